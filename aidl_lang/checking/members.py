"""Facts about members: of structures, shapes, primitives, points, boxes, lists and imported files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from aidl_lang.checking import builtins
from aidl_lang.checking.facts import NOTHING_READ, UNKNOWN, Fact, ReadPlace, body_of, of_symbol, part
from aidl_lang.checking.resolving.complaints import renamed, respell
from aidl_lang.checking.resolving.symbols import Symbol, SymbolKind, SymbolScope
from aidl_lang.checking.rules import a, shown
from aidl_lang.checking.synonyms import FIELDS, MEMBERS
from aidl_lang.checking.types import (
    ANY,
    AnyType,
    BoxType,
    GeometryType,
    ListType,
    PointType,
    RecordType,
    StructureType,
    Type,
)
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.names import find, fold, nearest
from aidl_lang.common.prose import first_few, ticked
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.infer import Inference


def member(check: Inference, node: ast.Member) -> Fact:
    if isinstance(node.value, ast.Name):
        symbol = check.resolution.uses.get(node.value)
        if symbol is not None and symbol.kind is SymbolKind.NAMESPACE:
            return _of_file(check, node, symbol)
    return member_of(check, check.fact(node.value), node)


def _of_file(check: Inference, node: ast.Member, space: Symbol) -> Fact:
    assert space.scope is not None
    if (scope := space.scope.spaces.get(space.name)) is None:
        return UNKNOWN
    key = find(node.name.text, scope.values)
    if key is None:
        return _no_member(check, node, "the file", list(scope.values))
    _means(check, node, scope.values[key])
    return of_symbol(check, scope.values[key])


def member_of(check: Inference, base: Fact, node: ast.Member) -> Fact:
    """Returns the fact of `base.name`."""
    name = node.name.text
    match base.type:
        case AnyType() | RecordType():
            return Fact(ANY, base.reads)
        case ListType():
            return _mapped(check, base, node)
        case StructureType():
            return _of_structure(check, base, node)
        case GeometryType(kind):
            if base.of is not None:
                return _of_shape(check, base, node)
            if kind in builtins.PRIMITIVE:
                return _field(check, base, node, builtins.PRIMITIVE[kind])
            return Fact(ANY, base.reads)
        case PointType():
            return _field(check, base, node, builtins.PRIMITIVE["point"])
        case BoxType():
            return _field(check, base, node, {})
        case _:
            return check.report(
                "E0202",
                f"{a(base.type)} has no members, so there is no `{shown(node.value)}.{name}`",
                node.name,
            )


def _mapped(check: Inference, base: Fact, node: ast.Member) -> Fact:
    """Returns the fact of `a.rim` for a list: of each member's; sides of a list may be those of its group."""
    settings = builtins.PATTERN.get(base.pattern, {})
    if (key := find(node.name.text, settings)) is not None:
        return Fact(settings[key], base.reads)
    element = base.element()
    if element.is_any or builtins.is_box_name(node.name.text) or find(node.name.text, builtins.BOX):
        return Fact(ANY, base.reads)
    return member_of(check, element, node).listed()


def _of_structure(check: Inference, base: Fact, node: ast.Member) -> Fact:
    if base.of is None:
        return Fact(ANY, base.reads)
    scope = check.resolution.scope_of(base.of)
    key = find(node.name.text, scope.values)
    if key is None:
        if len(within := _holding(check, scope, node.name.text)) == 1:
            path, at = f"{within[0]}.{node.name.text}", node.name.span
            return check.report(
                "E0202",
                f"`{shown(node.value)}` has no `{node.name.text}`: that is in its `{within[0]}`",
                node.name,
                fix=Fix(f"write `{path}`", (Edit(at, path),), is_sure=True),
            )
        return _field(check, base, node, builtins.STRUCTURE, list(scope.values))
    symbol = scope.values[key]
    _means(check, node, symbol)
    if symbol.kind is SymbolKind.ARGUMENT:
        return of_symbol(check, symbol)
    fact = of_symbol(check, symbol)
    if base.place is None:
        return replace(fact, reads=base.reads if fact.reads else NOTHING_READ, place=None)
    place = fact.place and _seen(check, fact.place, base.of, base.place, symbol)
    reads = frozenset(_seen(check, p, base.of, base.place, symbol) for p in fact.reads)
    return replace(fact, place=place, reads=reads)


def _holding(check: Inference, scope: SymbolScope, name: str) -> list[str]:
    """Returns the structures in a scope that have a structure or geometry of a name that all things lack."""
    if any(find(name, table) for table in (builtins.STRUCTURE, builtins.BOX, builtins.FINISH)):
        return []
    if builtins.is_box_name(name) or fold(name) in FIELDS:
        return []
    inner = (
        (key, symbol.node) for key, symbol in scope.values.items() if isinstance(symbol.node, ast.Structure)
    )
    return [key for key, node in inner if name in check.resolution.scope_of(node).values]


def _seen(check: Inference, place: ReadPlace, of: ast.Node, base: ReadPlace, symbol: Symbol) -> ReadPlace:
    """Returns a place that is given from inside a structure, or from around it, as seen from where that
    structure is named. A structure that the expression itself stands in is seen from inside.
    """
    if place.holder is not of:
        around = symbol.scope.homes if symbol.scope is not None else ()
        if place.holder in check.homes or place.holder not in around:
            return place
        outwards = len(around) - 1 - around.index(place.holder)
        return ReadPlace(base.holder, base.below[: max(len(base.below) - outwards, 0)] + place.below)
    if place.below == (symbol.name,) and symbol.node in check.homes and not symbol.is_array:
        assert symbol.node is not None
        return ReadPlace(symbol.node)
    return ReadPlace(base.holder, base.below + place.below)


def _of_shape(check: Inference, base: Fact, node: ast.Member) -> Fact:
    assert base.of is not None
    scope = body_of(check, base.of)
    key = find(node.name.text, scope.values)
    if key is None:
        if find(node.name.text, dict.fromkeys(builtins.OUTLINE)):
            return Fact(ANY, base.reads)
        return _field(check, base, node, {}, list(scope.values))
    _means(check, node, scope.values[key])
    return replace(part(check, base.of, key), reads=base.reads, place=None, bare=None)


def _field(
    check: Inference, base: Fact, node: ast.Member, own: Mapping[str, Type], known: Sequence[str] = ()
) -> Fact:
    """Returns the fact of a field of a primitive or a structure, or of one of the box that everything has."""
    name = node.name.text
    if builtins.is_box_name(name):
        return Fact(BoxType(), base.reads)
    for table in (own, builtins.BOX, builtins.FINISH):
        key = find(name, table)
        if key is not None:
            _means(check, node, Symbol(key, SymbolKind.FIELD))
            return Fact(table[key], base.reads)
    names = [*known, *own, *builtins.BOX]
    meant = next((m for m in MEMBERS.get(fold(name), ()) if find(m, dict.fromkeys(names))), None)
    if meant is not None:
        return _in_other_words(check, base, node, meant)
    return _no_member(check, node, a(base.type), names)


def _in_other_words(check: Inference, base: Fact, node: ast.Member, meant: str) -> Fact:
    """Returns the fact of a field named by a synonym: `c.r` for `c.radius`."""
    name = ast.Identifier(meant, span=node.name.span)
    other = ast.Member(node.value, name, span=node.span)
    fact = member_of(check, base, other)
    check.resolution.canonical[node.name] = check.resolution.canonical.get(name, meant)
    if (symbol := check.resolution.uses.get(other)) is not None:
        check.resolution.uses[node] = symbol
    return fact


def _means(check: Inference, node: ast.Member, symbol: Symbol) -> None:
    check.resolution.uses[node] = symbol
    if symbol.name != node.name.text:
        check.resolution.canonical[node.name] = symbol.name


def _function_or_coordinate(check: Inference, node: ast.Member, known: Sequence[str]) -> Fact | None:
    """Reports `plate.area`, which is a function here, and `c.x` of something with a width. None for other
    names.
    """
    name, of = node.name.text, node.value.span.text
    if fold(name) in ("area", "perimeter", "circumference"):
        function = "area" if fold(name) == "area" else "perimeter"
        return check.report(
            "E0206",
            f"`{function}` is a function and has to be called: `{function}({shown(node.value)})`",
            node.name,
            fix=Fix(f"write `{function}(…)`", (Edit(node.span, f"{function}({of})"),), is_sure=True),
        )
    if fold(name) in ("x", "y") and "center" in known and "width" in known:
        side = "left" if fold(name) == "x" else "bottom"
        return check.report(
            "E0202",
            f"`{shown(node.value)}` has no `{name}`: it has a centre and sides",
            node.name,
            hints=[f"write `{shown(node.value)}.center.{name}`, or a side, as `{shown(node.value)}.{side}`"],
            fix=Fix(f"write `center.{name}`", (Edit(node.name.span, f"center.{name}"),)),
        )
    if "rotation" in known and fold(name) in ("angle", "orientation", "tilt", "theta", "rotate"):
        return check.report(
            "E0202",
            f"`{shown(node.value)}` has no `{name}`: how a structure is turned is its `rotation`",
            node.name,
            fix=renamed(node.name, "rotation"),
        )
    return None


def _no_member(check: Inference, node: ast.Member, what: str, known: Sequence[str]) -> Fact:
    name = node.name.text
    if (answer := _function_or_coordinate(check, node, known)) is not None:
        return answer
    like = nearest(name, known, 2)
    members = f"its members are {first_few(ticked(dict.fromkeys(known)), 8, '')}, …"
    if fold(name) in ("apex", "tip", "peak") and {"a", "b", "c", "centroid"} <= set(known):
        like, members = [], "its corners are `a`, `b` and `c`, in the order in which they were given"
    return check.report(
        "E0202",
        f"`{shown(node.value)}` has no `{name}`" + (f"; did you mean `{like[0]}`?" if like else ""),
        node.name,
        label=f"not a member of {what}",
        hints=() if like else (members,) if known else (),
        fix=respell(node.name, like),
    )

"""Facts about members and operators: of structures, shapes, points, lists; arithmetic and comparisons."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from aidl_lang.checking import builtins, rules, units
from aidl_lang.checking.binding import FIELDS, MEMBERS
from aidl_lang.checking.complaints import did_you_mean, renamed, respell
from aidl_lang.checking.facts import (
    NOTHING_READ,
    UNKNOWN,
    Fact,
    ReadPlace,
    body_of,
    is_number,
    is_point,
    of_symbol,
    part,
)
from aidl_lang.checking.rules import a, in_box, shown
from aidl_lang.checking.symbols import Symbol, SymbolKind, SymbolScope
from aidl_lang.checking.types import (
    ANY,
    AnyType,
    BoxType,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    RangeType,
    RecordType,
    StructureType,
    TextType,
    TruthType,
    Type,
)
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.names import find, fold, nearest
from aidl_lang.common.prose import first_few, ticked
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.infer import Inference


# --- Arithmetic, vectors and comparisons: the operands that go together, and the types of the results.


def unary(check: Inference, node: ast.Unary) -> Fact:
    if node.operator == "not":
        return Fact(TruthType(), check.wants(node.operand, "a condition", TruthType).reads)
    fact = check.fact(node.operand)
    return fact if isinstance(fact.type, PointType) else check.numeric(node.operand)


def binary(check: Inference, node: ast.Binary) -> Fact:
    if node.operator in ("and", "or"):
        sides = [check.wants(n, "a condition", TruthType) for n in (node.left, node.right)]
        return Fact(TruthType(), sides[0].reads | sides[1].reads)
    left, right = check.fact(node.left), check.fact(node.right)
    reads = left.reads | right.reads
    if left.is_any or right.is_any or isinstance(left.type, ListType) or isinstance(right.type, ListType):
        return Fact(ANY, reads)
    if node.operator == "+" and isinstance(left.type, TextType) and isinstance(right.type, TextType):
        return Fact(TextType(), reads)
    if is_point(left.type) or is_point(right.type):
        return _vector(check, node, left, right)
    left, right = check.numeric(node.left), check.numeric(node.right)
    if not isinstance(left.type, NumberType) or not isinstance(right.type, NumberType):
        return Fact(ANY, reads)
    return _arithmetic(check, node, left, right, left.type, right.type)


def _vector(check: Inference, node: ast.Binary, left: Fact, right: Fact) -> Fact:
    points = is_point(left.type), is_point(right.type)
    numbers = isinstance(left.type, NumberType), isinstance(right.type, NumberType)
    op = node.operator
    if (
        (all(points) and op in "+-")
        or (points[0] and numbers[1] and op in "*/")
        or (numbers[0] and op == "*")
    ):
        return Fact(PointType(), left.reads | right.reads)
    misfit = rules.no_vectors(op, left.type, right.type, shown(node.left), shown(node.right))
    sides = ((node.left, left, right), (node.right, right, left))
    for side, fact, other in sides:
        if isinstance(side, ast.Member) and (text := _meant_point(check, side, fact, other)) is not None:
            hints = misfit.hints
            if isinstance(fact.type, GeometryType):
                hints = (f"`{shown(side)}` is {a(fact.type)} of the outline; the corner is `{text}`",)
            fix = Fix(f"write `{text}`", (Edit(side.span, text),))
            return check.misfit(replace(misfit, hints=hints), node, fix)
    return check.misfit(misfit, node)


def _meant_point(check: Inference, node: ast.Member, fact: Fact, other: Fact) -> str | None:
    """Returns the point or coordinate that is meant by a member beside a point or a number:
    `plate.top_left` by the arc `plate.corner_top_left`, `disc.top.y` by the point `disc.top`.
    """
    of, name = node.value.span.text, check.resolution.canonical.get(node.name, node.name.text)
    if is_number(other.type) and isinstance(fact.type, PointType):
        axis = {"top": "y", "bottom": "y", "left": "x", "right": "x"}.get(name)
        return f"{of}.{name}.{axis}" if axis else None
    corner = name.removeprefix("corner_")
    whole = check.fact(node.value).of
    if corner == name or whole is None or not is_point(other.type):
        return None
    return f"{of}.{corner}" if corner in body_of(check, whole).values else None


def _arithmetic(
    check: Inference, node: ast.Binary, left: Fact, right: Fact, x: NumberType, y: NumberType
) -> Fact:
    reads = left.reads | right.reads
    op = node.operator
    if op == "%":
        for operand in (node.left, node.right):
            if not check.known(operand, "an operand of `%`"):
                break
    if op in "+-%":
        dimension = check.same_dimension(left, right, node, f"`{op}` does not join")
        bare = left.bare or right.bare if dimension is None else None
        return Fact(NumberType(dimension, x.whole and y.whole), reads, bare=bare)
    if op == "^":
        if x.dimension in (None, units.PLAIN):
            return Fact(NumberType(x.dimension), reads)
        return Fact(ANY, reads)
    unclear = node.left if x.dimension is None else node.right
    if (x.dimension is None) != (y.dimension is None) and not _is_plain(unclear):
        return Fact(ANY, reads)  # a bare param may be a length or a plain number, which only building shows
    combine = units.multiply if op == "*" else units.divide
    return Fact(NumberType(combine(x.dimension, y.dimension), op == "*" and x.whole and y.whole), reads)


def comparison(check: Inference, node: ast.Comparison) -> Fact:
    facts = [check.fact(operand) for operand in node.operands]
    for i, operator in enumerate(node.operators):
        compare(check, operator, node.operands[i], node.operands[i + 1], node)
    return Fact(TruthType(), frozenset().union(*(f.reads for f in facts)))


def compare(
    check: Inference, operator: str, left: ast.Expression, right: ast.Expression, node: ast.Node
) -> None:
    """Reports two sides that cannot be compared."""
    x, y = check.fact(left), check.fact(right)
    if x.is_any or y.is_any:
        return
    if is_number(x.type) and is_number(y.type):
        what = f"`{operator}` does not compare"
        check.same_dimension(check.numeric(left), check.numeric(right), node, what)
        return
    if is_point(x.type) and is_point(y.type):
        if operator not in ("==", "!="):
            check.misfit(rules.no_order(operator), node)
        return
    if isinstance(x.type, ListType) or isinstance(y.type, ListType):
        return
    if type(x.type) is type(y.type) and isinstance(x.type, TextType | TruthType) and operator in ("==", "!="):
        return
    misfit = rules.no_comparison(operator, x.type, y.type, shown(left), shown(right))
    sides = ((left, x.type, y.type), (right, y.type, x.type))
    boxed = ((side, in_box(kind, side.span.text, other)) for side, kind, other in sides)
    fix = next((Fix(f"write `{text}`", (Edit(side.span, text),)) for side, text in boxed if text), None)
    check.misfit(misfit, node, fix)


def membership(check: Inference, node: ast.Membership) -> Fact:
    value = check.fact(node.value)
    container = check.wants(node.container, "a range or a list", RangeType, ListType)
    if isinstance(node.container, ast.Range) and isinstance(container.type, RangeType):
        compare(check, ">=", node.value, node.container.start, node)
        if not isinstance(node.container.end, ast.Number):
            compare(check, "<=", node.value, node.container.end, node)
    return Fact(TruthType(), value.reads | container.reads)


def _is_plain(node: ast.Expression) -> bool:
    """Tells whether a number without a unit can only be plain: it is made of digits alone."""
    return all(isinstance(n, ast.Number | ast.Unary | ast.Binary) for n in ast.walk(node))


# --- Facts about members: of structures, shapes, primitives, points, boxes, lists and imported files.


def member(check: Inference, node: ast.Member) -> Fact:
    if (space := check.namespace(node.value)) is not None:
        return _of_file(check, node, space)
    return member_of(check, check.fact(node.value), node)


def _of_file(check: Inference, node: ast.Member, space: Symbol) -> Fact:
    assert space.scope is not None
    if (scope := space.scope.spaces.get(space.name)) is None:
        return UNKNOWN
    if (key := find(node.name.text, scope.values)) is None:
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
            message = f"{a(base.type)} has no members, so there is no `{shown(node.value)}.{name}`"
            return check.report("E0202", message, node.name)


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
    if (key := find(node.name.text, scope.values)) is None:
        if len(within := _holding(check, scope, node.name.text)) == 1:
            path, at = f"{within[0]}.{node.name.text}", node.name.span
            message = f"`{shown(node.value)}` has no `{node.name.text}`: that is in its `{within[0]}`"
            fix = Fix(f"write `{path}`", (Edit(at, path),), is_sure=True)
            return check.report("E0202", message, node.name, fix=fix)
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
    nodes = ((key, symbol.node) for key, symbol in scope.values.items())
    inner = ((key, node) for key, node in nodes if isinstance(node, ast.Structure))
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
    if (key := find(node.name.text, scope.values)) is None:
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
        if (key := find(name, table)) is not None:
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
    """Reports `plate.area`, a function here, and `c.x` of something with a width. None for other names."""
    name, of = node.name.text, node.value.span.text
    if fold(name) in ("area", "perimeter", "circumference"):
        function = "area" if fold(name) == "area" else "perimeter"
        message = f"`{function}` is a function and has to be called: `{function}({shown(node.value)})`"
        fix = Fix(f"write `{function}(…)`", (Edit(node.span, f"{function}({of})"),), is_sure=True)
        return check.report("E0206", message, node.name, fix=fix)
    if fold(name) in ("x", "y") and "center" in known and "width" in known:
        side = "left" if fold(name) == "x" else "bottom"
        message = f"`{shown(node.value)}` has no `{name}`: it has a centre and sides"
        hint = f"write `{shown(node.value)}.center.{name}`, or a side, as `{shown(node.value)}.{side}`"
        fix = Fix(f"write `center.{name}`", (Edit(node.name.span, f"center.{name}"),))
        return check.report("E0202", message, node.name, hints=[hint], fix=fix)
    if "rotation" in known and fold(name) in ("angle", "orientation", "tilt", "theta", "rotate"):
        message = f"`{shown(node.value)}` has no `{name}`: how a structure is turned is its `rotation`"
        return check.report("E0202", message, node.name, fix=renamed(node.name, "rotation"))
    return None


def _no_member(check: Inference, node: ast.Member, what: str, known: Sequence[str]) -> Fact:
    name = node.name.text
    if (answer := _function_or_coordinate(check, node, known)) is not None:
        return answer
    like = nearest(name, known, 2)
    members = f"its members are {first_few(ticked(dict.fromkeys(known)), 8, '')}, …"
    if fold(name) in ("apex", "tip", "peak") and {"a", "b", "c", "centroid"} <= set(known):
        like, members = [], "its corners are `a`, `b` and `c`, in the order in which they were given"
    message = f"`{shown(node.value)}` has no `{name}`" + did_you_mean(like)
    label = f"not a member of {what}"
    hints = () if like else (members,) if known else ()
    return check.report("E0202", message, node.name, label=label, hints=hints, fix=respell(node.name, like))

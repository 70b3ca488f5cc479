"""Completion after a dot, between the brackets of an index, and of named arguments."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import partial

from aidl_lang.checking import builtins
from aidl_lang.checking.builtins import EDITS
from aidl_lang.checking.facts import Fact, body_of, of_symbol
from aidl_lang.checking.members import member_of
from aidl_lang.checking.resolving.symbols import Symbol, SymbolKind, SymbolScope
from aidl_lang.checking.types import (
    AnyType,
    BoxType,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    RecordType,
    Signature,
    StructureType,
    TextType,
    TruthType,
    Type,
    accepts,
)
from aidl_lang.checking.units import ANGLE
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.completion import names
from aidl_lang.tools.ide.completion.constraints import forms, kind_of
from aidl_lang.tools.ide.completion.context import CONDITION, Context, KnownName, Use
from aidl_lang.tools.ide.completion.drafts import Draft, stop, words_of
from aidl_lang.tools.ide.references import parameter_node
from aidl_lang.tools.ide.signatures import Reading, fenced, is_public, joined, of_parameter
from aidl_lang.tools.reference.signatures import parts, things
from aidl_lang.tools.vocabulary import vocabulary

_OWN, _FIELDS, _DEMANDS, _BOX, _METHODS, _UNFIT = 0.0, 1.0, 1.7, 2.0, 3.0, 4.0
_MOST_INDICES = 12
_SEEN = frozenset(
    (SymbolKind.PARAM, SymbolKind.LET, SymbolKind.VAR, SymbolKind.GEOMETRY, SymbolKind.STRUCTURE)
) | {SymbolKind.ARGUMENT}
_NUMBER = re.compile(r"-?\d+")


def members(context: Context, value: ast.Expression) -> Iterator[Draft]:
    """Yields members of the value before the dot, and calls that take it as first argument."""
    check = context.view.program.inference
    if isinstance(value, ast.Name):
        symbol = context.view.resolution.uses.get(value)
        if symbol is not None and symbol.kind is SymbolKind.NAMESPACE and symbol.scope is not None:
            yield from _of_file(context, symbol.scope.spaces.get(symbol.name))
            return
    fact = check.fact(value)
    if isinstance(value, ast.Number) or isinstance(fact.type, NumberType):
        return
    listed: set[str] = set()
    for tier, name, describe in _names(context, fact):
        if name not in listed:
            listed.add(name)
            yield _member(context, fact, name, tier, describe)
    yield from _methods(context, fact)


def _of_file(context: Context, scope: SymbolScope | None) -> Iterator[Draft]:
    if scope is None:
        return
    check = context.view.program.inference
    for name, symbol in scope.values.items():
        if symbol.kind in (SymbolKind.PARAM, SymbolKind.LET):
            known = KnownName(name, symbol, of_symbol(check, symbol))
            yield names.of_name(known, _OWN)
    for name in (*scope.callables, *scope.aliases):
        found = scope.called(name)
        if found is not None:
            yield names.call(context, name, found[1], _OWN, scope.aliases.get(name))


_Named = Iterator[tuple[float, str, Symbol | None]]


def _names(context: Context, fact: Fact) -> _Named:
    match fact.type:
        case StructureType() if fact.of is not None:
            for name, symbol in context.view.resolution.scope_of(fact.of).values.items():
                if symbol.kind in _SEEN:
                    yield _OWN + 0.5 * (symbol.kind in (SymbolKind.LET, SymbolKind.ARGUMENT)), name, symbol
            yield from _plain((*builtins.BOX, "bb"), _BOX)
            yield from _plain(builtins.STRUCTURE, _BOX + 0.5)
        case GeometryType(kind):
            if fact.of is not None:
                yield from _of_shape(context, fact.of)
            else:
                yield from _plain(builtins.PRIMITIVE.get(kind, {}), _FIELDS)
            yield from _plain((*builtins.BOX, "bb"), _BOX)
        case PointType():
            yield from _plain(("x", "y"), _FIELDS)
        case BoxType() | StructureType():
            yield from _plain(builtins.BOX, _FIELDS)
        case ListType():
            yield from _plain(builtins.PATTERN.get(fact.pattern, {}), _OWN)
            yield from _names(context, fact.element())
            yield from _plain((*builtins.BOX, "bb"), _BOX)
        case _:
            pass


def _plain(found: Iterable[str], tier: float) -> _Named:
    for name in found:
        yield tier, name, None


def _of_shape(context: Context, definition: ast.Node) -> _Named:
    assert isinstance(definition, ast.ShapeDefinition)
    scope = body_of(context.view.program.inference, definition)
    for part in parts(definition):
        name = part.name.partition("[")[0]
        if name in scope.values:
            yield _OWN, name, scope.values[name]
    for parameter in definition.parameters:
        if (symbol := scope.values.get(parameter.name.text)) is not None:
            yield _FIELDS, parameter.name.text, symbol


def _member(context: Context, base: Fact, name: str, tier: float, symbol: Symbol | None) -> Draft:
    check = context.view.program.inference
    identifier = ast.Identifier(name, span=context.path[-1].span)
    nothing = ast.Name(name, span=context.path[-1].span)
    fact = member_of(check, base, ast.Member(nothing, identifier, span=context.path[-1].span))
    wanted = context.wanted
    if wanted != CONDITION and wanted.distance(fact.type) is None:
        tier += _UNFIT if isinstance(fact.type, NumberType | PointType) else 0.5
    is_array = symbol is not None and symbol.is_array
    if symbol is None:
        return Draft(name, "field", tier, detail=str(fact.type), describe=partial(_field, name, fact))
    kind = "field" if symbol.kind is SymbolKind.ARGUMENT else str(symbol.kind)
    known = KnownName(name, symbol, fact)
    text = names.detail(known) if not is_array else str(fact.type)
    return Draft(name, kind, tier, detail=text, describe=partial(names.about, symbol))


def _field(name: str, fact: Fact) -> str:
    return joined([fenced(f"{name}: {fact.type}")])


def _methods(context: Context, fact: Fact) -> Iterator[Draft]:
    """Yields `a.above(…)`: constraints among constraints, functions elsewhere."""
    if isinstance(fact.type, AnyType | RecordType):
        return
    words = vocabulary()
    above = context.site.parent(2)
    is_demand = context.use is Use.CONSTRAINT and isinstance(
        above, ast.ExpressionStatement | ast.Constrain | ast.Block | ast.Prefer | ast.Binary
    )
    known: list[str] = []
    if is_demand:
        known += [*words.relations, *words.constraints]
        known += sorted(EDITS & {*words.operations})
    known += words.functions
    own = [name for name, _ in context.callables()]
    kind = kind_of(fact)
    for name in (*own, *known):
        signatures = context.called(name)
        distance = _first_fits(fact, signatures, name, kind) if signatures else None
        demands = [s.kind is ast.ConstraintDefinition for s in signatures]
        if distance is None or (not is_demand and all(demands)):
            continue
        tier = (
            (_DEMANDS if is_demand and demands[0] else _METHODS) + 0.1 * distance + 0.05 * (name not in own)
        )
        text = names.called(context, name, signatures, skipped=1)
        yield names.of_call(name, "method", tier + 0.05 * (name not in own), text, signatures)


def _first_fits(fact: Fact, signatures: list[Signature], name: str, kind: str) -> float | None:
    """Returns how well a callable's first parameter takes a thing; None if it does not."""
    table: Mapping[str, object] = forms()
    if name in table and all(s.standard for s in signatures):
        pairs = [len(form.pairs) for form in forms()[name] if any(first == kind for first, _ in form.pairs)]
        return min(pairs) / 100 if pairs else None
    distances = [
        d
        for s in signatures
        if s.parameters and (d := accepts(s.parameters[0][1], fact.type)) is not None and d < 3
    ]
    return min(distances) if distances else None


def indices(context: Context, index: ast.Index) -> Iterator[Draft]:
    """Yields the indices of an array in the last drawing, the last one as `-1`."""
    drawn = context.site.original.drawn
    if drawn is None or drawn.model is None:
        return
    name = index.value.span.one_line.rpartition(".")[2]
    found: set[int] = set()
    for structure in drawn.model.root.walk():
        things: list[SolvedStructure | SolvedGeometry] = [*structure.structures, *structure.geometry]
        for member in things:
            array, _, index_text = member.name.partition("[")
            if array == name and (number := _NUMBER.match(index_text)):
                found.add(int(number[0]))
    for place in sorted(found)[:_MOST_INDICES]:
        yield Draft(str(place), "word", _FIELDS, detail=f"{name}[{place}]")
    if found:
        yield Draft("-1", "word", _BOX, detail=f"the last of {len(found)}")


# --- Completion of named arguments that a call does not have yet.

_NEEDED, _OPTIONAL = 0.2, 0.6
_NAMED = re.compile(r"\s*(:|=(?!=))")
_LONGEST_DEFAULT = 20


def named_arguments(context: Context) -> Iterator[Draft]:
    """Yields parameters of the overloads still possible, required ones first."""
    call = context.call
    if call is None:
        return
    public = [r for r in context.readings if is_public(r.signature)] or context.readings
    for order, reading in enumerate(public):
        for place, (name, kind, is_optional) in enumerate(_open(reading, call[1])):
            tier = (_OPTIONAL if is_optional else _NEEDED + order / 20) + place / 100
            yield _argument(context, reading.signature, name, kind, tier)


def _open(reading: Reading, number: int) -> list[tuple[str, Type, bool]]:
    taken = {name for n, name in enumerate(reading.taken) if n != number}
    node = reading.signature.node
    related = {p.name.text for p in things(node)} if isinstance(node, ast.ConstraintDefinition) else set()
    return [p for p in reading.signature.parameters if p[0] not in taken and p[0] not in related]


def _argument(context: Context, signature: Signature, name: str, kind: Type, tier: float) -> Draft:
    node = parameter_node(signature, name)
    default = node.default.span.one_line if node is not None and node.default is not None else ""
    is_named = _NAMED.match(context.site.following) is not None
    text = name if is_named else f"{name}: {_proposed(signature, name, kind, default)}"
    return Draft(
        f"{name}:",
        "argument",
        tier,
        text,
        str(kind) + (f" = {default}" if default else ""),
        not is_named,
        describe=partial(of_parameter, signature, name),
    )


def _proposed(signature: Signature, name: str, kind: Type, default: str) -> str:
    """Returns a snippet placeholder with a value that the parameter takes."""
    if isinstance(kind, TextType) and (words := words_of(signature, name)):
        listed = [word if word.isidentifier() else f'"{word}"' for word in words if word != "free"]
        return f"${{1|{','.join(listed)}|}}"
    if default and len(default) < _LONGEST_DEFAULT:
        return stop(1, default)
    match kind:
        case NumberType(dimension, whole):
            return stop(1, "45deg" if dimension == ANGLE else "3" if whole else "10")
        case PointType():
            return "(${1:0}, ${2:0})"
        case TextType():
            return '"${1:text}"'
        case TruthType():
            return "${1|true,false|}"
        case ListType():
            return f"[{stop(1, name)}]"
        case _:
            return stop(1, name)

"""Facts about names: of params, lets, loop variables, parameters, geometry and structures."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from aidl_lang.checking import fields
from aidl_lang.checking.facts import UNKNOWN, Fact, ReadPlace, joined
from aidl_lang.checking.resolving.symbols import Symbol, SymbolKind
from aidl_lang.checking.types import (
    ANY,
    PARAMETER_TYPES,
    ListType,
    NumberType,
    RangeType,
    StructureType,
    Type,
)
from aidl_lang.common.names import find
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.infer import Inference


def of_symbol(check: Inference, symbol: Symbol) -> Fact:
    """Returns the fact of a name as it is declared."""
    match symbol.kind:
        case SymbolKind.BUILTIN:
            return _builtin(check, symbol)
        case SymbolKind.NAMESPACE:
            return UNKNOWN
        case SymbolKind.STRUCTURE if symbol.scope is None:  # its own name, inside the structure
            return _structure_itself(check, symbol.node)
        case SymbolKind.LOOP:
            return _loop_variable(check, symbol)
        case SymbolKind.ARGUMENT:
            return _argument(check, symbol)
        case _:
            return _declared(check, symbol)


def _builtin(check: Inference, symbol: Symbol) -> Fact:
    if symbol.name == "self":
        return _structure_itself(check, check.homes[-1])
    if symbol.name in fields.STRUCTURE:
        return Fact(fields.STRUCTURE[symbol.name])
    let = check.resolution.library.constants.get(symbol.name)
    return UNKNOWN if let is None else _literal(check, let.value)


def _literal(check: Inference, node: ast.Expression) -> Fact:
    return check.fact(node) if isinstance(node, ast.Number | ast.String | ast.Boolean) else UNKNOWN


def _structure_itself(check: Inference, node: ast.Node | None) -> Fact:
    if not isinstance(node, ast.Structure):
        return UNKNOWN
    place = ReadPlace(node)
    return Fact(StructureType(), frozenset({place}), node, place)


def _loop_variable(check: Inference, symbol: Symbol) -> Fact:
    loop = symbol.node
    assert isinstance(loop, ast.For | ast.ForArguments | ast.Comprehension)
    if len(loop.variables) > 1:
        return UNKNOWN
    run = check.facts.get(loop.iterable)
    if run is None:
        return UNKNOWN
    if isinstance(run.type, RangeType):
        return Fact(NumberType(None, whole=True)) if _is_plain_range(loop.iterable) else UNKNOWN
    element = run.element()
    return Fact(ANY, element.reads) if isinstance(element.type, NumberType) else element


def _argument(check: Inference, symbol: Symbol) -> Fact:
    parameter = symbol.node
    assert isinstance(parameter, ast.Parameter)
    if parameter.type is None:
        return UNKNOWN
    word = find(parameter.type.text, PARAMETER_TYPES)
    return Fact(PARAMETER_TYPES[word]) if word else UNKNOWN


def _declared(check: Inference, symbol: Symbol) -> Fact:
    """Returns the fact of a declared name; of several declarations, what they have in common."""
    fact: Fact | None = None
    for node in symbol.nodes:
        one = _declaration(check, symbol, node)
        fact = one if fact is None else joined(fact, one)
    fact = fact or UNKNOWN
    if isinstance(fact.type, NumberType) and fact.type.dimension is None and not fact.reads:
        fact = replace(fact, bare=symbol)
    return fact


def _declaration(check: Inference, symbol: Symbol, node: ast.Node) -> Fact:
    if node in check.running:
        return UNKNOWN  # a cycle, which is reported when its names are checked
    check.running.add(node)
    assert symbol.scope is not None
    before, check.homes = check.homes, symbol.scope.homes
    try:
        return _value_of(check, symbol, node)
    finally:
        check.homes = before
        check.running.discard(node)


def _value_of(check: Inference, symbol: Symbol, node: ast.Node) -> Fact:
    home = check.homes[-1]
    match node:
        case ast.Param():
            return _param(check, node)
        case ast.Let(value=value):
            return check.fact(value)
        case ast.Var(value=value):
            return Fact(_unlocked(check.fact(value).type), frozenset({ReadPlace(home)}))
        case ast.Structure(indices=indices):
            place = ReadPlace(home, (symbol.name,))
            return Fact(StructureType(), frozenset({place}), node, place).listed(len(indices))
        case ast.Assign(value=value, indices=indices):
            fact = check.fact(value)
            is_made = symbol.kind is SymbolKind.GEOMETRY
            if isinstance(fact.type, StructureType) or (is_made and _holds_structures(fact.type)):
                place = ReadPlace(home, (symbol.name,))
                fact = replace(fact, reads=frozenset({place}), place=place)
            elif is_made:
                # A copy of an ancestor's geometry is for the ancestor to constrain.
                far = {p for p in fact.reads if p.holder is not home}
                fact = fact.reading(frozenset({ReadPlace(home), *far}))
            return fact.listed(len(indices))
        case _:
            return UNKNOWN


def _holds_structures(kind: Type) -> bool:
    while isinstance(kind, ListType):
        kind = kind.element
    return isinstance(kind, StructureType)


def _param(check: Inference, node: ast.Param) -> Fact:
    fact = check.fact(node.value)
    if not isinstance(fact.type, NumberType):
        return fact
    dimension = fact.type.dimension
    if dimension is None and isinstance(node.domain, ast.Range):
        for end in (node.domain.start, node.domain.end):
            bound = check.fact(end).type
            if isinstance(bound, NumberType) and bound.dimension is not None:
                dimension = bound.dimension
    return Fact(NumberType(dimension, whole=dimension is None))


def _is_plain_range(node: ast.Expression) -> bool:
    return isinstance(node, ast.Range) and not any(
        isinstance(n, ast.Number) and n.unit is not None for n in ast.walk(node)
    )


def _unlocked(kind: Type) -> Type:
    """Returns the type of a number that the solver finds: not whole, and ANY for a bare one, whose dimension
    its constraints decide.
    """
    if isinstance(kind, NumberType):
        return ANY if kind.dimension is None else NumberType(kind.dimension)
    return kind

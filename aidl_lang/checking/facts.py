"""Facts about names and expressions before anything is built: types, and the unknowns that are read."""

from __future__ import annotations

from dataclasses import replace
from functools import reduce
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang.checking import builtins
from aidl_lang.checking.symbols import Symbol, SymbolKind, SymbolScope
from aidl_lang.checking.types import (
    ANY,
    AnyType,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    RangeType,
    StructureType,
    Type,
    parameter_type,
)
from aidl_lang.common.names import fold
from aidl_lang.common.records import record
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.infer import Inference


# --- Facts about an expression before anything is built: its type, and the unknowns it reads.


@record(slots=True)
class ReadPlace:
    """A structure whose unknowns are read: `below` is its path as the structure or file `holder` sees it."""

    holder: ast.Node
    below: tuple[str, ...] = ()


Reads: TypeAlias = frozenset[ReadPlace]

NOTHING_READ: Reads = frozenset()


@record(slots=True)
class Fact:
    """The facts about a value, as far as they are known.

    type   of the value
    reads  the structures whose unknowns the value depends on; empty for constants, and if it is not known
    of     the definition whose members it has (a list: its elements): structure, template, shape, or file
    place  of a structure
    bare   the param or let whose number without a unit it is
    pattern  the operation that laid out the members of an array
    """

    type: Type = ANY
    reads: Reads = NOTHING_READ
    of: ast.Node | None = None
    place: ReadPlace | None = None
    bare: Symbol | None = None
    pattern: str = ""

    @property
    def is_any(self) -> bool:
        return isinstance(self.type, AnyType)

    def listed(self, times: int = 1) -> Fact:
        """Returns the fact of a list of such values, or of lists of lists."""
        kind = self.type
        for _ in range(times):
            kind = ListType(kind)
        return Fact(kind, self.reads, self.of, self.place, None, "" if times else self.pattern)

    def element(self) -> Fact:
        """Returns the fact of a member of a list of such values."""
        kind = self.type.element if isinstance(self.type, ListType) else ANY
        return replace(self, type=kind, pattern="")


UNKNOWN = Fact()


def joined(a: Fact, b: Fact) -> Fact:
    """Returns the facts that two alternative values have in common."""
    reads = a.reads | b.reads
    if a.type == b.type and a.of is b.of:
        return Fact(a.type, reads, a.of, a.place if a.place == b.place else None)
    return Fact(ANY, reads)


def is_point(kind: Type) -> bool:
    return isinstance(kind, PointType) or kind == GeometryType("point")


def is_number(kind: Type) -> bool:
    """Tells whether a type is a number, or an edge that stands for its coordinate."""
    return isinstance(kind, NumberType) or kind == GeometryType("line")


# --- Facts about names: of params, lets, loop variables, parameters, geometry and structures.


def of_symbol(check: Inference, symbol: Symbol) -> Fact:
    """Returns the fact of a name as it is declared."""
    match symbol.kind:
        case SymbolKind.BUILTIN:
            return _builtin(check, symbol)
        case SymbolKind.NAMESPACE:
            return UNKNOWN
        case SymbolKind.STRUCTURE if symbol.scope is None:  # its own name, inside the structure
            return _structure_itself(symbol.node)
        case SymbolKind.LOOP:
            return _loop_variable(check, symbol)
        case SymbolKind.ARGUMENT:
            return _argument(symbol)
        case _:
            return _declared(check, symbol)


def _builtin(check: Inference, symbol: Symbol) -> Fact:
    if symbol.name == "self":
        return _structure_itself(check.homes[-1])
    if symbol.name in builtins.STRUCTURE:
        return Fact(builtins.STRUCTURE[symbol.name])
    let = check.resolution.library.constants.get(symbol.name)
    if let is None or not isinstance(let.value, ast.Number | ast.String | ast.Boolean):
        return UNKNOWN
    return check.fact(let.value)


def _structure_itself(node: ast.Node | None) -> Fact:
    if not isinstance(node, ast.Structure):
        return UNKNOWN
    place = ReadPlace(node)
    return Fact(StructureType(), frozenset({place}), node, place)


def _loop_variable(check: Inference, symbol: Symbol) -> Fact:
    loop = symbol.node
    assert isinstance(loop, ast.For | ast.ForArguments | ast.Comprehension)
    if len(loop.variables) > 1:
        return UNKNOWN
    if (run := check.facts.get(loop.iterable)) is None:
        return UNKNOWN
    if isinstance(run.type, RangeType):
        return Fact(NumberType(None, whole=True)) if _is_plain_range(loop.iterable) else UNKNOWN
    element = run.element()
    return Fact(ANY, element.reads) if isinstance(element.type, NumberType) else element


def _argument(symbol: Symbol) -> Fact:
    parameter = symbol.node
    assert isinstance(parameter, ast.Parameter)
    return Fact(parameter_type(parameter) or ANY)


def _declared(check: Inference, symbol: Symbol) -> Fact:
    """Returns the fact of a declared name; of several declarations, what they have in common."""
    facts = [_declaration(check, symbol, node) for node in symbol.nodes]
    fact = reduce(joined, facts) if facts else UNKNOWN
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
                fact = replace(fact, reads=frozenset({ReadPlace(home), *far}))
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
    """Returns the type of a number that the solver finds: not whole; ANY for a bare one, of any dimension."""
    if isinstance(kind, NumberType):
        return ANY if kind.dimension is None else NumberType(kind.dimension)
    return kind


# --- Facts about the library's own definitions. They see nothing of a program, so each is found once.

CONSTANT = frozenset({"len", "written"})
"""Functions whose results are constants even for unknowns."""


def body_of(check: Inference, definition: ast.Node) -> SymbolScope:
    """Returns the scope of the body of a structure or a definition."""
    if check.is_standard(definition):
        return check.of_standard(body_of, definition)
    return check.resolution.scope_of(definition)


def part(check: Inference, definition: ast.Node, key: str) -> Fact:
    """Returns the fact of a name that a body declares."""
    if check.is_standard(definition):
        return check.of_standard(part, definition, key)
    return of_symbol(check, body_of(check, definition).values[key])


def result(check: Inference, definition: ast.FunctionDefinition) -> tuple[Fact, bool]:
    """Returns the fact of a function's expression, and whether it depends on solved values of arguments."""
    if check.is_standard(definition):
        return check.of_standard(result, definition)
    before, check.homes = check.homes, body_of(check, definition).homes
    try:
        return check.fact(definition.value), _reads_arguments(definition)
    finally:
        check.homes = before


def _reads_arguments(definition: ast.FunctionDefinition) -> bool:
    names = {parameter.name.text for parameter in definition.parameters}
    stack: list[ast.Node] = [definition.value]
    while stack:
        match stack.pop():
            case ast.Name(text) if text in names:
                return True
            case ast.Call(callee=callee) if fold(callee.text) in CONSTANT:
                pass
            case node:
                stack.extend(ast.children(node))
    return False

"""The context of a place: the call around it, the names visible there, and the type wanted."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import Enum
from functools import cached_property
from typing import TypeVar

from aidl_lang.checking import types
from aidl_lang.checking.builtins import CLIP, COPYING, DERIVING, MATH, PATTERNS, STACKING
from aidl_lang.checking.facts import Fact, ReadPlace, of_symbol
from aidl_lang.checking.symbols import UNKNOWNS, Symbol, SymbolKind, SymbolScope
from aidl_lang.checking.units import ANGLE, LENGTH, PLAIN
from aidl_lang.common.records import record
from aidl_lang.syntax import ast
from aidl_lang.tools.vocabulary import vocabulary
from aidl_server.ide.signatures import Reading, readings, type_of
from aidl_server.ide.site import PLACEHOLDER, EditSite
from aidl_server.ide.workspace import View

T = TypeVar("T")
_ATTRIBUTES: dict[str, types.Type] = {
    **dict.fromkeys(("thickness", "depth", "elevation", "stroke", "dash", "halo"), types.NumberType(LENGTH)),
    **dict.fromkeys(("opacity", "quantity"), types.NumberType(PLAIN)),
    "shadow": types.NumberType(LENGTH),
    **dict.fromkeys(STACKING, types.StructureType()),
    CLIP: types.GeometryType(""),
}


class Use(Enum):
    """The statement around an expression, which limits what it may read (language reference: validity)."""

    GEOMETRY = "its own structure, above"
    DERIVING = "whatever stands above"
    CONSTRAINT = "what is in its structure"
    CHECK = "everything"
    CONSTANT = "constants"


@record(eq=False)
class KnownName:
    """A visible name with its symbol and its facts."""

    name: str
    symbol: Symbol
    fact: Fact


@record(eq=False)
class Context:
    """`call` is the call around the place with the number of the argument, the receiver counted."""

    site: EditSite
    view: View
    scope: SymbolScope
    path: tuple[ast.Node, ...]
    call: tuple[ast.Call, int] | None

    @cached_property
    def in_items(self) -> bool:
        """True among constraints."""
        return any(isinstance(n, ast.Constrain | ast.ConstraintDefinition) for n in self.path)

    @cached_property
    def use(self) -> Use:
        statement = next((n for n in reversed(self.path) if isinstance(n, _STATEMENTS)), None)
        match statement:
            case ast.Assert() | ast.Let() | ast.FunctionDefinition():
                return Use.CHECK
            case ast.Param() | ast.Parameter() | ast.If() | ast.For() if not self.in_items:
                return Use.CONSTANT
            case _ if self.in_items or isinstance(statement, _DEMANDS):
                return Use.CONSTRAINT
            case _ if self.call is not None and self.call[0].callee.text in DERIVING | PATTERNS | COPYING:
                return Use.DERIVING
            case _:
                return Use.GEOMETRY

    @cached_property
    def readings(self) -> list[Reading]:
        """The overloads of the call around that fit its arguments so far."""
        if self.call is None:
            return []
        found = readings(self.view.program, self.scope, self.call[0])
        return [r for r in found if r.fits] or found

    @property
    def filled(self) -> Iterator[tuple[Reading, str]]:
        """Yields those that have a parameter for the argument at the place, with it."""
        if self.call is None:
            return
        for reading in self.readings:
            if (name := reading.filled_by(self.call[1])) is not None:
                yield reading, name

    @property
    def is_named(self) -> bool:
        """True in an argument that has a name."""
        argument = self.innermost(ast.Argument)
        return argument is not None and argument.name is not None

    def innermost(self, kind: type[T]) -> T | None:
        return next((node for node in reversed(self.path) if isinstance(node, kind)), None)

    @cached_property
    def wanted(self) -> Wanted:
        return self._wanted(self.path)

    def _wanted(self, path: Sequence[ast.Node]) -> Wanted:
        """Returns the types wanted of the last node of a path."""
        if len(path) < 2:
            return Wanted()
        node, above = path[-1], path[-2]
        match above:
            case ast.Argument() | ast.Unary(operator="-" | "+"):
                return self._of_argument() if isinstance(above, ast.Argument) else self._wanted(path[:-1])
            case ast.Binary(operator="+" | "-", left=left, right=right):
                other = self.view.program.inference.fact(right if node is left else left).type
                return _alike(other) if not isinstance(other, types.AnyType) else self._wanted(path[:-1])
            case ast.Binary(operator="and" | "or") | ast.Unary():
                return CONDITION
            case ast.Binary():
                return Wanted((_NUMBER, types.NumberType(None)))
            case ast.Comparison(operands=operands):
                return self._compared(node, operands)
            case ast.Equation(left=left, right=right):
                return self._compared(node, (left, right))
            case ast.Conditional(test=test):
                return CONDITION if node is test else self._wanted(path[:-1])
            case ast.ArgumentBlock() | ast.ForArguments() if not _is_run_through(node, above):
                return self._wanted(path[:-1])
            case ast.IfArguments(test=test):
                return CONDITION if node is test else self._wanted(path[:-1])
            case ast.List():
                return _member_of(self._wanted(path[:-1]))
            case _:
                return _of_place(node, above, path)

    def _compared(self, node: ast.Node, operands: tuple[ast.Expression, ...]) -> Wanted:
        facts = [self.view.program.inference.fact(o) for o in operands if o is not node]
        known = next((f.type for f in facts if not isinstance(f.type, types.AnyType)), None)
        return _alike(known) if known is not None else Wanted()

    def _of_argument(self) -> Wanted:
        if self.call is None:
            attribute = self.innermost(ast.Attribute)
            if attribute is None:
                return Wanted()
            return Wanted(
                (_ATTRIBUTES.get(attribute.name.text, types.TextType()),), f"@{attribute.name.text}"
            )
        kinds: dict[types.Type, None] = {}
        name = ""
        for reading, taken in self.filled:
            if (kind := type_of(reading.signature, taken)) is None:
                continue
            name = name or taken
            if isinstance(kind, types.ListType) and not self.is_named:
                kinds[kind.element] = None
            kinds[kind] = None
        return Wanted(() if types.ANY in kinds and len(kinds) == 1 else tuple(kinds), name)

    @cached_property
    def values(self) -> list[KnownName]:
        """Returns the names of values visible here, the nearest scope first."""
        check = self.view.program.inference
        check.homes = self.scope.homes
        found = []
        for name, symbol in self.scope.visible().items():
            if name == PLACEHOLDER or name in MATH:
                continue  # a module of another language is named by those who know it
            if (symbol.kind is SymbolKind.BUILTIN and not self._is_here(name)) or self._is_ahead(symbol):
                continue
            known = KnownName(name, symbol, of_symbol(check, symbol))
            if self._may_read(known):
                found.append(known)
        return found

    def _is_here(self, name: str) -> bool:
        """Tells whether a built-in name is visible: one for programs, or one of structures in a structure."""
        words = vocabulary()
        in_structure = any(isinstance(home, ast.Structure) for home in self.scope.homes)
        return name in words.constants or (name in words.everywhere and in_structure)

    def _is_ahead(self, symbol: Symbol) -> bool:
        """True for the name of the statement itself, or one made below if order counts."""
        start = self.site.spot.start
        nodes = [n for n in symbol.nodes if n.span.source is self.view.source]
        if symbol.kind in (SymbolKind.ARGUMENT, SymbolKind.LOOP) or symbol.scope is None or not nodes:
            return False
        if any(n.span.start <= start < n.span.end and not isinstance(n, ast.Structure) for n in nodes):
            return True
        is_ordered = self.use in (Use.GEOMETRY, Use.DERIVING)
        if not is_ordered or symbol.kind not in UNKNOWNS or symbol.is_array:
            return False
        if symbol.scope.homes == self.scope.homes:
            return start < nodes[0].span.end
        return self.use is Use.DERIVING and start < nodes[0].span.start

    def _may_read(self, known: KnownName) -> bool:
        reads, home = known.fact.reads, self.scope.homes[-1]
        match self.use:
            case Use.CHECK:
                return True
            case Use.CONSTANT:
                return not reads
            case Use.CONSTRAINT:
                return all(p.holder is home for p in reads)
            case Use.GEOMETRY:
                own = all(p == ReadPlace(home) for p in reads)
                return own and known.name != "self" and known.symbol is not self.scope.own_name
            case Use.DERIVING:
                return all(p.holder in self.scope.homes for p in reads)

    def called(self, name: str) -> list[types.Signature]:
        """Returns the definitions that a call of a name may mean here; none for another name."""
        found = self.scope.called(name)
        return found[1] if found is not None else []

    def callables(self) -> Iterator[tuple[str, Symbol | None]]:
        """Yields the callable names of this program and its imports, nearest first, with an alias."""
        seen: set[str] = set()
        outermost = self.view.resolution.library_scope
        for scope in self.scope.chain():
            if scope is outermost:
                return
            for name in (*scope.callables, *scope.aliases):
                if name not in seen and name != PLACEHOLDER:
                    seen.add(name)
                    yield name, scope.aliases.get(name)


def context_of(site: EditSite) -> Context | None:
    """Returns the context of a site; None if the place is in no program."""
    if site.view is None or site.scope is None:
        return None
    path = site.path
    if isinstance(path[-1], ast.Identifier) and isinstance(path[-2], ast.Member | ast.Call):
        path = path[:-1]  # the whole expression is what has a wanted type
    return Context(site, site.view, site.scope, path, _call_around(site.view, path))


def _call_around(view: View, path: tuple[ast.Node, ...]) -> tuple[ast.Call, int] | None:
    """Returns the call with the innermost node, or an operation that ends in it, as argument."""
    for number in range(len(path) - 1, 0, -1):
        node, above = path[number], path[number - 1]
        if isinstance(above, ast.Argument):
            continue
        if isinstance(above, ast.Call) and isinstance(node, ast.Argument):
            symbol = view.resolution.uses.get(above.receiver) if above.receiver is not None else None
            is_file = symbol is not None and symbol.kind is SymbolKind.NAMESPACE
            before = int(above.receiver is not None and not is_file)
            return above, before + above.arguments.index(node)
        if not isinstance(above, ast.Unary | ast.Binary | ast.Conditional | ast.List | ast.Point):
            return None
    return None


_DEMANDS = ast.Constrain | ast.ExpressionStatement | ast.Prefer | ast.Equation
_STATEMENTS = ast.Allowing | ast.Structure | ast.Assign | ast.Parameter


_WHOLE = types.NumberType(None, whole=True)
_NUMBER = types.NumberType(LENGTH)
_PERHAPS = 3
"""Distance of an unknown type from the wanted one."""


@record()
class Wanted:
    """The wanted types, likelier first; empty for any. `name` is the parameter to fill."""

    kinds: tuple[types.Type, ...] = ()
    name: str = ""

    def distance(self, given: types.Type) -> int | None:
        """Returns how far a type is from the wanted ones; None if it does not fit, as an unknown one may."""
        if isinstance(given, types.AnyType):
            return _PERHAPS
        found = [d for kind in self.kinds if (d := types.accepts(kind, given)) is not None]
        return min(found) if found else None if self.kinds else 0


CONDITION = Wanted((types.TruthType(),))
"""The type of a condition, which often begins with a value: `a.radius >= 3`."""


def _is_run_through(node: ast.Node, above: ast.Node) -> bool:
    return isinstance(above, ast.For | ast.ForArguments | ast.Comprehension) and node is above.iterable


def _of_place(node: ast.Node, above: ast.Node, path: Sequence[ast.Node]) -> Wanted:
    match above:
        case ast.Point():
            return Wanted((types.NumberType(LENGTH),))
        case ast.Placement(at=at):
            return Wanted((types.PointType() if node is at else types.NumberType(ANGLE),))
        case ast.Membership(container=container) | ast.Param(domain=container) if node is container:
            return Wanted((types.RangeType(), types.ListType(types.ANY)))
        case ast.Range() | ast.Membership():
            return Wanted((_NUMBER, _WHOLE))
        case ast.For() | ast.ForArguments() | ast.Comprehension() if _is_run_through(node, above):
            return Wanted((types.ListType(types.ANY), types.RangeType()))
        case ast.Index() | ast.Structure() | ast.Assign() if (
            node is above.index if isinstance(above, ast.Index) else node in above.indices
        ):
            return Wanted((_WHOLE,))
        case ast.If(test=test) | ast.Assert(test=test) | ast.Prefer(value=test) if node is test:
            return CONDITION
        case ast.Assert():
            return Wanted((types.TextType(),))
        case ast.Prefer():
            return Wanted((types.NumberType(None),))
        case ast.ExpressionStatement():
            return CONDITION
        case ast.Parameter() if (kind := types.parameter_type(above)) is not None:
            return Wanted((kind,))
        case _:
            return Wanted()


def _alike(kind: types.Type) -> Wanted:
    match kind:
        case types.NumberType(dimension):
            return Wanted((types.NumberType(dimension), types.NumberType(None)))
        case types.GeometryType("line"):
            return Wanted((types.NumberType(LENGTH), kind))
        case _:
            return Wanted((kind,))


def _member_of(wanted: Wanted) -> Wanted:
    elements = [kind.element for kind in wanted.kinds if isinstance(kind, types.ListType)]
    known = tuple(kind for kind in elements if not isinstance(kind, types.AnyType))
    if not elements and types.PointType() in wanted.kinds:
        known = (types.NumberType(LENGTH),)
    return Wanted(known, wanted.name)

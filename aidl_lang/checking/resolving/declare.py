"""The step that enters the declarations of a block into its scope, before any of its names is looked up."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias, TypeVar

from aidl_lang.checking.builtins import DERIVING, EVERYWHERE, PATTERNS
from aidl_lang.checking.library import signature
from aidl_lang.checking.resolving import complaints
from aidl_lang.checking.resolving.symbols import UNKNOWNS, SymbolKind, SymbolScope
from aidl_lang.checking.types import PARAMETER_TYPES, PUBLIC
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.names import fold, nearest
from aidl_lang.common.prose import ticked
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.resolve import Resolver

T = TypeVar("T")
Branch: TypeAlias = tuple[tuple[int, bool], ...]
"""The `if`s around a declaration, and which way each has to go for it."""

_MAKERS = DERIVING | PATTERNS | frozenset({"path", *PUBLIC})


def is_definition(node: ast.Node) -> bool:
    """Tells whether a node is a function, shape, constraint or template, which is called."""
    if isinstance(node, ast.Structure):
        return node.parameters is not None
    return isinstance(node, ast.FunctionDefinition | ast.ShapeDefinition | ast.ConstraintDefinition)


def made_by(value: ast.Expression, scope: SymbolScope) -> SymbolKind:
    """Returns the kind of symbol that `name = value` declares: geometry, a structure, an expression."""
    match value:
        case ast.Point():
            return SymbolKind.GEOMETRY
        case ast.Call(callee=callee, receiver=receiver):
            found = scope.space_of(receiver).called(callee.text)
            if found is None:
                return SymbolKind.LET
            name, signatures = found
            kinds = {s.kind for s in signatures}
            if ast.Structure in kinds:
                return SymbolKind.STRUCTURE
            is_maker = ast.ShapeDefinition in kinds or (name in _MAKERS and signatures[0].kind is None)
            return SymbolKind.GEOMETRY if is_maker else SymbolKind.LET
        case ast.Conditional(then=then, otherwise=otherwise):
            kind = made_by(then, scope)
            return kind if kind is not SymbolKind.LET else made_by(otherwise, scope)
        case ast.Comprehension(element=element):
            return made_by(element, scope) if not isinstance(element, ast.Point) else SymbolKind.LET
        case ast.List(items) if items and not isinstance(items[0], ast.Point):
            return made_by(items[0], scope)
        case _:
            return SymbolKind.LET


class Declarer:
    """Enters the declarations of one block: those of its `if`s too, and the indexed ones of its `for`s."""

    def __init__(self, resolver: Resolver, scope: SymbolScope) -> None:
        self.resolver = resolver
        self.scope = scope
        self.branches: dict[str, list[tuple[Branch, tuple[float, ...] | None]]] = {}
        self.is_turn = isinstance(scope.owner, ast.For)

    def run(self, statements: Sequence[ast.Statement]) -> None:
        self._callables(statements)
        self._values(statements, ())

    # --- Callables -----------------------------------------------------------------------------

    def _callables(self, statements: Sequence[ast.Statement]) -> None:
        shapes = {s.name.text for s in statements if isinstance(s, ast.ShapeDefinition)}
        for node in statements:
            match node:
                case ast.If(then=then, otherwise=otherwise):
                    self._callables(then.statements)
                    self._callables(otherwise.statements if otherwise else ())
                case ast.Alias(name):
                    symbol = self.resolver.enter(self.scope, name, SymbolKind.ALIAS, node)
                    self.scope.aliases[name.text] = symbol
                case (
                    ast.FunctionDefinition()
                    | ast.ShapeDefinition()
                    | ast.ConstraintDefinition()
                    | ast.Structure()
                ) if is_definition(node):
                    self._callable(node, shapes)

    def _callable(self, node: ast.Callable, shapes: set[str]) -> None:
        made = signature(node, self._shape_types(node, shapes))
        name = node.name.text
        overloads = self.scope.callables.setdefault(name, [])
        symbol = self.resolver.enter(self.scope, node.name, complaints.kind_of(made), node)
        for other in overloads:
            is_same = [p[:2] for p in made.parameters] == [p[:2] for p in other.parameters]
            if is_same and other.node is not None:
                earlier = self.resolver.resolution.of_definition[other.node]
                complaints.declared_twice(self.resolver, symbol.declarations[0], earlier)
                break
        overloads.append(made)

    def _shape_types(self, node: ast.Callable, shapes: set[str]) -> list[str]:
        """Returns the shapes that stand as types of parameters; reports words that are no type."""
        found: list[str] = []
        for parameter in node.parameters or ():
            word = parameter.type
            if word is None or fold(word.text) in PARAMETER_TYPES:
                continue
            called = self.scope.called(word.text)
            is_shape = called is not None and any(isinstance(s.node, ast.ShapeDefinition) for s in called[1])
            if is_shape or word.text in shapes:
                found.append(word.text)
                continue
            like = nearest(word.text, [*PARAMETER_TYPES, *shapes], 2)
            message = f"`{word.text}` is not a type" + complaints.did_you_mean(like)
            hint = "types are " + ", ".join(ticked(PARAMETER_TYPES)) + " and the names of shapes"
            self.resolver.report("E0215", message, word, hints=(hint,), fix=complaints.respell(word, like))
        return found

    # --- Values --------------------------------------------------------------------------------

    def _values(self, statements: Sequence[ast.Statement], branch: Branch) -> None:
        for node in statements:
            match node:
                case ast.Param(name):
                    self._value(name, SymbolKind.PARAM, node, branch)
                case ast.Let(name):
                    self._value(name, SymbolKind.LET, node, branch)
                case ast.Var(name):
                    self._value(name, SymbolKind.VAR, node, branch)
                case ast.Structure(parameters=None):
                    self._member(node, SymbolKind.STRUCTURE, branch)
                case ast.Assign():
                    self._member(node, made_by(node.value, self.scope), branch)
                case ast.If(then=then, otherwise=otherwise):
                    self._values(then.statements, (*branch, (id(node), True)))
                    if otherwise is not None:
                        self._values(otherwise.statements, (*branch, (id(node), False)))
                case ast.For(variables, _, body) if not self.is_turn:
                    self._indexed(body.statements, branch, {v.text for v in variables})

    def _member(self, node: ast.Structure | ast.Assign, kind: SymbolKind, branch: Branch) -> None:
        if not self.is_turn:
            self._value(node.name, kind, node, branch, node.indices)
            return
        if node.indices:
            return  # entered where its members belong
        if kind is not SymbolKind.LET and not isinstance(getattr(node, "value", None), ast.Point):
            self._needs_index(node)
        self._value(node.name, kind, node, branch)

    def _needs_index(self, node: ast.Structure | ast.Assign) -> None:
        assert isinstance(self.scope.owner, ast.For)
        name, written = node.name, ""
        scope: SymbolScope | None = self.scope
        while scope is not None and isinstance(loop := scope.owner, ast.For):
            written, scope = f"[{loop.variables[0].text}]{written}", scope.parent
        member = name.text + written
        message = f"`{name.text}` is made in every turn of this `for` and needs an index"
        label, hints = "one name for several members", (f"`{member}` gives each turn a member of its own",)
        fix = Fix(f"write `{member}`", (Edit(name.span, member),), is_sure=True)
        self.resolver.report("E0208", message, name, label=label, hints=hints, fix=fix)

    def _indexed(self, statements: Sequence[ast.Statement], branch: Branch, local: set[str]) -> None:
        """Enters what a loop declares for the structure around it; `local` are the names of its turns."""
        named = (s for s in statements if isinstance(s, ast.Let | ast.Assign))
        local = local | {s.name.text for s in named if isinstance(s, ast.Let) or not s.indices}
        for node in statements:
            match node:
                case ast.Assign(indices=indices) | ast.Structure(indices=indices) if indices:
                    kind = SymbolKind.STRUCTURE
                    if isinstance(node, ast.Assign):
                        kind = made_by(node.value, self.scope)
                    if not _mentions(indices, local):
                        self._same_index(node, indices)
                    self._value(node.name, kind, node, branch, indices)
                case ast.For(variables, _, body):
                    self._indexed(body.statements, branch, local | {v.text for v in variables})
                case ast.If(then=then, otherwise=otherwise):
                    self._indexed(then.statements, (*branch, (id(node), True)), local)
                    if otherwise is not None:
                        self._indexed(otherwise.statements, (*branch, (id(node), False)), local)

    def _same_index(self, node: ast.Structure | ast.Assign, indices: Sequence[ast.Expression]) -> None:
        name = node.name.text
        message = f"`{name}` gets the same index in every turn of this `for`"
        label = "does not depend on the loop"
        hint = "let the index depend on the loop variable"
        self.resolver.report("E0208", message, indices[-1], label=label, hints=(hint,))

    def _value(
        self,
        name: ast.Identifier,
        kind: SymbolKind,
        node: ast.Node,
        branch: Branch,
        indices: Sequence[ast.Expression] = (),
    ) -> None:
        if name.text in EVERYWHERE and kind in UNKNOWNS:
            message = f"`{name.text}` belongs to every structure and cannot be declared"
            self.resolver.report("E0209", message, name, hints=("choose another name",))
            return
        known = self.scope.values.get(name.text)
        numbers = tuple(i.value for i in indices if isinstance(i, ast.Number))
        place = numbers if len(numbers) == len(indices) and indices else None
        if known is None:
            symbol = self.resolver.enter(self.scope, name, kind, node)
            symbol.is_array = bool(indices)
            self.scope.values[name.text] = symbol
            self.branches[name.text] = [(branch, place)]
            return
        for other, other_place in self.branches.get(name.text, [((), None)]):
            if not _together(branch, other):
                continue
            if bool(indices) and known.is_array and (place is None or place != other_place):
                continue
            complaints.declared_twice(self.resolver, name, known)
            break
        self.branches.setdefault(name.text, []).append((branch, place))
        self.resolver.resolution.uses[name] = known
        known.declarations.append(name)
        known.nodes.append(node)


def _together(a: Branch, b: Branch) -> bool:
    """Tells whether whatever builds one declaration certainly comes with the other: neither lies in a branch
    of its own. Branches of different `if`s may exclude each other, which only building shows.
    """
    shorter = min(len(a), len(b))
    return a[:shorter] == b[:shorter]


def _mentions(expressions: Sequence[ast.Expression], names: set[str]) -> bool:
    folded = {fold(name) for name in names}
    nodes = (node for expression in expressions for node in ast.walk(expression))
    return any(isinstance(node, ast.Name) and fold(node.text) in folded for node in nodes)

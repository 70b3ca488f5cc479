"""The definition that every name means: scopes, imports, aliases, and diagnostics for unknown names.

The pass works scope by scope, each in two steps. First everything declared in the scope is entered, `if`
branches included (they open no scope) and the indexed members of its `for` loops; callables before values,
because whether `a = f(…)` makes geometry, a structure or only a name for a number depends on what `f` is.
Then the statements are visited in order and each name is looked up from the inside out: as written in every
scope first, then without regard to case and underscores. So callables and constants are visible in their
whole block, and a name of geometry or of an unknown that stands above its declaration is found, and reported
as such.

A constraint, a preference or an assert is read after the whole structure: order does not bind it. The bodies
of `fn`, `shape`, `constraint` and templates run where they are called, so order binds only what they declare.

Members (`a.b`) depend on what `a` is; the type checker decides them and enters them in the same tables.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from aidl_lang.checking.allowing import allowances
from aidl_lang.checking.builtins import ATTRIBUTES, WORDED, is_word
from aidl_lang.checking.library import Library
from aidl_lang.checking.resolving import complaints
from aidl_lang.checking.resolving.complaints import ATTRIBUTES_MEANT, without_idle
from aidl_lang.checking.resolving.declare import Declarer, is_definition, made_by
from aidl_lang.checking.resolving.imports import (
    ImportedModules,
    hole_calls,
    load_imports,
    meant,
    with_inner_imports,
    with_placed_cuts,
)
from aidl_lang.checking.resolving.symbols import (
    UNKNOWNS,
    Resolution,
    Symbol,
    SymbolKind,
    SymbolScope,
    library_scope,
    word_meant,
)
from aidl_lang.checking.types import Signature
from aidl_lang.common.diagnostics import MOST_ERRORS, Diagnostic, Fix, Label, ordered
from aidl_lang.common.drawings import WHOLE
from aidl_lang.common.names import fold, nearest
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.common.world import World


def resolve(module: ast.Module, world: World | None, library: Library) -> Resolution:
    """Finds the meaning of all names in a file and in those it imports. Never raises for what they say."""
    module, misplaced = with_inner_imports(with_placed_cuts(module))
    loaded = load_imports(module, world)
    main, notes = without_idle(module, loaded.modules)
    modules = tuple(main if m is module else m for m in loaded.modules)
    resolution = Resolution(
        main=main,
        library=library,
        modules=modules,
        imports=loaded.targets,
        diagnostics=[*misplaced, *loaded.diagnostics, *notes],
        library_scope=library_scope(library),
        world=world,
        drawings={module.source: drawing for module, drawing in loaded.drawings.items()},
    )
    resolution.enter_library = Resolver(resolution, is_library=True).of_library
    for drawing in loaded.drawings.values():
        resolution.scopes[drawing.module] = drawing.scope(resolution.library_scope)
    for each in modules:
        Resolver(resolution).module(each, loaded)
    resolution.allowances, unknown = allowances(modules)
    resolution.diagnostics = ordered([*resolution.diagnostics, *unknown])
    return resolution


class Resolver:
    """Resolves one file, or one definition of the library, into a shared `Resolution`."""

    def __init__(self, resolution: Resolution, is_library: bool = False) -> None:
        self.resolution = resolution
        self.is_library = is_library
        self.is_ordered = True
        self.argument: ast.Call | None = None
        self.condition: ast.Expression | None = None  # the item of a `constrain` under way
        self.hole_calls: frozenset[ast.Call] = frozenset()

    # --- Files and definitions -----------------------------------------------------------------

    def module(self, module: ast.Module, loaded: ImportedModules) -> None:
        self.hole_calls = hole_calls(module)
        scope = SymbolScope(module, self._imported(module, loaded), (module,))
        self.resolution.scopes[module] = scope
        self._declare(scope, module.statements)
        self._statements(module.statements, scope)
        complaints.check_aliases(self, scope)

    def _imported(self, module: ast.Module, loaded: ImportedModules) -> SymbolScope:
        """Returns the scope of the names that a file imports, which its own definitions hide."""
        scope = SymbolScope(module, self.resolution.library_scope)
        for statement in module.statements:
            if not isinstance(statement, ast.Import):
                continue
            target = loaded.targets.get(statement)
            if target is None:
                _note_missing(statement, scope)
                continue
            source = self.resolution.scopes[target]
            if statement.alias is not None:
                name = statement.alias.text
                symbol = self.enter(scope, statement.alias, SymbolKind.NAMESPACE, statement)
                scope.values[name] = symbol
                scope.spaces[name] = source
                if target in loaded.drawings:
                    scope.callables[name] = source.callables[WHOLE]
                continue
            _bring(source, scope, self._wanted(statement, source, scope) if statement.names else None)
        return scope

    def _wanted(self, statement: ast.Import, source: SymbolScope, scope: SymbolScope) -> set[str]:
        """Returns the names that `import a, b from …` asks for; reports unknown ones."""
        known = [*source.values, *source.callables, *source.aliases]
        for identifier in statement.names:
            if identifier.text not in known:
                like = nearest(identifier.text, known, 2)
                lacking = f"`{statement.path.value}` has no `{identifier.text}`"
                hints = () if like else (complaints.list_of("it defines ", known),)
                fix = complaints.respell(identifier, like)
                message = lacking + complaints.did_you_mean(like)
                self.report("E0213", message, identifier, hints=hints, fix=fix)
                if scope.missing is not None:
                    scope.missing.add(identifier.text)
            elif identifier.text in source.values:
                self.resolution.uses[identifier] = source.values[identifier.text]
        return {identifier.text for identifier in statement.names}

    def of_library(self, node: ast.Node) -> None:
        """Resolves a definition of the library; its mistakes are not reported to the program."""
        self.definition(node, self.resolution.library_scope)

    def definition(self, node: ast.Node, scope: SymbolScope) -> None:
        """Resolves the body of a structure, template, shape, constraint or function."""
        assert isinstance(
            node, ast.Structure | ast.ShapeDefinition | ast.ConstraintDefinition | ast.FunctionDefinition
        )
        homes = (*scope.homes, node)
        inner = SymbolScope(node, scope, homes)
        self.resolution.scopes[node] = inner
        for parameter in node.parameters or ():
            self._parameter(parameter, node, inner)
        if isinstance(node, ast.Structure):
            if node.parameters is not None:
                self._attributes(node.attributes, inner)  # a template's may be its parameters
            kind, name = SymbolKind.STRUCTURE, node.name
            inner.own_name = Symbol(name.text, kind, node, scope.owner, [name], [node])
        before, self.is_ordered = self.is_ordered, True
        if isinstance(node, ast.FunctionDefinition):
            self.expression(node.value, inner)
        else:
            self._declare(inner, node.body.statements)
            self.is_ordered = not isinstance(node, ast.ConstraintDefinition)
            self._statements(node.body.statements, inner)
            if isinstance(node, ast.Structure) and self._is_root(node, scope):
                self._attributes(node.attributes, inner)  # nothing is around it that could be named
            complaints.check_aliases(self, inner)
        self.is_ordered = before

    def _parameter(self, parameter: ast.Parameter, node: ast.Node, scope: SymbolScope) -> None:
        if (earlier := scope.values.get(parameter.name.text)) is not None:
            complaints.declared_twice(self, parameter.name, earlier)
            return
        symbol = self.enter(scope, parameter.name, SymbolKind.ARGUMENT, parameter)
        scope.values[symbol.name] = symbol
        if parameter.default is not None:
            self.expression(parameter.default, scope)

    def _declare(self, scope: SymbolScope, statements: Sequence[ast.Statement]) -> None:
        Declarer(self, scope).run(statements)

    # --- Statements ----------------------------------------------------------------------------

    def _statements(self, statements: Sequence[ast.Statement], scope: SymbolScope) -> None:
        for statement in statements:
            self._statement(statement, scope)

    def _statement(self, node: ast.Statement, scope: SymbolScope) -> None:
        match node:
            case (
                ast.Structure()
                | ast.FunctionDefinition()
                | ast.ShapeDefinition()
                | ast.ConstraintDefinition()
            ):
                self._definition_statement(node, scope)
            case ast.Assign():
                self._attributes(node.attributes, scope)
                self._indices(node.indices, scope)
                self.expression(node.value, scope)
                self._placement(node.placement, scope)
            case ast.Var(value=value):
                self.expression(value, scope)
            case ast.Constrain(items):
                self._later(items, scope)
            case ast.Equation(ast.Name(name) as left, right) if scope.value(name) is None:
                self._unordered(scope, right)
                complaints.no_declaration(self, left, made_by(right, scope) is SymbolKind.LET)
            case ast.ExpressionStatement(value=value):
                self.condition = None if self.is_ordered else value
                self._unordered(scope, value)
            case ast.For():
                self._for(node, scope)
            case ast.If(test, then, otherwise):
                self.expression(test, scope)
                self._statements(then.statements, scope)
                self._statements(otherwise.statements if otherwise else (), scope)
            case ast.Import() | ast.Alias() | ast.Todo():
                pass
            case _:  # constants and conditions are not bound by order
                self._unordered(scope, *ast.children(node))

    def _definition_statement(self, node: ast.Callable, scope: SymbolScope) -> None:
        if isinstance(node, ast.Structure):
            self._indices(node.indices, scope)
            self._placement(node.placement, scope)
            if node.parameters is None and not self._is_root(node, scope):
                self._attributes(node.attributes, scope)
        self.definition(node, scope)

    @staticmethod
    def _is_root(node: ast.Structure, scope: SymbolScope) -> bool:
        return node.parameters is None and isinstance(scope.owner, ast.Module)

    def _for(self, node: ast.For, scope: SymbolScope) -> None:
        self.expression(node.iterable, scope)
        inner = self._loop(node, node.variables, scope)
        self._declare(inner, node.body.statements)
        self._statements(node.body.statements, inner)

    def _loop(self, node: ast.Node, variables: Sequence[ast.Identifier], scope: SymbolScope) -> SymbolScope:
        inner = SymbolScope(node, scope, scope.homes)
        self.resolution.scopes[node] = inner
        for variable in variables:
            inner.values[variable.text] = self.enter(inner, variable, SymbolKind.LOOP, node)
        return inner

    def _later(self, block: ast.Block, scope: SymbolScope) -> None:
        """Resolves statements that are read after the whole structure. Their declarations are their own."""
        before, self.is_ordered = self.is_ordered, False
        inner = SymbolScope(block, scope, scope.homes)
        self.resolution.scopes[block] = inner
        for item in block.statements:
            if isinstance(item, ast.Let):
                inner.values[item.name.text] = self.enter(inner, item.name, SymbolKind.LET, item)
        self._statements(block.statements, inner)
        self.is_ordered = before

    def _unordered(self, scope: SymbolScope, *expressions: ast.Node) -> None:
        before, self.is_ordered = self.is_ordered, False
        for expression in expressions:
            self.expression(expression, scope)
        self.is_ordered = before

    def _indices(self, indices: Sequence[ast.Expression], scope: SymbolScope) -> None:
        for index in indices:
            self.expression(index, scope)

    def _placement(self, placement: ast.Placement | None, scope: SymbolScope) -> None:
        if placement is not None:
            for part in (placement.at, placement.rotated):
                if part is not None:
                    self.expression(part, scope)

    def _attributes(self, attributes: Sequence[ast.Attribute], scope: SymbolScope) -> None:
        for attribute in attributes:
            name = attribute.name.text
            other, hint = "", ""
            if word_meant(name, ATTRIBUTES) is None:
                other, hint = ATTRIBUTES_MEANT.get(fold(name), ("", ""))
                like = [other] if other else nearest(name, [a for a in ATTRIBUTES if a != "colour"], 2)
                hint = hint or complaints.list_of("attributes are ", ATTRIBUTES, "@")
                respell, at = complaints.respell, attribute.name
                fix = complaints.renamed(at, other) if other else respell(at, like)
                message = f"there is no attribute `@{name}`" + complaints.did_you_mean(like, "@")
                self.report("E0204", message, at, hints=() if like else (hint,), fix=fix)
            for argument in attribute.arguments if word_meant(name, (ast.ALLOW,)) is None else ():
                value = argument.value
                # `@orientation(front)`, even if a part has that name
                symbol = scope.value(value.text) if isinstance(value, ast.Name) else None
                is_bare = isinstance(value, ast.Name) and (symbol is None or symbol.kind in UNKNOWNS)
                if not (is_bare and word_meant(other or name, WORDED)):
                    self._unordered(scope, value)

    # --- Expressions ---------------------------------------------------------------------------

    def expression(self, node: ast.Node, scope: SymbolScope) -> None:
        match node:
            case ast.Number() | ast.String() | ast.Boolean() | ast.Identifier():
                pass
            case ast.Name():
                self._name(node, scope)
            case ast.Call():
                self._call(node, scope)
            case ast.Comprehension(element, variables, iterable, condition):
                self.expression(iterable, scope)
                inner = self._loop(node, variables, scope)
                if condition is not None:
                    self.expression(condition, inner)
                self.expression(element, inner)
            case ast.ForArguments(variables, iterable, body):
                self.expression(iterable, scope)
                self._argument_block(body, self._loop(node, variables, scope))
            case ast.IfArguments(test, then, otherwise):
                self.expression(test, scope)
                for block in (then, otherwise):
                    if block is not None:
                        self._argument_block(block, scope)
            case _:
                for child in ast.children(node):
                    self.expression(child, scope)

    def _argument_block(self, block: ast.ArgumentBlock, scope: SymbolScope) -> None:
        inner = SymbolScope(block, scope, scope.homes)
        self.resolution.scopes[block] = inner
        lets = [item for item in block.items if isinstance(item, ast.Let)]
        for let in lets:
            if (earlier := inner.values.get(let.name.text)) is not None:
                complaints.declared_twice(self, let.name, earlier)
            else:
                inner.values[let.name.text] = self.enter(inner, let.name, SymbolKind.LET, let)
        for item in block.items:
            self.expression(item.value if isinstance(item, ast.Let) else item, inner)

    def _name(self, node: ast.Name, scope: SymbolScope) -> None:
        symbol = scope.value(node.text)
        if symbol is None:
            complaints.unknown_name(self, node, scope)
            return
        self.resolution.uses[node] = symbol
        if symbol.name != node.text:
            self.resolution.canonical[node] = symbol.name
        if self.is_ordered:
            complaints.check_order(self, node, symbol, scope)

    def _call(self, node: ast.Call, scope: SymbolScope) -> None:
        callee = node.callee
        where = scope.space_of(node.receiver)
        if node.receiver is not None:
            self.expression(node.receiver, scope)
        found = where.called(callee.text)
        if _is_of_missing(node, scope):
            pass
        elif found is None:
            complaints.unknown_callable(self, node, where)
        else:
            name, signatures = found[0], meant(found[1], node in self.hole_calls)
            self.resolution.candidates[node] = tuple(signatures)
            self.resolution.uses[node] = self._callable(signatures[0])
            if name != callee.text:
                self.resolution.canonical[callee] = name
        before, self.argument = self.argument, node
        candidates = self.resolution.candidates.get(node, ())
        for argument in node.arguments:
            if not is_word(argument, candidates) or self._is_in_reach(argument.value, scope):
                self.expression(argument.value, scope)
        self.argument = before

    def _is_in_reach(self, node: ast.Expression, scope: SymbolScope) -> bool:
        """Tells whether a word for an option is here a name that the program declares."""
        if self.is_library or not isinstance(node, ast.Name):
            return False
        symbol = scope.value(node.text)
        if symbol is None or symbol.name != node.text:
            return False
        return not (self.is_ordered and complaints.is_below(node, symbol, scope))

    def _callable(self, signature: Signature) -> Symbol:
        if signature.node is None:
            return Symbol(signature.name, SymbolKind.BUILTIN)
        known = self.resolution.of_definition.get(signature.node)
        if known is None:
            name = signature.node.name
            known = Symbol(
                signature.name, complaints.kind_of(signature), signature.node, None, [name], [signature.node]
            )
            self.resolution.of_definition[signature.node] = known
        return known

    # --- Declarations --------------------------------------------------------------------------

    def enter(self, scope: SymbolScope, name: ast.Identifier, kind: SymbolKind, node: ast.Node) -> Symbol:
        """Makes a symbol; the caller puts it into the table it belongs to."""
        symbol = Symbol(name.text, kind, node, scope.owner, [name], [node], scope=scope)
        self.resolution.uses[name] = symbol
        if not self.is_library:
            self.resolution.symbols.append(symbol)
        if is_definition(node):
            self.resolution.of_definition[node] = symbol
        return symbol

    def report(
        self,
        code: str,
        message: str,
        node: ast.Node,
        label: str = "",
        secondary: Sequence[Label] = (),
        hints: Sequence[str] = (),
        fix: Fix | None = None,
    ) -> None:
        if self.is_library or self.has_said_enough:
            return
        found = Diagnostic(code, message, node.span, label, tuple(secondary), tuple(hints), fix)
        self.resolution.diagnostics.append(found)
        self.resolution.errors += found.is_error

    @property
    def has_said_enough(self) -> bool:
        """True if there are more errors than will be reported, so that no more need be looked for."""
        return self.resolution.errors > MOST_ERRORS


def _is_of_missing(node: ast.Call, scope: SymbolScope) -> bool:
    """Tells whether a call names a file that could not be imported, so that nothing is known of it."""
    of = node.receiver
    return isinstance(of, ast.Name) and scope.value(of.text) is None and scope.may_be_missing(of.text)


def _note_missing(statement: ast.Import, scope: SymbolScope) -> None:
    """Notes the names that a failed import would have brought, so that they are not reported once more."""
    lost = {identifier.text for identifier in statement.names}
    if statement.alias is not None:
        lost = {statement.alias.text}
    scope.missing = scope.missing | lost if lost and scope.missing is not None else None


def _bring(source: SymbolScope, scope: SymbolScope, names: set[str] | None) -> None:
    """Enters the file-level definitions of an imported file, all or some of them."""
    for name, symbol in source.values.items():
        if (names is None or name in names) and symbol.kind in (SymbolKind.PARAM, SymbolKind.LET):
            scope.values.setdefault(name, symbol)
    for name, signatures in source.callables.items():
        if names is None or name in names:
            known = scope.callables.setdefault(name, [])
            known += [s for s in signatures if s not in known]
    for name, alias in source.aliases.items():
        if names is None or name in names:
            scope.aliases.setdefault(name, alias)

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
from functools import partial
from typing import TypeAlias, TypeVar

from aidl_lang.checking import complaints
from aidl_lang.checking.builtins import ATTRIBUTES, CLIP, DERIVING, EVERYWHERE, PATTERNS, WORDED, is_word
from aidl_lang.checking.complaints import ATTRIBUTES_MEANT, without_idle
from aidl_lang.checking.imports import (
    ImportedModules,
    hole_calls,
    load_imports,
    meant,
    with_inner_imports,
    with_placed_cuts,
)
from aidl_lang.checking.library import Library, signature
from aidl_lang.checking.symbols import (
    UNKNOWNS,
    Resolution,
    Symbol,
    SymbolKind,
    SymbolScope,
    allowances,
    library_scope,
    word_meant,
)
from aidl_lang.checking.types import PARAMETER_TYPES, PUBLIC, Signature, type_named
from aidl_lang.common.diagnostics import MOST_ERRORS, Diagnostic, Edit, Fix, Label, ordered
from aidl_lang.common.names import fold, nearest
from aidl_lang.common.prose import ticked
from aidl_lang.common.world import WHOLE, World
from aidl_lang.syntax import ast


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
    in_library = Resolver(resolution, is_library=True)  # whose mistakes are not reported to the program
    resolution.enter_library = partial(in_library.definition, scope=resolution.library_scope)
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
            if (target := loaded.targets.get(statement)) is None:
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

    def definition(self, node: ast.Node, scope: SymbolScope) -> None:
        """Resolves the body of a structure, template, shape, constraint or function."""
        assert isinstance(node, ast.Callable)
        homes = (*scope.homes, node)
        inner = SymbolScope(node, scope, homes)
        self.resolution.scopes[node] = inner
        for parameter in node.parameters or ():
            self._parameter(parameter, node, inner)
        if isinstance(node, ast.Structure):
            if node.parameters is not None:  # a template's may be its parameters
                self._attributes([a for a in node.attributes if not _is_clip(a)], inner)
            kind, name = SymbolKind.STRUCTURE, node.name
            inner.own_name = Symbol(name.text, kind, node, scope.owner, [name], [node])
        before, self.is_ordered = self.is_ordered, True
        if isinstance(node, ast.FunctionDefinition):
            self.expression(node.value, inner)
        else:
            self._declare(inner, node.body.statements)
            self.is_ordered = not isinstance(node, ast.ConstraintDefinition)
            self._statements(node.body.statements, inner)
            if isinstance(node, ast.Structure):
                # a clip is read inside its structure; around the root there is nothing that could be named
                is_root = node.parameters is None and isinstance(scope.owner, ast.Module)
                self._attributes([a for a in node.attributes if is_root or _is_clip(a)], inner)
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
        if isinstance(node, ast.Callable):
            self._definition_statement(node, scope)
            return
        match node:
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
            if node.parameters is None and not isinstance(scope.owner, ast.Module):
                self._attributes([a for a in node.attributes if not _is_clip(a)], scope)
        self.definition(node, scope)

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
        if (symbol := scope.value(node.text)) is None:
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
        if (known := self.resolution.of_definition.get(signature.node)) is None:
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
        if ast.is_definition(node):
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


def _is_clip(attribute: ast.Attribute) -> bool:
    return word_meant(attribute.name.text, (CLIP,)) is not None


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


# --- The step that enters the declarations of a block into its scope, before any of its names is looked up.

T = TypeVar("T")
Branch: TypeAlias = tuple[tuple[int, bool], ...]
"""The `if`s around a declaration, and which way each has to go for it."""

_MAKERS = DERIVING | PATTERNS | frozenset({"path", *PUBLIC})


def made_by(value: ast.Expression, scope: SymbolScope) -> SymbolKind:
    """Returns the kind of symbol that `name = value` declares: geometry, a structure, an expression."""
    match value:
        case ast.Point():
            return SymbolKind.GEOMETRY
        case ast.Call(callee=callee, receiver=receiver):
            if (found := scope.space_of(receiver).called(callee.text)) is None:
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
                case _ if ast.is_definition(node):
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
            if word is None or type_named(word.text) is not None:
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

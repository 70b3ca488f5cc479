"""Which definition every name means: scopes, imports, aliases, and what to say of a name that is not known.

The pass works scope by scope, each in two steps. First everything declared in the scope is entered, `if` branches
included (they open no scope) and the indexed members of its `for` loops; callables before values, because whether
`a = f(…)` makes geometry, a structure or only a name for a number depends on what `f` is. Then the statements
are visited in order and each name is looked up from the inside out: as written in every scope first, then without
regard to case and underscores. So callables and constants are visible in their whole block, and a name of geometry
or of an unknown that stands above its declaration is found, and reported as such.

A constraint, a preference or an assert is read after the whole structure: order does not bind it. The bodies of
`fn`, `shape`, `constraint` and templates run where they are called, so order binds only what they declare.

Members (`a.b`) depend on what `a` is; the type checker decides them and enters them in the same tables.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from aidl_lang import ast
from aidl_lang.builtins import SIGNATURES
from aidl_lang.diagnostics import Diagnostic, Edit, Fix, Label, ordered
from aidl_lang.library import Library
from aidl_lang.names import nearest
from aidl_lang.resolving.declare import Declarer, is_definition, outer_name
from aidl_lang.resolving.imports import ImportedModules, load_imports
from aidl_lang.resolving.symbols import UNKNOWNS, Scope, Symbol, SymbolKind
from aidl_lang.source import SourceFile, Span
from aidl_lang.types import Signature

if TYPE_CHECKING:
    from aidl_lang.world import World

_NOWHERE = ast.Module(SourceFile("built in", ""), (), (), span=Span(SourceFile("built in", ""), 0, 0))

BUILTIN_NAMES = ("self", "origin", "x_axis", "y_axis", "pi")
WORDS = frozenset(
    ["x", "y", "left", "right", "center", "top", "bottom", "middle", "horizontal", "vertical", "horizontally", "vertically", "both", "width", "height"]
)
"""Words that may stand bare as an argument (`axis: x`, `align: left`) where no value has the name."""

ATTRIBUTES = ("orientation", "color", "layer", "thickness", "material", "detached", "note")


@dataclass(eq=False)
class Resolution:
    """
    main         the file that is compiled
    modules      it and every file it imports, the imported before those that import them
    uses         names, calls, arguments' targets and (after type checking) members → what they mean
    candidates   calls → the overloads to choose from, innermost first
    symbols      every declaration of the program, in text order
    canonical    names → the spelling the printer shall write
    scopes       structures, definitions, loops, comprehensions and files → their scopes
    """

    main: ast.Module
    library: Library
    modules: tuple[ast.Module, ...] = ()
    imports: Mapping[ast.Import, ast.Module] = field(default_factory=dict)
    uses: dict[ast.Node, Symbol] = field(default_factory=dict)
    candidates: dict[ast.Call, tuple[Signature, ...]] = field(default_factory=dict)
    symbols: list[Symbol] = field(default_factory=list)
    canonical: dict[ast.Node, str] = field(default_factory=dict)
    scopes: dict[ast.Node, Scope] = field(default_factory=dict)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    of_definition: dict[ast.Node, Symbol] = field(default_factory=dict)
    library_scope: Scope = field(default_factory=lambda: Scope(_NOWHERE))

    def scope_of(self, definition: ast.Node) -> Scope:
        """The scope of a definition's body; one of the library is resolved when it is first asked for."""
        if definition not in self.scopes:
            quiet = Resolver(self, is_library=True)
            quiet.definition(definition, self.library_scope)
        return self.scopes[definition]


def resolve(module: ast.Module, world: World | None, library: Library) -> Resolution:
    """Find what every name of a file, and of the files it imports, means. Never raises for what they say."""
    loaded = load_imports(module, world)
    resolution = Resolution(
        main=module,
        library=library,
        modules=loaded.modules,
        imports=loaded.targets,
        diagnostics=list(loaded.diagnostics),
        library_scope=_library_scope(library),
    )
    for each in loaded.modules:
        Resolver(resolution).module(each, loaded)
    resolution.diagnostics = ordered(resolution.diagnostics)
    return resolution


def _library_scope(library: Library) -> Scope:
    """The outermost scope: what is built in and what the library defines."""
    scope = Scope(_NOWHERE)
    scope.callables = _Joined(SIGNATURES, library.callables)
    for name, target in library.aliases.items():
        identifier = ast.Identifier(target, span=_NOWHERE.span)
        alias = ast.Alias(ast.Identifier(name, span=_NOWHERE.span), identifier, None, span=_NOWHERE.span)
        scope.aliases[name] = Symbol(name, SymbolKind.ALIAS, alias)
    for name in library.constants:
        scope.values[name] = Symbol(name, SymbolKind.BUILTIN)
    for name in BUILTIN_NAMES:
        scope.values.setdefault(name, Symbol(name, SymbolKind.BUILTIN))
    return scope


class _Joined(dict[str, list[Signature]]):
    """Built-in and library overloads under one name, joined when they are asked for: a library definition is
    decoded only then.
    """

    def __init__(self, *tables: Mapping[str, tuple[Signature, ...]]) -> None:
        super().__init__(dict.fromkeys((name for table in tables for name in table), []))
        self._tables = tables
        self._joined: dict[str, list[Signature]] = {}

    def __getitem__(self, name: str) -> list[Signature]:
        if name not in self._joined:
            self._joined[name] = [s for table in self._tables if name in table for s in table[name]]
        return self._joined[name]

    def get(self, name: str, default: object = None) -> object:  # type: ignore[override]
        return self[name] if name in self else default


class Resolver:
    """Resolves one file, or one definition of the library, into a shared `Resolution`."""

    def __init__(self, resolution: Resolution, is_library: bool = False) -> None:
        self.resolution = resolution
        self.is_library = is_library
        self.is_ordered = True
        self.argument: ast.Call | None = None

    # --- Files and definitions -----------------------------------------------------------------

    def module(self, module: ast.Module, loaded: ImportedModules) -> None:
        scope = Scope(module, self._imported(module, loaded), (module,))
        self.resolution.scopes[module] = scope
        self._declare(scope, module.statements)
        self._statements(module.statements, scope)
        self._check_aliases(scope)

    def _imported(self, module: ast.Module, loaded: ImportedModules) -> Scope:
        """The scope of what a file imports, which its own definitions hide."""
        scope = Scope(module, self.resolution.library_scope)
        for statement in module.statements:
            if not isinstance(statement, ast.Import) or (target := loaded.targets.get(statement)) is None:
                continue
            if (source := self.resolution.scopes.get(target)) is None:
                continue  # part of a cycle, which was reported
            if statement.alias is not None:
                name = statement.alias.text
                symbol = self._enter(scope, statement.alias, SymbolKind.NAMESPACE, statement)
                scope.values[name] = symbol
                scope.spaces[name] = source
                continue
            names = None
            if statement.names:
                names = self._wanted(statement, source)
            _bring(source, scope, names)
        return scope

    def _wanted(self, statement: ast.Import, source: Scope) -> set[str]:
        """The names that `import a, b from …` asks for; unknown ones are reported."""
        known = [*source.values, *source.callables, *source.aliases]
        for identifier in statement.names:
            if identifier.text not in known:
                like = nearest(identifier.text, known)
                self._report(
                    "E0213",
                    f"`{statement.path.value}` has no `{identifier.text}`" + _did_you_mean(like),
                    identifier,
                    hints=() if like else (_list_of("it defines ", known),),
                    fix=_respell(identifier, like),
                )
            elif identifier.text in source.values:
                self.resolution.uses[identifier] = source.values[identifier.text]
        return {identifier.text for identifier in statement.names}

    def definition(self, node: ast.Node, scope: Scope) -> None:
        """The body of a structure, template, shape, constraint or function."""
        assert isinstance(
            node, ast.Structure | ast.ShapeDefinition | ast.ConstraintDefinition | ast.FunctionDefinition
        )
        homes = (*scope.homes, node)
        inner = Scope(node, scope, homes)
        self.resolution.scopes[node] = inner
        for parameter in node.parameters or ():
            self._parameter(parameter, node, inner)
        if isinstance(node, ast.Structure):
            inner.own_name = Symbol(
                node.name.text, SymbolKind.STRUCTURE, node, scope.owner, [node.name], [node]
            )
        before, self.is_ordered = self.is_ordered, True
        if isinstance(node, ast.FunctionDefinition):
            self.expression(node.value, inner)
        else:
            self._declare(inner, node.body.statements)
            self.is_ordered = not isinstance(node, ast.ConstraintDefinition)
            self._statements(node.body.statements, inner)
            self._check_aliases(inner)
        self.is_ordered = before

    def _parameter(self, parameter: ast.Parameter, node: ast.Node, scope: Scope) -> None:
        if (earlier := scope.values.get(parameter.name.text)) is not None:
            self._declared_twice(parameter.name, earlier)
            return
        symbol = self._enter(scope, parameter.name, SymbolKind.ARGUMENT, parameter)
        scope.values[symbol.name] = symbol
        if parameter.default is not None:
            self.expression(parameter.default, scope)

    def _declare(self, scope: Scope, statements: Sequence[ast.Statement]) -> None:
        Declarer(self, scope).run(statements)

    # --- Statements ----------------------------------------------------------------------------

    def _statements(self, statements: Sequence[ast.Statement], scope: Scope) -> None:
        for statement in statements:
            self._statement(statement, scope)

    def _statement(self, node: ast.Statement, scope: Scope) -> None:
        match node:
            case ast.Structure(parameters=None):
                self._indices(node.indices, scope)
                self._placement(node.placement, scope)
                self._attributes(node.attributes, scope)
                self.definition(node, scope)
            case (
                ast.Structure()
                | ast.FunctionDefinition()
                | ast.ShapeDefinition()
                | ast.ConstraintDefinition()
            ):
                if isinstance(node, ast.Structure):
                    self._attributes(node.attributes, scope)
                self.definition(node, scope)
            case ast.Assign():
                self._attributes(node.attributes, scope)
                self._indices(node.indices, scope)
                self.expression(node.value, scope)
                self._placement(node.placement, scope)
            case ast.Let(value=value):
                self._unordered(scope, value)
            case ast.Param(value=value, domain=domain, step=step):
                self._unordered(scope, value, domain, step)
            case ast.Var(value=value):
                self.expression(value, scope)
            case ast.ExpressionStatement(value) | ast.Prefer(value, None):
                self._unordered(scope, value)
            case ast.Constrain(items):
                self._later(items, scope)
            case ast.Equation(left, right):
                self._unordered(scope, left, right)
            case ast.Prefer(value, weight):
                self._unordered(scope, value, weight)
            case ast.Assert(test, message):
                self._unordered(scope, test, message)
            case ast.For():
                self._for(node, scope)
            case ast.If(test, then, otherwise):
                self.expression(test, scope)
                self._statements(then.statements, scope)
                if otherwise is not None:
                    self._statements(otherwise.statements, scope)
            case _:
                pass

    def _for(self, node: ast.For, scope: Scope) -> None:
        self.expression(node.iterable, scope)
        inner = self._loop(node, node.variables, scope)
        self._declare(inner, node.body.statements)
        self._statements(node.body.statements, inner)

    def _loop(self, node: ast.Node, variables: Sequence[ast.Identifier], scope: Scope) -> Scope:
        inner = Scope(node, scope, scope.homes)
        self.resolution.scopes[node] = inner
        for variable in variables:
            inner.values[variable.text] = self._enter(inner, variable, SymbolKind.LOOP, node)
        return inner

    def _later(self, block: ast.Block, scope: Scope) -> None:
        """Statements read after the whole structure. What they declare is their own."""
        before, self.is_ordered = self.is_ordered, False
        inner = Scope(block, scope, scope.homes)
        self.resolution.scopes[block] = inner
        for item in block.statements:
            if isinstance(item, ast.Let):
                inner.values[item.name.text] = self._enter(inner, item.name, SymbolKind.LET, item)
        self._statements(block.statements, inner)
        self.is_ordered = before

    def _unordered(self, scope: Scope, *expressions: ast.Expression | None) -> None:
        before, self.is_ordered = self.is_ordered, False
        for expression in expressions:
            if expression is not None:
                self.expression(expression, scope)
        self.is_ordered = before

    def _indices(self, indices: Sequence[ast.Expression], scope: Scope) -> None:
        for index in indices:
            self.expression(index, scope)

    def _placement(self, placement: ast.Placement | None, scope: Scope) -> None:
        if placement is not None:
            for part in (placement.at, placement.rotated):
                if part is not None:
                    self.expression(part, scope)

    def _attributes(self, attributes: Sequence[ast.Attribute], scope: Scope) -> None:
        for attribute in attributes:
            name = attribute.name.text
            if outer_name(name, ATTRIBUTES) is None:
                like = nearest(name, ATTRIBUTES)
                self._report(
                    "E0204",
                    f"`@{name}` XX" + _did_you_mean(like, "@"),
                    attribute.name,
                    hints=() if like else (_list_of("attributes are ", ATTRIBUTES, "@"),),
                    fix=_respell(attribute.name, like),
                )
            for argument in attribute.arguments:
                if not isinstance(argument.value, ast.Name):  # `@orientation(front)`: a word
                    self.expression(argument.value, scope)
                elif scope.value(argument.value.text) is not None:
                    self._name(argument.value, scope)

    # --- Expressions ---------------------------------------------------------------------------

    def expression(self, node: ast.Node, scope: Scope) -> None:
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
            case _:
                for child in ast.children(node):
                    self.expression(child, scope)

    def _name(self, node: ast.Name, scope: Scope) -> None:
        symbol = scope.value(node.text)
        if symbol is None:
            self._unknown_name(node, scope)
            return
        self.resolution.uses[node] = symbol
        if symbol.name != node.text:
            self.resolution.canonical[node] = symbol.name
        if self.is_ordered and symbol.kind in UNKNOWNS and symbol.node is not None:
            self._check_order(node, symbol, scope)

    def _check_order(self, node: ast.Name, symbol: Symbol, scope: Scope) -> None:
        """Geometry and unknowns exist from their line on. What another structure declares is judged by validity."""
        if symbol.scope is None or symbol.scope.homes != scope.homes or symbol.is_array:
            return
        assert symbol.node is not None
        here, place = node.span, symbol.node.span
        if here.source is place.source and here.start < place.end:
            inside = here.start >= place.start
            self._report(
                "E0205",
                f"`{symbol.name}` is used in its own definition"
                if inside
                else f"`{symbol.name}` is used above the line that makes it",
                node,
                label="not there yet",
                secondary=() if inside else (Label(symbol.declarations[0].span, "made here"),),
                hints=(
                    "write a first guess here, and the relation in `constrain { }`, which is read after everything",
                ),
            )

    def _unknown_name(self, node: ast.Name, scope: Scope) -> None:
        name = node.text
        if self.argument is not None and outer_name(name, WORDS) is not None:
            self.resolution.uses[node] = Symbol(name, SymbolKind.WORD)
            return
        called = scope.called(name)
        if called is not None:
            kind = _kind_of(called[1][0])
            self._report(
                "E0206",
                f"`{name}` is a {kind} and has to be called: `{name}(…)`",
                node,
                label="a name alone means a value",
            )
            return
        like = scope.near_values(name)
        hints: tuple[str, ...] = ()
        if not like:
            hints = ("names are declared with `param`, `let` or `name = …`",)
        declared = scope.value(like[0]) if like else None
        secondary = (
            (Label(declared.declarations[0].span, "declared here"),)
            if declared and declared.declarations
            else ()
        )
        self._report(
            "E0201",
            f"there is no `{name}` here" + _did_you_mean(like),
            node,
            label="not declared",
            secondary=secondary,
            hints=hints,
            fix=_respell(node, like),
        )

    def _call(self, node: ast.Call, scope: Scope) -> None:
        callee = node.callee
        where = scope
        if node.receiver is not None:
            space = scope.value(node.receiver.text) if isinstance(node.receiver, ast.Name) else None
            if space is not None and space.kind is SymbolKind.NAMESPACE:
                assert isinstance(node.receiver, ast.Name) and space.scope is not None
                self.resolution.uses[node.receiver] = space
                where = space.scope.spaces[space.name]
            else:
                self.expression(node.receiver, scope)
        found = where.called(callee.text)
        if found is None:
            self._unknown_callable(node, where)
        else:
            name, signatures = found
            self.resolution.candidates[node] = tuple(signatures)
            self.resolution.uses[node] = self._callable(signatures[0])
            if name != callee.text:
                self.resolution.canonical[callee] = name
        before, self.argument = self.argument, node
        for argument in node.arguments:
            self.expression(argument.value, scope)
        self.argument = before

    def _callable(self, signature: Signature) -> Symbol:
        if signature.node is None:
            return Symbol(signature.name, SymbolKind.BUILTIN)
        known = self.resolution.of_definition.get(signature.node)
        if known is None:
            name = signature.node.name
            known = Symbol(
                signature.name, _kind_of(signature), signature.node, None, [name], [signature.node]
            )
            self.resolution.of_definition[signature.node] = known
        return known

    def _unknown_callable(self, node: ast.Call, scope: Scope) -> None:
        name = node.callee.text
        value = scope.value(name)
        if value is not None and value.kind is not SymbolKind.BUILTIN:
            declared = (Label(value.declarations[0].span, "declared here"),) if value.declarations else ()
            hint = f"`{name}` alone names it"
            if isinstance(value.node, ast.Structure):
                hint = f"with a parameter list, `{value.node.kind} {name}() {{ … }}`, it is a template to be called"
            self._report(
                "E0206",
                f"`{name}` is a {value.kind} and cannot be called",
                node.callee,
                secondary=declared,
                hints=(hint,),
            )
            return
        like = nearest(name, scope.callable_names())
        hints = () if like else ("define it with `fn`, `shape`, `constraint` or as a template",)
        self._report(
            "E0203",
            f"there is no function, shape or constraint `{name}`" + _did_you_mean(like),
            node.callee,
            hints=hints,
            fix=_respell(node.callee, like),
        )

    # --- Declarations --------------------------------------------------------------------------

    def _enter(self, scope: Scope, name: ast.Identifier, kind: SymbolKind, node: ast.Node) -> Symbol:
        """A new symbol; the caller puts it into the table it belongs to."""
        symbol = Symbol(name.text, kind, node, scope.owner, [name], [node], scope=scope)
        self.resolution.uses[name] = symbol
        if not self.is_library:
            self.resolution.symbols.append(symbol)
        if is_definition(node):
            self.resolution.of_definition[node] = symbol
        return symbol

    def _declared_twice(self, name: ast.Identifier, earlier: Symbol) -> None:
        self._report(
            "E0209",
            f"`{name.text}` is declared twice",
            name,
            secondary=(Label(earlier.declarations[0].span, "declared here"),),
            hints=(
                "give one of them another name, or give both an index to make an array: "
                f"`{name.text}[0]`, `{name.text}[1]`",
            ),
        )

    def _check_aliases(self, scope: Scope) -> None:
        """An alias has to lead to something that can be called."""
        for symbol in scope.aliases.values():
            assert isinstance(symbol.node, ast.Alias)
            target = symbol.node.target
            if symbol.owner is not scope.owner or scope.called(symbol.name) is not None:
                continue
            trail = [symbol.name]
            while (step := scope.aliases.get(trail[-1])) is not None and isinstance(step.node, ast.Alias):
                trail.append(step.node.target.text)
                if trail[-1] in trail[:-1]:
                    break
            if len(trail) > 1 and trail[-1] in trail[:-1]:
                self._report(
                    "E0207",
                    f"the alias `{symbol.name}` stands for itself: {' → '.join(trail)}",
                    target,
                    hints=("let one of them name a function, shape, constraint or template",),
                )
                continue
            like = nearest(target.text, [n for n in scope.callable_names() if n != symbol.name])
            self._report(
                "E0203",
                f"there is no function, shape or constraint `{target.text}`" + _did_you_mean(like),
                target,
                fix=_respell(target, like),
            )

    def _report(
        self,
        code: str,
        message: str,
        node: ast.Node,
        label: str = "",
        secondary: Sequence[Label] = (),
        hints: Sequence[str] = (),
        fix: Fix | None = None,
    ) -> None:
        if not self.is_library:
            self.resolution.diagnostics.append(
                Diagnostic(code, message, node.span, label, tuple(secondary), tuple(hints), fix)
            )


def _bring(source: Scope, scope: Scope, names: set[str] | None) -> None:
    """Enter the file-level definitions of an imported file, all or some of them."""
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


def _kind_of(signature: Signature) -> SymbolKind:
    match signature.node:
        case ast.FunctionDefinition():
            return SymbolKind.FUNCTION
        case ast.ShapeDefinition():
            return SymbolKind.SHAPE
        case ast.ConstraintDefinition():
            return SymbolKind.CONSTRAINT
        case ast.Structure():
            return SymbolKind.TEMPLATE
        case _:
            return SymbolKind.FUNCTION


def _did_you_mean(like: Sequence[str], mark: str = "") -> str:
    return f"; did you mean `{mark}{like[0]}`?" if like else ""


def _respell(node: ast.Node, like: Sequence[str]) -> Fix | None:
    return Fix(f"write `{like[0]}`", (Edit(node.span, like[0]),)) if like else None


def _list_of(start: str, names: Sequence[str], mark: str = "") -> str:
    shown = ", ".join(f"`{mark}{name}`" for name in names[:8])
    return start + (shown + (", …" if len(names) > 8 else "") if names else "nothing")

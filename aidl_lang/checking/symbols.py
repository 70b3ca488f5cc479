"""Symbols, the scopes in which they are looked up, and the result of name resolution."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from enum import StrEnum
from functools import lru_cache
from typing import TYPE_CHECKING, Literal

from aidl_lang.checking.builtins import EVERYWHERE, MATH, SIGNATURES
from aidl_lang.checking.library import Lazy, Library
from aidl_lang.checking.types import Signature
from aidl_lang.common import resources
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.names import Spellings, find, fold
from aidl_lang.common.prose import with_article
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.imports import ImportedDrawing
    from aidl_lang.common.world import World

# --- Symbols, which names stand for, and the scopes in which they are looked up before anything is built.
#
# A scope belongs to a structure, a definition, a turn of a `for`, a comprehension or a file. Values and
# callables live apart: `slot(` is looked up among callables only, `slot` among values only.


class SymbolKind(StrEnum):
    """The kinds of symbols, by their names in messages."""

    PARAM = "param"
    LET = "let"
    VAR = "var"
    LOOP = "loop variable"
    ARGUMENT = "parameter"
    GEOMETRY = "geometry"
    STRUCTURE = "structure"
    FUNCTION = "function"
    SHAPE = "shape"
    CONSTRAINT = "constraint"
    TEMPLATE = "template"
    ALIAS = "alias"
    NAMESPACE = "imported file"
    BUILTIN = "built-in name"
    WORD = "word"
    FIELD = "field"

    @property
    def with_article(self) -> str:
        return with_article(self)


UNKNOWNS = frozenset({SymbolKind.VAR, SymbolKind.GEOMETRY, SymbolKind.STRUCTURE})
"""Kinds that exist only from their line on, and that only their own structure may build on."""


@record(frozen=False, eq=False)
class Symbol:
    """A declared or built-in thing that names stand for.

    node          the definition, of several the first; None for built-in ones
    owner         the structure or other definition whose body declares it, or the file
    declarations  the names at all places that declare it, in text order
    is_array      declared with indices
    """

    name: str
    kind: SymbolKind
    node: ast.Node | None = None
    owner: ast.Node | None = None
    declarations: list[ast.Identifier] = field(default_factory=list)
    nodes: list[ast.Node] = field(default_factory=list)
    is_array: bool = False
    scope: SymbolScope | None = None


@record(frozen=False, eq=False)
class SymbolScope:
    """The names declared in one body.

    owner      the node that opens it
    homes      the structures around, outermost (the file) first; geometry declared here belongs to the last
    callables  definitions of this scope under each name, in the order of writing
    spaces     files that `import … as name` names, by that name
    own_name   of a structure, by which it is known inside
    missing    names that failed imports would have brought; None if they could have been any
    """

    owner: ast.Node
    parent: SymbolScope | None = None
    homes: tuple[ast.Node, ...] = ()
    values: dict[str, Symbol] = field(default_factory=dict)
    callables: dict[str, list[Signature]] = field(default_factory=dict)
    aliases: dict[str, Symbol] = field(default_factory=dict)
    spaces: dict[str, SymbolScope] = field(default_factory=dict)
    own_name: Symbol | None = None
    missing: set[str] | None = field(default_factory=set)
    _spellings: dict[str, Spellings] = field(default_factory=dict, repr=False)

    def spelled_alike(self, kind: Literal["values", "callables", "aliases"], name: str) -> str | None:
        """Returns the name in a table of this scope that differs only in spelling (see `names.find`)."""
        if (known := self._spellings.get(kind)) is None:
            known = self._spellings[kind] = Spellings(getattr(self, kind))
        return known.find(name)

    def chain(self) -> Iterator[SymbolScope]:
        scope: SymbolScope | None = self
        while scope is not None:
            yield scope
            scope = scope.parent

    def value(self, name: str) -> Symbol | None:
        """Returns the symbol spelled so in any scope around, else one spelled alike in the nearest scope."""
        for scope in self.chain():
            if (symbol := scope.values.get(name)) is not None:
                return symbol
            if scope.own_name is not None and scope.own_name.name == name:
                return scope.own_name
        for scope in self.chain():
            if (alike := scope.spelled_alike("values", name)) is not None:
                return scope.values[alike]
            if scope.own_name is not None and find(name, {scope.own_name.name: 0}):
                return scope.own_name
        return None

    def space_of(self, receiver: ast.Node | None) -> SymbolScope:
        """Returns the scope in which `receiver.f(…)` looks for `f`: that of an imported file, or this one."""
        space = self.value(receiver.text) if isinstance(receiver, ast.Name) else None
        if space is None or space.kind is not SymbolKind.NAMESPACE or space.scope is None:
            return self
        return space.scope.spaces[space.name]

    def visible(self) -> dict[str, Symbol]:
        """Returns every value that can be named here; inner ones hide outer ones."""
        names: dict[str, Symbol] = {}
        for scope in self.chain():
            for name, symbol in scope.values.items():
                names.setdefault(name, symbol)
            if scope.own_name is not None:
                names.setdefault(scope.own_name.name, scope.own_name)
        return names

    def called(self, name: str) -> tuple[str, list[Signature]] | None:
        """Returns the defined name of a callable and all candidates, innermost first, by way of aliases."""
        key: str | None = name
        if not any(name in s.callables or name in s.aliases for s in self.chain()):
            alike = (s.spelled_alike(of, name) for s in self.chain() for of in ("callables", "aliases"))
            key = next((known for known in alike if known is not None), None)
        found: list[Signature] = []
        canonical: str | None = None
        seen: set[str] = set()
        while key is not None and key not in seen:
            seen.add(key)
            target: str | None = None
            for scope in self.chain():
                found += scope.callables.get(key, ())
                if target is None and (alias := scope.aliases.get(key)) is not None:
                    assert isinstance(alias.node, ast.Alias)
                    target = alias.node.target.text
            if found and canonical is None:
                canonical = key
            key = target
        return (canonical or name, found) if found else None

    def callable_names(self) -> list[str]:
        return [name for scope in self.chain() for name in (*scope.callables, *scope.aliases)]

    def may_be_missing(self, name: str) -> bool:
        """Tells whether a name may have been in a file that could not be imported, which was reported."""
        return any(scope.missing is None or name in scope.missing for scope in self.chain())


def word_meant(name: str, known: Iterable[str]) -> str | None:
    """Returns the one of a few fixed words that a name means."""
    return find(name, dict.fromkeys(known))


# --- The result of name resolution, and the outermost scope of every program.

_NOWHERE = ast.Module(SourceFile("built in", ""), (), (), span=Span(SourceFile("built in", ""), 0, 0))

BUILTIN_NAMES = (*EVERYWHERE, "pi")


@record(frozen=False, eq=False)
class Resolution:
    """The meanings of the names of a program.

    main         the file that is compiled
    modules      it and every file it imports, the imported before those that import them
    uses         names, calls, arguments' targets and (after type checking) members → what they mean
    candidates   calls → the overloads to choose from, innermost first
    symbols      every declaration of the program, in text order
    canonical    names → the spelling the printer shall write
    of_definition  functions, shapes, constraints and templates → their symbols
    allowances   what notes and warnings are not to be told
    errors       how many the resolver has found so far
    scopes       structures, definitions, loops, comprehensions and files → their scopes
    world        the files beside the program, such as fonts; None if only its text is at hand
    drawings     the drawings of other programs that it imports, by the sources of their definitions
    """

    main: ast.Module
    library: Library
    modules: tuple[ast.Module, ...] = ()
    imports: Mapping[ast.Import, ast.Module] = field(default_factory=dict)
    uses: dict[ast.Node, Symbol] = field(default_factory=dict)
    candidates: dict[ast.Call, tuple[Signature, ...]] = field(default_factory=dict)
    symbols: list[Symbol] = field(default_factory=list)
    canonical: dict[ast.Node, str] = field(default_factory=dict)
    scopes: dict[ast.Node, SymbolScope] = field(default_factory=dict)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    allowances: tuple[Allowance, ...] = ()
    errors: int = 0
    of_definition: dict[ast.Node, Symbol] = field(default_factory=dict)
    library_scope: SymbolScope = field(default_factory=lambda: SymbolScope(_NOWHERE))
    enter_library: Callable[[ast.Node], None] = lambda _: None
    world: World | None = None
    drawings: dict[SourceFile, ImportedDrawing] = field(default_factory=dict)

    @property
    def standard_sources(self) -> tuple[SourceFile, ...]:
        """The sources of definitions that no author of the program wrote."""
        return (*self.library.sources, *self.drawings)

    def scope_of(self, definition: ast.Node) -> SymbolScope:
        """Returns the scope of a definition's body; the library's are resolved when they are first needed."""
        if definition not in self.scopes:
            self.enter_library(definition)
        return self.scopes[definition]


@lru_cache(maxsize=4)
def library_scope(library: Library) -> SymbolScope:
    """Returns the outermost scope, of built-in names and the library's, in which nothing is declared."""
    scope = SymbolScope(_NOWHERE)

    def overloads(name: str) -> list[Signature]:
        return [*SIGNATURES.get(name, ()), *library.callables.get(name, ())]

    names = (*SIGNATURES, *library.callables)
    scope.callables = Lazy(names, overloads)  # type: ignore[assignment]  # it is only read
    for name, target in library.aliases.items():
        identifier = ast.Identifier(target, span=_NOWHERE.span)
        alias = ast.Alias(ast.Identifier(name, span=_NOWHERE.span), identifier, None, span=_NOWHERE.span)
        scope.aliases[name] = Symbol(name, SymbolKind.ALIAS, alias)
    for name in library.constants:
        scope.values[name] = Symbol(name, SymbolKind.BUILTIN)
    for name in BUILTIN_NAMES:
        scope.values.setdefault(name, Symbol(name, SymbolKind.BUILTIN))
    for name in MATH:
        scope.values[name] = Symbol(name, SymbolKind.NAMESPACE, scope=scope)
        scope.spaces[name] = scope
    return scope


# --- Notes and warnings that a program wants unsaid: `@allow("N0602")` before a statement.
#
# What is silenced has its place within the statement and is no error. One that silenced nothing is told, once
# it is known what there was to tell.

IDLE = "N0201"

_LATER = frozenset({"N0731", "N0741", "W0720", "W0725", "W0726", "W0733", "W0736"})
"""Codes that are told only when a file is written or parts are measured."""
_OF_TEXT = ("N02", "W01", "W02")  # codes of what a text says, whatever the values of its params


@record()
class Allowance:
    """A code that is not to be told within a statement: `place` is where it is written, `attribute` the whole
    of the attribute, `is_alone` whether it has no other code, `may_come` whether there may be something to
    silence though nothing is found: when a file is written, or with other values of the params.
    """

    code: str
    statement: Span
    place: Span
    attribute: Span
    is_alone: bool
    may_come: bool

    def covers(self, found: Diagnostic) -> bool:
        here = self.statement
        if found.code != self.code or found.is_error or (span := found.span) is None:
            return False
        return span.source is here.source and here.start <= span.start and span.end <= here.end


def allowances(modules: Iterable[ast.Module]) -> tuple[tuple[Allowance, ...], list[Diagnostic]]:
    """Returns what the files of a program allow, and what is wrong with how they say it."""
    allowed: list[Allowance] = []
    wrong: list[Diagnostic] = []
    modules = list(modules)
    for statement, attribute in _attributes(modules):
        if not attribute.arguments:
            hint = 'write the codes of the notes and warnings: `@allow("N0602", "W0705")`'
            wrong.append(Diagnostic("E0216", "`@allow` names no code", attribute.span, hints=(hint,)))
        for argument in attribute.arguments:
            value = argument.value
            code = value.value if isinstance(value, ast.String) else value.span.text
            if code in resources.codes() and not code.startswith("E"):
                is_alone = len(attribute.arguments) == 1
                may_come = code in _LATER or not (code.startswith(_OF_TEXT) or _is_still(modules))
                places = statement.span, value.span, attribute.span
                allowed.append(Allowance(code, *places, is_alone, may_come))
            else:
                wrong.append(_unknown(code, value.span))
    return tuple(allowed), wrong


def _is_still(modules: Iterable[ast.Module]) -> bool:
    return not any(isinstance(node, ast.Param) for module in modules for node in ast.walk(module))


def _attributes(modules: Iterable[ast.Module]) -> Iterator[tuple[ast.Node, ast.Attribute]]:
    for module in modules:
        if ast.ALLOW not in module.source.text.lower():
            continue
        for node in ast.walk(module):
            if isinstance(node, ast.Allowing | ast.Structure | ast.Assign):
                for attribute in ast.attributes(node):
                    if fold(attribute.name.text) == ast.ALLOW:
                        yield node, attribute


def _unknown(code: str, place: Span) -> Diagnostic:
    if code in resources.codes():
        message = f"`{code}` is an error, and only notes and warnings can be allowed"
        return Diagnostic("E0216", message, place, hints=(f"mend it: `aidl explain {code}` tells how",))
    codes = resources.codes()
    alike = [c for c in (code.upper(), *resources.near(code.upper())) if c in codes and c[0] != "E"]
    near = sorted(alike, key=lambda c: c[0] != code[:1].upper())[:1]
    message = f"there is no note or warning `{code}`" + (f"; did you mean `{near[0]}`?" if near else "")
    hints = () if near else ("codes stand in brackets in front of a message: `note[N0602]: …`",)
    fix = Fix(f"write `{near[0]}`", (Edit(place, f'"{near[0]}"'),)) if near else None
    return Diagnostic("E0216", message, place, hints=hints, fix=fix)


def audible(found: Iterable[Diagnostic], allowed: Sequence[Allowance]) -> list[Diagnostic]:
    """Returns the diagnostics without those that are allowed."""
    return [d for d in found if not any(each.covers(d) for each in allowed)]


def idle(found: Sequence[Diagnostic], allowed: Sequence[Allowance]) -> list[Diagnostic]:
    """Returns a note on each code that is allowed where `found`, all there is to tell, has none of it."""
    told: list[Diagnostic] = []
    for each in allowed:
        if not each.may_come and not any(each.covers(d) for d in found):
            message = f"`@allow` silences nothing: there is no `{each.code}` here"
            told.append(Diagnostic(IDLE, message, each.place, fix=_without(each)))
    return told


def _without(allowed: Allowance) -> Fix | None:
    if not allowed.is_alone:
        return None
    text, end = allowed.attribute.source.text, allowed.attribute.end
    end += len(text[end:]) - len(text[end:].lstrip())
    return Fix("remove it", (Edit(Span(allowed.attribute.source, allowed.attribute.start, end), ""),))

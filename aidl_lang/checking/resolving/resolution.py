"""The result of name resolution, and the outermost scope of every program."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from functools import lru_cache
from typing import TYPE_CHECKING

from aidl_lang.checking.allowing import Allowance
from aidl_lang.checking.builtins import EVERYWHERE, MATH, SIGNATURES
from aidl_lang.checking.library import Library
from aidl_lang.checking.resolving.symbols import Symbol, SymbolKind, SymbolScope
from aidl_lang.checking.types import Signature
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.resolving.drawings import ImportedDrawing
    from aidl_lang.common.world import World

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
        """Returns the scope of a definition's body; one of the library is resolved when it is first
        needed.
        """
        if definition not in self.scopes:
            self.enter_library(definition)
        return self.scopes[definition]


@lru_cache(maxsize=4)
def library_scope(library: Library) -> SymbolScope:
    """Returns the outermost scope: built-in names and those of the library. Nothing declares anything in it,
    so one serves all programs.
    """
    scope = SymbolScope(_NOWHERE)
    scope.callables = _Joined(SIGNATURES, library.callables)
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


class _Joined(dict[str, list[Signature]]):
    """Built-in and library overloads by name, joined when they are looked up: only then is a library
    definition decoded.
    """

    def __init__(self, *tables: Mapping[str, tuple[Signature, ...]]) -> None:
        super().__init__({name: [] for table in tables for name in table})
        self._tables = tables
        self._joined: dict[str, list[Signature]] = {}

    def __getitem__(self, name: str) -> list[Signature]:
        if name not in self._joined:
            self._joined[name] = [s for table in self._tables if name in table for s in table[name]]
        return self._joined[name]

    def get(self, name: str, default: object = None) -> object:  # type: ignore[override]
        return self[name] if name in self else default  # noqa: SIM401 (that would be this method)

"""Symbols, which names stand for, and the scopes in which they are looked up before anything is built.

A scope belongs to a structure, a definition, a turn of a `for`, a comprehension or a file. Values and
callables live apart: `slot(` is looked up among callables only, `slot` among values only.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import field
from enum import StrEnum
from typing import Literal

from aidl_lang.checking.types import Signature
from aidl_lang.common.names import Spellings, find, nearest
from aidl_lang.common.prose import with_article
from aidl_lang.common.records import record
from aidl_lang.syntax import ast


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
        """Returns the name in one of the tables of this scope that differs only in spelling (see
        `names.find`).
        """
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

    def container(self) -> SymbolScope:
        """Returns the scope whose members the declarations here become: that of the structure or definition
        around.
        """
        scope = self
        while isinstance(scope.owner, ast.For) and scope.parent is not None:
            scope = scope.parent
        return scope

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
        """Returns the defined name of a callable and all candidates, innermost first, with aliases followed.
        None if there are none.
        """
        key: str | None = name
        if not any(name in s.callables or name in s.aliases for s in self.chain()):
            key = next(
                (
                    k
                    for s in self.chain()
                    if (k := s.spelled_alike("callables", name) or s.spelled_alike("aliases", name))
                    is not None
                ),
                None,
            )
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

    def near_values(self, name: str) -> list[str]:
        return nearest(name, [*self.visible(), "origin", "x_axis", "y_axis", "self", "pi"], 2)


def word_meant(name: str, known: Iterable[str]) -> str | None:
    """Returns the one of a few fixed words that a name means."""
    return find(name, dict.fromkeys(known))

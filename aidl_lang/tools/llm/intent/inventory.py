"""The intents of a program: its structures, geometry, constraints, rotations, asserts and parameters."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from enum import StrEnum
from functools import cached_property

from aidl_lang.checking.resolving.resolution import Resolution
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast
from aidl_lang.tools.llm.intent.canonical import Key, Path, Reader, shape, things_in


class Kind(StrEnum):
    STRUCTURE = "structure"
    GEOMETRY = "geometry"
    PARAM = "param"
    ROTATION = "rotation"
    OPERATION = "operation"
    CONSTRAINT = "constraint"
    ASSERT = "assert"


STATED = frozenset({Kind.CONSTRAINT, Kind.ROTATION, Kind.OPERATION, Kind.ASSERT})
"""Kinds that state something of things; the others are things, and parameters."""


@record(eq=False)
class Step:
    """A block between a structure's body and a statement in it: a loop, a branch, `constrain { }`.

    opening, closing  what stands around its contents
    key               equal for blocks that are the same
    """

    block: ast.Block
    opening: str
    closing: str
    key: Key


@record(eq=False)
class Item:
    """Something a program means to have. Items compare by identity.

    home      the path of the structure, or the definition, that holds it
    node      what states it: of a condition the expression or equation, else the statement or the argument
    span      the statement
    text      the author's words, on one line
    steps     the blocks around it, from its structure inwards
    thing     the path of a structure or geometry itself; of an argument or placement that of its owner
    word      of a structure its kind or its template, of geometry what it is made by
    key       equal for items that mean the same
    wish      it is preferred, not asked for
    wrong     it carried an error
    may_go    a diagnostic offered to leave it out, as it says nothing new
    may_bend  a diagnostic offered to make it a wish
    clashes   it was one of those that could not hold together
    """

    kind: Kind
    home: Path
    node: ast.Node
    span: Span
    text: str
    steps: tuple[Step, ...]
    key: Key
    thing: Path = ()
    word: str = ""
    wish: bool = False
    wrong: bool = False
    may_go: bool = False
    may_bend: bool = False
    clashes: bool = False

    @cached_property
    def things(self) -> frozenset[Path]:
        """The paths of the things in it."""
        return frozenset(things_in(self.key))

    @cached_property
    def shape(self) -> Key:
        return shape(self.key)

    @property
    def context(self) -> Key:
        """The loops and branches around it."""
        return tuple(step.key for step in self.steps if step.key != CONSTRAIN)


CONSTRAIN: Key = ("constrain",)


@record(eq=False)
class Inventory:
    """The intents of a program.

    diagnostics  the diagnostics with a place in the program
    things       the items of structures and geometry by path; of several with one path, the first
    bodies       the blocks of structures and definitions by path
    readers      the reader of the expressions in each structure
    knobs        names of params, and of values worked out from them
    counts       how many there are in the model by path without indices; empty if there is no model
    """

    resolution: Resolution
    diagnostics: tuple[Diagnostic, ...]
    items: tuple[Item, ...]
    things: dict[Path, Item]
    bodies: dict[Path, ast.Block]
    readers: dict[Path, Reader]
    knobs: frozenset[str]
    counts: Counter[Path]

    @property
    def source(self) -> SourceFile:
        return self.resolution.main.source

    def inside(self, path: Path) -> Iterator[Item]:
        """Yields the items in a structure, at any depth."""
        return (item for item in self.items if item.home[: len(path)] == path)


def unnumbered(path: Path) -> Path:
    return tuple(component for component in path if not component.startswith("["))

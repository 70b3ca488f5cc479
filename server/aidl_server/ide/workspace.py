"""The programs of a project in an editor, a view of each, and the places and edits of one text."""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from difflib import SequenceMatcher
from enum import StrEnum
from functools import cached_property
from itertools import accumulate
from pathlib import Path
from typing import TypeAlias

from aidl_lang import pipeline
from aidl_lang.building.expression import Evaluator
from aidl_lang.building.model import Knob, Model
from aidl_lang.checking.imports import SUFFIX, digest
from aidl_lang.checking.symbols import Resolution, audible
from aidl_lang.common import resources
from aidl_lang.common.diagnostics import Diagnostic, Edit
from aidl_lang.common.names import fold
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import DiskWorld, FileError, ReadFailure, World, normalize
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.solved import SolvedModel
from aidl_lang.parser import Parsed
from aidl_lang.pipeline import Compiled, Settings
from aidl_lang.solver.hierarchy import Memory
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import Tokens, tokenize
from aidl_lang.typecheck import Program

# --- Converts between offsets and lines and characters of protocols: in UTF-16 units, or as agreed.
#
# Lines end with `\n`, `\r\n` or `\r`. Lines and characters count from 0.

Position: TypeAlias = tuple[int, int]
"""A line and a character of it."""

_LINE_END = re.compile("\r\n|\n|\r")
_WIDE = {"utf-16": re.compile("[\U00010000-\U0010ffff]"), "utf-8": re.compile("[^\x00-\x7f]")}


class Unit(StrEnum):
    """The unit in which characters of a line are counted."""

    UTF_8 = "utf-8"
    UTF_16 = "utf-16"
    UTF_32 = "utf-32"


class Positions:
    """Positions in one text. Making it reads the text once; a look-up takes a few comparisons."""

    def __init__(self, text: str, unit: Unit = Unit.UTF_16) -> None:
        self._starts, self._ends = [0], []
        for end in _LINE_END.finditer(text):
            self._ends.append(end.start())
            self._starts.append(end.end())
        self._ends.append(len(text))
        wide = _WIDE.get(unit)
        found = [] if wide is None or text.isascii() else [m.start() for m in wide.finditer(text)]
        # Offsets of the characters of several units, and by how much those before each exceed one.
        self._wide = found
        self._more = [0, *accumulate(_units(text[at], unit) - 1 for at in found)]

    def position(self, offset: int) -> Position:
        """Returns the position of an offset; beyond the text its end, in a line break that's start."""
        offset = max(0, min(offset, self._ends[-1]))
        line = bisect_right(self._starts, offset) - 1
        offset = min(offset, self._ends[line])
        return line, self._units(offset) - self._units(self._starts[line])

    def offset(self, line: int, character: int) -> int:
        """Returns the offset of a position; beyond a line the end of it, within a character the start."""
        if line < 0:
            return 0
        if line >= len(self._starts):
            return self._ends[-1]
        start, end = self._starts[line], self._ends[line]
        wanted = self._units(start) + max(0, character)
        if wanted >= self._units(end):
            return end
        return start + bisect_right(range(start, end), wanted, key=self._units) - 1

    def _units(self, offset: int) -> int:
        return offset + self._more[bisect_left(self._wide, offset)]


def _units(character: str, unit: Unit) -> int:
    return 2 if unit is Unit.UTF_16 else len(character.encode("utf-8", "surrogatepass"))


# --- Edits of one text: applying them, and finding them between two versions.


def applied(text: str, edits: Iterable[Edit]) -> str:
    """Returns the text after edits that do not overlap; insertions at one place stay in their order."""
    for _, edit in sorted(enumerate(edits), key=lambda pair: (-pair[1].span.start, -pair[0])):
        text = text[: edit.span.start] + edit.replacement + text[edit.span.end :]
    return text


def between(source: SourceFile, text: str) -> list[Edit]:
    """Returns the edits, by whole lines, from one text to another."""
    old, new = source.text.splitlines(keepends=True), text.splitlines(keepends=True)
    starts = list(accumulate(map(len, old), initial=0))
    changes = SequenceMatcher(a=old, b=new, autojunk=False).get_opcodes()
    return [
        Edit(Span(source, starts[i], starts[j]), "".join(new[k:m]))
        for tag, i, j, k, m in changes
        if tag != "equal"
    ]


def line_start(text: str, offset: int) -> int:
    return text.rfind("\n", 0, offset) + 1


def above_comments(text: str, offset: int) -> int:
    """Returns the beginning of the line of an offset, or of the comments right above it."""
    start = line_start(text, offset)
    while start and text[line_start(text, start - 1) : start].lstrip().startswith(("//", "#")):
        start = line_start(text, start - 1)
    return start


def indent_at(text: str, offset: int) -> str:
    """Returns the white space at the beginning of the line of an offset."""
    line = text[line_start(text, offset) : offset]
    return line[: len(line) - len(line.lstrip())]


def insert(source: SourceFile, offset: int, text: str) -> Edit:
    return Edit(Span(source, offset, offset), text)


# --- Formats a program with few edits.


def format_document(view: View) -> list[Edit]:
    """Returns the edits that bring a text into its canonical form; none if it does not parse."""
    text, _ = pipeline.formatted(view.source, view.world)
    return [] if text is None else between(view.source, text)


def format_range(view: View, wanted: Span) -> list[Edit]:
    text = view.source.text
    start = line_start(text, wanted.start)
    end = text.find("\n", wanted.end)
    end = len(text) if end < 0 else end + 1
    return [e for e in format_document(view) if e.span.start < end and e.span.end >= start]


# --- One text of a program with all that is known of it, from which every question of an editor is answered.

SETTINGS = Settings()


@record(eq=False)
class Solved:
    """An outcome that has a picture, with all that this was made of."""

    outcome: Compiled
    model: SolvedModel
    drawing: Drawing
    built: Model
    evaluate: Evaluator

    @property
    def holds(self) -> bool:
        return self.outcome.status == "solved"


def solved(outcome: Compiled | None) -> Solved | None:
    """Returns an outcome with what it is made of; None if it was wrong before it was solved."""
    if outcome is None or outcome.model is None or outcome.drawing is None:
        return None
    if outcome.built is None or outcome.evaluate is None:
        return None
    return Solved(outcome, outcome.model, outcome.drawing, outcome.built, outcome.evaluate)


@record(eq=False)
class View:
    """A text of a program, checked and perhaps run.

    path      of the file, absolute
    program   the text as checked, however broken
    found     diagnostics of checking it, without building and solving
    outcome   the result of this very text; None until it was run
    drawn     the last outcome with a picture, which may be that of an earlier text
    params    values that were set from outside for `outcome`
    """

    path: Path
    world: World
    program: Program
    found: list[Diagnostic]
    outcome: Compiled | None = None
    drawn: Compiled | None = None
    params: Mapping[str, str | float | bool] | None = None

    @property
    def module(self) -> ast.Module:
        return self.program.main

    @property
    def source(self) -> SourceFile:
        return self.program.main.source

    @property
    def resolution(self) -> Resolution:
        return self.program.resolution

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """The diagnostics of the outcome, else those of checking."""
        if self.outcome is not None:
            return self.outcome.diagnostics
        return audible(self.found, self.program.resolution.allowances)

    @property
    def solved(self) -> Solved | None:
        """What the outcome of this very text was made of; None without a picture."""
        return solved(self.outcome)

    @property
    def knobs(self) -> tuple[Knob, ...]:
        return self.outcome.knobs if self.outcome is not None else ()

    @property
    def set_outside(self) -> frozenset[str]:
        """The names, folded, of the params that were set from outside."""
        return frozenset(fold(name.strip()) for name in self.params or ())

    @property
    def is_stale(self) -> bool:
        """True if the picture is that of another text."""
        return self.drawn is not self.outcome

    def is_library(self, source: SourceFile) -> bool:
        return source in self.resolution.standard_sources

    def file(self, source: SourceFile) -> Path | None:
        """Returns the file of a source; None for a built-in one."""
        if source is self.source:
            return self.path
        if source in self.program.library.sources:
            return resources.resource(source.name)
        is_imported = any(module.source is source for module in self.resolution.modules)
        return self.path.parent / source.name if is_imported or self.is_library(source) else None

    @cached_property
    def _params(self) -> Mapping[Span | None, ast.Param]:
        nodes = (node for module in self.resolution.modules for node in ast.walk(module))
        return {node.span: node for node in nodes if isinstance(node, ast.Param)}

    def declaration(self, knob: Knob) -> ast.Param | None:
        """Returns the declaration of a param in the text or a file that it imports; None in the library."""
        return self._params.get(knob.span)

    @cached_property
    def tokens(self) -> Tokens:
        return tokenize(self.source)

    def span(self, start: int, end: int) -> Span:
        return Span(self.source, start, end)


def hasty(settings: Settings = SETTINGS) -> Settings:
    """Returns the settings for what is shown for a moment: why it does not hold is not searched for."""
    return replace(settings, solving=replace(settings.solving, explain=False))


def look(path: Path, text: str | Parsed, world: World, settings: Settings = SETTINGS) -> View:
    """Checks a program, parsed or not. Never raises for its contents."""
    read = SourceFile(path.name, text) if isinstance(text, str) else text
    return View(path, world, *pipeline.front(read, world, settings))


def run(
    view: View,
    last: View | None = None,
    memory: Memory | None = None,
    params: Mapping[str, str | float | bool] | None = None,
    settings: Settings = SETTINGS,
) -> View:
    """Returns the view with its outcome; if that has no picture, with the picture of the `last` view.

    Raises Cancelled where the run is given up (see `common.running`).
    """
    checked = (view.program, view.found)
    outcome = pipeline.compile(view.source, view.world, params, settings, memory=memory, checked=checked)
    drawn = outcome if outcome.drawing is not None else last.drawn if last is not None else None
    return replace(view, outcome=outcome, drawn=drawn, params=params)


def edited(view: View, edits: Iterable[Edit], settings: Settings = SETTINGS) -> View:
    """Returns the view of the text with edits made, run with the same values from outside."""
    changed = look(view.path, applied(view.source.text, edits), view.world)
    return run(changed, params=view.params, settings=settings)


# --- Views of all the programs of a workspace, each remade only when one of its texts has changed.


@record(frozen=False)
class Project:
    workspace: Workspace
    _views: dict[Path, View] = field(default_factory=dict)

    def view(self, path: Path) -> View | None:
        """Returns the program in a file; None if it cannot be read."""
        try:
            text = self.workspace.text(path)
        except FileError:
            self._views.pop(path, None)
            return None
        known = self._views.get(path)
        if known is None or known.source.text != text or not self._is_fresh(known):
            known = self._views[path] = look(path, text, self.workspace.world(path))
        return known

    def views_with(self, name: str) -> Iterator[View]:
        """Yields the programs in whose text a name occurs, however it is spelled."""
        wanted = fold(name)
        for path in self.workspace.programs():
            try:
                text = self.workspace.text(path)
            except FileError:
                continue  # gone since, or no program; compiling reports that
            if wanted in fold(text) and (view := self.view(path)) is not None:
                yield view

    def _is_fresh(self, view: View) -> bool:
        """True if all that a program imports could be read, and is unchanged."""
        resolution = view.resolution
        imports = (s for m in resolution.modules for s in m.statements if isinstance(s, ast.Import))
        others = (module.source for module in resolution.modules if module is not view.module)
        files = ((source, view.file(source)) for source in others)
        try:
            return (
                all(statement in resolution.imports for statement in imports)
                and all(file and self.workspace.text(file) == source.text for source, file in files)
                and all(
                    digest(view.world.read_bytes(s.name)) == d.digest for s, d in resolution.drawings.items()
                )
            )
        except FileError:
            return False


# --- The programs of a project in an editor: open ones from memory, all others from disk.

MOST_FILES = 2_000
"""Most programs of a project that are searched."""
_PASSED_OVER = frozenset({"node_modules", "build", "dist", "__pycache__"})


@record(frozen=False)
class Workspace:
    """The programs below some folders; `open` has the texts of those in the editor by absolute path."""

    roots: Sequence[Path] = ()
    open: dict[Path, str] = field(default_factory=dict)

    def text(self, path: Path) -> str:
        """Returns the text of a file. Raises FileError."""
        if (text := self.open.get(path)) is not None:
            return text
        return DiskWorld(path.parent).read(path.name)

    def world(self, path: Path) -> OpenWorld:
        """Returns the world of a program: its folder and those below, as for the command line."""
        return OpenWorld(self, path.parent)

    def programs(self) -> list[Path]:
        """Returns the programs below the roots, and the open ones; the first of very many."""
        found = dict.fromkeys(self.open)
        for root in self.roots:
            for path in _below(root):
                if len(found) >= MOST_FILES:
                    return list(found)
                found[path] = None
        return list(found)


def _below(folder: Path) -> Iterator[Path]:
    """Yields the programs in a folder and in those below it, except hidden and generated ones."""
    try:
        entries = sorted(folder.iterdir())
    except OSError:
        return  # it may have gone since, or may not be read
    for entry in entries:
        if entry.name.startswith(".") or entry.name in _PASSED_OVER:
            continue
        if entry.is_dir() and not entry.is_symlink():
            yield from _below(entry)
        elif entry.suffix == SUFFIX and entry.is_file():
            yield entry


@record()
class OpenWorld:
    """The files below a folder, open ones with their text in the editor."""

    workspace: Workspace
    folder: Path

    def read(self, path: str) -> str:
        inside = normalize(path)
        if (text := self.workspace.open.get(self.folder / inside)) is not None:
            return text
        return self._disk(path).read(inside)

    def read_bytes(self, path: str) -> bytes:
        return self._disk(path).read_bytes(normalize(path))

    def _disk(self, path: str) -> DiskWorld:
        if not self.folder.is_dir():  # of a program that was never saved
            raise FileError(path, ReadFailure.MISSING)
        return DiskWorld(self.folder)

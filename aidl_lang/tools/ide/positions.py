"""Places and edits of one text: positions of protocols, applying and finding edits, formatting."""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Iterable
from difflib import SequenceMatcher
from enum import StrEnum
from itertools import accumulate
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.source import SourceFile, Span

if TYPE_CHECKING:
    from aidl_lang.tools.ide.workspace import View


# --- Converts between offsets in a text and lines and characters of protocols: in UTF-16 units, or as
# agreed.
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

    @property
    def lines(self) -> int:
        return len(self._starts)

    def position(self, offset: int) -> Position:
        """Returns the position of an offset; one outside the text is taken to its end, one in a line break to
        its start.
        """
        offset = max(0, min(offset, self._ends[-1]))
        line = bisect_right(self._starts, offset) - 1
        offset = min(offset, self._ends[line])
        return line, self._units(offset) - self._units(self._starts[line])

    def offset(self, line: int, character: int) -> int:
        """Returns the offset of a position; beyond a line it is the end of it, within a character its
        start.
        """
        if line < 0:
            return 0
        if line >= self.lines:
            return self._ends[-1]
        start, end = self._starts[line], self._ends[line]
        wanted = self._units(start) + max(0, character)
        if wanted >= self._units(end):
            return end
        return start + bisect_right(range(start, end), wanted, key=self._units) - 1

    def length(self, start: int, end: int) -> int:
        """Returns the units from one offset to another, line breaks included."""
        return self._units(end) - self._units(start)

    def _units(self, offset: int) -> int:
        """Returns the units before an offset."""
        return offset + self._more[bisect_left(self._wide, offset)]


def _units(character: str, unit: Unit) -> int:
    if unit is Unit.UTF_16:
        return 2
    return len(character.encode("utf-8", "surrogatepass"))


# --- Edits of one text: applying them, and finding them between two versions.


def applied(text: str, edits: Iterable[Edit]) -> str:
    """Returns the text after edits that do not overlap; insertions at one place stay in their order."""
    for _, edit in sorted(enumerate(edits), key=lambda pair: (-pair[1].span.start, -pair[0])):
        text = text[: edit.span.start] + edit.replacement + text[edit.span.end :]
    return text


def between(source: SourceFile, text: str) -> list[Edit]:
    """Returns the edits, by whole lines, from one text to another."""
    old, new = source.text.splitlines(keepends=True), text.splitlines(keepends=True)
    starts = [0]
    for line in old:
        starts.append(starts[-1] + len(line))
    changes = SequenceMatcher(a=old, b=new, autojunk=False).get_opcodes()
    return [
        Edit(Span(source, starts[i], starts[j]), "".join(new[k:m]))
        for tag, i, j, k, m in changes
        if tag != "equal"
    ]


def line_start(text: str, offset: int) -> int:
    """Returns the beginning of the line of an offset."""
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
    """Returns the formatting edits for the lines of a range."""
    text = view.source.text
    start = line_start(text, wanted.start)
    end = text.find("\n", wanted.end)
    end = len(text) if end < 0 else end + 1
    return [e for e in format_document(view) if e.span.start < end and e.span.end >= start]

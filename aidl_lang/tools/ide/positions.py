r"""Converts between offsets in a text and lines and characters of protocols: in UTF-16 units, or as agreed.

Lines end with `\n`, `\r\n` or `\r`. Lines and characters count from 0.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from enum import StrEnum
from itertools import accumulate
from typing import TypeAlias

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

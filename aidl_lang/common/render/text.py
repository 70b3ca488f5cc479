"""Source text made safe and measured for a terminal.

A source may hold anything: tabs, wide and combining characters, escape sequences that would move the
cursor or recolour the screen, marks that reorder the line. Each character becomes a harmless cell with a
known width, so that carets stand under what they mean.
"""

from __future__ import annotations

import unicodedata

from aidl_lang.common.records import record

TAB = 4
_REACH = 4_000
"""Characters that are laid out before what a label points at; no terminal is as wide."""
_BREAKING = {"Cc", "Cf", "Cs", "Zl", "Zp"}
"""Categories that change the screen rather than print: controls, formats, surrogates, separators."""


def escape(text: str) -> str:
    """Returns the text with a visible stand-in for every character that could disturb a terminal; line breaks
    are kept.
    """
    return "".join(char if char == "\n" else _visible(char) for char in text)


def width_of(text: str) -> int:
    """Returns the terminal columns that an escaped text takes."""
    return sum(_width(char) for char in text)


@record()
class CellLine:
    """One line as cells. `columns[i]` is where character i begins; the last entry is the end of the line."""

    cells: tuple[str, ...]
    columns: tuple[int, ...]

    @property
    def text(self) -> str:
        return "".join(self.cells)

    def column(self, index: int) -> int:
        """Returns the terminal column at which a character begins; past the end, that of the end."""
        return self.columns[min(index, len(self.cells))]


def lay_out(text: str) -> CellLine:
    """Returns a line as cells: tabs go to the next stop, controls become their pictures or code points."""
    cells: list[str] = []
    columns = [0]
    for char in text:
        cell = " " * (TAB - columns[-1] % TAB) if char == "\t" else _visible(char)
        cells.append(cell)
        columns.append(columns[-1] + width_of(cell))
    return CellLine(tuple(cells), tuple(columns))


@record()
class Window:
    """The part of a long line that is shown: characters `start:end`, with `…` in place of the rest. Of a very
    long one only some characters are laid out: those from `skipped` on, to the end unless `is_cut`.
    """

    line: CellLine
    start: int
    end: int
    skipped: int
    is_cut: bool

    @property
    def text(self) -> str:
        before = "…" if self.start or self.skipped else ""
        after = "…" if self.end < len(self.line.cells) or self.is_cut else ""
        return before + "".join(self.line.cells[self.start : self.end]) + after

    def column(self, index: int) -> int:
        """Returns the column of a character within `text`; a character left out counts as at the edge."""
        index -= self.skipped
        if index < self.start:
            return 0
        shift = self.line.column(self.start) - (1 if self.start or self.skipped else 0)
        return self.line.column(min(index, self.end)) - shift


def window(text: str, width: int, focus: tuple[int, int]) -> Window:
    """Cuts a line to `width` columns so that the characters of `focus`, or its first ones, can be seen."""
    skipped = max(0, focus[0] - _REACH)
    end = focus[0] + 2 * _REACH
    line, is_cut = lay_out(text[skipped:end]), len(text) > end
    total = line.columns[-1]
    if total <= width and not (skipped or is_cut):
        return Window(line, 0, len(line.cells), skipped, is_cut)
    first, last = line.column(focus[0] - skipped), line.column(focus[1] - skipped)
    room = width - 2
    lead = max(0, (room - (last - first)) // 2) if last - first <= room else room // 8
    left = max(0, min(first - lead, total - room))
    start = next(i for i, column in enumerate(line.columns) if column >= left)
    end = start
    while end < len(line.cells) and line.columns[end + 1] - line.columns[start] <= room:
        end += 1
    return Window(line, start, end, skipped, is_cut)


def _visible(char: str) -> str:
    if char.isprintable() or unicodedata.category(char) not in _BREAKING:
        return char
    code = ord(char)
    if code < 0x20:
        return chr(0x2400 + code)
    if code == 0x7F:
        return "␡"
    return f"<U+{code:04X}>"


def _width(char: str) -> int:
    if unicodedata.combining(char) or unicodedata.category(char) in ("Mn", "Me"):
        return 0
    return 2 if unicodedata.east_asian_width(char) in ("W", "F") else 1

"""Lays the variants of a sweep out in rows of cells, on whatever can be painted on. Lengths are in mm, y runs
down.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

from aidl_lang.common.prose import counted
from aidl_lang.common.records import record
from aidl_lang.common.render import escape
from aidl_lang.tools.sweeping.axes import shown
from aidl_lang.tools.sweeping.rows import Row

MARGIN = 12.0
_HEAD = 10.0
_GAP = 4.0
_LINE = 3.4
_TEXT = 2.6
_LINES = 4
_INK, _GREY, _RED, _PALE = "#1c2330", "#8a93a3", "#b3261e", "#fdf1f0"


class Painter(Protocol):
    """What a sheet is painted on."""

    def box(self, x: float, y: float, width: float, height: float, fill: str, line: str) -> None: ...

    def text(self, x: float, y: float, size: float, colour: str, text: str) -> None:
        """Paints a line of text whose baseline begins at a point."""
        ...

    def length(self, text: str, size: float) -> float: ...

    def picture(self, x: float, y: float, width: float, height: float, png: bytes) -> None:
        """Paints a picture as large as fits into a box, in its middle."""
        ...


@record()
class Grid:
    """So many columns and rows of square pictures with texts below, on pages of one size."""

    columns: int
    rows: int
    side: float

    @property
    def cell(self) -> float:
        """Returns the height of a cell."""
        return self.side + _LINES * _LINE + 2 * _GAP

    @property
    def size(self) -> tuple[float, float]:
        """Returns the size of a page that is just large enough."""
        width = self.columns * (self.side + _GAP) - _GAP
        return 2 * MARGIN + width, 2 * MARGIN + _HEAD + self.rows * self.cell

    @property
    def per_page(self) -> int:
        return self.columns * self.rows


def on_paper(width: float, height: float, columns: int = 4) -> Grid:
    """Returns the grid for a page of paper."""
    side = (width - 2 * MARGIN + _GAP) / columns - _GAP
    cell = Grid(columns, 1, side).cell
    return Grid(columns, max(1, math.floor((height - 2 * MARGIN - _HEAD) / cell)), side)


def in_one(count: int, side: float) -> Grid:
    """Returns the grid that has all variants on one page about as wide as high."""
    columns = max(1, min(count, math.ceil(math.sqrt(count * Grid(1, 1, side).cell / side))))
    return Grid(columns, math.ceil(count / columns), side)


def paint(painter: Painter, grid: Grid, title: str, rows: Sequence[Row], first: int = 0) -> None:
    """Paints one page: the variants from the one at `first`."""
    failing = sum(not row.ok for row in rows)
    head = f"{escape(title)}: {counted(len(rows), 'variant')}, {failing or 'none'} failing"
    width = grid.size[0] - 2 * MARGIN
    painter.text(MARGIN, MARGIN + 4, 4.2, _INK, fitted(painter, head, 4.2, width))
    for k, row in enumerate(rows[first : first + grid.per_page]):
        x = MARGIN + k % grid.columns * (grid.side + _GAP)
        y = MARGIN + _HEAD + k // grid.columns * grid.cell
        _paint_cell(painter, grid.side, x, y, row)


def _paint_cell(painter: Painter, side: float, x: float, y: float, row: Row) -> None:
    painter.box(x, y, side, side, "#ffffff" if row.ok else _PALE, "#d5dae3" if row.ok else _RED)
    if row.outcome.picture:
        painter.picture(x + 1.5, y + 1.5, side - 3, side - 3, row.outcome.picture)
    else:
        painter.text(x + 3, y + side / 2, _TEXT, _GREY, "no drawing")
    message = _lines(painter, _plain(row.message).split(), side, 2, " ") if not row.ok else []
    words = [f"{row.variant.number}"]
    words += [_plain(f"{path} {shown(value)}") for path, value in row.variant.values.items()]
    lines = [(line, _INK) for line in _lines(painter, words, side, _LINES - len(message), "  ")]
    lines += [(line, _RED) for line in message]
    for k, (line, colour) in enumerate(lines):
        painter.text(x, y + side + _LINE * (k + 1), _TEXT, colour, fitted(painter, line, _TEXT, side))


def _plain(text: str) -> str:
    return escape(text[:300]).replace("\n", " ")


def _lines(painter: Painter, words: Sequence[str], width: float, most: int, between: str) -> list[str]:
    """Returns words as lines of a width, `most` at most; the last has all that is left."""
    lines: list[str] = []
    for word in words:
        longer = f"{lines[-1]}{between}{word}" if lines else word
        if lines and (len(lines) == most or painter.length(longer, _TEXT) <= width):
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def fitted(painter: Painter, text: str, size: float, width: float) -> str:
    """Returns a text cut to a width."""
    text = text[:300]
    while len(text) > 1 and painter.length(text, size) > width:
        text = f"{text.removesuffix('…')[:-1]}…"
    return text

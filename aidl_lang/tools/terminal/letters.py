"""Pictures made of characters: grids of cells, lettering in them, and the text that they become."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Sequence
from typing import NamedTuple, TypeAlias

from aidl_lang.common.records import record

Colour: TypeAlias = tuple[int, int, int]
"""Red, green and blue, from 0 to 255."""

WHITE: Colour = (255, 255, 255)
_LEVELS = (0, 95, 135, 175, 215, 255)
"""Of the colour cube of xterm."""
_ASCII = {"⌀": "D", "×": "x", "°": "deg", "–": "-", "−": "-", "…": "..", "²": "2", "≤": "<=", "≥": ">="}


class Cell(NamedTuple):
    """A character in front of its paper. Without colours it takes those of the terminal."""

    character: str
    ink: Colour | None = None
    paper: Colour | None = None


Grid: TypeAlias = list[list[Cell]]


@record()
class Label:
    """A line of text in a grid, about `column` and `row`; `anchor` is start, middle or end."""

    text: str
    column: float
    row: float
    anchor: str
    colour: Colour


def written(grid: Grid, labels: Iterable[Label], *, only_ascii: bool = False) -> Grid:
    """Returns the grid with labels in it, except those that would touch an earlier one, or leave the grid."""
    rows = [list(row) for row in grid]
    taken: set[tuple[int, int]] = set()
    for label in labels:
        characters = _characters(label.text, only_ascii)
        start = round(
            label.column - {"start": 0.0, "middle": 0.5, "end": 1.0}[label.anchor] * len(characters)
        )
        row = int(label.row)
        needed = {(row, column) for column in range(start - 1, start + len(characters) + 1)}
        is_inside = 0 <= row < len(rows) and start >= 0 and start + len(characters) <= len(rows[row])
        if not is_inside or taken & needed:
            continue
        taken |= needed
        for column, character in enumerate(characters, start):
            is_coloured = rows[row][column].paper is not None
            rows[row][column] = Cell(character, label.colour, WHITE) if is_coloured else Cell(character)
    return rows


def _characters(text: str, only_ascii: bool) -> list[str]:
    """Returns one character for each column; a wide one is followed by an empty one."""
    if only_ascii:
        text = "".join(_ASCII.get(c, c if c.isascii() else "?") for c in text)
    found: list[str] = []
    for character in unicodedata.normalize("NFC", text):
        if unicodedata.combining(character):
            continue
        found.append(character if character.isprintable() else "?")
        if unicodedata.east_asian_width(character) in "WF":
            found.append("")
    return found


def text(grid: Grid, *, true_colour: bool = True) -> str:
    """Returns the grid as lines. Colours end with each, so that none runs into the margin."""
    return "".join(f"{_line(row, true_colour)}\n" for row in grid)


def _line(row: Sequence[Cell], true_colour: bool) -> str:
    if all(cell.paper is None for cell in row):
        return "".join(cell.character for cell in row).rstrip(" \u2800")
    pieces, ink, paper = [], None, None
    for cell in row:
        codes = []
        if cell.ink != ink and cell.ink is not None and cell.character != " ":
            codes.append(f"38;{_code(cell.ink, true_colour)}")
            ink = cell.ink
        if cell.paper != paper and cell.paper is not None:
            codes.append(f"48;{_code(cell.paper, true_colour)}")
            paper = cell.paper
        pieces += [f"\x1b[{';'.join(codes)}m"] if codes else []
        pieces.append(cell.character)
    return "".join(pieces) + "\x1b[0m"


def _code(colour: Colour, true_colour: bool) -> str:
    return "2;{};{};{}".format(*colour) if true_colour else f"5;{nearest(colour)}"


def nearest(colour: Colour) -> int:
    """Returns the number of the nearest of the 256 colours of xterm, without the first 16, which themes
    change.
    """
    cube = [min(range(6), key=lambda k: abs(_LEVELS[k] - part)) for part in colour]
    grey = min(max(round((sum(colour) / 3 - 8) / 10), 0), 23)
    choices = [
        (_distance(colour, tuple(_LEVELS[k] for k in cube)), 16 + 36 * cube[0] + 6 * cube[1] + cube[2]),
        (_distance(colour, (8 + 10 * grey,) * 3), 232 + grey),
    ]
    return min(choices)[1]


def _distance(one: Sequence[int], other: Sequence[int]) -> int:
    return sum((a - b) ** 2 for a, b in zip(one, other, strict=True))

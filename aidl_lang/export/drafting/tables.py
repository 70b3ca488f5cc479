"""Tables of a drawing sheet: the title block (ISO 7200), the list of parts, the list of holes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field

from aidl_lang.common.records import record
from aidl_lang.export.drafting.lettering import (
    BLACK,
    LARGE,
    NARROW,
    SMALL,
    WIDE,
    lines,
    width_of,
    written,
)
from aidl_lang.export.marks import Curves, Group, Ink, Mark
from aidl_lang.geometry.curves import Circle, Vec

WIDTH = 180.0
"""Width of the title block and of the tables that stand on it."""
_ROW, _CELL = 5.5, 10.5
_AIR = 1.2


@record()
class Title:
    """The fields of a title block; what is not known is left empty, to be filled in by hand."""

    title: str
    number: str = ""
    revision: str = ""
    author: str = ""
    date: str = ""
    material: str = ""
    thickness: str = ""
    scale: str = ""
    paper: str = ""
    sheet: str = ""


@record()
class Table:
    """A table: heads, rows, and how its width is divided; columns of numbers stand to the right."""

    name: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numeric: frozenset[int] = field(default_factory=frozenset)

    @property
    def height(self) -> float:
        return _ROW * (len(self.rows) + 1)

    def group(self, left: float, bottom: float) -> Group:
        """Returns the table with its lower left corner at a place; its heads stand above its rows."""
        widths = self._widths()
        edges = [left]
        for width in widths:
            edges.append(edges[-1] + width)
        levels = [bottom + _ROW * k for k in range(len(self.rows) + 2)]
        segments = [((edges[0], y), (edges[-1], y)) for y in levels]
        segments += [((x, levels[0]), (x, levels[-1])) for x in edges]
        marks: list[Mark] = [lines(segments)]
        for row, cells in enumerate((self.heads, *self.rows)):
            y = levels[-2 - row] + (_ROW - SMALL) / 2
            for column, words in enumerate(cells):
                room = widths[column] - 2 * _AIR
                if column in self.numeric:
                    at, anchor = (edges[column + 1] - _AIR, y), "end"
                else:
                    at, anchor = (edges[column] + _AIR, y), "start"
                marks.append(written(words, at, SMALL, anchor, room))
        return Group(self.name, tuple(marks), {"class": "table"})

    def _widths(self) -> list[float]:
        wanted = [
            max(width_of(row[k], SMALL) for row in (self.heads, *self.rows)) + 2 * _AIR
            for k in range(len(self.heads))
        ]
        total = sum(wanted)
        # What is left over goes to the widest; too much is taken off all alike.
        if total > WIDTH:
            return [WIDTH * w / total for w in wanted]
        if len(self.numeric) == len(wanted):
            return [WIDTH * w / total for w in wanted]
        wanted[wanted.index(max(wanted))] += WIDTH - total
        return wanted


TITLE_HEIGHT = 3 * _CELL

_PLAN = (
    (
        ("Title", "title", 96.0),
        ("Number", "number", 46.0),
        ("Rev.", "revision", 16.0),
        ("Sheet", "sheet", 22.0),
    ),
    (
        ("Material", "material", 64.0),
        ("Thickness", "thickness", 32.0),
        ("Scale", "scale", 24.0),
        ("Paper", "paper", 22.0),
        ("", "projection", 38.0),
    ),
    (("Drawn by", "author", 64.0), ("Date", "date", 32.0), ("Dimensions in", "unit", 84.0)),
)


def title_block(title: Title, left: float, bottom: float, is_first_angle: bool) -> Group:
    """Returns the title block with its lower left corner at a place."""
    marks: list[Mark] = []
    segments: list[tuple[Vec, Vec]] = []
    for row, cells in enumerate(_PLAN):
        x, top = left, bottom + TITLE_HEIGHT - row * _CELL
        segments.append(((left, top), (left + WIDTH, top)))
        for label, name, width in cells:
            if x > left:
                segments.append(((x, top), (x, top - _CELL)))
            room = width - 2 * _AIR
            if name == "projection":
                marks += _projection((x + width / 2, top - _CELL / 2), is_first_angle)
            else:
                value = "mm, degrees" if name == "unit" else str(getattr(title, name))
                marks.append(written(label, (x + _AIR, top - _AIR - SMALL + 0.2), SMALL, room=room))
                height = LARGE if name == "title" else SMALL
                marks.append(written(value, (x + _AIR, top - _CELL + 1.3), height, room=room))
            x += width
    marks.append(lines(segments))
    around = (left, bottom), (left + WIDTH, bottom), (left + WIDTH, top + _CELL * 2), (left, top + _CELL * 2)
    marks.append(lines([*zip(around, (*around[1:], around[0]), strict=True)], WIDE))
    return Group("title-block", tuple(m for m in marks if m), {"class": "title-block"})


def _projection(middle: Vec, is_first_angle: bool) -> Iterator[Mark]:
    """Yields the symbol of the method of projection (ISO 5456-2): a cone from the side and from its tip."""
    x, y = middle
    side, front = (-4.5, 4.5) if is_first_angle else (4.5, -4.5)
    a, b, half = 1.5, 3.0, 3.0
    corners = (
        (x + side - half, y - a),
        (x + side + half, y - b),
        (x + side + half, y + b),
        (x + side - half, y + a),
    )
    yield lines([*zip(corners, (*corners[1:], corners[0]), strict=True)])
    center = x + front, y
    yield Curves((Circle(center, a),), Ink(BLACK, NARROW))
    yield Curves((Circle(center, b),), Ink(BLACK, NARROW))
    axis = Ink(BLACK, NARROW, (2.0, 0.6, 0.4, 0.6))
    yield Curves(lines([((x - 9, y), (x + 9, y))]).pieces, axis)
    yield Curves(lines([((x + front, y - 4), (x + front, y + 4))]).pieces, axis)

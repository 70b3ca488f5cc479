"""Paper, frames, scales, lettering and tables of a drawing sheet."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field

from aidl_lang.common.materials import PAPERS
from aidl_lang.common.records import record
from aidl_lang.export.marks import CAPITAL, Curves, Group, Ink, Mark, Text, corners, polygon
from aidl_lang.geometry.curves import Bounds, Circle, Line, Vec

# --- Paper, frames and scales of technical drawings: ISO 5457 and 5455, and what is usual beside them.

SCALES = (
    *((factor, 1) for factor in (50, 20, 10, 5, 2, 1)),
    *((1, factor * ten) for ten in (1, 10, 100, 1000) for factor in (2, 5, 10)),
)
"""The standard series, the largest first: millimetres on paper, and in the part."""

_SMALL = frozenset({"a5", "a4", "letter", "legal"})
_MARGIN = 10.0


@record()
class Standard:
    """The habits of a country: its paper from the smallest, the margin on which sheets are bound, and where
    views from the side stand.
    """

    papers: tuple[str, ...]
    binding: float
    is_first_angle: bool


STANDARDS = {
    "iso": Standard(("a4", "a3", "a2", "a1", "a0"), 20.0, True),
    "ansi": Standard(("letter", "tabloid", "a2", "a1", "a0"), 10.0, False),
}


@record()
class Paper:
    """A sheet of paper as it lies before the reader."""

    name: str
    width: float
    height: float
    binding: float

    @property
    def label(self) -> str:
        return self.name.upper() if self.name[0] == "a" and len(self.name) == 2 else self.name.capitalize()

    @property
    def box(self) -> Bounds:
        return 0.0, 0.0, self.width, self.height

    @property
    def frame(self) -> Bounds:
        return self.binding, _MARGIN, self.width - _MARGIN, self.height - _MARGIN

    @property
    def digits(self) -> float:
        """Height of digits, mm: those of a small sheet are read from near."""
        return 2.5 if self.name in _SMALL else 3.5


def papers(standard: Standard, name: str | None, is_landscape: bool | None) -> Iterator[Paper]:
    """Yields the papers that may be taken, the smaller ones first."""
    for known in (name,) if name is not None else standard.papers:
        short, long = PAPERS[known]
        # A4 stands upright by habit, anything larger lies.
        ways = (False, True) if known in _SMALL else (True, False)
        for way in ways if is_landscape is None else (is_landscape,):
            width, height = (long, short) if way else (short, long)
            yield Paper(known, width, height, standard.binding)


def scale_text(scale: tuple[int, int]) -> str:
    return f"{scale[0]}:{scale[1]}"


# --- Texts and lines of a drawing sheet, in mm on paper.

BLACK, GREY = "#000000", "#555555"
WIDE, NARROW = 0.35, 0.18
"""Widths of lines: of outlines and the frame, and of everything else (ISO 128-2, group 0.35)."""
SMALL, LARGE = 2.5, 3.5
"""Heights of capitals (ISO 3098-1)."""
_CHARACTER = 0.62
"""Width of a character relative to the size of the font, on the wide side."""
_CUT = "…"


def width_of(words: str, height: float) -> float:
    return _CHARACTER * height / CAPITAL * len(words)


def written(
    words: str, at: Vec, height: float = SMALL, anchor: str = "start", room: float | None = None
) -> Text:
    """Returns a text, made smaller and then cut off where it has no more than some `room`."""
    if room is not None and width_of(words, height) > room:
        height = max(SMALL, height * room / width_of(words, height))
        while len(words) > 1 and width_of(words, height) > room + 1e-9:
            words = words.removesuffix(_CUT)[:-1].rstrip() + _CUT
    return Text(at, words, height / CAPITAL, BLACK, anchor, halo=False)


def lines(segments: Sequence[tuple[Vec, Vec]]) -> Curves:
    return Curves(tuple(Line(*ends) for ends in segments), Ink(BLACK, NARROW))


def outline(*corners: Vec, width: float = NARROW, role: str = "") -> Curves:
    return Curves(polygon(*corners).outer.pieces, Ink(BLACK, width), role)


# --- Tables of a drawing sheet: the title block (ISO 7200), the list of parts, the list of holes.

WIDTH = 180.0
"""Width of the title block and of the tables that stand on it."""
_ROW, _CELL = 5.5, 10.5
_AIR = 1.2


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
        # What is left over goes to the widest, if that has words; too much is taken off all alike.
        if total > WIDTH or len(self.numeric) == len(wanted):
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


def title_block(title: Mapping[str, str], left: float, bottom: float, is_first_angle: bool) -> Group:
    """Returns the title block with its lower left corner at a place. `title` has its fields by name; what is
    not known is empty, to be filled in by hand.
    """
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
                value = title[name]
                marks.append(written(label, (x + _AIR, top - _AIR - SMALL + 0.2), SMALL, room=room))
                height = LARGE if name == "title" else SMALL
                marks.append(written(value, (x + _AIR, top - _CELL + 1.3), height, room=room))
            x += width
    marks.append(lines(segments))
    marks.append(outline(*corners((left, bottom, left + WIDTH, top + _CELL * 2)), width=WIDE))
    return Group("title-block", tuple(marks), {"class": "title-block"})


def _projection(middle: Vec, is_first_angle: bool) -> Iterator[Mark]:
    """Yields the symbol of the method of projection (ISO 5456-2): a cone from the side and from its tip."""
    x, y = middle
    side, front = (-4.5, 4.5) if is_first_angle else (4.5, -4.5)
    a, b, half = 1.5, 3.0, 3.0
    left, right = x + side - half, x + side + half
    yield outline((left, y - a), (right, y - b), (right, y + b), (left, y + a))
    for radius in (a, b):
        yield Curves((Circle((x + front, y), radius),), Ink(BLACK, NARROW))
    for axis in (Line((x - 9, y), (x + 9, y)), Line((x + front, y - 4), (x + front, y + 4))):
        yield Curves((axis,), Ink(BLACK, NARROW, (2.0, 0.6, 0.4, 0.6)))

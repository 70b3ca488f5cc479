"""Splits pictures larger than the paper into several pages, printed 1:1 and joined afterwards.

Pages overlap. Crosses in the middle of the overlaps lie on both pages, so that they can be laid over each
other; a scale of 50 mm tells whether the printer kept the size. Pages on which nothing is drawn are left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from aidl_lang.common.prose import fixed, size_text
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.export import ExportError, themes
from aidl_lang.export.marks import Area, Curves, Dot, Frame, Group, Ink, Mark, Picture, Text
from aidl_lang.geometry.curves import Line, Piece, Vec
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.geometry.nearness import inside
from aidl_lang.geometry.tessellate import Polygon, face_polygons, piece_points

MARGIN = 10.0
"""Millimetres along each edge of a page: printers leave about 5 blank, the rest holds labels."""
OVERLAP = 10.0
MOST_PAGES = 500
SMALLEST_PAGE = 100.0
"""Narrower pages have no room for the scale and the label."""
SCALE = 50.0
HAIRLINE, FONT = 0.1, 2.8
ARM, TICK = 3.0, 2.5
"""Half of a cross at most, and the length of the marks at the corners of the window, mm."""
BLEED = 1.0
"""Distance by which drawings run over the edge of the window, so that no line there is halved, mm."""
DEVIATION = 0.05
"""Accuracy of the polylines that tell which pages a curve touches, mm."""

Size = tuple[float, float]


@record()
class _Row:
    """Windows of one size along an axis: their number, their first edge and the step between them."""

    count: int
    first: float
    step: float
    window: float

    @classmethod
    def over(cls, low: float, high: float, window: float, overlap: float) -> _Row:
        """Returns the fewest windows that cover the range, centred on it."""
        step = window - overlap
        count = max(1, math.ceil((high - low - overlap) / step - 1e-9))
        return cls(count, (low + high - (count - 1) * step - window) / 2, step, window)

    def start(self, index: int) -> float:
        return self.first + index * self.step

    def seams(self, overlap: float) -> list[float]:
        """Returns the middles of the overlaps."""
        return [self.start(k) + overlap / 2 for k in range(1, self.count)]

    def quarters(self) -> list[float]:
        return [self.start(k) + self.window * share for k in range(self.count) for share in (0.25, 0.75)]


def tiled(picture: Picture, page: Size, margin: float = MARGIN, overlap: float = OVERLAP) -> list[Picture]:
    """Returns the pages on which something is drawn, in reading order; the box of each is that of the paper.

    Raises ExportError if the page is too small, or too many would be needed.
    """
    window = page[0] - 2 * margin, page[1] - 2 * margin
    _check(page, window, overlap)
    left, bottom, right, top = picture.box
    across = _Row.over(left, right, window[0], overlap)
    down = _Row.over(-top, -bottom, window[1], overlap)  # rows count from the top
    if across.count * down.count > MOST_PAGES:
        raise ExportError(
            "E0924",
            f"{across.count * down.count} pages are more than {MOST_PAGES}",
            "give a larger `--tile`",
        )
    crosses = [(x, -y) for x in across.seams(overlap) for y in down.quarters()]
    crosses += [(x, -y) for x in across.quarters() for y in down.seams(overlap)]
    shapes = [[(mark, _Shape(mark)) for mark in group.marks] for group in picture.groups]
    found = []
    for row, column in np.ndindex(down.count, across.count):
        checkpoint()
        x, y = across.start(column), -down.start(row)
        sight = (x, y - window[1], x + window[0], y)
        groups = [
            replace(group, marks=shown, clip=_grown(sight, BLEED))
            for group, marks in zip(picture.groups, shapes, strict=True)
            if (shown := tuple(mark for mark, shape in marks if shape.meets(sight)))
        ]
        if groups or across.count * down.count == 1:
            found.append((sight, groups, f"row {row + 1}, column {column + 1}"))
    made = []
    for k, (sight, groups, place) in enumerate(found, 1):
        marks = _page_marks(sight, crosses, overlap, f"{k}/{len(found)}: {place}")
        made.append(Picture(_grown(sight, margin), (*groups, Group("page-marks", tuple(marks)))))
    return made


def _check(page: Size, window: Size, overlap: float) -> None:
    if min(page) < SMALLEST_PAGE:
        raise ExportError(
            "E0924",
            f"a page of {size_text(page)} is too small for tiles",
            f"each side must have {fixed(SMALLEST_PAGE)} mm at least",
        )
    if overlap > min(window) / 2:
        raise ExportError(
            "E0924",
            f"an overlap of {fixed(overlap)} mm is more than half of what a page of {size_text(page)} shows",
            "give a smaller `--overlap` or a larger `--tile`",
        )


def _page_marks(sight: Bounds, crosses: Sequence[Vec], overlap: float, label: str) -> Iterator[Mark]:
    """Yields the marks that help to join the pages: corners, crosses, a label and a scale."""
    left, bottom, right, top = sight
    ink = Ink(themes.PLAN, HAIRLINE)
    ticks: list[Piece] = []
    for x, out in ((left, -1.0), (right, 1.0)):
        for y, up in ((bottom, -1.0), (top, 1.0)):
            ticks.append(Line((x + out * BLEED, y), (x + out * (BLEED + TICK), y)))
            ticks.append(Line((x, y + up * BLEED), (x, y + up * (BLEED + TICK))))
    yield Curves(tuple(ticks), ink, "crop")
    arm = min(ARM, 0.4 * overlap)
    for x, y in crosses:
        if arm and left <= x - arm and x + arm <= right and bottom <= y - arm and y + arm <= top:
            lines = Line((x - arm, y), (x + arm, y)), Line((x, y - arm), (x, y + arm))
            yield Curves(lines, ink, "registration")
    start, low = left + 2 * TICK, bottom - 2.5
    ends = (Line((x, low - 1), (x, low + 1)) for x in (start, start + SCALE))
    yield Curves((Line((start, low), (start + SCALE, low)), *ends), ink, "scale")
    yield Text((start + SCALE + 1, low - 1), f"{fixed(SCALE)} mm", FONT, themes.PLAN, halo=False)
    yield Text((start, top + 1.5), label, FONT, themes.PLAN, halo=False)


class _Shape:
    """The area of a mark, accurate enough to tell whether a page shows any of it."""

    def __init__(self, mark: Mark) -> None:
        self._lines: list[Polygon] = []
        self._filled: list[Polygon] = []
        air = 0.0
        match mark:
            case Area():
                polygons = face_polygons(mark.face, DEVIATION)
                self._lines = [np.concatenate((p, p[:1])) for p in polygons]
                self._filled = polygons if mark.fill else []
                air = mark.ink.width / 2 if mark.ink else 0.0
            case Curves():
                self._lines = [piece_points(piece, DEVIATION) for piece in mark.pieces]
                air = mark.ink.width / 2
            case Frame(box, _, width):
                self._lines = [_outline(box)]
                air = width / 2
            case Text():
                self._lines = [_outline(mark.box)]
                self._filled = self._lines
            case Dot(at, radius):
                self._lines = [np.array([at, at])]
                air = radius
        self._air = air + DEVIATION
        spots = np.concatenate(self._lines)
        self._low, self._high = spots.min(axis=0) - self._air, spots.max(axis=0) + self._air

    def meets(self, sight: Bounds) -> bool:
        """True if any of it lies in a window."""
        low, high = np.array(sight[:2]), np.array(sight[2:])
        if (self._low > high).any() or (self._high < low).any():
            return False
        if any(_reaches(line, low - self._air, high + self._air) for line in self._lines):
            return True
        middle = (low + high)[None] / 2  # no outline in sight: all of the window is inside, or nothing is
        return sum(int(inside([polygon], middle)[0]) for polygon in self._filled) % 2 == 1


def _reaches(line: Polygon, low: Polygon, high: Polygon) -> bool:
    """True if a polyline has points in a box: each side is clipped to the box along both axes."""
    start, way = line[:-1], np.diff(line, axis=0)
    level = way == 0
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = (low - start) / way, (high - start) / way
    within = (low <= start) & (start <= high)
    enter = np.where(level, np.where(within, -np.inf, np.inf), np.minimum(first, second)).max(axis=1)
    leave = np.where(level, np.where(within, np.inf, -np.inf), np.maximum(first, second)).min(axis=1)
    return bool((np.maximum(enter, 0.0) <= np.minimum(leave, 1.0)).any())


def _outline(box: Bounds) -> Polygon:
    left, bottom, right, top = box
    return np.array([(left, bottom), (right, bottom), (right, top), (left, top), (left, bottom)])


def _grown(box: Bounds, by: float) -> Bounds:
    return box[0] - by, box[1] - by, box[2] + by, box[3] + by

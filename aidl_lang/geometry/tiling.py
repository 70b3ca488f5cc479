"""Regions filled with copies of a cell on a lattice, cut off at the border.

A cell that encloses something is an area: where copies overlap they are one, and what the border cuts off is
closed along it. The curves of another cell are strokes, which end on the border; drawn with a pen of a width
they are areas too. A line that leads from a place of the lattice to the next runs on as one through all
copies in its way.

Only copies near the border take part in a boolean. Those wholly inside are the cell moved, if no two meet.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import compress

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.boolean import clearance, clipped_each, common
from aidl_lang.geometry.curves import Bounds, Floats, Line, Piece, Vec, image, turn_between, union_bounds
from aidl_lang.geometry.intersect import Sides, inside
from aidl_lang.geometry.network import CHORD, RELATIVE_TOLERANCE
from aidl_lang.geometry.offsets import thick
from aidl_lang.geometry.region import Region

MOST = 10_000
"""Copies of a cell that are made at most."""
_MOST_TRIED = 4_000_000
"""Places of a lattice that are looked at."""
_SAME = 1e-9
"""Relative difference up to which a line is as long as a step."""
_NEXT = 3
"""Steps within which neighbours of a cell are looked for, either way."""
_AT_ONCE = 1000
"""Copies whose distance to the border is looked at together, which bounds the memory."""


class TooManyCopiesError(Exception):
    """Raised with the number of copies that a region would take."""


@record()
class Lattice:
    """The places of the copies: `step` leads from one to the next in a row, `row` from a row to the next, if
    there are several. The first copy is the cell turned by `angle` (radians) about `origin` and moved by
    `offset`.
    """

    step: Vec
    row: Vec | None = None
    origin: Vec = (0.0, 0.0)
    angle: float = 0.0
    offset: Vec = (0.0, 0.0)

    @classmethod
    def through(cls, points: Sequence[Vec], region: Region, start: str) -> Lattice:
        """Returns the lattice of an origin, the places beside and above it, the first of these turned, and
        the ends of one step or two. Its origin is put in the middle (`center`) or the first corner (`corner`)
        of the box that stands along the rows about a region, or left where it is (`here`).
        """
        origin, *others = points
        beside, above, turned, *steps = [(x - origin[0], y - origin[1]) for x, y in others]
        angle = turn_between(beside, turned)
        lattice = cls(steps[0], steps[1] if len(steps) > 1 else None, origin, angle)
        if start == "here" or not lattice.is_possible:
            return lattice
        sense = math.copysign(1.0, _cross(beside, above))
        at = _anchor(region, lattice.step, sense, is_middle=start == "center")
        return replace(lattice, offset=(at[0] - origin[0], at[1] - origin[1]))

    def turned(self, curve: Piece) -> Piece:
        """Returns a curve of the cell turned by the angle."""
        if self.angle == 0:
            return curve
        (x, y), cos, sin = self.origin, math.cos(self.angle), math.sin(self.angle)

        def at(p: Vec) -> Vec:
            dx, dy = p[0] - x, p[1] - y
            return x + cos * dx - sin * dy, y + sin * dx + cos * dy

        return image(curve, at, turned=lambda direction: direction + self.angle)

    @property
    def is_possible(self) -> bool:
        """True if the steps are neither nothing nor along one line."""
        length = math.hypot(*self.step)
        if self.row is None:
            return length > 0
        return abs(_cross(self.step, self.row)) > _SAME * length * math.hypot(*self.row)

    def ways(self, low: Floats, high: Floats) -> list[Vec]:
        """Returns the ways of all copies between two corners, row by row."""
        low, high = low - self.offset, high - self.offset
        step, row = np.array(self.step), np.array(self.row or (0.0, 0.0))
        if self.row is None:
            spans = [_span(step / (step @ step), low, high), range(1)]
        else:
            across = _cross(self.step, self.row)
            spans = [
                _span(np.array((row[1], -row[0])) / across, low, high),
                _span(np.array((-step[1], step[0])) / across, low, high),
            ]
        if (tried := len(spans[0]) * len(spans[1])) > _MOST_TRIED:
            raise TooManyCopiesError(tried)
        j, i = np.meshgrid(spans[1], spans[0], indexing="ij")
        ways = i.reshape(-1, 1) * step + j.reshape(-1, 1) * row
        kept = ways[((ways >= low) & (ways <= high)).all(axis=1)]
        if len(kept) > MOST:
            raise TooManyCopiesError(len(kept))
        return [(x, y) for x, y in (kept + self.offset).tolist()]

    def told_apart(self, cell: Sequence[Piece], box: Bounds) -> tuple[list[Piece], list[Piece]]:
        """Returns the curves that end in their copy, and the lines that the others are together in a box."""
        single, running = list[Piece](), list[Piece]()
        for curve in cell:
            if isinstance(curve, Line) and (run := self._run_of(curve)) is not None:
                running += self._run_together(curve, *run, box)
            else:
                single.append(curve)
        return single, running

    def _run_of(self, line: Line) -> tuple[Vec, Vec | None] | None:
        """Returns the step along which a line runs on, and the other one; None for what ends in its copy."""
        way = line.way
        for along, other in ((self.step, self.row), (self.row, self.step)):
            if along is None:
                continue
            near = _SAME * math.hypot(*along)
            if min(math.dist(way, along), math.dist(way, (-along[0], -along[1]))) <= near:
                return along, other
        return None

    def _run_together(self, line: Line, along: Vec, other: Vec | None, box: Bounds) -> Iterator[Line]:
        """Yields the lines that the copies of one are together, as far as they may lie in a box."""
        length = math.hypot(*along)
        unit = along[0] / length, along[1] / length
        x, y = line.start[0] + self.offset[0], line.start[1] + self.offset[1]
        corners = [(cx - x, cy - y) for cx in box[::2] for cy in box[1::2]]
        sides = [_cross(unit, c) for c in corners]
        rows = range(1)
        if other is not None:
            ends = sorted(side / _cross(unit, other) for side in (min(sides), max(sides)))
            rows = range(math.ceil(ends[0]), math.floor(ends[1]) + 1)
        if len(rows) > MOST:
            raise TooManyCopiesError(len(rows))
        for k in rows:
            dx, dy = (k * other[0], k * other[1]) if other is not None else (0.0, 0.0)
            if not min(sides) <= _cross(unit, (dx, dy)) <= max(sides):
                continue
            shares = [unit[0] * (cx - dx) + unit[1] * (cy - dy) for cx, cy in corners]
            tips = ((x + dx + far * unit[0], y + dy + far * unit[1]) for far in (min(shares), max(shares)))
            yield Line(*tips)


def tiled_strokes(cell: Sequence[Piece], region: Region, lattice: Lattice, *, whole: bool) -> list[Piece]:
    """Returns the strokes of all copies that lie inside; with `whole` of those that lie inside wholly."""
    single, running = lattice.told_apart(cell, region.box) if not whole else (cell, [])
    pieces = [p for one in clipped_each(running, region) for p in one.inner]
    if not single:
        return pieces
    inner, crossing = _sorted(single, region, lattice)
    pieces += [_moved(c, way) for way in inner for c in single]
    parts = clipped_each([_moved(c, way) for way in crossing for c in single], region)
    for k in range(0, len(parts), len(single)):
        of_copy = parts[k : k + len(single)]
        if not whole or all(one.is_whole for one in of_copy):
            pieces += [p for one in of_copy for p in one.inner]
    return pieces


def tiled_areas(cell: Region, region: Region, lattice: Lattice, *, whole: bool) -> Region:
    """Returns what lies inside of all copies of an area; with `whole` the copies that lie inside wholly."""
    inner, crossing = (
        [cell.mapped(partial(_moved, way=way)) for way in ways]
        for ways in _sorted(cell.pieces, region, lattice)
    )
    if whole:
        inner, crossing = [*inner, *_uncut(crossing, region)], []
    if _meet_each_other(cell, lattice):
        return common(region, *inner, *crossing)
    cut = common(region, _together(crossing)) if crossing else Region()
    return _together([*inner, cut])


def tiled_bars(cell: Sequence[Piece], region: Region, lattice: Lattice, width: float) -> Region:
    """Returns what lies inside of all copies of strokes drawn with a pen of a width."""
    left, bottom, right, top = region.box
    box = left - width, bottom - width, right + width, top + width
    single, strokes = lattice.told_apart(cell, box)
    if single:
        strokes += [_moved(c, way) for way in lattice.ways(*_reach(single, box)) for c in single]
    return common(region, thick(strokes, width, "square")) if strokes else Region()


def _anchor(region: Region, step: Vec, sense: float, *, is_middle: bool) -> Vec:
    """Returns the middle or first corner of a region's box along a step, in a frame of some `sense`."""
    length = math.hypot(*step)
    x, y = step[0] / length, step[1] / length

    def level(p: Vec) -> Vec:
        return p[0] * x + p[1] * y, sense * (p[1] * x - p[0] * y)

    across = math.atan2(y, x)
    images = (image(c, level, turned=lambda a: sense * (a - across), sense=sense) for c in region.pieces)
    left, bottom, right, top = union_bounds([c.box for c in images])
    u, v = ((left + right) / 2, (bottom + top) / 2) if is_middle else (left, bottom)
    return u * x - sense * v * y, u * y + sense * v * x


# --- Copies ------------------------------------------------------------------------------------------


def _sorted(cell: Sequence[Piece], region: Region, lattice: Lattice) -> tuple[list[Vec], list[Vec]]:
    """Returns the ways of the copies that lie wholly inside, and of those that the border may cut."""
    ways = lattice.ways(*_reach(cell, region.box))
    left, bottom, right, top = union_bounds([c.box for c in cell])
    radius = math.hypot(right - left, top - bottom) / 2
    spots = np.array(ways).reshape(-1, 2) + np.array(((left + right) / 2, (bottom + top) / 2))
    size = float(np.ptp(region.boxes.reshape(-1, 2), axis=0).max())
    polygons = region.polygons(CHORD * size)
    sides = Sides(np.concatenate([np.concatenate((p, np.roll(p, -1, axis=0)), axis=1) for p in polygons]))
    crossing = np.zeros(len(spots), dtype=np.bool_)
    for begin in range(0, len(spots), _AT_ONCE):
        checkpoint()
        crossing[begin + sides.near(spots[begin : begin + _AT_ONCE], radius + 2 * CHORD * size)[0]] = True
    inner = inside(polygons, spots) & ~crossing
    return list(compress(ways, inner)), list(compress(ways, crossing))


def _reach(cell: Sequence[Piece], box: Bounds) -> tuple[Floats, Floats]:
    """Returns the least and the greatest way of copies of a cell that meet a box."""
    own = union_bounds([c.box for c in cell])
    return np.array((box[0] - own[2], box[1] - own[3])), np.array((box[2] - own[0], box[3] - own[1]))


def _meet_each_other(cell: Region, lattice: Lattice) -> bool:
    left, bottom, right, top = cell.box
    near = RELATIVE_TOLERANCE * max(right - left, top - bottom)
    row = lattice.row or (0.0, 0.0)
    for j in range(_NEXT + 1 if lattice.row is not None else 1):
        for i in range(-_NEXT if j else 1, _NEXT + 1):
            way = i * lattice.step[0] + j * row[0], i * lattice.step[1] + j * row[1]
            if abs(way[0]) > right - left + near or abs(way[1]) > top - bottom + near:
                continue
            if clearance(cell, cell.mapped(partial(_moved, way=way))) <= near:
                return True
    return False


def _uncut(areas: Sequence[Region], region: Region) -> list[Region]:
    outlines = iter(clipped_each([p for r in areas for p in r.pieces], region))
    found = [[next(outlines) for _ in r.pieces] for r in areas]
    kept = [r for r, pieces in zip(areas, found, strict=True) if all(one.is_whole for one in pieces)]
    if not any(face.holes for face in region.faces):
        return kept
    return [r for r in kept if abs(common(region, r).area - r.area) <= RELATIVE_TOLERANCE * r.area]


def _moved(curve: Piece, way: Vec) -> Piece:
    return image(curve, lambda p: (p[0] + way[0], p[1] + way[1]))


def _together(regions: Sequence[Region]) -> Region:
    return Region(tuple(face for region in regions for face in region.faces))


def _span(share: Floats, low: Floats, high: Floats) -> range:
    """Returns the whole values that a linear function has in a box."""
    middle, half = float(share @ (low + high)) / 2, float(np.abs(share) @ (high - low)) / 2
    return range(math.floor(middle - half), math.ceil(middle + half) + 1)


def _cross(a: Vec, b: Vec) -> float:
    return a[0] * b[1] - a[1] * b[0]

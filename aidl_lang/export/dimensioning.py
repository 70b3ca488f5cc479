"""Places dimensions in a picture so that all can be read.

Sizes along the axes stand in rows outside the drawing, short ones nearer to it, or in the free space beside
what they measure; leaders and slanted sizes look for the place where they cover and cross least.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import field, replace
from itertools import chain

from aidl_lang.common.prose import counted
from aidl_lang.common.records import record
from aidl_lang.export.dimension_marks import HEIGHT, Pen, PlacedDimension, Sheet, broken, words_of
from aidl_lang.export.marks import DIMENSION, Group, Text
from aidl_lang.geometry.curves import Arc, Bounds, Circle, Vec, larger_side, union_bounds
from aidl_lang.geometry.dimensions import dimensions
from aidl_lang.geometry.dimensions.features import X_AXIS, Y_AXIS, is_clipped
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.solved import Dimension, Length, Opening, Roundness, SolvedModel

MOST = 40
"""More dimensions than this are counted, not drawn."""
SHARE = 0.0125
"""Height of digits relative to the larger side of the picture: 20 of 1600 pixels."""
FIRST, NEXT = 10.0, 8.0
"""The first row from the outline and further ones from each other, mm on paper."""
CROSS = 1.5
"""Arms of the crosses at centres, mm on paper."""
ROWS = 60
"""Rows that are tried before a dimension is given up."""

_REACHES = (6, 9, 13, 18, 25, 34, 46, 62, 84)
_TURNS = tuple(a + b for a in (0, 90, 180, 270) for b in (45, 60, 30, 75, 15))


def dimensioned(model: SolvedModel, drawing: Drawing, box: Bounds) -> tuple[Bounds, tuple[Group, ...]]:
    """Returns the box of `box` and all dimensions, and marks for each, sized to be read in the whole."""
    wanted = visible(model, drawing)
    size = larger_side(box)
    if not wanted or not size > 0:
        return box, ()
    height = 1.3 * SHARE * size
    for _ in range(6):
        whole, groups = _Layout(drawing, Pen(height / HEIGHT), box).make(wanted)
        needed = SHARE * larger_side(whole)
        if height >= needed:
            break
        height = 1.05 * needed
    return whole, groups


@record()
class Callout:
    """A word at the end of a line that points to one of `spots`, each with the direction to come from."""

    name: str
    word: str
    spots: tuple[tuple[Vec, Vec], ...]


def dimensioned_to_scale(
    drawing: Drawing,
    pen: Pen,
    wanted: Sequence[tuple[Dimension, ...]],
    callouts: Sequence[Callout] = (),
    words: Sequence[Text] = (),
) -> tuple[Bounds, tuple[Group, ...], int]:
    """Returns the box of a drawing with these dimensions and callouts, a group of marks for each, and the
    number of those that found no place. `words` stand there already.
    """
    layout = _Layout(drawing, pen, drawing.box, most=len(wanted), remarks=False)
    layout.sheet.texts += [pen.block(text) for text in words]
    whole, groups = layout.make(wanted)
    pointers = [(c, placed) for c in callouts if (placed := layout.point(c)) is not None]
    rings = [d.curve for group in wanted for d in group if isinstance(d, Roundness) and d.origin == "pattern"]
    whole = union_bounds(
        [whole, *(pen.box_of(placed) for _, placed in pointers), *(ring.box for ring in rings)]
    )
    more = [Group(c.name, tuple(pen.marks(placed)), {"class": "item"}) for c, placed in pointers]
    left = len(wanted) + len(callouts) - len(groups) - len(more)
    return whole, (*groups, *more), left


def seen_on(drawing: Drawing) -> Sheet:
    """Returns a sheet that tells what can be seen of a drawing."""
    return Sheet(drawing, Pen(0.005 * drawing.size))


def visible(model: SolvedModel, drawing: Drawing) -> list[tuple[Dimension, ...]]:
    """Returns the dimensions, without those that end where nothing is drawn: in a hole beyond what it cuts,
    or clipped away.
    """
    wanted, sheet = dimensions(model, drawing), seen_on(drawing)
    stay = ("hand", "overall") if is_clipped(model.root) else ("hand", "overall", "constraint")
    centers = {d.curve.center for group in wanted for d in group if isinstance(d, Roundness)}

    def ends_at_something(points: tuple[Vec, ...]) -> bool:
        return bool(sheet.seen(points)) or any(p in centers or sheet.is_material(p) for p in points)

    return [
        group
        for group in wanted
        if not isinstance(group[0], Length)
        or group[0].origin in stay
        or (ends_at_something(group[0].start) and ends_at_something(group[0].end))
    ]


@record(frozen=False)
class _Row:
    """The place of a dimension line outside the drawing: side, range and row."""

    side: tuple[Vec, int]
    low: float
    high: float
    row: int


@record(frozen=False)
class _Layout:
    drawing: Drawing
    pen: Pen
    box: Bounds
    rows: list[_Row] = field(default_factory=list)
    most: int = MOST
    remarks: bool = True

    def __post_init__(self) -> None:
        self.sheet = Sheet(self.drawing, self.pen)

    def make(self, wanted: Sequence[tuple[Dimension, ...]]) -> tuple[Bounds, tuple[Group, ...]]:
        placed: dict[int, PlacedDimension] = {}
        for index in sorted(range(min(len(wanted), self.most)), key=lambda i: _turn(wanted[i][0])):
            found = self.place(wanted[index])
            if found is not None:
                self.sheet.add(found)
                placed[index] = found
        boxes = [self.box, *map(self.pen.box_of, placed.values())]
        groups = [self._group(n, wanted[i], placed[i]) for n, i in enumerate(sorted(placed), 1)]
        if self.remarks and (left := len(wanted) - len(placed)):
            (x, y, *_), size = union_bounds(boxes), 0.8 * self.pen.font
            words = f"{counted(left, 'more dimension')} not shown"
            note = Text((x, y - 1.6 * size), words, size, DIMENSION)
            groups.append(Group("dimensions-left-out", (note,), {"class": "dimension"}))
            boxes.append(note.box)
        return union_bounds(boxes), tuple(groups)

    def _group(self, number: int, wanted: tuple[Dimension, ...], placed: PlacedDimension) -> Group:
        first = wanted[0]
        own = self.pen.block(placed.text)
        others = [block for block in self.sheet.texts if block != own]
        lines = tuple(part for e in placed.extensions for part in broken(e, others))
        attributes = {
            "class": "dimension",
            "data-kind": first.kind,
            "data-value": f"{first.value:.12g}",
            "data-origin": first.origin,
        }
        attributes |= {"data-of": first.of} if first.of else {}
        attributes |= {"data-param": first.name} if first.name else {}
        return Group(
            f"dimension-{number}", tuple(self.pen.marks(replace(placed, extensions=lines))), attributes
        )

    def point(self, callout: Callout) -> PlacedDimension | None:
        """Places a callout, if there is room for it."""
        pen = self.pen
        candidates = (
            (reach / 8 + 0.01 * rank, pen.leader(tip, way, reach * pen.mm, way[0] >= 0, callout.word))
            for rank, (tip, way) in enumerate(callout.spots)
            for reach in _REACHES
        )
        found = self._best(candidates)
        if found is not None:
            self.sheet.add(found)
        return found

    def place(self, wanted: tuple[Dimension, ...]) -> PlacedDimension | None:
        words = words_of(wanted[0], len(wanted))
        match wanted[0]:
            case Length() as length:
                return self._length(length, words)
            case Opening() as opening:
                return self._best(self._arcs(opening, words))
            case _:
                curves = [d.curve for d in wanted if isinstance(d, Roundness)]
                found = self._best(self._leaders(curves, words))
                centers = [(c.center, min(CROSS * self.pen.mm, 0.5 * c.radius)) for c in curves]
                if found is None or isinstance(curves[0], Arc):
                    return found
                ring = curves[0] if wanted[0].origin == "pattern" else None
                return replace(found, crosses=tuple(centers), ring=ring)

    def _length(self, of: Length, words: str) -> PlacedDimension | None:
        """Places a length from a point that is seen, if there is one; a cross marks an end that is not."""
        start, end = self.sheet.seen(of.start), self.sheet.seen(of.end)
        of = replace(of, start=start or of.start, end=end or of.end)
        is_straight = of.along in (X_AXIS, Y_AXIS)
        if of.offset is not None:
            return self._by_hand(of, words, of.offset)
        placed = self._in_row(of, words) if is_straight else self._best(self._beside(of, words))
        unseen = [points[0] for points, seen in ((of.start, start), (of.end, end)) if not seen]
        crosses = tuple((p, CROSS * self.pen.mm) for p in unseen)
        return replace(placed, crosses=crosses) if placed is not None else None

    def _by_hand(self, of: Length, words: str, offset: float) -> PlacedDimension:
        """Places a length at an offset from what it measures: to the right or upwards, or the other way."""
        u, v = of.along
        side = -offset if of.along == Y_AXIS else offset  # across a vertical length is towards the left
        across = [p[1] * u - p[0] * v for p in (*of.start, *of.end)]
        level = (max(across) if side > 0 else min(across)) + side
        return self.pen.straight(of, words, level, after=True)

    def _best(self, candidates: Iterator[tuple[float, PlacedDimension]]) -> PlacedDimension | None:
        """Returns the cheapest candidate that keeps clear of all values."""
        best, least = None, math.inf
        for cost, candidate in sorted(candidates, key=lambda c: c[0]):
            if cost >= least:
                break
            if self.sheet.is_free(candidate) and (total := cost + self.sheet.harm(candidate)) < least:
                best, least = candidate, total
        return best

    # --- Along the axes ----------------------------------------------------------------------------

    def _in_row(self, of: Length, words: str) -> PlacedDimension | None:
        # Below and to the right where nothing speaks against it.
        rows = [
            (self._stretch(found[0]) + 0.3 * (side > 0) + 0.1 * (not after), *found)
            for side in (-1, 1)
            for after in (True, False)
            if (found := self._row(of, words, side, after)) is not None
        ]
        outside = ((cost, placed) for cost, placed, _ in rows)
        best = self._best(chain(outside, self._near(of, words)))
        self.rows += [row for _, placed, row in rows if placed is best]
        return best

    def _stretch(self, placed: PlacedDimension) -> float:
        return sum(math.dist(*e) for e in placed.extensions) / (20 * self.pen.mm)

    def _row(self, of: Length, words: str, side: int, after: bool) -> tuple[PlacedDimension, _Row] | None:
        """Returns the first free row on a side of the drawing, beyond those of shorter lengths there."""
        mm, axis = self.pen.mm, int(of.along == X_AXIS)
        # Across a vertical length is towards the left.
        bounds = (self.box[axis], self.box[axis + 2]) if axis else (-self.box[2], -self.box[0])
        edge = bounds[side > 0]
        trial = self.pen.straight(of, words, edge, after)
        ends = [p[1 - axis] for p in trial.lines[0]]
        low, high = min(ends), max(ends)
        key = of.along, side
        inner = [
            r.row for r in self.rows if r.side == key and r.low < high - 0.1 * mm and low < r.high - 0.1 * mm
        ]
        for row in range(max(inner, default=-1) + 1, ROWS):
            placed = self.pen.straight(of, words, edge + side * (FIRST + NEXT * row) * mm, after)
            if self.sheet.is_free(placed):
                return placed, _Row(key, low, high, row)
        return None

    def _near(self, of: Length, words: str) -> Iterator[tuple[float, PlacedDimension]]:
        """Yields places right beside what is measured, in free space within the drawing."""
        mm, axis = self.pen.mm, int(of.along == X_AXIS)
        if of.value > 0.999 * (self.box[3 - axis] - self.box[1 - axis]):
            return  # what spans the whole stands outside
        bounds = (self.box[axis], self.box[axis + 2]) if axis else (-self.box[2], -self.box[0])
        across = [p[1] if axis else -p[0] for p in (*of.start, *of.end)]
        for side, edge in ((-1, min(across)), (1, max(across))):
            for k in range(12):
                level = edge + side * (FIRST - 2 + NEXT * k) * mm
                if not bounds[0] < level < bounds[1]:
                    break
                placed = self.pen.straight(of, words, level, after=True)
                material = self.sheet.covers_material(placed)
                yield self._stretch(placed) + 0.5 + 0.4 * k + 4.0 * material, placed

    # --- Free places -------------------------------------------------------------------------------

    def _beside(self, of: Length, words: str) -> Iterator[tuple[float, PlacedDimension]]:
        """Yields places of a slanted length beside what it measures, preferably outside."""
        u, v = of.along
        mm, n = self.pen.mm, (-v, u)
        across = [p[0] * n[0] + p[1] * n[1] for p in (*of.start, *of.end)]
        for side, edge in ((-1, min(across)), (1, max(across))):
            for k in range(ROWS):
                for after in (True, False):
                    placed = self.pen.straight(of, words, edge + side * (FIRST - 2 + NEXT * k) * mm, after)
                    inside = self.sheet.covers_material(placed)
                    yield 0.7 * k + 2.0 * self._stretch(placed) + 3.0 * inside + 0.1 * (not after), placed

    def _arcs(self, of: Opening, words: str) -> Iterator[tuple[float, PlacedDimension]]:
        for k in range(24):
            placed = self.pen.angle(of, words, (12 + 4 * k) * self.pen.mm)
            yield 0.6 * k + 1.0 * self.sheet.covers_material(placed), placed

    def _leaders(self, curves: Sequence[Circle | Arc], words: str) -> Iterator[tuple[float, PlacedDimension]]:
        mm = self.pen.mm
        step = max(1, len(curves) // 8)
        for curve in curves[::step]:
            for rank, way in enumerate(_ways(curve)):
                r = curve.radius
                tip = curve.center[0] + r * way[0], curve.center[1] + r * way[1]
                hidden = 0.0 if self.sheet.is_drawn(tip) else 12.0
                for reach in _REACHES:
                    for outward in (True, False):
                        if not outward and (reach > 12 or reach * mm > 0.9 * r):
                            continue
                        out = way if outward else (-way[0], -way[1])
                        placed = self.pen.leader(tip, out, reach * mm, out[0] >= 0, words)
                        turned = 0.1 * (rank % 7 if isinstance(curve, Arc) else rank % 5)
                        yield reach / 8 + turned + hidden + 0.6 * (not outward), placed


def _turn(of: Dimension) -> tuple[int, float]:
    """Returns the sort key of placing: axial lengths from the shortest, then what has more choice."""
    if of.offset is not None:
        return -1, of.value
    if isinstance(of, Length):
        return int(of.along not in (X_AXIS, Y_AXIS)), of.value
    return 2 + isinstance(of, Roundness), of.value


def _ways(curve: Circle | Arc) -> list[Vec]:
    """Returns directions from the centre to places where a leader may end."""
    if isinstance(curve, Circle):
        return [(math.cos(math.radians(a)), math.sin(math.radians(a))) for a in _TURNS]
    spots = [curve.point(t) for t in (0.5, 0.4, 0.6, 0.25, 0.75, 0.1, 0.9)]
    return [((x - curve.center[0]) / curve.radius, (y - curve.center[1]) / curve.radius) for x, y in spots]

"""The marks on a sheet so far, and what a further dimension would cover or cross."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.cancelling import checkpoint
from aidl_lang.export.dimension_marks import Block, Pen, PlacedDimension, Segment, arc_segments
from aidl_lang.geometry.curves import Line, Piece, Vec
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.evaluate import Bounds, ends, points

Segments = NDArray[np.float64]
"""Shape (n, 4): x and y of both ends."""

CLEAR = 1.8
"""Around a value, mm on paper."""
ROOM = 5.5
"""Between a dimension line and another that runs beside it, mm on paper; half of it to an outline."""

_FINE, _COARSE, _MANY = 24, 8, 800


class Sheet:
    """Outlines as short segments; values and arrowheads as boxes; lines of the dimensions placed so far."""

    def __init__(self, drawing: Drawing, pen: Pen) -> None:
        bodies = {
            b.path: _chords([p for loop in b.region.loops for p in loop.pieces]) for b in drawing.bodies
        }
        strokes = _chords([p for s in drawing.strokes for p in s.pieces])
        self.pen, self.box = pen, drawing.box
        self.edges = np.concatenate((np.empty((0, 4)), *bodies.values()))
        for pair in drawing.pairs:
            if pair.relation == "overlapping":
                bodies[pair.a] = _uncovered(bodies[pair.a], bodies[pair.b])
        self.outlines = np.concatenate((strokes, *bodies.values()))
        self.texts: list[Block] = []
        self.heads: list[Block] = []
        self._lines: list[Segment] = []
        self._extensions: list[Segment] = []
        self.lines = self.extensions = np.empty((0, 4))

    def add(self, placed: PlacedDimension) -> None:
        self.texts.append(self.pen.block(placed.text))
        self.heads += map(self.pen.head_block, placed.heads)
        self._lines += _all_lines(placed)
        self._extensions += placed.extensions
        self.lines, self.extensions = _array(self._lines), _array(self._extensions)

    def is_free(self, placed: PlacedDimension) -> bool:
        """True if its value keeps clear of others' values, arrowheads and lines, and theirs of its own."""
        text = self.pen.block(placed.text)
        heads = list(map(self.pen.head_block, placed.heads))
        if any(text.overlaps(other) for other in (*self.texts, *self.heads, *heads)):
            return False
        if crossings(self.lines, text) or any(h.overlaps(other) for h in heads for other in self.texts):
            return False
        lines = _array(_all_lines(placed))
        return not any(crossings(lines, other) for other in self.texts)

    def harm(self, placed: PlacedDimension) -> float:
        """Returns the cost of a place: what its value covers and its lines cross."""
        checkpoint()
        text, lines = self.pen.block(placed.text, CLEAR), _array(_all_lines(placed))
        extensions = _array(placed.extensions)
        cost = 6.0 * min(crossings(self.outlines, text), 4) + 2.0 * crossings(self.extensions, text)
        cost += 3.0 * self._crossed(lines, self.lines) + 2.5 * self._crossed(lines, self.extensions)
        cost += 2.0 * self._crossed(extensions, self.lines)
        for line in placed.lines if len(placed.heads) == 2 else ():
            cost += 3.0 * crossings(self.lines, self._lane(line, ROOM))
            cost += 2.0 * min(crossings(self.outlines, self._lane(line, ROOM / 2)), 4)
        cost += 1.5 * sum(crossings(extensions, other) for other in self.texts)
        return cost + 1.2 * min(self._crossed(lines, self.outlines), 8)

    def _lane(self, line: Segment, room: float) -> Block:
        """Returns the strip that a line should have for itself."""
        (x0, y0), (x1, y1) = line
        short, across = 0.5 * self.pen.mm, room * self.pen.mm
        angle = math.degrees(math.atan2(y1 - y0, x1 - x0))
        return Block((x0, y0), angle, (short, -across, math.hypot(x1 - x0, y1 - y0) - short, across))

    def covers_material(self, placed: PlacedDimension) -> bool:
        left, bottom, right, top = self.pen.block(placed.text).box
        return self.is_material(((left + right) / 2, (bottom + top) / 2))

    def is_material(self, p: Vec) -> bool:
        """True for a point in a body: an odd number of edges is above it."""
        return bool(_inside(np.array([p]), self.edges)[0])

    def is_drawn(self, p: Vec) -> bool:
        """True if an outline runs through the point."""
        checkpoint()
        reach = 1.2 * self.pen.mm
        near = _within(self.outlines, (p[0] - reach, p[1] - reach, p[0] + reach, p[1] + reach))
        if not len(near):
            return False
        a, d = near[:, :2], near[:, 2:] - near[:, :2]
        square = np.maximum((d * d).sum(axis=1), 1e-300)
        t = np.clip(((np.array(p) - a) * d).sum(axis=1) / square, 0, 1)
        away = a + t[:, None] * d - np.array(p)
        return bool((away * away).sum(axis=1).min() < reach * reach)

    def seen(self, points: tuple[Vec, ...]) -> tuple[Vec, ...]:
        """Returns the points on an outline, else such points between them: the end of an edge may be
        hidden.
        """
        (x0, y0), (x1, y1) = points[0], points[-1]
        between = tuple((x0 + k / 12 * (x1 - x0), y0 + k / 12 * (y1 - y0)) for k in range(1, 12))
        return next(filter(None, (tuple(filter(self.is_drawn, spots)) for spots in (points, between))), ())

    @staticmethod
    def _crossed(lines: Segments, others: Segments) -> int:
        return sum(_cross(line, others) for line in lines) if len(others) else 0


def _inside(spots: NDArray[np.float64], edges: Segments) -> NDArray[np.bool_]:
    """Marks the points inside the edges: an odd number of edges is above them."""
    x0, y0, x1, y1 = edges.T
    found = np.zeros(len(spots), dtype=bool)
    for k, (x, y) in enumerate(spots):
        checkpoint()
        over = (x0 > x) != (x1 > x)
        height = y0[over] + (x - x0[over]) * (y1[over] - y0[over]) / (x1[over] - x0[over])
        found[k] = np.count_nonzero(height > y) % 2
    return found


def _uncovered(outline: Segments, cover: Segments) -> Segments:
    """Returns the segments of an outline that `cover`, drawn later, does not hide."""
    middles = (outline[:, :2] + outline[:, 2:]) / 2
    ends = cover.reshape(-1, 2)
    near = np.all((middles > ends.min(axis=0)) & (middles < ends.max(axis=0)), axis=1)
    near[near] = _inside(middles[near], cover)
    uncovered: Segments = outline[~near]
    return uncovered


def crossings(segments: Segments, block: Block) -> int:
    """Counts the segments that meet a rectangle."""
    segments = _within(segments, block.box)
    if not len(segments):
        return 0
    turn, box = np.array(block.axes).T, block.sides
    segments = ((segments.reshape(-1, 2) - np.array(block.at)) @ turn).reshape(-1, 4)
    start, way = segments[:, :2], segments[:, 2:] - segments[:, :2]
    with np.errstate(divide="ignore", invalid="ignore"):
        low = (np.array(box[:2]) - start) / way
        high = (np.array(box[2:]) - start) / way
    # Along an axis in which a segment does not extend, it is in the box always or never.
    still = way == 0
    within = (start > np.array(box[:2])) & (start < np.array(box[2:]))
    enter = np.where(still, np.where(within, -np.inf, np.inf), np.minimum(low, high)).max(axis=1)
    leave = np.where(still, np.where(within, np.inf, -np.inf), np.maximum(low, high)).min(axis=1)
    return int(np.count_nonzero(np.maximum(enter, 0) < np.minimum(leave, 1)))


def broken(segment: Segment, blocks: Iterable[Block]) -> list[Segment]:
    """Returns the parts of a line that blocks do not interrupt."""
    parts = [segment]
    for block in blocks:
        parts = [piece for part in parts for piece in _around(part, block)]
    return parts


def _around(segment: Segment, block: Block) -> list[Segment]:
    (x0, y0), (x1, y1) = segment
    start, way = (x0 - block.at[0], y0 - block.at[1]), (x1 - x0, y1 - y0)
    low, high = 0.0, 1.0
    for axis, near, far in zip(block.axes, block.sides[:2], block.sides[2:], strict=True):
        at, go = (v[0] * axis[0] + v[1] * axis[1] for v in (start, way))
        if abs(go) < 1e-12:
            if not near < at < far:
                return [segment]
            continue
        a, b = sorted(((near - at) / go, (far - at) / go))
        low, high = max(low, a), min(high, b)
    if low >= high:
        return [segment]
    first, last = ((x0 + t * way[0], y0 + t * way[1]) for t in (low, high))
    return [part for part, keep in ((((x0, y0), first), low > 0), ((last, (x1, y1)), high < 1)) if keep]


def _within(segments: Segments, box: Bounds) -> Segments:
    """Returns the segments whose own boxes meet `box`; the others cannot meet it."""
    if not len(segments):
        return segments
    x0, y0, x1, y1 = segments.T
    beyond = (np.maximum(x0, x1) < box[0]) | (np.minimum(x0, x1) > box[2])
    beyond |= (np.maximum(y0, y1) < box[1]) | (np.minimum(y0, y1) > box[3])
    within: Segments = segments[~beyond]
    return within


def _cross(line: NDArray[np.float64], others: Segments) -> int:
    """Counts the segments that a line truly crosses, not merely touches."""
    x, y = sorted(line[::2].tolist()), sorted(line[1::2].tolist())
    others = _within(others, (x[0], y[0], x[1], y[1]))
    p, r = line[:2], line[2:] - line[:2]
    q, s = others[:, :2], others[:, 2:] - others[:, :2]
    cross = r[0] * s[:, 1] - r[1] * s[:, 0]
    offset = q - p
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (offset[:, 0] * s[:, 1] - offset[:, 1] * s[:, 0]) / cross
        k = (offset[:, 0] * r[1] - offset[:, 1] * r[0]) / cross
    slack = 1e-6
    found = (t > slack) & (t < 1 - slack) & (k > -slack) & (k < 1 + slack) & (cross != 0)
    return int(np.count_nonzero(found))


def _chords(pieces: Sequence[Piece]) -> Segments:
    count = _FINE if len(pieces) < _MANY else _COARSE
    t = np.linspace(0, 1, count + 1)
    found = [np.empty((0, 4))]
    for piece in pieces:
        spots = np.array(ends(piece)) if isinstance(piece, Line) else points(piece, t)
        found.append(np.concatenate((spots[:-1], spots[1:]), axis=1))
    return np.concatenate(found)


def _all_lines(placed: PlacedDimension) -> list[Segment]:
    return [*placed.lines, *(arc_segments(placed.arc) if placed.arc is not None else ())]


def _array(segments: Sequence[Segment]) -> Segments:
    return np.array([(*a, *b) for a, b in segments]).reshape(-1, 4)

"""The outline of a region as elements, and the chords at right angles to it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Arc, Circle, Ellipse, Floats, Ints, Line, Mask, Piece, Vec
from aidl_lang.geometry.intersect import windows
from aidl_lang.geometry.network import RELATIVE_TOLERANCE
from aidl_lang.geometry.region import Loop, Region

# --- The outline of a region as straight and round elements in arrays, to be searched for chords (`walls`).
#
# Lines, arcs and circles are what they are. A corner is a round element of radius 0: it looks in all
# directions between the normals of its two edges, as if it were rounded a little. Ellipses and Bézier curves
# are cut into chords, with corners between them, and remember where they come from.

_CHORDS = {"Bezier": 32, "EllipseArc": 32, "Ellipse": 64}
_CUSP = 1e-6
"""Radians short of a half turn within which a corner is a cusp."""


@record(slots=True)
class Bit:
    """An element: the part `first..last` of a piece (one parameter twice for a corner).

    A straight one runs from `start` to `end`. A round one has its center at `start`, a radius, and the
    directions in which its points lie from there: `middle` give or take `half`, radians. `side` is 1 where
    the material is on the side of the center, -1 where it is on the other.
    """

    piece: int
    first: float
    last: float
    start: Vec
    end: Vec = (0.0, 0.0)
    is_round: bool = False
    radius: float = 0.0
    middle: float = 0.0
    half: float = 0.0
    side: float = 1.0


class Skeleton:
    """Arrays over all elements, the straight ones first (`straight` of them).

    pieces     of the outline, each with the material on its left; its neighbours are `before` and `after`
    piece, first, last   of what an element is part of, as in `Bit`
    free       whether it only stands for a part of a curve that is neither straight nor round
    error      how far such a part may be from it
    boxes      left, bottom, right, top
    normal, spread   the direction into the material, give or take, radians
    """

    def __init__(self, region: Region) -> None:
        self.pieces: list[Piece] = []
        self.before: list[int] = []
        self.after: list[int] = []
        bits: list[Bit] = []
        for loop in region.loops:
            bits += self._of_loop(loop)
        bits.sort(key=lambda bit: bit.is_round)
        self.straight = sum(not bit.is_round for bit in bits)
        self.piece = np.array([b.piece for b in bits], dtype=np.intp)
        self.first, self.last = np.array([b.first for b in bits]), np.array([b.last for b in bits])
        lines, rounds = bits[: self.straight], bits[self.straight :]
        self.start = np.array([b.start for b in bits]).reshape(-1, 2)
        way = np.array([b.end for b in lines]).reshape(-1, 2) - self.start[: self.straight]
        self.length = np.hypot(way[:, 0], way[:, 1])
        self.way = way / np.maximum(self.length, 1e-300)[:, None]
        self.radius, self.middle, self.half, self.side = (
            np.array([getattr(b, name) for b in rounds]) for name in ("radius", "middle", "half", "side")
        )
        is_free = np.array([not isinstance(p, Line | Arc | Circle) for p in self.pieces], dtype=np.bool_)
        self.free = is_free[self.piece] & (self.first < 2)
        self.error = max((_error(p) for p in self.pieces), default=0.0)
        self.boxes = self._boxes()
        self.size = math.dist(self.boxes[:, :2].min(axis=0), self.boxes[:, 2:].max(axis=0))
        self.tolerance = RELATIVE_TOLERANCE * self.size
        left = np.arctan2(self.way[:, 0], -self.way[:, 1])
        self.normal = np.concatenate((left, self.middle + np.where(self.side > 0, math.pi, 0)))
        self.spread = np.concatenate((np.zeros(self.straight), self.half))

    def __len__(self) -> int:
        return len(self.piece)

    def _boxes(self) -> Floats:
        start = self.start[: self.straight]
        end = start + self.way * self.length[:, None]
        lines = np.concatenate((np.minimum(start, end), np.maximum(start, end)), axis=1)
        center, r = self.start[self.straight :], self.radius[:, None]
        # Boxes of arcs from the directions they cover: an axis within the range, or the ends.
        angles = self.middle[:, None] + self.half[:, None] * np.array((-1.0, 1.0))
        xs, ys = np.cos(angles), np.sin(angles)
        low = np.stack((xs.min(1), ys.min(1)), axis=1)
        high = np.stack((xs.max(1), ys.max(1)), axis=1)
        for k, axis in enumerate((0.0, math.pi / 2)):
            high[:, k] = np.where(within(axis, self.middle, self.half, 0.0), 1.0, high[:, k])
            low[:, k] = np.where(within(axis + math.pi, self.middle, self.half, 0.0), -1.0, low[:, k])
        return np.concatenate((lines, np.concatenate((center + r * low, center + r * high), axis=1)))

    def _of_loop(self, loop: Loop) -> Iterator[Bit]:
        first = len(self.pieces)
        count = len(loop.pieces)
        for k, piece in enumerate(loop.pieces):
            self.pieces.append(_turned(piece) if loop.reversed else piece)
            self.before.append(first + (k - 1) % count)
            self.after.append(first + (k + 1) % count)
        for number in range(first, first + count):
            yield from self._of_piece(number, -1.0 if loop.reversed else 1.0)
            if not self.pieces[number].is_closed:
                yield self._corner(number, self.after[number])

    def _of_piece(self, number: int, side: float) -> Iterator[Bit]:
        piece = self.pieces[number]
        if isinstance(piece, Line):
            yield Bit(number, 0.0, 1.0, piece.start, piece.end)
        elif isinstance(piece, Arc | Circle):
            first, sweep = piece.range
            side = math.copysign(1.0, sweep) if isinstance(piece, Arc) else side
            middle, half = first + sweep / 2, abs(sweep) / 2
            yield Bit(number, 0.0, 1.0, piece.center, (0.0, 0.0), True, piece.radius, middle, half, side)
        else:
            yield from _chopped(number, piece)

    def _corner(self, number: int, after: int) -> Bit:
        """Returns the corner where a piece ends. Its parameter 2 says that it is fixed there."""
        one, other = self.pieces[number], self.pieces[after]
        arriving, leaving = direction(one, 1.0), direction(other, 0.0)
        turn = math.remainder(leaving - arriving, math.tau)
        if abs(turn) > math.pi - _CUSP:
            # A cusp: which side it is on shows a little away from it.
            (x, y), (x0, y0), (x1, y1) = one.ends[1], one.point(1 - 1e-3), other.point(1e-3)
            nearby = math.atan2(y1 - y, x1 - x) - math.atan2(y - y0, x - x0)
            turn = math.copysign(turn, math.remainder(nearby, math.tau))
        return _bend(number, 2.0, one.ends[1], arriving, turn)


def _bend(piece: int, t: float, at: Vec, arriving: float, turn: float) -> Bit:
    """Returns a corner: one to the left sticks out of the material, which lies on the left."""
    side = 1.0 if turn >= 0 else -1.0
    middle = arriving - side * math.pi / 2 + turn / 2
    return Bit(piece, t, t, at, (0.0, 0.0), True, 0.0, middle, abs(turn) / 2, side)


def _chopped(number: int, piece: Piece) -> Iterator[Bit]:
    """Yields chords of a curve and the corners between them, also those of chord and tangent at its ends."""
    count = _CHORDS[type(piece).__name__]
    ts = np.linspace(0.0, 1.0, count + 1)
    spots: list[Vec] = [(float(x), float(y)) for x, y in piece.points(ts)]
    angles = [math.atan2(q[1] - p[1], q[0] - p[0]) for p, q in pairwise(spots)]
    for k in range(count):
        yield Bit(number, float(ts[k]), float(ts[k + 1]), spots[k], spots[k + 1])
    around = [angles[-1] if piece.is_closed else direction(piece, 0.0), *angles]
    if not piece.is_closed:
        angles = [*angles, direction(piece, 1.0)]
    for k, (arriving, leaving) in enumerate(zip(around, angles, strict=False)):
        yield _bend(number, float(ts[k]), spots[k], arriving, math.remainder(leaving - arriving, math.tau))


def _turned(piece: Piece) -> Piece:
    """Returns a whole curve run through clockwise: an ellipse mirrored in its long axis is itself."""
    return replace(piece, ry=-piece.ry) if isinstance(piece, Ellipse) else piece.reversed()


def _error(piece: Piece) -> float:
    """Returns a bound on how far chords of a chopped curve are from it: twice that in their middles."""
    if isinstance(piece, Line | Arc | Circle):
        return 0.0
    spots = piece.points(np.linspace(0.0, 1.0, 2 * _CHORDS[type(piece).__name__] + 1))
    middles = (spots[:-2:2] + spots[2::2]) / 2 - spots[1::2]
    return 2 * float(np.hypot(middles[:, 0], middles[:, 1]).max())


def direction(piece: Piece, t: float) -> float:
    """Returns the direction of travel, radians."""
    dx, dy = piece.direction(t)
    return math.atan2(dy, dx)


def within(angle: Floats | float, middle: Floats, half: Floats, slack: float) -> Mask:
    """Tells whether directions lie in ranges, up to some radians."""
    away = np.abs((angle - middle + math.pi) % math.tau - math.pi)
    return away <= half + slack


# --- Chords at right angles to an outline at both ends, in closed form for all pairs of elements at once.
#
# `kind` of a chord is 1 where it leaves both ends into the material (a wall), -1 where it leaves them into
# the empty side (a gap). What lies between the ends is not looked at here.

ANGLE = 1e-6
"""Tolerance of right angles, radians."""
_CHUNK = 400_000
"""Pairs that are worked on at a time."""


@record(slots=True)
class Chords:
    """Chords by row: length, ends, the elements they lie on, places along these (0..1), and kind."""

    length: Floats
    a: Floats
    b: Floats
    i: Ints
    j: Ints
    s: Floats
    t: Floats
    kind: Ints

    def __len__(self) -> int:
        return len(self.length)

    def where(self, keep: Mask | Ints) -> Chords:
        return Chords(*(getattr(self, name)[keep] for name in self.__slots__))


def joined(parts: list[Chords]) -> Chords:
    names = Chords.__slots__
    return Chords(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def chords(outline: Skeleton, reach: float, least: float) -> Iterator[Chords]:
    """Yields chords longer than `least` of elements whose boxes are `reach` apart at most, in parts."""
    for i, j in _pairs(outline, reach):
        lines = outline.straight
        yield _between_lines(outline, *_only(i, j, (i < lines) & (j < lines)), least)
        i, j = np.minimum(i, j), np.maximum(i, j)
        yield _line_to_round(outline, *_only(i, j, (i < lines) & (j >= lines)), least)
        yield _between_rounds(outline, *_only(i, j, i >= lines), least)


def _only(i: Ints, j: Ints, keep: Mask) -> tuple[Ints, Ints]:
    return i[keep], j[keep]


def _pairs(o: Skeleton, reach: float) -> Iterator[tuple[Ints, Ints]]:
    """Yields pairs of elements (each with itself too) that come near enough and look at each other, or away
    from each other; by place or by direction, whichever leaves fewer to try.
    """
    order, begin, count = min(_by_place(o.boxes, reach), _by_direction(o), key=lambda way: way[2].sum())
    for i, rank in windows(begin, begin + count, _CHUNK):
        checkpoint()
        j = order[rank % len(order)]
        apart = np.maximum(o.boxes[i, :2] - o.boxes[j, 2:], o.boxes[j, :2] - o.boxes[i, 2:])
        i, j = _only(i, j, np.all(apart <= reach, axis=1))
        yield _only(i, j, within(o.normal[i] + math.pi, o.normal[j], o.spread[i] + o.spread[j], 2 * ANGLE))


def _by_place(boxes: Floats, reach: float) -> tuple[Ints, Ints, Ints]:
    """Returns an order of all elements; for each, where in it its partners begin and their number."""
    extent = boxes[:, 2:].max(axis=0) - boxes[:, :2].min(axis=0)
    along = int(extent[1] > extent[0])
    order = np.argsort(boxes[:, along], kind="stable")
    begin = np.empty(len(order), dtype=np.intp)
    begin[order] = np.arange(len(order))
    end = np.searchsorted(boxes[order, along], boxes[:, along + 2] + reach, side="right")
    return order, begin, np.maximum(end - begin, 1)


def _by_direction(o: Skeleton) -> tuple[Ints, Ints, Ints]:
    """Returns an order of all elements by direction, and for each where in it its partners begin and how many
    there are: those the opposite of whose range begins within its own.
    """
    turn = 2 * math.pi
    opposite = (o.normal + math.pi - o.spread) % turn
    order = np.argsort(opposite, kind="stable")
    starts = np.concatenate([opposite[order] + k * turn for k in range(3)])
    low = (o.normal - o.spread) % turn - ANGLE + turn
    begin = np.searchsorted(starts, low)
    end = np.searchsorted(starts, low + np.minimum(2 * o.spread + 2 * ANGLE, turn), side="right")
    return order, begin, np.minimum(end - begin, len(order))


def _between_lines(o: Skeleton, i: Ints, j: Ints, least: float) -> Chords:
    """Returns chords between parallel lines that face each other, in the middle of where they do."""
    u = o.way[i]
    offset = o.start[j] - o.start[i]
    far = offset + o.way[j] * o.length[j][:, None]
    one, other = (offset * u).sum(axis=1), (far * u).sum(axis=1)
    low, high = np.maximum(0.0, other), np.minimum(o.length[i], one)
    middle = (low + high) / 2
    t = (one - middle) / o.length[j]
    a = o.start[i] + u * middle[:, None]
    b = o.start[j] + o.way[j] * (t * o.length[j])[:, None]
    height = u[:, 0] * (b - a)[:, 1] - u[:, 1] * (b - a)[:, 0]
    found = Chords(
        np.abs(height), a, b, i, j, middle / o.length[i], t, np.where(height > 0, 1, -1).astype(np.intp)
    )
    return found.where((high > low) & (np.abs(height) > least))


def _line_to_round(o: Skeleton, i: Ints, j: Ints, least: float) -> Chords:
    """Returns the perpendicular from the center of a round element to a line."""
    k = j - o.straight
    u = o.way[i]
    normal = np.stack((-u[:, 1], u[:, 0]), axis=1)
    offset = o.start[j] - o.start[i]
    along, height = (offset * u).sum(axis=1), (offset * normal).sum(axis=1)
    reached = height + o.side[k] * o.radius[k]
    slack = ANGLE * np.abs(reached)
    toward = o.side[k][:, None] * normal
    keep = (along >= -slack) & (along <= o.length[i] + slack) & (np.abs(reached) > least)
    a = o.start[i] + u * along[:, None]
    b = o.start[j] + toward * o.radius[k][:, None]
    s = np.clip(along / o.length[i], 0.0, 1.0)
    kind = np.where(reached > 0, 1, -1).astype(np.intp)
    return Chords(np.abs(reached), a, b, i, j, s, _share(o, k, toward), kind).where(keep)


def _between_rounds(o: Skeleton, i: Ints, j: Ints, least: float) -> Chords:
    """Returns chords through both centres; of concentric elements, in the middle of shared directions."""
    offset = o.start[j] - o.start[i]
    distance = np.hypot(offset[:, 0], offset[:, 1])
    same = distance <= np.maximum(least, 1e-9 * (o.radius[i - o.straight] + o.radius[j - o.straight]))
    angle = np.arctan2(offset[:, 1], offset[:, 0])
    found = []
    for way in (1, -1):
        # Into the material at the first end of a wall that runs this way, or of a gap the other way.
        into = angle + (math.pi if way < 0 else 0.0)
        looks = within(into, o.normal[i], o.spread[i], ANGLE)
        looks &= within(into + math.pi, o.normal[j], o.spread[j], ANGLE)
        rows = np.flatnonzero(looks & ~same)
        found.append(_on_centers(o, i[rows], j[rows], distance[rows], angle[rows], way, least))
    rows = np.flatnonzero(same)
    angle, shares = _shared_direction(o, i[rows], j[rows])
    rows, angle = rows[shares], angle[shares]
    found.append(_on_centers(o, i[rows], j[rows], distance[rows], angle, 1, least))
    return joined(found)


def _on_centers(
    o: Skeleton, i: Ints, j: Ints, distance: Floats, angle: Floats, way: int, least: float
) -> Chords:
    """Returns chords along the line through the centres, at this angle: walls this way, or gaps the other."""
    p, q = i - o.straight, j - o.straight
    one, other = -way * o.side[p], way * o.side[q]
    start, end = one * o.radius[p], distance + other * o.radius[q]
    unit = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    a = o.start[i] + unit * start[:, None]
    b = o.start[j] + unit * (other * o.radius[q])[:, None]
    s, t = _share(o, p, unit * one[:, None]), _share(o, q, unit * other[:, None])
    kind = np.where(way * (end - start) > 0, 1, -1).astype(np.intp)
    length = np.abs(end - start)
    return Chords(length, a, b, i, j, s, t, kind).where(length > least)


def _shared_direction(o: Skeleton, i: Ints, j: Ints) -> tuple[Floats, Mask]:
    """Returns a direction into the material at the first and out of it at the other; and if there is one."""
    first, p, q = o.normal[i], o.spread[i], o.spread[j]
    away = (o.normal[j] - first) % (2 * math.pi) - math.pi
    low, high = np.maximum(-p, away - q), np.minimum(p, away + q)
    # Two long arcs may share directions on either side of the circle.
    beyond = away - np.copysign(2 * math.pi, away)
    low_2, high_2 = np.maximum(-p, beyond - q), np.minimum(p, beyond + q)
    better = high_2 - low_2 > high - low
    low, high = np.where(better, low_2, low), np.where(better, high_2, high)
    return first + (low + high) / 2, high >= low - ANGLE


def _share(o: Skeleton, k: Ints, toward: Floats) -> Floats:
    """Returns the place along a round element that lies in a direction, counter-clockwise, 0..1."""
    angle = np.arctan2(toward[:, 1], toward[:, 0]) - o.middle[k]
    away = (angle + math.pi) % (2 * math.pi) - math.pi
    share: Floats = np.clip((away / np.where(o.half[k] > 0, o.half[k], 1.0) + 1) / 2, 0.0, 1.0)
    return share

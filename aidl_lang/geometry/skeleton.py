"""The outline of a region as straight and round elements in arrays, to be searched for chords (`walls`).

Lines, arcs and circles are what they are. A corner is a round element of radius 0: it looks in all directions
between the normals of its two edges, as if it were rounded a little. Ellipses and Bézier curves are cut into
chords, with corners between them, and remember where they come from.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Arc, Circle, Ellipse, Line, Piece, Vec
from aidl_lang.geometry.evaluate import TAU, derivative, ends, is_closed, point, points, reverse, round_range
from aidl_lang.geometry.region import Loop, Region

_CHORDS = {"Bezier": 32, "EllipseArc": 32, "Ellipse": 64}
_CUSP = 1e-6
"""Radians short of a half turn within which a corner is a cusp."""

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]


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
        inward = (
            np.arctan2(self.way[:, 0], -self.way[:, 1]),
            self.middle + np.where(self.side > 0, math.pi, 0),
        )
        self.normal = np.concatenate(inward)
        self.spread = np.concatenate((np.zeros(self.straight), self.half))

    def __len__(self) -> int:
        return len(self.piece)

    def _boxes(self) -> Floats:
        ends_ = self.start[: self.straight] + self.way * self.length[:, None]
        lines = np.concatenate((self.start[: self.straight], ends_), axis=1)
        lines = np.concatenate(
            (np.minimum(lines[:, :2], lines[:, 2:]), np.maximum(lines[:, :2], lines[:, 2:])), 1
        )
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
            if not is_closed(self.pieces[number]):
                yield self._corner(number, self.after[number])

    def _of_piece(self, number: int, side: float) -> Iterator[Bit]:
        piece = self.pieces[number]
        if isinstance(piece, Line):
            yield Bit(number, 0.0, 1.0, piece.start, piece.end)
        elif isinstance(piece, Arc | Circle):
            first, sweep = round_range(piece)
            side = math.copysign(1.0, sweep) if isinstance(piece, Arc) else side
            middle, half = first + sweep / 2, abs(sweep) / 2
            yield Bit(number, 0.0, 1.0, piece.center, (0.0, 0.0), True, piece.radius, middle, half, side)
        else:
            yield from _chopped(number, piece)

    def _corner(self, number: int, after: int) -> Bit:
        """Returns the corner where a piece ends. Its parameter 2 says that it is fixed there."""
        one, other = self.pieces[number], self.pieces[after]
        arriving, leaving = direction(one, 1.0), direction(other, 0.0)
        turn = math.remainder(leaving - arriving, TAU)
        if abs(turn) > math.pi - _CUSP:
            # A cusp: which side it is on shows a little away from it.
            (x, y), (x0, y0), (x1, y1) = ends(one)[1], point(one, 1 - 1e-3), point(other, 1e-3)
            nearby = math.atan2(y1 - y, x1 - x) - math.atan2(y - y0, x - x0)
            turn = math.copysign(turn, math.remainder(nearby, TAU))
        return _bend(number, 2.0, ends(one)[1], arriving, turn)


def _bend(piece: int, t: float, at: Vec, arriving: float, turn: float) -> Bit:
    """Returns a corner: one to the left sticks out of the material, which lies on the left."""
    side = 1.0 if turn >= 0 else -1.0
    middle = arriving - side * math.pi / 2 + turn / 2
    return Bit(piece, t, t, at, (0.0, 0.0), True, 0.0, middle, abs(turn) / 2, side)


def _chopped(number: int, piece: Piece) -> Iterator[Bit]:
    """Yields chords of a curve with the corners between them, and the range between chord and tangent at its
    ends.
    """
    count = _CHORDS[type(piece).__name__]
    ts = np.linspace(0.0, 1.0, count + 1)
    spots: list[Vec] = [(float(x), float(y)) for x, y in points(piece, ts)]
    angles = [math.atan2(q[1] - p[1], q[0] - p[0]) for p, q in pairwise(spots)]
    for k in range(count):
        yield Bit(number, float(ts[k]), float(ts[k + 1]), spots[k], spots[k + 1])
    around = [angles[-1] if is_closed(piece) else direction(piece, 0.0), *angles]
    if not is_closed(piece):
        angles = [*angles, direction(piece, 1.0)]
    for k, (arriving, leaving) in enumerate(zip(around, angles, strict=False)):
        yield _bend(number, float(ts[k]), spots[k], arriving, math.remainder(leaving - arriving, TAU))


def _turned(piece: Piece) -> Piece:
    """Returns a whole curve run through clockwise: an ellipse mirrored in its long axis is itself."""
    return (
        Ellipse(piece.center, piece.rx, -piece.ry, piece.angle)
        if isinstance(piece, Ellipse)
        else reverse(piece)
    )


def _error(piece: Piece) -> float:
    """Returns a bound on the distance of a chord of a chopped curve from it: twice that in the middle of
    one.
    """
    if isinstance(piece, Line | Arc | Circle):
        return 0.0
    spots = points(piece, np.linspace(0.0, 1.0, 2 * _CHORDS[type(piece).__name__] + 1))
    middles = (spots[:-2:2] + spots[2::2]) / 2 - spots[1::2]
    return 2 * float(np.hypot(middles[:, 0], middles[:, 1]).max())


def direction(piece: Piece, t: float) -> float:
    """Returns the direction of travel at an end, radians; where a control point is doubled, by a small
    step.
    """
    dx, dy = derivative(piece, t)
    start, end = ends(piece)
    if math.hypot(dx, dy) <= 1e-9 * max(math.dist(start, end), 1e-300):
        a, b = (
            (point(piece, 0.0), point(piece, 1e-4)) if t == 0 else (point(piece, 1 - 1e-4), point(piece, 1.0))
        )
        dx, dy = b[0] - a[0], b[1] - a[1]
    return math.atan2(dy, dx)


def within(angle: Floats | float, middle: Floats, half: Floats, slack: float) -> NDArray[np.bool_]:
    """Tells whether directions lie in ranges, up to some radians."""
    away = np.abs((angle - middle + math.pi) % TAU - math.pi)
    inside: NDArray[np.bool_] = away <= half + slack
    return inside

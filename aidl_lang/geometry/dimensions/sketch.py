"""What of an outline is told: by what is seen of it, and by dimensions.

The unknowns are the levels of its edges, corners and centres along both axes, and its radii. What is seen
without a number gives equations: arcs end on their edges, joints are smooth, corners are right, halves mirror
each other about a drawn axis; what stands on one level is one unknown. Each equation is a row of a matrix,
and so is each dimension. A dimension is needed if its row lies outside the span of those before it, and a
number is missing as long as its own does. Rows are taken at the outline as it is drawn, by derivatives along
imaginary steps (Squire and Trapp, "Using complex variables to estimate derivatives of real functions", SIAM
Review 40, 1998).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import chain, product
from typing import Generic, TypeVar

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Arc, Bounds, Circle, Floats, Line, Piece, Vec, meeting
from aidl_lang.geometry.dimensions.features import X_AXIS, Y_AXIS
from aidl_lang.geometry.region import Loop
from aidl_lang.geometry.solved import Dimension, Length, Opening, Roundness

Unknowns = Sequence[complex]
Row = Floats
T = TypeVar("T")

EDGE, CORNER, HIDDEN, JOINT = range(4)
"""How a level is seen: as an edge or a centre with its lines, as a corner, as the centre of a short arc, as
the place where two curves touch. The ones before are rather measured.
"""
_STEP = 1e-30
_NEW = 1e-6
"""The part of a row of length 1 that lies outside the span, from which on it tells something."""


@record()
class Reading:
    """A number of an outline as it follows from the unknowns `needs`."""

    needs: tuple[int, ...]
    of: Callable[[Unknowns], complex]


@record()
class Spot:
    """A point of an outline."""

    at: Vec
    x: Reading
    y: Reading

    def along(self, axis: int) -> Reading:
        return (self.x, self.y)[axis]

    @property
    def needs(self) -> tuple[int, ...]:
        return self.x.needs + self.y.needs

    def of(self, z: Unknowns) -> tuple[complex, complex]:
        return self.x.of(z), self.y.of(z)


@record()
class Round:
    """A circle, or all arcs of one. `is_seen`: half of it or more is there, so that its centre has lines."""

    curve: Circle | Arc
    center: Spot
    radius: int
    is_seen: bool


@record()
class Level:
    """A number along an axis that an outline has, the points at it, and how it is seen."""

    axis: int
    value: float
    reading: Reading
    points: tuple[Vec, ...]
    rank: int


class Places(Generic[T]):
    """Things by where they are; numbers that differ by less than the slack are one."""

    def __init__(self, slack: float) -> None:
        self._slack = slack
        self._cells: dict[tuple[int, ...], list[tuple[tuple[float, ...], T]]] = {}

    def add(self, at: tuple[float, ...], thing: T) -> T:
        self._cells.setdefault(self._cell(at), []).append((at, thing))
        return thing

    def find(self, at: tuple[float, ...]) -> T | None:
        return next(self.all(at), None)

    def things(self) -> Iterator[T]:
        return (thing for cell in self._cells.values() for _, thing in cell)

    def all(self, at: tuple[float, ...]) -> Iterator[T]:
        for cell in product(*((n, n - 1, n + 1) for n in self._cell(at))):
            for known, thing in self._cells.get(cell, ()):
                if all(abs(a - b) <= self._slack for a, b in zip(known, at, strict=True)):
                    yield thing

    def _cell(self, at: tuple[float, ...]) -> tuple[int, ...]:
        return tuple(math.floor(number / (2 * self._slack)) for number in at)


class Sketch:
    """An outline as its unknowns. `box`: of all that is drawn of the part."""

    def __init__(self, loops: Iterable[Loop], box: Bounds, slack: float) -> None:
        self.slack, self.box = slack, box
        self.rounds: list[Round] = []
        self.fixed: list[float | None] = [None, None]
        """ends of the part that an outline without dimensions has, by axis"""
        self._values: list[float] = []
        self._levels: tuple[Places[int], Places[int]] = (Places(slack), Places(slack))
        self._seen: dict[int, tuple[int, list[Vec], int]] = {}
        """Levels: their axis, the points at them, how they are seen."""
        self._corners: list[Spot] = []
        self.fillets: set[int] = set()
        """radii of rounded corners"""
        self.lines: list[tuple[Spot, Spot]] = []
        self.equations: list[Reading] = []
        self._spots: Places[Spot] = Places(slack)
        self._rounds: Places[Round] = Places(slack)
        outlines = [loop.pieces for loop in loops]
        self._find_rounds([p for pieces in outlines for p in pieces if isinstance(p, Circle | Arc)])
        for pieces in outlines:
            checkpoint()
            if not isinstance(pieces[0], Circle):
                self._read(pieces)

    # --- Unknowns ----------------------------------------------------------------------------------

    def _unknown(self, value: float) -> int:
        self._values.append(value)
        return len(self._values) - 1

    def _level(self, axis: int, p: Vec, rank: int) -> int:
        """Returns the unknown of the level of a point: one that is there already, unless none sees it."""
        places = self._levels[axis]
        number = places.find((p[axis],)) if rank < HIDDEN else None
        if number is None:
            number = self._unknown(p[axis])
            if rank < HIDDEN:
                places.add((p[axis],), number)
        _, points, before = self._seen.get(number, (axis, [], rank))
        self._seen[number] = axis, [*points, p], min(rank, before)
        return number

    def _spot(self, at: Vec, x: int, y: int) -> Spot:
        return self._spots.add(at, Spot(at, plain(x), plain(y)))

    def _find_rounds(self, curves: Iterable[Circle | Arc]) -> None:
        same: Places[list[Circle | Arc]] = Places(self.slack)
        for curve in curves:
            key = (*curve.center, curve.radius)
            (same.find(key) or same.add(key, [])).append(curve)
        for known in same.things():
            first = known[0]
            is_seen = any(is_half_round(c) for c in known)
            x, y = (self._level(k, first.center, EDGE if is_seen else HIDDEN) for k in (0, 1))
            spot = self._spot(first.center, x, y)
            found = Round(first, spot, self._unknown(first.radius), is_seen)
            self.rounds.append(self._rounds.add((*first.center, first.radius), found))

    def round_of(self, curve: Circle | Arc) -> Round | None:
        return self._rounds.find((*curve.center, curve.radius))

    # --- What is seen ------------------------------------------------------------------------------

    def _read(self, pieces: Sequence[Piece]) -> None:
        """Notes the corners of an outline and the equations that are seen of it."""
        count = len(pieces)
        spots = [self._vertex(pieces[k - 1], pieces[k]) for k in range(count)]
        for k, piece in enumerate(pieces):
            before, after = pieces[k - 1], pieces[(k + 1) % count]
            a, b, c, d = (spots[(k + n) % count] for n in (-1, 0, 1, 2))
            self._joint(a, b, c, before, piece)
            if isinstance(piece, Line):
                self.lines.append((b, c))
                if _is_right(piece, after):
                    self._turn(b, c, c, d, is_right=True)
            elif is_smooth(before, piece) and is_smooth(piece, after):
                self._between(a, b, c, d, before, after)
                is_corner = isinstance(before, Line) and isinstance(after, Line)
                if is_corner and isinstance(piece, Arc) and not is_half_round(piece):
                    self.fillets.add(self._round(piece).radius)

    def _joint(self, a: Spot, b: Spot, c: Spot, before: Piece, after: Piece) -> None:
        """Notes what is seen where a piece from `a` to `b` meets one from `b` to `c`."""
        arcs = [self._round(p) for p in (before, after) if isinstance(p, Arc)]
        for arc in arcs:
            self._equate(_off, b, arc.center, arc.radius)
        if not is_smooth(before, after):
            return
        if len(arcs) == 2:
            m, n = (arc.center for arc in arcs)
            self._turn(b, m, b, n)
        elif not any(self.is_across(p, axis) for p in (before, after) for axis in (0, 1)):
            m, far = arcs[0].center, a if isinstance(before, Line) else c
            self._turn(b, m, b, far, is_right=True)

    def _between(self, a: Spot, b: Spot, c: Spot, d: Spot, before: Piece, after: Piece) -> None:
        """Notes what is seen of a rounded corner or a round end: what its edges are to each other."""
        if not (isinstance(before, Line) and isinstance(after, Line)):
            return
        at = meeting(before, after)
        if at is None or _is_right(before, after):
            self._turn(a, b, c, d, is_right=at is not None)
        if at is None:
            return
        needs = a.needs + b.needs + c.needs + d.needs
        x, y = (Reading(needs, partial(_crossing, a, b, c, d, axis)) for axis in (0, 1))
        for line, own in ((before, a), (after, d)):
            if self.is_across(line, 0):
                x = own.x
            elif self.is_across(line, 1):
                y = own.y
        self._corners.append(self._spots.add(at, Spot(at, x, y)))

    def _turn(self, a: Spot, b: Spot, c: Spot, d: Spot, is_right: bool = False) -> None:
        """Notes that two slanted ways are seen to be parallel, or at a right angle."""
        product = dot if is_right else cross
        self._equate(lambda a, b, c, d, z: product(way(a, b, z), way(c, d, z)), a, b, c, d)

    def _vertex(self, before: Piece, after: Piece) -> Spot:
        """Returns where a piece begins; where an axial edge touches an arc, straight beside the centre."""
        at = after.ends[0]
        is_joint = is_smooth(before, after)
        ranks = [JOINT if is_joint else CORNER] * 2
        beside: list[int | None] = [None, None]
        for line, other in ((before, after), (after, before)):
            for axis in (0, 1):
                if self.is_across(line, axis):
                    ranks[axis] = EDGE
                    if is_joint and isinstance(other, Arc):
                        beside[1 - axis] = self._round(other).center.along(1 - axis).needs[0]
        x, y = (self._level(k, at, ranks[k]) if (n := beside[k]) is None else n for k in (0, 1))
        return self._spot(at, x, y)

    def is_across(self, piece: Piece, axis: int) -> bool:
        """Tells whether a piece is a line at one level of an axis."""
        return isinstance(piece, Line) and abs(piece.start[axis] - piece.end[axis]) <= self.slack

    def _round(self, curve: Circle | Arc) -> Round:
        found = self.round_of(curve)
        assert found is not None
        return found

    def _equate(self, of: Callable[..., complex], *things: Spot | Reading | int) -> None:
        """Notes a number of some things, and of the unknowns, that is seen to be nought."""
        needs = [(t,) if isinstance(t, int) else t.needs for t in things]
        self.equations.append(Reading(tuple(chain(*needs)), partial(of, *things)))

    def mirror(self, axis: int, middle: float) -> Reading:
        """Notes that both sides of a drawn axis are alike; returns its level."""
        at = (middle, self.box[1]) if axis == 0 else (self.box[0], middle)
        axle = self._level(axis, at, EDGE)
        spots = list(self._spots.things())
        for spot in spots:
            other = self._spots.find(flipped(spot.at, axis, middle))
            if other is None:
                continue
            sides = spot.along(axis), other.along(axis)
            self._equate(lambda a, b, mid, z: a.of(z) + b.of(z) - 2 * mid.of(z), *sides, plain(axle))
            self.equations.append(less(spot.along(1 - axis), other.along(1 - axis)))
        for own in self.rounds:
            twin = self._rounds.find((*flipped(own.curve.center, axis, middle), own.curve.radius))
            if twin is not None:
                self.equations.append(less(plain(own.radius), plain(twin.radius)))
        return plain(axle)

    def levels(self) -> list[Level]:
        """Returns all that may be measured along the axes."""
        found = [
            Level(axis, self._values[n], plain(n), tuple(dict.fromkeys(points)), rank)
            for n, (axis, points, rank) in self._seen.items()
        ]
        for spot in self._corners:
            found += [Level(k, spot.at[k], spot.along(k), (spot.at,), CORNER) for k in (0, 1)]
        return found

    # --- Rows --------------------------------------------------------------------------------------

    @property
    def count(self) -> int:
        return len(self._values)

    def row(self, reading: Reading) -> Row:
        """Returns how a number changes with each of the unknowns."""
        found, z = np.zeros(self.count), [complex(value) for value in self._values]
        for number in set(reading.needs):
            known, z[number] = z[number], z[number] + _STEP * 1j
            found[number] = reading.of(z).imag / _STEP
            z[number] = known
        return found

    def spot(self, at: Vec) -> Spot | None:
        """Returns what is best seen of an outline at a point."""
        here = self._spots.all(at)
        return min(here, key=lambda spot: max(self._seen[n][2] for n in spot.needs), default=None)

    def level(self, axis: int, value: float) -> int | None:
        """Returns the unknown of a level that is seen."""
        return self._levels[axis].find((value,))


class Span:
    """What rows tell together: an orthonormal basis of them."""

    def __init__(self, count: int) -> None:
        self._basis, self._size = np.zeros((count, count)), 0

    def add_all(self, rows: Iterable[Row]) -> bool:
        """Adds rows; tells whether any of them told something new."""
        before = self._size
        for row in rows:
            if (rest := self._rest(row)) is not None:
                self._basis[self._size] = rest / np.linalg.norm(rest)
                self._size += 1
        return self._size > before

    def lacks(self, row: Row) -> bool:
        return self._rest(row) is not None

    def _rest(self, row: Row) -> Row | None:
        """Returns the part of a row outside the span; None if there is none."""
        size = float(np.linalg.norm(row))
        if not size > 0 or self._size == len(self._basis):
            return None
        known, rest = self._basis[: self._size], row / size
        for _ in range(2):  # once more, for what rounding left
            rest = rest - known.T @ (known @ rest)
        return rest if np.linalg.norm(rest) > _NEW else None


def is_half_round(curve: Piece) -> bool:
    """Tells whether enough of a circle is there for its centre to be drawn."""
    return isinstance(curve, Circle) or (isinstance(curve, Arc) and abs(curve.sweep) >= math.pi - 1e-6)


def is_smooth(before: Piece, after: Piece) -> bool:
    """Tells whether a piece goes over into the next one without a corner."""
    u, v = before.derivative(1.0), after.derivative(0.0)
    size = math.hypot(*u) * math.hypot(*v)
    return abs(u[0] * v[1] - u[1] * v[0]) <= 1e-6 * size and u[0] * v[0] + u[1] * v[1] > 0


def _is_right(a: Piece, b: Piece) -> bool:
    if not (isinstance(a, Line) and isinstance(b, Line)):
        return False
    u, v = a.derivative(1.0), b.derivative(0.0)
    return abs(u[0] * v[0] + u[1] * v[1]) <= 1e-6 * math.hypot(*u) * math.hypot(*v)


def flipped(at: Vec, axis: int, middle: float) -> Vec:
    return (2 * middle - at[0], at[1]) if axis == 0 else (at[0], 2 * middle - at[1])


def plain(number: int) -> Reading:
    return Reading((number,), lambda z: z[number])


def way(a: Spot, b: Spot, z: Unknowns) -> tuple[complex, complex]:
    (x0, y0), (x1, y1) = a.of(z), b.of(z)
    return x1 - x0, y1 - y0


def dot(u: tuple[complex, complex], v: tuple[complex, complex]) -> complex:
    return u[0] * v[0] + u[1] * v[1]


def cross(u: tuple[complex, complex], v: tuple[complex, complex]) -> complex:
    return u[0] * v[1] - u[1] * v[0]


def _off(a: Spot, center: Spot, radius: int, z: Unknowns) -> complex:
    u = way(a, center, z)
    return dot(u, u) - z[radius] ** 2


def _crossing(a: Spot, b: Spot, c: Spot, d: Spot, axis: int, z: Unknowns) -> complex:
    """Returns where the lines through `a` and `b` and through `c` and `d` meet."""
    u, v = way(a, b, z), way(c, d, z)
    return a.along(axis).of(z) + cross(way(a, c, z), v) / cross(u, v) * u[axis]


# --- What a dimension tells of a sketch: a number of its unknowns, for each place where it is measured.

ALONG = (X_AXIS, Y_AXIS)
End = tuple[Spot, int, float]
"""A point of an outline: a spot, or the tip of what is round about it, with its radius and its side."""


def told(sketch: Sketch, of: Dimension) -> list[Reading] | None:
    """Returns the numbers of a sketch that a dimension tells; None if it measures something else."""
    match of:
        case Length(along=along) if along in ALONG:
            axis = ALONG.index(along)
            low, high = (level(sketch, axis, points) for points in (of.start, of.end))
            return [less(high, low)] if low is not None and high is not None else None
        case Length():
            found = next(_aligned(sketch, of), None)
            return [found] if found is not None else None
        case Roundness(origin="pattern", curve=Circle() as ring):
            return _on_ring(sketch, ring)
        case Roundness(curve=curve):
            known = sketch.round_of(curve)
            return [plain(known.radius)] if known is not None else None
        case Opening():
            return _opening(sketch, of)
    return None


def less(high: Reading, low: Reading) -> Reading:
    return Reading(high.needs + low.needs, lambda z: high.of(z) - low.of(z))


def level(sketch: Sketch, axis: int, points: Sequence[Vec]) -> Reading | None:
    """Returns the level of the first point that is on an outline, else of anything seen at that level."""
    for spot, radius, side in _ends(sketch, points, ALONG[axis]):
        return _tip(spot.along(axis), radius, side)
    value = points[0][axis]
    if (number := sketch.level(axis, value)) is not None:
        return plain(number)
    for own in sketch.rounds:
        for side in (-1.0, 1.0):
            if abs(own.curve.center[axis] + side * own.curve.radius - value) <= sketch.slack:
                return _tip(own.center.along(axis), own.radius, side)
    fixed = sketch.fixed[axis]
    return Reading((), lambda _: value) if fixed is not None and abs(fixed - value) <= sketch.slack else None


def _tip(center: Reading, radius: int, side: float) -> Reading:
    if not side:
        return center
    return Reading((*center.needs, radius), lambda z: center.of(z) + side * z[radius])


def _ends(sketch: Sketch, points: Iterable[Vec], along: Vec) -> Iterator[End]:
    """Yields the points of an outline that lie at some points: spots, and tips of what is round."""
    for p in points:
        if (spot := sketch.spot(p)) is not None:
            yield spot, 0, 0.0
        for own in sketch.rounds:
            (x, y), r = own.curve.center, own.curve.radius
            for side in (-1.0, 1.0):
                if math.dist(p, (x + side * r * along[0], y + side * r * along[1])) <= sketch.slack:
                    yield own.center, own.radius, side


def _aligned(sketch: Sketch, of: Length) -> Iterator[Reading]:
    """Yields the distance of two points, or of a point and an edge at a right angle to it."""
    starts, finishes = (list(_ends(sketch, points, of.along)) for points in (of.start, of.end))
    for a in starts:
        for b in finishes:
            reach = b[0].at[0] - a[0].at[0], b[0].at[1] - a[0].at[1]
            if abs(reach[0] * of.along[1] - reach[1] * of.along[0]) <= sketch.slack:
                sense = math.copysign(1.0, reach[0] * of.along[0] + reach[1] * of.along[1])
                is_far = math.hypot(*reach) > sketch.slack
                yield Reading(_needs(a) + _needs(b), partial(_apart, a, b, sense if is_far else 0.0))
    for found, points in ((starts, of.end), (finishes, of.start)):
        for end in found:
            for edge in sketch.lines:
                (x0, y0), (x1, y1) = edge[0].at, edge[1].at
                size = math.dist(*(spot.at for spot in edge))
                leans = abs((x1 - x0) * of.along[0] + (y1 - y0) * of.along[1])
                off = abs((x1 - x0) * (points[0][1] - y0) - (y1 - y0) * (points[0][0] - x0))
                if leans <= 1e-6 * size and off <= sketch.slack * size:
                    needs = _needs(end) + edge[0].needs + edge[1].needs
                    yield Reading(needs, partial(_from_edge, end, *edge))


def _needs(end: End) -> tuple[int, ...]:
    return (*end[0].needs, end[1]) if end[2] else end[0].needs


def _apart(a: End, b: End, sense: float, z: Unknowns) -> complex:
    """Returns the distance of two ends along the line through them; `sense`: that of their spots to it."""
    u = way(a[0], b[0], z)
    between = sense * dot(u, u) ** 0.5 if sense else 0.0
    return between + b[2] * z[b[1]] - a[2] * z[a[1]]


def _from_edge(end: End, a: Spot, b: Spot, z: Unknowns) -> complex:
    u = way(a, b, z)
    found = cross(u, way(a, end[0], z)) / dot(u, u) ** 0.5
    sense = 1.0 if found.real > 0 else -1.0
    return sense * found + (z[end[1]] if end[2] else 0.0)


def is_on(ring: Circle | Arc, p: Vec, slack: float) -> bool:
    """Tells whether a point lies on a circle."""
    return abs(math.dist(p, ring.center) - ring.radius) <= slack


def _on_ring(sketch: Sketch, ring: Circle) -> list[Reading] | None:
    """Returns where centres at equal steps on a circle are from its centre, if that is seen."""
    seen = (own.center for own in sketch.rounds if own.is_seen)
    middle = next((spot for spot in seen if math.dist(spot.at, ring.center) <= sketch.slack), None)
    if middle is None:
        return None
    circles = (own.center for own in sketch.rounds if isinstance(own.curve, Circle))
    spots = (spot for spot in circles if is_on(ring, spot.at, sketch.slack))
    return [less(spot.along(k), middle.along(k)) for spot in spots for k in (0, 1)]


def _opening(sketch: Sketch, of: Opening) -> list[Reading] | None:
    """Returns the angle of two edges through its corner; the first may be level and not drawn."""
    first, second = (_arm(sketch, of.corner, degrees) for degrees in (of.first, of.first + of.value))
    if second is None or (first is None and abs(math.remainder(of.first, 90)) > 1e-6):
        return None
    level = math.cos(math.radians(of.first)), math.sin(math.radians(of.first))
    needs = tuple(chain(*(spot.needs for spot in (*(first or ()), *second))))
    return [Reading(needs, partial(_lean, first, second, level, math.radians(of.value)))]


def _arm(sketch: Sketch, corner: Vec, degrees: float) -> tuple[Spot, Spot] | None:
    u = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    for a, b in sketch.lines:
        (x0, y0), (x1, y1) = a.at, b.at
        size = math.dist(a.at, b.at)
        is_along = abs((x1 - x0) * u[1] - (y1 - y0) * u[0]) <= 1e-6 * size
        off = abs((corner[0] - x0) * (y1 - y0) - (corner[1] - y0) * (x1 - x0))
        if is_along and off <= sketch.slack * size:
            return (a, b) if (x1 - x0) * u[0] + (y1 - y0) * u[1] > 0 else (b, a)
    return None


def _lean(
    first: tuple[Spot, Spot] | None, second: tuple[Spot, Spot], level: Vec, turn: float, z: Unknowns
) -> complex:
    """Returns a number that is nought where two edges are turned by an angle to each other."""
    u = way(*first, z) if first is not None else level
    v = way(*second, z)
    size = (dot(u, u) * dot(v, v)) ** 0.5
    return (cross(u, v) * math.cos(turn) - dot(u, v) * math.sin(turn)) / size

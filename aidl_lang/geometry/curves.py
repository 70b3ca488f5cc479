"""Exact curves in the plane: numbers only, millimetres and radians."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields, replace
from operator import attrgetter
from typing import Any, ClassVar, Self, TypeAlias, TypeVar, get_args

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record

T = TypeVar("T")
Vec: TypeAlias = tuple[float, float]
Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.intp]
Mask: TypeAlias = NDArray[np.bool_]
Bounds = tuple[float, float, float, float]

_PARALLEL = 1e-9
"""Sine of the angle of two lines up to which they are parallel."""
SLACK = 1e-9
"""Slack in a count of chords, so that rounding does not choose how many there are."""
_SAMPLES = 32
_SAMPLED = np.linspace(0, 1, _SAMPLES + 1)


class _Curve:
    """What can be asked of every curve. It runs over a parameter t from 0 to 1: along a line, through the
    angle of an arc or a circle (from its rightmost point), through the eccentric anomaly of an ellipse, and
    the usual parameter of a Bézier curve.
    """

    __slots__ = ()
    is_closed: ClassVar = False
    """Whether it is a loop by itself."""

    @property
    def ends(self) -> tuple[Vec, Vec]:
        """Start and end; of a closed curve twice the point where its parameter begins."""
        start = self.point(0.0)
        return start, start

    @property
    def box(self) -> Bounds:
        """The tight bounding box: left, bottom, right, top."""
        spots = [*self.ends, *(self.point(t) for t in self.extremes() if 0 < t < 1)]
        xs, ys = [p[0] for p in spots], [p[1] for p in spots]
        return min(xs), min(ys), max(xs), max(ys)

    def point(self, t: float) -> Vec:
        """Returns the point at parameter t; the stored ends at 0 and 1."""
        raise NotImplementedError

    def points(self, t: Floats) -> Floats:
        """Returns the points at many parameters, shape (n, 2)."""
        raise NotImplementedError

    def derivative(self, t: float) -> Vec:
        """Returns the derivative of the point by t."""
        raise NotImplementedError

    def second_derivative(self, t: float) -> Vec:
        return 0.0, 0.0

    def direction(self, t: float) -> Vec:
        """Returns the unit tangent; where control points of a Bézier curve are doubled, that beside it."""
        dx, dy = self.derivative(t)
        size = math.hypot(dx, dy)
        if size <= 1e-9 * math.dist(*self.ends):
            dx, dy = self.derivative(t + 1e-6 if t < 0.5 else t - 1e-6)
            size = math.hypot(dx, dy) or 1.0
        return dx / size, dy / size

    def parallel(self, t: float, left: float) -> Vec:
        """Returns the point at a distance to the left of that at a parameter."""
        (x, y), (dx, dy) = self.point(t), self.direction(t)
        return x - left * dy, y + left * dx

    def extremes(self) -> list[float]:
        """Returns the parameters of tangents parallel to an axis (some may lie outside 0..1)."""
        return []

    def reversed(self) -> Self:
        """Returns the curve run through the other way round; closed curves keep their form."""
        return self

    def chords(self, tolerance: float, share: float = 1.0, widest: float = math.tau / 16) -> int:
        """Returns how many chords keep a tolerance along a share of a curve: at least two, so that a curve
        does not fall flat, and such of which none goes through more than the `widest` angle.
        """
        raise NotImplementedError

    def nearest(self, p: Vec) -> float:
        """Returns the parameter of the point of the curve that is nearest to p."""
        samples = self.points(_SAMPLED)
        away = np.hypot(samples[:, 0] - p[0], samples[:, 1] - p[1])
        # Another stretch may come nearer between two samples than one that has the nearest sample.
        reach = np.abs(np.diff(samples, axis=0)).sum(axis=1).max()
        beside = np.concatenate(([np.inf], away, [np.inf]))
        low = np.flatnonzero((away <= beside[:-2]) & (away <= beside[2:]) & (away <= away.min() + reach))
        found = [self._polished(p, float(_SAMPLED[k])) for k in low]
        return found[0] if len(found) == 1 else min(found, key=lambda t: math.dist(self.point(t), p))

    def _polished(self, p: Vec, t: float) -> float:
        """Solves (C(t) - p)·C'(t) = 0, the slope of the distance, by Newton between the samples at t."""
        low, high = t - 1 / _SAMPLES, t + 1 / _SAMPLES
        if not self.is_closed:
            low, high = max(0.0, low), min(1.0, high)
        for _ in range(60):
            (x, y), (dx, dy), (ax, ay) = self.point(t), self.derivative(t), self.second_derivative(t)
            slope = (x - p[0]) * dx + (y - p[1]) * dy
            bend = dx * dx + dy * dy + (x - p[0]) * ax + (y - p[1]) * ay
            if abs(slope) <= 1e-15 * bend:
                break
            # Where a curve starts without speed, its distance is level, and may fall behind.
            falls = slope < 0 or (slope == 0 >= bend and t == low)
            low, high = (t, high) if falls else (low, t)
            before, t = t, t - slope / bend if bend > 0 else math.nan
            if not low < t < high:
                t = (low + high) / 2
            if abs(t - before) < 1e-15:
                break
        return t % 1.0 if self.is_closed else t

    def locate(self, p: Vec, tolerance: float) -> float | None:
        """Returns the parameter of p if it lies on the curve; else None."""
        t = self.nearest(p)
        return t if math.dist(self.point(t), p) <= tolerance else None

    def is_finite(self, most: float = sys.float_info.max) -> bool:
        """Tells whether every number of the curve is finite, and no larger than that."""
        for value in _VALUES[type(self)](self):
            if not (max(map(abs, value)) <= most if isinstance(value, tuple) else abs(value) <= most):
                return False
        return True


@record(slots=True)
class Line(_Curve):
    kind: ClassVar = "line"
    start: Vec
    end: Vec

    @property
    def ends(self) -> tuple[Vec, Vec]:
        return self.start, self.end

    @property
    def box(self) -> Bounds:
        (x0, y0), (x1, y1) = self.start, self.end
        return min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)

    def point(self, t: float) -> Vec:
        (x0, y0), (x1, y1) = self.start, self.end
        return (x0 + t * (x1 - x0), y0 + t * (y1 - y0)) if t != 1 else self.end

    def points(self, t: Floats) -> Floats:
        start, end = np.array(self.start), np.array(self.end)
        found: Floats = start + np.multiply.outer(t, end - start)
        return found

    @property
    def way(self) -> Vec:
        return self.end[0] - self.start[0], self.end[1] - self.start[1]

    def derivative(self, t: float) -> Vec:
        return self.way

    def chords(self, tolerance: float, share: float = 1.0, widest: float = math.tau / 16) -> int:
        return 1

    def reversed(self) -> Line:
        return Line(self.end, self.start)

    def nearest(self, p: Vec) -> float:
        dx, dy = self.way
        square = dx * dx + dy * dy
        if square == 0:
            return 0.0
        t = ((p[0] - self.start[0]) * dx + (p[1] - self.start[1]) * dy) / square
        return min(1.0, max(0.0, t))

    def part(self, t0: float, t1: float, start: Vec, end: Vec) -> Line:
        """Returns the piece from t0 to t1 (backwards if t1 < t0) with the given ends, which lie on it within
        tolerance. Parameters of closed curves may run past 1.
        """
        return Line(start, end)


@record(slots=True)
class Bezier(_Curve):
    """A cubic by its four control points."""

    kind: ClassVar = "bezier"
    p0: Vec
    p1: Vec
    p2: Vec
    p3: Vec

    @property
    def ends(self) -> tuple[Vec, Vec]:
        return self.p0, self.p3

    def point(self, t: float) -> Vec:
        if t == 1:
            return self.p3
        s = 1 - t
        a, b, c, d = s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t
        return (
            a * self.p0[0] + b * self.p1[0] + c * self.p2[0] + d * self.p3[0],
            a * self.p0[1] + b * self.p1[1] + c * self.p2[1] + d * self.p3[1],
        )

    def points(self, t: Floats) -> Floats:
        found: Floats = (_WEIGHTS if t is _SAMPLED else _weights(t)) @ np.array(_VALUES[Bezier](self))
        return found

    def derivative(self, t: float) -> Vec:
        s = 1 - t
        a, b, c = 3 * s * s, 6 * s * t, 3 * t * t
        p0, p1, p2, p3 = self.p0, self.p1, self.p2, self.p3
        return (
            a * (p1[0] - p0[0]) + b * (p2[0] - p1[0]) + c * (p3[0] - p2[0]),
            a * (p1[1] - p0[1]) + b * (p2[1] - p1[1]) + c * (p3[1] - p2[1]),
        )

    def second_derivative(self, t: float) -> Vec:
        a, b = 6 * (1 - t), 6 * t
        p0, p1, p2, p3 = self.p0, self.p1, self.p2, self.p3
        x = a * (p0[0] - 2 * p1[0] + p2[0]) + b * (p1[0] - 2 * p2[0] + p3[0])
        y = a * (p0[1] - 2 * p1[1] + p2[1]) + b * (p1[1] - 2 * p2[1] + p3[1])
        return x, y

    def extremes(self) -> list[float]:
        return [t for axis in (0, 1) for t in self._extremes(axis)]

    def _extremes(self, axis: int) -> list[float]:
        p0, p1, p2, p3 = (p[axis] for p in (self.p0, self.p1, self.p2, self.p3))
        a, b, c = p3 - 3 * p2 + 3 * p1 - p0, 2 * (p2 - 2 * p1 + p0), p1 - p0
        if abs(a) <= 1e-14 * (abs(b) + abs(c)):
            return [-c / b] if b else []
        root = b * b - 4 * a * c
        if root < 0:
            return []
        q = -(b + math.copysign(math.sqrt(root), b)) / 2
        return [q / a] + ([c / q] if q else [])

    def chords(self, tolerance: float, share: float = 1.0, widest: float = math.tau / 16) -> int:
        bend = max(math.hypot(*self.second_derivative(t)) for t in (0.0, 1.0))
        return max(3, math.ceil(share * math.sqrt(bend / (8 * tolerance)) - SLACK))

    def reversed(self) -> Bezier:
        return Bezier(self.p3, self.p2, self.p1, self.p0)

    def part(self, t0: float, t1: float, start: Vec, end: Vec) -> Bezier:
        # The inner points of a part are p0 + p'(t)·Δt/3 at both ends (Farin, Curves and Surfaces).
        step = (t1 - t0) / 3
        (ax, ay), (bx, by) = self.derivative(t0), self.derivative(t1)
        p1, p2 = (start[0] + step * ax, start[1] + step * ay), (end[0] - step * bx, end[1] - step * by)
        return Bezier(start, p1, p2, end)


class _Round(_Curve):
    """A curve with the points center + R(angle) (rx cos u, ry sin u) for u from `first` through `sweep`."""

    __slots__ = ()

    @property
    def frame(self) -> tuple[Vec, float, float, float, float, float]:
        """`center`, `rx`, `ry`, `angle`, `first` and `sweep`."""
        raise NotImplementedError

    @property
    def range(self) -> tuple[float, float]:
        """The first angle (eccentric anomaly for ellipses) and the sweep, in radians."""
        return self.frame[4:]

    def point(self, t: float) -> Vec:
        if t in (0, 1) and not self.is_closed:
            return self.ends[int(t)]
        center, rx, ry, angle, first, sweep = self.frame
        x, y = rx * math.cos(first + t * sweep), ry * math.sin(first + t * sweep)
        c, s = math.cos(angle), math.sin(angle)
        return center[0] + c * x - s * y, center[1] + s * x + c * y

    def points(self, t: Floats) -> Floats:
        center, rx, ry, angle, first, sweep = self.frame
        u = first + sweep * t
        x, y = rx * np.cos(u), ry * np.sin(u)
        c, s = math.cos(angle), math.sin(angle)
        return np.stack((center[0] + c * x - s * y, center[1] + s * x + c * y), axis=1)

    def derivative(self, t: float) -> Vec:
        _, rx, ry, angle, first, sweep = self.frame
        u = first + t * sweep
        x, y = -rx * math.sin(u) * sweep, ry * math.cos(u) * sweep
        c, s = math.cos(angle), math.sin(angle)
        return c * x - s * y, s * x + c * y

    def second_derivative(self, t: float) -> Vec:
        (cx, cy), *_, sweep = self.frame
        square, (x, y) = sweep**2, self.point(t)
        return -square * (x - cx), -square * (y - cy)

    def extremes(self) -> list[float]:
        _, rx, ry, angle, first, sweep = self.frame
        c, s = math.cos(angle), math.sin(angle)
        across = math.atan2(-ry * s, rx * c)
        along = math.atan2(ry * c, rx * s)
        turn = math.copysign(math.tau, sweep)
        return [((a - first) % turn) / sweep for a in (across, across + math.pi, along, along + math.pi)]

    def chords(self, tolerance: float, share: float = 1.0, widest: float = math.tau / 16) -> int:
        _, rx, ry, *_, sweep = self.frame
        step = min(widest, 4 * math.asin(math.sqrt(min(1.0, tolerance / (2 * max(rx, ry))))))
        return max(2, math.ceil(abs(sweep) * share / step - SLACK))


class _Circular(_Round):
    __slots__ = ()

    def nearest(self, p: Vec) -> float:
        (x, y), *_, first, sweep = self.frame
        angle = math.atan2(p[1] - y, p[0] - x)
        t = ((angle - first) % math.copysign(math.tau, sweep)) / sweep
        if t <= 1:
            return t
        # Off the arc: the nearer end, halfway round the gap.
        return 1.0 if t < (1 + math.tau / abs(sweep)) / 2 else 0.0

    def part(self, t0: float, t1: float, start: Vec, end: Vec) -> Self | Arc:
        if self.is_closed and abs(t1 - t0) >= 1:
            return self
        center, radius, *_, sweep = self.frame
        return Arc(center, radius, start, end, (t1 - t0) * sweep)


@record(slots=True)
class Arc(_Circular):
    """From `start` about `center` through `sweep` radians, positive counter-clockwise, 0 < |sweep| <= 2 pi.

    `end` is stored, so that chained curves share their end points to the last digit.
    """

    kind: ClassVar = "arc"
    center: Vec
    radius: float
    start: Vec
    end: Vec
    sweep: float

    @property
    def start_angle(self) -> float:
        return math.atan2(self.start[1] - self.center[1], self.start[0] - self.center[0])

    @property
    def ends(self) -> tuple[Vec, Vec]:
        return self.start, self.end

    @property
    def frame(self) -> tuple[Vec, float, float, float, float, float]:
        return self.center, self.radius, self.radius, 0.0, self.start_angle, self.sweep

    def reversed(self) -> Arc:
        return replace(self, start=self.end, end=self.start, sweep=-self.sweep)


@record(slots=True)
class Circle(_Circular):
    kind: ClassVar = "circle"
    is_closed: ClassVar = True
    center: Vec
    radius: float

    @property
    def frame(self) -> tuple[Vec, float, float, float, float, float]:
        return self.center, self.radius, self.radius, 0.0, 0.0, math.tau

    @property
    def box(self) -> Bounds:
        (x, y), r = self.center, self.radius
        return x - r, y - r, x + r, y + r


class _Elliptic(_Round):
    __slots__ = ()

    def part(self, t0: float, t1: float, start: Vec, end: Vec) -> Self | EllipseArc:
        if self.is_closed and abs(t1 - t0) >= 1:
            return self
        center, rx, ry, angle, first, sweep = self.frame
        first = math.remainder(first + t0 * sweep, math.tau)
        return EllipseArc(center, rx, ry, angle, start, end, first, (t1 - t0) * sweep)


@record(slots=True)
class Ellipse(_Elliptic):
    """`rx` along `angle` (radians from the x axis), `ry` across it."""

    kind: ClassVar = "ellipse"
    is_closed: ClassVar = True
    center: Vec
    rx: float
    ry: float
    angle: float

    @property
    def frame(self) -> tuple[Vec, float, float, float, float, float]:
        return self.center, self.rx, self.ry, self.angle, 0.0, math.tau


@record(slots=True)
class EllipseArc(_Elliptic):
    """A piece of an ellipse, as booleans leave it, through `sweep` radians of the eccentric anomaly."""

    kind: ClassVar = "ellipse_arc"
    center: Vec
    rx: float
    ry: float
    angle: float
    start: Vec
    end: Vec
    first: float
    sweep: float

    @property
    def ends(self) -> tuple[Vec, Vec]:
        return self.start, self.end

    @property
    def frame(self) -> tuple[Vec, float, float, float, float, float]:
        return self.center, self.rx, self.ry, self.angle, self.first, self.sweep

    def reversed(self) -> EllipseArc:
        first = self.first + self.sweep
        return replace(self, start=self.end, end=self.start, first=first, sweep=-self.sweep)


Curve: TypeAlias = Line | Arc | Circle | Ellipse | Bezier
Piece: TypeAlias = Line | Arc | Circle | Ellipse | EllipseArc | Bezier
"""A curve of an outline of a region, or an exact part of one."""

FIELDS = {kind: tuple(field.name for field in fields(kind)) for kind in get_args(Piece)}
"""The numbers and points of each curve by their names: what `angle` is a direction, `first` and `sweep` run
counter-clockwise, and any other number a length.
"""
_VALUES: dict[type, Callable[[object], tuple[Any, ...]]] = {
    kind: attrgetter(*names) for kind, names in FIELDS.items()
}
KINDS = frozenset(kind.kind for kind in FIELDS)


def _weights(t: Floats) -> Floats:
    """Returns the shares of the control points of a cubic in its points at these parameters."""
    s = 1 - t
    return np.stack((s**3, 3 * s * s * t, 3 * s * t * t, t**3), axis=1)


_WEIGHTS = _weights(_SAMPLED)


def image(
    curve: Piece,
    at: Callable[[Vec], Vec],
    scale: float = 1.0,
    turned: Callable[[float], float] = lambda direction: direction,
    sense: float = 1.0,
) -> Piece:
    """Returns the curve after a similarity, given as maps of points, lengths, directions and turns."""

    def moved(name: str, value: Any) -> Any:
        if isinstance(value, tuple):
            return at(value)
        if name == "angle":
            return turned(value)
        return (sense if name in ("first", "sweep") else scale) * value

    return replace(curve, **{name: moved(name, getattr(curve, name)) for name in FIELDS[type(curve)]})


def inward(curve: Piece, origin: Vec, rotation: float, mirrored: bool) -> Piece:
    """Returns a curve as seen in a frame: from an origin, reflected in x if mirrored, turned by degrees."""
    angle = math.radians(rotation)
    c, s = math.cos(angle), math.sin(angle)
    flip = -1.0 if mirrored else 1.0

    def at(p: Vec) -> Vec:
        x, y = p[0] - origin[0], p[1] - origin[1]
        return flip * (c * x + s * y), c * y - s * x

    def turned(direction: float) -> float:
        return math.pi - (direction - angle) if mirrored else direction - angle

    return image(curve, at, turned=turned, sense=flip)


def in_runs(things: Iterable[T], follows: Callable[[T, T], bool]) -> list[list[T]]:
    """Returns things in runs, in which each follows the one before it."""
    runs: list[list[T]] = []
    for thing in things:
        if runs and follows(runs[-1][-1], thing):
            runs[-1].append(thing)
        else:
            runs.append([thing])
    return runs


def turn_between(a: Vec, b: Vec) -> float:
    """Returns the angle from one direction to another in radians, positive counter-clockwise."""
    return math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])


def meeting(a: Line, b: Line) -> Vec | None:
    """Returns the crossing of two endless lines; None if they are parallel."""
    (ux, uy), (vx, vy) = a.way, b.way
    cross = ux * vy - uy * vx
    if abs(cross) <= _PARALLEL * math.hypot(ux, uy) * math.hypot(vx, vy):
        return None
    t = ((b.start[0] - a.start[0]) * vy - (b.start[1] - a.start[1]) * vx) / cross
    return a.start[0] + t * ux, a.start[1] + t * uy


# --- Boxes.

LARGEST = 1e12
"""Coordinates beyond this, in mm, are a mistake and are not drawn."""

NO_LENGTH = 1e-7
"""Extent of a curve, in mm, that is none: its ends were made to meet, or its size to vanish."""


def are_near(a: Bounds, b: Bounds) -> bool:
    """Tells whether two boxes touch or overlap."""
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]


def union_bounds(boxes: Sequence[Bounds]) -> Bounds:
    if not boxes:
        return 0.0, 0.0, 0.0, 0.0
    lefts, bottoms, rights, tops = zip(*boxes, strict=True)
    return min(lefts), min(bottoms), max(rights), max(tops)


def larger_side(box: Bounds) -> float:
    return max(box[2] - box[0], box[3] - box[1])


def extent(curves: Iterable[Piece]) -> float:
    """Returns the larger side of what some curves cover, 1 if that is nothing."""
    return larger_side(union_bounds([curve.box for curve in curves])) or 1.0


def usable(curve: Piece) -> Piece | None:
    """Returns the curve with positive radii; None if it has no finite coordinates, or a radius is nothing."""
    if not curve.is_finite():
        return None
    if isinstance(curve, Circle | Arc):
        return replace(curve, radius=abs(curve.radius)) if curve.radius else None
    if isinstance(curve, Ellipse):
        curve = Ellipse(curve.center, abs(curve.rx), abs(curve.ry), curve.angle)
        return curve if curve.rx * curve.ry > 0 else None
    return curve


def has_extent(box: Bounds) -> bool:
    if not all(map(math.isfinite, box)) or max(map(abs, box)) > LARGEST:
        return False
    return math.hypot(box[2] - box[0], box[3] - box[1]) >= NO_LENGTH

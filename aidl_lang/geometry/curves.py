"""Exact curves in the plane: numbers only, millimetres and radians."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields, replace
from operator import attrgetter
from typing import Any, ClassVar, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record

Vec: TypeAlias = tuple[float, float]
Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.intp]
Mask: TypeAlias = NDArray[np.bool_]


@record(slots=True)
class Line:
    kind: ClassVar = "line"
    start: Vec
    end: Vec


@record(slots=True)
class Arc:
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


@record(slots=True)
class Circle:
    kind: ClassVar = "circle"
    center: Vec
    radius: float


@record(slots=True)
class Ellipse:
    """`rx` along `angle` (radians from the x axis), `ry` across it."""

    kind: ClassVar = "ellipse"
    center: Vec
    rx: float
    ry: float
    angle: float


@record(slots=True)
class Bezier:
    """A cubic by its four control points."""

    kind: ClassVar = "bezier"
    p0: Vec
    p1: Vec
    p2: Vec
    p3: Vec


@record(slots=True)
class EllipseArc:
    """A piece of an ellipse, as booleans leave it, through `sweep` radians of the eccentric anomaly.

    Its points are center + R(angle) (rx cos u, ry sin u) for u from `first` to `first + sweep`.
    """

    kind: ClassVar = "ellipse_arc"
    center: Vec
    rx: float
    ry: float
    angle: float
    start: Vec
    end: Vec
    first: float
    sweep: float


Curve: TypeAlias = Line | Arc | Circle | Ellipse | Bezier
Piece: TypeAlias = Line | Arc | Circle | Ellipse | EllipseArc | Bezier
"""A curve of an outline of a region, or an exact part of one."""

FIELDS = {kind: tuple(field.name for field in fields(kind)) for kind in get_args(Piece)}
"""The numbers and points of each curve by their names: what `angle` is a direction, `first` and `sweep` run
counter-clockwise, and any other number a length.
"""

KINDS = frozenset(kind.kind for kind in FIELDS)


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


# --- Points, directions, parts and bounds of exact curves.
#
# Every curve runs over a parameter t from 0 to 1: along a line, through the angle of an arc or a circle
# (from its rightmost point), through the eccentric anomaly of an ellipse, and the usual parameter of a
# Bézier curve.

TAU = 2 * math.pi
_SAMPLES = 32
_MANY = 16
"""Curves from which on it takes less to work them out at once."""
Bounds = tuple[float, float, float, float]

LARGEST = 1e12
"""Coordinates beyond this, in mm, are a mistake and are not drawn."""

NO_LENGTH = 1e-7
"""Extent of a curve, in mm, that is none: its ends were made to meet, or its size to vanish."""


_VALUES = {kind: attrgetter(*names) for kind, names in FIELDS.items()}


def is_finite(curve: Piece, most: float = sys.float_info.max) -> bool:
    """Tells whether every number of the curve is finite, and no larger than that."""
    for value in _VALUES[type(curve)](curve):
        if not (max(map(abs, value)) <= most if isinstance(value, tuple) else abs(value) <= most):
            return False
    return True


def is_closed(curve: Piece) -> bool:
    """Tells whether the curve is a loop by itself."""
    return isinstance(curve, Circle | Ellipse)


def round_range(curve: Arc | Circle | Ellipse | EllipseArc) -> tuple[float, float]:
    """Returns the first angle (eccentric anomaly for ellipses) and the sweep, in radians."""
    if isinstance(curve, Arc):
        return curve.start_angle, curve.sweep
    return (curve.first, curve.sweep) if isinstance(curve, EllipseArc) else (0.0, TAU)


def point(curve: Piece, t: float) -> Vec:
    """Returns the point at parameter t; the stored ends at 0 and 1."""
    if isinstance(curve, Line):
        (x0, y0), (x1, y1) = curve.start, curve.end
        return (x0 + t * (x1 - x0), y0 + t * (y1 - y0)) if t != 1 else curve.end
    if isinstance(curve, Bezier):
        return _bezier_point(curve, t)
    if isinstance(curve, Arc | EllipseArc) and t in (0, 1):
        return curve.end if t else curve.start
    first, sweep = round_range(curve)
    angle = first + t * sweep
    if isinstance(curve, Ellipse | EllipseArc):
        x, y = curve.rx * math.cos(angle), curve.ry * math.sin(angle)
        c, s = math.cos(curve.angle), math.sin(curve.angle)
        return curve.center[0] + c * x - s * y, curve.center[1] + s * x + c * y
    return (
        curve.center[0] + curve.radius * math.cos(angle),
        curve.center[1] + curve.radius * math.sin(angle),
    )


def _bezier_point(curve: Bezier, t: float) -> Vec:
    if t == 1:
        return curve.p3
    s = 1 - t
    a, b, c, d = s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t
    return (
        a * curve.p0[0] + b * curve.p1[0] + c * curve.p2[0] + d * curve.p3[0],
        a * curve.p0[1] + b * curve.p1[1] + c * curve.p2[1] + d * curve.p3[1],
    )


def _weights(t: Floats) -> Floats:
    """Returns the shares of the control points of a cubic in its points at these parameters."""
    s = 1 - t
    return np.stack((s**3, 3 * s * s * t, 3 * s * t * t, t**3), axis=1)


_SAMPLED = np.linspace(0, 1, _SAMPLES + 1)
_WEIGHTS = _weights(_SAMPLED)


def points(curve: Piece, t: Floats) -> Floats:
    """Returns the points at many parameters, shape (n, 2)."""
    if isinstance(curve, Line):
        start, end = np.array(curve.start), np.array(curve.end)
        straight: Floats = start + np.multiply.outer(t, end - start)
        return straight
    if isinstance(curve, Bezier):
        weights = _WEIGHTS if t is _SAMPLED else _weights(t)
        curved: Floats = weights @ np.array(_VALUES[Bezier](curve))
        return curved
    first, sweep = round_range(curve)
    u = first + sweep * t
    cos, sin = np.cos(u), np.sin(u)
    if isinstance(curve, Arc | Circle):
        return np.stack((curve.center[0] + curve.radius * cos, curve.center[1] + curve.radius * sin), axis=1)
    c, s_ = math.cos(curve.angle), math.sin(curve.angle)
    x, y = curve.rx * cos, curve.ry * sin
    return np.stack((curve.center[0] + c * x - s_ * y, curve.center[1] + s_ * x + c * y), axis=1)


def derivative(curve: Piece, t: float) -> Vec:
    """Returns the derivative of the point by t."""
    if isinstance(curve, Line):
        return curve.end[0] - curve.start[0], curve.end[1] - curve.start[1]
    if isinstance(curve, Bezier):
        return _bezier_derivative(curve, t)
    first, sweep = round_range(curve)
    u = first + t * sweep
    if isinstance(curve, Arc | Circle):
        return -curve.radius * sweep * math.sin(u), curve.radius * sweep * math.cos(u)
    x, y = -curve.rx * math.sin(u) * sweep, curve.ry * math.cos(u) * sweep
    c, s = math.cos(curve.angle), math.sin(curve.angle)
    return c * x - s * y, s * x + c * y


def _bezier_derivative(curve: Bezier, t: float) -> Vec:
    s = 1 - t
    a, b, c = 3 * s * s, 6 * s * t, 3 * t * t
    p0, p1, p2, p3 = curve.p0, curve.p1, curve.p2, curve.p3
    return (
        a * (p1[0] - p0[0]) + b * (p2[0] - p1[0]) + c * (p3[0] - p2[0]),
        a * (p1[1] - p0[1]) + b * (p2[1] - p1[1]) + c * (p3[1] - p2[1]),
    )


def ends(curve: Piece) -> tuple[Vec, Vec]:
    """Returns start and end; for a closed curve twice the point where its parameter begins."""
    if isinstance(curve, Line | Arc | EllipseArc):
        return curve.start, curve.end
    if isinstance(curve, Bezier):
        return curve.p0, curve.p3
    start = point(curve, 0.0)
    return start, start


def reverse(curve: Piece) -> Piece:
    """Returns the curve run through the other way round; closed curves keep their form."""
    if isinstance(curve, Line):
        return Line(curve.end, curve.start)
    if isinstance(curve, Arc):
        return replace(curve, start=curve.end, end=curve.start, sweep=-curve.sweep)
    if isinstance(curve, EllipseArc):
        first = curve.first + curve.sweep
        return replace(curve, start=curve.end, end=curve.start, first=first, sweep=-curve.sweep)
    if isinstance(curve, Bezier):
        return Bezier(curve.p3, curve.p2, curve.p1, curve.p0)
    return curve


def turn_between(a: Vec, b: Vec) -> float:
    """Returns the angle from one direction to another in radians, positive counter-clockwise."""
    return math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])


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


def part(curve: Piece, t0: float, t1: float, start: Vec, end: Vec) -> Piece:
    """Returns the piece from t0 to t1 (backwards if t1 < t0) with the given ends, which lie on it within
    tolerance.

    Parameters of closed curves may run past 1.
    """
    if isinstance(curve, Line):
        return Line(start, end)
    if isinstance(curve, Bezier):
        return _bezier_part(curve, t0, t1, start, end)
    if is_closed(curve) and abs(t1 - t0) >= 1:
        return curve
    first, sweep = round_range(curve)
    if isinstance(curve, Arc | Circle):
        return Arc(curve.center, curve.radius, start, end, (t1 - t0) * sweep)
    first = math.remainder(first + t0 * sweep, TAU)
    return EllipseArc(curve.center, curve.rx, curve.ry, curve.angle, start, end, first, (t1 - t0) * sweep)


def _bezier_part(curve: Bezier, t0: float, t1: float, start: Vec, end: Vec) -> Bezier:
    """Returns a part; its inner points are p0 + p'(t)·Δt/3 at both ends (Farin, Curves and Surfaces)."""
    step = (t1 - t0) / 3
    d0, d1 = _bezier_derivative(curve, t0), _bezier_derivative(curve, t1)
    return Bezier(
        start,
        (start[0] + step * d0[0], start[1] + step * d0[1]),
        (end[0] - step * d1[0], end[1] - step * d1[1]),
        end,
    )


def bounds(curve: Piece) -> Bounds:
    """Returns the tight bounding box: left, bottom, right, top."""
    if isinstance(curve, Line):
        (x0, y0), (x1, y1) = curve.start, curve.end
        return min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)
    if isinstance(curve, Circle):
        (x, y), r = curve.center, curve.radius
        return x - r, y - r, x + r, y + r
    ts = [t for t in extreme_parameters(curve) if 0 < t < 1]
    spots = [*ends(curve), *(point(curve, t) for t in ts)]
    xs, ys = [p[0] for p in spots], [p[1] for p in spots]
    return min(xs), min(ys), max(xs), max(ys)


def are_near(a: Bounds, b: Bounds) -> bool:
    """Tells whether two boxes touch or overlap."""
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]


def all_bounds(curves: Iterable[Piece]) -> list[Bounds]:
    """Returns the bounding box of each of some curves; those of many cubics are worked out at once."""
    every = list(curves)
    cubics = [k for k, curve in enumerate(every) if isinstance(curve, Bezier)]
    if len(cubics) < _MANY:
        return [bounds(curve) for curve in every]
    p = np.array([_VALUES[Bezier](every[k]) for k in cubics]).transpose(1, 0, 2)
    a, b, c = p[3] - 3 * p[2] + 3 * p[1] - p[0], 2 * (p[2] - 2 * p[1] + p[0]), p[1] - p[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        q = -(b + np.copysign(np.sqrt(b * b - 4 * a * c), b)) / 2
        is_flat = np.abs(a) <= 1e-14 * (np.abs(b) + np.abs(c))
        t = np.stack((np.where(is_flat, -c / b, q / a), c / q))
    t = np.where((t > 0) & (t < 1), t, 0.0)
    s = 1 - t
    extremes = s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3]
    spots = np.concatenate((extremes, p[:1], p[3:]))
    boxes = iter(np.concatenate((spots.min(axis=0), spots.max(axis=0)), axis=1).tolist())
    return [tuple(next(boxes)) if isinstance(curve, Bezier) else bounds(curve) for curve in every]


def extreme_parameters(curve: Piece) -> list[float]:
    """Parameters at which the tangent is parallel to an axis (some may lie outside 0..1)."""
    if isinstance(curve, Line):
        return []
    if isinstance(curve, Bezier):
        return [t for axis in (0, 1) for t in _bezier_extremes(curve, axis)]
    first, sweep = round_range(curve)
    if isinstance(curve, Arc | Circle):
        angles = [k * math.pi / 2 for k in range(4)]
    else:
        c, s = math.cos(curve.angle), math.sin(curve.angle)
        across = math.atan2(-curve.ry * s, curve.rx * c)
        along = math.atan2(curve.ry * c, curve.rx * s)
        angles = [across, across + math.pi, along, along + math.pi]
    turn = math.copysign(TAU, sweep)
    return [((a - first) % turn) / sweep for a in angles]


def _bezier_extremes(curve: Bezier, axis: int) -> list[float]:
    p0, p1, p2, p3 = (p[axis] for p in (curve.p0, curve.p1, curve.p2, curve.p3))
    a, b, c = p3 - 3 * p2 + 3 * p1 - p0, 2 * (p2 - 2 * p1 + p0), p1 - p0
    if abs(a) <= 1e-14 * (abs(b) + abs(c)):
        return [-c / b] if b else []
    root = b * b - 4 * a * c
    if root < 0:
        return []
    q = -(b + math.copysign(math.sqrt(root), b)) / 2
    return [q / a] + ([c / q] if q else [])


def nearest(curve: Piece, p: Vec) -> float:
    """Returns the parameter of the point of the curve that is nearest to p."""
    if isinstance(curve, Line):
        return _nearest_on_line(curve, p)
    if isinstance(curve, Arc | Circle):
        return _nearest_on_round(curve, p)
    samples = points(curve, _SAMPLED)
    away = np.hypot(samples[:, 0] - p[0], samples[:, 1] - p[1])
    # Another stretch of the curve may come nearer between two samples than one that has the nearest sample.
    reach = np.abs(np.diff(samples, axis=0)).sum(axis=1).max()
    beside = np.concatenate(([np.inf], away, [np.inf]))
    low = np.flatnonzero((away <= beside[:-2]) & (away <= beside[2:]) & (away <= away.min() + reach))
    found = [_polish_nearest(curve, p, float(_SAMPLED[k])) for k in low]
    return found[0] if len(found) == 1 else min(found, key=lambda t: math.dist(point(curve, t), p))


def _nearest_on_line(curve: Line, p: Vec) -> float:
    dx, dy = curve.end[0] - curve.start[0], curve.end[1] - curve.start[1]
    square = dx * dx + dy * dy
    if square == 0:
        return 0.0
    t = ((p[0] - curve.start[0]) * dx + (p[1] - curve.start[1]) * dy) / square
    return min(1.0, max(0.0, t))


def _nearest_on_round(curve: Arc | Circle, p: Vec) -> float:
    first, sweep = round_range(curve)
    angle = math.atan2(p[1] - curve.center[1], p[0] - curve.center[0])
    t = ((angle - first) % math.copysign(TAU, sweep)) / sweep
    if t <= 1:
        return t
    # Off the arc: the nearer end, halfway round the gap.
    return 1.0 if t < (1 + TAU / abs(sweep)) / 2 else 0.0


def _polish_nearest(curve: Piece, p: Vec, t: float) -> float:
    """Solves (C(t) - p)·C'(t) = 0, the slope of the distance, by Newton between the samples at t."""
    wraps = is_closed(curve)
    low, high = t - 1 / _SAMPLES, t + 1 / _SAMPLES
    if not wraps:
        low, high = max(0.0, low), min(1.0, high)
    for _ in range(60):
        (x, y), (dx, dy), (ax, ay) = point(curve, t), derivative(curve, t), second_derivative(curve, t)
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
    return t % 1.0 if wraps else t


def second_derivative(curve: Piece, t: float) -> Vec:
    if isinstance(curve, Bezier):
        a, b = 6 * (1 - t), 6 * t
        p0, p1, p2, p3 = curve.p0, curve.p1, curve.p2, curve.p3
        x = a * (p0[0] - 2 * p1[0] + p2[0]) + b * (p1[0] - 2 * p2[0] + p3[0])
        y = a * (p0[1] - 2 * p1[1] + p2[1]) + b * (p1[1] - 2 * p2[1] + p3[1])
        return x, y
    if isinstance(curve, Line):
        return 0.0, 0.0
    square = round_range(curve)[1] ** 2
    x, y = point(curve, t)
    return -square * (x - curve.center[0]), -square * (y - curve.center[1])


def locate(curve: Piece, p: Vec, tolerance: float) -> float | None:
    """Returns the parameter of p if it lies on the curve; else None."""
    t = nearest(curve, p)
    return t if math.dist(point(curve, t), p) <= tolerance else None


def union_bounds(boxes: Sequence[Bounds]) -> Bounds:
    if not boxes:
        return 0.0, 0.0, 0.0, 0.0
    lefts, bottoms, rights, tops = zip(*boxes, strict=True)
    return min(lefts), min(bottoms), max(rights), max(tops)


def larger_side(box: Bounds) -> float:
    return max(box[2] - box[0], box[3] - box[1])


def usable(curve: Piece) -> Piece | None:
    """Returns the curve with positive radii; None if it has no finite coordinates, or a radius is nothing."""
    if not is_finite(curve):
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

"""The curves of a drawing file: lines and cubic Bézier curves by points, arcs of ellipses, B-splines."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeAlias

from aidl_lang.common.font_files import Curve, Vec
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint

if TYPE_CHECKING:
    from ezdxf.math import BSpline


# --- The curves of a drawing file: lines and cubic Bézier curves by their points, and arcs of ellipses, of
# which circles are a kind. An affine map of each is one of the same sort, exactly.

TURN = 2 * math.pi

Matrix: TypeAlias = tuple[float, float, float, float, float, float]
"""a, b, c, d, e, f of the map (x, y) → (a x + c y + e, b x + d y + f), as SVG writes it."""

STILL: Matrix = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)


@record(slots=True)
class Bow:
    """An arc of an ellipse: the points center + u cos t + v sin t, for t from `first` to `first + sweep`.

    u, v  any two conjugate half-diameters: an affine map of the arc maps them
    start, end  are stored, so that curves that follow one another share them to the last digit
    """

    center: Vec
    u: Vec
    v: Vec
    first: float
    sweep: float
    start: Vec
    end: Vec

    @property
    def is_whole(self) -> bool:
        return abs(self.sweep) >= TURN

    def at(self, t: float) -> Vec:
        """Returns the point at a parameter."""
        c, s = math.cos(t), math.sin(t)
        return (
            self.center[0] + self.u[0] * c + self.v[0] * s,
            self.center[1] + self.u[1] * c + self.v[1] * s,
        )


Stroke: TypeAlias = Curve | Bow


def ellipse(center: Vec, u: Vec, v: Vec) -> Bow:
    """Returns a whole ellipse by two conjugate half-diameters."""
    start = center[0] + u[0], center[1] + u[1]
    return Bow(center, u, v, 0.0, TURN, start, start)


def circle(center: Vec, radius: float) -> Bow:
    return ellipse(center, (radius, 0.0), (0.0, radius))


def product(outer: Matrix, inner: Matrix) -> Matrix:
    """Returns the map that does `inner` first."""
    a, b, c, d, e, f = outer
    g, h, i, j, k, m = inner
    return (
        a * g + c * h,
        b * g + d * h,
        a * i + c * j,
        b * i + d * j,
        a * k + c * m + e,
        b * k + d * m + f,
    )


def mapped(stroke: Stroke, matrix: Matrix) -> Stroke:
    """Returns the image of a stroke."""
    a, b, c, d, e, f = matrix

    def at(p: Vec) -> Vec:
        return a * p[0] + c * p[1] + e, b * p[0] + d * p[1] + f

    if not isinstance(stroke, Bow):
        return tuple(map(at, stroke))
    u, v = ((a * x + c * y, b * x + d * y) for x, y in (stroke.u, stroke.v))
    return Bow(at(stroke.center), u, v, stroke.first, stroke.sweep, at(stroke.start), at(stroke.end))


def ends(stroke: Stroke) -> tuple[Vec, Vec]:
    if isinstance(stroke, Bow):
        return stroke.start, stroke.end
    return stroke[0], stroke[-1]


def numbers(stroke: Stroke) -> Iterator[float]:
    """Yields every coordinate, to be checked."""
    if isinstance(stroke, Bow):
        stroke = stroke.start, stroke.end, stroke.u, stroke.v, stroke.center
    for p in stroke:
        yield from p


def has_length(stroke: Stroke) -> bool:
    """Tells whether a stroke is more than a single point."""
    if isinstance(stroke, Bow):
        return stroke.sweep != 0.0 and math.hypot(*stroke.u, *stroke.v) > 0.0
    return len(set(stroke)) > 1


def quadratic(a: Vec, b: Vec, c: Vec) -> Curve:
    """Returns a quadratic Bézier curve as the same cubic one."""
    one = (a[0] + 2 * b[0]) / 3, (a[1] + 2 * b[1]) / 3
    two = (c[0] + 2 * b[0]) / 3, (c[1] + 2 * b[1]) / 3
    return a, one, two, c


# --- How far strokes reach -------------------------------------------------------------------------


def furthest(strokes: Iterable[Stroke], way: Vec) -> float:
    """Returns the greatest product of a point of the strokes with a vector."""
    return max(_furthest(stroke, way) for stroke in strokes)


def box(strokes: Iterable[Stroke]) -> tuple[float, float, float, float]:
    """Returns left, bottom, right and top of the strokes, tight."""
    strokes = tuple(strokes)
    left, bottom = (-furthest(strokes, way) for way in ((-1.0, 0.0), (0.0, -1.0)))
    right, top = (furthest(strokes, way) for way in ((1.0, 0.0), (0.0, 1.0)))
    return left, bottom, right, top


def _furthest(stroke: Stroke, way: Vec) -> float:
    def along(p: Vec) -> float:
        return p[0] * way[0] + p[1] * way[1]

    best = max(map(along, ends(stroke)))
    if isinstance(stroke, Bow):
        across, up = along(stroke.u), along(stroke.v)
        if _passes(stroke, math.atan2(up, across)):
            best = max(best, along(stroke.center) + math.hypot(across, up))
        return best
    if len(stroke) < 4:
        return best
    a, b, c, d = map(along, stroke)
    for t in _turning_points(a, b, c, d):
        s = 1.0 - t
        best = max(best, s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d)
    return best


def _passes(bow: Bow, t: float) -> bool:
    """Tells whether an arc goes through a parameter."""
    ahead = (t - bow.first) * math.copysign(1.0, bow.sweep) % TURN
    return ahead <= abs(bow.sweep)


def _turning_points(a: float, b: float, c: float, d: float) -> Iterator[float]:
    """Yields where the derivative of a cubic Bézier function is 0, between its ends."""
    p, q, r = d - 3 * c + 3 * b - a, 2 * (c - 2 * b + a), b - a
    if p == 0.0:
        roots = [-r / q] if q else []
    else:
        inside = q * q - 4 * p * r
        if inside < 0.0:
            return
        # The sum that does not cancel gives one root, and the product of both the other.
        half = -0.5 * (q + math.copysign(math.sqrt(inside), q))
        roots = [half / p, *([r / half] if half else [])]
    yield from (t for t in roots if 0.0 < t < 1.0)


# --- In cubics -------------------------------------------------------------------------------------

_FINE = TURN / 24
"""Turn of an arc that a cubic follows to 6e-9 of its radius."""


def as_curves(stroke: Stroke) -> tuple[Curve, ...]:
    """Returns a stroke in lines and cubics, which follow an arc to 6e-9 of its size."""
    if not isinstance(stroke, Bow):
        return (stroke,)
    count = max(1, math.ceil(abs(stroke.sweep) / _FINE))
    step = stroke.sweep / count
    handle = 4 / 3 * math.tan(step / 4)
    found: list[Curve] = []
    for k in range(count):
        first, last = stroke.first + k * step, stroke.first + (k + 1) * step
        start, end = stroke.at(first), stroke.at(last)
        one, two = (
            _moved(start, _heading(stroke, first), handle),
            _moved(end, _heading(stroke, last), -handle),
        )
        found.append((start, one, two, end))
    return tuple(found)


def _heading(bow: Bow, t: float) -> Vec:
    c, s = math.cos(t), math.sin(t)
    return bow.v[0] * c - bow.u[0] * s, bow.v[1] * c - bow.u[1] * s


def _moved(p: Vec, way: Vec, by: float) -> Vec:
    return p[0] + way[0] * by, p[1] + way[1] * by


# --- B-splines as cubic Bézier curves.

_NEAR = 1e-7
"""Distance of a cubic from the curve that it follows, relative to the size of that."""
_HALVINGS = 10


def cubics(entity: Any) -> tuple[list[Curve], bool]:
    """Returns the cubics of a SPLINE, and whether they are the same curve."""
    spline: BSpline = entity.construction_tool()
    if spline.degree <= 3 and not spline.is_rational and spline.is_clamped:
        return [_raised([_flat(p) for p in piece]) for piece in spline.bezier_decomposition()], True
    points = [_flat(p) for p in spline.control_points]
    size = max(max(axis) - min(axis) for axis in zip(*points, strict=True)) or 1.0
    knots = sorted(set(spline.knots()[spline.degree : len(spline.knots()) - spline.degree]))
    found = [
        curve
        for first, last in pairwise(knots)
        for curve in _followed(spline, first, last, _NEAR * size, _HALVINGS)
    ]
    return [_joined(curve, found[k - 1] if k else None) for k, curve in enumerate(found)], False


def _flat(p: Any) -> Vec:
    return float(p[0]), float(p[1])


def _raised(points: list[Vec]) -> Curve:
    """Returns a Bézier curve of a degree up to 3 as a line or a cubic."""
    while 2 < len(points) < 4:
        n = len(points)
        inner = [
            tuple((k * a + (n - k) * b) / n for a, b in zip(points[k - 1], points[k], strict=True))
            for k in range(1, n)
        ]
        points = [points[0], *((x, y) for x, y in inner), points[-1]]
    return tuple(points)


def _followed(spline: BSpline, first: float, last: float, near: float, halvings: int) -> Iterator[Curve]:
    """Yields cubics with the ends and the derivatives of a part of a spline, halved until they are near."""
    checkpoint()
    step = last - first
    inside = [first + 1e-12 * step, last - 1e-12 * step]  # of the part, should its ends be corners
    (start, heading), (end, arrival) = ((_flat(p), _flat(d)) for p, d in spline.derivatives(inside, 1))
    one = start[0] + heading[0] * step / 3, start[1] + heading[1] * step / 3
    two = end[0] - arrival[0] * step / 3, end[1] - arrival[1] * step / 3
    middle = (first + last) / 2
    off = max(
        math.dist(_at((start, one, two, end), k / 4), _flat(spline.point(first + k / 4 * step)))
        for k in (1, 2, 3)
    )
    if off <= near or halvings == 0:
        yield start, one, two, end
        return
    yield from _followed(spline, first, middle, near, halvings - 1)
    yield from _followed(spline, middle, last, near, halvings - 1)


def _at(curve: Curve, t: float) -> Vec:
    s = 1.0 - t
    weights = s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t
    x, y = (sum(w * p[axis] for w, p in zip(weights, curve, strict=True)) for axis in (0, 1))
    return x, y


def _joined(curve: Curve, before: Curve | None) -> Curve:
    """Returns a curve that begins where the one before it ends, to the last digit."""
    return curve if before is None else (before[-1], *curve[1:])

"""Measures of curves: their extent, length and roundness."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from aidl_lang.geometry.curves import Arc, Circle, Ellipse, EllipseArc, Line, Piece, Vec
from aidl_lang.geometry.evaluate import ends, extreme_parameters, is_closed, locate, point
from aidl_lang.geometry.solved import Length, Opening

X_AXIS, Y_AXIS = (1.0, 0.0), (0.0, 1.0)
_FLAT = 1e-9


def direction(degrees: float) -> Vec:
    quarter = degrees / 90
    if abs(quarter - round(quarter)) < _FLAT:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[round(quarter) % 4]
    return math.cos(math.radians(degrees)), math.sin(math.radians(degrees))


def readable(u: Vec) -> Vec:
    """Returns the direction or its opposite: to the right, or upwards; that of an axis is exact."""
    if abs(u[1]) < _FLAT:
        return X_AXIS
    if abs(u[0]) < _FLAT:
        return Y_AXIS
    return u if u[0] > 0 else (-u[0], -u[1])


def dot(p: Vec, q: Vec) -> float:
    return p[0] * q[0] + p[1] * q[1]


def extreme(curves: Iterable[Piece | Vec], u: Vec) -> tuple[Vec, ...]:
    """Returns the points of curves that lie furthest in a direction."""
    spots = [spot for curve in curves for spot in _spots(curve, u)]
    furthest = max(dot(p, u) for p in spots)
    slack = 1e-9 * max(max(map(abs, p)) for p in spots)
    return tuple(dict.fromkeys(p for p in spots if dot(p, u) >= furthest - slack))


def _spots(curve: Piece | Vec, u: Vec) -> Sequence[Vec]:
    """Returns points of a curve of which one is the furthest in a direction."""
    if isinstance(curve, tuple):
        return [curve]
    own = [] if is_closed(curve) else list(ends(curve))
    if isinstance(curve, Circle | Arc):
        tip = curve.center[0] + curve.radius * u[0], curve.center[1] + curve.radius * u[1]
        on_it = isinstance(curve, Circle) or locate(curve, tip, 1e-9 * curve.radius) is not None
        return [*own, tip] if on_it else own
    if isinstance(curve, Ellipse | EllipseArc) or u in (X_AXIS, Y_AXIS, (-1.0, 0.0), (0.0, -1.0)):
        own += [point(curve, t) for t in extreme_parameters(curve) if 0 <= t <= 1]
    return own


def length_along(curves: Sequence[Piece | Vec], u: Vec) -> Length:
    """Returns the extent of curves along a direction."""
    return length_between(extreme(curves, (-u[0], -u[1])), extreme(curves, u), u)


def length_between(start: Sequence[Vec], end: Sequence[Vec], u: Vec) -> Length:
    """Returns the length along a direction from any of some points to any of others, all of which agree in
    it.
    """
    u = readable(u)
    low, high = sorted((tuple(start), tuple(end)), key=lambda points: dot(points[0], u))
    return Length(dot(high[0], u) - dot(low[0], u), "", start=low, end=high, along=u)


def length_of_line(a: Vec, b: Vec) -> Length | None:
    u = unit(a, b)
    return length_between([a], [b], u) if u is not None else None


def unit(a: Vec, b: Vec) -> Vec | None:
    """Returns the direction from one point to another."""
    reach = math.dist(a, b)
    return ((b[0] - a[0]) / reach, (b[1] - a[1]) / reach) if reach else None


def foot(p: Vec, line: Line) -> Vec:
    """Returns the point of an endless line that is nearest to a point."""
    dx, dy = line.end[0] - line.start[0], line.end[1] - line.start[1]
    square = dx * dx + dy * dy
    t = ((p[0] - line.start[0]) * dx + (p[1] - line.start[1]) * dy) / square if square else 0.0
    return line.start[0] + t * dx, line.start[1] + t * dy


def angle_of(a: Line, b: Line, degrees: float) -> Opening | None:
    """Returns the angle between two lines that is as large as stated, rather between arms that are drawn."""
    corner = meeting(a, b)
    if corner is None:
        return None
    best: tuple[float, Opening] | None = None
    for side_a in (1.0, -1.0):
        for side_b in (1.0, -1.0):
            (from_a, arm_a), (from_b, arm_b) = _arm(a, side_a, corner), _arm(b, side_b, corner)
            opening = (from_b - from_a) % 360
            if opening > 180:
                opening, from_a, arm_a, arm_b = 360 - opening, from_b, arm_b, arm_a
            drawn = min(arm_a[1], 0.0) + min(arm_b[1], 0.0)
            if abs(opening - degrees) < 1e-6 and (best is None or drawn > best[0]):
                made = Opening(opening, "", corner=corner, first=from_a, arms=(arm_a, arm_b))
                best = drawn, made
    return best[1] if best else None


def meeting(a: Line, b: Line) -> Vec | None:
    """Returns the crossing of two endless lines; None if they are parallel."""
    ux, uy = a.end[0] - a.start[0], a.end[1] - a.start[1]
    vx, vy = b.end[0] - b.start[0], b.end[1] - b.start[1]
    cross = ux * vy - uy * vx
    if abs(cross) <= _FLAT * math.hypot(ux, uy) * math.hypot(vx, vy):
        return None
    t = ((b.start[0] - a.start[0]) * vy - (b.start[1] - a.start[1]) * vx) / cross
    return a.start[0] + t * ux, a.start[1] + t * uy


def _arm(line: Line, side: float, corner: Vec) -> tuple[float, tuple[float, float]]:
    """Returns the direction of a line to one side, and the stretch in which it is drawn there."""
    ux, uy = side * (line.end[0] - line.start[0]), side * (line.end[1] - line.start[1])
    reach = math.hypot(ux, uy)
    u = ux / reach, uy / reach
    along = sorted(dot((p[0] - corner[0], p[1] - corner[1]), u) for p in (line.start, line.end))
    return math.degrees(math.atan2(uy, ux)), (along[0], along[1])

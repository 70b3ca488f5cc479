"""The pieces that offsets are put together from: strips along curves, wedges at corners, caps at ends.

What lies within a distance of a curve is swept by its normals. A point is nearest to the inside of a curve,
where the normal leads to it, or to a corner; so strips along all curves and wedges at all corners cover
exactly the points within the distance (but for caps). A strip need not reach beyond the centre of curvature,
where other points of the curve are nearer. Each strip is bounded by exact curves, except beside Bézier curves
and ellipses: their parallel curves are fitted by cubics.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

from aidl_lang.geometry.curves import Arc, Bezier, Circle, Line, Piece, Vec
from aidl_lang.geometry.evaluate import (
    bounds,
    derivative,
    ends,
    extreme_parameters,
    part,
    point,
    reverse,
    second_derivative,
    turn_between,
)
from aidl_lang.geometry.finishing import direction

Outline = tuple[Piece, ...]
Strip = tuple[Outline, ...]
"""A closed outline, or an outer and an inner one."""

FIT = 1e-5
"""Largest error of a fitted parallel curve, relative to its distance plus the extent of the curve."""
_DEEPEST = 6
_SHORTEST = 1e-6
"""Shares of a curve that are no part of their own."""
_BEND = 0.3
"""Radians that a part may turn under a straight top."""
_SHARPEST = math.radians(168.5)
"""Corners that turn further are rounded: their point would stand out more than ten times the distance."""


def beside(curve: Piece, left: float) -> Iterator[Strip]:
    """Yields the strips within a distance to the left of a curve (to its right for a negative one)."""
    if isinstance(curve, Line):
        yield (_between(curve, Line(_parallel(curve, 0.0, left), _parallel(curve, 1.0, left))),)
    elif isinstance(curve, Circle):
        other = curve.radius - left
        yield ((curve,), (Circle(curve.center, other),)) if other > 0 else ((curve,),)
    elif isinstance(curve, Arc):
        yield (_beside_arc(curve, left),)
    else:
        yield from _beside_free(curve, left)


def _between(curve: Piece, other: Piece) -> Outline:
    """Returns the outline from a curve to one beside it and back."""
    (a, b), (c, d) = ends(curve), ends(other)
    return tuple(
        p
        for p in (curve, Line(b, d), reverse(other), Line(c, a))
        if not isinstance(p, Line) or p.start != p.end
    )


def _beside_arc(arc: Arc, left: float) -> Outline:
    radius = arc.radius - math.copysign(left, left * arc.sweep)
    if radius <= 0:
        return (arc, Line(arc.end, arc.center), Line(arc.center, arc.start))
    start, end = (_scaled(arc, p, radius) for p in (arc.start, arc.end))
    return _between(arc, Arc(arc.center, radius, start, end, arc.sweep))


def _scaled(arc: Arc, p: Vec, radius: float) -> Vec:
    share = radius / arc.radius
    return arc.center[0] + share * (p[0] - arc.center[0]), arc.center[1] + share * (p[1] - arc.center[1])


# --- Curves whose parallels are no curves of their kind ------------------------------------------------


def _beside_free(curve: Piece, left: float) -> Iterator[Strip]:
    """Yields strips in parts short enough to fit; their far side is straight where the curve bends closer
    than the distance. A part ends where the curve is level or upright, and there the fit is exact: the box of
    the parallel curve is that of the curve moved out.
    """
    x0, y0, x1, y1 = bounds(curve)
    scale = abs(left) + max(x1 - x0, y1 - y0)
    inner = sorted(t for t in extreme_parameters(curve) if _SHORTEST < t < 1 - _SHORTEST)
    cuts = [t for t, after in pairwise([*inner, 1.0]) if after - t > _SHORTEST]
    stack = [(t0, t1, 0) for t0, t1 in pairwise([0.0, *cuts, 1.0])][::-1]
    while stack:
        t0, t1, depth = stack.pop()
        bent = [_stretch(curve, t0 + (t1 - t0) * k / 8, left) <= 0 for k in range(9)]
        top: Piece
        if not any(bent):
            top = _fitted(curve, t0, t1, left)
            is_fine = _error(curve, t0, t1, left, top) <= FIT * scale
        else:
            top = Line(*(_reached(curve, t, left) for t in (t0, t1)))
            is_fine = all(bent) and abs(turn_between(direction(curve, t0), direction(curve, t1))) < _BEND
        if is_fine or depth >= _DEEPEST:
            yield (_between(part(curve, t0, t1, point(curve, t0), point(curve, t1)), top),)
        else:
            half = (t0 + t1) / 2
            stack += [(half, t1, depth + 1), (t0, half, depth + 1)]


def _reached(curve: Piece, t: float, left: float) -> Vec:
    """Returns the end of a normal that goes a little beyond the centre of curvature, but not beyond the
    distance.
    """
    stretch = _stretch(curve, t, left)
    return _parallel(curve, t, left * min(1.0, 1.1 / abs(1 - stretch)) if stretch != 1 else left)


def _stretch(curve: Piece, t: float, left: float) -> float:
    """Returns the length of a step on the parallel curve relative to that on the curve: 1 - left ·
    curvature.
    """
    (dx, dy), (ax, ay) = derivative(curve, t), second_derivative(curve, t)
    speed = math.hypot(dx, dy)
    return 1 - left * (dx * ay - dy * ax) / speed**3 if speed else 1.0


def _fitted(curve: Piece, t0: float, t1: float, left: float) -> Bezier:
    """Returns the cubic with the ends and the derivatives of the parallel curve."""
    p, q = _parallel(curve, t0, left), _parallel(curve, t1, left)
    (ax, ay), (bx, by) = derivative(curve, t0), derivative(curve, t1)
    u, v = (_stretch(curve, t, left) * (t1 - t0) / 3 for t in (t0, t1))
    return Bezier(p, (p[0] + u * ax, p[1] + u * ay), (q[0] - v * bx, q[1] - v * by), q)


def _parallel(curve: Piece, t: float, left: float) -> Vec:
    (x, y), (dx, dy) = point(curve, t), direction(curve, t)
    return x - left * dy, y + left * dx


def _error(curve: Piece, t0: float, t1: float, left: float, fitted: Bezier) -> float:
    """Returns the greatest distance of the fitted curve from the parallel one, along the normals of that."""
    worst = 0.0
    for s in (0.2, 0.35, 0.5, 0.65, 0.8):
        t = t0 + s * (t1 - t0)
        (px, py), (qx, qy), (dx, dy) = _parallel(curve, t, left), point(fitted, s), direction(curve, t)
        worst = max(worst, abs((qx - px) * dy - (qy - py) * dx))
    return worst


# --- Corners and ends ----------------------------------------------------------------------------


def wedge(at: Vec, arriving: Vec, leaving: Vec, left: float, sharp: bool) -> Strip | None:
    """Returns the strip that a corner adds on its outer side; None if that is not the side asked for.
    `arriving` and `leaving` are unit directions.
    """
    turn = turn_between(arriving, leaving)
    if abs(turn) < 1e-9 or (turn * left >= 0 and abs(turn) < math.pi - 1e-9):
        return None
    p = at[0] - left * arriving[1], at[1] + left * arriving[0]
    q = at[0] - left * leaving[1], at[1] + left * leaving[0]
    if sharp and abs(turn) < _SHARPEST:
        reach = math.tan(turn / 2) * -left
        tip = p[0] + reach * arriving[0], p[1] + reach * arriving[1]
        return ((Line(at, p), Line(p, tip), Line(tip, q), Line(q, at)),)
    sweep = -math.copysign(abs(turn), left)
    return ((Line(at, p), Arc(at, abs(left), p, q, sweep), Line(q, at)),)


def cap(at: Vec, outward: Vec, half: float, form: str) -> Strip | None:
    """Returns the strip that an end adds on both sides of its curve: `round`, `square`, or None for
    `butt`.
    """
    p = at[0] + half * outward[1], at[1] - half * outward[0]
    q = at[0] - half * outward[1], at[1] + half * outward[0]
    if form == "butt":
        return None
    if form == "round":
        return ((Arc(at, half, p, q, math.pi), Line(q, p)),)
    x, y = half * outward[0], half * outward[1]
    a, b = (p[0] + x, p[1] + y), (q[0] + x, q[1] + y)
    return ((Line(p, a), Line(a, b), Line(b, q), Line(q, p)),)


def disc(at: Vec, radius: float) -> Strip:
    return ((Circle(at, radius),),)

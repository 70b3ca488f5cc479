"""Where a curve meets the endless line or the whole circle that carries another: its distance from that is a
function of its parameter alone, which has one zero at most between two extremes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np
from numpy.polynomial import polynomial

from aidl_lang.geometry.curves import Arc, Bezier, Circle, Line, Piece, Vec
from aidl_lang.geometry.evaluate import derivative, is_closed, point

_POWERS = np.array([[1, 0, 0, 0], [-3, 3, 0, 0], [3, -6, 3, 0], [-1, 3, -3, 1]])
"""Coefficients of 1, t, t² and t³ of a cubic, from its control points."""
_MARKS = [k / 64 for k in range(65)]


def on_carrier(carried: Line | Arc | Circle, curve: Piece, tolerance: float) -> Iterator[float]:
    """Yields the parameters at which a curve crosses what carries another, or comes within the tolerance and
    turns away.
    """
    away, slope = _distance(carried)

    def height(t: float) -> float:
        return away(point(curve, t))

    def rise(t: float) -> float:
        return slope(point(curve, t), derivative(curve, t))

    turns = _turns_of_cubic(carried, curve) if isinstance(curve, Bezier) else list(_turns(rise))
    knots = [(t, height(t)) for t in sorted({0.0, *turns, 1.0})]
    touches = {t for t, h in knots[1:-1] if abs(h) <= tolerance}
    yield from touches
    for (t, g), (s, h) in pairwise(knots):
        if (g > 0) != (h > 0) and not {t, s} & touches:
            yield _root(height, t, s)
    if is_closed(curve) and abs(knots[0][1]) <= tolerance:
        yield 0.0


def _distance(
    carried: Line | Arc | Circle,
) -> tuple[Callable[[Vec], float], Callable[[Vec, Vec], float]]:
    """Returns the distance of a point from a line, positive on its left, or from a circle, positive outside,
    and the rate at which it grows for a point on its way.
    """
    if isinstance(carried, Line):
        (x, y), (dx, dy) = carried.start, _direction(carried)
        return lambda p: dx * (p[1] - y) - dy * (p[0] - x), lambda p, way: dx * way[1] - dy * way[0]
    (x, y), r = carried.center, carried.radius

    def grows(p: Vec, way: Vec) -> float:
        return ((p[0] - x) * way[0] + (p[1] - y) * way[1]) / (math.hypot(p[0] - x, p[1] - y) or 1.0)

    return lambda p: math.hypot(p[0] - x, p[1] - y) - r, grows


def _direction(line: Line) -> Vec:
    (x, y), (u, v) = line.start, line.end
    length = math.hypot(u - x, v - y)
    return (u - x) / length, (v - y) / length


def _turns_of_cubic(carried: Line | Arc | Circle, curve: Bezier) -> list[float]:
    """Returns the parameters within 0..1 at which the distance of a cubic has an extreme: the roots of a
    polynomial, of (B - c)·B' for a circle about c.
    """
    origin = carried.start if isinstance(carried, Line) else carried.center
    x, y = (_POWERS @ (np.array((curve.p0, curve.p1, curve.p2, curve.p3)) - origin)).T
    if isinstance(carried, Line):
        dx, dy = _direction(carried)
        slope = polynomial.polyder(dx * y - dy * x)
    else:
        slope = np.convolve(x, polynomial.polyder(x)) + np.convolve(y, polynomial.polyder(y))
    # Leading coefficients that are nothing but rounding would give roots far away.
    slope[np.abs(slope) <= 1e-14 * np.abs(slope).max(initial=0.0)] = 0.0
    roots = polynomial.polyroots(np.trim_zeros(slope, "b")) if slope.any() else np.empty(0)
    return [float(root.real) for root in roots if abs(root.imag) <= 1e-6 and 0 < root.real < 1]


def _turns(rise: Callable[[float], float]) -> Iterator[float]:
    """Yields the parameters at which a distance has an extreme, between places where it rises and falls."""
    rises = [rise(t) for t in _MARKS]
    for (t, g), (s, h) in pairwise(zip(_MARKS, rises, strict=True)):
        if (g > 0) != (h > 0):
            yield _root(rise, t, s)


def _root(of: Callable[[float], float], low: float, high: float) -> float:
    """Returns where a function that changes its sign between two places is zero, by secants through them; the
    value at a place that stays twice counts half (the Illinois method).
    """
    below, above = of(low), of(high)
    if not below or not above:
        return high if below else low
    t, stays_low = low, False
    for _ in range(100):
        before, t = t, high - above * (high - low) / (above - below)
        value = of(t)
        if not value or abs(t - before) <= 1e-16:
            break
        if (value > 0) == (above > 0):
            below = below / 2 if stays_low else below
            high, above, stays_low = t, value, True
        else:
            above = above if stays_low else above / 2
            low, below, stays_low = t, value, False
    return t

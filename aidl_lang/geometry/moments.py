"""Second moments of area of a region, from its exact pieces.

They are integrals along the outline: of straight lines, whole circles and whole ellipses in closed form, of
all others by Gauss-Legendre quadrature. With twelve nodes it is exact for Bézier curves (whose integrand is a
polynomial of degree 11) and exact to rounding for a quarter of a circle or an ellipse; the closed form of an
arc would lose all digits where the arc is shallow and its radius large.
"""

from __future__ import annotations

import math

from aidl_lang.common.quadrature import gauss
from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Bezier, Circle, Ellipse, Line, Piece, Vec
from aidl_lang.geometry.evaluate import derivative, point, round_range
from aidl_lang.geometry.measures import moments_about_start
from aidl_lang.geometry.region import Loop, Region

_ISOTROPIC = 1e-9
"""Difference of the principal moments, relative to them, below which every axis is a principal one."""
_ROUNDING = 1e-12
"""Part of the moments below which the product of inertia counts as zero."""

Squares = tuple[float, float, float]
"""Integrals of x², y² and xy over an area."""


@record(slots=True)
class Inertia:
    """Second moments of area about the centroid, mm⁴: xx = ∫y² dA, yy = ∫x² dA, xy = ∫xy dA."""

    xx: float
    yy: float
    xy: float

    @property
    def polar(self) -> float:
        """About the axis that stands on the plane."""
        return self.xx + self.yy

    @property
    def principal(self) -> tuple[float, float]:
        """The largest and the least about any axis in the plane."""
        middle, half = self.polar / 2, math.hypot((self.xx - self.yy) / 2, self.xy)
        return middle + half, middle - half

    @property
    def angle(self) -> float:
        """The angle from the x axis to the axis of the largest moment, degrees over -90 to 90; 0 if all are
        equal.
        """
        largest, least = self.principal
        if largest - least <= _ISOTROPIC * largest:
            return 0.0
        if abs(self.xy) <= _ROUNDING * largest:
            return 0.0 if self.xx > self.yy else 90.0
        return math.degrees(math.atan2(-2 * self.xy, self.xx - self.yy)) / 2


def inertia(region: Region, centroid: Vec) -> Inertia:
    """Returns the second moments of a region about its centroid."""
    xx = yy = xy = 0.0
    for loop in region.loops:
        sign = -1 if loop.reversed else 1
        start, (a, mx, my) = moments_about_start(loop)
        dx, dy = start[0] - centroid[0], start[1] - centroid[1]
        sx, sy, sxy = _squares(loop, start)
        # The parallel axis theorem, from the start of the loop to the centroid.
        xx += sign * sx + 2 * dx * mx + dx * dx * a
        yy += sign * sy + 2 * dy * my + dy * dy * a
        xy += sign * sxy + dx * my + dy * mx + dx * dy * a
    return Inertia(yy, xx, xy)


def _squares(loop: Loop, origin: Vec) -> Squares:
    """Returns the second moments of a loop about a point, as if it were not `reversed`."""
    columns = zip(*(_piece_squares(piece, origin) for piece in loop.pieces), strict=True)
    x, y, xy = map(math.fsum, columns)
    return x, y, xy


def _piece_squares(piece: Piece, origin: Vec) -> Squares:
    """Returns the second moments of the triangle fan from the origin to the piece."""
    match piece:
        case Line(start, end):
            return _triangle(
                (start[0] - origin[0], start[1] - origin[1]), (end[0] - origin[0], end[1] - origin[1])
            )
        case Circle(center, r):
            return _whole_ellipse(Ellipse(center, r, r, 0.0), origin)
        case Ellipse():
            return _whole_ellipse(piece, origin)
        case _:
            return _curved(piece, origin)


def _triangle(p: Vec, q: Vec) -> Squares:
    a = (p[0] * q[1] - p[1] * q[0]) / 12
    return (
        a * (p[0] * p[0] + p[0] * q[0] + q[0] * q[0]),
        a * (p[1] * p[1] + p[1] * q[1] + q[1] * q[1]),
        a * (p[0] * p[1] + (p[0] * q[1] + q[0] * p[1]) / 2 + q[0] * q[1]),
    )


def _whole_ellipse(e: Ellipse, origin: Vec) -> Squares:
    a = math.pi * e.rx * e.ry
    u, v = a * e.rx * e.rx / 4, a * e.ry * e.ry / 4
    c, s = math.cos(e.angle), math.sin(e.angle)
    dx, dy = e.center[0] - origin[0], e.center[1] - origin[1]
    return (
        c * c * u + s * s * v + dx * dx * a,
        s * s * u + c * c * v + dy * dy * a,
        c * s * (u - v) + dx * dy * a,
    )


def _curved(piece: Piece, origin: Vec) -> Squares:
    """Integrals of (p × p') times a quarter of x², y² and xy."""
    spans = 1
    if not isinstance(piece, Line | Bezier):
        spans = max(1, math.ceil(abs(round_range(piece)[1]) / (math.pi / 2) - 1e-9))
    xx = yy = xy = 0.0
    for k in range(spans):
        for node, weight in gauss(12):
            t = (k + node) / spans
            x, y = point(piece, t)
            x, y = x - origin[0], y - origin[1]
            dx, dy = derivative(piece, t)
            cross = weight / spans * (x * dy - y * dx) / 4
            xx, yy, xy = xx + cross * x * x, yy + cross * y * y, xy + cross * x * y
    return xx, yy, xy

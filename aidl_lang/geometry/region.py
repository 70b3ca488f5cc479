"""Regions of the plane, bounded by exact curves: their measures, and polygons close to them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import field
from functools import cache, cached_property

import numpy as np

from aidl_lang.building.curves import gauss
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Arc, Bezier, Bounds, Circle, Floats, Line, Piece, Vec, union_bounds


@record(slots=True)
class Loop:
    """A closed outline; each piece starts where the one before it ends, to the last digit.

    A whole circle or ellipse is a loop of one piece and counts as counter-clockwise; `reversed` turns it
    around.
    """

    pieces: tuple[Piece, ...]
    reversed: bool = False

    def mapped(self, moved: Callable[[Piece], Piece]) -> Loop:
        """Returns the loop of the images of the pieces under what keeps its sense."""
        return Loop(tuple(map(moved, self.pieces)), self.reversed)

    @property
    def is_whole(self) -> bool:
        """True if the loop is a single closed curve without ends."""
        return len(self.pieces) == 1 and self.pieces[0].is_closed

    @property
    def start(self) -> Vec:
        """Where it begins, by which loops and faces are in order."""
        return self.pieces[0].ends[0]

    @property
    def box(self) -> Bounds:
        return union_bounds([piece.box for piece in self.pieces])

    @property
    def area(self) -> float:
        """The area, positive counter-clockwise."""
        at = self.start
        area = sum(_bezier_area(p, at) if isinstance(p, Bezier) else _moments(p, at)[0] for p in self.pieces)
        return -area if self.reversed else area

    @property
    def moments(self) -> Moments:
        """The moments about its start: far from the origin nothing cancels there."""
        a = mx = my = 0.0
        for da, dx, dy in (_moments(piece, self.start) for piece in self.pieces):
            a, mx, my = a + da, mx + dx, my + dy
        sign = -1 if self.reversed else 1
        return sign * a, sign * mx, sign * my

    def polygon(self, tolerance: float) -> Polygon:
        """Returns its polygon in its own direction (`tolerance` in mm, above 0)."""
        if not tolerance > 0:
            raise ValueError(f"the tolerance must be above 0, not {tolerance}")
        polygon = np.concatenate([_from_start(piece, tolerance) for piece in self.pieces])
        return polygon[::-1] if self.reversed else polygon


@record(slots=True)
class Face:
    """A connected area: `outer` counter-clockwise, `holes` clockwise."""

    outer: Loop
    holes: tuple[Loop, ...] = ()

    @property
    def loops(self) -> tuple[Loop, ...]:
        return (self.outer, *self.holes)

    def mapped(self, moved: Callable[[Piece], Piece]) -> Face:
        return Face(self.outer.mapped(moved), tuple(hole.mapped(moved) for hole in self.holes))

    def polygons(self, tolerance: float) -> list[Polygon]:
        """Returns the outer polygon, counter-clockwise, then those of the holes, clockwise."""
        return [_faithful(loop, tolerance) for loop in self.loops]


@record()
class Region:
    """Any number of faces that do not overlap."""

    faces: tuple[Face, ...] = field(default=())

    @property
    def loops(self) -> tuple[Loop, ...]:
        return tuple(loop for face in self.faces for loop in face.loops)

    @property
    def circle(self) -> Circle | None:
        """The circle that it is, if it is one."""
        only = self.faces[0].outer.pieces[0] if len(self.loops) == 1 else None
        return only if isinstance(only, Circle) else None

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """All that it is bounded by, loop by loop."""
        return tuple(piece for loop in self.loops for piece in loop.pieces)

    @cached_property
    def boxes(self) -> Floats:
        """The box of each piece, a row each."""
        return np.array([piece.box for piece in self.pieces]).reshape(-1, 4)

    @cached_property
    def box(self) -> Bounds:
        return union_bounds([face.outer.box for face in self.faces])

    @property
    def area(self) -> float:
        return sum(loop.area for loop in self.loops)

    @property
    def perimeter(self) -> float:
        return sum(map(length, self.pieces))

    def polygons(self, tolerance: float) -> list[Polygon]:
        """Returns one polygon for each of its loops: outer ones counter-clockwise, holes clockwise."""
        return [polygon for face in self.faces for polygon in face.polygons(tolerance)]

    def mapped(self, moved: Callable[[Piece], Piece]) -> Region:
        return Region(tuple(face.mapped(moved) for face in self.faces))

    def __bool__(self) -> bool:
        return bool(self.faces)


# --- Area, perimeter, centroid and box of a region from its exact pieces, by Green's theorem.
#
# Area and first moments are integrals along the outline: straight lines and circular segments in closed form
# (a segment of radius r and sweep s has the area r²(s - sin s)/2 and the moment 2/3 r³ sin³(s/2) along its
# bisector), ellipses as their affine images, Bézier curves by Gauss-Legendre quadrature, which is exact for
# them.

Moments = tuple[float, float, float]
"""Area and its first moments about the origin, as contributions to the integral along an outline."""


@record(slots=True)
class Measures:
    """Square millimetres and millimetres. `box` is left, bottom, right, top."""

    area: float
    perimeter: float
    centroid: Vec
    box: Bounds
    loops: int


def measure(region: Region) -> Measures:
    """Returns all measures of a region."""
    area = mx = my = perimeter = 0.0
    for loop in region.loops:
        (x0, y0), (a, x, y) = loop.start, loop.moments
        area, mx, my = area + a, mx + (x + a * x0), my + (y + a * y0)
        perimeter += sum(length(piece) for piece in loop.pieces)
    centroid = (mx / area, my / area) if area else (0.0, 0.0)
    return Measures(area, perimeter, centroid, region.box, len(region.loops))


def _moments(piece: Piece, origin: Vec) -> Moments:
    """Returns the moments of the triangle fan from the origin to the piece."""
    if isinstance(piece, Bezier):
        return _bezier_moments(piece, origin)
    start, end = piece.ends
    p, q = (start[0] - origin[0], start[1] - origin[1]), (end[0] - origin[0], end[1] - origin[1])
    half = (p[0] * q[1] - p[1] * q[0]) / 2
    chord = half, half * (p[0] + q[0]) / 3, half * (p[1] + q[1]) / 3
    if isinstance(piece, Line):
        return chord
    first, sweep = piece.range
    a = _less_sine(sweep) / 2
    moment = 2 / 3 * math.sin(sweep / 2) ** 3
    bisector = first + sweep / 2
    x, y = moment * math.cos(bisector), moment * math.sin(bisector)
    if isinstance(piece, Arc | Circle):
        rx = ry = piece.radius
    else:
        rx, ry = piece.rx, piece.ry
        c, s = math.cos(piece.angle), math.sin(piece.angle)
        x, y = (c * rx * x - s * ry * y) / rx, (s * rx * x + c * ry * y) / rx
    a, x, y = a * rx * ry, x * rx * rx * ry, y * rx * rx * ry
    cx, cy = piece.center[0] - origin[0], piece.center[1] - origin[1]
    return chord[0] + a, chord[1] + x + a * cx, chord[2] + y + a * cy


def _less_sine(angle: float) -> float:
    """Returns the angle minus its sine, by the series where the difference would lose digits."""
    if abs(angle) > 1:
        return angle - math.sin(angle)
    term = total = angle**3 / 6
    for k in range(4, 20, 2):
        term *= -angle * angle / (k * (k + 1))
        total += term
    return total


def _bezier_moments(piece: Bezier, origin: Vec) -> Moments:
    """Integrals of (p x p')/2 and p (p x p')/3, polynomials of degree 5 and 8."""
    a = mx = my = 0.0
    for t, weight in gauss(5):
        x, y = piece.point(t)
        x, y = x - origin[0], y - origin[1]
        dx, dy = piece.derivative(t)
        cross = weight * (x * dy - y * dx)
        a, mx, my = a + cross / 2, mx + cross * x / 3, my + cross * y / 3
    return a, mx, my


def _bezier_area(piece: Bezier, origin: Vec) -> float:
    """Returns the integral of (p x p')/2 by the control points, of which each pair has a share of its own."""
    ox, oy = origin
    ax, ay, bx, by = piece.p0[0] - ox, piece.p0[1] - oy, piece.p1[0] - ox, piece.p1[1] - oy
    cx, cy, dx, dy = piece.p2[0] - ox, piece.p2[1] - oy, piece.p3[0] - ox, piece.p3[1] - oy
    beside = 6 * (ax * by - ay * bx + cx * dy - cy * dx)
    return (beside + 3 * (ax * cy - ay * cx + bx * cy - by * cx + bx * dy - by * dx) + ax * dy - ay * dx) / 20


def length(piece: Piece) -> float:
    """Returns the arc length; of ellipses and Bézier curves by quadrature to about nine digits."""
    if isinstance(piece, Line):
        return math.dist(piece.start, piece.end)
    if isinstance(piece, Arc | Circle):
        return piece.radius * abs(piece.range[1])
    nodes, shares, slopes = _quadrature()
    if isinstance(piece, Bezier):
        control = np.array((piece.p0, piece.p1, piece.p2, piece.p3))
        speed = np.hypot(*(slopes @ (3 * np.diff(control, axis=0))).T)
    else:
        first, sweep = piece.range
        u = first + sweep * nodes
        speed = abs(sweep) * np.hypot(piece.rx * np.sin(u), piece.ry * np.cos(u))
    return float(speed @ shares)


@cache
def _quadrature() -> tuple[Floats, Floats, Floats]:
    """Nodes and weights of a quadrature in some spans of 0..1; at each the shares of the differences of
    control points in the slope of a cubic.
    """
    at, shares = np.array(gauss(16)).T
    spans = 8
    t = np.concatenate([(k + at) / spans for k in range(spans)])
    return t, np.tile(shares / spans, spans), np.stack(((1 - t) ** 2, 2 * t * (1 - t), t**2), axis=1)


# --- Polygons close to exact outlines, for formats and readers that have no curves.
#
# Every vertex lies on the outline, every end of a piece is a vertex, and no chord departs from its piece by
# more than the tolerance: a chord of a circle of radius r over the angle a departs by r (1 - cos a/2), an
# ellipse is the affine image of a circle with its larger half-axis, and any curve departs by at most
# max|C''| Δt²/8. Outlines closer to each other than the tolerance may cross as polygons.

Polygon = Floats
"""Vertices in order, shape (n, 2), mm; the first is not repeated at the end."""

COARSE = 0.05
"""Millimetres from an outline to the polygon that stands for it where places are sought."""
_FINER, _ROUNDS = 16, 4


def _faithful(loop: Loop, tolerance: float) -> Polygon:
    """Returns a loop's polygon, which follows a thin loop closely enough not to turn inside out."""
    checkpoint()
    exact = loop.area
    for _ in range(_ROUNDS):
        polygon = loop.polygon(tolerance)
        if polygon_area(polygon) * exact > exact * exact / 2:
            break
        tolerance /= _FINER
    return polygon


def piece_points(piece: Piece, tolerance: float) -> Polygon:
    """Returns a polyline along a piece, both ends included."""
    return np.concatenate((_from_start(piece, tolerance), [piece.ends[1]]))


def polygon_area(polygon: Polygon) -> float:
    """Returns the area, positive counter-clockwise; about the first vertex, so that nothing cancels."""
    x, y = (polygon - polygon[0]).T
    return float(x[:-1] @ y[1:] - y[:-1] @ x[1:]) / 2


def _from_start(piece: Piece, tolerance: float) -> Polygon:
    count = piece.chords(tolerance)
    found = piece.points(np.arange(count) / count)
    found[0] = piece.ends[0]
    return found

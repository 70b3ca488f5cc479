"""Polygons close to exact outlines, for formats and readers that have no curves.

Every vertex lies on the outline, every end of a piece is a vertex, and no chord departs from its piece by
more than the tolerance: a chord of a circle of radius r over the angle a departs by r (1 - cos a/2), an
ellipse is the affine image of a circle with its larger half-axis, and any curve departs by at most
max|C''| Δt²/8. Outlines closer to each other than the tolerance may cross as polygons.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Line, Piece
from aidl_lang.geometry.evaluate import TAU, ends, points, round_range
from aidl_lang.geometry.measures import loop_area
from aidl_lang.geometry.region import Face, Loop, Region

Polygon = NDArray[np.float64]
"""Vertices in order, shape (n, 2), mm; the first is not repeated at the end."""

COARSEST = TAU / 16
"""Largest angle of a chord, so that a hole much smaller than the tolerance is still round."""
SLACK = 1e-9
"""Slack in a count of chords, so that rounding does not choose how many there are."""
_FINER, _ROUNDS = 16, 4


def region_polygons(region: Region, tolerance: float) -> list[Polygon]:
    """Returns one polygon for each loop of `region.loops`: outer ones counter-clockwise, holes clockwise."""
    return [polygon for face in region.faces for polygon in face_polygons(face, tolerance)]


def face_polygons(face: Face, tolerance: float) -> list[Polygon]:
    """Returns the outer polygon, counter-clockwise, then those of the holes, clockwise."""
    return [_faithful(loop, tolerance) for loop in face.loops]


def _faithful(loop: Loop, tolerance: float) -> Polygon:
    """Returns a loop's polygon; a loop that is thinner than the tolerance is followed more closely, so that
    it does not turn inside out.
    """
    checkpoint()
    exact = loop_area(loop)
    for _ in range(_ROUNDS):
        polygon = loop_points(loop, tolerance)
        if polygon_area(polygon) * exact > exact * exact / 2:
            break
        tolerance /= _FINER
    return polygon


def loop_points(loop: Loop, tolerance: float) -> Polygon:
    """Returns the polygon of a loop in its own direction (`tolerance` in mm, above 0)."""
    if not tolerance > 0:
        raise ValueError(f"the tolerance must be above 0, not {tolerance}")
    polygon = np.concatenate([_from_start(piece, tolerance) for piece in loop.pieces])
    return polygon[::-1] if loop.reversed else polygon


def piece_points(piece: Piece, tolerance: float) -> Polygon:
    """Returns a polyline along a piece, both ends included."""
    return np.concatenate((_from_start(piece, tolerance), [ends(piece)[1]]))


def polygon_area(polygon: Polygon) -> float:
    """Returns the area, positive counter-clockwise; about the first vertex, so that far away nothing
    cancels.
    """
    x, y = (polygon - polygon[0]).T
    return float(x[:-1] @ y[1:] - y[:-1] @ x[1:]) / 2


def _from_start(piece: Piece, tolerance: float) -> Polygon:
    """Returns the points along a piece without its end."""
    count = _chords(piece, tolerance)
    found = points(piece, np.arange(count) / count)
    found[0] = ends(piece)[0]
    return found


def _chords(piece: Piece, tolerance: float) -> int:
    """Returns the number of chords that keeps the tolerance; at least two for a curve, so that it does not
    fall on its chord.
    """
    if isinstance(piece, Line):
        return 1
    if isinstance(piece, Bezier):
        # C''/6 runs straight from one second difference of the control points to the other.
        corners = (piece.p0, piece.p1, piece.p2, piece.p3)
        sides = [(q[0] - p[0], q[1] - p[1]) for p, q in pairwise(corners)]
        bend = 6 * max(math.dist(a, b) for a, b in pairwise(sides))
        return max(3, math.ceil(math.sqrt(bend / (8 * tolerance)) - SLACK))
    radius = piece.radius if isinstance(piece, Arc | Circle) else max(piece.rx, piece.ry)
    step = min(COARSEST, 4 * math.asin(math.sqrt(min(1.0, tolerance / (2 * radius)))))
    return max(2, math.ceil(abs(round_range(piece)[1]) / step - SLACK))

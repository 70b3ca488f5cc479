"""Polygons of exact outlines: how far their chords depart, which way they run, what they enclose."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, Line, Piece
from aidl_lang.geometry.region import Face, Loop, Region, piece_points, polygon_area
from tests.geometry.models import arc

WHOLE = Ellipse((1, 2), 30, 2, 0.4)
PIECES: list[Piece] = [
    Line((0, 0), (30, 4)),
    arc((5, 5), 40, 20, 75),
    arc((5, 5), 40, 75, -280),
    Circle((3, -2), 25),
    Ellipse((3, -2), 30, 0.5, 0.7),
    WHOLE.part(0.9, 0.2, WHOLE.point(0.9), WHOLE.point(0.2)),
    Bezier((0, 0), (50, 0), (-20, 40), (30, 40)),
    Bezier((0, 0), (10, 10), (20, 20), (30, 30)),
    Bezier((0, 0), (90, 60), (-60, 60), (30, 0)),
]


@pytest.mark.parametrize("piece", PIECES, ids=lambda p: type(p).__name__)
@pytest.mark.parametrize("tolerance", [1e-4, 0.003, 0.1, 1.7, 30])
def test_no_chord_departs_by_more_than_the_tolerance(piece: Piece, tolerance: float):
    line = piece_points(piece, tolerance)
    assert tuple(line[0]) == piece.ends[0]
    assert tuple(line[-1]) == piece.ends[1]
    spots = piece.points(np.linspace(0, 1, 3001))
    away = shapely.distance(shapely.LineString(line), shapely.points(spots)).max()
    assert away <= tolerance * (1 + 1e-8) + 1e-12
    # The vertices lie on the curve: between samples it strays from their chords by next to nothing.
    assert shapely.distance(shapely.LineString(spots), shapely.points(line)).max() < 1e-4


def region(x: float) -> Region:
    """A stadium with a round and an elliptic hole, and a whole circle beside it."""
    top, bottom = arc((x + 20, 0), 10, -90, 90), arc((x, 0), 10, 90, 270)
    outer = Loop((Line(bottom.end, top.start), top, Line(top.end, bottom.start), bottom))
    holes = (Loop((Circle((x, 0), 4),), True), Loop((Ellipse((x + 20, 0), 6, 3, 0.3),), True))
    return Region((Face(outer, holes), Face(Loop((Circle((x + 60, 0), 7),)))))


def test_the_area_converges():
    """Cut by chords of n per turn, areas are short by a share that falls with n², as the tolerance does."""
    for x in (0.0, 1e7):
        exact = region(x).area
        errors = [abs(_area(region(x), tolerance) - exact) for tolerance in (1e-1, 1e-2, 1e-3)]
        assert errors[0] < exact * 0.03
        assert errors[1] < errors[0] / 5
        assert errors[2] < errors[1] / 5


def _area(r: Region, tolerance: float) -> float:
    return sum(map(polygon_area, r.polygons(tolerance)))


def test_a_sliver_thinner_than_the_tolerance_does_not_turn_inside_out():
    """A crescent between two circles through (±10, 0), 0.002 mm at its widest."""

    def bow(rise: float, forward: bool) -> Arc:
        radius = (100 + rise * rise) / (2 * rise)
        sweep = 4 * math.atan(rise / 10)
        right, left = (10.0, 0.0), (-10.0, 0.0)
        center = (0.0, rise - radius)
        return (
            Arc(center, radius, right, left, sweep) if forward else Arc(center, radius, left, right, -sweep)
        )

    face = Face(Loop((bow(3.002, True), bow(3.0, False))))
    exact = Region((face,)).area
    assert exact == pytest.approx(2 / 3 * 20 * 0.002, rel=0.1)
    (polygon,) = Region((face,)).polygons(1.0)
    assert polygon_area(polygon) > exact / 2


@pytest.mark.parametrize("tolerance", [0.0, -1.0, math.nan])
def test_a_tolerance_is_above_0(tolerance: float):
    with pytest.raises(ValueError, match="above 0"):
        Loop((Circle((0, 0), 1),)).polygon(tolerance)

"""Where curves meet: crossings counted by signs along a fine sampling, touches that are built to be ones."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from aidl_lang.geometry.curves import Bezier, Circle, Ellipse, Line, Piece, Vec
from aidl_lang.geometry.intersect import intersections
from tests.amount import tries

TOLERANCE = 1e-7
NUMBER = st.floats(-10, 10).map(lambda x: round(x, 3))
SIZE = st.floats(0.5, 9).map(lambda x: round(x, 3))
POINT = st.tuples(NUMBER, NUMBER)
BEZIER = st.builds(Bezier, POINT, POINT, POINT, POINT)
ELLIPSE = st.builds(Ellipse, POINT, SIZE, SIZE, st.floats(0, 6).map(lambda x: round(x, 3)))


@tries(200)
@given(st.one_of(BEZIER, ELLIPSE), POINT, SIZE)
def test_crossings_of_a_circle_are_where_the_distance_from_its_centre_passes_the_radius(
    curve: Piece, center: Vec, radius: float
) -> None:
    spots = curve.points(np.linspace(0, 1, 4001))
    outside = np.hypot(*(spots - center).T) - radius
    assume(np.abs(outside).min() < 1)
    turns = outside[1:-1][(outside[1:-1] - outside[:-2]) * (outside[2:] - outside[1:-1]) <= 0]
    assume(np.abs(np.array([*turns, outside[0], outside[-1]])).min() > 1e-3)  # neither touches nor ends on it
    found = intersections(Circle(center, radius), curve, TOLERANCE)
    passes = spots[1:][np.diff(outside > 0)]
    assume(all(math.dist(p, q) > 0.1 for k, p in enumerate(passes) for q in passes[:k]))
    assert len(found) == len(passes)
    for _, s, p in found:
        assert math.dist(p, center) - radius == pytest.approx(0, abs=1e-9)
        assert curve.point(s) == p


@tries(200)
@given(BEZIER, st.floats(0.1, 0.9), SIZE, st.sampled_from([-1, 1]))
def test_a_touch_is_found(curve: Bezier, t: float, size: float, side: int) -> None:
    (x, y), (dx, dy) = curve.point(t), curve.derivative(t)
    speed, (ax, ay) = math.hypot(dx, dy), curve.second_derivative(t)
    assume(speed > 0.5)
    bend = (dx * ay - dy * ax) / speed**3
    assume(
        abs(bend) > 0.01 and abs(bend * side * size - 1) > 0.01
    )  # neither straight nor as bent as the circle
    dx, dy = dx / speed, dy / speed
    line = Line((x - 2 * dx, y - 2 * dy), (x + size * dx, y + size * dy))
    circle = Circle((x - side * size * dy, y + side * size * dx), size)
    for other in (line, circle):
        found = intersections(curve, other, TOLERANCE)
        assert min(math.dist(p, (x, y)) for _, _, p in found) < 1e-5


@tries(200)
@given(BEZIER, st.floats(0, 1))
def test_a_point_on_a_curve_is_located(curve: Bezier, t: float) -> None:
    speeds = [math.hypot(*curve.derivative(k / 99)) for k in range(100)]
    assume(min(speeds) > 0.1 * max(speeds))  # near a cusp two stretches lie between two samples
    p = curve.point(t)
    found = curve.locate(p, TOLERANCE)
    assert found is not None
    assert math.dist(curve.point(found), p) <= TOLERANCE

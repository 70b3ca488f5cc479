"""Where curves meet: crossings counted by signs along a fine sampling, touches that are built to be ones."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from aidl_lang.geometry.boolean import ALL_PAIRS, Contact, piece_distance
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, Line, Piece, Vec
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.intersect import intersections
from aidl_lang.geometry.solved import SolvedGeometry
from tests.amount import tries
from tests.geometry.models import arc, circle, model, structure

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
    assert math.dist(curve.point(found), p) <= TOLERANCE


# --- Pairs of bodies, and distances ---------------------------------------------------------------------


def pairs(*shapes: SolvedGeometry) -> list[Contact]:
    solids = [structure("solid", f"p{i}", shape) for i, shape in enumerate(shapes)]
    return list(draw(model(structure("assembly", "a", *solids)))[0].pairs)


def test_large_drawings_list_near_pairs_only():
    count = ALL_PAIRS + 6
    found = pairs(*(circle("c", 10 * i, 0, 5) for i in range(count)))
    touching = [(p.a, p.b) for p in found if p.relation == "touching"]
    assert touching == [(f"a.p{i}", f"a.p{i + 1}") for i in range(count - 1)]
    assert all(p.gap <= 15 for p in found if p.gap is not None)


CURVES: list[Piece] = [
    Line((0, 0), (3, 1)),
    arc((1, 4), 2, 200, 300),
    Arc((5, 5), 1, (6, 5), (5, 4), 1.5 * math.pi),
    Circle((8, 0), 1.5),
    Ellipse((-4, 3), 2, 1, 0.5),
    Bezier((9, 9), (4, 3), (12, 3), (7, 9)),
]


@pytest.mark.parametrize(("one", "other"), list(combinations(CURVES, 2)))
def test_distances_agree_with_a_fine_sampling(one: Piece, other: Piece):
    ts = np.linspace(0, 1, 1501)
    p, q = one.points(ts), other.points(ts)
    sampled = min(float(np.hypot(*(q - row).T).min()) for row in p)
    found, a, b = piece_distance(one, other)
    assert found == pytest.approx(sampled, abs=1e-3)
    assert math.dist(a, b) == found

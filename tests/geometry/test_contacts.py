"""Pairs of bodies, distances and the sharing of nodes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.geometry.boolean import ALL_PAIRS, Contact, piece_distance
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, Line, Piece, points
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.solved import SolvedGeometry
from tests.amount import tries
from tests.geometry.models import arc, circle, model, rectangle, structure


def pairs(*shapes: SolvedGeometry) -> list[Contact]:
    solids = [structure("solid", f"p{i}", shape) for i, shape in enumerate(shapes)]
    return list(draw(model(structure("assembly", "a", *solids)))[0].pairs)


@pytest.mark.parametrize(
    ("one", "other", "relation", "amount"),
    [
        (rectangle("r", 0, 0, 2, 2), rectangle("r", 2, 1, 4, 3), "touching", None),
        (rectangle("r", 0, 0, 2, 2), rectangle("r", 2, 2, 4, 3), "touching", None),
        (rectangle("r", 0, 0, 2, 2), rectangle("r", 5, 6, 7, 7), "apart", 5.0),
        (circle("c", 0, 0, 2), circle("c", 5, 0, 3), "touching", None),
        (circle("c", 0, 0, 2), circle("c", 6, 0, 3), "apart", 1.0),
        (circle("c", 0, 0, 5), circle("c", 1, 0, 1), "overlapping", math.pi),
        (rectangle("r", 0, 0, 2, 2), circle("c", 1, 5, 2), "apart", 1.0),
        (rectangle("r", 0, 0, 2, 2), rectangle("r", 1, 1, 4, 3), "overlapping", 1.0),
        (rectangle("r", 0, 0, 2, 2), rectangle("r", 2 + 1e-9, 0, 4, 3), "touching", None),
        (rectangle("r", 0, 0, 2, 2), rectangle("r", 2 - 1e-9, 0, 4, 3), "touching", None),
    ],
)
def test_relations(one: SolvedGeometry, other: SolvedGeometry, relation: str, amount: float | None):
    (pair,) = pairs(one, other)
    assert pair.relation == relation
    assert (pair.gap if relation == "apart" else pair.area) == pytest.approx(amount)


def test_a_pin_in_its_bore_touches_the_plate():
    hole = structure("hole", "h", circle("c", 0, 0, 2))
    plate = structure("solid", "plate", circle("c", 0, 0, 5), hole)
    for radius, relation in ((2, "touching"), (1.5, "apart"), (3, "overlapping")):
        pin = structure("solid", "pin", circle("c", 0, 0, radius))
        (pair,) = draw(model(structure("assembly", "a", plate, pin)))[0].pairs
        assert pair.relation == relation


def test_only_pairs_that_come_near_are_compared_before_they_are_asked_for():
    shapes = [circle("c", x, 0, 1) for x in (0, 2, 5, 7.0005)]
    solids = [structure("solid", f"p{i}", shape) for i, shape in enumerate(shapes)]
    found = draw(model(structure("assembly", "a", *solids)))[0].contacts
    assert found.near() == (("a.p0", "a.p1"), ("a.p2", "a.p3"))
    apart = [(p.a, p.b, pytest.approx(p.gap)) for p in found.all() if (p.a, p.b) not in found.near()]
    assert apart == [
        ("a.p0", "a.p2", 3),
        ("a.p0", "a.p3", 5.0005),
        ("a.p1", "a.p2", 1),
        ("a.p1", "a.p3", 3.0005),
    ]


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


@pytest.mark.parametrize("i", range(len(CURVES)))
@pytest.mark.parametrize("j", range(len(CURVES)))
def test_distances_agree_with_a_fine_sampling(i: int, j: int):
    if i >= j:
        return
    ts = np.linspace(0, 1, 1501)
    p, q = points(CURVES[i], ts), points(CURVES[j], ts)
    sampled = min(float(np.hypot(*(q - row).T).min()) for row in p)
    found, a, b = piece_distance(CURVES[i], CURVES[j])
    assert found == pytest.approx(sampled, abs=1e-3)
    assert math.dist(a, b) == found


@tries(80)
@given(st.floats(-9, 9), st.floats(-9, 9), st.floats(0.1, 3), st.floats(0, 360), st.floats(10, 350))
def test_line_to_arc(x: float, y: float, r: float, first: float, sweep: float):
    line, bow = Line((-2.0, -1.0), (3.0, 2.0)), arc((x, y), r, first, first + sweep)
    ts = np.linspace(0, 1, 2001)
    p, q = points(line, np.linspace(0, 1, 401)), points(bow, ts)
    sampled = float(np.hypot(p[:, None, 0] - q[None, :, 0], p[:, None, 1] - q[None, :, 1]).min())
    found = piece_distance(line, bow)[0]
    assert sampled - 0.02 <= found <= sampled + 1e-9 or sampled < 0.02

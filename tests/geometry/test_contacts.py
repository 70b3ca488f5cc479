"""Pairs of bodies, distances and the sharing of nodes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from aidl_lang.geometry.boolean import ALL_PAIRS, Contact, piece_distance
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, Line, Piece
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.solved import SolvedGeometry
from tests.geometry.models import arc, circle, model, structure


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


@pytest.mark.parametrize("i", range(len(CURVES)))
@pytest.mark.parametrize("j", range(len(CURVES)))
def test_distances_agree_with_a_fine_sampling(i: int, j: int):
    if i >= j:
        return
    ts = np.linspace(0, 1, 1501)
    p, q = CURVES[i].points(ts), CURVES[j].points(ts)
    sampled = min(float(np.hypot(*(q - row).T).min()) for row in p)
    found, a, b = piece_distance(CURVES[i], CURVES[j])
    assert found == pytest.approx(sampled, abs=1e-3)
    assert math.dist(a, b) == found

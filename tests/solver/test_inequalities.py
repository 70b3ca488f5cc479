"""Inequalities and branching expressions."""

from __future__ import annotations

import random

from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.solver import solve
from tests.amount import tries

from .build import Model, call, distance
from .check import assert_smallest_change, assert_solved


@given(st.integers(0, 10_000))
@tries(25)
def test_random_half_planes(seed: int) -> None:
    rng = random.Random(seed)
    m = Model()
    x, y, z = (m.unknown(rng.uniform(-5, 5)) for _ in range(3))
    for _ in range(8):
        m.at_most(
            x * rng.uniform(-1, 1) + y * rng.uniform(-1, 1) + z * rng.uniform(-1, 1) - rng.uniform(0.1, 2)
        )
    solution = solve(problem := m.problem())  # the origin always satisfies them
    assert_solved(problem, solution)
    assert_smallest_change(problem, solution)


@given(st.integers(0, 10_000))
@tries(20)
def test_points_kept_apart_and_within_a_disc(seed: int) -> None:
    rng = random.Random(seed)
    m = Model()
    points = [m.point(rng.uniform(-3, 3), rng.uniform(-3, 3)) for _ in range(4)]
    for i, p in enumerate(points):
        m.at_most(call("hypot", *p) - 4.0)
        for q in points[:i]:
            m.at_most(2.0 - distance(p, q))
    solution = solve(problem := m.problem())
    assert_solved(problem, solution)

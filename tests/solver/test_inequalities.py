"""Inequalities and branching expressions."""

from __future__ import annotations

import functools
import itertools
import math
import operator
import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.solver import Settings, solve
from aidl_lang.solver.analysis import analyse
from tests.amount import tries

from .build import Model, call, distance
from .check import assert_smallest_change, assert_solved


def test_one_that_holds_has_no_influence() -> None:
    m = Model()
    x, y = m.unknown(1.0, visible=True), m.unknown(2.0, visible=True)
    m.equal(x + y - 5.0)
    plain = solve(before := m.problem())
    m.at_most(x - 100.0)
    m.at_most(y - 3.5)
    with_them = solve(after := m.problem())
    assert with_them.values.tobytes() == plain.values.tobytes()
    assert analyse(after, with_them).degrees == analyse(before, plain).degrees == 1


def test_a_violated_one_is_met_on_the_bound() -> None:
    m = Model()
    x = m.unknown(0.0)
    m.at_most(3.0 - x)
    m.at_most(5.0 - x)
    assert solve(m.problem()).values == pytest.approx([5.0], abs=1e-9)


def test_one_that_comes_to_be_violated_joins_and_one_that_pulls_leaves() -> None:
    m = Model()
    x, y = m.unknown(0.0), m.unknown(0.0)
    m.equal(x - 10.0)
    m.at_most(x - y - 4.0)
    m.at_most(1.0 - y)  # violated at the start, but carried along by the other
    solution = solve(problem := m.problem())
    assert solution.values == pytest.approx([10.0, 6.0])
    assert_smallest_change(problem, solution)


def test_a_chain_of_pushes() -> None:
    m = Model()
    boxes = [m.unknown(0.1 * i) for i in range(20)]
    for a, b in itertools.pairwise(boxes):
        m.at_most(a + 2.0 - b)
    solution = solve(problem := m.problem())
    assert_solved(problem, solution)
    assert_smallest_change(problem, solution)


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


class TestBranches:
    def test_a_minimum_over_several_ends_at_its_value(self) -> None:
        m = Model()
        x, y = m.unknown(0.0), m.unknown(1.0)
        m.equal(call("minimum", x, y) - 5.0)
        assert solve(m.problem()).values == pytest.approx([5.0, 5.0])

    def test_a_maximum_where_only_the_other_branch_can_move(self) -> None:
        m = Model()
        x = m.unknown(3.0)
        m.equal(call("maximum", x, x * 0.0 + 5.0) - 8.0)
        assert solve(m.problem()).values == pytest.approx([8.0])

    def test_a_maximum_overtaken_on_the_way(self) -> None:
        m = Model()
        x, y = m.unknown(10.0), m.unknown(9.0)
        m.equal(call("maximum", x, y) - 4.0)
        m.equal(y - 4.0 + (x - 4.0) * 0.0)
        solution = solve(problem := m.problem())
        assert_solved(problem, solution)

    def test_absolute_values_keep_their_sign(self) -> None:
        m = Model()
        x = m.unknown(-3.0)
        m.equal(abs(x) - 5.0)
        assert solve(m.problem()).values == pytest.approx([-5.0])

    def test_angles_agree_modulo_a_turn(self) -> None:
        m = Model()
        x = m.unknown(725.0)
        m.equal((x + 180.0 - 20.0) % 360.0 - 180.0)
        assert solve(m.problem()).values == pytest.approx([740.0])

    def test_select_takes_the_branch_of_its_condition(self) -> None:
        m = Model()
        x, y = m.unknown(1.0), m.unknown(0.0)
        m.equal(call("select", x, y - 4.0, y + 4.0))
        assert solve(m.problem()).values == pytest.approx([1.0, 4.0])

    def test_boxes_side_by_side(self) -> None:
        m = Model()
        circles = [
            (m.unknown(x), m.unknown(y), r) for x, y, r in [(0, 0, 3), (5, 1, 2), (6, 8, 1), (9, 2, 4)]
        ]
        left, right = circles[:2], circles[2:]
        right_edge = call("maximum", *(x + float(r) for x, _, r in left))
        left_edge = call("minimum", *(x - float(r) for x, _, r in right))
        m.equal(left_edge - right_edge - 1.0)
        top = call("maximum", *(y + float(r) for _, y, r in left))
        other_top = call("maximum", *(y + float(r) for _, y, r in right))
        m.equal(top - other_top)
        solution = solve(problem := m.problem())
        assert_solved(problem, solution)
        x = solution.values
        assert max(x[0] + 3, x[2] + 2) + 1 == pytest.approx(min(x[4] - 1, x[6] - 4))

    def test_without_pruning_a_search_follows_the_branches_as_far_as_slopes_lead(self) -> None:
        """Both ways meet a maximum that is near; one whose own branch cannot move needs another branch."""
        for far, status in ((5.0, "solved"), (1000.0, "partial")):
            m = Model()
            x, y = m.unknown(3.0), m.unknown(1.0)
            m.equal(call("maximum", x, y * 0.0 + far) - far - 3.0)
            m.equal(call("minimum", x, y) - 2.0)
            problem = m.problem()
            assert_solved(problem, solve(problem))
            freely = solve(problem, Settings(pruning=False))
            assert freely.status == status
            if freely.status == "solved":
                assert freely.values == pytest.approx([8.0, 2.0])

    def test_without_pruning_many_rows_are_solved_as_well(self) -> None:
        """Those that would go to arrays, which know chosen branches alone."""
        m = Model()
        starts = [(1.0 + i % 7) * (-1.0) ** i for i in range(420)]
        xs = [m.unknown(start) for start in starts]
        for i, x in enumerate(xs):
            m.equal(abs(x) - 3.0 - i % 5)
        m.equal(functools.reduce(operator.add, xs) - m.unknown(0.0))
        signed = [math.copysign(3.0 + i % 5, start) for i, start in enumerate(starts)]
        for settings in (Settings(), Settings(pruning=False), Settings(together=False)):
            assert solve(m.problem(), settings).values == pytest.approx([*signed, sum(signed)])

    def test_no_branch_will_do(self) -> None:
        m = Model()
        x = m.unknown(2.0)
        m.equal(abs(x) + 1.0)
        solution = solve(m.problem())
        assert solution.status == "failed"
        assert np.isfinite(solution.values).all()

    def test_the_extent_of_a_cubic(self) -> None:
        m = Model()
        p = [m.unknown(y) for y in (0.0, 4.0, 4.0, 0.0)]
        m.equal(call("cubic_max", *p) - 6.0)
        x = solve(m.problem()).values
        t = np.linspace(0, 1, 100_001)
        height = (1 - t) ** 3 * x[0] + 3 * (1 - t) ** 2 * t * x[1] + 3 * (1 - t) * t * t * x[2] + t**3 * x[3]
        assert height.max() == pytest.approx(6.0, abs=1e-8)

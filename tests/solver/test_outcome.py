"""Failures with their conflicts, degrees of freedom, redundancy."""

from __future__ import annotations

import numpy as np
import pytest

from aidl_lang.solver import Settings, solve

from .build import Model, distance


class TestConflicts:
    def test_two_values_for_one_unknown(self) -> None:
        m = Model()
        x, y = m.unknown(0.0), m.unknown(0.0)
        m.equal(y - x)
        first = m.equal(x - 3.0)
        m.at_most(x - 100.0)
        second = m.equal(x - 5.0)
        solution = solve(m.problem())
        assert solution.status == "partial"
        (failure,) = solution.failures
        assert failure.conflict == (first, second)
        assert failure.minimal
        assert failure.reason == "contradictory"

    def test_a_triangle_that_cannot_close(self) -> None:
        m = Model()
        a, b, c, d = (m.point(x, y) for x, y in [(0, 0), (4, 1), (2, 3), (9, 9)])
        sides = [m.equal(distance(p, q) - v) for p, q, v in [(a, b, 3.0), (b, c, 4.0), (a, c, 9.0)]]
        m.equal(distance(c, d) - 5.0)
        (failure,) = solve(m.problem()).failures
        assert failure.conflict == tuple(sides)
        assert failure.minimal
        assert failure.reason == "contradictory"

    def test_inequalities_take_part(self) -> None:
        m = Model()
        x, y = m.unknown(0.0), m.unknown(0.0)
        conflict = (m.at_most(x - y + 1.0), m.at_most(y - x + 1.0))
        m.at_most(x - 10.0)
        assert solve(m.problem()).failures[0].conflict == conflict

    def test_the_rest_of_the_tree_is_still_solved(self) -> None:
        m = Model()
        bad, good = m.group(), m.group()
        x, y, z = m.unknown(0.0, bad), m.unknown(0.0, good), m.unknown(0.0)
        m.equal(x - 1.0, group=bad)
        m.equal(x - 2.0, group=bad)
        held = m.equal(y - 4.0, group=good)
        top = m.equal(z - x - y)
        solution = solve(m.problem())
        assert solution.status == "partial"
        assert [failure.group for failure in solution.failures] == [bad]
        assert solution.satisfied[held]
        assert solution.satisfied[top]

    def test_without_explanation(self) -> None:
        m = Model()
        x = m.unknown(0.0)
        m.equal(x - 1.0)
        m.equal(x - 2.0)
        solution = solve(m.problem(), Settings(explain=False))
        assert solution.status == "failed"
        assert not solution.failures[0].minimal

    def test_residuals_are_those_of_the_values(self) -> None:
        m = Model()
        x = m.unknown(0.0)
        m.equal(x - 1.0)
        m.at_most(2.0 - x)
        solution = solve(m.problem())
        x_solved = solution.values[0]
        assert solution.residuals == pytest.approx((abs(x_solved - 1.0), max(2.0 - x_solved, 0.0)))
        assert solution.satisfied == tuple(r <= 1e-9 for r in solution.residuals)


class TestFreedom:
    def test_a_rigid_triangle_has_three(self) -> None:
        m = Model()
        points = [m.point(x, y) for x, y in [(0, 0), (4, 0), (1, 3)]]
        for i in range(3):
            m.equal(distance(points[i], points[i - 1]) - 4.0)
        solution = solve(m.problem())
        assert solution.degrees == 3
        assert solution.group_degrees == (3,)
        assert solution.free == tuple(range(6))

    def test_a_pinned_one_has_none(self) -> None:
        m = Model()
        a, b = m.point(0, 0), m.point(4, 1)
        m.equal(*a)
        m.equal(distance(a, b) - 4.0)
        m.equal(b[1])
        solution = solve(m.problem())
        assert solution.degrees == 0
        assert solution.free == ()

    def test_frame_and_contents_against_each_other_do_not_count(self) -> None:
        m = Model()
        child = m.group()
        frame, x = m.unknown(1.0, frame=child), m.unknown(2.0, child)
        m.observe(child, frame + x)
        m.at_most(frame + x - 100.0)
        assert solve(m.problem()).degrees == 1
        m.equal(frame + x - 8.0)
        solution = solve(m.problem())
        assert solution.degrees == 0

    def test_a_frame_that_nothing_mentions_does_not_count(self) -> None:
        m = Model()
        child = m.group()
        frame, x = m.unknown(1.0, frame=child), m.unknown(2.0, child)
        m.observe(child, frame + x)
        m.equal(x - 2.0, group=child)
        assert solve(m.problem()).degrees == 0

    def test_kept_sizes_and_inequalities_do_not_count(self) -> None:
        m = Model()
        x, r = m.unknown(1.0, visible=True), m.unknown(2.0, kept=True, visible=True)
        m.at_most(r - x)
        solution = solve(m.problem())
        assert solution.values == pytest.approx([2.0, 2.0])
        assert solution.degrees == 1
        assert solution.free == (0,)

    def test_groups_are_counted_by_what_they_draw(self) -> None:
        m = Model()
        child = m.group()
        m.point(0, 0)
        p = m.point(1, 1, child)
        m.equal(p[0] - 1.0, group=child)
        solution = solve(m.problem())
        assert solution.degrees == 3
        assert solution.group_degrees == (2, 1)


class TestRedundancy:
    def test_what_follows_from_others_is_named(self) -> None:
        m = Model()
        a, b, c = (m.unknown(float(i)) for i in range(3))
        m.equal(a - b)
        m.equal(b - c)
        third = m.equal(a - c)
        solution = solve(m.problem())
        assert solution.status == "solved"
        assert solution.redundant == (third,)

    def test_independent_ones_are_not(self) -> None:
        m = Model()
        a, b = m.unknown(0.0), m.unknown(1.0)
        m.equal(a - b, a + b - 4.0)
        assert solve(m.problem()).redundant == ()


def test_an_empty_problem() -> None:
    solution = solve(Model().problem())
    assert solution.status == "solved"
    assert solution.values.shape == (0,)
    assert solution.degrees == 0


def test_constraints_over_constants() -> None:
    m = Model()
    x = m.unknown(1.0)
    bad = m.equal(x * 0.0 + 2.0)
    solution = solve(m.problem())
    assert solution.status == "failed"
    assert solution.failures[0].conflict == (bad,)
    assert np.isfinite(solution.values).all()


def test_a_model_too_large_to_count_is_solved_all_the_same() -> None:
    m = Model()
    x = m.unknown(0.0)
    m.equal(x - 3.0)
    problem = m.problem()
    solution = solve(problem, Settings(counted=len(problem.observables) * len(problem.initial) - 1))
    assert solution.status == "solved"
    assert solution.values.tolist() == [3.0]
    assert (solution.degrees, solution.group_degrees, solution.free) == (None, None, ())

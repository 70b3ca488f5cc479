"""Failures with their conflicts."""

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


def test_an_empty_problem() -> None:
    solution = solve(Model().problem())
    assert solution.status == "solved"
    assert solution.values.shape == (0,)


def test_constraints_over_constants() -> None:
    m = Model()
    x = m.unknown(1.0)
    bad = m.equal(x * 0.0 + 2.0)
    solution = solve(m.problem())
    assert solution.status == "failed"
    assert solution.failures[0].conflict == (bad,)
    assert np.isfinite(solution.values).all()

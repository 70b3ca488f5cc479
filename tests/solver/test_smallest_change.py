"""Equations: they hold afterwards, and no solution is nearer to what was written."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.solver import Problem, Settings, solve
from aidl_lang.solver.analysis import analyse
from tests.amount import tries

from .build import Model, call, distance
from .check import assert_smallest_change, assert_solved


def truss(seed: int, points: int = 6) -> Problem:
    """Points in a row, each tied to the two before by lengths a little off."""
    random_number = random.Random(seed).uniform
    m = Model()
    places = [(10.0 * (i // 2), 8.0 * (i % 2)) for i in range(points)]
    at = [m.point(x + random_number(-1, 1), y + random_number(-1, 1)) for x, y in places]
    for i in range(points):
        for j in range(max(0, i - 2), i):
            m.equal(distance(at[i], at[j]) - math.dist(places[i], places[j]) * random_number(0.95, 1.05))
    return m.problem()


@given(st.integers(0, 10_000))
@tries(25)
def test_a_truss_is_satisfied_by_the_smallest_change(seed: int) -> None:
    problem = truss(seed)
    solution = solve(problem)
    assert_solved(problem, solution)
    assert_smallest_change(problem, solution)
    assert analyse(problem, solution).degrees == 3


@given(st.integers(0, 10_000))
@tries(15)
def test_the_order_of_constraints_does_not_matter(seed: int) -> None:
    problem = truss(seed)
    shuffled = list(problem.constraints)
    random.Random(seed).shuffle(shuffled)
    other = solve(problem.with_constraints(shuffled))
    assert np.abs(other.values - solve(problem).values).max() < 1e-6


def test_redundant_copies_change_nothing() -> None:
    problem = truss(3)
    copies = problem.with_constraints(problem.constraints * 2)
    solution = solve(copies)
    assert_solved(copies, solution)
    assert np.abs(solution.values - solve(problem).values).max() < 1e-6
    count = len(problem.constraints)
    told = [(found.constraint, found.follows_from) for found in analyse(copies, solution).redundant]
    assert told == [(count + index, (index,)) for index in range(count)]


def test_the_same_problem_gives_the_same_digits() -> None:
    assert solve(truss(5)).values.tobytes() == solve(truss(5)).values.tobytes()


def test_a_large_move_around_a_curve_ends_at_the_nearest_point() -> None:
    m = Model()
    x, y = m.unknown(1.0), m.unknown(7.0)
    m.equal(x * x / 4.0 + y * y - 25.0)
    solution = solve(m.problem())
    t = np.linspace(0, 2 * math.pi, 1_000_001)
    nearest = np.min(np.hypot(10 * np.cos(t) - 1.0, 5 * np.sin(t) - 7.0))
    assert math.dist(solution.values, (1.0, 7.0)) == pytest.approx(nearest, abs=1e-9)


def test_scales_say_what_moves() -> None:
    m = Model()
    a, b = m.unknown(0.0, scale=1.0), m.unknown(0.0, scale=3.0)
    m.equal(b - a - 10.0)
    assert solve(m.problem()).values == pytest.approx([-1.0, 9.0])


def test_unknowns_in_no_row_never_move() -> None:
    m = Model()
    x, _ = m.unknown(1.0), m.unknown(math.pi)
    m.equal(x - 3.0)
    assert solve(m.problem()).values.tolist() == [3.0, math.pi]


@pytest.mark.parametrize("size", [1e-4, 1.0, 1e5])
def test_sizes_from_tiny_to_huge(size: float) -> None:
    m = Model()
    a, b, c = (m.point(x * size, y * size) for x, y in [(0, 0), (1, 0.1), (0.4, 1.2)])
    for p, q in [(a, b), (b, c), (a, c)]:
        m.equal(distance(p, q) - size, scale=size)
    angle = call("atan2", b[1] - a[1], b[0] - a[0])
    m.equal(angle * (180.0 / math.pi) - 30.0, scale=57.3)
    assert_solved(problem := m.problem(), solve(problem))


class TestSingularStarts:
    def test_coincident_points_asked_to_be_apart(self) -> None:
        m = Model()
        a, b = m.point(2, 3), m.point(2, 3)
        m.equal(distance(a, b) - 10.0)
        solution = solve(problem := m.problem())
        assert_solved(problem, solution)
        assert np.linalg.norm(solution.values - problem.initial) == pytest.approx(math.sqrt(50.0))

    def test_coincident_points_with_a_squared_distance(self) -> None:
        m = Model()
        a, b = m.point(0, 0), m.point(0, 0)
        m.equal((a[0] - b[0]) ** 2.0 + (a[1] - b[1]) ** 2.0 - 25.0)
        assert_solved(problem := m.problem(), solve(problem))

    def test_a_line_without_length_gets_an_angle(self) -> None:
        m = Model()
        a, b = m.point(0, 0), m.point(0, 0)
        m.equal(call("atan2", b[1] - a[1], b[0] - a[0]) - 0.5)
        m.equal(distance(a, b) - 4.0)
        assert_solved(problem := m.problem(), solve(problem))

    def test_collinear_points_become_a_triangle(self) -> None:
        m = Model()
        a, b, c = m.point(0, 0), m.point(5, 0), m.point(10, 0)
        for p, q in [(a, b), (b, c), (a, c)]:
            m.equal(distance(p, q) - 7.0)
        assert_solved(problem := m.problem(), solve(problem))

    def test_concentric_circles_become_tangent(self) -> None:
        m = Model()
        a, b = m.point(1, 1), m.point(1, 1)
        r, s = m.unknown(2.0, kept=True), m.unknown(3.0, kept=True)
        m.equal(distance(a, b) - (r + s))
        solution = solve(problem := m.problem())
        assert_solved(problem, solution)
        assert solution.changed == ()

    def test_a_start_without_value(self) -> None:
        m = Model()
        x = m.unknown(0.0)
        m.equal(1.0 / x - 0.25)
        assert_solved(problem := m.problem(), solve(problem))


def test_the_time_limit_is_honoured() -> None:
    solution = solve(truss(1, 60), Settings(seconds=0.0))
    assert solution.status == "failed"
    assert solution.failures[0].reason == "timed out"

"""The stages of language design, section 9, in their order."""

from __future__ import annotations

import pytest

from aidl_lang.solver import Solution, solve

from .build import E, Model, call, distance
from .check import assert_solved


def stages(solution: Solution, group: int = 0) -> list[str]:
    return [report.stage for report in solution.stages if report.group == group]


def test_the_placed_move_before_the_held() -> None:
    m = Model()
    a, b = m.unknown(0.0), m.unknown(10.0)
    m.equal(b - a - 4.0, placed=[b])
    solution = solve(m.problem())
    assert solution.values.tolist() == [0.0, 4.0]
    assert stages(solution) == ["placed"]


def test_the_held_move_if_the_placed_do_not_suffice() -> None:
    m = Model()
    a, b = m.unknown(0.0), m.unknown(10.0)
    m.equal(b - a - 4.0, placed=[b])
    m.equal(b - 20.0, placed=[b])
    solution = solve(m.problem())
    assert solution.values == pytest.approx([16.0, 20.0])
    assert stages(solution) == ["placed", "own"]


def test_a_constraint_that_holds_moves_nothing() -> None:
    m = Model()
    a, b = m.unknown(0.0), m.unknown(4.0)
    m.equal(b - a - 4.0, placed=[b])
    solution = solve(m.problem())
    assert solution.stages == ()
    assert solution.values.tolist() == [0.0, 4.0]


def child_with_point(m: Model, at: float, x: float, parent: int = 0) -> tuple[E, E, int]:
    """A child group with a frame at (at, 0) and a point at x in it: frame, point, group."""
    child = m.group(parent)
    frame, _ = m.frame(child, at)
    return frame, m.unknown(x, child), child


def test_a_child_is_translated_rather_than_changed() -> None:
    m = Model()
    frame, x, _ = child_with_point(m, 10.0, 1.0)
    m.equal(frame + x - 20.0)
    solution = solve(m.problem())
    assert solution.values == pytest.approx([19.0, 0.0, 1.0])
    assert stages(solution) == ["own"]


def test_two_children_that_must_agree_inside() -> None:
    m = Model()
    frame, x, child = child_with_point(m, 0.0, 1.0)
    y = m.unknown(5.0, child)
    m.equal(frame + x - 20.0)
    m.equal(frame + y - 23.0)
    solution = solve(m.problem())
    assert_solved(m.problem(), solution)
    assert stages(solution) == ["own", "positions 1"]


def test_grandchildren_are_translated_before_children_change() -> None:
    m = Model()
    child = m.group()
    outer, _ = m.frame(child)
    x = m.unknown(0.0, child)
    grandchild = m.group(child)
    inner, _ = m.frame(grandchild, 3.0)
    y = m.unknown(1.0, grandchild)
    m.equal(outer + x - 10.0)
    m.equal(outer + inner + y - 20.0)
    solution = solve(problem := m.problem())
    assert_solved(problem, solution)
    assert stages(solution) == ["own", "translations 1"]
    assert solution.values[[m.index(x), m.index(y)]].tolist() == [0.0, 1.0]


def test_what_a_move_could_break_is_taken_along() -> None:
    m = Model()
    child = m.group()
    outer, _ = m.frame(child)
    anchor = m.unknown(0.0, child)
    grandchild = m.group(child)
    inner, _ = m.frame(grandchild, 3.0)
    y = m.unknown(0.0, grandchild)
    m.equal(inner - anchor - 5.0, group=child, placed=[inner])
    m.equal(outer + inner + y - 20.0)
    m.equal(outer - 2.0)
    solution = solve(problem := m.problem())
    assert_solved(problem, solution)
    assert stages(solution, child) == ["placed"]
    assert stages(solution) == ["own", "positions 1"]
    assert solution.values[m.index(y)] == 0.0


def test_kept_sizes_change_last_and_are_reported() -> None:
    m = Model()
    a, b = m.unknown(0.0), m.unknown(10.0)
    width = m.unknown(4.0, kept=True)
    m.equal(a)
    m.equal(b - a - width)
    solution = solve(m.problem())
    assert solution.changed == ()
    m.equal(b - 12.0)
    solution = solve(m.problem())
    assert solution.values == pytest.approx([0.0, 12.0, 12.0])
    assert solution.changed == (m.index(width),)
    assert stages(solution) == ["own", "own sizes"]


def test_of_kept_sizes_the_placed_change_first() -> None:
    m = Model()
    ear, grip = m.unknown(15.0, kept=True), m.unknown(16.0, kept=True)
    m.equal(ear - grip, placed=[ear])
    solution = solve(m.problem())
    assert solution.values.tolist() == [16.0, 16.0]
    assert stages(solution) == ["placed sizes"]


def test_own_sizes_change_before_those_of_children() -> None:
    m = Model()
    child = m.group()
    inner = m.unknown(4.0, child, kept=True)
    own = m.unknown(5.0, kept=True)
    m.equal(own - inner)
    solution = solve(m.problem())
    assert solution.values.tolist() == [4.0, 4.0]
    m.equal(own - 5.0)
    solution = solve(m.problem())
    assert solution.values == pytest.approx([5.0, 5.0])
    assert stages(solution) == ["own sizes", "sizes 1"]


def test_a_descendant_that_nothing_mentions_is_rigid() -> None:
    m = Model()
    a, b = m.unknown(0.0), m.unknown(1.0)
    child = m.group()
    p, q = m.unknown(0.0, child), m.unknown(0.5, child)
    m.equal(q - p - 0.5, group=child)
    m.equal(a - b - 1.0)
    solution = solve(m.problem())
    assert solution.values[[m.index(p), m.index(q)]].tolist() == [0.0, 0.5]


def test_children_are_solved_first() -> None:
    m = Model()
    child = m.group()
    p, q = m.point(0, 0, child), m.point(3, 0, child)
    m.equal(distance(p, q) - 5.0, group=child)
    frame, _ = m.frame(child)
    m.equal(call("maximum", p[0], q[0]) + frame - 10.0)
    solution = solve(problem := m.problem())
    assert_solved(problem, solution)
    assert [report.group for report in solution.stages] == [1, 0]
    assert solution.values[m.index(frame)] == pytest.approx(6.0)


class TestPreferences:
    def test_weights_decide_between_preferences(self) -> None:
        m = Model()
        x = m.unknown(0.0)
        m.equal(x - 3.0, weight=1.0)
        m.equal(x - 7.0, weight=3.0)
        solution = solve(m.problem())
        assert solution.status == "solved"
        assert solution.values == pytest.approx([6.0], abs=1e-8)

    def test_one_that_can_hold_holds_exactly(self) -> None:
        m = Model()
        x, y = m.unknown(0.0), m.unknown(1.0)
        m.equal(x + y - 10.0)
        index = m.equal(x - y - 2.0, weight=1.0)
        solution = solve(m.problem())
        assert solution.satisfied[index]
        assert solution.values == pytest.approx([6.0, 4.0])

    def test_never_at_the_price_of_a_hard_one(self) -> None:
        m = Model()
        x, y = m.unknown(0.0), m.unknown(0.0)
        m.at_most(x - 5.0)
        m.equal(x + y - 1.0)
        soft = m.equal(x - 9.0, weight=100.0)
        solution = solve(problem := m.problem())
        assert_solved(problem, solution)
        assert solution.values == pytest.approx([5.0, -4.0])
        assert not solution.satisfied[soft]

    def test_never_by_changing_a_kept_size(self) -> None:
        m = Model()
        size = m.unknown(4.0, kept=True)
        m.equal(size - 5.0, weight=1.0)
        solution = solve(m.problem())
        assert solution.values.tolist() == [4.0]

    def test_soft_inequalities_count_only_when_violated(self) -> None:
        m = Model()
        x = m.unknown(0.0)
        m.at_most(2.0 - x, weight=1.0)
        m.at_most(x - 50.0, weight=1.0)
        assert solve(m.problem()).values == pytest.approx([2.0])

    def test_along_a_curve(self) -> None:
        m = Model()
        p = m.point(3.0, 4.0)
        m.equal(call("hypot", *p) - 5.0)
        m.equal(p[0] - 10.0, weight=1.0)
        m.equal(p[1] - 10.0, weight=1.0)
        solution = solve(problem := m.problem())
        assert_solved(problem, solution)
        assert solution.values == pytest.approx([12.5**0.5] * 2, abs=1e-5)

    def test_translations_of_children_may_follow_a_preference(self) -> None:
        m = Model()
        frame, x, _ = child_with_point(m, 0.0, 1.0)
        m.equal(frame + x - 20.0, weight=1.0)
        assert solve(m.problem()).values == pytest.approx([19.0, 0.0, 1.0])

"""Solving again after a change: the same answer as a first solve, with less done."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.solver import Memory, Problem, Status, solve
from aidl_lang.solver import hierarchy as hierarchy_module
from aidl_lang.solver.hierarchy import Hierarchy
from tests.amount import tries
from tests.solver.build import Model, distance


def row_of_parts(count: int, lengths: list[float]) -> Problem:
    """Parts, each a rod of a given length, side by side under one root."""
    m = Model()
    edge = None
    for i in range(count):
        part = m.group()
        shift, _ = m.frame(part, 9.0 * i)
        a, b = m.point(0.5, 0.1, part), m.point(4.0 + 0.1 * i, -0.2, part)
        m.equal(distance(a, b) - lengths[i], group=part)
        m.equal(a[1], b[1], group=part)
        if edge is not None:
            m.equal(a[0] + shift - edge - 2.0, placed=[shift])
        edge = b[0] + shift
    return m.problem()


@pytest.fixture(params=["one by one", "all at once"])
def _way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hierarchy_module, "MANY", 10**9 if request.param == "one by one" else 0)


@pytest.mark.usefixtures("_way")
class TestMemory:
    def test_nothing_is_solved_twice(self, monkeypatch: pytest.MonkeyPatch) -> None:
        problem, memory = row_of_parts(6, [5.0] * 6), Memory()
        first = solve(problem, memory=memory)
        assert first.status == Status.SOLVED

        def refuse(*_: object) -> None:
            raise AssertionError("it is known")

        monkeypatch.setattr(Hierarchy, "_solve_with_care", lambda _, groups: refuse() if groups else None)
        again = solve(problem, memory=memory)
        assert (again.status, again.stages) == (first.status, first.stages)
        assert again.values.tobytes() == first.values.tobytes()

    def test_numbers_that_hash_alike_are_told_apart(self) -> None:
        memory = Memory()
        for high in (-1.0, -2.0):  # hash(-1.0) == hash(-2.0)
            m = Model()
            _, y = m.point(0.0, 3.0)
            m.equal(y - high)
            assert solve(m.problem(), memory=memory).values[1] == pytest.approx(high)

    def test_what_has_changed_is_solved_with_all_above_it(self) -> None:
        memory, lengths = Memory(), [5.0] * 6
        before = solve(row_of_parts(6, lengths), memory=memory)
        lengths[2] = 7.5
        again = solve(row_of_parts(6, lengths), memory=memory)
        assert np.abs(again.values - solve(row_of_parts(6, lengths)).values).max() <= 1e-9
        assert np.abs(again.values - before.values).max() > 1.0

    def test_a_failure_is_not_remembered(self) -> None:
        m = Model()
        x = m.unknown(1.0)
        m.equal(x - 2.0)
        m.equal(x - 3.0)
        memory = Memory()
        first, again = solve(m.problem(), memory=memory), solve(m.problem(), memory=memory)
        assert first.failures
        assert again.failures == first.failures

    def test_another_problem_of_the_same_size(self) -> None:
        memory = Memory()
        for wanted in (2.0, 3.0):
            m = Model()
            x = m.unknown(1.0)
            m.equal(x - wanted)
            assert solve(m.problem(), memory=memory).values.tolist() == [wanted]

    @given(
        st.lists(st.floats(1.0, 12.0), min_size=5, max_size=5),
        st.lists(st.tuples(st.integers(0, 4), st.floats(1.0, 12.0)), max_size=3),
    )
    @tries(30)
    def test_any_changes_end_where_a_first_solve_ends(
        self, lengths: list[float], changes: list[tuple[int, float]]
    ) -> None:
        memory = Memory()
        solve(row_of_parts(5, lengths), memory=memory)
        for part, length in changes:
            lengths[part] = length
            again = solve(row_of_parts(5, lengths), memory=memory)
            cold = solve(row_of_parts(5, lengths))
            assert again.status == cold.status
            assert np.abs(again.values - cold.values).max() <= 1e-9

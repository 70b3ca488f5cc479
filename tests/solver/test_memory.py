"""Solving again after a change: the same answer as a first solve, with less done."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.solver import Memory, Problem, solve
from aidl_lang.solver import hierarchy as hierarchy_module
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
    def test_numbers_that_hash_alike_are_told_apart(self) -> None:
        memory = Memory()
        for high in (-1.0, -2.0):  # hash(-1.0) == hash(-2.0)
            m = Model()
            _, y = m.point(0.0, 3.0)
            m.equal(y - high)
            assert solve(m.problem(), memory=memory).values[1] == pytest.approx(high)

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

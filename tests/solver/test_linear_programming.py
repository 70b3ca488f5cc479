"""Linear problems against scipy: feasibility, the nearest point, and minimal conflicts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog, nnls

from aidl_lang.solver import solve
from tests.amount import tries

from .build import E, Model


@dataclass
class Linear:
    """`equations @ x == right` and `inequalities @ x <= bound`, started from `x0`."""

    equations: np.ndarray
    right: np.ndarray
    inequalities: np.ndarray
    bound: np.ndarray
    x0: np.ndarray

    def model(self) -> Model:
        m = Model()
        x = [m.unknown(float(v)) for v in self.x0]

        def less(row: np.ndarray, constant: float) -> E:
            terms = (xi * float(a) for a, xi in zip(row, x, strict=True))
            return sum(terms, start=E(m.builder, m.builder.constant(-constant)))

        for row, constant in zip(self.equations, self.right, strict=True):
            m.equal(less(row, constant))
        for row, constant in zip(self.inequalities, self.bound, strict=True):
            m.at_most(less(row, constant))
        return m

    def feasible(self, chosen: Sequence[int]) -> bool:
        e = [i for i in chosen if i < len(self.right)]
        i = [i - len(self.right) for i in chosen if i >= len(self.right)]
        answer = linprog(
            np.zeros(len(self.x0)),
            A_ub=self.inequalities[i] if i else None,
            b_ub=self.bound[i] if i else None,
            A_eq=self.equations[e] if e else None,
            b_eq=self.right[e] if e else None,
            bounds=[(None, None)] * len(self.x0),
        )
        return bool(answer.status == 0)

    def nearest(self) -> np.ndarray:
        """Least distance programming (Lawson and Hanson, chapter 23, section 4)."""
        rows = np.vstack([self.equations, -self.equations, self.inequalities])
        y = np.concatenate([self.right, -self.right, self.bound]) - rows @ self.x0
        if not len(rows):
            return self.x0
        matrix = np.vstack([-rows.T, -y])
        target = np.append(np.zeros(len(self.x0)), 1.0)
        residual = matrix @ nnls(matrix, target)[0] - target
        return self.x0 - residual[:-1] / residual[-1]


def random_problem(seed: int) -> Linear:
    rng = np.random.default_rng(seed)
    n, e, i = rng.integers(1, 7), rng.integers(0, 4), rng.integers(0, 10)
    equations, right = rng.integers(-2, 3, (e, n)).astype(float), rng.integers(-5, 6, e).astype(float)
    if seed % 2:  # dependent rows must not matter
        equations, right = np.vstack([equations, equations]), np.concatenate([right, right])
    return Linear(
        equations,
        right,
        rng.integers(-2, 3, (i, n)).astype(float),
        rng.integers(-5, 6, i).astype(float),
        rng.uniform(-5, 5, n),
    )


@given(st.integers(0, 100_000))
@tries(60)
def test_against_scipy(seed: int) -> None:
    problem = random_problem(seed)
    solution = solve(problem.model().problem())
    everything = range(len(problem.right) + len(problem.bound))
    if problem.feasible(everything):
        assert solution.status == "solved"
        assert solution.values == pytest.approx(problem.nearest(), abs=1e-6)
        return
    assert solution.status != "solved"
    for failure in solution.failures:
        assert failure.reason == "contradictory"
        assert failure.minimal
        assert not problem.feasible(failure.conflict)
        assert all(problem.feasible([j for j in failure.conflict if j != i]) for i in failure.conflict)

"""Where a problem is well behaved, so that a right solver has only one answer to give.

Everything here is found by finite differences on the independent evaluation of `check`.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from aidl_lang.solver import Problem, Relation, Row

from .check import jacobian, values_of

GAP = 0.05
"""Singular values of a well-behaved system, its rows of length one, are above this; or they are nothing."""
NOTHING = 1e-7
STEP = 0.02
"""How far a neighbour is, in units of the unknowns."""


def hard_rows(problem: Problem) -> list[Row]:
    return [row for c in problem.constraints if c.weight is None for row in c.rows]


def is_regular(problem: Problem, x: np.ndarray, free: np.ndarray | None = None) -> bool:
    """Whether the points that satisfy the active rows form a smooth surface near `x`, clearly so, as far as
    the unknowns `free` (n,) can move.

    Rows may depend on each other if they do so all along the surface: from `x`, which satisfies them, one
    can go along every direction that leaves them as they are.
    """
    surface = _Surface(problem, x, free)
    sigma = surface.sigma
    if bool(((sigma > NOTHING) & (sigma < GAP)).any()):
        return False
    return all(surface.neighbour(direction) is not None for direction in surface.directions())


def neighbours(problem: Problem, x: np.ndarray) -> Iterator[np.ndarray]:
    """Points near `x` that satisfy all hard rows if `x` does."""
    surface, rows = _Surface(problem, x), hard_rows(problem)
    at_most = np.array([row.relation is Relation.AT_MOST for row in rows], dtype=np.bool_)
    slack = np.array([1e-9 * row.scale for row in rows])
    for direction in surface.directions():
        for side in (direction, -direction):
            found = surface.neighbour(side)
            if found is not None:
                values = values_of(problem, [row.expression for row in rows], found)
                if (np.where(at_most, values, np.abs(values)) <= slack).all():
                    yield found


class _Surface:
    """The points that satisfy the rows that are active at `x`."""

    def __init__(self, problem: Problem, x: np.ndarray, free: np.ndarray | None = None) -> None:
        self.problem, self.x = problem, x
        self.unit = problem.scale * (1.0 if free is None else free)
        rows = hard_rows(problem)
        values = values_of(problem, [row.expression for row in rows], x).tolist()
        pairs = [(row, abs(value) <= 1e-6 * row.scale) for row, value in zip(rows, values, strict=True)]
        active = [row for row, is_tight in pairs if row.relation is Relation.EQUAL or is_tight]
        self.nodes = [row.expression for row in active]
        self.row_scale = np.array([row.scale for row in active])
        matrix = self._jacobian(x)
        lengths = np.linalg.norm(matrix, axis=1, keepdims=True)
        unit_rows = np.where(lengths > NOTHING, matrix / np.maximum(lengths, NOTHING), 0.0)
        _, self.sigma, vt = np.linalg.svd(unit_rows, full_matrices=True)
        self.rank = int(np.count_nonzero(self.sigma > NOTHING))
        self.tangents = vt[self.rank :][np.abs(vt[self.rank :] * (self.unit == 0.0)).max(axis=1) < NOTHING]

    def _jacobian(self, x: np.ndarray) -> np.ndarray:
        """Scaled, (r, n)."""
        step = 1e-6 * float(self.problem.scale.min(initial=1.0))
        return jacobian(self.problem, self.nodes, x, step) * self.unit / self.row_scale[:, None]

    def directions(self) -> list[np.ndarray]:
        """Two tangents (n,) of length one in which all directions have a part."""
        found = [np.cos(np.arange(1, len(self.tangents) + 1) * turn) for turn in (1.0, 2.4)]
        return [v / np.linalg.norm(v) @ self.tangents for v in found if len(v)]

    def neighbour(self, direction: np.ndarray) -> np.ndarray | None:
        """A point on the surface a short way along a tangent; None if the surface does not go there."""
        start = self.x + STEP * self.unit * direction
        found = start
        for _ in range(4):
            residuals = self._residuals(found)
            u, sigma, vt = np.linalg.svd(self._jacobian(found), full_matrices=False)
            r = self.rank
            found = found - self.unit * ((vt[:r].T / sigma[:r]) @ (u[:, :r].T @ residuals))
        moved = np.abs((found - start)[self.unit > 0.0] / self.unit[self.unit > 0.0])
        on_it = np.abs(self._residuals(found)).max(initial=0.0) < 1e-9
        return found if on_it and moved.max(initial=0.0) < STEP / 4 else None

    def _residuals(self, x: np.ndarray) -> np.ndarray:
        return values_of(self.problem, self.nodes, x) / self.row_scale

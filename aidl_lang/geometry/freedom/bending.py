"""Tests whether a motion goes on as it begins: a slide along a line may be the first of a way around
something.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.arrays import each_once, scattered
from aidl_lang.solver.analysis import Part
from aidl_lang.solver.gradients import Sparse, linearise
from aidl_lang.solver.problem import Problem, Solution
from aidl_lang.solver.valuation import Valuation

Floats = NDArray[np.float64]

STEP = 1e-3
"""Distance to either side over which a motion is followed, in units of the unknowns."""
KINK = 0.1
"""Greatest bend of a row on the way, as a share of the change of its terms: beyond that the row has a corner
there, and the motion is possible to one side.
"""
STRAIGHT = 1e-5
"""The bend that counts as none, in units of the unknowns."""
ROUNDING = 1e-14
"""Relative error of a difference of three values that rounding explains."""
WORK = 2_000_000
"""Greatest size of the matrix of a part whose motions are followed."""


class Bending:
    """The bends of the equations that hold, and of the observables of a problem, along a motion."""

    def __init__(self, problem: Problem, solution: Solution) -> None:
        self.problem, self.at = problem, np.asarray(solution.values, dtype=np.float64)
        rows = problem.rows
        holding = np.isnan(problem.weight) & np.array(solution.satisfied, dtype=np.bool_)
        equal = np.flatnonzero(holding[rows.constraint] & ~rows.at_most)
        self.equations = len(equal)
        observed = np.array([node for _, node in problem.observables], dtype=np.intp)
        self.roots = np.concatenate((rows.expression[equal], observed))

    @cached_property
    def slopes(self) -> Sparse:
        """The slopes of the equations and observables, in units of the unknowns."""
        return self._slopes(self.at)

    @cached_property
    def slopes_beside(self) -> Sparse:
        """The same a little away, where slopes are no zeros by chance."""
        away = STEP * (0.75 + 0.25 * scattered(len(self.at), 1))
        return self._slopes(self.at + self.problem.scale * away)

    @cached_property
    def lengths(self) -> Floats:
        """(r,) of the rows of slopes."""
        return np.maximum(self.slopes.lengths(), self.slopes_beside.lengths())

    @cached_property
    def is_bent(self) -> NDArray[np.bool_]:
        """(r,) whether the slopes of a row are others a little away."""
        weights = scattered(len(self.at), 2)
        here, beside = (
            np.bincount(m.rows, m.entries * weights[m.columns], len(m))
            for m in (self.slopes, self.slopes_beside)
        )
        found: NDArray[np.bool_] = np.abs(here - beside) > 1e-9 * self.lengths
        return found

    @cached_property
    def valuation(self) -> Valuation:
        return Valuation(self.problem.tape, self.at.tolist())

    def goes_on(self, part: Part, rates: Floats, wanted: Floats) -> bool:
        """Tells whether the observables of the problem can have the accelerations `wanted` (o,) where the
        unknowns of a part change at these rates.
        """
        columns = part.unknowns
        has_part = np.zeros(len(self.at), dtype=np.bool_)
        has_part[columns] = True
        inside = has_part[self.slopes.columns]
        beside = self.slopes_beside
        touched = has_part[beside.columns] & (beside.entries != 0.0)
        rows = each_once(np.concatenate((self.slopes.rows[inside], beside.rows[touched])))
        if not (self.is_bent[rows].any() or wanted.any()) or len(rows) * len(columns) > WORK:
            return True
        step = STEP / float(np.abs(rates / self.problem.scale[columns]).max())
        bends, rounding = self._second_differences(rows, columns, step * rates)
        asked = np.concatenate((np.zeros(self.equations), wanted))[rows] * step**2
        kept = (np.abs(bends) <= KINK * STEP * self.lengths[rows]) & (self.lengths[rows] > 0.0)
        lengths = self.lengths[rows][kept]
        needed = (asked - bends)[kept] / (STEP**2 * lengths)
        most = float(np.abs(needed).max(initial=0.0))
        # A row that hardly changes is no more than its rounding, however short a step is for it.
        allowed = STRAIGHT * max(1.0, most) + rounding[kept] / (STEP**2 * lengths)
        if (np.abs(needed) <= allowed).all() and most <= 1.0:
            return True
        slopes = self.slopes.only(inside).take(rows[kept]).dense(columns) / lengths[:, None]
        missing = needed - slopes @ np.linalg.lstsq(slopes, needed, rcond=1e-9)[0]
        return bool((np.abs(missing) <= allowed).all())

    def _slopes(self, at: Floats) -> Sparse:
        with np.errstate(all="ignore"):
            matrix = linearise(self.problem.tape, at, self.roots)[1]
        return matrix.scaled(np.ones(len(matrix)), self.problem.scale)

    def _second_differences(
        self, rows: NDArray[np.intp], columns: NDArray[np.intp], step: Floats
    ) -> tuple[Floats, Floats]:
        """(r,) the value of each row one step along and one step back, less twice that between; and how much
        of it may be rounding.
        """
        roots = self.roots[rows].tolist()
        valuation = self.valuation
        cone = valuation.cone(roots)
        values = []
        for sign in (1.0, -1.0, 0.0):
            ahead = self.at[columns] + sign * step
            valuation.assign(zip(columns.tolist(), ahead.tolist(), strict=True))
            valuation.refresh(cone)
            values.append(np.array([valuation.nodes[root] for root in roots]))
        return values[0] - 2.0 * values[2] + values[1], ROUNDING * (1.0 + np.abs(values[2]))

"""Constraints that follow from others, each with those that it follows from.

Gradients tell what happens near by to the first order only: `distance(a, b) == 10` has the gradient of
`b.x - a.x == 10` where both hold, and yet says more. So whatever depends on others by its gradient is tried:
from a place a little off, where the others hold again, the row must hold as well. (If it is the same sum of
the others everywhere, it does.)
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property

import numpy as np

from aidl_lang.common.arrays import each_once, scattered
from aidl_lang.common.records import record
from aidl_lang.solver.dependence import Relation
from aidl_lang.solver.expression import mentioned
from aidl_lang.solver.gradients import Sparse, linearise
from aidl_lang.solver.operations import Floats, Ints
from aidl_lang.solver.problem import Problem
from aidl_lang.solver.stacks import LARGE, RANK

AWAY = 1e-2
"""Distance from the solution at which a row is tried, relative to its scale."""
STEPS = 10
HELD = 1e-10
"""Residual, relative to the scale of the row, at which the others hold again."""
HOLDS = 1e-8
WIDER = 40
"""Rows beyond the combination that are tried one by one."""


@record()
class Equations:
    """Equations that hold, in order of preference; those without slope are left out.

    row    (r,) which of the problem's rows each is
    owner  (r,) its constraint
    matrix unit rows over all unknowns, in units of their scales
    """

    row: Ints
    owner: Ints
    matrix: Sparse


@record()
class Redundancy:
    """A constraint that follows from others; without any one of them it would not."""

    constraint: int
    follows_from: tuple[int, ...]


def redundancies(
    problem: Problem,
    values: Floats,
    equations: Equations,
    relations: Mapping[int, Relation],
    whole: Iterable[int],
) -> list[Redundancy]:
    """Returns the constraints all of whose rows follow from others.

    whole  those that have nothing but equations with a slope
    """
    rows_of: dict[int, list[int]] = defaultdict(list)
    for row, owner in enumerate(equations.owner.tolist()):
        rows_of[owner].append(row)
    tried = _ImplicationTest(problem, values, equations, set(relations))
    found: list[Redundancy] = []
    for constraint in whole:
        rows = rows_of[constraint]
        if not rows or not all(row in relations for row in rows):
            continue
        supports = [tried.support(row, relations[row]) for row in rows]
        if all(supports):
            named = sorted({other for support in supports for other in support})
            found.append(Redundancy(constraint, tuple(dict.fromkeys(equations.owner[named].tolist()))))
    return found


class _ImplicationTest:
    """Tests away from the solution whether rows follow from others."""

    def __init__(self, problem: Problem, values: Floats, equations: Equations, dependent: set[int]) -> None:
        self.problem, self.values, self.equations = problem, values, equations
        self.expressions = problem.rows.expression[equations.row]
        self.scales = problem.rows.scale[equations.row]
        self.dependent = dependent

    def support(self, row: int, relation: Relation) -> Sequence[int]:
        """Returns rows that `row` follows from, each of them needed; empty if that could not be shown."""
        others = sorted(relation)
        if self._is_sum(row, relation) or self._follows(row, others):
            return others
        extra = self._around(row, others)
        if not self._follows(row, [*others, *extra]):
            return ()
        for other in reversed(extra):
            fewer = [kept for kept in extra if kept != other]
            if self._follows(row, [*others, *fewer]):
                extra = fewer
        return sorted([*others, *extra])

    @cached_property
    def _mentions(self) -> list[set[int]]:
        return [set(self._unknowns([row]).tolist()) for row in range(len(self.expressions))]

    def _around(self, row: int, others: Sequence[int]) -> list[int]:
        """Returns independent rows that share unknowns with these, or with those that do, the nearest
        first.
        """
        near = {row, *others}
        columns = set().union(*(self._mentions[each] for each in near))
        found: list[int] = []
        while len(found) < WIDER:
            ring = [
                each
                for each, mentioned in enumerate(self._mentions)
                if each not in near and each not in self.dependent and not mentioned.isdisjoint(columns)
            ]
            if not ring:
                break
            found += ring[: WIDER - len(found)]
            near.update(ring)
            columns = columns.union(*(self._mentions[each] for each in ring))
        return found

    def _is_sum(self, row: int, relation: Relation) -> bool:
        """Tells whether the row is the same combination of others everywhere, as between affine rows."""
        rows = np.array([*relation, row], dtype=np.int64)
        columns = self._unknowns(rows)
        gradient = linearise(self.problem.tape, self.values, self.expressions[rows])[1]
        lengths = gradient.scaled(np.ones(len(rows)), self.problem.scale).lengths()
        shares = np.array([*relation.values(), -1.0])
        away = AWAY * self.problem.scale[columns] * float((self.scales[rows] / lengths).max())
        for seed in range(2):
            place = self.values.copy()
            place[columns] += away * scattered(len(columns), seed)
            parts = shares * linearise(self.problem.tape, place, self.expressions[rows])[0] / lengths
            if not abs(float(parts.sum())) <= HOLDS * float(np.abs(parts).max()):
                return False
        return True

    def _unknowns(self, rows: Sequence[int] | Ints) -> Ints:
        """Returns the unknowns that rows mention, whether or not they have a slope here."""
        found = mentioned(self.problem.tape, self.expressions[rows].tolist())
        return each_once(np.array(found, dtype=np.int64))

    def _follows(self, row: int, others: Sequence[int]) -> bool:
        rows = np.array([*others, row], dtype=np.int64)
        columns = self._unknowns(rows)
        if max(len(rows), len(columns)) > LARGE:
            return False  # not within the budget
        gradient = self._rows(self.values, rows, columns)[1]
        inverse = np.linalg.pinv(gradient[:-1], rcond=RANK)
        for seed in range(2):
            move = scattered(len(columns), seed)
            move -= inverse @ (gradient[:-1] @ move)
            length = float(np.linalg.norm(move))
            if length < RANK:
                return True  # the others leave a single place
            away = AWAY / (length * float(np.linalg.norm(gradient[-1])))
            if not self._holds_at(rows, columns, away * move):
                return False
        return True

    def _holds_at(self, rows: Ints, columns: Ints, move: Floats) -> bool:
        """Tells whether the last of `rows` holds where the others hold again after a move away."""
        place = self.values.copy()
        scale = self.problem.scale[columns]
        place[columns] += move * scale
        for _ in range(STEPS):
            residuals, gradient = self._rows(place, rows, columns)
            if not np.isfinite(residuals).all():
                return False
            if np.abs(residuals[:-1]).max() <= HELD:
                return abs(float(residuals[-1])) <= HOLDS
            place[columns] -= scale * np.linalg.lstsq(gradient[:-1], residuals[:-1], rcond=RANK)[0]
        return False

    def _rows(self, place: Floats, rows: Ints, columns: Ints) -> tuple[Floats, Floats]:
        """Returns residuals and gradients of rows in units of their scales."""
        values, matrix = linearise(self.problem.tape, place, self.expressions[rows])
        dense = matrix.dense(columns) * self.problem.scale[columns]
        return values / self.scales[rows], dense / self.scales[rows][:, None]

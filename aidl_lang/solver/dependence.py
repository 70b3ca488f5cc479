"""Rows of a matrix that are combinations of others, with these combinations.

Rows are taken in an order of preference. One is dependent if it is a combination of independent rows before
it; those with coefficients other than zero are the only ones that make it up: none of them can be left out.
Rows with an unknown of their own are put aside first; of the rest the left null space is reduced, latest rows
first.

Gradients tell what happens near by to the first order only: `distance(a, b) == 10` has the gradient of
`b.x - a.x == 10` where both hold, and yet says more. So a constraint that depends on others by its gradient
is tried: from a place a little off, where the others hold again, it must hold as well. (If it is the same sum
of the others everywhere, it does.)
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import TypeAlias

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver.expression import Floats, Ints, mentioned
from aidl_lang.solver.linear import DOUBT, RANK, Sparse, each_once, others, scattered
from aidl_lang.solver.problem import Problem
from aidl_lang.solver.valuation import LARGE, Sorted, connected, linearise

OWN = 1e-3
"""Least entry of a unit row by which an unknown of its own makes the row independent beyond doubt."""
SHARE = 1e-6
"""Coefficients of unit rows below which they count as zero."""
MOST = 200
"""The most dependent rows of one large part that are explained."""
AWAY = 1e-2
"""Distance from the solution at which a row is tried, relative to its scale."""
STEPS = 10
HELD = 1e-10
"""Residual, relative to the scale of the row, at which the others hold again."""
HOLDS = 1e-8
TRIED = 300
"""Rows or unknowns up to which it is tried whether a row follows from others."""
WIDER = 40
"""Rows beyond the combination that are tried one by one."""

Relation: TypeAlias = dict[int, float]
"""A row as a combination of others."""


def dependent_rows(rows: Sparse, width: int) -> tuple[dict[int, Relation], list[int]]:
    """Returns the relation of each dependent row among unit rows, and the rows that are undecided."""
    relations: dict[int, Relation] = {}
    rest = _entangled(rows, width)
    undecided: list[int] = []
    for part in _connected_parts(rows.take(rest), width):
        names = rest[part].tolist()
        found = _relations(rows.take(rest[part]))
        if found is None:
            undecided += names
            continue
        for row, relation in found.items():
            relations[names[row]] = {names[other]: share for other, share in relation.items()}
    return relations, undecided


def _entangled(matrix: Sparse, width: int) -> Ints:
    """Returns the rows left when those with an unknown that no other mentions are taken away, repeatedly."""
    matrix = matrix.only(matrix.entries != 0.0)
    # The count of rows that mention a column, and the sum of their numbers: with one left, it is its number.
    counts = np.bincount(matrix.columns, minlength=width).tolist()
    sums = np.bincount(matrix.columns, matrix.rows, width).astype(np.int64).tolist()
    lone = [column for column, count in enumerate(counts) if count == 1]
    starts, columns = matrix.starts.tolist(), matrix.columns.tolist()
    sizes = np.abs(matrix.entries).tolist()
    left = np.ones(len(matrix), dtype=np.bool_)
    while lone:
        column = lone.pop()
        if counts[column] != 1:
            continue
        row = sums[column]
        here = columns[starts[row] : starts[row + 1]]
        if sizes[starts[row] + here.index(column)] < OWN:
            continue
        left[row] = False
        for other in here:
            counts[other] -= 1
            sums[other] -= row
            if counts[other] == 1:
                lone.append(other)
    return np.flatnonzero(left)


def _connected_parts(matrix: Sparse, width: int) -> Iterable[Ints]:
    if not len(matrix):
        return []
    links = matrix.links
    label = connected(*links, width)
    part_of_row = np.unique(label[links[1][matrix.starts[:-1]]], return_inverse=True)[1]
    parts = Sorted(part_of_row, int(part_of_row.max()) + 1)
    return [parts.members(part) for part in range(len(parts.count))]


def _relations(matrix: Sparse) -> dict[int, Relation] | None:
    """Returns the relations of the dependent rows of one part; None if its rank is undecided."""
    columns = each_once(matrix.columns)
    if max(len(columns), len(matrix)) > LARGE:
        return _sparse_relations(matrix, columns)
    u, sigma, _ = np.linalg.svd(matrix.dense(columns))
    if ((sigma > DOUBT) & (sigma < RANK)).any():
        return None
    return _reduced(u[:, np.count_nonzero(sigma >= RANK) :].T)


def _sparse_relations(matrix: Sparse, columns: Ints) -> dict[int, Relation] | None:
    from aidl_lang.solver.sparse import UndecidedError, combinations, independent_rows

    local = Sparse(matrix.starts, np.searchsorted(columns, matrix.columns), matrix.entries)
    try:
        independent = independent_rows(local, len(columns))
        dependent = others(len(matrix), independent)
        if not len(dependent):
            return {}
        if len(dependent) > MOST:
            return None
        shares = combinations(local.take(independent), local.take(dependent), len(columns))
    except UndecidedError:
        return None
    left = np.zeros((len(dependent), len(matrix)))
    left[:, independent] = -shares
    left[np.arange(len(dependent)), dependent] = 1.0
    return _reduced(left)


def _reduced(left: Floats) -> dict[int, Relation]:
    """Returns d relations from a basis (d, r) of the left null space, each of the latest row possible."""
    left = left.copy()
    pending = np.arange(len(left))
    pivots: dict[int, int] = {}
    for row in range(left.shape[1] - 1, -1, -1):
        if not len(pending):
            break
        best = int(pending[np.argmax(np.abs(left[pending, row]))])
        if abs(left[best, row]) <= SHARE:
            continue
        left[best] /= left[best, row]
        others = np.flatnonzero(left[:, row])
        others = others[others != best]
        left[others] -= np.outer(left[others, row], left[best])
        pivots[row] = best
        pending = pending[pending != best]
    return {
        row: {
            other: -float(left[vector, other])
            for other in np.flatnonzero(np.abs(left[vector]) > SHARE).tolist()
            if other != row
        }
        for row, vector in pivots.items()
    }


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
        """Returns independent rows that share unknowns with these, or with such rows, the nearest first."""
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
        rows = np.array([*relation, row], dtype=np.intp)
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
        return each_once(np.array(found, dtype=np.intp))

    def _follows(self, row: int, others: Sequence[int]) -> bool:
        rows = np.array([*others, row], dtype=np.intp)
        columns = self._unknowns(rows)
        if max(len(rows), len(columns)) > TRIED:
            return False
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
        values, matrix = linearise(self.problem.tape, place, self.expressions[rows])
        dense = matrix.dense(columns) * self.problem.scale[columns]
        return values / self.scales[rows], dense / self.scales[rows][:, None]

"""Gradients of many nodes at one place, each as the few unknowns that it depends on.

They are accumulated forward as dictionaries, which for a drawing is quickest; for large models the adjoints
of all roots go down the levels of the tape together, as arrays. Newton's method, which comes back to the
same rows again and again, does not use this.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver import arrays
from aidl_lang.solver.expression import Tape, below
from aidl_lang.solver.operations import PARTIALS, VALUE, Bools, Floats, Ints, Op
from aidl_lang.solver.schedule import Schedule
from aidl_lang.solver.valuation import Valuation

Values: TypeAlias = "Mapping[int, float] | Sequence[float]"
"""The value of each node, by its number."""
Gradient: TypeAlias = dict[int, float]
"""Partial derivative by unknown; unknowns that are missing have none."""

FEW = 3000
"""Number of nodes up to which dictionaries are quicker than arrays."""
MANY = 100
"""Nodes to a root beyond which it is not worth it to evaluate the whole tape."""
STEEPEST = 1e100
"""Slopes above this are what overflow leaves."""
NARROW = 50
"""Nodes to a level up to which dictionaries are quicker, as in chains of things that hang on each other."""
BRANCHES = 4
"""Most operands that an operation has."""

_Adjoints: TypeAlias = tuple[Ints, Ints, Floats]
"""Roots, nodes, and the derivatives of the former along the latter."""

FLAT = 1e-9
"""Slopes below this count as zero: coordinates that cancel, as in the width of a box."""


@record()
class Sparse:
    """A matrix by its entries, row by row.

    starts  (r + 1,) where each row begins
    columns (e,)
    entries (e,)
    """

    starts: Ints
    columns: Ints
    entries: Floats

    def __len__(self) -> int:
        return len(self.starts) - 1

    @cached_property
    def rows(self) -> Ints:
        """The row (e,) of each entry."""
        return np.repeat(np.arange(len(self)), np.diff(self.starts))

    def lengths(self) -> Floats:
        """Returns the Euclidean lengths (r,) of the rows."""
        squares = np.bincount(self.rows, self.entries * self.entries, len(self))
        return np.asarray(np.sqrt(squares), dtype=np.float64)

    def scaled(self, rows: Floats, columns: Floats) -> Sparse:
        """Returns the matrix with every entry multiplied by the factors of its row and its column."""
        return Sparse(self.starts, self.columns, self.entries * rows[self.rows] * columns[self.columns])

    def take(self, rows: Ints) -> Sparse:
        """Returns the given rows, in their order."""
        counts = self.starts[rows + 1] - self.starts[rows]
        starts = _starts(counts)
        picked = np.arange(starts[-1]) + np.repeat(self.starts[rows] - starts[:-1], counts)
        return Sparse(starts, self.columns[picked], self.entries[picked])

    def only(self, entries: NDArray[np.bool_]) -> Sparse:
        """Returns the matrix without the entries that are marked False."""
        starts = _starts(np.bincount(self.rows[entries], minlength=len(self)))
        return Sparse(starts, self.columns[entries], self.entries[entries])

    def above(self, other: Sparse) -> Sparse:
        """Returns these rows with those of another matrix below them."""
        starts = np.concatenate((self.starts, self.starts[-1] + other.starts[1:]))
        columns = np.concatenate((self.columns, other.columns))
        return Sparse(starts, columns, np.concatenate((self.entries, other.entries)))

    @property
    def links(self) -> tuple[Ints, Ints]:
        """Pairs of columns that share a row, enough of them to connect all that do."""
        firsts = self.columns[np.minimum(self.starts[:-1], max(len(self.columns) - 1, 0))[self.rows]]
        return firsts, self.columns

    def dense(self, columns: Ints) -> Floats:
        """Returns the given columns as a dense matrix; they are ascending and hold every entry."""
        matrix = np.zeros((len(self), len(columns)))
        matrix[self.rows, np.searchsorted(columns, self.columns)] = self.entries
        return matrix


def _starts(counts: NDArray[np.intp]) -> Ints:
    return np.concatenate((np.zeros(1, dtype=np.int64), np.cumsum(counts, dtype=np.int64)))


def gradients(values: Valuation, roots: Iterable[int]) -> dict[int, Gradient]:
    """Returns the gradient of each root at the current node values, which must be up to date."""
    wanted = list(roots)
    found = _forward(values.tape, values.nodes, below(values.tape, wanted))
    return {root: found[root] for root in wanted}


def linearise(tape: Tape, at: Floats, roots: Ints, among: Bools | None = None) -> tuple[Floats, Sparse]:
    """Returns the values (r,) of `roots` at the unknowns `at` (n,), and their finite partial derivatives; by
    the unknowns `among` (n,) only, if these are given.

    Unknowns without influence on a root have no entry; entries that cancel may be zeros, and products that
    overflow count as none.
    """
    wanted = roots.tolist()
    height = int(tape.levels.max(initial=0)) + 1
    if len(tape) <= max(FEW, NARROW * height) or len(wanted) * MANY < len(tape):
        nodes = below(tape, wanted)
        known = _values(tape, at.tolist(), nodes)
        found = _forward(tape, known, nodes, None if among is None else among.tolist())
        values, matrix = np.array([known[root] for root in wanted]), _sparse([found[root] for root in wanted])
    else:
        with np.errstate(all="ignore"):
            every, slopes = _everything(tape, at, among)
            values, matrix = every[roots], _backward(tape, slopes, roots)
    sensible = np.abs(matrix.entries) < STEEPEST  # not for those that are not numbers
    return values, replace(matrix, entries=np.where(sensible, matrix.entries, 0.0))


def _sparse(rows: Sequence[Gradient]) -> Sparse:
    starts = np.cumsum([0, *(len(row) for row in rows)], dtype=np.int64)
    columns = np.array([unknown for row in rows for unknown in row], dtype=np.int64)
    return Sparse(starts, columns, np.array([slope for row in rows for slope in row.values()]))


def _values(tape: Tape, at: Sequence[float], nodes: Iterable[int]) -> dict[int, float]:
    ops, operands, constants = tape.op_list, tape.operand_lists, tape.constants
    values: dict[int, float] = {}
    for node in nodes:
        op, args = ops[node], operands[node]
        if op == Op.UNKNOWN:
            values[node] = at[args[0]]
        elif op == Op.CONSTANT:
            values[node] = float(constants[node])
        elif len(args) < 3:
            values[node] = VALUE[op](values[args[0]], values[args[-1]])
        else:
            values[node] = VALUE[op](*[values[a] for a in args])
    return values


def _slopes(op: int, args: tuple[int, ...], values: Values, node: int) -> tuple[float, ...]:
    padded = args if len(args) > 1 else args * 2
    return PARTIALS[op](*[values[a] for a in padded], values[node])


def _forward(
    tape: Tape, values: Values, nodes: Iterable[int], among: Sequence[bool] | None = None
) -> dict[int, Gradient]:
    """Returns the gradient of each node from those of its operands, by the unknowns `among` if these are
    given.
    """
    ops, operands = tape.op_list, tape.operand_lists
    found: dict[int, Gradient] = {}
    for node in nodes:
        op, args = ops[node], operands[node]
        total: Gradient = {}
        if op == Op.UNKNOWN:
            total = {args[0]: 1.0} if among is None or among[args[0]] else {}
        elif op != Op.CONSTANT and any(map(found.__getitem__, args)):
            owned = False
            for a, slope in zip(args, _slopes(op, args, values, node), strict=False):
                if slope == 1.0 and not total:
                    total = found[a]  # shared, hence copied before it is added to
                elif slope != 0.0 and found[a]:
                    if not owned:
                        total, owned = dict(total), True
                    for unknown, derivative in found[a].items():
                        total[unknown] = total.get(unknown, 0.0) + slope * derivative
        found[node] = total
    return found


def _everything(tape: Tape, at: Floats, among: Bools | None) -> tuple[Floats, Floats]:
    """Returns the value (m,) of every node of the tape, and the slope (m, 4) of each along its operands;
    along those that depend on an unknown `among` only, if these are given.
    """
    schedule = Schedule(tape)
    values, slopes = schedule.evaluate(at), np.zeros((len(tape), BRANCHES))
    varies = np.ones(len(tape), dtype=np.bool_)
    if among is not None:
        varies[:] = False
        varies[schedule.inputs] = among[schedule.unknowns]
    for batch in schedule.batches:
        operands = tuple(values[a] for a in batch.operands)
        if among is not None:
            varies[batch.nodes] = np.logical_or.reduce([varies[a] for a in batch.operands])
        for k, slope in enumerate(arrays.partials(batch.op, operands, values[batch.nodes])[: len(operands)]):
            slopes[batch.nodes, k] = np.where(varies[batch.operands[k]], slope, 0.0)
    return values, slopes


def _backward(tape: Tape, slopes: Floats, roots: Ints) -> Sparse:
    """Returns the adjoints of all roots at once, from the highest level of the tape to the unknowns."""
    operands, level = tape.operands.astype(np.int64), tape.levels
    pending: dict[int, list[_Adjoints]] = {}
    _sort_in(pending, level, (np.arange(len(roots)), roots, np.ones(len(roots))))
    for height in range(int(level[roots].max(initial=0)), 0, -1):
        if height not in pending:
            continue
        rows, at, weight = _merged(pending.pop(height), len(tape))
        for k in range(BRANCHES):
            share = weight * slopes[at, k]
            passed = share != 0.0
            if passed.any():
                _sort_in(pending, level, (rows[passed], operands[at[passed], k], share[passed]))
    rows, at, weight = _merged(pending.get(0, []), len(tape))
    inputs = tape.ops[at] == Op.UNKNOWN
    rows, columns, weight = rows[inputs], operands[at[inputs], 0], weight[inputs]
    return Sparse(_starts(np.bincount(rows, minlength=len(roots))), columns, weight)


def _sort_in(pending: dict[int, list[_Adjoints]], level: NDArray[np.int32], found: _Adjoints) -> None:
    """Adds adjoints to those that wait at the level of their node."""
    rows, at, weight = found
    order = np.argsort(level[at], kind="stable")
    heights, firsts = np.unique(level[at][order], return_index=True)
    for height, part in zip(heights.tolist(), np.split(order, firsts[1:]), strict=False):
        pending.setdefault(height, []).append((rows[part], at[part], weight[part]))


def _merged(parts: list[_Adjoints], nodes: int) -> _Adjoints:
    """Returns adjoints by root and node, with those of the same root at the same node added up."""
    if not parts:
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros(0)
    keys = np.concatenate([rows * nodes + at for rows, at, _ in parts])
    unique, inverse = np.unique(keys, return_inverse=True)
    total = np.bincount(inverse, np.concatenate([weight for _, _, weight in parts]))
    return unique // nodes, unique % nodes, np.asarray(total, dtype=np.float64)

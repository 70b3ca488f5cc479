"""Many rows as functions of their free unknowns, on whole arrays.

The counterpart of `freezing` for large systems: `ArrayFreezing` chooses branches and separates what varies
from what does not; an `ArrayProgram` evaluates nodes a level and an operation at a time, and accumulates
derivatives in reverse for all rows at once. They live by *pairs* of a row and a node below it; which pairs
there are, and in which order they are visited, is laid out once.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver.expression import (
    BRANCHING,
    IDENTITY,
    LINEAR,
    Bools,
    Floats,
    Ints,
    Op,
    Tape,
    partials_of,
    values_of,
)
from aidl_lang.solver.linear import Matrix, marked, places
from aidl_lang.solver.newton import GOLDEN

DENSE = 4096
"""Entries of a Jacobian up to which it is a dense matrix."""
CANCELLED = 1e-13
"""Part of its terms below which a sum is what rounding left of zero."""
ZERO = -1
"""First member of a difference that is 0."""
TIE = 1e-9
"""Difference, relative to the operands, below which rounding shall not decide between branches."""
ALIKE = 1e-12
"""Relative difference of slopes that is rounding alone."""


@record()
class Step:
    """The pairs `low … high` of one level, from those above them.

    parents (e,) the pair above, slopes (e,) place of the slope between the two, by the pair below
    starts  where each pair's edges begin, None if each has one
    """

    low: int
    high: int
    parents: Ints
    slopes: Ints
    starts: Ints | None


@record(frozen=False)
class ArrayProgram:
    """Some rows as functions of their free unknowns, with branches fixed.

    columns  (k,) the unknowns, ascending
    rows     (r,) which of the roots given to `freeze`
    indptr, indices: the pattern of the Jacobian by rows, as in `scipy.sparse.csr_array`
    affine   (r,) whether each row is an affine function of the unknowns
    plain    (r,) whether it is the same affine function whatever branches are taken; found when asked for
    """

    roots: Ints
    columns: Ints
    indptr: Ints
    indices: Ints
    affine: Bools
    rows: Ints
    _inputs: Ints
    _batches: list[Batch]
    _steps: list[Step]
    _freezing: ArrayFreezing

    @property
    def plain(self) -> Bools:
        return self._freezing.plain[self.roots]

    @property
    def linear(self) -> bool:
        return bool(self.affine.all())

    @property
    def shape(self) -> tuple[int, int]:
        return len(self.roots), len(self.columns)

    def residuals(self, x: Floats) -> Floats:
        """Returns the values (r,) of the rows at the unknowns `x` (k,)."""
        values = self._freezing.values
        values[self._inputs] = x
        with np.errstate(all="ignore"):
            for batch in self._batches:
                values[batch.nodes] = values_of(batch.op, tuple(values[a] for a in batch.operands))
        return values[self.roots]

    def jacobian(self, row_factors: Floats, column_factors: Floats) -> Matrix:
        """Returns the (r, k) partial derivatives where `residuals` was evaluated last, by these factors."""
        entries = self.entries() * row_factors[self.entry_rows] * column_factors[self.indices]
        rows, columns = self.shape
        if rows * columns <= DENSE:
            matrix = np.zeros((rows, columns))
            matrix[self.entry_rows, self.indices] = entries
            return matrix
        from scipy.sparse import csr_array

        from aidl_lang.solver.sparse import SparseMatrix

        return SparseMatrix(csr_array((entries, self.indices, self.indptr), shape=self.shape))

    @cached_property
    def entry_rows(self) -> Ints:
        """The row of each entry of the pattern."""
        return np.repeat(np.arange(len(self.roots)), np.diff(self.indptr))

    def entries(self) -> Floats:
        """Returns the partial derivatives in the order of the pattern, where `residuals` was last found."""
        values, slopes = self._freezing.values, self._freezing.slopes
        stride = len(values)
        with np.errstate(all="ignore"):
            for batch in self._batches:
                operands = tuple(values[a] for a in batch.operands)
                for k, slope in enumerate(partials_of(batch.op, operands, values[batch.nodes])):
                    slopes[k * stride + batch.nodes] = slope
            adjoints = np.empty(self._steps[-1].high + 1 if self._steps else 1)
            adjoints[-1] = 1.0
            for step in self._steps:
                passed = adjoints[step.parents] * slopes[step.slopes]
                if step.starts is not None:
                    sums = np.add.reduceat(passed, step.starts)
                    sizes = np.add.reduceat(np.abs(passed), step.starts)
                    passed = np.where(np.abs(sums) > CANCELLED * sizes, sums, 0.0)
                adjoints[step.low : step.high] = passed
        found = adjoints[len(adjoints) - 1 - len(self.indices) : -1]
        return found if np.isfinite(found).all() else np.nan_to_num(found)


@record()
class Batch:
    """Nodes (k,) of one operation on one level, and the nodes (k,) of each of their operands."""

    op: int
    nodes: Ints
    operands: tuple[Ints, ...]


def _batches(
    ops: NDArray[np.int8], operands: NDArray[np.int32], levels: NDArray[np.int32], nodes: Ints
) -> list[Batch]:
    """Returns some nodes (k,) of a tape as batches in an order in which they can be evaluated."""
    key = levels[nodes].astype(np.intp) * 64 + ops[nodes]
    order = np.argsort(key, kind="stable")
    nodes, key = nodes[order], key[order]
    found = []
    for low, high in pairwise(np.flatnonzero(np.diff(key, prepend=-1, append=-1)).tolist()):
        columns = operands[nodes[low:high]].astype(np.intp).T
        arity = int(np.count_nonzero(columns[:, 0] >= 0))
        found.append(Batch(int(key[low]) % 64, nodes[low:high], tuple(columns[:arity])))
    return found


class Schedule:
    """A tape made ready to be evaluated as a whole."""

    def __init__(self, tape: Tape) -> None:
        self.tape = tape
        self.inputs = np.flatnonzero(tape.ops == Op.UNKNOWN)
        """The nodes that are unknowns."""
        self.unknowns = tape.operands[self.inputs, 0].astype(np.intp)
        """The index of the unknown at each of these nodes."""

    @cached_property
    def size(self) -> int:
        """The number of nodes that are computed."""
        return int(np.count_nonzero(self.tape.ops > Op.UNKNOWN))

    @cached_property
    def batches(self) -> list[Batch]:
        """All other nodes, in an order in which they can be evaluated."""
        tape = self.tape
        return _batches(tape.ops, tape.operands, tape.levels, np.flatnonzero(tape.ops > Op.UNKNOWN))

    @cached_property
    def by_level(self) -> list[Ints]:
        """The nodes of each level but the lowest."""
        order = np.argsort(self.tape.levels, kind="stable")
        bounds = np.cumsum(np.bincount(self.tape.levels))
        return np.split(order, bounds[:-1])[1:] if len(order) else []

    def varying(self, free: Bools, operands: NDArray[np.int32] | None = None) -> Bools:
        """Returns the mask of nodes that depend on the unknowns `free` (n,). `operands` are those through the
        branches that were chosen, with those of nodes added behind the tape.
        """
        operands = self.tape.operands if operands is None else operands
        found = np.zeros(len(operands) + 1, dtype=np.bool_)  # the last is what missing operands refer to
        found[self.inputs] = free[self.unknowns]
        for nodes in (*self.by_level, np.arange(len(self.tape), len(operands))):
            found[nodes] = found[operands[nodes]].any(axis=1)
        return found[:-1]

    def evaluate(self, x: Floats) -> Floats:
        """Returns the value (m,) of each node at the unknowns `x` (n,)."""
        values = self.tape.constants.copy()
        values[self.inputs] = x[self.unknowns]
        with np.errstate(all="ignore"):
            for batch in self.batches:
                values[batch.nodes] = values_of(batch.op, tuple(values[a] for a in batch.operands))
        return values


@record()
class _Layout:
    """A sweep: its steps; rows and nodes of the pairs above the unknowns; row and unknown of each entry."""

    steps: list[Step]
    rows: Ints
    nodes: Ints
    row: Ints
    unknown: Ints


class ArrayFreezing:
    """The rows of a tape at one place, with branches chosen; makes programs of some of them.

    `values` (m,) are those of all nodes at that place. Branching nodes in `flipped` take the branch that is
    not active. Each of `differences` becomes a further node, numbered from m on. The programs share memory:
    no two of them may have unknowns in common. Without `choosing`, every branch counts as active, which is
    good for patterns only.
    """

    def __init__(
        self,
        schedule: Schedule,
        values: Floats,
        free: Bools,
        flipped: Collection[int] = (),
        differences: Sequence[tuple[int, int]] = (),
        choosing: bool = True,
    ) -> None:
        tape = schedule.tape
        self._schedule, self._free = schedule, free
        self._ops, self._operands, self._levels = tape.ops, tape.operands, tape.levels
        self.values = values.copy()
        self._branching = np.flatnonzero(np.isin(tape.ops, list(BRANCHING)))
        self.choices = np.zeros(len(self._branching), dtype=np.intp)
        if choosing and len(self._branching):
            self._choose(flipped)
        if differences:
            self._append(differences)
        self._varies = schedule.varying(free, self._operands)
        self._laid_out: tuple[Ints, _Layout] | None = None
        self.slopes = np.ones(4 * len(self.values) + 1)

    def branches(self, roots: Ints) -> list[tuple[int, int]]:
        """Returns the branching nodes below these (r,) through active branches, and the choice at each."""
        below = marked(roots, len(self.values) + 1)  # the last one is for missing operands
        added = np.arange(len(self._schedule.tape), len(self.values))
        for nodes in (added, *reversed(self._schedule.by_level)):
            below[self._operands[nodes[below[nodes]]]] = True
        taken = below[self._branching]
        return list(zip(self._branching[taken].tolist(), self.choices[taken].tolist(), strict=True))

    @property
    def knows_all_values(self) -> bool:
        """True if every value follows from the unknowns of a program, whatever the others were."""
        return not len(self._branching) and bool(self._varies[self._ops > Op.UNKNOWN].all())

    def varies(self, roots: Ints) -> Bools:
        """Tells whether each of these nodes depends on a free unknown."""
        return self._varies[roots]

    # -- branches

    def _choose(self, flipped: Collection[int]) -> None:
        nodes, values = self._branching, self.values
        ops = self._ops[nodes]
        operands = self._operands[nodes].astype(np.intp)
        first, second = values[operands[:, 0]], values[operands[:, 1]]
        second[ops == Op.ABS] = 0.0
        with np.errstate(all="ignore"):
            ahead = np.where(ops == Op.MINIMUM, first - second, second - first)
            choice = (ahead > TIE * (1.0 + np.abs(first))).astype(np.intp)
            choice[ops == Op.SELECT] = ~(first[ops == Op.SELECT] >= 0.0)
        if flipped:
            choice ^= np.isin(nodes, list(flipped))
        choice[ops == Op.SELECT] += 1
        self._ops, self._operands = self._ops.copy(), self._operands.copy()
        self._ops[nodes] = IDENTITY
        self._ops[nodes[(ops == Op.ABS) & (choice == 1)]] = Op.NEG
        taken = np.where(ops == Op.ABS, 0, choice)
        chosen = np.full((len(nodes), 4), -1)
        chosen[:, 0] = operands[np.arange(len(nodes)), taken]
        self._operands[nodes] = chosen
        self.choices = choice

    def _append(self, differences: Sequence[tuple[int, int]]) -> None:
        pairs = np.array(differences, dtype=np.int32)
        from_zero = pairs[:, 0] == ZERO
        operands = np.full((len(pairs), 4), -1, dtype=np.int32)
        operands[:, :2] = pairs
        operands[from_zero, 0], operands[from_zero, 1] = pairs[from_zero, 1], -1
        values = self.values[pairs]
        values[from_zero, 0] = 0.0
        self._ops = np.append(self._ops, np.where(from_zero, Op.NEG, Op.SUB).astype(np.int8))
        self._operands = np.vstack((self._operands, operands))
        top = np.full(len(pairs), self._levels.max(initial=0) + 1, dtype=np.int32)
        self._levels = np.append(self._levels, top)
        self.values = np.append(self.values, values[:, 0] - values[:, 1])

    @cached_property
    def plain(self) -> Bools:
        """The mask (m,) of nodes that are affine functions of the free unknowns whatever branches are taken.

        The least of several coordinates of one rigid part is such a function, as all of them move alike: two
        branches are taken for one if they change alike in a direction in which no two unknowns change alike.
        """
        tape, schedule = self._schedule.tape, self._schedule
        values, slopes = self.values, np.zeros(len(self.values))
        plain = np.ones(len(values), dtype=np.bool_)
        turn = np.mod(schedule.unknowns * GOLDEN, 1.0) + 0.5
        slopes[schedule.inputs] = np.where(self._free[schedule.unknowns], turn, 0.0)
        with np.errstate(all="ignore"):
            for batch in schedule.batches:
                slopes[batch.nodes], known = _slope(batch, values, slopes)
                for operand in batch.operands:
                    known = known & plain[operand]
                plain[batch.nodes] = known
        plain[len(tape) :] = False
        return plain

    # -- programs

    def pattern(self, roots: Ints) -> tuple[Ints, Ints]:
        """Returns row and unknown (e,) of each entry of the Jacobian of these nodes (r,), which vary."""
        layout = self._lay_out(roots)
        return layout.row, layout.unknown

    def program(self, roots: Ints) -> ArrayProgram:
        """Returns the program of the rows at these nodes (r,), each of which varies."""
        layout = self._lay_out(roots)
        count, width = len(self.values), len(self._free)
        nodes = np.flatnonzero(marked(layout.nodes, count))
        columns = np.flatnonzero(marked(layout.unknown, width))
        indptr = np.zeros(len(roots) + 1, dtype=np.intp)
        np.cumsum(np.bincount(layout.row, minlength=len(roots)), out=indptr[1:])
        affine = ~marked(layout.rows[self._curved(layout.nodes)], len(roots))
        input_of = np.empty(width, dtype=np.intp)
        input_of[self._schedule.unknowns] = self._schedule.inputs
        return ArrayProgram(
            roots,
            columns,
            indptr,
            places(columns, width)[layout.unknown],
            affine,
            np.arange(len(roots)),
            input_of[columns],
            self._batches(nodes),
            layout.steps,
            self,
        )

    def _batches(self, nodes: Ints) -> list[Batch]:
        if self._operands is self._schedule.tape.operands and len(nodes) == self._schedule.size:
            return self._schedule.batches
        return _batches(self._ops, self._operands, self._levels, nodes)

    def _lay_out(self, roots: Ints) -> _Layout:
        """Returns the layout of the pairs of a row and a node below it that varies; keeps the last one."""
        if self._laid_out is None or not np.array_equal(self._laid_out[0], roots):
            self._laid_out = roots, self._find_pairs(roots)
        return self._laid_out[1]

    def _find_pairs(self, roots: Ints) -> _Layout:
        steps: list[Step] = []
        count, width = len(self.values), len(self._free)
        above: dict[int, list[tuple[Ints, ...]]] = {}
        """Pairs still to be visited, by level: row, node, pair above, place of the slope between them."""
        rows, unset = np.arange(len(roots)), np.full(len(roots), -1)
        _add_by_level(above, self._levels[roots], rows, roots, unset, np.full(len(roots), 4 * count))
        low = 0
        visited_rows, visited = [rows[:0]], [rows[:0]]
        row, second = rows[:0], roots[:0]
        while above:
            level = max(above)
            pieces = zip(*above.pop(level), strict=True)
            row, node, parent, slope = (np.concatenate(column) for column in pieces)
            second = node if level else self._operands[node, 0].astype(np.intp)
            key = row * max(count, width) + second
            order = np.argsort(key, kind="stable")
            key = key[order]
            starts = np.flatnonzero(np.diff(key, prepend=-1))
            unique = order[starts]
            row, second = row[unique], second[unique]
            single = len(starts) == len(order)
            high = low + len(starts)
            steps.append(Step(low, high, parent[order], slope[order], None if single else starts))
            if level:
                visited_rows.append(row)
                visited.append(second)
                self._descend(above, row, second, low)
            low = high
        return _Layout(steps, np.concatenate(visited_rows), np.concatenate(visited), row, second)

    def _descend(self, above: dict[int, list[tuple[Ints, ...]]], row: Ints, node: Ints, low: int) -> None:
        """Adds the pairs below those of one level, which are numbered from `low` on."""
        children = self._operands[node]
        at, k = np.nonzero((children >= 0) & self._varies[children])
        child = children[at, k].astype(np.intp)
        slope = k * len(self.values) + node[at]
        _add_by_level(above, self._levels[child], row[at], child, low + at, slope)

    def _curved(self, nodes: Ints) -> Bools:
        """Tells whether each node is not an affine function of those of its operands that vary."""
        ops, operands = self._ops[nodes], self._operands[nodes]
        first, second = (self._varies[operands[:, k]] & (operands[:, k] >= 0) for k in (0, 1))
        straight = np.isin(ops, [*LINEAR, IDENTITY])
        curved: Bools = ~(straight | (ops == Op.DIV) & ~second | (ops == Op.MUL) & ~(first & second))
        return curved


def _add_by_level(
    known: dict[int, list[tuple[Ints, ...]]], levels: NDArray[np.int32], *columns: Ints
) -> None:
    for level in np.flatnonzero(np.bincount(levels)).tolist():
        members = np.flatnonzero(levels == level)
        known.setdefault(level, []).append(tuple(column[members] for column in columns))


def _slope(batch: Batch, values: Floats, slopes: Floats) -> tuple[Floats, Bools]:
    """Returns the slope of each node along the direction in which `slopes` has those of its operands, and a
    mask of the nodes whose slope is the same everywhere.
    """
    op, operands = batch.op, batch.operands
    inner = [slopes[a] for a in operands]
    if op == Op.MUL:
        slope = inner[0] * values[operands[1]] + inner[1] * values[operands[0]]
        return slope, (inner[0] == 0.0) | (inner[1] == 0.0)
    if op == Op.DIV:
        return inner[0] / values[operands[1]], inner[1] == 0.0
    if op in (Op.MINIMUM, Op.MAXIMUM):
        return inner[0], np.abs(inner[0] - inner[1]) <= ALIKE * np.abs(inner[0])
    if op in LINEAR:
        return values_of(op, tuple(inner)), np.ones(len(batch.nodes), dtype=np.bool_)
    return np.zeros(len(batch.nodes)), ~np.any(inner, axis=0)

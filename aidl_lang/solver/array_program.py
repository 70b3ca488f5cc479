"""Many rows as functions of their free unknowns, on whole arrays.

The counterpart of `program` for large systems: nodes are evaluated a level and an operation at a time, and
derivatives are accumulated in reverse for all rows at once. They live by *pairs* of a row and a node below
it; which pairs there are, and in which order they are visited, is laid out once, by `array_freezing`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver import arrays
from aidl_lang.solver.expression import Tape
from aidl_lang.solver.linear import Matrix
from aidl_lang.solver.operations import Bools, Floats, Ints, Op

DENSE = 4096
"""Entries of a Jacobian up to which it is a dense matrix."""
CANCELLED = 1e-13
"""Part of its terms below which a sum is what rounding left of zero."""
IDENTITY = 40
"""The code of a branching node whose branch is chosen; beyond the codes of `Op`."""


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
    _values: Floats
    _slopes: Floats
    _find_plain: Callable[[], Bools]

    @property
    def plain(self) -> Bools:
        return self._find_plain()

    @property
    def linear(self) -> bool:
        return bool(self.affine.all())

    @property
    def shape(self) -> tuple[int, int]:
        return len(self.roots), len(self.columns)

    def residuals(self, x: Floats) -> Floats:
        """Returns the values (r,) of the rows at the unknowns `x` (k,)."""
        values = self._values
        values[self._inputs] = x
        with np.errstate(all="ignore"):
            for batch in self._batches:
                operands = tuple(values[a] for a in batch.operands)
                values[batch.nodes] = _value(batch, operands)
        return values[self.roots]

    def jacobian(self, row_factors: Floats, column_factors: Floats) -> Matrix:
        """Returns the (r, k) partial derivatives where `residuals` was last evaluated, times these
        factors.
        """
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
        """Returns the partial derivatives in the order of the pattern, where `residuals` was last
        evaluated.
        """
        values, slopes = self._values, self._slopes
        stride = len(values)
        with np.errstate(all="ignore"):
            for batch in self._batches:
                operands = tuple(values[a] for a in batch.operands)
                for k, slope in enumerate(_partials(batch, operands, values)):
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


def _value(batch: Batch, operands: tuple[Floats, ...]) -> Floats:
    if batch.op == IDENTITY:
        return operands[0]
    return arrays.values(batch.op, operands)


def _partials(batch: Batch, operands: tuple[Floats, ...], values: Floats) -> tuple[Floats | float, ...]:
    if batch.op == IDENTITY:
        return (1.0,)
    return arrays.partials(batch.op, operands, values[batch.nodes])


@record()
class Batch:
    """Nodes (k,) of one operation on one level, and the nodes (k,) of each of their operands."""

    op: int
    nodes: Ints
    operands: tuple[Ints, ...]


@record()
class Graph:
    """A tape whose branching nodes may have become others: ops (m,), operands (m, 4), levels (m,)."""

    ops: NDArray[np.int8]
    operands: NDArray[np.int32]
    levels: NDArray[np.int32]

    def batches(self, nodes: Ints) -> list[Batch]:
        """Returns these nodes (k,) as batches in an order in which they can be evaluated."""
        key = self.levels[nodes].astype(np.int64) * 64 + self.ops[nodes]
        order = np.argsort(key, kind="stable")
        nodes, key = nodes[order], key[order]
        bounds = np.flatnonzero(np.diff(key, prepend=-1, append=-1)).tolist()
        found = []
        for low, high in pairwise(bounds):
            columns = self.operands[nodes[low:high]].astype(np.int64).T
            arity = int(np.count_nonzero(columns[:, 0] >= 0))
            found.append(Batch(int(key[low]) % 64, nodes[low:high], tuple(columns[:arity])))
        return found


class Schedule:
    """A tape made ready to be evaluated as a whole."""

    def __init__(self, tape: Tape) -> None:
        self.tape = tape
        self.inputs = np.flatnonzero(tape.ops == Op.UNKNOWN)
        """The nodes that are unknowns."""
        self.unknowns = tape.operands[self.inputs, 0].astype(np.int64)
        """The index of the unknown at each of these nodes."""

    @cached_property
    def size(self) -> int:
        """The number of nodes that are computed."""
        return int(np.count_nonzero(self.tape.ops > Op.UNKNOWN))

    @cached_property
    def batches(self) -> list[Batch]:
        """All other nodes, in an order in which they can be evaluated."""
        tape = self.tape
        return Graph(tape.ops, tape.operands, tape.levels).batches(np.flatnonzero(tape.ops > Op.UNKNOWN))

    @cached_property
    def by_level(self) -> list[Ints]:
        """The nodes of each level but the lowest."""
        order = np.argsort(self.tape.levels, kind="stable")
        bounds = np.cumsum(np.bincount(self.tape.levels))
        return np.split(order, bounds[:-1])[1:] if len(order) else []

    def above(self, unknowns: Bools) -> bytes:
        """Returns for each node whether it hangs on nothing but these unknowns (n,)."""
        found = np.ones(len(self.tape) + 1, dtype=np.bool_)  # the last for operands that are not there
        found[self.inputs] = unknowns[self.unknowns]
        for nodes in self.by_level:
            found[nodes] = found[self.tape.operands[nodes]].all(axis=1)
        return found.tobytes()

    def evaluate(self, x: Floats) -> Floats:
        """Returns the value (m,) of each node at the unknowns `x` (n,)."""
        values = self.tape.constants.copy()
        values[self.inputs] = x[self.unknowns]
        with np.errstate(all="ignore"):
            for batch in self.batches:
                values[batch.nodes] = arrays.values(batch.op, tuple(values[a] for a in batch.operands))
        return values

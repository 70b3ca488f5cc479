"""The order in which the nodes of a tape are evaluated on arrays, many at a time."""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver import arrays
from aidl_lang.solver.expression import Tape
from aidl_lang.solver.operations import Bools, Floats, Ints, Op


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

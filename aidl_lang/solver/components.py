"""Connected components of graphs; the small matrices that the parts of a sparse one are, many at once."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from aidl_lang.solver.gradients import Sparse
from aidl_lang.solver.operations import Floats, Ints

EDGES = 3000
"""Edges of a graph up to which scipy is not worth loading."""
RANK = 1e-6
"""Singular values of unit rows above this count towards the rank."""
DOUBT = 1e-8
"""Singular values below this count as zero; between the two the rank is undecided."""
LARGE = 300
"""Rows or columns of a part from which on sparse elimination is quicker."""


def components(a: Ints, b: Ints, count: int) -> Ints:
    """Returns the component of each of `count` vertices, numbered from 0; edges (e,) link `a` and `b`."""
    if len(a) > EDGES:
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        links = coo_array((np.ones(len(a), dtype=np.int8), (a, b)), shape=(count, count))
        labels: Ints = connected_components(links, directed=False)[1].astype(np.int64)
        return labels
    lowest = connected(a, b, count)
    return (np.cumsum(lowest == np.arange(count)) - 1)[lowest]


def connected(a: Ints, b: Ints, count: int) -> Ints:
    """Returns the least vertex of the component of each of `count` vertices; edges (e,) link `a` and `b`."""
    lowest = np.arange(count)
    while True:
        below, above = np.minimum(lowest[a], lowest[b]), np.maximum(lowest[a], lowest[b])
        if (below == above).all():
            return lowest
        np.minimum.at(lowest, above, below)
        while (lowest != (lower := lowest[lowest])).any():
            lowest = lower


class Sorted:
    """Things sorted by the part they belong to: `of[first[p] : first[p] + count[p]]` are those of part p."""

    def __init__(self, part: Ints, parts: int) -> None:
        self.of = np.argsort(part, kind="stable")
        self.count = np.bincount(part[part >= 0], minlength=parts)
        self.first = np.cumsum(self.count) - self.count + np.count_nonzero(part < 0)
        self.place = np.empty(len(part), dtype=np.int64)
        """The number of each within its part."""
        self.place[self.of] = np.arange(len(part)) - np.append(self.first, 0)[part][self.of]

    def members(self, part: int) -> Ints:
        return self.of[self.first[part] : self.first[part] + self.count[part]]


def lots(*sizes: Ints) -> list[Ints]:
    """Groups parts by their sizes, each rounded up to a power of two."""
    exponents = np.ceil(np.log2(np.maximum(np.stack(sizes), 0.5))).astype(np.int64)
    found: dict[tuple[int, ...], list[int]] = defaultdict(list)
    for part, size in enumerate(zip(*exponents.tolist(), strict=True)):
        found[size].append(part)
    return [np.array(parts) for parts in found.values()]


def stacked(matrix: Sparse, of_row: Ints, rows: Sorted, columns: Sorted, slot: Ints) -> Floats:
    """Returns the rows of each part that has a slot as one matrix of a stack, filled up with zeros."""
    slot_of_row = np.append(slot, -1)[of_row]
    at = np.flatnonzero(slot_of_row >= 0)
    picked = matrix.take(at)
    row = at[picked.rows]
    height, width = (int(sizes.count[slot >= 0].max(initial=0)) for sizes in (rows, columns))
    stack = np.zeros((int(slot.max()) + 1, height, width))
    stack[slot_of_row[row], rows.place[row], columns.place[picked.columns]] = picked.entries
    return stack

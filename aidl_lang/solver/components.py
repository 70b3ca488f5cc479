"""Connected components of graphs."""

from __future__ import annotations

import numpy as np

from aidl_lang.solver.operations import Ints

EDGES = 3000
"""Edges of a graph up to which scipy is not worth loading."""


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

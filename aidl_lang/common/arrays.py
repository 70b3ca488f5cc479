"""Stand-ins for functions of numpy that load parts of it which nothing else needs: `np.unique(x)` loads
`numpy.ma`, and `np.random` as much again, each longer than most programs take to solve.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray


def each_once(values: NDArray[np.intp]) -> NDArray[np.intp]:
    """Returns the distinct numbers (k,) of an array, in order."""
    found = np.sort(values, axis=None)
    if len(found) > 1:
        found = found[np.concatenate(([True], found[1:] != found[:-1]))]
    return found


def others(count: int, left_out: Iterable[int]) -> NDArray[np.intp]:
    """Returns the numbers (k,) from 0 to `count` that are not left out, in order."""
    kept = np.ones(count, dtype=np.bool_)
    kept[np.fromiter(left_out, dtype=np.intp)] = False
    return np.flatnonzero(kept)


def scattered(count: int, seed: int = 0) -> NDArray[np.float64]:
    """Returns numbers (count,) from -1 to 1 without a pattern: a counter's bits mixed (splitmix64)."""
    z: NDArray[Any] = np.arange(1, count + 1, dtype=np.uint64) + np.uint64(seed << 32)
    z *= np.uint64(0x9E3779B97F4A7C15)
    for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB)):
        z = (z ^ (z >> np.uint64(shift))) * np.uint64(factor)
    mixed: NDArray[np.float64] = ((z ^ (z >> np.uint64(31))) >> np.uint64(11)).astype(np.float64)
    return mixed * 2.0**-52 - 1.0

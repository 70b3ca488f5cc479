"""Finds what is near: pairs of boxes, and sides of polylines beside a point, in windows of sorted tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from aidl_lang.common.running import checkpoint, give_up
from aidl_lang.geometry.curves import Bounds, Floats, Ints, Mask
from aidl_lang.solver.linear import each_once

_AT_ONCE = 1 << 20
"""Number of candidates looked at in one step, which bounds the memory."""

_MOST_PAIRS = 2_000_000
"""Pairs of boxes that meet, beyond which no drawing is worked out in time."""


def near_pairs(boxes: Sequence[Bounds], margin: float) -> Iterator[tuple[int, int]]:
    """Yields pairs i < j whose boxes come closer than the margin, in a sweep from left to right."""
    yield from ((i, j) for i, j in near_rows(boxes, margin).tolist())


def near_rows(boxes: Sequence[Bounds] | Floats, margin: float) -> Ints:
    """Returns the pairs of `near_pairs` as a table of two columns."""
    if len(boxes) < 2:
        return np.zeros((0, 2), dtype=np.intp)
    b = np.array(boxes, dtype=np.float64)
    order = np.argsort(b[:, 0], kind="stable")
    b = b[order]
    sweeps = [_sweep(b, axis, margin) for axis in (0, 1)]
    along, stops = min(sweeps, key=lambda sweep: int((sweep[1] - np.arange(len(b))).sum()))
    found, total = [], 0
    for one, other in windows(np.arange(1, len(b) + 1), stops):
        first, second = np.minimum(along[one], along[other]), np.maximum(along[one], along[other])
        meets = (b[first, 2:] + margin >= b[second, :2]).all(axis=1) & (b[first, 1] - margin <= b[second, 3])
        found.append((first[meets], second[meets]))
        total += int(np.count_nonzero(meets))
        if total > _MOST_PAIRS:
            give_up()
        checkpoint()
    firsts, seconds = (np.concatenate([pair[k] for pair in found]) for k in (0, 1))
    kept = np.lexsort((firsts, seconds))
    one, other = order[firsts[kept]], order[seconds[kept]]
    return np.stack((np.minimum(one, other), np.maximum(one, other)), axis=1)


def _sweep(b: Floats, axis: int, margin: float) -> tuple[Ints, Ints]:
    """Returns boxes in order of their beginnings on an axis, and for each place up to which they meet."""
    along = np.argsort(b[:, axis], kind="stable")
    return along, np.searchsorted(b[along, axis], b[along, 2 + axis] + margin, side="right")


def windows(low: Ints, high: Ints, at_once: int = _AT_ONCE) -> Iterator[tuple[Ints, Ints]]:
    """Yields every number k with every place in `low[k]:high[k]`, a part of them at a time."""
    sizes = np.maximum(0, high - low)
    ends = np.cumsum(sizes)
    begin = 0
    while begin < len(sizes):
        done = int(ends[begin - 1]) if begin else 0
        stop = max(begin + 1, int(np.searchsorted(ends, done + at_once, side="right")))
        size = sizes[begin:stop]
        number = np.repeat(np.arange(begin, stop), size)
        within = np.arange(len(number)) - np.repeat(np.cumsum(size) - size, size)
        yield number, low[number] + within
        begin = stop


class Sides:
    """Straight sides (x0, y0, x1, y1 in a row), found by place: by left ends, in classes of width."""

    def __init__(self, sides: Floats) -> None:
        self._start, self._way = sides[:, :2], sides[:, 2:] - sides[:, :2]
        left, width = np.minimum(sides[:, 0], sides[:, 2]), np.abs(self._way[:, 0])
        size = np.frexp(np.maximum(width, 1e-9))[1]
        self._classes: list[tuple[Ints, Floats, float]] = []
        for k in each_once(size):
            of_size = np.flatnonzero(size == k)
            of_size = of_size[np.argsort(left[of_size], kind="stable")]
            self._classes.append((of_size, left[of_size], float(2.0**k)))

    def beside(self, x: Floats, reach: float) -> Iterator[tuple[Ints, Ints]]:
        """Places on the first axis, each with every side that may come within reach of it there, in parts."""
        for of_size, left, width in self._classes:
            low = np.searchsorted(left, x - width - reach)
            high = np.searchsorted(left, x + reach, side="right")
            for place, window in windows(low, high):
                yield place, of_size[window]

    def near(self, spots: Floats, reach: float) -> tuple[Ints, Ints, Floats]:
        """Returns all sides that pass a spot at most at the given distance: spot, side and distance."""
        found = [(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp), np.zeros(0))]
        for spot, side in self.beside(spots[:, 0], reach):
            away = from_sides(spots[spot] - self._start[side], self._way[side])
            kept = away <= reach
            found.append((spot[kept], side[kept], away[kept]))
        spot, side, away = (np.concatenate([f[k] for f in found]) for k in range(3))
        return spot, side, away

    def nearest(self, spots: Floats, reach: float) -> Ints:
        """Returns the side nearest to each spot, the first of several; sought within a reach that grows."""
        result = np.full(len(spots), -1, dtype=np.intp)
        while len(left := np.flatnonzero(result < 0)):
            spot, side, away = self.near(spots[left], reach)
            order = np.lexsort((side, away, spot))
            first = np.unique(spot[order], return_index=True)
            result[left[first[0]]] = side[order][first[1]]
            reach *= 1000
        return result


def from_sides(gap: Floats, way: Floats) -> Floats:
    """Returns the distances of spots from sides, by the ways from the starts to spots and ends of these."""
    square = np.maximum((way**2).sum(axis=-1), 1e-300)
    t = np.clip((gap * way).sum(axis=-1) / square, 0, 1)
    away: Floats = np.hypot(*np.moveaxis(gap - t[..., None] * way, -1, 0))
    return away


def inside(polygons: Sequence[Floats], spots: Floats) -> Mask:
    """Returns the mask of points inside an odd number of polygons, by the crossings of rays to the right."""
    crossings = np.zeros(len(spots), dtype=np.intp)
    if polygons and len(spots):
        start = np.concatenate(polygons)
        end = np.concatenate([np.concatenate((p[1:], p[:1])) for p in polygons])
        # A ray along x meets the sides whose span in y has it: they are found by that axis.
        across = Sides(np.concatenate((start[:, ::-1], end[:, ::-1]), axis=1))
        for spot, side in across.beside(spots[:, 1], 0.0):
            (ax, ay), (bx, by), (px, py) = start[side].T, end[side].T, spots[spot].T
            straddle = (ay > py) != (by > py)
            x = ax + (py - ay) / np.where(straddle, by - ay, 1.0) * (bx - ax)
            crossings += np.bincount(spot[straddle & (x > px)], minlength=len(spots))
    odd: Mask = crossings % 2 == 1
    return odd

"""Where curves meet the endless lines or the whole circles that carry others: their distance from these is a
function of their parameter alone, which has one zero at most between two extremes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from aidl_lang.geometry.curves import Arc, Circle, Line
from aidl_lang.geometry.tables import Floats, Ints, Table, cross, dot, long

Function = Callable[[Ints, Floats], Floats]
_STEPS = 32
"""Steps along a curve, in each of which the rate of its distance has one extreme at most."""
_LAST = 1e-13
"""Step of a secant after which the next one is beneath the last digit."""


def on_carriers(
    carriers: Sequence[Line | Arc | Circle], table: Table, curves: Ints, tolerance: float
) -> list[list[float]]:
    """Returns the parameters at which each of some curves crosses what carries another, or comes within the
    tolerance and turns away.
    """
    is_line = np.array([isinstance(carrier, Line) for carrier in carriers], dtype=np.bool_)
    origin, way, radius = np.split(np.array([_row(carrier) for carrier in carriers]), [2, 4], axis=1)

    def height(k: Ints, t: Floats) -> Floats:
        e = table.at(curves[k], t)[0] - origin[k]
        return np.where(is_line[k], cross(way[k], e), long(e) - radius[k, 0])

    def rise(k: Ints, t: Floats) -> Floats:
        spots, ways = table.at(curves[k], t, 1)
        return np.where(is_line[k], cross(way[k], ways), dot(spots - origin[k], ways))

    def bend(k: Ints, t: Floats) -> Floats:
        spots, ways, turns = table.at(curves[k], t, 2)
        return np.where(is_line[k], cross(way[k], turns), dot(ways, ways) + dot(spots - origin[k], turns))

    every = np.arange(len(curves))
    marks = np.repeat(every, _STEPS + 1), np.tile(np.linspace(0, 1, _STEPS + 1), len(curves))
    k, turns = _zeros(rise, *_merged(*marks, *_zeros(bend, *marks)))
    inner = (turns > 0) & (turns < 1)
    row, at = _merged(np.repeat(every, 2), np.tile((0.0, 1.0), len(curves)), k[inner], turns[inner])
    high = height(row, at)
    is_near, is_inner = np.abs(high) <= tolerance, (at > 0) & (at < 1)
    touches = is_near & (is_inner | ((at == 0) & table.is_closed[curves[row]]))
    k, roots = _zeros(height, row, at, ~(is_near & is_inner))
    found: list[list[float]] = [[] for _ in carriers]
    numbers, places = np.concatenate((row[touches], k)), np.concatenate((at[touches], roots))
    for number, t in zip(numbers.tolist(), places.tolist(), strict=True):
        found[number].append(t)
    return found


def _row(carrier: Line | Arc | Circle) -> tuple[float, ...]:
    """Returns a point, the direction of a line, and a radius."""
    if isinstance(carrier, Line):
        (x, y), (u, v) = carrier.start, carrier.end
        size = math.dist(carrier.start, carrier.end)
        return x, y, (u - x) / size, (v - y) / size, 0.0
    return *carrier.center, 0.0, 0.0, carrier.radius


def _merged(row: Ints, at: Floats, *more: NDArray[Any]) -> tuple[Ints, Floats]:
    """Returns places on curves, with the numbers of these, in order with some more."""
    row, at = np.concatenate((row, more[0])), np.concatenate((at, more[1]))
    order = np.lexsort((at, row))
    return row[order], at[order]


def _zeros(
    of: Function, row: Ints, at: Floats, asked: NDArray[np.bool_] | None = None
) -> tuple[Ints, Floats]:
    """Returns the places at which functions change their sign, between neighbours among some places in
    order, both asked for.
    """
    is_above = of(row, at) > 0
    changes = (row[1:] == row[:-1]) & (is_above[1:] != is_above[:-1])
    if asked is not None:
        changes &= asked[1:] & asked[:-1]
    before = np.flatnonzero(changes)
    return row[before], _roots(of, row[before], at[before], at[before + 1])


def _roots(of: Function, k: Ints, low: Floats, high: Floats) -> Floats:
    """Returns where functions that change their sign between two places are zero, by secants through them;
    the value at a place that stays twice counts half (the Illinois method).
    """
    below, above = of(k, low), of(k, high)
    t = np.where(below == 0, low, high)
    left = np.flatnonzero((below != 0) & (above != 0))
    low, high, before = low.copy(), high.copy(), low.copy()
    stays_low = np.zeros(len(k), dtype=np.bool_)
    for _ in range(100):
        if not len(left):
            break
        a, b = above[left], below[left]
        t[left] = high[left] - a * (high[left] - low[left]) / (a - b)
        value = of(k[left], t[left])
        is_upper = (value > 0) == (a > 0)
        up, down = left[is_upper], left[~is_upper]
        below[up[stays_low[up]]] /= 2
        above[down[~stays_low[down]]] /= 2
        high[up], above[up], stays_low[up] = t[up], value[is_upper], True
        low[down], below[down], stays_low[down] = t[down], value[~is_upper], False
        goes_on = (value != 0) & (np.abs(t[left] - before[left]) > _LAST)
        before[left] = t[left]
        left = left[goes_on]
    return t

"""What is near, and where curves meet: of many pairs at once."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.running import checkpoint, give_up
from aidl_lang.geometry.curves import Arc, Bezier, Bounds, Circle, Floats, Ints, Line, Mask, Piece, Vec
from aidl_lang.solver.linear import each_once

# --- What is near: pairs of boxes, and sides of polylines beside a point, in windows of sorted tables.

_CANDIDATES = 1 << 20
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


def windows(low: Ints, high: Ints, at_once: int = _CANDIDATES) -> Iterator[tuple[Ints, Ints]]:
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


# --- Many curves as a table of numbers, for points on all of them at once.

_POWERS = np.array([[1, 0, 0, 0], [-3, 3, 0, 0], [3, -6, 3, 0], [-1, 3, -3, 1]])
"""Coefficients of 1, t, t² and t³ of a cubic, from its control points."""


class Table:
    """Curves by row: the coefficients of a cubic, or centre, half-axes, their turn, first angle, sweep."""

    def __init__(self, curves: Sequence[Piece]) -> None:
        self.curves = curves
        self.is_round = np.array([not isinstance(curve, Line | Bezier) for curve in curves], dtype=np.bool_)
        self.is_closed = np.array([curve.is_closed for curve in curves], dtype=np.bool_)
        self.rows = np.array([_row(curve) for curve in curves]).reshape(-1, 8)
        cubic = ~self.is_round
        self.rows[cubic] = (_POWERS @ self.rows[cubic].reshape(-1, 4, 2)).reshape(-1, 8)

    def at(self, curves: Ints, t: Floats, order: int = 0) -> Floats:
        """Returns the points at parameters of some curves and their derivatives up to an order, by it."""
        found = np.empty((order + 1, len(t), 2))
        is_round = self.is_round[curves]
        if not is_round.all():
            c, u = self.rows[curves[~is_round]].reshape(-1, 4, 2), t[~is_round, None]
            found[0, ~is_round] = ((c[:, 3] * u + c[:, 2]) * u + c[:, 1]) * u + c[:, 0]
            if order:
                found[1, ~is_round] = (3 * c[:, 3] * u + 2 * c[:, 2]) * u + c[:, 1]
            if order > 1:
                found[2, ~is_round] = 6 * c[:, 3] * u + 2 * c[:, 2]
        if is_round.any():
            x, y, rx, ry, cos, sin, first, sweep = self.rows[curves[is_round]].T
            u = first + sweep * t[is_round]
            for k in range(order + 1):
                far = sweep**k
                along, across = far * rx * np.cos(u + k * math.pi / 2), far * ry * np.sin(u + k * math.pi / 2)
                found[k, is_round] = np.stack(
                    (cos * along - sin * across, sin * along + cos * across), axis=1
                )
            found[0, is_round] += np.stack((x, y), axis=1)
        return found

    def within(self, curves: Ints, t: Floats) -> Floats:
        """Returns parameters brought back onto curves: round closed ones, to the ends of others."""
        return np.where(self.is_closed[curves], t % 1.0, np.clip(t, 0.0, 1.0))


def cross(u: Floats, v: Floats) -> Floats:
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def dot(u: Floats, v: Floats) -> Floats:
    return u[..., 0] * v[..., 0] + u[..., 1] * v[..., 1]


def long(u: Floats) -> Floats:
    return np.hypot(u[..., 0], u[..., 1])


def _row(curve: Piece) -> tuple[float, ...]:
    if isinstance(curve, Line):
        (x, y), (u, v) = curve.start, curve.end
        return x, y, x + (u - x) / 3, y + (v - y) / 3, u - (u - x) / 3, v - (v - y) / 3, u, v
    if isinstance(curve, Bezier):
        return *curve.p0, *curve.p1, *curve.p2, *curve.p3
    center, rx, ry, angle, first, sweep = curve.frame
    return *center, rx, ry, math.cos(angle), math.sin(angle), first, sweep


# --- Where curves meet the endless lines or the whole circles that carry others: their distance from these
# is a function of their parameter alone, which has one zero at most between two extremes.

Function = Callable[[Ints, Floats], Floats]
_STEPS = 32
"""Steps along a curve, in each of which the rate of its distance has one extreme at most."""
_LAST = 1e-13
"""Step of a secant after which the next one is beneath the last digit."""


def on_carriers(
    carriers: Sequence[Line | Arc | Circle], table: Table, curves: Ints, tolerance: float
) -> list[list[float]]:
    """Returns where each curve crosses, or comes within the tolerance of, what carries another."""
    is_line = np.array([isinstance(carrier, Line) for carrier in carriers], dtype=np.bool_)
    origin, way, radius = np.split(np.array([_row_carriers(carrier) for carrier in carriers]), [2, 4], axis=1)

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


def _row_carriers(carrier: Line | Arc | Circle) -> tuple[float, ...]:
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


def _zeros(of: Function, row: Ints, at: Floats, asked: Mask | None = None) -> tuple[Ints, Floats]:
    """Returns where functions change their sign between neighbours in order, both of them asked for."""
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


# --- The points where two curves meet: closed forms for lines and circles, `carriers` for one of those and
# another curve, Newton from a sampling for two others. Of the last two kinds many pairs are worked out at
# once.
#
# A near miss within the tolerance counts as a touch. Curves that lie on each other have no crossing here;
# what they share begins and ends at end points, which `network` places on both.

_STEPS_INTERSECT = 64
"""Steps along a curve between its samples."""
_LAST_INTERSECT = 1e-11
"""Step of Newton's method after which the next one is beneath the last digit."""
_AT_ONCE, _SAMPLED_AT_ONCE = 1024, 64
"""Pairs that are compared in one step, which bounds the memory."""
Crossing = tuple[float, float, Vec]
Step = Callable[[Floats, Floats], tuple[Floats, Floats]]


def intersections(a: Piece, b: Piece, tolerance: float) -> list[Crossing]:
    """Crossings and touches as (parameter on a, parameter on b, point)."""
    return all_intersections(Table([a, b]), np.array([[0, 1]]), tolerance)[0]


def all_intersections(table: Table, pairs: Ints, tolerance: float) -> list[list[Crossing]]:
    """Returns for each of some pairs of curves of a table where they meet."""
    curves, found = table.curves, list[list[Crossing]]([] for _ in pairs)
    is_plain = np.array([isinstance(curve, Line | Arc | Circle) for curve in curves], dtype=np.bool_)[pairs]
    for k in np.flatnonzero(is_plain.all(axis=1)).tolist():
        a, b = (curves[number] for number in pairs[k].tolist())
        found[k] = _plain(a, b, tolerance)
    for part in _parts(np.flatnonzero(is_plain[:, 0] != is_plain[:, 1]), _AT_ONCE):
        is_second = is_plain[part, 1]
        plain, other = pairs[part, is_second.astype(int)], pairs[part, 1 - is_second]
        carriers = [curves[number] for number in plain.tolist()]
        at = on_carriers(carriers, table, other, tolerance)
        for k, a, number, ts in zip(part.tolist(), carriers, other.tolist(), at, strict=True):
            crossings = _carried(a, curves[number], ts, tolerance) if ts else []
            found[k] = crossings if is_plain[k, 0] else [(t, s, p) for s, t, p in crossings]
    for part in _parts(np.flatnonzero(~is_plain.any(axis=1)), _SAMPLED_AT_ONCE):
        for row, t, s in _sampled(table, pairs[part], tolerance):
            found[part[row]].append((t, s, curves[pairs[part[row], 0]].point(t)))
    return [_apart(crossings, tolerance) if len(crossings) > 1 else crossings for crossings in found]


def _parts(numbers: Ints, at_once: int) -> Iterator[Ints]:
    for begin in range(0, len(numbers), at_once):
        checkpoint()
        yield numbers[begin : begin + at_once]


def _carried(a: Piece, b: Piece, at: Sequence[float], tolerance: float) -> list[Crossing]:
    """Returns the crossings among the places at which b meets what carries a."""
    spots = [(s, b.point(s)) for s in at]
    found = [(t, s, p) for s, p in spots if (t := a.locate(p, tolerance)) is not None]
    may_lie = len(found) + sum(_on(a, p, tolerance) for p in b.ends) > 1
    return [] if may_lie and _lie_on_each_other(a, b, tolerance) else found


def meet(a: Piece, b: Piece, tolerance: float) -> bool:
    """Tells whether two curves have a point in common: a crossing, a touch, an end of one on the other."""
    return (
        any(a.locate(p, tolerance) is not None for p in b.ends)
        or any(b.locate(p, tolerance) is not None for p in a.ends)
        or bool(intersections(a, b, tolerance))
    )


def _plain(a: Piece, b: Piece, tolerance: float) -> list[Crossing]:
    """Returns the crossings of lines, arcs and circles, among those of what carries them."""
    if isinstance(a, Line) and isinstance(b, Line):
        return _line_line(a, b, tolerance)
    if isinstance(b, Line):
        return [(t, s, p) for s, t, p in _plain(b, a, tolerance)]
    assert isinstance(a, Line | Arc | Circle)
    assert isinstance(b, Arc | Circle)
    spots = line_circle(a, b, tolerance) if isinstance(a, Line) else circle_circle(a, b, tolerance)
    places = ((a.locate(p, tolerance), b.locate(p, tolerance), p) for p in spots)
    return [(t, s, p) for t, s, p in places if t is not None and s is not None]


def _line_line(a: Line, b: Line, tolerance: float) -> list[Crossing]:
    (x0, y0), (u0, v0), (ax, ay), (bx, by) = a.start, b.start, a.way, b.way
    cross = ax * by - ay * bx
    if abs(cross) <= 1e-9 * math.hypot(ax, ay) * math.hypot(bx, by):
        return []
    t = ((u0 - x0) * by - (v0 - y0) * bx) / cross
    s = ((u0 - x0) * ay - (v0 - y0) * ax) / cross
    slack_a, slack_b = tolerance / math.hypot(ax, ay), tolerance / math.hypot(bx, by)
    if not (-slack_a <= t <= 1 + slack_a and -slack_b <= s <= 1 + slack_b):
        return []
    t, s = min(1.0, max(0.0, t)), min(1.0, max(0.0, s))
    return [(t, s, a.point(t))]


def line_circle(line: Line, circle: Arc | Circle, tolerance: float) -> list[Vec]:
    (x, y), r = circle.center, circle.radius
    dx, dy = line.way
    length = math.hypot(dx, dy)
    if not length:
        return []
    dx, dy = dx / length, dy / length
    along = (x - line.start[0]) * dx + (y - line.start[1]) * dy
    foot = line.start[0] + along * dx, line.start[1] + along * dy
    distance = math.hypot(foot[0] - x, foot[1] - y)
    if distance > r + tolerance:
        return []
    if distance >= r - tolerance:
        return [foot]
    half = math.sqrt((r - distance) * (r + distance))
    return [(foot[0] + k * dx, foot[1] + k * dy) for k in (-half, half)]


def circle_circle(a: Arc | Circle, b: Arc | Circle, tolerance: float) -> list[Vec]:
    dx, dy = b.center[0] - a.center[0], b.center[1] - a.center[1]
    d, ra, rb = math.hypot(dx, dy), a.radius, b.radius
    if d <= tolerance or d > ra + rb + tolerance or d < abs(ra - rb) - tolerance:
        return []
    dx, dy = dx / d, dy / d
    if d >= ra + rb - tolerance or d <= abs(ra - rb) + tolerance:
        k = ra if d > rb or ra > rb else -ra
        return [(a.center[0] + k * dx, a.center[1] + k * dy)]
    k = (d * d + (ra - rb) * (ra + rb)) / (2 * d)
    h = math.sqrt(max(0.0, (ra - k) * (ra + k)))
    x, y = a.center[0] + k * dx, a.center[1] + k * dy
    return [(x - h * dy, y + h * dx), (x + h * dy, y - h * dx)]


def _sampled(table: Table, pairs: Ints, tolerance: float) -> Iterator[tuple[int, float, float]]:
    """Yields crossings and touches with the numbers of their pairs, from polylines and nearest samples."""
    marks = np.linspace(0, 1, _STEPS_INTERSECT + 1)
    p, q = (
        table.at(np.repeat(own, len(marks)), np.tile(marks, len(own)))[0].reshape(len(own), -1, 2)
        for own in pairs.T
    )
    away = long(p[:, :, None] - q[:, None])
    step = np.maximum(*(long(np.diff(x, axis=1)).max(axis=1) for x in (p, q)))
    lies = _may_lie(away <= step[:, None, None] + tolerance, table.is_closed[pairs])
    for row in np.flatnonzero(lies).tolist():
        a, b = (table.curves[number] for number in pairs[row].tolist())
        lies[row] = _lie_on_each_other(a, b, tolerance)
    k, t, s = _crossed(p, q, ~lies)
    t, s, meets = _improved(table, pairs[k], t, s, tolerance, _to_crossing)
    k, t, s = k[meets], t[meets], s[meets]
    beside = _improved(table, pairs[k], t, s, tolerance, _to_touch)
    for row, *crossing, touch, other, is_one in zip(*(x.tolist() for x in (k, t, s, *beside)), strict=True):
        if is_one:
            # So close from one to the other that they are one there: the crossing belongs to the touch.
            a, b = (table.curves[number] for number in pairs[row].tolist())
            way = touch - crossing[0]
            way = math.remainder(way, 1.0) if a.is_closed else way
            if _on(b, a.point(crossing[0] + way / 2), tolerance):
                crossing = [touch, other]
        yield row, crossing[0], crossing[1]
    k, t, s = _nearest_samples(away, step, ~lies)
    t, s, meets = _improved(table, pairs[k], t, s, tolerance, _to_touch)
    yield from zip(*(x[meets].tolist() for x in (k, t, s)), strict=True)


def _apart(found: list[Crossing], tolerance: float) -> list[Crossing]:
    """Returns crossings in order, one of those at one point."""
    kept: list[Crossing] = []
    for crossing in sorted(found):
        if all(math.dist(crossing[2], other[2]) > tolerance for other in kept):
            kept.append(crossing)
    return kept


def _lie_on_each_other(a: Piece, b: Piece, tolerance: float) -> bool:
    """Tells whether the curves share a stretch: between two ends that lie on both, all else does."""
    if a.is_closed:
        a, b = b, a
    marks = [0.0, 1.0]
    if not a.is_closed:
        spots = list(a.ends) if b.is_closed else [*a.ends, *b.ends]
        on_both = [
            t for p in spots if (t := a.locate(p, tolerance)) is not None and _on(b, a.point(t), tolerance)
        ]
        marks = sorted(on_both)
    return any(
        all(_on(b, a.point(t0 + (t1 - t0) * k / 8), tolerance) for k in range(1, 8))
        for t0, t1 in pairwise(marks)
        if math.dist(a.point(t0), a.point(t1)) > tolerance or t1 - t0 > 0.5
    )


def _on(curve: Piece, p: Vec, tolerance: float) -> bool:
    return curve.locate(p, tolerance) is not None


def _may_lie(near: Mask, closed: Mask) -> Mask:
    """Tells of pairs of curves, whose near samples and kinds are given, whether they may share a stretch."""
    found = near[:, [0, -1]].any(axis=2), near[:, :, [0, -1]].any(axis=1)
    count = sum(np.count_nonzero(found[k] & ~closed[:, k : k + 1], axis=1) for k in (0, 1))
    may: Mask = (count > 1) | closed.all(axis=1)
    return may


def _crossed(p: Floats, q: Floats, asked: Mask) -> tuple[Ints, Floats, Floats]:
    """Returns the crossings of the pairs of polylines asked for: the pair's number, and the parameters."""
    dp, dq = np.diff(p, axis=1)[:, :, None], np.diff(q, axis=1)[:, None]
    gap, sine = q[:, None, :-1] - p[:, :-1, None], cross(dp, dq)
    with np.errstate(divide="ignore", invalid="ignore"):
        t, s = cross(gap, dq) / sine, cross(gap, dp) / sine
        # The curves bulge beyond their chords: look a little past each segment.
        hit = (t >= -0.2) & (t <= 1.2) & (s >= -0.2) & (s <= 1.2) & asked[:, None, None]
    k, i, j = np.nonzero(hit)
    return k, (i + t[hit]) / _STEPS_INTERSECT, (j + s[hit]) / _STEPS_INTERSECT


def _nearest_samples(away: Floats, step: Floats, asked: Mask) -> tuple[Ints, Floats, Floats]:
    """Returns where samples are nearest, and no further apart than neighbours, as `_crossed` does."""
    padded = np.pad(away, ((0, 0), (1, 1), (1, 1)), constant_values=np.inf)
    n = away.shape[1]
    beside = [padded[:, i : i + n, j : j + n] for i in range(3) for j in range(3)]
    near = (away <= step[:, None, None]) & asked[:, None, None]
    k, i, j = np.nonzero(near & (away <= np.min(beside, axis=0)))
    return k, i / _STEPS_INTERSECT, j / _STEPS_INTERSECT


def _improved(
    table: Table, pairs: Ints, t: Floats, s: Floats, tolerance: float, step: Step
) -> tuple[Floats, Floats, Mask]:
    """Returns parameters after steps of Newton's method, and which are crossings, or touches."""
    a, b = pairs.T
    t, s = table.within(a, t), table.within(b, s)
    left, order = np.arange(len(t)), 2 if step is _to_touch else 1
    for _ in range(30):
        if not len(left):
            break
        dt, ds = step(table.at(a[left], t[left], order), table.at(b[left], s[left], order))
        moves = np.isfinite(dt)
        left, dt, ds = left[moves], dt[moves], ds[moves]
        t[left], s[left] = table.within(a[left], t[left] + dt), table.within(b[left], s[left] + ds)
        left = left[np.abs(dt) + np.abs(ds) >= _LAST_INTERSECT]
    ours, theirs = table.at(a, t, 1), table.at(b, s, 1)
    meets = long(ours[0] - theirs[0]) <= tolerance
    if step is _to_touch:
        meets &= np.abs(cross(ours[1], theirs[1])) <= 1e-6 * long(ours[1]) * long(theirs[1])
    return t, s, meets


def _to_crossing(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Returns the steps to where b - a is nothing; NaN where the curves are parallel."""
    sine, e = cross(a[1], b[1]), b[0] - a[0]
    sine = np.where(np.abs(sine) > 1e-12 * long(a[1]) * long(b[1]), sine, np.nan)
    return cross(e, b[1]) / sine, cross(e, a[1]) / sine


def _to_touch(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Returns the steps to where the curves are parallel and side by side: (b - a)·a' = 0 and a' x b' = 0."""
    e = b[0] - a[0]
    f, g = dot(e, a[1]), cross(a[1], b[1])
    ft, fs = dot(e, a[2]) - dot(a[1], a[1]), dot(b[1], a[1])
    gt, gs = cross(a[2], b[1]), cross(a[1], b[2])
    determinant = ft * gs - fs * gt
    determinant = np.where(determinant, determinant, np.nan)
    steps = (fs * g - gs * f) / determinant, (gt * f - ft * g) / determinant
    return np.clip(steps[0], -0.1, 0.1), np.clip(steps[1], -0.1, 0.1)


def self_crossing(curve: Bezier) -> tuple[float, float] | None:
    """Returns the two parameters at which a cubic passes one point, if its loop is within 0..1.

    With p = a t³ + b t² + c t + d and u = s + t, v = s t, p(s) = p(t) gives a (u² - v) + b u + c = 0.
    """
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = curve.p0, curve.p1, curve.p2, curve.p3
    ax, ay = x3 - 3 * x2 + 3 * x1 - x0, y3 - 3 * y2 + 3 * y1 - y0
    bx, by = 3 * (x2 - 2 * x1 + x0), 3 * (y2 - 2 * y1 + y0)
    cx, cy = 3 * (x1 - x0), 3 * (y1 - y0)
    across = ax * by - ay * bx
    if abs(across) <= 1e-12 * (math.hypot(ax, ay) * math.hypot(bx, by) + 1e-300):
        return None
    u = -(ax * cy - ay * cx) / across
    v = u * u + ((ax * bx + ay * by) * u + ax * cx + ay * cy) / (ax * ax + ay * ay)
    root = u * u - 4 * v
    if root <= 1e-12:
        return None
    s, t = (u - math.sqrt(root)) / 2, (u + math.sqrt(root)) / 2
    return (s, t) if s > 1e-9 and t < 1 - 1e-9 else None

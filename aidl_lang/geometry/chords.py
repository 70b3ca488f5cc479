"""Chords at right angles to an outline at both ends, in closed form for all pairs of elements at once.

`kind` of a chord is 1 where it leaves both ends into the material (a wall), -1 where it leaves them into the
empty side (a gap). What lies between the ends is not looked at here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.skeleton import Floats, Ints, Skeleton, within

ANGLE = 1e-6
"""Tolerance of right angles, radians."""
_CHUNK = 400_000
"""Pairs that are worked on at a time."""


@record(slots=True)
class Chords:
    """Chords by row: a length, its ends, the elements they lie on, their places along these (0..1), and the
    kind.
    """

    length: Floats
    a: Floats
    b: Floats
    i: Ints
    j: Ints
    s: Floats
    t: Floats
    kind: Ints

    def __len__(self) -> int:
        return len(self.length)

    def where(self, keep: NDArray[np.bool_] | Ints) -> Chords:
        return Chords(*(getattr(self, name)[keep] for name in self.__slots__))


def joined(parts: list[Chords]) -> Chords:
    names = Chords.__slots__
    return Chords(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def chords(outline: Skeleton, reach: float, least: float) -> Iterator[Chords]:
    """Yields those longer than `least` between elements whose boxes are at most `reach` apart, some at a
    time.
    """
    for i, j in _pairs(outline, reach):
        lines = outline.straight
        yield _between_lines(outline, *_only(i, j, (i < lines) & (j < lines)), least)
        i, j = np.minimum(i, j), np.maximum(i, j)
        yield _line_to_round(outline, *_only(i, j, (i < lines) & (j >= lines)), least)
        yield _between_rounds(outline, *_only(i, j, i >= lines), least)


def _only(i: Ints, j: Ints, keep: NDArray[np.bool_]) -> tuple[Ints, Ints]:
    return i[keep], j[keep]


def _pairs(o: Skeleton, reach: float) -> Iterator[tuple[Ints, Ints]]:
    """Yields pairs of elements (each with itself too) that come near enough and look at each other, or away
    from each other; by place or by direction, whichever leaves fewer to try.
    """
    order, begin, count = min(_by_place(o.boxes, reach), _by_direction(o), key=lambda way: way[2].sum())
    for i, rank in _listed(begin, count):
        j = order[rank % len(order)]
        apart = np.maximum(o.boxes[i, :2] - o.boxes[j, 2:], o.boxes[j, :2] - o.boxes[i, 2:])
        i, j = _only(i, j, np.all(apart <= reach, axis=1))
        yield _only(i, j, within(o.normal[i] + math.pi, o.normal[j], o.spread[i] + o.spread[j], 2 * ANGLE))


def _by_place(boxes: Floats, reach: float) -> tuple[Ints, Ints, Ints]:
    """Returns an order of all elements, and for each where in it its partners begin and how many there
    are.
    """
    extent = boxes[:, 2:].max(axis=0) - boxes[:, :2].min(axis=0)
    along = int(extent[1] > extent[0])
    order = np.argsort(boxes[:, along], kind="stable")
    begin = np.empty(len(order), dtype=np.intp)
    begin[order] = np.arange(len(order))
    end = np.searchsorted(boxes[order, along], boxes[:, along + 2] + reach, side="right")
    return order, begin, np.maximum(end - begin, 1)


def _by_direction(o: Skeleton) -> tuple[Ints, Ints, Ints]:
    """Returns an order of all elements by direction, and for each where in it its partners begin and how many
    there are: those the opposite of whose range begins within its own.
    """
    turn = 2 * math.pi
    opposite = (o.normal + math.pi - o.spread) % turn
    order = np.argsort(opposite, kind="stable")
    starts = np.concatenate([opposite[order] + k * turn for k in range(3)])
    low = (o.normal - o.spread) % turn - ANGLE + turn
    begin = np.searchsorted(starts, low)
    end = np.searchsorted(starts, low + np.minimum(2 * o.spread + 2 * ANGLE, turn), side="right")
    return order, begin, np.minimum(end - begin, len(order))


def _listed(begin: Ints, count: Ints) -> Iterator[tuple[Ints, Ints]]:
    """Yields each element with each of its `count` ranks from `begin`, some at a time."""
    total = np.concatenate(([0], np.cumsum(count)))
    first = 0
    while first < len(count):
        checkpoint()
        last = max(first + 1, int(np.searchsorted(total, total[first] + _CHUNK)) - 1)
        rows = np.arange(first, last)
        i = np.repeat(rows, count[rows])
        yield i, np.arange(len(i)) + np.repeat(begin[rows] - total[rows] + total[first], count[rows])
        first = last


def _between_lines(o: Skeleton, i: Ints, j: Ints, least: float) -> Chords:
    """Returns chords between parallel lines that face each other, at the middle of the stretch in which they
    do.
    """
    u = o.way[i]
    offset = o.start[j] - o.start[i]
    far = offset + o.way[j] * o.length[j][:, None]
    one, other = (offset * u).sum(axis=1), (far * u).sum(axis=1)
    low, high = np.maximum(0.0, other), np.minimum(o.length[i], one)
    middle = (low + high) / 2
    t = (one - middle) / o.length[j]
    a = o.start[i] + u * middle[:, None]
    b = o.start[j] + o.way[j] * (t * o.length[j])[:, None]
    height = u[:, 0] * (b - a)[:, 1] - u[:, 1] * (b - a)[:, 0]
    found = Chords(
        np.abs(height), a, b, i, j, middle / o.length[i], t, np.where(height > 0, 1, -1).astype(np.intp)
    )
    return found.where((high > low) & (np.abs(height) > least))


def _line_to_round(o: Skeleton, i: Ints, j: Ints, least: float) -> Chords:
    """Returns the perpendicular from the center of a round element to a line."""
    k = j - o.straight
    u = o.way[i]
    normal = np.stack((-u[:, 1], u[:, 0]), axis=1)
    offset = o.start[j] - o.start[i]
    along, height = (offset * u).sum(axis=1), (offset * normal).sum(axis=1)
    reached = height + o.side[k] * o.radius[k]
    slack = ANGLE * np.abs(reached)
    toward = o.side[k][:, None] * normal
    keep = (along >= -slack) & (along <= o.length[i] + slack) & (np.abs(reached) > least)
    a = o.start[i] + u * along[:, None]
    b = o.start[j] + toward * o.radius[k][:, None]
    s = np.clip(along / o.length[i], 0.0, 1.0)
    kind = np.where(reached > 0, 1, -1).astype(np.intp)
    return Chords(np.abs(reached), a, b, i, j, s, _share(o, k, toward), kind).where(keep)


def _between_rounds(o: Skeleton, i: Ints, j: Ints, least: float) -> Chords:
    """Returns chords on the line through both centres; for concentric elements, in the middle of the
    directions they share.
    """
    offset = o.start[j] - o.start[i]
    distance = np.hypot(offset[:, 0], offset[:, 1])
    same = distance <= np.maximum(least, 1e-9 * (o.radius[i - o.straight] + o.radius[j - o.straight]))
    angle = np.arctan2(offset[:, 1], offset[:, 0])
    found = []
    for way in (1, -1):
        # Into the material at the first end of a wall that runs this way, or of a gap the other way.
        into = angle + (math.pi if way < 0 else 0.0)
        looks = within(into, o.normal[i], o.spread[i], ANGLE)
        looks &= within(into + math.pi, o.normal[j], o.spread[j], ANGLE)
        rows = np.flatnonzero(looks & ~same)
        found.append(_on_centers(o, i[rows], j[rows], distance[rows], angle[rows], way, least))
    rows = np.flatnonzero(same)
    angle, shares = _shared_direction(o, i[rows], j[rows])
    rows, angle = rows[shares], angle[shares]
    found.append(_on_centers(o, i[rows], j[rows], distance[rows], angle, 1, least))
    return joined(found)


def _on_centers(
    o: Skeleton, i: Ints, j: Ints, distance: Floats, angle: Floats, way: int, least: float
) -> Chords:
    """Returns chords along the line through the centres, which has this angle: walls this way, or gaps the
    other.
    """
    p, q = i - o.straight, j - o.straight
    one, other = -way * o.side[p], way * o.side[q]
    start, end = one * o.radius[p], distance + other * o.radius[q]
    unit = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    a = o.start[i] + unit * start[:, None]
    b = o.start[j] + unit * (other * o.radius[q])[:, None]
    s, t = _share(o, p, unit * one[:, None]), _share(o, q, unit * other[:, None])
    kind = np.where(way * (end - start) > 0, 1, -1).astype(np.intp)
    length = np.abs(end - start)
    return Chords(length, a, b, i, j, s, t, kind).where(length > least)


def _shared_direction(o: Skeleton, i: Ints, j: Ints) -> tuple[Floats, NDArray[np.bool_]]:
    """Returns a direction into the material at the first and out of it at the other, and whether there is
    one.
    """
    first, p, q = o.normal[i], o.spread[i], o.spread[j]
    away = (o.normal[j] - first) % (2 * math.pi) - math.pi
    low, high = np.maximum(-p, away - q), np.minimum(p, away + q)
    # Two long arcs may share directions on either side of the circle.
    beyond = away - np.copysign(2 * math.pi, away)
    low_2, high_2 = np.maximum(-p, beyond - q), np.minimum(p, beyond + q)
    better = high_2 - low_2 > high - low
    low, high = np.where(better, low_2, low), np.where(better, high_2, high)
    return first + (low + high) / 2, high >= low - ANGLE


def _share(o: Skeleton, k: Ints, toward: Floats) -> Floats:
    """Returns the place along a round element that lies in a direction, counter-clockwise, 0..1."""
    angle = np.arctan2(toward[:, 1], toward[:, 0]) - o.middle[k]
    away = (angle + math.pi) % (2 * math.pi) - math.pi
    share: Floats = np.clip((away / np.where(o.half[k] > 0, o.half[k], 1.0) + 1) / 2, 0.0, 1.0)
    return share

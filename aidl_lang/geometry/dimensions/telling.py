"""What a dimension tells of a sketch: a number of its unknowns, for each place where it is measured."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from functools import partial

from aidl_lang.geometry.curves import Arc, Circle, Vec
from aidl_lang.geometry.dimensions import sketch as sk
from aidl_lang.geometry.dimensions.features import X_AXIS, Y_AXIS
from aidl_lang.geometry.dimensions.sketch import Reading, Sketch, Spot, Unknowns
from aidl_lang.geometry.solved import Dimension, Length, Opening, Roundness

ALONG = (X_AXIS, Y_AXIS)
End = tuple[Spot, int, float]
"""A point of an outline: a spot, or the tip of what is round about it, with its radius and its side."""


def told(sketch: Sketch, of: Dimension) -> list[Reading] | None:
    """Returns the numbers of a sketch that a dimension tells; None if it measures something else."""
    match of:
        case Length(along=along) if along in ALONG:
            axis = ALONG.index(along)
            low, high = (level(sketch, axis, points) for points in (of.start, of.end))
            return [less(high, low)] if low is not None and high is not None else None
        case Length():
            found = next(_aligned(sketch, of), None)
            return [found] if found is not None else None
        case Roundness(origin="pattern", curve=Circle() as ring):
            return _on_ring(sketch, ring)
        case Roundness(curve=curve):
            known = sketch.round_of(curve)
            return [sk.plain(known.radius)] if known is not None else None
        case Opening():
            return _opening(sketch, of)
    return None


def less(high: Reading, low: Reading) -> Reading:
    return Reading(high.needs + low.needs, lambda z: high.of(z) - low.of(z))


def level(sketch: Sketch, axis: int, points: Sequence[Vec]) -> Reading | None:
    """Returns the level of the first of some points that is a point of an outline, else that of anything seen
    at the same level.
    """
    for spot, radius, side in _ends(sketch, points, ALONG[axis]):
        return _tip(spot.along(axis), radius, side)
    value = points[0][axis]
    if (number := sketch.level(axis, value)) is not None:
        return sk.plain(number)
    for own in sketch.rounds:
        for side in (-1.0, 1.0):
            if abs(own.curve.center[axis] + side * own.curve.radius - value) <= sketch.slack:
                return _tip(own.center.along(axis), own.radius, side)
    fixed = sketch.fixed[axis]
    return Reading((), lambda _: value) if fixed is not None and abs(fixed - value) <= sketch.slack else None


def _tip(center: Reading, radius: int, side: float) -> Reading:
    if not side:
        return center
    return Reading((*center.needs, radius), lambda z: center.of(z) + side * z[radius])


def _ends(sketch: Sketch, points: Iterable[Vec], along: Vec) -> Iterator[End]:
    """Yields the points of an outline that lie at some points: spots, and tips of what is round."""
    for p in points:
        if (spot := sketch.spot(p)) is not None:
            yield spot, 0, 0.0
        for own in sketch.rounds:
            (x, y), r = own.curve.center, own.curve.radius
            for side in (-1.0, 1.0):
                if math.dist(p, (x + side * r * along[0], y + side * r * along[1])) <= sketch.slack:
                    yield own.center, own.radius, side


def _aligned(sketch: Sketch, of: Length) -> Iterator[Reading]:
    """Yields the distance of two points, or of a point and an edge at a right angle to it."""
    starts, finishes = (list(_ends(sketch, points, of.along)) for points in (of.start, of.end))
    for a in starts:
        for b in finishes:
            reach = b[0].at[0] - a[0].at[0], b[0].at[1] - a[0].at[1]
            if abs(reach[0] * of.along[1] - reach[1] * of.along[0]) <= sketch.slack:
                sense = math.copysign(1.0, reach[0] * of.along[0] + reach[1] * of.along[1])
                is_far = math.hypot(*reach) > sketch.slack
                yield Reading(_needs(a) + _needs(b), partial(_apart, a, b, sense if is_far else 0.0))
    for ends, points in ((starts, of.end), (finishes, of.start)):
        for end in ends:
            for edge in sketch.lines:
                (x0, y0), (x1, y1) = edge[0].at, edge[1].at
                size = math.dist(*(spot.at for spot in edge))
                leans = abs((x1 - x0) * of.along[0] + (y1 - y0) * of.along[1])
                off = abs((x1 - x0) * (points[0][1] - y0) - (y1 - y0) * (points[0][0] - x0))
                if leans <= 1e-6 * size and off <= sketch.slack * size:
                    needs = _needs(end) + edge[0].needs + edge[1].needs
                    yield Reading(needs, partial(_from_edge, end, *edge))


def _needs(end: End) -> tuple[int, ...]:
    return (*end[0].needs, end[1]) if end[2] else end[0].needs


def _apart(a: End, b: End, sense: float, z: Unknowns) -> complex:
    """Returns the distance of two ends along the line through them; `sense`: that of their spots to it."""
    u = sk.way(a[0], b[0], z)
    between = sense * sk.dot(u, u) ** 0.5 if sense else 0.0
    return between + b[2] * z[b[1]] - a[2] * z[a[1]]


def _from_edge(end: End, a: Spot, b: Spot, z: Unknowns) -> complex:
    """Returns how far an end is from an edge."""
    u = sk.way(a, b, z)
    found = sk.cross(u, sk.way(a, end[0], z)) / sk.dot(u, u) ** 0.5
    sense = 1.0 if found.real > 0 else -1.0
    return sense * found + (z[end[1]] if end[2] else 0.0)


def centers_on(sketch: Sketch, ring: Circle | Arc) -> list[Spot]:
    """Returns the centres of whole circles that lie on a circle."""
    circles = (own for own in sketch.rounds if isinstance(own.curve, Circle))
    return [
        own.center
        for own in circles
        if abs(math.dist(own.curve.center, ring.center) - ring.radius) <= sketch.slack
    ]


def _on_ring(sketch: Sketch, ring: Circle) -> list[Reading] | None:
    """Returns where centres at equal steps on a circle are from its centre, if that is seen."""
    seen = (own.center for own in sketch.rounds if own.is_seen)
    middle = next((spot for spot in seen if math.dist(spot.at, ring.center) <= sketch.slack), None)
    if middle is None:
        return None
    return [less(spot.along(k), middle.along(k)) for spot in centers_on(sketch, ring) for k in (0, 1)]


def _opening(sketch: Sketch, of: Opening) -> list[Reading] | None:
    """Returns the angle of two edges through its corner; the first may be level and not drawn."""
    arms = [_arm(sketch, of.corner, degrees) for degrees in (of.first, of.first + of.value)]
    first, second = arms
    if first is None and abs(math.remainder(of.first, 90)) > 1e-6:
        return None
    if second is None:
        return None
    turn = math.radians(of.value)
    if first is None:
        way = math.cos(math.radians(of.first)), math.sin(math.radians(of.first))
        return [Reading(second[0].needs + second[1].needs, partial(_lean, None, second, way, turn))]
    needs = first[0].needs + first[1].needs + second[0].needs + second[1].needs
    return [Reading(needs, partial(_lean, first, second, (1.0, 0.0), turn))]


def _arm(sketch: Sketch, corner: Vec, degrees: float) -> tuple[Spot, Spot] | None:
    """Returns the edge in a direction from a point."""
    u = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    for a, b in sketch.lines:
        (x0, y0), (x1, y1) = a.at, b.at
        size = math.dist(a.at, b.at)
        is_along = abs((x1 - x0) * u[1] - (y1 - y0) * u[0]) <= 1e-6 * size
        off = abs((corner[0] - x0) * (y1 - y0) - (corner[1] - y0) * (x1 - x0))
        if is_along and off <= sketch.slack * size:
            return (a, b) if (x1 - x0) * u[0] + (y1 - y0) * u[1] > 0 else (b, a)
    return None


def _lean(
    first: tuple[Spot, Spot] | None, second: tuple[Spot, Spot], level: Vec, turn: float, z: Unknowns
) -> complex:
    """Returns a number that is nought where two edges are turned by an angle to each other."""
    u = sk.way(*first, z) if first is not None else level
    v = sk.way(*second, z)
    size = (sk.dot(u, u) * sk.dot(v, v)) ** 0.5
    return (sk.cross(u, v) * math.cos(turn) - sk.dot(u, v) * math.sin(turn)) / size

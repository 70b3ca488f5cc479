"""The arrangement of equal holes: the steps of a row or grid, or the circle through their centres."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

from aidl_lang.geometry.curves import Circle, Vec
from aidl_lang.geometry.dimensions.features import X_AXIS, Y_AXIS, length_between
from aidl_lang.geometry.solved import Dimension, Length, Roundness


def pattern_pitches(group: Sequence[Dimension], tolerance: float) -> Iterator[Dimension]:
    """Yields the dimensions that place the members of a group of equal circles, if these are in order."""
    centers = [d.curve.center for d in group if isinstance(d, Roundness) and isinstance(d.curve, Circle)]
    if len(centers) < 2:
        return
    columns, rows = (_levels([c[axis] for c in centers], tolerance) for axis in (0, 1))
    if len(columns) * len(rows) == len(centers):
        for axis, levels in enumerate((columns, rows)):
            steps = [b - a for a, b in pairwise(levels)]
            if steps and max(steps) - min(steps) <= tolerance:
                yield from _steps(centers, levels, axis, tolerance)
        return
    ring = _ring(centers, tolerance)
    if ring is not None:
        yield Roundness(2 * ring.radius, "pattern", f"centres of {group[0].of}", curve=ring)


def _levels(values: Sequence[float], tolerance: float) -> list[float]:
    """Returns the different ones of some numbers, from the smallest."""
    found: list[float] = []
    for value in sorted(values):
        if not found or value - found[-1] > tolerance:
            found.append(value)
    return found


def _steps(centers: Sequence[Vec], levels: Sequence[float], axis: int, tolerance: float) -> Iterator[Length]:
    for a, b in pairwise(levels):
        start, end = (tuple(c for c in centers if abs(c[axis] - level) <= tolerance) for level in (a, b))
        found = length_between(start, end, (X_AXIS, Y_AXIS)[axis])
        yield Length(
            found.value,
            "pattern",
            group=("steps", axis, *centers[0]),
            start=found.start,
            end=found.end,
            along=found.along,
        )


def _ring(centers: Sequence[Vec], tolerance: float) -> Circle | None:
    """Returns the circle through all of at least three points."""
    if len(centers) < 3:
        return None
    (ax, ay), (bx, by), (cx, cy) = centers[0], centers[len(centers) // 3], centers[2 * len(centers) // 3]
    bx, by, cx, cy = bx - ax, by - ay, cx - ax, cy - ay
    twice = 2 * (bx * cy - by * cx)
    if abs(twice) <= tolerance * tolerance:
        return None
    b, c = bx * bx + by * by, cx * cx + cy * cy
    x, y = ax + (cy * b - by * c) / twice, ay + (bx * c - cx * b) / twice
    radius = math.dist((x, y), (ax, ay))
    return (
        Circle((x, y), radius)
        if all(abs(math.dist((x, y), p) - radius) <= tolerance for p in centers)
        else None
    )

"""Least distances between outlines, exact for lines, arcs and circles."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Arc, Circle, Line, Piece, Vec
from aidl_lang.geometry.evaluate import derivative, ends, is_closed, nearest, point, points, second_derivative
from aidl_lang.geometry.measures import region_bounds
from aidl_lang.geometry.region import Region

_SAMPLES = np.linspace(0, 1, 49)
Floats = NDArray[np.float64]
Closest = tuple[float, Vec, Vec]
"""A distance and the points on either side where it is found."""


def region_distance(a: Region, b: Region) -> Closest | None:
    """Returns the distance between the outlines of two regions that do not overlap; None if one is empty."""
    if not (a and b):
        return None
    away = _apart(a.boxes, b.boxes).ravel()
    # Pairs of pieces, those first whose boxes are nearest; few are nearer than the first two pieces.
    first = int(np.argmin(away))
    best = _between(a, b, first)
    near = np.flatnonzero(away < best[0])
    for k in near[np.argsort(away[near], kind="stable")].tolist():
        if away[k] >= best[0]:
            break
        checkpoint()
        if k != first and (found := _between(a, b, k))[0] < best[0]:
            best = found
    return best


def lie_within(a: Region, b: Region, reach: float) -> bool:
    """Tells whether the outlines of two regions that do not overlap come as close to each other as that."""
    away = _apart(a.boxes, b.boxes).ravel()
    near = np.flatnonzero(away <= reach)
    return any(_between(a, b, k)[0] <= reach for k in near[np.argsort(away[near], kind="stable")].tolist())


def nearest_region(ours: Sequence[Region], others: Sequence[Region]) -> tuple[float, int]:
    """Returns the least distance of outlines on either side, and the place of the other one's region."""
    best = math.inf, 0
    away = _apart(*(np.array([region_bounds(region) for region in side]) for side in (ours, others)))
    for pair in np.argsort(away, axis=None, kind="stable").tolist():
        i, j = divmod(pair, len(others))
        if away[i, j] >= best[0]:
            break
        if (found := region_distance(ours[i], others[j])) is not None and found[0] < best[0]:
            best = found[0], j
    return best


def _apart(a: Floats, b: Floats) -> Floats:
    """Returns the distance of each box of a table from each of another."""
    gaps = np.maximum(np.maximum(a[:, None, :2] - b[:, 2:], b[:, :2] - a[:, None, 2:]), 0.0)
    return np.hypot(gaps[..., 0], gaps[..., 1])


def _between(a: Region, b: Region, pair: int) -> Closest:
    i, j = divmod(pair, len(b.pieces))
    return piece_distance(a.pieces[i], b.pieces[j])


def piece_distance(a: Piece, b: Piece) -> Closest:
    """Returns the least distance between two curves that do not cross."""
    candidates = [_to(b, p) for p in _candidates(a, b)]
    candidates += [(d, q, p) for d, p, q in (_to(a, p) for p in _candidates(b, a))]
    return min(candidates, key=lambda c: c[0])


def _to(curve: Piece, p: Vec) -> Closest:
    q = point(curve, nearest(curve, p))
    return math.dist(p, q), p, q


def _candidates(a: Piece, b: Piece) -> list[Vec]:
    """Returns points of `a` from which the way to `b` may be the shortest: its ends and those where the
    normals agree.
    """
    if not isinstance(a, Line | Arc | Circle) or not isinstance(b, Line | Arc | Circle):
        return _sampled_candidates(a, b)
    spots = [] if is_closed(a) else list(ends(a))
    if isinstance(b, Line):
        return spots
    if isinstance(a, Line):
        return [*spots, point(a, nearest(a, b.center))]
    dx, dy = b.center[0] - a.center[0], b.center[1] - a.center[1]
    d = math.hypot(dx, dy)
    ux, uy = (dx / d, dy / d) if d else (1.0, 0.0)
    for sign in (-1, 1):
        p = a.center[0] + sign * a.radius * ux, a.center[1] + sign * a.radius * uy
        spots.append(point(a, nearest(a, p)))
    return spots


def _sampled_candidates(a: Piece, b: Piece) -> list[Vec]:
    """Returns the ends of a, and the nearest of a sampling, polished."""
    away = ((points(a, _SAMPLES)[:, None, :] - points(b, _SAMPLES)[None, :, :]) ** 2).sum(axis=2)
    i, j = divmod(int(np.argmin(away)), len(_SAMPLES))
    t = _facing(a, b, float(_SAMPLES[i]), float(_SAMPLES[j]))
    if t is not None:
        return [*ends(a), point(a, t)]
    if {i, j} & {0, len(_SAMPLES) - 1} and not is_closed(a) and not is_closed(b):
        return list(ends(a))  # an end is nearest, of one or of the other
    p = point(a, float(_SAMPLES[i]))
    for _ in range(50):  # by projecting to and fro
        before, p = p, point(a, nearest(a, point(b, nearest(b, p))))
        if p == before:
            break
    return [*ends(a), p]


def _facing(a: Piece, b: Piece, t: float, s: float) -> float | None:
    """Returns the parameter on `a` at which the way to `b` is at right angles to both, by Newton on e·a' = 0
    and e·b' = 0 with e = b - a from parameters nearby. None if that leads off the curves, or to no minimum.
    """
    for _ in range(30):
        (x, y), (u, v) = point(a, t), point(b, s)
        (ax, ay), (bx, by) = derivative(a, t), derivative(b, s)
        (cx, cy), (dx, dy) = second_derivative(a, t), second_derivative(b, s)
        ex, ey = u - x, v - y
        f, g = -(ex * ax + ey * ay), ex * bx + ey * by
        ftt = ax * ax + ay * ay - ex * cx - ey * cy
        fss = bx * bx + by * by + ex * dx + ey * dy
        fts = -(ax * bx + ay * by)
        determinant = ftt * fss - fts * fts
        if not (ftt > 0 and determinant > 0):
            return None
        dt, ds = (fts * g - fss * f) / determinant, (fts * f - ftt * g) / determinant
        t, s = t + dt, s + ds
        if not (0 <= t <= 1 and 0 <= s <= 1):
            return None
        if abs(dt) + abs(ds) < 1e-14:
            return t
    return None

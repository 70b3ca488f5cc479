"""Least distances between outlines, exact for lines, arcs and circles."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from aidl_lang.cancelling import checkpoint
from aidl_lang.geometry.curves import Arc, Circle, Line, Piece, Vec
from aidl_lang.geometry.evaluate import bounds, ends, is_closed, nearest, point, points
from aidl_lang.geometry.region import Region

Closest = tuple[float, Vec, Vec]
"""A distance and the points on either side where it is found."""


def region_distance(a: Region, b: Region) -> Closest | None:
    """Between the outlines of two regions that do not overlap; None if one is empty."""
    ours = [piece for loop in a.loops for piece in loop.pieces]
    theirs = [piece for loop in b.loops for piece in loop.pieces]
    best: Closest | None = None
    for bound, i, j in _by_box_distance(ours, theirs):
        if best is not None and bound >= best[0]:
            break
        checkpoint()
        found = piece_distance(ours[i], theirs[j])
        if best is None or found[0] < best[0]:
            best = found
    return best


def _by_box_distance(ours: list[Piece], theirs: list[Piece]) -> Iterator[tuple[float, int, int]]:
    """Pairs of pieces, those first whose boxes are nearest."""
    if not ours or not theirs:
        return
    a, b = np.array([bounds(p) for p in ours])[:, None, :], np.array([bounds(p) for p in theirs])[None]
    dx = np.maximum(0, np.maximum(a[..., 0] - b[..., 2], b[..., 0] - a[..., 2]))
    dy = np.maximum(0, np.maximum(a[..., 1] - b[..., 3], b[..., 1] - a[..., 3]))
    away = np.hypot(dx, dy).ravel()
    for k in np.argsort(away, kind="stable"):
        yield float(away[k]), int(k) // len(theirs), int(k) % len(theirs)


def piece_distance(a: Piece, b: Piece) -> Closest:
    """The least distance between two curves that do not cross."""
    candidates = [_to(b, p) for p in _candidates(a, b)]
    candidates += [(d, q, p) for d, p, q in (_to(a, p) for p in _candidates(b, a))]
    return min(candidates, key=lambda c: c[0])


def _to(curve: Piece, p: Vec) -> Closest:
    q = point(curve, nearest(curve, p))
    return math.dist(p, q), p, q


def _candidates(a: Piece, b: Piece) -> list[Vec]:
    """Points of a from which the way to b may be the shortest: its ends and where the normals agree."""
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
    """The ends of a, and the nearest of a sampling polished by projecting to and fro."""
    ts = np.linspace(0, 1, 49)
    away = points(a, ts)[:, None, :] - points(b, ts)[None, :, :]
    t = float(ts[int(np.argmin((away**2).sum(axis=2).min(axis=1)))])
    p = point(a, t)
    for _ in range(50):
        before, p = p, point(a, nearest(a, point(b, nearest(b, p))))
        if p == before:
            break
    return [*ends(a), p]

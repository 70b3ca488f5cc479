"""Curves cut to the inside of a region, each by itself: they are not cut where they cross each other."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Piece, Vec
from aidl_lang.geometry.evaluate import Bounds, bounds, ends, is_closed, locate, part, point
from aidl_lang.geometry.intersect import Crossing, all_intersections
from aidl_lang.geometry.nearness import inside, near_rows
from aidl_lang.geometry.network import CHORD, RELATIVE_TOLERANCE
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.separation import Hulls
from aidl_lang.geometry.tables import Floats, Table
from aidl_lang.geometry.tessellate import region_polygons


@record(slots=True)
class Clipped:
    """The parts of a curve that lie inside, and the others; `is_whole` if none of these is off the border."""

    inner: tuple[Piece, ...]
    outer: tuple[Piece, ...]
    is_whole: bool


@record(slots=True)
class Stretch:
    """The part of a curve from one cut to the next; its parameters may run past 1 on a closed curve."""

    t0: float
    t1: float
    start: Vec
    end: Vec
    on_border: bool

    @property
    def middle(self) -> float:
        return (self.t0 + self.t1) / 2


def clipped_each(curves: Sequence[Piece], region: Region, *, with_border: bool = False) -> list[Clipped]:
    """Returns for each curve what of it lies inside, or along the border where that counts as inside."""
    if not curves or not region:
        return [Clipped((), (curve,), is_whole=False) for curve in curves]
    boxes = np.concatenate((np.array([bounds(c) for c in curves]), region.boxes))
    size = float((boxes[:, 2:].max(axis=0) - boxes[:, :2].min(axis=0)).max()) or 1.0
    tolerance = RELATIVE_TOLERANCE * size
    stretches = stretches_beside(curves, region.pieces, boxes, tolerance)
    spots = [point(c, s.middle) for c, of in zip(curves, stretches, strict=True) for s in of]
    polygons = region_polygons(region, CHORD * size)
    within = iter(inside(polygons, np.array(spots).reshape(-1, 2)).tolist())
    return [
        _clipped(c, of, [next(within) for _ in of], with_border)
        for c, of in zip(curves, stretches, strict=True)
    ]


def stretches_beside(
    curves: Sequence[Piece], borders: Sequence[Piece], boxes: Floats | Sequence[Bounds], tolerance: float
) -> list[list[Stretch]]:
    """Returns for each curve its parts between the places where it meets some borders; `boxes` are those of
    the curves, then of the borders.
    """
    every, count = [*curves, *borders], len(curves)
    near = near_rows(boxes, tolerance)
    near = near[(near[:, 0] < count) & (near[:, 1] >= count)]
    table = Table(every)
    pairs = Hulls(table, tolerance).meeting(near)
    found: list[tuple[list[Piece], list[Crossing]]] = [([], []) for _ in curves]
    for (i, j), crossings in zip(pairs.tolist(), all_intersections(table, pairs, tolerance), strict=True):
        found[i][0].append(every[j])
        found[i][1].extend(crossings)
    return [_stretches(c, *own, tolerance) for c, own in zip(curves, found, strict=True)]


def _stretches(
    curve: Piece, borders: Sequence[Piece], crossings: Sequence[Crossing], tolerance: float
) -> list[Stretch]:
    """Returns a curve in parts between the places where it meets the border."""
    checkpoint()
    cuts = [(t, p) for t, _, p in crossings]
    spots = (p for border in borders for p in ends(border))
    cuts += [(t, p) for p in spots if (t := locate(curve, p, tolerance)) is not None]
    start, end = ends(curve)
    cuts.sort(key=lambda cut: cut[0])
    if not is_closed(curve):
        cuts = [(0.0, start), *cuts, (1.0, end)]
    elif cuts:
        cuts.append((cuts[0][0] + 1, cuts[0][1]))
    else:
        cuts = [(0.0, start), (1.0, end)]
    apart = cuts[:1]
    for t, p in cuts[1:]:
        t0, before = apart[-1]
        if max(math.dist(before, point(curve, (t0 + t) / 2)), math.dist(before, p)) > tolerance:
            apart.append((t, p))
        elif t == cuts[-1][0] and len(apart) > 1:
            apart[-1] = (t, p)
    return [_stretch(curve, *before, *after, borders, tolerance) for before, after in pairwise(apart)]


def _stretch(
    curve: Piece, t0: float, start: Vec, t1: float, end: Vec, borders: Sequence[Piece], tolerance: float
) -> Stretch:
    middle = point(curve, (t0 + t1) / 2)
    on_border = any(locate(border, middle, 2 * tolerance) is not None for border in borders)
    return Stretch(t0, t1, start, end, on_border)


def _clipped(
    curve: Piece, stretches: Sequence[Stretch], within: Sequence[bool], with_border: bool
) -> Clipped:
    sides: tuple[list[Stretch], list[Stretch]] = ([], [])
    for stretch, is_within in zip(stretches, within, strict=True):
        same = sides[0 if (with_border if stretch.on_border else is_within) else 1]
        if same and same[-1].t1 == stretch.t0:
            before = same.pop()
            stretch = Stretch(before.t0, stretch.t1, before.start, stretch.end, on_border=False)
        same.append(stretch)
    for same in sides if is_closed(curve) else ():
        if len(same) > 1 and same[-1].t1 == same[0].t0 + 1:
            last, first = same.pop(), same[0]
            same[0] = Stretch(last.t0, first.t1 + 1, last.start, first.end, on_border=False)
    is_whole = all(s.on_border or is_in for s, is_in in zip(stretches, within, strict=True))
    inner, outer = (
        tuple(curve if s.t1 - s.t0 == 1 else part(curve, s.t0, s.t1, s.start, s.end) for s in same)
        for same in sides
    )
    return Clipped(inner, outer, is_whole)

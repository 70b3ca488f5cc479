"""Booleans on finished regions, for those who ask about true outlines: `overlaps`, `clearance`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import accumulate

import numpy as np

from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.distance import region_distance
from aidl_lang.geometry.evaluate import is_closed
from aidl_lang.geometry.intersect import meet
from aidl_lang.geometry.measures import area
from aidl_lang.geometry.nearness import near_rows
from aidl_lang.geometry.network import RELATIVE_TOLERANCE, Network, with_finer_chords
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.sections import Section, difference, fill, intersection, union
from aidl_lang.geometry.separation import Hulls
from aidl_lang.geometry.tables import Table
from aidl_lang.geometry.trace import trace


def united(*regions: Region) -> Region:
    """Returns the union of regions."""
    return _combined(regions, lambda *sections: union(sections))


def without(a: Region, *others: Region) -> Region:
    """Returns the region `a` without the others."""
    return _combined((a, *others), lambda base, *sections: difference(base, union(sections)))


def common(a: Region, b: Region) -> Region:
    """Returns the intersection of two regions."""
    return _combined((a, b), intersection)


def within(cover: Region, regions: Sequence[Region]) -> Region:
    """Returns what of some regions lies in a cover."""
    return _combined((cover, *regions), lambda base, *sections: intersection(base, union(sections)))


def overlap_area(a: Region, b: Region) -> float:
    """Returns the area of the intersection of two regions, mm²."""
    return area(common(a, b))


def clearance(a: Region, b: Region) -> float:
    """Returns the least distance between two regions, mm; 0 where they touch or overlap, infinite if one is
    empty.
    """
    if not _lie_apart(a, b) and overlap_area(a, b) > 0:
        return 0.0
    closest = region_distance(a, b)
    return closest[0] if closest else float("inf")


def _lie_apart(a: Region, b: Region) -> bool:
    """Tells whether no outlines of two regions meet, and none lies in the box of the other."""
    curves, count = [*a.pieces, *b.pieces], len(a.pieces)
    boxes = np.concatenate((a.boxes, b.boxes))
    tolerance = RELATIVE_TOLERANCE * float(np.ptp(boxes.reshape(-1, 2), axis=0).max(initial=0.0))
    near = near_rows(boxes, tolerance)
    near = near[(near[:, 0] < count) & (near[:, 1] >= count)]
    open_pairs = Hulls(Table(curves), tolerance).meeting(near)
    if any(meet(curves[i], curves[j], tolerance) for i, j in open_pairs.tolist()):
        return False
    return not (_may_hold(a, b) or _may_hold(b, a))


def _may_hold(region: Region, other: Region) -> bool:
    """Tells whether an outline of the other lies in the box of a region."""
    if not (region and other):
        return False
    begins = list(accumulate([0, *(len(loop.pieces) for loop in other.loops[:-1])]))
    low, high = np.minimum.reduceat(other.boxes, begins), np.maximum.reduceat(other.boxes, begins)
    inside = (low[:, :2] >= region.boxes[:, :2].min(axis=0)) & (
        high[:, 2:] <= region.boxes[:, 2:].max(axis=0)
    )
    return bool(inside.all(axis=1).any())


def _combined(regions: Sequence[Region], operation: Callable[..., Section]) -> Region:
    pieces: list[Piece] = [piece for region in regions for piece in region.pieces]
    network = Network(pieces)
    counts = [len(region.pieces) for region in regions]
    firsts = accumulate([0, *counts][:-1])

    def traced(placed: Sequence[tuple[Region, int]] = tuple(zip(regions, firsts, strict=True))) -> Region:
        return trace(network, operation(*(section_of(network, r, first) for r, first in placed))).region

    return with_finer_chords(network, traced)


def section_of(network: Network, region: Region, number: int) -> Section:
    """Returns a region as polygons; its pieces are the curves of the network from `number` on."""
    polygons = []
    for loop in region.loops:
        uses = [use for k in range(len(loop.pieces)) for use in network.uses[number + k]]
        number += len(loop.pieces)
        if not uses:  # too small to be seen beside the rest
            continue
        polygons.append(network.polyline(uses))
        assert loop.is_whole or not any(map(is_closed, loop.pieces))
    return fill(polygons, "EvenOdd")

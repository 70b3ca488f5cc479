"""Booleans on finished regions, for those who ask about true outlines: `overlaps`, `clearance`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import accumulate

from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.distance import region_distance
from aidl_lang.geometry.evaluate import is_closed
from aidl_lang.geometry.measures import area
from aidl_lang.geometry.network import Network, exactly
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.sections import Section, difference, fill, intersection, union
from aidl_lang.geometry.trace import trace


def united(*regions: Region) -> Region:
    """What lies in any of them."""
    return _combined(regions, lambda *sections: union(sections))


def without(a: Region, *others: Region) -> Region:
    """What lies in a and in none of the others."""
    return _combined((a, *others), lambda base, *sections: difference(base, union(sections)))


def common(a: Region, b: Region) -> Region:
    """What lies in both."""
    return _combined((a, b), intersection)


def overlap_area(a: Region, b: Region) -> float:
    """Area of what lies in both, mm²."""
    return area(common(a, b))


def clearance(a: Region, b: Region) -> float:
    """The least distance between two regions, mm; 0 where they touch or overlap, infinite if one is empty."""
    if overlap_area(a, b) > 0:
        return 0.0
    closest = region_distance(a, b)
    return closest[0] if closest else float("inf")


def _combined(regions: Sequence[Region], operation: Callable[..., Section]) -> Region:
    pieces: list[Piece] = [p for region in regions for loop in region.loops for p in loop.pieces]
    network = Network(pieces)
    counts = [sum(len(loop.pieces) for loop in region.loops) for region in regions]
    firsts = accumulate([0, *counts][:-1])

    def traced(placed: Sequence[tuple[Region, int]] = tuple(zip(regions, firsts, strict=True))) -> Region:
        return trace(network, operation(*(section_of(network, r, first) for r, first in placed))).region

    return exactly(network, traced)


def section_of(network: Network, region: Region, number: int) -> Section:
    """A region as polygons; its pieces are the curves of the network from `number` on."""
    polygons = []
    for loop in region.loops:
        uses = [use for k in range(len(loop.pieces)) for use in network.uses[number + k]]
        number += len(loop.pieces)
        if not uses:  # too small to be seen beside the rest
            continue
        polygons.append(network.polyline(uses))
        assert loop.is_whole or not any(map(is_closed, loop.pieces))
    return fill(polygons, "EvenOdd")

"""Booleans on finished regions, for those who ask about true outlines: `overlaps`, `clearance`."""

from __future__ import annotations

from collections.abc import Callable

from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.distance import region_distance
from aidl_lang.geometry.evaluate import is_closed
from aidl_lang.geometry.measures import area
from aidl_lang.geometry.network import Network, exactly
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.sections import Section, difference, fill, intersection, union
from aidl_lang.geometry.trace import trace


def united(a: Region, b: Region) -> Region:
    """What lies in one or both."""
    return _combined(a, b, lambda p, q: union([p, q]))


def without(a: Region, b: Region) -> Region:
    """What lies in a and not in b."""
    return _combined(a, b, difference)


def common(a: Region, b: Region) -> Region:
    """What lies in both."""
    return _combined(a, b, intersection)


def overlap_area(a: Region, b: Region) -> float:
    """Area of what lies in both, mm²."""
    return area(common(a, b))


def clearance(a: Region, b: Region) -> float:
    """The least distance between two regions, mm; 0 where they touch or overlap, infinite if one is empty."""
    if overlap_area(a, b) > 0:
        return 0.0
    closest = region_distance(a, b)
    return closest[0] if closest else float("inf")


def _combined(a: Region, b: Region, operation: Callable[[Section, Section], Section]) -> Region:
    pieces: list[Piece] = [p for region in (a, b) for loop in region.loops for p in loop.pieces]
    network = Network(pieces)
    first = sum(len(loop.pieces) for loop in a.loops)

    def traced() -> Region:
        return trace(network, operation(section_of(network, a, 0), section_of(network, b, first))).region

    return exactly(network, traced)


def section_of(network: Network, region: Region, number: int) -> Section:
    """A region as polygons; its pieces are the curves of the network from `number` on."""
    polygons = []
    for loop in region.loops:
        uses = [use for k in range(len(loop.pieces)) for use in network.uses[number + k]]
        number += len(loop.pieces)
        polygons.append(network.polyline(uses))
        assert loop.is_whole or not any(map(is_closed, loop.pieces))
    return fill(polygons, "EvenOdd")

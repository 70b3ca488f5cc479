"""The contacts between the bodies of a drawing: touching, apart or overlapping.

All is worked out when it is asked for: which pairs touch or overlap, which takes little, and how far apart
they are, or by how much they overlap. Up to `ALL_PAIRS` bodies every pair is listed. In larger drawings only
pairs whose boxes are closer than `NEAR` times the size of the drawing are, so that hundreds of bodies stay
cheap; a pair that is not listed is apart.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import field
from itertools import combinations
from typing import Literal

from aidl_lang.common.records import record
from aidl_lang.common.running import Later
from aidl_lang.geometry.distance import lie_within, nearest_region, region_distance
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.geometry.measures import area
from aidl_lang.geometry.nearness import near_pairs
from aidl_lang.geometry.network import Network
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.sections import NEGLIGIBLE, Section, intersection, is_nothing
from aidl_lang.geometry.trace import trace

ALL_PAIRS = 24
NEAR = 0.05
UNNOTICED = 1e-3
"""A gap in mm that nobody who makes the parts will see: flanks of gears are a little less than touching."""
_THIN = 100 * NEGLIGIBLE
"""Width of an area below which it may be but the difference of curves and chords, so that it is traced."""

Relation = Literal["touching", "apart", "overlapping"]


@record(slots=True)
class Contact:
    """The contact of two bodies, by their paths; `gap` (mm) if they are apart, `area` (mm²) if they
    overlap.
    """

    a: str
    b: str
    relation: Relation
    gap: float | None = None
    area: float | None = None


@record(slots=True)
class Solid:
    """A body to be compared: its region, and the same as polygons of the network."""

    path: str
    region: Region
    section: Section = field(repr=False, compare=False)
    box: Bounds


@record()
class Contacts:
    """The pairs of some bodies, in order: those `near` touch or overlap; of `all` see above."""

    bodies: Sequence[tuple[str, Region]] = ()
    near: Callable[[], tuple[tuple[str, str], ...]] = field(default=tuple, repr=False, compare=False)
    all: Callable[[], tuple[Contact, ...]] = field(default=tuple, repr=False, compare=False)

    def nearest(self, path: str) -> tuple[float, str]:
        """Returns the distance (mm) from a body to the nearest other, and its path."""
        own = [region for name, region in self.bodies if name == path]
        others = [(name, region) for name, region in self.bodies if name != path]
        gap, place = nearest_region(own, [region for _, region in others])
        return gap, others[place][0]


def contacts(network: Network, solids: Sequence[Solid]) -> Contacts:
    """Returns the contacts between some bodies, whose sections are those of a network."""

    def near() -> tuple[tuple[str, str], ...]:
        reach = max(UNNOTICED, network.tolerance)
        pairs = sorted(near_pairs([solid.box for solid in solids], reach + network.tolerance))
        couples = ((solids[i], solids[j]) for i, j in pairs)
        return tuple(
            (a.path, b.path)
            for a, b in couples
            if _shared(network, a, b, exactly=False) > 0 or lie_within(a.region, b.region, reach)
        )

    def everything() -> tuple[Contact, ...]:
        pairs: Iterable[tuple[int, int]] = combinations(range(len(solids)), 2)
        if len(solids) > ALL_PAIRS:
            pairs = sorted(near_pairs([solid.box for solid in solids], NEAR * network.size))
        return tuple(_compare(network, solids[i], solids[j]) for i, j in pairs)

    return Contacts(tuple((s.path, s.region) for s in solids), Later(near), Later(everything))


def _shared(network: Network, a: Solid, b: Solid, *, exactly: bool) -> float:
    """Returns the area that two bodies share; that of their polygons will do if it is no thin one."""
    common = intersection(a.section, b.section)
    if is_nothing(common):
        return 0.0
    left, bottom, right, top = common.bounds()
    thin = _THIN * common.num_contour() * ((right - left) + (top - bottom))
    return common.area() if common.area() > thin and not exactly else area(trace(network, common).region)


def _compare(network: Network, a: Solid, b: Solid) -> Contact:
    if (shared := _shared(network, a, b, exactly=True)) > 0:
        return Contact(a.path, b.path, "overlapping", area=shared)
    closest = region_distance(a.region, b.region)
    gap = closest[0] if closest and closest[0] > network.tolerance else None
    return Contact(a.path, b.path, "touching" if gap is None else "apart", gap)

"""The contacts between the bodies of a drawing: touching, apart or overlapping.

All is worked out when it is asked for: which pairs touch or overlap, which takes little, and how far apart
they are, or by how much they overlap. Up to `ALL_PAIRS` bodies every pair is listed. In larger drawings only
pairs whose boxes are closer than `NEAR` times the size of the drawing are, so that hundreds of bodies stay
cheap; a pair that is not listed is apart.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import field
from functools import cached_property, partial
from itertools import combinations
from typing import Literal

from aidl_lang.common.records import record
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
    """The pairs of some bodies, whose sections are those of a network."""

    solids: Sequence[Solid] = ()
    network: Network = field(default_factory=partial(Network, ()), repr=False, compare=False)

    def __getstate__(self) -> dict[str, object]:
        """Returns what a pickle keeps: what is worked out on demand is worked out now."""
        return {"solids": (), "network": None, "near": self.near, "all": self.all}

    @cached_property
    def near(self) -> tuple[tuple[str, str], ...]:
        """The pairs that touch or overlap, as far as a reader can see."""
        reach = max(UNNOTICED, self.network.tolerance)
        pairs = sorted(near_pairs([solid.box for solid in self.solids], reach + self.network.tolerance))
        couples = ((self.solids[i], self.solids[j]) for i, j in pairs)
        return tuple(
            (a.path, b.path)
            for a, b in couples
            if _shared(self.network, a, b, exactly=False) > 0 or lie_within(a.region, b.region, reach)
        )

    @cached_property
    def all(self) -> tuple[Contact, ...]:
        """All pairs (see above), in the order of the bodies."""
        pairs: Iterable[tuple[int, int]] = combinations(range(len(self.solids)), 2)
        if len(self.solids) > ALL_PAIRS:
            pairs = sorted(near_pairs([solid.box for solid in self.solids], NEAR * self.network.size))
        return tuple(_compare(self.network, self.solids[i], self.solids[j]) for i, j in pairs)

    def nearest(self, path: str) -> tuple[float, str]:
        """Returns the distance (mm) from a body to the nearest other, and its path."""
        own = [solid.region for solid in self.solids if solid.path == path]
        others = [solid for solid in self.solids if solid.path != path]
        gap, place = nearest_region(own, [solid.region for solid in others])
        return gap, others[place].path


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

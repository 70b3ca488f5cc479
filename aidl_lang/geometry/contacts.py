"""How the bodies of a drawing lie to each other: touching, apart or overlapping.

Up to `ALL_PAIRS` bodies every pair is compared. In larger drawings only pairs whose boxes are closer than
`NEAR` times the size of the drawing are, so that hundreds of bodies stay cheap; a pair that is not listed is
apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from aidl_lang.geometry.distance import region_distance
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.geometry.measures import area
from aidl_lang.geometry.nearness import near_pairs
from aidl_lang.geometry.network import Network
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.sections import Section, intersection, is_nothing
from aidl_lang.geometry.trace import trace
from aidl_lang.records import record

ALL_PAIRS = 24
NEAR = 0.05

Relation = Literal["touching", "apart", "overlapping"]


@record(slots=True)
class Contact:
    """Two bodies by their paths; `gap` (mm) where they are apart, `area` (mm²) where they overlap."""

    a: str
    b: str
    relation: Relation
    gap: float | None = None
    area: float | None = None


@record(slots=True)
class Solid:
    """What is compared: a body's region and the same as polygons of the network."""

    path: str
    region: Region
    section: Section
    box: Bounds


def contacts(network: Network, solids: Sequence[Solid]) -> list[Contact]:
    """All pairs (see above), in the order of the bodies."""
    count = len(solids)
    if count <= ALL_PAIRS:
        pairs = [(i, j) for i in range(count) for j in range(i + 1, count)]
    else:
        pairs = sorted(near_pairs([s.box for s in solids], NEAR * network.size))
    return [_compare(network, solids[i], solids[j]) for i, j in pairs]


def _compare(network: Network, a: Solid, b: Solid) -> Contact:
    common = intersection(a.section, b.section)
    if not is_nothing(common):
        shared = area(trace(network, common).region)
        if shared > 0:
            return Contact(a.path, b.path, "overlapping", area=shared)
    closest = region_distance(a.region, b.region)
    gap = closest[0] if closest else 0.0
    if gap <= network.tolerance:
        return Contact(a.path, b.path, "touching")
    return Contact(a.path, b.path, "apart", gap=gap)

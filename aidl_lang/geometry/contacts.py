"""The contacts between the bodies of a drawing: touching, apart or overlapping.

All is worked out when it is asked for, pairs that may touch apart from how far others are apart. Up to
`ALL_PAIRS` bodies every pair is listed. In larger drawings only pairs whose boxes are closer than `NEAR`
times the size of the drawing are, so that hundreds of bodies stay cheap; a pair that is not listed is apart.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import field
from functools import cached_property
from itertools import combinations
from operator import itemgetter
from typing import Literal

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.common.running import Later
from aidl_lang.geometry.distance import region_distance
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.geometry.measures import area
from aidl_lang.geometry.nearness import near_pairs
from aidl_lang.geometry.network import Network
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.sections import Section, intersection, is_nothing
from aidl_lang.geometry.trace import trace

ALL_PAIRS = 24
NEAR = 0.05
UNNOTICED = 1e-3
"""A gap in mm that nobody who makes the parts will see: flanks of gears are a little less than touching."""

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

    @property
    def is_close(self) -> bool:
        """True if the bodies touch or overlap, as far as a reader can see."""
        return self.relation != "apart" or (self.gap or 0.0) <= UNNOTICED


@record(slots=True)
class Solid:
    """A body to be compared: its region, and the same as polygons of the network."""

    path: str
    region: Region
    section: Section
    box: Bounds


@record()
class Contacts:
    """The pairs of some bodies. `near` works out those that touch, overlap or are `UNNOTICED` apart at most;
    `tolerance` and `size` are those of the drawing.
    """

    bodies: Sequence[tuple[str, Region, Bounds]] = ()
    near: Callable[[], tuple[Contact, ...]] = field(default=tuple, repr=False, compare=False)
    tolerance: float = 0.0
    size: float = 0.0

    @cached_property
    def all(self) -> tuple[Contact, ...]:
        """All pairs (see above), in the order of the bodies."""
        known = {(contact.a, contact.b): contact for contact in self.near()}
        pairs: Iterable[tuple[int, int]] = combinations(range(len(self.bodies)), 2)
        if len(self.bodies) > ALL_PAIRS:
            pairs = sorted(near_pairs([box for _, _, box in self.bodies], NEAR * self.size))
        return tuple(self._pair(i, j, known) for i, j in pairs)

    def nearest(self, path: str) -> tuple[float, str] | None:
        """Returns the distance (mm) from a body to the nearest other, and its path; None if it is alone."""
        boxes = np.array([box for _, _, box in self.bodies])
        number = next(i for i, (name, _, _) in enumerate(self.bodies) if name == path)
        apart = np.maximum(boxes[number, :2] - boxes[:, 2:], boxes[:, :2] - boxes[number, 2:])
        away = np.hypot(*np.maximum(apart, 0.0).T)
        best: tuple[float, str] | None = None
        for other in np.argsort(away, kind="stable").tolist():
            if best is not None and away[other] >= best[0]:
                break
            if other != number:
                name, theirs, _ = self.bodies[other]
                pair = _apart(path, self.bodies[number][1], name, theirs, self.tolerance)
                found = pair.gap or 0.0, name
                best = found if best is None else min(best, found, key=itemgetter(0))
        return best

    def _pair(self, i: int, j: int, known: dict[tuple[str, str], Contact]) -> Contact:
        (a, ours, _), (b, theirs, _) = self.bodies[i], self.bodies[j]
        return known.get((a, b)) or _apart(a, ours, b, theirs, self.tolerance)


def contacts(network: Network, solids: Sequence[Solid]) -> Contacts:
    """Returns the contacts between some bodies."""

    def near() -> tuple[Contact, ...]:
        margin = max(UNNOTICED, 2 * network.tolerance)
        pairs = sorted(near_pairs([s.box for s in solids], margin))
        return tuple(_compare(network, solids[i], solids[j]) for i, j in pairs)

    bodies = tuple((s.path, s.region, s.box) for s in solids)
    return Contacts(bodies, Later(near), network.tolerance, network.size)


def _compare(network: Network, a: Solid, b: Solid) -> Contact:
    common = intersection(a.section, b.section)
    if not is_nothing(common):
        shared = area(trace(network, common).region)
        if shared > 0:
            return Contact(a.path, b.path, "overlapping", area=shared)
    return _apart(a.path, a.region, b.path, b.region, network.tolerance)


def _apart(a: str, ours: Region, b: str, theirs: Region, tolerance: float) -> Contact:
    """Returns the contact of two bodies that do not overlap."""
    closest = region_distance(ours, theirs)
    gap = closest[0] if closest else 0.0
    return Contact(a, b, "apart", gap=gap) if gap > tolerance else Contact(a, b, "touching")

"""A thin layer over Manifold's plane booleans, on polygons in grid units (see `network`)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from importlib import import_module
from typing import Any, Literal, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from aidl_lang.geometry.nearness import inside
from aidl_lang.geometry.network import RELATIVE_TOLERANCE
from aidl_lang.geometry.tessellate import polygon_area

Polygon = NDArray[np.float64]
NEGLIGIBLE = 16 * RELATIVE_TOLERANCE
"""Width in grid units below which an area is rounding: the drawing measures about 16 of them."""


_CORNERS = 32
"""Of the polygon that stands for a circle around a corner."""


class Section(Protocol):
    """The part of Manifold's `CrossSection` used here: an area of the plane bounded by polygons."""

    def area(self) -> float: ...
    def bounds(self) -> tuple[float, float, float, float]: ...
    def is_empty(self) -> bool: ...
    def num_contour(self) -> int: ...
    def num_vert(self) -> int: ...
    def decompose(self) -> list[Self]: ...
    def to_polygons(self) -> list[Polygon]: ...
    def __sub__(self, other: Self) -> Self: ...
    def __xor__(self, other: Self) -> Self: ...


@lru_cache(maxsize=1)
def _manifold() -> Any:
    # Not imported at the top: checking and formatting a program need no kernel.
    return import_module("manifold3d")


def fill(polygons: Sequence[Polygon], rule: Literal["EvenOdd", "NonZero"]) -> Section:
    m = _manifold()
    kept = [p for p in polygons if len(p) > 2]
    section: Section = m.CrossSection(kept, getattr(m.FillRule, rule)) if kept else m.CrossSection()
    return section


def widened(polygon: Polygon, by: float, rough: float = 0.0) -> Polygon:
    """Returns the outer boundary of all within a distance of a polygon, or a little further out: up to twice
    `rough`, for which corners that matter less are left out, but no further than its box.
    """
    m = _manifold()

    def grown(by: float) -> Any:
        reach = by / math.cos(math.pi / _CORNERS)  # of a round corner's chords
        section = m.CrossSection([polygon], m.FillRule.NonZero)
        return section.offset(reach, m.JoinType.Round, 2.0, _CORNERS)

    section: Section = grown(by)
    if rough:
        left, bottom, right, top = section.bounds()
        box = m.CrossSection.square((right - left, top - bottom)).translate((left, bottom))
        section = grown(by + rough).simplify(rough) ^ box
    return max(
        (np.asarray(p, np.float64) for p in section.to_polygons()),
        key=lambda p: float(np.ptp(p, axis=0).max()),
    )


def union(sections: Sequence[Section]) -> Section:
    """Returns the union of any number of sections."""
    m = _manifold()
    full = [s for s in sections if not s.is_empty()]
    if len(full) == 1:
        return full[0]
    section: Section = m.CrossSection.batch_boolean(full, m.OpType.Add) if full else m.CrossSection()
    return section


def difference(a: Section, b: Section) -> Section:
    if not boxes_meet(a, b):
        return a
    return a - b


def intersection(a: Section, b: Section) -> Section:
    if not boxes_meet(a, b):
        nothing: Section = _manifold().CrossSection()
        return nothing
    return a ^ b


def boxes_meet(a: Section, b: Section) -> bool:
    """Tells whether the bounding boxes overlap by more than nothing."""
    if a.is_empty() or b.is_empty():
        return False
    (a0, a1, a2, a3), (b0, b1, b2, b3) = a.bounds(), b.bounds()
    return bool(a0 < b2 and b0 < a2 and a1 < b3 and b1 < a3)


def box_within(a: Section, b: Section) -> bool:
    """Tells whether the box of a lies in the box of b."""
    (a0, a1, a2, a3), (b0, b1, b2, b3) = a.bounds(), b.bounds()
    e = NEGLIGIBLE
    return bool(a0 >= b0 - e and a1 >= b1 - e and a2 <= b2 + e and a3 <= b3 + e)


def is_nothing(section: Section, scale: float | None = None) -> bool:
    """Tells whether an area is empty or thinner than the tolerance; `scale` is the size to compare it
    with.
    """
    if section.is_empty():
        return True
    if scale is None:
        left, bottom, right, top = section.bounds()
        scale = (right - left) + (top - bottom)
    return bool(abs(section.area()) <= NEGLIGIBLE * scale)


def covers(cover: Section, section: Section) -> bool:
    """Tells whether nothing of the section lies outside the cover."""
    if section.is_empty() or cover.is_empty() or not box_within(section, cover):
        return False
    return is_nothing(difference(section, cover), math.sqrt(abs(section.area())))


def holes_of(section: Section) -> list[Section]:
    """Returns the areas that the inner outlines of a section enclose."""
    whole = fill([p for p in section.to_polygons() if polygon_area(p) > 0], "NonZero")
    return difference(whole, section).decompose()


def inside_mask(section: Section, spots: Polygon) -> NDArray[np.bool_]:
    """Returns the mask of points, in grid units, inside a section."""
    within = np.zeros(len(spots), dtype=np.bool_)
    if not section.is_empty():
        left, bottom, right, top = section.bounds()
        near = np.flatnonzero(((spots >= (left, bottom)) & (spots <= (right, top))).all(axis=1))
        if len(near):
            within[near] = inside(section.to_polygons(), spots[near])
    return within

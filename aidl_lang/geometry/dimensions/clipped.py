"""Sizes of what `@clip` takes away: a drawing does not state them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from aidl_lang.geometry.curves import Vec
from aidl_lang.geometry.evaluate import nearest, point
from aidl_lang.geometry.measures import region_bounds
from aidl_lang.geometry.nearness import inside
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import Dimension, Length, Opening, Roundness, SolvedStructure
from aidl_lang.geometry.tessellate import region_polygons

_SPOTS = 24
_CHORD = 1e-4
_NEAR = 1e-6


def is_clipped(root: SolvedStructure) -> bool:
    return any(s.inside is not None for s in root.walk())


def left_of(sizes: Sequence[Dimension], root: SolvedStructure) -> list[Dimension]:
    """Returns the sizes of which both ends are still there where structures are clipped."""
    clips = [(f"{s.path}.", _Inside(s.inside)) for s in root.walk() if s.inside is not None]
    return [d for d in sizes if all(clip.shows(d) for path, clip in clips if f"{d.of}.".startswith(path))]


class _Inside:
    """The region that a structure is clipped to."""

    def __init__(self, region: Region) -> None:
        left, bottom, right, top = region_bounds(region) if region else (0.0, 0.0, 0.0, 0.0)
        size = max(right - left, top - bottom)
        self._region, self._near = region, _NEAR * size
        self._polygons = region_polygons(region, _CHORD * size) if region else []

    def shows(self, dimension: Dimension) -> bool:
        return all(self._has_one(spots) for spots in _ends(dimension))

    def _has_one(self, spots: Iterable[Vec]) -> bool:
        every = list(spots)
        if inside(self._polygons, np.array(every)).any():
            return True
        borders = self._region.pieces
        return any(math.dist(point(c, nearest(c, p)), p) <= self._near for p in every for c in borders)


def _ends(dimension: Dimension) -> Iterator[Iterable[Vec]]:
    """Yields, for each end of a dimension, the places where it may be seen."""
    match dimension:
        case Length(start=start, end=end):
            for (x0, y0), (x1, y1) in ((start[0], start[-1]), (end[0], end[-1])):
                shares = [k / _SPOTS for k in range(_SPOTS + 1)]
                yield [(x0 + t * (x1 - x0), y0 + t * (y1 - y0)) for t in shares]
        case Roundness(curve=curve):
            yield [point(curve, k / _SPOTS) for k in range(_SPOTS + 1)]
        case Opening(corner=corner):
            yield [corner]

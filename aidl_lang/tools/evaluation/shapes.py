"""Outlines of other languages as regions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Literal

import numpy as np

from aidl_lang.geometry.curves import Line
from aidl_lang.geometry.region import Face, Loop, Region
from aidl_lang.geometry.sections import Polygon, Section, fill
from aidl_lang.geometry.tessellate import polygon_area

_CORNERS = 24
"""Corners of a round end."""
PIXELS = 512
"""Larger side of the pictures."""


def region(outlines: Sequence[Polygon], rule: Literal["EvenOdd", "NonZero"] = "EvenOdd") -> Region:
    """Returns the region inside an odd number of the outlines, or inside any that are not cancelled."""
    return _region(fill(outlines, rule))


def without(outlines: Sequence[Polygon], others: Sequence[Polygon]) -> Region:
    """Returns the region inside outlines but outside others; all are directed."""
    return _region(fill(outlines, "NonZero") - fill(others, "NonZero"))


def stroked(paths: Sequence[Polygon], width: float) -> Region:
    """Returns what lines of a width along paths cover, with round ends and corners."""
    bands = [band for path in paths for a, b in pairwise(path) for band in (_band(a, b, width / 2),)]
    return region([*bands, *(_disc(point, width / 2) for path in paths for point in path)], "NonZero")


def _band(a: Polygon, b: Polygon, reach: float) -> Polygon:
    way = b - a
    length = float(np.hypot(*way))
    if not length:
        return np.empty((0, 2))
    aside = reach / length * np.array([-way[1], way[0]])
    return np.array([a - aside, b - aside, b + aside, a + aside])


def _disc(center: Polygon, radius: float) -> Polygon:
    turns = np.linspace(0.0, math.tau, _CORNERS, endpoint=False)
    return center + radius * np.stack((np.cos(turns), np.sin(turns)), axis=1)


def _region(section: Section) -> Region:
    if section.is_empty():
        return Region()
    return Region(tuple(_face(part.to_polygons()) for part in section.decompose()))


def _face(polygons: Sequence[Polygon]) -> Face:
    """Returns one connected area from its outlines; only the outer one runs counter-clockwise."""
    outer, *holes = sorted(polygons, key=polygon_area, reverse=True)
    return Face(_loop(outer), tuple(map(_loop, holes)))


def _loop(polygon: Polygon) -> Loop:
    corners = [(float(x), float(y)) for x, y in polygon]
    return Loop(tuple(Line(a, b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)))

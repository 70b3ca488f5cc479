"""Outlines of other languages as regions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal

import numpy as np

from aidl_lang.geometry.curves import Line
from aidl_lang.geometry.region import Face, Loop, Polygon, Region, polygon_area
from aidl_lang.geometry.sections import Section, fill

_CORNERS = 24
"""Of a round end or turn."""


def region(outlines: Sequence[Polygon], rule: Literal["EvenOdd", "NonZero"] = "EvenOdd") -> Region:
    """Returns the region inside an odd number of the outlines, or inside any that are not cancelled."""
    return _region(fill(outlines, rule))


def without(outlines: Sequence[Polygon], others: Sequence[Polygon]) -> Region:
    """Returns the region inside outlines but outside others; all are directed."""
    return _region(fill(outlines, "NonZero") - fill(others, "NonZero"))


def stroked(paths: Sequence[Polygon], width: float, cap: str = "butt") -> Region:
    """Returns what lines along paths cover; one that ends where it begins is closed. Turns are round."""
    reach, found = width / 2, list[Polygon]()
    for path in paths:
        points = path[np.append(np.diff(path, axis=0).any(axis=1), True)]
        ways = np.diff(points, axis=0)
        ways /= np.hypot(*ways.T)[:, None]
        is_closed = len(points) > 2 and np.allclose(points[0], points[-1], rtol=0, atol=1e-9 * reach)
        found += [_disc(p, reach) for p in (points if is_closed or cap == "round" else points[1:-1])]
        if cap == "square" and not is_closed and len(ways):
            points[0] -= reach * ways[0]
            points[-1] += reach * ways[-1]
        asides = reach * np.stack((-ways[:, 1], ways[:, 0]), axis=1)
        found += [
            np.array([a - s, b - s, b + s, a + s])
            for a, b, s in zip(points, points[1:], asides, strict=False)
        ]
    return region(found, "NonZero")


def _disc(center: Polygon, radius: float) -> Polygon:
    turns = np.linspace(0.0, math.tau, _CORNERS, endpoint=False)
    return center + radius * np.stack((np.cos(turns), np.sin(turns)), axis=1)


def _region(section: Section) -> Region:
    if section.is_empty:
        return Region()
    return Region(tuple(_face(part.to_polygons()) for part in section.decompose()))


def _face(polygons: Sequence[Polygon]) -> Face:
    """Returns one connected area from its outlines; only the outer one runs counter-clockwise."""
    outer, *holes = sorted(polygons, key=polygon_area, reverse=True)
    return Face(_loop(outer), tuple(map(_loop, holes)))


def _loop(polygon: Polygon) -> Loop:
    corners = [(float(x), float(y)) for x, y in polygon]
    return Loop(tuple(Line(a, b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)))

"""Outlines of other languages as regions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from aidl_lang.geometry.curves import Line
from aidl_lang.geometry.region import Face, Loop, Polygon, Region, polygon_area
from aidl_lang.geometry.sections import Section, fill

_CORNERS = 24
"""Corners of a round end or turn."""
PIXELS = 512
"""Larger side of the pictures."""


def region(outlines: Sequence[Polygon], rule: Literal["EvenOdd", "NonZero"] = "EvenOdd") -> Region:
    """Returns the region inside an odd number of the outlines, or inside any that are not cancelled."""
    return _region(fill(outlines, rule))


def without(outlines: Sequence[Polygon], others: Sequence[Polygon]) -> Region:
    """Returns the region inside outlines but outside others; all are directed."""
    return _region(fill(outlines, "NonZero") - fill(others, "NonZero"))


@dataclass(frozen=True)
class Stroke:
    """How wide a line is drawn, and how it ends and turns: words and numbers of SVG."""

    width: float
    cap: str = "butt"
    join: str = "miter"
    limit: float = 4.0


def stroked(paths: Sequence[Polygon], stroke: Stroke) -> Region:
    """Returns what lines along paths cover; one that ends where it begins is closed."""
    found = list[Polygon]()
    for path in paths:
        reach, ways = stroke.width / 2, np.diff(path, axis=0)
        lengths = np.hypot(*ways.T)
        kept = np.append(lengths > 0, True)
        points = path[kept]
        ways = (ways / lengths[:, None])[kept[:-1]] if kept[:-1].any() else np.empty((0, 2))
        if not len(ways):
            found += [_disc(path[0], reach)] if stroke.cap == "round" else []
            continue
        is_closed = len(ways) > 1 and np.allclose(points[0], points[-1], rtol=0, atol=1e-9 * reach)
        if not is_closed and stroke.cap == "square":
            points = np.concatenate(
                ([points[0] - reach * ways[0]], points[1:-1], [points[-1] + reach * ways[-1]])
            )
        asides = reach * np.stack((-ways[:, 1], ways[:, 0]), axis=1)
        for a, b, aside in zip(points, points[1:], asides, strict=False):
            found.append(np.array([a - aside, b - aside, b + aside, a + aside]))
        if not is_closed and stroke.cap == "round":
            found += [_disc(points[0], reach), _disc(points[-1], reach)]
        turns = list(zip(points[1:], asides, asides[1:], strict=False))
        if is_closed:
            turns.append((points[0], asides[-1], asides[0]))
        found += [corner for turn in turns if len(corner := _corner(*turn, stroke))]
    return region(found, "NonZero")


def _corner(at: Polygon, before: Polygon, after: Polygon, stroke: Stroke) -> Polygon:
    """Returns what a line covers outside a turn, counter-clockwise; empty where it goes straight on."""
    reach = stroke.width / 2
    bend, ahead = before[0] * after[1] - before[1] * after[0], float(before @ after) / reach**2
    if stroke.join == "round":
        return _disc(at, reach)
    if abs(bend) < 1e-12 * reach**2:
        return np.empty((0, 2))
    one, two = (at - before, at - after) if bend > 0 else (at + after, at + before)
    if stroke.join != "miter" or 2 / (1 + ahead) > stroke.limit**2:
        return np.array([at, one, two])
    return np.array([at, one, at + (one + two - 2 * at) / (1 + ahead), two])


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

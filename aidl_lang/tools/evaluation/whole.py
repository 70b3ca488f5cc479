"""Measures of a whole drawing that the language has no words for, by their names in prompts."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from aidl_lang.geometry.boolean import common, overlap_area
from aidl_lang.geometry.curves import Line
from aidl_lang.geometry.distance import region_distance
from aidl_lang.geometry.evaluate import inward, points
from aidl_lang.geometry.measures import area, measure, region_bounds
from aidl_lang.geometry.nearness import near_pairs
from aidl_lang.geometry.region import Face, Loop, Region

NEAR = 0.02
"""Distance, as a share of the drawing, up to which parts hold together."""

_BELOW_TOP = 0.03
"""Distance from its top at which a drawing is cut to count battlements, as a share of its height."""

_SAMPLES = 48
"""Points on a curve at which the distance from the centre is measured."""


def pieces(whole: Region) -> float:
    """Counts the groups of material further apart than a fiftieth of the drawing's size."""
    group = list(range(len(whole.faces)))

    def head(k: int) -> int:
        while group[k] != k:
            k = group[k]
        return k

    boxes = [region_bounds(Region((face,))) for face in whole.faces]
    reach = NEAR * _size(whole)
    for i, j in near_pairs(boxes, reach):
        if head(i) != head(j):
            closest = region_distance(Region((whole.faces[i],)), Region((whole.faces[j],)))
            if closest is not None and closest[0] <= reach:
                group[head(j)] = head(i)
    return float(len({head(k) for k in group}))


def symmetry(whole: Region) -> float:
    """Returns the share of the area covered by its mirror image about the upright through the centroid."""
    if not whole:
        return math.nan
    x = measure(whole).centroid[0]
    return overlap_area(_seen(whole, x, mirrored=False), _seen(whole, x, mirrored=True)) / area(whole)


def _seen(region: Region, x: float, *, mirrored: bool) -> Region:
    def turned(loop: Loop) -> Loop:
        return Loop(tuple(inward(piece, (x, 0.0), 0.0, mirrored) for piece in loop.pieces), loop.reversed)

    return Region(tuple(Face(turned(f.outer), tuple(map(turned, f.holes))) for f in region.faces))


def openings(whole: Region) -> float:
    """Counts the holes that material surrounds."""
    return float(sum(len(face.holes) for face in whole.faces))


def teeth(whole: Region) -> float:
    """Counts how often the outermost outline crosses the circle halfway between its least and greatest
    distance from its centre, out and back.
    """
    if not whole:
        return math.nan
    outer = max(whole.faces, key=lambda face: area(Region((Face(face.outer),)))).outer
    center = measure(Region((Face(outer),))).centroid
    steps = np.linspace(0.0, 1.0, _SAMPLES)
    away = np.concatenate([np.hypot(*(points(p, steps) - center).T) for p in outer.pieces])
    beyond = away > (away.min() + away.max()) / 2
    return float(np.count_nonzero(beyond & ~np.roll(beyond, 1)))


def battlements(whole: Region) -> float:
    """Counts the pieces of material at the top."""
    if not whole:
        return math.nan
    left, bottom, right, top = region_bounds(whole)
    high = top - _BELOW_TOP * (top - bottom)
    low = high - 1e-3 * (top - bottom)
    corners = [(left - 1, low), (right + 1, low), (right + 1, high), (left - 1, high)]
    band = Loop(tuple(Line(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)))
    return float(len(common(whole, Region((Face(band),))).faces))


MEASURES: Mapping[str, Callable[[Region], float]] = {
    "pieces": pieces,
    "symmetry": symmetry,
    "openings": openings,
    "teeth": teeth,
    "battlements": battlements,
}
"""Each of what all bodies cover together."""


def _size(whole: Region) -> float:
    left, bottom, right, top = region_bounds(whole)
    return max(right - left, top - bottom)

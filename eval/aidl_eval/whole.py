"""Measures of a whole drawing that the language has no words for, by their names in prompts."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from aidl_eval import shapes
from aidl_eval.regions import FINE, Regions
from aidl_lang.geometry.boolean import common, region_distance
from aidl_lang.geometry.intersect import near_pairs
from aidl_lang.geometry.network import Joined
from aidl_lang.geometry.region import Face, Region, measure, polygon_area

_NEAR = 0.02
"""Distance, as a share of the drawing, up to which parts hold together."""
_BELOW_TOP = 0.03
"""Distance from its top at which a drawing is cut to count battlements, as a share of its height."""
_SLIVER = 0.004
"""Width, as a share of the drawing's size, up to which something is too small to be counted."""
_ALIKE = 0.05
"""Relative difference up to which sizes are one."""
_ROUND = 0.06
"""Difference from a disc's area up to which an outline is round: a twelve-sided one is."""
_SAMPLES = 48
"""Points on a curve at which the distance from the centre is measured."""


def pieces(drawn: Regions) -> float:
    """Counts the groups of material further apart than a fiftieth of the drawing's size."""
    faces = [Region((face,)) for face in drawn.whole.faces]
    joined, reach = Joined(), _NEAR * drawn.size
    for i, j in near_pairs([face.box for face in faces], reach):
        if joined.root(i) != joined.root(j):
            closest = region_distance(faces[i], faces[j])
            if closest is not None and closest[0] <= reach:
                joined.join(i, j)
    return float(len(joined.groups(range(len(faces)))))


def symmetry(drawn: Regions) -> float:
    """Returns the share of the area covered by its mirror image about the upright through the centroid."""
    whole = drawn.whole
    axis = measure(whole).centroid[0]
    image = [(p * (-1.0, 1.0) + (2 * axis, 0.0))[::-1] for p in whole.polygons(FINE * drawn.size)]
    return common(whole, shapes.region(image, "NonZero")).area / whole.area


def openings(drawn: Regions) -> float:
    """Counts the holes that material surrounds. Gaps between outlines that were to touch do not count."""
    holes = [hole for face in drawn.whole.faces for hole in face.holes]
    return float(sum(abs(hole.area) > (_SLIVER * drawn.size) ** 2 for hole in holes))


def teeth(drawn: Regions) -> float:
    """Counts how often the outermost outline crosses the circle halfway between its least and greatest
    distance from its centre, out and back.
    """
    filled = [Region((Face(face.outer),)) for face in drawn.whole.faces]
    outer = max(filled, key=lambda region: region.area)
    center, steps = measure(outer).centroid, np.linspace(0.0, 1.0, _SAMPLES)
    away = np.concatenate([np.hypot(*(p.points(steps) - center).T) for p in outer.faces[0].outer.pieces])
    if np.ptp(away) <= _SLIVER * drawn.size:
        return 0.0
    beyond = away > (away.min() + away.max()) / 2
    return float(np.count_nonzero(beyond & ~np.roll(beyond, 1)))


def battlements(drawn: Regions) -> float:
    """Counts the pieces of material at the top."""
    return float(len(_across(drawn, 1 - _BELOW_TOP).faces))


def rounds(drawn: Regions) -> float:
    """Returns the size of the largest group of round outlines of one size: discs and holes of any part."""
    return _largest_group([(o.width, o.height) for o in _outlines(drawn) if o.is_round])


def alike(drawn: Regions) -> float:
    """Returns the size of the largest group of outlines of one width, height and area."""
    return _largest_group([(o.width, o.height, math.sqrt(o.area)) for o in _outlines(drawn)])


def fields(drawn: Regions) -> float:
    """Counts the closed fields that are seen: areas of one part each, with what lies above taken away, and
    openings that material surrounds. Slivers do not count.
    """
    faces = [face for region in drawn.visible for face in region.faces]
    least = (_SLIVER * drawn.size) ** 2
    return float(sum(Region((face,)).area > least for face in faces)) + openings(drawn)


def fullness(drawn: Regions) -> float:
    """Returns the share of its box that the silhouette covers."""
    return drawn.whole.area / (_side(0, drawn) * _side(1, drawn))


def _side(axis: int, drawn: Regions) -> float:
    return drawn.whole.box[axis + 2] - drawn.whole.box[axis]


def _width_at(share: float, drawn: Regions) -> float:
    """Returns how wide the silhouette is at a share of its height, as a share of its whole width; from the
    first material on the left to the last on the right.
    """
    met = _across(drawn, share)
    return (met.box[2] - met.box[0]) / _side(0, drawn) if met else 0.0


def _across(drawn: Regions, share: float) -> Region:
    """Returns a thin band of the silhouette from a share of its height on."""
    left, bottom, right, top = drawn.whole.box
    low = bottom + share * (top - bottom)
    high = low + 1e-3 * (top - bottom)
    band = np.array([(left - 1, low), (right + 1, low), (right + 1, high), (left - 1, high)])
    return common(drawn.whole, shapes.region([band]))


class _Outline(NamedTuple):
    width: float
    height: float
    area: float
    is_round: bool


def _outlines(drawn: Regions) -> Iterator[_Outline]:
    """Yields the outlines of all parts, holes among them, that are not slivers."""
    for polygon in (polygon for outlines in drawn.outlines for polygon in outlines):
        width, height = np.ptp(polygon, axis=0)
        if min(width, height) <= _SLIVER * drawn.size:
            continue
        covered = abs(polygon_area(polygon))
        around = float(np.hypot(*(np.roll(polygon, -1, axis=0) - polygon).T).sum())
        is_round = (
            abs(width - height) <= _ALIKE * max(width, height)
            and abs(covered / (math.pi / 4 * width * height) - 1) <= _ROUND
            and 4 * math.pi * covered / around**2 >= 1 - _ROUND / 2
        )
        yield _Outline(float(width), float(height), covered, is_round)


def _largest_group(sizes: Sequence[tuple[float, ...]]) -> float:
    """Returns the most of some sizes that agree with one of them."""
    table = np.array(sizes)
    if not len(table):
        return 0.0
    near = np.abs(table[:, None] - table[None]) <= _ALIKE * np.maximum(table[:, None], table[None])
    return float(near.all(axis=2).sum(axis=1).max())


_Measure = Callable[[Regions], float]


def _of_material(measure: _Measure) -> _Measure:
    """Returns a measure that is NaN where there is nothing to measure."""
    return lambda drawn: measure(drawn) if drawn.whole else math.nan


MEASURES: Mapping[str, _Measure] = {
    "width": _of_material(partial(_side, 0)),
    "height": _of_material(partial(_side, 1)),
    "pieces": pieces,
    "symmetry": _of_material(symmetry),
    "openings": openings,
    "teeth": _of_material(teeth),
    "battlements": _of_material(battlements),
    "rounds": rounds,
    "alike": alike,
    "fields": fields,
    "fullness": _of_material(fullness),
    "width_at_bottom": _of_material(partial(_width_at, 0.05)),
    "width_at_quarter": _of_material(partial(_width_at, 0.25)),
    "width_at_middle": _of_material(partial(_width_at, 0.5)),
    "width_at_three_quarters": _of_material(partial(_width_at, 0.75)),
    "width_at_top": _of_material(partial(_width_at, 0.95)),
}
"""Each of all that is drawn as areas, in any language."""

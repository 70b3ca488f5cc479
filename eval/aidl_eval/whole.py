"""Measures of a whole drawing that the language has no words for, by their names in prompts."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from aidl_eval.regions import Regions
from aidl_lang.geometry.boolean import common, region_distance
from aidl_lang.geometry.curves import Line, inward
from aidl_lang.geometry.intersect import near_pairs
from aidl_lang.geometry.network import Joined
from aidl_lang.geometry.region import Face, Loop, Region, measure, polygon_area

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


def pieces(whole: Region) -> float:
    """Counts the groups of material further apart than a fiftieth of the drawing's size."""
    faces = [Region((face,)) for face in whole.faces]
    joined, reach = Joined(), _NEAR * _size(whole)
    for i, j in near_pairs([face.box for face in faces], reach):
        if joined.root(i) != joined.root(j):
            closest = region_distance(faces[i], faces[j])
            if closest is not None and closest[0] <= reach:
                joined.join(i, j)
    return float(len(joined.groups(range(len(faces)))))


def symmetry(whole: Region) -> float:
    """Returns the share of the area covered by its mirror image about the upright through the centroid."""
    if not whole:
        return math.nan
    x = measure(whole).centroid[0]
    return common(_seen(whole, x, mirrored=False), _seen(whole, x, mirrored=True)).area / whole.area


def _seen(region: Region, x: float, *, mirrored: bool) -> Region:
    def turned(loop: Loop) -> Loop:
        return Loop(tuple(inward(piece, (x, 0.0), 0.0, mirrored) for piece in loop.pieces), loop.reversed)

    return Region(tuple(Face(turned(f.outer), tuple(map(turned, f.holes))) for f in region.faces))


def openings(whole: Region) -> float:
    """Counts the holes that material surrounds. Gaps between outlines that were to touch do not count."""
    if not whole:
        return 0.0
    least = (_SLIVER * _size(whole)) ** 2
    return float(sum(abs(hole.area) > least for face in whole.faces for hole in face.holes))


def teeth(whole: Region) -> float:
    """Counts how often the outermost outline crosses the circle halfway between its least and greatest
    distance from its centre, out and back.
    """
    if not whole:
        return math.nan
    outer = max(whole.faces, key=lambda face: Region((Face(face.outer),)).area).outer
    center = measure(Region((Face(outer),))).centroid
    steps = np.linspace(0.0, 1.0, _SAMPLES)
    away = np.concatenate([np.hypot(*(p.points(steps) - center).T) for p in outer.pieces])
    beyond = away > (away.min() + away.max()) / 2
    return float(np.count_nonzero(beyond & ~np.roll(beyond, 1)))


def battlements(whole: Region) -> float:
    """Counts the pieces of material at the top."""
    if not whole:
        return math.nan
    left, bottom, right, top = whole.box
    height = 1e-3 * (top - bottom)
    low = top - _BELOW_TOP * (top - bottom) - height
    return float(len(common(whole, _band((left, right), low, height)).faces))


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
    return float(sum(Region((face,)).area > least for face in faces)) + openings(drawn.whole)


def fullness(drawn: Regions) -> float:
    """Returns the share of its box that the silhouette covers."""
    if not drawn.whole:
        return math.nan
    left, bottom, right, top = drawn.whole.box
    return drawn.whole.area / ((right - left) * (top - bottom))


def width_at(drawn: Regions, share: float) -> float:
    """Returns how wide the silhouette is at a share of its height, as a share of its whole width; from the
    first material on the left to the last on the right.
    """
    if not drawn.whole:
        return math.nan
    left, bottom, right, top = drawn.whole.box
    y = bottom + share * (top - bottom)
    met = common(drawn.whole, _band((left, right), y, 1e-3 * (top - bottom)))
    if not met:
        return 0.0
    low, _, high, _ = met.box
    return (high - low) / (right - left)


@dataclass(frozen=True)
class _Outline:
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


def _side(drawn: Regions, axis: int) -> float:
    box = drawn.whole.box if drawn.whole else (math.nan,) * 4
    return box[axis + 2] - box[axis]


MEASURES: Mapping[str, Callable[[Regions], float]] = {
    "width": lambda drawn: _side(drawn, 0),
    "height": lambda drawn: _side(drawn, 1),
    "pieces": lambda drawn: pieces(drawn.whole),
    "symmetry": lambda drawn: symmetry(drawn.whole),
    "openings": lambda drawn: openings(drawn.whole),
    "teeth": lambda drawn: teeth(drawn.whole),
    "battlements": lambda drawn: battlements(drawn.whole),
    "rounds": rounds,
    "alike": alike,
    "fields": fields,
    "fullness": fullness,
    "width_at_bottom": lambda drawn: width_at(drawn, 0.05),
    "width_at_quarter": lambda drawn: width_at(drawn, 0.25),
    "width_at_middle": lambda drawn: width_at(drawn, 0.5),
    "width_at_three_quarters": lambda drawn: width_at(drawn, 0.75),
    "width_at_top": lambda drawn: width_at(drawn, 0.95),
}
"""Each of all that is drawn as areas, in any language."""


def _band(across: tuple[float, float], low: float, height: float) -> Region:
    (left, right), high = across, low + height
    corners = [(left - 1, low), (right + 1, low), (right + 1, high), (left - 1, high)]
    return Region(
        (Face(Loop(tuple(Line(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)))),)
    )


def _size(whole: Region) -> float:
    left, bottom, right, top = whole.box
    return max(right - left, top - bottom)

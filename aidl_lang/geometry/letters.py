"""The areas of letters that a drawing fills, with their counters open; letters with overlapping contours
united; letters of stencils, with bridges to what they enclose.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.boolean import common, without
from aidl_lang.geometry.curves import (
    Bezier,
    Line,
    Piece,
    all_bounds,
    ends,
    larger_side,
    reverse,
    union_bounds,
)
from aidl_lang.geometry.nearness import near_rows
from aidl_lang.geometry.network import RELATIVE_TOLERANCE, Network, with_finer_chords
from aidl_lang.geometry.region import Face, Loop, Region, loop_area, region_bounds
from aidl_lang.geometry.sections import closed_loop, faces_of, filled, first_point, trace

if TYPE_CHECKING:
    from aidl_lang.common.font_files import Curve


def lettered_region(letters: Sequence[Sequence[Piece]]) -> Region | None:
    """Returns the region of letters whose contours follow one another, do not cross, and turn one way and the
    other where they are nested: nothing need be arranged for it. None if one is open, or two may meet.
    """
    boxes = [union_bounds(all_bounds(letter)) for letter in letters]
    tolerance = RELATIVE_TOLERANCE * larger_side(union_bounds(boxes))
    if len(near_rows(boxes, tolerance)):
        return None
    faces: list[Face] = []
    for letter in letters:
        checkpoint()
        contours = list(_contours(letter))
        if any(ends(contour[0])[0] != ends(contour[-1])[1] for contour in contours):
            return None
        areas = [loop_area(Loop(contour)) for contour in contours]
        sense = math.copysign(1.0, max(areas, key=abs))
        turned = [c if sense > 0 else tuple(reverse(piece) for piece in reversed(c)) for c in contours]
        loops = (closed_loop(contour, tolerance) for contour in turned)
        faces += faces_of([(sense * area, loop) for area, loop in zip(areas, loops, strict=True)])
    return Region(tuple(sorted(faces, key=lambda face: first_point(face.outer))))


@lru_cache(maxsize=512)
def united(outline: tuple[Curve, ...]) -> tuple[Curve, ...]:
    """Returns the outline of what the contours of a character enclose together, by the non-zero rule."""
    network = Network([Line(*c) if len(c) == 2 else Bezier(*c) for c in outline])

    def traced() -> Region:
        return trace(network, filled(network, _contours(network.curves), 0, "NonZero")).region

    return tuple(_points(piece) for piece in with_finer_chords(network, traced).pieces)


_ROUNDS = 4
"""How often what is still enclosed gets bridges: a ring in a ring needs two."""


@lru_cache(maxsize=512)
def stencilled(outline: tuple[Curve, ...], width: float) -> tuple[Curve, ...]:
    """Returns the outline of a character through which bridges lead to all that it encloses: upright ones of
    that width, above and below the middle of each counter, through the strokes next to it.
    """
    region = lettered_region([[Line(*c) if len(c) == 2 else Bezier(*c) for c in outline]]) or Region()
    for wider in range(_ROUNDS):
        counters = [hole for face in region.faces for hole in face.holes]
        if not counters:
            break
        beyond = width * 2**wider
        region = without(region, *(bar for hole in counters for bar in _bridges(region, hole, width, beyond)))
    return tuple(_points(piece) for piece in region.pieces)


def _bridges(region: Region, counter: Loop, width: float, beyond: float) -> Iterator[Region]:
    """Yields the areas of a letter to be taken away for a counter. They reach `beyond` the far side of a
    stroke, which may be slanted, but no further than half of the way to the next one.
    """
    left, low, right, high = region_bounds(Region((Face(counter),)))
    x, middle = (left + right) / 2, (low + high) / 2
    _, bottom, _, top = region_bounds(region)
    line = _rectangle(x - 1e-3 * width, bottom - width, x + 1e-3 * width, top + width)
    strokes = sorted(region_bounds(Region((face,)))[1::2] for face in common(region, line).faces)
    above = [stroke for stroke in strokes if stroke[0] > middle]
    below = [stroke for stroke in reversed(strokes) if stroke[1] < middle]
    if above:
        end = min([above[0][1] + beyond, *((above[0][1] + next_low) / 2 for next_low, _ in above[1:2])])
        yield _rectangle(x - width / 2, middle, x + width / 2, end)
    if below:
        end = max([below[0][0] - beyond, *((below[0][0] + next_high) / 2 for _, next_high in below[1:2])])
        yield _rectangle(x - width / 2, end, x + width / 2, middle)


def _rectangle(left: float, bottom: float, right: float, top: float) -> Region:
    corners = ((left, bottom), (right, bottom), (right, top), (left, top))
    return Region((Face(Loop(tuple(Line(a, b) for a, b in pairwise((*corners, corners[0]))))),))


def _points(piece: Piece) -> Curve:
    if isinstance(piece, Bezier):
        return piece.p0, piece.p1, piece.p2, piece.p3
    assert isinstance(piece, Line)
    return piece.start, piece.end


def _contours(outline: Sequence[Piece]) -> Iterator[tuple[Piece, ...]]:
    """Yields the runs of curves of which each begins where the one before it ends."""
    first = 0
    for k, piece in enumerate(outline):
        is_closed = ends(outline[first])[0] == ends(piece)[1]
        if is_closed or k + 1 == len(outline) or ends(outline[k + 1])[0] != ends(piece)[1]:
            yield tuple(outline[first : k + 1])
            first = k + 1

"""The areas of letters that a drawing fills, with their counters open; letters with overlapping contours
united; letters of stencils, with bridges to what they enclose.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import pairwise

import numpy as np

from aidl_lang.common.font_files import Curve
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.boolean import common, without
from aidl_lang.geometry.curves import Bezier, Line, Piece
from aidl_lang.geometry.evaluate import ends, points, reverse
from aidl_lang.geometry.measures import loop_area, region_bounds
from aidl_lang.geometry.nearness import inside
from aidl_lang.geometry.network import Network, with_finer_chords
from aidl_lang.geometry.region import Face, Loop, Region
from aidl_lang.geometry.sections import fill
from aidl_lang.geometry.trace import trace

_STEPS = np.linspace(0, 1, 9)


def letter_faces(outline: Sequence[Piece]) -> tuple[Face, ...]:
    """Returns the faces of one character, whose contours follow one another and alternate where they are
    nested; none if one of them is open.
    """
    checkpoint()
    contours = list(_contours(outline))
    if any(ends(contour[0])[0] != ends(contour[-1])[1] for contour in contours):
        return ()
    around = _nesting(contours)
    holes: dict[int, list[Loop]] = {k: [] for k, outer in enumerate(around) if len(outer) % 2 == 0}
    for k, outer in enumerate(around):
        if k not in holes:
            # Of the contours around a hole that are no holes, the innermost has the most around itself.
            holder = max((other for other in outer if other in holes), key=lambda other: len(around[other]))
            holes[holder].append(_turning(contours[k], -1.0))
    return tuple(Face(_turning(contours[k], 1.0), tuple(inner)) for k, inner in holes.items())


@lru_cache(maxsize=512)
def united(outline: tuple[Curve, ...]) -> tuple[Curve, ...]:
    """Returns the outline of what the contours of a character enclose together, by the non-zero rule."""
    network = Network([Line(*c) if len(c) == 2 else Bezier(*c) for c in outline])
    numbers = {id(curve): number for number, curve in enumerate(network.curves)}
    contours = [[numbers[id(piece)] for piece in contour] for contour in _contours(network.curves)]

    def traced() -> Region:
        uses = [[use for number in contour for use in network.uses[number]] for contour in contours]
        return trace(network, fill([network.polyline(u) for u in uses if u], "NonZero")).region

    region = with_finer_chords(network, traced)
    return tuple(_points(piece) for piece in region.pieces)


_ROUNDS = 4
"""How often what is still enclosed gets bridges: a ring in a ring needs two."""


@lru_cache(maxsize=512)
def stencilled(outline: tuple[Curve, ...], width: float) -> tuple[Curve, ...]:
    """Returns the outline of a character through which bridges lead to all that it encloses: upright ones of
    that width, above and below the middle of each counter, through the strokes next to it.
    """
    region = Region(letter_faces([Line(*c) if len(c) == 2 else Bezier(*c) for c in outline]))
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


def _nesting(contours: Sequence[Sequence[Piece]]) -> list[list[int]]:
    """Returns for each contour the numbers of those that it lies in."""
    if len(contours) == 1:
        return [[]]
    polygons = [np.concatenate([points(piece, _STEPS)[:-1] for piece in contour]) for contour in contours]
    spots = np.array([polygon[0] for polygon in polygons])
    within = [inside([polygon], spots) for polygon in polygons]
    return [
        [other for other in range(len(contours)) if other != k and within[other][k]]
        for k in range(len(contours))
    ]


def _turning(contour: tuple[Piece, ...], sense: float) -> Loop:
    """Returns a contour as a loop, counter-clockwise if `sense` is positive."""
    loop = Loop(contour)
    if loop_area(loop) * sense < 0:
        return Loop(tuple(reverse(piece) for piece in reversed(contour)))
    return loop

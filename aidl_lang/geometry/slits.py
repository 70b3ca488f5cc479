"""Straight gaps about as wide as the cut of a machine, which makes them in one pass along their middle."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Line, Piece, Vec
from aidl_lang.geometry.evaluate import point
from aidl_lang.geometry.region import Face, Loop, Region

WIDEST = 1.5
"""Width of a gap, in cuts, up to which the second of two passes would burn most of the first again."""
_SLENDER = 3
"""Length of a slit in widths: a shorter gap is a hole."""
_PARALLEL = 1e-6


@record()
class Slit:
    """The way of a cut, and how wide the gap was drawn, mm."""

    way: Line
    width: float


def without_slits(region: Region, cut: float) -> tuple[Region, list[Slit]]:
    """Returns a region with the gaps filled that one pass of a cut makes, and these: narrow holes, and such
    as are open at the border of the region.
    """
    slits: list[Slit] = []
    faces = []
    for face in region.faces:
        outer, *holes = (_without(loop, cut, slits, is_hole=loop is not face.outer) for loop in face.loops)
        assert outer is not None
        faces.append(Face(outer, tuple(hole for hole in holes if hole is not None)))
    return (Region(tuple(faces)) if slits else region), slits


def _without(loop: Loop, cut: float, slits: list[Slit], *, is_hole: bool) -> Loop | None:
    """Returns an outline without its slits, which are added to those found; None for a hole that is one."""
    pieces = loop.pieces
    if is_hole and len(pieces) == 4:
        for k in (0, 1):
            a, tip, b, end = (*pieces[k:], *pieces[:k])
            if (slit := _slit((a, tip, b), cut, point(end, 0.5), -cut / 2)) is not None:
                slits.append(slit)
                return None
    first = next((k for k in (-2, -1) if _open(pieces[k:] + pieces[:k], cut) is not None), 0)
    rest, kept, found = list(pieces[first:] + pieces[:first])[::-1], list[Piece](), len(slits)
    while rest:
        opened = _open(rest[:-4:-1], cut)
        if opened is None:
            kept.append(rest.pop())
            continue
        slit, mouth = opened
        slits.append(slit)
        kept.append(mouth)
        del rest[-3:]
    return replace(loop, pieces=tuple(kept)) if len(slits) > found else loop


def _open(pieces: Sequence[Piece], cut: float) -> tuple[Slit, Line] | None:
    """Returns the slit that the first three pieces of an outline are, and its mouth."""
    if len(pieces) < 3 or not isinstance(pieces[0], Line) or not isinstance(pieces[2], Line):
        return None
    mouth = Line(pieces[0].start, pieces[2].end)
    slit = _slit(pieces[:3], cut, point(mouth, 0.5), cut / 2)
    return None if slit is None else (slit, mouth)


def _slit(sides: Sequence[Piece], cut: float, end: Vec, beyond: float) -> Slit | None:
    """Returns the slit between two sides and the tip between them, if they are lines and near enough. Its way
    begins half a cut within the tip, and ends beyond its other end.
    """
    a, tip, b = sides
    if not isinstance(a, Line) or not isinstance(b, Line):
        return None
    (ax, ay), (bx, by) = ((s.end[0] - s.start[0], s.end[1] - s.start[1]) for s in (a, b))
    long, other = math.hypot(ax, ay), math.hypot(bx, by)
    across = (b.start[0] - a.end[0], b.start[1] - a.end[1])
    # Material lies to the left of an outline, so that the way around a gap turns to the right.
    width = (ay * across[0] - ax * across[1]) / long
    if not 0 < width <= WIDEST * cut or min(long, other) < _SLENDER * max(width, cut):
        return None
    if abs(ax * by - ay * bx) > _PARALLEL * long * other or ax * bx + ay * by > 0:
        return None
    x, y = start = point(tip, 0.5)
    far = math.dist(start, end)
    ux, uy = (end[0] - x) / far, (end[1] - y) / far
    ends = (x + ux * cut / 2, y + uy * cut / 2), (end[0] + ux * beyond, end[1] + uy * beyond)
    return Slit(Line(*ends), width)

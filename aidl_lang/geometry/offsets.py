"""Regions grown, shrunk and drawn with a thick pen: exact sums of curves and discs.

Every offset is the region with its strips and wedges (see `strips`) united or cut off by the booleans that
all drawings use. So whatever crosses itself, splits or vanishes comes out as it must.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from aidl_lang.geometry.boolean import section_of
from aidl_lang.geometry.curves import Arc, Circle, Line, Piece, Vec
from aidl_lang.geometry.evaluate import bounds, ends, is_closed
from aidl_lang.geometry.finishing import direction
from aidl_lang.geometry.network import Network, union_bounds, with_finer_chords
from aidl_lang.geometry.region import Face, Loop, Region
from aidl_lang.geometry.sections import difference, fill, union
from aidl_lang.geometry.strips import Strip, beside, cap, disc, wedge
from aidl_lang.geometry.trace import trace

NEAR = 1e-6
"""Ends that are closer, relative to the size of what they belong to, are one point."""


def offset(region: Region, distance: float, sharp: bool = True) -> Region:
    """Returns all points within a distance of the region; for a negative one, the region without its
    border.
    """
    if distance == 0 or not region:
        return region
    strips: list[Strip] = []
    loops: list[Loop] = []
    for loop in region.loops:
        left = distance if loop.reversed else -distance  # material lies to the left
        parts: list[Piece] = []
        for piece, along, corner in _along(loop.pieces, left, sharp):
            strips += along + corner
            # Cut where its strips are, so that the outline and they have the same curves.
            is_whole = isinstance(piece, Line | Arc | Circle)
            parts += [piece] if is_whole else [strip[0][0] for strip in along]
        loops.append(Loop(tuple(parts), loop.reversed))
    # Loops are only filled together here, so that they may all count as outer ones.
    return _combined(Region(tuple(map(Face, loops))), strips, cut=distance < 0)


def _along(
    pieces: Sequence[Piece], left: float, sharp: bool
) -> Iterator[tuple[Piece, list[Strip], list[Strip]]]:
    """Yields each piece of a closed outline with the strips on one side of it, and that at its end."""
    for piece, after in zip(pieces, (*pieces[1:], pieces[0]), strict=True):
        corner = None
        if not is_closed(piece):
            corner = wedge(ends(piece)[1], direction(piece, 1.0), direction(after, 0.0), left, sharp)
        yield piece, list(beside(piece, left)), [] if corner is None else [corner]


def thick(curves: Sequence[Piece], width: float, caps: str = "round", sharp: bool = False) -> Region:
    """Returns the region that a pen of a width draws along curves; where more than two meet, the joint is
    round.
    """
    half = width / 2
    left, bottom, right, top = union_bounds([bounds(c) for c in curves])
    near = NEAR * (max(right - left, top - bottom) or 1.0)
    strips: list[Strip] = [s for c in curves for side in (half, -half) for s in beside(c, side)]
    for at, leaving in _joints(curves, near):
        if len(leaving) > 2:
            strips.append(disc(at, half))
        elif len(leaving) == 2:
            a, b = leaving
            found = [wedge(at, (-a[0], -a[1]), b, side, sharp) for side in (half, -half)]
            strips += [s for s in found if s is not None]
        else:
            (a,) = leaving
            end = cap(at, (-a[0], -a[1]), half, caps)
            strips += [end] if end is not None else []
    return _combined(Region(), strips, cut=False)


def _joints(curves: Sequence[Piece], near: float) -> list[tuple[Vec, list[Vec]]]:
    """Returns the points where open curves end, with the directions in which they leave them."""
    found: list[tuple[Vec, list[Vec]]] = []
    for curve in curves:
        if is_closed(curve):
            continue
        (start, end), (dx, dy) = ends(curve), direction(curve, 1.0)
        for p, way in ((start, direction(curve, 0.0)), (end, (-dx, -dy))):
            ways = next((w for q, w in found if math.dist(p, q) <= near), None)
            if ways is None:
                found.append((p, [way]))
            else:
                ways.append(way)
    return found


def _combined(region: Region, strips: Sequence[Strip], *, cut: bool) -> Region:
    """Returns a region with strips added to it or taken off."""
    pieces = [p for loop in region.loops for p in loop.pieces]
    number = len(pieces)
    pieces += [p for strip in strips for outline in strip for p in outline]
    network = Network(pieces)

    def traced() -> Region:
        place = number
        sections = []
        for strip in strips:
            polygons = []
            for outline in strip:
                uses = [u for k in range(len(outline)) for u in network.uses[place + k]]
                place += len(outline)
                if uses:
                    polygons.append(network.polyline(uses))
            # Normals of a curve that bends closely cross: all that a single outline goes around counts.
            sections.append(fill(polygons, "NonZero" if len(strip) == 1 else "EvenOdd"))
        base, added = section_of(network, region, 0), union(sections)
        return trace(network, difference(base, added) if cut else union([base, added])).region

    return with_finer_chords(network, traced)

"""Outlines of other languages as regions, and their pictures in the style of AIDL's drawings."""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.export import Options, palette
from aidl_lang.export import render as render_picture
from aidl_lang.export.marks import Area, Group, Ink, Picture
from aidl_lang.export.picture import MARGIN, OUTLINE_WIDTH
from aidl_lang.geometry.curves import Line
from aidl_lang.geometry.measures import region_bounds
from aidl_lang.geometry.region import Face, Loop, Region
from aidl_lang.geometry.sections import Polygon, fill
from aidl_lang.geometry.tessellate import polygon_area

PIXELS = 512
"""Larger side of the pictures."""


def region(outlines: Sequence[Polygon]) -> Region:
    """Returns the region inside an odd number of the outlines."""
    return Region(tuple(_face(part.to_polygons()) for part in fill(outlines, "EvenOdd").decompose()))


def _face(polygons: Sequence[Polygon]) -> Face:
    """Returns one connected area from its outlines; only the outer one runs counter-clockwise."""
    outer, *holes = sorted(polygons, key=polygon_area, reverse=True)
    return Face(_loop(outer), tuple(map(_loop, holes)))


def _loop(polygon: Polygon) -> Loop:
    corners = [(float(x), float(y)) for x, y in polygon]
    return Loop(tuple(Line(a, b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)))


def png(drawn: Region) -> bytes:
    """Draws a region that is not empty."""
    left, bottom, right, top = region_bounds(drawn)
    size = max(right - left, top - bottom)
    ink = Ink(palette.OUTLINE, OUTLINE_WIDTH * size, is_round=True)
    areas = tuple(Area(face, palette.body_fill(0), ink) for face in drawn.faces)
    margin = MARGIN * size
    box = (left - margin, bottom - margin, right + margin, top + margin)
    return render_picture(Picture(box, (Group("drawing", areas),)), ".png", Options(pixels=PIXELS))

"""Pictures of what a program draws in any language: in its own colours, and in one style for all."""

from __future__ import annotations

from collections.abc import Iterator

from aidl_eval.regions import Regions
from aidl_eval.shapes import PIXELS
from aidl_lang.export import render as render_picture
from aidl_lang.export.job import Options
from aidl_lang.export.marks import OUTLINE, Area, Curves, Group, Ink, Mark, Picture, body_fill, outline_of
from aidl_lang.export.picture import MARGIN, OUTLINE_WIDTH
from aidl_lang.geometry.curves import union_bounds

_NEUTRAL, _EDGE = "#c9ced6", "#2b2f36"
"""The one fill, and the ink of all edges."""


def neutral(drawn: Regions) -> bytes:
    """Returns a PNG in the one style: one fill for all parts, outer and inner edges alike, no colours."""
    return _png(drawn, [_NEUTRAL] * len(drawn.parts), [_EDGE] * len(drawn.parts))


def colored(drawn: Regions) -> bytes:
    """Returns a PNG in the colours that the program gives; without one, in those of AIDL's drawings."""
    fills = [part.color or body_fill(number) for number, part in enumerate(drawn.parts)]
    edges = [
        outline_of(fill) if part.color else OUTLINE for fill, part in zip(fills, drawn.parts, strict=True)
    ]
    return _png(drawn, fills, edges)


def _png(drawn: Regions, fills: list[str], edges: list[str]) -> bytes:
    boxes = [part.region.box for part in drawn.parts]
    boxes += [piece.box for line in drawn.lines for piece in line]
    left, bottom, right, top = union_bounds(boxes)
    size = max(right - left, top - bottom) or 1.0
    margin = MARGIN * size
    box = (left - margin, bottom - margin, right + margin, top + margin)
    marks = tuple(_marks(drawn, fills, edges, OUTLINE_WIDTH * size))
    return render_picture(Picture(box, (Group("drawing", marks),)), ".png", Options(pixels=PIXELS))


def _marks(drawn: Regions, fills: list[str], edges: list[str], width: float) -> Iterator[Mark]:
    for part, fill, edge in zip(drawn.parts, fills, edges, strict=True):
        ink = Ink(edge, width, is_round=True)
        yield from (Area(face, fill, ink) for face in part.region.faces)
    for line in drawn.lines:
        yield Curves(line, Ink(_EDGE, width, is_round=True))

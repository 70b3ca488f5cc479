"""Pictures of what a program draws, in one style for all languages: so nothing in them tells the language."""

from __future__ import annotations

from aidl_eval.regions import Regions
from aidl_lang.export import render
from aidl_lang.export.job import Options
from aidl_lang.export.marks import Area, Curves, Group, Ink, Mark, Picture
from aidl_lang.export.picture import MARGIN, OUTLINE_WIDTH
from aidl_lang.geometry.curves import union_bounds

PIXELS = 512
"""Of the larger side."""
_FILL, _EDGE = "#c9ced6", "#2b2f36"


def png(drawn: Regions) -> bytes:
    """Returns a picture: one grey for all parts, outer and inner edges alike."""
    boxes = [part.box for part in drawn.parts]
    boxes += [piece.box for line in drawn.lines for piece in line]
    left, bottom, right, top = union_bounds(boxes)
    size = max(right - left, top - bottom) or 1.0
    margin = MARGIN * size
    box = (left - margin, bottom - margin, right + margin, top + margin)
    ink = Ink(_EDGE, OUTLINE_WIDTH * size, is_round=True)
    marks: list[Mark] = [Area(face, _FILL, ink) for part in drawn.parts for face in part.faces]
    marks += [Curves(line, ink) for line in drawn.lines]
    return render(Picture(box, (Group("drawing", tuple(marks)),)), ".png", Options(pixels=PIXELS))

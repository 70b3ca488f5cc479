"""Views at their scale, as marks in mm on paper."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from aidl_lang.common.records import record
from aidl_lang.export.dimension_marks import HEIGHT, Pen
from aidl_lang.export.dimensioning import dimensioned_to_scale
from aidl_lang.export.drafting.contents import View
from aidl_lang.export.drafting.lettering import BLACK, NARROW, SMALL, WIDE, written
from aidl_lang.export.marks import Area, Curves, Group, Ink, Mark, Text
from aidl_lang.export.scaling import Placing
from aidl_lang.geometry.curves import Arc, Circle, Line, Piece, Vec
from aidl_lang.geometry.dimensions.completing import mirror_levels
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.geometry.network import union_bounds

_BEYOND = 2.5
"""Centre lines reach so far beyond a circle, mm on paper."""
_CHAIN = (6.0, 1.0, 0.8, 1.0)
_SHORT = 8.0
"""Centre lines up to this length are whole, mm on paper."""
_LABEL = 8.0


@record()
class DrawnView:
    """A view on paper, its lower left corner in the origin; `left` is how many dimensions found no place."""

    width: float
    height: float
    groups: tuple[Group, ...]
    left: int

    def at(self, corner: Vec, number: int) -> tuple[Group, ...]:
        """Returns the groups moved to a place, under names of their own."""
        placing = Placing(1.0, corner)
        return tuple(
            replace(placing.group(group), name=f"view-{number}-{group.name}") for group in self.groups
        )


def drawn_view(view: View, factor: float, digits: float) -> DrawnView:
    """Draws a view. `factor`: millimetres on paper for one of the part; `digits`: height of the values."""
    pen = Pen(digits / HEIGHT / factor)
    box, dimensions, left = dimensioned_to_scale(view.drawing, view.drawing.box, pen, view.wanted)
    centers = tuple(_center_lines(view.drawing, factor))
    outlines = Group("outline", tuple(_outlines(view.drawing, factor)), {"class": "outline"})
    box = union_bounds([box, _grown(view.drawing.box, (_BEYOND + 1) / factor)])
    bottom = _LABEL if view.label else 0.0
    placing = Placing(factor, (-factor * box[0], bottom - factor * box[1]))
    groups = [outlines, Group("centers", centers, {"class": "center"}), *dimensions]
    placed = [placing.group(replace(g, marks=tuple(map(_black, g.marks)))) for g in groups if g.marks]
    width, height = factor * (box[2] - box[0]), factor * (box[3] - box[1]) + bottom
    if view.label:
        label = written(view.label, (width / 2, 0.5), SMALL, "middle")
        placed.append(Group("label", (label,), {"class": "label"}))
    return DrawnView(width, height, tuple(placed), left)


def _grown(box: Bounds, by: float) -> Bounds:
    return box[0] - by, box[1] - by, box[2] + by, box[3] + by


def _outlines(drawing: Drawing, factor: float) -> Iterator[Mark]:
    wide, narrow = Ink(BLACK, WIDE / factor), Ink(BLACK, NARROW / factor)
    for body in drawing.bodies:
        for face in body.region.faces:
            yield Area(face, "#ffffff", wide, "outline")
    for stroke in drawing.strokes:
        yield Curves(stroke.pieces, narrow, stroke.role)


def _center_lines(drawing: Drawing, factor: float) -> Iterator[Curves]:
    """Yields crosses at the centres of all that is round for half a turn or more."""
    largest: dict[tuple[int, int], Circle | Arc] = {}
    slack = 1e-6 * drawing.size
    for body in drawing.bodies:
        for piece in body.region.pieces:
            if isinstance(piece, Circle) or (isinstance(piece, Arc) and abs(piece.sweep) >= math.pi - 1e-6):
                key = round(piece.center[0] / slack), round(piece.center[1] / slack)
                if key not in largest or largest[key].radius < piece.radius:
                    largest[key] = piece
    for body in drawing.bodies if len(drawing.bodies) == 1 else ():
        left, bottom, right, top = _grown(body.box, _BEYOND / factor)
        x, y = mirror_levels(body, slack)
        has_circle = any(
            isinstance(p, Circle) and 2 * p.radius >= 0.999 * (body.box[2] - body.box[0])
            for p in body.region.pieces
        )
        if x is not None and not has_circle:
            yield center_line((x, bottom), (x, top), factor)
        if y is not None and not has_circle:
            yield center_line((left, y), (right, y), factor)
    for piece in largest.values():
        (x, y), reach = piece.center, piece.radius + _BEYOND / factor
        yield center_line((x - reach, y), (x + reach, y), factor)
        yield center_line((x, y - reach), (x, y + reach), factor)


def center_line(start: Vec, end: Vec, factor: float) -> Curves:
    """Returns a chain line, or a whole one if it is short on paper."""
    is_short = factor * math.dist(start, end) <= _SHORT
    dash = None if is_short else tuple(part / factor for part in _CHAIN)
    pieces: tuple[Piece, ...] = (Line(start, end),)
    return Curves(pieces, Ink(BLACK, NARROW / factor, dash), "center")


def _black(mark: Mark) -> Mark:
    """Returns a mark of a dimension in black."""
    match mark:
        case Area(ink=None):
            return replace(mark, fill=BLACK)
        case Curves(ink=ink):
            return replace(mark, ink=replace(ink, color=BLACK))
        case Text():
            return replace(mark, color=BLACK)
    return mark

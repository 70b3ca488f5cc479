"""Views at their scale, as marks in mm on paper."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from aidl_lang.common.records import record
from aidl_lang.export.dimension_marks import HEIGHT, Pen
from aidl_lang.export.dimensioning import Callout, dimensioned_to_scale
from aidl_lang.export.drafting.contents import View
from aidl_lang.export.drafting.tables import BLACK, CAPITAL, NARROW, SMALL, WIDE, width_of, written
from aidl_lang.export.marks import Area, Curves, Group, Ink, Mark, Text
from aidl_lang.export.scaling import Placing
from aidl_lang.geometry.curves import Arc, Circle, Line, Piece, Vec
from aidl_lang.geometry.dimensions.completing import mirror_levels
from aidl_lang.geometry.dimensions.sketch import is_half_round
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.evaluate import Bounds, bounds, point
from aidl_lang.geometry.network import union_bounds

_BEYOND = 2.5
"""Centre lines reach so far beyond a circle, mm on paper."""
_CHAIN = (6.0, 1.0, 0.8, 1.0)
_SHORT = 8.0
"""Centre lines up to this length are whole, mm on paper."""
_LABEL = 8.0
_FREE = "Outline not dimensioned: as in the file"
"""Stands below parts that are made from a DXF, not by hand."""


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
    signs = tuple(_signs(view, factor))
    callouts = [
        Callout(f"item-{number}", str(number), tuple(_spots(body.box, body.region.faces[0].outer.pieces)))
        for number, body in view.balloons
    ]
    callouts += [
        Callout(f"note-{number}", words, tuple(_spots(union_bounds([bounds(p) for p in pieces]), pieces)))
        for number, (words, pieces) in enumerate(view.notes, 1)
    ]
    box, dimensions, left = dimensioned_to_scale(view.drawing, pen, view.wanted, callouts, signs)
    centers = tuple(_center_lines(view.drawing, factor))
    outlines = Group("outline", tuple(_outlines(view.drawing, factor)), {"class": "outline"})
    box = union_bounds([box, _grown(view.drawing.box, (_BEYOND + 1) / factor)])
    words = [view.label] if view.label else []
    words += [_FREE] if view.free else []
    bottom = _LABEL if words else 0.0
    placing = Placing(factor, (-factor * box[0], bottom - factor * box[1]))
    box = union_bounds([box, *(sign.box for sign in signs)])
    signed = Group("holes", (*_datum(view, factor), *signs), {"class": "holes"})
    groups = [outlines, signed, Group("centers", centers, {"class": "center"}), *dimensions]
    placed = [placing.group(replace(g, marks=tuple(map(_black, g.marks)))) for g in groups if g.marks]
    width, height = factor * (box[2] - box[0]), factor * (box[3] - box[1]) + bottom
    if words:
        width = max(width, width_of(". ".join(words), SMALL))
        label = written(". ".join(words), (width / 2, 0.5), SMALL, "middle")
        placed.append(Group("label", (label,), {"class": "label"}))
    return DrawnView(width, height, tuple(placed), left)


def _spots(box: Bounds, pieces: Sequence[Piece]) -> Iterator[tuple[Vec, Vec]]:
    """Yields places on an outline with the way from there to the outside, about."""
    left, bottom, right, top = box
    for piece in pieces:
        for t in (0.5, 0.3, 0.7):
            tip = point(piece, t)
            for turn in (45, 135, -45, -135, 20, 160, 70, 110):
                way = math.cos(math.radians(turn)), math.sin(math.radians(turn))
                out = (tip[0] - (left + right) / 2) * way[0] + (tip[1] - (bottom + top) / 2) * way[1]
                if out > 0:
                    yield tip, way


def _signs(view: View, factor: float) -> Iterator[Text]:
    """Yields the signs of holes, beside them."""
    for hole in view.holes:
        (x, y), reach = hole.circle.center, 0.72 * hole.circle.radius + 0.8 / factor
        yield Text((x + reach, y + reach), hole.sign, SMALL / CAPITAL / factor, BLACK)


def _datum(view: View, factor: float) -> Iterator[Mark]:
    """Yields the axes from whose origin holes are placed, if there is a table of them."""
    if view.holes:
        left, bottom, _, _ = view.drawing.box
        is_corner = abs(view.datum[0] - left) + abs(view.datum[1] - bottom) < 1e-6 * view.drawing.size
        size = SMALL / CAPITAL / factor
        reach, aside = 9.0 / factor, 1.0 / factor
        for way, sign in (((1.0, 0.0), "X"), ((0.0, 1.0), "Y")):
            x, y = (left - 3 * aside, bottom - 3 * aside) if is_corner else view.datum
            end = x + reach * way[0], y + reach * way[1]
            yield Curves((Line((x, y), end),), Ink(BLACK, WIDE / factor), "datum")
            yield Text((end[0] + aside * way[0], end[1] + aside * way[1]), sign, size, BLACK, halo=False)


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
    on_part = [stroke.pieces[0] for stroke in drawing.strokes if len(stroke.pieces) == 1]
    rounds = [piece for body in drawing.bodies for piece in body.region.pieces if is_half_round(piece)]
    for piece in (*rounds, *(piece for piece in on_part if isinstance(piece, Circle))):
        if isinstance(piece, Arc | Circle):
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

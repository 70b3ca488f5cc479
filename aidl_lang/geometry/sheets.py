"""The bodies of a drawing laid flat, apart from one another, on sheets to cut them from.

Bodies are moved and turned by quarters, never mirrored: their front stays up, and every curve is as exact as
before. They are packed by their boxes, or in a time given for it by their outlines. Those of different
material or thickness are cut from different sheets.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.geometry.contacts import Contacts
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.drawing import Body, Drawing, Stroke
from aidl_lang.geometry.engraving import boxes_meet, engraved, owner
from aidl_lang.geometry.evaluate import Bounds, bounds, inward
from aidl_lang.geometry.measures import region_bounds
from aidl_lang.geometry.network import union_bounds
from aidl_lang.geometry.region import Face, Loop, Region
from aidl_lang.geometry.sections import widened
from aidl_lang.geometry.tessellate import Polygon, face_polygons

SPACING = 3.0
"""Millimetres between parts, and between them and the edge of the sheet."""

GRID = 1000
"""Unit of places: whole micrometres, so that sums and comparisons of what is left are exact."""
SLACK = 1e-3
"""Micrometres by which rounding may enlarge a part."""
FEW = 200
"""The most parts for which a slower packer is used, which fills the sheets better."""

COARSE = 0.05
"""Millimetres from an outline to the polygon that stands for it in packing."""

Size = tuple[float, float]
Cell = tuple[int, int]
"""Width and height in micrometres."""


@record()
class Layout:
    """Sheets with their lower left corner in the origin, or none if parts are too large.

    strays    what drawings have beside all bodies; it is on no sheet
    oversize  paths of bodies that do not fit, with their sizes as they fit best
    """

    sheets: tuple[Drawing, ...]
    strays: tuple[Stroke, ...] = ()
    oversize: tuple[tuple[str, Size], ...] = ()


@record()
class _Part:
    """A body with its engraving and the regions of the structures it was made of."""

    body: Body
    strokes: tuple[Stroke, ...]
    regions: dict[str, Region]
    box: Bounds

    @property
    def size(self) -> Size:
        return self.box[2] - self.box[0], self.box[3] - self.box[1]

    def cell(self, gap: int) -> Cell:
        """Returns the size of the part's place on a sheet, with the gap on one side of it each way."""
        return max(1, _ceil(self.size[0])) + gap, max(1, _ceil(self.size[1])) + gap


@record()
class _Place:
    """How a part gets to its sheet: turned by quarters about the origin, then moved by (`x`, `y`), mm."""

    part: _Part
    quarters: int
    x: float
    y: float


def laid_out(drawing: Drawing, sheet: Size, spacing: float = SPACING, nest: float | None = None) -> Layout:
    """Returns all bodies on as few sheets as the packer finds, those of one stock together (sizes in mm).

    They are packed by their boxes and, for `nest` seconds, by their outlines; what uses less is taken.
    """
    on, off = engraved(drawing.bodies, drawing.strokes)
    parts = _parts(drawing, on)
    gap = _ceil(spacing)
    room = _floor(sheet[0]) - gap, _floor(sheet[1]) - gap
    oversize = tuple(
        (part.body.path, part.size)
        for part in parts
        for cell in [part.cell(gap)]
        if not (_fits(cell, room) or _fits(cell[::-1], room))
    )
    if oversize:
        return Layout((), tuple(off), oversize)
    stocks: dict[tuple[str, float], list[_Part]] = {}
    for part in parts:
        style = part.body.style
        stocks.setdefault((style.material or "", style.thickness or 0.0), []).append(part)

    def nesting(group: Sequence[_Part]) -> _Nesting | None:
        return _Nesting(sheet, spacing, nest * len(group) / len(parts)) if nest else None

    return Layout(
        tuple(
            _drawn(drawing, sheet, places)
            for _, group in sorted(stocks.items(), key=lambda item: item[0])
            for places in _packed(group, room, gap, nesting(group))
        ),
        tuple(off),
    )


def _fits(cell: Cell, room: Cell) -> bool:
    return cell[0] <= room[0] and cell[1] <= room[1]


def _ceil(length: float) -> int:
    return math.ceil(length * GRID - SLACK)


def _floor(length: float) -> int:
    return math.floor(length * GRID + SLACK)


def _parts(drawing: Drawing, on: dict[str, list[Stroke]]) -> list[_Part]:
    bodies = {body.path: body for body in drawing.bodies}
    below: dict[str, dict[str, Region]] = {path: {} for path in bodies}
    shared: dict[str, Region] = {}  # holes of an assembly may cut several of its bodies
    for path, region in drawing.regions.items():
        above = owner(bodies, path)
        (shared if above is None else below[above])[path] = region
    parts = []
    for body in drawing.bodies:
        strokes = tuple(on.get(body.path, ()))
        box = union_bounds([body.box, *(bounds(piece) for s in strokes for piece in s.pieces)])
        regions = below[body.path]
        regions |= {p: r for p, r in shared.items() if boxes_meet(region_bounds(r), body.box)}
        parts.append(_Part(body, strokes, regions, box))
    return parts


@record()
class _Nesting:
    """The sheet and the spacing, mm, and the seconds for packing by outlines."""

    sheet: Size
    spacing: float
    seconds: float


def _packed(parts: Sequence[_Part], room: Cell, gap: int, nesting: _Nesting | None) -> list[list[_Place]]:
    """Returns the places on each sheet: by boxes, or by outlines if that saves sheets or room on the last."""
    by_boxes = _in_boxes(parts, room, gap)
    if nesting is None or len(parts) == 1:
        return by_boxes
    by_outlines = _by_outlines(parts, nesting)
    return min(by_boxes, by_outlines, key=_used) if by_outlines else by_boxes


def _used(sheets: Sequence[Sequence[_Place]]) -> tuple[int, float]:
    """Returns the number of sheets, and the width used of the last one."""
    return len(sheets), max(_placed_box(place)[2] for place in sheets[-1])


def _by_outlines(parts: Sequence[_Part], nesting: _Nesting) -> list[list[_Place]]:
    from aidl_lang.geometry.nesting import nested

    # Each outline has half the spacing around it. Chords are inside of what bulges, by less than COARSE.
    outlines = [widened(_outline(part), nesting.spacing / 2 + COARSE) for part in parts]
    room = nesting.sheet[0] - nesting.spacing, nesting.sheet[1] - nesting.spacing
    aside = nesting.spacing / 2
    sheets = nested(outlines, room, nesting.seconds)
    return [
        [_Place(parts[n.number], n.quarters, n.x + aside, n.y + aside) for n in places] for places in sheets
    ]


def _outline(part: _Part) -> Polygon:
    """Returns the outline of a part; its box, if it is in pieces or has engraving beyond its material."""
    faces = part.body.region.faces
    if len(faces) == 1 and part.box == part.body.box:
        return face_polygons(faces[0], COARSE)[0]
    left, bottom, right, top = part.box
    return np.array([(left, bottom), (right, bottom), (right, top), (left, top)])


def _in_boxes(parts: Sequence[_Part], room: Cell, gap: int) -> list[list[_Place]]:
    """Returns the places on each sheet. Parts are turned only if that saves sheets."""
    cells = [part.cell(gap) for part in parts]
    upright = all(_fits(cell, room) for cell in cells)
    bins = _bins(cells, room, turning=False) if upright else []
    if len(bins) != 1:
        turned = _bins(cells, room, turning=True)
        bins = turned if not upright or len(turned) < len(bins) else bins
    return [[_place(parts[r.rid], r, gap) for r in sorted(found, key=lambda r: r.rid)] for found in bins]


def _bins(cells: Sequence[Cell], room: Cell, *, turning: bool) -> list[Any]:
    from rectpack import SORT_LSIDE, PackingBin, PackingMode, newPacker
    from rectpack.maxrects import MaxRectsBl
    from rectpack.skyline import SkylineBl

    packer = newPacker(
        mode=PackingMode.Offline,
        bin_algo=PackingBin.BFF,
        pack_algo=MaxRectsBl if len(cells) <= FEW else SkylineBl,
        sort_algo=SORT_LSIDE,
        rotation=turning,
    )
    packer.add_bin(*room, count=math.inf)
    for number, cell in enumerate(cells):
        packer.add_rect(*cell, rid=number)
    packer.pack()
    return list(packer)


def _place(part: _Part, cell: Any, gap: int) -> _Place:
    """Returns the place with the lower left corner of the part's box in a cell's."""
    quarters = int((cell.width, cell.height) != part.cell(gap))
    box = _turned_box(part.box, quarters)
    return _Place(part, quarters, (cell.x + gap) / GRID - box[0], (cell.y + gap) / GRID - box[1])


def _turned_box(box: Bounds, quarters: int) -> Bounds:
    for _ in range(quarters % 4):  # (x, y) becomes (-y, x)
        box = -box[3], box[0], -box[1], box[2]
    return box


def _placed_box(place: _Place) -> Bounds:
    left, bottom, right, top = _turned_box(place.part.box, place.quarters)
    return left + place.x, bottom + place.y, right + place.x, top + place.y


def _drawn(drawing: Drawing, sheet: Size, places: Sequence[_Place]) -> Drawing:
    """Returns the drawing of one sheet. Seams and plans are not cut, and nothing is filled."""
    bodies, strokes, regions = [], [], dict[str, Region]()
    for place in places:
        part = place.part
        region = _moved_region(part.body.region, place)
        bodies.append(replace(part.body, region=region, box=region_bounds(region)))
        strokes += [replace(s, pieces=tuple(_moved(s.pieces, place)), faces=()) for s in part.strokes]
        for path, below in part.regions.items():
            faces = regions.get(path, Region()).faces
            regions[path] = Region(faces + _moved_region(below, place).faces)
    box = (0.0, 0.0, *sheet)
    return Drawing(tuple(bodies), regions, (), tuple(strokes), (), Contacts(), drawing.styles, box)


def _moved_region(region: Region, place: _Place) -> Region:
    return Region(
        tuple(
            Face(_moved_loop(face.outer, place), tuple(_moved_loop(hole, place) for hole in face.holes))
            for face in region.faces
        )
    )


def _moved_loop(loop: Loop, place: _Place) -> Loop:
    return Loop(tuple(_moved(loop.pieces, place)), loop.reversed)


def _moved(pieces: Sequence[Piece], place: _Place) -> Iterator[Piece]:
    # What is at the place's origin on the sheet is where the curves are seen from.
    x, y = place.x, place.y
    for _ in range(place.quarters % 4):
        x, y = y, -x
    return (inward(piece, (-x, -y), -90.0 * place.quarters, mirrored=False) for piece in pieces)

"""The bodies of a drawing laid flat, apart from one another, on sheets to cut them from."""

from __future__ import annotations

import math
import signal
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from types import FrameType
from typing import TYPE_CHECKING, Any

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Bounds
from aidl_lang.geometry.drawing import Drawing, Stroke
from aidl_lang.geometry.parts import Motion, Part, Size, drawn, gathered, parts_of, upright_turn
from aidl_lang.geometry.region import COARSE, Polygon, polygon_area
from aidl_lang.geometry.sections import widened

if TYPE_CHECKING:
    from spyrrow import Item


# --- Places for outlines on sheets by their true shapes, where packing their boxes would waste material.
#
# The packer (sparrow, through spyrrow) fills a strip of a given height, as short as it can. Here the strip
# is as high as the sheet: what lies within its width is on one sheet, and the rest is packed anew. It
# searches until its time is over, so that how well it does depends on the machine.

SEED = 1
"""Of the packer's random numbers: the same program, time and machine give about the same sheets."""
_SHORTEST = 1
"""Seconds; the packer counts whole ones."""
_FILLED = 0.7
"""Share of a sheet that parts take of it, about."""
_SLACK = 1e-6
"""Millimetres by which sums of places may be off."""


class NestingError(ValueError):
    """Raised if the packer gives up; the message is its own."""


@record()
class Nested:
    """The place of an outline: turned by quarters about the origin, then moved by (`x`, `y`), mm."""

    number: int
    quarters: int
    x: float
    y: float


def turned_box(box: Bounds, quarters: int) -> Bounds:
    """Returns a box turned by quarters about the origin."""
    for _ in range(quarters % 4):  # (x, y) becomes (-y, x)
        box = -box[3], box[0], -box[1], box[2]
    return box


def nested(outlines: Sequence[Polygon], sheet: tuple[float, float], seconds: float) -> list[list[Nested]]:
    """Returns the places of outlines, mm, on each sheet, whose lower left corner is the origin; no sheets if
    an outline is too large for one. Needs the package spyrrow. Raises NestingError.
    """
    from spyrrow import Item

    boxes = [_box(outline) for outline in outlines]
    turns = [_turns(box, sheet) for box in boxes]
    if not all(turns):
        return []
    areas = [polygon_area(outline) for outline in outlines]
    rest = list(range(len(outlines)))
    found: list[list[Nested]] = []
    end = time.monotonic() + seconds
    while rest:
        checkpoint()
        # Each of the sheets that are still to come has its share of the time that is left.
        to_come = math.ceil(sum(areas[k] for k in rest) / (_FILLED * sheet[0] * sheet[1]))
        share = max(_SHORTEST, int((end - time.monotonic()) / to_come))
        items = [Item(str(k), [(float(x), float(y)) for x, y in outlines[k]], 1, turns[k]) for k in rest]
        placed = _strip(items, sheet[1], share)
        here = [p for p in placed if turned_box(boxes[p.number], p.quarters)[2] + p.x <= sheet[0] + _SLACK]
        assert here, "the first part of a strip is no wider than the sheet"
        found.append(sorted(here, key=lambda place: place.number))
        on_it = {place.number for place in here}
        rest = [k for k in rest if k not in on_it]
    return found


def _strip(items: Sequence[Item], height: float, seconds: int) -> list[Nested]:
    """Returns places in a strip of a height that begins at x = 0."""
    from spyrrow import StripPackingConfig, StripPackingInstance

    config = StripPackingConfig(total_computation_time=seconds, num_workers=1, seed=SEED)
    try:
        with _keeping_interrupts():
            solution = StripPackingInstance("", height, items).solve(config)
    except BaseException as reason:  # a panic in Rust is no Exception, and its class cannot be imported
        if type(reason).__name__ != "PanicException":
            raise
        raise NestingError(str(reason)) from None
    return [
        Nested(int(placed.id), round(placed.rotation / 90) % 4, *placed.translation)
        for placed in solution.placed_items
    ]


@contextmanager
def _keeping_interrupts() -> Iterator[None]:
    """Raises at the end what the handler of Ctrl-C raised: the packer stops for it, and swallows it."""
    handler = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(handler):
        yield
        return
    raised: list[BaseException] = []

    def handle(number: int, frame: FrameType | None) -> None:
        try:
            handler(number, frame)
        except BaseException as reason:
            raised.append(reason)
            raise

    signal.signal(signal.SIGINT, handle)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
    for reason in raised:
        raise reason


def _box(outline: Polygon) -> Bounds:
    (left, bottom), (right, top) = outline.min(axis=0), outline.max(axis=0)
    return float(left), float(bottom), float(right), float(top)


def _turns(box: Bounds, sheet: tuple[float, float]) -> list[float]:
    width, height = box[2] - box[0], box[3] - box[1]
    upright = [0.0, 180.0] if width <= sheet[0] and height <= sheet[1] else []
    lying = [90.0, 270.0] if height <= sheet[0] and width <= sheet[1] else []
    return [*upright, *lying]


# --- Bodies lie as their own frames do, and are moved and turned by quarters, never mirrored: their front
# stays up, and every curve is as exact as before. They are packed by their boxes, or in a time given for it
# by their outlines. Those of different material or thickness are cut from different sheets.

SPACING = 3.0
"""Millimetres between parts, and between them and the edge of the sheet."""

GRID = 1000
"""Unit of places: whole micrometres, so that sums and comparisons of what is left are exact."""
SLACK = 1e-3
"""Micrometres by which rounding may enlarge a part."""
FEW = 200
"""The most parts for which a slower packer is used, which fills the sheets better."""

ROUGH = 0.1
"""Millimetres that outlines may be wider where that leaves out corners, by which packing takes longer."""

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


def laid_out(drawing: Drawing, sheet: Size, spacing: float = SPACING, nest: float | None = None) -> Layout:
    """Returns all bodies, each as often as it is to be made, on as few sheets as the packer finds, those of
    one stock together (sizes in mm).

    They are packed by their boxes and, for `nest` seconds, by their outlines; what uses less is taken.
    """
    found, off = parts_of(drawing)
    gap = _ceil(spacing)
    room = _floor(sheet[0]) - gap, _floor(sheet[1]) - gap
    fitting = [_fitting(part, room, gap) for part in found]
    parts = [part for part in fitting for _ in range(part.body.style.quantity)]
    oversize = {part.body.path: part.size for part in parts if not _lies_in(part, room, gap)}
    if oversize:
        return Layout((), tuple(off), tuple(oversize.items()))
    share = (nest or 0.0) / max(1, len(parts))
    stocks = sorted(gathered(parts, lambda part: part.stock), key=lambda group: group[0].stock)
    packed = (_packed(group, room, gap, sheet, spacing, share * len(group)) for group in stocks)
    sheets = (drawn(drawing, on_it, (0.0, 0.0, *sheet)) for found in packed for on_it in found)
    return Layout(tuple(sheets), tuple(off))


def _fitting(part: Part, room: Cell, gap: int) -> Part:
    """Returns a part as it lies; turned into its smallest box where it only fits so."""
    if _lies_in(part, room, gap):
        return part
    turned = part.moved(Motion(upright_turn(part)))
    return turned if _lies_in(turned, room, gap) else part


def _lies_in(part: Part, room: Cell, gap: int) -> bool:
    cell = _cell(part, gap)
    return _fits(cell, room) or _fits(cell[::-1], room)


def _cell(part: Part, gap: int) -> Cell:
    """Returns the size of the part's place on a sheet, with the gap on one side of it each way."""
    return max(1, _ceil(part.size[0])) + gap, max(1, _ceil(part.size[1])) + gap


def _fits(cell: Cell, room: Cell) -> bool:
    return cell[0] <= room[0] and cell[1] <= room[1]


def _ceil(length: float) -> int:
    return math.ceil(length * GRID - SLACK)


def _floor(length: float) -> int:
    return math.floor(length * GRID + SLACK)


def _packed(
    parts: Sequence[Part], room: Cell, gap: int, sheet: Size, spacing: float, seconds: float
) -> Iterator[list[Part]]:
    """Yields the parts of each sheet in their places: packed by boxes and, if there are seconds for it, by
    outlines, where that saves sheets or room on the last.
    """
    best = _in_boxes(parts, room, gap)
    if seconds and len(parts) > 1 and (by_outlines := _by_outlines(parts, sheet, spacing, seconds)):
        best = min(best, by_outlines, key=lambda places: _used(parts, places, sheet))
    for places in best:
        yield [parts[p.number].moved(Motion(90.0 * p.quarters, p.x, p.y)) for p in places]


def _used(parts: Sequence[Part], sheets: Sequence[Sequence[Nested]], sheet: Size) -> tuple[int, float]:
    """Returns the number of sheets, and the area of the last one that is lost if the rest is cut off it."""
    boxes = [(turned_box(parts[place.number].box, place.quarters), place) for place in sheets[-1]]
    right, top = max(box[2] + at.x for box, at in boxes), max(box[3] + at.y for box, at in boxes)
    return len(sheets), min(sheet[1] * right, sheet[0] * top)


def _by_outlines(parts: Sequence[Part], sheet: Size, spacing: float, seconds: float) -> list[list[Nested]]:
    # Each outline has half the spacing around it. Chords are inside of what bulges, by less than COARSE.
    aside = spacing / 2
    outlines = [widened(_outline(part), aside + COARSE, ROUGH) for part in parts]
    sheets = nested(outlines, (sheet[0] - spacing, sheet[1] - spacing), seconds)
    return [[replace(place, x=place.x + aside, y=place.y + aside) for place in places] for places in sheets]


def _outline(part: Part) -> Polygon:
    """Returns the outline of a part; its box, if it is in pieces or has engraving beyond its material."""
    faces = part.body.region.faces
    if len(faces) == 1 and part.box == part.body.box:
        return faces[0].polygons(COARSE)[0]
    left, bottom, right, top = part.box
    return np.array([(left, bottom), (right, bottom), (right, top), (left, top)])


def _in_boxes(parts: Sequence[Part], room: Cell, gap: int) -> list[list[Nested]]:
    """Returns the places on each sheet. Parts are turned only if that saves sheets."""
    cells = [_cell(part, gap) for part in parts]
    upright = all(_fits(cell, room) for cell in cells)
    bins = _bins(cells, room, turning=False) if upright else []
    if len(bins) != 1:
        turned = _bins(cells, room, turning=True)
        bins = turned if not upright or len(turned) < len(bins) else bins
    return [[_place(parts, r, gap) for r in sorted(found, key=lambda r: r.rid)] for found in bins]


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


def _place(parts: Sequence[Part], cell: Any, gap: int) -> Nested:
    """Returns the place with the lower left corner of the part's box in a cell's."""
    part = parts[cell.rid]
    quarters = int((cell.width, cell.height) != _cell(part, gap))
    box = turned_box(part.box, quarters)
    return Nested(cell.rid, quarters, (cell.x + gap) / GRID - box[0], (cell.y + gap) / GRID - box[1])

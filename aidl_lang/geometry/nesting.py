"""Places for outlines on sheets by their true shapes, where packing their boxes would waste material.

The packer (sparrow, through spyrrow) fills a strip of a given height, as short as it can. Here the strip is
as high as the sheet: what lies within its width is on one sheet, and the rest is packed anew. It searches
until its time is over, so that how well it does depends on the machine.
"""

from __future__ import annotations

import math
import signal
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.geometry.tessellate import Polygon, polygon_area

if TYPE_CHECKING:
    from spyrrow import Item

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
    """Returns the quarter turns in which an outline fits, degrees."""
    width, height = box[2] - box[0], box[3] - box[1]
    upright = [0.0, 180.0] if width <= sheet[0] and height <= sheet[1] else []
    lying = [90.0, 270.0] if height <= sheet[0] and width <= sheet[1] else []
    return [*upright, *lying]

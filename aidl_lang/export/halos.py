"""Clear gaps around what lies in front (`@halo`): the colour of the paper, over all that is behind."""

from __future__ import annotations

from collections.abc import Iterator

from aidl_lang.export import palette
from aidl_lang.export.marks import HALO, Area, Curves, Ink
from aidl_lang.geometry.boolean import without
from aidl_lang.geometry.drawing import Body, Drawing, Stroke
from aidl_lang.geometry.evaluate import Bounds, bounds
from aidl_lang.geometry.network import union_bounds
from aidl_lang.geometry.offsets import offset
from aidl_lang.geometry.solved import SolvedStructure
from aidl_lang.geometry.stacking import stacked


class Halos:
    """The gaps of a drawing; only what lies near something further back has one."""

    def __init__(self, drawing: Drawing, root: SolvedStructure) -> None:
        self._place = {s.path: place for place, s in enumerate(stacked(root))}
        boxes = [(self._place[b.path], b.box) for b in drawing.bodies]
        self._boxes = boxes + [(self._place[s.path], _box(s)) for s in drawing.strokes]

    def around_body(self, body: Body, line: float) -> Iterator[Area]:
        """Yields the gap around a body whose outline has a width."""
        width = body.style.halo or 0.0
        if width > 0 and self._covers(body.path, body.box, by := width + line / 2):
            wide = offset(body.region, by, sharp=False)
            if body.style.is_clear:
                wide = without(wide, body.region)
            yield from (Area(face, palette.PAPER, None, HALO) for face in wide.faces)

    def around_stroke(self, stroke: Stroke, line: float) -> Iterator[Area | Curves]:
        """Yields the gap around curves drawn as lines of a width; letters that are filled have lines of 0."""
        width = stroke.style.halo or 0.0
        if width > 0 and self._covers(stroke.path, _box(stroke), width + line / 2):
            ink = Ink(palette.PAPER, line + 2 * width, is_round=True)
            yield Curves(stroke.pieces, ink, HALO)

    def _covers(self, path: str, box: Bounds, by: float) -> bool:
        """Tells whether the box of something, widened, meets that of something behind it."""
        left, bottom, right, top = box[0] - by, box[1] - by, box[2] + by, box[3] + by
        return any(
            place < self._place[path] and b[0] < right and left < b[2] and b[1] < top and bottom < b[3]
            for place, b in self._boxes
        )


def _box(stroke: Stroke) -> Bounds:
    return union_bounds([bounds(piece) for piece in stroke.pieces])

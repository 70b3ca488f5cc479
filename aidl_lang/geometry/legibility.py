"""Strokes that cannot be seen, because what they lie on has their colour; lettering that parts lie over."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from aidl_lang.diagnostics import Diagnostic
from aidl_lang.geometry.colors import look_alike
from aidl_lang.geometry.evaluate import Bounds, bounds
from aidl_lang.geometry.measures import length
from aidl_lang.geometry.network import Network, union_bounds
from aidl_lang.geometry.notes import listed
from aidl_lang.geometry.sections import (
    Polygon,
    Section,
    boxes_meet,
    covers,
    inside_mask,
    intersection,
    is_nothing,
    union,
)
from aidl_lang.records import record
from aidl_lang.solved import SolvedGeometry, SolvedStructure

COVERED = 0.01
"""Part of the letters below which nobody misses what is covered."""
_WHOLE = 0.995


@record()
class Lying:
    """A body: its path, its place in the order of drawing, and its colour, if it has one."""

    path: str
    place: int
    color: str | None
    section: Section
    box: Bounds


@record()
class Ground:
    """What strokes lie on, or under: the bodies from back to front."""

    network: Network
    bodies: Sequence[Lying]

    def hides(self, color: str | None, curves: Sequence[int], place: int) -> list[bool]:
        """For each edge of some curves drawn at a place whether what is below has nearly their colour."""
        below = [b for b in self.bodies if b.place < place]
        if color is None:
            return []
        alike = [b.color is not None and look_alike(b.color, color) for b in below]
        if not any(alike):
            return []
        spots = self._spots(curves)
        hidden = np.zeros(len(spots), dtype=np.bool_)
        for is_alike, body in zip(alike, below, strict=True):
            hidden[inside_mask(body.section, spots)] = is_alike
        return hidden.tolist()

    def covering(self, curves: Sequence[int], place: int) -> str | None:
        """The path of a body that is drawn over some curves, all of them; None where there is none."""
        if not curves or (self.bodies[-1:] and self.bodies[-1].place < place):
            return None
        box = union_bounds([bounds(self.network.curves[curve]) for curve in curves])
        above = [b for b in self.bodies if b.place > place and _lies_within(box, b.box)]
        spots = self._spots(curves) if above else []
        return next((b.path for b in above if inside_mask(b.section, spots).all()), None)

    def covered_part(self, curves: Sequence[int], place: int) -> tuple[float, list[str]]:
        """How much of some curves drawn at a place, of their length, later bodies lie over, and which."""
        above = [b for b in self.bodies if b.place > place]
        edges = [edge for curve in curves for edge, _ in self.network.uses[curve]]
        if not above or not edges:
            return 0.0, []
        spots = [self.network.midpoint(edge) for edge in edges]
        lengths = np.array([length(self.network.piece((edge, True))) for edge in edges])
        inside = np.array([inside_mask(b.section, spots) for b in above])
        by = [b.path for b, mask in zip(above, inside, strict=True) if lengths[mask].sum() > 0]
        whole = float(lengths.sum())
        return (float(lengths[inside.any(axis=0)].sum()) / whole if whole else 0.0), by

    def hidden_part(self, faces: Section, place: int) -> tuple[float, list[str]]:
        """The same of faces, by their area. A body that lies within them is an inlay and shows them."""
        above = [b for b in self.bodies if b.place > place and boxes_meet(b.section, faces)]
        above = [b for b in above if not covers(faces, b.section)]
        by = [b.path for b in above if not is_nothing(intersection(b.section, faces))]
        hidden = intersection(union([b.section for b in above]), faces) if by else None
        return (hidden.area() / faces.area() if hidden is not None else 0.0), by

    def _spots(self, curves: Sequence[int]) -> list[Polygon]:
        return [self.network.midpoint(edge) for curve in curves for edge, _ in self.network.uses[curve]]


def _lies_within(inner: Bounds, outer: Bounds) -> bool:
    return outer[0] < inner[0] and outer[1] < inner[1] and inner[2] < outer[2] and inner[3] < outer[3]


def covered_note(drawing: SolvedStructure, names: Sequence[str], by: str) -> Diagnostic:
    """For curves of a drawing that a later body lies over."""
    name = by.rpartition(".")[2]
    return Diagnostic(
        "W0709",
        f"{listed(names)} of drawing `{drawing.path}` cannot be seen: `{by}` is drawn over it",
        drawing.span,
        "what stands further down is drawn over it",
        hints=(f"write the drawing below `{name}`, or inside it",),
    )


def lettering_note(
    structure: SolvedStructure, text: SolvedGeometry, share: float, by: Sequence[str]
) -> Diagnostic:
    """For letters that later bodies lie over, in part or as a whole."""
    part = f"{max(1, round(100 * share))} % of the" if share < _WHOLE else "the"
    names = [path.rpartition(".")[2] for path in by]
    over = "is" if len(by) == 1 else "are"
    order = f"write {listed(names)} before what the letters belong to"
    if structure.kind == "drawing":
        order = f"write the drawing below {listed(names)}"
    return Diagnostic(
        "W0713",
        f"{part} lettering `{text.path}` cannot be seen: {listed(by)} {over} drawn over it",
        text.span or structure.span,
        "what stands further down is drawn over it",
        hints=(f"move one of them, or {order}",),
    )


def unseen_note(drawing: SolvedStructure, names: Sequence[str], color: str) -> Diagnostic:
    """For curves of a drawing that was given the colour of what they lie on."""
    return Diagnostic(
        "W0709",
        f"{listed(names)} of drawing `{drawing.path}` cannot be seen: {color} on what has that colour",
        drawing.span,
        "strokes of the colour of what is below",
        hints=(
            'give it another colour, as `@color("dimgray")`',
            "with no `@color` of its own it gets one that shows",
        ),
    )

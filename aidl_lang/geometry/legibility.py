"""Strokes that cannot be seen, because what they lie on has their colour."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from aidl_lang.diagnostics import Diagnostic
from aidl_lang.geometry.colors import look_alike
from aidl_lang.geometry.evaluate import Bounds, bounds
from aidl_lang.geometry.network import Network, union_bounds
from aidl_lang.geometry.notes import listed
from aidl_lang.geometry.sections import Polygon, Section, inside_mask
from aidl_lang.solved import SolvedStructure


@dataclass(frozen=True)
class Lying:
    """A body: its path, its place in the order of drawing, and its colour, if it has one."""

    path: str
    place: int
    color: str | None
    section: Section
    box: Bounds


@dataclass(frozen=True)
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

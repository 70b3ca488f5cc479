"""Finds strokes that cannot be seen on a ground of their colour, and lettering that parts cover."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from aidl_lang.common.colors import look_alike
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import named
from aidl_lang.common.records import record
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.geometry.measures import length
from aidl_lang.geometry.network import Network, union_bounds
from aidl_lang.geometry.sections import (
    Section,
    boxes_meet,
    covers,
    inside_mask,
    intersection,
    is_nothing,
    union,
)
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure

COVERED = 0.1
"""Part of the letters that may be covered: they can be read though the hand of a clock lies over them."""
_WHOLE = 0.995


@record()
class StackedBody:
    """A body with its path, its place in the order of drawing, and its colour, if it has one. One that
    `is_clear` hides nothing.
    """

    path: str
    place: float
    color: str | None
    section: Section
    box: Bounds
    is_clear: bool = False


@record()
class Ground:
    """The bodies that strokes lie on, or under, from back to front. `inked` are the curves of all strokes."""

    network: Network
    bodies: Sequence[StackedBody]
    inked: Sequence[int]

    def hides(self, color: str | None, curves: Sequence[int], place: float) -> list[bool]:
        """Returns for each edge of some curves drawn at a place whether the body below has nearly their
        colour.
        """
        if color is None or not any(look_alike(known, color) for known in self._colors):
            return []
        count = bisect_left(self._places, place)
        below = [[k for k in self._within[edge] if k < count] for edge in self._edges(curves)]
        return [bool(under) and self._is_alike(under[-1], color) for under in below]

    def _is_alike(self, body: int, color: str) -> bool:
        own = self.bodies[body].color
        return own is not None and look_alike(own, color)

    def covering(self, curves: Sequence[int], place: float) -> str | None:
        """Returns the path of a body that is drawn over all of some curves; None if there is none."""
        first = bisect_right(self._places, place)
        if not curves or first == len(self.bodies):
            return None
        box = union_bounds([self.network.boxes[curve] for curve in curves])
        over = {k for k in range(first, len(self.bodies)) if not self.bodies[k].is_clear}
        for edge in self._edges(curves):
            over.intersection_update(self._within[edge])
        return next(
            (b.path for b in map(self.bodies.__getitem__, sorted(over)) if _lies_within(box, b.box)), None
        )

    def covered_part(self, curves: Sequence[int], place: float) -> tuple[float, list[str]]:
        """Returns the share of the length of some curves drawn at a place that later bodies cover, and these
        bodies.
        """
        first, edges = bisect_right(self._places, place), self._edges(curves)
        above = [
            [k for k in self._within[edge] if k >= first and not self.bodies[k].is_clear] for edge in edges
        ]
        if not any(above):
            return 0.0, []
        lengths = [length(self.network.piece((edge, True))) for edge in edges]
        by = sorted({k for over, long in zip(above, lengths, strict=True) for k in over if long > 0})
        covered = sum(long for over, long in zip(above, lengths, strict=True) if over)
        return covered / (sum(lengths) or 1.0), [self.bodies[k].path for k in by]

    def hidden_part(self, faces: Section, place: float) -> tuple[float, list[str]]:
        """Returns the share of the area of faces that later bodies cover, and these bodies. A body within the
        faces is an inlay and shows them.
        """
        above = [b for b in self.bodies if b.place > place and not b.is_clear]
        above = [b for b in above if boxes_meet(b.section, faces)]
        above = [b for b in above if not covers(faces, b.section)]
        by = [b.path for b in above if not is_nothing(intersection(b.section, faces))]
        hidden = intersection(union([b.section for b in above]), faces) if by else None
        return (hidden.area() / faces.area() if hidden is not None else 0.0), by

    def _edges(self, curves: Sequence[int]) -> list[int]:
        return [edge for curve in curves for edge, _ in self.network.uses[curve]]

    @cached_property
    def _places(self) -> list[float]:
        return [body.place for body in self.bodies]

    @cached_property
    def _colors(self) -> set[str]:
        return {body.color for body in self.bodies if body.color is not None}

    @cached_property
    def _within(self) -> dict[int, list[int]]:
        """The numbers of the bodies that the middle of each edge of a stroke lies in."""
        edges = sorted(set(self._edges(self.inked)))
        found: dict[int, list[int]] = {edge: [] for edge in edges}
        spots = self.network.midpoints(edges)
        order = np.argsort(spots[:, 0], kind="stable")
        along = spots[order, 0]
        for number, body in enumerate(self.bodies):
            left, _, right, _ = body.section.bounds()
            beside = order[np.searchsorted(along, left) : np.searchsorted(along, right, side="right")]
            for k in beside[inside_mask(body.section, spots[beside])].tolist():
                found[edges[k]].append(number)
        return found


def _lies_within(inner: Bounds, outer: Bounds) -> bool:
    return outer[0] < inner[0] and outer[1] < inner[1] and inner[2] < outer[2] and inner[3] < outer[3]


def covered_note(drawing: SolvedStructure, names: Sequence[str], by: str) -> Diagnostic:
    """Returns the diagnostic on curves of a drawing that a later body covers."""
    around, _, name = by.rpartition(".")
    hint = f"write the drawing below `{name}`, or inside it"
    if around == drawing.path:
        hint = f"write {'it' if len(names) == 1 else 'them'} below `{name}`"
    elif around == drawing.path.rpartition(".")[0]:
        hint += f", or say `@in_front({name})` before it"
    return Diagnostic(
        "W0709",
        f"{named(names)} of drawing `{drawing.path}` cannot be seen: `{by}` is drawn over it",
        drawing.span,
        "what stands further down is drawn over it",
        hints=(hint,),
    )


def lettering_note(
    structure: SolvedStructure, text: SolvedGeometry, share: float, by: Sequence[str]
) -> Diagnostic:
    """Returns the diagnostic on letters that later bodies cover, in part or as a whole."""
    part = f"{max(1, round(100 * share))} % of the" if share < _WHOLE else "the"
    names = [path.rpartition(".")[2] for path in by]
    over = "is" if len(by) == 1 else "are"
    order = f"write {named(names)} before what the letters belong to"
    if structure.kind == "drawing":
        order = f"write the drawing below {named(names)}"
    return Diagnostic(
        "W0713",
        f"{part} lettering `{text.path}` cannot be seen: {named(by)} {over} drawn over it",
        text.span or structure.span,
        "what stands further down is drawn over it",
        hints=(f"move one of them, or {order}",),
    )


def unseen_note(drawing: SolvedStructure, names: Sequence[str], color: str) -> Diagnostic:
    """Returns the diagnostic on curves of a drawing that was given the colour of what they lie on."""
    return Diagnostic(
        "W0709",
        f"{named(names)} of drawing `{drawing.path}` cannot be seen: {color} on what has that colour",
        drawing.span,
        "strokes of the colour of what is below",
        hints=(
            'give it another colour, as `@color("dimgray")`',
            "with no `@color` of its own it gets one that shows",
        ),
    )

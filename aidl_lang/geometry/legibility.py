"""Finds strokes that cannot be seen on a ground of their colour, and lettering that parts cover."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Sequence
from functools import cached_property

import numpy as np

from aidl_lang.common.colors import look_alike
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import named
from aidl_lang.common.records import record
from aidl_lang.geometry.clipping import stretches_beside
from aidl_lang.geometry.curves import Piece, Vec
from aidl_lang.geometry.evaluate import Bounds, are_near, part, point
from aidl_lang.geometry.measures import length
from aidl_lang.geometry.network import GRID, Network, union_bounds
from aidl_lang.geometry.region import Region
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
    region: Region
    box: Bounds
    is_clear: bool = False


@record()
class Ground:
    """The bodies that strokes lie on, or under, from back to front. `curves` are those of all strokes, which
    go by their numbers; `boxes` are theirs.
    """

    network: Network
    bodies: Sequence[StackedBody]
    curves: Sequence[Piece]
    boxes: Sequence[Bounds]

    def hides(self, color: str | None, curves: Sequence[int], place: float, *, wholly: bool) -> bool:
        """Tells whether the body below some curves drawn at a place has nearly their colour: all along them,
        or else somewhere.
        """
        count = bisect_left(self._places, place)
        below = self._around(curves, range(count))
        seen = ((k, self.bodies[k].color) for k in below)
        alike = {k for k, own in seen if own is not None and color is not None and look_alike(own, color)}
        if not alike:
            return False
        asked = all if wholly else any
        middles = ([k for k in self._at_middles[curve] if k < count] for curve in curves)
        if asked(bool(on) and on[-1] in alike for on in middles) is not wholly:
            return not wholly
        # By the middles alone it may still be otherwise.
        return asked(bool(on) and on[-1] in alike for _, on in self._parts(curves, below))

    def covering(self, curves: Sequence[int], place: float) -> str | None:
        """Returns the path of a body that is drawn over all of some curves; None if there is none."""
        box = union_bounds([self.boxes[curve] for curve in curves])
        over = [k for k in self._above(curves, place) if _lies_within(box, self.bodies[k].box)]
        over = [k for k in over if all(k in self._at_middles[curve] for curve in curves)]
        within = [on for _, on in self._parts(curves, over)]
        return next((self.bodies[k].path for k in over if all(k in on for on in within)), None)

    def covered_part(self, curves: Sequence[int], place: float) -> tuple[float, list[str]]:
        """Returns the share of the length of some curves drawn at a place that later bodies cover, and these
        bodies.
        """
        parts = [(length(piece), over) for piece, over in self._parts(curves, self._above(curves, place))]
        by = sorted({k for long, over in parts for k in over if long > 0})
        covered = sum(long for long, over in parts if over)
        return covered / (sum(long for long, _ in parts) or 1.0), [self.bodies[k].path for k in by]

    def _above(self, curves: Sequence[int], place: float) -> list[int]:
        """Returns the bodies that are drawn over a place and may hide some curves."""
        later = range(bisect_right(self._places, place), len(self.bodies))
        return self._around(curves, [k for k in later if not self.bodies[k].is_clear])

    def _around(self, curves: Sequence[int], bodies: Iterable[int]) -> list[int]:
        """Returns those of some bodies whose boxes meet that of some curves."""
        box = union_bounds([self.boxes[curve] for curve in curves])
        return [k for k in bodies if curves and are_near(box, self.bodies[k].box)]

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

    @cached_property
    def _places(self) -> list[float]:
        return [body.place for body in self.bodies]

    def _parts(self, curves: Sequence[int], bodies: Sequence[int]) -> list[tuple[Piece, list[int]]]:
        """Returns the parts of some curves between the outlines of some bodies, each with those of these that
        it lies in; none without bodies.
        """
        if not bodies:
            return []
        own, boxes = [self.curves[k] for k in curves], [self.boxes[k] for k in curves]
        outlines = [self.bodies[k].region for k in bodies]
        around = union_bounds(boxes)
        near = [(p, b) for r in outlines for p, b in zip(r.pieces, r.boxes.tolist(), strict=True)]
        near = [(p, b) for p, b in near if are_near(around, b)]
        boxes += [b for _, b in near]
        cut = stretches_beside(own, [p for p, _ in near], boxes, self.network.tolerance)
        parts = [(curve, stretch) for curve, of in zip(own, cut, strict=True) for stretch in of]
        holders = self._holders([point(curve, stretch.middle) for curve, stretch in parts], bodies)
        pieces = (part(c, s.t0, s.t1, s.start, s.end) for c, s in parts)
        return list(zip(pieces, holders, strict=True))

    @cached_property
    def _at_middles(self) -> list[list[int]]:
        """The bodies that the middle of each curve lies in."""
        return self._holders([point(curve, 0.5) for curve in self.curves], range(len(self.bodies)))

    def _holders(self, spots: Sequence[Vec], bodies: Sequence[int]) -> list[list[int]]:
        """Returns for each spot those of some bodies that it lies in."""
        on_grid = self.network.to_grid(np.array(spots)) * np.float64(GRID)
        order = np.argsort(on_grid[:, 0], kind="stable")
        along, found = on_grid[order, 0], [list[int]() for _ in spots]
        for k in bodies:
            left, _, right, _ = self.bodies[k].section.bounds()
            beside = order[np.searchsorted(along, left) : np.searchsorted(along, right, side="right")]
            for n in beside[inside_mask(self.bodies[k].section, on_grid[beside])].tolist():
                found[n].append(k)
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

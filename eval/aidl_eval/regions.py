"""What a program draws, in any language: areas of the plane in mm, back to front, and lines."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from aidl_eval import shapes
from aidl_lang.geometry.boolean import common
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.drawing import Drawing, draw
from aidl_lang.geometry.region import Polygon, Region
from aidl_lang.geometry.solved import Frame, SolvedGeometry, SolvedModel, SolvedStructure
from aidl_lang.geometry.styles import stacked

FINE = 2e-4
"""Distance of chords from curves, as a share of the drawing's size."""


@dataclass(frozen=True)
class Regions:
    """Areas that are drawn as one each, from back to front, and curves drawn as lines, above them all."""

    parts: tuple[Region, ...] = ()
    lines: tuple[tuple[Piece, ...], ...] = field(default=())

    def __bool__(self) -> bool:
        return bool(self.parts or self.lines)

    @cached_property
    def size(self) -> float:
        """The larger side of the box around the parts."""
        boxes = np.array([part.box for part in self.parts] or [(0.0, 0.0, 0.0, 0.0)])
        return float(max(boxes[:, 2].max() - boxes[:, 0].min(), boxes[:, 3].max() - boxes[:, 1].min()))

    @cached_property
    def outlines(self) -> tuple[tuple[Polygon, ...], ...]:
        """The outlines of each part as polygons; holes run clockwise."""
        return tuple(tuple(p.polygons(FINE * (self.size or 1.0))) for p in self.parts)

    @cached_property
    def whole(self) -> Region:
        """All parts as one: the silhouette."""
        return shapes.region([p for outlines in self.outlines for p in outlines], "NonZero")

    @cached_property
    def visible(self) -> tuple[Region, ...]:
        """What is seen of each part: without what lies above it."""
        seen, above = list[Region](), list[Polygon]()
        for outlines in reversed(self.outlines):
            seen.append(shapes.without(outlines, above))
            above += outlines
        return tuple(reversed(seen))


def of_drawing(model: SolvedModel, drawing: Drawing) -> Regions:
    """Returns the bodies of AIDL's drawing, each taken apart into the outlines that it was united of, as far
    as they are seen in it; and strokes as lines.

    Other languages unite no shapes that stand side by side, so what is united without a word counts by
    outline: a drawing of one solid has as many parts as the same outlines in a solid each.
    """
    bodies = {body.path: body.region for body in drawing.bodies}
    parts = list[Region]()
    for structure in stacked(model.root):
        if structure.path in bodies:
            body = bodies[structure.path]
            found = tuple(_within(structure, body, is_cut=False))
            parts += found if len(found) > 1 else (body,)
    lines = tuple(stroke.pieces for stroke in drawing.strokes if stroke.pieces)
    return Regions(tuple(parts), lines)


def _within(structure: SolvedStructure, body: Region, *, is_cut: bool) -> Iterator[Region]:
    """Yields the outlines in a structure and what it holds. Where holes are cut they are one part, as in a
    difference of their union, so that the edge of a hole is there once.
    """
    if structure.kind == "solid":
        is_cut = is_cut or any(child.kind == "hole" for child in structure.structures)
        outlines = [g for g in structure.drawn if not g.construction and g.type != "point"]
        for group in (outlines,) if is_cut else zip(outlines):
            if seen := common(_covered(group), body):
                yield seen
    for child in structure.structures:
        yield from _within(child, body, is_cut=is_cut)


def _covered(outlines: Sequence[SolvedGeometry]) -> Region:
    """Returns what outlines cover when nothing else is drawn."""
    here = Frame(0.0, 0.0, 0.0)
    alone = SolvedStructure("it", "it", "solid", "top", here, {}, {}, tuple(outlines), (), None, False, None)
    return draw(SolvedModel("solved", alone))[0].regions.get("it", Region())

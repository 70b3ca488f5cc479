"""What a program draws, in any language: coloured areas of the plane in mm, back to front, and lines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import field
from functools import cached_property

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.geometry.boolean import common
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.measures import area, region_bounds
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.sections import Polygon
from aidl_lang.geometry.solved import SolvedModel, SolvedStructure
from aidl_lang.geometry.stacking import stacked
from aidl_lang.geometry.tessellate import region_polygons
from aidl_lang.tools.evaluation import shapes

FINE = 2e-4
"""Distance of chords from curves, as a share of the drawing's size."""


@record()
class Part:
    """An area that is drawn as one; `color` is a CSS colour, None where the program names none."""

    region: Region
    color: str | None = None


@record()
class Regions:
    """Parts from back to front, and curves drawn as lines, which lie above them all."""

    parts: tuple[Part, ...] = ()
    lines: tuple[tuple[Piece, ...], ...] = field(default=())

    def __bool__(self) -> bool:
        return bool(self.parts or self.lines)

    @cached_property
    def size(self) -> float:
        """The larger side of the box around the parts."""
        boxes = np.array([region_bounds(part.region) for part in self.parts] or [(0.0, 0.0, 0.0, 0.0)])
        return float(max(boxes[:, 2].max() - boxes[:, 0].min(), boxes[:, 3].max() - boxes[:, 1].min()))

    @cached_property
    def outlines(self) -> tuple[tuple[Polygon, ...], ...]:
        """The outlines of each part as polygons; holes run clockwise."""
        return tuple(tuple(region_polygons(p.region, FINE * (self.size or 1.0))) for p in self.parts)

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


def of_outlines(parts: Iterable[tuple[Sequence[Polygon], str | None]]) -> Regions:
    """Returns the regions inside an odd number of a part's outlines each; parts without area are left out."""
    drawn = ((shapes.region(outlines), color) for outlines, color in parts)
    return Regions(tuple(Part(region, color) for region, color in drawn if region))


def of_drawing(model: SolvedModel, drawing: Drawing) -> Regions:
    """Returns the bodies of AIDL's drawing, each followed by the solids that it was united of, as far as they
    are seen in it; and strokes as lines.
    """
    bodies = {body.path: body.region for body in drawing.bodies}
    parts = list[Part]()
    for structure in stacked(model.root):
        if structure.path in bodies:
            parts.append(Part(bodies[structure.path], _color(drawing, structure.path)))
            parts += _within(structure, bodies[structure.path], drawing)
    lines = tuple(stroke.pieces for stroke in drawing.strokes if stroke.pieces)
    return Regions(tuple(parts), lines)


def _within(structure: SolvedStructure, body: Region, drawing: Drawing) -> Iterator[Part]:
    for child in structure.structures:
        own = drawing.regions.get(child.path)
        if child.kind != "solid" or not own:
            continue
        seen = common(own, body)
        if seen and area(seen) < (1 - 1e-9) * area(body):
            yield Part(seen, _color(drawing, child.path))
        yield from _within(child, body, drawing)


def _color(drawing: Drawing, path: str) -> str | None:
    return drawing.styles[path].color

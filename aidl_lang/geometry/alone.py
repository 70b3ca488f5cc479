"""The region of one piece of geometry by itself, for questions about its area."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import Frame, SolvedGeometry, SolvedModel, SolvedStructure


def region_alone(model: SolvedModel, path: str) -> Region:
    """Returns the region that a geometry would cover as a solid of its own."""
    found = (g for g in all_geometry(model.root) if g.path == path)
    geometry = tuple(replace(g, construction=False) for g in found)
    frame = Frame(0.0, 0.0, 0.0)
    alone = SolvedStructure("it", "it", "solid", "top", frame, {}, {}, geometry, (), None, False, 0, None)
    drawing, _ = draw(SolvedModel(model.status, alone, (), 0, (), ()))
    return drawing.regions.get("it", Region(()))


def all_geometry(root: SolvedStructure) -> Iterator[SolvedGeometry]:
    """Yields every piece of geometry under a structure, with the parts of each."""
    for structure in root.walk():
        stack = list(structure.drawn)
        while stack:
            yield (top := stack.pop())
            stack.extend(top.parts)

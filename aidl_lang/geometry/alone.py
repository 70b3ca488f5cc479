"""The region of one piece of geometry by itself, for questions about its area."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import Frame, SolvedGeometry, SolvedModel, SolvedStructure


def region_alone(root: SolvedStructure, path: str) -> Region:
    """Returns the region that a geometry would cover as a solid of its own."""
    found = (g for g in all_geometry(root) if g.path == path)
    geometry = tuple(replace(g, construction=False) for g in found)
    frame = Frame(0.0, 0.0, 0.0)
    alone = SolvedStructure("it", "it", "solid", "top", frame, {}, {}, geometry, (), None, False, None)
    return draw(SolvedModel("solved", alone))[0].regions.get("it", Region(()))


def all_geometry(root: SolvedStructure) -> Iterator[SolvedGeometry]:
    """Yields every piece of geometry under a structure, as it is drawn, with the parts of each."""
    return (g for structure in root.walk() for drawn in structure.drawn for g in drawn.walk())

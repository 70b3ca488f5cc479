"""Drawings that are clipped to the material of a solid, once that is known."""

from __future__ import annotations

from dataclasses import replace

from aidl_lang.geometry.boolean import common
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.outlines import clipped_ink
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import SolvedModel, SolvedStructure


def on_material(model: SolvedModel, drawing: Drawing) -> SolvedModel:
    """Returns a model with its drawings as far as they lie on the solids that they are clipped to; `drawing`:
    that of the model without.
    """
    return replace(model, root=_inked(model.root, drawing, None))


def _inked(s: SolvedStructure, drawing: Drawing, around: Region | None) -> SolvedStructure:
    """Returns a structure with its drawings clipped; `around`: the material that those around it lie on."""
    ground = around
    if s.ground is not None:
        ground = _material(drawing, s.ground)
        ground = ground if around is None else common(ground, around)
    children = tuple(_inked(child, drawing, ground) for child in s.structures)
    if ground is None:
        return replace(s, structures=children)
    inside = s.inside if s.ground is None else ground
    return replace(s, structures=children, finished=tuple(clipped_ink(s.drawn, ground)), inside=inside)


def _material(drawing: Drawing, path: str) -> Region:
    """Returns what is left of a solid in the end: the bodies around it have holes, too."""
    region = drawing.regions.get(path, Region())
    for body in drawing.bodies:
        if f"{path}.".startswith(f"{body.path}.") and body.path != path:
            region = common(region, body.region)
    return region

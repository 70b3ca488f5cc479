"""3MF: a named mesh for each body, with its colour, opacity and material, as printers take it."""

from __future__ import annotations

import uuid
from typing import Any

import lib3mf
import numpy as np

from aidl_lang.common.colors import rgb
from aidl_lang.common.running import checkpoint
from aidl_lang.export import Exported, ExportError, Job
from aidl_lang.export.mesh import Mesh, meshes, printable
from aidl_lang.export.themes import body_fill

_NAMES = uuid.UUID("6f0a1d5e-6f6b-5c1a-9c53-3d9a4f7b2c10")
"""Namespace for ids, which are derived from names, so that the same drawing gives the same file."""

_LARGEST = 1e9
"""mm. Largest coordinate that lib3mf takes."""


def to_3mf(job: Job) -> Exported:
    """Writes the 3MF file. Raises ExportError as `meshes` does, and for a body too far out (E0918)."""
    made, notes = meshes(job)
    wrapper = lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    model.SetUnit(lib3mf.ModelUnit.MilliMeter)
    model.SetBuildUUID(_id("build", job.model.root.path))
    materials = _Materials(wrapper, model)
    order = {body.path: index for index, body in enumerate(job.drawing.bodies)}
    for mesh in made:
        checkpoint()
        thing = _mesh_object(model, mesh)
        style = mesh.body.style
        color = style.color or body_fill(order[mesh.body.path])
        name, opacity = printable(style.material or mesh.body.path), style.opacity
        thing.SetObjectLevelProperty(*materials.of(name, color, 1.0 if opacity is None else opacity))
        item = model.AddBuildItem(thing, wrapper.GetIdentityTransform())
        item.SetUUID(_id("item", mesh.body.path))
    return Exported(bytes(model.QueryWriter("3mf").WriteToBuffer()), notes=notes)


def _mesh_object(model: Any, mesh: Mesh) -> Any:
    if np.abs(mesh.points).max() >= _LARGEST:
        raise ExportError(
            "E0918",
            f"`{mesh.body.path}` does not fit into 3MF: it reaches further than {_LARGEST:g} mm",
            "look for a size or position that was written in another unit, or multiplied once too often",
        )
    thing = model.AddMeshObject()
    thing.SetName(mesh.name)
    thing.SetUUID(_id("object", mesh.body.path))
    points = [lib3mf.Position(tuple(p)) for p in mesh.points.tolist()]
    thing.SetGeometry(points, [lib3mf.Triangle(tuple(t)) for t in mesh.triangles.tolist()])
    return thing


class _Materials:
    """One group of materials, each a name and a colour, without duplicates."""

    def __init__(self, wrapper: Any, model: Any) -> None:
        self.wrapper, self.group = wrapper, model.AddBaseMaterialGroup()
        self.known: dict[tuple[str, str, float], int] = {}

    def of(self, name: str, color: str, opacity: float) -> tuple[int, int]:
        """Returns the ids of the group and of the material in it."""
        key = name, color, opacity
        if key not in self.known:
            paint = self.wrapper.RGBAToColor(*rgb(color), round(255 * opacity))
            self.known[key] = self.group.AddMaterial(name, paint)
        return self.group.GetResourceID(), self.known[key]


def _id(sort: str, path: str) -> str:
    return str(uuid.uuid5(_NAMES, f"{sort} {path}"))

"""Bodies in their planes with their thickness; triangle meshes of them, and their formats: STL and 3MF."""

from __future__ import annotations

import math
import uuid
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Any

import manifold3d
import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.colors import rgb
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import named
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.export.job import Exported, ExportError, Job
from aidl_lang.export.marks import body_fill
from aidl_lang.geometry.curves import LARGEST
from aidl_lang.geometry.drawing import Body, Stroke
from aidl_lang.geometry.legibility import owner
from aidl_lang.geometry.parts import GROUND, Plane, placement_notes, planes, thickness_of
from aidl_lang.geometry.region import Region

# --- Common to the three-dimensional formats: bodies in their planes, with their thickness.

THINNEST = 1e-6
"""mm. A smaller thickness is lost among the tolerances of programs that read the file."""

_REMEDIES = ("say how thick: `@thickness(3mm)` before it or what is around it", "or for all: `--thickness 3`")
_NAMED = 6


@record()
class Recess:
    """An area that a hole which ends in its solid takes away of it, down from the face that is seen.

    plane      that of its bottom, `depth` mm below the face
    narrowing  how much less the radius of a circle is there, mm
    """

    region: Region
    plane: Plane
    depth: float
    narrowing: float = 0.0


@record()
class PlacedBody:
    """A body, its plane, its thickness in mm, None if it stays flat, and what is taken away of that."""

    body: Body
    plane: Plane
    thickness: float | None
    recesses: tuple[Recess, ...] = ()


def placed_bodies(job: Job) -> list[PlacedBody]:
    """Returns the bodies in order of drawing. Raises ExportError for one that cannot be made a solid."""
    stand = _planes(job)
    found = []
    for body in job.drawing.bodies:
        thickness = thickness_of(body, job.options.thickness)
        if thickness is not None and not THINNEST <= thickness <= LARGEST:
            message = f"`{body.path}` cannot be made a solid: it would be {thickness:g} mm thick"
            raise ExportError("E0918", message, f"a thickness is from {THINNEST:g} to {LARGEST:g} mm")
        _require_place(body.path, stand[body.path])
        recesses = _recesses(job, body, stand[body.path], thickness) if thickness is not None else ()
        found.append(PlacedBody(body, stand[body.path], thickness, tuple(recesses)))
    return found


def _recesses(job: Job, body: Body, plane: Plane, thickness: float) -> Iterator[Recess]:
    bodies, styles = {other.path: other for other in job.drawing.bodies}, job.drawing.styles
    grows_up = float(np.cross(plane.u, plane.v) @ plane.growth) > 0
    for path, region in job.drawing.regions.items():
        if not styles[path].is_blind or not _holds(bodies, path, body.path):
            continue
        depth, *taper = styles[path].depth
        slope = math.tan(math.radians(taper[0] / 2)) if taper else 0.0
        if (circle := region.circle) is None:
            slope = 0.0
        elif slope:  # no deeper than its point
            depth = min(depth, circle.radius / slope)
        bottom = plane.shifted(thickness - depth) if grows_up else plane
        yield Recess(region, bottom, depth, depth * slope)


def _holds(bodies: Mapping[str, Body], hole: str, body: str) -> bool:
    """Tells whether a hole takes away of a body: the one around it, or all in the assembly around it."""
    if (holder := owner(bodies, hole)) is not None:
        return holder == body
    while hole and not any(path.startswith(f"{hole}.") for path in bodies):
        hole = hole.rpartition(".")[0]
    return body.startswith(f"{hole}.")


def placed_strokes(job: Job) -> list[tuple[Stroke, Plane]]:
    """Returns the strokes with the planes they lie in, without the outlines of recesses."""
    stand = _planes(job)
    for stroke in job.drawing.strokes:
        _require_place(stroke.path, stand[stroke.path])
    solid = {path for path, style in job.drawing.styles.items() if style.is_blind}
    return [(stroke, stand[stroke.path]) for stroke in job.drawing.strokes if stroke.path not in solid]


def _planes(job: Job) -> dict[str, Plane]:
    if job.is_flat:
        return dict.fromkeys((s.path for s in job.model.root.walk()), GROUND)
    return planes(job.model.root)


def _require_place(path: str, plane: Plane) -> None:
    if not np.abs(plane.origin).max() <= LARGEST:
        message = f"`{path}` cannot be placed in space: it lies further out than {LARGEST:g} mm"
        hint = "look for an `@elevation` that was written in another unit, or multiplied once too often"
        raise ExportError("E0918", message, hint)


# --- Triangle meshes of the bodies that have a thickness, and STL: binary for one body, text for several.

# A triangle mesh has no curves: chords depart from the outline by at most `FINENESS` of the size of a body,
# or by `FINEST` if that is more. Manifold extrudes, so a mesh is closed and does not cross itself.

FINENESS = 1e-4
FINEST = 0.001
"""mm"""
_MANY = 2000
"""Outlines of a face above which its holes are cut out one by one."""
_FEW = 20
"""Holes per triangle in that case."""


@record()
class Mesh:
    """A closed surface: points in mm, shape (n, 3), and triangles of them, counter-clockwise from outside."""

    body: Body
    points: NDArray[np.float64]
    triangles: NDArray[np.int64]

    @property
    def name(self) -> str:
        return printable(self.body.path)

    @property
    def corners(self) -> NDArray[np.float64]:
        """Returns the corners of each triangle, shape (n, 3, 3)."""
        return self.points[self.triangles]


def meshes(job: Job) -> tuple[list[Mesh], tuple[Diagnostic, ...]]:
    """Returns the meshes of the bodies in order of drawing, with diagnostics about them. Raises ExportError
    if no body has a thickness (E0917), or one cannot be made solid (E0918).
    """
    bodies, notes = placed_bodies(job), tuple(placement_notes(job.model.root, job.drawing))
    flat = [p.body.path for p in bodies if p.thickness is None]
    if not bodies:
        hint = "material is what the curves of a `solid` enclose"
        raise ExportError("E0917", "there is no body to write", hint)
    if flat:
        have = f"{named(flat, _NAMED)} {'has' if len(flat) == 1 else 'have'} no thickness"
        if len(flat) == len(bodies):
            raise ExportError("E0917", have, *_REMEDIES)
        left_out = "is left out" if len(flat) == 1 else "are left out"
        notes = (Diagnostic("W0725", f"{have} and {left_out}", hints=_REMEDIES), *notes)
    return [_mesh(placed) for placed in bodies if placed.thickness is not None], notes


def printable(name: str) -> str:
    """Returns a name without characters that XML and lines of text cannot hold."""
    return "".join(c if c.isprintable() else "_" for c in name)


def _mesh(placed: PlacedBody) -> Mesh:
    body, thickness = placed.body, placed.thickness
    assert thickness is not None
    left, bottom, right, top = body.box
    # About its own centre, so that no digits are lost far out.
    center = np.array(((left + right) / 2, (bottom + top) / 2))
    tolerance = max(FINEST, FINENESS * max(right - left, top - bottom))
    faces = [[p - center for p in face.polygons(tolerance)] for face in body.region.faces]
    made = _extruded(faces, thickness, [_tool(r, thickness, center, tolerance) for r in placed.recesses])
    if made is None:
        message = f"`{body.path}` cannot be made a solid of triangles: it is too large or too thin for them"
        hint = "look for a size that was written in another unit, or shrank to nothing"
        raise ExportError("E0918", message, hint)
    motion = placed.plane.placed(thickness)
    flat = np.asarray(made.vert_properties)[:, :3] + (*center, 0.0)
    points = flat @ motion[:, :3].T + motion[:, 3]
    return Mesh(body, points, np.asarray(made.tri_verts, dtype=np.int64))


def _tool(
    recess: Recess, thickness: float, center: NDArray[np.float64], tolerance: float
) -> manifold3d.Manifold:
    """Returns what a recess takes away, and as much above the face, so that no skin is left on it."""
    bottom = thickness - recess.depth
    made = []
    for face in recess.region.faces:
        polygons = [p - center for p in face.polygons(tolerance)]
        if recess.narrowing:
            middle = polygons[0].mean(axis=0)
            radius, sides = float(np.hypot(*(polygons[0][0] - middle))), len(polygons[0])
            low, high = max(radius - recess.narrowing, 0.0), radius + recess.narrowing
            cone = manifold3d.Manifold.cylinder(2 * recess.depth, low, high, sides)
            made.append(cone.translate((*middle, bottom)))
        else:
            made.append(_upright(polygons, 2 * recess.depth).translate((0.0, 0.0, bottom)))
    return manifold3d.Manifold.batch_boolean(made, manifold3d.OpType.Add)


def _extruded(
    faces: list[list[NDArray[np.float64]]], thickness: float, tools: Sequence[manifold3d.Manifold]
) -> manifold3d.Mesh64 | None:
    """Extrudes faces (outline, holes) less some tools; None if Manifold's numbers do not reach."""
    try:
        if max(map(len, faces)) > _MANY:
            solid = manifold3d.Manifold.compose([_drilled(*face, thickness=thickness) for face in faces])
        else:
            solid = _upright([polygon for face in faces for polygon in face], thickness)
    except RuntimeError:
        return None
    for tool in tools:
        solid -= tool
    return None if solid.is_empty() else solid.to_mesh64()


def _drilled(
    outline: NDArray[np.float64], *holes: NDArray[np.float64], thickness: float
) -> manifold3d.Manifold:
    """Extrudes a face and cuts its holes out of many small triangles: triangles over the whole face need a
    bridge from each hole to the outline, which takes a time that grows with their square.
    """
    solid = _upright([outline], thickness)
    if not holes:
        return solid
    drills = _upright([hole[::-1] for hole in holes], 3 * thickness).translate((0.0, 0.0, -thickness))
    return solid.refine(1 + math.isqrt(len(holes) // (_FEW * len(outline)))) - drills


def _upright(polygons: list[NDArray[np.float64]], thickness: float) -> manifold3d.Manifold:
    return manifold3d.CrossSection(polygons, manifold3d.FillRule.Positive).extrude(thickness)


_HEADER = 80
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def to_stl(job: Job) -> Exported:
    """Writes the STL file. Raises ExportError as `meshes` does."""
    made, notes = meshes(job)
    return Exported(_binary(made[0]) if len(made) == 1 else _text(made), notes=notes)


def _binary(mesh: Mesh) -> bytes:
    records = np.zeros(len(mesh.triangles), _RECORD)
    records["normal"], records["corners"] = _normals(mesh), mesh.corners
    # A reader takes a file that begins with `solid` for text.
    header = f"AIDL {mesh.body.path}".encode("ascii", "replace")[:_HEADER].ljust(_HEADER, b"\0")
    count: bytes = np.array(len(records), "<u4").tobytes()
    return header + count + records.tobytes()


def _text(made: Sequence[Mesh]) -> bytes:
    lines: list[str] = []
    for mesh in made:
        lines.append(f"solid {mesh.name}")
        for normal, corners in zip(_normals(mesh), mesh.corners, strict=True):
            lines += [f"facet normal {_numbers(normal)}", "outer loop"]
            lines += [f"vertex {_numbers(corner)}" for corner in corners]
            lines += ["endloop", "endfacet"]
        lines.append(f"endsolid {mesh.name}")
    return ("\n".join(lines) + "\n").encode()


def _normals(mesh: Mesh) -> NDArray[np.float64]:
    a, b, c = mesh.corners.swapaxes(0, 1)
    normals = np.cross(b - a, c - a)
    sizes = np.linalg.norm(normals, axis=1, keepdims=True)
    found: NDArray[np.float64] = np.divide(normals, sizes, out=np.zeros_like(normals), where=sizes > 0)
    return found


def _numbers(point: NDArray[np.float64]) -> str:
    x, y, z = point
    return f"{x + 0.0:.9g} {y + 0.0:.9g} {z + 0.0:.9g}"


_NAMES = uuid.UUID("6f0a1d5e-6f6b-5c1a-9c53-3d9a4f7b2c10")
"""Namespace for ids, which are derived from names, so that the same drawing gives the same file."""

_LARGEST = 1e9
"""mm. Largest coordinate that lib3mf takes."""


def to_3mf(job: Job) -> Exported:
    """Writes the 3MF file. Raises ExportError as `meshes` does, and for a body too far out (E0918)."""
    import lib3mf

    made, notes = meshes(job)
    wrapper = lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    model.SetUnit(lib3mf.ModelUnit.MilliMeter)
    model.SetBuildUUID(_id("build", job.model.root.path))
    materials = model.AddBaseMaterialGroup()

    @cache
    def material(name: str, color: str, opacity: float) -> int:
        number: int = materials.AddMaterial(name, wrapper.RGBAToColor(*rgb(color), round(255 * opacity)))
        return number

    order = {body.path: index for index, body in enumerate(job.drawing.bodies)}
    for mesh in made:
        checkpoint()
        thing = _mesh_object(lib3mf, model, mesh)
        style = mesh.body.style
        color = style.color or body_fill(order[mesh.body.path])
        name, opacity = printable(style.material or mesh.body.path), style.opacity
        own = material(name, color, 1.0 if opacity is None else opacity)
        thing.SetObjectLevelProperty(materials.GetResourceID(), own)
        item = model.AddBuildItem(thing, wrapper.GetIdentityTransform())
        item.SetUUID(_id("item", mesh.body.path))
    return Exported(bytes(model.QueryWriter("3mf").WriteToBuffer()), notes=notes)


def _mesh_object(lib3mf: Any, model: Any, mesh: Mesh) -> Any:
    if np.abs(mesh.points).max() >= _LARGEST:
        message = f"`{mesh.body.path}` does not fit into 3MF: it reaches further than {_LARGEST:g} mm"
        hint = "look for a size or position that was written in another unit, or multiplied once too often"
        raise ExportError("E0918", message, hint)
    thing = model.AddMeshObject()
    thing.SetName(mesh.name)
    thing.SetUUID(_id("object", mesh.body.path))
    points = [lib3mf.Position(tuple(p)) for p in mesh.points.tolist()]
    thing.SetGeometry(points, [lib3mf.Triangle(tuple(t)) for t in mesh.triangles.tolist()])
    return thing


def _id(sort: str, path: str) -> str:
    return str(uuid.uuid5(_NAMES, f"{sort} {path}"))

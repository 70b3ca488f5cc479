"""STL: binary for one body; text, which can name them, for several."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from aidl_lang.export import Exported, Job
from aidl_lang.export.mesh import Mesh, meshes

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

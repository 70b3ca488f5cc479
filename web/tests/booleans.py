"""What `aidl_lang` asks of `manifold3d`, told as numbers: asked of that and of the stand-in."""

from __future__ import annotations

from typing import Any

import numpy as np

Polygons = list[list[tuple[float, float]]]


def told(m: Any, given: dict[str, Any]) -> dict[str, Any]:
    """Returns what comes of some polygons `a` and `b`."""
    rule = getattr(m.FillRule, given["rule"])
    a, b = (m.CrossSection([np.array(p) for p in given[name]], rule) for name in ("a", "b"))
    small, nothing = m.CrossSection.square((3.0, 2.0)).translate((-1.0, 0.5)), m.CrossSection()
    sections = {
        "a": a,
        "difference": a - b,
        "intersection": a ^ b,
        "union": m.CrossSection.batch_boolean([a, b, small], m.OpType.Add),
        "offset": a.offset(given["by"], m.JoinType.Round, 2.0, 32),
        "rough": a.offset(given["by"], m.JoinType.Round, 2.0, 32).simplify(0.5) ^ b,
        "nothing": nothing,
        "of nothing": nothing - a,
    }
    return {name: _told(section) for name, section in sections.items()} | {"solid": _solid(m, a, given["by"])}


def _told(section: Any) -> dict[str, Any]:
    pieces = [] if section.is_empty() else section.decompose()
    return {
        "polygons": [np.asarray(p).tolist() for p in section.to_polygons()],
        "area": section.area(),
        "bounds": None if section.is_empty() else list(section.bounds()),
        "empty": section.is_empty(),
        "counts": [section.num_contour(), section.num_vert()],
        "pieces": [piece.area() for piece in pieces],
    }


def _solid(m: Any, section: Any, by: float) -> dict[str, Any]:
    """Returns the triangles of what is extruded of it, less a cone and a refined plate."""
    body = section.extrude(4.0)
    cone = m.Manifold.cylinder(6.0, 0.0, 2.0, 24).translate((0.5, 0.5, 1.0))
    joined = m.Manifold.batch_boolean([cone, cone.translate((by, 0.0, 0.0))], m.OpType.Add)
    both = m.Manifold.compose([body, body.translate((100.0, 0.0, 0.0))])
    cut = both - joined - section.extrude(1.0).refine(2).translate((0.0, 0.0, 3.5))
    if cut.is_empty():
        return {"empty": True}
    mesh = cut.to_mesh64()
    points, corners = np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts, dtype=np.intp)
    first, second, third = points[corners].swapaxes(0, 1)
    volume = float(np.einsum("ij,ij->i", first, np.cross(second, third)).sum() / 6)
    return {"empty": False, "volume": volume, "box": [*points.min(axis=0), *points.max(axis=0)]}

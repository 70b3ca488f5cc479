"""The drawing as the shapes of a CAD library in Python, by way of Open CASCADE, which both share."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from aidl_lang.export.job import Job, Options, require

if TYPE_CHECKING:
    from build123d import Compound, Location

    from aidl_lang.compiled import Compiled
    from aidl_lang.export.mesh import PlacedBody
    from aidl_lang.geometry.solved import SolvedStructure


def to_build123d(compiled: Compiled, thickness: float | None) -> Compound:
    """Returns the bodies and strokes of a drawing as build123d has them, each under its dotted path: a Part
    for a solid with a thickness, a Sketch for a flat one, a Curve for strokes. One that is the whole program
    is returned itself, else all of them in a Compound under the name of the root. A body has a joint for each
    circle and point in it, under its path from the body.

    Raises ExportError if build123d is not installed or a body makes no valid shape, and AidlError if the
    program is not well.
    """
    require("build123d", "to_build123d", "build123d")
    if not compiled.ok or compiled.model is None or compiled.drawing is None:
        raise compiled.refused("the model is not ok, so there are no shapes of it")
    from build123d import Color, Compound, Curve, Part, RigidJoint, Shape, Sketch, Solid

    from aidl_lang.common.colors import rgb
    from aidl_lang.common.diagnostics import within
    from aidl_lang.export.mesh import placed_bodies
    from aidl_lang.export.step import Product, products

    def made(product: Product) -> Compound:
        shapes = [Shape.cast(each) for each in product.shapes]
        kind = Curve if product.is_stroke else Part if isinstance(shapes[0], Solid) else Sketch
        shape = kind(shapes, label=product.name)
        if product.style.color is not None:
            shape.color = Color(*(value / 255 for value in rgb(product.style.color)))
        return shape

    root = compiled.model.root
    job = Job(compiled.model, compiled.drawing, options=Options(thickness=thickness))
    with within(compiled.limit, "drawing"):
        shapes = [made(product) for product in products(job)[1]]
        for shape, placed in zip(shapes, placed_bodies(job), strict=False):  # bodies come first
            for name, place in _places(root, placed):
                RigidJoint(name, shape, place)
    return (
        shapes[0] if [s.label for s in shapes] == [root.path] else Compound(label=root.path, children=shapes)
    )


def _places(root: SolvedStructure, of: PlacedBody) -> Iterator[tuple[str, Location]]:
    """Yields the name and the place of each circle and point of a body on the face seen (z outwards)."""
    from build123d import Location, Plane

    from aidl_lang.geometry.curves import Circle

    body, plane = of.body.path, of.plane
    towards = np.cross(plane.u, plane.v)
    seen = plane.shifted(of.thickness or 0.0) if float(towards @ plane.growth) > 0 else plane
    for structure in root.walk():
        if structure.path != body and not structure.path.startswith(f"{body}."):
            continue
        for geometry in (part for each in structure.geometry for part in each.walk()):
            field = (
                "center" if isinstance(geometry.curve, Circle) else "at" if geometry.type == "point" else ""
            )
            at = geometry.values.get(field)
            if geometry.piece_of is None and isinstance(at, tuple) and len(at) == 2:
                place = Plane(tuple(seen.at(*at)), tuple(plane.u), tuple(towards))
                yield geometry.path.removeprefix(f"{body}."), Location(place)

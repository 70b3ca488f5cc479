"""The drawing as the shapes of a CAD library in Python, by way of Open CASCADE, which both share."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aidl_lang.export import Job, Options, require

if TYPE_CHECKING:
    from build123d import Compound

    from aidl_lang.compiled import Compiled


def to_build123d(compiled: Compiled, thickness: float | None) -> Compound:
    """Returns the bodies and strokes of a drawing as build123d has them, each under its dotted path: a Part
    for a solid with a thickness, a Sketch for a flat one, a Curve for strokes. One that is the whole program
    is returned itself, else all of them in a Compound under the name of the root.

    Raises ExportError if build123d is not installed or a body makes no valid shape, and AidlError if the
    program is not well.
    """
    require("build123d", "to_build123d", "build123d")
    if not compiled.ok or compiled.model is None or compiled.drawing is None:
        raise compiled.refused("the model is not ok, so there are no shapes of it")
    from build123d import Color, Compound, Curve, Part, Shape, Sketch, Solid

    from aidl_lang.common.colors import rgb
    from aidl_lang.common.drawing_time import within
    from aidl_lang.export.step import Product, products

    def made(product: Product) -> Compound:
        shapes = [Shape.cast(each) for each in product.shapes]
        kind = Curve if product.is_stroke else Part if isinstance(shapes[0], Solid) else Sketch
        shape = kind(shapes, label=product.name)
        if product.style.color is not None:
            shape.color = Color(*(value / 255 for value in rgb(product.style.color)))
        return shape

    job = Job(compiled.model, compiled.drawing, options=Options(thickness=thickness))
    with within(compiled.limit, "drawing"):
        shapes = [made(product) for product in products(job)[1]]
    root = compiled.model.root.path
    return shapes[0] if [each.label for each in shapes] == [root] else Compound(label=root, children=shapes)

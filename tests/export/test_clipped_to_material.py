"""Drawings on a solid with holes, in every format: as written they go on over the holes, and clipped to the
solid they end there. What the files hold is read by other libraries.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import pytest
from shapely import LineString, MultiLineString, Point, box, unary_union
from shapely.geometry.base import BaseGeometry

from aidl_lang import Model
from tests.compiled import model
from tests.export.readers import dxf_of, svg_origin, svg_paths

PITCH = 3
PROGRAM = """
@thickness(3mm) @stroke(0.1mm) @color("white") solid outer {
    rim = rectangle(center: fixed((0, 0)), width: 80, height: 50)
    hole slit { gap = rectangle(center: fixed((0, 15)), width: 70, height: 4) }
    hole bore { rim = circle(center: fixed((10, 0)), radius: 8) }
    @color("black") CLIP drawing engraved {
        for i in 0..20 { way[i] = line((-50, PITCH * i - 30), (50, PITCH * i - 30)) }
    }
}
""".replace("PITCH", str(PITCH))
NESTED = """
assembly view {
    @detached solid outer {
        body = rectangle(center: fixed((0, 0)), width: fixed(90), height: fixed(60))
        hole slit { gap = rectangle(center: fixed((20, 0)), width: fixed(10), height: fixed(40)) }
        solid plate {
            body = rectangle(center: fixed((0, 0)), width: fixed(60), height: fixed(30))
            @clip(plate) drawing engraved {
                way = line(fixed((-50, 0)), fixed((50, 0)))
                drawing deeper { way = line(fixed((0, -50)), fixed((0, 50))) }
            }
        }
    }
    @detached twin = mirror(outer, about: line((60, 0), (60, 10)))
    @clip(outer) drawing beside { way = line(fixed((-60, 14)), fixed((60, 14))) }
    low = copy(beside, by: (0, -10))
}
"""
MATERIAL = box(-40, -25, 40, 25) - box(-35, 13, 35, 17) - Point(10, 0).buffer(8, quad_segs=256)
WRITTEN = MultiLineString([[(-50, PITCH * i - 30), (50, PITCH * i - 30)] for i in range(21)])


@cache
def compiled(clip: str) -> Model:
    found = model(PROGRAM.replace("CLIP", clip))
    assert found.ok
    return found


def ink_in_svg(made: Model) -> BaseGeometry:
    """Strokes of the picture, y up; what the picture's frame adds is taken away by the viewBox."""
    svg = made.export("svg")
    left, top = svg_origin(svg)
    return unary_union(
        [
            LineString([(p.x - left, -p.y - top) for p in (line.start, line.end)])
            for path in svg_paths(svg)
            if path.fill.value is None
            for line in path
            if type(line).__name__ == "Line"
        ]
    )


def ink_in_dxf(made: Model) -> BaseGeometry:
    space = dxf_of(made.export("dxf")).modelspace()
    return unary_union(
        [
            LineString([tuple(e.dxf.start)[:2], tuple(e.dxf.end)[:2]])
            for e in space.query("LINE[layer=='drawing']")
        ]
    )


def ink_in_drawing(made: Model) -> BaseGeometry:
    strokes = made._compiled.drawing.strokes  # type: ignore[union-attr]
    return unary_union([LineString([p.start, p.end]) for s in strokes for p in s.pieces])  # type: ignore[union-attr]


@pytest.mark.parametrize("read", [ink_in_svg, ink_in_dxf, ink_in_drawing])
def test_strokes_end_at_the_holes_of_their_solid(read: Callable[[Model], BaseGeometry]) -> None:
    hole = Point(10, 0).buffer(7.9)
    whole, clipped = read(compiled("")), read(compiled("@clip(outer)"))
    assert whole.difference(WRITTEN.buffer(0.01)).is_empty
    assert whole.length == pytest.approx(WRITTEN.length, rel=1e-4)
    assert whole.intersection(hole).length == pytest.approx(WRITTEN.intersection(hole).length, rel=1e-3)
    expected = WRITTEN.intersection(MATERIAL)
    assert clipped.length == pytest.approx(expected.length, rel=1e-4)
    assert clipped.intersection(hole).is_empty
    assert clipped.difference(MATERIAL.buffer(0.01)).is_empty
    assert len(clipped.geoms) == len(expected.geoms)  # type: ignore[attr-defined]


def test_nested_drawings_and_copies_end_at_the_same_material() -> None:
    """A copy that comes with its solid ends at the copy of that, the drawing alone at the same solid."""
    strokes = model(NESTED)._compiled.drawing.strokes  # type: ignore[union-attr]
    lengths: dict[str, float] = {}
    for s in strokes:
        own = sum(LineString([p.start, p.end]).length for p in s.pieces)  # type: ignore[union-attr]
        lengths[s.path] = lengths.get(s.path, 0) + own
    plate = {"engraved": 60 - 10, "engraved.deeper": 30}
    expected = {f"view.{of}.plate.{name}": size for of in ("outer", "twin") for name, size in plate.items()}
    assert lengths == pytest.approx(expected | {"view.beside": 90 - 10, "view.low": 90 - 10})

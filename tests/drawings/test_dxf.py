"""DXF files: each kind of entity as an exact curve, units, layers and blocks, beside what ezdxf flattens."""

from __future__ import annotations

import io
import math
from collections.abc import Callable

import ezdxf
import pytest
from ezdxf import path
from ezdxf.disassemble import recursive_decompose
from ezdxf.document import Drawing
from ezdxf.layouts import Modelspace
from shapely.geometry import LineString, MultiLineString

from aidl_lang.common.drawings import OutlineFile, outlines
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line
from aidl_lang.geometry.faces import curve_of
from aidl_lang.geometry.region import length

Draw = Callable[[Modelspace], object]


def made(draw: Draw, units: int = 4) -> tuple[Drawing, OutlineFile]:
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = units
    for name in ("B", "A"):
        document.blocks.new(name)
    draw(document.modelspace())
    text = io.StringIO()
    document.write(text)
    return document, outlines("a.dxf", text.getvalue().encode())


def flattened(document: Drawing) -> MultiLineString:
    """What ezdxf makes of the outlines."""
    paths = (path.make_path(e) for e in recursive_decompose(document.modelspace()))
    return MultiLineString([LineString([(p.x, p.y) for p in each.flattening(1e-5)]) for each in paths])


DRAWN: dict[str, tuple[Draw, list[type]]] = {
    "line": (lambda m: m.add_line((1, 2), (3, 4)), [Line]),
    "arc": (lambda m: m.add_arc((1, 2), 5, 30, 190), [Arc]),
    "arc over zero": (lambda m: m.add_arc((1, 2), 5, 300, 20), [Arc]),
    "arc seen from below": (
        lambda m: m.add_arc((1, 2), 5, 30, 190, dxfattribs={"extrusion": (0, 0, -1)}),
        [Arc],
    ),
    "circle": (lambda m: m.add_circle((1, 2), 5), [Circle]),
    "tilted circle": (lambda m: m.add_circle((1, 2), 5, dxfattribs={"extrusion": (0, 0.6, 0.8)}), [Ellipse]),
    "ellipse": (lambda m: m.add_ellipse((1, 2), (5, 1), 0.4), [Ellipse]),
    "piece of an ellipse": (lambda m: m.add_ellipse((1, 2), (5, 1), 0.4, 1, 4), [EllipseArc]),
    "polyline": (
        lambda m: m.add_lwpolyline([(0, 0, 0.5), (9, 0, 0), (9, 5, -1.5), (0, 5, 0)], "xyb", close=True),
        [Arc, Line, Arc, Line],
    ),
    "old polyline": (
        lambda m: m.add_polyline2d([(0, 0, 0.5), (9, 0, 0), (9, 5, 0)], "xyb", close=True),
        [Arc, Line, Line],
    ),
    "polyline in space": (lambda m: m.add_polyline3d([(0, 0, 3), (9, 0, 4), (9, 5, 5)]), [Line, Line]),
    "spline": (lambda m: m.add_open_spline([(0, 0), (3, 8), (9, 8), (12, 0), (15, 3)]), [Bezier, Bezier]),
    "quadratic spline": (lambda m: m.add_open_spline([(0, 0), (3, 8), (9, 8)], degree=2), [Bezier]),
    "spline through points": (lambda m: m.add_spline([(0, 0), (3, 8), (9, 8), (12, 0)]), [Bezier] * 3),
}


@pytest.mark.parametrize("name", DRAWN)
def test_each_kind_is_its_own_exact_curve(name: str):
    draw, kinds = DRAWN[name]
    document, found = made(draw)
    curves = [curve_of(s) for s in found.whole.strokes]
    assert [type(c) for c in curves] == kinds
    theirs = flattened(document)
    assert math.isclose(sum(map(length, curves)), theirs.length, rel_tol=5e-4)  # a quarter is one cubic there
    assert found.whole.box == pytest.approx(theirs.bounds, abs=5e-3)
    assert not found.remarks


def test_rational_splines_are_followed_closely_and_told():
    """A quarter of a circle as a rational spline."""
    weights = [1, math.sqrt(0.5), 1]
    _, found = made(lambda m: m.add_rational_spline([(5, 0), (5, 5), (0, 5)], weights, degree=2))
    for stroke in found.whole.strokes:
        curve = curve_of(stroke)
        assert isinstance(curve, Bezier)
        middle = [
            (a + 3 * b + 3 * c + d) / 8
            for a, b, c, d in zip(curve.p0, curve.p1, curve.p2, curve.p3, strict=True)
        ]
        assert abs(math.hypot(*middle) - 5) < 5e-7
    assert [r.code for r in found.remarks] == ["N0752"]


@pytest.mark.parametrize(("units", "width"), [(1, 254), (2, 3048), (4, 10), (5, 100), (6, 10_000)])
def test_units_are_those_of_the_header(units: int, width: float):
    _, found = made(lambda m: m.add_line((0, 0), (10, 0)), units)
    assert found.whole.box == (0, 0, width, 0)
    assert not found.remarks


def test_without_a_unit_it_is_millimetres_and_told():
    _, found = made(lambda m: m.add_line((0, 0), (10, 0)), 0)
    assert found.whole.box[2] == 10
    assert [r.code for r in found.remarks] == ["N0753"]


def test_blocks_stand_in_their_places_with_their_layers():
    def draw(m: Modelspace) -> None:
        inner, outer = m.doc.blocks.get("A"), m.doc.blocks.get("B")
        inner.add_circle((0, 0), 1)
        inner.add_line((0, 0), (1, 0), dxfattribs={"layer": "marks"})
        outer.add_blockref("A", (3, 0), dxfattribs={"xscale": 2, "yscale": 2})
        m.add_blockref("B", (10, 10), dxfattribs={"layer": "cut", "rotation": 90})
        m.add_blockref("A", (0, 0), dxfattribs={"layer": "cut", "xscale": 3})
        m.add_blockref("A", (50, 50), dxfattribs={"layer": "row", "column_count": 3, "column_spacing": 5})

    document, found = made(draw)
    assert set(found.parts) == {"cut", "marks", "row", "A", "B"}
    kinds = [type(curve_of(s)) for s in found.parts["cut"].strokes]
    assert kinds == [Circle, Ellipse]
    assert curve_of(found.parts["B"].strokes[0]).box == pytest.approx((8, 11, 12, 15))
    assert found.parts["row"].box == pytest.approx((49, 49, 61, 51))
    assert found.whole.box == pytest.approx(flattened(document).bounds, abs=5e-3)


def test_what_is_hidden_or_no_outline_is_counted():
    def draw(m: Modelspace) -> None:
        m.doc.layers.add("off").off()
        m.add_circle((0, 0), 5)
        m.add_circle((0, 0), 4, dxfattribs={"layer": "off"})
        m.add_text("one")
        m.add_mtext("two")
        m.add_point((0, 0))
        m.add_hatch()

    _, found = made(draw)
    assert len(found.whole.strokes) == 1
    assert [r.message for r in found.remarks] == [
        "`a.dxf` has more than outlines; left out: 1 hidden entity, 2 texts, 1 point and 1 hatch"
    ]

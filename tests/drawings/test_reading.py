"""SVG and DXF files as exact curves: units, pages, groups, layers and blocks; beside those of svgelements and
what ezdxf flattens. Affine maps of these curves and how far they reach, against points of them.
"""

from __future__ import annotations

import io
import math
from collections.abc import Callable

import ezdxf
import numpy as np
import pytest
from ezdxf import path
from ezdxf.disassemble import recursive_decompose
from ezdxf.document import Drawing
from ezdxf.layouts import Modelspace
from fontTools.misc.transform import Transform
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely.geometry import LineString, MultiLineString
from svgelements import SVG, Shape

from aidl_lang.common import drawings
from aidl_lang.common.drawings import (
    Bow,
    Element,
    OutlineFile,
    Stroke,
    as_curves,
    bow,
    furthest,
    mapped,
    outlines,
)
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line, Piece
from aidl_lang.geometry.faces import curve_of
from aidl_lang.geometry.region import length
from tests.amount import tries

NAMES = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
NAMES += ' xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
PAGE = 'width="100mm" height="100mm" viewBox="0 0 100 100"'


def read(body: str, page: str = PAGE) -> OutlineFile:
    return outlines("a.svg", f"<svg {NAMES} {page}>{body}</svg>".encode())


def kinds(body: str) -> list[type]:
    return [type(curve_of(s)) for s in read(body).whole.strokes]


def box(body: str, page: str = PAGE) -> tuple[float, float, float, float]:
    return tuple(round(v, 6) for v in read(body, page).whole.box)  # type: ignore[return-value]


@pytest.mark.parametrize(
    ("page", "width"),
    [
        ('width="100mm" viewBox="0 0 10 10"', 100.0),
        ('height="5cm" viewBox="0 0 10 10"', 50.0),
        ('width="1in" height="1in" viewBox="0 0 10 10"', 25.4),
        ('viewBox="0 0 10 10"', 10 * 25.4 / 96),
        ('width="96" height="96"', 10 * 25.4 / 96),
        ('width="100%" height="100%" viewBox="0 0 10 10"', 10 * 25.4 / 96),
        ('width="10pt" height="10pt" viewBox="0 0 10 10"', 10 * 25.4 / 72),
    ],
)
def test_sizes_are_millimetres_by_the_page(page: str, width: float):
    left, bottom, right, _ = read('<rect width="10" height="10"/>', page).whole.box
    assert math.isclose(right - left, width, rel_tol=1e-12)
    assert left == 0.0
    if "viewBox" in page:
        assert math.isclose(bottom, 0.0, abs_tol=1e-12)


def test_y_points_up_and_the_page_stands_on_the_origin():
    assert box('<rect x="10" y="20" width="30" height="5"/>') == (10, 75, 40, 80)


def test_a_page_of_another_shape_keeps_proportions_as_it_says():
    page = 'width="200mm" height="100mm" viewBox="0 0 10 10"'
    square = '<rect width="10" height="10"/>'
    assert box(square, page) == (50, 0, 150, 100)
    assert box(square, page + ' preserveAspectRatio="xMinYMid"') == (0, 0, 100, 100)
    assert box(square, page + ' preserveAspectRatio="none"') == (0, 0, 200, 100)
    assert box(square, page + ' preserveAspectRatio="xMidYMid slice"') == (0, -50, 200, 150)


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('<circle r="5"/>', [Circle]),
        ('<circle r="5" transform="scale(2 1)"/>', [Ellipse]),
        ('<circle r="5" transform="rotate(30) scale(-2)"/>', [Circle]),
        ('<ellipse rx="5" ry="3"/>', [Ellipse]),
        ('<ellipse rx="5" ry="2.5" transform="scale(1 2)"/>', [Circle]),
        ('<rect width="9" height="5"/>', [Line] * 4),
        ('<rect width="9" height="5" rx="1"/>', [Line, Arc] * 4),
        ('<rect width="9" height="5" rx="1" ry="2"/>', [Line, EllipseArc] * 4),
        ('<rect width="4" height="4" rx="2"/>', [Arc] * 4),
        ('<path d="M0 0 A5 5 0 0 1 6 0 Z"/>', [Arc, Line]),
        ('<path d="M0 0 A5 3 0 0 1 6 0 Z"/>', [EllipseArc, Line]),
        ('<path d="M0 0a1 1 0 012 0 1 1 0 01-2 0z"/>', [Arc, Arc]),
        ('<path d="M0 0 C1 2 3 4 5 0 Q 3 -5 0 0"/>', [Bezier, Bezier]),
        ('<path d="M0 0 A0 5 0 0 1 6 0 V 3 Z"/>', [Line] * 3),
        ('<line x2="5" y2="5" stroke="red" fill="none"/>', [Line]),
        ('<polygon points="0,0 5,0 5,5"/>', [Line] * 3),
        ('<polyline points="0,0 5,0 5,5" fill="none" stroke="red"/>', [Line] * 2),
        ('<polyline points="0,0 5,0 5,5"/>', [Line] * 3),
    ],
)
def test_shapes_are_exact_curves(body: str, expected: list[type]):
    assert kinds(body) == expected


@pytest.mark.parametrize(
    "body",
    [
        '<g style="display:none"><circle r="1"/></g>',
        '<g display="none"><circle r="1"/></g>',
        '<g visibility="hidden"><circle r="1"/></g>',
        '<style>.off {display: none}</style><circle class="on off" r="1"/>',
        "<defs><circle r='1'/></defs>",
        "<symbol><circle r='1'/></symbol>",
        "<clipPath><circle r='1'/></clipPath>",
        "<circle r='0'/>",
        "<rect width='5'/>",
    ],
)
def test_what_is_not_drawn_is_not_read(body: str):
    assert kinds(f'{body}<rect width="3" height="3"/>') == [Line] * 4


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ('<circle r="1" clip-path="url(#c)"/>', "left out: 1 clipped or masked shape"),
        ('<use href="#none"/>', "left out: 1 dangling `use` element"),
        ("<video/><text/><image/>", "left out: 1 `video` element, 1 text and 1 image"),
        ('<circle r="1" transform="leap(3)"/>', "attributes that cannot be read, in `circle`"),
        ('<circle r="1 furlong" id="rim"/>', "attributes that cannot be read, in `rim`"),
    ],
)
def test_what_is_no_outline_is_told(body: str, told: str):
    (remark,) = read(f'<rect width="3" height="3"/>{body}').remarks
    assert remark.message.endswith(told)


def test_used_groups_stand_where_they_are_used():
    body = """
        <defs><g id="dot"><circle id="rim" r="1"/></g></defs>
        <symbol id="sign" viewBox="0 0 2 2"><circle cx="1" cy="1" r="1"/></symbol>
        <use id="one" href="#dot" x="10" y="10"/>
        <g transform="translate(50 50)"><use id="two" xlink:href="#dot" transform="scale(3)" x="1"/></g>
        <use id="three" href="#sign" width="20" height="20"/>
    """
    parts = read(body).parts
    assert parts["one"].box == pytest.approx((9, 89, 11, 91))
    assert parts["two"].box == pytest.approx((50, 47, 56, 53))
    assert parts["dot"].box == pytest.approx((9, 47, 56, 91))
    assert [type(curve_of(s)) for s in read(body).whole.strokes] == [Circle] * 3
    assert parts["three"].elements[0].names == ("three", "sign")


def test_an_inner_page_is_a_view_of_its_own():
    inner = '<svg x="10" y="10" width="20" height="20" viewBox="0 0 100 100">'
    assert box(f'{inner}<rect width="100" height="100"/></svg>') == (10, 70, 30, 90)


def test_names_are_ids_and_labels_once_each():
    body = """
        <g id="layer1" inkscape:label="Cut lines"><rect id="a" width="5" height="5"/></g>
        <g id="layer2" inkscape:label="layer 2"><rect id="A" x="9" width="5" height="5"/></g>
        <rect id="a_2" x="20" width="5" height="5"/><rect id="3d" x="30" width="5" height="5"/>
    """
    found = read(body)
    assert list(found.parts) == ["Cut_lines", "layer1", "a", "layer_2", "A_part", "a_2", "id_3d"]
    assert found.parts["Cut_lines"].elements == found.parts["layer1"].elements


steps = st.one_of(
    st.builds("translate({} {})".format, st.integers(-9, 9), st.integers(-9, 9)),
    st.builds("rotate({})".format, st.integers(-180, 180)),
    st.builds("rotate({} {} {})".format, st.integers(-180, 180), st.integers(-9, 9), st.integers(-9, 9)),
    st.builds("scale({})".format, st.sampled_from([0.5, 2, -1])),
    st.builds("scale({}, {})".format, st.sampled_from([0.5, 2, -1]), st.sampled_from([1, 3])),
    st.builds("skewX({})".format, st.integers(-40, 40)),
    st.builds("matrix({} 0.5 -0.5 1 2 3)".format, st.integers(1, 3)),
)


@tries(120)
@given(st.lists(st.lists(steps, max_size=3).map(" ".join), min_size=1, max_size=3))
def test_nested_transforms_are_those_of_another_reader(groups: list[str]):
    shape = '<path d="M1 2 L 8 3 C 9 9 4 7 3 8 Z"/>'
    for transform in reversed(groups):
        shape = f'<g transform="{transform}">{shape}</g>'
    page = 'viewBox="0 0 100 100"'
    (element,) = read(shape, page).whole.elements
    (theirs,) = (
        e
        for e in SVG.parse(io.StringIO(f"<svg {NAMES} {page}>{shape}</svg>")).elements()
        if isinstance(e, Shape)
    )
    expected = [(s.start.x, s.start.y) for s in theirs if s.start is not None and s.start != s.end]
    unit = 25.4 / 96
    found = [(x / unit, 100 - y / unit) for x, y in starts(element)]
    assert len(found) == len(expected)
    for p, q in zip(found, expected, strict=True):
        assert math.dist(p, q) < 1e-6 * (1 + math.hypot(*q))


def starts(element: Element) -> list[tuple[float, float]]:
    return [s[0] if isinstance(s, tuple) else s.start for s in element.strokes]


# --- DXF -------------------------------------------------------------------------------------------

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


# --- Maps and reach --------------------------------------------------------------------------------

coordinates = st.floats(-100, 100, allow_nan=False)
places = st.tuples(coordinates, coordinates)
factors = st.floats(-3, 3, allow_nan=False)
matrices = st.builds(Transform, factors, factors, factors, factors, coordinates, coordinates)
PARAMETERS = np.linspace(0, 1, 401)


def turned(center: tuple[float, float], rx: float, ry: float, turn: float, first: float, sweep: float) -> Bow:
    c, s = math.cos(turn), math.sin(turn)
    return bow(center, (rx * c, rx * s), (-ry * s, ry * c), first, sweep)


radii = st.floats(0.5, 40, allow_nan=False)
turns = st.floats(-7, 7, allow_nan=False)
sweeps = st.floats(0.2, 6.2).flatmap(lambda s: st.sampled_from([s, -s]))
bows = st.builds(turned, places, radii, radii, turns, turns, sweeps)
strokes = st.one_of(st.tuples(places, places), st.tuples(places, places, places, places), bows)


def sampled(stroke: Stroke) -> np.ndarray:
    """Points of a stroke, by its definition alone."""
    if isinstance(stroke, Bow):
        return np.array([stroke.at(stroke.first + t * stroke.sweep) for t in PARAMETERS])
    t = PARAMETERS[:, None]
    if len(stroke) == 2:
        return (1 - t) * np.array(stroke[0]) + t * np.array(stroke[1])
    a, b, c, d = (np.array(p) for p in stroke)
    return (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t * t * c + t**3 * d


def image(p: np.ndarray, matrix: Transform) -> np.ndarray:
    a, b, c, d, e, f = matrix
    return p @ np.array([[a, b], [c, d]]) + np.array([e, f])


@tries(150)
@given(strokes, matrices)
def test_the_image_of_a_curve_is_the_curve_of_the_images(stroke: Stroke, matrix: Transform):
    assert np.allclose(sampled(mapped(stroke, matrix)), image(sampled(stroke), matrix), atol=1e-9)


@tries(100)
@given(strokes, matrices, matrices)
def test_two_maps_are_one_product(stroke: Stroke, outer: Transform, inner: Transform):
    one, two = mapped(mapped(stroke, inner), outer), mapped(stroke, outer.transform(inner))
    assert np.allclose(sampled(one), sampled(two), atol=1e-8)


@tries(150)
@given(strokes, st.floats(0, 7))
def test_nothing_reaches_further_and_something_as_far(stroke: Stroke, angle: float):
    way = math.cos(angle), math.sin(angle)
    found = float((sampled(stroke) @ np.array(way)).max())
    reach = furthest([stroke], way)
    assert reach >= found - 1e-9
    assert reach <= found + 0.02  # between two of the points


@tries(200)
@given(bows, matrices)
def test_a_mapped_arc_is_the_exact_curve_in_place(stroke: Bow, matrix: Transform):
    a, b, c, d, _, _ = matrix
    assume(abs(a * d - b * c) > 0.05)
    there = mapped(stroke, matrix)
    curve = curve_of(there)
    assert isinstance(curve, Arc | EllipseArc)
    assert np.allclose(curve.points(PARAMETERS), sampled(there), atol=1e-6)
    assert np.allclose(curve.box, drawings.box([there]), atol=1e-6)


def test_circles_stay_circles_under_similarities_alone():
    circle = bow((1.0, 2.0), (5.0, 0.0), (0.0, 5.0))
    there = mapped(circle, Transform(0.6, 0.8, -0.8, 0.6, 3.0, 4.0))
    assert curve_of(there) == Circle((3.0 + 0.6 - 1.6, 4.0 + 0.8 + 1.2), 5.0)
    assert isinstance(curve_of(mapped(circle, Transform(1.0, 0.0, 0.0, 1.01, 0.0, 0.0))), Ellipse)
    skewed: Piece = curve_of(mapped(circle, Transform(1.0, 0.0, 1.0, 1.0, 0.0, 0.0)))
    assert isinstance(skewed, Ellipse)
    assert math.isclose(skewed.rx * skewed.ry, 25.0, rel_tol=1e-12)


def test_an_arc_pressed_flat_is_a_line():
    assert isinstance(curve_of(mapped(turned((0, 0), 5, 5, 0, 0, 2), Transform(1, 0, 0, 0, 0, 0))), Line)


@tries(60)
@given(bows)
def test_cubics_follow_an_arc(stroke: Bow):
    for k, (start, one, two, end) in enumerate(as_curves(stroke)):
        count = len(as_curves(stroke))
        t = stroke.first + stroke.sweep * (k + 0.5) / count
        middle = [(p + 3 * q + 3 * r + s) / 8 for p, q, r, s in zip(start, one, two, end, strict=True)]
        assert math.dist(middle, stroke.at(t)) < 1e-6

"""SVG files: units, pages, groups and their transforms, shapes; beside those of svgelements."""

from __future__ import annotations

import io
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from svgelements import SVG, Shape

from aidl_lang.common.drawings import Element, OutlineFile, outlines
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line
from aidl_lang.geometry.faces import curve_of
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

"""Inverse tasks: outlines that are to have an area, a perimeter or a centroid.

What came out is measured in the drawing, which knows nothing of the formulas.
"""

from __future__ import annotations

import math
import re

import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

import aidl_lang

SHAPES = {
    "circle": "circle(center: (3, 2), radius: guess(6))",
    "ellipse": "ellipse(center: (3, 2), rx: guess(8), ry: 5)",
    "turned ellipse": "ellipse(center: (3, 2), rx: guess(8), ry: 5, angle: 30)",
    "rectangle": "rectangle(center: (3, 2), width: guess(14), height: 8)",
    "rounded rectangle": "rounded_rectangle(center: (3, 2), width: guess(14), height: 9, radius: 2)",
    "chamfered rectangle": "chamfered_rectangle(center: (3, 2), width: guess(14), height: 9, chamfer: 2)",
    "slot": "slot(center: (3, 2), length: guess(16), width: 7)",
    "ring": "ring(center: (3, 2), outer_radius: guess(8), inner_radius: 3)",
    "trapezoid": "trapezoid(center: (3, 2), bottom_width: guess(14), top_width: 8, height: 8)",
    "triangle": "triangle((0, 0), (guess(14), 0), (3, 9))",
    "polygon": "polygon((0, 0), (guess(12), -1), (11, 9), (5, 12), (-1, 7))",
    "regular": "regular_polygon(center: (3, 2), sides: 7, radius: guess(7))",
    "star": "star(center: (3, 2), outer_radius: guess(10), inner_radius: 5)",
    "sector": "sector(center: (3, 2), radius: guess(9), start_angle: 20, end_angle: 130)",
    "segment": "segment(center: (3, 2), radius: guess(9), start_angle: 20, end_angle: 130)",
    "drop": "drop(radius: guess(6), height: 20)",
    "dome": "dome(width: guess(14), height: 8)",
}
ASKED = {"area": (110.0, 145.0), "perimeter": (46.0, 60.0)}


def solved(shape: str, asked: str) -> aidl_lang.Model:
    text = f"solid s {{\n    g = {shape}\n    constrain {asked}\n}}"
    model = aidl_lang.compile(text)
    assert model.ok, (text, [str(d) for d in model.diagnostics])
    return model


@pytest.mark.parametrize(("number", "shape"), list(enumerate(SHAPES)))
@pytest.mark.parametrize("measure", ASKED)
def test_an_outline_gets_the_measure_that_it_is_asked_for(measure: str, number: int, shape: str) -> None:
    wanted = ASKED[measure][number % 2]
    model = solved(SHAPES[shape], f"{measure}(g) == {wanted}")
    assert getattr(model.measure(), measure) == pytest.approx(wanted, rel=1e-8)


@pytest.mark.parametrize("shape", SHAPES)
def test_an_outline_gets_the_centroid_that_it_is_asked_for(shape: str) -> None:
    moved = re.sub(r"guess\((\d+)\)", r"\1", SHAPES[shape])
    x, y = solved(moved, "centroid(g) == (21, -13)").measure().centroid
    assert (x, y) == pytest.approx((21, -13), abs=1e-8)


def test_holes_are_taken_from_the_area_and_their_edges_added_to_the_perimeter() -> None:
    plate = "rectangle(center: (0, 0), width: guess(40), height: 20)"
    holes = (
        "hole a { c = circle(center: (5, 0), radius: 4) }\n hole b { c = square(center: (-5, 0), size: 3) }"
    )
    for measure, wanted in (("area", 700), ("perimeter", 150)):
        found = solved(plate, f"{measure}(s) == {wanted}\n {holes}").measure()
        assert getattr(found, measure) == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize("shape", [shape for shape in SHAPES if shape != "ring"])  # which is no one line
def test_a_point_of_an_outline_is_found_by_its_way_and_by_its_x(shape: str) -> None:
    written = re.sub(r"guess\((\d+)\)", r"\1", SHAPES[shape])
    text = f"""drawing d {{
        g = {written}
        a = point(g.edge_point(along: 1))
        b = point(g.edge_point(along: 12))
        same = point(g.edge_point(x: b.x, side: bottom))
        other = point(g.edge_point(x: b.x))
        assert abs(distance(a, b, along: g) - 11) < 1e-6
        assert min(distance(b, same), distance(b, other)) < 1e-6
    }}"""
    model = aidl_lang.compile(text)
    assert model.ok, (text, [str(d) for d in model.diagnostics])


def test_the_way_along_an_ellipse_is_its_integral() -> None:
    text = """drawing d {
        rim = ellipse(center: fixed((0, 0)), rx: fixed(30), ry: fixed(15))
        top = point(fixed((0, 15)))
        spoke = line((0, 0), guess((20, 11)))
        constrain distance(top, spoke.end, along: rim) == 25
        constrain spoke.length == 40
    }"""
    model = aidl_lang.compile(text)
    assert model.ok, [str(d) for d in model.diagnostics]
    (end,) = (g.values["end"] for g in model["d"].geometry if g.name == "spoke")
    foot = minimize_scalar(lambda t: math.dist(end, (30 * math.cos(t), 15 * math.sin(t))), (0.2, 0.6)).x
    way, _ = quad(lambda t: math.hypot(30 * math.sin(t), 15 * math.cos(t)), foot, math.pi / 2)
    assert way == pytest.approx(25, abs=1e-5)

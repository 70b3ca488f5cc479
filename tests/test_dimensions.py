"""Which dimensions come from which program, and that they are what came out of solving."""

from __future__ import annotations

import math

import pytest

from aidl_lang.export.job import Options
from aidl_lang.geometry.dimensions import dimensions
from aidl_lang.geometry.solved import Dimension, Length
from tests.compiled import compiled, json_of


def found(text: str) -> list[tuple[Dimension, ...]]:
    made = compiled(text)
    assert made.model is not None, made.diagnostics
    assert made.drawing is not None
    return dimensions(made.model, made.drawing)


def told(text: str) -> list[tuple[str, float, str]]:
    return [(f"{len(g)}x {g[0].kind}", round(g[0].value, 6), g[0].origin) for g in found(text)]


def of(text: str, origin: str) -> list[tuple[str, float]]:
    return [(kind.removeprefix("1x "), value) for kind, value, o in told(text) if o == origin]


def test_exact_sizes_have_the_name_of_their_param():
    text = """solid s {
        param w = 80
        a = rectangle(center: origin, width: w, height: w / 2)
        b = circle(radius: fixed(9))
    }"""
    groups = [g[0] for g in found(text) if g[0].origin == "param"]
    assert [(d.of, d.value, d.name) for d in groups] == [
        ("s.a.width", 80, "w"),
        ("s.a.height", 40, None),
        ("s.b.radius", 18, None),
    ]


def test_what_is_clipped_away_has_no_dimensions():
    """Of the square half is left, and of the far disc nothing; what reaches there is not drawn."""
    text = """assembly a {
        construction window = rectangle(center: origin, width: 60, height: 40)
        @clip(window) assembly inner {
            solid disc { rim = circle(center: fixed((0, 0)), radius: 8) }
            solid far { rim = circle(center: (60, 0), radius: 9) }
            solid half { body = rectangle(center: fixed((30, 0)), width: 12, height: 7) }
            solid tall { body = rectangle(center: fixed((-20, 0)), width: 6, height: 90) }
            constrain far.rim.left == disc.rim.right + 43
        }
    }"""
    assert of(text, "size") == [("diameter", 16), ("vertical", 7), ("horizontal", 6)]
    for program, is_there in ((text, False), (text.replace("@clip(window)", ""), True)):
        svg = compiled(program).export(".svg", Options(dimension=True))
        assert (b">43<" in svg) is is_there


@pytest.mark.parametrize(
    ("shape", "kind", "value"),
    [
        ("slot(center: (0, 0), length: w, width: 4)", "horizontal", 20),
        ("slot(center: (0, 0), length: w, width: 4, angle: 90deg)", "vertical", 20),
        ("slot(start: (0, 0), end: (30, 0), width: w)", "vertical", 20),
        ("rectangle(width: w, height: 4, angle: 30deg)", "aligned", 20),
        ("trapezoid(bottom_width: 40, top_width: w, height: 4)", "horizontal", 20),
        ("triangle(base: 40, height: w)", "vertical", 20),
        ("ring(outer_radius: w, inner_radius: 3)", "diameter", 40),
        ("ring(outer_radius: 50, inner_radius: w)", "diameter", 40),
        ("rounded_rectangle(width: 70, height: 60, radius: w)", "radius", 20),
        ("arc(center: (0, 0), radius: w, start_angle: 0deg, end_angle: 90deg)", "radius", 20),
        ("circle(diameter: w)", "diameter", 20),
        ("line((0, 0), length: w, angle: 90deg)", "vertical", 20),
        ("ellipse(rx: w, ry: 3)", "horizontal", 40),
    ],
)
def test_fields_are_measured_where_they_are(shape: str, kind: str, value: float):
    groups = found(f"drawing d {{ param w = 20\n a = {shape} }}")
    (exact,) = {(g[0].kind, round(g[0].value, 9)) for g in groups if g[0].origin == "param"}
    assert exact == (kind, value)


A_B = """
    a = rectangle(center: fixed((0, 0)), width: guess(20), height: guess(10))
    b = circle(center: (50, 3), radius: guess(4))
"""


@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("distance(b, a) == 30", [("aligned", 30)]),
        ("distance(b, a, 30)", [("aligned", 30)]),
        ("horizontal_distance(b, a) == 30", [("horizontal", 30)]),
        ("vertical_distance(b, a, 5)", [("vertical", 5)]),
        ("distance(b, a.top) == 12", [("vertical", 12)]),
        ("diameter(b) == 9", [("diameter", 9)]),
        ("radius(b) == 9", [("diameter", 18)]),
        ("b.radius == 9", [("diameter", 18)]),
        ("9 == b.radius", [("diameter", 18)]),
        ("a.width == 25", [("horizontal", 25)]),
        ("b.bb.height == 10", [("vertical", 10)]),
        ("b.left == a.bb.right + 7", [("horizontal", 7)]),
        ("b.bb.bottom - 3 == a.top", [("vertical", 3)]),
        ("b.center == a.top_right + (6, -2)", [("horizontal", 6), ("vertical", 2)]),
        ("b.center.x == a.center.x + 33 - 3", [("horizontal", 30)]),
        ("b.right_of(a, gap: 8)", [("horizontal", 8)]),
        ("b.over(a, gap: 6)", [("vertical", 6)]),
        ("length(a.top) == 22", [("horizontal", 22)]),
        ("b.left >= a.bb.right + 7", []),
        ("b.right_of(a, at_least: 8)", []),
        ("b.center_y == a.center.y", []),
        ("b.bb.width == a.bb.width", []),
    ],
)
def test_constraints_that_measure(statement: str, expected: list[tuple[str, float]]):
    assert of(f"drawing d {{ {A_B} constrain {statement} }}", "constraint") == expected


def test_the_same_place_is_told_once_and_the_whole_always():
    text = """solid s {
        a = rectangle(center: origin, width: 60, height: 30)
        b = rectangle(center: origin, width: 60, height: 20)
    }"""
    assert told(text) == [
        ("1x horizontal", 60, "overall"),
        ("1x vertical", 30, "overall"),
        ("1x vertical", 20, "size"),
    ]
    assert told("solid s { a = circle(radius: 20) }") == [("1x diameter", 40, "size")]


def test_values_are_those_of_the_solved_model():
    text = """assembly a {
        param w = 60
        solid s at (3, 4) rotated 25deg {
            body = rectangle(width: w, height: 20)
            hole h { rim = circle(center: (5, 2), radius: 3) }
            constrain h.rim.center == body.bottom_left + (8, 6)
        }
    }"""
    solved = json_of(text)["root"]["structures"][0]
    corner = solved["geometry"]["body"]["parts"]["bottom_left"]["at"]
    center = solved["structures"][0]["geometry"]["rim"]["center"]
    lengths = [g[0] for g in found(text) if isinstance(g[0], Length) and g[0].origin == "constraint"]
    assert sorted(d.value for d in lengths) == pytest.approx([6, 8])
    for d in lengths:
        reach = (center[0] - corner[0]) * d.along[0] + (center[1] - corner[1]) * d.along[1]
        assert abs(reach) == pytest.approx(d.value)
        assert math.degrees(math.atan2(d.along[1], d.along[0])) == pytest.approx(
            25 if d.value > 7 else -65, abs=1e-6
        )

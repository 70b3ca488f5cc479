"""Which dimensions come from which program, and that they are what came out of solving."""

from __future__ import annotations

import json
import math

import pytest

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.export import Options
from aidl_lang.geometry.dimensions import dimensions
from aidl_lang.geometry.solved import Dimension, Length, Opening, Roundness


def found(text: str) -> list[tuple[Dimension, ...]]:
    compiled = pipeline.compile(SourceFile("test.aidl", text))
    assert compiled.model is not None, compiled.diagnostics
    assert compiled.drawing is not None
    return dimensions(compiled.model, compiled.drawing)


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


def test_written_sizes_come_after_exact_ones_and_guesses_not_at_all():
    text = """drawing d {
        param r = 4
        a = circle(radius: 7)
        b = circle(center: (30, 0), radius: r)
        c = circle(center: (60, 0), radius: guess(5))
    }"""
    assert [(k, v) for k, v, o in told(text) if "diameter" in k] == [("1x diameter", 8), ("1x diameter", 14)]


def test_what_is_derived_or_construction_is_not_dimensioned():
    text = """drawing d {
        a = circle(radius: 7)
        b = circle(center: (30, 0), radius: a.radius)
        construction c = circle(radius: 2)
    }"""
    assert of(text, "size") == [("diameter", 14)]


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
        svg = pipeline.compile(SourceFile("test.aidl", program)).export(".svg", Options(dimension=True))
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


def test_angles_lie_between_what_is_drawn():
    text = """drawing d {
        a = line(fixed((0, 0)), fixed((40, 0)))
        b = line(a.start, length: 30, angle: guess(50deg))
        constrain angle(b, a) == 40deg
    }"""
    (angle,) = [g[0] for g in found(text) if isinstance(g[0], Opening)]
    assert angle.corner == pytest.approx((0, 0), abs=1e-9)
    assert (angle.value, angle.first) == pytest.approx((40, 0), abs=1e-6)
    assert angle.arms == (pytest.approx((0, 40), abs=1e-6), pytest.approx((0, 30), abs=1e-6))


def test_preferences_and_what_does_not_hold_are_no_dimensions():
    assert not of(f"drawing d {{ {A_B} prefer a.width == 25 }}", "constraint")
    text = f"drawing d {{ {A_B} constrain a.width == 25\n constrain a.width == 30 }}"
    assert all(value in (25, 30) for _, value in of(text, "constraint"))


def test_equal_holes_of_a_loop_or_a_pattern_are_one():
    loop = "for i in 0..9 { hole h[i] { rim = circle(center: fixed(polar(30, 36deg * i)), diameter: 8) } }"
    pattern = "hole dot(d = 4) { rim = circle(center: origin, diameter: d) }\n"
    pattern += "h = polar_array(dot(d: 8), n: 10, radius: 30)"
    for holes in (loop, pattern):
        assert told(f"solid s {{ body = circle(center: origin, radius: 50)\n {holes} }}") == [
            ("1x diameter", 100, "size"),
            ("10x diameter", 8, "size"),
            ("1x diameter", 60, "pattern"),
        ]


def test_steps_of_a_grid():
    text = """solid s {
        body = rectangle(center: fixed((15, 5)), width: 60, height: 30)
        for i in 0..2 {
            for j in 0..1 { hole h[i][j] { rim = circle(center: fixed((15 * i, 9 * j)), diameter: 5) } }
        }
    }"""
    assert [t for t in told(text) if t[2] == "pattern"] == [
        ("2x horizontal", 15, "pattern"),
        ("1x vertical", 9, "pattern"),
    ]


def test_fillets_are_counted():
    text = "solid s { param r = 5\n body = rectangle(width: 60, height: 30)\n fillet(body, r) }"
    ((exact, *others),) = [g for g in found(text) if isinstance(g[0], Roundness)]
    assert (exact.value, exact.name, len(others)) == (5, "r", 3)


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
    compiled = pipeline.compile(SourceFile("test.aidl", text))
    solved = json.loads(compiled.export(".json"))["root"]["structures"][0]
    corner = solved["geometry"]["body"]["parts"]["bottom_left"]["at"]
    center = solved["structures"][0]["geometry"]["rim"]["center"]
    assert compiled.model is not None
    assert compiled.drawing is not None
    groups = dimensions(compiled.model, compiled.drawing)
    lengths = [g[0] for g in groups if isinstance(g[0], Length) and g[0].origin == "constraint"]
    assert sorted(d.value for d in lengths) == pytest.approx([6, 8])
    for d in lengths:
        reach = (center[0] - corner[0]) * d.along[0] + (center[1] - corner[1]) * d.along[1]
        assert abs(reach) == pytest.approx(d.value)
        assert math.degrees(math.atan2(d.along[1], d.along[0])) == pytest.approx(
            25 if d.value > 7 else -65, abs=1e-6
        )


def test_nothing_is_measured_unless_it_is_asked_for():
    """Sizes are worked out on demand, and once."""
    compiled = pipeline.compile(
        SourceFile("test.aidl", "solid s { body = rectangle(width: 60, height: 30) }")
    )
    assert compiled.model is not None
    assert "sizes" not in vars(compiled.model)
    assert compiled.model.sizes is compiled.model.sizes


def test_an_empty_program():
    assert not found("solid s { }")

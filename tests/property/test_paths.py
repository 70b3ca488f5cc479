"""Paths, splines, gears and finger joints: the solved JSON, measured by formulas of its own."""

from __future__ import annotations

import cmath
import json
import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import shapely
from shapely import Polygon
from shapely.affinity import rotate, translate

from tests.amount import some
from tests.compiled import json_of

FINE = 64
"""Chords for a curve when an outline becomes a polygon."""


def geometry(program: str, structure: str = "") -> dict[str, Any]:
    """The geometry of the root of a program that must solve, or of one of its children."""
    found = json_of(program)
    assert found["status"] == "solved"
    root = found["root"]
    return next((s for s in root["structures"] if s["name"] == structure), root)["geometry"]


def indexed(parts: dict[str, Any], name: str) -> list[dict[str, Any]]:
    """`name[0]`, `name[1]`, … in order."""
    found: list[dict[str, Any]] = []
    while (key := f"{name}[{len(found)}]") in parts:
        found.append(parts[key])
    return found


def curve(part: dict[str, Any], t: float) -> complex:
    """A point of a curve at a share 0 to 1 of its parameter."""
    match part["type"]:
        case "circle" | "ellipse":
            rx, ry = (part[k] if k in part else part["radius"] for k in ("rx", "ry"))
            at = complex(rx * math.cos(math.tau * t), ry * math.sin(math.tau * t))
            return complex(*part["center"]) + at * cmath.rect(1, math.radians(part.get("angle", 0)))
        case "line":
            a, b = (complex(*part[k]) for k in ("start", "end"))
            return a + (b - a) * t
        case "arc":
            center = complex(*part["center"])
            a, b = (complex(*part[k]) - center for k in ("start", "end"))
            sense = -1 if part["clockwise"] else 1
            sweep = (sense * cmath.phase(b / a)) % math.tau
            return center + a * cmath.exp(1j * sense * sweep * t)
        case "bezier":
            p = [complex(*q) for q in part["points"]]
            s = 1 - t
            return s**3 * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t**3 * p[3]
    raise AssertionError(part["type"])


def heading(part: dict[str, Any], t: float) -> complex:
    """The direction of a curve at its start (0) or its end (1), of length 1, by a difference."""
    step = 1e-6 if t == 0 else -1e-6
    way = (curve(part, t + step) - curve(part, t)) * (1 if t == 0 else -1)
    return way / abs(way)


def region(parts: list[dict[str, Any]]) -> Polygon:
    """The area inside a closed chain of curves."""
    points = [curve(part, k / FINE) for part in parts for k in range(FINE)]
    return Polygon([(p.real, p.imag) for p in points])


# --- Paths ---------------------------------------------------------------------------------------

STEPS = """line_to((40, 0)), arc_to((60, 20), radius: 25, {smooth}), arc_by(70deg, radius: 8), forward(12),
    tangent_arc_to((30, 60)), bezier_to((20, 62), (10, 50), (0, 40), {smooth}), left(12, {smooth}),
    arc_to((-20, 10), center: (-12, 25)), close({smooth})"""


@pytest.mark.parametrize("moved", ["", "constrain edge.corner[0] == (70, -30)"])
def test_the_segments_of_a_path_share_their_ends(moved: str) -> None:
    steps = STEPS.format(smooth="smooth: false")
    parts = geometry(f"drawing d {{ edge = path(from: (0, 0), {steps}) {moved} }}")["edge"]["parts"]
    segments, corners = indexed(parts, "segment"), indexed(parts, "corner")
    assert len(segments) == len(corners) == 9
    for corner, segment, after in zip(corners, segments, segments[1:] + segments[:1], strict=True):
        assert abs(complex(*corner["at"]) - curve(segment, 0)) < 1e-9
        assert abs(curve(segment, 1) - curve(after, 0)) < 1e-9
    where = complex(*corners[0]["at"])
    assert abs(where - (70 - 30j if moved else 0)) < 1e-9
    assert abs(complex(*corners[5]["at"]) - where - (30 + 60j)) < 1e-9, "what was written has moved as one"
    for i in (2, 3, 4):
        assert abs(heading(segments[i - 1], 1) - heading(segments[i], 0)) < 1e-5


def test_smooth_segments_go_on_in_the_direction_of_the_one_before() -> None:
    steps = """line_to((40, 0)), arc_to((60, 20), radius: guess(25), smooth: true), arc_by(70deg, radius: 8),
        bezier_to((40, 62), (10, 50), (0, 40), smooth: true), line_to((-12, 30), smooth: true),
        arc_to((-20, 10), radius: guess(15), smooth: true)"""
    parts = geometry(f"drawing d {{ edge = path(from: (0, 0), {steps}) }}")["edge"]["parts"]
    segments = indexed(parts, "segment")
    assert len(segments) == 6
    for before, after in pairwise(segments):
        assert abs(heading(before, 1) - heading(after, 0)) < 1e-5


def test_the_area_within_a_path_of_arcs() -> None:
    """A square of 40 with half discs of 20 added on the right, and taken away on the left."""
    steps = """right(40), arc_to((40, 40), radius: 20), left(40), arc_by(180deg, radius: 20), close()"""
    program = f"solid s {{ edge = path(from: (0, 0), {steps}) }}"
    assert json_of(program)["regions"]["s"]["area"] == pytest.approx(1600 + math.pi * 400, abs=1e-6)


# --- Splines -------------------------------------------------------------------------------------


@pytest.mark.parametrize("closed", [False, True])
def test_a_spline_goes_through_its_points_without_a_corner(closed: bool) -> None:
    points = [(0, 0), (20, 15), (25, -5), (60, 10), (40, 40), (-10, 35)]
    written = ", ".join(map(str, points))
    program = f"drawing d {{ s = spline({written}, closed: {str(closed).lower()}) }}"
    segments = indexed(geometry(program)["s"]["parts"], "segment")
    assert len(segments) == len(points) - (not closed)
    for point, segment in zip(points, segments, strict=False):
        assert abs(curve(segment, 0) - complex(*point)) < 1e-9
    for before, after in pairwise(segments + segments[:1] if closed else segments):
        assert abs(curve(before, 1) - curve(after, 0)) < 1e-9
        assert abs(heading(before, 1) - heading(after, 0)) < 1e-4


@pytest.mark.parametrize("angles", [(0, 60, 120, 180), (0, 20, 90, 150, 170)])
def test_a_spline_through_points_of_a_circle_follows_it(angles: tuple[int, ...]) -> None:
    points = ", ".join(f"polar(50, {a}deg)" for a in angles)
    segments = indexed(geometry(f"drawing d {{ s = spline({points}) }}")["s"]["parts"], "segment")
    radii = [abs(curve(s, k / 50)) for s in segments for k in range(51)]
    assert max(abs(r - 50) for r in radii) < 50 * 3e-4


# --- Gears ---------------------------------------------------------------------------------------

GEARS = [(6, 20.0, 0.0), (12, 20.0, 0.3), (20, 14.5, 0.0), (20, 20.0, 0.0), (31, 25.0, -0.2), (44, 20.0, 0.0)]


def gear(parts: dict[str, Any]) -> list[dict[str, Any]]:
    """The curves of a gear in order."""
    found: list[dict[str, Any]] = []
    for tooth, root in zip(indexed(parts, "tooth"), indexed(parts, "root"), strict=True):
        inner = tooth["parts"]
        feet = [[inner[name]] if name in inner else [] for name in ("right_foot", "left_foot")]
        right, left = indexed(inner, "right_flank"), indexed(inner, "left_flank")
        found += [*feet[0], *right, inner["tip"], *reversed(left), *feet[1], root]
    return found


@pytest.mark.parametrize(("teeth", "pressure", "shift"), some(GEARS, 2))
def test_the_flanks_of_a_gear_are_involutes(teeth: int, pressure: float, shift: float) -> None:
    """Of every point its distance to the involute along the tangent to the base circle, in modules; and the
    thickness of a tooth on the pitch circle.
    """
    module = 3.0
    parts = geometry(
        f"solid s {{ g = gear(teeth: {teeth}, module: {module}, pressure_angle: {pressure}deg, "
        f"profile_shift: {shift}, center: origin, angle: 25deg) }}"
    )["g"]["parts"]
    alpha = math.radians(pressure)
    pitch = teeth * module / 2
    base = pitch * math.cos(alpha)
    thickness = module * (math.pi / 2 + 2 * shift * math.tan(alpha))
    half = thickness / 2 / pitch + math.tan(alpha) - alpha
    for number in (0, 1, teeth - 1):
        middle = cmath.exp(1j * (math.radians(25) + math.tau * number / teeth))
        inner = indexed(parts, "tooth")[number]["parts"]
        for name, side in (("right_flank", 1), ("left_flank", -1)):
            worst = 0.0
            for piece in indexed(inner, name):
                for t in np.linspace(0, 1, 101):
                    p = curve(piece, t) / middle
                    seen = cmath.phase(p) * side + half
                    reach = math.sqrt(max(abs(p) ** 2 - base**2, 0.0))
                    rolled = base * (seen + math.acos(min(base / abs(p), 1.0)))
                    worst = max(worst, abs(reach - rolled))
            assert worst < 1e-4 * module
        tip = complex(*inner["tip"]["start"])
        assert abs(tip) == pytest.approx(pitch + module * (1 + shift), abs=1e-9)
    root = indexed(parts, "root")[0]
    assert abs(complex(*root["start"])) == pytest.approx(pitch + module * (shift - 1.25), abs=1e-9)


def test_the_curves_of_a_gear_close() -> None:
    parts = geometry("solid s { g = gear(teeth: 8, module: 2, backlash: 0.1) }")["g"]["parts"]
    curves = gear(parts)
    for before, after in zip(curves, curves[1:] + curves[:1], strict=True):
        assert abs(curve(before, 1) - curve(after, 0)) < 1e-9


def assert_running(a: Polygon, b: Polygon, module: float) -> None:
    """Two gears touch on both flanks of a tooth, without play and without overlap."""
    assert a.is_valid
    assert b.is_valid
    assert a.intersection(b).area < 1e-3 * module**2
    assert a.distance(b) < 1e-3 * module
    for turn in (-0.3, 0.3):
        assert rotate(a, turn, origin=a.centroid).intersection(b).area > 1e-3 * module**2


PAIRS = [
    (11, 16, 33.0, 2.0, (0.4, 0.25)),
    pytest.param(17, 24, 200.0, 1.5, (0.0, 0.0), marks=pytest.mark.slow),  # as the first, without a shift
    pytest.param(30, 41, 0.0, 1.0, (0.0, 0.0), marks=pytest.mark.slow),
]


@pytest.mark.parametrize(("first", "second", "direction", "module", "shifts"), PAIRS)
def test_gears_that_mesh_touch_and_do_not_overlap(
    first: int, second: int, direction: float, module: float, shifts: tuple[float, float]
) -> None:
    """At the centre distance of the textbook: inv(w) = inv(a) + 2 (x1 + x2) / (z1 + z2) tan(a)."""
    teeth = first + second
    near = cmath.rect(module * teeth / 2 * 1.1, math.radians(direction))
    place = (near.real, near.imag)
    program = f"""assembly pair {{
        @detached solid a {{
            g = gear(teeth: {first}, module: {module}, center: origin, profile_shift: {shifts[0]})
        }}
        @detached solid b {{
            g = gear(teeth: {second}, module: {module}, center: {place}, profile_shift: {shifts[1]})
        }}
        constrain meshes(b.g, a.g)
    }}"""
    a, b = (region(gear(geometry(program, name)["g"]["parts"])) for name in "ab")
    alpha = math.radians(20)
    wanted = math.tan(alpha) - alpha + 2 * sum(shifts) / teeth * math.tan(alpha)
    low, high = alpha, math.radians(40)
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if math.tan(middle) - middle < wanted else (low, middle)
    distance = module * teeth / 2 * math.cos(alpha) / math.cos(low)
    assert shapely.distance(a.centroid, b.centroid) == pytest.approx(distance, abs=1e-3)
    assert_running(a, b, module)


def test_backlash_is_how_much_thinner_a_tooth_is() -> None:
    found = []
    for backlash in (0.0, 0.4):
        program = f"solid s {{ g = gear(teeth: 9, module: 2, center: origin, backlash: {backlash}) }}"
        outline = region(gear(geometry(program)["g"]["parts"]))
        circle = shapely.Point(0, 0).buffer(9, quad_segs=4000).exterior
        found.append(circle.intersection(outline).length / 9)
    assert found[0] == pytest.approx(math.pi, abs=2e-4)
    assert found[0] - found[1] == pytest.approx(0.4, abs=2e-4)


# --- Finger joints -------------------------------------------------------------------------------


def panel(width: float, height: float, edges: list[str], kerf: float = 0.0) -> Polygon:
    program = f"""solid s {{
        body = finger_panel(width: {width}, height: {height}, thickness: 4, finger: 11, kerf: {kerf},
            edges: {json.dumps(edges)}, center: origin)
    }}"""
    outline = geometry(program)["body"]["parts"]["outline"]["parts"]
    return Polygon([edge["start"] for edge in indexed(outline, "edges")])


@pytest.mark.parametrize(("height", "kerf"), [(40.0, 0.3), (61.0, 0.0)])
def test_tabs_fit_the_notches_of_an_edge_as_long(height: float, kerf: float) -> None:
    """Laid edge into edge, two panels fill the whole; a kerf lets them overlap by as much at every step."""
    right = panel(80, height, ["flat", "tabs", "flat", "flat"], kerf)
    left = translate(panel(50, height, ["flat", "flat", "flat", "notches"], kerf), 40 + 25 - 4)
    whole = right.union(left)
    assert whole.area == pytest.approx((80 + 50 - 4) * height, abs=1e-6)
    steps = 2 * (int(height / 11 / 2) * 2 + 1) - 2
    assert right.intersection(left).area == pytest.approx(steps / 2 * 4 * kerf, abs=1e-6)


def walls() -> Iterator[tuple[Polygon, tuple[int, int], tuple[int, float]]]:
    """The panels of a box 80 × 60 × 50: outline, the axes it spans, the third and where it begins there."""
    front = panel(80, 50, ["tabs", "tabs", "tabs", "tabs"])
    side = panel(60, 50, ["tabs", "notches", "tabs", "notches"])
    floor = panel(80, 60, ["notches", "notches", "notches", "notches"])
    for at in (0.0, 56.0):
        yield translate(front, 40, 25), (0, 2), (1, at)
    for at in (0.0, 76.0):
        yield translate(side, 30, 25), (1, 2), (0, at)
    for at in (0.0, 46.0):
        yield translate(floor, 40, 30), (0, 1), (2, at)


def test_six_panels_make_a_box() -> None:
    """Every point of the walls of a box belongs to one panel, and no point to two."""
    random = np.random.default_rng(7)
    points = random.uniform((0, 0, 0), (80, 60, 50), (40000, 3))
    inside = np.all((points > 4) & (points < np.array([76, 56, 46])), axis=1)
    count = np.zeros(len(points), dtype=int)
    for outline, (u, v), (axis, low) in walls():
        within = (points[:, axis] > low) & (points[:, axis] < low + 4)
        count += within & shapely.contains_xy(outline, points[:, u], points[:, v])
    assert np.all(count[inside] == 0)
    assert np.all(count[~inside] == 1)


# --- Free curves -----------------------------------------------------------------------------------


def sampled(parts: list[dict[str, Any]], fine: int) -> list[complex]:
    return [curve(part, k / fine) for part in parts for k in range(fine)] + [curve(parts[-1], 1.0)]


def test_a_wave_is_a_sine() -> None:
    program = "drawing d { w = wave(start: fixed((2, 1)), end: fixed((38, 28)), amplitude: 4, waves: 2.5) }"
    parts = geometry(program)["w"]["parts"]
    way = 36 + 27j
    for p in sampled(indexed(parts, "segment"), fine=40):
        share = (p - (2 + 1j)) / way
        height = share.imag * abs(way)
        assert height == pytest.approx(4 * math.sin(math.tau * 2.5 * share.real), abs=4e-3)


@pytest.mark.parametrize("sense", [1, -1])
def test_a_spiral_grows_evenly(sense: int) -> None:
    told = "true" if sense < 0 else "false"
    program = f"""drawing d {{
        s = spiral(center: fixed((3, 4)), start_radius: 2, end_radius: 20, turns: 3.25, clockwise: {told})
    }}"""
    points = sampled(indexed(geometry(program)["s"]["parts"], "segment"), fine=40)
    turned = np.unwrap([cmath.phase(p - (3 + 4j)) for p in points]) * sense
    assert turned[-1] == pytest.approx(3.25 * math.tau)
    for p, angle in zip(points, turned, strict=True):
        assert abs(p - (3 + 4j)) == pytest.approx(2 + 18 * angle / turned[-1], abs=5e-3)


@pytest.mark.parametrize(("call", "side"), [("coil", 4), ("spring", 4)])
@pytest.mark.parametrize("turns", [1, 3])
def test_a_cord_is_as_wide_as_said_and_unbroken(call: str, side: float, turns: int) -> None:
    told = f"start: fixed((2, 1)), end: fixed((38, 28)), width: {2 * side}, turns: {turns}"
    segments = indexed(geometry(f"drawing d {{ w = {call}({told}) }}")["w"]["parts"], "segment")
    way = 0.8 + 0.6j
    aside = [((p - (2 + 1j)) / way).imag for p in sampled([s for s in segments if s["type"] == "bezier"], 50)]
    assert [min(aside), max(aside)] == pytest.approx([-side, side], abs=0.02)
    for a, b in pairwise(sampled(segments, 1000)):
        assert abs(a - b) < 0.1


@pytest.mark.parametrize("upright", [False, True])
def test_an_s_is_smooth(upright: bool) -> None:
    ends = [(40, 15), (-40, 15), (40, -15), (-10, -30)]
    told = f"upright: {str(upright).lower()}"
    calls = (
        f"s[{k}] = s_curve(start: fixed((0, 0)), end: fixed({end}), {told})" for k, end in enumerate(ends)
    )
    drawn = geometry(f"drawing d {{ {'; '.join(calls)} }}")
    for k, end in enumerate(ends):
        parts = drawn[f"s[{k}]"]["parts"]
        points = sampled([parts["first"], parts["second"]], fine=2000)
        ways = [b - a for a, b in pairwise(points)]
        level = [(way.real if upright else way.imag) / abs(way) for way in (ways[0], ways[-1])]
        assert level == pytest.approx([0, 0], abs=2e-3)
        assert all(abs(cmath.phase(b / a)) < 5e-3 for a, b in pairwise(ways))
        assert points[-1] == pytest.approx(complex(*end))


def test_a_spline_stays_near_its_points_where_it_turns_sharply() -> None:
    """Its curves lie in the hulls of their handles, none of which is longer than its chord."""
    points = [(-97, 18), (-75, 52), (-55, 117), (-64, 90), (-84, 48)]
    parts = geometry(f"drawing d {{ s = spline({points}, closed: true) }}")["s"]["parts"]
    for segment in indexed(parts, "segment"):
        start, one, two, end = segment["points"]
        chord = math.dist(start, end)
        assert max(math.dist(start, one), math.dist(two, end)) <= chord * (1 + 1e-9)

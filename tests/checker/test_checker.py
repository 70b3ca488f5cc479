"""The checker complains when it should: true and false statements about coordinates given by hand."""

from __future__ import annotations

import copy
import json
from typing import Any

import pytest

import aidl_lang
from tests.checker.checking import broken, check
from tests.documents import ROOT

PROGRAM = """
assembly scene {{
    var gap_wanted = 2
    flat  = line((0, 0), (0, 0))
    up    = line((0, 0), (0, 0))
    slant = line((0, 0), (0, 0))
    dot   = (0, 0)
    round = circle(center: (0, 0), radius: guess(1))
    bend  = arc(center: (0, 0), start: (1, 0), end: (0, 1))
    solid low  {{ r = line((0, 0), (1, 1)) }}
    solid high {{ r = line((0, 0), (1, 1))
        hole cut {{ c = circle(center: (0, 0), radius: guess(1)) }} }}
    solid ball {{ c = circle(center: (0, 0), radius: guess(1)) }}
    solid plan {{ todo }}
    constrain {statement}
}}
"""


def _line(start: list[float], end: list[float]) -> dict[str, Any]:
    return {"type": "line", "start": start, "end": end}


def _circle(center: list[float], radius: float) -> dict[str, Any]:
    return {"type": "circle", "center": center, "radius": radius}


def _structure(name: str, geometry: dict[str, Any], *children: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {
        "name": name,
        "path": name,
        "kind": "solid",
        "frame": {"x": 0.0, "y": 0.0, "rotation": 0.0},
        "bb": None,
        "params": {},
        "geometry": geometry,
        "structures": list(children),
        **more,
    }


def _scene() -> dict[str, Any]:
    """low: 0…20 × 0…10; high: 5…15 × 12…18, a hole below; ball about (30, 5), radius 5, its frame turned."""
    cut = _structure("cut", {"c": _circle([10, 0], 3)}, kind="hole")
    geometry = {
        "flat": _line([0, 0], [10, 0]),
        "up": _line([10, 0], [10, 5]),
        "slant": _line([0, 20], [10, 30]),
        "dot": {"type": "point", "at": [5, 0]},
        "round": _circle([5, 4], 4),
        "bend": {
            "type": "arc",
            "center": [9, 5],
            "radius": 1,
            "start": [10, 5],
            "end": [9, 6],
            "clockwise": False,
        },
    }
    root = _structure(
        "scene",
        geometry,
        _structure("low", {"r": _line([0, 0], [20, 10])}),
        _structure("high", {"r": _line([5, 12], [15, 18])}, cut),
        _structure("ball", {"c": _circle([30, 5], 5)}, frame={"x": 0.0, "y": 0.0, "rotation": 30.0}),
        _structure("plan", {}, bb={"left": 40, "right": 50, "bottom": 0, "top": 10}, empty=True),
        params={"gap_wanted": 2.0},
    )
    return {"root": root, "changed": []}


def _complaints(statement: str) -> list[str]:
    text = PROGRAM.format(statement=statement)
    found = [f for f in check(text, _scene()) if f.kind == "constraint"]
    assert found
    return [str(f) for f in found if not f.holds]


TRUE = """
high.above(low); high.above(low, gap: 2); high.above(low, at_least: 1); high.above(low, gap: gap_wanted)
low.below(high, gap: 2); low.left_of(ball, gap: 5); ball.right_of(low, at_least: 5); over(high, low)
centered_horizontally(high, low); centered_vertically(ball, low); same_height(plan, ball, low)
align_bottom(ball, low, plan); align_top([ball, low]); align_center_y(ball, plan)
align_left(high, low, inset: 5); wider(low, high); taller(low, high); narrower(high, low)
shorter(high, low); no_overlap(high, low); row(low, ball, gap: 5, align: "bottom")
row([low, ball, plan], gap: 5); evenly_spaced(low, ball, plan, axis: x)
column(high, low, gap: 2, align: "center"); touching(flat, low); overlapping(low, self); ball.within(self)
horizontal(flat); vertical(up); perpendicular(flat, up); parallel(flat, flat); tangent(round, flat)
coincident(dot, flat); coincident(flat.end, up.start); midpoint(dot, flat); dot == flat.midpoint
tangent(up, bend); bend.start == up.end; bend.radius == 1; bend.sweep == 90deg; bend.end_angle == 90
distance(dot, up) == 5; distance(flat, up.end, 5); horizontal_distance(dot, up.end) == 5
angle(flat, slant, 45deg); angle(flat, slant) == 45; angle(slant, flat, 135deg); slant.angle == 0.125turn
angle(flat, slant, 45deg, ccw: true); equal(flat.length, 10); equal_length(flat, flat); radius(round, 4)
round.diameter == 8; length(up, 5); low.width == 2 * high.width; 1 <= gap_wanted <= 2; gap_wanted in 2..3
high.bottom >= low.top and up.length == 5; bend.bb.top == 6; bend.bb.left == 9; high.top - high.bottom == 6
low.top_right == (20, 10); up == 10; flat <= 0; symmetric(flat.start, flat.end, about: up.start - (5, 0))
if len([1, 2]) == 2 { horizontal(flat) }; for i in 1..3 { flat.length >= i }; ball.origin == origin
max(low.top, high.top) == 18; hypot(3, 4) == flat.length / 2
on_segment(dot, flat); on_segment((10, 2), up); coincident(flat.end, up.start, (10, 0)); collinear(flat, dot)
perpendicular(line((5, 0), (5, 9)), round); concentric(round, (5, 4)); equal(round.radius, flat.length - 6)
beside(low, ball, gap: 5); beside(ball, low, at_least: 4, align: center)
high.above(low, gap: 2, align: center)
centered_between(ball, low, plan, axis: x); centered_between(ball, plan, low); same_size(plan, ball)
centered_in(ball, low, by: (20, 0)); centered_horizontally(ball, low, by: 20); flush(ball, low, side: bottom)
align_left(high, low, by: 5); row(low, ball, pitch: 20); row(low, ball, at_least: 4)
column(high, low, at_least: 1)
evenly_spaced(low, ball, plan, gap: 5); evenly_spaced(low, ball, plan, spacing: 5, axis: x)
evenly_spaced(low, ball, pitch: 20); no_overlap(low, ball, plan, at_least: 5); wider(low, high, by: 10)
narrower(high, low, at_least: 10); taller(low, high, by: 4); shorter(high, low, by: 4)
distance(dot, up, at_least: 4); distance(dot, up, at_least: 4, at_most: 6)
vertical_distance(dot, up.end, at_most: 5)
angle(flat, 0deg); angle(slant, 225deg); angle(up.end, flat.end, flat.start, 90deg)
distance(round, ball) >= 25
on_circle(flat.start, flat.end, center: (5, 0), radius: 5)
on_circle([up.end, dot], center: (5, 5), r: 5, evenly: false)
on_circle([flat.start, flat.end], center: (5, 0), diameter: 10, start: 180deg); gap(low, ball) == 5
at_corners((0, 0), (20, 0), (20, 10), (0, 10), low)
at_corners([(2, 1), (18, 1), (18, 9), (2, 9)], low, inset: (2, 1))
spread(low, ball, plan, inside: self, axis: x, margin: 0); spread(ball, plan, inside: [ball, plan], margin: 0)
spread(ball, inside: ball); symmetric(low, (5, 5), about: 7.5); symmetric(round, ball, about: (17.5, 4.5))
inside(high, self, margin: (4, 0))
mirror_of(flat.start, flat.end, about: (5, 0)); mirror_of(flat, flat, about: dot)
symmetric(round, about: line((5, 0), (5, 1)))
symmetric([flat.start, dot, flat.end], about: line((5, 0), (5, 1))); symmetric(flat.start, flat.end, about: 5)
clearance(round, ball.c) == hypot(25, 1) - 9; clearance(dot, up) == 5; clearance(dot, round) == 0
clearance(up, flat) <= 0
between(dot, up.start) == (7.5, 0); between(dot, up.start, 0.2).x == 6; anchor(low, "top_left") == (0, 10)
low.spot(0.25, 0.5) == (5, 5); spots(low, [(0, 1), (1, 0)])[1] == (20, 0)
coincident(ball.origin, vertical_through(origin)); coincident(up.end, line_through(dot, 45deg))
len(range(2, 9, 3)) == 3; sum([i * x for i, x in enumerate([5, 7])]) == 7
sum([a + b for a, b in zip([1], [2])]) == 3
record(a: 3, b: [4]).b[0] == 4; len([1] + [2, 3]) == flat.length - 7
for i in 0..10 step 5 { flat.length >= i }
"""

FALSE = """
low.above(high); high.above(low, gap: 1); high.above(low, at_least: 3); high.above(low, gap: 2 * gap_wanted)
low.below(high, gap: 2.001); low.left_of(ball, gap: 4); ball.right_of(low, at_least: 6); over(low, high)
centered_horizontally(ball, low); centered_vertically(high, low); same_height(high, low)
same_width(low, high); align_bottom(high, low); align_top([ball, high]); align_center_x(ball, plan)
align_left(high, low); wider(high, low); taller(high, low); narrower(low, high); shorter(low, high)
no_overlap(low, self); row(low, ball, gap: 4); row(low, high, gap: 5)
evenly_spaced(low, high, plan, axis: x); touching(low, high); column(high, low, gap: 2, align: "left")
overlapping(low, high); low.within(high); inside(low, self, margin: 1); horizontal(up); vertical(flat)
perpendicular(flat, slant); parallel(flat, slant); tangent(round, up); coincident(dot, up)
coincident(flat.start, up.start); midpoint(dot, slant); dot == flat.start; concentric(round, bend)
tangent(slant, bend); bend.start == up.start; bend.radius == 2; bend.sweep == 270deg; collinear(flat, slant)
distance(dot, up) == 4; distance(flat, up.end, 4); vertical_distance(dot, up.end) == 4
angle(flat, slant, 44deg); angle(flat, slant) == 46; angle(flat, slant, 45deg, ccw: false); equal(flat, up)
equal_length(flat, slant); radius(round, 5); length(up, 4); low.width == high.width; 1 <= gap_wanted <= 1.5
gap_wanted in 3..4; high.bottom >= low.top and up.length == 4; bend.bb.top == 5; bend.bb.right == 9
low.top_right == (20, 11); up == 9; flat >= 1; low.left == 0.00001; for i in 1..11 { flat.length >= i }
min(low.top, high.top) == 18; 2 == 3
on_segment((11, 0), flat); on_segment(dot, up); coincident(flat.end, up.start, (10, 1))
collinear(flat, round)
perpendicular(up, round); concentric(round, (5, 5)); equal(round, ball.c)
beside(low, ball, gap: 4); beside(ball, high, at_least: 4, align: top); high.above(low, gap: 2, align: left)
centered_between(high, low, plan, axis: x); same_size(plan, low)
centered_in(ball, low, by: (21, 0)); centered_horizontally(ball, low, by: 19); flush(ball, low, side: left)
align_left(high, low, by: 4); row(low, ball, pitch: 21); row(low, ball, at_least: 6)
column(high, low, at_least: 3)
evenly_spaced(low, ball, plan, gap: 4); evenly_spaced(low, ball, plan, spacing: 4, axis: x)
evenly_spaced(low, ball, pitch: 19); no_overlap(low, ball, plan, at_least: 6); wider(low, high, by: 9)
narrower(high, low, at_least: 11); taller(low, high, by: 5); shorter(high, low, by: 3)
distance(dot, up, at_least: 6); distance(dot, up, at_least: 2, at_most: 4)
vertical_distance(dot, up.end, at_most: 4)
angle(flat, 10deg); angle(slant, 44deg); angle(up.end, flat.end, flat.start, 80deg)
distance(round, ball) >= 26
on_circle(flat.start, flat.end, center: (5, 0), radius: 4); on_circle([up.end, dot], center: (5, 5), r: 5)
on_circle([flat.start, flat.end], center: (5, 0), diameter: 10, start: 0deg + 10deg); gap(low, ball) == 4
at_corners((0, 0), (20, 0), (20, 10), (10, 10), low)
at_corners([(2, 1), (18, 1), (18, 9), (2, 9)], low, inset: 2)
spread(low, ball, plan, inside: self, margin: 1, axis: x); inside(high, self, margin: (6, 0))
spread(low, ball, plan, inside: self, axis: x); evenly_spaced(plan, ball, low, axis: x)
symmetric(low, (5, 5), about: 8); symmetric(round, ball, about: (17.5, 5))
mirror_of(flat.start, flat.end, about: (6, 0)); mirror_of(flat, up, about: dot)
symmetric(round, about: line((6, 0), (6, 1)))
symmetric([flat.start, up.end, flat.end], about: line((5, 0), (5, 1)))
symmetric(flat.start, flat.end, about: 4)
clearance(round, ball.c) == 16; clearance(dot, up) == 4; clearance(dot, round) >= 1; clearance(up, flat) >= 1
between(dot, up.start) == (7, 0); between(dot, up.start, 0.2).x == 7; anchor(low, "top_left") == (0, 0)
low.spot(0.5, 0.25) == (5, 5); spots(low, [(0, 1), (1, 0)])[0] == (0, 0)
coincident(dot, vertical_through(origin)); coincident(up.end, line_through(dot, 40deg))
len(range(2, 9, 3)) == 2; sum([i * x for i, x in enumerate([5, 7])]) == 12
sum([a + b for a, b in zip([1], [2])]) == 2
record(a: 3, b: [4]).a == 4; for i in 0..20 step 5 { flat.length >= i }
"""


def _statements(text: str) -> list[str]:
    return [s.strip() for line in text.strip().splitlines() for s in line.split(";")]


def _braced(statement: str) -> str:
    return f"{{ {statement} }}"


@pytest.mark.parametrize("statement", _statements(TRUE))
def test_true_statements_hold(statement: str) -> None:
    assert _complaints(_braced(statement)) == []


@pytest.mark.parametrize("statement", _statements(FALSE))
def test_false_statements_do_not(statement: str) -> None:
    assert _complaints(_braced(statement)) != []


def test_a_box_used_with_that_of_a_descendant_leaves_it_out() -> None:
    """scene without ball reaches to x = 50 (plan); without plan to 35."""
    assert _complaints("{ ball.right == 35, self.right == 50 }") == []
    assert _complaints("{ plan.left == self.right + 5 }") == []
    assert _complaints("{ plan.left == scene.right + 4 }") != []


def test_the_box_of_a_structure_has_no_holes_in_it() -> None:
    assert _complaints("{ high.bottom == 12, high.cut.bottom == -3 }") == []


def _document(text: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(aidl_lang.compile(text).to_json())
    return found


def _numbers(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The paths of all numbers below a value."""
    if isinstance(value, dict):
        return [p for k, v in value.items() for p in _numbers(v, (*path, k))]
    if isinstance(value, list):
        return [p for i, v in enumerate(value) for p in _numbers(v, (*path, i))]
    return [path] if isinstance(value, float) else []


def _shifted(document: dict[str, Any], path: tuple[Any, ...]) -> dict[str, Any]:
    changed = copy.deepcopy(document)
    place: Any = changed
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] += 0.01
    return changed


def test_nearly_every_number_of_an_example_matters() -> None:
    """Moving one coordinate a hundredth of a millimetre breaks something, except where it is free."""
    text = (ROOT / "examples" / "telephone.aidl").read_text()
    document = _document(text)
    assert broken(text, document) == []
    receiver = document["root"]["structures"][1]
    paths = [("root", "structures", 1, "geometry", *p) for p in _numbers(receiver["geometry"])]
    noticed = [bool(broken(text, _shifted(document, p))) for p in paths]
    assert len(paths) > 20
    assert sum(noticed) >= 0.6 * len(paths)


def test_an_arc_off_its_circle_is_noticed() -> None:
    text = "drawing d { a = arc(center: (0, 0), start: (5, 0), end: (0, 5)) constrain a.radius == 6 }"
    document = _document(text)
    assert broken(text, document) == []
    document["root"]["geometry"]["a"]["end"][1] += 0.001
    assert "arc" in {f.kind for f in broken(text, document)}


def test_what_the_document_does_not_say_is_reported_as_unchecked() -> None:
    text = "solid s { var g = 5 c = circle(radius: 2) constrain g == 7 }"
    document = _document("solid s { c = circle(radius: 2) }")
    (finding,) = [f for f in check(text, document) if f.kind == "constraint"]
    assert finding.residual is None
    assert not finding.holds


GEARS = """
drawing drive {{
    pinion = gear(teeth: 12, module: 2, center: fixed((0, 0)), angle: fixed(0deg))
    wheel = gear(teeth: 20, module: 2, center: fixed(({x}, 0)), angle: fixed({angle}deg))
    {constraint}
}}
"""


@pytest.mark.parametrize(
    ("x", "angle", "constraint", "holds"),
    [
        (32, 9, "meshes(wheel, pinion)", True),
        (32, 0, "meshes(wheel, pinion)", False),
        (32.01, 9, "meshes(wheel, pinion)", False),
        (32.2, 9, "meshes(wheel, pinion, backlash: 0.2)", True),
        (32, 8.9, "pinion.mesh(wheel)", False),
    ],
)
def test_gears_mesh_where_a_tooth_meets_a_gap(x: float, angle: float, constraint: str, holds: bool) -> None:
    document = _document(GEARS.format(x=x, angle=angle, constraint=""))
    text = GEARS.format(x=x, angle=angle, constraint=f"constrain {constraint}")
    assert ([f for f in broken(text, document) if f.kind == "constraint"] == []) == holds

"""Constraints are satisfied from random first guesses, judged by their definitions on solved coordinates.

The trials of a constraint are drawings of one program, each with its own random geometry and one constraint.
"""

from __future__ import annotations

import json
import math
import random
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest
import shapely
import shapely.affinity

import aidl_lang
from tests.amount import tried

TRIALS = tried(60)
BATCH = min(25, TRIALS)
ENOUGH = 0.99
NEAR = 1e-6
STEP, ROW = 400, 10
"""How far the drawings of a program are apart, and how many stand side by side."""

Solved = dict[str, Any]
Check = Callable[[Solved], float]
"""How far a solved drawing is from what the constraint means: 0 when it holds."""

THINGS = {
    "p": "{n} = ({x}, {y})",
    "l": "{n} = line(({x}, {y}), length: guess({s}), angle: guess({t}deg))",
    "c": "{n} = circle(center: ({x}, {y}), radius: guess({s}))",
    "a": "{n} = arc(center: ({x}, {y}), radius: guess({s}), start_angle: {t}, end_angle: {t} + {u})",
    "e": "{n} = ellipse(center: ({x}, {y}), rx: guess({s}), ry: guess({s} * 0.6))",
    "r": "{n} = rectangle(center: ({x}, {y}), width: guess({s}), height: guess({w}))",
    "R": "{n} = rectangle(center: ({x}, {y}), width: {s}, height: {w}, angle: {t}deg)",
    "s": "{n} = slot(start: ({x}, {y}), end: ({x} + {s}, {y} + {w}), width: {v})",
}
"""Things by the letter that their names begin with."""


def thing(name: str, chance: random.Random) -> str:
    sizes = {"s": 8, "w": 8, "v": 4}
    numbers = {k: round(chance.uniform(low, 3 * low), 3) for k, low in sizes.items()}
    places = {k: round(chance.uniform(-50, 50), 3) for k in "xy"}
    turns = {"t": round(chance.uniform(-180, 180), 2), "u": round(chance.uniform(30, 300), 2)}
    return THINGS[name[0]].format(n=name, **numbers, **places, **turns)


# --- Definitions on solved coordinates -------------------------------------------------------------


def minus(a: list[float], b: list[float]) -> tuple[float, float]:
    return a[0] - b[0], a[1] - b[1]


def cross(a: tuple[float, float], b: tuple[float, float]) -> float:
    return a[0] * b[1] - a[1] * b[0]


def way(line: Solved) -> tuple[float, float]:
    return minus(line["end"], line["start"])


def offset(p: list[float], line: Solved) -> float:
    """The signed distance of a point from an endless line."""
    return cross(way(line), minus(p, line["start"])) / math.hypot(*way(line))


def length(line: Solved) -> float:
    return math.hypot(*way(line))


def sine(a: Solved, b: Solved) -> float:
    return cross(way(a), way(b)) / length(a) / length(b)


def cosine(a: Solved, b: Solved) -> float:
    (ax, ay), (bx, by) = way(a), way(b)
    return (ax * bx + ay * by) / length(a) / length(b)


def center(g: Solved) -> list[float]:
    """Of a point, a round thing, a line or a rectangle."""
    match g["type"]:
        case "point":
            return g["at"]
        case "line":
            return [(g["start"][i] + g["end"][i]) / 2 for i in (0, 1)]
        case "rectangle":
            return g["params"]["center"]
        case _:
            return g["center"]


def apart(a: Solved, b: Solved) -> float:
    return math.dist(center(a), center(b))


def mirrored(p: list[float]) -> list[float]:
    return [-p[0], p[1]]


def reach(e: Solved, line: Solved) -> float:
    """Half the width of an upright ellipse across a line."""
    x, y = way(line)
    return math.hypot(e["rx"] * y, e["ry"] * x) / length(line)


def touch(a: Solved, b: Solved, *, inside: bool | None = None) -> float:
    outer = apart(a, b) - a["radius"] - b["radius"]
    inner = apart(a, b) - abs(a["radius"] - b["radius"])
    return min(abs(outer), abs(inner)) if inside is None else abs(inner if inside else outer)


def sides(g: Solved) -> tuple[float, float, float, float]:
    """Left, bottom, right and top of a circle or an upright rectangle."""
    (x, y), p = center(g), g.get("params", {})
    w, h = (p["width"] / 2, p["height"] / 2) if p else (g["radius"], g["radius"])
    return x - w, y - h, x + w, y + h


def short(*least: float) -> float:
    """By how much the least of some numbers is below 0."""
    return max(0.0, -min(least))


def room(a: Solved, b: Solved) -> tuple[float, float]:
    """How far two boxes are apart across and up; less than 0 when they share a part."""
    (al, ab, ar, at), (bl, bb, br, bt) = sides(a), sides(b)
    return max(al - br, bl - ar), max(ab - bt, bb - at)


def gaps(things: list[Solved], axis: int = 0) -> list[float]:
    return [sides(b)[axis] - sides(a)[axis + 2] for a, b in pairwise(things)]


def wide(g: Solved) -> float:
    return sides(g)[2] - sides(g)[0]


def tall(g: Solved) -> float:
    return sides(g)[3] - sides(g)[1]


def turn(a: Solved, b: Solved) -> float:
    return math.degrees(math.atan2(sine(a, b), cosine(a, b)))


def at_angle(found: float, *wanted: float) -> float:
    return min(abs((found - w + 180) % 360 - 180) for w in wanted)


def corner(a: list[float], at: list[float], b: list[float]) -> float:
    (ax, ay), (bx, by) = minus(a, at), minus(b, at)
    return math.degrees(abs(math.atan2(ax * by - ay * bx, ax * bx + ay * by)))


def length_of_arc(a: Solved) -> float:
    first, last = (math.atan2(*reversed(minus(a[e], a["center"]))) for e in ("start", "end"))
    return float(a["radius"] * ((last - first) % math.tau))


def even_around(things: list[Solved], radius: float) -> float:
    """On a circle about the origin, each a third of a turn from the one before, either way round."""
    at = [center(t) for t in things]
    angles = [math.degrees(math.atan2(y, x)) for x, y in at]
    steps = [at_angle(b - a, 120, -120) for a, b in pairwise(angles)]
    return max(max(abs(math.hypot(*p) - radius) for p in at), *steps)


def inner(g: Solved, inset: float) -> list[list[float]]:
    """The corners of an upright rectangle moved inwards."""
    left, bottom, right, top = sides(g)
    return [[x, y] for x in (left + inset, right - inset) for y in (bottom + inset, top - inset)]


def outline(g: Solved) -> Any:
    """As a shape of shapely: the core and how far the outline is from it."""
    match g["type"]:
        case "circle":
            return shapely.Point(g["center"]), g["radius"]
        case "line":
            return shapely.LineString([g["start"], g["end"]]), 0.0
        case "slot":
            p = g["params"]
            return shapely.LineString([p["start"], p["end"]]), p["width"] / 2
        case _:
            p = g["params"]
            w, h = p["width"] / 2, p["height"] / 2
            turned = shapely.affinity.rotate(shapely.box(-w, -h, w, h), p["angle"], origin=(0, 0))
            return shapely.affinity.translate(turned, *p["center"]), 0.0


def outline_distance(a: Solved, b: Solved) -> float:
    (p, r), (q, s) = outline(a), outline(b)
    return float(p.distance(q) - r - s)


def of(*names: str) -> Callable[[Callable[..., float]], Check]:
    """A check of some of the things of a drawing, by name."""
    return lambda compute: lambda solved: compute(*(solved[n] for n in names))


AB, ABC = of("c1", "c2"), of("r1", "r2", "r3")
CASES: dict[str, tuple[str, Check]] = {
    "coincident(p1, p2)": ("p1 p2", of("p1", "p2")(apart)),
    "coincident(p1, l2)": ("p1 l2", of("p1", "l2")(lambda p, line: abs(offset(p["at"], line)))),
    "coincident(p1, c2)": ("p1 c2", of("p1", "c2")(lambda p, c: abs(apart(p, c) - c["radius"]))),
    "coincident(p1, a2)": ("p1 a2", of("p1", "a2")(lambda p, a: abs(apart(p, a) - a["radius"]))),
    "coincident(p1, e2)": (
        "p1 e2",
        of("p1", "e2")(
            lambda p, e: abs(
                math.hypot(
                    *(d / r for d, r in zip(minus(p["at"], e["center"]), (e["rx"], e["ry"]), strict=True))
                )
                - 1
            )
        ),
    ),
    "on_segment(p1, l2)": (
        "p1 l2",
        of("p1", "l2")(
            lambda p, s: abs(math.dist(p["at"], s["start"]) + math.dist(p["at"], s["end"]) - length(s))
        ),
    ),
    "concentric(c1, r2, a3)": ("c1 r2 a3", of("c1", "r2", "a3")(lambda a, b, c: apart(a, b) + apart(b, c))),
    "midpoint(p1, l2)": ("p1 l2", of("p1", "l2")(apart)),
    "midpoint(c1, p2, p3)": (
        "c1 p2 p3",
        of("c1", "p2", "p3")(
            lambda c, p, q: math.dist(c["center"], [(p["at"][i] + q["at"][i]) / 2 for i in (0, 1)])
        ),
    ),
    "horizontal(l1)": ("l1", of("l1")(lambda a: abs(way(a)[1]))),
    "vertical(l1)": ("l1", of("l1")(lambda a: abs(way(a)[0]))),
    "horizontal(p1, c2)": ("p1 c2", of("p1", "c2")(lambda p, c: abs(p["at"][1] - c["center"][1]))),
    "vertical(p1, c2)": ("p1 c2", of("p1", "c2")(lambda p, c: abs(p["at"][0] - c["center"][0]))),
    "parallel(l1, l2)": ("l1 l2", of("l1", "l2")(lambda a, b: abs(sine(a, b)))),
    "perpendicular(l1, l2)": ("l1 l2", of("l1", "l2")(lambda a, b: abs(cosine(a, b)))),
    "perpendicular(l1, c2)": ("l1 c2", of("l1", "c2")(lambda a, c: abs(offset(c["center"], a)))),
    "collinear(l1, l2)": (
        "l1 l2",
        of("l1", "l2")(lambda a, b: abs(offset(a["start"], b)) + abs(offset(a["end"], b))),
    ),
    "collinear(p1, p2, p3)": (
        "p1 p2 p3",
        of("p1", "p2", "p3")(lambda p, q, r: abs(offset(p["at"], {"start": q["at"], "end": r["at"]}))),
    ),
    "tangent(l1, c2)": ("l1 c2", of("l1", "c2")(lambda a, c: abs(abs(offset(c["center"], a)) - c["radius"]))),
    "tangent(l1, a2)": ("l1 a2", of("l1", "a2")(lambda a, c: abs(abs(offset(c["center"], a)) - c["radius"]))),
    "tangent(l1, e2)": ("l1 e2", of("l1", "e2")(lambda a, e: abs(abs(offset(e["center"], a)) - reach(e, a)))),
    "tangent(c1, c2)": ("c1 c2", AB(touch)),
    "tangent(c1, a2)": ("c1 a2", of("c1", "a2")(touch)),
    "tangent(c1, c2, inside: true)": ("c1 c2", AB(lambda a, b: touch(a, b, inside=True))),
    "equal(l1, l2)": ("l1 l2", of("l1", "l2")(lambda a, b: abs(length(a) - length(b)))),
    "equal(c1, c2)": ("c1 c2", AB(lambda a, b: abs(a["radius"] - b["radius"]))),
    "equal(r1, r2)": ("r1 r2", of("r1", "r2")(lambda a, b: abs(wide(a) - wide(b)) + abs(tall(a) - tall(b)))),
    "equal_length(l1, a2)": ("l1 a2", of("l1", "a2")(lambda a, b: abs(length(a) - length_of_arc(b)))),
    "equal_radius(c1, a2)": ("c1 a2", of("c1", "a2")(lambda a, b: abs(a["radius"] - b["radius"]))),
    "symmetric(p1, p2, about: y_axis)": (
        "p1 p2",
        of("p1", "p2")(lambda p, q: math.dist(mirrored(p["at"]), q["at"])),
    ),
    "symmetric(l1, l2, about: y_axis)": (
        "l1 l2",
        of("l1", "l2")(
            lambda a, b: min(
                math.dist(mirrored(a["start"]), b[i]) + math.dist(mirrored(a["end"]), b[j])
                for i, j in (("start", "end"), ("end", "start"))
            )
        ),
    ),
    "symmetric(a1, a2, about: y_axis)": (
        "a1 a2",
        of("a1", "a2")(
            lambda a, b: math.dist(mirrored(a["start"]), b["end"]) + math.dist(mirrored(a["end"]), b["start"])
        ),
    ),
    "symmetric(c1, c2, about: p3)": (
        "c1 c2 p3",
        of("c1", "c2", "p3")(
            lambda a, b, p: (
                math.dist([(a["center"][i] + b["center"][i]) / 2 for i in (0, 1)], p["at"])
                + abs(a["radius"] - b["radius"])
            )
        ),
    ),
    "distance(p1, c2) == 30": ("p1 c2", of("p1", "c2")(lambda p, c: abs(apart(p, c) - 30))),
    "distance(c1, l2, 15)": ("c1 l2", of("c1", "l2")(lambda c, a: abs(abs(offset(c["center"], a)) - 15))),
    "distance(p1, p2, at_least: 20, at_most: 25)": (
        "p1 p2",
        of("p1", "p2")(lambda p, q: short(apart(p, q) - 20, 25 - apart(p, q))),
    ),
    "horizontal_distance(c1, c2) == 12": (
        "c1 c2",
        AB(lambda a, b: abs(abs(a["center"][0] - b["center"][0]) - 12)),
    ),
    "vertical_distance(c1, c2, 12)": (
        "c1 c2",
        AB(lambda a, b: abs(abs(a["center"][1] - b["center"][1]) - 12)),
    ),
    "angle(l1, l2) == 40deg": (
        "l1 l2",
        of("l1", "l2")(lambda a, b: at_angle(turn(a, b), 40, -40, 140, -140)),
    ),
    "angle(l1, l2, 40deg, ccw: true)": ("l1 l2", of("l1", "l2")(lambda a, b: at_angle(turn(a, b), 40))),
    "angle(p1, p2, p3) == 70deg": (
        "p1 p2 p3",
        of("p1", "p2", "p3")(lambda a, b, c: abs(corner(a["at"], b["at"], c["at"]) - 70)),
    ),
    "length(a1) == 20": ("a1", of("a1")(lambda a: abs(length_of_arc(a) - 20))),
    "diameter(c1, 13)": ("c1", of("c1")(lambda c: abs(2 * c["radius"] - 13))),
    "clearance(c1, R2) == 5": ("c1 R2", lambda s: abs(outline_distance(s["c1"], s["R2"]) - 5)),
    "clearance(R1, R2) >= 5": ("R1 R2", lambda s: short(outline_distance(s["R1"], s["R2"]) - 5)),
    "clearance(s1, R2) >= 3": ("s1 R2", lambda s: short(outline_distance(s["s1"], s["R2"]) - 3)),
    "clearance(s1, l2) == 4": ("s1 l2", lambda s: abs(outline_distance(s["s1"], s["l2"]) - 4)),
    "above(r1, c2, gap: 3)": ("r1 c2", of("r1", "c2")(lambda a, b: abs(sides(a)[1] - sides(b)[3] - 3))),
    "below(r1, c2, align: center)": (
        "r1 c2",
        of("r1", "c2")(lambda a, b: short(sides(b)[1] - sides(a)[3]) + abs(center(a)[0] - center(b)[0])),
    ),
    "left_of(r1, c2, at_least: 2)": (
        "r1 c2",
        of("r1", "c2")(lambda a, b: short(sides(b)[0] - sides(a)[2] - 2)),
    ),
    "right_of(r1, c2, gap: 2, align: top)": (
        "r1 c2",
        of("r1", "c2")(lambda a, b: abs(sides(a)[0] - sides(b)[2] - 2) + abs(sides(a)[3] - sides(b)[3])),
    ),
    "beside(r1, c2, gap: 2)": ("r1 c2", of("r1", "c2")(lambda a, b: abs(room(a, b)[0] - 2))),
    "stacked_on(r1, r2)": (
        "r1 r2",
        of("r1", "r2")(lambda a, b: abs(sides(a)[1] - sides(b)[3]) + abs(center(a)[0] - center(b)[0])),
    ),
    "inside(c1, r2, margin: 1)": (
        "c1 r2",
        of("c1", "r2")(
            lambda a, b: short(
                *(sides(a)[i] - sides(b)[i] - 1 for i in (0, 1)),
                *(sides(b)[i] - sides(a)[i] - 1 for i in (2, 3)),
            )
        ),
    ),
    "centered_in(c1, r2)": ("c1 r2", of("c1", "r2")(apart)),
    "centered_between(r1, r2, r3)": (
        "r1 r2 r3",
        ABC(
            lambda a, b, c: min(
                abs(sides(a)[i] + sides(a)[i + 2] - sides(p)[i + 2] - sides(q)[i])
                for i in (0, 1)
                for p, q in ((b, c), (c, b))
            )
        ),
    ),
    "align_left(r1, r2, r3, inset: 2)": (
        "r1 r2 r3",
        ABC(lambda a, b, c: sum(abs(sides(t)[0] - sides(c)[0] - 2) for t in (a, b))),
    ),
    "flush(r1, r2, side: bottom)": ("r1 r2", of("r1", "r2")(lambda a, b: abs(sides(a)[1] - sides(b)[1]))),
    "same_size(r1, c2)": (
        "r1 c2",
        of("r1", "c2")(lambda a, b: abs(wide(a) - wide(b)) + abs(tall(a) - tall(b))),
    ),
    "wider(r1, r2, by: 4)": ("r1 r2", of("r1", "r2")(lambda a, b: abs(wide(a) - wide(b) - 4))),
    "shorter(r1, r2)": ("r1 r2", of("r1", "r2")(lambda a, b: short(tall(b) - tall(a)))),
    "row(r1, r2, r3, gap: 2)": ("r1 r2 r3", ABC(lambda *t: max(abs(g - 2) for g in gaps(list(t))))),
    "row(r1, r2, r3)": ("r1 r2 r3", ABC(lambda *t: short(*gaps(list(t))))),
    "column(r1, r2, r3, pitch: 30)": (
        "r1 r2 r3",
        ABC(lambda a, b, c: max(abs(center(p)[1] - center(q)[1] - 30) for p, q in ((a, b), (b, c)))),
    ),
    "evenly_spaced(r1, r2, r3, axis: x)": (
        "r1 r2 r3",
        ABC(lambda *t: min(abs(g[0] - g[1]) for g in (gaps(list(t)), gaps(list(t[::-1]))))),
    ),
    "evenly_spaced(r1, r2, r3, axis: x, spacing: 6)": (
        "r1 r2 r3",
        ABC(lambda *t: min(abs(g[0] - 6) + abs(g[1] - 6) for g in (gaps(list(t)), gaps(list(t[::-1]))))),
    ),
    "touching(r1, c2)": ("r1 c2", of("r1", "c2")(lambda a, b: abs(max(room(a, b))))),
    "no_overlap(r1, r2, r3)": (
        "r1 r2 r3",
        ABC(lambda a, b, c: short(*(max(room(p, q)) for p, q in ((a, b), (b, c), (a, c))))),
    ),
    "overlapping(r1, c2)": ("r1 c2", of("r1", "c2")(lambda a, b: max(0.0, *room(a, b)))),
    "on_circle([c1, c2, c3], center: origin, radius: 30)": (
        "c1 c2 c3",
        of("c1", "c2", "c3")(lambda *t: even_around(list(t), 30)),
    ),
    "spread([r1, r2, r3], inside: c4, axis: y, margin: 1)": (
        "r1 r2 r3 c4",
        of("r1", "r2", "r3", "c4")(
            lambda a, b, c, box: min(
                abs(sides(p)[1] - sides(box)[1] - 1)
                + abs(sides(box)[3] - sides(q)[3] - 1)
                + abs((sides(b)[1] - sides(p)[3]) - (sides(q)[1] - sides(b)[3]))
                for p, q in ((a, c), (c, a))
            )
        ),
    ),
    "at_corners([c1, c2, c3, c4], r5, inset: 2)": (
        "c1 c2 c3 c4 r5",
        lambda s: max(
            min(math.dist(corner, s[f"c{i}"]["center"]) for i in range(1, 5)) for corner in inner(s["r5"], 2)
        ),
    ),
}


# --- The trials ------------------------------------------------------------------------------------


def trials(statement: str, names: str, chance: random.Random) -> str:
    """A program with a drawing for each trial, apart from each other and each about its own origin."""
    lines = []
    for i in range(BATCH):
        things = "; ".join(thing(name, chance) for name in names.split())
        place = f"({STEP * (i % ROW)}, {STEP * (i // ROW)})"
        lines.append(f"drawing trial{i} at {place} {{ {things}; constrain {statement} }}")
    return "\n".join(["drawing all {", *lines, "}"])


def local(value: Any, frame: Solved) -> Any:
    """Coordinates of the root in the frame of a drawing."""
    if isinstance(value, dict):
        return {k: local(v, frame) for k, v in value.items()}
    if isinstance(value, list) and len(value) == 2 and all(isinstance(v, int | float) for v in value):
        return [value[0] - frame["x"], value[1] - frame["y"]]
    return value


@pytest.mark.parametrize("statement", CASES)
def test_a_constraint_holds_from_random_guesses(statement: str) -> None:
    names, check = CASES[statement]
    chance = random.Random(statement)
    held = 0
    for _ in range(TRIALS // BATCH):
        document = json.loads(aidl_lang.compile(trials(statement, names, chance)).to_json())
        said = {c["path"]: c["satisfied"] for c in document["constraints"]}
        solved = {d["path"]: local(d["geometry"], d["frame"]) for d in document["root"]["structures"]}
        wrong = {path: geometry for path, geometry in solved.items() if check(geometry) >= NEAR}
        assert wrong.keys() == {path for path, satisfied in said.items() if not satisfied}, wrong
        assert (document["status"] == "solved") == (not wrong)
        held += BATCH - len(wrong)
    assert held >= ENOUGH * TRIALS


# --- Clearances: the closed forms against the outlines of the finished drawing -----------------------

CONVEX = {
    "circle": "circle(center: ({x}, {y}), radius: {s})",
    "slot": "slot(start: ({x}, {y}), end: ({x} + {s}, {y} - {w}), width: {w})",
    "rectangle": "rectangle(center: ({x}, {y}), width: {s}, height: {w}, angle: {t}deg)",
    "rounded": "rounded_rectangle(center: ({x}, {y}), width: 3 * {s}, height: 2 * {s}, radius: {w} / 2)",
    "triangle": "triangle(({x}, {y}), ({x} + {s}, {y} + {w}), ({x} - {w}, {y} + {s}))",
    "clockwise": "triangle(({x}, {y}), ({x} - {w}, {y} + {s}), ({x} + {s}, {y} + {w}))",
    "hexagon": "regular_polygon(center: ({x}, {y}), radius: {s}, sides: 6, angle: {t}deg)",
}


@pytest.mark.parametrize("first", CONVEX)
def test_closed_forms_of_clearance_agree_with_the_outlines(first: str) -> None:
    """Also where they overlap: an assertion never reads less than 0."""
    chance = random.Random(first)
    lines = ["drawing all {"]
    for i, second in enumerate([*CONVEX, *CONVEX]):
        shapes = (
            CONVEX[kind].format(
                x=round(chance.uniform(-25, 25), 3),
                y=round(chance.uniform(-25, 25), 3),
                s=round(chance.uniform(6, 18), 3),
                w=round(chance.uniform(3, 9), 3),
                t=round(chance.uniform(1, 90), 3),
            )
            for kind in (first, second)
        )
        a, b = shapes
        lines.append(f"drawing pair{i} at ({STEP * i}, 0) {{ a = {a}; b = {b} }}")
        lines.append(
            f"let near{i} = abs(clearance(pair{i}.a, pair{i}.b) - outline_clearance(pair{i}.a, pair{i}.b))"
        )
        lines.append(f'assert near{i} < 0.000001, "pair {i}"')
    model = aidl_lang.compile("\n".join([*lines, "}"]))
    assert [d.message for d in model.diagnostics if d.is_error] == []
    assert model.status == "solved"

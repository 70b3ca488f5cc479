"""Constraints are satisfied from random first guesses, judged by the outside check.

The trials of a constraint are drawings of one program, each with its own random geometry and one constraint.
"""

from __future__ import annotations

import json
import random
import re

import pytest

import aidl_lang
from tests.amount import tried
from tests.checker.checking import check

TRIALS = tried(60)
BATCH = min(25, TRIALS)
ENOUGH = 0.99
STEP, ROW = 400, 10
"""How far the drawings of a program are apart, and how many stand side by side."""

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


CASES = (
    "coincident(p1, p2)",
    "coincident(p1, l2)",
    "coincident(p1, c2)",
    "coincident(p1, a2)",
    "coincident(p1, e2)",
    "on_segment(p1, l2)",
    "concentric(c1, r2, a3)",
    "midpoint(p1, l2)",
    "midpoint(c1, p2, p3)",
    "horizontal(l1)",
    "vertical(l1)",
    "horizontal(p1, c2)",
    "vertical(p1, c2)",
    "parallel(l1, l2)",
    "perpendicular(l1, l2)",
    "perpendicular(l1, c2)",
    "collinear(l1, l2)",
    "collinear(p1, p2, p3)",
    "tangent(l1, c2)",
    "tangent(l1, a2)",
    "tangent(l1, e2)",
    "tangent(c1, c2)",
    "tangent(c1, a2)",
    "tangent(c1, c2, inside: true)",
    "equal(l1, l2)",
    "equal(c1, c2)",
    "equal(r1, r2)",
    "equal_length(l1, a2)",
    "equal_radius(c1, a2)",
    "symmetric(p1, p2, about: y_axis)",
    "symmetric(l1, l2, about: y_axis)",
    "symmetric(a1, a2, about: y_axis)",
    "symmetric(c1, c2, about: p3)",
    "distance(p1, c2) == 30",
    "distance(c1, l2, 15)",
    "distance(p1, p2, at_least: 20, at_most: 25)",
    "horizontal_distance(c1, c2) == 12",
    "vertical_distance(c1, c2, 12)",
    "angle(l1, l2) == 40deg",
    "angle(l1, l2, 40deg, ccw: true)",
    "angle(p1, p2, p3) == 70deg",
    "length(a1) == 20",
    "diameter(c1, 13)",
    "clearance(c1, R2) == 5",
    "clearance(R1, R2) >= 5",
    "clearance(s1, R2) >= 3",
    "clearance(s1, l2) == 4",
    "above(r1, c2, gap: 3)",
    "below(r1, c2, align: center)",
    "left_of(r1, c2, at_least: 2)",
    "right_of(r1, c2, gap: 2, align: top)",
    "beside(r1, c2, gap: 2)",
    "stacked_on(r1, r2)",
    "inside(c1, r2, margin: 1)",
    "centered_in(c1, r2)",
    "centered_between(r1, r2, r3)",
    "align_left(r1, r2, r3, inset: 2)",
    "flush(r1, r2, side: bottom)",
    "same_size(r1, c2)",
    "wider(r1, r2, by: 4)",
    "shorter(r1, r2)",
    "row(r1, r2, r3, gap: 2)",
    "row(r1, r2, r3)",
    "column(r1, r2, r3, pitch: 30)",
    "evenly_spaced(r1, r2, r3, axis: x)",
    "evenly_spaced(r1, r2, r3, axis: x, spacing: 6)",
    "touching(r1, c2)",
    "no_overlap(r1, r2, r3)",
    "overlapping(r1, c2)",
    "on_circle([c1, c2, c3], center: origin, radius: 30)",
    "spread([r1, r2, r3], inside: c4, axis: y, margin: 1)",
    "at_corners([c1, c2, c3, c4], r5, inset: 2)",
)


# --- The trials ------------------------------------------------------------------------------------


def trials(statement: str, names: str, chance: random.Random) -> str:
    """A program with a drawing for each trial, apart from each other and each about its own origin."""
    lines = []
    for i in range(BATCH):
        things = "; ".join(thing(name, chance) for name in names.split())
        place = f"({STEP * (i % ROW)}, {STEP * (i // ROW)})"
        lines.append(f"drawing trial{i} at {place} {{ {things}; constrain {statement} }}")
    return "\n".join(["drawing all {", *lines, "}"])


@pytest.mark.parametrize("statement", CASES)
def test_a_constraint_holds_from_random_guesses(statement: str) -> None:
    names = " ".join(dict.fromkeys(re.findall(r"\b[plcaerRs]\d", statement)))
    chance = random.Random(statement)
    held = 0
    for _ in range(TRIALS // BATCH):
        text = trials(statement, names, chance)
        document = json.loads(aidl_lang.compile(text).to_json())
        findings = [f for f in check(text, document) if f.kind == "constraint"]
        assert len(findings) == BATCH
        wrong = {f.path for f in findings if not f.holds}
        assert wrong == {c["path"] for c in document["constraints"] if not c["satisfied"]}
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

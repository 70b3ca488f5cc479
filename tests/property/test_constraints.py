"""Constraints are satisfied from random first guesses, judged by the outside check.

The trials of a constraint are drawings of one program, each with its own random geometry and one constraint.
"""

from __future__ import annotations

import json
import random
import re
from pathlib import Path

import pytest

import aidl_lang
from tests.amount import TRIES_ALL, tried
from tests.checker.checking import check

BATCH = min(25, tried(40))
TRIALS = tried(40) // BATCH * BATCH
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


CASES = Path(__file__).with_name("constraints.txt").read_text("utf-8").splitlines()


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
    for i, second in enumerate(CONVEX):
        if not TRIES_ALL and (i - list(CONVEX).index(first)) % 7 in (3, 5, 6):
            continue  # of each two of the seven one order is left
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

"""What holds for every program: constraints that hold, in any order."""

from __future__ import annotations

import json
import math
import random
import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import HealthCheck, Phase, assume, given, note, settings
from hypothesis import strategies as st

import aidl_lang
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from tests.amount import TRIES_ALL, tries
from tests.checker.checking import broken
from tests.compiled import FEW
from tests.documents import ROOT
from tests.property.programs import Sketch, outline_text, outlines, sketches

SCHEMA = json.loads((ROOT / "docs" / "model.schema.json").read_text("utf-8"))
TOLERANCE = 1e-6


def profile(examples: int) -> settings:
    """Compiling is slow, so there is no shrinking."""
    return tries(
        examples,
        phases=(Phase.explicit, Phase.generate),
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
    )


def document(model: aidl_lang.Model) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(model.to_json())
    return found


def coordinates(value: Any) -> list[float]:
    """All numbers of a document's structures in order of their names."""
    if isinstance(value, dict):
        return [c for k in sorted(value) if k not in ("dof", "attributes") for c in coordinates(value[k])]
    if isinstance(value, list):
        ordered = (
            sorted(value, key=lambda v: v.get("name", "")) if value and isinstance(value[0], dict) else value
        )
        return [c for v in ordered for c in coordinates(v)]
    return [float(value)] if isinstance(value, int | float) and not isinstance(value, bool) else []


def apart(a: dict[str, Any], b: dict[str, Any]) -> float:
    """The largest difference of two documents' coordinates."""
    p, q = coordinates(a["root"]), coordinates(b["root"])
    assert len(p) == len(q)
    return max((abs(x - y) for x, y in zip(p, q, strict=True)), default=0.0)


def is_degenerate(found: dict[str, Any]) -> bool:
    """Whether a line has no length, so that its direction means nothing, or all points lie on one line."""
    points = [g["at"] for g in found["root"]["geometry"].values() if g["type"] == "point"]
    (ax, ay), *others = points
    areas = [abs((b[0] - ax) * (c[1] - ay) - (b[1] - ay) * (c[0] - ax)) for b in others for c in others]
    return max(areas) < 1 or min(math.dist(p, q) for p, q in pairwise([*points, points[0]])) < 0.1


# --- (a) well-formed programs ----------------------------------------------------------------------


@given(sketches())
@profile(20)
def test_well_formed_programs_solve_and_their_constraints_hold(sketch: Sketch) -> None:
    text = sketch.text()
    note(text)
    model = aidl_lang.compile(text)
    assert [d.message for d in model.diagnostics if d.is_error] == []
    assert model.status == "solved"
    found = document(model)
    assert [str(f) for f in broken(text, found)] == []
    jsonschema.validate(found, SCHEMA)


@given(outlines())
@profile(20)
def test_outlines_that_are_said_to_be_solved_are(outline: tuple[list[str], list[str]]) -> None:
    text = outline_text(*outline)
    note(text)
    model = aidl_lang.compile(text)
    assert model.status != "wrong"
    found = document(model)
    jsonschema.validate(found, SCHEMA)
    assume(not is_degenerate(found))
    complaints = [str(f) for f in broken(text, found)]
    assert complaints == [] if model.status == "solved" else complaints != []


# --- (b) order does not matter ---------------------------------------------------------------------


def reordered(text: str, chance: random.Random) -> str:
    """The program with constraints and unrelated siblings in each other's places, in every block."""
    module = parse(SourceFile("program.aidl", text)).module
    return _Reordering(text, chance).statements(module.statements, 0, len(text), held=False)


class _Reordering:
    def __init__(self, text: str, chance: random.Random) -> None:
        self.text, self.chance = text, chance

    def statements(self, nodes: Sequence[ast.Node], start: int, end: int, held: bool) -> str:
        """The text from `start` to `end`, in which these statements stand."""
        movable = (
            [i for i, n in enumerate(nodes) if not isinstance(n, ast.Let)] if held else self._free(nodes)
        )
        order = dict(zip(movable, self.chance.sample(movable, len(movable)), strict=True))
        pieces = []
        for i, node in enumerate(nodes):
            pieces += [self.text[start : node.span.start], self._statement(nodes[order.get(i, i)], held)]
            start = node.span.end
        return "".join([*pieces, self.text[start:end]])

    def _statement(self, node: ast.Node, held: bool) -> str:
        held = isinstance(node, ast.Constrain) or (held and not isinstance(node, ast.Structure))
        pieces, start = [], node.span.start
        for block in _blocks(node):
            first, last = block.span.start, block.span.end
            pieces += [self.text[start:first], self.statements(block.statements, first, last, held)]
            start = last
        return "".join([*pieces, self.text[start : node.span.end]])

    def _free(self, nodes: Sequence[ast.Node]) -> list[int]:
        """The structures among some statements that name none of the others."""
        found = [i for i, n in enumerate(nodes) if isinstance(n, ast.Structure) and n.parameters is None]
        names = {i: re.compile(rf"\b{nodes[i].name.text}\b") for i in found}
        return [
            i
            for i in found
            if not any(
                names[j].search(nodes[i].span.text) or names[i].search(nodes[j].span.text)
                for j in found
                if j != i
            )
        ]


def _blocks(node: ast.Node) -> Iterator[ast.Block]:
    """The outermost blocks in a node, in text order."""
    for child in ast.children(node):
        if isinstance(child, ast.Block):
            yield child
        else:
            yield from _blocks(child)


@given(outlines(), st.randoms(use_true_random=False))
@profile(15)
def test_the_order_of_geometric_constraints_does_not_matter(
    outline: tuple[list[str], list[str]], chance: random.Random
) -> None:
    drawing, constraints = outline
    one = aidl_lang.compile(outline_text(drawing, constraints))
    other = aidl_lang.compile(outline_text(drawing, chance.sample(constraints, len(constraints))))
    note(outline_text(drawing, constraints))
    assert one.status == other.status
    if one.status == "solved" and not is_degenerate(document(one)):
        assert apart(document(one), document(other)) < TOLERANCE


@given(sketches(least=3), st.randoms(use_true_random=False))
@profile(10)
def test_the_order_of_independent_structures_does_not_matter(sketch: Sketch, chance: random.Random) -> None:
    parts = [p.text() for p in sketch.parts]
    one, other = sketch.text(), sketch.text(parts=chance.sample(parts, len(parts)))
    note(other)
    assert apart(document(aidl_lang.compile(one)), document(aidl_lang.compile(other))) < TOLERANCE


@pytest.mark.parametrize("path", FEW)
def test_the_order_in_an_example_does_not_matter(path: Path) -> None:
    text = path.read_text("utf-8")
    one = document(aidl_lang.compile(text))
    for seed in range(2 if TRIES_ALL else 1):
        other = reordered(text, random.Random(seed))
        assert other != text or "constrain {" not in text
        assert apart(one, document(aidl_lang.compile(other))) < TOLERANCE


# --- (c) rigid parts -------------------------------------------------------------------------------


def _distances(structure: dict[str, Any]) -> list[float]:
    """Distances between all points of a structure's own geometry, and its radii."""
    points, sizes = _points(structure["geometry"])
    return sizes + [math.dist(p, q) for i, p in enumerate(points) for q in points[:i]]


def _points(value: Any) -> tuple[list[list[float]], list[float]]:
    points: list[list[float]] = []
    sizes: list[float] = []
    for name, item in value.items():
        if name in ("radius", "rx", "ry"):
            sizes.append(item)
        elif name in ("at", "start", "end", "center"):
            points.append(item)
        elif isinstance(item, dict) and name != "params":
            below = _points(item)
            points, sizes = points + below[0], sizes + below[1]
    return points, sizes


@given(sketches())
@profile(15)
def test_a_part_that_its_parent_moves_keeps_its_shape(sketch: Sketch) -> None:
    """Only relations of boxes hold a part from outside, so it moves as a whole."""
    loose, held = (
        document(aidl_lang.compile(text)) for text in (sketch.text(relations=["1 == 1"]), sketch.text())
    )
    note(sketch.text())
    for before, after in zip(loose["root"]["structures"], held["root"]["structures"], strict=True):
        pairs = zip(_distances(before), _distances(after), strict=True)
        assert max((abs(a - b) for a, b in pairs), default=0.0) < TOLERANCE

"""What holds for every program: constraints that hold, in any order."""

from __future__ import annotations

import json
import math
import random
from itertools import pairwise
from typing import Any

import jsonschema
from hypothesis import HealthCheck, Phase, assume, given, note, settings
from hypothesis import strategies as st

import aidl_lang
from tests.amount import tries
from tests.checker.checking import broken
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
@profile(30)
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
@profile(25)
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

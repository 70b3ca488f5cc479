"""The checker complains when it should: true and false statements about a scene."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import aidl_lang
from tests.checker.checking import broken, check
from tests.documents import ROOT

SCENE = """
assembly scene {{
    var gap_wanted = 2
    flat  = line(fixed((0, 0)), fixed((10, 0)))
    up    = line(fixed((10, 0)), fixed((10, 5)))
    slant = line(fixed((0, 20)), fixed((10, 30)))
    dot   = point(fixed((5, 0)))
    round = circle(center: fixed((5, 4)), radius: fixed(4))
    bend  = arc(center: fixed((9, 5)), start: fixed((10, 5)), end: fixed((9, 6)))
    solid low  {{ r = line(fixed((0, 0)), fixed((20, 10))) }}
    solid high {{ r = line(fixed((5, 12)), fixed((15, 18)))
        hole cut {{ c = circle(center: fixed((10, 0)), radius: fixed(3)) }} }}
    solid ball rotated 30deg {{ c = circle(center: fixed(turned((30, 5), -30deg)), radius: fixed(5)) }}
    solid plan {{ todo }}
    constrain {statement}
}}
"""
PLACED = "{ plan.left == 40, plan.right == 50, plan.bottom == 0, plan.top == 10 }"


@cache
def _scene() -> dict[str, Any]:
    return _document(SCENE.format(statement=PLACED))


def _complaints(statement: str) -> list[str]:
    text = SCENE.format(statement=statement)
    found = [f for f in check(text, _scene()) if f.kind == "constraint"]
    assert found
    return [str(f) for f in found if not f.holds]


def _statements() -> Iterator[tuple[str, bool]]:
    """Those of `statements.txt`, and whether they are true of the scene."""
    for line in Path(__file__).with_name("statements.txt").read_text("utf-8").splitlines():
        if line.startswith("==="):
            is_true = line == "=== true"
        else:
            yield from ((statement.strip(), is_true) for statement in line.split(";"))


def test_what_is_true_holds_and_nothing_else() -> None:
    """Each statement stands on a line of its own."""
    statements = list(_statements())
    text = SCENE.format(statement="{\n" + ";\n".join(statement for statement, _ in statements) + "\n}")
    first = text[: text.index("constrain {")].count("\n") + 2
    found = [f for f in check(text, _scene()) if f.kind == "constraint"]
    told, false = ({f.line - first for f in some} for some in (found, [f for f in found if not f.holds]))
    assert told == set(range(len(statements)))
    assert [s for n, (s, is_true) in enumerate(statements) if (n in false) == is_true] == []


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
    pinion = gear(teeth: 6, module: 2, center: fixed((0, 0)), angle: fixed(0deg))
    wheel = gear(teeth: 8, module: 2, center: fixed(({x}, 0)), angle: fixed({angle}deg))
    {constraint}
}}
"""


@pytest.mark.parametrize(
    ("x", "angle", "constraint", "holds"),
    [
        (14, 22.5, "meshes(wheel, pinion)", True),
        (14, 0, "meshes(wheel, pinion)", False),
        (14.01, 22.5, "meshes(wheel, pinion)", False),
        (14.2, 22.5, "meshes(wheel, pinion, backlash: 0.2)", True),
        (14, 22.4, "pinion.mesh(wheel)", False),
    ],
)
def test_gears_mesh_where_a_tooth_meets_a_gap(x: float, angle: float, constraint: str, holds: bool) -> None:
    document = _document(GEARS.format(x=x, angle=angle, constraint=""))
    text = GEARS.format(x=x, angle=angle, constraint=f"constrain {constraint}")
    assert ([f for f in broken(text, document) if f.kind == "constraint"] == []) == holds

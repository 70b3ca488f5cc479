"""The checker complains when it should: true and false statements about coordinates given by hand."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import aidl_lang
from tests.checker.checking import broken, check

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


def _statements() -> Iterator[tuple[str, bool]]:
    """Those of `statements.txt`, and whether they are true of the scene."""
    for line in Path(__file__).with_name("statements.txt").read_text("utf-8").splitlines():
        if line.startswith("==="):
            is_true = line == "=== true"
        else:
            yield from ((statement.strip(), is_true) for statement in line.split(";"))


@pytest.mark.parametrize(("statement", "is_true"), list(_statements()))
def test_what_is_true_holds_and_nothing_else(statement: str, is_true: bool) -> None:
    assert (_complaints(f"{{ {statement} }}") == []) == is_true


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

"""Every example in every format, read back by a reader that is not ours, against the JSON."""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from aidl_lang import Model, compile
from tests.documents import ROOT
from tests.export import readers

EXAMPLES = sorted(p.stem for p in (ROOT / "examples").glob("*.aidl"))


@cache
def example(name: str) -> Model:
    model = compile(Path(ROOT, "examples", f"{name}.aidl"))
    assert model.ok
    return model


def bodies_of(name: str) -> dict[str, Any]:
    document = json.loads(example(name).to_json())
    return {path: document["regions"][path] for path in document["bodies"]}


def agree(found: readers.Body, told: dict[str, Any], margin: tuple[float, float], tolerance: float) -> None:
    """Areas, perimeters, boxes and numbers of loops; `margin` is where the reader has the origin."""
    assert len(found.loops) == told["loops"]
    assert max(loop.gap() for loop in found.loops) <= tolerance
    size = math.hypot(told["bb"]["right"] - told["bb"]["left"], told["bb"]["top"] - told["bb"]["bottom"])
    assert found.area == pytest.approx(told["area"], abs=tolerance * told["perimeter"])
    assert found.perimeter == pytest.approx(told["perimeter"], abs=tolerance * 100)
    left, bottom, right, top = found.box
    box = (left - margin[0], bottom - margin[1], right - margin[0], top - margin[1])
    told_box = tuple(told["bb"][side] for side in ("left", "bottom", "right", "top"))
    assert box == pytest.approx(told_box, abs=tolerance + 5e-6 * size)


@pytest.mark.parametrize("name", EXAMPLES)
def test_svg(name: str):
    """Coordinates have six decimals."""
    found, told = readers.read_svg(example(name).export(".svg")), bodies_of(name)
    assert list(found) == list(told)
    margin = readers.svg_origin(example(name).export(".svg"))
    for path, body in found.items():
        assert body.faces == len(told[path]["faces"])
        agree(body, told[path], margin, 2e-6)


@pytest.mark.parametrize("name", EXAMPLES)
def test_dxf(name: str):
    found, told = readers.read_dxf(example(name).export(".dxf")), bodies_of(name)
    drawings = {s.path for s in example(name).solved.root.walk() if s.kind == "drawing"}
    assert set(found) - drawings == set(told)
    for path in told:
        agree(found[path], told[path], (0.0, 0.0), 1e-8)

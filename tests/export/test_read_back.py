"""Every example in every format, read back by a reader that is not ours, against the JSON; and the same in
every process, whatever the seed of its hashes and whatever it wrote before.
"""

from __future__ import annotations

import io
import json
import math
import os
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
from PIL import Image
from shapely.geometry import shape
from shapely.ops import unary_union

import aidl_lang
from aidl_lang import Model
from aidl_lang.export.job import Options
from tests import compiled
from tests.amount import TRIES_ALL
from tests.documents import ROOT
from tests.export import readers
from tests.export.readers import read_meshes

ALL = [path.stem for path in compiled.EXAMPLES]
EXAMPLES = ALL if TRIES_ALL else [name for name in ALL if name not in compiled.DEAR][::3]


@cache
def example(name: str) -> Model:
    model = compiled.example(name)
    assert model.ok
    return model


@cache
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


@pytest.mark.parametrize(
    "shape",
    [
        "circle((0.12345678, 7.7654321), 20.1234567)",
        "ellipse((0.12345678, 7.7654321), 40.1234567, 20.7654321, angle: 17.3deg)",
        "slot((0.12345678, 7.7654321), (33.3333333, 41.4141414), 20.1234567)",
        "path((0, 0), line_to(40, 0.3), arc_to((0.12345678, 0.4), 19.94), close())",
    ],
)
def test_half_turns_bend_as_far_as_they_should_in_svg(shape: str):
    """A digit more or less at both ends of half a turn would move its middle by thousandths."""
    model = compiled.model(f"solid part {{ outline = {shape} }}")
    ((_, found),) = readers.read_svg(model.export(".svg")).items()
    told = json.loads(model.to_json())["regions"]["part"]
    assert abs(found.area - told["area"]) < 1e-6 * told["perimeter"]


@pytest.mark.parametrize("name", EXAMPLES)
@pytest.mark.parametrize(("kind", "tolerance"), [("splines", 1e-8), ("arcs", 0.01)])
def test_dxf(name: str, kind: str, tolerance: float):
    """Arcs are within the tolerance of curves, and so is what they enclose, over the perimeter."""
    made = example(name).export(".dxf", Options(dxf=kind))
    found, told = readers.read_dxf(made), bodies_of(name)
    engraved = {s.path for s in example(name).solved.root.walk() if s.kind != "hole"} - set(told)
    assert set(found) - engraved == set(told)
    for path in told:
        agree(found[path], told[path], (0.0, 0.0), tolerance)


@pytest.mark.parametrize("name", EXAMPLES)
def test_pdf(name: str):
    """The reader has single precision, and paths without names: in order of drawing, as the SVG has them. In
    place of each that fades there are steps.
    """
    svg = example(name).export(".svg")
    found, told = readers.read_pdf(example(name).export(".pdf")), bodies_of(name)
    fading = sum(b"stop-opacity" in each for each in svg.split(b"Gradient>"))
    at, bodies, steps = 0, 0.0, 0
    for path, role, fill in readers.svg_fills(svg):
        same = (k for k in range(at, len(found)) if found[k].area == pytest.approx(fill.area, rel=2e-5))
        if (here := next(same, None)) is None:
            steps += 1
            continue
        assert fading or here == at
        assert len(found[here].loops) == len(fill.loops)
        at, bodies = here + 1, bodies + (found[here].area if path in told and not role else 0.0)
    assert (steps, at) == (fading, len(found))
    assert bodies == pytest.approx(sum(region["area"] for region in told.values()), rel=2e-6)


@pytest.mark.parametrize("name", EXAMPLES)
def test_png(name: str):
    """The pixels that differ from the paper, where no body lies over another."""
    model, told = example(name), bodies_of(name)
    with Image.open(io.BytesIO(model.export(".png", Options(pixels=2000)))) as image:
        pixels, density = np.asarray(image.convert("L")), image.info["dpi"][0] / 25.4
    assert max(pixels.shape) == 2000
    bodies = [shape(region["geometry"]) for region in told.values()]
    strokes = any(s.kind == "drawing" for s in model.solved.root.walk())
    covered = unary_union(bodies)
    ink = 0.0025 * max(pixels.shape) / density
    seen = (pixels < 250).sum() / density**2
    if not strokes:
        assert seen == pytest.approx(covered.buffer(ink / 2).area, rel=0.01)
    else:
        assert seen > 0.99 * covered.area


@pytest.mark.parametrize("suffix", [".stl", ".3mf"])
@pytest.mark.parametrize("name", EXAMPLES)
def test_meshes(name: str, suffix: str):
    """Chords stay within a ten-thousandth of the size of a body, or a micrometre."""
    data, told = example(name).export(suffix, Options(thickness=3)), bodies_of(name)
    found = read_meshes(data, suffix)
    assert len(found) == len(told)
    for path, mesh in zip(told, found.values(), strict=True):
        region, box = told[path], told[path]["bb"]
        sides = np.array([[box["left"], box["bottom"]], [box["right"], box["top"]]])
        slack = max(1e-3, 1e-4 * np.ptp(sides, axis=0).max())
        thickness = thickness_of(example(name), path)
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(
            region["area"] * thickness, abs=thickness * slack * region["perimeter"]
        )
        assert mesh.bounds[:, :2] == pytest.approx(sides, abs=slack + 1e-4)
        assert mesh.bounds[:, 2] == pytest.approx([0, thickness], abs=1e-5)
        # A handle for each hole: an outline and its holes make a face.
        holes = sum(len(face["holes"]) for face in region["faces"])
        assert mesh.euler_number == 2 * len(region["faces"]) - 2 * holes


def thickness_of(model: Model, path: str) -> float:
    """What `@thickness` says of a structure or of the nearest around it, else the 3 mm asked for."""
    around = [s for s in model.solved.root.walk() if f"{path}.".startswith(f"{s.path}.")]
    said = [s.attributes["thickness"][0] for s in around if "thickness" in s.attributes]
    return float(said[-1]) if said else 3.0


def test_nothing_of_the_examples_is_lost():
    """What has bodies in the JSON is what the tests above have looked at."""
    assert len(EXAMPLES) >= (13 if TRIES_ALL else 5)
    assert all(bodies_of(name) for name in EXAMPLES)


KEY = ROOT / "examples" / "key.aidl"
BEGINNINGS = {
    ".svg": b"<?xml",
    ".dxf": b"  0\nSECTION",
    ".pdf": b"%PDF",
    ".png": b"\x89PNG",
    ".stl": b"",
    ".json": b"{",
    ".step": b"ISO",
}
SCRIPT = """
import pathlib, sys
sys.modules["lib3mf"] = sys.modules["OCP"] = None
import aidl_lang
key = aidl_lang.compile(pathlib.Path(sys.argv[1]))
for suffix in sys.argv[2:]:
    if suffix == ".step":
        del sys.modules["OCP"]
    pathlib.Path("key" + suffix).write_bytes(key.export(suffix, thickness=2))
"""


def test_the_same_bytes_in_every_process(tmp_path: Path) -> None:
    """None but STEP needs the packages of STEP and 3MF."""
    here = aidl_lang.compile(KEY)
    for seed in "1234" if TRIES_ALL else "1":
        environment = os.environ | {"PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)}
        words = [sys.executable, "-c", SCRIPT, str(KEY), *BEGINNINGS]
        done = subprocess.run(words, cwd=tmp_path, env=environment, check=True, capture_output=True)
        assert (done.stdout, done.stderr) == (b"", b"")  # Open CASCADE would have much to say
        for suffix, beginning in BEGINNINGS.items():
            data = (tmp_path / f"key{suffix}").read_bytes()
            assert data == here.export(suffix, thickness=2), suffix
            assert data.startswith(beginning)
            assert str(ROOT).encode() not in data
    assert not ezdxf.options.write_fixed_meta_data_for_testing

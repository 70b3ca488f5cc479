"""The shapes that build123d is handed, and what it reads of a STEP file: the same volumes and names."""

from __future__ import annotations

import math
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

import aidl_lang
from aidl_lang.tools import cad
from tests.compiled import EXAMPLES
from tests.documents import ROOT, blocks

PLATE = """
@thickness(3mm) @color("#ff8000")
solid plate {
    body = rounded_rectangle(center: fixed((0, 0)), width: 60, height: 40, radius: 5)
    hole bore { rim = circle(center: fixed((0, 0)), radius: 8) }
}
"""
VOLUME = 3 * (60 * 40 - (4 - math.pi) * 25 - math.pi * 64)
MIXED = """
assembly things {
    @thickness(2mm) solid block {
        body = square(size: 10)
        drawing mark { score = line(start: fixed((-3, 0)), end: fixed((3, 0))) }
    }
    @thickness(5mm) @orientation(front)
    solid wall { body = rectangle(center: fixed((20, 0)), width: 30, height: 8) }
    @detached solid flat { disc = ellipse(center: fixed((60, 0)), rx: 9, ry: 4) }
}
"""


def test_without_build123d_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "build123d", None)
    monkeypatch.setattr("aidl_lang.export.job.find_spec", lambda name: None)
    with pytest.raises(aidl_lang.AidlError) as told:
        aidl_lang.compile(PLATE).to_build123d()
    assert told.value.diagnostics[0].code == "E0913"
    assert told.value.diagnostics[0].hints == ("pip install 'aidl-lang[build123d]'",)


class TestWithBuild123d:
    """Left out where build123d is not installed: it is no part of the development environment."""

    @pytest.fixture(autouse=True)
    def build123d(self) -> Any:
        return pytest.importorskip("build123d", reason="build123d is not installed")

    def test_a_solid_with_a_thickness_is_a_part_under_its_name(self, build123d: Any) -> None:
        part = aidl_lang.compile(PLATE).to_build123d()
        assert isinstance(part, build123d.Part)
        assert part.label == "plate"
        assert part.is_valid
        assert part.volume == pytest.approx(VOLUME, rel=1e-9)
        assert tuple(part.color) == pytest.approx((1.0, 128 / 255, 0.0, 1.0), abs=1e-6)
        rounded = build123d.fillet(part.edges().group_by(build123d.Axis.Z)[-1], 0.5)
        assert part.volume - 60 < rounded.volume < part.volume

    def test_one_without_is_a_sketch_and_takes_a_thickness(self, build123d: Any) -> None:
        model = aidl_lang.compile(PLATE.replace("@thickness(3mm)", ""))
        sketch = model.to_build123d()
        assert isinstance(sketch, build123d.Sketch)
        assert sketch.area == pytest.approx(VOLUME / 3, rel=1e-9)
        assert model.to_build123d(thickness=3).volume == pytest.approx(VOLUME, rel=1e-9)
        assert build123d.extrude(sketch, 3).volume == pytest.approx(VOLUME, rel=1e-9)

    def test_several_are_children_of_the_whole(self) -> None:
        whole = aidl_lang.compile(MIXED).to_build123d()
        assert whole.label == "things"
        found = {child.label: type(child).__name__ for child in whole.children}
        assert found == {
            "things.block": "Part",
            "things.wall": "Part",
            "things.flat": "Sketch",
            "things.block.mark.score": "Curve",
        }
        by_name = {child.label: child for child in whole.children}
        assert by_name["things.block"].volume == pytest.approx(200, rel=1e-9)
        assert by_name["things.wall"].volume == pytest.approx(1200, rel=1e-9)
        assert by_name["things.flat"].area == pytest.approx(math.pi * 36, rel=1e-9)
        size = by_name["things.wall"].bounding_box().size
        measured = [size.X, size.Y, size.Z]
        assert measured == pytest.approx([30, 5, 8], abs=1e-6)

    def test_circles_and_points_are_joints_on_the_face_that_is_seen(self) -> None:
        plate = aidl_lang.compile(PLATE).to_build123d()
        assert tuple(plate.joints["bore.rim"].location.position) == pytest.approx((0, 0, 3))
        upright = """
        assembly a {
            @thickness(5mm) @orientation(front) solid wall {
                body = rectangle(center: fixed((20, 0)), width: 30, height: 8)
                hole h { rim = circle(center: fixed((21, 1)), radius: 2) }
            }
            @detached @thickness(5mm) solid floor { disc = circle(center: fixed((90, 0)), radius: 3) }
        }
        """
        wall, floor = aidl_lang.compile(upright).to_build123d().children
        seen = wall.joints["h.rim"].location
        assert tuple(seen.position) == pytest.approx((21, 0, 1))
        assert tuple(seen.orientation) == pytest.approx((90, 0, 0))  # z points to the front
        assert list(floor.joints) == ["disc"]
        assert tuple(floor.joints["disc"].location.position) == pytest.approx((90, 0, 5))

    @pytest.mark.parametrize("name", ["motor_bracket", "finger_box", "gear_pair", "wrench"])
    def test_examples_have_the_measured_volume(self, name: str, tmp_path: Path, build123d: Any) -> None:
        """Also those in a STEP file that build123d reads."""
        (path,) = (each for each in EXAMPLES if each.stem == name)
        model = aidl_lang.compile(path)
        shape = model.to_build123d(thickness=3)
        area = {part.path: part for part in (model.measure(body) for body in _bodies(model))}
        parts = {child.label: child for child in (shape.children or [shape])}
        for body, part in area.items():
            assert parts[body].volume == pytest.approx(part.area * (part.thickness or 3), rel=1e-9)
        model.save(tmp_path / "part.step", thickness=3)
        read = build123d.import_step(tmp_path / "part.step")
        solids = sum(solid.volume for child in parts.values() for solid in child.solids())
        assert sum(solid.volume for solid in read.solids()) == pytest.approx(solids, rel=1e-9)

    def test_the_page_says_what_is_printed(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
    ) -> None:
        monkeypatch.chdir(tmp_path)
        names: dict[str, object] = {}
        page = list(blocks(ROOT / "docs" / "howto" / "build123d.md"))
        ran = 0
        for block, after in pairwise(page):
            if block.language == "python":
                exec(block.text, names)
                assert capsys.readouterr().out == after.text
                ran += 1
        assert ran == 3

    def test_a_model_that_is_not_ok_is_refused(self) -> None:
        wrong = aidl_lang.compile("solid a { b = circle(radius: fixed(3))\n constrain b.radius == 4 }")
        with pytest.raises(aidl_lang.AidlError, match="not ok"):
            cad.to_build123d(wrong._compiled, None)


def _bodies(model: aidl_lang.Model) -> list[str]:
    drawing = model._compiled.drawing
    assert drawing is not None
    return [body.path for body in drawing.bodies]

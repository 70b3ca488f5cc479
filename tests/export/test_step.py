"""STEP files, read back by Open CASCADE and measured against closed forms."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.common.render import render
from aidl_lang.common.source import SourceFile
from aidl_lang.export import export
from aidl_lang.export.job import ExportError, Job, Options
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, Line
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.region import Face, Loop, Region
from aidl_lang.geometry.solved import SolvedGeometry, SolvedModel
from tests.compiled import LIGHTER, compiled
from tests.documents import ROOT
from tests.export.readers import read_step
from tests.geometry.models import arc, circle, compound, model, primitive, rectangle, structure


def written(program: str, thickness: float | None = None) -> tuple[bytes, list[str]]:
    compiled = pipeline.compile(SourceFile("part.aidl", program))
    assert compiled.ok, compiled.diagnostics
    made = compiled.exported(".step", Options(thickness=thickness))
    return made.data, [f"{note.code}: {note.message}" for note in made.notes]


def of_model(m: SolvedModel, thickness: float | None = None) -> bytes:
    return export(Job(m, draw(m)[0], options=Options(thickness=thickness)), ".step").data


# --- One body --------------------------------------------------------------------------------------

BITTEN = """
@thickness(3mm)
solid plate {
    body = rectangle(center: fixed((0, 0)), width: 60, height: 40)
    hole bore { rim = circle(center: fixed((0, 0)), radius: 8) }
    hole notch { rim = circle(center: fixed((10, 0)), radius: 6) }
}
"""


def test_every_kind_of_curve_is_exact(tmp_path: Path) -> None:
    """Walls over a closed ellipse, part of one, an arc run clockwise, and a Bézier curve."""
    left = arc((0, 0), 5, 90, -90)  # clockwise: bulges to the right, and cuts in
    bow = Bezier((0, -5), (-8, -12), (-22, -12), (-30, -5))
    m = model(
        structure(
            "solid",
            "s",
            compound(
                "body",
                left,
                bow,
                Bezier((-30, -5), (-30, 0), (-30, 3), (-30, 5)),
                Bezier((-30, 5), (-20, 5), (-10, 5), (0, 5)),
            ),
            structure("hole", "eye", primitive("rim", Ellipse((-20, 0), 1, 3, 0.3))),
            structure("hole", "bite", primitive("rim", Ellipse((-30, 0), 2, 3, 0.0))),
        )
    )
    drawing, _ = draw(m)
    (part,) = read_step(of_model(m, 2.5), tmp_path).parts
    assert part.is_valid
    assert part.is_closed
    assert part.surfaces["Cylinder"] == 1
    assert part.surfaces["SurfaceOfExtrusion"] == 6  # bow, two rests of the left edge, top, eye, bite
    assert part.curves["Ellipse"] == 4
    assert part.curves["BSplineCurve"] == 8
    assert part.volume == pytest.approx(2.5 * drawing.regions["s"].area, rel=1e-9)


# --- Several ---------------------------------------------------------------------------------------

SEVERAL = """
assembly box {
    @color("tomato") @thickness(2mm) @layer("cut") @material("birch")
    solid base { body = rectangle(center: fixed((0, 0)), width: 10, height: 10) }
    @detached @color("#102030")
    solid lid { body = rectangle(center: fixed((20, 0)), width: 10, height: 10) }
    @color("navy") @elevation(2)
    drawing marks {
        cross = line(fixed((-4, 0)), fixed((4, 0)))
        ring = circle(center: fixed((0, 0)), radius: 3)
        bow = arc(center: fixed((0, 0)), radius: 4, start_angle: 80, end_angle: 20, clockwise: true)
    }
}
"""


def test_an_assembly_keeps_its_bodies_apart_named_and_coloured(tmp_path: Path) -> None:
    data, notes = written(SEVERAL)
    file = read_step(data, tmp_path)
    assert notes == []
    assert file.name == "box"
    assert [part.name for part in file.parts] == [
        "box.base", "box.lid", "box.marks.cross", "box.marks.ring", "box.marks.bow",
    ]  # fmt: skip
    assert [part.color for part in file.parts] == [(255, 99, 71), (16, 32, 48), *[(0, 0, 128)] * 3]
    assert [part.count("SOLID") for part in file.parts] == [1, 0, 0, 0, 0]
    assert "PRESENTATION_LAYER_ASSIGNMENT('cut'" in data.decode()
    assert "PRODUCT('box.base','box.base','birch'" in data.decode()


def test_a_box_of_boards_stands_in_space(tmp_path: Path) -> None:
    """By hand: a bottom of 100 × 60 × 3, a front and a back between two sides, all 3 thick and 40 high."""
    program = """
    @thickness(3mm)
    assembly box {
        solid bottom { board = rectangle(center: fixed((50, 30)), width: 100, height: 60) }
        @orientation(front) @elevation(3mm) @detached
        solid near at fixed((0, 0)) { board = rectangle(center: fixed((50, 23)), width: 94, height: 40) }
        @orientation(front) @detached
        solid far at fixed((0, 54)) { board = rectangle(center: fixed((50, 23)), width: 94, height: 40) }
        @orientation(side) @detached
        assembly ends at fixed((0, 0)) {
            solid left { board = rectangle(center: fixed((30, 23)), width: 60, height: 40) }
            @elevation(97mm)
            solid right { board = rectangle(center: fixed((30, 23)), width: 60, height: 40) }
        }
    }
    """
    data, notes = written(program)
    file = read_step(data, tmp_path)
    assert notes == []
    assert {part.name: tuple(round(v, 9) for v in part.bounds) for part in file.parts} == {
        "box.bottom": (0, 0, 0, 100, 60, 3),
        "box.near": (3, 3, 3, 97, 6, 43),
        "box.far": (3, 54, 3, 97, 57, 43),
        "box.ends.left": (0, 0, 3, 3, 60, 43),
        "box.ends.right": (97, 0, 3, 100, 60, 43),
    }
    assert all(part.is_valid and part.is_closed and part.volume > 0 for part in file.parts)


def test_turned_and_mirrored_structures(tmp_path: Path) -> None:
    program = """
    @thickness(2mm)
    assembly all {
        assembly half at fixed((100, 0)) rotated 90deg {
            solid foot { body = rectangle(center: fixed((10, 0)), width: 20, height: 4) }
            @orientation(front) @detached
            solid post at fixed((20, 0)) rotated 90deg {
                body = rectangle(center: fixed((15, 2)), width: 30, height: 4)
            }
        }
    }
    """
    data, notes = written(program)
    file = read_step(data, tmp_path)
    assert notes == ["W0726: `all.half.post` stands unturned in `all.half`, which is turned"]
    assert file["all.half.foot"].bounds == pytest.approx((98, 0, 0, 102, 20, 2), abs=1e-9)
    # Its origin is carried to (100, 20); its own turn stands it up in the plane of x and z.
    assert file["all.half.post"].bounds == pytest.approx((96, 20, 0, 100, 22, 30), abs=1e-9)
    assert file["all.half.post"].volume == pytest.approx(240, rel=1e-9)


def test_a_mirrored_structure_of_another_orientation(tmp_path: Path) -> None:
    program = """
    @thickness(2mm)
    assembly all {
        @orientation(front) @detached
        solid left at fixed((-10, 0)) {
            body = polygon(fixed((0, 0)), fixed((9, 0)), fixed((0, 6)))
        }
        @detached right = mirror(left, about: y_axis)
    }
    """
    file = read_step(written(program)[0], tmp_path)
    right = file["all.right"]
    assert right.bounds == pytest.approx((1, 0, 0, 10, 2, 6), abs=1e-9)
    assert right.is_valid
    assert right.volume == pytest.approx(54, rel=1e-9)


def test_what_is_united_has_the_place_and_thickness_of_its_body() -> None:
    program = """
    @thickness(4mm)
    solid knob {
        base = circle(center: fixed((0, 0)), radius: 20)
        @thickness(12mm) @elevation(4)
        solid grip { body = rectangle(center: fixed((0, 0)), width: 60, height: 10) }
        @orientation(side) hole bore { rim = circle(center: fixed((0, 12)), radius: 3) }
        @thickness(4mm) solid rib { body = rectangle(center: fixed((0, 0)), width: 10, height: 60) }
    }
    """
    assert written(program)[1] == [
        "W0727: `@elevation` and `@thickness` of `knob.grip` count for nothing: it is one body with `knob`",
        "W0727: `@orientation` of `knob.bore` counts for nothing: it is one body with `knob`",
    ]


# --- The file itself -------------------------------------------------------------------------------


def test_another_process_writes_the_same_and_says_nothing(tmp_path: Path) -> None:
    (tmp_path / "box.aidl").write_text(SEVERAL)
    command = [sys.executable, "-m", "aidl_lang", "compile", "box.aidl", "-o", "-", "--format", "step"]
    environment = {**os.environ, "PYTHONHASHSEED": "1", "PYTHONPATH": str(ROOT)}
    ran = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, check=True)
    assert ran.stdout == written(SEVERAL)[0]
    assert b"STEP" not in ran.stderr
    assert b"Transfer" not in ran.stderr


def test_settings_of_the_process_are_as_before() -> None:
    from OCP.Interface import Interface_Static
    from OCP.Message import Message, Message_PrinterOStream

    written(SEVERAL)
    settings = {"write.step.schema": "AP203", "write.step.unit": "INCH", "write.surfacecurve.mode": "On"}
    for name, value in settings.items():
        assert Interface_Static.SetCVal_s(name, value)
    before = {name: Interface_Static.CVal_s(name) for name in settings}
    printer = Message_PrinterOStream()
    Message.DefaultMessenger_s().AddPrinter(printer)
    data = written(BITTEN)[0]
    assert {name: Interface_Static.CVal_s(name) for name in settings} == before
    assert Message.DefaultMessenger_s().RemovePrinter(printer)
    Interface_Static.SetCVal_s("write.step.schema", "AP214IS")
    Interface_Static.SetCVal_s("write.step.unit", "MM")
    assert data == written(BITTEN)[0]
    assert b"FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));" in data
    assert b"SI_UNIT(.MILLI.,.METRE.)" in data


def test_the_extra_is_named_where_it_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("aidl_lang.export.job.find_spec", lambda name: None)
    with pytest.raises(ExportError) as reason:
        written(BITTEN)
    assert render(reason.value.diagnostic) == (
        "error[E0913]: `.step` needs a package that is not installed\n  = hint: pip install 'aidl-lang[step]'"
    )


def test_odd_names_come_back_as_they_are(tmp_path: Path) -> None:
    name = "a'b\\c </svg> Größe 木 \U0001f600 \\X2\\0041\\X0\\ ~0~ " + 30 * "many'words_"
    m = model(structure("assembly", name, structure("solid", name, circle("c", 0, 0, 1))))
    data = of_model(m, 1)
    assert data.isascii()
    file = read_step(data, tmp_path)
    assert (file.name, file.parts[0].name) == (name, f"{name}.{name}")


@pytest.mark.parametrize(
    ("attribute", "thickness", "message"),
    [
        ("@thickness(1e-9)", None, "`s` cannot be made a solid: it would be 1e-09 mm thick"),
        ("@thickness(1e30)", None, "`s` cannot be made a solid: it would be 1e+30 mm thick"),
        ("", 1e-8, "`s` cannot be made a solid: it would be 1e-08 mm thick"),
        ("@elevation(1e15m)", 3, "`s` cannot be placed in space: it lies further out than 1e+12 mm"),
    ],
)
def test_what_cannot_be_made_solid(attribute: str, thickness: float | None, message: str) -> None:
    with pytest.raises(ExportError) as reason:
        written(f"{attribute} solid s {{ c = circle(center: origin, radius: 5) }}", thickness)
    assert (reason.value.diagnostic.code, reason.value.diagnostic.message) == ("E0918", message)


@pytest.mark.parametrize(
    ("holes", "circles"),
    [
        ([circle("a", 10, 10, 3), circle("b", 16, 10, 3)], 2),  # each other
        ([circle("a", 10, 5, 5)], 1),  # the edge
        ([circle("a", 10, 10, 3), circle("b", 16, 10, 3), circle("c", 13, 10 + 3 * 3**0.5, 3)], 3),
    ],
)
@pytest.mark.parametrize("thickness", [3, None])
def test_outlines_that_touch(
    tmp_path: Path, holes: list[SolvedGeometry], circles: int, thickness: float | None
) -> None:
    """They get a vertex in common there, without which Open CASCADE calls the shape invalid."""
    plate = structure(
        "solid", "s", rectangle("r", 0, 0, 40, 20), *(structure("hole", g.name, g) for g in holes)
    )
    (part,) = read_step(of_model(model(plate), thickness), tmp_path).parts
    assert part.is_valid
    radius = holes[0].values["radius"]
    exact = 800 - circles * math.pi * radius**2
    if thickness is None:
        assert part.area == pytest.approx(exact, rel=1e-9)
    else:
        assert part.is_closed
        assert part.volume == pytest.approx(thickness * exact, rel=1e-9)


def test_what_open_cascade_raises_is_said_of_the_body() -> None:
    nothing = Face(Loop((Line((0, 0), (0, 0)),)))
    m = model(structure("solid", "s", circle("c", 0, 0, 1)))
    drawing, _ = draw(m)
    drawing = replace(drawing, bodies=(replace(drawing.bodies[0], region=Region((nothing,))),))
    with pytest.raises(ExportError, match="`s` cannot be written as STEP"):
        export(Job(m, drawing), ".step")


@pytest.mark.parametrize("path", LIGHTER)
def test_examples(path: Path, tmp_path: Path) -> None:
    made = compiled(path.read_text("utf-8"))
    assert made.ok
    assert made.drawing is not None
    file = read_step(made.export(".step", Options(thickness=3)), tmp_path)
    assert made.drawing.bodies
    for body in made.drawing.bodies:
        part = file[body.path]
        assert part.is_valid
        assert part.is_closed
        assert part.count("SOLID") == len(body.region.faces)
        thickness = body.style.thickness or 3
        assert part.volume == pytest.approx(thickness * body.region.area, rel=1e-9)
        left, bottom, right, top = body.box
        assert part.bounds == pytest.approx((left, bottom, 0, right, top, thickness), abs=1e-5)
        # A top, a bottom, and a side for each piece of the outline.
        pieces = sum(len(loop.pieces) for loop in body.region.loops)
        assert part.count("FACE") == 2 * len(body.region.faces) + pieces
    whole = [p for body in made.drawing.bodies for loop in body.region.loops for p in loop.pieces]
    cylinders = sum(part.surfaces["Cylinder"] for part in file.parts)
    assert cylinders == sum(isinstance(p, Arc | Circle) for p in whole)

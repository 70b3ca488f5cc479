"""Solids: STEP, read back by Open CASCADE and measured against closed forms; STL and 3MF, read by trimesh."""

from __future__ import annotations

import io
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from aidl_lang.export import export
from aidl_lang.export.job import ExportError, Job, Options
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, Line
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.region import Face, Loop, Region
from aidl_lang.geometry.solved import SolvedGeometry
from tests.amount import large, some
from tests.compiled import LIGHTER, compiled
from tests.export.making import refused, written
from tests.export.readers import read_meshes, read_step
from tests.geometry.models import arc, circle, compound, model, primitive, rectangle, structure

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
    (part,) = read_step(written(m, ".step", thickness=2.5).data, tmp_path).parts
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
    made = written(SEVERAL, ".step")
    data, file = made.data, read_step(made.data, tmp_path)
    assert made.notes == ()
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
    made = written(program, ".step")
    file = read_step(made.data, tmp_path)
    assert made.notes == ()
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
    made = written(program, ".step")
    file, (note,) = read_step(made.data, tmp_path), made.notes
    said = "`all.half.post` stands unturned in `all.half`, which is turned"
    assert (note.code, note.message) == ("W0726", said)
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
    file = read_step(written(program, ".step").data, tmp_path)
    right = file["all.right"]
    assert right.bounds == pytest.approx((1, 0, 0, 10, 2, 6), abs=1e-9)
    assert right.is_valid
    assert right.volume == pytest.approx(54, rel=1e-9)


# --- The file itself -------------------------------------------------------------------------------


def test_settings_of_the_process_are_as_before() -> None:
    from OCP.Interface import Interface_Static
    from OCP.Message import Message, Message_PrinterOStream

    written(SEVERAL, ".step")
    settings = {"write.step.schema": "AP203", "write.step.unit": "INCH", "write.surfacecurve.mode": "On"}
    for name, value in settings.items():
        assert Interface_Static.SetCVal_s(name, value)
    before = {name: Interface_Static.CVal_s(name) for name in settings}
    printer = Message_PrinterOStream()
    Message.DefaultMessenger_s().AddPrinter(printer)
    data = written(BITTEN, ".step").data
    assert {name: Interface_Static.CVal_s(name) for name in settings} == before
    assert Message.DefaultMessenger_s().RemovePrinter(printer)
    Interface_Static.SetCVal_s("write.step.schema", "AP214IS")
    Interface_Static.SetCVal_s("write.step.unit", "MM")
    assert data == written(BITTEN, ".step").data
    assert b"FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));" in data
    assert b"SI_UNIT(.MILLI.,.METRE.)" in data


@pytest.mark.parametrize(("suffix", "extra"), [(".step", "step"), (".3mf", "3mf")])
def test_a_package_that_is_missing(monkeypatch: pytest.MonkeyPatch, suffix: str, extra: str) -> None:
    monkeypatch.setattr("aidl_lang.export.job.find_spec", lambda name: None)
    message, hint = f"`{suffix}` needs a package that is not installed", f"pip install 'aidl-lang[{extra}]'"
    assert refused(BITTEN, suffix) == ("E0913", message, hint)
    assert written(BITTEN, ".stl").data


def test_odd_names_come_back_as_they_are(tmp_path: Path) -> None:
    name = "a'b\\c </svg> Größe 木 \U0001f600 \\X2\\0041\\X0\\ ~0~ " + 30 * "many'words_"
    m = model(structure("assembly", name, structure("solid", name, circle("c", 0, 0, 1))))
    data = written(m, ".step", thickness=1).data
    assert data.isascii()
    file = read_step(data, tmp_path)
    assert (file.name, file.parts[0].name) == (name, f"{name}.{name}")


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
    (part,) = read_step(written(plate, ".step", thickness=thickness).data, tmp_path).parts
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


@pytest.mark.parametrize("path", some(LIGHTER, 4))
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


SUFFIXES = (".stl", ".3mf")


def only(data: bytes, suffix: str) -> Any:
    (body,) = read_meshes(data, suffix).values()
    return body


RING = """
@thickness(3mm)
solid ring {
    body = circle(center: fixed((0, 0)), radius: 20)
    hole bore { rim = circle(center: fixed((0, 0)), radius: 8) }
}
"""
STAND = """
assembly stand {
    @thickness(4mm) @color("tomato") @material("birch")
    solid base { body = rectangle(center: fixed((30, 20)), width: 60, height: 40) }
    @thickness(3mm) @orientation(front) @elevation(-1)
    solid back at fixed((0, 40)) { body = rectangle(center: fixed((30, 24)), width: 60, height: 40) }
    @thickness(3mm) @orientation(side)
    solid end at fixed((57, 0)) { body = rectangle(center: fixed((20, 24)), width: 40, height: 40) }
    @detached solid note { body = rectangle(center: fixed((90, 20)), width: 10, height: 10) }
    drawing mark { stroke = line(fixed((0, 0)), fixed((10, 10))) }
}
"""


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_every_vertex_lies_on_the_outline(suffix: str) -> None:
    body = only(written(RING, suffix).data, suffix)
    radii = [math.hypot(x, y) for x, y, _ in body.vertices]
    assert all(min(abs(r - 20), abs(r - 8)) < 2e-6 for r in radii)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_bodies_stay_apart_named_and_placed(suffix: str) -> None:
    found = read_meshes(written(STAND, suffix).data, suffix)
    assert {name: body.bounds.round(5).tolist() for name, body in found.items()} == {
        "stand.base": [[0, 0, 0], [60, 40, 4]],
        "stand.back": [[0, 39, 4], [60, 42, 44]],
        "stand.end": [[57, 0, 4], [60, 40, 44]],
    }
    assert all(body.is_watertight for body in found.values())
    volumes = [body.volume for body in found.values()]
    assert volumes == pytest.approx([60 * 40 * 4, 60 * 40 * 3, 40 * 40 * 3], rel=1e-6)


def test_colours_and_materials() -> None:
    import zipfile

    made = zipfile.ZipFile(io.BytesIO(written(STAND, ".3mf").data)).read("3D/3dmodel.model").decode()
    assert 'unit="millimeter"' in made
    assert '<base name="birch" displaycolor="#FF6347FF"/>' in made
    assert made.count("<item ") == 3


def test_a_plate_with_many_holes() -> None:
    count = large(2500)
    holes = [circle(f"c[{k}]", 10 * (k % 50), 10 * (k // 50), 3) for k in range(count)]
    m = model(structure("solid", "s", rectangle("r", -10, -10, 500, 500), structure("hole", "h", *holes)))
    body = only(written(m, ".stl", thickness=2).data, ".stl")
    assert body.is_watertight
    assert body.euler_number == 2 - 2 * count
    chord = 1e-4 * 510  # so far at most from the rims
    low, high = (2 * (510**2 - count * math.pi * r**2) for r in (3 + chord, 3 - chord))
    assert low < body.volume < high
    assert isinstance(draw(m)[0].bodies[0].region.faces[0].holes[0].pieces[0], Circle)

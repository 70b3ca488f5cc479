"""OpenSCAD beside AIDL: what counts as valid, what the model is told, and what is kept from programs."""

from __future__ import annotations

import io
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from aidl_eval import openscad, pictures, rendering
from aidl_eval.openscad import OpenScad, parts, render
from aidl_eval.sandbox import fence

needs_openscad = pytest.mark.skipif(OpenScad().missing() is not None, reason="openscad is not installed")

PLATE = """\
width = 80; // not height = 3;
h = 40.5;
/* depth = 3; module no() {} */
label = "size = 4;";
sum = width + 1;
module plate() { inner = 2; square([width, 40]); }
difference() { plate(); translate([20, 20]) circle(r = 10, $fn = 4); }
"""


def test_knobs_are_the_plain_numbers_of_the_top_level() -> None:
    assert OpenScad().knobs(PLATE) == {"width": 80.0, "h": 40.5}
    assert OpenScad().knobs("a = -1e3; a = 2; { b = 3; }") == {"a": 2.0}
    assert OpenScad().structures(PLATE) == 1


@needs_openscad
def test_a_program_is_drawn_with_its_holes() -> None:
    drawn = render(PLATE).regions.whole
    assert drawn.box == pytest.approx((0, 0, 80, 40))
    assert drawn.area == pytest.approx(80 * 40 - 200)  # a square of diagonal 20 is cut out
    assert [len(face.holes) for face in drawn.faces] == [1]
    wider = render(PLATE, {"width": 100.0}).regions.whole
    assert wider.box[2] == pytest.approx(100)
    with Image.open(io.BytesIO(pictures.png(render(PLATE).regions))) as picture:
        pixels = np.asarray(picture.convert("RGB"))
    assert max(picture.size) == pictures.PIXELS
    assert tuple(pixels[2, 2]) == (255, 255, 255)
    middle, hole = (
        pixels[picture.height // 2, picture.width * 3 // 4],
        pixels[picture.height // 2, picture.width * 28 // 106],
    )
    assert tuple(middle) != (255, 255, 255)
    assert tuple(hole) == (255, 255, 255)


@needs_openscad
@pytest.mark.parametrize(
    ("program", "errors"),
    [
        ("square(3 4);", ("error (line 1): Parser error: syntax error",)),
        (
            "cube(3);",
            ("error: the drawing must be flat, not a solid: do without extrusion, `cube`, `sphere` …",),
        ),
        ("x = 3;", ("error: nothing is drawn",)),
        ("", ("error: nothing is drawn",)),
        ("square(0);", ("error: nothing is drawn",)),
        ("square(1e12);", ("error: a coordinate is not a finite number, or too large",)),
        ('square([1, 1]);\nassert(false, "no");', ("error (line 2): Assertion 'false' failed: \"no\"",)),
    ],
)
def test_what_does_not_draw_is_not_valid(program: str, errors: tuple[str, ...]) -> None:
    assert render(program).errors == errors


@pytest.mark.parametrize(
    "program",
    [
        'import("/etc/drawing.svg");',
        'import /* */ ("a.dxf");',
        "include <a.scad>\nsquare(1);",
        "use <a.scad>\nsquare(1);",
        'surface("a.png");',
        'linear_extrude(file = "a.dxf");',
        "square(1); \0",
    ],
)
def test_files_are_out_of_reach(program: str) -> None:
    (error,) = render(program).errors
    assert error.startswith("error: files cannot be read")


@needs_openscad
def test_a_comment_about_files_is_no_offence() -> None:
    assert render('// import("a")\nlabel = "include <a>"; square(1);').ok


OUT_OF_TIME_OR_MEMORY = ("error: rendering took longer than 1 s", "error: OpenSCAD was stopped")


@needs_openscad
@pytest.mark.parametrize(
    ("program", "error"),
    [
        (
            "for (i = [0 : 1e9]) square(i);",
            "warning (line 1): Bad range parameter in for statement: too many elements",
        ),
        ("for (i = [0 : 9e3]) for (j = [0 : 9e3]) square(i + j);", OUT_OF_TIME_OR_MEMORY),
        ("minkowski() { circle(3, $fn = 9999); circle(4, $fn = 9999); }", OUT_OF_TIME_OR_MEMORY),
        (
            "function f(n) = f(n + 1) + 1; echo(f(0));",
            "error (line 1): Recursion detected calling function 'f'",
        ),
        ("module m() { m(); square(1); } m();", "error (line 1): Recursion detected calling module 'm'"),
    ],
)
def test_what_takes_too_much_is_told(
    program: str, error: str | tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    if error is OUT_OF_TIME_OR_MEMORY:
        monkeypatch.setattr(rendering, "SECONDS", 1)
    said = OpenScad().conversation().judge(program)
    assert not said.ok
    assert any(line.startswith(error) for line in said.feedback.splitlines()), said.feedback


@needs_openscad
@pytest.mark.parametrize(
    ("limit", "value", "program"),
    [
        (
            "MEMORY",
            1 << 28,
            "x = [for (i = [0 : 9e5]) [for (j = [0 : 99]) j]]; square(len(x));",
        ),
        ("OUTPUT", 1 << 12, "for (i = [0 : 999]) translate([2 * i, 0]) square(1);"),
        ("OUTPUT", 1 << 12, "for (i = [0 : 9000]) echo(i); square(1);"),
    ],
)
def test_memory_and_output_are_limited(
    limit: str, value: int, program: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rendering, limit, value)
    (error,) = render(program).errors
    assert error.startswith("error: OpenSCAD was stopped (signal ")


@needs_openscad
@pytest.mark.skipif(not fence.version(), reason="this kernel has no Landlock")
def test_openscad_itself_cannot_read_what_is_not_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Programs with these words are refused before; here they come as far as OpenSCAD."""
    monkeypatch.setattr(openscad, "_FILES", re.compile(r"\Z\A."))
    outside = tmp_path / "a.svg"
    outside.write_text('<svg xmlns="http://www.w3.org/2000/svg"><rect width="9" height="9"/></svg>')
    (error,) = render(f'import("{outside}");').errors
    assert error.startswith("error: Can't open file")
    monkeypatch.setattr(fence, "fence", lambda folder: None)
    assert render(f'import("{outside}");').ok
    library = tmp_path / "a.scad"
    library.write_text("module a() square(5);")
    assert render(f"use <{library}>\na();").ok
    monkeypatch.undo()
    monkeypatch.setattr(openscad, "_FILES", re.compile(r"\Z\A."))
    assert not render(f"use <{library}>\na();").ok
    assert render('text("a");').ok  # its fonts are


@needs_openscad
def test_the_model_is_told_and_a_remark_is_made_once() -> None:
    conversation = OpenScad().conversation()
    wrong = conversation.judge("square(3 4);")
    assert (wrong.ok, wrong.stage) == (False, "render")
    assert wrong.feedback.startswith("error (line 1): Parser error: syntax error\n\nMend this")
    remarked = conversation.judge("square(3);\nwheel(4);")
    assert remarked.ok
    assert remarked.feedback.startswith("warning (line 2): Ignoring unknown module 'wheel'\n\n")
    assert conversation.judge("square(3);\nwheel(4);").feedback == ""
    assert conversation.judge("square(3);").feedback == ""
    assert wrong.weight > remarked.weight


def test_without_openscad_it_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    assert OpenScad().missing() == "it is not installed"


PARTED = """
module two() { color("red") square(10); translate([8, 0]) { circle(3); circle(1); } }
translate([0, 5]) two();
difference() { square(4); square(1); }
"""


@needs_openscad
def test_what_stands_side_by_side_is_a_part_of_its_own() -> None:
    (drawn,) = OpenScad().run(PARTED)
    areas = [part.area for part in drawn.regions.parts]
    assert len(areas) == 4
    assert areas[0] == pytest.approx(100)
    assert areas[3] == pytest.approx(15)
    whole = OpenScad().judged(PARTED)
    assert whole.regions.whole.area == pytest.approx(drawn.regions.whole.area, rel=1e-4)


def test_a_tree_is_opened_down_to_its_shapes() -> None:
    shapes = "\t\tsquare(size = [1, 1]);\n\t\tcircle(r = 1);\n"
    tree = f"group() {{\n\tgroup();\n\tcolor([1, 0, 0, 1]) {{\n{shapes}\t}}\n}}\n"
    assert parts(tree) == ["square(size = [1, 1]);", "circle(r = 1);"]
    assert parts("") == []

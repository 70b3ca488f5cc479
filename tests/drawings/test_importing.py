"""Imported drawings in programs: areas there and back, files for cutters, and who may read what."""

from __future__ import annotations

import io
import math
from pathlib import Path

import ezdxf
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld, MemoryWorld
from aidl_lang.export.job import Options
from aidl_lang.pipeline import Compiled
from aidl_lang.tools.discretion import Programs
from aidl_server.ide.completion import complete
from aidl_server.ide.hover import hover
from aidl_server.ide.references import CannotError, definitions, renameable
from aidl_server.ide.workspace import View, look
from tests.amount import tries

LOGO = (
    b'<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="30mm" viewBox="0 0 40 30">'
    b'<g id="frame"><rect width="40" height="30" rx="4"/></g>'
    b'<g id="holes"><circle id="left_hole" cx="8" cy="8" r="3"/>'
    b'<ellipse id="slit" cx="30" cy="9" rx="4" ry="2"/></g>'
    b'<path id="smile" d="M10 18 A 10 10 0 0 0 30 18 C 25 14 15 14 10 18 Z"/>'
    b'<path id="brow" d="M14 12 A 7 3 20 0 1 26 12 Z"/></svg>'
)


def compiled(text: str, **files: bytes) -> Compiled:
    data = {"logo.svg": LOGO, **{name.replace("_", "."): content for name, content in files.items()}}
    return pipeline.compile(SourceFile("t.aidl", text), MemoryWorld({}, data))


def area(found: Compiled, path: str = "s") -> float:
    assert found.ok, [d.message for d in found.diagnostics]
    assert found.drawing is not None
    return found.drawing.measures[path].area


PARTS = {
    "arcs": (
        "solid s { a = rounded_rectangle(width: 40, height: 20, radius: 5) "
        "hole h { b = slot(length: 20, width: 6) } }"
    ),
    "gear": "solid s { a = spur_gear(module: 2, teeth: 14) }",
    "curves": "solid s { a = heart(width: 30, height: 30) hole h { e = ellipse(rx: 5, ry: 3) at (0, 2) } }",
    "letters": 'solid s { a = rectangle(width: 60, height: 20) hole h { b = text("BOX", height: 8) } }',
    "lines": "solid s { a = star(outer_radius: 20, inner_radius: 9) }",
}


@pytest.mark.parametrize(("suffix", "near"), [(".svg", 1e-6), (".dxf", 1e-4)])
@pytest.mark.parametrize("name", PARTS)
def test_what_is_written_comes_back_with_the_same_area(name: str, suffix: str, near: float):
    """As files for cutters: the outlines alone. DXF has arcs in place of Bézier curves."""
    first = compiled(PARTS[name])
    data = first.export(suffix, Options(cut=True, tolerance=1e-3))
    kind = suffix.removeprefix(".")
    again = compiled(f'import "back.{kind}" as back\nsolid s {{ a = back() }}', **{f"back_{kind}": data})
    assert math.isclose(area(again), area(first), rel_tol=near)


def test_an_imported_outline_is_cut_as_any_other():
    wider = compiled('import "logo.svg" as logo\nsolid s { a = logo.left_hole() }')
    cut = wider.export(".dxf", Options(cut=True, kerf=0.2))
    (ring,) = ezdxf.read(io.StringIO(cut.decode())).modelspace().query("CIRCLE")  # type: ignore[attr-defined]
    assert math.isclose(ring.dxf.radius, 3.1, abs_tol=1e-6)


@tries(20)
@given(st.floats(-200, 200), st.floats(0.1, 8), st.floats(-50, 50), st.floats(-50, 50))
def test_its_box_is_that_of_its_curves_wherever_it_is(angle: float, scale: float, x: float, y: float):
    """The box that constraints see, worked out from formulas, is that of the drawing, from its curves."""
    program = (
        f'import "logo.svg" as logo\ndrawing d {{ a = logo(start: fixed(({x!r}, {y!r})), scale: {scale!r}, '
        f"angle: {angle!r}deg)\n"
    )
    found = compiled(program + "assert a.left <= a.right }")
    assert found.drawing is not None
    sides = zip(("left", "bottom", "right", "top"), found.drawing.box, strict=True)
    checks = "".join(f"assert abs(a.{side} - ({value!r})) <= 1e-6\n" for side, value in sides)
    again = compiled(f"{program}{checks} }}")
    assert again.ok, [d.message for d in again.diagnostics]


def test_it_turns_as_one_where_a_constraint_asks_for_it():
    found = compiled(
        'import "logo.svg" as logo\n'
        "solid s { a = logo(start: fixed((0, 0)), angle: guess(20deg)) constrain a.smile.center_x == 0 }"
    )
    assert found.ok, [d.message for d in found.diagnostics]
    assert math.isclose(area(found), area(compiled('import "logo.svg" as logo\nsolid s { a = logo() }')))


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        ("width: 3, height: 3", "E0311", ""),
        ("scale: -1", "E0515", "the scale of this drawing is -1, and sizes are never negative"),
    ],
)
def test_sizes_that_cannot_be_are_refused(arguments: str, code: str, message: str):
    found = compiled(f'import "logo.svg" as logo\nsolid s {{ a = logo({arguments}) }}')
    (error,) = [d for d in found.diagnostics if d.is_error]
    assert error.code == code
    assert error.message.startswith(message)


@tries(16)
@given(st.floats(-180, 180), st.floats(0.2, 5), st.sampled_from(["x_axis", "y_axis"]))
def test_mirror_images_are_exact_too(angle: float, scale: float, axis: str):
    """Also of arcs of ellipses: mirrored twice it lies where it was."""
    found = compiled(
        f'import "logo.svg" as logo\nassembly a {{ solid one {{ x = logo(scale: {scale!r}, '
        f"angle: {angle!r}deg) }} solid two {{ x = mirror(one.x, about: {axis}) }} "
        f"solid three {{ x = mirror(two.x, about: {axis}) }} }}"
    )
    assert found.drawing is not None, [d.message for d in found.diagnostics]
    one, two, three = (found.drawing.measures[f"a.{name}"] for name in ("one", "two", "three"))
    assert math.isclose(one.area, two.area, rel_tol=1e-9)
    sense = (1, -1) if axis == "x_axis" else (-1, 1)
    mirrored = one.centroid[0] * sense[0], one.centroid[1] * sense[1]
    assert math.dist(mirrored, two.centroid) < 1e-6
    assert math.dist(one.centroid, three.centroid) < 1e-6


# --- Who reads what ------------------------------------------------------------------------------


def test_programs_of_models_read_drawings_below_their_folder_and_nothing_else(tmp_path: Path):
    (tmp_path / "secret.svg").write_bytes(LOGO)
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "logo.svg").write_bytes(LOGO)
    (inner / "link.svg").symlink_to(tmp_path / "secret.svg")
    (inner / "notes.txt").write_text("secret")
    (inner / "other.svg").symlink_to(inner / "notes.txt")
    world = Programs(DiskWorld(inner))

    def codes(name: str) -> list[str]:
        text = f'import "{name}" as logo\nsolid s {{ a = logo() }}'
        found = pipeline.compile(SourceFile("t.aidl", text), world).diagnostics
        return [f"{d.code} {d.message}" for d in found]

    assert codes("logo.svg") == []
    assert codes("link.svg") == ["E0210 `link.svg` cannot be imported: it lies outside the project"]
    assert codes("../secret.svg") == ["E0212 `../secret.svg` lies outside the project"]
    assert codes("other.svg") == ["E0210 `other.svg` cannot be imported: it leads to another kind of file"]


# --- Editors -------------------------------------------------------------------------------------

PROGRAM = """import "logo.svg" as logo

solid s {
    a = logo.smile(width: 10)
    b = logo()
    constrain b.slit.left == 0
}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("logo")
    (found / "logo.svg").write_bytes(LOGO)
    return found


@pytest.fixture(scope="module")
def view(folder: Path) -> View:
    return look(folder / "t.aidl", PROGRAM, DiskWorld(folder))


def test_names_in_a_drawing_are_completed(view: View):
    at = PROGRAM.index("logo.smile") + len("logo.")
    assert {"smile", "frame", "holes", "left_hole", "slit"} <= {
        c.label.partition("(")[0] for c in complete(view, at)
    }
    at = PROGRAM.index("b.slit") + len("b.")
    assert {"smile", "frame", "holes", "left_hole", "slit", "width", "center"} <= {
        c.label for c in complete(view, at)
    }


@pytest.mark.parametrize("offset", range(0, len(PROGRAM), 3))
def test_questions_about_a_drawing_have_answers(view: View, offset: int):
    hover(view, offset)
    definitions(view, offset)
    complete(view, offset)


def test_it_is_defined_in_its_file_and_keeps_its_names(view: View, folder: Path):
    at = PROGRAM.index("smile")
    (place,) = definitions(view, at)
    assert view.file(place.source) == folder / "logo.svg"
    assert "smile of logo.svg: 20 × 13 mm" in str(hover(view, at))
    with pytest.raises(CannotError, match="`smile` is called so in the drawing that is imported"):
        renameable(view, at)

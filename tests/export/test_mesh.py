"""STL and 3MF, read back by trimesh."""

from __future__ import annotations

import importlib.util
import io
import math
import subprocess
import sys
from typing import Any

import pytest

from aidl_lang import pipeline
from aidl_lang.common.render import render
from aidl_lang.common.source import SourceFile
from aidl_lang.export import export
from aidl_lang.export.job import Exported, ExportError, Job, Options
from aidl_lang.geometry.curves import Circle
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.solved import SolvedModel
from tests.amount import large
from tests.export.readers import read_meshes
from tests.geometry.models import circle, model, rectangle, structure

SUFFIXES = (".stl", ".3mf")


def written(program: str, suffix: str, thickness: float | None = None) -> Exported:
    compiled = pipeline.compile(SourceFile("part.aidl", program))
    assert compiled.ok, compiled.diagnostics
    return compiled.exported(suffix, Options(thickness=thickness))


def of_model(m: SolvedModel, suffix: str, thickness: float | None = None) -> bytes:
    return export(Job(m, draw(m)[0], options=Options(thickness=thickness)), suffix).data


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


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_what_is_left_out_is_named(suffix: str) -> None:
    (note,) = written(STAND, suffix).notes
    assert render(note) == (
        "warning[W0725]: `stand.note` has no thickness and is left out\n"
        "  = hint: say how thick: `@thickness(3mm)` before it or what is around it\n"
        "  = hint: or for all: `--thickness 3`"
    )
    made = written(STAND, suffix, thickness=2)
    assert made.notes == ()
    assert read_meshes(made.data, suffix)["stand.note"].volume == pytest.approx(200, rel=1e-6)


def test_there_is_no_body() -> None:
    with pytest.raises(ExportError) as reason:
        written("drawing d { a = line(fixed((0, 0)), fixed((1, 0))) }", ".stl", thickness=3)
    assert render(reason.value.diagnostic) == (
        "error[E0917]: there is no body to write\n  = hint: material is what the curves of a `solid` enclose"
    )


def test_a_body_too_large_for_triangles() -> None:
    m = model(structure("solid", "s", rectangle("r", 0, 0, 3e11, 2e11)))
    with pytest.raises(ExportError) as reason:
        of_model(m, ".stl", 1)
    assert render(reason.value.diagnostic) == (
        "error[E0918]: `s` cannot be made a solid of triangles: it is too large or too thin for them\n"
        "  = hint: look for a size that was written in another unit, or shrank to nothing"
    )


def test_colours_and_materials() -> None:
    import zipfile

    made = zipfile.ZipFile(io.BytesIO(written(STAND, ".3mf").data)).read("3D/3dmodel.model").decode()
    assert 'unit="millimeter"' in made
    assert '<base name="birch" displaycolor="#FF6347FF"/>' in made
    assert made.count("<item ") == 3


def test_what_does_not_fit_into_3mf() -> None:
    m = model(structure("solid", "s", rectangle("r", 0, 0, 2e9, 1e9)))
    with pytest.raises(ExportError) as reason:
        of_model(m, ".3mf", 1)
    assert render(reason.value.diagnostic) == (
        "error[E0918]: `s` does not fit into 3MF: it reaches further than 1e+09 mm\n"
        "  = hint: look for a size or position that was written in another unit, or multiplied once too often"
    )


def test_a_plate_with_many_holes() -> None:
    count = large(2500)
    holes = [circle(f"c[{k}]", 10 * (k % 50), 10 * (k // 50), 3) for k in range(count)]
    m = model(structure("solid", "s", rectangle("r", -10, -10, 500, 500), structure("hole", "h", *holes)))
    body = only(of_model(m, ".stl", 2), ".stl")
    assert body.is_watertight
    assert body.euler_number == 2 - 2 * count
    chord = 1e-4 * 510  # so far at most from the rims
    low, high = (2 * (510**2 - count * math.pi * r**2) for r in (3 + chord, 3 - chord))
    assert low < body.volume < high
    assert isinstance(draw(m)[0].bodies[0].region.faces[0].holes[0].pieces[0], Circle)


def test_a_format_needs_no_package_of_another() -> None:
    """In a process of its own, which has loaded nothing yet."""
    said = (
        "import sys; sys.modules['lib3mf'] = sys.modules['OCP'] = None; import aidl_lang\n"
        "made = aidl_lang.compile('@thickness(2mm) solid a { b = circle(radius: 4) }')\n"
        "for suffix in ('.stl', '.svg', '.dxf', '.pdf', '.png', '.json'): assert made.export(suffix)\n"
    )
    subprocess.run([sys.executable, "-c", said], check=True, timeout=120)


def test_a_package_that_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("aidl_lang.export.job.find_spec", lambda name: None)
    with pytest.raises(ExportError) as reason:
        written(RING, ".3mf")
    assert render(reason.value.diagnostic) == (
        "error[E0913]: `.3mf` needs a package that is not installed\n  = hint: pip install 'aidl-lang[3mf]'"
    )
    assert written(RING, ".stl").data == written(RING, ".stl").data
    assert importlib.util.find_spec("lib3mf") is not None

"""Examples of the workshop in the files as they are cut: a name sign of one piece, and a Raspberry Pi case,
every panel in every format, and all of them put together.
"""

from __future__ import annotations

import csv
import io
import math
import re
from functools import cache
from typing import Any

import numpy as np
import pypdfium2
import pytest
from shapely.geometry import MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from aidl_lang import Model
from aidl_lang.export import Exporter
from aidl_lang.export.job import Options
from aidl_lang.export.profiles import PROFILES
from tests.compiled import model
from tests.documents import ROOT
from tests.export.readers import Body, Loop, dxf_of, read_dxf, read_meshes, svg_paths, united
from tests.export.test_dxf import is_closed, ring

WORKSHOP = ROOT / "examples" / "workshop"
TEXT = (WORKSHOP / "name_sign.aidl").read_text("utf-8")
STENCIL = ", stencil: bridge"


@cache
def sign(text: str = TEXT) -> Model:
    found = model(text)
    assert found.ok
    return found


def size_on_paper(data: bytes) -> list[float]:
    with pypdfium2.PdfDocument(data) as made:
        assert len(made) == 1
        return [side * 25.4 / 72 for side in made[0].get_size()]


def left_over(made: Model) -> BaseGeometry:
    """What is left of the plate, read off the DXF with arcs in chords of a micrometre."""
    rest: BaseGeometry = Polygon()
    for entity in dxf_of(made.export("dxf")).modelspace():
        if entity.dxf.layer in ("solid", "hole"):
            assert is_closed(entity)
            rest = rest.symmetric_difference(Polygon(ring(entity, 1e-3)))
    return rest


def test_no_piece_falls_out() -> None:
    rest = left_over(sign())
    assert isinstance(rest, Polygon)
    assert rest.area == pytest.approx(sign().measure().area, rel=1e-4)
    assert sign().diagnostics == []


def test_without_bridges_pieces_fall_out_and_are_told() -> None:
    """A, two R, O and the two of B: six."""
    loose = sign(TEXT.replace(STENCIL, ""))
    rest = left_over(loose)
    assert isinstance(rest, MultiPolygon)
    assert len(rest.geoms) == 7
    (told,) = [d for d in loose.diagnostics if d.code == "W0714"]
    assert told.message.startswith("6 pieces fall out of solid `name_sign`")
    assert told.fix is not None


def test_engraving_comes_before_the_cuts() -> None:
    """In every file that a cutter follows; the line under the name is followed and not filled."""
    options = Options(profile=PROFILES["lightburn"])
    dxf = sign()._compiled.exported(".dxf", options).data
    layers = list(dict.fromkeys(e.dxf.layer for e in dxf_of(dxf).modelspace()))
    assert [layer.rpartition("-")[2] for layer in layers] == ["engrave", "inner", "outer"]
    svg = sign()._compiled.exported(".svg", options).data
    operations = [p.values["data-operation"] for p in svg_paths(svg)]
    assert list(dict.fromkeys(operations)) == ["engrave", "inner", "outer"]


def test_it_is_as_thick_as_said_in_space_and_as_large_on_paper() -> None:
    (solid,) = read_meshes(sign().export("stl"), ".stl").values()
    assert solid.is_watertight
    assert solid.volume == pytest.approx(4 * sign().measure().area, rel=1e-3)
    width, height = size_on_paper(sign().export("pdf"))
    assert width > 200
    assert height > 80


PANELS = ("base", "lid", "front", "back", "right", "left")
HOLES = {"base": 4, "lid": 9, "front": 4, "back": 0, "right": 3, "left": 1}
THICKNESS, KERF = 3.0, 0.15
LENGTH, DEPTH, HEIGHT = 97.0, 66.0, 32.4
SHEET = (300.0, 200.0)


@cache
def case() -> Model:
    found = model((WORKSHOP / "pi_case.aidl").read_text("utf-8"))
    assert found.ok
    assert found.diagnostics == []
    return found


@cache
def cutting() -> Exporter:
    """What works out once for all formats how its parts are cut."""
    return case()._compiled.exporting(Options(sheet=SHEET, kerf=KERF, profile=PROFILES["lightburn"]))


@cache
def sheet(suffix: str) -> bytes:
    made = cutting()(suffix)
    assert made.notes == ()
    assert made.further == ()
    return made.data


def test_svg_and_pdf_are_as_large_as_the_sheet_and_hold_as_much() -> None:
    paths = svg_paths(sheet(".svg"))
    by_operation = {
        op: [p for p in paths if p.values["data-operation"] == op] for op in ("inner", "outer", "fill")
    }
    assert [len(found) for found in by_operation.values()] == [sum(HOLES.values()), len(PANELS), 1]
    for path in by_operation["outer"]:
        left, top, right, bottom = path.bbox()
        assert min(left, top) > 2.9
        assert right < SHEET[0] - 2.9
        assert bottom < SHEET[1] - 2.9
    assert re.search(rb'width="300mm"', sheet(".svg"))
    assert size_on_paper(sheet(".pdf")) == pytest.approx(SHEET, abs=1e-3)
    with pypdfium2.PdfDocument(sheet(".pdf")) as made:
        assert len(list(made[0].get_objects())) == len(paths)


def test_the_cut_list_adds_up() -> None:
    text = sheet(".csv").decode("utf-8-sig")
    parts, sheets = (list(csv.DictReader(io.StringIO(part))) for part in text.split("\r\n\r\n"))
    assert [part["part"] for part in parts] == list(PANELS)
    for part in parts:
        body = drawn()[part["part"]]
        assert float(part["area_mm2"]) == pytest.approx(body.area, abs=0.01)
        assert float(part["cut_mm"]) == pytest.approx(body.perimeter, abs=0.01)
        x0, y0, x1, y1 = body.box
        assert (float(part["width_mm"]), float(part["height_mm"])) == pytest.approx(
            (x1 - x0, y1 - y0), abs=0.001
        )
    assert float(sheets[0]["cut_mm"]) == pytest.approx(sum(float(part["cut_mm"]) for part in parts), abs=0.01)


@cache
def drawn() -> dict[str, Body]:
    """The panels by name."""
    found = read_dxf(case().export("dxf", dxf="splines"))
    return {path.rpartition(".")[2]: body for path, body in found.items()}


def panels(suffix: str) -> dict[str, bytes]:
    found = case()._compiled.exporting(Options()).parts(suffix)
    return {item.name: made.data for item, made in found}


# --- Put together --------------------------------------------------------------------------------

_T = THICKNESS
STANDING = {
    "base": ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], (0, 0, 0)),
    "lid": ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], (0, 0, HEIGHT - _T)),
    "front": ([[1, 0, 0], [0, 0, -1], [0, 1, 0]], (0, _T, 0)),
    "back": ([[-1, 0, 0], [0, 0, 1], [0, 1, 0]], (LENGTH, DEPTH - _T, 0)),
    "right": ([[0, 0, 1], [1, 0, 0], [0, 1, 0]], (LENGTH - _T, 0, 0)),
    "left": ([[0, 0, -1], [-1, 0, 0], [0, 1, 0]], (_T, DEPTH, 0)),
}
"""How each panel, lying with its corner at the origin and its outside up, gets to its place in the case."""


def standing(suffix: str) -> dict[str, Any]:
    found = {}
    for name, data in panels(suffix).items():
        (mesh,) = read_meshes(data, suffix).values()
        assert mesh.is_watertight
        motion = np.eye(4)
        motion[:3, :3], motion[:3, 3] = STANDING[name]
        assert np.linalg.det(motion) == pytest.approx(1)
        found[name] = mesh.apply_transform(motion)
    return found


def test_the_panels_make_a_closed_case() -> None:
    """No two of them share any room, and together they are as large as a hollow box less the openings."""
    meshes = standing(".stl")
    together = united(meshes.values())
    total = sum(mesh.volume for mesh in meshes.values())
    assert together.volume == pytest.approx(total, abs=0.05)
    assert together.bounds == pytest.approx(np.array([[0, 0, 0], [LENGTH, DEPTH, HEIGHT]]), abs=1e-3)
    hollow = (LENGTH - 2 * _T) * (DEPTH - 2 * _T) * (HEIGHT - 2 * _T)
    openings = sum(abs(loop.area) for panel in drawn() for loop in _inner(panel))
    assert total == pytest.approx(LENGTH * DEPTH * HEIGHT - hollow - _T * openings, rel=1e-4)


def _inner(panel: str) -> list[Loop]:
    if panel == "label":
        return []
    return sorted(drawn()[panel].loops, key=lambda loop: -abs(loop.area))[1:]


def test_the_openings_lie_where_the_plugs_of_the_board_are() -> None:
    """Places of the plugs from the corner of the board, mm, and the board 2 mm from the panels beside it."""

    def middles(panel: str) -> list[tuple[float, float]]:
        left, bottom, _, _ = drawn()[panel].box
        boxes = [(loop.polygon(64).min(axis=0), loop.polygon(64).max(axis=0)) for loop in _inner(panel)]
        return sorted((float(a[0] + b[0]) / 2 - left, float(a[1] + b[1]) / 2 - bottom) for a, b in boxes)

    board = THICKNESS + 2
    holes = middles("base")
    assert [x for x, _ in holes] == pytest.approx([board + 3.5] * 2 + [board + 61.5] * 2, abs=0.01)
    assert sorted({round(y, 2) for _, y in holes}) == [board + 3.5, board + 52.5]
    assert [x for x, _ in middles("front")] == pytest.approx(
        [board + x for x in (11.2, 26, 39.5, 54)], abs=0.01
    )
    assert [x for x, _ in middles("right")] == pytest.approx([board + y for y in (9, 27, 45.75)], abs=0.01)
    deck = THICKNESS + 5 + 1.4
    assert [y for _, y in middles("right")] == pytest.approx([deck + 8, deck + 8, deck + 7], abs=0.01)
    assert math.dist(middles("left")[0], (DEPTH / 2, deck - 2.5)) < 0.01

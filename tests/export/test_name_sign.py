"""The workshop example of a name sign: what is left of it is one piece, in the files as they are cut."""

from __future__ import annotations

import io
from functools import cache

import ezdxf
import pypdfium2
import pytest
from shapely.geometry import MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry
from svgelements import SVG
from svgelements import Path as SvgPath

from aidl_lang import Model
from aidl_lang.export.job import Options
from aidl_lang.export.profiles import PROFILES
from tests.compiled import model
from tests.documents import ROOT
from tests.export.readers import read_meshes
from tests.export.test_dxf_for_cutters import is_closed, ring

TEXT = (ROOT / "examples" / "workshop" / "name_sign.aidl").read_text("utf-8")
STENCIL = ", stencil: bridge"


@cache
def sign(text: str = TEXT) -> Model:
    found = model(text)
    assert found.ok
    return found


def left_over(made: Model) -> BaseGeometry:
    """What is left of the plate, read off the DXF with arcs in chords of a micrometre."""
    rest: BaseGeometry = Polygon()
    for entity in ezdxf.read(io.StringIO(made.export("dxf").decode())).modelspace():
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
    dxf = sign()._compiled.exported(".dxf", options).data.decode()
    layers = list(dict.fromkeys(e.dxf.layer for e in ezdxf.read(io.StringIO(dxf)).modelspace()))
    assert [layer.rpartition("-")[2] for layer in layers] == ["engrave", "inner", "outer"]
    svg = SVG.parse(io.BytesIO(sign()._compiled.exported(".svg", options).data), ppi=25.4)
    operations = [p.values["data-operation"] for p in svg.elements(lambda e: isinstance(e, SvgPath))]
    assert list(dict.fromkeys(operations)) == ["engrave", "inner", "outer"]


def test_it_is_as_thick_as_said_in_space_and_as_large_on_paper() -> None:
    (solid,) = read_meshes(sign().export("stl"), ".stl").values()
    assert solid.is_watertight
    assert solid.volume == pytest.approx(4 * sign().measure().area, rel=1e-3)
    with pypdfium2.PdfDocument(sign().export("pdf")) as made:
        width, height = (side * 25.4 / 72 for side in made[0].get_size())
    assert width > 200
    assert height > 80

"""DXF files as ezdxf reads them back: entities, areas, ends, layers, names, bytes."""

from __future__ import annotations

import io
import json
import math
from collections import Counter
from typing import Any

import ezdxf
import numpy as np
import pytest
import shapely
from ezdxf.document import Drawing as Document

import aidl_lang
from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.source import SourceFile
from aidl_lang.export import export
from aidl_lang.export.job import Job, Options
from aidl_lang.geometry.curves import Ellipse, Line
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.solved import SolvedModel, SolvedStructure
from tests.export.readers import read_dxf
from tests.geometry.models import arc, circle, compound, model, primitive, rectangle, structure

EXACT = Options(dxf="splines")


def written(m: SolvedModel, options: Options | None = None) -> tuple[Document, tuple[Diagnostic, ...]]:
    made = export(Job(m, draw(m)[0], options=options or Options()), ".dxf")
    document = ezdxf.read(io.StringIO(made.data.decode()))
    auditor = document.audit()
    assert not auditor.errors
    assert not auditor.fixes
    return document, made.notes


def document_of(root: SolvedStructure, options: Options | None = None) -> Document:
    return written(model(root), options)[0]


def exported(program: str, options: Options | None = None) -> bytes:
    return pipeline.compile(SourceFile("x.aidl", program)).export(".dxf", options)


def document_from(program: str, options: Options | None = None) -> Document:
    return ezdxf.read(io.StringIO(exported(program, options).decode()))


def kinds(document: Document) -> Counter[tuple[str, str]]:
    return Counter((e.dxftype(), e.dxf.layer) for e in document.modelspace())


def named(entity: Any, application: str = "AIDL") -> str:
    return "".join(tag.value for tag in entity.get_xdata(application) if tag.code == 1000)


def only(document: Document, kind: str) -> Any:
    (entity,) = document.modelspace().query(kind)
    return entity


# --- Forms -----------------------------------------------------------------------------------------


def test_a_circle_and_a_hole():
    document = document_of(
        structure("solid", "s", circle("c", 3, 4, 10), structure("hole", "h", circle("c", 3, 4, 2)))
    )
    first, second = document.modelspace()
    assert (first.dxftype(), first.dxf.layer, first.dxf.radius) == ("CIRCLE", "hole", 2)
    assert (second.dxftype(), second.dxf.layer, second.dxf.radius) == ("CIRCLE", "solid", 10)
    assert second.dxf.center == (3, 4, 0)


@pytest.mark.parametrize("turn", [1e-4, 0.01, 1, 90, 179, 181, 200, 270, 350, 359, 359.9, 359.999])
@pytest.mark.parametrize("way", [1, -1])
def test_arcs_come_back_from_their_bulges(turn: float, way: int):
    """An arc from 20° and its chord: all arcs read back have its centre and radius, and sweep as far."""
    bow = arc((7, -3), 25, 20, 20 + way * turn)
    entity = only(
        document_of(structure("drawing", "d", compound("x", bow, Line(bow.end, bow.start)))), "LWPOLYLINE"
    )
    arcs = [e for e in entity.virtual_entities() if e.dxftype() == "ARC"]
    assert len(arcs) == (1 if turn <= 315 else 2)
    assert sum(map(_sweep, arcs)) == pytest.approx(turn, rel=1e-9)
    size = min(50, 25 * math.radians(turn))
    # What the ends of a flat arc tell of its centre is worth less, by its radius over its chord.
    slack = 25 * 1e-13 * max(100, 25 / size)
    for found in arcs:
        assert math.dist(found.dxf.center.vec2, (7, -3)) < slack
        assert found.dxf.radius == pytest.approx(25, abs=slack)
        for p in found.vertices(np.linspace(found.dxf.start_angle, found.dxf.end_angle, 9)):
            assert abs(math.dist(p.vec2, (7, -3)) - 25) < 1e-9 * size


def _sweep(found: Any) -> float:
    return float((found.dxf.end_angle - found.dxf.start_angle) % 360)


LEAF = """solid leaf {
    bow = bezier(fixed((0, 0)), fixed((10, 30)), fixed((30, 30)), fixed((40, 0)))
    foot = line(bow.end, bow.start)
    hole bite { rim = ellipse(center: fixed((0, 0)), rx: WIDE, ry: HIGH) }
    hole nick { rim = circle(center: fixed((30, 0)), radius: 5) }
}"""


@pytest.mark.parametrize(("wide", "high"), [("12", "6"), ("6", "12")])
def test_ends_of_a_mixed_outline_agree(wide: str, high: str):
    program = LEAF.replace("WIDE", wide).replace("HIGH", high)
    document = document_from(program, EXACT)
    assert set(kinds(document)) == {(k, "solid") for k in ("LINE", "ARC", "ELLIPSE", "SPLINE")}
    (loop,) = read_dxf(exported(program, EXACT))["leaf"].loops
    assert loop.gap() < 1e-12 * 40
    area = json.loads(aidl_lang.compile(program).to_json())["regions"]["leaf"]["area"]
    assert loop.area == pytest.approx(area, rel=1e-8)


def test_lines_of_a_drawing_are_joined_in_any_order_and_direction():
    sides = (Line((0, 0), (9, 0)), Line((0, 5), (9, 5)), Line((0, 5), (0, 0)), Line((9, 0), (9, 5)))
    found = only(document_of(structure("drawing", "d", compound("r", *sides))), "*")
    assert found.dxftype() == "LWPOLYLINE"
    assert found.closed
    assert sorted(p[:2] for p in found.get_points()) == [(0, 0), (0, 5), (9, 0), (9, 5)]
    rays = [primitive(f"l{k}", Line((0, 0), (math.cos(k), math.sin(k)))) for k in range(3)]
    assert kinds(document_of(structure("drawing", "d", *rays))) == {("LINE", "drawing"): 3}
    bent = (Line((0, 0), (5, 0)), Line((5, 3), (5, 0)))
    found = only(document_of(structure("drawing", "d", compound("v", *bent))), "*")
    assert (found.closed, found.get_points("xy")) == (False, [(0, 0), (5, 0), (5, 3)])


# --- Layers, colours, names, order -----------------------------------------------------------------


def test_layers_by_kind_and_their_colours():
    bore = structure("hole", "h", circle("c", 9, 9, 3))
    loose = primitive("loose", Line((60, 0), (70, 3)))
    parts = (
        structure("solid", "s", rectangle("r", 0, 0, 30, 30), bore),
        structure("solid", "t", rectangle("r", 40, 0, 50, 30), loose),
        structure("drawing", "d", circle("c", 20, 20, 3)),
    )
    document = document_of(structure("assembly", "a", circle("own", 100, 0, 5), *parts))
    assert kinds(document) == {
        ("CIRCLE", "assembly"): 1,
        ("LWPOLYLINE", "solid"): 2,
        ("CIRCLE", "hole"): 1,
        ("CIRCLE", "drawing"): 1,
        ("LINE", "open"): 1,
    }
    colors = {layer.dxf.name: layer.color for layer in document.layers}
    own = {"assembly": 7, "solid": 7, "hole": 1, "drawing": 5, "open": 6}
    assert colors == {"0": 7, "Defpoints": 7, **own}


def test_engraving_comes_first_and_holes_before_what_is_around_them():
    inner = structure("solid", "island", circle("c", 0, 0, 5))
    eye = structure("hole", "eye", circle("c", 0, 0, 20), inner)
    plate = structure("solid", "plate", rectangle("r", -30, -30, 30, 30), eye)
    bore = structure("hole", "bore", circle("c", 60, 0, 1))
    cap = structure("solid", "cap", circle("c", 60, 0, 8), bore)
    mark = structure("drawing", "mark", primitive("l", Line((-25, 0), (-22, 0))))
    document = document_of(structure("assembly", "a", plate, cap, mark))
    first, *cuts = document.modelspace()
    assert first.dxftype() == "LINE"
    shapes = [
        shapely.Point(e.dxf.center.vec2).buffer(e.dxf.radius)
        if e.dxftype() == "CIRCLE"
        else shapely.Polygon(e.get_points("xy"))
        for e in cuts
    ]
    assert len(shapes) == 5
    for k, shape in enumerate(shapes):
        assert not any(before.contains_properly(shape) for before in shapes[:k])


@pytest.mark.parametrize(
    ("layers", "names", "messages"),
    [
        (["a/b"], ["a_b"], ["the layer `a/b` is called `a_b` in the DXF"]),
        (["Cut", "cut"], ["Cut", "cut_2"], ["the layer `cut` is called `cut_2` in the DXF"]),
        (["a/b", "a_b"], ["a_b", "a_b_2"], ["the layer `a/b`", "the layer `a_b` is called `a_b_2`"]),
        (["DEFPOINTS"], ["DEFPOINTS_2"], ["the layer `DEFPOINTS`"]),
        (["Hole"], ["Hole_2"], ["the layer `Hole`"]),
        (["hole", "0", "Größe 本"], ["hole", "0", "Größe 本"], []),
        (["", " ", "\n", "\x00\ud800\u2028\x85"], ["solid", "_", "__2"], ["", "", ""]),
        (["x" * 300, "X" * 300], ["x" * 255, "X" * 253 + "_2"], ["`" + "x" * 59 + "…`", "…"]),
        (["</svg>\\U+0041%%d^J"], ["__svg__U+0041%%d_J"], ["the layer"]),
    ],
    ids=lambda v: repr(v)[:20] if isinstance(v, list) else None,
)
def test_hostile_layer_names(layers: list[str], names: list[str], messages: list[str]):
    parts = [
        structure("solid", f"s{k}", circle("c", 30 * k, 0, 10 + k), layer=(name,))
        for k, name in enumerate(layers)
    ]
    document, notes = written(model(structure("assembly", "a", *parts)))
    found = [e.dxf.layer for e in document.modelspace()]
    if "" not in layers:
        assert found == names
    assert len({name.casefold() for name in found}) == len(layers)
    assert [n.code for n in notes] == ["W0720"] * len(messages)
    assert all(part in note.message for part, note in zip(messages, notes, strict=True))


@pytest.mark.parametrize("name", ["größe", "x" * 1000, "本" * 400])
def test_long_and_foreign_names_survive(name: str):
    found = only(document_of(structure("solid", name, circle("c", 0, 0, 1))), "*")
    assert named(found) == name
    assert all(len(tag.value.encode()) <= 255 for tag in found.get_xdata("AIDL"))


# --- Edges -----------------------------------------------------------------------------------------


def test_an_empty_drawing_says_so():
    plans = [structure("solid", f"p{k}") for k in range(5)]
    document, notes = written(model(structure("assembly", "a", *plans)))
    assert len(document.modelspace()) == 0
    (note,) = notes
    assert (note.code, note.message) == ("W0721", "nothing is drawn, so what is written is empty")
    document, (note,) = written(model(structure("drawing", "d")))
    assert note.hints == ()


def test_a_hole_that_nothing_holds():
    assert kinds(document_of(structure("hole", "h", rectangle("r", 0, 0, 4, 4)))) == {
        ("LWPOLYLINE", "hole"): 1
    }


def test_a_thin_ellipse_has_the_least_ratio_that_dxf_takes():
    root = structure("drawing", "d", primitive("e", Ellipse((0, 0), 1e-7, 20, 0)))
    found = only(document_of(root, EXACT), "ELLIPSE")
    assert found.dxf.ratio == 1e-6
    assert tuple(found.dxf.major_axis)[1] == 20

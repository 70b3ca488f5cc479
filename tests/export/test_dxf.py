"""DXF files as ezdxf reads them back: entities, areas, ends, layers, names, bytes."""

from __future__ import annotations

import io
import json
import math
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path
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
from aidl_lang.export import Job, Options, export
from aidl_lang.geometry.curves import Bezier, Ellipse, Line
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.solved import SolvedModel, SolvedStructure
from tests.amount import large, tried
from tests.compiled import LIGHTER, compiled
from tests.export.readers import read_dxf
from tests.geometry.models import arc, circle, compound, model, primitive, rectangle, structure

ROOT = Path(__file__).parents[2]


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


def test_header():
    document = document_of(structure("solid", "s", rectangle("r", -10, 5, 50, 25)))
    header = document.header
    assert document.acad_release == "R2010"
    assert (header["$INSUNITS"], header["$MEASUREMENT"]) == (4, 1)
    assert header["$EXTMIN"] == (-10, 5, 0)
    assert header["$EXTMAX"] == (50, 25, 0)
    (view,) = document.viewports.get("*Active")
    assert view.dxf.center == (20, 15)
    assert view.dxf.height >= 60


def test_a_rectangle_is_one_closed_polyline_at_1_to_1():
    entity = only(document_of(structure("solid", "s", rectangle("r", -10, 5, 50, 25))), "*")
    assert entity.dxftype() == "LWPOLYLINE"
    assert entity.closed
    corners = [(-10, 5), (50, 5), (50, 25), (-10, 25)]
    assert sorted(entity.get_points("xyb")) == sorted((x, y, 0) for x, y in corners)


def test_a_circle_and_a_hole():
    document = document_of(
        structure("solid", "s", circle("c", 3, 4, 10), structure("hole", "h", circle("c", 3, 4, 2)))
    )
    first, second = document.modelspace()
    assert (first.dxftype(), first.dxf.layer, first.dxf.radius) == ("CIRCLE", "hole", 2)
    assert (second.dxftype(), second.dxf.layer, second.dxf.radius) == ("CIRCLE", "solid", 10)
    assert second.dxf.center == (3, 4, 0)


def test_half_circles_have_the_bulge_1():
    document = document_from("solid s { body = slot(center: origin, length: 60, width: 20) }")
    entity = only(document, "LWPOLYLINE")
    assert sorted(b for *_, b in entity.get_points("xyb")) == pytest.approx([0, 0, 1, 1], abs=1e-15)


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


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("turn", [10, 90, 200, 350])
def test_an_arc_by_itself(turn: float, way: int):
    bow = arc((7, -3), 25, 20, 20 + way * turn)
    found = only(document_of(structure("drawing", "d", primitive("a", bow))), "*")
    assert found.dxftype() == "ARC"
    assert found.dxf.radius == 25
    assert _sweep(found) == pytest.approx(turn, rel=1e-12)
    assert found.dxf.start_angle == pytest.approx((20 if way > 0 else 20 - turn) % 360, rel=1e-12)


@pytest.mark.parametrize(("rx", "ry"), [(30, 10), (10, 30), (20, 20)])
@pytest.mark.parametrize("angle", [0.0, 0.4, -2.0])
def test_an_ellipse(rx: float, ry: float, angle: float):
    root = structure("solid", "s", primitive("e", Ellipse((5, 6), rx, ry, angle)))
    found = only(document_of(root, EXACT), "*")
    assert found.dxftype() == "ELLIPSE"
    assert found.dxf.ratio == min(rx, ry) / max(rx, ry)
    assert found.dxf.major_axis.magnitude == pytest.approx(max(rx, ry), rel=1e-12)
    assert found.construction_tool().param_span == pytest.approx(math.tau)
    c, s = math.cos(angle), math.sin(angle)
    for p in found.vertices(np.linspace(0, 6, 20)):
        x, y = p.x - 5, p.y - 6
        assert ((c * x + s * y) / rx) ** 2 + ((c * y - s * x) / ry) ** 2 == pytest.approx(1, rel=1e-11)


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


def test_a_bezier_is_a_spline_of_one_span():
    curve = Bezier((0, 0), (10, 30), (30, -30), (40, 0))
    found = only(document_of(structure("drawing", "d", primitive("b", curve)), EXACT), "SPLINE")
    assert [tuple(p)[:2] for p in found.control_points] == [curve.p0, curve.p1, curve.p2, curve.p3]
    assert list(found.knots) == [0, 0, 0, 0, 1, 1, 1, 1]
    assert (found.dxf.degree, list(found.weights)) == (3, [])


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


@pytest.mark.parametrize("path", LIGHTER)
def test_examples(path: Path):
    """Bodies by name, their areas from the entities read back, holes without seams."""
    result = compiled(path.read_text("utf-8"))
    document = json.loads(result.export(".json"))
    bodies = read_dxf(result.export(".dxf", EXACT))
    drawing = result.drawing
    assert drawing is not None
    assert {b.path for b in drawing.bodies} == bodies.keys() & document["regions"].keys()
    for name in (b.path for b in drawing.bodies):
        region = document["regions"][name]
        loops = sorted(bodies[name].loops, key=lambda loop: -loop.area)
        assert len(loops) == region["loops"]
        assert sum(loop.length for loop in loops) == pytest.approx(region["perimeter"], rel=1e-7)
        if len(region["faces"]) == 1:
            area = loops[0].area - sum(loop.area for loop in loops[1:])
            assert area == pytest.approx(region["area"], rel=1e-8)
        assert max(loop.gap() for loop in loops) < 1e-6 * math.sqrt(region["area"])


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


LAYERED = """assembly a {
    @layer("cut") solid plate {
        body = rectangle(center: origin, width: 60, height: 40)
        hole plain { rim = circle(center: fixed((-20, 0)), radius: 4) }
        @layer("drill") @color(red) hole bolt[0] { rim = circle(center: fixed((0, 0)), radius: 4) }
        @layer("drill") hole slit {
            rim = slot(center: fixed((20, 0)), length: 12, width: 4)
            hole deep { cross = rectangle(center: fixed((20, 0)), width: 3, height: 20) }
        }
        @color("#0a0b0c") drawing mark { line_ = line(start: (0, 15), end: (10, 15)) }
    }
    solid washer { body = ring(center: fixed((80, 0)), outer_radius: 10, inner_radius: 5) }
}"""


def test_layers_and_colours_as_written():
    document = document_from(LAYERED)
    assert kinds(document) == {
        ("LWPOLYLINE", "cut"): 1,
        ("CIRCLE", "cut"): 1,
        ("CIRCLE", "drill"): 1,
        ("LWPOLYLINE", "drill"): 1,
        ("LINE", "cut"): 1,
        ("CIRCLE", "hole"): 1,
        ("CIRCLE", "solid"): 1,
    }
    colors = {e.dxf.true_color: named(e) for e in document.modelspace() if e.dxf.hasattr("true_color")}
    assert colors == {0xFF0000: "a.plate", 0x0A0B0C: "a.plate.mark"}
    assert document.layers.get("cut").color != document.layers.get("drill").color


def test_each_entity_tells_its_body_and_its_hole():
    found = Counter(
        (named(e), named(e, "AIDL_HOLE") if e.has_xdata("AIDL_HOLE") else None)
        for e in document_from(LAYERED).modelspace()
    )
    holes = ("plain", "bolt[0]", "slit")
    expected = {("a.plate", f"a.plate.{h}") for h in holes} | {("a.plate", None), ("a.plate.mark", None)}
    assert set(found) >= expected - {("a.plate", "a.plate.slit")}
    assert found["a.washer", None] == 2
    assert found["a.plate", "a.plate.slit"] + found["a.plate", "a.plate.slit.deep"] == 1


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


def test_what_is_said_of_a_changed_layer():
    program = """assembly a {
        @layer("a:b") solid s { c = circle(radius: 5) }
        @layer("A_B") solid t { c = circle(radius: 9) }
    }"""
    found = pipeline.compile(SourceFile("x.aidl", program))
    assert found.drawing is not None
    assert found.model is not None
    first, second = export(Job(found.model, found.drawing), ".dxf").notes
    assert first.message == "the layer `a:b` is called `a_b` in the DXF"
    assert first.hints == ('names in DXF have 1 to 255 characters and none of < > / \\ " : ; ? * | , = ` ^',)
    assert first.span is not None
    assert first.span.line == 2
    assert second.message == "the layer `A_B` is called `A_B_2` in the DXF"
    assert second.hints == (
        "DXF makes no difference between capital and small letters in names, and keeps some for itself",
    )


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


@pytest.mark.parametrize(("x", "size"), [(1e8, 10.0), (0.0, 1e-3), (-5e10, 1e9)])
def test_far_away_small_and_large(x: float, size: float):
    bow = arc((x, 0), size, 0, 180)
    m = model(structure("solid", "s", compound("d", bow, Line(bow.end, bow.start))))
    found = only(written(m)[0], "LWPOLYLINE")
    (half,) = (e for e in found.virtual_entities() if e.dxftype() == "ARC")
    assert half.dxf.radius == pytest.approx(size, rel=1e-9)
    assert half.dxf.center.x == pytest.approx(x, abs=1e-9 * max(size, abs(x) * 1e-7))


def test_a_thin_ellipse_has_the_least_ratio_that_dxf_takes():
    root = structure("drawing", "d", primitive("e", Ellipse((0, 0), 1e-7, 20, 0)))
    found = only(document_of(root, EXACT), "ELLIPSE")
    assert found.dxf.ratio == 1e-6
    assert tuple(found.dxf.major_axis)[1] == 20


def test_the_same_bytes_in_every_process():
    script = (
        "import sys, aidl_lang, pathlib\n"
        "sys.stdout.buffer.write(aidl_lang.compile(pathlib.Path(sys.argv[1])).export('.dxf'))"
    )
    run = [sys.executable, "-c", script, str(ROOT / "examples" / "key.aidl")]
    one, *others = (
        subprocess.run(run, check=True, capture_output=True, env=os.environ | {"PYTHONHASHSEED": seed}).stdout
        for seed in "12345"[: tried(5)]
    )
    assert others
    assert all(other == one for other in others)
    assert len(one) > 10_000
    assert not ezdxf.options.write_fixed_meta_data_for_testing


def test_thousands_of_circles():
    count = large(3_000)
    holes = [
        structure("hole", f"h[{k}]", circle("c", 10 * (k % 100), 10 * (k // 100), 3)) for k in range(count)
    ]
    m = model(structure("solid", "p", rectangle("r", -10, -10, 1010, 1010), *holes))
    drawing, _ = draw(m)
    made = export(Job(m, drawing), ".dxf")
    document = ezdxf.read(io.StringIO(made.data.decode()))
    assert kinds(document) == {("CIRCLE", "hole"): count, ("LWPOLYLINE", "solid"): 1}
    assert {named(e, "AIDL_HOLE") for e in document.modelspace().query("CIRCLE")} == {
        f"p.h[{k}]" for k in range(count)
    }


def test_a_hole_is_on_the_layer_of_its_own_part() -> None:
    bar = "{ r = rectangle(width: 30, height: 8)\n hole h { rim = circle(radius: 2) } }"
    text = f'assembly a {{ @layer("low") solid low {bar} @layer("high") solid high {bar} }}\n'
    document = ezdxf.read(io.StringIO(pipeline.compile(SourceFile("a", text)).export(".dxf").decode()))
    assert sorted(e.dxf.layer for e in document.modelspace().query("CIRCLE")) == ["high", "low"]

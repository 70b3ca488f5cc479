"""DXF files as ezdxf reads them back: entities, areas, ends, layers, names, bytes; and as cutters take them:
closed polylines of lines and arcs near the curves, in order, in old words too.
"""

from __future__ import annotations

import json
import math
from collections import Counter
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import shapely
from ezdxf.document import Drawing as Document
from shapely import LinearRing, Polygon

import aidl_lang
from aidl_lang.export import Exporter
from aidl_lang.export.job import Job, Options
from aidl_lang.geometry.curves import Ellipse, Line
from aidl_lang.geometry.solved import SolvedStructure
from tests.compiled import compiled
from tests.documents import ROOT
from tests.export.making import written
from tests.export.readers import dxf_of, read_dxf
from tests.geometry.models import arc, circle, compound, primitive, rectangle, structure


def read(data: bytes) -> Document:
    found = dxf_of(data)
    auditor = found.audit()
    assert not auditor.errors
    assert not auditor.fixes
    return found


def document_of(root: SolvedStructure | str, **options: Any) -> Document:
    return read(written(root, ".dxf", **options).data)


def kinds(document: Document) -> Counter[tuple[str, str]]:
    return Counter((e.dxftype(), e.dxf.layer) for e in document.modelspace())


def named(entity: Any, application: str = "AIDL") -> str:
    return "".join(tag.value for tag in entity.get_xdata(application) if tag.code == 1000)


def only(document: Document, kind: str) -> Any:
    (entity,) = document.modelspace().query(kind)
    return entity


# --- Forms -----------------------------------------------------------------------------------------


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
    document = document_of(program, dxf="splines")
    assert set(kinds(document)) == {(k, "solid") for k in ("LINE", "ARC", "ELLIPSE", "SPLINE")}
    (loop,) = read_dxf(written(program, ".dxf", dxf="splines").data)["leaf"].loops
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
    made = written(structure("assembly", "a", *parts), ".dxf")
    found, notes = [e.dxf.layer for e in read(made.data).modelspace()], made.notes
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
    made = written(structure("assembly", "a", *plans), ".dxf")
    assert len(read(made.data).modelspace()) == 0
    (note,) = made.notes
    assert (note.code, note.message) == ("W0721", "nothing is drawn, so what is written is empty")
    assert written(structure("drawing", "d"), ".dxf").notes[0].hints == ()


def test_a_hole_that_nothing_holds():
    assert kinds(document_of(structure("hole", "h", rectangle("r", 0, 0, 4, 4)))) == {
        ("LWPOLYLINE", "hole"): 1
    }


def test_a_thin_ellipse_has_the_least_ratio_that_dxf_takes():
    root = structure("drawing", "d", primitive("e", Ellipse((0, 0), 1e-7, 20, 0)))
    found = only(document_of(root, dxf="splines"), "ELLIPSE")
    assert found.dxf.ratio == 1e-6
    assert tuple(found.dxf.major_axis)[1] == 20


SIGN = """@thickness(3mm)
@detached
solid sign {
    plate = rounded_rectangle(center: origin, width: 200, height: 60, radius: 10)
    hole word { letters = text("Rb&8", height: 14) }
    hole left { rim = ellipse(center: fixed((-92, 0)), rx: 2, ry: 3) }
    drawing frame {
        e = ellipse(rx: 84, ry: 25)
        s = text("ie98", height: 6)
    }
    constrain {
        word.letters.center == plate.center + (0, 6)
        frame.s.center == plate.center - (0, 10)
        frame.e.center == plate.center
    }
}
"""
GEAR = """@detached solid gear {
    rim = spur_gear(center: fixed((0, 0)), module: 2, teeth: 11)
    hole bore { eye = ellipse(center: fixed((0, 0)), rx: 4, ry: 3) }
}
"""
OWN = {"sign": SIGN, "gear": GEAR}


def text_of(name: str) -> str:
    return OWN.get(name) or (ROOT / "examples" / f"{name}.aidl").read_text("utf-8")


def document(name: str, **options: Any) -> Document:
    return document_of(text_of(name), cut=True, **options)


def is_closed(entity: Any) -> bool:
    match entity.dxftype():
        case "LWPOLYLINE":
            return bool(entity.closed)
        case "POLYLINE":
            return bool(entity.is_closed)
        case kind:
            return bool(kind == "CIRCLE")


def ring(entity: Any, sagitta: float = 1e-3) -> np.ndarray[Any, Any]:
    """Its points, in its own direction."""
    if entity.dxftype() == "CIRCLE":
        return np.array([(p.x, p.y) for p in entity.flattening(sagitta)])
    parts = [list(e.flattening(sagitta)) if e.dxftype() == "ARC" else None for e in entity.virtual_entities()]
    corners = list(entity.get_points("xyb") if entity.dxftype() == "LWPOLYLINE" else entity.points())
    found: list[tuple[float, float]] = []
    for corner, part in zip(corners, parts, strict=True):
        here = (corner[0], corner[1])
        found.append(here)
        if part is not None:
            inner = [(p.x, p.y) for p in part]
            found += (inner if math.dist(inner[0], here) < math.dist(inner[-1], here) else inner[::-1])[1:-1]
    return np.array(found)


def test_the_sign_is_engraved_by_closed_polylines_too() -> None:
    engraved = [e for e in document("sign").modelspace() if e.dxf.layer == "drawing"]
    assert all(e.dxftype() == "LWPOLYLINE" and e.closed for e in engraved)
    # Dotted i, e and 9 with an eye, two of them in 8; and the frame.
    assert len(engraved) == 4 + 1 + 1 + 1 + 2 + 1


@pytest.mark.parametrize(("name", "tolerance"), [("sign", 0.1), ("gear", 0.01)])
def test_arcs_are_within_the_tolerance_both_ways(name: str, tolerance: float) -> None:
    """Curves of the exact file are sampled at a hundred places, an ellipse at many; arcs as finely as a
    hundredth of the tolerance asks for.
    """
    exact = read_dxf(written(text_of(name), ".dxf", cut=True, dxf="splines").data)
    rings = {
        path: [LinearRing(loop.polygon(2000 if len(loop.curves) == 1 else 100)) for loop in body.loops]
        for path, body in exact.items()
    }
    worst = 0.0
    for entity in document(name, tolerance=tolerance).modelspace():
        path = named(entity)
        found = LinearRing(ring(entity, tolerance / 100))
        off = {id(c): np.abs(np.subtract(c.bounds, found.bounds)).max() for c in rings[path]}
        curve = min(rings[path], key=lambda c: off[id(c)])
        for one, other in ((found, curve), (curve, found)):
            spots = shapely.points(one.coords)[:: max(1, len(one.coords) // 2000)]
            worst = max(worst, float(shapely.distance(spots, other).max()))
    assert 0.2 * tolerance < worst <= 1.02 * tolerance


@pytest.mark.parametrize("name", [*OWN, "telephone"])
def test_outer_contours_run_counter_clockwise_and_inner_ones_clockwise(name: str) -> None:
    for entity in document(name).modelspace():
        if entity.dxf.layer not in ("solid", "hole") or entity.dxftype() == "CIRCLE":
            continue
        if entity.has_xdata("AIDL_HOLE"):
            assert not LinearRing(ring(entity)).is_ccw
        elif entity.dxf.layer == "solid":
            assert LinearRing(ring(entity)).is_ccw


@pytest.mark.parametrize("name", OWN)
def test_the_kerf_is_half_on_either_side_and_leaves_no_slivers(name: str) -> None:
    wide = list(document(name, kerf=0.15).modelspace())
    cut = [e for e in wide if e.dxf.layer in ("solid", "hole")]
    narrow = [e for e in document(name).modelspace() if e.dxf.layer in ("solid", "hole")]
    assert len(cut) == len(narrow)
    left = [Polygon(ring(e)) for e in narrow]
    for entity in cut:
        if entity.dxftype() != "CIRCLE":
            assert min(map(_length, entity.virtual_entities())) > 0.03
        shape = Polygon(ring(entity))
        grown = 1 if entity.dxf.layer == "solid" else -1
        before = min(left, key=lambda p: p.centroid.distance(shape.centroid) + abs(p.length - shape.length))
        wanted = before.buffer(grown * 0.075, join_style="mitre", mitre_limit=10)
        assert shape.symmetric_difference(wanted).area < 0.02 * shape.length


def _length(piece: Any) -> float:
    if piece.dxftype() == "LINE":
        return float(piece.dxf.start.distance(piece.dxf.end))
    return float(piece.dxf.radius * math.radians((piece.dxf.end_angle - piece.dxf.start_angle) % 360))


def test_what_is_cut_is_worked_out_once_for_all_files() -> None:
    result, told = compiled(GEAR), list[tuple[int, int]]()
    assert result.model is not None
    assert result.drawing is not None
    job = Job(result.model, result.drawing, options=Options(kerf=0.2, sheet=(600, 400)))
    exporter = Exporter(job, lambda done, count: told.append((done, count)))
    first, *others = (exporter(suffix).data for suffix in (".svg", ".pdf", ".dxf", ".svg"))
    count = len(result.drawing.regions)
    assert told == [(k, count) for k in range(count + 1)]
    assert others[-1] == first


# --- R12 -------------------------------------------------------------------------------------------

OLD = """assembly a {
    @layer("größer als 3") @color("#ff0000") @stroke(0.5mm) @dash(3, 1.5)
    solid s { body = slot(center: origin, length: 60, width: 20) }
    @layer("ritzen") drawing d { c = bezier((0, 0), (3, 8), (7, 8), (10, 0)) }
}"""


def test_r12(capfd: pytest.CaptureFixture[str]) -> None:
    made = written(OLD, ".dxf", dxf="r12")
    assert capfd.readouterr() == ("", "")
    found = dxf_of(made.data, "cp1252")
    assert found.acad_release == "R12"
    stroke, body = found.modelspace()
    assert [e.dxftype() for e in (stroke, body)] == ["POLYLINE", "POLYLINE"]
    assert (stroke.is_closed, body.is_closed) == (False, True)
    assert (body.dxf.layer, body.dxf.color, body.dxf.linetype) == ("gr__er_als_3", 1, "DASHED_3_1_5")
    assert [v.dxf.bulge for v in body.vertices] == pytest.approx([0, 1, 0, 1])
    assert found.header["$EXTMIN"] == (-30, -10, 0)
    assert "LWPOLYLINE" not in made.data.decode("cp1252")
    (note,) = made.notes
    assert note.message == "the layer `größer als 3` is called `gr__er_als_3` in the DXF"
    assert note.hints == ("names in DXF R12 have 1 to 31 letters, digits, $, - and _",)


@pytest.mark.parametrize(("step", "count"), [(0.015, 9), (0.2, 10)])
def test_a_step_too_short_to_cut_is_closed_up(step: float, count: int) -> None:
    low, high = [(0, 0), (40, 0), (40, 10), (30, 10)], [(20, 20), (10, 20), (10, 30), (0, 30)]
    corners = [*low, (30, 10 + step), (20, 10 + step), *high]
    outline = f"polygon({', '.join(f'fixed({c})' for c in corners)})"
    (found,) = document_of(f"@detached solid s {{ o = {outline} }}").modelspace()
    points = found.get_points("xy")
    assert len(points) == count
    assert min(math.dist(a, b) for a, b in pairwise([*points, points[0]])) > 0.03

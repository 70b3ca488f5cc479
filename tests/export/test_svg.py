"""SVG documents: well-formed, named, cut, in millimetres."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from xml.etree import ElementTree

import pytest

from aidl_lang.common.source import SourceFile, Span
from aidl_lang.export import SHOW, Job, Options, export
from aidl_lang.export.svg import face_path, loop_path, open_path
from aidl_lang.geometry.curves import Bezier, Circle, Ellipse, Line
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.region import Face, Loop
from aidl_lang.geometry.solved import Box, ConstraintReport, Mobility, SolvedModel, SolvedStructure
from tests.geometry.models import arc, circle, model, primitive, rectangle, structure

SVG = "{http://www.w3.org/2000/svg}"


def written(root: SolvedStructure, *show: str) -> ElementTree.Element:
    return of_model(model(root), *show)


def of_model(m: SolvedModel, *show: str) -> ElementTree.Element:
    return ElementTree.fromstring(as_svg(m, *show))


def as_svg(m: SolvedModel, *show: str) -> str:
    return export(Job(m, draw(m)[0], options=Options(frozenset(show))), ".svg").data.decode()


def groups(svg: ElementTree.Element) -> dict[str, ElementTree.Element]:
    return {g.attrib["id"]: g for g in svg.iter(f"{SVG}g") if "id" in g.attrib}


def texts(svg: ElementTree.Element) -> list[str]:
    """Every text once, the halos below them aside."""
    return [t.text or "" for t in svg.iter(f"{SVG}text") if t.get("aria-hidden") is None]


PLATE = structure(
    "solid",
    "plate",
    rectangle("r", 0, 0, 100, 50),
    structure("hole", "bore", circle("c", 50, 25, 10)),
    layer=("cut",),
)
MARKS = structure("drawing", "marks", primitive("l", Line((0, 25), (100, 25))))
ROOT = structure("assembly", "part", PLATE, MARKS)


def test_groups_carry_paths_kinds_and_layers():
    found = groups(written(ROOT))
    assert list(found) == ["part", "part.plate", "part.plate.bore", "part.marks"]
    plate = found["part.plate"].attrib
    assert (plate["data-kind"], plate["data-path"], plate["data-layer"]) == ("solid", "part.plate", "cut")
    assert "data-layer" not in found["part.marks"].attrib


def test_millimetres_and_a_margin():
    svg = written(ROOT)
    assert svg.attrib["width"] == "106mm"
    assert svg.attrib["height"] == "56mm"
    assert svg.attrib["viewBox"] == "-3 -53 106 56"


def test_a_hole_is_cut_from_the_path():
    (path,) = groups(written(ROOT))["part.plate"]
    assert path.attrib["d"] == "M0 0L100 0L100 -50L0 -50ZM60 -25A10 10 0 0 1 40 -25A10 10 0 0 1 60 -25Z"
    assert path.attrib["fill-rule"] == "evenodd"


def test_drawings_lie_in_the_order_of_the_text():
    early = structure("drawing", "early", primitive("l", Line((-1, 0), (1, 0))))
    inside = structure("drawing", "inside", primitive("l", Line((1, 1), (9, 9))))
    late = structure("drawing", "late", primitive("l", Line((1, 9), (9, 1))))
    plate = structure("solid", "plate", rectangle("r", 0, 0, 10, 10), inside)
    svg = written(structure("assembly", "a", early, plate, late))
    assert list(groups(svg)) == ["a", "a.early", "a.plate", "a.plate.inside", "a.late"]


def test_drawings_are_stroked_on_what_holds_them():
    svg = written(ROOT)
    (path,) = list(svg.iter(f"{SVG}g"))[-1]
    assert (path.attrib["fill"], path.attrib["d"]) == ("none", "M0 -25L100 -25")


def test_colors():
    red = structure("assembly", "a", structure("solid", "s", circle("c", 0, 0, 1)), color=(255, 0, 0))
    (path,) = groups(written(red))["a.s"]
    assert path.attrib["fill"] == "#ff0000"


@pytest.mark.parametrize(("fill", "ink"), [("ivory", "#818179"), ("#102030", "#889098")])
def test_strokes_that_take_the_colour_of_what_they_lie_on_are_drawn_in_another(fill: str, ink: str):
    on = structure("drawing", "on", primitive("l", Line((1, 1), (9, 9))))
    beside = structure("drawing", "beside", primitive("l", Line((20, 0), (30, 0))))
    colored = structure("drawing", "colored", primitive("l", Line((1, 9), (9, 1))), color=("red",))
    found = groups(
        written(structure("solid", "s", rectangle("r", 0, 0, 10, 10), on, beside, colored, color=(fill,)))
    )
    strokes = [found[f"s.{name}"][0].attrib["stroke"] for name in ("on", "beside", "colored")]
    assert strokes == [ink, fill, "red"]


def test_what_lies_on_another_colour_keeps_its_own():
    mark = structure("drawing", "mark", primitive("l", Line((1, 1), (9, 9))))
    plate = structure("solid", "plate", rectangle("r", 0, 0, 10, 10), color=("gold",))
    (path,) = groups(written(structure("assembly", "a", plate, mark, color=("navy",))))["a.mark"]
    assert path.attrib["stroke"] == "navy"
    lid = structure("solid", "lid", rectangle("r", 0, 0, 10, 10), color=("gold",))
    late = structure("solid", "below", rectangle("r", 0, 0, 10, 10), mark, color=("navy",))
    (path,) = groups(written(structure("assembly", "a", late, lid)))["a.below.mark"]
    assert path.attrib["stroke"] == "#8080c0", "the lid is drawn over both"


def test_path_commands():
    assert loop_path(Loop((Circle((0, 0), 2),), reversed=True)) == "M2 0A2 2 0 0 1 -2 0A2 2 0 0 1 2 0Z"
    assert open_path([arc((0, 0), 2, 0, 90)]) == "M2 0A2 2 0 0 0 0 -2"
    assert open_path([arc((0, 0), 2, 90, -180)]) == "M0 -2A2 2 0 1 1 -2 0"
    assert open_path([Bezier((0, 0), (1, 2), (3, 4), (5, 6))]) == "M0 0C1 -2 3 -4 5 -6"
    half = math.radians(30)
    assert face_path(Face(Loop((Ellipse((0, 0), 2, 1, half),)))).startswith(
        "M1.732051 -1A2 1 -30 0 0 -1.732051 1"
    )
    assert (
        open_path([Line((0, 0), (1, 0)), Line((1, 0), (1, 1)), Line((5, 5), (6, 6))])
        == "M0 0L1 0L1 -1M5 -5L6 -6"
    )


@pytest.mark.parametrize("off", [-1e-9, -1e-13, 0.0, 1e-13, 1e-9])
def test_a_half_circle_has_one_flag_however_its_last_digits_come_out(off: float) -> None:
    assert open_path([arc((0, 0), 2, 0, 180 + off)]) == "M2 0A2 2 0 0 0 -2 0"
    assert open_path([arc((0, 0), 2, 0, 180.001)]).startswith("M2 0A2 2 0 1 0 -2 ")


def test_plans_are_drawn_when_asked_for():
    plan = structure("assembly", "house", structure("solid", "kitchen", box=Box(0, 0, 40, 30)))
    assert texts(written(plan)) == []
    svg = written(plan, "plan")
    assert texts(svg) == ["kitchen"]
    assert len(list(svg.iter(f"{SVG}rect"))) == 1


def explained() -> SolvedModel:
    span = Span(SourceFile("x", "\n"), 0, 0)
    constraints = (
        ConstraintReport(
            "part", "plate.left >= 0 & 1 < 2", span, 0.0, True, lambda: ("part.plate.r.edges[0].start",)
        ),
        ConstraintReport("part", "bore is far away " * 9, span, 3.25, False, lambda: ("part.plate.bore.c",)),
    )
    mobility = Mobility(2, ("part.plate.bore.c.center.x", "part.marks.l.start.x"))
    return replace(model(ROOT), constraints=constraints, mobility=lambda: mobility)


def test_all_layers():
    svg = of_model(explained(), *SHOW)
    assert [g for g in groups(svg) if g.startswith("show-")] == [
        "show-plan", "show-bbox", "show-points", "show-names", "show-constraints", "show-dof",
    ]  # fmt: skip
    found = texts(svg)
    assert {"plate", "bore", "marks", "c.center", "l.start", "1", "2", "2 degrees of freedom"} <= set(found)
    assert "1  plate.left >= 0 & 1 < 2" in found
    assert any(t.endswith("off by 3.25") for t in found)


def test_everything_is_in_sight():
    svg = of_model(explained(), *SHOW)
    left, top, width, height = map(float, svg.attrib["viewBox"].split())
    for text in svg.iter(f"{SVG}text"):
        assert left <= float(text.attrib["x"]) <= left + width
        assert top <= float(text.attrib["y"]) <= top + height


def test_hostile_names_are_escaped():
    name = "a<b>&\"'\x00\x1b]]>"
    hostile = structure("solid", name, circle("<script>", 0, 0, 1), layer=("\x07<x>",))
    svg = written(hostile, *SHOW)
    assert next(iter(groups(svg))) == name.replace("\x00", "\ufffd").replace("\x1b", "\ufffd")
    assert "<script>.center" in texts(svg)


@pytest.mark.parametrize("show", [(), SHOW])
def test_an_empty_model_is_still_a_picture(show: tuple[str, ...]):
    assert written(structure("assembly", "nothing"), *show).tag == f"{SVG}svg"


def test_numbers_are_short_and_never_minus_zero():
    m = model(structure("solid", "s", circle("c", 0, 0, 1 / 3)))
    text = as_svg(m)
    assert not re.search(r"-0[ \"A-Z]", text)
    assert not re.search(r"\.\d{7}", text)

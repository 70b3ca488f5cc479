"""SVG documents: well-formed, named, cut, in millimetres."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import pytest

from aidl_lang.export import export
from aidl_lang.export.job import SHOW, Job, Options
from aidl_lang.geometry.curves import Line
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.solved import Box, SolvedModel, SolvedStructure
from tests.geometry.models import circle, model, primitive, rectangle, structure

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


def test_drawings_are_stroked_on_what_holds_them():
    svg = written(ROOT)
    (path,) = list(svg.iter(f"{SVG}g"))[-1]
    assert (path.attrib["fill"], path.attrib["d"]) == ("none", "M0 -25L100 -25")


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


def test_plans_are_drawn_when_asked_for():
    plan = structure("assembly", "house", structure("solid", "kitchen", box=Box(0, 0, 40, 30)))
    assert texts(written(plan)) == []
    svg = written(plan, "plan")
    assert texts(svg) == ["kitchen"]
    assert len(list(svg.iter(f"{SVG}rect"))) == 1


def test_hostile_names_are_escaped():
    name = "a<b>&\"'\x00\x1b]]>"
    hostile = structure("solid", name, circle("<script>", 0, 0, 1), layer=("\x07<x>",))
    svg = written(hostile, *SHOW)
    assert next(iter(groups(svg))) == name.replace("\x00", "\ufffd").replace("\x1b", "\ufffd")
    assert "<script>.center" in texts(svg)


def test_numbers_are_short_and_never_minus_zero():
    m = model(structure("solid", "s", circle("c", 0, 0, 1 / 3)))
    text = as_svg(m)
    assert not re.search(r"-0[ \"A-Z]", text)
    assert not re.search(r"\.\d{7}", text)

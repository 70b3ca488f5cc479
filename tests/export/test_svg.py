"""SVG documents: well-formed, named, cut, in millimetres, in each theme."""

from __future__ import annotations

import re
import subprocess
import sys
from xml.etree import ElementTree

import pytest

from aidl_lang.export.job import SHOW
from aidl_lang.export.marks import REDUCED, THEMES
from aidl_lang.geometry.curves import Line
from aidl_lang.geometry.solved import Box, SolvedStructure
from tests.export.making import written
from tests.geometry.models import circle, primitive, rectangle, structure

SVG = "{http://www.w3.org/2000/svg}"


def read(root: SolvedStructure, *show: str) -> ElementTree.Element:
    return ElementTree.fromstring(written(root, ".svg", show=frozenset(show)).data)


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
    found = groups(read(ROOT))
    assert list(found) == ["part", "part.plate", "part.plate.bore", "part.marks"]
    plate = found["part.plate"].attrib
    assert (plate["data-kind"], plate["data-path"], plate["data-layer"]) == ("solid", "part.plate", "cut")
    assert "data-layer" not in found["part.marks"].attrib


@pytest.mark.parametrize(("fill", "ink"), [("ivory", "#818179"), ("#102030", "#889098")])
def test_strokes_that_take_the_colour_of_what_they_lie_on_are_drawn_in_another(fill: str, ink: str):
    on = structure("drawing", "on", primitive("l", Line((1, 1), (9, 9))))
    beside = structure("drawing", "beside", primitive("l", Line((20, 0), (30, 0))))
    colored = structure("drawing", "colored", primitive("l", Line((1, 9), (9, 1))), color=("red",))
    found = groups(
        read(structure("solid", "s", rectangle("r", 0, 0, 10, 10), on, beside, colored, color=(fill,)))
    )
    strokes = [found[f"s.{name}"][0].attrib["stroke"] for name in ("on", "beside", "colored")]
    assert strokes == [ink, fill, "red"]


def test_what_lies_on_another_colour_keeps_its_own():
    mark = structure("drawing", "mark", primitive("l", Line((1, 1), (9, 9))))
    plate = structure("solid", "plate", rectangle("r", 0, 0, 10, 10), color=("gold",))
    (path,) = groups(read(structure("assembly", "a", plate, mark, color=("navy",))))["a.mark"]
    assert path.attrib["stroke"] == "navy"
    lid = structure("solid", "lid", rectangle("r", 0, 0, 10, 10), color=("gold",))
    late = structure("solid", "below", rectangle("r", 0, 0, 10, 10), mark, color=("navy",))
    (path,) = groups(read(structure("assembly", "a", late, lid)))["a.below.mark"]
    assert path.attrib["stroke"] == "#8080c0", "the lid is drawn over both"


def test_plans_are_drawn_when_asked_for():
    plan = structure("assembly", "house", structure("solid", "kitchen", box=Box(0, 0, 40, 30)))
    assert texts(read(plan)) == []
    svg = read(plan, "plan")
    assert texts(svg) == ["kitchen"]
    assert len(list(svg.iter(f"{SVG}rect"))) == 1


def test_hostile_names_are_escaped():
    name = "a<b>&\"'\x00\x1b]]>"
    hostile = structure("solid", name, circle("<script>", 0, 0, 1), layer=("\x07<x>",))
    svg = read(hostile, *SHOW)
    assert next(iter(groups(svg))) == name.replace("\x00", "\ufffd").replace("\x1b", "\ufffd")
    assert "<script>.center" in texts(svg)


def test_numbers_are_short_and_never_minus_zero():
    text = written(structure("solid", "s", circle("c", 0, 0, 1 / 3)), ".svg").data.decode()
    assert not re.search(r"-0[ \"A-Z]", text)
    assert not re.search(r"\.\d{7}", text)


# --- Themes ----------------------------------------------------------------------------------------

PROGRAM = """
assembly lamp {
    @color("gold") solid shade { cone = trapezoid(bottom_width: 40, top_width: 20, height: 20) }
    solid foot { plate = rectangle(center: (0, -14), width: 30, height: 8) }
    @color("crimson") drawing mark { cut = line((0, 0), (5, 0)) }
    constrain foot.below(shade, gap: 0)
}
"""


def svg(text: str = PROGRAM, **options: object) -> str:
    return written(text, ".svg", **options).data.decode()


def colours(text: str) -> set[str]:
    return set(re.findall(r'(?:fill|stroke)="(#\w+|[a-z]+)"', text)) - {"none"}


@pytest.mark.parametrize("name", REDUCED)
def test_dimensions_and_names_are_in_the_theme(name: str) -> None:
    theme = REDUCED[name]
    shown = svg(theme=name, dimension=True, show=frozenset({"names", "points", "bbox"}))
    assert colours(shown) <= {theme.paper, theme.fill, theme.line, "#ffffff"}  # dots have a white rim


@pytest.mark.parametrize("name", REDUCED)
def test_light_and_shade_leave_no_veil_over_the_lines_below(name: str) -> None:
    """What shows through has no fill where all fills are of one colour; its outline stays."""
    program = """
    assembly jar {
        solid body { wall = rectangle(center: fixed((0, 0)), width: 40, height: 30) }
        @opacity(0.4) solid glass { pane = rectangle(center: fixed((0, 0)), width: 20, height: 10) }
        @stroke(none) @opacity(0.3) @color("black")
        solid shade { dark = rectangle(center: fixed((10, 0)), width: 20, height: 30) }
    }
    """
    reduced, coloured = (svg(program, theme=theme) for theme in (name, "colour"))
    assert reduced.count("<path") == coloured.count("<path")  # one less, and the paper
    assert "fill-opacity" in coloured
    assert "fill-opacity" not in reduced


@pytest.mark.parametrize("name", REDUCED)
def test_what_is_shaded_hides_what_is_below_it(name: str) -> None:
    """Shade is left out, and the fill under it stays: else the lines below would show through a tank."""
    tank = "drawing d {{ {} solid tank {{ r = rectangle(center: fixed((0, 0)), width: 20, height: 30) }} }}"
    shown = [svg(tank.format(shade), theme=name) for shade in ("", "@shade(round)", '@shade("navy")')]
    assert shown[0] == shown[1] == shown[2]
    assert f'fill="{REDUCED[name].fill}" fill-rule="evenodd" stroke="{REDUCED[name].line}"' in shown[0]


@pytest.mark.parametrize("suffix", [".png", ".pdf"])
def test_every_picture_has_every_theme(suffix: str) -> None:
    made = {written(PROGRAM, suffix, theme=name, pixels=100).data for name in THEMES}
    assert len(made) == len(THEMES)


# --- What is loaded later of the package that writes SVG is the real thing once it is asked for ------

SCRIPT = """
import sys
from aidl_lang.export.svg import _loaded_later, svgwrite

svg = svgwrite()
assert svg is sys.modules["svgwrite"] is svgwrite()
assert not {"urllib.request", "svgwrite.data.svgparser", "ssl"} & set(sys.modules)

checker = svg.drawing.SVG(debug=True).validator.typechecker  # it asks the real parser
assert checker.check("path-data", "M 0 0 L 1 1")
assert not checker.check("path-data", "no path")
assert "svgwrite.data.svgparser" in sys.modules

with _loaded_later("urllib.request", "urlopen"):
    from urllib.request import Request, urlopen  # as another thread does meanwhile
assert sys.modules["urllib.request"].Request is Request
assert Request("http://localhost").host == "localhost"
for opens in (svg.container.urlopen, urlopen):
    try:
        opens("none:")
    except OSError as reason:
        assert "none" in str(reason)
    else:
        raise AssertionError("an address that is none was opened")
"""


def test_what_is_loaded_later_is_the_real_thing() -> None:
    subprocess.run([sys.executable, "-c", SCRIPT], check=True, timeout=60)

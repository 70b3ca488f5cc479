"""Every drawn element and where it is written: checked against the model, the regions and the text itself."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import pytest
from lxml import etree
from shapely.geometry import Polygon
from svgelements import Path as SvgPath

from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure
from aidl_lang.tools.ide.preview import LAYERS, Writer, elements_at, preview, svg_of
from aidl_lang.tools.ide.preview.elements import elements
from aidl_lang.tools.ide.workspace import View, Workspace, look, run
from tests.compiled import LIGHTER
from tests.preview.views import view_of

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module", params=LIGHTER)
def example(request: pytest.FixtureRequest) -> View:
    path: Path = request.param
    return run(look(path, path.read_text("utf-8"), Workspace([path.parent]).world(path)))


def svg(view: View, show: tuple[str, ...] = ()) -> etree._Element:
    assert view.drawn is not None
    return etree.fromstring(svg_of(view.drawn, elements(view), show).encode())


def shapes(root: etree._Element, number: int, kind: str) -> list[SvgPath]:
    found = root.iterfind(f".//{SVG}path[@data-element='{number}']")
    return [SvgPath(path.get("d")) for path in found if path.get("class") == kind]


def all_in(structure: SolvedStructure) -> list[SolvedStructure | SolvedGeometry]:
    """Structures and their named geometry."""
    below = [each for child in structure.structures for each in all_in(child)]
    return [structure, *structure.drawn, *below]


def polygon_area(path: SvgPath) -> float:
    """By the even-odd rule, of polygons with many corners."""
    total = Polygon()
    for part in path.as_subpaths():
        points = [SvgPath(part).point(k / 2000, error=1e-4) for k in range(2000)]
        ring = Polygon([(p.x, p.y) for p in points]).buffer(0)
        total = total.symmetric_difference(ring)
    return float(total.area)


def test_all_of_a_model_is_an_element(example: View) -> None:
    assert example.outcome is not None
    assert example.outcome.model is not None
    of_path = {element.path: element for element in elements(example).values}
    for thing in all_in(example.outcome.model.root):
        element = of_path[thing.path]
        is_structure = isinstance(thing, SolvedStructure)
        assert element.kind == ("structure" if is_structure else "geometry")
        assert element.type == (thing.kind if is_structure else thing.type)


def test_elements_are_written_where_they_say(example: View) -> None:
    """The text at the place of an element begins with its kind and name, or is a call that makes it."""
    of_path = {element.path: element for element in elements(example).values}
    for path, element in of_path.items():
        span = element.span
        assert span is not None
        assert span.source is example.source
        name = re.sub(r"\[.*", "", path.rpartition(".")[2])
        around = of_path.get(path.rpartition(".")[0])
        is_in_another = around is not None and around.span is not None and around.span == span
        head = re.match(r"(@\w+(\([^)]*\))?\s*)*(construction\s+)?(\w+\s+)?(\w+)", span.text)
        assert head is not None
        assert is_in_another or name == head[5] or "=" not in span.text.partition("(")[0], (path, span.text)


def test_the_text_of_an_element_leads_to_it(example: View) -> None:
    values = elements(example).values
    for start in sorted({e.span.start for e in values if e.span is not None})[:12]:
        here = [e.span for e in values if e.span is not None and e.span.start == start]
        smallest = min(here, key=lambda span: span.end)
        assert {values[k].span for k in elements_at(example, start)} == {smallest}


def test_every_element_that_is_drawn_can_be_pointed_at(example: View) -> None:
    root, found = svg(example), elements(example)
    carried = {int(node.get("data-element")) for node in root.iterfind(".//*[@data-element]")}
    assert carried <= set(range(len(found.values)))
    inside = {
        k: [j for j, other in enumerate(found.values) if other.path.startswith(f"{element.path}.")]
        for k, element in enumerate(found.values)
    }
    for number in range(len(found.values)):
        assert carried & {number, *inside[number]}


def test_shapes_lie_where_the_model_has_them(example: View) -> None:
    root = svg(example)
    for number, drawn in enumerate(elements(example).drawn):
        curves = list(drawn.model.curves()) if isinstance(drawn.model, SolvedGeometry) else []
        paths = shapes(root, number, "hit")
        if not curves or not paths:
            continue
        boxes = [SvgPath(path).bbox() for path in paths]
        sampled = [p for curve in curves for p in ends_and_middles(curve)]
        left, low, right, high = boxes[0]
        for x, y in sampled:
            assert left - 1e-4 <= x <= right + 1e-4
            assert low - 1e-4 <= -y <= high + 1e-4


def ends_and_middles(curve: object) -> list[tuple[float, float]]:
    """Points of a curve by its own numbers."""
    center, radius = getattr(curve, "center", None), getattr(curve, "radius", None)
    if center is not None and radius is not None and not hasattr(curve, "start"):
        return [(center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)) for a in range(6)]
    return [getattr(curve, end) for end in ("start", "end", "p0", "p3") if hasattr(curve, end)]


def test_areas_are_those_of_the_regions() -> None:
    view = view_of(
        """
        assembly a {
            solid plate {
                body = rectangle(center: (0, 0), width: 60, height: 40)
                solid lug { rim = circle(center: (30, 0), radius: 12) }
                hole eye { rim = circle(center: (30, 0), radius: 5) }
            }
            solid far { rim = ellipse(center: (100, 0), rx: 8, ry: 4) }
        }
        """
    )
    root = svg(view)
    number = elements(view).number
    assert view.drawn is not None
    assert view.drawn.drawing is not None
    measured = {path: m.area for path, m in view.drawn.drawing.measures.items()}
    expected = {
        "a.plate.lug": math.pi * 144,
        "a.plate.eye": math.pi * 25,
        "a.far": math.pi * 32,
        "a.plate": measured["a.plate"],
    }
    for path, area in expected.items():
        (shape,) = shapes(root, number[path], "hit area")
        assert polygon_area(shape) == pytest.approx(area, rel=2e-3)


def test_what_lies_on_top_comes_later() -> None:
    view = view_of(
        """
        assembly a {
            solid under { body = rectangle(center: (0, 0), width: 60, height: 40)
                          hole eye { rim = circle(center: (0, 0), radius: 5) } }
            solid over { body = rectangle(center: (0, 0), width: 20, height: 20) }
        }
        """
    )
    order = [int(node.get("data-element")) for node in svg(view).iterfind(f".//{SVG}path[@data-element]")]
    places = {e.path: order.index(k) for k, e in enumerate(elements(view).values) if k in order}
    assert places["a.under"] < places["a.under.eye"] < places["a.under.body.left"] < places["a.over"]


@pytest.mark.parametrize("layer", LAYERS)
def test_layers_are_drawn(layer: str) -> None:
    view = view_of("solid a { body = rectangle(width: 20, height: 10) }\nsolid b { p = point((3, 4)) }")
    assert len(list(svg(view, (layer,)).iter())) >= len(list(svg(view).iter()))
    assert preview(view, ["no such layer", layer]).svg == preview(view, [layer]).svg


def test_library_parts_lead_to_the_call() -> None:
    view = view_of('solid s { body = rectangle(width: 90, height: 90)\n mount = motor_mount("nema17") }')
    for element in elements(view).values:
        assert element.span is not None
        if element.path.startswith("s.mount"):
            assert element.span.text == 'mount = motor_mount("nema17")'


def test_elements_of_an_imported_file_are_there() -> None:
    other = "solid bolt(d = 5mm) { solid head { rim = circle(diameter: 2 * d) } }"
    view = view_of(
        'import bolt from "other.aidl"\nassembly a { b = bolt(d: 6mm) }', files={"other.aidl": other}
    )
    made = Writer(view).preview(preview(view), 1)
    uris = {e["path"]: e["uri"] for e in made["elements"]}
    assert uris["a"] == "file:///project/part.aidl"
    (inner,) = [path for path in uris if path.endswith("rim")]
    assert uris[inner] == "file:///project/other.aidl"


ASTRAL = (
    "/* 🅰 😀 */ solid a {\r\n\t/* 🚀🚀 */ body = circle(radius: 5) // é\r\n"
    '\t@note("😀") hole b { rim = circle(radius: 2) } }\r\n'
)


def test_ranges_count_utf_16() -> None:
    view = view_of(ASTRAL)
    made = Writer(view).preview(preview(view), 7)
    lines = [line.encode("utf-16-le") for line in re.split("\r\n|\n|\r", ASTRAL)]
    for element, data in zip(elements(view).values, made["elements"], strict=True):
        assert element.span is not None
        start, end = data["range"]["start"], data["range"]["end"]
        rows = lines[start["line"] : end["line"] + 1]
        rows[-1] = rows[-1][: 2 * end["character"]]
        rows[0] = rows[0][2 * start["character"] :]
        assert "\r\n".join(row.decode("utf-16-le") for row in rows) == element.span.text
    assert json.loads(json.dumps(made, allow_nan=False))["version"] == 7


def test_a_broken_text_shows_the_last_picture() -> None:
    text = "solid a {\n    body = circle(radius: 5)\n    rim = circle(center: (2, 0), radius: 4)\n}\n"
    good = view_of(text)
    broken = text.replace("radius: 5", "radius: 5 +")
    view = view_of(broken, good)
    made = preview(view)
    assert (made.stale, made.svg, made.motions, made.handles) == (True, preview(good).svg, (), ())
    assert {p.severity for p in made.problems} >= {"error"}
    spans = {e.path: e.span for e in made.elements}
    rim = spans["a.rim"]
    assert rim is not None
    assert rim.source is view.source
    assert rim.text == "rim = circle(center: (2, 0), radius: 4)"
    assert spans["a.body"] is not None
    assert spans["a.body"].text == "body = circle(radius: 5 +)"
    assert preview(view_of(text, view)).stale is False


@pytest.mark.parametrize("text", ["", "\ufeff", "solid", "solid a { body = circle(radius: ", "\0", "🅰" * 50])
def test_what_never_drew_has_no_picture(text: str) -> None:
    made = preview(view_of(text))
    assert (made.svg, made.stale) == (None, False)
    assert made.problems or not text.strip("\ufeff")


def test_hostile_texts_stay_texts() -> None:
    evil = "<script>alert(1)</script>\"'&]]>"
    quoted = evil.replace("\\", "\\\\").replace('"', '\\"')
    view = view_of(
        f'solid a {{ param label = "{quoted}"\n @note("{quoted}") @layer("{quoted}") solid b {{'
        f' body = circle(radius: 5) }}\n drawing d {{ t = text("<b>", height: 5) }} }}'
    )
    root = svg(view, LAYERS)
    assert {node.tag.removeprefix(SVG) for node in root.iter()} <= {
        *("svg", "defs", "g", "path", "text", "rect", "circle", "clipPath", "line", "tspan")
    }
    assert [k.value for k in preview(view).knobs] == [evil]


def test_a_program_that_solves_and_fails_an_assertion_is_wrong() -> None:
    text = "solid s {{ r = rectangle(width: 30, height: 20) assert r.width > {} }}"
    assert [preview(view_of(text.format(width))).status for width in (20, 40)] == ["solved", "wrong"]

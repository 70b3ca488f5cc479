"""Every drawn element and where it is written: checked against the model, the regions and the text itself."""

from __future__ import annotations

import math
import re

import pytest
from lxml import etree
from shapely.geometry import Polygon
from svgelements import Path as SvgPath

from aidl_server.ide.preview import LAYERS, preview, svg_of
from aidl_server.ide.preview.elements import elements
from aidl_server.ide.workspace import View, look, run
from server.tests.ide.conftest import seen, solved_at
from tests.amount import some
from tests.compiled import LIGHTER

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module", params=some(LIGHTER, 8))
def example(request: pytest.FixtureRequest) -> View:
    return solved_at(request.param)


def svg(view: View, show: tuple[str, ...] = ()) -> etree._Element:
    assert view.drawn is not None
    return etree.fromstring(svg_of(view.drawn, elements(view), show).encode())


def shapes(root: etree._Element, number: int, kind: str) -> list[SvgPath]:
    found = root.iterfind(f".//{SVG}path[@data-element='{number}']")
    return [SvgPath(path.get("d")) for path in found if path.get("class") == kind]


def polygon_area(path: SvgPath) -> float:
    """By the even-odd rule, of polygons with many corners."""
    total = Polygon()
    for part in path.as_subpaths():
        points = [SvgPath(part).point(k / 300, error=1e-4) for k in range(300)]
        ring = Polygon([(p.x, p.y) for p in points]).buffer(0)
        total = total.symmetric_difference(ring)
    return float(total.area)


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


def test_areas_are_those_of_the_regions() -> None:
    view = seen(
        """
        assembly a {
            solid plate {
                body = rectangle(center: (0, 0), width: 60, height: 40)
                solid lug { rim = circle(center: (30, 0), radius: 12) }
                hole eye { rim = circle(center: (30, 0), radius: 5) }
            }
            solid far { rim = ellipse(center: (100, 0), rx: 8, ry: 4) }
        }
        """,
        solved=True,
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


def test_library_parts_lead_to_the_call() -> None:
    view = seen(
        'solid s { body = rectangle(width: 90, height: 90)\n mount = motor_mount("nema17") }', solved=True
    )
    for element in elements(view).values:
        assert element.span is not None
        if element.path.startswith("s.mount"):
            assert element.span.text == 'mount = motor_mount("nema17")'


def test_a_broken_text_shows_the_last_picture() -> None:
    text = "solid a {\n    body = circle(radius: 5)\n    rim = circle(center: (2, 0), radius: 4)\n}\n"
    good = seen(text, solved=True)
    broken = text.replace("radius: 5", "radius: 5 +")
    view = run(look(good.path, broken, good.world), good)
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
    assert preview(good).stale is False
    assert preview(seen(text.replace("}", "assert body.radius < 3 }"), solved=True)).status == "wrong"


def test_hostile_texts_stay_texts() -> None:
    evil = "<script>alert(1)</script>\"'&]]>"
    quoted = evil.replace("\\", "\\\\").replace('"', '\\"')
    view = seen(
        f'solid a {{ param label = "{quoted}"\n @note("{quoted}") @layer("{quoted}") solid b {{'
        f' body = circle(radius: 5) }}\n drawing d {{ t = text("<b>", height: 5) }} }}',
        solved=True,
    )
    root = svg(view, LAYERS)
    assert {node.tag.removeprefix(SVG) for node in root.iter()} <= {
        *("svg", "defs", "g", "path", "text", "rect", "circle", "clipPath", "line", "tspan")
    }
    assert [k.value for k in preview(view).knobs] == [evil]

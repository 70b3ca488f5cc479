"""The preview pane in Chromium: drawings and texts that mean harm, and drawings to keep whole."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from PIL.ImageColor import getrgb
from playwright.sync_api import expect

from aidl_lang.common.colors import COLOR_NAMES
from aidl_lang.common.source import SourceFile
from aidl_lang.export.job import Options
from aidl_lang.pipeline import compile
from server.tests.preview.pane.conftest import Pane
from server.tests.preview.pane.messages import SVG, URI, element, handle, knob, place, problem
from server.tests.preview.pane.scripted import ScriptedHost
from tests.compiled import FEW

EVIL = "window.harmed = true; fetch('/harm')"
HTML = "http://www.w3.org/1999/xhtml"

IMAGE = f'<image href="/harm" width="9" height="9" onerror="{EVIL}" onload="{EVIL}"/>'
PICTURE = (
    f'<foreignObject width="9" height="9"><img xmlns="{HTML}" src="/harm" onerror="{EVIL}"/></foreignObject>'
)
SHAPE = 'd="M0 0L9 9"'
LINK = "http://www.w3.org/1999/xlink"

HOSTILE = (
    f"<script>{EVIL}</script>",
    f'<s:script xmlns:s="http://www.w3.org/2000/svg">{EVIL}</s:script>',
    f'<script xmlns="{HTML}">{EVIL}</script>',
    f'<g onload="{EVIL}"><path {SHAPE} onload="{EVIL}" onmouseover="{EVIL}" onfocus="{EVIL}"/></g>',
    IMAGE,
    f'<image xmlns:xlink="{LINK}" xlink:href="/harm" width="9" height="9"/>',
    PICTURE,
    f'<foreignObject><iframe xmlns="{HTML}" src="/harm" srcdoc="&lt;b&gt;"/></foreignObject>',
    f'<a href="javascript:{EVIL}"><path d="M-50 30L50 30L50 -30L-50 -30Z" fill="red"/></a>',
    '<use href="/harm#a"/><use href="data:image/svg+xml,x#a"/>',
    f'<path {SHAPE}><set attributeName="onload" to="{EVIL}"/><animate/></path>',
    "<style>@import '/harm'; body { display: none } * { background: url(/harm) }</style>",
    f'<path {SHAPE} style="fill: url(/harm); background: url(/harm)"/>',
    f'<path {SHAPE} fill="url(/harm#a)" stroke="url(&quot;/harm&quot;)"/>',
    f'<path {SHAPE} fill="u\\72l(/harm)" stroke="URL(/harm)" clip-path="url(/harm)"/>',
    f'<filter id="f"><feImage href="/harm"/></filter><path filter="url(#f)" {SHAPE}/>',
    "<?xml-stylesheet href='/harm' type='text/css'?>",
    f'<path {SHAPE} ONLOAD="{EVIL}" onClick="{EVIL}"/>',
    f'<embed xmlns="{HTML}" src="/harm"/><object xmlns="{HTML}" data="/harm"/>',
)
FORBIDDEN = r"on|href|style|script|image|foreign|a$|use$|animate|set$|filter|mask|xlink|iframe|embed|object"


def test_a_hostile_drawing_does_nothing(open_pane) -> None:
    """Without a Content-Security-Policy, so that nothing but the pane itself stands in the way."""
    with ScriptedHost(csp="") as host:
        pane = open_pane(host)
        for content in ("".join(HOSTILE), "&harm;"):  # the last is no XML at all
            pane.shows(svg=SVG.replace("</svg>", f"{content}</svg>"))
            pane.move(0, 0)
            pane.page.mouse.click(*pane.at(0, -20))
            pane.page.wait_for_timeout(100)
            assert pane.page.evaluate("() => window.harmed") is None
            assert "/harm" not in host.requests
            assert pane.page.url == host.url
            nodes = pane.page.eval_on_selector_all(
                "#world *",
                """all => all.flatMap(one =>
                    [one.localName, ...[...one.attributes].map(a => `${a.name}=${a.value}`)])""",
            )
            assert "path" in nodes or content == "&harm;"
            assert not [node for node in nodes if re.match(FORBIDDEN, node) or "harm" in node]
        pane.page.evaluate(  # elsewhere the same does harm: the test can fail
            """text => document.body.append(document.importNode(
                new DOMParser().parseFromString(text, "image/svg+xml").documentElement, true))""",
            SVG.replace("</svg>", f"{IMAGE}{PICTURE}</svg>"),
        )
        pane.page.wait_for_function("() => window.harmed")
        assert "/harm" in host.requests


def test_what_is_no_drawing_is_said(still: Pane) -> None:
    for text in ("", "no XML", "<svg>", f"<html xmlns='{HTML}'/>", "<svg/>"):
        still.shows(svg=text)
        expect(still.find(".toast")).to_contain_text("not an SVG document")
        expect(still.find("#empty")).to_be_visible()
        still.find(".toast button").click()
        still.shows()
        expect(still.find("#empty")).to_be_hidden()
    still.complaints.clear()  # Chromium styles its own report of broken XML, and the policy stops that


def test_names_in_a_drawing_are_not_those_of_the_page(still: Pane) -> None:
    clip = '<clipPath id="stage"><rect x="0" y="-30" width="50" height="60"/></clipPath>'
    group = '<g id="status" clip-path="url(#stage)"><rect id="world" width="9" height="9"/></g>'
    still.shows(svg=SVG.replace("</svg>", f"<defs>{clip}</defs>{group}</svg>"))
    for name in ("stage", "status", "world"):
        expect(still.find(f"[id={name}]")).to_have_count(1)
    target = still.page.eval_on_selector(
        "#world [clip-path]", "one => one.getAttribute('clip-path').slice(5, -1)"
    )
    assert still.find(f"clipPath#{target} rect").count() == 1


def test_gradients_of_the_drawing_are_shown_and_none_from_elsewhere(still: Pane) -> None:
    stops = '<stop offset="0" stop-color="#ff0000"/><stop offset="1" stop-color="#0000ff"/>'
    shade = (
        f'<linearGradient id="shade-1" gradientUnits="userSpaceOnUse" x1="0" x2="50">{stops}</linearGradient>'
    )
    shown = '<path fill="url(#shade-1)" d="M0 0h9v9z"/><path fill="url(/harm#a)" d="M0 0h9v9z"/>'
    still.shows(svg=SVG.replace("</svg>", f"<defs>{shade}</defs>{shown}</svg>"))
    target = still.page.eval_on_selector(
        ".drawing [fill^=url]", "one => one.getAttribute('fill').slice(5, -1)"
    )
    assert still.find(f"linearGradient#{target} stop").count() == 2
    assert still.find(".drawing [fill^=url]").count() == 1


@pytest.mark.parametrize("example", FEW)
def test_nothing_of_a_drawing_is_lost(still: Pane, example: Path) -> None:
    compiled = compile(SourceFile(example.name, example.read_text("utf-8")))
    layers = frozenset({"names", "points", "bbox", "constraints", "dof", "plan"})
    svg = compiled.export(".svg", Options(layers)).decode()
    still.shows(svg=svg, uri=f"{URI}/{example.name}")
    for shape in ("path", "circle", "rect", "clipPath"):
        expect(still.find(f".drawing {shape}")).to_have_count(len(re.findall(rf"<{shape}\b", svg)))
    words = re.findall(r"<text[^>]*>([^<]*)</text>", svg)
    assert len(words) == still.find(".drawing text").count() > 0
    fills = {fill.replace("url(#", "url(#drawing-") for fill in re.findall(r'fill="([^"]*)"', svg)}
    assert fills == set(
        still.page.eval_on_selector_all(".drawing [fill]", "all => all.map(one => one.getAttribute('fill'))")
    )


def test_every_colour_of_css_is_drawn(still: Pane) -> None:
    names = sorted(COLOR_NAMES)
    assert len(names) == 148
    text = "".join(
        f'@detached @color("{name}") solid s{k} {{ c = circle(center: fixed(({3 * k}, 0)), radius: 1) }}\n'
        for k, name in enumerate(names)
    )
    still.shows(svg=compile(SourceFile("colours", text)).export(".svg").decode())
    fills = still.page.eval_on_selector_all(
        ".drawing path, .drawing circle",
        "all => all.map(one => getComputedStyle(one).fill).filter(fill => fill !== 'none')",
    )
    assert fills == [f"rgb({', '.join(map(str, getrgb(name)))})" for name in names]


def test_hostile_texts_are_shown_as_text(pane: Pane) -> None:
    evil = '<img src=/harm onerror="window.harmed=true"><script>window.harmed=true</script>`<b>`&amp;'
    seen = evil.replace("`", "")
    pane.shows(
        uri=f"file:///a/{evil}",
        elements=[element(f"part.{evil}", "structure", evil, None, evil)] * 5,
        knobs=[
            knob(path=f"{evil}.{evil}", name=evil, doc=evil),
            knob(path="c", name="c", kind="choice", value=evil, choices=[evil], doc=""),
            knob(path="t", name="t", kind="text", value=evil, doc=""),
        ],
        handles=[handle(hint=evil)],
        problems=[problem(message=evil, hints=[evil], code=evil, fixes=1, titles=[evil], points=[[0, 0]])],
        conflicts=[
            {
                "headline": evil,
                "constraints": [
                    {"text": evil, "range": place(1, 0, 1), "uri": evil, "elements": [], "off": 1}
                ],
            }
        ],
        motions=[{"words": evil, "elements": [0], "arrows": [{"from": [0, 0], "to": [9, 0]}], "turns": []}],
        status=evil,
    )
    pane.writes(text=f"{evil}\n", version=2, undo=evil)
    pane.page.get_by_role("button", name="Freedom").click()
    pane.move(-40, 10)
    pane.host.fail(evil)
    expect(pane.find(".toast")).to_contain_text(seen)
    for where, text in (
        ("tooltip", evil),
        ("problems-list", seen),
        ("knobs-list", seen),
        ("freedom-list", evil),
    ):
        expect(pane.find(f"#{where}")).to_contain_text(text)
    expect(pane.find(".cm-line").first).to_have_text(evil)
    assert pane.page.evaluate("() => window.harmed") is None
    assert pane.find("img:not(.cm-widgetBuffer), b, script:not([src])").count() == 0
    assert "/harm" not in pane.host.requests

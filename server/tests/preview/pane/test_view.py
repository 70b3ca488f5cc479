"""The preview pane in Chromium: the view, what is pointed at, and what is said."""

from __future__ import annotations

import json
import re

import pytest
from playwright.sync_api import expect

from server.tests.preview.pane.conftest import Pane, drawn
from server.tests.preview.pane.messages import BORE, OUTLINE, PLATE, RIM, SVG, URI, place, problem, where


def stage(pane: Pane) -> tuple[float, float, float, float]:
    box = pane.find("#stage").bounding_box()
    assert box is not None
    return box["x"], box["y"], box["width"], box["height"]


def close(found: tuple[float, float], expected: tuple[float, float]) -> bool:
    return found == pytest.approx(expected, abs=0.05)


@pytest.fixture
def pane(still: Pane) -> Pane:
    return still


# The view


def test_a_first_picture_is_fitted_into_the_window(pane: Pane) -> None:
    x, y, width, height = stage(pane)
    left, top = pane.at(-50, 30)
    right, bottom = pane.at(50, -30)
    assert close(((left + right) / 2, (top + bottom) / 2), (x + width / 2, y + height / 2))
    assert x < left < right < x + width
    assert y < top < bottom < y + height
    assert max((right - left) / width, (bottom - top) / height) == pytest.approx(0.84, abs=0.01)


def test_the_wheel_zooms_at_the_pointer_and_the_view_is_kept(pane: Pane) -> None:
    before = pane.scale
    spot = pane.at(30, 5)
    pane.page.mouse.move(*spot)
    pane.page.mouse.wheel(0, -240)
    pane.page.wait_for_function(
        "before => document.querySelector('.drawing').getScreenCTM().a > before", arg=before
    )
    assert pane.scale > 1.2 * before
    assert pane.at(30, 5) == pytest.approx(spot, abs=0.5)  # pointers are told in whole pixels
    seen = pane.at(0, 0), pane.scale
    pane.shows(svg=SVG.replace("#a7bcd6", "#123456"), box=[-60, -30, 60, 30])
    assert (pane.at(0, 0), pane.scale) == seen
    assert pane.find("#world path[fill='#123456']").count() == 1


def test_a_drawing_that_grows_out_of_its_fitted_view_is_fitted_again(pane: Pane) -> None:
    before = pane.scale
    pane.shows(box=[-52, -30, 52, 30])
    assert pane.scale == before
    pane.shows(box=[-150, -30, 150, 30])
    assert pane.scale == pytest.approx(before / 3, rel=0.01)
    pane.page.keyboard.press("+")
    chosen = pane.scale
    pane.shows(box=[-900, -30, 900, 30])
    assert pane.scale == chosen


def test_dragging_moves_the_view_and_is_no_click(pane: Pane) -> None:
    x, y = pane.at(-30, 0)
    before = pane.scale
    pane.page.mouse.move(x, y)
    pane.page.mouse.down()
    pane.page.mouse.move(x + 35, y - 20, steps=4)
    pane.page.mouse.up()
    assert close(pane.at(-30, 0), (x + 35, y - 20))
    assert pane.scale == before
    assert pane.host.of("goto") == []


def test_fitting(pane: Pane) -> None:
    fitted = pane.at(0, 0), pane.scale
    button = pane.page.get_by_role("button", name="Fit the drawing into the window")
    for fit in (
        lambda: pane.page.keyboard.press("f"),
        lambda: pane.page.keyboard.press("0"),
        lambda: pane.page.mouse.dblclick(*pane.at(-20, 0)),
        button.click,
    ):
        pane.page.keyboard.press("+")
        pane.page.keyboard.press("ArrowLeft")
        assert pane.scale == pytest.approx(1.25 * fitted[1])
        fit()
        assert close(pane.at(0, 0), fitted[0])
        assert pane.scale == pytest.approx(fitted[1])


def test_keys_move_and_zoom(pane: Pane) -> None:
    x, y = pane.at(0, 0)
    for key in ("ArrowLeft", "ArrowUp", "ArrowUp"):
        pane.page.keyboard.press(key)
    assert close(pane.at(0, 0), (x + 40, y + 80))
    before = pane.scale
    pane.page.keyboard.press("-")
    assert pane.scale == pytest.approx(before / 1.25)


def test_two_fingers_zoom(pane: Pane) -> None:
    before = pane.scale
    x, y = pane.at(10, 5)
    client = pane.page.context.new_cdp_session(pane.page)

    def touch(kind: str, apart: float) -> None:
        points = [{"x": x - apart, "y": y, "id": 1}, {"x": x + apart, "y": y, "id": 2}]
        client.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points if apart else []})

    touch("touchStart", 40)
    for apart in range(50, 90, 10):
        touch("touchMove", apart)
    touch("touchEnd", 0)
    assert pane.scale == pytest.approx(2 * before, rel=0.01)
    assert close(pane.at(10, 5), pytest.approx((x, y), abs=1))
    assert pane.host.of("goto") == []


def test_lines_stay_thin_and_keep_their_proportions(pane: Pane) -> None:
    lines = "".join(f'<path d="M0 {k}L9 {k}" fill="none" stroke="red" stroke-width="0.4"/>' for k in range(3))
    lines += '<path d="M0 9L9 9" stroke="blue" stroke-width="0.8" stroke-dasharray="1.6,0.8" fill="none"/>'
    pane.shows(svg=SVG.replace("</svg>", f"{lines}</svg>"))
    looks = """all => all.map(one => getComputedStyle(one))
        .map(style => [style.strokeWidth, style.strokeDasharray, style.vectorEffect])"""
    for _ in range(2):
        red, *_, blue = pane.page.eval_on_selector_all(".drawing path[stroke]:not(.hit)", looks)
        assert red == ["1.25px", "none", "non-scaling-stroke"]
        assert blue == ["2.5px", "5px, 2.5px", "non-scaling-stroke"]
        for _ in range(5):
            pane.page.keyboard.press("+")


def test_a_drawing_that_has_moved_out_of_sight_is_looked_for(pane: Pane) -> None:
    moved = SVG.replace('60mm">', '60mm"><g transform="translate(9000 0)">').replace("</svg>", "</g></svg>")
    pane.shows(svg=moved, box=[8950, -30, 9050, 30])
    x, _, width, _ = stage(pane)
    assert x < pane.at(9000, 0)[0] < x + width


# Pointing


def test_what_is_hovered_is_outlined_and_told(pane: Pane) -> None:
    pane.move(-40, 10)
    assert pane.host.hears("aidl/hover") == {"place": where(PLATE)}
    assert pane.outlined("hover") == [re.search(r'id="body" d="([^"]*)"', SVG)[1]]
    expect(pane.find("#tooltip")).to_contain_text("part.plate")
    expect(pane.find("#tooltip")).to_contain_text("solid, 100 × 60 mm")
    pane.move(15, 5)
    assert pane.host.hears("aidl/hover", 2)["place"] == where(BORE)
    pane.move(20, 15)
    assert pane.host.hears("aidl/hover", 3)["place"] == where(RIM)
    assert pane.outlined("hover") == [drawn(RIM)]
    pane.move(-50, 0)
    assert pane.host.hears("aidl/hover", 4)["place"] == where(OUTLINE)
    pane.move(-54, 0)
    assert pane.host.hears("aidl/hover", 5)["place"] is None
    expect(pane.find("#tooltip")).to_be_hidden()
    assert pane.outlined("hover") == []


def test_a_click_goes_to_the_text_and_selects(pane: Pane) -> None:
    pane.page.mouse.click(*pane.at(-40, 10))
    assert pane.host.hears("aidl/goto") == where(PLATE)
    assert len(pane.outlined("selected")) == 1
    pane.shows()
    assert len(pane.outlined("selected")) == 1
    pane.page.keyboard.press("Escape")
    assert pane.outlined("selected") == []


def test_the_host_reveals_elements(pane: Pane) -> None:
    pane.host.tell("aidl/reveal", {"elements": [RIM]})
    expect(pane.find(".mark.reveal .line")).to_have_count(1)
    assert pane.outlined("reveal") == [drawn(RIM)]
    pane.host.tell("aidl/reveal", {"elements": [0]})
    expect(pane.find(".mark.reveal .line")).to_have_count(4)  # the drawing is seen by all that is in it
    pane.host.tell("aidl/reveal", {"elements": [PLATE, RIM]})
    expect(pane.find(".mark.reveal .line")).to_have_count(1)  # the rim is in the plate
    pane.host.tell("aidl/reveal", {"elements": [99, -1]})
    expect(pane.find(".mark.reveal .line")).to_have_count(0)


# What is said


def test_the_status_bar(pane: Pane) -> None:
    words = {"solved": "Solved", "partial": "Partly solved", "failed": "Not solved", "wrong": "Has errors"}
    for status, told in words.items():
        pane.shows(status=status, degrees=1, seconds=1.25)
        expect(pane.find("#status")).to_have_text(told)
    expect(pane.find("#status")).to_have_attribute("aria-live", "polite")
    expect(pane.find("#status-freedom")).to_have_text("1 degree of freedom")
    expect(pane.find("#status-size")).to_have_text("100 × 60 mm")
    expect(pane.find("#status-time")).to_have_text("1.25 s")
    pane.shows(degrees=0, seconds=0.0312)
    expect(pane.find("#status-freedom")).to_have_text("fully constrained")
    expect(pane.find("#status-time")).to_have_text("31 ms")
    pane.shows(tried=True, status="wrong")
    expect(pane.find("#status")).to_have_text("Has errors (tried, not in the text)")
    expect(pane.find("#status")).to_have_class("status wrong")


def test_a_stale_picture_is_marked(pane: Pane) -> None:
    filters = "() => getComputedStyle(document.getElementById('world')).filter"
    assert pane.page.evaluate(filters) == "none"
    expect(pane.find("#stale")).to_be_hidden()
    pane.shows(stale=True, status="wrong", problems=[problem(message="there is no `inn` here")])
    expect(pane.find("#stale")).to_contain_text("Earlier drawing. there is no inn here (line 6)")
    assert "grayscale" in pane.page.evaluate(filters)
    assert pane.find("#world path").count() > 0
    pane.shows()
    expect(pane.find("#stale")).to_be_hidden()
    assert pane.page.evaluate(filters) == "none"


def test_work_that_takes_long_and_what_cannot_be_done(pane: Pane) -> None:
    pane.host.tell("aidl/busy", {})
    expect(pane.find("#busy")).to_be_visible()
    pane.host.fail("the file has changed")
    expect(pane.find(".toast")).to_contain_text("the file has changed")
    expect(pane.find("#busy")).to_be_hidden()
    pane.host.fail("the file has changed")
    pane.host.fail("again")
    expect(pane.find(".toast")).to_have_count(2)
    for left in (1, 0):
        pane.find(".toast").first.get_by_role("button", name="Close").click()
        expect(pane.find(".toast")).to_have_count(left)


def test_problems_are_listed_and_marked(pane: Pane) -> None:
    found = [
        problem(severity="warning", code="W0301", message="thin", range=None, uri=None, points=[[-50, 30]]),
        problem(elements=[RIM], fixes=2, titles=["move it", "leave it out"]),
        problem(severity="note", code="N0701", message="by the way", uri="file:///home/you/lib%20a.aidl"),
    ]
    pane.shows(problems=found)
    entries = pane.find("#problems-list > li")
    expect(entries).to_have_count(3)
    expect(entries.nth(0)).to_contain_text("bore is not where it should be")
    expect(entries.nth(0)).to_contain_text("E0601")
    expect(entries.nth(1)).to_contain_text("thin")
    expect(entries.nth(2)).to_contain_text("lib a.aidl, line 6")
    assert pane.outlined("error") == [drawn(RIM)]
    assert close(pane.middle(".point.warning .line"), pane.at(-50, 30))
    entries.nth(0).get_by_role("button", name="leave it out").click()
    version = json.loads(pane.find("body").get_attribute("data-shown") or "")[1]
    assert pane.host.hears("aidl/fix") == {"uri": URI, "version": version, "problem": 1, "fix": 1}
    entries.nth(0).get_by_role("button", name="line 6").click()
    assert pane.host.hears("aidl/goto") == {"uri": URI, "range": found[1]["range"]}
    entries.nth(2).get_by_text("by the way").click()
    assert pane.host.hears("aidl/goto", 2)["uri"] == "file:///home/you/lib%20a.aidl"


def test_conflicts_name_their_constraints(pane: Pane) -> None:
    headline = "`a` and `b` cannot hold together"
    constraints = [
        {"text": "a == 2", "range": place(3, 0, 6), "uri": URI, "elements": [OUTLINE], "off": 3.5},
        {"text": "b == 9", "range": place(4, 0, 6), "uri": URI, "elements": [RIM], "off": None},
    ]
    conflicts = [
        {"headline": headline, "constraints": constraints},
        {"headline": "another", "constraints": []},
    ]
    pane.shows(status="failed", problems=[problem(message=headline)], conflicts=conflicts)
    expect(pane.find("#problems-list > li")).to_have_count(2)  # the error and its conflict are one
    parties = pane.find(".party")
    expect(parties).to_have_count(2)
    expect(parties.nth(0)).to_contain_text("off by 3.5")
    assert pane.outlined("conflict") == [drawn(OUTLINE), drawn(RIM)]
    parties.nth(1).hover()
    assert pane.outlined("reveal") == [drawn(RIM)]
    parties.nth(1).get_by_text("b == 9").click()
    assert pane.host.hears("aidl/goto") == {"uri": URI, "range": constraints[1]["range"]}


def test_free_directions(pane: Pane) -> None:
    motions = [
        {
            "words": "slide along x",
            "elements": [PLATE],
            "arrows": [{"from": [0, 0], "to": [30, 0]}],
            "turns": [],
        },
        {
            "words": "turn",
            "elements": [RIM],
            "arrows": [],
            "turns": [{"center": [20, 5], "radius": 15, "sweep": 90}],
        },
    ]
    pane.shows(motions=motions)
    assert pane.find(".motion").count() == 0
    button = pane.page.get_by_role("button", name="Freedom").first
    button.click()
    pane.host.hears("aidl/preview")
    expect(pane.find("#freedom-list li")).to_have_text(["plate can slide along x", "plate.bore.rim can turn"])
    lines = pane.page.eval_on_selector_all(".motion .line", "all => all.map(one => one.getAttribute('d'))")
    x, y, _, _ = stage(pane)
    numbers = [float(n) for n in re.findall(r"-?[\d.]+", lines[0])]
    assert close((numbers[0] + x, numbers[1] + y), pane.at(0, 0))
    assert close((numbers[2] + x, numbers[3] + y), pane.at(30, 0))
    radius, end = re.search(r"A([\d.]+) .* 0 0 (\S+ [\d.]+)", lines[1]).groups()
    assert float(radius) == pytest.approx(15 * pane.scale)
    diagonal = 15 / 2**0.5  # a quarter about straight up ends at 135°
    last_x, last_y = map(float, end.split())
    assert close((last_x + x, last_y + y), pane.at(20 - diagonal, 5 + diagonal))
    pane.find("#freedom-list li").nth(1).hover()
    assert pane.outlined("reveal") == [drawn(RIM)]
    pane.shows(motions=motions, stale=True)
    assert pane.find(".motion").count() == 0
    button.click()
    pane.host.hears("aidl/preview", 2)


def test_there_is_no_text_where_the_host_tells_none(pane: Pane) -> None:
    for part in ("source", "source-toggle", "history"):
        expect(pane.find(f"#{part}")).to_be_hidden()
    loaded = pane.page.evaluate("() => performance.getEntriesByType('resource').map(one => one.name)")
    assert any(name.endswith("/view.js") for name in loaded)
    assert not any(name.endswith("/editor.js") for name in loaded)

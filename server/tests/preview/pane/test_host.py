"""The preview pane in Chromium: connections, menus, VS Code, themes, and use without a mouse."""

from __future__ import annotations

import base64
import json

import pytest
from playwright.sync_api import expect

from server.tests.preview.pane.conftest import Pane
from server.tests.preview.pane.messages import EXPORTS, URI, picture, problem

CODE = """
window.sent = [];
window.kept = JSON.parse(sessionStorage.getItem("kept") ?? "null") ?? undefined;
window.acquireVsCodeApi = () => ({
    postMessage: message => window.sent.push(message),
    getState: () => window.kept,
    setState: state => sessionStorage.setItem("kept", JSON.stringify(window.kept = state)),
});
"""
NOBODY = """
window.attempts = 0;
window.WebSocket = class extends EventTarget {
    constructor() {
        super();
        window.attempts += 1;
        queueMicrotask(() => this.dispatchEvent(new Event("close")));
    }
};
"""


# Connections


def test_a_lost_connection_is_told_and_made_again(pane: Pane) -> None:
    pane.host.is_away = True
    pane.host.drop()
    banner = pane.find("#disconnected")
    expect(banner).to_contain_text("Not connected")
    expect(pane.find("#status")).to_have_text("Not connected")
    filters = "() => getComputedStyle(document.getElementById('world')).filter"
    assert "grayscale" in pane.page.evaluate(filters)
    pane.host.is_away = False
    pane.host.hears("aidl/preview", 2)
    expect(banner).to_be_hidden()
    pane.shows()
    expect(pane.find("#status")).to_have_text("Solved")
    assert pane.page.evaluate(filters) == "none"
    pane.complaints.clear()  # of attempts to connect while the host was away


def test_a_host_that_is_away_is_asked_ever_more_seldom(open_pane) -> None:
    pane = open_pane(script=NOBODY, has_clock=True)
    banner = pane.find("#disconnected")
    expect(banner).to_be_visible()
    pane.page.clock.pause_at(3_600_000)
    pane.page.get_by_role("button", name="Connect now").click()
    attempts = pane.page.evaluate("() => window.attempts")
    for wait in (0.5, 1, 2, 4, 8, 10, 10):
        expect(banner).to_contain_text(f"in {wait:g} s")
        pane.page.clock.run_for(int(wait * 1000) - 50)
        assert pane.page.evaluate("() => window.attempts") == attempts
        pane.page.clock.run_for(50)
        attempts += 1
        assert pane.page.evaluate("() => window.attempts") == attempts


def test_layers_are_asked_for_again_after_a_lost_connection(pane: Pane) -> None:
    pane.page.get_by_role("button", name="Layers").click()
    pane.page.get_by_label("Dimensions").check()
    asks = {"uri": URI}
    assert pane.host.hears("aidl/preview", 2) == {**asks, "show": ["dimensions"]}
    pane.page.get_by_label("Names").check()
    assert pane.host.hears("aidl/preview", 3) == {**asks, "show": ["names", "dimensions"]}
    pane.host.drop()
    assert pane.host.hears("aidl/preview", 4)["show"] == ["names", "dimensions"]
    pane.page.reload()
    assert pane.host.hears("aidl/preview", 5)["show"] == ["names", "dimensions"]


def test_files_are_asked_for_and_saved(pane: Pane) -> None:
    pane.page.get_by_role("button", name="Export").click()
    pane.host.answer("aidl/exports", EXPORTS)
    menu = pane.find("#export-menu")
    expect(menu.get_by_label("Packed by")).to_be_hidden()  # an SVG has none
    menu.get_by_label("Format").select_option("dxf")
    menu.get_by_label("Packed by").select_option("outlines")
    menu.get_by_label("Sheet").fill("much")
    menu.get_by_role("button", name="Save").click()
    options = {"sheet": "much", "nest": "outlines"}
    asked = {"uri": URI, "format": "dxf", "options": options, "show": []}
    assert pane.host.hears("aidl/export") == asked
    pane.host.answer("aidl/export", error="`much` is no size")
    expect(menu.get_by_role("alert")).to_have_text("much is no size")
    menu.get_by_label("Sheet").fill("600x400")
    menu.get_by_label("Sheet").press("Enter")
    assert pane.host.hears("aidl/export", 2)["options"] == {**options, "sheet": "600x400"}
    content = bytes(range(256)) * 3
    data = base64.b64encode(content).decode()
    with pane.page.expect_download() as saved:
        pane.host.answer("aidl/export", {"name": "plate.dxf", "data": data, "notes": ["it is `thin`"]})
    assert saved.value.suggested_filename == "plate.dxf"
    assert saved.value.path().read_bytes() == content
    expect(menu).to_be_hidden()
    expect(pane.find(".toast.warning")).to_contain_text("it is thin")
    pane.page.get_by_role("button", name="Export").click()
    expect(menu.get_by_label("Sheet")).to_have_value("600x400")


# VS Code


def test_in_vs_code_messages_go_by_its_api_and_its_colors_win(open_pane) -> None:
    pane = open_pane(script=CODE)
    pane.page.wait_for_function("() => window.sent.some(m => m.method === 'aidl/preview')")
    assert "/socket" not in pane.host.requests
    asked = pane.page.evaluate("() => window.sent")
    assert [m["params"] for m in asked] == [{"uri": URI, "show": []}]
    answer = {"jsonrpc": "2.0", "id": asked[0]["id"], "result": picture()}
    pane.page.evaluate("message => window.postMessage(message)", answer)
    expect(pane.find("#status")).to_have_text("Solved")
    pane.page.mouse.click(*pane.at(-40, 10))
    sent = pane.page.evaluate("() => window.sent")
    assert [m["method"] for m in sent] == ["aidl/preview", "aidl/hover", "aidl/goto"]
    assert pane.page.evaluate("() => window.kept.uri") == URI
    expect(pane.find("#theme")).to_be_hidden()
    pane.page.evaluate(
        """() => {
            document.body.classList.add("vscode-dark");
            document.documentElement.style.setProperty("--vscode-sideBar-background", "rgb(1, 2, 3)");
        }"""
    )
    expect(pane.find(".toolbar")).to_have_css("background-color", "rgb(1, 2, 3)")
    pane.page.get_by_role("button", name="Points", exact=True).click()
    pane.page.reload()
    expect(pane.page.get_by_role("button", name="Points", exact=True)).to_have_attribute(
        "aria-pressed", "true"
    )


# Themes and sizes


def test_themes(pane: Pane) -> None:
    def lightness() -> float:
        color = pane.page.evaluate(
            "() => getComputedStyle(document.querySelector('.toolbar')).backgroundColor"
        )
        return sum(map(int, color[4:-1].split(", "))) / 765

    assert lightness() > 0.5
    pane.page.emulate_media(color_scheme="dark")
    assert lightness() < 0.5
    button = pane.page.get_by_role("button", name="Theme")
    button.click()
    assert lightness() > 0.5
    pane.page.reload()
    assert lightness() > 0.5
    button.click()
    pane.page.emulate_media(color_scheme="light")
    assert lightness() < 0.5
    button.click()
    assert lightness() > 0.5


def boxes(pane: Pane, *parts: str) -> list[dict[str, float]]:
    """Where parts are once all is laid out, and the first of them scrolled into sight."""
    script = """async parts => {
        await new Promise(laid => requestAnimationFrame(() => requestAnimationFrame(laid)));
        document.querySelector(parts[0]).scrollIntoView({ block: "nearest", inline: "nearest" });
        return parts.map(part => document.querySelector(part).getBoundingClientRect().toJSON());
    }"""
    found: list[dict[str, float]] = pane.page.evaluate(script, parts)
    return found


@pytest.fixture
def full(still: Pane) -> Pane:
    """The pane with a text beside the drawing, and a long problem."""
    still.writes()
    still.shows(problems=[problem(message="a `long` " * 30)])
    return still


def test_everything_fits_into_narrow_windows(full: Pane) -> None:
    for width in (320, 480, 720, 1400):
        full.page.set_viewport_size({"width": width, "height": 800})
        size = full.page.evaluate(
            "() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]"
        )
        assert size == [width, 800]
        for part in ("#stage", "#problems", "#knobs", ".statusbar"):
            (box,) = boxes(full, part)
            assert box["left"] >= 0
            assert box["right"] <= width + 0.5
            assert box["height"] > (150 if part == "#stage" else 20)


def test_the_drawing_is_in_sight_beside_text_problems_and_sliders(full: Pane) -> None:
    for height in (480, 640, 800):
        full.page.set_viewport_size({"width": 420, "height": height})
        for part in ("#source", "#knobs"):
            _, drawing, bar = boxes(full, part, ".drawing", ".statusbar")
            assert drawing["width"] > 150
            assert drawing["top"] >= 0
            assert drawing["bottom"] <= bar["top"]


# Without a mouse


def test_every_control_has_a_name(still: Pane) -> None:
    still.writes()
    still.shows(problems=[problem(fixes=1)])
    unnamed = still.page.eval_on_selector_all(
        "button, input, select, [tabindex]",
        """all => all.filter(one => !one.getAttribute("aria-label") && !one.textContent.trim())
            .filter(one => !one.labels?.length).map(one => one.outerHTML)""",
    )
    assert unnamed == []


def test_menus_work_by_keys(still: Pane) -> None:
    still.page.get_by_role("button", name="Export").focus()
    still.page.keyboard.press("Enter")
    still.host.answer("aidl/exports", EXPORTS)
    expect(still.find("#export-format")).to_be_focused()
    still.page.keyboard.press("ArrowDown")
    still.page.keyboard.press("Tab")
    still.page.keyboard.type("a3")
    still.page.keyboard.press("Enter")
    assert still.host.hears("aidl/export")["format"] == "dxf"
    still.host.answer("aidl/export", {"name": "plate.dxf", "data": "", "notes": []})
    expect(still.find("#export-menu")).to_be_hidden()
    still.page.get_by_role("button", name="Export").click()
    still.page.keyboard.press("Escape")
    expect(still.find("#export-menu")).to_be_hidden()
    expect(still.page.get_by_role("button", name="Export")).to_be_focused()


def test_keys_in_a_field_are_typed(still: Pane) -> None:
    before = still.scale, json.dumps(still.at(0, 0))
    field = still.page.get_by_role("textbox", name="width")
    field.focus()
    still.page.keyboard.type("+f0-")
    assert (still.scale, json.dumps(still.at(0, 0))) == before
    field.press("Escape")

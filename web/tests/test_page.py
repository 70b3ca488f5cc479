"""The built folder as people have it: in Chromium, from a server that has nothing else, and from nowhere."""

from __future__ import annotations

import functools
import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect

from aidl_web.site import built
from web.tests.places import MISSING, PYODIDE

pytestmark = pytest.mark.slow
PATIENCE = 60_000
PLATE = "solid plate {\n    param width = 80 in 40..160\n    body = rectangle(width: width, height: 40)\n}\n"
ROUND = "drawing d { c = circle(center: (10, 5), radius: 3) }\n"
DEMANDING = (
    "solid s {\n    for i in 0..300 { for k in 0..300 { p = circle(center: (i, k), radius: 0.4) } }\n}\n"
)


class Handler(SimpleHTTPRequestHandler):
    extensions_map = {".js": "text/javascript", ".mjs": "text/javascript", ".wasm": "application/wasm"} | {
        suffix: kind for suffix, kind in SimpleHTTPRequestHandler.extensions_map.items() if suffix != ".js"
    }

    def log_message(self, *_: object) -> None:
        """Keeps quiet."""


@contextmanager
def serving(kind: type[SimpleHTTPRequestHandler], folder: Path) -> Iterator[str]:
    """The address of a folder, while it is served."""
    with ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(kind, directory=str(folder))) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_port}/"
        finally:
            server.shutdown()
            thread.join()


@pytest.fixture(scope="module")
def server(site: Path) -> Iterator[str]:
    with serving(Handler, site) as address:
        yield address


@dataclass
class Playground:
    """The playground on a page."""

    context: BrowserContext
    page: Page
    url: str
    requests: list[str] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)

    def goes(self, address: str = "") -> None:
        self.page.goto(self.url + address)

    def shows(self, name: str) -> None:
        """Waits until a program is drawn, and its text is there."""
        drawn = (
            "name => document.body.dataset.shown?.includes(`/${name}`) && document.querySelector('.drawing')"
        )
        self.page.wait_for_function(drawn, arg=name)
        self.page.wait_for_selector(".cm-line")

    def says(self, status: str) -> None:
        expect(self.page.locator("#status")).to_have_text(status)

    def writes(self, text: str) -> None:
        """Puts another text in place of the one in the editor, as somebody who pastes it."""
        self.page.click(".cm-content")
        self.page.keyboard.press("Control+a")
        self.page.keyboard.press("Delete")
        self.page.keyboard.insert_text(text)

    def opens(self, example: str) -> None:
        self.page.click("#programs-button")
        self.page.click(f"#programs-examples >> text={example}")

    @property
    def kept(self) -> list[dict[str, str]]:
        """What the browser keeps, the newest first."""
        found: list[dict[str, str]] = json.loads(
            self.page.evaluate("() => localStorage.getItem('aidl-playground') ?? '[]'")
        )
        return found

    def keeps(self, part: str) -> None:
        self.page.wait_for_function(
            "part => localStorage.getItem('aidl-playground')?.includes(part)", arg=part
        )

    def exports(self, kind: str) -> bytes:
        page = self.page
        if page.locator("#export-menu").is_hidden():
            page.click("#export-button")
        page.select_option("#export-format", kind)
        with page.expect_download() as download:
            page.click("#export-menu button[type=submit]")
        return Path(download.value.path()).read_bytes()


@pytest.fixture
def playground(browser: Browser, server: str, request: pytest.FixtureRequest) -> Iterator[Playground]:
    looks: dict[str, Any] = getattr(request, "param", {"viewport": {"width": 1200, "height": 800}})
    context = browser.new_context(**looks)
    context.set_default_timeout(PATIENCE)
    expect.set_options(timeout=PATIENCE)
    made = Playground(context, context.new_page(), server)
    context.on("request", lambda request: made.requests.append(request.url))
    made.page.on("pageerror", lambda error: made.complaints.append(str(error)))
    made.page.on("console", lambda line: line.type == "error" and made.complaints.append(line.text))
    yield made
    context.close()
    assert [each for each in made.requests if not each.startswith((made.url, "data:", "blob:"))] == []
    assert made.complaints == []


def test_a_program_is_drawn_changed_and_mended(playground: Playground) -> None:
    page = playground.page
    playground.goes()
    playground.shows("motor_bracket.aidl")
    playground.writes(PLATE.replace("height", "hieght"))
    playground.says("Has errors")
    page.click("#problems-list >> text=write")  # the fix
    playground.says("Solved")
    playground.keeps("height: 40")
    page.locator("#knobs-list input[type=range]").focus()
    page.keyboard.press("End")
    playground.keeps("width = 160 in")
    page.click("#undo")
    playground.keeps("width = 80 in")
    playground.writes(ROUND)
    playground.keeps("(10, 5)")
    playground.says("Solved")
    page.click("#handles-toggle")
    handle = page.locator(".handle.guess")
    expect(handle).to_have_count(1)
    box = handle.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + 60, box["y"] + 45, steps=5)
    page.mouse.up()
    page.wait_for_function("() => !localStorage.getItem('aidl-playground').includes('(10, 5)')")


def test_a_program_travels_in_its_link_and_survives_a_reload(playground: Playground) -> None:
    page = playground.page
    playground.goes("#example=gallery/teapot")
    playground.shows("teapot.aidl")
    assert page.evaluate("() => location.hash") == ""
    playground.writes(PLATE)
    playground.keeps("height: 40")
    page.reload()
    playground.shows("teapot.aidl")
    assert page.locator(".cm-line").first.inner_text() == "solid plate {"
    page.click("#share-button")
    page.wait_for_function("() => document.querySelector('#share-link').value")
    link = page.input_value("#share-link")
    other = playground.context.new_page()
    other.goto(link)
    other.wait_for_selector(".cm-line")
    assert other.locator(".cm-line").first.inner_text() == "solid plate {"
    other.goto(link[:-30])
    other.reload()
    expect(other.locator(".toast")).to_contain_text("cannot be read")
    other.close()


def test_examples_and_files_leave_what_was_changed(playground: Playground, tmp_path: Path) -> None:
    page = playground.page
    playground.goes()
    playground.shows("motor_bracket.aidl")
    playground.writes(PLATE)
    playground.keeps("height: 40")
    playground.opens("lantern")
    playground.shows("lantern.aidl")
    playground.opens("motor bracket")
    playground.shows("motor_bracket_2.aidl")
    file = tmp_path / "mine.aidl"
    file.write_text('import "rim.aidl"\nassembly hook { a = rim(size: 7) }\n')
    (tmp_path / "rim.aidl").write_text("solid rim(size = 5) { edge = circle(radius: size) }\n")
    page.set_input_files("#file", [file, tmp_path / "rim.aidl"])
    playground.shows("mine.aidl")
    playground.says("Solved")
    page.click("#programs-button")
    page.click("#programs-own >> text=motor_bracket.aidl")
    playground.shows("motor_bracket.aidl")
    assert page.locator(".cm-line").first.inner_text() == "solid plate {"
    page.set_input_files("#file", [{"name": "a.aidl", "mimeType": "text/plain", "buffer": b"\xff\xfe\x00"}])
    expect(page.locator(".toast")).to_contain_text("is no text")


def test_by_the_keyboard_alone_from_open_to_export(playground: Playground) -> None:
    page = playground.page
    playground.goes()
    playground.shows("motor_bracket.aidl")
    page.keyboard.press("Tab")
    while page.evaluate("() => document.activeElement.id") != "programs-button":
        page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    page.wait_for_selector("#programs-examples .item")
    while "wrench" not in page.evaluate("() => document.activeElement.textContent"):
        page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    playground.shows("wrench.aidl")
    while page.evaluate("() => document.activeElement.id") != "export-button":
        page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    page.wait_for_selector("#export-format")
    page.keyboard.type("SVG")
    with page.expect_download() as download:
        page.keyboard.press("Tab")
        while page.evaluate("() => document.activeElement.type") != "submit":
            page.keyboard.press("Tab")
        page.keyboard.press("Enter")
    assert download.value.suggested_filename.startswith("wrench.")


def test_exports_that_need_no_package_and_those_that_do(playground: Playground) -> None:
    page = playground.page
    playground.goes()
    playground.shows("motor_bracket.aidl")
    assert b"<svg" in playground.exports("svg")
    assert b"SECTION" in playground.exports("dxf")
    assert len(playground.exports("stl")) > 1000
    assert playground.exports("pdf").startswith(b"%PDF")
    assert playground.exports("png").startswith(b"\x89PNG")
    page.click("#export-button")
    for kind, package in (("step", "aidl-lang[step]"), ("3mf", "aidl-lang[3mf]")):
        page.select_option("#export-format", kind)
        page.click("#export-menu button[type=submit]")
        expect(page.locator("#export-menu .refusal")).to_contain_text(package)
    page.keyboard.press("Escape")
    page.click(".cm-content")
    with page.expect_download() as download:
        page.keyboard.press("Control+s")
    assert download.value.suggested_filename == "motor_bracket.aidl"


def test_what_takes_long_is_stopped_and_runs_again_when_it_is_changed(playground: Playground) -> None:
    page = playground.page
    playground.goes()
    playground.shows("motor_bracket.aidl")
    playground.writes(DEMANDING)
    playground.keeps("0..300")
    page.click("#stop")
    expect(page.locator("#held")).to_be_visible()
    playground.says("Stopped")
    assert page.locator(".cm-line").first.inner_text() == "solid s {"
    playground.writes(PLATE)
    playground.says("Solved")
    expect(page.locator("#held")).to_be_hidden()


def test_it_works_without_a_connection_after_the_first_visit(playground: Playground) -> None:
    page = playground.page
    playground.goes()
    playground.shows("motor_bracket.aidl")
    page.evaluate("() => navigator.serviceWorker.ready.then(() => null)")
    page.wait_for_function("() => navigator.serviceWorker.controller")
    playground.context.set_offline(True)
    page.reload()
    playground.shows("motor_bracket.aidl")
    assert playground.exports("pdf").startswith(b"%PDF")
    playground.opens("lantern")
    playground.shows("lantern.aidl")


@pytest.mark.parametrize(
    "playground",
    [
        {
            "viewport": {"width": 390, "height": 844},
            "is_mobile": True,
            "has_touch": True,
            "color_scheme": "dark",
        }
    ],
    indirect=True,
)
def test_a_phone_in_the_dark(playground: Playground) -> None:
    page = playground.page
    playground.goes()
    page.wait_for_function("() => document.body.dataset.shown && document.querySelector('.drawing')")
    assert page.evaluate("() => document.documentElement.scrollWidth <= innerWidth")
    assert page.evaluate("() => getComputedStyle(document.body).backgroundColor") == "rgb(20, 23, 28)"
    for name in ("programs", "share", "export"):
        page.tap(f"#{name}-button")
        box = page.locator(f"#{name}-menu").bounding_box()
        assert box is not None
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= 390
        page.keyboard.press("Escape")


@pytest.mark.skipif(bool(MISSING), reason=MISSING)
def test_python_comes_from_elsewhere_by_default(browser: Browser, tmp_path: Path) -> None:
    """Pyodide by the address of a server, as that of its CDN; the rest is of the page's own."""

    class Open(Handler):
        def end_headers(self) -> None:
            self.send_header("Access-Control-Allow-Origin", "*")
            super().end_headers()

    with serving(Open, PYODIDE) as elsewhere, serving(Handler, tmp_path / "site") as here:
        built(tmp_path / "site", elsewhere, tmp_path / "work")
        assert not (tmp_path / "site" / "pyodide").exists()
        context = browser.new_context()
        requests: list[str] = []
        context.on("request", lambda request: requests.append(request.url))
        page = context.new_page()
        page.goto(here)
        shown = "() => document.body.dataset.shown && document.querySelector('.drawing')"
        page.wait_for_function(shown, timeout=PATIENCE)
        page.evaluate("() => navigator.serviceWorker.ready.then(() => null)")
        page.wait_for_function("() => navigator.serviceWorker.controller")
        assert elsewhere + "pyodide.asm.wasm" in requests
        assert [each for each in requests if not each.startswith((elsewhere, here, "data:"))] == []
        page.reload()
        page.wait_for_function(shown, timeout=PATIENCE)
        context.set_offline(True)
        page.reload()
        page.wait_for_function(shown, timeout=PATIENCE)
        context.close()

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Dialog, Locator, Page, ViewportSize, sync_playwright

from server.tests.preview.messages import picture, words
from server.tests.preview.scripted import ScriptedHost
from server.tests.preview.talking import TEXT

BROWSERS = "chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"
CHROMIUM = next(filter(None, map(shutil.which, BROWSERS)), None)
ARGUMENTS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
]
VIEWPORT: ViewportSize = {"width": 1200, "height": 800}


@pytest.fixture(scope="module")  # it runs an event loop, in which the tests of other modules could start none
def browser() -> Iterator[Browser]:
    if CHROMIUM is None:
        pytest.skip("there is no Chromium")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield browser
        browser.close()


@pytest.fixture(autouse=True)
def _untidied(monkeypatch: pytest.MonkeyPatch) -> None:
    """Servers in this process look for garbage in all that the tests have loaded, which takes long."""
    monkeypatch.setattr("gc.collect", lambda *_: 0)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """The program that hosts without a browser serve."""
    path = tmp_path / "part.aidl"
    path.write_text(TEXT, "utf-8")
    return path


@dataclass
class Pane:
    """The pane in a browser, and the host that it talks to."""

    page: Page
    host: ScriptedHost
    complaints: list[str] = field(default_factory=list)
    """What the browser has to say: errors, and what the Content-Security-Policy stopped."""

    def shows(self, **changes: Any) -> None:
        """Send a picture and wait until it is shown: as the answer to who asks for it, else as news."""
        message = picture(**changes)
        asked = "aidl/try" if changes.get("tried") else "aidl/preview"
        if self.host.is_asked(asked):
            self.host.answer(asked, message)
        else:
            self.host.tell("aidl/previewChanged", message)
        shown = "([uri, version]) => JSON.stringify([uri, version]) === document.body.dataset.shown"
        self.page.wait_for_function(shown, arg=[message["uri"], message["version"]])

    def writes(self, **changes: Any) -> None:
        """Tell of the text, and wait until the editor has it."""
        told = words(**changes)
        self.host.tell("aidl/text", told)
        first = str(told["text"]).split("\n")[0]
        self.page.wait_for_function(
            "first => document.querySelector('.cm-line')?.textContent === first", arg=first
        )

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Where on the page a point of the drawing is, as the browser has it."""
        matrix = "one => { const m = one.getScreenCTM(); return [m.a, m.d, m.e, m.f] }"
        a, d, e, f = self.page.eval_on_selector(".drawing", matrix)
        return a * x + e, -d * y + f

    @property
    def scale(self) -> float:
        """Pixels for a millimetre."""
        return self.at(1, 0)[0] - self.at(0, 0)[0]

    def move(self, x: float, y: float, steps: int = 1) -> None:
        """The pointer to a point of the drawing."""
        self.page.mouse.move(*self.at(x, y), steps=steps)

    def middle(self, selector: str) -> tuple[float, float]:
        """Where on the page the middle of a shape is."""
        box = (
            "one => { const b = one.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2] }"
        )
        x, y = self.page.eval_on_selector(selector, box)
        return x, y

    def find(self, selector: str) -> Locator:
        return self.page.locator(selector)


def opened(context: BrowserContext, host: ScriptedHost, has_clock: bool = False) -> Pane:
    """The pane on a page of its own."""
    pane = listened(context, host)
    if has_clock:
        pane.page.clock.install(time=0)
    pane.page.goto(host.url)
    return pane


def listened(context: BrowserContext, host: ScriptedHost) -> Pane:
    """A page for the pane, with nothing in it."""
    context.set_default_timeout(10_000)
    pane = Pane(context.new_page(), host)
    pane.page.on("pageerror", lambda error: pane.complaints.append(str(error)))
    pane.page.on("console", lambda line: line.type == "error" and pane.complaints.append(line.text))
    return pane


def left(dialog: Dialog) -> None:
    """Leaves a page, unsaved text and all."""
    dialog.accept()


@pytest.fixture
def host() -> Iterator[ScriptedHost]:
    with ScriptedHost() as host:
        yield host


@pytest.fixture
def open_pane(browser: Browser, host: ScriptedHost) -> Iterator[Callable[..., Pane]]:
    """What opens the pane in a browser of its own; `looks` are those of `Browser.new_context`."""
    contexts = []

    def open_pane(host: ScriptedHost = host, script: str = "", has_clock: bool = False, **looks: Any) -> Pane:
        contexts.append(browser.new_context(**{"viewport": VIEWPORT, **looks}))
        if script:
            contexts[-1].add_init_script(script)
        return opened(contexts[-1], host, has_clock)

    yield open_pane
    for context in contexts:
        context.close()


@pytest.fixture(scope="module")
def shared(browser: Browser) -> Iterator[Pane]:
    """One host and one page for many tests: a page of its own for each takes three times as long to load."""
    with ScriptedHost() as host:
        context = browser.new_context(viewport=VIEWPORT)
        yield listened(context, host)
        context.close()


@pytest.fixture
def pane(shared: Pane) -> Iterator[Pane]:
    """The pane, loaded anew, with a plate in it; nothing that a test does may make the browser complain."""
    host, page = shared.host, shared.page
    host.forget()
    shared.complaints.clear()
    page.set_viewport_size(VIEWPORT)
    page.emulate_media(color_scheme="light")
    page.mouse.up()
    page.mouse.move(0, 0)
    page.goto(host.url)
    host.hears("aidl/preview")
    shared.writes()
    shared.shows()
    yield shared
    page.evaluate("() => localStorage.clear()")
    page.once("dialog", left)
    page.goto("about:blank")
    page.remove_listener("dialog", left)
    host.drop()
    assert shared.complaints == []

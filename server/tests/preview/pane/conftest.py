from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Locator, Page, ViewportSize

from server.tests.preview.conftest import browsing
from server.tests.preview.pane.messages import SVG, picture, words
from server.tests.preview.pane.scripted import ScriptedHost

VIEWPORT: ViewportSize = {"width": 1000, "height": 600}

browser = pytest.fixture(scope="package")(browsing)


@dataclass
class Pane:
    """The pane in a browser, and the host that it talks to."""

    page: Page
    host: ScriptedHost
    complaints: list[str] = field(default_factory=list)
    """What the browser has to say: errors, and what the Content-Security-Policy stopped."""
    dialogs: list[str] = field(default_factory=list)
    """What asked before the page was left."""
    still_for: object = None
    """The module of tests for which it is as it was when it was loaded."""

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
        return at(self.page, x, y)

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

    def outlined(self, mark: str) -> list[str]:
        """The paths that are outlined in one of the ways."""
        paths: list[str] = self.page.eval_on_selector_all(
            f".mark.{mark} .line", "all => all.map(one => one.getAttribute('d'))"
        )
        return paths

    def find(self, selector: str) -> Locator:
        return self.page.locator(selector)


def at(page: Page, x: float, y: float) -> tuple[float, float]:
    """Where on the page a point of the drawing is, as the browser has it."""
    matrix = "one => { const m = one.getScreenCTM(); return [m.a, m.d, m.e, m.f] }"
    a, d, e, f = page.eval_on_selector(".drawing", matrix)
    return a * x + e, -d * y + f


def drawn(number: int) -> str:
    """The path of an element of the plate, from its SVG."""
    found = re.search(rf'data-element="{number}"[^>]*? d="([^"]*)"', SVG)
    assert found is not None
    return found[1]


def listened(context: BrowserContext, host: ScriptedHost) -> Pane:
    """A page for the pane, with nothing in it."""
    context.set_default_timeout(10_000)
    pane = Pane(context.new_page(), host)
    pane.page.on("pageerror", lambda error: pane.complaints.append(str(error)))
    pane.page.on("console", lambda line: line.type == "error" and pane.complaints.append(line.text))
    return pane


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
        pane = listened(contexts[-1], host)
        if has_clock:
            pane.page.clock.install(time=0)
        pane.page.goto(host.url)
        return pane

    yield open_pane
    for context in contexts:
        context.close()


@pytest.fixture(scope="package")
def shared(browser: Browser) -> Iterator[Pane]:
    """One host and one page for many tests: a page of its own for each takes three times as long to load."""
    with ScriptedHost() as host:
        context = browser.new_context(viewport=VIEWPORT)
        pane = listened(context, host)
        pane.page.on("dialog", lambda dialog: (pane.dialogs.append(dialog.type), dialog.accept()))
        yield pane
        context.close()


def load(pane: Pane) -> None:
    """Loads the pane anew, with a plate in it."""
    pane.host.drop()
    pane.host.forget()
    pane.complaints.clear()
    pane.still_for = None
    pane.page.set_viewport_size(VIEWPORT)
    pane.page.emulate_media(color_scheme="light")
    pane.page.mouse.up()
    pane.page.mouse.move(0, 0)
    pane.page.goto(pane.host.url)
    pane.dialogs.clear()
    pane.host.hears("aidl/preview")
    pane.shows()


@pytest.fixture
def pane(shared: Pane) -> Iterator[Pane]:
    """The pane, loaded anew; nothing that a test does may make the browser complain."""
    load(shared)
    yield shared
    shared.page.evaluate("() => localStorage.clear()")
    assert shared.complaints == []


@pytest.fixture
def still(shared: Pane, request: pytest.FixtureRequest) -> Iterator[Pane]:
    """The pane, loaded once for tests of a module, in a row, that leave nothing open and unanswered."""
    page, host = shared.page, shared.host
    if shared.still_for is not request.module:
        load(shared)
    shared.still_for = None
    yield shared
    page.mouse.up()
    page.mouse.move(0, 0)
    if page.viewport_size != VIEWPORT:
        page.set_viewport_size(VIEWPORT)
    if host.is_asked("aidl/try"):  # whose answer is too late
        host.answer("aidl/try", picture(tried=True))
    page.evaluate(
        """() => {
            document.activeElement.blur();
            document.querySelector("#handles-toggle[aria-pressed=true]")?.click();
        }"""
    )
    page.keyboard.press("Escape")
    shared.shows()
    page.keyboard.press("f")
    hovers = host.of("aidl/hover")
    host.wait(lambda: not hovers or host.of("aidl/hover")[-1]["place"] is None)
    host.forget()
    assert shared.complaints == []
    shared.still_for = request.module

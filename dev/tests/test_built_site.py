"""The site as `make site` built it: colours, search, nothing loaded from elsewhere. CI builds
it before the tests; where it is not built, or is older than the pages, these are left out.
"""

from __future__ import annotations

import functools
import http.server
import re
import threading
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, TimeoutError

from aidl_site import checking
from tests.documents import ROOT

SITE = ROOT / "build" / "site"
SHOWN = "index.html", "tutorial.html", "gallery.html", "howto/holes.html", "reference/rounds.html"
WIDTHS = (1280, 390)
ASKED = {
    "round corners": "howto/corners.html",
    "screw hole": "howto/holes.html",
    "laser kerf": "howto/cutting.html",
    "import svg logo": "howto/drawings.html",
    "openscad": "start/openscad.html",
    "export step": "howto/solids.html",
    "finger joint": "reference/joints.html",
    "equal sizes": "howto/sizes.html",
    "3d print": "howto/solids.html",
    "E0601": "diagnostics/E0601.html",
    "install": "howto/install.html",
    "freecad": "howto/build123d.html",
    "conflict": "howto/messages.html",
}
"""What people ask for, each with a page that is among the first three found."""


def _newest() -> float:
    return max(path.stat().st_mtime for path in (ROOT / "docs").rglob("*.md"))


pytestmark = pytest.mark.skipif(
    not (SITE / "index.html").is_file() or (SITE / "index.html").stat().st_mtime < _newest(),
    reason="the site is not built as the pages are: `make site`",
)


def test_nothing_is_loaded_from_elsewhere() -> None:
    assert checking.outside(SITE.glob("*.html")) == set()


@pytest.mark.parametrize("page", SHOWN[:2] + SHOWN[3:])
def test_programs_have_colours(page: str) -> None:
    """The words that begin structures are told apart, and nothing is taken for an error."""
    text = (SITE / page).read_text("utf-8")
    assert re.search(r'<span class="kt">solid</span>', text)
    assert 'class="err"' not in text


class _Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *said: object) -> None:
        """Says nothing."""


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(_Quiet, directory=str(SITE)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()
    server.server_close()


@pytest.mark.parametrize("width", WIDTHS)
def test_pages_fit_the_window_and_ask_nobody_else(browser: Browser, address: str, width: int) -> None:
    page = browser.new_page(viewport={"width": width, "height": 800})
    asked: list[str] = []
    errors: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.on("pageerror", lambda error: errors.append(str(error)))
    for name in SHOWN:
        page.goto(address + name)
        assert page.evaluate("document.documentElement.scrollWidth") <= width, name
        broken = "[...document.images].filter(i => i.complete && !i.naturalWidth).map(i => i.src)"
        assert page.evaluate(broken) == []
    page.close()
    assert errors == []
    assert [url for url in asked if not url.startswith(address)] == []


def test_what_people_ask_for_is_found(browser: Browser, address: str) -> None:
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.goto(address)
    page.locator("button.md-search__button").wait_for()
    page.keyboard.press("Control+k")
    found = page.locator('div[style*="position: fixed"] a')
    missed = {}
    for words, wanted in ASKED.items():
        page.keyboard.press("Control+a")
        page.keyboard.type(words)
        try:
            page.wait_for_function(
                "wanted => [...document.querySelectorAll('div')].flatMap(d => d.shadowRoot"
                " ? [...d.shadowRoot.querySelectorAll('a')].slice(0, 3) : [])"
                ".some(a => a.href.includes(wanted))",
                arg=wanted,
                timeout=5_000,
            )
        except TimeoutError:
            links = found.evaluate_all("links => links.slice(0, 3).map(link => link.getAttribute('href'))")
            missed[words] = links
    page.close()
    assert missed == {}

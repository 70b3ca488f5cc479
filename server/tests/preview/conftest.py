from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, sync_playwright

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


def browsing() -> Iterator[Browser]:
    """It runs an event loop, in which tests that start one of their own cannot run meanwhile."""
    if CHROMIUM is None:
        pytest.skip("there is no Chromium")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield browser
        browser.close()


browser = pytest.fixture(scope="module")(browsing)


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

"""One VS Code for all tests that look into it.

They are there only when AIDL_CODE_SERVER names the folder that `install.py` has filled, and
AIDL_VSIX the extension.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.editors.vscode.install import Installed

if TYPE_CHECKING:
    from tests.editors.vscode.window import Window

FOLDER = os.environ.get("AIDL_CODE_SERVER", "")
VSIX = os.environ.get("AIDL_VSIX", "")


@pytest.fixture(scope="session")
def vsix() -> Path:
    if not VSIX:
        pytest.skip("AIDL_VSIX does not name an extension (`make vscode` makes one)")
    return Path(VSIX).resolve()


@pytest.fixture(scope="session")
def started(vsix: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Window]:
    if not FOLDER:
        pytest.skip("AIDL_CODE_SERVER does not name a folder with VS Code (`make test-vscode` makes one)")
    sync_api = pytest.importorskip("playwright.sync_api")
    from server.tests.preview.conftest import ARGUMENTS, CHROMIUM
    from tests.editors.vscode.window import PATIENCE, Window, served

    with (
        served(Installed(Path(FOLDER)), vsix, tmp_path_factory.mktemp("code")) as (address, folder),
        sync_api.sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        page = browser.new_page(viewport={"width": 1500, "height": 900})
        # Nothing outside this machine is asked for: no extension gallery, no telemetry.
        page.route(lambda url: "//127.0.0.1:" not in url, lambda route: route.abort())
        window = Window(page, folder)
        window.load(address)
        page.get_by_role("button", name="Yes, I trust").click(timeout=PATIENCE)
        yield window
        browser.close()


@pytest.fixture
def window(started: Window) -> Iterator[Window]:
    yield started
    started.close_all()

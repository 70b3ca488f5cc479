"""VS Code in a browser, driven as a person would: keys, pointer, and what can be seen."""

from __future__ import annotations

import json
import os
import re
import shutil
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import FrameLocator, Locator, Page, TimeoutError, expect

from tests.editors.vscode.install import Installed

AIDL = Path(sys.executable).with_name("aidl")
SETTINGS = {
    "telemetry.telemetryLevel": "off",
    "extensions.autoCheckUpdates": False,
    "workbench.startupEditor": "none",
    "workbench.tips.enabled": False,
    "editor.minimap.enabled": False,
    "explorer.autoReveal": False,
    "editor.stickyScroll.enabled": False,
}
PATIENCE = 30_000
"""ms that something may take to be seen; only a failure takes so long."""


@contextmanager
def served(installed: Installed, vsix: Path, folder: Path) -> Iterator[tuple[str, Path]]:
    """VS Code with the extension, on a port of this machine: the address, and the folder that is open in it.
    Its `.venv` has `aidl`, which is nowhere on the PATH.
    """
    workspace, data = folder / "parts", folder / "data"
    programs = workspace / ".venv" / "bin"
    programs.mkdir(parents=True)
    (programs / "aidl").symlink_to(AIDL)
    settings = data / "data" / "Machine" / "settings.json"
    settings.parent.mkdir(parents=True)
    settings.write_text(json.dumps(SETTINGS))
    command = ["node", str(installed.server), "--accept-server-license-terms", "--force-disable-user-env"]
    command += ["--server-data-dir", str(data), "--extensions-dir", str(folder / "extensions")]
    environment = {**os.environ, "PATH": path_without_aidl()}
    subprocess.run(
        [*command, "--install-extension", str(vsix)], check=True, capture_output=True, env=environment
    )
    port = free_port()
    command += ["--host", "127.0.0.1", "--port", str(port), "--without-connection-token"]
    with (folder / "server.log").open("wb") as log:
        server = subprocess.Popen(command, stdout=log, stderr=log, env=environment)
    try:
        wait_for(f"http://127.0.0.1:{port}/", server)
        yield f"http://127.0.0.1:{port}/?folder={workspace}", workspace
    finally:
        server.terminate()
        server.wait(20)


def path_without_aidl() -> str:
    folders = os.environ["PATH"].split(os.pathsep)
    return os.pathsep.join(folder for folder in folders if not shutil.which("aidl", path=folder))


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def wait_for(address: str, server: subprocess.Popen[bytes]) -> None:
    end = time.monotonic() + PATIENCE / 1000
    while True:
        try:
            urllib.request.urlopen(address).close()
            return
        except OSError:
            if server.poll() is not None or time.monotonic() > end:
                raise
            time.sleep(0.1)


class Window:
    """
    page    what the browser shows
    folder  the one that is open in VS Code
    """

    def __init__(self, page: Page, folder: Path) -> None:
        self.page, self.folder = page, folder

    def load(self, address: str) -> None:
        self.page.goto(address)
        self.page.wait_for_selector(".monaco-workbench .explorer-folders-view", timeout=PATIENCE)

    @property
    def editor(self) -> Locator:
        return self.page.locator(".editor-instance .monaco-editor").first

    @property
    def status(self) -> Locator:
        return self.page.locator("[id='aidl.aidl.aidl.status']")

    @property
    def pane(self) -> FrameLocator:
        """The page of the preview that is in front."""
        return self.page.frame_locator("iframe.webview.ready").frame_locator("#active-frame")

    def open(self, name: str, text: str) -> Path:
        """Write a program and open it; the caret is at its beginning."""
        file = self.folder / name
        file.write_text(text)
        self.page.keyboard.press("Control+O")
        self.give(file)
        expect(self.tab(name)).to_be_visible(timeout=PATIENCE)
        self.page.wait_for_selector(".editor-instance .monaco-editor .view-line", timeout=PATIENCE)
        return file

    def tab(self, name: str) -> Locator:
        return self.page.locator(f".tab.active[data-resource-name='{name}']")

    def give(self, file: Path, suggested: str = "") -> None:
        """Tell a dialog that asks for a file which one, once it has listed the folder that it begins with."""
        rows = self.page.locator(".quick-input-list .monaco-list-row")
        expect(self.field).to_have_value(re.compile(f"^/.*{re.escape(suggested)}$"), timeout=PATIENCE)
        expect(rows.filter(has_text="..").first).to_be_visible(timeout=PATIENCE)
        self.field.fill(str(file))
        expect(self.field).to_have_value(str(file))
        self.field.press("Enter")
        self.field.wait_for(state="hidden", timeout=PATIENCE)

    def run(self, command: str) -> None:
        """Take a command from the palette, which is opened again if something took its focus."""
        self.page.keyboard.press("F1")
        try:
            self.field.fill(f">{command}", timeout=PATIENCE / 3)
        except TimeoutError:
            self.page.keyboard.press("F1")
            self.field.fill(f">{command}")
        named = f"[aria-label='{command}'], [aria-label^='{command},']"
        self.page.locator(".quick-input-list .monaco-list-row").and_(self.page.locator(named)).click(
            timeout=PATIENCE
        )

    @property
    def field(self) -> Locator:
        return self.page.locator(".quick-input-widget input.input")

    def caret(self, line: int, column: int) -> None:
        """Put the caret into the text; counted from 1, as editors do."""
        self.page.keyboard.press("Control+1")  # the text's side of the window
        self.page.keyboard.press("Control+G")
        self.field.fill(f":{line}:{column}")
        self.field.press("Enter")
        self.field.wait_for(state="hidden", timeout=PATIENCE)
        expect(self.page.locator("#status\\.editor\\.selection")).to_contain_text(f"Ln {line}, Col {column}")

    def text(self) -> str:
        """What the editor shows, of a program so short that all of it is seen."""
        lines = self.editor.locator(".view-line").evaluate_all(
            "lines => lines.map(line => [parseFloat(line.style.top), line.textContent])"
        )
        return "\n".join(line.replace("\xa0", " ") for _, line in sorted(lines))

    def preview(self) -> FrameLocator:
        """Open the preview beside the text and wait for its picture."""
        self.page.keyboard.press("Control+K")
        self.page.keyboard.press("v")
        self.pane.locator("#world [data-element]").first.wait_for(state="attached", timeout=PATIENCE)
        return self.pane

    def close_all(self) -> None:
        self.run("View: Close All Editors")
        dismiss = self.page.get_by_role("button", name="Don't Save")
        if dismiss.is_visible():
            dismiss.click()
        expect(self.page.locator(".tab")).to_have_count(0)

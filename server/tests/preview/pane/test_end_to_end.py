"""`aidl preview` as people have it: a real process, a real browser, a real file."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from server.tests.preview.pane.conftest import VIEWPORT, at
from tests.documents import ROOT

PLATE = """\
solid plate {
    param width = 160mm in 100..240
    body = rectangle(width: width, height: 80)
}
"""
PATIENCE = 30.0
"""Seconds after which what a test waits for is not coming."""


@dataclass
class Preview:
    """The page of a program, and its file."""

    page: Page
    file: Path
    complaints: list[str]

    def find(self, selector: str) -> Locator:
        return self.page.locator(selector)

    def until_width(self, width: float) -> None:
        """Waits until the widest that is painted is so many mm wide."""
        self.page.wait_for_function(
            """width => Math.abs(width - Math.max(
                ...[...document.querySelectorAll(".drawing [data-element] path:not(.hit)")]
                    .map(path => path.getBBox().width))) < 0.01""",
            arg=width,
            polling=20,
        )

    @property
    def text(self) -> str:
        return self.file.read_text("utf-8")


def wait(is_so: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not is_so():
        assert time.monotonic() < end, "it did not come"
        time.sleep(0.02)


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Path, str]]:
    """The file and the address of a program that is previewed."""
    file = tmp_path_factory.mktemp("preview") / "plate.aidl"
    file.write_text(PLATE, "utf-8")
    command = [sys.executable, "-m", "aidl_lang", "preview", str(file), "--no-open"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, cwd=ROOT) as process:
        try:
            assert process.stderr is not None
            found = re.search(r"http://\S+", process.stderr.readline())
            assert found is not None
            yield file, found[0]
            process.send_signal(signal.SIGINT)
            assert process.wait(PATIENCE) == 130
            assert process.stderr.read() == ""
        finally:
            process.kill()


@pytest.fixture(scope="module")
def shared(browser: Browser, served: tuple[Path, str]) -> Iterator[Preview]:
    page = browser.new_page(viewport=VIEWPORT)
    page.set_default_timeout(PATIENCE * 1000)
    expect.set_options(timeout=PATIENCE * 1000)
    complaints: list[str] = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("console", lambda m: complaints.append(m.text) if m.type in ("error", "warning") else None)
    page.goto(served[1])
    yield Preview(page, served[0], complaints)
    page.close()


@pytest.fixture
def preview(shared: Preview) -> Iterator[Preview]:
    """The page, with the plate in it again."""
    shared.file.write_text(PLATE, "utf-8")
    shared.page.mouse.move(0, 0)
    expect(shared.find("#source-lines")).to_contain_text("param width = 160mm")
    shared.until_width(160)
    yield shared
    assert shared.complaints == []


def test_a_slider_solves_again_and_is_written_on_release(preview: Preview) -> None:
    box = preview.find("#knobs-list input[type=range]").bounding_box()
    assert box is not None
    middle = box["y"] + box["height"] / 2
    preview.page.mouse.move(box["x"] + box["width"] * 60 / 140, middle)
    preview.page.mouse.down()
    preview.page.mouse.move(box["x"] + box["width"] * 0.9, middle, steps=4)
    tried = float(preview.find("#knobs-list input:not([type=range])").input_value())
    assert tried > 200
    preview.until_width(tried)
    assert preview.text == PLATE
    preview.page.mouse.up()
    wait(lambda: preview.text != PLATE)
    (written,) = re.findall(r"param width = ([\d.]+)mm in 100\.\.240", preview.text)
    assert float(written) == tried
    assert preview.text == PLATE.replace("160mm", f"{written}mm")
    expect(preview.find("#source-lines")).to_contain_text(f"param width = {written}mm")
    preview.until_width(float(written))


def test_a_dragged_point_changes_the_text(preview: Preview) -> None:
    text = "drawing sketch {\n    one = line((0, 0), (30, 40))\n    two = line(one.end, (80, 0))\n}\n"
    preview.file.write_text(text, "utf-8")
    expect(preview.find("#source-lines")).to_contain_text("drawing sketch")
    preview.find("#handles-toggle").click()
    handle = preview.find('.handle[aria-label*="one.start"]')
    handle.wait_for()
    before = handle.bounding_box()
    assert before is not None
    x, y = before["x"] + before["width"] / 2, before["y"] + before["height"] / 2
    assert (x, y) == pytest.approx(at(preview.page, 0, 0), abs=1)
    preview.page.mouse.move(x, y)
    preview.page.mouse.down()
    preview.page.mouse.move(*at(preview.page, -20, -10), steps=4)
    preview.page.wait_for_function(
        "() => document.querySelector('.drawing').getBBox().width > 90", polling=20
    )
    assert preview.text == text
    preview.page.mouse.up()
    wait(lambda: preview.text != text)
    assert re.sub(r"-?\d+(\.\d+)?", "N", preview.text) == re.sub(r"-?\d+(\.\d+)?", "N", text)
    (x, y) = map(float, re.findall(r"one = line\(\((-?[\d.]+), (-?[\d.]+)\)", preview.text)[0])
    assert (x, y) == pytest.approx((-20, -10), abs=1)


def test_what_is_typed_is_drawn_saved_and_undone(preview: Preview) -> None:
    unsaved = preview.find("#save")
    line = preview.page.locator(".cm-line", has_text="param width")
    line.click()
    preview.page.keyboard.press("Home")
    preview.page.keyboard.press("Shift+End")
    preview.page.keyboard.insert_text("    param width = 200mm in 100..240")
    preview.until_width(200)
    expect(unsaved).to_be_visible()
    assert preview.text == PLATE
    preview.page.keyboard.press("Control+s")
    expect(unsaved).to_be_hidden()
    wait(lambda: "200mm" in preview.text)
    preview.page.keyboard.press("Control+z")
    preview.until_width(160)
    expect(unsaved).to_be_visible()
    assert "200mm" in preview.text
    preview.page.keyboard.press("Control+s")
    wait(lambda: preview.text == PLATE)

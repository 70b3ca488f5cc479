"""Contact sheets, read back: the PDF and the PNG as pictures, the page in a browser."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pypdfium2
import pytest
from PIL import Image
from playwright.sync_api import Page, sync_playwright

from aidl_lang.tools.sweeping.sheet import fitted, in_one
from server.tests.preview.conftest import ARGUMENTS, CHROMIUM
from tests.sweep.here import PLATE, sweep

SIGN = PLATE.replace("param bored = true", 'param name = "Ada"').replace("if bored {", "if true {")
NAMES = ["</script><script>document.title = 'evil'</script>", "<b>bold</b>", "שלום", 'a"b', "two\nlines"]


def cell(text: str) -> str:
    return '"' + text.replace('"', '""') + '"'


def test_a_pdf_has_all_variants(tmp_path: Path) -> None:
    sweep(tmp_path, ["width=40..120/9", "style=*"], ["sheet.pdf"])
    document = pypdfium2.PdfDocument(tmp_path / "sheet.pdf")
    assert len(document) == 2
    text = "\n".join(document[k].get_textpage().get_text_bounded() for k in range(len(document)))
    assert text.count("plate.aidl: 18 variants, 4 failing") == 2
    assert text.count("style round") == 9
    assert text.count("assertion failed") == 4
    pictures = [
        each
        for k in range(len(document))
        for each in document[k].get_objects(filter=[pypdfium2.raw.FPDF_PAGEOBJ_IMAGE])
    ]
    assert len(pictures) == 18
    document.close()


def test_a_png_shows_the_drawings(tmp_path: Path) -> None:
    sweep(tmp_path, ["width=80,120", "style=square"], ["sheet.png"])
    with Image.open(tmp_path / "sheet.png") as image:
        pixels = image.convert("RGB")
    grid = in_one(2, 40.0)
    scale = pixels.width / grid.size[0]
    assert pixels.size == tuple(round(side * scale) for side in grid.size)

    def at(x: float, y: float) -> tuple[int, ...]:
        return pixels.getpixel((round(x * scale), round(y * scale)))

    left, right = 12.0, 12.0 + 40 + 4
    middle = 12 + 10 + 20
    plate, bore = at(left + 12, middle), at(left + 20, middle)
    assert plate == at(right + 12, middle) != (255, 255, 255)
    assert bore == at(right + 20, middle) == (255, 255, 255)
    red = at(right, middle)
    assert red[0] > 150 > max(red[1:])


@pytest.fixture(scope="module")
def browser() -> Iterator[Page]:
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield chromium.new_page()
        chromium.close()


def test_a_page_has_its_knobs_as_filters(tmp_path: Path, browser: Page) -> None:
    said: list[str] = []
    browser.on("console", lambda message: said.append(message.text))
    browser.on("pageerror", lambda error: said.append(str(error)))
    browser.on("request", lambda request: said.extend([request.url] * request.url.startswith("http")))
    rows = [f"{40 + 6.5 * k},{('round', 'square')[k % 2]},{str(k % 4 < 2).lower()}\n" for k in range(13)]
    sweep(tmp_path, [], ["sheet.html"], table="width,style,bored\n" + "".join(rows))
    browser.goto((tmp_path / "sheet.html").as_uri())
    count = browser.locator("#count")
    assert count.inner_text() == "13 of 13 variants, 2 failing"
    assert browser.locator("article:visible").count() == 13
    browser.get_by_label("square").uncheck()
    assert count.inner_text() == "7 of 13 variants, 1 failing"
    browser.get_by_label("from").fill("86")
    assert count.inner_text() == "3 of 13 variants, 1 failing"
    browser.get_by_label("false").uncheck()
    browser.get_by_label("only what fails").check()
    assert browser.locator("article:visible").count() == 1
    assert "it fits the sheet" in browser.locator("article:visible .message").first.inner_text()
    browser.get_by_text("all of it").locator("visible=true").first.click()
    assert browser.locator("article:visible dt").first.inner_text() == "n"
    assert browser.evaluate("document.querySelector('article:not([hidden]) img').naturalWidth") == 320
    assert said == []


def test_a_page_shows_hostile_names_as_text(tmp_path: Path, browser: Page) -> None:
    table = "name\n" + "".join(f"{cell(name)}\n" for name in NAMES)
    sweep(tmp_path, ["style=square"], ["sheet.html"], text=SIGN, table=table)
    browser.goto((tmp_path / "sheet.html").as_uri())
    assert browser.title() == "plate.aidl"
    assert browser.locator("b").count() == 0
    shown = browser.eval_on_selector_all("article bdi", "all => all.map(each => each.textContent)")
    assert shown[::2] == NAMES


class Typewriter:
    def length(self, text: str, size: float) -> float:
        return len(text) * size


@pytest.mark.parametrize(("text", "kept"), [("abc", "abc"), ("abcdefgh", "abcd…"), ("", "")])
def test_texts_are_cut_to_a_width(text: str, kept: str) -> None:
    assert fitted(Typewriter(), text, 1.0, 5.0) == kept  # type: ignore[arg-type]

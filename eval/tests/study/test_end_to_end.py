"""A study as people have it: a real process, a real browser, three raters; then the report."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import combinations
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from aidl_lang.tools.cli import main
from eval.tests.study import results
from eval.tests.study.results import LANGUAGES, PROMPTS
from tests.documents import ROOT

PATIENCE = 30.0
Taste = Callable[[str], dict[str, int] | None]
"""How good a rater finds each language for a prompt, 0 the best; None: cannot tell."""


@contextmanager
def serving(folder: Path) -> Iterator[str]:
    command = [sys.executable, "-m", "aidl_lang", "eval", "study", str(folder), "--no-open"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, cwd=ROOT) as process:
        try:
            assert process.stderr is not None
            found = re.search(r"http://[^\s,]+", process.stderr.readline())
            assert found is not None
            yield found[0]
            process.send_signal(signal.SIGINT)
            assert process.wait(PATIENCE) == 130
            assert process.stderr.read() == ""
        finally:
            process.kill()


@contextmanager
def opened(browser: Browser, url: str) -> Iterator[Page]:
    page = browser.new_page(viewport={"width": 1280, "height": 800})
    page.set_default_timeout(PATIENCE * 1000)
    complaints: list[str] = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("console", lambda m: complaints.append(m.text) if m.type in ("error", "warning") else None)
    page.goto(url)
    yield page
    page.close()
    assert complaints == []


def begin(page: Page, rater: str) -> None:
    page.get_by_label("Your name or number").fill(rater)
    page.keyboard.press("Enter")
    expect(page.locator("#rater")).to_have_text(rater.lower())


def languages(page: Page) -> list[str]:
    """What the pictures are of, in the order on the screen: their widths tell it to tests alone."""
    widths = page.eval_on_selector_all(
        ".card img", "all => Promise.all(all.map(async one => (await one.decode(), one.naturalWidth)))"
    )
    by_width = {results.width_of(name): name for name in LANGUAGES}
    return [by_width[width] for width in widths]


def rank(page: Page, taste: Taste) -> None:
    """One sheet, by keys."""
    number, asked = page.locator("#count").inner_text(), page.locator("#asked").inner_text()
    liked, names = taste(asked), languages(page)
    if liked is None:
        page.keyboard.press("s")
    else:
        order = sorted(names, key=liked.__getitem__)
        for before, name in zip([None, *order], order, strict=False):
            if before is not None and liked[before] == liked[name]:
                page.keyboard.press("=")
            page.keyboard.press(str(names.index(name) + 1))
        page.keyboard.press("Enter")
    is_next = "number => !rank.checkVisibility() || count.textContent !== number"
    page.wait_for_function(is_next, arg=number)


def north(prompt: str) -> dict[str, int]:
    return {"full": 0, "openscad": 1, "svg": 2}


def south(prompt: str) -> dict[str, int] | None:
    return None if prompt == "old key" else {"full": 0, "openscad": 0, "svg": 1}


def west(prompt: str) -> dict[str, int]:
    return {"full": 1, "openscad": 0, "svg": 2} if prompt < "p" else {"full": 2, "openscad": 1, "svg": 0}


RATERS: dict[str, Taste] = {"north": north, "south": south, "west": west}
STATES = {("tall mug", "svg", 1): "none"}
RANKS = {
    "full": [*[1] * 4, *[1.5] * 3, 2, 2, 2, 3],
    "openscad": [*[2] * 4, *[1.5] * 3, 1, 1, 1, 2],
    "svg": [*[3] * 4, *[3] * 3, 3, 3, 3, 1],
}
"""By north, south and west, for the prompts in turn; who drew nothing is behind all."""


def test_three_raters_and_the_report(
    browser: Browser, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    results.write(tmp_path, states=STATES)
    with serving(tmp_path) as url:
        with opened(browser, url) as page:
            begin(page, "north")
            for _number in PROMPTS:
                rank(page, north)
            expect(page.locator("#all")).to_have_text("That was all: 4 answers are kept.")
            page.get_by_role("button", name="Someone else").click()
            begin(page, "south")
            rank(page, south)
            rank(page, south)
        assert [line["rater"] for line in results.lines(tmp_path)] == ["north"] * 4 + ["south"] * 2
        late = browser.new_page()
        late.goto(url)
        late.locator("#name").fill("=no name")
        late.keyboard.press("Enter")
        expect(late.get_by_role("alert")).to_contain_text("1 to 40 letters or digits")
        begin(late, "late")
    for key in ("1", "2", "3", "Enter"):
        late.keyboard.press(key)
    expect(late.get_by_role("alert")).to_contain_text("This was not kept")
    expect(late.locator("#order")).to_contain_text("1 > 2")
    late.close()
    # south stopped in the middle, and so did the study
    with serving(tmp_path) as url, opened(browser, url) as page:
        begin(page, "South")
        expect(page.locator("#count")).to_have_text("3 of 4")
        rank(page, south)
        page.reload()
        expect(page.locator("#count")).to_have_text("4 of 4")
        rank(page, south)
        page.get_by_role("button", name="Someone else").click()
        begin(page, "west")
        for _number in PROMPTS:
            rank(page, west)
        expect(page.locator("#all")).to_be_visible()
    assert len(results.lines(tmp_path)) == 12

    assert main(["eval", "--report", "--out", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    found = results.figures(tmp_path)
    whole = {line["figure"]: line["value"] for line in found if not line["variant"]}
    assert (whole["raters"], whole["judgements"], whole["skipped"]) == (3, 11, 1)
    assert whole["alpha"] == pytest.approx(0.191097508591065)  # pair by pair, by the definition
    lines = [line for line in found if line["figure"] == "rank"]
    for name, ranks in RANKS.items():
        (own,) = (line for line in lines if line["variant"] == name and not line["against"])
        assert own["value"] == pytest.approx(sum(ranks) / 11)
        assert own["count"] == 11
        assert own["low"] <= own["value"] <= own["high"]
        assert f"{own['value']:.2f} ± " in out
    pairs = [(line["variant"], line["against"]) for line in lines if line["against"]]
    assert pairs == list(combinations(LANGUAGES, 2))
    assert "3 raters and 11 judgements; 1 time a rater could not tell. Their agreement" in out
    assert f"Krippendorff's alpha of ranks: {whole['alpha']:.3f}." in out
    assert (tmp_path / "evaluation.md").read_text("utf-8") == out


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with serving(results.write(tmp_path_factory.mktemp("study")).folder) as url:
        yield url


def test_undo_alike_and_back(browser: Browser, url: str) -> None:
    with opened(browser, url) as page:
        begin(page, "undoing")
        order, forward = page.locator("#order"), page.locator("#next")
        page.keyboard.press("Enter")  # nothing is chosen yet
        for key, shown in (
            *(("2", "2 > …"), ("=", "2 = …"), ("Backspace", "2 > …"), ("=", "2 = …"), ("3", "2 = 3 > …")),
            *(("9", "2 = 3 > …"), ("1", "2 = 3 > 1"), ("Backspace", "2 = 3 > …"), ("Backspace", "2 > …")),
            *(("2", "Choose from best to worst."), ("3", "3 > …"), ("1", "3 > 1 > …")),
        ):
            page.keyboard.press(key)
            expect(order).to_have_text(shown)
        expect(forward).to_be_disabled()
        page.keyboard.press("2")
        expect(forward).to_be_enabled()
        page.keyboard.press("Enter")
        expect(page.locator("#count")).to_have_text("2 of 4")
        page.keyboard.press("b")
        expect(page.locator("#count")).to_have_text("1 of 4")
        expect(order).to_have_text("3 > 1 > 2")
        page.keyboard.press("Enter")
        expect(page.locator("#count")).to_have_text("2 of 4")
        page.keyboard.press("s")
        expect(page.locator("#count")).to_have_text("3 of 4")
        page.keyboard.press("ArrowLeft")
        expect(order).to_have_text("You could not tell.")


def test_mouse_and_names_for_readers(browser: Browser, url: str) -> None:
    with opened(browser, url) as page:
        begin(page, "clicking")
        expect(page.get_by_role("heading", level=1)).to_be_focused()
        drawings = page.get_by_role("group", name="Drawings, to be chosen from best to worst")
        assert drawings.get_by_role("button").count() == 3
        drawings.get_by_role("button", name="Drawing 2, no place yet").click()
        expect(drawings.get_by_role("button", name="Drawing 2, place 1")).to_have_attribute(
            "aria-pressed", "true"
        )
        page.get_by_role("button", name="As good as the last").click()
        drawings.get_by_role("button", name="Drawing 1, no place yet").click()
        expect(drawings.get_by_role("button", name="Drawing 1, place 1")).to_be_visible()
        drawings.get_by_role("button", name="Drawing 3").click()
        expect(drawings.get_by_role("button", name="Drawing 3, place 3")).to_be_focused()
        page.keyboard.press("Space")  # on a drawing it takes its place away
        expect(drawings.get_by_role("button", name="Drawing 3, no place yet")).to_be_visible()
        drawings.get_by_role("button", name="Drawing 3").click()
        page.keyboard.press("Enter")  # and this goes on
        expect(page.locator("#count")).to_have_text("2 of 4")
        expect(page.get_by_role("progressbar", name="Prompts that are done")).to_have_attribute("value", "1")
        page.get_by_role("button", name="Back").click()
        expect(page.locator("#order")).to_have_text("2 = 1 > 3")


def test_touch_on_a_small_screen(browser: Browser, url: str) -> None:
    context = browser.new_context(viewport={"width": 390, "height": 800}, has_touch=True, is_mobile=True)
    page = context.new_page()
    page.goto(url)
    page.locator("#name").fill("touching")
    page.locator("#begin button").tap()
    for number in (3, 1, 2):
        page.locator(".card").nth(number - 1).tap()
    page.locator("#next").tap()
    expect(page.locator("#count")).to_have_text("2 of 4")
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    context.close()

"""The extension in VS Code itself."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.editors.vscode.conftest import FOLDER

if not FOLDER:
    pytest.skip("AIDL_CODE_SERVER does not name a folder with VS Code", allow_module_level=True)

from playwright.sync_api import expect

from tests.editors.vscode.window import PATIENCE

TELEPHONE = (Path(__file__).parents[3] / "examples" / "telephone.aidl").read_text()
PLATE = """\
solid plate {
    param width = 80mm in 40..200
    body = rectangle(center: origin, width: width, height: 40)
    hole left {
        rim = circle(center: (-20, 0), radius: 6)
    }
}
"""


def number(text: str) -> float:
    (found,) = re.findall(r"param width = ([\d.]+)", text)
    return float(found)


def test_the_text_is_coloured(window):
    window.open("colours.aidl", TELEPHONE)

    def colour(word: str) -> str:
        token = window.editor.locator(".view-line span span", has_text=re.compile(rf"^\s*{word}\s*$")).first
        return token.evaluate("token => getComputedStyle(token).color")

    colours = [colour(each) for each in ("solid", "0", '"crimson"', "rectangle", "left_ear")]
    assert len(set(colours)) == len(colours)


def test_how_solving_went_is_in_the_status_bar_and_what_is_wrong_in_the_text(window):
    window.open("wrong.aidl", PLATE)
    expect(window.status).to_contain_text("Solved", timeout=PATIENCE)
    window.caret(3, 5)
    window.page.keyboard.type("§ ")
    expect(window.status).to_contain_text("Not drawn", timeout=PATIENCE)
    expect(window.editor.locator(".squiggly-error").first).to_be_attached(timeout=PATIENCE)
    window.page.keyboard.press("Control+Z")
    window.page.keyboard.press("Control+Z")
    expect(window.status).to_contain_text("Solved", timeout=PATIENCE)
    expect(window.editor.locator(".squiggly-error")).to_have_count(0, timeout=PATIENCE)


def test_hovering_tells_the_solved_value(window):
    window.open("hover.aidl", PLATE.replace("radius: 6", "radius: guess(6)"))
    expect(window.status).to_contain_text("Solved", timeout=PATIENCE)
    # Lines move down under the pointer where a lens comes above them.
    lens = window.editor.locator(".codelens-decoration", has_text="try the ends").first
    expect(lens).to_be_visible(timeout=PATIENCE)
    window.editor.locator(".view-line span span", has_text="width").first.hover()
    expect(window.page.locator(".monaco-hover:visible .hover-contents").first).to_contain_text(
        "80 mm", timeout=PATIENCE
    )


def test_completion_knows_what_follows_a_dot(window):
    window.open("completion.aidl", PLATE.replace("\n}\n", "\n\n    constrain { body. }\n}\n"))
    window.caret(8, 22)
    window.run("Trigger Suggest")
    expect(window.page.locator(".suggest-widget .monaco-list-row").first).to_be_visible(timeout=PATIENCE)
    window.page.keyboard.type("bottom_l")
    expect(window.page.locator(".suggest-widget .monaco-list-row").first).to_contain_text("bottom_left")
    window.page.keyboard.press("Escape")


def test_the_preview_draws_and_follows_the_text(window):
    window.open("follow.aidl", PLATE)
    pane = window.preview()
    expect(pane.locator("#status")).to_have_text("Solved", timeout=PATIENCE)
    expect(pane.locator("#status-size")).to_contain_text("80", timeout=PATIENCE)
    window.caret(2, 21)
    window.page.keyboard.press("Backspace")
    window.page.keyboard.press("Backspace")
    window.page.keyboard.type("120")
    expect(pane.locator("#status-size")).to_contain_text("120", timeout=PATIENCE)


def test_a_text_that_cannot_be_drawn_keeps_its_picture_marked_as_an_earlier_one(window):
    window.open("stale.aidl", PLATE)
    pane = window.preview()
    expect(pane.locator("#stale")).to_be_hidden()
    window.caret(3, 5)
    window.page.keyboard.type("} } (")
    expect(pane.locator("#stale")).to_be_visible(timeout=PATIENCE)
    expect(pane.locator("#world [data-element]").first).to_be_attached()


def test_a_slider_solves_while_it_moves_and_writes_when_it_is_let_go(window):
    window.open("slider.aidl", PLATE)
    pane = window.preview()
    size = pane.locator("#status-size").inner_text()
    slider = pane.locator("#knobs input[type=range]").first
    box = slider.bounding_box()
    middle = box["y"] + box["height"] / 2
    mouse = window.page.mouse
    mouse.move(box["x"] + box["width"] * 40 / 160, middle)
    mouse.down()
    mouse.move(box["x"] + box["width"] * 0.8, middle, steps=8)
    expect(pane.locator("#status-size")).not_to_have_text(size, timeout=PATIENCE)
    assert window.text() == PLATE
    mouse.up()
    expect(window.editor.locator(".view-lines")).not_to_contain_text("80mm", timeout=PATIENCE)
    written = number(window.text())
    assert 140 < written < 190
    assert window.text() == PLATE.replace("80mm", f"{written:g}mm")
    expect(slider).to_have_value(f"{written:g}")


def test_a_dragged_point_changes_the_text_and_undo_takes_it_back(window):
    window.open("drag.aidl", PLATE)
    pane = window.preview()
    pane.locator("#handles-toggle").click()
    guess = pane.locator(".handle.guess").first
    box = guess.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    mouse = window.page.mouse
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + 60, y, steps=6)
    mouse.up()
    expect(window.editor.locator(".view-lines")).not_to_contain_text("(-20, 0)", timeout=PATIENCE)
    (moved,) = re.findall(r"center: \((-?[\d.]+), (-?[\d.]+)\)", window.text())
    assert -20 < float(moved[0]) < 30
    assert float(moved[1]) == pytest.approx(0, abs=0.5)
    window.caret(1, 1)
    window.page.keyboard.press("Control+Z")
    expect(window.editor.locator(".view-lines")).to_contain_text("(-20, 0)", timeout=PATIENCE)
    assert window.text() == PLATE


def test_the_pointer_in_the_picture_marks_the_text(window):
    window.open("pointer.aidl", PLATE)
    pane = window.preview()
    marks = window.editor.locator(".view-overlays .cdr[class*=ced-]")
    before = marks.count()
    hit = pane.locator("#stage").bounding_box()
    window.page.mouse.move(hit["x"] + hit["width"] / 2 + 40, hit["y"] + hit["height"] / 2)
    expect(pane.locator(".mark.hover > *").first).to_be_attached(timeout=PATIENCE)
    expect(marks).not_to_have_count(before, timeout=PATIENCE)
    window.page.mouse.move(hit["x"] + 4, hit["y"] + 4)
    expect(marks).to_have_count(before, timeout=PATIENCE)


def test_the_caret_in_the_text_lights_up_the_picture(window):
    window.open("caret.aidl", PLATE)
    pane = window.preview()
    window.caret(5, 12)
    expect(pane.locator(".mark.reveal > *").first).to_be_attached(timeout=PATIENCE)
    window.caret(7, 2)
    expect(pane.locator(".mark.reveal > *")).to_have_count(0, timeout=PATIENCE)


def test_a_click_in_the_picture_goes_to_the_text(window):
    window.open("click.aidl", PLATE)
    pane = window.preview()
    window.caret(7, 1)
    stage = pane.locator("#stage").bounding_box()
    window.page.mouse.click(stage["x"] + stage["width"] / 2 + 40, stage["y"] + stage["height"] / 2)
    expect(window.page.locator("#status\\.editor\\.selection")).to_contain_text(
        re.compile("Ln [1-3],"), timeout=PATIENCE
    )


def test_export_saves_a_file(window):
    window.open("export.aidl", PLATE)
    pane = window.preview()
    pane.locator("#export-button").click()
    pane.locator("#export-menu").get_by_role("button", name="Save").click()
    expect(window.field).to_have_value(re.compile(r"export\.svg$"), timeout=PATIENCE)
    target = window.folder / "saved.svg"
    window.field.fill(str(target))
    window.field.press("Enter")
    expect(
        window.page.locator(".notification-list-item-message", has_text="Exported saved.svg")
    ).to_be_visible(timeout=PATIENCE)
    assert target.read_text().lstrip().startswith(("<?xml", "<svg"))
    window.run("Notifications: Clear All Notifications")


def test_a_preview_survives_a_reload_of_the_window(window):
    window.open("reload.aidl", PLATE)
    window.preview()
    with window.page.expect_navigation(timeout=PATIENCE):
        window.run("Developer: Reload Window")
    pane = window.pane
    expect(pane.locator("#world [data-element]").first).to_be_attached(timeout=PATIENCE)
    expect(pane.locator("#name")).to_have_text("reload.aidl")


def test_a_new_program_is_written_and_opened(window):
    window.run("AIDL: New Program from Template…")
    window.give(window.folder / "bracket.aidl", "part.aidl")
    expect(window.tab("bracket.aidl")).to_be_visible(timeout=PATIENCE)
    assert "solid bracket {" in (window.folder / "bracket.aidl").read_text()

"""The text in the pane, in Chromium: typed, told, saved, undone, and put together with what others write."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import expect

from server.tests.preview.pane.conftest import Pane, drawn
from server.tests.preview.pane.messages import OUTLINE, TEXT, URI, picture, place, problem, words

LINES = TEXT.split("\n")


@pytest.fixture
def pane(pane: Pane) -> Pane:
    """The pane with the text beside the drawing."""
    pane.writes()
    return pane


@pytest.fixture
def text(still: Pane) -> Pane:
    """The same for tests that type nothing."""
    still.writes()
    return still


def type_at_end(pane: Pane, line: int, text: str) -> None:
    pane.find(".cm-line").nth(line).click()
    pane.page.keyboard.press("End")
    pane.page.keyboard.type(text)


def typed(pane: Pane, count: int = 1) -> dict[str, Any]:
    return pane.host.hears("aidl/type", count)


def insertion(line: int, character: int, text: str) -> dict[str, Any]:
    at = {"line": line, "character": character}
    return {"start": at, "end": at, "text": text}


def of_one_version(pane: Pane, **changes: Any) -> None:
    """Tells of the text and its picture."""
    version = picture()["version"]
    pane.host.tell("aidl/text", words(version=version))
    pane.shows(version=version, **changes)


def test_undo_and_redo_by_buttons_and_keys(text: Pane) -> None:
    undo, redo = (text.page.get_by_role("button", name=name) for name in ("Undo", "Redo"))
    expect(undo).to_be_disabled()
    text.host.tell("aidl/text", words(None, undo="Set width", redo="Drag"))
    expect(undo).to_have_attribute("title", "Undo: Set width (Ctrl+Z)")
    expect(redo).to_have_attribute("title", "Redo: Drag (Ctrl+Y)")
    undo.click()
    redo.click()
    text.host.hears("aidl/redo")
    text.find("#stage").focus()
    for key in ("Control+z", "Control+Shift+z", "Control+y"):
        text.page.keyboard.press(key)
    text.host.hears("aidl/redo", 3)
    text.host.hears("aidl/undo", 2)
    slider = text.find("#knobs-list input[type=range]").first
    slider.focus()
    text.page.keyboard.press("Control+z")
    text.host.hears("aidl/undo", 3)
    text.find(".cm-content").focus()
    text.page.keyboard.press("Control+z")
    text.host.hears("aidl/undo", 4)
    text.host.refusal = "the file was changed elsewhere"
    undo.click()
    expect(text.find(".toast")).to_contain_text("the file was changed elsewhere")
    text.page.get_by_role("button", name="Close").click()


def test_a_file_that_others_changed_is_told_and_chosen(text: Pane) -> None:
    contested = text.find("#contested")
    expect(contested).to_be_hidden()
    text.host.tell("aidl/text", words(None, saved=False, contested=True))
    expect(contested).to_be_visible()
    text.page.get_by_role("button", name="Save mine over it").click()
    assert text.host.hears("aidl/save") == {"uri": URI, "anyway": True}
    text.page.get_by_role("button", name="Take the file").click()
    text.host.hears("aidl/takeFile")


def test_what_is_wrong_is_underlined(text: Pane) -> None:
    of_one_version(text, problems=[problem(range=place(1, 4, 9), message="no `such` thing")])
    wrong = text.find(".cm-lintRange-error")
    expect(wrong).to_have_text(LINES[1][4:9])
    wrong.hover()
    expect(text.find(".cm-diagnostic")).to_contain_text("no `such` thing")
    text.shows(problems=[])  # of a text that is not here yet
    expect(wrong).to_have_count(1)
    of_one_version(text, problems=[])
    expect(wrong).to_have_count(0)


def test_the_text_follows_the_pointer_and_back(text: Pane) -> None:
    expect(text.find(".cm-line")).to_have_text(LINES)
    text.move(20, 15)
    expect(text.find(".cm-line.marked")).to_have_text([LINES[5]])
    text.find(".cm-line").nth(3).click()
    assert text.outlined("selected") == [drawn(OUTLINE)]
    text.find(".cm-line").nth(6).click()
    expect(text.find(".mark.selected .line")).to_have_count(1)
    assert text.outlined("selected") == [drawn(3)]  # the innermost whose place has this line
    button = text.page.get_by_role("button", name="Text")
    button.click()
    expect(text.find("#source")).to_be_hidden()
    expect(text.find("#stage")).to_be_visible()
    button.click()


def test_what_is_typed_is_told_and_not_saved(pane: Pane) -> None:
    save = pane.page.get_by_role("button", name="Unsaved")
    expect(save).to_be_hidden()
    type_at_end(pane, 1, " // x")
    expect(save).to_be_visible()
    change = insertion(1, len(LINES[1]), " // x")
    assert typed(pane) == {"uri": URI, "version": 1, "changes": [change]}
    pane.host.answer("aidl/type", {"applied": True, "version": 2})
    pane.host.tell("aidl/text", words(None, version=2, saved=False, undo="Typing"))
    type_at_end(pane, 0, "y")
    assert typed(pane, 2) == {"uri": URI, "version": 2, "changes": [insertion(0, len(LINES[0]), "y")]}
    pane.host.answer("aidl/type", {"applied": True, "version": 3})
    pane.page.keyboard.press("Control+s")
    assert pane.host.hears("aidl/save") == {"uri": URI, "anyway": False}
    pane.host.tell("aidl/text", words(None, version=3, undo="Typing"))
    expect(save).to_be_hidden()


def test_what_is_typed_and_not_told_yet_goes_before_what_is_set(pane: Pane) -> None:
    type_at_end(pane, 0, "z")
    pane.page.keyboard.press("Control+z")
    typed(pane)
    assert pane.host.of("aidl/undo") == []
    pane.host.answer("aidl/type", {"applied": True, "version": 2})
    pane.host.hears("aidl/undo")
    asked = [m["method"] for m in pane.host.heard]
    assert asked.index("aidl/type") < asked.index("aidl/undo")


def test_what_others_write_is_put_together_with_what_is_typed(pane: Pane) -> None:
    type_at_end(pane, 1, " // mine")
    typed(pane)
    theirs = "// theirs\n" + TEXT
    pane.host.tell("aidl/text", words(theirs, version=7))
    pane.host.answer("aidl/type", {"applied": False, "reason": "the text has changed meanwhile"})
    again = typed(pane, 2)
    assert again == {"uri": URI, "version": 7, "changes": [insertion(2, len(LINES[1]), " // mine")]}
    expect(pane.find(".cm-line").first).to_have_text("// theirs")
    expect(pane.find(".cm-line").nth(2)).to_have_text(f"{LINES[1]} // mine")
    expect(pane.find(".toast")).to_have_count(0)


def test_what_cannot_be_taken_is_told_and_not_left_unasked(pane: Pane) -> None:
    type_at_end(pane, 0, "q")
    typed(pane)
    pane.host.answer("aidl/type", {"applied": False, "reason": "there is no room"})
    expect(pane.find(".toast")).to_contain_text("there is no room")
    expect(pane.page.get_by_role("button", name="Unsaved")).to_be_visible()
    pane.page.reload()
    assert pane.dialogs == ["beforeunload"]


def test_another_host_gets_what_the_first_did_not_save(pane: Pane) -> None:
    type_at_end(pane, 0, "w")
    typed(pane)
    pane.host.answer("aidl/type", {"applied": True, "version": 2})
    pane.host.tell("aidl/text", words(None, version=2, saved=False))
    pane.host.drop()
    pane.host.hears("aidl/preview", 2)
    pane.host.tell("aidl/text", words())
    assert typed(pane, 2) == {"uri": URI, "version": 1, "changes": [insertion(0, len(LINES[0]), "w")]}


def test_a_problem_leads_to_its_place_in_the_text_where_keys_are_letters(pane: Pane) -> None:
    of_one_version(pane, problems=[problem(range=place(3, 8, 15))])
    before = pane.at(0, 0), pane.scale
    pane.find("#problems-list").get_by_role("button", name="line 4").click()
    expect(pane.find(".cm-content")).to_be_focused()
    pane.page.keyboard.type("ft+0")
    change = typed(pane)["changes"][0]
    assert (change["start"], change["text"][0]) == ({"line": 3, "character": 8}, "f")
    assert (pane.at(0, 0), pane.scale) == before
    expect(pane.find("#source")).to_be_visible()
    for _ in range(2):  # a list of completions may be open
        pane.page.keyboard.press("Escape")
    expect(pane.find(".cm-content")).not_to_be_focused()


def test_enter_is_a_new_line_unless_something_offered_was_chosen(pane: Pane) -> None:
    offered, lines = pane.find(".cm-tooltip-autocomplete"), pane.find(".cm-line")
    for row, (line, opens) in enumerate([("r = rect", True), ("param b = 2m", True), ("param c = 2", False)]):
        type_at_end(pane, 1 + 2 * row, "\n")
        pane.page.keyboard.insert_text(line[:-1])
        pane.page.keyboard.type(line[-1])
        if opens:
            expect(offered).to_be_visible()
        else:
            pane.page.wait_for_timeout(300)
            expect(offered).to_be_hidden()
        pane.page.keyboard.press("Enter")
        pane.page.keyboard.type("x")
        expect(lines.nth(2 + 2 * row)).to_have_text(f"    {line}")
        expect(lines.nth(3 + 2 * row)).to_have_text("    x")
    pane.page.keyboard.insert_text("\nr = rectan")
    pane.page.keyboard.type("g")
    expect(offered).to_be_visible()
    pane.page.wait_for_timeout(100)  # a list that has just opened takes no keys
    pane.page.keyboard.press("ArrowDown")
    pane.page.keyboard.press("Enter")
    expect(lines.nth(8)).to_contain_text("rectangle(")

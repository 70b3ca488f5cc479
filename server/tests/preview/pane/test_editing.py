"""The preview pane in Chromium: sliders, fields, and points that are dragged."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Locator, expect

from server.tests.preview.pane.conftest import Pane
from server.tests.preview.pane.messages import RIM, URI, handle, knob, picture, where


def slider(pane: Pane) -> Locator:
    return pane.page.get_by_role("slider", name="width")


def field(pane: Pane, name: str = "width") -> Locator:
    return pane.page.get_by_role("textbox", name=name)


def along(pane: Pane, value: float, low: float = 60, high: float = 200) -> tuple[float, float]:
    """Where on the page the thumb is at a value; it is 14 pixels wide."""
    box = slider(pane).bounding_box()
    assert box is not None
    return box["x"] + 7 + (value - low) / (high - low) * (box["width"] - 14), box["y"] + box["height"] / 2


def tried(pane: Pane) -> list[tuple[Any, bool]]:
    """The values and places that were tried, and those that were written."""
    found = []
    for message in pane.host.heard:
        match message["method"], message["params"]:
            case "aidl/try", {"knobs": {"width": value}} | {"drag": {"to": value}}:
                found.append((value, False))
            case ("aidl/setKnob", {"value": value}) | ("aidl/drag", {"to": value}):
                found.append((value, True))
    return found


def pull(pane: Pane, *places: tuple[float, float], steps: int = 1) -> None:
    """Presses at the first place on the page, and moves over the others."""
    pane.page.mouse.move(*places[0])
    pane.page.mouse.down()
    for place in places[1:]:
        pane.page.mouse.move(*place, steps=steps)


# Fields


def test_what_is_typed_is_worked_out_by_the_host(still: Pane) -> None:
    for count, text in enumerate(["120", "1e9", "99,5", " 80+20 ", "12cm", "abc", "−7"], 1):
        field(still).fill(text)
        field(still).press("Enter")
        asked = {"uri": URI, "path": "width", "value": text.strip()}
        assert still.host.hears("aidl/setKnob", count) == asked
        still.shows(knobs=[knob(value=100 + count)])
        expect(field(still)).to_have_value(str(100 + count))


def test_why_a_number_is_refused_is_told_beside_it(still: Pane) -> None:
    still.host.refusal = "`width` cannot be `300`: that is outside its range 60..200 mm"
    field(still).fill("30cm")
    field(still).press("Enter")
    refusal = still.find(".knob .refusal")
    expect(refusal).to_have_text("width cannot be 300: that is outside its range 60..200 mm")
    expect(field(still)).to_have_value("30cm")
    expect(still.find(".toast")).to_have_count(0)
    still.shows()  # another picture of the same text
    expect(refusal).to_be_visible()
    field(still).press("Escape")
    expect(refusal).to_be_hidden()
    expect(field(still)).to_have_value("100")


def test_choices_truths_and_texts(still: Pane) -> None:
    still.shows(
        knobs=[
            knob(path="bolt", name="bolt", kind="choice", value="m4", choices=["m4", "m5"], unit=""),
            knob(path="size", name="size", kind="choice", value=4, choices=[4, 5, 6]),
            knob(path="a.feet", name="feet", kind="truth", value=False, unit=""),
            knob(path="label", name="label", kind="text", value="hello", unit=""),
        ]
    )
    still.page.get_by_label("bolt", exact=True).select_option("m5")
    still.page.get_by_label("size", exact=True).select_option("6 mm")
    still.page.get_by_role("switch", name="feet").check()
    field(still, "label").fill("it's")
    field(still, "label").press("Enter")
    still.host.wait(lambda: len([1 for _, final in tried(still) if final]) == 4)
    assert [value for value, final in tried(still) if final] == ["m5", 6, True, "it's"]
    assert [params["path"] for params in still.host.of("aidl/setKnob")] == ["bolt", "size", "a.feet", "label"]


def test_a_picture_keeps_the_focus_and_what_is_being_typed(still: Pane) -> None:
    field(still).fill("170")
    still.shows(knobs=[knob(value=110)])
    expect(field(still)).to_have_value("170")
    field(still).press("Escape")
    expect(field(still)).to_have_value("110")
    field(still).select_text()
    still.shows(knobs=[knob(value=150)])
    expect(field(still)).to_have_value("150")
    still.page.keyboard.type("180")  # over what was selected
    expect(field(still)).to_have_value("180")
    field(still).press("Escape")
    field(still).focus()
    still.shows(knobs=[knob(), knob(path="depth", name="depth")])
    still.shows(knobs=[knob(), knob(path="depth", name="depth", value=70)])
    expect(field(still, "depth")).to_have_value("70")
    field(still, "depth").focus()
    still.shows(knobs=[knob(), knob(path="depth", name="depth", value=80)])
    expect(field(still, "depth")).to_be_focused()


def test_the_places_where_the_kind_changes_are_marked_until_the_text_changes(still: Pane) -> None:
    button = still.page.get_by_role("button", name="Mark where the kind changes")
    marks = still.find("#knobs-list .turn")
    settled = still.page.evaluate("JSON.parse(document.body.dataset.shown)[1]")
    button.click()
    expect(button).to_be_disabled()
    fixes = [{"title": "let the range of `width` end at 149mm"}]
    turns = [{"value": 150, "message": "at `width = 150mm` it breaks", "fixes": fixes}]
    answer = {"summary": "1 param walked", "walked": [{"param": "width", "turns": turns}]}
    still.host.answer("aidl/ranges", answer)
    expect(marks).to_have_count(1)
    expect(marks).to_have_attribute(
        "title", "at width = 150mm it breaks\nlet the range of width end at 149mm"
    )
    expect(still.find("#walked")).to_have_text("1 param walked")
    assert still.middle("#knobs-list .turn")[0] == pytest.approx(along(still, 150)[0], abs=1)
    still.shows(tried=True, version=settled, knobs=[knob(value=120)])
    expect(marks).to_have_count(1)
    still.shows()
    expect(marks).to_have_count(0)
    expect(still.find("#walked")).to_be_hidden()
    button.click()
    still.shows()
    still.host.answer("aidl/ranges", answer)
    expect(button).to_be_enabled()
    expect(marks).to_have_count(0)  # they are of a text before
    button.click()
    still.host.answer("aidl/ranges", error="the text has changed", code=-32801)
    expect(button).to_be_enabled()
    expect(still.find(".toast")).to_have_count(0)
    still.shows(knobs=[knob(low=None, high=None)])
    expect(button).to_be_hidden()


def test_points_appear_when_their_element_is_pointed_at(still: Pane) -> None:
    dot = still.find(".handle")
    expect(dot).to_be_hidden()
    still.move(-40, 10)
    expect(dot).to_be_visible()
    still.move(20, 5)  # on the point itself
    expect(dot).to_be_visible()
    assert still.host.hears("aidl/hover", 2)["place"] == where(RIM)
    still.move(-54, 0)
    expect(dot).to_be_hidden()
    still.page.get_by_role("button", name="Points", exact=True).click()
    expect(dot).to_be_visible()
    still.page.keyboard.press("p")
    expect(dot).to_be_hidden()


# Sliders


def test_a_slider_asks_for_one_thing_at_a_time_and_next_for_the_newest(still: Pane) -> None:
    pull(still, *(along(still, value) for value in (100, 110, 120, 130, 140)), steps=3)
    (first, final), *others = tried(still)
    assert not others
    assert not final
    assert 100 < first < 112
    expect(field(still)).to_have_value("140")

    still.shows(tried=True, knobs=[knob(value=first)], box=[-60, -30, 60, 30])
    expect(field(still)).to_have_value("140")
    expect(still.find("#status")).to_contain_text("tried")
    expect(still.find("#status-size")).to_have_text("120 × 60 mm")
    still.host.hears("aidl/try", 2)
    assert tried(still)[1] == (140, False)
    still.page.mouse.move(*along(still, 150))
    assert len(tried(still)) == 2

    still.page.mouse.up()
    still.host.hears("aidl/setKnob")
    assert tried(still)[2:] == [(150, True)]
    still.shows(knobs=[knob(value=150)])
    expect(field(still)).to_have_value("150")
    expect(still.find("#status")).to_have_text("Solved")


def test_a_late_answer_to_what_was_tried_is_not_shown(still: Pane) -> None:
    pull(still, along(still, 100), along(still, 120))
    still.page.mouse.up()
    still.host.wait(lambda: (120, True) in tried(still))
    still.host.answer("aidl/try", picture(tried=True, degrees=77))
    still.shows(knobs=[knob(value=120)])
    expect(still.find("#status-freedom")).to_have_text("2 degrees of freedom")


def test_a_slider_ends_at_the_bounds(still: Pane) -> None:
    for start, past, bound in ((100, 400, 200), (200, -100, 60)):
        pull(still, along(still, start), along(still, past))
        still.page.mouse.up()
        still.host.wait(lambda bound=bound: (bound, True) in tried(still))
        still.shows(knobs=[knob(value=bound)])
    assert all(60 <= value <= 200 for value, _ in tried(still))


def test_a_slider_by_keys_writes_when_the_key_is_let_go(still: Pane) -> None:
    slider(still).focus()
    still.page.keyboard.down("ArrowRight")
    still.page.keyboard.down("ArrowRight")
    still.host.hears("aidl/try")
    assert not any(final for _, final in tried(still))
    still.page.keyboard.up("ArrowRight")
    still.host.wait(lambda: (101, True) in tried(still))  # two steps of half a millimetre
    still.shows(knobs=[knob(value=101)])
    still.page.keyboard.press("End")
    still.host.wait(lambda: (200, True) in tried(still))


def test_what_is_wrong_is_looked_into_when_the_slider_rests(still: Pane) -> None:
    pull(still, along(still, 100), along(still, 150))
    assert "rests" not in still.host.hears("aidl/try")
    still.shows(tried=True, status="partial")
    assert still.host.hears("aidl/try", 2)["rests"] is True
    still.page.mouse.up()


@pytest.mark.parametrize("changes", [{"editable": False}, {"range": None, "uri": None}])
def test_what_is_not_in_the_text_can_only_be_tried(still: Pane, changes: dict[str, Any]) -> None:
    still.shows(knobs=[knob(**changes), knob(path="depth", name="depth")])
    reset = still.page.get_by_role("button", name="Reset width")
    expect(reset).to_be_hidden()
    pull(still, along(still, 100), along(still, 150))
    still.page.mouse.up()
    still.host.hears("aidl/try")
    still.shows(tried=True, knobs=[knob(value=150, **changes), knob(path="depth", name="depth")], degrees=9)
    expect(reset).to_be_visible()
    assert tried(still) == [(150, False)]
    reset.click()
    expect(field(still)).to_have_value("100")
    expect(still.find("#status-freedom")).to_have_text("2 degrees of freedom")


# Points


def grab(pane: Pane, x: float, y: float) -> None:
    """Takes hold of a handle that is there."""
    pane.page.get_by_role("button", name="Points", exact=True).click()
    pull(pane, pane.at(x, y))


def test_a_dragged_point_tells_millimetres(still: Pane) -> None:
    grab(still, 20, 5)
    still.move(22.2, 7.3, steps=2)
    still.move(30.4, -4.8, steps=2)
    expect(still.find("#tooltip")).to_contain_text("30.0, −5.0 mm" if still.scale < 8 else "30.5, −5.0 mm")
    still.page.mouse.up()
    still.host.wait(lambda: any(final for _, final in tried(still)))
    assert [final for _, final in tried(still)] == [False, True]
    assert still.scale < 8
    assert tried(still)[-1] == ([30, -5], True)
    assert still.host.of("aidl/drag")[-1]["id"] == "h0"
    assert still.host.of("aidl/goto") == []
    assert still.middle(".handle .knot") == pytest.approx(still.at(30, -5), abs=0.6)


def test_a_point_is_dragged_at_once_after_another_was_chosen(still: Pane) -> None:
    still.shows(handles=[handle(), handle(id="h1", at=[-20, 5])])
    grab(still, 20, 5)
    still.page.mouse.up()
    pull(still, still.at(-20, 5), still.at(-25, 8), steps=3)
    still.page.mouse.up()
    still.host.wait(lambda: any(final for _, final in tried(still)))
    assert tried(still)[-1] == ([-25, 8], True)
    assert still.host.of("aidl/drag")[-1]["id"] == "h1"


def test_params_that_a_drag_changes_are_shown(still: Pane) -> None:
    x, y = still.middle(".handle")
    still.page.get_by_role("button", name="Points").click()
    pull(still, (x, y), (x + 40, y), steps=3)
    still.host.hears("aidl/try")
    still.shows(tried=True, knobs=[knob(value=117)])
    expect(field(still)).to_have_value("117")
    still.page.keyboard.press("Escape")
    expect(field(still)).to_have_value("100")
    still.page.mouse.up()


def test_escape_while_dragging_forgets_it(still: Pane) -> None:
    grab(still, 20, 5)
    still.move(30, 5, steps=2)
    still.host.hears("aidl/try")
    still.page.keyboard.press("Escape")
    still.host.answer("aidl/try", picture(tried=True, degrees=77))
    still.move(35, 5)
    still.page.mouse.up()
    expect(still.find(".handle.dragged")).to_have_count(0)
    expect(still.find("#status-freedom")).to_have_text("2 degrees of freedom")
    assert all(not final for _, final in tried(still))


def test_a_point_moves_by_keys(pane: Pane) -> None:
    pane.page.get_by_role("button", name="Points", exact=True).click()
    view = pane.at(0, 0)
    pane.page.get_by_role("button", name="Drag: center of rim").focus()
    pane.page.keyboard.down("ArrowUp")
    pane.page.keyboard.down("ArrowUp")
    pane.page.keyboard.up("ArrowUp")
    pane.host.wait(lambda: tried(pane)[-1:] == [([20, 7], True)])
    assert pane.at(0, 0) == view

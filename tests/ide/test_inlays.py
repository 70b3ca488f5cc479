from __future__ import annotations

from pathlib import Path

import pytest

from aidl_lang.tools.ide.lenses import inlays
from aidl_lang.tools.ide.workspace import applied, look, run
from tests.ide.conftest import opened, seen

MOVED = """drawing d {
    c = circle(center: (1, 2), radius: guess(5cm))
    constrain {
        c.center == (1, 8)
        c.radius == 70
    }
}
"""


def shown(text: str, **files: str) -> list[tuple[str, str]]:
    """The text before each hint, and the hint."""
    return [(text[: i.offset][-4:], i.text) for i in inlays(seen(text, solved=True, **files))]


def test_what_was_solved_to_something_else_says_so() -> None:
    assert shown(MOVED) == [("1, 2", "→ 8 mm"), ("(5cm", "→ 7 cm")]


def test_the_edit_writes_the_value() -> None:
    view = seen(MOVED, solved=True)
    text = applied(view.source.text, [edit for hint in inlays(view) for edit in hint.edits])
    assert "center: (1, 8), radius: guess(7cm)" in text
    assert inlays(seen(text, solved=True)) == []


def test_a_kept_size_that_changed_says_so_in_words() -> None:
    view = seen("drawing d { c = circle(center: (1, 2), radius: 3)\n constrain c.radius == 4 }", solved=True)
    (hint,) = inlays(view)
    assert (hint.text, hint.is_reading) == ("→ 4 mm", False)
    assert "a size that had to change, written as 3 and solved to 4" in hint.tooltip


def test_the_reading_of_an_ambiguous_call_is_told() -> None:
    text = (
        "drawing d { a = circle(center: (0, 0), radius: 5)\n b = circle(center: (11, 0), radius: 4)\n"
        " constrain tangent(a, b) }"
    )
    view = seen(text, solved=True)
    assert view.outcome is not None
    assert view.outcome.model is not None
    told = [i for i in inlays(view) if i.is_reading]
    assert [i.text for i in told] == [r.text for r in view.outcome.model.readings]
    assert told
    assert all(text[: i.offset].endswith("tangent(a, b)") for i in told)


@pytest.mark.parametrize(("params", "hints"), [({"w": 25.0}, ["→ 25 mm"]), ({"w": 20.0}, []), ({}, [])])
def test_a_param_set_from_outside_is_told(params: dict[str, float], hints: list[str]) -> None:
    text = "solid s { param w = 2cm\n r = rectangle(width: w, height: w) }"
    project = opened({"part.aidl": text})
    path = Path("/project/part.aidl")
    view = run(look(path, text, project.workspace.world(path)), params=params)
    found = inlays(view)
    assert [i.text for i in found] == hints
    assert all(text[: i.offset].endswith("2cm") for i in found)


def test_a_picture_of_another_text_tells_nothing_of_this_one() -> None:
    first = seen(MOVED, solved=True)
    broken = look(first.path, MOVED.replace("radius:", "radius"), first.world)
    assert inlays(run(broken, first)) == []
    assert inlays(broken) == []

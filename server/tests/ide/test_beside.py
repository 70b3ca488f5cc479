"""What stands beside a text: hints, lenses above structures and params, colour pickers."""

from __future__ import annotations

from pathlib import Path

import pytest

from aidl_lang.common.diagnostics import Edit
from aidl_server.ide.lenses import can_be_tried, end_lenses, inlays, lenses, tried
from aidl_server.ide.outline import colors, spellings
from aidl_server.ide.workspace import SETTINGS, View, applied, look, run
from server.tests.ide.conftest import opened, seen, solved_at

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


COLORED = """\
@color("crimson") solid a { c = circle(center: origin, radius: 9) }
@color(navy) solid b { c = circle(center: origin, radius: 8) }
@colour(255, 128, 0) solid c { c = circle(center: origin, radius: 7) }
@color("#0f0") solid d { c = circle(center: origin, radius: 6) }
@color("nonesuch") solid e { c = circle(center: origin, radius: 5) }
@note("red") solid f { c = circle(center: origin, radius: 4) }
"""


def test_colours_are_read_as_they_are_drawn() -> None:
    found = [(span.text, rgb) for span, rgb in colors(seen(COLORED))]
    assert found == [
        ('"crimson"', (220, 20, 60)),
        ("navy", (0, 0, 128)),
        ("255, 128, 0", (255, 128, 0)),
        ('"#0f0"', (0, 255, 0)),
    ]


@pytest.mark.parametrize("wanted", [(1, 2, 3), (255, 0, 0), (0, 0, 0)])
def test_whatever_is_picked_is_what_is_drawn(wanted: tuple[int, int, int]) -> None:
    view = seen(COLORED)
    for number, (span, _) in enumerate(colors(view)):
        for spelling in spellings(view, span, tuple(part / 255 for part in wanted)):
            text = applied(view.source.text, [Edit(span, spelling)])
            assert colors(seen(text))[number][1] == wanted


def titles(text: str) -> list[tuple[str, str]]:
    return [(span.text, title) for span, title in lenses(seen(text, solved=True))]


def test_a_structure_says_what_in_it_can_move() -> None:
    text = """\
assembly a {
    solid plate { body = rectangle(center: fixed((0, 0)), width: 40, height: 20) }
    solid knob {
        body = circle(center: (0, 30), radius: 4)
        eye = circle(center: (0, 30), radius: 1)
        constrain eye.center.y == body.center.y
    }
    for i in 0..1 { hole h[i] { c = circle(center: fixed((20 * i - 10, 0)), radius: 3) } }
    constrain knob.body.center.y == 30
}
"""
    assert titles(text) == [
        (
            "a",
            "solved, 2 degrees of freedom · 1 constraint · "
            "knob.body can slide along x, knob.eye can slide along x",
        ),
        ("plate", "fully constrained"),
        ("knob", "1 constraint · body can slide along x, eye can slide along x"),
        ("h", "2 times · fully constrained"),
    ]


def test_constraints_that_do_not_hold_are_counted() -> None:
    text = (
        "solid a {\n c = circle(center: origin, radius: 4)\n constrain { c.radius == 5, c.radius == 6 }\n}\n"
    )
    ((name, title),) = titles(text)
    assert name == "a"
    assert "not met" in title


def test_nothing_is_said_of_a_text_that_was_not_solved() -> None:
    assert lenses(seen("solid a { c = circle(center: origin, radius: 4) }")) == []
    assert titles("solid a { c = circle(radius: ) }") == []


def test_examples(example: View) -> None:
    view = solved_at(example.path)
    assert view.outcome is not None
    assert view.outcome.model is not None
    said = lenses(view)
    assert any(title.startswith("solved") for _, title in said)
    names = {span.text for span, _ in said}
    assert names <= {s.name.partition("[")[0] for s in view.outcome.model.root.walk()}


@pytest.mark.parametrize(
    "text",
    [
        "solid a { b = circle(center: origin, radius: 4) }",
        "solid a { param r = 3; b = circle(center: origin, radius: r) }",
        "solid a { param r = 3 in 1..5; b = circle(center: origin, radius: r); assert r > 4 }",
        "solid a { param r = 3 in 1..5; b = circle(center: origin, radius: ) }",
    ],
)
def test_there_may_be_nothing_to_try(text: str) -> None:
    view = seen(text, solved=True)
    assert not can_be_tried(view)
    assert end_lenses(view, None) == []
    with pytest.raises(ValueError, match="the program has to work as it is written"):
        tried(view, SETTINGS, lambda done, count: None, 60.0)

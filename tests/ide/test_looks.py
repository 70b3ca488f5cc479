"""Colour pickers, and what is said above structures."""

from __future__ import annotations

import pytest

from aidl_lang.common.diagnostics import Edit
from aidl_lang.tools.ide.lenses import lenses
from aidl_lang.tools.ide.outline import colors, spellings
from aidl_lang.tools.ide.workspace import View, applied

from .conftest import seen, solved_at

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
        for spelling in spellings(view, span, wanted):
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

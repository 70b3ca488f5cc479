from __future__ import annotations

import pytest

from aidl_lang.common.prose import shortest
from aidl_lang.syntax.tables import tokenize
from aidl_lang.tools.ide.guesses import can_write_back, guesses, write_back
from aidl_lang.tools.ide.lenses import inlays
from aidl_lang.tools.ide.references import CannotError
from aidl_lang.tools.ide.workspace import View, applied, look, run
from tests.compiled import EXAMPLES
from tests.ide.conftest import seen, solved_at
from tests.ide.test_guesses import curves, near

MOVED = """drawing d {
    c = circle(center: (1, 2), radius: guess(5))
    constrain {
        c.center == (1, 8)
        c.radius == 7
    }
}
"""


def rewritten(view: View, **options) -> str:
    found = write_back(view, **options)
    return applied(view.source.text, found)


def words_besides_numbers(text: str) -> list[str]:
    view = seen(text)
    words = [text[t.start : t.end] for t in tokenize(view.source).tokens]
    return [w for w in words if not w[:1].isdigit() and w != "-"]


def test_first_guesses_become_what_was_solved() -> None:
    assert rewritten(seen(MOVED, solved=True)) == MOVED.replace("2)", "8)").replace("guess(5)", "guess(7)")


def test_a_selection_is_left_to_itself() -> None:
    view = seen(MOVED, solved=True)
    start = MOVED.index("radius")
    assert rewritten(view, span=view.span(start, start + 16)) == MOVED.replace("guess(5)", "guess(7)")


def test_nothing_to_write_is_said() -> None:
    text = rewritten(seen(MOVED, solved=True))
    view = seen(text, solved=True)
    assert not can_write_back(view)
    for nothing in (view, seen(text)):
        with pytest.raises(CannotError, match="no first guess"):
            write_back(nothing)


def test_units_stay_as_they_are_written() -> None:
    text = "drawing d { c = circle(center: (1cm, 2in), radius: 5)\n constrain c.center == (25, 25.4) }"
    assert "center: (2.5cm, 1in)" in rewritten(seen(text, solved=True))


def test_changed_sizes_are_written_only_when_asked() -> None:
    text = (
        "drawing d { c = circle(center: (0, 2), radius: 5)\n constrain { c.radius == 7\n c.center.y == 3 } }"
    )
    view = seen(text, solved=True)
    assert rewritten(view) == text.replace("(0, 2)", "(0, 3)")
    assert rewritten(view, sizes=True) == text.replace("radius: 5", "radius: 7")


def test_a_line_that_had_to_change_is_moved_without_writing_its_length() -> None:
    text = "drawing d { l = line((0, 0), (40, 0))\n constrain { l.start == (5, 5)\n l.length == 60 } }"
    view = seen(text, solved=True)
    assert "line((5, 5), (45, 5))" in rewritten(view)
    both = seen(rewritten(view), solved=True)
    assert "line((5, 5), (65, 5))" in rewritten(both, sizes=True)


@pytest.mark.parametrize("name", ["telephone", "phone_stand", "lighthouse", "wrench", "handset"])
def test_examples_draw_the_same_and_have_nothing_left_to_tell(name: str) -> None:
    path = next(p for p in EXAMPLES if p.stem == name)
    view = solved_at(path)
    text = rewritten(view)
    again = run(look(path, text, view.world))
    assert again.outcome is not None
    assert again.outcome.status == "solved"
    assert near(curves(view), curves(again))
    kept = {g.path for g in guesses(again) if g.is_kept}
    assert [i for i in inlays(again) if not any(f"`{p}`" in i.tooltip for p in kept)] == []
    assert words_besides_numbers(text) == words_besides_numbers(view.source.text)


def test_a_program_that_would_draw_something_else_is_left_alone() -> None:
    text = "drawing d { let n = 3.2\n c = circle(center: (n, 0), radius: 1)\n constrain c.center.x == 9\n"
    text += " if written(c.center.x) < 5 { e = circle(center: fixed((0, 0)), radius: fixed(1)) } }"
    view = seen(text, solved=True)
    assert view.outcome is not None
    assert view.outcome.status == "solved"
    with pytest.raises(CannotError, match="would not draw the same"):
        write_back(view)


@pytest.mark.parametrize(
    ("value", "tolerance", "text"),
    [
        (52.3700000003, 1e-7, "52.37"),
        (52.37, 0.05, "52.4"),
        (-0.0001, 0.01, "0"),
        (1 / 3, 1e-6, "0.333333"),
        (1e18, 0.1, "1000000000000000000"),
        (1e-9, 0.0, "0.000000001"),
    ],
)
def test_numbers_are_as_short_as_they_may_be(value: float, tolerance: float, text: str) -> None:
    assert shortest(value, tolerance) == text

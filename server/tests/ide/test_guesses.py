"""First guesses with what they were solved to, and these written into the text."""

from __future__ import annotations

import math
from dataclasses import astuple
from pathlib import Path

import pytest

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.prose import shortest
from aidl_server.ide.guesses import Guess, can_write_back, guesses, write_back
from aidl_server.ide.lenses import inlays
from aidl_server.ide.references import CannotError
from aidl_server.ide.workspace import View, applied, look, run
from server.tests.ide.conftest import besides_numbers, seen, solved_at
from tests.amount import TRIES_ALL, some
from tests.compiled import EXAMPLES
from tests.documents import ROOT, Block, programs

EAR = """solid ear {
    param size = 12mm
    rim = circle(center: (3, -4), radius: 2cm)
    dot = circle(center: rim.center, radius: guess(5))
    pin = circle(center: fixed((1, 2)), radius: size)
    constrain { rim.center == (30, 4)
        dot.radius == 7 }
}
"""


def told(view: View) -> dict[str, Guess]:
    return {guess.path: guess for guess in guesses(view)}


def curves(view: View) -> dict[str, tuple[float, ...]]:
    """The ends and middle of every curve, by the path of its geometry: a comparison of its own."""
    assert view.outcome is not None
    if view.outcome.model is None:
        return {}
    found = {}
    for structure in view.outcome.model.root.walk():
        for geometry in structure.geometry:
            for part in geometry.walk():
                if part.curve is not None:
                    found[part.path] = tuple(_flat(astuple(part.curve)))
    return found


def _flat(value):
    if isinstance(value, (list, tuple)):
        for item in value:
            yield from _flat(item)
    elif isinstance(value, float):
        yield value


def near(a: dict[str, tuple[float, ...]], b: dict[str, tuple[float, ...]], tolerance: float = 1e-6) -> bool:
    return a.keys() == b.keys() and all(
        len(a[k]) == len(b[k])
        and all(math.isclose(x, y, abs_tol=tolerance) for x, y in zip(a[k], b[k], strict=True))
        for k in a
    )


def test_each_number_that_may_change_stands_beside_what_it_became() -> None:
    found = told(seen(EAR, solved=True))
    assert {path: (g.span.text, g.written, round(g.solved or math.nan, 9)) for path, g in found.items()} == {
        "ear.rim.center.x": ("3", 3.0, 30.0),
        "ear.rim.center.y": ("-4", -4.0, 4.0),
        "ear.rim.radius": ("2cm", 2.0, 2.0),
        "ear.dot.radius": ("5", 5.0, 7.0),
    }
    assert [path for path, g in found.items() if g.is_kept] == ["ear.rim.radius"]
    assert (found["ear.rim.radius"].unit, found["ear.rim.center.x"].unit) == ("cm", "")
    assert found["ear.rim.center.x"].measure == "mm"


def written_down(view: View) -> str:
    sole = [g for g in guesses(view) if not g.is_shared and g.solved is not None]
    edits = [Edit(g.span, f"{g.solved:.15f}{g.unit}") for g in sole]
    return applied(view.source.text, edits)


PAGES = ("exactness", "placement", "templates", "paths", "structures")
SHAPED_BY_WHAT_IS_WRITTEN = {
    "`guess` is free",  # of a reference: the other number is a guess for this one too
    "Closing",  # how many segments there are hangs on where the last point is written
    "Rectilinear outlines",  # which edges are level does
}
"""Of these programs another text is another program, whatever was solved."""


def _moved() -> list[Block]:
    found = (b for page in PAGES for b in programs(Path(ROOT, "tests/spec", f"{page}.md")))
    return some([b for b in found if not b.note and "constrain" in b.text], 6)


def test_the_corpus_draws_the_same_with_all_solved_numbers_written_down() -> None:
    tried = 0
    wrong = set()
    for block in _moved():
        view = seen(block.text, solved=True)
        text = written_down(view)
        if text == block.text:
            continue
        tried += 1
        again = seen(text, solved=True)
        left = [g for g in guesses(again) if not g.is_shared and g.is_off(g.solved)]
        if not near(curves(view), curves(again)) or left:
            wrong.add(block.heading)
    assert tried > (30 if TRIES_ALL else 5)
    assert wrong <= SHAPED_BY_WHAT_IS_WRITTEN


def test_places_are_right_after_astral_characters_and_other_line_ends() -> None:
    text = (
        "\ufeff// \U0001d518 😀\r\ndrawing d {\r\n\tc = circle(center: (1, /* 😀 */ 2), radius: 3)\r\n}\r\n"
    )
    view = seen(text, solved=True)
    assert [text[g.span.start : g.span.end] for g in guesses(view)] == ["1", "2", "3"]


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


@pytest.mark.parametrize("name", ["telephone", "wrench"])
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
    assert besides_numbers(text) == besides_numbers(view.source.text)


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

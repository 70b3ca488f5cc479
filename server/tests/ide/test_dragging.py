from __future__ import annotations

import math

import pytest

from aidl_lang.geometry.curves import Vec
from aidl_server.ide.dragging import Dragged, Handle, drag, handles
from aidl_server.ide.references import CannotError
from aidl_server.ide.workspace import View, applied, look, run
from server.tests.ide.conftest import besides_numbers, seen, solved_at
from tests.amount import TRIES_ALL
from tests.compiled import EXAMPLES

ROD = """drawing d {
    base = line(fixed((0, 0)), fixed((100, 0)))
    rod = line((20, 0), (20, 30))
    bob = circle(center: (20, 30), radius: 5)
    far = circle(center: (70, 60), radius: 4)
    constrain {
        coincident(rod.start, base)
        vertical(rod)
        bob.center == rod.end
    }
}
"""
PLATE = """solid plate {
    body = rectangle(center: (0, 0), width: 80, height: 40)
    hole bore at (10, 5) { rim = circle(center: origin, radius: 6) }
    constrain bore.bottom >= body.bottom + 2
}
"""
SHELF = """assembly shelf {
    param width = 120mm in 60..200 step 5
    solid board { body = rectangle(center: fixed((0, 0)), width: width, height: fixed(8)) }
}
"""


def handle(view: View, ending: str) -> Handle:
    return next(h for h in handles(view) if h.id.endswith(ending))


def dragged(view: View, ending: str, to: Vec, **options) -> Dragged:
    found = drag(view, handle(view, ending).id, to, **options)
    assert isinstance(found, Dragged), found
    return found


def dropped(view: View, found: Dragged) -> View:
    """The program as its text says after the drag, solved anew."""
    text = applied(view.source.text, found.edits)
    return run(look(view.path, text, view.world))


def geometry(view: View, path: str):
    assert view.outcome is not None
    assert view.outcome.model is not None
    assert view.outcome.status == "solved"
    parts = (p for s in view.outcome.model.root.walk() for g in s.geometry for p in g.walk())
    return next(part for part in parts if part.path == path)


# --- First guesses -------------------------------------------------------------------------------


def test_a_point_that_is_free_goes_where_it_is_dragged() -> None:
    view = seen(ROD, solved=True)
    found = dragged(view, "far.center", (60, 44.3))
    assert found.at == pytest.approx((60, 44.3), abs=1e-6)
    assert geometry(found.view, "d.far").values["center"] == pytest.approx((60, 44.3), abs=1e-6)
    again = dropped(view, found)
    assert again.source.text == ROD.replace("(70, 60)", "(60, 44.3)")
    assert geometry(again, "d.far").values["center"] == pytest.approx((60, 44.3), abs=1e-6)


def test_what_is_constrained_moves_along() -> None:
    view = seen(ROD, solved=True)
    found = dragged(view, "rod.start", (55, 0))
    assert geometry(found.view, "d.bob").values["center"] == pytest.approx((55, 30), abs=1e-6)
    again = dropped(view, found)
    assert geometry(again, "d.rod").values["start"] == pytest.approx((55, 0), abs=1e-3)
    assert geometry(again, "d.bob").values["center"] == pytest.approx((55, 30), abs=1e-3)
    assert geometry(again, "d.far").values["center"] == (70, 60)
    assert besides_numbers(again.source.text) == besides_numbers(ROD)


def test_a_point_goes_as_near_as_its_constraints_let_it() -> None:
    view = seen(ROD, solved=True)
    found = dragged(view, "rod.start", (40, 25))
    assert found.at == pytest.approx((40, 0), abs=1e-6)
    again = dropped(view, found)
    assert geometry(again, "d.rod").values["start"] == pytest.approx((40, 0), abs=1e-3)


def test_an_inequality_stops_a_point() -> None:
    text = PLATE.replace("(0, 0)", "fixed((0, 0))")
    view = seen(text, solved=True)
    found = dragged(view, "bore at", (-12, -300))
    x, y = found.at
    assert (x, y) == pytest.approx((-12, -12), abs=1e-5)
    again = dropped(view, found)
    assert geometry(again, "plate.bore.rim").values["center"] == pytest.approx((-12, -12), abs=0.2)
    assert besides_numbers(again.source.text) == besides_numbers(text)


def test_numbers_are_rounded_to_the_step() -> None:
    view = seen(ROD, solved=True)
    found = dragged(view, "far.center", (60.123, 44.377), step=0.5)
    assert applied(ROD, found.edits) == ROD.replace("(70, 60)", "(60, 44.4)")
    fine = dragged(view, "far.center", (60.123, 44.377), step=0.001)
    assert applied(ROD, fine.edits) == ROD.replace("(70, 60)", "(60.123, 44.377)")


def test_a_drawing_that_may_slide_is_moved_as_a_whole_by_its_middle() -> None:
    text = "solid s { r = rectangle(center: (0, 0), width: 80, height: 40) }"
    view = seen(text, solved=True)
    assert dropped(view, dragged(view, "r.center", (7, 3))).source.text == text.replace("(0, 0)", "(7, 3)")


def test_a_point_that_nothing_holds_elsewhere_is_not_offered() -> None:
    view = solved_at(next(path for path in EXAMPLES if path.stem == "bottle_opener"))
    whole = [h for h in handles(view) if h.hint.endswith("to move the drawing")]
    assert whole == []
    assert len(handles(view)) > 5


def test_a_count_turns_by_whole_steps() -> None:
    text = (
        "solid a { param n = 3 in 1..6 step 1\n param w = 50 in 20..90\n"
        "base = rectangle(bottom_left: fixed((0, 0)), width: w * n, height: 5) }"
    )
    view = seen(text, solved=True)
    found = dragged(view, "base.bottom_right", (203, 0))
    assert "n = 4 in" in dropped(view, found).source.text


# --- What is shown meanwhile -----------------------------------------------------------------


def test_asserts_and_contacts_are_those_of_what_is_shown() -> None:
    text = """assembly a {
        solid s at fixed((0, 0)) { r = square(center: origin, size: 10) }
        solid t at (30, 0) { r = square(center: origin, size: 10) }
        assert t.left >= s.right + 5, "too near"
    }"""
    view = seen(text, solved=True)
    assert view.outcome is not None
    codes = lambda of: {d.code for d in of.outcome.diagnostics}  # noqa: E731
    assert codes(view) == {"W0705"}
    near = dragged(view, "t.r.center", (10, 0))
    assert codes(near.view) == {"E0604"}  # they touch now
    assert codes(dragged(view, "t.r.center", (12, 0)).view) == {"E0604", "W0705"}
    far = dragged(view, "t.r.center", (40, 0))
    assert codes(far.view) == {"W0705"}
    assert codes(dropped(view, near)) == {"E0604"}  # what was seen is written


# --- Sizes ---------------------------------------------------------------------------------------


def test_a_corner_held_by_sizes_changes_them() -> None:
    view = seen(PLATE, solved=True)
    assert handle(view, "body.top_right").moves == "size"
    found = dragged(view, "body.top_right", (50, 26))
    assert found.at == pytest.approx((50, 26), abs=1e-6)
    again = dropped(view, found)
    assert "width: 100, height: 52" in again.source.text
    assert geometry(again, "plate.body.top_right").values["at"] == pytest.approx((50, 26), abs=0.2)
    assert besides_numbers(again.source.text) == besides_numbers(PLATE)


# --- Params --------------------------------------------------------------------------------------


@pytest.mark.parametrize(("x", "width"), [(900.0, "200mm"), (-900.0, "60mm")])
def test_a_param_stays_in_its_range(x: float, width: str) -> None:
    view = seen(SHELF, solved=True)
    found = dragged(view, "body.top_right", (x, 4))
    assert applied(SHELF, found.edits) == SHELF.replace("120mm", width)


def test_a_param_that_bends_the_way_is_followed() -> None:
    text = (
        "drawing d { param turn = 10deg in 0deg..80deg\n"
        " l = line(start: fixed((0, 0)), length: fixed(100), angle: turn) }"
    )
    view = seen(text, solved=True)
    there = (100 * math.cos(math.radians(50)), 100 * math.sin(math.radians(50)))
    found = dragged(view, "l.end", there)
    assert math.dist(found.at, there) < 1
    again = dropped(view, found)
    assert math.dist(geometry(again, "d.l").values["end"], there) < 1


# --- What there is -------------------------------------------------------------------------------


def test_handles_lie_where_their_points_are_and_each_place_has_one() -> None:
    view = seen(ROD, solved=True)
    found = {h.id: h.at for h in handles(view)}
    assert found["d.far.center"] == (70, 60)
    assert len({(round(x, 3), round(y, 3)) for x, y in found.values()}) == len(found)
    assert {h.moves for h in handles(view)} <= {"guess", "size", "param"}


def test_unknown_handles_and_steps_are_refused() -> None:
    view = seen(ROD, solved=True)
    with pytest.raises(CannotError):
        drag(view, "d.nothing", (1, 2))
    with pytest.raises(CannotError):
        drag(view, "d.far.center", (1, 2), step=math.nan)
    with pytest.raises(CannotError):
        drag(view, "d.far.center", (1, 2), step=0)


@pytest.mark.parametrize("name", ["telephone", "toy_sword", "key"] if TRIES_ALL else ["telephone"])
def test_in_examples_points_come_to_lie_where_they_were_shown(name: str) -> None:
    path = next(p for p in EXAMPLES if p.stem == name)
    view = solved_at(path)
    put = 0
    for each in handles(view)[: 8 if TRIES_ALL else 3]:
        try:
            found = drag(view, each.id, (each.at[0] + 3, each.at[1] + 2))
            assert found.edits
        except CannotError:
            continue
        put += 1
        again = dropped(view, found)
        assert again.outcome is not None
        assert again.outcome.status == "solved"
        assert besides_numbers(again.source.text) == besides_numbers(view.source.text)
        assert again.outcome.model is not None
        assert all(report.satisfied for report in again.outcome.model.constraints if not report.soft)
    assert put >= (5 if TRIES_ALL else 2)

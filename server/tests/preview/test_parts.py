"""Sliders, problems, conflicts and motions: checked against other runs of the program, and by hand."""

from __future__ import annotations

import math
import re

import pytest

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.tools.agents.workspace import RefusalError
from aidl_server.ide.preview import preview
from aidl_server.ide.preview.elements import Slider, Way, set_knob
from aidl_server.ide.workspace import View, applied
from server.tests.ide.conftest import seen, solved_at
from tests.amount import some
from tests.compiled import EXAMPLES

KNOBS = """
param width = 160mm in 100..240
/// Teeth of the wheel.
param teeth = 15 in 12..24
param lean = -5.5deg in -10..10 step 0.5
param bolt = "m5" in ["m4", "m5"]
param marked = true
param label = "x"
param half = width / 2
solid a { body = rectangle(width: width, height: half)
    hole h { rim = circle(diameter: if marked then 2 * teeth else teeth) } }
"""


def knob(view: View, path: str) -> Slider:
    return next(k for k in preview(view).knobs if k.path == path)


@pytest.mark.parametrize(
    ("path", "value", "written"),
    [
        ("width", 101.5, "101.5mm"),
        ("teeth", 20, "20"),
        ("lean", 7.5, "7.5deg"),
        ("bolt", "m4", '"m4"'),
        ("marked", False, "false"),
        ("label", 'ä"\\😀', '"ä\\"\\\\😀"'),
    ],
)
def test_a_value_is_written_and_nothing_else(path: str, value: float | str | bool, written: str) -> None:
    view = seen(KNOBS, solved=True)
    (edit,) = set_knob(view, path, value)
    text = applied(KNOBS, [edit])
    assert text == re.sub(rf'(param {path} = )(-?[\w.]+|"\w+")', lambda m: m[1] + written, KNOBS)
    assert {k.path: k.value for k in pipeline.knobs(SourceFile("p", text))[0]}[path] == value


@pytest.mark.parametrize(
    ("path", "value"),
    [
        *(("width", value) for value in (99.0, math.inf, math.nan, 1e30, True, "wide")),
        *(("bolt", "m6"), ("bolt", 4), ("marked", "yes"), ("label", 3), ("half", 50), ("no such", 1)),
    ],
)
def test_what_does_not_fit_is_refused(path: str, value: float | str | bool) -> None:
    with pytest.raises(RefusalError, match=r"\w"):
        set_knob(seen(KNOBS, solved=True), path, value)


@pytest.mark.parametrize(
    ("typed", "written"), [("22cm", "22cm"), ("100 + 2*20", "140mm"), ("9in - 1/2in", "8.5in")]
)
def test_what_is_typed_is_worked_out(typed: str, written: str) -> None:
    edits = set_knob(seen(KNOBS, solved=True), "width", typed)
    assert applied(KNOBS, edits) == KNOBS.replace("160mm", written)


@pytest.mark.parametrize(
    ("typed", "why"),
    [
        ("90deg", "`90deg` does not fit `width`: that is an angle, and it is a length"),
        ("1m", "`width` cannot be `1000`: that is outside its range 100..240 mm"),
        ("wide", "`wide` does not fit `width`: there is no `wide` here"),
    ],
)
def test_why_it_is_refused_is_told(typed: str, why: str) -> None:
    with pytest.raises(RefusalError) as refused:
        set_knob(seen(KNOBS, solved=True), "width", typed)
    assert refused.value.diagnostics[0].message == why


def test_conflicts_name_what_they_relate() -> None:
    view = seen(
        """
        assembly a {
            solid one { body = rectangle(width: 10, height: 10) }
            solid two { body = rectangle(width: 10, height: 10) }
            constrain one.left == two.right + 3
            constrain two.left >= one.right + 1
        }
        """,
        solved=True,
    )
    made = preview(view)
    assert made.status != "solved"
    (conflict,) = made.conflicts
    assert [p.text for p in conflict.constraints] == [
        "one.left == two.right + 3",
        "two.left >= one.right + 1",
    ]
    for party in conflict.constraints:
        paths = [made.elements[k].path for k in party.elements]
        assert any(path.startswith("a.one") for path in paths)
        assert any(path.startswith("a.two") for path in paths)
        assert party.span.text == party.text


# --- Motions ----------------------------------------------------------------------------------------


def ways(text: str) -> dict[str, list[Way]]:
    """By the path of what moves, joined by spaces."""
    made = preview(seen(text, solved=True), ("freedom",))
    found: dict[str, list[Way]] = {}
    for way in made.motions:
        found.setdefault(" ".join(made.elements[k].path for k in way.elements), []).append(way)
    return found


def test_what_slides_along_a_slope_has_an_arrow_along_it() -> None:
    ((way,),) = ways(
        """
        solid a {
            p = point((30, 40))
            body = circle(center: (0, 0), radius: 60)
            constrain { body.center == (0, 0); 3 * p.y == 4 * p.x }
        }
        """
    ).values()
    (arrow,) = way.arrows
    assert arrow["from"] == pytest.approx((30, 40))
    assert (arrow["to"][1] - 40) / (arrow["to"][0] - 30) == pytest.approx(4 / 3)


def test_a_point_moves_from_where_it_is() -> None:
    ((way,),) = ways(
        "drawing a { hand = line(fixed((10, 5)), (40, 5)); constrain { hand.length == 30 } }"
    ).values()
    (arrow,) = way.arrows
    assert way.words == "slide along a curve that begins along y at its end"
    assert arrow["from"] == pytest.approx((40, 5))
    assert arrow["to"][0] == pytest.approx(40, abs=1e-3)


SEVERAL = """
drawing d {
    drawing pin { rim = circle(center: (9, 9), radius: guess(3)) }
    plate = rectangle(center: fixed((0, 0)), width: guess(40), height: 20)
    knob = circle(center: fixed((0, 30)), radius: 2)
    hand = line(fixed((50, 0)), length: fixed(10), angle: guess(30deg))
    constrain pin.rim.radius >= 1
}
"""


def test_what_turns_has_an_arc_about_what_holds_it() -> None:
    (way,) = ways(SEVERAL)["d.hand"]
    (turn,) = way.turns
    assert turn.center == pytest.approx((50, 0), abs=1e-5)
    assert 2 < turn.radius < 15
    assert 10 < abs(turn.sweep) < 360
    # The arc goes through the hand.
    assert turn.start < 30 < turn.start + turn.sweep or turn.start + turn.sweep < 30 < turn.start


def test_the_examples_have_arrows_in_finite_places() -> None:
    for path in some(EXAMPLES, 8):
        view = solved_at(path)
        assert view.outcome is not None
        assert view.outcome.model is not None
        made = preview(view, ("freedom",))
        assert preview(view).motions == ()
        assert len(made.motions) == len(view.outcome.model.motions)
        for way in made.motions:
            numbers = [n for a in way.arrows for n in (*a["from"], *a["to"])]
            numbers += [n for t in way.turns for n in (*t.center, t.radius, t.start, t.sweep)]
            assert all(map(math.isfinite, numbers))
            assert way.arrows or way.turns

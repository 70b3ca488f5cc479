"""Edits of knobs: which values are tried, and what comes of them, on programs small enough to foresee."""

from __future__ import annotations

import pytest

from aidl_eval.editability import EditOutcome, of_aidl, of_rendered, turned
from aidl_eval.openscad import OpenScad
from aidl_eval.requirements import read
from aidl_lang.building.model import Knob
from aidl_lang.common.source import SourceFile
from aidl_lang.tools.llm.aidl import Aidl

PROMPT = read(
    SourceFile(
        "1-plate.aidl",
        """
        /// plate
        assembly plate {
            solid whole { todo }
            var pieces = 1
            assert whole.width >= 1.5 * whole.height, "it is wide"
            assert pieces <= 1, "it is one"
        }
        """,
    )
)


def knob(value: float | str | bool, **rest: object) -> Knob:
    fields = {"low": None, "high": None, "choices": (), "step": None, "unit": "mm", "doc": None}
    return Knob("k", value, **{**fields, **rest})  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("tried", "values", "cut"),
    [
        (knob(100.0), [75, 90, 110, 125], 0),
        (knob(-10.0), [-7.5, -9, -11, -12.5], 0),
        (knob(100.0, low=80.0, high=115.0), [80, 90, 110, 115], 2),
        (knob(100.0, low=100.0, high=110.0), [110], 3),  # 75 and 90 give 100 itself, 125 gives 110 again
        (knob(40.0, low=20.0, high=50.0, step=10.0), [30, 50], 2),  # 30, 36, 44, 50 → 30, 40, 40, 50
        (knob(45.0, low=20.0, high=55.0, step=20.0), [40], 4),  # 33.75, 40.5, 49.5, 56.25 → 40, 40, 40, 40
        (knob(5.0, unit=""), [4, 6], 4),  # 3.75, 4.5, 5.5, 6.25 → the even ones nearest
        (knob(0.5, unit=""), [0.375, 0.45, 0.55, 0.625], 0),
        (knob(0.0), [], 0),
        (knob("round", choices=("round", "square", "oval")), ["square", "oval"], 0),
        (knob(4.0, choices=(3.0, 4.0, 5.0)), [3.0, 5.0], 0),
        (knob(True), [False], 0),
        (knob("label"), [], 0),
    ],
)
def test_values(tried: Knob, values: list[object], cut: int) -> None:
    assert turned(tried) == (values, cut)


def outcomes(program: str) -> dict[tuple[str, object], EditOutcome]:
    edits = of_aidl(Aidl(), SourceFile("part.aidl", program), PROMPT)
    return {(edit.knob, edit.value): edit.outcome for edit in edits.edits}


def test_what_holds_is_kept_and_what_an_assert_forbids_is_told_apart() -> None:
    found = outcomes("""
        param width = 100mm
        solid plate {
            edge = rectangle(center: origin, width: width, height: 20)
            assert edge.width < 120, "it fits the box"
        }
    """)
    kept, assertion = EditOutcome.KEPT, EditOutcome.ASSERTION
    assert found == {
        ("width", 75): kept,
        ("width", 90): kept,
        ("width", 110): kept,
        ("width", 125): assertion,
    }


def test_a_size_that_gives_way_is_no_kept_edit() -> None:
    found = outcomes("""
        param width = 100mm
        solid plate {
            edge = rectangle(center: origin, width: 100, height: 20)
            constrain edge.width == width
        }
    """)
    assert set(found.values()) == {EditOutcome.CHANGED}


def test_a_size_that_gave_way_before_may_do_so_again() -> None:
    found = outcomes("""
        param width = 100mm
        solid plate {
            edge = rectangle(center: origin, width: 50, height: 20)
            constrain edge.width == width
        }
    """)
    assert set(found.values()) == {EditOutcome.KEPT}


def test_constraints_that_cannot_hold_and_wrong_values_are_broken() -> None:
    found = outcomes("""
        param width = 100mm
        param inner = 80mm
        solid plate {
            edge = circle(center: origin, radius: width)
            eye = circle(center: origin, radius: inner)
            constrain eye.radius < edge.radius
        }
    """)
    # circle in circle adds nothing, but is drawn; 75 and 80, 100 and 100 cannot be in order
    assert {key for key, outcome in found.items() if outcome is EditOutcome.BROKEN} == {
        ("width", 75),
        ("inner", 100),
    }


def test_a_knob_without_a_value_to_try_is_counted() -> None:
    edits = of_aidl(
        Aidl(),
        SourceFile(
            "part.aidl",
            'param label = "a"\nparam w = 10mm in 9..10\nsolid s { c = circle(center: origin, radius: w) }',
        ),
        PROMPT,
    )
    assert (edits.knobs, edits.skipped, edits.narrowed) == (2, 1, 3)
    assert [(edit.knob, edit.value, edit.outcome) for edit in edits.edits] == [("w", 9.0, EditOutcome.KEPT)]


@pytest.mark.skipif(OpenScad().missing() is not None, reason="openscad is not installed")
def test_openscad_is_edited_at_its_numbers() -> None:
    edits = of_rendered(
        OpenScad(), "w = 10; n = 3; $fn = 20; square([w, 1]); assert(w < 12); assert(n > 2);", PROMPT
    )
    assert edits.knobs == 2
    assert {(e.knob, e.value): str(e.outcome) for e in edits.edits} == {
        ("w", 8.0): "kept",
        ("w", 9.0): "kept",
        ("w", 11.0): "kept",
        ("w", 12.0): "empty",
        ("n", 2.0): "empty",
        ("n", 4.0): "kept",
    }


@pytest.mark.skipif(OpenScad().missing() is not None, reason="openscad is not installed")
def test_edits_hold_where_what_was_met_still_is() -> None:
    edits = of_rendered(OpenScad(), "h = 14; square([24, h]);", PROMPT)
    # it is wide up to a height of 16
    assert {e.value: e.holds for e in edits.edits} == {10.0: True, 13.0: True, 15.0: True, 18.0: False}


def test_edits_of_aidl_hold_by_the_same_requirements() -> None:
    program = "param w = 20 solid s { a = rectangle(center: origin, width: w, height: 12) }"
    edits = of_aidl(Aidl(), SourceFile("part.aidl", program), PROMPT)
    assert {e.value: (str(e.outcome), e.holds) for e in edits.edits} == {
        15: ("kept", False),
        18: ("kept", True),
        22: ("kept", True),
        25: ("kept", True),
    }

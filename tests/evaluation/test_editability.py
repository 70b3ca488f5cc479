"""Edits of knobs: which values are tried, and what comes of them, on programs small enough to foresee."""

from __future__ import annotations

import pytest

from aidl_lang.building.model import Knob
from aidl_lang.common.source import SourceFile
from aidl_lang.tools.evaluation.editability import EditOutcome, of_aidl, of_openscad, turned
from aidl_lang.tools.evaluation.openscad import OpenScad


def knob(value: float | str | bool, **rest: object) -> Knob:
    fields = {"low": None, "high": None, "choices": (), "step": None, "unit": "mm", "doc": None}
    return Knob("k", value, **{**fields, **rest})  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("tried", "values", "cut"),
    [
        (knob(100.0), [70, 90, 110, 130], 0),
        (knob(-10.0), [-7, -9, -11, -13], 0),
        (knob(100.0, low=80.0, high=115.0), [80, 90, 110, 115], 2),
        (knob(100.0, low=100.0, high=110.0), [110], 3),  # 70 and 90 give 100 itself, 130 gives 110 again
        (knob(40.0, low=20.0, high=50.0, step=10.0), [30, 50], 4),  # 28, 36, 44, 52 → 30, 40, 40, 50
        (knob(45.0, low=20.0, high=55.0, step=20.0), [40], 4),  # 31.5, 40.5, 49.5, 58.5 → 40, 40, 40, 40
        (knob(5.0, unit=""), [4, 6], 4),  # 3.5, 4.5, 5.5, 6.5 → the even ones nearest
        (knob(0.5, unit=""), [0.35, 0.45, 0.55, 0.65], 0),
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
    edits = of_aidl(SourceFile("part.aidl", program))
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
        ("width", 70): kept,
        ("width", 90): kept,
        ("width", 110): kept,
        ("width", 130): assertion,
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
    # circle in circle adds nothing, but is drawn; 70 and 80, 100 and 104 cannot be in order
    assert {key for key, outcome in found.items() if outcome is EditOutcome.BROKEN} == {
        ("width", 70),
        ("inner", 104),
    }


def test_a_knob_without_a_value_to_try_is_counted() -> None:
    edits = of_aidl(
        SourceFile(
            "part.aidl",
            'param label = "a"\nparam w = 10mm in 9..10\nsolid s { c = circle(center: origin, radius: w) }',
        )
    )
    assert (edits.knobs, edits.skipped, edits.narrowed) == (2, 1, 3)
    assert [(edit.knob, edit.value, edit.outcome) for edit in edits.edits] == [("w", 9.0, EditOutcome.KEPT)]


@pytest.mark.skipif(not OpenScad().is_installed, reason="openscad is not installed")
def test_openscad_is_edited_at_its_numbers() -> None:
    edits = of_openscad("w = 10; n = 3; $fn = 20; square([w, 1]); assert(w < 12); assert(n > 2);")
    assert edits.knobs == 2
    assert {(e.knob, e.value): str(e.outcome) for e in edits.edits} == {
        ("w", 7.0): "kept",
        ("w", 9.0): "kept",
        ("w", 11.0): "kept",
        ("w", 13.0): "empty",
        ("n", 2.0): "empty",
        ("n", 4.0): "kept",
    }

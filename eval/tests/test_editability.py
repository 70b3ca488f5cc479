"""Edits of knobs: which values are tried, and what comes of them, on programs small enough to foresee."""

from __future__ import annotations

import pytest

from aidl_eval.measures import of_aidl, of_rendered, turned
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
            var width = 1
            var height = 1
            var pieces = 1
            assert width >= 1.5 * height, "it is wide"
            assert pieces <= 1, "it is one"
        }
        """,
    )
)


def knob(value: float | str | bool, **rest: object) -> Knob:
    fields = {"low": None, "high": None, "choices": (), "step": None, "unit": "mm", "doc": None}
    return Knob("k", value, **{**fields, **rest})  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("tried", "values"),
    [
        (knob(100.0), [75, 90, 110, 125]),
        (knob(-10.0), [-7.5, -9, -11, -12.5]),
        (knob(100.0, low=80.0, high=115.0), [80, 90, 110, 115]),
        (knob(100.0, low=100.0, high=110.0), [110]),  # 75 and 90 give 100 itself, 125 gives 110 again
        (knob(40.0, low=20.0, high=50.0, step=10.0), [30, 50]),  # 30, 36, 44, 50 → 30, 40, 40, 50
        (knob(45.0, low=20.0, high=55.0, step=20.0), [40]),  # 33.75, 40.5, 49.5, 56.25 → 40, 40, 40, 40
        (knob(5.0, unit=""), [4, 6]),  # 3.75, 4.5, 5.5, 6.25 → the even ones nearest
        (knob(0.5, unit=""), [0.375, 0.45, 0.55, 0.625]),
        (knob(0.0), []),
        (knob("round", choices=("round", "square", "oval")), ["square", "oval"]),
        (knob(4.0, choices=(3.0, 4.0, 5.0)), [3.0, 5.0]),
        (knob(True), [False]),
        (knob("label"), []),
    ],
)
def test_values(tried: Knob, values: list[object]) -> None:
    assert turned(tried) == values


def held(program: str) -> dict[tuple[str, object], bool]:
    edits = of_aidl(Aidl(), SourceFile("part.aidl", program), PROMPT)
    return {(edit.knob, edit.value): edit.holds for edit in edits.edits}


def test_what_an_assert_or_a_requirement_forbids_does_not_hold() -> None:
    found = held("""
        param width = 32mm
        solid plate {
            edge = rectangle(center: origin, width: width, height: 18)
            assert edge.width < 40, "it fits the box"
        }
    """)
    assert found == {("width", 24): False, ("width", 28.8): True, ("width", 35.2): True, ("width", 40): False}


def test_constraints_that_cannot_hold_and_wrong_values_do_not_hold() -> None:
    found = held("""
        param width = 100mm
        param inner = 80mm
        solid plate {
            edge = rectangle(center: origin, width: 400, height: 10)
            rim = circle(center: origin, radius: width)
            eye = circle(center: origin, radius: inner)
            constrain eye.radius < rim.radius
        }
    """)
    # 75 and 80, 100 and 100 cannot be in order
    assert {key for key, holds in found.items() if not holds} == {("width", 75), ("inner", 100)}


def test_a_knob_without_a_value_to_try_counts_as_one() -> None:
    program = (
        'param label = "a"\nparam w = 20mm in 19..20\n'
        "solid s { r = rectangle(center: origin, width: w, height: 8) }"
    )
    edits = of_aidl(Aidl(), SourceFile("part.aidl", program), PROMPT)
    assert edits.knobs == 2
    assert [(edit.knob, edit.value, edit.holds) for edit in edits.edits] == [("w", 19.0, True)]


@pytest.mark.skipif(OpenScad().missing() is not None, reason="openscad is not installed")
def test_openscad_is_edited_at_its_numbers() -> None:
    program = "w = 10; n = 3; square([w, 6]); assert(w < 12); assert(n > 2);"
    edits = of_rendered(OpenScad(), program, PROMPT)
    assert edits.knobs == 2
    assert {(e.knob, e.value): e.holds for e in edits.edits} == {
        ("w", 8.0): False,  # 8 by 6 is not wide
        ("w", 9.0): True,
        ("w", 11.0): True,
        ("w", 12.0): False,
        ("n", 2.0): False,
        ("n", 4.0): True,
    }

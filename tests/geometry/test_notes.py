"""Warnings about curves, holes and parts."""

from __future__ import annotations

import pytest

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Diagnostic, apply_fixes
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.solved import SolvedStructure
from tests.geometry.models import circle, model, primitive, rectangle, structure


def notes(root: SolvedStructure) -> list[Diagnostic]:
    return draw(model(root))[1].everything()


def only(root: SolvedStructure) -> Diagnostic:
    (note,) = notes(root)
    return note


def span_of(source: SourceFile, text: str) -> Span:
    start = source.text.index(text)
    return Span(source, start, start + len(text))


def test_the_fix_makes_the_inner_loop_a_hole():
    source = SourceFile(
        "x.aidl", "solid s {\n    plate = square(10)\n    bore = circle(center: (5, 5), radius: 2)\n}\n"
    )
    bore = circle("bore", 5, 5, 2)
    bore = primitive("bore", bore.curve, span=span_of(source, "bore = circle(center: (5, 5), radius: 2)"))
    note = only(structure("solid", "s", rectangle("plate", 0, 0, 10, 10), bore))
    text, count = apply_fixes(source, [note])
    assert count == 1
    assert "    hole bore_hole { bore = circle(center: (5, 5), radius: 2) }\n" in text


PIN = "solid pin(r: length) { c = circle(radius: r) }\n"


@pytest.mark.parametrize(
    "lonely",
    [
        "solid b { c = circle(center: (50, 0), radius: 1) }",
        '@color("red") solid b { c = circle(center: (50, 0), radius: 1) }',
        "@detached(false) solid b { c = circle(center: (50, 0), radius: 1) }",
        "for i in 1..3 { solid b[i] { c = circle(center: (50 * i, 0), radius: 1) } }",
        "b = pin(r: 2) at (50, 0)",
        "assembly b { solid c { d = circle(center: (50, 0), radius: 1) } }",
    ],
)
def test_the_fix_of_a_detached_part_needs_no_trial(lonely):
    text = (
        PIN
        + "solid a { c = circle(radius: 1) }\nsolid e { c = circle(center: (2, 0), radius: 1) }\n"
        + lonely
    )
    source = SourceFile("x.aidl", text)
    found = pipeline.compile(source).diagnostics
    assert {d.code for d in found} == {"W0705"}
    mended, _ = apply_fixes(source, [d for d in found if d.code == "W0705"])
    after = pipeline.compile(SourceFile("x.aidl", mended)).diagnostics
    assert [d.code for d in after] == ["W0705" for d in found if d.fix is None]

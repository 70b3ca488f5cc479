"""Warnings about curves, holes and parts."""

from __future__ import annotations

import pytest

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import apply_fixes
from aidl_lang.common.source import SourceFile


def test_the_fix_makes_the_inner_loop_a_hole():
    bore = "bore = circle(center: (5, 5), radius: 2)"
    source = SourceFile("x.aidl", f"solid s {{\n    plate = square(size: 20)\n    {bore}\n}}\n")
    (note,) = pipeline.compile(source).diagnostics
    assert apply_fixes(source, [note]) == (source.text.replace(bore, f"hole bore_hole {{ {bore} }}"), 1)


TOUCHING = """solid pin(r: length) { c = circle(radius: r) }
solid a { c = circle(radius: 1) }
solid e { c = circle(center: (2, 0), radius: 1) }
"""


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
    source = SourceFile("x.aidl", TOUCHING + lonely)
    found = pipeline.compile(source).diagnostics
    assert {d.code for d in found} == {"W0705"}
    mended, _ = apply_fixes(source, [d for d in found if d.code == "W0705"])
    after = pipeline.compile(SourceFile("x.aidl", mended)).diagnostics
    assert [d.code for d in after] == ["W0705" for d in found if d.fix is None]

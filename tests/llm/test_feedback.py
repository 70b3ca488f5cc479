"""What a model is told beside its errors."""

from __future__ import annotations

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.tools.llm import generation
from aidl_lang.tools.llm.aidl import Aidl

LAMP = """assembly lamp {
    solid foot { plate = rectangle(width: 60, height: 8) }
    solid pole { rod = rectangle(center: (0, 34), width: 6, height: 60) }
    solid shade { cone = trapezoid(center: (0, 80), bottom_width: 50, top_width: 30, height: 32) }
    CONSTRAIN
}
"""


def test_what_is_told_of_floating_parts() -> None:
    compiled = pipeline.compile(SourceFile("part.aidl", LAMP.replace("CONSTRAIN", "")))
    told = generation.remarks(compiled, may_constrain=True)
    assert "warning: `foot`, `pole`, `shade` float: no constraint speaks of where, so they stand" in told
    assert "float" not in generation.remarks(compiled, may_constrain=False)


def test_the_stage_is_the_first_that_fails() -> None:
    def stage(program: str) -> str:
        return generation.stage_of(pipeline.compile(SourceFile("part.aidl", program)).diagnostics)

    plate = "solid plate { outline = rectangle(width: 60, height: 40) REST }"
    assert stage(plate.replace("REST", "constrain }")) == "syntax"
    assert stage(plate.replace("REST", "constrain outline.sise == 3")) == "types"
    assert (
        stage(plate.replace("REST", "hole h { c = circle(center: outline.center, radius: 3) }")) == "validity"
    )
    assert stage(plate.replace("REST", "constrain { outline.width == 1; outline.width == 2 }")) == "solve"
    assert stage(plate.replace("REST", "assert outline.width == 1")) == "asserts"
    apart = (
        "assembly a { solid b { c = circle(radius: 3) } solid d { e = circle(center: (20, 0), radius: 3) } }"
    )
    assert stage(apart) == "contacts"
    assert stage(plate.replace("REST", "")) == "done"


def test_a_robust_program_is_asked_for_once() -> None:
    plate = """solid plate {
    param way = 0 in 0..50
    body = rectangle(center: fixed((0, 0)), width: 80, height: 50)
    hole bore { rim = circle(center: fixed((way, 0)), radius: 6) }
}
"""
    assert Aidl().conversation().judge(plate).feedback == ""
    conversation = Aidl(is_robust=True).conversation()
    told = conversation.judge(plate).feedback
    assert "let the range of `way` end at 34" in told
    assert "Answer with the whole program" in told or "answer with the whole program" in told
    assert conversation.judge(plate).feedback == ""
    assert Aidl(is_robust=True).conversation().judge(plate.replace("0..50", "0..30")).feedback == ""

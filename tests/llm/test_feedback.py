"""Programs are found in replies, and what a model is told beside its errors; the script of the README."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.tools.cli import main
from aidl_lang.tools.llm import generation
from aidl_lang.tools.llm.aidl import Aidl
from aidl_lang.tools.llm.messages import find_program
from tests.sweep.here import at_once as at_once

PROGRAM = "solid plate { outline = rectangle(width: 60, height: 40) }\n"


def found(reply: str) -> str | None:
    return find_program(reply, ("aidl",), Aidl().reads)[0]


@pytest.mark.parametrize(
    "reply",
    [
        f"```aidl\n{PROGRAM}```",
        f"A plate.\n\n```aidl\n{PROGRAM}```\nThat is all.",
        f"```\n{PROGRAM}```",
        f"```AIDL title=plate\n{PROGRAM}```",
        f"~~~~aidl\n{PROGRAM}~~~~",
        f"First try:\n```aidl\nsolid a {{\n```\nBetter:\n```aidl\n{PROGRAM}```",
        f"```aidl\n{PROGRAM}```\nRun it:\n```sh\naidl compile plate.aidl\n```",
        f"<think>\n```aidl\nsolid no {{}}\n```\n</think>\n```aidl\n{PROGRAM}```",
        f"````markdown\nno\n````\n   ```aidl\n{PROGRAM}   ```",
        PROGRAM,
        f"<think>hm</think>\n{PROGRAM}",
    ],
)
def test_the_program_is_found(reply: str) -> None:
    assert found(reply) == PROGRAM


@pytest.mark.parametrize(
    "reply",
    [
        "",
        "I cannot draw that.",
        f"```aidl\n{PROGRAM}",
        f"<think>```aidl\n{PROGRAM}```",
        "solid plate is what you want",
        "solid plate { outline = rectangle(width: 60",
        "let a = 3",
    ],
)
def test_what_is_no_program_is_not_taken_for_one(reply: str) -> None:
    assert found(reply) is None


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


@pytest.mark.usefixtures("at_once")
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


README = (Path(__file__).parents[2] / "README.md").read_text("utf-8")
PLATE = "solid plate { outline = rectangle(width: 60, height: 40) }\n"
MODEL = """import sys
prompt = sys.stdin.read()
assert prompt.startswith("[system]\\n# AIDL in a few pages"), prompt[:60]
assert "[user]\\nWrite a program that draws this: a hinge" in prompt
print("```aidl\\n" + open("plate.aidl").read() + "```")
"""


def test_the_script_of_the_readme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scripts = [s for s in re.findall(r"```python\n(.*?)```", README, re.S) if "reply.py" in s]
    (tmp_path / "reply.py").write_text(scripts[0], "utf-8")
    (tmp_path / "model.py").write_text(MODEL, "utf-8")
    (tmp_path / "plate.aidl").write_text(PLATE, "utf-8")
    monkeypatch.chdir(tmp_path)
    provider = f"exec:{sys.executable} reply.py {sys.executable} model.py"
    assert main(["generate", "a hinge", "-o", "hinge.aidl", "--provider", provider]) == 0
    assert (tmp_path / "hinge.aidl").read_text("utf-8") == PLATE

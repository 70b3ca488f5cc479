"""`aidl grammar`."""

from __future__ import annotations

from pathlib import Path

import pytest

from aidl_lang.tools.grammars import FORMATS, export
from tests.commands import Aidl, Result


@pytest.mark.parametrize("format", FORMATS)
def test_prints_a_format(aidl: Aidl, format: str) -> None:
    assert aidl("grammar", "--format", format) == Result(0, export(format), "")


def test_writes_a_file(aidl: Aidl) -> None:
    result = aidl("grammar", "--format", "gbnf", "--fenced", "-o", "aidl.gbnf")
    assert result == Result(0, "", "aidl.gbnf: written\n")
    assert Path("aidl.gbnf").read_text(encoding="utf-8") == export("gbnf", fenced=True)


def test_formats_that_are_not_there(aidl: Aidl) -> None:
    assert aidl("grammar", "--format", "bnf") == Result(
        2,
        "",
        "error[E0940]: there is no format `bnf`\n  = hint: the formats: lark, llguidance, gbnf, ebnf\n",
    )
    assert aidl("grammar", "--fenced") == Result(
        2,
        "",
        "error[E0941]: `lark` has no form for free text before a program\n"
        "  = hint: `--fenced` goes with `--format llguidance` and `--format gbnf`\n",
    )
    assert "there is no directory" in aidl("grammar", "-o", "nowhere/a.lark").err

"""`--trace-solve` prints the stages, as the page on the solver shows them."""

from __future__ import annotations

from pathlib import Path

import pytest

from aidl_lang.tools.cli import main
from tests.documents import ROOT, blocks

PAGE = ROOT / "docs" / "solver.md"


def test_the_page_shows_what_is_printed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, shown = [block for block in blocks(PAGE) if block.heading == "An example"]
    file = tmp_path / "sign.aidl"
    file.write_text(program.text, encoding="utf-8")
    assert main(["compile", str(file), "--trace-solve", "--quiet"]) == 0
    assert capsys.readouterr().err == shown.text


def test_when_there_is_nothing_to_solve(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "dot.aidl"
    file.write_text("solid dot { c = circle(center: origin, radius: 1) }\n", encoding="utf-8")
    assert main(["compile", str(file), "--trace-solve", "--quiet"]) == 0
    assert "nothing to solve" in capsys.readouterr().err

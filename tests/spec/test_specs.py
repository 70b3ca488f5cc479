"""The specs say what the language does; here they are held to it. `AIDL_ACCEPT=1` writes down what comes."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path

import pytest

from tests.spec.parts import Case, read
from tests.spec.running import Outcome, run

HERE = Path(__file__).parent
SPECS = sorted(path for path in HERE.glob("*.md") if path.name not in ("README.md", "tolerance.md"))
CASES = [case for path in SPECS for case in read(path)]
_ACCEPT = os.environ.get("AIDL_ACCEPT") == "1"


@cache
def outcome_of(case: Case) -> Outcome:
    return run(case)


def _parameter(case: Case) -> object:
    marks = [pytest.mark.xfail(reason=case.pending, strict=True)] if case.pending else []
    marks += [pytest.mark.slow] if case.slow else []
    return pytest.param(case, id=f"{case.place} {case.heading}", marks=marks)


@pytest.mark.parametrize("case", [_parameter(case) for case in CASES])
def test_spec(case: Case) -> None:
    outcome = outcome_of(case)
    if outcome.problems and not (_ACCEPT and not case.pending):
        where = case.path.relative_to(HERE.parent.parent)
        pytest.fail("\n".join(f"{where}:{p.line}: {p.text}" for p in outcome.problems), pytrace=False)


@pytest.mark.skipif(not _ACCEPT, reason="writes only with AIDL_ACCEPT=1")
@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_accept(path: Path) -> None:
    """Write the diagnostics and values that come into the specs, from the last line to the first."""
    lines = path.read_text(encoding="utf-8").splitlines()
    edits = {
        place: text
        for case in CASES
        if case.path == path and not case.pending
        for place, text in outcome_of(case).accepted.items()
    }
    for (start, end), text in sorted(edits.items(), reverse=True):
        lines[start - 1 : end - 1] = text
    path.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")

"""What comes of each example, against the files in `expected/`.

`make accept` (AIDL_ACCEPT=1) takes the present results as the new ones. Numbers are rounded, so that the last
digits of a machine's arithmetic make no difference.
"""

from __future__ import annotations

import difflib
import json
import math
import os
import re
from collections.abc import Callable
from functools import cache
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

import aidl_lang
from tests.compiled import EXAMPLES, json_of, model
from tests.documents import ROOT

EXPECTED = Path(__file__).parent / "expected"
ACCEPT = bool(os.environ.get("AIDL_ACCEPT"))
_NUMBER = re.compile(r"-?\d+\.\d+(?:e[-+]?\d+)?")
_MOST_LINES = 60
_WIDTH = 160


def rounded(value: float) -> float:
    """Six significant digits; what is nothing but rounding error is 0."""
    if not math.isfinite(value) or abs(value) < 1e-7:
        return 0.0 if math.isfinite(value) else value
    return float(f"{value:.6g}")


def rounded_text(text: str) -> str:
    return _NUMBER.sub(lambda m: f"{rounded(float(m[0])):g}", text)


def rounded_document(value: Any) -> Any:
    match value:
        case float():
            return rounded(value)
        case dict():
            return {k: rounded_document(v) for k, v in value.items() if k != "residual"}
        case list():
            return [rounded_document(v) for v in value]
        case _:
            return value


# --- What comes ------------------------------------------------------------------------------------


def solved(text: str) -> str:
    return _rows(rounded_document(json_of(text)), "") + "\n"


def _rows(value: Any, indent: str) -> str:
    """Returns JSON in which what fits into a line has one line: a geometry, mostly."""
    line = json.dumps(value, ensure_ascii=False)
    if len(line) + len(indent) <= _WIDTH or not isinstance(value, dict | list) or not value:
        return line
    inner = indent + " "
    if isinstance(value, list):
        rows, (left, right) = [_rows(each, inner) for each in value], "[]"
    else:
        rows, (left, right) = (
            [f"{json.dumps(key)}: {_rows(each, inner)}" for key, each in value.items()],
            "{}",
        )
    return f"{left}\n{inner}" + f",\n{inner}".join(rows) + f"\n{indent}{right}"


@cache
def drawn(text: str) -> str:
    return rounded_text(model(text).to_svg())


STAGES: dict[str, Callable[[str], str]] = {
    "canonical.aidl": aidl_lang.format,
    "solved.json": solved,
    "drawing.svg": drawn,
}

# --- Tests -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("stage", STAGES)
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda p: p.stem)
def test_stage(path: Path, stage: str) -> None:
    golden = EXPECTED / path.stem / stage
    actual = STAGES[stage](path.read_text("utf-8"))
    if ACCEPT:
        golden.parent.mkdir(parents=True, exist_ok=True)
        golden.write_text(actual, "utf-8")
        return
    assert golden.exists(), f"no golden {golden.relative_to(ROOT)}: `make accept` writes it"
    expected = golden.read_text("utf-8")
    if expected != actual:
        told = difflib.unified_diff(
            expected.splitlines(), actual.splitlines(), stage, "now", lineterm="", n=2
        )
        pytest.fail("\n".join([*islice(told, _MOST_LINES), "`make accept` takes it"]), pytrace=False)


def test_no_golden_is_left_of_an_example_that_is_gone() -> None:
    known = {path.stem for path in EXAMPLES}
    assert {folder.name for folder in EXPECTED.iterdir()} <= known


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda p: p.stem)
def test_the_canonical_form_means_the_same_drawing(path: Path) -> None:
    text = path.read_text("utf-8")
    assert drawn(aidl_lang.format(text)) == drawn(text)

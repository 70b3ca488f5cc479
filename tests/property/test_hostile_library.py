"""Everything that can be called, called with what it does not expect: programs of random calls, each with
arguments of right and of wrong kinds, as geometry, constraint, assertion, statement and value.

None may raise, take long, write what is not JSON or a drawing, or come to nothing without a word.
`AIDL_EXAMPLES=20 pytest …` tries twenty times as many, others each time.
"""

from __future__ import annotations

import json
import math
import random
import time
from typing import Any

import pytest

import aidl_lang
from aidl_lang import parser
from aidl_lang.common.render.terminal import render
from aidl_lang.common.source import SourceFile
from aidl_lang.syntax import ast
from aidl_lang.tools.reference.collect import Entry, reference
from tests.amount import TRIES_ALL, some, tried
from tests.fuzz.calls import CALLABLES, Writer

LONGEST = 20.0
"""Seconds; what building and solving are allowed on a busy machine."""


def no_number(text: str) -> float:
    raise ValueError(f"{text} is not JSON")


def numbers(value: Any) -> list[float]:
    """All numbers in a JSON value."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        return [n for v in value for n in numbers(v)]
    return [value] if isinstance(value, float | int) and not isinstance(value, bool) else []


def trouble(text: str) -> str | None:
    """What is wrong with the answer to a program; None if nothing is. Raises what the compiler raises."""
    start = time.monotonic()
    model = aidl_lang.compile(text)
    for d in model.diagnostics:
        assert render(d)
    if model.status == "wrong":
        if not any(d.is_error for d in model.diagnostics):
            return "wrong, and no error says why"
    else:
        said = json.loads(model.to_json(), parse_constant=no_number)
        if not all(map(math.isfinite, numbers(said))):
            return "numbers beyond all bounds"
        if any(region["area"] < 0 for region in said["regions"].values()):
            return "a negative area"
        drawn = model.to_svg()
        if "nan" in drawn or "inf" in drawn:
            return "a drawing with numbers that are none"
        if model.status != "solved" and not model.diagnostics:
            return f"{model.status}, and nothing says why"
    took = time.monotonic() - start
    return f"{took:.1f} s" if took > LONGEST else None


NAMES = list(CALLABLES) if TRIES_ALL else [n for n in CALLABLES if n in reference().entries][::18]
"""Some of what a program may call; with `AIDL_EXAMPLES` all, also what only the library itself calls."""


@pytest.mark.parametrize("name", NAMES)
def test_no_call_breaks_the_compiler(name: str) -> None:
    for number in range(tried(1)):
        for overload in CALLABLES[name] if TRIES_ALL else CALLABLES[name][:1]:
            text = Writer((number, str(overload))).program(name, overload)
            try:
                found = trouble(text)
            except Exception as error:
                error.add_note(text)
                raise
            assert found is None, f"{found}\n{text}"


SHAPES = [entry for entry in reference().entries.values() if entry.sort == "shape" and entry.doc.example]
SHAPES = some(SHAPES, 16)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.name)
def test_every_number_counts(shape: Entry) -> None:
    """Twice a size in the example of a shape gives another picture, or is told."""
    example = shape.doc.example
    module = parser.parse(SourceFile("<example>", example)).module
    calls = [n for n in ast.walk(module) if isinstance(n, ast.Call) and n.callee.text == shape.name]
    sizes = [a.value for call in calls for a in call.arguments if not isinstance(a.value, ast.Point)]
    spans = [n.span for size in sizes for n in ast.walk(size) if isinstance(n, ast.Number) and n.value]
    before = outcome(example)
    for span in spans if TRIES_ALL else random.Random(shape.name).sample(spans, min(1, len(spans))):
        text = f"{example[: span.start]}({span.text} * 2){example[span.end :]}"
        assert outcome(text) != before, text


def outcome(text: str) -> object:
    """What is drawn, and what is said."""
    model = aidl_lang.compile(text)
    said = [d.message for d in model.diagnostics]
    return (said, model.to_svg()) if model.status != "wrong" else said

"""Programs that ask for trouble: each ends soon, with diagnostics or a drawing, never with an exception."""

from __future__ import annotations

import json
import time
from pathlib import Path

import pytest

import aidl_lang
from tests.amount import TRIES_ALL
from tests.compiled import FEW

LONGEST = 30.0
"""Seconds of the processor: however busy the machine is."""

DOUBLING = "\n".join(f"let a{i} = a{i - 1} + a{i - 1}" for i in range(1, 40))

GENERATED = {
    "parentheses": f"solid s {{ r = circle(radius: {'(' * 3000}1{')' * 3000}) }}",
    "braces": "".join(f"solid s{i} {{ " for i in range(500)) + "}" * 500,
    "signs": f"solid s {{ r = circle(radius: {'-' * 5000}1) }}",
    "terms": f"solid s {{ r = circle(radius: {'+'.join(['1'] * 5000)}) }}",
    "doubling constants": f"let a0 = 1\n{DOUBLING}\nsolid s {{ r = circle(radius: a39) }}",
    "doubling unknowns": f"solid s {{ var v = 1 let a0 = v\n{DOUBLING}\n constrain a39 == 5 }}",
    "long chain": f"solid s {{ r = circle(radius: 1) constrain {' <= '.join(['r.radius'] * 300)} }}",
    "control characters": "solid s { r = circle(radius: 1) \x00 \ud7ff \u202e }",
}


def _written() -> dict[str, str]:
    """The programs of `hostile.txt`, each under a line `=== name`."""
    text = (Path(__file__).parent / "hostile.txt").read_text("utf-8")
    found = (part.partition("\n") for part in text.split("=== ")[1:])
    return {name: program for name, _, program in found}


HOSTILE = _written() | GENERATED

CHECKED = [
    "solid s { let x = " + "(" * 90 + "1" + ")" * 90 + " }",
    "solid s { let x = " + "+".join("x1" for _ in range(90)) + " }",
    "solid s { let x = [" + ", ".join(f"({i}, {i})" for i in range(500)) + "] }",
    "solid s {\n" + "\n".join(f"let v{i} = v{i + 1}" for i in range(1_200)) + "\nlet v1200 = 1 }",
    "solid s {\n" + "\n".join(f"let v{i} = v{i + 1} + v{(i * 7) % 900}" for i in range(900)) + " }",
    "\n".join(f"solid s{i} {{ r = circle(radius: {i}) }}" for i in range(150)),
    "fn f(n) = f(n)\nfn g(n) = h(n)\nfn h(n) = g(n)\nsolid s { let x = f(1) + g(2) }",
    "shape f(n) { inner = f(n) }\nsolid s { a = f(1)\n let x = a.inner.inner.inner.n }",
    "solid t(n) { inner = t(n) }\nsolid s { a = t(1)\n let x = a.inner.inner.inner.n }",
    "alias circle = circle\nsolid s { a = circle(radius: 3) }",
    "solid s { s = s\n a = a.a\n hole s { s = s } }",
    "for i in 0..3 { for i in i { i[i] = i } }",
    "constrain constrain constrain { } = { }",
    "solid s { param p = p in p..p step p }",
]  # fmt: skip


@pytest.mark.parametrize(
    "text",
    [
        pytest.param(text, id=name, marks=[pytest.mark.slow] if name == "loops in loops" else [])
        for name, text in HOSTILE.items()
    ],
)  # loops go on to the limit of all turns, of which `spec/limits.md` tells
def test_ends_soon_without_an_exception(text: str) -> None:
    start = time.process_time()
    model = aidl_lang.compile(text)
    if model.status == "wrong":
        assert any(d.is_error for d in model.diagnostics)
    else:
        aidl_lang.check(text)  # what is wrong was found by the same steps
        json.loads(model.to_json())
        assert model.to_svg().startswith(("<?xml", "<svg"))
    assert time.process_time() - start < LONGEST


@pytest.mark.parametrize("text", CHECKED, ids=range(len(CHECKED)))
def test_is_checked_without_an_exception(text: str) -> None:
    assert all(d.code for d in aidl_lang.check(text))


@pytest.mark.parametrize("path", FEW)
def test_every_prefix_of_a_program_is_survived(path: Path) -> None:
    text = path.read_text("utf-8")
    for end in range(0, len(text), 37 if TRIES_ALL else 149):
        aidl_lang.check(text[:end])


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "1e400", "", "x", "0/0", "1e-400", "-1", "999"])
def test_odd_values_of_knobs_are_refused_or_taken(value: str) -> None:
    model = aidl_lang.compile("param w = 5 in 1..9 solid s { r = circle(radius: w) }", params={"w": value})
    assert model.status == "wrong"
    assert any(d.is_error for d in model.diagnostics)

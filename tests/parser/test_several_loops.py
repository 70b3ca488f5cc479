"""Lists with several `for`, each with its own `if`."""

from __future__ import annotations

import pytest

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax.printer import format_module

LISTS = [
    ("[10 * i + j for i in 0..3 for j in 0..i if i != j]", [10, 20, 21, 30, 31, 32]),
    ("[10 * i + j for i in 0..3 if i % 2 == 1 for j in 1..2]", [11, 12, 31, 32]),
    ("[i * j for i in 1..2, j in 1..3]", [1, 2, 3, 2, 4, 6]),
    ("[i + j + k for i in 1..2 for j in 1..i for k in 1..j]", [3, 4, 5, 6]),
    ("[i for i in 1..2 for j in 3..2]", []),
]


@pytest.mark.parametrize(("written", "meant"), LISTS)
def test_members_come_in_the_order_of_the_loops(written: str, meant: list[int]) -> None:
    asserted = "".join(f"assert found[{k}] == {v}\n" for k, v in enumerate(meant))
    text = f"drawing d {{ let found = {written}\nassert len(found) == {len(meant)}\n{asserted}"
    text += "c = circle(center: origin, radius: 1) }"
    compiled = pipeline.compile(SourceFile("part.aidl", text))
    assert not compiled.diagnostics


@pytest.mark.parametrize("written", [written for written, _ in LISTS])
def test_printing_keeps_the_loops(written: str) -> None:
    module = parse(SourceFile("part.aidl", f"let found = {written}\n")).module
    printed = format_module(module)
    assert printed.count(" for ") == written.count(" in ")
    assert format_module(parse(SourceFile("part.aidl", printed)).module) == printed

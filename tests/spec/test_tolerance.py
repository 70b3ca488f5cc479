"""What is written in other words means the same; what is wrong gets the message that `tolerance.md` shows.

`AIDL_ACCEPT=1` writes down the messages that come, under the programs of `wrong` blocks.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Diagnostic, apply_fixes
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld
from tests.documents import Block, blocks
from tests.spec.running import headline

PAGE = Path(__file__).with_name("tolerance.md")
_SIGNATURES = ("it is called as", "or as", "for example")
_ACCEPT = os.environ.get("AIDL_ACCEPT") == "1"


@dataclass
class Row:
    """A program (`\\n` in it is a line break) and the indented lines below it."""

    block: Block
    line: int
    program: str
    below: list[str] = field(default_factory=list)

    @property
    def id(self) -> str:
        return f"{self.line} {self.program[:60]}"


def rows(language: str) -> list[Row]:
    found: list[Row] = []
    for block in blocks(PAGE):
        if block.language != language:
            continue
        for number, line in enumerate(block.text.splitlines(), block.line + 1):
            if line.startswith("    "):
                found[-1].below.append(line.strip())
            elif line:
                found.append(Row(block, number, line))
    return found


@lru_cache(maxsize=64)
def compiled(program: str) -> tuple[pipeline.Compiled, SourceFile]:
    """A program that names no structure stands in a drawing."""
    text = program.replace("\\n", "\n")
    is_whole = text.startswith("!")
    source = SourceFile("spec.aidl", text[1:] if is_whole else f"drawing d {{\n{text}\n}}\n")
    return pipeline.compile(source, MemoryWorld({})), source


@lru_cache(maxsize=64)
def solved(program: str) -> object:
    """The solved model without what tells where and in which words it was written."""
    document = json.loads(compiled(program)[0].export(".json"))
    for item in [*document["constraints"], *document.get("readings", ())]:
        for word in ("text", "line", "column"):
            del item[word]
    for change in document["changed"]:
        del change["because"]
    del document["diagnostics"]
    return document


def told(diagnostics: list[Diagnostic]) -> list[str]:
    """Diagnostics as the page shows them, without the signatures that they list."""
    lines = []
    for d in diagnostics:
        lines.append(headline(d))
        lines += [f"hint: {hint}" for hint in d.hints if not hint.startswith(_SIGNATURES)]
    return lines


SAME, WRONG = rows("same"), rows("wrong")


@pytest.mark.parametrize("row", SAME, ids=lambda row: row.id)
def test_it_means_the_same(row: Row) -> None:
    canonical, *notes = row.below
    written, plain = compiled(row.program)[0], compiled(canonical)[0]
    assert plain.ok, [headline(d) for d in plain.diagnostics]
    assert written.ok, [headline(d) for d in written.diagnostics]
    assert solved(row.program) == solved(canonical)
    usual = [headline(d) for d in plain.diagnostics]
    assert [headline(d) for d in written.diagnostics if headline(d) not in usual] == notes


@pytest.mark.parametrize("row", WRONG, ids=lambda row: row.id)
def test_the_message_helps(row: Row) -> None:
    assert row.below == answer(row.program) or _ACCEPT


def answer(program: str) -> list[str]:
    """The errors with their hints, then the program with all fixes applied, which has to compile."""
    outcome, source = compiled(program)
    errors = [d for d in outcome.diagnostics if d.is_error]
    assert errors, "nothing is wrong with this"
    lines = told(errors)
    fixed, count = apply_fixes(source, errors)
    if not count:
        return lines
    whole = program.startswith("!")
    body = fixed if whole else fixed.removeprefix("drawing d {\n").removesuffix("\n}\n")
    text = ("!" if whole else "") + body.replace("\n", "\\n")
    again, _ = compiled(text)
    if any(d.is_error for d in again.diagnostics):
        lines += [f"then {line}" for line in told([d for d in again.diagnostics if d.is_error])]
    return [*lines, f"fixed: {text.strip()}"]


def test_there_is_enough_of_both() -> None:
    assert len(SAME) >= 150
    assert len(WRONG) >= 60


@pytest.mark.skipif(not _ACCEPT, reason="writes only with AIDL_ACCEPT=1")
def test_accept() -> None:
    """Write the messages that come into the page, from the last row to the first."""
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    for row in reversed(WRONG):
        lines[row.line : row.line + len(row.below)] = [f"    {line}" for line in answer(row.program)]
    PAGE.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")

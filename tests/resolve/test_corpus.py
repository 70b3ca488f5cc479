"""A corpus of misspelt and foreign names: what is mended unasked has the meaning that was wanted, and nothing
that is offered turns a meaning round.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.source import SourceFile
from aidl_lang.tools.mending import mend

CORPUS = Path(__file__).parent / "names.txt"
NONE = "none"


@dataclass(frozen=True)
class Case:
    """A name, the program it stands in, what it was to mean, and what is not to be offered for it."""

    context: str
    program: str
    name: str
    wanted: str
    never: tuple[str, ...]

    @property
    def place(self) -> str:
        return f"{self.context}: {self.name}"

    def written(self, name: str) -> SourceFile:
        return SourceFile("part.aidl", self.program.replace("?", name))


@dataclass(frozen=True)
class Verdict:
    """`kind` is `mended` or `mended wrongly`, unasked; `read` as written, or `read otherwise`; `offered` or
    `offered another`, in a message; or else `told`.
    """

    kind: str
    offered: tuple[str, ...] = ()


def cases() -> Iterator[Case]:
    context = program = ""
    for line in CORPUS.read_text("utf-8").splitlines():
        if not line or line.startswith("#"):
            continue
        if head := re.fullmatch(r"\[(.*?)\] (.*)", line):
            context, program = head.groups()
            continue
        name, wanted, *never = line.split()
        yield Case(context, program, name, wanted, tuple(never[1:]))


def judged(case: Case) -> Verdict:
    source = case.written(case.name)
    mended = mend(source)
    found = mended.diagnostics if mended.source is source else pipeline.check(source)
    offered = tuple(offers(found))
    if mended.source.text != source.text:
        is_right = case.wanted != NONE and meaning(mended.source) == meaning(case.written(case.wanted))
        return Verdict("mended" if is_right else "mended wrongly", offered)
    if not any(d.is_error for d in found):
        is_right = case.wanted == NONE or meaning(source) == meaning(case.written(case.wanted))
        return Verdict("read" if is_right else "read otherwise", offered)
    if not offered:
        return Verdict("told")
    is_right = offered[0] == case.wanted or meaning(case.written(offered[0])) == meaning(
        case.written(case.wanted)
    )
    return Verdict("offered" if is_right else "offered another", offered)


def offers(found: list[Diagnostic]) -> Iterator[str]:
    """The names that messages and fixes propose."""
    for d in found:
        yield from re.findall(r"did you mean `@?(\w+)`", " ".join((d.message, *d.hints)))
        if d.fix is not None:
            yield from (edit.replacement for edit in d.fix.edits if edit.replacement.isidentifier())


def meaning(source: SourceFile) -> str:
    """A program with every name spelled as it is defined: alike for programs that say the same."""
    return pipeline.formatted(source)[0] or source.text


@pytest.mark.parametrize("case", list(cases()), ids=lambda case: case.place)
def test_nothing_is_mended_into_another_meaning(case: Case) -> None:
    verdict = judged(case)
    assert verdict.kind not in ("mended wrongly", "read otherwise")
    assert not set(verdict.offered) & set(case.never)


def test_the_corpus_is_large_enough() -> None:
    assert len(list(cases())) >= 300

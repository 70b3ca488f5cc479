"""Every snippet, with what it suggests, is a statement that the parser and the checker take."""

from __future__ import annotations

import json
import re

import pytest

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Severity
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld
from aidl_lang.tools.vocabulary import SNIPPETS, Snippet, expanded, vocabulary
from tests.documents import ROOT

PARTS = "solid washer(outer = 20) { rim = circle(radius: outer / 2) }\n"
SOLID = "{ r = circle(center: (0, 0), radius: 4) }"
AROUND = {
    "file": "SNIPPET\nsolid s { r = circle(center: (0, 0), radius: 4) }\n",
    "block": f"assembly s {{ solid p {SOLID}\nSNIPPET\n}}\n",
    "attribute": f"SNIPPET\nsolid s {SOLID}\n",
    "constraints": f"assembly s {{ solid a {SOLID} solid b {SOLID} constrain {{\nSNIPPET\n}} }}\n",
}
UNFINISHED = {"W0201", "W0202", "W0705"}
"""A parameter that nothing uses yet, a block without constraints, parts that are not put together."""

ID = [pytest.param(s, id=s.prefix) for s in SNIPPETS]


def program(snippet: Snippet) -> str:
    around = AROUND[snippet.place]
    if snippet.prefix == "hole":  # of something
        around = "solid s { r = rectangle(width: 60, height: 40)\nSNIPPET\n}\n"
    if snippet.prefix == "holes":
        around = "solid s { r = rectangle(width: 160, height: 40)\nSNIPPET\n}\n"
    if snippet.prefix in ("@behind", "@in_front"):  # of a sibling
        around = f"assembly s {{ solid other {SOLID}\nSNIPPET\nsolid p {SOLID} }}\n"
    if snippet.prefix == "@depth":  # of a hole
        around = f"solid s {{ b = rectangle(width: 60, height: 40)\nSNIPPET\nhole h {SOLID} }}\n"
    if snippet.prefix == "@clip":
        around = "SNIPPET\nsolid s { outline = circle(center: (0, 0), radius: 4) }\n"
    return around.replace("SNIPPET", expanded(snippet.body))


@pytest.mark.parametrize("snippet", ID)
def test_expanded_it_compiles(snippet: Snippet) -> None:
    text = program(snippet)
    compiled = pipeline.compile(SourceFile("s.aidl", text), MemoryWorld({"parts.aidl": PARTS}))
    assert [d for d in compiled.diagnostics if d.is_error] == [], text
    warned = {d.code for d in compiled.diagnostics if d.severity is Severity.WARNING}
    assert warned <= UNFINISHED, text


def test_the_kinds_stand_alone() -> None:
    for snippet in SNIPPETS:
        if snippet.prefix in vocabulary().kinds:
            assert pipeline.compile(SourceFile("s.aidl", expanded(snippet.body))).ok, expanded(snippet.body)


@pytest.mark.parametrize("snippet", ID)
def test_its_places_are_numbered_and_agree(snippet: Snippet) -> None:
    numbers = [int(a or b) for a, b in re.findall(r"\$\{(\d+):|\$(\d+)", snippet.body)]
    assert set(numbers) - {0} == set(range(1, max([*numbers, 1]) + (max(numbers) > 0)))
    assert numbers.count(0) == 1
    given = re.findall(r"\$\{(\d+):([^}]*)\}", snippet.body)
    assert len(dict(given)) == len(set(given)), "one number, one suggestion"


def test_every_kind_and_every_statement_has_one() -> None:
    prefixes = [s.prefix for s in SNIPPETS]
    assert len(set(prefixes)) == len(prefixes)
    words = vocabulary()
    assert {*words.kinds, *words.statements} - {"construction"} <= set(prefixes)
    assert {f"@{name}" for name in words.attributes} - {"@colour"} == {p for p in prefixes if p[0] == "@"}


def test_the_file_of_the_editor_has_them_all() -> None:
    data = json.loads((ROOT / "editors/vscode/snippets/aidl.json").read_text("utf-8"))
    assert [(s["prefix"], "\n".join(s["body"]), s["description"]) for s in data.values()] == [
        (s.prefix, s.body, s.title) for s in SNIPPETS
    ]

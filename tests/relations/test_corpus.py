"""Every program of the corpus solves, and keeps the sizes that it does not say must change."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from pathlib import Path

import pytest

import aidl_lang
from aidl_lang.checking import library
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from tests import compiled

CORPUS = sorted((Path(__file__).parent / "corpus").glob("*.aidl"))
DEAR = {"meshing", "outlines", "places", "shapes", "sides", "turned_holder"}
"""The largest are slow: shapes and relations stand in the others as well."""


@pytest.mark.parametrize("path", compiled.lighter(CORPUS, DEAR))
def test_constraints_hold_and_kept_sizes_change_only_where_the_program_says_they_must(path: Path) -> None:
    """A program lists in `// changes:` the geometry whose sizes its constraints force to change."""
    text = path.read_text("utf-8")
    model = compiled.model(text)
    assert [d.message for d in model.diagnostics if d.is_error] == []
    assert model.status == "solved"
    document = compiled.json_of(text)
    assert [c["text"] for c in document["constraints"] if not c.get("soft") and not c["satisfied"]] == []
    listed = re.search(r"^// changes: *(.*)$", text, re.MULTILINE)
    allowed = set(listed[1].split(", ")) if listed else set()
    assert {c["path"].partition(".")[2].rpartition(".")[0] for c in document["changed"]} == allowed


def _statements() -> list[tuple[str, ast.Node]]:
    return [(m.source.name, s) for m in library.load().modules for s in m.statements]


def _public(kind: type, *files: str) -> set[str]:
    """The documented definitions of a kind, of some files or of all."""
    return {
        s.name.text
        for name, s in _statements()
        if isinstance(s, kind) and s.doc and (not files or name.rpartition("/")[2] in files)
    }


def _called(nodes: Iterable[ast.Node]) -> set[str]:
    """The names of all calls, by the library's name for each."""
    other = {s.name.text: s.target.text for _, s in _statements() if isinstance(s, ast.Alias)}
    names = {n.callee.text for n in nodes if isinstance(n, ast.Call)}
    return names | {other[name] for name in names if name in other}


def _corpus() -> list[ast.Node]:
    modules = [parse(SourceFile(p.name, p.read_text("utf-8"))).module for p in CORPUS]
    return [node for module in modules for node in ast.walk(module)]


def unused() -> set[str]:
    """Returns the public constraints that no program of the corpus states, and the measures and places that
    none names.
    """
    blocks = [node.items for node in _corpus() if isinstance(node, ast.Constrain)]
    items = [n.value for b in blocks for n in ast.walk(b) if isinstance(n, ast.ExpressionStatement)]
    measures = _public(ast.FunctionDefinition, "measures.aidl", "clearance.aidl", "placement.aidl")
    assert {"gap", "clearance", "between"} <= measures
    return (_public(ast.ConstraintDefinition) - _called(items)) | (measures - _called(_corpus()))


def _ends(path: Path) -> list[dict[str, float]]:
    """Each numeric knob of a program at the ends of its range, one at a time."""
    knobs = compiled.model(path.read_text("utf-8")).params.values()
    return [{k.path: end} for k in knobs for end in (k.low, k.high) if end is not None]


@pytest.mark.parametrize("path", compiled.FEW)
def test_examples_hold_at_the_ends_of_their_knobs(path: Path) -> None:
    """An assertion of the program may refuse a value; the constraints hold all the same."""
    text = path.read_text("utf-8")
    for params in _ends(path):
        model = aidl_lang.compile(text, params=params)
        assert {d.code for d in model.diagnostics if d.is_error} <= {"E0604"}, params
        if model.status == "wrong":
            continue
        assert model.status == "solved", params
        assert all(c["satisfied"] for c in json.loads(model.to_json())["constraints"] if not c.get("soft"))

"""Every example and every program of the corpus solves, and an independent reading of the result agrees."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import aidl_lang
from aidl_lang.checking import library
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.tools.reference.collect import reference
from tests import compiled
from tests.checker.checking import TOLERANCE, Finding, check
from tests.checker.model import fold
from tests.checker.relations import RELATIONS

CORPUS = sorted((Path(__file__).parent / "corpus").glob("*.aidl"))
_CHANGES = re.compile(r"^// changes: *(.*)$", re.MULTILINE)


def _name(path: Path) -> str:
    return f"{path.parent.name}/{path.stem}"


@cache
def _solved(path: Path) -> tuple[str, dict[str, Any]]:
    text = path.read_text("utf-8")
    model = compiled.model(text)
    errors = [f"line {d.span.line if d.span else 0}: {d.message}" for d in model.diagnostics if d.is_error]
    assert errors == []
    assert model.status == "solved"
    return text, compiled.json_of(text)


@cache
def _findings(path: Path) -> list[Finding]:
    return check(*_solved(path))


DEAR = {"gear_pair", "meshing", "outlines", "places", "shapes", "sides", "turned_holder"}
ALL = [
    pytest.param(path, id=_name(path), marks=[pytest.mark.slow] if path.stem in DEAR else [])
    for path in compiled.EXAMPLES + CORPUS
]
"""The largest are slow: shapes and relations stand in the others as well, gears mesh in `test_checker`."""


UNREAD = {
    "held": 2,
    "own_words": 1,
    "patterns": 7,
    "values": 2,
}
"""Statements about what the document does not tell: clearances of outlines that are not convex, what is asked
of a pattern or of a `let` in a shape, what is `fixed` where it was written.
"""


@pytest.mark.parametrize("path", ALL)
def test_every_constraint_holds_and_kept_sizes_change_only_where_they_must(path: Path) -> None:
    """By the coordinates; a program of the corpus lists in `// changes:` the geometry whose sizes its
    constraints force to change.
    """
    findings = _findings(path)
    assert any(f.kind == "constraint" for f in findings)
    assert [str(f) for f in findings if not f.holds and f.residual is not None] == [], f"over {TOLERANCE}"
    unread = sum(f.residual is None for f in findings)
    if path in CORPUS:
        assert unread == UNREAD.get(path.stem, 0)
        text, document = _solved(path)
        listed = _CHANGES.search(text)
        changed = {c["path"].partition(".")[2].rpartition(".")[0] for c in document["changed"]}
        assert changed == (set(listed[1].split(", ")) if listed else set())
    assert 4 * unread < len(findings)


@pytest.mark.parametrize("path", ALL)
def test_the_checker_and_the_document_speak_of_the_same_constraints(path: Path) -> None:
    """Those that the program writes; the document has hidden equations too (arguments of templates)."""
    text, document = _solved(path)
    hard = [c for c in document["constraints"] if not c.get("soft")]
    assert all(c["satisfied"] for c in hard)
    checked = {f.line for f in _findings(path)}
    assert {c["line"] for c in hard if c["text"] in text} <= checked


def _public(kind: type, *files: str) -> set[str]:
    """The documented definitions of a kind, of some files or of all."""
    return {
        name
        for name, overloads in library.load().callables.items()
        for s in overloads
        if s.kind is kind and s.node.doc
        if not files or s.node.span.source.name.rpartition("/")[2] in files
    }


def _called(nodes: Iterable[ast.Node]) -> set[str]:
    """The names of all calls, by the library's name for each."""
    other = {fold(name): target for name, target in library.load().aliases.items()}
    names = {n.callee.text for n in nodes if isinstance(n, ast.Call)}
    return names | {other[fold(name)] for name in names if fold(name) in other}


def unused() -> set[str]:
    """Returns the public constraints that no program of the corpus states, nor the example of any in the
    library, and the measures and places that none names: all these programs are judged from outside.
    """
    entries = reference().entries.values()
    texts = [p.read_text("utf-8") for p in CORPUS]
    texts += [e.doc.example for e in entries if e.sort in ("constraint", "relation")]
    nodes = [node for text in texts for node in ast.walk(parse(SourceFile("<text>", text)).module)]
    blocks = [node.items for node in nodes if isinstance(node, ast.Constrain)]
    items = [n.value for b in blocks for n in ast.walk(b) if isinstance(n, ast.ExpressionStatement)]
    measures = _public(ast.FunctionDefinition, "measures.aidl", "clearance.aidl", "placement.aidl")
    assert {"gap", "clearance", "between"} <= measures
    return (_public(ast.ConstraintDefinition) - _called(items)) | (measures - _called(nodes))


def unjudged() -> set[str]:
    """Returns the public constraints that the outside check does not know."""
    return {name for name in _public(ast.ConstraintDefinition) if fold(name) not in RELATIONS}


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
        findings = check(text, json.loads(model.to_json()))
        assert [
            str(f) for f in findings if f.residual is not None and not f.holds and f.kind == "constraint"
        ] == [], params

"""Every example and every program of the corpus solves, and an independent reading of the result agrees."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

import aidl_lang
from tests.checker.checking import TOLERANCE, check

ROOT = Path(__file__).resolve().parents[2]
CORPUS = sorted((Path(__file__).parent / "corpus").glob("*.aidl"))
EXAMPLES = sorted((ROOT / "examples").glob("*.aidl"))
_CHANGES = re.compile(r"^// changes: *(.*)$", re.MULTILINE)


def _name(path: Path) -> str:
    return f"{path.parent.name}/{path.stem}"


def _solved(path: Path) -> tuple[str, dict[str, Any]]:
    text = path.read_text("utf-8")
    model = aidl_lang.compile(text)
    errors = [f"line {d.span.line if d.span else 0}: {d.message}" for d in model.diagnostics if d.is_error]
    assert errors == []
    assert model.status == "solved"
    return text, json.loads(model.to_json())


@pytest.mark.parametrize("path", EXAMPLES + CORPUS, ids=_name)
def test_every_constraint_holds_on_the_coordinates(path: Path) -> None:
    text, document = _solved(path)
    findings = check(text, document)
    assert any(f.kind == "constraint" for f in findings)
    assert [str(f) for f in findings if not f.holds] == [], f"residuals of {TOLERANCE} or more, or unchecked"


@pytest.mark.parametrize("path", EXAMPLES + CORPUS, ids=_name)
def test_the_checker_and_the_document_speak_of_the_same_constraints(path: Path) -> None:
    text, document = _solved(path)
    assert all(c["satisfied"] for c in document["constraints"] if not c.get("soft"))
    checked = {f.line for f in check(text, document)}
    assert {c["line"] for c in document["constraints"] if not c.get("soft")} <= checked


@pytest.mark.parametrize("path", CORPUS, ids=_name)
def test_kept_sizes_change_only_where_the_program_says_they_must(path: Path) -> None:
    """A program of the corpus lists in `// changes:` the sizes that its constraints force to change."""
    text, document = _solved(path)
    listed = _CHANGES.search(text)
    allowed = set(listed[1].split(", ")) if listed else set()
    changed = {c["path"].partition(".")[2] for c in document["changed"]}
    assert changed == allowed


def test_the_corpus_is_large_enough() -> None:
    assert len(CORPUS) >= 25

"""The tables are made of the grammar once, and kept as data."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import pytest

from aidl_lang.common import resources
from aidl_lang.common.resources import resource
from aidl_lang.syntax import tables
from aidl_lang.syntax.construction import build_tables

SMALL = """
module: ((NAME | CALL) ";")*
NAME: /[a-z]+/
CALL: /[a-z]+\\(/
%ignore /[ ]+/
"""


def _same(a: tables.Tables, b: tables.Tables) -> bool:
    names = [f.name for f in fields(tables.Tables) if f.name != "steps"]
    return all(getattr(a, name) == getattr(b, name) for name in names)


def test_what_was_kept_is_what_was_built() -> None:
    built = build_tables(resource("grammar/aidl.lark").read_text(encoding="utf-8"))
    assert _same(tables.decoded(tables.encoded(built)), built)
    assert _same(tables.load_tables(), built)


def test_they_are_plain_data() -> None:
    assert json.loads(tables.built())["start"] == 0


def test_a_checkout_has_the_tables_of_its_grammar(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    grammar = tmp_path / "aidl.lark"
    grammar.write_text(SMALL)
    monkeypatch.setattr(tables, "resource", lambda name: grammar)
    monkeypatch.setattr(resources, "_CHECKOUT", tmp_path)
    assert tables.load_tables.__wrapped__().literals == {";"}
    grammar.write_text(SMALL.replace('";"', '"!"'))
    assert tables.load_tables.__wrapped__().literals == {"!"}
    assert len(list((tmp_path / "build" / "derived").iterdir())) == 1


def test_nobody_needs_lark_to_parse() -> None:
    program = (
        "import sys; from aidl_lang.syntax.tables import load_tables; load_tables();"
        "sys.modules.update(lark=None, interegular=None);"
        "from aidl_lang.parser import parse; from aidl_lang.common.source import SourceFile;"
        "print(len(parse(SourceFile('', 'let a = 3')).module.statements), 'pickle' in sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["1", "False"]

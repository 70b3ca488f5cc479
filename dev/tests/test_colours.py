"""The files made for editors, and the grammar for TextMate among them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from aidl_dev.grammars import formats
from aidl_dev.highlighting.scopes import SCOPES
from aidl_dev.highlighting.site import write
from aidl_lang.tools.highlighting import CLASSES
from aidl_lang.tools.vocabulary import vocabulary
from tests.documents import ROOT


def test_what_is_right_is_not_written_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(formats, "texts", dict)  # which take long to work out
    (tmp_path / "tests/editors").mkdir(parents=True)
    (tmp_path / "tests/editors/classes.aidl").write_text("x = 5mm\n", "utf-8")
    write(tmp_path)
    paths = [path for path in tmp_path.rglob("*") if path.is_file()]
    before = [path.stat().st_mtime_ns for path in paths]
    write(tmp_path)
    assert len(paths) > 5
    assert [path.stat().st_mtime_ns for path in paths] == before
    samples = json.loads((tmp_path / "tests/editors/classes.json").read_text("utf-8"))
    assert samples["programs"]["tests/editors/classes.aidl"] == [
        *([0, 1, "name.definition"], [2, 3, "operator.assignment"], [4, 5, "number"], [5, 7, "unit"])
    ]


def test_every_class_has_a_scope() -> None:
    assert set(SCOPES) == set(CLASSES)


# --- TextMate --------------------------------------------------------------------------------------


def grammar() -> dict:
    return json.loads((ROOT / "editors/vscode/syntaxes/aidl.tmLanguage.json").read_text("utf-8"))


def test_every_rule_that_is_named_is_there_and_used() -> None:
    data = grammar()
    named = set(re.findall(r'"include": "#(\w+)"', json.dumps(data)))
    assert named == set(data["repository"])


def test_every_word_is_in_the_grammar() -> None:
    words = vocabulary()
    spelled = set(re.findall(r"\w+", re.sub(r"\\[pGsbS]", " ", json.dumps(grammar(), ensure_ascii=False))))
    wanted = {*words.keywords, *words.kind_words, *words.attributes, *words.everywhere, *words.constants}
    wanted |= {name for name, kind in words.named().items() if kind != "constants"}
    assert wanted <= spelled


def test_configuration_agrees_with_the_words() -> None:
    data = json.loads((ROOT / "editors/vscode/language-configuration.json").read_text("utf-8"))
    brackets = [sign for pair in data["brackets"] for sign in pair]
    assert sorted(brackets) == sorted(vocabulary().brackets)
    assert data["comments"] == {"lineComment": "//", "blockComment": ["/*", "*/"]}

"""The files made for editors are up to date, and the Pygments lexer colours as the classes say."""

from __future__ import annotations

import json
import re
import sys
import tomllib
from importlib.metadata import EntryPoint

import pytest
from pygments import highlight
from pygments.formatters import HtmlFormatter, LatexFormatter
from pygments.styles import get_all_styles
from pygments.token import STANDARD_TYPES, Error, Name, Whitespace

from aidl_lang.tools.highlighting.classes import CLASSES, classify
from aidl_lang.tools.highlighting.pygments import TOKENS, AidlLexer
from aidl_lang.tools.highlighting.scopes import SCOPES
from aidl_lang.tools.highlighting.site import texts, write
from aidl_lang.tools.vocabulary import vocabulary
from tests.documents import ROOT

PROGRAMS = [*sorted((ROOT / "examples").glob("*.aidl")), ROOT / "tests/editors/classes.aidl"]


def test_what_is_right_is_not_written_again(tmp_path) -> None:
    (tmp_path / "tests/editors").mkdir(parents=True)
    (tmp_path / "tests/editors/classes.aidl").write_text("x = 5mm\n", "utf-8")
    write(tmp_path)
    paths = [tmp_path / path for path in texts(tmp_path)]
    before = [path.stat().st_mtime_ns for path in paths]
    write(tmp_path)
    assert [path.stat().st_mtime_ns for path in paths] == before
    samples = json.loads((tmp_path / "tests/editors/classes.json").read_text("utf-8"))
    assert samples["programs"]["tests/editors/classes.aidl"] == [
        *([0, 1, "name.definition"], [2, 3, "operator.assignment"], [4, 5, "number"], [5, 7, "unit"])
    ]


# --- Pygments ------------------------------------------------------------------------------------


def test_every_class_has_a_token_and_a_scope() -> None:
    assert set(TOKENS) == set(SCOPES) == set(CLASSES)
    assert all(token in STANDARD_TYPES or token.parent in STANDARD_TYPES for token in TOKENS.values())


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.name)
def test_every_token_is_coloured_as_its_class(path) -> None:
    text = path.read_text("utf-8")
    kinds = {start: TOKENS[kind] for start, _, kind in classify(text)}
    end = 0
    for start, token, value in AidlLexer(ensurenl=False, stripnl=False).get_tokens_unprocessed(text):
        assert start == end
        assert text[start:].startswith(value)
        assert token is (Whitespace if not value.strip() else kinds[start])
        assert token is not Error
        end += len(value)
    assert end == len(text)


def test_pygments_itself_finds_the_lexer() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    [(name, value)] = project["entry-points"]["pygments.lexers"].items()
    assert EntryPoint(name, value, "pygments.lexers").load() is AidlLexer
    assert name in AidlLexer.aliases
    assert "*.aidl" in AidlLexer.filenames


@pytest.mark.parametrize(
    "text", ["", "\n", "'open", "/* open", "\ufeffsolid a {", "}{)(", "5px", "x\r\ny", "\0"]
)
def test_broken_programs_are_coloured_too(text: str) -> None:
    assert "".join(value for _, _, value in AidlLexer().get_tokens_unprocessed(text)) == text
    assert isinstance(highlight(text, AidlLexer(), HtmlFormatter()), str)


def test_other_formats_take_it() -> None:
    text = (ROOT / "examples/telephone.aidl").read_text("utf-8")
    latex = highlight(text, AidlLexer(), LatexFormatter())
    assert r"\PY{n+nc}{telephone}" in latex
    html = highlight(text, AidlLexer(), HtmlFormatter())
    assert '<span class="mi">' not in html
    assert re.search(r'<span class="nc">telephone</span>', html)
    assert {"default", "monokai"} <= set(get_all_styles())


def test_the_core_does_without_pygments() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert not [line for line in project["dependencies"] if line.startswith("pygments")]
    importers = [
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "aidl_lang").rglob("*.py")
        if re.search(r"^(?:from|import) pygments\b", path.read_text("utf-8"), re.MULTILINE)
    ]
    assert importers == ["aidl_lang/tools/highlighting/pygments.py"]
    assert Name.Class is TOKENS["name.structure"]
    assert "pygments" in sys.modules


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

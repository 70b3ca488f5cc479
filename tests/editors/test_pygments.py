"""The Pygments lexer colours as the classes say."""

from __future__ import annotations

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
from tests.documents import ROOT

PROGRAMS = [*sorted((ROOT / "examples").glob("*.aidl")), ROOT / "tests/editors/classes.aidl"]


def test_every_class_has_a_token() -> None:
    assert set(TOKENS) == set(CLASSES)
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

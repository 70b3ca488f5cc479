"""What each token is, compared with the syntax tree, which the classes are not made from; and Pygments."""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterator
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pygments import highlight
from pygments.formatters import HtmlFormatter, LatexFormatter
from pygments.styles import get_all_styles
from pygments.token import STANDARD_TYPES, Error, Name, Whitespace

from aidl_lang.checking.types import PUBLIC
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import tokenize
from aidl_lang.tools.highlighting import CLASSES, Piece, classify
from aidl_lang.tools.highlighting.pygments import TOKENS, AidlLexer
from aidl_lang.tools.reference.collect import reference
from tests.amount import some
from tests.documents import ROOT

EVERYTHING = Path(__file__).with_name("classes.aidl")
FOLDERS = ("examples", "stdlib", "eval/aidl_eval/prompts")
FILES = [*some([p for folder in FOLDERS for p in sorted((ROOT / folder).rglob("*.aidl"))], 3), EVERYTHING]
OF_TOKEN: dict[str, str | tuple[str, ...]] = {
    "NAME": ("name", "kind", "attribute"),
    "CALL": ("call", "attribute", "name.function", "name.template"),
    "NUMBER": "number",
    "STRING": "string",
    "@": "attribute.sign",
    **dict.fromkeys(("true", "false", "True", "False"), "constant.truth"),
    **dict.fromkeys(("as", "from", "then"), ("keyword.import", "keyword.control", "name")),
    **dict.fromkeys("()[]{}", "bracket"),
    **dict.fromkeys(",;:.", "punctuation"),
}
"""How the class of a token begins; of other words with `keyword`, of other signs with `operator`."""
TOLD_BY_THE_TREE = {kind for kind in CLASSES if kind.startswith(("kind", "call", "name."))} - {
    *("name.everywhere", "name.constant", "name.module"),
}
SORTS = {entry.name: entry.sort for entry in reference().entries.values()} | {
    alias: reference().entries[target].sort for alias, target in reference().aliases.items()
}


def expected(text: str) -> dict[int, str]:
    """What the tree says of names, by where they begin; of calls with what the reference says."""
    source = SourceFile("", text)
    found: dict[int, str] = {}
    for node in ast.walk(parse(source).module):
        for name, kind in _named(node):
            found[name.span.start] = kind
    return found


def _named(node: ast.Node) -> Iterator[tuple[ast.Identifier, str]]:
    match node:
        case ast.Structure():
            yield node.kind_word, "kind"
            yield node.name, "name.structure" if node.parameters is None else "name.template"
        case ast.FunctionDefinition() | ast.ShapeDefinition() | ast.ConstraintDefinition():
            yield node.name, "name.function"
        case ast.Param() | ast.Var() | ast.Let() | ast.Assign() | ast.Alias():
            yield node.name, "name.definition"
        case ast.Parameter():
            yield node.name, "name.parameter"
            if node.type is not None:
                yield node.type, "name.type"
        case ast.For() | ast.ForArguments() | ast.Comprehension():
            yield from ((name, "name.definition") for name in node.variables)
        case ast.Import():
            yield from ((name, "name.definition") for name in (*node.names, node.alias) if name is not None)
        case ast.Attribute():
            yield node.name, "attribute"
        case ast.Argument(name) if name is not None:
            yield name, "name.argument"
        case ast.Member():
            yield node.name, "name.member"
        case ast.Call():
            yield node.callee, _call(node)


def _call(node: ast.Call) -> str:
    sort = SORTS.get(node.callee.text)
    if sort in ("shape", "template") or node.callee.text in PUBLIC:
        return "call.shape"
    if sort in ("constraint", "relation"):
        return "call.constraint"
    if sort in ("function", "builtin"):
        return "call.function"
    return "call" if node.receiver is None else "call.member"


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_names_are_what_the_tree_says_and_other_tokens_of_their_kind(path: Path) -> None:
    text = path.read_text("utf-8")
    pieces = {piece.start: piece for piece in classify(text)}
    wanted = expected(text)
    assert wanted
    assert {start: pieces[start].kind for start in wanted if start in pieces} == wanted
    for piece in pieces.values():
        if piece.kind in TOLD_BY_THE_TREE:
            assert piece.start in wanted, (piece, text[piece.start : piece.end])
    by_end = {piece.end: piece.kind for piece in pieces.values()}
    for token in tokenize(SourceFile("", text)).tokens[:-1]:
        others = "keyword." if token.kind.isidentifier() else "operator."
        assert pieces[token.start].kind.startswith(OF_TOKEN.get(token.kind, others)), token
        if token.kind == "CALL":
            assert pieces[token.end - 1].kind == "bracket"
        if token.kind == "NUMBER":
            assert by_end[token.end] == ("number" if token.text[-1].isdigit() else "unit"), token


SCRAPS = st.sampled_from(
    [*"()[]{}@.,:;=+-*/^!\"'#\n\t°€\U0001d4b3\ufeff", "==", "..", "///", "/*", "*/", "\r\n", "\\",
     "solid", "f(",
     "for", "in", "import", "from", "as", "then", "if", "else", "constrain", "constraint c(", "fn f(", "at",
     "x", " x", " ", "5mm", "5px", "1e", "0..9", '"a\\"', "@color(", "template", "param", "rotated", "part "]
)  # fmt: skip


@given(st.lists(SCRAPS, max_size=30).map("".join))
def test_whatever_is_written_the_pieces_cover_it(text: str) -> None:
    pieces: list[Piece] = classify(text)
    end = 0
    for piece in pieces:
        assert end <= piece.start < piece.end
        assert piece.kind in CLASSES
        assert not text[end : piece.start].strip(" \t\r\n\f\ufeff")
        end = piece.end
    assert not text[end:].strip(" \t\r\n\f\ufeff")


def test_every_class_has_a_token() -> None:
    assert set(TOKENS) == set(CLASSES)
    assert all(token in STANDARD_TYPES or token.parent in STANDARD_TYPES for token in TOKENS.values())


@pytest.mark.parametrize("path", FILES[::-4], ids=lambda path: path.name)
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

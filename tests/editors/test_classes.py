"""What each token is, compared with the syntax tree, which the classes are not made from."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.checking.types import PUBLIC
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import tokenize
from aidl_lang.tools.highlighting.classes import CLASSES, Piece, classify
from aidl_lang.tools.reference.collect import reference
from tests.documents import ROOT

EVERYTHING = Path(__file__).with_name("classes.aidl")
FILES = [
    *(
        path
        for folder in ("examples", "stdlib", "eval/aidl_eval/prompts")
        for path in (ROOT / folder).rglob("*.aidl")
    ),
    EVERYTHING,
]
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


def check(text: str, place: str) -> None:
    pieces = {piece.start: piece for piece in classify(text)}
    wanted = expected(text)
    assert wanted, place
    found = {start: pieces[start].kind for start in wanted if start in pieces}
    assert found == wanted, place
    for piece in pieces.values():
        if piece.kind in TOLD_BY_THE_TREE:
            assert piece.start in wanted, (place, piece, text[piece.start : piece.end])


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_names_are_what_the_tree_says(path: Path) -> None:
    check(path.read_text("utf-8"), path.name)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_other_tokens_are_of_the_class_of_their_kind(path: Path) -> None:
    text = path.read_text("utf-8")
    pieces = {piece.start: piece for piece in classify(text)}
    by_end = {piece.end: piece.kind for piece in pieces.values()}
    for token in tokenize(SourceFile("", text)).tokens[:-1]:
        kind = pieces[token.start].kind
        match token.kind:
            case "NAME":
                assert kind.startswith(("name", "kind", "attribute")), token
            case "CALL":
                assert kind.startswith(("call", "attribute", "name.function", "name.template")), token
                assert pieces[token.end - 1].kind == "bracket"
            case "NUMBER":
                assert kind == "number", token
                assert by_end[token.end] == ("number" if token.text[-1].isdigit() else "unit"), token
            case "STRING":
                assert kind == "string", token
            case "true" | "false" | "True" | "False":
                assert kind == "constant.truth", token
            case "as" | "from" | "then":
                assert kind.startswith(("keyword.import", "keyword.control", "name")), token
            case word if word.isidentifier():
                assert kind.startswith("keyword."), token
            case "@":
                assert kind == "attribute.sign"
            case "(" | ")" | "[" | "]" | "{" | "}":
                assert kind == "bracket"
            case "," | ";" | ":" | ".":
                assert kind == "punctuation"
            case _:
                assert kind.startswith("operator."), token


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

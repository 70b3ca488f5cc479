"""The queries of the tree-sitter grammar: each compiles, fits somewhere, and colours as the classes say."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from tree_sitter import Node, Query, QueryCursor

from aidl_dev.highlighting.scopes import HELIX, NEOVIM
from aidl_dev.highlighting.tree_sitter import queries
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse as read
from aidl_lang.syntax import ast
from aidl_lang.tools.highlighting import classify
from tests.documents import ROOT
from tests.editors.trees import FOLDER, language, nodes, parse

FILES = sorted((FOLDER / "queries").rglob("*.scm"))
COLOURED = [*sorted((ROOT / "examples").glob("*.aidl")), ROOT / "tests/editors/classes.aidl"]
STARTS = (
    *("structure", "param_declaration", "let_declaration", "assignment", "expression_statement"),
    "for_statement",
)
FOLDABLE = {
    *("block", "constraint_block", "argument_block", "parameters", "arguments", "list", "block_comment"),
    *("doc_comment", "line_comment", "import_statement"),
}


def query(path: Path) -> Query:
    return Query(language(), path.read_text("utf-8"))


@cache
def texts() -> tuple[str, ...]:
    """The examples, and a program that has all there is."""
    corpus = [path.read_text("utf-8") for path in sorted((FOLDER / "test/corpus").glob("*.txt"))]
    cases = [case for text in corpus for case in re.findall(r"(?ms)^={20,}\n(.*?)^-{20,}\n", text)]
    return (*(path.read_text("utf-8") for path in COLOURED), *cases)


def captured(compiled: Query, text: str) -> list[tuple[str, Node, int]]:
    """Each capture with its node and the number of its pattern."""
    matches = QueryCursor(compiled).matches(parse(text).root_node)
    return [(name, n, number) for number, caught in matches for name, ns in caught.items() for n in ns]


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(FOLDER / "queries")))
def test_every_pattern_of_a_query_fits_somewhere(path: Path) -> None:
    compiled = query(path)
    seen = {(name, number) for text in texts() for name, _, number in captured(compiled, text)}
    assert {number for _, number in seen} == set(range(compiled.pattern_count))
    assert {name for name, _ in seen} == {compiled.capture_name(n) for n in range(compiled.capture_count)}


def test_only_predicates_that_every_editor_has() -> None:
    """An editor that does not know one refuses the whole query."""
    used = {word for path in FILES for word in re.findall(r"\(#([^\s)]+)", path.read_text("utf-8"))}
    assert used <= {"any-of?", "set!"}


def test_generated_queries_are_up_to_date() -> None:
    lagging = [path for path, text in queries().items() if (ROOT / path).read_text("utf-8") != text]
    assert lagging == [], "run `make colours`"


@pytest.mark.parametrize(
    ("folder", "captures"), [(FOLDER / "queries", NEOVIM), (FOLDER / "queries/helix", HELIX)]
)
def test_colours_are_those_of_the_classes(folder: Path, captures: dict[str, str]) -> None:
    """Every piece of the examples has the colour of its class, and all of it. Of several captures the one of
    the smallest node holds, and of those the last.
    """
    compiled, seen, wrong = query(folder / "highlights.scm"), Counter[str](), []
    for path in COLOURED:
        text = path.read_text("utf-8")
        colours = _colours(compiled, text)
        ends = [0]
        for char in text:
            ends.append(ends[-1] + len(char.encode()))
        for piece in classify(text):
            word = text[piece.start : piece.end]
            expected = captures["keyword.control for" if word == "for" else piece.kind]
            got = set(colours[ends[piece.start] : ends[piece.end]])
            seen[piece.kind] += 1
            if got != {expected}:
                wrong.append((path.name, text.count("\n", 0, piece.start) + 1, word, expected, got))
    assert wrong == []
    assert set(captures) - {"keyword.control for", "unknown"} <= set(seen)
    assert sum(seen.values()) > 5000


def _colours(compiled: Query, text: str) -> list[str | None]:
    """The colour of each byte."""
    found = captured(compiled, text)
    colours: list[str | None] = [None] * len(text.encode())
    for name, node, _ in sorted(found, key=lambda c: (c[1].start_byte - c[1].end_byte, c[2])):
        colours[node.start_byte : node.end_byte] = [name] * (node.end_byte - node.start_byte)
    return colours


def test_slips_are_coloured_as_wrong() -> None:
    text = "let a = 5inches\nlet b = 1...2\nlet c = 1.2.3"
    colours = _colours(query(FOLDER / "queries/highlights.scm"), text)
    wrong = "".join(
        char if colour == NEOVIM["unknown"] else " " for char, colour in zip(text, colours, strict=True)
    )
    assert wrong.split() == ["inches", "...", ".3"]


def test_folds_are_what_spans_lines() -> None:
    compiled = query(FOLDER / "queries/folds.scm")
    for text in texts():
        tree = parse(text)
        matches = QueryCursor(compiled).matches(tree.root_node)
        folds = {node.id for _, caught in matches for node in caught["fold"]}
        assert folds == {node.id for node in nodes(tree) if node.type in FOLDABLE}


@pytest.mark.parametrize(
    ("path", "inside", "closing"),
    [("indents.scm", "indent.begin", "indent.branch"), ("helix/indents.scm", "indent", "outdent")],
)
def test_indents_are_those_of_the_examples(path: str, inside: str, closing: str) -> None:
    """A line is as deep as the nodes around it that begin on lines above, those of one line counted once;
    a bracket that closes one stands where its line began. Lines that go on with an expression aside.
    """
    compiled, lines = query(FOLDER / "queries" / path), 0
    for example in COLOURED[:-1]:
        text = example.read_text("utf-8")
        found = captured(compiled, text)
        opened = [node for name, node, _ in found if name == inside]
        closers = {node.start_point for name, node, _ in found if name == closing}
        starts = {node.start_point for node in nodes(parse(text)) if node.type in STARTS}
        for row, line in enumerate(text.splitlines()):
            first = (row, len(line) - len(line.lstrip()))
            if line.strip() and (first in starts or first in closers):
                around = {n.start_point[0] for n in opened if n.start_point[0] < row <= n.end_point[0]}
                assert first[1] == 4 * (len(around) - (first in closers)), (example.name, row + 1)
                lines += 1
    assert lines > 400


def test_local_definitions_are_those_of_the_parser() -> None:
    compiled = query(FOLDER / "queries/locals.scm")
    for text in texts():
        parsed = read(SourceFile("", text))
        if not any(d.is_error for d in parsed.diagnostics):
            found = captured(compiled, text)
            names = Counter(
                n.text.decode() for name, n, _ in found if name.startswith("local.definition") and n.text
            )
            assert names == Counter(_defined(parsed.module))


def _defined(module: ast.Module) -> Iterator[str]:
    """The names that a program gives, those of single members of an array aside."""
    stack: list[ast.Node] = [module]
    while stack:
        node = stack.pop()
        stack += ast.children(node)
        match node:
            case ast.Structure() | ast.Param() | ast.Let() | ast.Var() | ast.Parameter() | ast.Alias():
                yield node.name.text
            case ast.FunctionDefinition() | ast.ShapeDefinition() | ast.ConstraintDefinition():
                yield node.name.text
            case ast.Assign() if not node.indices:
                yield node.name.text
            case ast.For() | ast.Comprehension():
                yield from (variable.text for variable in node.variables)
            case ast.Import():
                yield from (name.text for name in (*node.names, *filter(None, [node.alias])))
            case _:
                pass

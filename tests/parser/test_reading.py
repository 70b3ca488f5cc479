"""Runs `reading.md`: canonical forms, mistakes word for word with their places, what fixes make."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from aidl_lang.common.diagnostics import Diagnostic, apply_fixes
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.syntax.printer import format_expression, format_statement
from tests.documents import blocks

ROWS = {
    block.heading: [line.replace("⏎", "\n").split("  →  ") for line in block.text.splitlines()]
    for block in blocks(Path(__file__).with_name("reading.md"))
}


def rows(heading: str) -> pytest.MarkDecorator:
    return pytest.mark.parametrize(("text", "wanted"), ROWS[heading])


def found(text: str) -> tuple[Diagnostic, ...]:
    return parse(SourceFile("", text)).diagnostics


def statement(text: str) -> ast.Statement:
    parsed = parse(SourceFile("", text))
    assert [f"{d.code} {d.message}" for d in parsed.diagnostics] == []
    (only,) = parsed.module.statements
    return only


def expression(text: str) -> ast.Expression:
    let = statement(f"let _ = {text}")
    assert isinstance(let, ast.Let)
    return let.value


@rows("Expressions in their canonical form")
def test_expression(text: str, wanted: str) -> None:
    assert format_expression(expression(text)) == wanted
    assert ast.same(expression(wanted), expression(text))


@rows("Statements in their canonical form")
def test_statement(text: str, wanted: str) -> None:
    assert format_statement(statement(text)) == wanted
    assert format_statement(statement(wanted)) == wanted


@rows("How many statements there are")
def test_where_statements_end(text: str, wanted: str) -> None:
    parsed = parse(SourceFile("", text))
    assert len(parsed.module.statements) == int(wanted) if wanted != "0" else parsed.diagnostics
    assert bool(parsed.diagnostics) == (wanted == "0")


@rows("Mistakes")
def test_mistake(text: str, wanted: str) -> None:
    (d,) = found(text)
    assert d.span is not None
    assert f"{d.code} {d.span.line}:{d.span.column} {d.message}".startswith(wanted)


@rows("Mended")
def test_fix(text: str, wanted: str) -> None:
    source = SourceFile("", text)
    assert apply_fixes(source, parse(source).diagnostics)[0] == wanted


BROKEN = "let a = )|solid a b c|for in {|if { }|import 5|alias a|fn f = 3|@|x = [for]|a[|."


@pytest.mark.parametrize("text", BROKEN.split("|"))
def test_messages_speak_no_token_names(text: str) -> None:
    tokens = r"\b(NAME|CALL|NUMBER|STRING|LPAR|RPAR|__\w+|\$END)\b|<\w+>"
    assert not any(re.search(tokens, d.message) for d in found(text))


@pytest.mark.parametrize(
    ("text", "value", "unit"),
    [
        ("5", 5, None),
        ("1e3", 1000, None),
        (".5in", 0.5, "in"),
        ("1.5e-3mm", 0.0015, "mm"),
        ("30°", 30, "deg"),
    ],
)
def test_numbers(text: str, value: float, unit: str | None) -> None:
    number = expression(text)
    assert isinstance(number, ast.Number)
    assert (number.value, number.unit) == (value, unit)


def test_docs_belong_to_the_definition_below() -> None:
    plate = statement(
        "/// A plate.\n/// Thin.\n@thickness(3)\nsolid plate {\n /// wide\n param w = 5 // mm\n}"
    )
    assert isinstance(plate, ast.Structure)
    (param,) = plate.body.statements
    assert isinstance(param, ast.Param)
    assert (plate.doc, param.doc) == ("A plate.\nThin.", "wide")


def test_spans_are_those_of_the_text() -> None:
    text = "solid a { c = circle(center: (0, 0), radius: 2 * (w + 1)) }"
    nodes = list(ast.walk(parse(SourceFile("", text)).module))
    by_type = {type(node): node.span.text for node in nodes}
    assert by_type[ast.Structure] == text
    assert by_type[ast.Call] == "circle(center: (0, 0), radius: 2 * (w + 1))"
    assert by_type[ast.Point] == "(0, 0)"
    assert [n.span.text for n in nodes if isinstance(n, ast.Binary)] == ["2 * (w + 1)", "w + 1"]

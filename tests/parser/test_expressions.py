"""Expressions: precedence, spellings, numbers, texts."""

from __future__ import annotations

import pytest

from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.syntax.printer import format_expression


def read(text: str) -> ast.Expression:
    parsed = parse(SourceFile("", f"let _ = {text}"))
    assert [f"{d.code} {d.message}" for d in parsed.diagnostics] == []
    (statement,) = parsed.module.statements
    assert isinstance(statement, ast.Let)
    return statement.value


@pytest.mark.parametrize(
    ("written", "canonical"),
    [
        ("1+2*3", "1 + 2 * 3"),
        ("(1+2)*3", "(1 + 2) * 3"),
        ("1-(2-3)", "1 - (2 - 3)"),
        ("(1-2)-3", "1 - 2 - 3"),
        ("2^3^4", "2 ^ 3 ^ 4"),
        ("(2**3)**4", "(2 ^ 3) ^ 4"),
        ("-a^2", "-a ^ 2"),
        ("(-a)^2", "(-a) ^ 2"),
        ("2^-1", "2 ^ -1"),
        ("a % 2 == 0 && !b || c", "a % 2 == 0 and not b or c"),
        ("a and (b or c)", "a and (b or c)"),
        ("not (a == b)", "not a == b"),
        ("a != b", "a != b"),
        ("a < b <= c", "a < b <= c"),
        ("(a < b) == c", "(a < b) == c"),
        ("x in 3..5", "x in 3..5"),
        ("x not in [1, 2]", "not x in [1, 2]"),
        ("0..n-1", "0..n - 1"),
        ("0 .. .5", "0.. .5"),
        ("True and False", "true and false"),
        ("a if c else b", "if c then a else b"),
        ("if c then a else if d then b else e", "if c then a else if d then b else e"),
        ("(a if c else b) + 1", "(if c then a else b) + 1"),
        ("f(a, b=2, c: 3,)", "f(a, b: 2, c: 3)"),
        ("a.b(c).d[3].e", "a.b(c).d[3].e"),
        ("sum(v.width for v in a if v.width > 3)", "sum([v.width for v in a if v.width > 3])"),
        ("[v for i, v in a]", "[v for i, v in a]"),
        ("[1, 2,]", "[1, 2]"),
        ("[]", "[]"),
        ("(1, 2,)", "(1, 2)"),
        ("((1))", "1"),
        ("30°", "30deg"),
        ("1e-3mm", "1e-3mm"),
        (".5in", ".5in"),
        ("'it\\'s'", '"it\'s"'),
        ('"a\\"b\\n"', '"a\\"b\\n"'),
        ("if then then then else then", "if then then then else then"),
    ],
)
def test_reads_and_prints(written: str, canonical: str) -> None:
    expression = read(written)
    assert format_expression(expression) == canonical
    assert ast.same(read(canonical), expression)


@pytest.mark.parametrize(
    ("text", "value", "unit"),
    [("4mm", 4, "mm"), ("2.5in", 2.5, "in"), ("3m", 3, "m"), ("0.25turn", 0.25, "turn"), ("1e2", 100, None)],
)
def test_numbers(text: str, value: float, unit: str | None) -> None:
    number = read(text)
    assert isinstance(number, ast.Number)
    assert (number.value, number.unit) == (value, unit)
    assert number.text + (unit or "") == text


def test_names_may_be_spelled_otherwise() -> None:
    expression = read("CenterInside(a.Foo)")
    names = {
        node: "center_inside" for node in ast.walk(expression) if getattr(node, "text", "") == "CenterInside"
    }
    assert format_expression(expression, names) == "center_inside(a.Foo)"

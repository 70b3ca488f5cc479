"""Each construct of the language, in the form the printer gives it and in the others that mean the same."""

from __future__ import annotations

import pytest

from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.syntax.printer import format_statement


def read(text: str) -> tuple[ast.Statement, ...]:
    parsed = parse(SourceFile("test.aidl", text))
    assert [f"{d.code} {d.message}" for d in parsed.diagnostics] == []
    return parsed.module.statements


@pytest.mark.parametrize(
    ("written", "canonical"),
    [
        # structures
        ("solid a {}", "solid a {}"),
        ("part a { }", "solid a {}"),
        ("component a {}", "solid a {}"),
        ("cut a {}", "hole a {}"),
        ("sketch a {}", "drawing a {}"),
        ("group a {}", "assembly a {}"),
        ("Solid a {}", "solid a {}"),
        ("hole h[i][j + 1] {}", "hole h[i][j + 1] {}"),
        ("solid a at (10, 0) rotated 45deg {}", "solid a at (10, 0) rotated 45deg {}"),
        ("solid a rotated 45deg at(10, 0) {}", "solid a at (10, 0) rotated 45deg {}"),
        (
            "template solid w(outer = 20, inner: length = 10,) {}",
            "solid w(outer = 20, inner: length = 10) {}",
        ),
        ("solid w() {}", "solid w() {}"),
        ('@color("red")\n@detached solid a {}', '@color("red")\n@detached solid a {}'),
        ("solid a { todo }", "solid a { todo }"),
        # definitions
        ("x = circle(radius: 5)", "x = circle(radius: 5)"),
        ("x = circle(radius = 5,)", "x = circle(radius: 5)"),
        (
            "arm[i] = lug(w) at polar(5, 30deg * i) rotated -i",
            "arm[i] = lug(w) at polar(5, 30deg * i) rotated -i",
        ),
        ("construction axis = line(a, b)", "construction axis = line(a, b)"),
        ("param w = 80 in 20..200 step 5", "param w = 80 in 20..200 step 5"),
        ('param s = "round" in ["round", "square"]', 'param s = "round" in ["round", "square"]'),
        ("param w = if a > 3 then 4 else 5 in 1..9", "param w = (if a > 3 then 4 else 5) in 1..9"),
        ("var g = 5;", "var g = 5"),
        ("let h = w / 2", "let h = w / 2"),
        ("fn f(a, b = 2) = a * b", "fn f(a, b = 2) = a * b"),
        (
            "shape cross(size: length = 5) { a = line(b, c) }",
            "shape cross(size: length = 5) { a = line(b, c) }",
        ),
        ("constraint flush(a, b) { a.top == b.top }", "constraint flush(a, b) { a.top == b.top }"),
        ("alias orthogonal = perpendicular", "alias orthogonal = perpendicular"),
        ('import "a.aidl"', 'import "a.aidl"'),
        ("import 'a.aidl' as parts", 'import "a.aidl" as parts'),
        ('import a, b from "x.aidl"', 'import a, b from "x.aidl"'),
        # constraints
        ("a.x == b.x", "constrain a.x == b.x"),
        ("5 <= a.width <= 9", "constrain 5 <= a.width <= 9"),
        ("(a + b) / 2 == c", "constrain (a + b) / 2 == c"),
        ("a.x in 3..5", "constrain a.x in 3..5"),
        ("a.above(b, gap: 2)", "a.above(b, gap: 2)"),
        ("constrain a = b", "constrain a == b"),
        ("constrain { a.x = b.x, distance(a, b) = 5 }", "constrain { a.x == b.x; distance(a, b) == 5 }"),
        ("constrain { constrain a == b; touching(a, b) }", "constrain { a == b; touching(a, b) }"),
        (
            "constrain { for i in a { i == b } if n { x == y } else if m { y == z } let q = 3 prefer q }",
            "constrain { for i in a { i == b }; if n { x == y } else if m { y == z }; let q = 3; prefer q }",
        ),
        ("constrain { constrain -a == b }", "constrain { constrain -a == b }"),
        ("prefer a == b weight 3", "prefer a == b weight 3"),
        ('assert a > 3, "why"', 'assert a > 3, "why"'),
        # control
        ("for i, v in list { a = v }", "for i, v in list { a = v }"),
        ("for i in 0..<n { }", "for i in 0..<n {}"),
        ("if (a) { b = c } else { d = e }", "if a { b = c } else { d = e }"),
        ("if a {} else if b {} else {}", "if a {} else if b {} else {}"),
    ],
)
def test_reads_and_prints(written: str, canonical: str) -> None:
    (statement,) = read(written)
    assert format_statement(statement) == canonical
    (again,) = read(canonical)
    assert format_statement(again) == canonical


@pytest.mark.parametrize(
    ("written", "count"),
    [
        ("let a = b if c { d = e }", 2),
        ("constrain a.x = b.x if c { d.x == e.x }", 2),
        ("let a = b if c then_d else e", 0),
        ("x = f(a) if c { } else { } y = 3", 3),
        ("a = b (c + d) / 2 == e", 0),
        ("a = b\n(c + d) / 2 == e", 2),
        ("a == b\n-c", 1),
        ("a = 3; b = 4", 2),
        (";;a = 3;;", 1),
        ("", 0),
    ],
)
def test_where_statements_end(written: str, count: int) -> None:
    parsed = parse(SourceFile("", written))
    if count:
        assert not parsed.diagnostics
        assert len(parsed.module.statements) == count
    else:
        assert bool(parsed.diagnostics) == bool(written)


def test_an_equation_keeps_that_it_was_one() -> None:
    (statement,) = read("constrain { a.x = b.x }")
    assert isinstance(statement, ast.Constrain)
    assert isinstance(statement.items.statements[0], ast.Equation)


def test_docs_belong_to_the_definition_below() -> None:
    (statement,) = read(
        "/// A plate.\n/// Thin.\n@thickness(3)\nsolid plate {\n /// wide\n param w = 5 // mm\n}"
    )
    assert isinstance(statement, ast.Structure)
    assert statement.doc == "A plate.\nThin."
    (param,) = statement.body.statements
    assert isinstance(param, ast.Param)
    assert param.doc == "wide"


def test_spans_are_those_of_the_text() -> None:
    text = "solid a { c = circle(center: (0, 0), radius: 2 * (w + 1)) }"
    source = SourceFile("", text)
    nodes = list(ast.walk(parse(source).module))
    by_type = {type(node): node.span.text for node in nodes}
    assert by_type[ast.Structure] == text
    assert by_type[ast.Call] == "circle(center: (0, 0), radius: 2 * (w + 1))"
    assert by_type[ast.Point] == "(0, 0)"
    assert [n.span.text for n in nodes if isinstance(n, ast.Binary)] == ["2 * (w + 1)", "w + 1"]
    assert [n.text for n in nodes if isinstance(n, ast.Identifier)][:2] == ["solid", "a"]

"""Messages, word for word: in the words of the language, with the place and, where one is sure, the fix."""

from __future__ import annotations

import re

import pytest

from aidl_lang.common.diagnostics import apply_fixes
from aidl_lang.common.resources import resource
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse

PAGES = [
    *sorted(resource("docs/diagnostics").glob("E01*.md")),
    *sorted(resource("docs/diagnostics").glob("W01*.md")),
]


@pytest.mark.parametrize(
    ("text", "code", "at", "message"),
    [
        ("x = circle(radius: 5\ny = 3", "E0102", (1, 5), "expected `)` to close the call that begins here"),
        ("x = [1, 2\n", "E0102", (1, 5), "expected `]` to close the bracket that begins here"),
        ("solid a {\n", "E0102", (1, 9), "expected `}` to close the block that begins here"),
        (
            "let a = (1, 2]",
            "E0102",
            (1, 9),
            "expected `)` to close the parenthesis that begins here, not `]`",
        ),
        ("param w\nlet a = 3", "E0103", (1, 7), "`param` needs a value: `param w = 80`"),
        ("let", "E0103", (1, 1), "`let` needs a name and a value: `let w = w / 2`"),
        ("let a = 3 +\n", "E0103", (1, 11), "expected a value after `+`"),
        ("let a 3", "E0103", (1, 7), "expected `=` between the name and its value: `let a = …`"),
        (
            "circle c = circle(radius: 1)",
            "E0113",
            (1, 1),
            "a definition has no type before its name: `c = …`",
        ),
        ("constrain a == if b then c else d", "E0101", (1, 16), "a choice stands in parentheses behind `==`"),
        ("import gears\n", "E0103", (1, 1), "`import gears` does not say from which file"),
        ("let a = if b then c\n", "E0103", (1, 19), None),
        (
            "shape = circle(radius: 5)",
            "E0104",
            (1, 1),
            "`shape` is a word of the language and cannot be a name",
        ),
        ("p = at(10, 0)", "E0104", (1, 5), "`at` is a word of the language and cannot be called"),
        ("let a = 5px", "E0105", (1, 9), "`px` is not a unit"),
        ("let a = 5inches", "E0105", (1, 9), "`inches` is not a unit; did you mean `5in`?"),
        ("let a = 1.2.3", "E0105", (1, 9), "`1.2.3` is not a number"),
        ("let a = 5 mm", "E0106", (1, 9), "a unit touches its number: `5mm`"),
        ("param w = 170mm in", "E0103", (1, 17), "expected a value after `in`"),
        (
            'assert a > 3, "no\n',
            "E0107",
            (1, 15),
            'this text is not closed: expected `"` before the end of the line',
        ),
        ("/* note", "E0107", (1, 1), "this comment is not closed: expected `*/`"),
        ("let a = b ≤ c", "E0108", (1, 11), "`≤` is written `<=`"),
        ("let a = “b”", "E0108", (1, 9), 'text stands in straight quotes: `"`'),
        ("let a = b ~ c", "E0108", (1, 11), "the character `~` has no meaning in the language"),
        ("constrain a => b", "E0109", (1, 13), "`=>` is written `>=`"),
        ("constrain a === b", "E0109", (1, 13), "`===` is written `==`"),
        ("let a = 0...5", "E0109", (1, 10), "`...` is written `..`"),
        ("x := 5", "E0109", (1, 3), "`:=` is written `=`"),
        ("x += 5", "E0109", (1, 3), "there is no `+=`: a name keeps the value it was given"),
        ("param w: 80", "E0109", (1, 8), "a name is given its value by `=`, not `:`"),
        (
            "a.x = b.x",
            "E0110",
            (1, 5),
            "`=` gives a value to a name; what must be equal is written with `==`",
        ),
        ("let x == 3", "E0111", (1, 7), "a name is given its value by `=`, not `==`"),
        ("x = f(a b)", "E0112", (1, 8), "expected `,` between two arguments"),
        ("x = f(a: 1 for i in 0..2 { i })", "E0112", (1, 11), "expected `,` between two arguments"),
        ('x = f(1, for i in 0..2 { i "a" })', "E0112", (1, 27), "expected `,` between two arguments"),
        ("x = [1 2]", "E0112", (1, 7), "expected `,` between two items"),
        ("def f(x) = x", "E0113", (1, 1), "there is no `def`: functions are defined as `fn f(x) = 2 * x`"),
        ("while a { }", "E0113", (1, 1), "there is no `while`: programs repeat with `for i in 0..9 { … }`"),
        ("x = f (a)", "E0114", (1, 5), "the `(` of a call touches its name: `f(`"),
        ("soild a { }", "E0115", (1, 1), "`soild` is not a kind of structure; did you mean `solid`?"),
        ("hole { }", "E0116", (1, 1), "a `hole` needs a name: `hole hole_1 { … }`"),
        ('solid "a b" { }', "E0116", (1, 7), "a name is written without quotes: `solid a_b`"),
        ("a.b\n", "E0117", (1, 1), "`a.b` alone says nothing"),
        ("let a = 3 }", "E0118", (1, 11), "`}` closes nothing"),
        ("constrain { var a = 3 }", "E0119", (1, 13), "`var` cannot stand inside `constrain`"),
        ("solid a at (0, 0) at (1, 1) { }", "E0120", (1, 19), "`at` is said twice"),
        ("for i in 0..3:\n", "E0121", (1, 14), "expected `{` to begin the block of `for`"),
        ("let a = 3, let b = 4", "E0122", (1, 10), "statements are not separated by commas"),
        ("let a = (1, 2, 3)", "E0123", (1, 9), "a point has two coordinates: `(x, y)`"),
        ("a == b\n-c == d", "W0101", (2, 1), "a line that begins with `-` continues the line above"),
        ("else { }", "E0101", (1, 1), "`else` follows the block of an `if`, and there is none before it"),
    ],
)
def test_message(text: str, code: str, at: tuple[int, int], message: str | None) -> None:
    (diagnostic,) = parse(SourceFile("", text)).diagnostics
    assert diagnostic.span is not None
    assert (diagnostic.code, (diagnostic.span.line, diagnostic.span.column)) == (code, at)
    assert message is None or diagnostic.message == message


@pytest.mark.parametrize(
    ("text", "mended"),
    [
        ("x = circle(radius: 5\ny = 3\n", "x = circle(radius: 5)\ny = 3\n"),
        ("x = f(g([1, 2\ny = 3\n", "x = f(g([1, 2]))\ny = 3\n"),
        ("solid a {\n    let b = 3\n", "solid a {\n    let b = 3\n}\n"),
        ("let x == 3px", "let x = 3px"),
        ("constrain a => b", "constrain a >= b"),
        ("assert a, “b”", 'assert a, "b"'),
        ('f("a)\nlet b = 3', 'f("a")\nlet b = 3'),
        ("function f(x) = x", "fn f(x) = x"),
        ("let r = 3 mm", "let r = 3mm"),
        ("x = f (a)", "x = f(a)"),
        ("x = f(a b, 3 4)", "x = f(a, b, 3, 4)"),
        ("param w 80", "param w = 80"),
        ("hole { todo }", "hole hole_1 { todo }"),
        ("a == b\n-c == d", "a == b;\nconstrain -c == d"),
        (
            "Here is a plate.\nIts width (60 mm) can\nbe changed.\nlet a = 3",
            "// Here is a plate.\n// Its width (60 mm) can\n// be changed.\nlet a = 3",
        ),
        ("let step = 3\nlet a = step", "let step_1 = 3\nlet a = step_1"),
    ],
)
def test_fix(text: str, mended: str) -> None:
    source = SourceFile("", text)
    assert apply_fixes(source, parse(source).diagnostics)[0] == mended


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_page(page) -> None:  # type: ignore[no-untyped-def]
    mistake, mended = re.findall(r"```aidl\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    assert [d.code for d in parse(SourceFile("", mistake)).diagnostics] == [page.stem]
    assert parse(SourceFile("", mended)).diagnostics == []


def test_messages_speak_no_token_names() -> None:
    texts = [
        "let a = )",
        "solid a b c",
        "for in {",
        "if { }",
        "import 5",
        "alias a",
        "fn f = 3",
        "@",
        "x = [for]",
        "a[",
        ".",
    ]
    for text in texts:
        for diagnostic in parse(SourceFile("", text)).diagnostics:
            assert not re.search(
                r"\b(NAME|CALL|NUMBER|STRING|LPAR|RPAR|__\w+|\$END)\b|<\w+>", diagnostic.message
            )

"""After an error reading goes on: every error is told once, and what is sound stays."""

from __future__ import annotations

import pytest

from aidl_lang.common.source import SourceFile
from aidl_lang.parser import TextLimits, parse
from aidl_lang.syntax import ast


def codes(text: str) -> list[str]:
    return [d.code for d in parse(SourceFile("", text)).diagnostics]


def names(text: str) -> list[str]:
    """The names defined anywhere in what was understood."""
    module = parse(SourceFile("", text)).module
    return [
        node.name.text for node in ast.walk(module) if isinstance(node, ast.Let | ast.Structure | ast.Assign)
    ]


@pytest.mark.parametrize(
    ("text", "told", "kept"),
    [
        (
            "solid a {\n let one == 1\n let two = 2\n c = circle(center: (0, 0) radius: 5)\n d.e\n"
            " let three = 3\n}\nlet four = 4\n",
            ["E0111", "E0112", "E0117"],
            ["a", "one", "two", "c", "three", "four"],
        ),
        ("solid a { }\n```\n< 3\n", ["E0108", "E0101"], ["a"]),  # where reading goes back to its inside
        (
            "let a = 1\nfor 3 in x {\n  let b = 2\n  if q { let c = 3 }\n}\nlet d = 4\n",
            ["E0101"],
            ["a", "b", "c", "d"],
        ),
        (
            "solid a {\n  hole b {\n    let x = \n  }\n  let y = 2\n}\nsolid c { let z = 3 }\n",
            ["E0103"],
            ["a", "b", "y", "c", "z"],
        ),
        ("x = f(a\ny = 3", ["E0102"], ["x", "y"]),
        ("x = f(g(a, [1, 2\ny = 3", ["E0102"], ["x", "y"]),
        ("x = circle(\n    center: (0, 0),\n    radius: 5\ny = 3", ["E0102"], ["x", "y"]),
        ("x = f(a]\ny = 3", ["E0102"], ["x", "y"]),
    ],
)
def test_every_error_is_told_once_and_what_is_sound_is_kept(
    text: str, told: list[str], kept: list[str]
) -> None:
    assert list(dict.fromkeys(codes(text))) == told
    assert names(text) == kept


def test_what_does_not_belong_into_constrain_is_left_out_with_its_block() -> None:
    text = "constrain {\n  a == b\n  solid c { let x = 3 }\n  param w = 5\n  d == e\n}\nlet f = 1\n"
    assert codes(text) == ["E0119", "E0119"]
    constrain = parse(SourceFile("", text)).module.statements[0]
    assert isinstance(constrain, ast.Constrain)
    assert len(constrain.items.statements) == 2


def test_a_missing_brace_is_placed_by_indentation() -> None:
    text = "solid a {\n    hole b {\n        let x = 3\n\n    let y = 4\n}\n"
    (diagnostic,) = parse(SourceFile("", text)).diagnostics
    assert diagnostic.code == "E0102"
    assert diagnostic.span is not None
    assert (diagnostic.span.line, diagnostic.fix is not None) == (2, True)


def test_a_word_that_is_reserved_is_told_once() -> None:
    text = "let step = 3\nlet a = 2 * step\nlet b = f(step, step)\nparam c = 3 in 1..9 step 2\n"
    (diagnostic,) = parse(SourceFile("", text)).diagnostics
    assert diagnostic.code == "E0104"
    assert diagnostic.fix is not None
    assert len(diagnostic.fix.edits) == 4


def test_a_number_with_a_unit_is_given_no_second_one() -> None:
    assert "E0114" not in codes("let 5x (3)")  # no call
    assert codes('let a = 5mm"') == ["E0107", "E0101"]
    assert codes('let a = 5°"') == ["E0107", "E0101"]


def test_limits() -> None:
    assert codes("x" * 2_000_001) == ["E0801"]
    assert codes("let a = " + "(" * 10_000) == ["E0802"]
    assert codes("let a = " + "1 + " * 1000 + "1") == ["E0802"]
    assert codes("let a = " + "-" * 10_000 + "1") == ["E0802"]
    assert codes("let a = " + "(" * 90 + "1" + ")" * 90) == []
    assert codes("solid a { " * 1_000)[-1] == "E0802"
    assert codes("let = 3\n" * 1000)[-1] == "E0104"
    assert codes("}\n" * 1000)[-1] == "E0803"
    source = SourceFile("", "let a = [[[[1]]]]")
    assert [d.code for d in parse(source, TextLimits(max_nesting=5)).diagnostics] == ["E0802"]


def test_much_text_is_read() -> None:
    text = "let a = [" + "1, " * 4_000 + "]\n"
    assert codes(text) == []

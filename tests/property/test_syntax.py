"""Properties of parser and printer over made-up texts."""

from __future__ import annotations

import string
from functools import cache
from unittest.mock import patch

import pytest
from hypothesis import HealthCheck, given
from hypothesis import strategies as st
from hypothesis.extra.lark import from_lark
from lark import Lark

from aidl_lang.common.diagnostics import apply_fixes
from aidl_lang.common.resources import resource
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.syntax.printer import format_module
from tests.amount import tries

FEW = tries(60)


def _errors(text: str) -> list[str]:
    return [f"{d.code}: {d.message}" for d in parse(SourceFile("", text)).diagnostics if d.is_error]


_TERMINALS = {
    "NAME": st.sampled_from([" a ", " width ", " hole ", " b2 "]),
    "CALL": st.sampled_from([" circle(", " f("]),
    "NUMBER": st.sampled_from([" 5 ", " 0.5mm ", " 30deg "]),
    "STRING": st.sampled_from([' "s" ', ' "" ']),
}
_LAYOUT = st.sampled_from([" ", "\n", " // note\n", " /* note */ ", "\n\n\n"])


@cache
def _of_the_grammar() -> st.SearchStrategy[str]:
    """What the grammar makes, with white space about every word."""
    text = resource("grammar/aidl.lark").read_text(encoding="utf-8")
    grammar = Lark(text, parser="earley", start="module", maybe_placeholders=False)
    terminals = [t for t in grammar.terminals if t.pattern.type == "str"]
    words = {terminal.name: st.just(f" {terminal.pattern.value} ") for terminal in terminals}
    ignored = dict.fromkeys(grammar.ignore_tokens, _LAYOUT)
    explicit = _TERMINALS | words | ignored
    assert {terminal.name for terminal in grammar.terminals} == explicit.keys()
    # What Hypothesis works out of the pattern of each takes seconds, and all have something in its place.
    with patch("hypothesis.extra.lark.st.from_regex", return_value=st.nothing()):
        found = from_lark(grammar, start="module", explicit=explicit)
        found.validate()
    return found


@tries(12, suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow])
@given(st.deferred(lambda: _of_the_grammar()))
def test_what_the_grammar_makes_reads_as_it_is_printed(text: str) -> None:
    parsed = parse(SourceFile("", text))
    if any(d.is_error for d in parsed.diagnostics):
        return  # an unknown kind, as `width a { }`
    once = format_module(parsed)
    again = parse(SourceFile("", once))
    assert not [d for d in again.diagnostics if d.is_error], once
    assert ast.same(again.module, parsed.module), once
    assert format_module(again) == once
    assert len(again.module.comments) == len(parsed.module.comments)


_PIECES = st.sampled_from(
    [*string.punctuation, *"“”≤°é\0\r", "\n", "\n\n", " ", "  ", "5", "5mm", "0..3", "a", "solid", "circle(",
     "if", "else", "then", "for", "in", "let", "param", "constrain", "at", "rotated", "and", "not", "import",
     "from", "true", "step", "weight", "todo", "fn f(", "shape", "/*", "*/", "//", '"s"', "(1, 2)", "{ }"]
)  # fmt: skip


@FEW
@given(st.lists(_PIECES, max_size=30).map("".join) | st.text(max_size=40))
def test_any_text_is_answered_with_diagnostics(text: str) -> None:
    source = SourceFile("", text)
    parsed = parse(source)
    for diagnostic in parsed.diagnostics:
        assert 0 <= diagnostic.span.start <= diagnostic.span.end <= len(text)
        assert diagnostic.message
    apply_fixes(source, parsed.diagnostics)
    format_module(parsed)


@pytest.mark.parametrize("kind", ["E0102", "E0112", "E0105", "E0106", "E0111"])
def test_a_fix_leaves_less_to_mend(kind: str) -> None:
    text = "solid a {\n  let w == 5\n  c = circle(center: (0, 0) radius: 5 mm)\n  d = circle(radius: 3px\n}\n"
    source = SourceFile("", text)
    found = parse(source).diagnostics
    assert kind in [d.code for d in found]
    mended, applied = apply_fixes(source, found)
    assert applied >= 4
    assert len(_errors(mended)) < len(found)

"""Diagnostics as a language model reads them."""

from __future__ import annotations

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.render import compact
from aidl_lang.common.source import SourceFile, Span


def span(source: SourceFile, text: str) -> Span:
    start = source.text.index(text)
    return Span(source, start, start + len(text))


def test_errors_come_first_and_what_repeats_is_counted() -> None:
    source = SourceFile("part.aidl", "\n".join(f"name_{k}" for k in range(40)))
    many = [
        Diagnostic(f"{'WE'[k % 2]}02{k % 4:02}", f"number {k}", span(source, f"name_{k}")) for k in range(40)
    ]
    blocks = compact(many).split("\n\n")
    assert [b.partition(":")[0] for b in blocks[:4]] == [
        "error E0201 line 2",
        "error E0203 line 4",
        "error E0201 line 6",
        "error E0203 line 8",
    ]
    assert len(blocks) == 16
    codes = ("E0201", "E0203", "W0200", "W0202")
    assert blocks[-4:] == [f"and 7 more {code}, to be mended alike" for code in codes]


def test_fixes_are_lines_to_write() -> None:
    source = SourceFile("part.aidl", "one\ntwo\nthree\nfour\n")

    def fix(*edits: tuple[str, str]) -> list[str]:
        made = Fix("mend", tuple(Edit(span(source, old), new) for old, new in edits))
        return compact([Diagnostic("E0101", "wrong", span(source, "two"), fix=made)]).splitlines()[2:]

    assert fix(("two", "2")) == ["  fix (mend): line 2 becomes", "    2"]
    assert fix(("two\n", "")) == ["  fix (mend): line 2 goes"]
    assert fix(("two\nthree", "2\n3")) == ["  fix (mend): lines 2-3 become", "    2", "    3"]
    assert fix(("one\n", "one\n1.5\n")) == ["  fix (mend): after line 1 write", "    1.5"]
    assert fix(("one", "1"), ("four", "4")) == [
        "  fix (mend): line 1 becomes",
        "    1",
        "  and: line 4 becomes",
        "    4",
    ]


def test_what_a_program_holds_cannot_break_the_form() -> None:
    source = SourceFile("a\nb.aidl", "x\x1b[31m" + "y" * 500)
    lines = compact([Diagnostic("E0101", "two\nlines", Span(source, 0, 1))]).splitlines()
    assert lines[0] == "error E0101 line 1: two lines"
    assert "\x1b" not in lines[1]
    assert len(lines[1]) < 220

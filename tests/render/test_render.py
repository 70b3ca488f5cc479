"""Diagnostics as they look on a terminal, and as a language model reads them."""

from __future__ import annotations

import io
import re
from textwrap import dedent

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.render import TerminalStyle, compact, render, wants_colour
from aidl_lang.common.render.excerpt import escape, width_of
from aidl_lang.common.source import SourceFile, Span

PART = SourceFile(
    "part.aidl",
    dedent("""\
    assembly a {
    \tsolid base {
    \t\t世界 = circle(center: plate.center, radius: 3)
    \t}
        solid plate {
            edge = square(side: 3)
            hole h { }
            todo
            todo
            todo
        }
    }
    """),
)


def span(text: str, source: SourceFile = PART) -> Span:
    start = source.text.index(text)
    return Span(source, start, start + len(text))


def shown(diagnostic: Diagnostic, width: int = 110) -> str:
    return "\n" + render(diagnostic, width=width) + "\n"


def test_labels_that_overlap_hang_below() -> None:
    labels = (Label(span("plate"), "a solid"), Label(span("circle"), "the call"))
    found = Diagnostic("E0401", "out of reach", span("plate.center"), "this", labels)
    assert shown(found) == dedent("""
        error[E0401]: out of reach
         --> part.aidl:3:23
          |
        3 |         世界 = circle(center: plate.center, radius: 3)
          |                ------         ^^^^^^^^^^^^
          |                |              |
          |                |              this
          |                |              |
          |                |              a solid
          |                |
          |                the call
        """)


def test_bars_within_bars() -> None:
    inner = span("base {\n" + PART.text.partition("base {\n")[2].partition("    solid plate")[0].rstrip())
    outer = Label(Span(PART, 0, len(PART.text)), "outer")
    assert shown(Diagnostic("N0501", "two bars", inner, "inner", (outer,))) == dedent("""
        note[N0501]: two bars
          --> part.aidl:2:8
           |
         1 | /   assembly a {
         2 | |       solid base {
           | |  ___________^
         3 | | |         世界 = circle(center: plate.center, radius: 3)
         4 | | |     }
           | | |_____^ inner
           | |   …
        12 | |   }
           | |___- outer
        """)


def test_fix_is_shown_as_what_goes_and_what_comes() -> None:
    at_end = PART.text.rindex("}")
    edits = (
        Edit(span("plate.center"), "guess(0, 0)"),
        Edit(Span(PART, at_end, at_end), "    constrain base.bottom == 3\n"),
    )
    found = Diagnostic("E0401", "out of reach", span("plate.center"), fix=Fix("say it in `a`", edits))
    assert shown(found).partition("  = ")[2] == dedent("""\
        fix: say it in `a`
           |
         3 -         世界 = circle(center: plate.center, radius: 3)
         3 +         世界 = circle(center: guess(0, 0), radius: 3)
           |
        11 |     }
        12 +     constrain base.bottom == 3
        """)


def test_very_long_line_is_cut_around_the_span() -> None:
    text = "points = [" + ", ".join(f"({i}, {i})" for i in range(500)) + "]"
    source = SourceFile("long.aidl", text)
    lines = render(Diagnostic("E0301", "odd point", span("(250, 250)", source), "this"), width=60).split("\n")
    assert all(len(line) <= 64 for line in lines)
    excerpt, carets = lines[3], lines[4]
    assert excerpt[carets.index("^") :].startswith("(250, 250)")
    assert excerpt.count("…") == 2


def test_colour_changes_nothing_but_colour() -> None:
    found = Diagnostic(
        "E0401", "out", span("plate.center"), "x", fix=Fix("mend", (Edit(span("plate.center"), "origin"),))
    )
    coloured = render(found, TerminalStyle(colour=True))
    assert "\x1b[1;31m" in coloured
    assert re.sub(r"\x1b\[[\d;]*m", "", coloured) == render(found)


@pytest.mark.parametrize(
    ("environment", "terminal", "wanted"),
    [
        ({}, True, True),
        ({}, False, False),
        ({"NO_COLOR": "1"}, True, False),
        ({"NO_COLOR": ""}, True, True),
        ({"FORCE_COLOR": "1"}, False, True),
        ({"FORCE_COLOR": "0"}, False, False),
        ({"NO_COLOR": "1", "FORCE_COLOR": "1"}, True, False),
        ({"TERM": "dumb"}, True, False),
    ],
)
def test_when_colour_is_used(environment: dict[str, str], terminal: bool, wanted: bool) -> None:
    stream = io.StringIO()
    stream.isatty = lambda: terminal  # type: ignore[method-assign]
    assert wants_colour(stream, environment) is wanted


@given(st.text("ab\n\t世\r\x1b", max_size=60), st.data())
def test_any_span_of_any_text_can_be_rendered(text: str, data: st.DataObject) -> None:
    source = SourceFile("x", text)
    cuts = st.integers(0, len(text))

    def some_span() -> Span:
        a, b = sorted((data.draw(cuts), data.draw(cuts)))
        return Span(source, a, b)

    labels = tuple(Label(some_span(), "label") for _ in range(data.draw(st.integers(0, 3))))
    fix = Fix("fix", (Edit(some_span(), data.draw(st.sampled_from(["", "x", "x\ny\n"]))),))
    found = Diagnostic("E0101", "message", some_span(), "here", labels, ("hint",), fix)
    page = render(found, width=50)
    assert "\x1b" not in page
    assert "^" in page
    assert all(width_of(line) <= 50 + len(" label") for line in page.splitlines() if "…" in line)


# --- In few words --------------------------------------------------------------------------------


def test_errors_come_first_and_what_repeats_is_counted() -> None:
    source = SourceFile("part.aidl", "\n".join(f"name_{k}" for k in range(40)))
    many = [
        Diagnostic(f"{'WE'[k % 2]}02{k % 4:02}", f"number {k}", span(f"name_{k}", source)) for k in range(40)
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
        made = Fix("mend", tuple(Edit(span(old, source), new) for old, new in edits))
        return compact([Diagnostic("E0101", "wrong", span("two", source), fix=made)]).splitlines()[2:]

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


# --- Characters ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("hostile", "visible"),
    [
        ("\x1b[2J", "␛[2J"),
        ("\x07", "␇"),
        ("a\rb", "a␍b"),
        ("\x7f", "␡"),
        ("\x9b31m", "<U+009B>31m"),
        ("\u202eabc", "<U+202E>abc"),
        ("\u2028", "<U+2028>"),
        ("\ud800", "<U+D800>"),
        ("two\nlines", "two\nlines"),
        ("naïve 世界 ½", "naïve 世界 ½"),
    ],
)
def test_escape(hostile: str, visible: str) -> None:
    assert escape(hostile) == visible


@given(st.text())
def test_escaped_text_can_be_printed(text: str) -> None:
    safe = escape(text)
    safe.encode("utf-8")
    assert not any(ord(char) < 0x20 or 0x7F <= ord(char) < 0xA0 for char in safe.replace("\n", ""))

"""What messages about conflicts promise: what would fit fits."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import pytest

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.render import render, to_dict
from aidl_lang.common.source import SourceFile, Span
from tests.documents import ROOT, Block, programs

UNSOLVABLE = programs(ROOT / "tests" / "spec" / "conflicts.md")
NUMBER = re.compile(r"(?<![\w.\[])-?\d+(?:\.\d+)?(?![\w.])")
FITS = re.compile(r"(?:^|; )(-?\d+(?:\.\d{1,2})?) would fit$")
"""A number that is told with all its digits, and is not a limit."""


def compiled(text: str, **solving: float) -> pipeline.Compiled:
    settings = pipeline.Settings()
    return pipeline.compile(
        SourceFile("part.aidl", text),
        settings=replace(settings, solving=replace(settings.solving, **solving)),
    )


def errors(text: str, **solving: float) -> list[Diagnostic]:
    return [d for d in compiled(text, **solving).diagnostics if d.is_error]


@cache
def failures_of(text: str) -> list[Diagnostic]:
    """The errors of a program that several tests look at."""
    return errors(text)


CASES = [
    pytest.param(block, id=block.place, marks=[pytest.mark.slow] if k % 16 != 8 else [])
    for k, block in enumerate(UNSOLVABLE)
]
"""A sixteenth of them on every run; the specs hold every message, and apply every fix by itself."""


def replacements(text: str) -> Iterator[str]:
    """The program with one number replaced by the one that is said to fit, for each that is said."""
    for d in failures_of(text):
        places: list[tuple[Span | None, str]] = [(d.span, d.label)]
        places += [(label.span, label.text) for label in d.secondary]
        for span, said in places:
            fits = FITS.search(said)
            if span is None or fits is None:
                continue
            numbers = list(NUMBER.finditer(span.text))
            assert len(numbers) == 1, f"`{span.text}` does not say for which number {fits[1]} would fit"
            start, end = span.start + numbers[0].start(), span.start + numbers[0].end()
            yield text[:start] + fits[1] + text[end:]


@pytest.mark.parametrize("block", CASES)
def test_what_would_fit_fits(block: Block) -> None:
    if "for " not in block.text:
        before = len(failures_of(block.text))
        for text in replacements(block.text):
            assert len(errors(text)) == before - 1, text


def test_it_is_said_often_what_would_fit() -> None:
    asked = [block.text for block in UNSOLVABLE[8::16] if "for " not in block.text]
    assert sum(1 for text in asked for _ in replacements(text)) > 2


TRIANGLE = """drawing d {
    a = line((0, 0), (30, 0))
    b = line(a.end, (15, 20))
    c = line(b.end, a.start)
    constrain { a.length == 41; b.length == 52; c.length == 33 }
}
"""


def test_a_search_that_does_not_arrive_says_how_near_it_came() -> None:
    failures = errors(TRIANGLE, iterations=1)  # each of which leaves out one constraint and goes on
    assert failures
    for failure in failures:
        assert failure.code == "E0602"
        assert re.fullmatch(r"no position was found in which .* hold", failure.message)
        assert re.fullmatch(r"off by \d+\.\d+ mm where the search left it", failure.label)
        assert failure.fix is None


def test_a_search_without_time_says_so() -> None:
    (failure,) = errors(TRIANGLE, seconds=0.0)
    assert failure.code == "E0603"
    assert failure.message.startswith("the time for solving ran out before ")
    assert failure.fix is None


def test_json_has_the_places_what_would_fit_and_the_fix() -> None:
    text = UNSOLVABLE[0].text
    (failure,) = errors(text)
    data = to_dict(failure)
    assert (data["code"], data["line"], data["label"]) == ("E0601", 5, "6 would fit")
    assert [(s["line"], s["label"]) for s in data["secondary"]] == [(4, "conflicts with this; 9 would fit")]
    assert [edit["replacement"] for edit in data["fix"]["edits"]] == [""]
    assert SourceFile("part.aidl", text).text[data["fix"]["edits"][0]["start"] :].lstrip().startswith("rim")


@pytest.mark.parametrize("value", ["1e12", "-1e12", "1e-300", "0", "-1e12mm", "6.000001"])
def test_extreme_numbers_do_not_break_the_message(value: str) -> None:
    stated = f"a.radius == 6; a.radius == {value}"
    found = errors(f"drawing d {{ a = circle(center: (0, 0), radius: 5); constrain {{ {stated} }} }}")
    assert found
    assert {d.code for d in found} == {"E0601"}
    for d in found:
        assert render(d)
        assert d.fix is not None


def test_a_search_that_is_cut_short_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    text = "solid a { b = circle(center: origin, radius: 5); constrain { b.radius == 6; b.radius <= 4 } }"
    told = "what would fit was not sought to the end, for want of time"
    (found,) = errors(text)
    assert told not in found.hints
    monkeypatch.setattr("aidl_lang.explaining.trials.SECONDS", -1.0)
    (found,) = errors(text)
    assert told in found.hints


def test_of_sizes_that_change_together_each_statement_is_named_that_asks_for_it() -> None:
    (told,) = compiled(
        """drawing d {
    a = rectangle(center: (0, 0), width: 10, height: 10)
    b = rectangle(center: (60, 0), width: 10, height: 10)
    constrain { a.width + b.width == 60; a.width - b.width == 10 }
}
"""
    ).diagnostics
    assert told.hints[0] == "`a.width + b.width == 60` and `a.width - b.width == 10` ask for it"
    labels = [(label.span.text, label.text) for label in told.secondary]
    assert labels[1:] == [
        ("a.width + b.width == 60", "asks for it"),
        ("a.width - b.width == 10", "asks for it"),
    ]

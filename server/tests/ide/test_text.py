"""Outline, colours, folds, selections, the canonical form, of whole and of broken programs; positions."""

from __future__ import annotations

import random
import re
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang import pipeline
from aidl_server.ide.outline import (
    MODIFIERS,
    TYPES,
    Colored,
    Entry,
    folds,
    outline,
    selections,
    semantic_tokens,
)
from aidl_server.ide.workspace import Positions, Unit, View, applied, format_document
from server.tests.ide.conftest import seen
from tests.amount import tries
from tests.compiled import EXAMPLES

PART = """\
import "other.aidl" as other
/// A plate.
/// With holes.
param width = 60mm in 20..200
fn double(x) = 2 * x
@color("red")
solid plate {
    body = rectangle(
        center: origin,
        width: width,
        height: double(4)
    )
    for i in 0..2 {
        hole h[i] { rim = circle(center: (10 * i, 0), radius: 2) }
    }
    w = washer(8)
    /* a block
       of words */
    constrain body.center.x == 0
}
solid washer(outer = 20) { rim = circle(center: origin, radius: outer / 2) }
"""


def test_the_outline_has_what_is_declared() -> None:
    def flat(entries: list[Entry] | tuple[Entry, ...]) -> list[object]:
        return [(str(e.kind), e.name, e.detail, *flat(e.children)) for e in entries]

    assert flat(outline(seen(PART, other="param a = 1"))) == [
        ("imported file", "other", '"other.aidl"'),
        ("param", "width", "60mm"),
        ("function", "double", "2 * x"),
        (
            "structure",
            "plate",
            "solid",
            ("geometry", "body", "rectangle"),
            ("structure", "h[i]", "hole", ("geometry", "rim", "circle")),
            ("structure", "w", "washer"),
        ),
        ("template", "washer", "solid", ("geometry", "rim", "circle")),
    ]


def colored(view: View) -> list[tuple[str, str]]:
    return [(c.span.text, c.type) for c in semantic_tokens(view)]


def test_words_have_the_colour_of_what_they_mean() -> None:
    found = colored(seen(PART, other="param a = 1"))
    for expected in (
        ("other", "namespace"),
        ("/// A plate.", "comment"),
        ("60mm", "number"),
        ("double", "function"),
        ("x", "parameter"),
        ("color", "decorator"),
        ('"red"', "string"),
        ("solid", "keyword"),
        ("plate", "class"),
        ("rectangle", "type"),
        ("center", "parameter"),
        ("==", "operator"),
        ("/* a block", "comment"),
        ("       of words */", "comment"),
    ):
        assert expected in found
    marked = {c.span.text: c for c in semantic_tokens(seen(PART)) if c.span.text in ("rectangle", "double")}
    assert "defaultLibrary" in marked["rectangle"].modifiers
    assert "defaultLibrary" not in marked["double"].modifiers


def assert_in_order(tokens: list[Colored]) -> None:
    for before, after in pairwise(tokens):
        assert before.span.end <= after.span.start
    for token in tokens:
        assert token.span.text
        assert "\n" not in token.span.text
        assert token.type in TYPES
        assert token.modifiers <= set(MODIFIERS)


def test_folds_stay_where_brackets_are_missing() -> None:
    view = seen(PART.replace("solid washer", "solid washer { ( ] }\nsolid x"))
    found = set(folds(view))
    assert {(2, 3, "comment"), (7, 19, "region"), (8, 11, "region"), (17, 18, "comment")} <= found


def check_everything(view: View, *places: int) -> None:
    text = view.source.text
    assert_in_order(semantic_tokens(view))
    lines = text.count("\n") + 1
    for start, end, _ in folds(view):
        assert 1 <= start < end <= lines
    for at in places:
        for inner, outer in pairwise(selections(view, at)):
            assert outer.start <= inner.start <= inner.end <= outer.end
    for entry in outline(view):
        assert entry.span.start <= entry.name_span.start <= entry.name_span.end <= entry.span.end
    edits = format_document(view)
    if edits:
        assert applied(text, edits) == pipeline.formatted(view.source, view.world)[0]


def test_examples(example: View) -> None:
    check_everything(example, *range(0, len(example.source.text), 97))


@tries(60)
@given(st.sampled_from(EXAMPLES), st.integers(0, 10**6))
def test_what_is_broken_is_answered_too(path: object, seed: int) -> None:
    assert path in EXAMPLES
    chance = random.Random(seed)
    text = path.read_text("utf-8")  # type: ignore[attr-defined]
    for _ in range(chance.randint(1, 4)):
        at = chance.randrange(len(text) + 1)
        put = chance.choice(["", "{", "}", '"', "\U0001d518", "\r\n", "(", "= =", "/*", "\u2028", "@"])
        text = text[:at] + put + text[at + chance.randint(0, 3) :]
    check_everything(seen(text), chance.randrange(len(text) + 1))


TEXTS = st.lists(st.sampled_from(["a", "é", "…", "🅰", "😀", "\n", "\r", "\r\n", "\t", "\ufeff", " "])).map(
    "".join
)
WIDTH = {Unit.UTF_8: ("utf-8", 1), Unit.UTF_16: ("utf-16-le", 2), Unit.UTF_32: ("utf-32-le", 4)}


def slowly(text: str, offset: int, unit: Unit) -> tuple[int, int]:
    """What a position is, by cutting the text into lines and encoding one."""
    if text[offset - 1 : offset + 1] == "\r\n":
        offset -= 1
    codec, size = WIDTH[unit]
    lines = re.split("\r\n|\n|\r", text[:offset])
    return len(lines) - 1, len(lines[-1].encode(codec)) // size


@pytest.mark.parametrize("unit", Unit)
@given(TEXTS)
def test_positions_are_those_of_encoded_lines(unit: Unit, text: str) -> None:
    positions = Positions(text, unit)
    for offset in range(len(text) + 1):
        place = positions.position(offset)
        assert place == slowly(text, offset, unit)
        is_within_break = text[offset - 1 : offset + 1] == "\r\n" if offset else False
        assert positions.offset(*place) == offset - is_within_break


@given(TEXTS, st.integers(-3, 9), st.integers(-3, 9), st.integers(-5, 99))
def test_places_out_of_range_are_taken_to_what_is_near(
    text: str, line: int, character: int, offset: int
) -> None:
    positions = Positions(text)
    assert 0 <= positions.offset(line, character) <= len(text)
    assert positions.position(offset) == positions.position(max(0, min(offset, len(text))))
    if line > positions.position(len(text))[0]:
        assert positions.offset(line, character) == len(text)


def test_half_a_character_is_its_start() -> None:
    positions = Positions("a😀b")
    assert [positions.offset(0, k) for k in range(5)] == [0, 1, 1, 2, 3]
    assert positions.position(3) == (0, 4)

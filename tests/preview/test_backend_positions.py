from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.tools.ide.workspace import Positions, Unit

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

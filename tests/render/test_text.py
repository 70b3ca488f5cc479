"""Characters as a terminal shows them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.common.render.excerpt import escape, lay_out, width_of, window


@pytest.mark.parametrize(
    ("hostile", "shown"),
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
def test_escape(hostile: str, shown: str) -> None:
    assert escape(hostile) == shown


@pytest.mark.parametrize(("text", "width"), [("abc", 3), ("世界", 4), ("e\u0301", 1), ("\uff46", 2), ("", 0)])
def test_width(text: str, width: int) -> None:
    assert width_of(text) == width


def test_tabs_go_to_the_next_stop() -> None:
    line = lay_out("a\tb")
    assert line.text == "a   b"
    assert line.column(2) == 4


@given(st.text())
def test_escaped_text_can_be_printed(text: str) -> None:
    shown = escape(text)
    shown.encode("utf-8")
    assert not any(ord(char) < 0x20 or 0x7F <= ord(char) < 0xA0 for char in shown.replace("\n", ""))


@given(st.text(), st.integers(20, 60), st.data())
def test_window_fits_and_holds_its_focus(text: str, width: int, data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, len(text)))
    line = lay_out(text)
    view = window(text, width, (start, end))
    assert width_of(view.text) <= width
    assert view.start <= start <= view.end
    if view.start <= start < view.end:
        before = "…" if view.start else ""
        assert view.column(start) == width_of(before + "".join(line.cells[view.start : start]))

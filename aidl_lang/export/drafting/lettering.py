"""Texts and lines of a drawing sheet, in mm on paper."""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.export.marks import Curves, Ink, Text
from aidl_lang.geometry.curves import Line, Vec

BLACK, GREY = "#000000", "#555555"
WIDE, NARROW = 0.35, 0.18
"""Widths of lines: of outlines and the frame, and of everything else (ISO 128-2, group 0.35)."""
SMALL, LARGE = 2.5, 3.5
"""Heights of capitals (ISO 3098-1)."""
CAPITAL = 0.73
"""Height of capitals relative to the size of the font."""
_CHARACTER = 0.62
"""Width of a character relative to the size of the font, on the wide side."""
_CUT = "…"


def width_of(words: str, height: float) -> float:
    return _CHARACTER * height / CAPITAL * len(words)


def written(
    words: str, at: Vec, height: float = SMALL, anchor: str = "start", room: float | None = None
) -> Text:
    """Returns a text, made smaller and then cut off where it has no more than some `room`."""
    if room is not None and width_of(words, height) > room:
        height = max(SMALL, height * room / width_of(words, height))
        while len(words) > 1 and width_of(words, height) > room + 1e-9:
            words = words.removesuffix(_CUT)[:-1].rstrip() + _CUT
    return Text(at, words, height / CAPITAL, BLACK, anchor, halo=False)


def lines(segments: Sequence[tuple[Vec, Vec]], width: float = NARROW, role: str = "") -> Curves:
    return Curves(tuple(Line(*ends) for ends in segments), Ink(BLACK, width), role)

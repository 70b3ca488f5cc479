"""The font of single lines, each engraved in one pass of the tool: strokes of lines and rounded corners.

It is written in `fonts/SingleLine.txt`, which says how. Corners are arcs as cubic Bézier curves, which for a
quarter of a circle are off by 0.03 % of the radius (Riškus, 2006).
"""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import pairwise

from aidl_lang.common.font_files import Curve, Vec
from aidl_lang.common.resources import resource

_FILE = "aidl_lang/common/fonts/SingleLine.txt"
_SPACE, _BETWEEN = 4.0, 2.4
"""Widths of a blank, and between two characters, in tenths of the height of a capital."""
_WITHOUT_DOT = {"i": "\u0131", "j": "\u0237"}


class SingleLines:
    """The characters of the font, as a `FontFile` has them: in tenths of the height of a capital."""

    capital_height = 10.0

    def __init__(self) -> None:
        lines = resource(_FILE).read_text(encoding="utf-8").splitlines()
        rows = [line for line in lines if line and not line.startswith("//")]
        self._written = {row[0]: row[1:].split(maxsplit=1) for row in rows}

    def __contains__(self, character: str) -> bool:
        return character in " \u00a0" or all(part in self._written for part in _parts(character))

    def outline(self, character: str) -> tuple[tuple[Curve, ...], float]:
        """Returns the curves of a character, stroke by stroke, and its advance width."""
        if character in " \u00a0":
            return (), _SPACE
        letter, accents = _parts(character)[0], _parts(character)[1:]
        if any(map(_is_above, accents)):
            letter = _WITHOUT_DOT.get(letter, letter)
        width, curves = float(self._written[letter][0]), list(self._strokes(letter))
        top = max(y for curve in curves for _, y in curve)
        for accent in accents:
            at = (width / 2, top if _is_above(accent) else 0.0)
            curves += [_moved(curve, at) for curve in self._strokes(accent)]
        left = min(0.0, *(x for curve in curves for x, _ in curve))
        right = max(width, *(x for curve in curves for x, _ in curve))
        return tuple(_moved(curve, (-left, 0.0)) for curve in curves), right - left + _BETWEEN

    def _strokes(self, character: str) -> Iterator[Curve]:
        for stroke in self._written[character][1].split("  "):
            if not (text := stroke.strip()):
                continue
            if text.startswith("="):
                other, _, at = text[1:].partition("@")
                yield from (_moved(curve, _point(at or "0,0")) for curve in self._strokes(other))
            else:
                yield from _way(text.split())


def _is_above(accent: str) -> bool:
    """Tells whether an accent stands above its letter, by its class in Unicode."""
    return unicodedata.combining(accent) >= 230


@cache
def _parts(character: str) -> str:
    """Returns a letter and the accents on it."""
    return unicodedata.normalize("NFD", character)


def _way(words: Sequence[str]) -> Iterator[Curve]:
    """Yields the curves of a stroke."""
    is_closed = words[-1] == "z"
    corners = [_corner(word) for word in (words[:-1] if is_closed else words)]
    ring = [corners[-1], *corners, corners[0]] if is_closed else [corners[0], *corners, corners[-1]]
    rounded = [
        _rounded(before, at, after, radius)
        for (before, _), (at, radius), (after, _) in zip(ring, corners, ring[2:], strict=False)
    ]
    if is_closed:
        rounded.append(rounded[0])
    for k, (one, other) in enumerate(pairwise(rounded)):
        if k or not is_closed:
            yield from _bend(one)
        if math.dist(one[-1], other[0]) > 1e-9:
            yield one[-1], other[0]
    yield from _bend(rounded[-1])


def _bend(curve: Curve) -> Iterator[Curve]:
    if len(curve) > 1:
        yield curve


def _rounded(before: Vec, at: Vec, after: Vec, radius: float) -> Curve:
    """Returns the arc that rounds a corner, as a cubic Bézier curve; the corner alone without a radius."""
    if radius == 0:
        return (at,)
    (ax, ay), (bx, by) = _toward(at, before), _toward(at, after)
    half = math.acos(max(-1.0, min(1.0, ax * bx + ay * by))) / 2
    reach = radius / math.tan(half)
    handle = reach - 4 / 3 * math.tan((math.pi / 2 - half) / 2) * radius
    x, y = at
    return (
        (x + reach * ax, y + reach * ay),
        (x + handle * ax, y + handle * ay),
        (x + handle * bx, y + handle * by),
        (x + reach * bx, y + reach * by),
    )


def _toward(a: Vec, b: Vec) -> Vec:
    length = math.dist(a, b)
    return (b[0] - a[0]) / length, (b[1] - a[1]) / length


def _corner(word: str) -> tuple[Vec, float]:
    at, _, radius = word.partition("~")
    return _point(at), float(radius or 0)


def _point(text: str) -> Vec:
    x, _, y = text.partition(",")
    return float(x), float(y)


def _moved(curve: Curve, by: Vec) -> Curve:
    return tuple((x + by[0], y + by[1]) for x, y in curve)

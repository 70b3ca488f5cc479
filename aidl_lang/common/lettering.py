"""Lettering: texts as exact outlines in the height of a capital, and as single lines to engrave."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Iterator, Sequence
from functools import cache, lru_cache
from itertools import pairwise

from aidl_lang.common.font_files import Curve, FontFile, Vec, point_of
from aidl_lang.common.records import record
from aidl_lang.common.resources import resource

# --- Lettering: texts as exact outlines, measured in the height of a capital letter.
#
# The outlines are those of a font file (see `font_files`): of one that ships with the package, plain or
# bold, or of one's own. Characters stand one behind the other by their advance widths, without kerning. All
# places go by the ink: a line of text begins where its first letter has its leftmost point.

Box = tuple[float, float, float, float]
"""Left, bottom, right, top."""

ALIGNMENTS = {"left": 0.0, "center": 0.5, "right": 1.0}

_FOLDER = "aidl_lang/common/fonts"


@record()
class Glyph:
    """The outline of one character; `box` is that of its ink.

    is_nested  its contours do not overlap, so that nested ones alternate; otherwise they are to be united by
               the non-zero rule
    is_stroked  its curves are the way of a tool and enclose nothing
    """

    curves: tuple[Curve, ...]
    box: Box
    is_nested: bool = True
    is_stroked: bool = False

    def moved(self, dx: float, dy: float) -> Glyph:
        left, bottom, right, top = self.box
        curves = tuple(tuple((x + dx, y + dy) for x, y in curve) for curve in self.curves)
        return Glyph(curves, (left + dx, bottom + dy, right + dx, top + dy), self.is_nested, self.is_stroked)


def box_around(glyphs: Sequence[Glyph]) -> Box:
    """Returns the box around the ink of all glyphs."""
    lefts, bottoms, rights, tops = zip(*(g.box for g in glyphs), strict=True)
    return min(lefts), min(bottoms), max(rights), max(tops)


def silhouette(curves: Sequence[Curve]) -> tuple[Curve, ...]:
    """Returns the corners of the convex hull of curves, each alone, and the curves of which a part may lie on
    it. In every direction the furthest point of all belongs to one of these.
    """
    import numpy as np

    ordered = sorted({p for curve in curves for p in _samples(curve)})
    corners = [*_chain(ordered)[:-1], *_chain(ordered[::-1])[:-1]]
    start = np.array(corners).reshape(-1, 2)
    way = np.roll(start, -1, axis=0) - start

    def is_inside(curve: Curve) -> bool:
        gap = np.array(curve)[:, None] - start
        return bool((way[:, 0] * gap[..., 1] >= way[:, 1] * gap[..., 0]).all())

    bent = [c for c in curves if len(c) > 2 and not is_inside(c)]
    ends = {p for c in curves for p in (c[0], c[-1])}
    return (*((p,) for p in corners if p in ends), *bent)


_SAMPLES = 16
"""Points of a curve that are tested for lying inside the hull of all."""


def _samples(curve: Curve) -> Sequence[Vec]:
    """Returns points of a curve, its exact ends among them."""
    if len(curve) == 2:
        return curve
    between = [point_of(curve, k / _SAMPLES) for k in range(1, _SAMPLES)]
    return [curve[0], *between, curve[-1]]


def _chain(ordered: Sequence[Vec]) -> list[Vec]:
    """Returns the chain of those sorted points that have all others to their left, as one goes along it: a
    half of their convex hull (Andrew, 1979).
    """

    def turns_left(a: Vec, b: Vec, c: Vec) -> bool:
        return (b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0])

    chain: list[Vec] = []
    for p in ordered:
        while len(chain) > 1 and not turns_left(chain[-2], chain[-1], p):
            chain.pop()
        chain.append(p)
    return chain


def unknown_characters(text: str, font: Font | None = None) -> list[str]:
    """Returns the characters that a font does not have, each once; line breaks are no characters."""
    known = font or plain_font()
    return [c for c in dict.fromkeys(_composed(text)) if c not in known and c != "\n"]


@lru_cache(maxsize=1024)
def typeset(text: str, align: str, line_spacing: float, font: Font | None = None) -> tuple[Glyph, ...]:
    """Returns the characters of a text that have ink, in order, with known characters only. Raises
    FontError.

    The origin lies on the baseline of the first line, at the left end, the middle or the right end of every
    line, as `align` says. Baselines are `line_spacing` apart.
    """
    found: list[Glyph] = []
    for number, line in enumerate(_composed(text).split("\n")):
        pen, placed = 0.0, list[Glyph]()
        for character in line:
            glyph, advance = (font or plain_font()).glyph(character)
            if glyph is not None:
                placed.append(glyph.moved(pen, 0.0))
            pen += advance
        if placed:
            left, _, right, _ = box_around(placed)
            shift = left + ALIGNMENTS[align] * (right - left)
            found += [g.moved(-shift, -number * line_spacing) for g in placed]
    return tuple(found)


def _composed(text: str) -> str:
    """Returns a text with each accented letter as one character, and one kind of line break."""
    return unicodedata.normalize("NFC", text).replace("\r\n", "\n")


# --- Fonts ---------------------------------------------------------------------------------------


class Font:
    """The characters of a font file, each of which is read once.

    is_nested   of its characters (see `Glyph`)
    is_stroked  of its characters
    """

    def __init__(self, file: FontFile | SingleLines, *, is_nested: bool = False) -> None:
        self.is_nested = is_nested
        self.is_stroked = isinstance(file, SingleLines)
        self._file = file
        self._made: dict[str, tuple[Glyph | None, float]] = {}

    def __contains__(self, character: str) -> bool:
        return character in self._file

    def glyph(self, character: str) -> tuple[Glyph | None, float]:
        """Returns the outline of a character (None: blank) and its advance width. Raises FontError."""
        if character not in self._made:
            self._made[character] = self._read(character)
        return self._made[character]

    def _read(self, character: str) -> tuple[Glyph | None, float]:
        outline, advance = self._file.outline(character)
        unit = 1.0 / self._file.capital_height
        curves = tuple(tuple((x * unit, y * unit) for x, y in curve) for curve in outline)
        glyph = Glyph(curves, _ink(curves), self.is_nested, self.is_stroked) if curves else None
        return glyph, advance * unit


@lru_cache(maxsize=8)
def font_of(data: bytes) -> Font:
    """Returns the font of a file. Raises FontError."""
    return Font(FontFile(data))


@cache
def plain_font() -> Font:
    return Font(FontFile(resource(f"{_FOLDER}/DejaVuSansAIDL.ttf").read_bytes()), is_nested=True)


@cache
def bold_font() -> Font:
    return Font(FontFile(resource(f"{_FOLDER}/DejaVuSansAIDL-Bold.ttf").read_bytes()), is_nested=True)


@cache
def single_line_font() -> Font:
    return Font(SingleLines(), is_nested=True)


def _ink(curves: Sequence[Curve]) -> Box:
    from fontTools.misc.arrayTools import calcBounds, unionRect
    from fontTools.misc.bezierTools import calcCubicBounds

    boxes = [calcCubicBounds(*c) if len(c) == 4 else calcBounds(c) for c in curves]
    whole = boxes[0]
    for box in boxes[1:]:
        whole = unionRect(whole, box)
    return whole[0], whole[1], whole[2], whole[3]


# --- What to say of characters that are missing ------------------------------------------------------


def described(character: str) -> str:
    """Returns a character for a message: itself where it can be seen, and its number."""
    code = f"U+{ord(character):04X}"
    return f"`{character}` ({code})" if character.isprintable() else code


def replacement(character: str) -> str | None:
    """Returns what stands for a missing character: spaces for a tab, a letter without accent, or None."""
    if character == "\t":
        return "    "
    known = plain_font()
    plain = unicodedata.normalize("NFKD", character)
    plain = "".join(c for c in plain if not unicodedata.combining(c))
    return plain if plain != character and plain and all(c in known for c in plain) else None


# --- The font of single lines, each engraved in one pass of the tool: strokes of lines and rounded corners.
#
# It is written in `fonts/SingleLine.txt`, which says how. Corners are arcs as cubic Bézier curves, which for
# a quarter of a circle are off by 0.03 % of the radius (Riškus, 2006).

_SPACE, _BETWEEN = 4.0, 2.4
"""Widths of a blank, and between two characters, in tenths of the height of a capital."""
_WITHOUT_DOT = {"i": "\u0131", "j": "\u0237"}


class SingleLines:
    """The characters of the font, as a `FontFile` has them: in tenths of the height of a capital."""

    capital_height = 10.0

    def __init__(self) -> None:
        lines = resource(f"{_FOLDER}/SingleLine.txt").read_text(encoding="utf-8").splitlines()
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
                yield from (_moved(curve, _point_of_line(at or "0,0")) for curve in self._strokes(other))
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
    is_closed = words[-1] == "z"
    corners = [_corner(word) for word in (words[:-1] if is_closed else words)]
    ring = [corners[-1], *corners, corners[0]] if is_closed else [corners[0], *corners, corners[-1]]
    rounded = [
        _rounded(before, at, after, radius)
        for (before, _), (at, radius), (after, _) in zip(ring, corners, ring[2:], strict=False)
    ]
    if is_closed:
        rounded.append(rounded[0])
    for one, other in pairwise(rounded):
        if math.dist(one[-1], other[0]) > 1e-9:
            yield one[-1], other[0]
        if len(other) > 1:
            yield other


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
    return _point_of_line(at), float(radius or 0)


def _point_of_line(text: str) -> Vec:
    x, _, y = text.partition(",")
    return float(x), float(y)


def _moved(curve: Curve, by: Vec) -> Curve:
    return tuple((x + by[0], y + by[1]) for x, y in curve)

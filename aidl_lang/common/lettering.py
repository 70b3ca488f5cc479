"""Lettering: texts as exact outlines, measured in the height of a capital letter.

The outlines are those of a font file (see `font_files`): of one that ships with the package, plain or bold,
or of one's own. Characters stand one behind the other by their advance widths, without kerning. All
places go by the ink: a line of text begins where its first letter has its leftmost point.
"""

from __future__ import annotations

import unicodedata
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from functools import cache, lru_cache

from aidl_lang.common.font_files import Curve, FontFile, Vec
from aidl_lang.common.records import record
from aidl_lang.common.resources import resource
from aidl_lang.common.single_line import SingleLines

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


def silhouette(glyphs: Sequence[Glyph]) -> tuple[Curve, ...]:
    """Returns the corners of the convex hull of the ink, each alone, and the curves of which a part may lie
    on it. In every direction the furthest point of the ink belongs to one of these.
    """
    return silhouette_of([curve for glyph in glyphs for curve in glyph.curves])


def silhouette_of(curves: Sequence[Curve]) -> tuple[Curve, ...]:
    """Returns the silhouette of any curves, as of letters."""
    hull = _Hull([p for curve in curves for p in _samples(curve)])
    bent = [c for c in curves if len(c) > 2 and not all(p in hull for p in c)]
    ends = {p for c in curves for p in (c[0], c[-1])}
    return (*((p,) for p in hull.corners if p in ends), *bent)


def _point(curve: Curve, t: float) -> Vec:
    """Returns the point of a cubic Bézier curve at a parameter."""
    s = 1.0 - t
    a, b, c, d = s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = curve
    return a * x0 + b * x1 + c * x2 + d * x3, a * y0 + b * y1 + c * y2 + d * y3


_SAMPLES = 16
"""Points of a curve that are tested for lying inside the hull of all."""


def _samples(curve: Curve) -> Sequence[Vec]:
    """Returns points of a curve, its exact ends among them."""
    if len(curve) == 2:
        return curve
    between = [_point(curve, k / _SAMPLES) for k in range(1, _SAMPLES)]
    return [curve[0], *between, curve[-1]]


class _Hull:
    """The convex hull of points (Andrew, 1979): its corners counter-clockwise, and its chains from left to
    right, in which points are found by bisection.
    """

    def __init__(self, points: Sequence[Vec]) -> None:
        ordered = sorted(set(points))
        lower, upper = _chain(ordered), _chain(ordered[::-1])
        self.corners = [*lower[:-1], *upper[:-1]]
        self._chains = [(chain, [x for x, _ in chain]) for chain in (lower, upper[::-1])]

    def __contains__(self, p: Vec) -> bool:
        """Tells whether a point lies inside the hull or on its outline."""
        for sense, (chain, lefts) in zip((1.0, -1.0), self._chains, strict=True):
            if not lefts[0] <= p[0] <= lefts[-1]:
                return False
            k = min(bisect_right(lefts, p[0]), len(chain) - 1)
            if k > 0 and sense * _turn(chain[k - 1], chain[k], p) < 0.0:
                return False
        return True


def _chain(ordered: Sequence[Vec]) -> list[Vec]:
    """Returns the chain of those sorted points that have all others to their left, as one goes along it."""
    chain: list[Vec] = []
    for p in ordered:
        while len(chain) > 1 and _turn(chain[-2], chain[-1], p) <= 0.0:
            chain.pop()
        chain.append(p)
    return chain


def _turn(a: Vec, b: Vec, c: Vec) -> float:
    """Returns twice the signed area of a triangle: positive if c lies left of the way from a to b."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


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
        placed = list(_set_line(line, font or plain_font()))
        if placed:
            left, _, right, _ = box_around(placed)
            shift = left + ALIGNMENTS[align] * (right - left)
            found += [g.moved(-shift, -number * line_spacing) for g in placed]
    return tuple(found)


def _composed(text: str) -> str:
    """Returns a text with each accented letter as one character, and one kind of line break."""
    return unicodedata.normalize("NFC", text).replace("\r\n", "\n")


def _set_line(line: str, font: Font) -> Iterator[Glyph]:
    pen = 0.0
    for character in line:
        glyph, advance = font.glyph(character)
        if glyph is not None:
            yield glyph.moved(pen, 0.0)
        pen += advance


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
        """Returns the outline of a character at the origin (None for a blank) and its advance width.
        Raises FontError.
        """
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
    """Returns a text to write for a character that the font lacks: spaces for a tab, a letter without its
    accent; None for any other.
    """
    if character == "\t":
        return "    "
    known = plain_font()
    plain = unicodedata.normalize("NFKD", character)
    plain = "".join(c for c in plain if not unicodedata.combining(c))
    return plain if plain != character and plain and all(c in known for c in plain) else None

"""Lettering: texts as exact outlines, measured in the height of a capital letter.

The outlines are those of a TrueType font that ships with the package, plain or bold. It has no overlapping
contours, so that nested ones alternate. The splines of such a font are quadratic; as cubic Bézier curves they
are the same curves. Characters stand one behind the other by their advance widths, without kerning. All
places go by the ink: a line of text begins where its first letter has its leftmost point.
"""

from __future__ import annotations

import unicodedata
from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from functools import cache, cached_property, lru_cache
from io import BytesIO
from typing import TYPE_CHECKING, Any

from aidl_lang.common.records import record
from aidl_lang.common.resources import resource

if TYPE_CHECKING:
    from fontTools.ttLib import TTFont

Vec = tuple[float, float]
Curve = tuple[Vec, ...]
"""The two ends of a line, or the four control points of a cubic Bézier curve; a single point is a place."""
Box = tuple[float, float, float, float]
"""Left, bottom, right, top."""

ALIGNMENTS = {"left": 0.0, "center": 0.5, "right": 1.0}

_FOLDER = "aidl_lang/common/fonts"


@record()
class Glyph:
    """The outline of one character; `box` is that of its ink."""

    curves: tuple[Curve, ...]
    box: Box

    def moved(self, dx: float, dy: float) -> Glyph:
        left, bottom, right, top = self.box
        curves = tuple(tuple((x + dx, y + dy) for x, y in curve) for curve in self.curves)
        return Glyph(curves, (left + dx, bottom + dy, right + dx, top + dy))


def box_around(glyphs: Sequence[Glyph]) -> Box:
    """Returns the box around the ink of all glyphs."""
    lefts, bottoms, rights, tops = zip(*(g.box for g in glyphs), strict=True)
    return min(lefts), min(bottoms), max(rights), max(tops)


def silhouette(glyphs: Sequence[Glyph]) -> tuple[Curve, ...]:
    """Returns the corners of the convex hull of the ink, each alone, and the curves of which a part may lie
    on it. In every direction the furthest point of the ink belongs to one of these.
    """
    curves = [curve for glyph in glyphs for curve in glyph.curves]
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
    """Returns the characters of a text that have ink, in order, with known characters only.

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
    """A font file, of which each character is read once."""

    def __init__(self, data: bytes) -> None:
        # Not imported at the top: a program without text needs no font.
        from fontTools.ttLib import TTFont

        self._file: TTFont = TTFont(BytesIO(data), lazy=True)
        self._names: Mapping[int, str] = self._file.getBestCmap()
        self._made: dict[str, tuple[Glyph | None, float]] = {}

    def __contains__(self, character: str) -> bool:
        return ord(character) in self._names

    def glyph(self, character: str) -> tuple[Glyph | None, float]:
        """Returns the outline of a character at the origin (None for a blank) and its advance width."""
        if character not in self._made:
            self._made[character] = self._read(character)
        return self._made[character]

    def _read(self, character: str) -> tuple[Glyph | None, float]:
        from fontTools.pens.recordingPen import DecomposingRecordingPen

        glyphs, name = self._file.getGlyphSet(), self._names[ord(character)]
        pen = DecomposingRecordingPen(glyphs)
        glyphs[name].draw(pen)
        unit = 1.0 / self._capital_height
        curves = tuple(
            tuple((x * unit, y * unit) for x, y in curve)
            for curve in _curves(pen.value)
            if len(set(curve)) > 1
        )
        advance = float(glyphs[name].width) * unit
        return (Glyph(curves, _ink(curves)) if curves else None), advance

    @cached_property
    def _capital_height(self) -> float:
        """The height of an H in font units."""
        return float(self._file["glyf"][self._names[ord("H")]].yMax)


@cache
def plain_font() -> Font:
    return Font(resource(f"{_FOLDER}/DejaVuSansAIDL.ttf").read_bytes())


@cache
def bold_font() -> Font:
    return Font(resource(f"{_FOLDER}/DejaVuSansAIDL-Bold.ttf").read_bytes())


def _curves(commands: Sequence[tuple[str, Any]]) -> Iterator[Curve]:
    """Yields the curves of what a pen drew, contour by contour, in font units."""
    from fontTools.pens.basePen import decomposeQuadraticSegment

    first = here = (0.0, 0.0)
    for command, points in commands:
        if command == "moveTo":
            first = here = points[0]
        elif command == "lineTo":
            yield here, points[0]
            here = points[0]
        elif command == "qCurveTo":
            if points[-1] is None:  # a contour of control points only starts between two of them
                (x0, y0), (x1, y1) = points[-2], points[0]
                first = here = (x0 + x1) / 2, (y0 + y1) / 2
                points = (*points[:-1], here)
            for control, end in decomposeQuadraticSegment(points):
                yield _raised(here, control, end)
                here = end
        elif command == "closePath":
            yield here, first
        else:
            raise ValueError(f"{command} in a TrueType outline")


def _raised(a: Vec, b: Vec, c: Vec) -> Curve:
    """Returns a quadratic Bézier curve as the same cubic one."""
    one = (a[0] + 2 * b[0]) / 3, (a[1] + 2 * b[1]) / 3
    two = (c[0] + 2 * b[0]) / 3, (c[1] + 2 * b[1]) / 3
    return a, one, two, c


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

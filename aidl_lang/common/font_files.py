"""Font files: the outlines of characters, their advance widths and the height of a capital, in font units.

TrueType outlines have quadratic splines, those of OpenType's CFF cubic ones; both come out as cubic Bézier
curves, which are the same curves. A file may be anybody's, so that nothing in it is believed: what is broken,
or would take long or much memory to read, raises `FontError`.
"""

from __future__ import annotations

import logging
import math
import struct
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from functools import cached_property
from io import BytesIO
from itertools import pairwise
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from aidl_lang.common.running import checkpoint

if TYPE_CHECKING:
    from fontTools.ttLib import TTFont

Vec = tuple[float, float]
Curve = tuple[Vec, ...]
"""The two ends of a line, or the four control points of a cubic Bézier curve; a single point is a place."""


_KINDS = (b"\0\1\0\0", b"true", b"OTTO")
"""What a file with one font begins with."""
_MOST_CURVES = 10_000
_MOST_COMPONENTS = 200
"""Characters that one is made of, and those of which these are."""
_MOST_STEPS = 200_000
"""Bytes of the programs that draw one character, each counted as often as it is called."""

FAULTS = (
    *(ArithmeticError, AssertionError, AttributeError, EOFError, LookupError, NameError, NotImplementedError),
    *(OSError, RecursionError, StopIteration, TypeError, ValueError, struct.error),
)
"""What libraries raise for files that are not as they should be, beside their own errors."""

# What fontTools would say of a file is told by diagnostics; it is not printed beside them.
logging.getLogger("fontTools").addHandler(logging.NullHandler())


class FontError(Exception):
    """Raised for a file, or for a character of it, that cannot be drawn with; the text is the reason."""


class FontFile:
    """A font file, of which each character is read when it is asked for."""

    def __init__(self, data: bytes) -> None:
        """Raises FontError."""
        # Not imported at the top: a program without text needs no font.
        from fontTools.ttLib import TTFont, TTLibError

        if data[:4] not in _KINDS:
            raise FontError("it is no TrueType or OpenType font")
        try:
            self._file: TTFont = TTFont(BytesIO(data), lazy=True)
            self._runs = _runs(self._file.reader["cmap"])
            self._draw = _cff(self._file) if "CFF " in self._file else _true_type(self._file)
            self._advances: dict[str, tuple[int, int]] = self._file["hmtx"].metrics
            if not self.capital_height > 0.0:
                raise FontError("it does not say how high its capitals are, and has no H")
        except (*FAULTS, TTLibError) as reason:
            raise FontError("its contents are broken") from reason

    def __contains__(self, character: str) -> bool:
        return self._glyph(character) > 0

    def _glyph(self, character: str) -> int:
        """Returns the number of a glyph; 0, which is the sign for a missing character, if there is none."""
        code = ord(character)
        k = bisect_left(self._runs, code, key=lambda run: run[1])
        if k == len(self._runs) or self._runs[k][0] > code:
            return 0
        first, _, glyph = self._runs[k]
        return glyph + code - first

    def outline(self, character: str) -> tuple[tuple[Curve, ...], float]:
        """Returns the curves of a character, contour by contour, and its advance width. Raises FontError."""
        from fontTools.ttLib import TTLibError

        try:
            name = self._file.getGlyphName(self._glyph(character))
            return self._curves_of(name), float(self._advances[name][0])
        except (*FAULTS, TTLibError) as reason:
            raise FontError(f"its outline of `{character}` is broken") from reason

    @cached_property
    def capital_height(self) -> float:
        """The height of a capital as the font states it, otherwise that of its H; 0 without either."""
        stated = getattr(self._file["OS/2"], "sCapHeight", 0) if "OS/2" in self._file else 0
        if stated > 0:
            return float(stated)
        curves = self.outline("H")[0] if "H" in self else ()
        return max((y for curve in curves for _, y in (curve[0], curve[-1])), default=0.0)

    def _curves_of(self, name: str) -> tuple[Curve, ...]:
        from fontTools.pens.recordingPen import DecomposingRecordingPen

        drawers = _Drawers(self._draw)
        pen = DecomposingRecordingPen(drawers)
        drawers[name].draw(pen)
        curves = tuple(curve for curve in _curves(pen.value) if len(set(curve)) > 1)
        if len(curves) > _MOST_CURVES:
            raise FontError(f"it has a character of more than {_MOST_CURVES:,} curves")
        if not all(math.isfinite(v) for curve in curves for p in curve for v in p):
            raise FontError("it has a character without bounds")
        return curves


# --- Which character is which glyph ----------------------------------------------------------------


def _runs(data: bytes) -> list[tuple[int, int, int]]:
    """Returns the Unicode map of a `cmap` table in runs of consecutive characters: the first, the last, the
    glyph of the first. Runs stay runs, as one may claim to have all characters.
    """
    (count,) = struct.unpack_from(">H", data, 2)
    found: dict[int, int] = {}
    for k in range(count):
        platform, encoding, at = struct.unpack_from(">HHL", data, 4 + 8 * k)
        if platform == 0 or (platform == 3 and encoding in (1, 10)):
            found.setdefault(struct.unpack_from(">H", data, at)[0], at)
    if 12 in found:
        at = found[12]
        (count,) = struct.unpack_from(">L", data, at + 12)
        groups = range(min(count, len(data) // 12))
        runs = [struct.unpack_from(">LLL", data, at + 16 + 12 * k) for k in groups]
        return sorted(runs, key=lambda run: run[1])
    if 4 in found:
        return sorted(_segments(data, found[4]), key=lambda run: run[1])
    raise FontError("it does not say which characters it has")


def _segments(data: bytes, at: int) -> Iterator[tuple[int, int, int]]:
    """Yields the runs of a map of format 4; glyphs that are listed one by one are runs of one."""
    count = struct.unpack_from(">H", data, at + 6)[0] // 2
    lasts, firsts = at + 14, at + 16 + 2 * count
    beyond = -1
    for k in range(count):
        (last,), (first,) = (struct.unpack_from(">H", data, table + 2 * k) for table in (lasts, firsts))
        (delta,) = struct.unpack_from(">h", data, firsts + 2 * count + 2 * k)
        place = firsts + 4 * count + 2 * k
        (offset,) = struct.unpack_from(">H", data, place)
        if not beyond < first <= last:  # they are to be in order; what is not would be listed again and again
            continue
        beyond = last
        for code in range(first, last + 1):
            glyph = code
            if offset:
                if place + offset + 2 * (code - first) + 2 > len(data):
                    break
                (glyph,) = struct.unpack_from(">H", data, place + offset + 2 * (code - first))
            if glyph or not offset:
                yield code, code, (glyph + delta) & 0xFFFF


# --- Drawing ---------------------------------------------------------------------------------------


class _Drawers:
    """The glyphs of a font by name, as a pen of fontTools looks them up, for one that is made of others."""

    def __init__(self, draw: Any) -> None:
        self._draw, self._count = draw, 0

    def __getitem__(self, name: str) -> SimpleNamespace:
        self._count += 1
        if self._count > _MOST_COMPONENTS:
            raise FontError(f"it has a character made of more than {_MOST_COMPONENTS} others")
        checkpoint()
        is_part = self._count > 1
        return SimpleNamespace(draw=lambda pen: self._draw(name, pen, is_part))


def _true_type(file: TTFont) -> Any:
    file.setGlyphOrder([f"glyph{k}" for k in range(file["maxp"].numGlyphs)])
    if any(after < before for before, after in pairwise(file["loca"].locations)):
        raise FontError("its contents are broken")
    glyphs, metrics = file["glyf"], file["hmtx"].metrics

    def draw(name: str, pen: Any, is_part: bool) -> None:
        glyph = glyphs[name]
        is_shifted = not is_part and hasattr(glyph, "xMin")
        glyph.draw(pen, glyphs, metrics[name][1] - glyph.xMin if is_shifted else 0)

    return draw


def _cff(file: TTFont) -> Any:
    from fontTools.misc.psCharStrings import T2OutlineExtractor

    class Counting(T2OutlineExtractor):  # type: ignore[misc]
        steps = 0

        def execute(self, charString: Any, **other: Any) -> None:  # noqa: N803 (the name in the library)
            checkpoint()
            self.steps += 1 + len(charString.bytecode or charString.program)
            if self.steps > _MOST_STEPS:
                raise FontError("it has a character that takes too many steps to draw")
            super().execute(charString, **other)

    file.setGlyphOrder(file["CFF "].getGlyphOrder())
    programs = file["CFF "].cff.topDictIndex[0].CharStrings

    def draw(name: str, pen: Any, is_part: bool) -> None:
        program = programs[name]
        own = program.private
        subroutines = getattr(own, "Subrs", [])
        widths = own.nominalWidthX, own.defaultWidthX
        Counting(pen, subroutines, program.globalSubrs, *widths, own, None).execute(program)

    return draw


def _curves(commands: Sequence[tuple[str, Any]]) -> Iterator[Curve]:
    """Yields the curves of what a pen drew, contour by contour, in font units."""
    from fontTools.pens.basePen import decomposeQuadraticSegment, decomposeSuperBezierSegment

    first = here = (0.0, 0.0)
    for command, points in commands:
        if command == "moveTo":
            first = here = points[0]
        elif command == "lineTo":
            yield here, points[0]
            here = points[0]
        elif command == "curveTo":
            for one, two, end in decomposeSuperBezierSegment(points):
                yield here, one, two, end
                here = end
        elif command == "qCurveTo":
            if points[-1] is None:  # a contour of control points only starts between two of them
                (x0, y0), (x1, y1) = points[-2], points[0]
                first = here = (x0 + x1) / 2, (y0 + y1) / 2
                points = (*points[:-1], here)
            for control, end in decomposeQuadraticSegment(points):
                yield quadratic(here, control, end)
                here = end
        elif command == "closePath":
            yield here, first
        else:
            raise ValueError(f"{command} in an outline")


def quadratic(a: Vec, b: Vec, c: Vec) -> Curve:
    """Returns a quadratic Bézier curve as the same cubic one."""
    one = (a[0] + 2 * b[0]) / 3, (a[1] + 2 * b[1]) / 3
    two = (c[0] + 2 * b[0]) / 3, (c[1] + 2 * b[1]) / 3
    return a, one, two, c


def point_of(curve: Curve, t: float) -> Vec:
    """Returns the point of a cubic Bézier curve at a parameter."""
    s = 1.0 - t
    a, b, c, d = s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = curve
    return a * x0 + b * x1 + c * x2 + d * x3, a * y0 + b * y1 + c * y2 + d * y3

"""PDF and PNG: pictures with the bundled font in them, and no other."""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np

from aidl_lang.common.colors import rgb
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.lettering import unknown_characters
from aidl_lang.common.prose import first_few, size_text
from aidl_lang.common.resources import resource
from aidl_lang.common.running import checkpoint
from aidl_lang.export import marks
from aidl_lang.export.job import ExportError
from aidl_lang.export.marks import Area, Curves, Dot, Frame, Gradient, Group, Ink, Mark, Picture, Text
from aidl_lang.export.svg import to_svg
from aidl_lang.geometry.curves import Bezier, Bounds, Circle, Line, Piece, Vec
from aidl_lang.version import __version__

# --- The font of texts in pictures, for formats that embed it.

FAMILY = "DejaVu Sans AIDL"
_NAMED = 8


def font_file() -> str:
    return str(resource("aidl_lang/common/fonts/DejaVuSansAIDL.ttf"))


def character_notes(pages: Iterable[Picture]) -> tuple[Diagnostic, ...]:
    """Warns of characters in the texts that the font lacks."""
    texts = (mark.text for page in pages for mark in marks.separated(page)[1])
    missing = unknown_characters("".join(dict.fromkeys("".join(texts))))
    if not missing:
        return ()
    shown = first_few([f"`{c}`" if c.isprintable() else f"U+{ord(c):04X}" for c in missing], _NAMED)
    message = f"the font has no {shown}; texts in the picture show a box in their place"
    return (Diagnostic("W0733", message, hints=("an SVG is shown with the fonts of the reader's system",)),)


SLIMMEST = 1 / 100
"""Largest ratio of the sides; a longer picture gets more white along its sides."""
LARGEST = 1e5
"""mm. A larger picture is drawn in another scale."""
MM_PER_INCH = 25.4
_DENSITIES = (0.1, 1e6)
"""Dots per inch that a PNG can state."""


def to_png(picture: Picture, pixels: int) -> bytes:
    """Returns the picture with so many pixels along its larger side, and its resolution stated."""
    import resvg_py
    from PIL import Image

    whole = max(picture.width, picture.height)
    picture = marks.spaced(picture, SLIMMEST * whole, SLIMMEST * whole)
    density = MM_PER_INCH * pixels / whole
    if whole > LARGEST:  # round lines of such a size take resvg for ever, however few pixels they are
        picture = marks.scaled(picture, LARGEST / whole)
    per_mm = pixels / max(picture.width, picture.height)
    picture = marks.resolved(picture, 1 / per_mm)
    width, height = round(picture.width * per_mm), round(picture.height * per_mm)
    drawn = resvg_py.svg_to_bytes(
        svg_string=to_svg(picture, (width, height)),
        background="#ffffff",
        skip_system_fonts=True,
        font_files=[font_file()],
        font_family=FAMILY,
        sans_serif_family=FAMILY,
        width=width,
        height=height,
    )
    stated = {"dpi": (density, density)} if _DENSITIES[0] < density < _DENSITIES[1] else {}
    data = io.BytesIO()
    with Image.open(io.BytesIO(bytes(drawn))) as image:
        image.convert("RGB").save(data, "PNG", **stated)
    return data.getvalue()


# --- PDF: pictures at 1:1, one on each page, as vectors with the font embedded.
#
# PDF has no arcs: those of circles and ellipses become cubic Bézier curves, each over at most a sixteenth of
# a turn, which depart from a circle of radius r by less than 1e-7 r.

POINTS_PER_MM = 72 / 25.4
LONGEST = 14_400 / POINTS_PER_MM
"""Sides of pages end here (PDF 32000-1, annex C)."""
_STEP = math.tau / 16
_FILLED_AND_STROKED = 2
_WHITE = "#ffffff"
_LAYERS = 40
"""Layers of a fill that fades to nothing."""
_FAR = 1e5
"""mm; as far as any drawing goes on paper."""


def to_pdf(pages: Sequence[Picture], title: str) -> bytes:
    """Writes the pictures as a document. Raises ExportError (E0921) for one larger than a page may be."""
    from reportlab.pdfbase import pdfmetrics
    from reportlab.pdfbase.ttfonts import TTFont
    from reportlab.pdfgen.canvas import Canvas

    for page in pages:
        if max(page.width, page.height) > LONGEST:
            size = size_text((page.width, page.height))
            message = f"the picture measures {size}, and a page of a PDF ends at {LONGEST:.0f} mm"
            raise ExportError("E0921", message, "print it over several pages: `--tile a0`")
    pdfmetrics.registerFont(TTFont(FAMILY, font_file()))
    data = io.BytesIO()
    # invariant: no dates and no random numbers
    canvas = Canvas(data, invariant=1)
    canvas.setTitle(title)
    canvas.setCreator(f"AIDL {__version__}")
    for page in pages:
        canvas.setPageSize((page.width * POINTS_PER_MM, page.height * POINTS_PER_MM))
        canvas.scale(POINTS_PER_MM, POINTS_PER_MM)
        canvas.translate(-page.box[0], -page.box[1])
        pen = _Pen(canvas)
        for group in page.groups:
            pen.group(group)
        canvas.showPage()
    canvas.save()
    return data.getvalue()


class _Pen:
    """Draws marks on a page whose unit is a millimetre."""

    def __init__(self, canvas: Any) -> None:
        self._canvas = canvas

    def group(self, group: Group) -> None:
        with self._state():
            if group.clip is not None:
                self._canvas.clipPath(self._frame_path(group.clip), stroke=0, fill=0)
            for mark in group.marks:
                checkpoint()
                with self._state():
                    self._draw(mark)

    @contextmanager
    def _state(self) -> Iterator[None]:
        self._canvas.saveState()
        yield
        self._canvas.restoreState()

    def _draw(self, mark: Mark) -> None:
        match mark:
            case Area():
                self._area(mark)
            case Curves():
                path = self._canvas.beginPath()
                _add_pieces(path, mark.pieces)
                self._ink(mark.ink)
                self._canvas.drawPath(path)
            case Text():
                self._lettering(mark)
            case Dot():
                self._fill(mark.color)
                self._ink(Ink(_WHITE, 0.3 * mark.radius))
                path = self._canvas.beginPath()
                _add_pieces(path, [Circle(mark.at, mark.radius)])
                self._canvas.drawPath(path, fill=1)
            case Frame():
                self._ink(mark.ink)
                self._canvas.drawPath(self._frame_path(mark.box))

    def _area(self, mark: Area) -> None:
        path = self._canvas.beginPath()
        for loop in mark.face.loops:
            _add_pieces(path, loop.pieces)
            path.close()
        if mark.fill is not None:
            self._fill(mark.fill)
            if mark.opacity != 1:
                self._canvas.setFillAlpha(mark.opacity)
        if mark.ink is not None:
            self._ink(mark.ink)
        is_lined, is_filled = mark.ink is not None, mark.fill is not None
        if mark.gradient is not None and mark.gradient.fades:
            self._fade(path, mark.gradient, mark.opacity)
            is_filled = False
        elif mark.gradient is not None:
            if mark.opacity == 1:  # for readers without gradients
                self._canvas.drawPath(path, fill=is_filled, stroke=is_lined, fillMode=0)
            self._shade(path, mark.gradient)
            is_filled = False
        if is_filled or is_lined:
            self._canvas.drawPath(path, fill=is_filled, stroke=is_lined, fillMode=0)

    def _shade(self, path: Any, gradient: Gradient) -> None:
        shares = [stop.share for stop in gradient.stops]
        colors = [self._color(stop.color) for stop in gradient.stops]
        with self._state():
            self._canvas.clipPath(path, stroke=0, fill=0, fillMode=0)
            if gradient.radius is None:
                self._canvas.linearGradient(*gradient.start, *gradient.end, colors, shares)
            else:
                self._canvas.radialGradient(*gradient.start, gradient.radius, colors, shares)

    def _fade(self, path: Any, gradient: Gradient, opacity: float) -> None:
        """Fills a path with one colour that fades to nothing: in layers that lie on each other, as readers
        agree on these and not on gradients of opacity.
        """
        shares = np.linspace(0.0, 1.0, _LAYERS + 1)
        told = np.array([(stop.share, stop.opacity) for stop in gradient.stops])
        seen = np.interp((shares[:-1] + shares[1:]) / 2, *told.T) * opacity
        through = 1.0 - np.append(seen, 0.0)
        with self._state():
            self._canvas.clipPath(path, stroke=0, fill=0, fillMode=0)
            for layer in range(_LAYERS - 1, -1, -1):
                self._canvas.setFillAlpha(1.0 - through[layer] / through[layer + 1])
                self._canvas.drawPath(self._within(gradient, shares[layer + 1]), fill=1, stroke=0)

    def _within(self, gradient: Gradient, share: float) -> Any:
        """Returns the area that a gradient covers up to a share of its way."""
        path, (x, y) = self._canvas.beginPath(), gradient.start
        if gradient.radius is not None:
            across, up = gradient.radius * share, gradient.radius * gradient.height * share
            path.ellipse(x - across, y - up, 2 * across, 2 * up)
            return path
        dx, dy = gradient.end[0] - x, gradient.end[1] - y
        far = _FAR / math.hypot(dx, dy)
        corners = ((-far, -far), (share, -far), (share, far), (-far, far))
        first, *others = (
            (x + along * dx - aside * dy, y + along * dy + aside * dx) for along, aside in corners
        )
        path.moveTo(*first)
        for corner in others:
            path.lineTo(*corner)
        path.close()
        return path

    def _lettering(self, mark: Text) -> None:
        canvas = self._canvas
        canvas.translate(*mark.at)
        canvas.rotate(mark.angle)
        width = canvas.stringWidth(mark.text, FAMILY, mark.size)
        left = marks.ANCHORS[mark.anchor] * width
        if mark.halo:
            with self._state():
                self._text(mark, left, _WHITE, Ink(_WHITE, 0.22 * mark.size, is_round=True))
        # The font has one weight: a line of its own colour around it makes it bold.
        self._text(mark, left, mark.color, Ink(mark.color, 0.04 * mark.size) if mark.bold else None)

    def _frame_path(self, box: Bounds) -> Any:
        path = self._canvas.beginPath()
        path.rect(box[0], box[1], box[2] - box[0], box[3] - box[1])
        return path

    def _text(self, mark: Text, left: float, fill: str, ink: Ink | None) -> None:
        text = self._canvas.beginText(left, 0)
        text.setFont(FAMILY, mark.size)
        self._fill(fill)
        if ink is not None:
            self._ink(ink)
            text.setTextRenderMode(_FILLED_AND_STROKED)
        text.textOut(mark.text)
        self._canvas.drawText(text)

    def _fill(self, color: str) -> None:
        self._canvas.setFillColor(self._color(color))

    @staticmethod
    def _color(color: str) -> Any:
        from reportlab.lib.colors import Color

        return Color(*(part / 255 for part in rgb(color)))

    def _ink(self, ink: Ink) -> None:
        canvas = self._canvas
        canvas.setStrokeColorRGB(*(c / 255 for c in rgb(ink.color)))
        canvas.setLineWidth(ink.width)
        canvas.setLineCap(int(ink.is_round))
        canvas.setLineJoin(int(ink.is_round))
        if ink.opacity != 1:
            canvas.setStrokeAlpha(ink.opacity)
        if ink.dash is not None:
            canvas.setDash(list(ink.dash))


def _add_pieces(path: Any, pieces: Iterable[Piece]) -> None:
    """Adds curves one after the other, moving only where one does not start at the end of the one before."""
    at: Vec | None = None
    for piece in pieces:
        start, end = piece.ends
        if start != at:
            path.moveTo(*start)
        if isinstance(piece, Line):
            path.lineTo(*end)
        else:
            for cubic in _cubics(piece):
                path.curveTo(*(c for p in cubic[1:] for c in p))
        at = end


def _cubics(piece: Piece) -> Iterator[tuple[Vec, Vec, Vec, Vec]]:
    if isinstance(piece, Bezier):
        yield piece.p0, piece.p1, piece.p2, piece.p3
        return
    assert not isinstance(piece, Line)
    sweep = piece.range[1]
    count = max(1, math.ceil(abs(sweep) / _STEP - 1e-9))
    # The handles that meet the arc in its middle (Farin, Curves and Surfaces, ch. 4): 4/3 tan(a/4) times the
    # derivative by the angle, which is that by the parameter over the sweep.
    reach = 4 / 3 * math.tan(sweep / count / 4) / sweep
    for k in range(count):
        t0, t1 = k / count, (k + 1) / count
        (x0, y0), (x1, y1) = piece.point(t0), piece.point(t1)
        (u0, v0), (u1, v1) = piece.derivative(t0), piece.derivative(t1)
        handles = (x0 + reach * u0, y0 + reach * v0), (x1 - reach * u1, y1 - reach * v1)
        yield (x0, y0), *handles, (x1, y1)

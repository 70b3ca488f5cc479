"""The contact sheet as a PDF to print: pages of A4."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

from aidl_lang.common.materials import PAPERS
from aidl_lang.export.pdf import POINTS_PER_MM
from aidl_lang.export.png import FAMILY, font_file
from aidl_lang.tools.sweeping.rows import Row
from aidl_lang.tools.sweeping.sheet.layout import on_paper, paint
from aidl_lang.version import __version__


def pdf(title: str, rows: Sequence[Row]) -> bytes:
    """Returns the sheet; its bytes depend on the rows alone."""
    from reportlab.pdfbase import pdfmetrics
    from reportlab.pdfbase.ttfonts import TTFont
    from reportlab.pdfgen.canvas import Canvas

    pdfmetrics.registerFont(TTFont(FAMILY, font_file()))
    width, height = sorted(PAPERS["a4"])
    data = io.BytesIO()
    canvas = Canvas(data, (width * POINTS_PER_MM, height * POINTS_PER_MM), invariant=1)
    canvas.setTitle(title)
    canvas.setCreator(f"AIDL {__version__}")
    grid = on_paper(width, height)
    for first in range(0, max(1, len(rows)), grid.per_page):
        canvas.scale(POINTS_PER_MM, POINTS_PER_MM)
        paint(_Paper(canvas, height), grid, title, rows, first)
        canvas.showPage()
    canvas.save()
    return data.getvalue()


class _Paper:
    """A page of a PDF whose unit is a millimetre."""

    def __init__(self, canvas: Any, height: float) -> None:
        self._canvas, self._height = canvas, height

    def box(self, x: float, y: float, width: float, height: float, fill: str, line: str) -> None:
        self._canvas.setLineWidth(0.2)
        self._canvas.setFillColor(fill)
        self._canvas.setStrokeColor(line)
        self._canvas.rect(x, self._height - y - height, width, height, fill=1)

    def text(self, x: float, y: float, size: float, colour: str, text: str) -> None:
        self._canvas.setFont(FAMILY, size)
        self._canvas.setFillColor(colour)
        self._canvas.drawString(x, self._height - y, text)

    def length(self, text: str, size: float) -> float:
        found: float = self._canvas.stringWidth(text, FAMILY, size)
        return found

    def picture(self, x: float, y: float, width: float, height: float, png: bytes) -> None:
        from reportlab.lib.utils import ImageReader

        image = ImageReader(io.BytesIO(png))
        self._canvas.drawImage(
            image, x, self._height - y - height, width, height, preserveAspectRatio=True, anchor="c"
        )

"""The contact sheet of a sweep: a small picture of each variant, its params and what is wrong with it."""

from __future__ import annotations

import html
import io
import json
import math
from base64 import b64encode
from collections.abc import Sequence
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from aidl_lang.common.materials import PAPERS
from aidl_lang.common.prose import counted
from aidl_lang.common.records import record
from aidl_lang.common.render import escape
from aidl_lang.export.pdf import FAMILY, POINTS_PER_MM, font_file
from aidl_lang.tools.sweeping.outputs import Columns, Row
from aidl_lang.tools.sweeping.plan import shown
from aidl_lang.version import __version__

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageFont import FreeTypeFont


# --- Lays the variants out in rows of cells, on whatever can be painted on. Lengths in mm, y runs down.

MARGIN = 12.0
_HEAD = 10.0
_GAP = 4.0
_LINE = 3.4
_TEXT = 2.6
_LINES = 4
_COLUMNS = 4
"""Of a page of paper."""
_INK, _GREY, _RED, _PALE = "#1c2330", "#8a93a3", "#b3261e", "#fdf1f0"


Painter: TypeAlias = "_Paper | _Pixels"
"""What a sheet is painted on: boxes, lines of text whose baseline begins at a point, and pictures as large as
fits into a box, in its middle.
"""


@record()
class Grid:
    """So many columns and rows of square pictures with texts below, on pages of one size."""

    columns: int
    rows: int
    side: float

    @property
    def cell(self) -> float:
        """Returns the height of a cell."""
        return self.side + _LINES * _LINE + 2 * _GAP

    @property
    def size(self) -> tuple[float, float]:
        """Returns the size of a page that is just large enough."""
        width = self.columns * (self.side + _GAP) - _GAP
        return 2 * MARGIN + width, 2 * MARGIN + _HEAD + self.rows * self.cell

    @property
    def per_page(self) -> int:
        return self.columns * self.rows


def on_paper(width: float, height: float) -> Grid:
    side = (width - 2 * MARGIN + _GAP) / _COLUMNS - _GAP
    cell = Grid(_COLUMNS, 1, side).cell
    return Grid(_COLUMNS, max(1, math.floor((height - 2 * MARGIN - _HEAD) / cell)), side)


def in_one(count: int, side: float) -> Grid:
    """Returns the grid that has all variants on one page about as wide as high."""
    columns = max(1, min(count, math.ceil(math.sqrt(count * Grid(1, 1, side).cell / side))))
    return Grid(columns, math.ceil(count / columns), side)


def paint(painter: Painter, grid: Grid, title: str, rows: Sequence[Row], first: int = 0) -> None:
    """Paints one page: the variants from the one at `first`."""
    failing = sum(not row.ok for row in rows)
    head = f"{escape(title)}: {counted(len(rows), 'variant')}, {failing or 'none'} failing"
    width = grid.size[0] - 2 * MARGIN
    painter.text(MARGIN, MARGIN + 4, 4.2, _INK, fitted(painter, head, 4.2, width))
    for k, row in enumerate(rows[first : first + grid.per_page]):
        x = MARGIN + k % grid.columns * (grid.side + _GAP)
        y = MARGIN + _HEAD + k // grid.columns * grid.cell
        _paint_cell(painter, grid.side, x, y, row)


def _paint_cell(painter: Painter, side: float, x: float, y: float, row: Row) -> None:
    painter.box(x, y, side, side, "#ffffff" if row.ok else _PALE, "#d5dae3" if row.ok else _RED)
    if row.outcome.picture:
        painter.picture(x + 1.5, y + 1.5, side - 3, side - 3, row.outcome.picture)
    else:
        painter.text(x + 3, y + side / 2, _TEXT, _GREY, "no drawing")
    message = _lines(painter, _plain(row.message).split(), side, 2, " ") if not row.ok else []
    words = [f"{row.variant.number}"]
    words += [_plain(f"{path} {shown(value)}") for path, value in row.variant.values.items()]
    lines = [(line, _INK) for line in _lines(painter, words, side, _LINES - len(message), "  ")]
    lines += [(line, _RED) for line in message]
    for k, (line, colour) in enumerate(lines):
        painter.text(x, y + side + _LINE * (k + 1), _TEXT, colour, fitted(painter, line, _TEXT, side))


def _plain(text: str) -> str:
    return escape(text[:300]).replace("\n", " ")


def _lines(painter: Painter, words: Sequence[str], width: float, most: int, between: str) -> list[str]:
    """Returns words as lines of a width, `most` at most; the last has all that is left."""
    lines: list[str] = []
    for word in words:
        longer = f"{lines[-1]}{between}{word}" if lines else word
        if lines and (len(lines) == most or painter.length(longer, _TEXT) <= width):
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def fitted(painter: Painter, text: str, size: float, width: float) -> str:
    text = text[:300]
    while len(text) > 1 and painter.length(text, size) > width:
        text = f"{text.removesuffix('…')[:-1]}…"
    return text


# --- The contact sheet as a page: one file that asks for nothing, with the knobs as filters.
#
# Values are strangers' text: the page is filled by its script, which sets texts and never markup, and its
# policy lets no other script run.

_HERE = Path(__file__).parent


def page(title: str, columns: Columns, rows: Sequence[Row]) -> bytes:
    script = (_HERE / "sheet.js").read_text(encoding="utf-8")
    style = (_HERE / "sheet.css").read_text(encoding="utf-8")
    data = {
        "title": title,
        "given": columns.given,
        "columns": columns.names,
        "rows": [_entry(columns, row) for row in rows],
    }
    policy = f"default-src 'none'; img-src data:; style-src {_hash(style)}; script-src {_hash(script)}"
    told = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{html.escape(policy)}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{html.escape(title)}</title><style>{style}</style></head><body>",
        '<header><h1></h1><p id="count" role="status"></p></header>',
        '<form id="filters" autocomplete="off"></form><main id="cards"></main>',
        f'<script type="application/json" id="data">{_json(data)}</script>',
        f"<script>{script}</script></body></html>\n",
    ]
    return "\n".join(told).encode("utf-8", "backslashreplace")


def _entry(columns: Columns, row: Row) -> dict[str, Any]:
    return {
        "cells": columns.by_name(row),
        "ok": row.ok,
        "message": row.message,
        "picture": b64encode(row.outcome.picture).decode(),
    }


def _json(data: object) -> str:
    """Returns JSON as it may stand in a script: nothing in it ends the element or begins a comment."""
    return (
        json.dumps(data, ensure_ascii=True, allow_nan=False).replace("<", "\\u003c").replace(">", "\\u003e")
    )


def _hash(text: str) -> str:
    return f"'sha256-{b64encode(sha256(text.encode()).digest()).decode()}'"


# --- The contact sheet as a PDF to print: pages of A4.


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


_SIDE = 40.0
_SHARPEST = 6.0
"""Pixels per mm."""
_LARGEST = 60_000_000
"""Most pixels of all of it."""


def png(title: str, rows: Sequence[Row]) -> bytes:
    from PIL import Image

    grid = in_one(max(1, len(rows)), _SIDE)
    width, height = grid.size
    per_mm = min(_SHARPEST, math.sqrt(_LARGEST / (width * height)))
    image = Image.new("RGB", (round(width * per_mm), round(height * per_mm)), "#ffffff")
    paint(_Pixels(image, per_mm), grid, title, rows)
    data = io.BytesIO()
    image.save(data, "PNG")
    return data.getvalue()


class _Pixels:
    """A picture with so many pixels per mm."""

    def __init__(self, image: Image, per_mm: float) -> None:
        from PIL import ImageDraw

        self._image, self._per_mm = image, per_mm
        self._draw = ImageDraw.Draw(image)

    def box(self, x: float, y: float, width: float, height: float, fill: str, line: str) -> None:
        k = self._per_mm
        self._draw.rectangle((x * k, y * k, (x + width) * k, (y + height) * k), fill=fill, outline=line)

    def text(self, x: float, y: float, size: float, colour: str, text: str) -> None:
        k = self._per_mm
        self._draw.text((x * k, y * k), text, fill=colour, font=self._font(size), anchor="ls")

    def length(self, text: str, size: float) -> float:
        return self._font(size).getlength(text) / self._per_mm

    def picture(self, x: float, y: float, width: float, height: float, png: bytes) -> None:
        from PIL import Image

        k = self._per_mm
        with Image.open(io.BytesIO(png), formats=["PNG"]) as found:
            small = found.convert("RGB")
        small.thumbnail((max(1, round(width * k)), max(1, round(height * k))))
        left, top = x * k + (width * k - small.width) / 2, y * k + (height * k - small.height) / 2
        self._image.paste(small, (round(left), round(top)))

    def _font(self, size: float) -> FreeTypeFont:
        return _loaded(max(1, round(size * self._per_mm)))


@lru_cache(maxsize=8)
def _loaded(pixels: int) -> FreeTypeFont:
    from PIL import ImageFont

    return ImageFont.truetype(font_file(), pixels, layout_engine=ImageFont.Layout.BASIC)


def contact_sheet(suffix: str, title: str, columns: Columns, rows: Sequence[Row]) -> bytes:
    """Returns a contact sheet in the format of a suffix: `.html`, `.pdf` or `.png`."""
    if suffix == ".html":
        return page(title, columns, rows)
    if suffix == ".pdf":
        return pdf(title, rows)
    return png(title, rows)

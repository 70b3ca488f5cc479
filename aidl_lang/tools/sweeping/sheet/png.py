"""The contact sheet as one picture."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

from aidl_lang.export.png import font_file
from aidl_lang.tools.sweeping.rows import Row
from aidl_lang.tools.sweeping.sheet.layout import in_one, paint

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageFont import FreeTypeFont

_SIDE = 40.0
_SHARPEST = 6.0
"""Pixels per mm."""
_LARGEST = 60_000_000
"""Most pixels of all of it."""


def png(title: str, rows: Sequence[Row]) -> bytes:
    """Returns the sheet."""
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
        self._draw.rectangle(
            (
                x * k,
                y * k,
                (x + width) * k,
                (y + height) * k,
            ),
            fill=fill,
            outline=line,
        )

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

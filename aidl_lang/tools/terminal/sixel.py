"""Sixel: bands of six rows, and in each band a layer for each colour that is in it (DEC VT340)."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from typing import Any

_COLOURS = 256
_ROWS = 6
_RUN = re.compile(r"(.)\1{3,}")
"""What gets shorter by being counted: `!4x` for `xxxx`."""


def sixel(png: bytes) -> str:
    """The picture in its own pixels, with the 256 colours that suit it best."""
    import numpy as np
    from PIL import Image

    with Image.open(io.BytesIO(png)) as image:
        indexed = image.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)
    pixels = np.asarray(indexed)
    height, width = pixels.shape
    used = [int(k) for k in np.unique(pixels)]
    palette = indexed.getpalette() or []
    colours = "".join(
        f"#{k};2;" + ";".join(str(round(part * 100 / 255)) for part in palette[3 * k : 3 * k + 3])
        for k in used
    )
    bands = "-".join("$".join(_layers(pixels[top : top + _ROWS])) for top in range(0, height, _ROWS))
    return f'\x1bP0;1;0q"1;1;{width};{height}{colours}{bands}\x1b\\'


def _layers(band: Any) -> Iterator[str]:
    """Yields for each colour of a band its columns, a bit for each row."""
    import numpy as np

    weights = (1 << np.arange(len(band), dtype=np.uint8))[:, None]
    for colour in np.unique(band):
        bits = ((band == colour) * weights).sum(axis=0, dtype=np.uint8)
        columns = (bits + 63).astype(np.uint8).tobytes().decode().rstrip("?")
        yield f"#{colour}" + _RUN.sub(lambda run: f"!{len(run[0])}{run[1]}", columns)

"""PNG: the SVG of a picture as pixels on white, with the bundled font and no other."""

from __future__ import annotations

import io
from collections.abc import Iterable
from dataclasses import replace

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.lettering import unknown_characters
from aidl_lang.common.prose import first_few
from aidl_lang.common.resources import resource
from aidl_lang.export.marks import Picture, Text, resolved, scaled
from aidl_lang.export.svg import to_svg

# --- The font of texts in pictures, for formats that embed it.

FAMILY = "DejaVu Sans AIDL"
_NAMED = 8


def font_file() -> str:
    return str(resource("aidl_lang/common/fonts/DejaVuSansAIDL.ttf"))


def character_notes(pages: Iterable[Picture]) -> tuple[Diagnostic, ...]:
    """Warns of characters in the texts that the font lacks."""
    texts = (
        mark.text for page in pages for group in page.groups for mark in group.marks if isinstance(mark, Text)
    )
    missing = unknown_characters("".join(dict.fromkeys("".join(texts))))
    if not missing:
        return ()
    shown = first_few([f"`{c}`" if c.isprintable() else f"U+{ord(c):04X}" for c in missing], _NAMED)
    return (
        Diagnostic(
            "W0733",
            f"the font has no {shown}; texts in the picture show a box in their place",
            hints=("an SVG is shown with the fonts of the reader's system",),
        ),
    )


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

    picture = _widened(picture)
    whole = max(picture.width, picture.height)
    density = MM_PER_INCH * pixels / whole
    if whole > LARGEST:  # round lines of such a size take resvg for ever, however few pixels they are
        picture = scaled(picture, LARGEST / whole)
    per_mm = pixels / max(picture.width, picture.height)
    picture = resolved(picture, 1 / per_mm)
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


def _widened(picture: Picture) -> Picture:
    left, bottom, right, top = picture.box
    least = SLIMMEST * max(picture.width, picture.height)
    x, y = max(0.0, least - picture.width) / 2, max(0.0, least - picture.height) / 2
    return replace(picture, box=(left - x, bottom - y, right + x, top + y))

"""The font of texts in pictures, for formats that embed it."""

from __future__ import annotations

from collections.abc import Iterable

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.lettering import unknown_characters
from aidl_lang.common.prose import first_few
from aidl_lang.common.resources import resource
from aidl_lang.export.marks import Picture, Text

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

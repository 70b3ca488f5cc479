"""Lengths and sizes of paper and sheets as people give them to commands and dialogs."""

from __future__ import annotations

import math
import re

from aidl_lang.checking.units import LENGTH, UNITS
from aidl_lang.common.materials import PAPERS

LARGEST = 1e5
"""Largest side of a sheet, mm."""

_SIZE = re.compile(r"(?P<width>[\d.]+)\s*[x×*]\s*(?P<height>[\d.]+)\s*(?P<unit>[a-z]*)")
_LENGTH = re.compile(r"(?P<number>[\d.]+)\s*(?P<unit>[a-z]*)")


def size(text: str) -> tuple[float, float]:
    """Parses width and height in mm: of a paper by its name, or as in `600x400`, `60x40cm`. Raises
    ValueError.
    """
    wanted = text.strip().lower()
    if wanted in PAPERS:
        return PAPERS[wanted]
    if found := _SIZE.fullmatch(wanted):
        sides = [_millimetres(found[side], found["unit"]) for side in ("width", "height")]
        if all(0 < side <= LARGEST for side in sides):
            return sides[0], sides[1]
    raise ValueError(
        f"expected a size such as 600x400, 60x40cm or 24x18in, or one of {', '.join(PAPERS)}, not `{text}`"
    )


def length(text: str) -> float:
    """Parses a length of 0 mm or more: `3`, `0.15mm`, `0.1in`. Raises ValueError."""
    found = _LENGTH.fullmatch(text.strip().lower())
    value = _millimetres(found["number"], found["unit"]) if found else math.nan
    if not 0 <= value <= LARGEST:
        raise ValueError(f"expected a length such as 3, 0.15mm or 0.1in, not `{text}`")
    return value


def _millimetres(number: str, unit: str) -> float:
    """Returns millimetres; NaN for an invalid length."""
    factor, dimension = UNITS.get(unit or "mm", (math.nan, LENGTH))
    try:
        return float(number) * factor if dimension == LENGTH else math.nan
    except ValueError:
        return math.nan

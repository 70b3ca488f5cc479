"""Dimensions and units, and lengths and sizes of paper as people give them."""

from __future__ import annotations

import math
import re
from functools import lru_cache
from typing import NamedTuple

from aidl_lang.common.materials import PAPERS

# Values are kept in millimetres, degrees and their products. A dimension counts powers of length and of
# angle; a number written without a unit is *bare*: it takes the dimension its place asks for, unchanged in
# value.


class Dimension(NamedTuple):
    length: int = 0
    angle: int = 0

    def __str__(self) -> str:
        if name := _NAMES.get(self):
            return name
        parts = [f"{n}^{p}" if p != 1 else n for n, p in (("mm", self.length), ("deg", self.angle)) if p]
        return " ".join(parts)


PLAIN = Dimension()
_PURE = (None, PLAIN)
LENGTH = Dimension(length=1)
ANGLE = Dimension(angle=1)
AREA = Dimension(length=2)

_NAMES = {PLAIN: "plain number", LENGTH: "length", ANGLE: "angle", AREA: "area", Dimension(3, 0): "volume"}

UNITS: dict[str, tuple[float, Dimension]] = {
    "mm": (1.0, LENGTH),
    "cm": (10.0, LENGTH),
    "m": (1000.0, LENGTH),
    "in": (25.4, LENGTH),
    "ft": (304.8, LENGTH),
    "deg": (1.0, ANGLE),
    "rad": (180.0 / math.pi, ANGLE),
    "turn": (360.0, ANGLE),
}
"""Unit suffix → factor to millimetres or degrees, and the dimension."""

MaybeDimension = Dimension | None
"""None is the dimension of a bare number."""


def describe(dimension: MaybeDimension) -> str:
    return "number without a unit" if dimension is None else str(dimension)


class UnequalError(ValueError):
    """Raised for two dimensions that do not go together; both are its arguments."""


def add(a: MaybeDimension, b: MaybeDimension) -> MaybeDimension:
    """Returns the dimension of a sum, difference, minimum or comparison.

    Raises UnequalError if the two do not go together.
    """
    if a is None or a == b:
        return b
    if b is None:
        return a
    raise UnequalError(a, b)


@lru_cache(maxsize=256)
def multiply(a: MaybeDimension, b: MaybeDimension) -> MaybeDimension:
    """Returns the dimension of a product; a bare number times a plain one (`10 * cos(a)`) stays bare."""
    if (a is None and b in _PURE) or (b is None and a in _PURE):
        return None
    a, b = a or PLAIN, b or PLAIN
    return Dimension(a.length + b.length, a.angle + b.angle)


@lru_cache(maxsize=256)
def divide(a: MaybeDimension, b: MaybeDimension) -> MaybeDimension:
    """Returns the dimension of a quotient; a bare number by a plain one stays bare."""
    if a is None and b in _PURE:
        return None
    a, b = a or PLAIN, b or PLAIN
    return Dimension(a.length - b.length, a.angle - b.angle)


def power(a: MaybeDimension, exponent: float) -> MaybeDimension:
    """Returns the dimension of a power. Raises ValueError if a dimension would get a fractional power."""
    if a is None or a == PLAIN:
        return a
    length, angle = a.length * exponent, a.angle * exponent
    if length != int(length) or angle != int(angle):
        raise ValueError(f"{describe(a)} taken to the power {exponent:g}")
    return Dimension(int(length), int(angle))


# --- Lengths and sizes of paper and sheets as people give them to commands and dialogs.

LARGEST = 1e5
"""Largest side of a sheet, mm."""

_SIZE = re.compile(r"(?P<width>[\d.]+)\s*[x×*]\s*(?P<height>[\d.]+)\s*(?P<unit>[a-z]*)")
_LENGTH = re.compile(r"(?P<number>[\d.]+)\s*(?P<unit>[a-z]*)")


def size(text: str) -> tuple[float, float]:
    """Parses width and height in mm: a paper's name, or as in `600x400`, `60x40cm`. Raises ValueError."""
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
    factor, dimension = UNITS.get(unit or "mm", (math.nan, LENGTH))
    try:
        return float(number) * factor if dimension == LENGTH else math.nan
    except ValueError:
        return math.nan

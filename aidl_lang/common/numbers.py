"""Numbers in texts: the same digits on every run."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

_MOST_DECIMALS = 15


def fixed(value: float, decimals: int = 6) -> str:
    """Returns a number with at most so many decimals, without trailing zeros and without a minus before
    zero.
    """
    text = f"{value:.{decimals}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def shortest(value: float, tolerance: float) -> str:
    """Returns the decimal with the fewest places that is within `tolerance`."""
    for places in range(_MOST_DECIMALS):
        if abs(round(value, places) - value) <= tolerance:
            return fixed(value, places)
    return fixed(value, _MOST_DECIMALS)


def short(value: float, decimals: int = 6) -> str:
    """Returns a number for a sentence: six significant digits, so many decimals at most, never `-0`."""
    return f"{round(value, decimals) + 0.0:.6g}"


def rough(value: float) -> str:
    """Returns a length for a sentence: four significant digits, no exponent for ordinary sizes."""
    return f"{value + 0.0:.4g}"


def literal(value: float | str | bool, digits: int = 6, unit: str = "") -> str:
    """Returns a value as the language writes it; a number with so many significant digits."""
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else f"{value:.{digits}g}{unit}"


def significant(value: float) -> float:
    """Returns a number rounded to 12 significant digits, past which rounding errors begin; -0 becomes 0."""
    if value == 0 or not math.isfinite(value):
        return 0.0 if value == 0 else value
    return float(f"{value:.12g}")


def rounded(value: Any) -> Any:
    """Returns data for JSON with its numbers as `significant` rounds them; infinities and NaN become null."""
    if isinstance(value, float):
        value = significant(value)
        return value if value - value == 0 else None
    if isinstance(value, Mapping):
        return {key: rounded(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [rounded(v) for v in value]
    return value


def size_text(size: Sequence[float]) -> str:
    """Returns width and height in mm for a sentence: `600 × 400 mm`."""
    return f"{fixed(size[0], 3)} × {fixed(size[1], 3)} mm"

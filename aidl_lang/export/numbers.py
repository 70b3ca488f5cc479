"""Numbers in exported texts: the same digits on every run."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

_MOST_DECIMALS = 15


def fixed(value: float, decimals: int = 6) -> str:
    """At most this many decimals, without trailing zeros and without a minus before zero."""
    text = f"{value:.{decimals}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def shortest(value: float, tolerance: float) -> str:
    """The decimal with the fewest places that is this near."""
    for places in range(_MOST_DECIMALS):
        if abs(round(value, places) - value) <= tolerance:
            return fixed(value, places)
    return fixed(value, _MOST_DECIMALS)


def significant(value: float) -> float:
    """Rounded to 12 significant digits, past which rounding errors begin; -0 becomes 0."""
    if value == 0 or not math.isfinite(value):
        return 0.0 if value == 0 else value
    return float(f"{value:.12g}")


def rounded(value: Any) -> Any:
    """Data for JSON with its numbers rounded so; what is not finite becomes null."""
    if isinstance(value, float):
        value = significant(value)
        return value if value - value == 0 else None
    if isinstance(value, Mapping):
        return {key: rounded(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [rounded(v) for v in value]
    return value


def size_text(size: Sequence[float]) -> str:
    """Width and height in mm for a sentence: `600 × 400 mm`."""
    return f"{fixed(size[0], 3)} × {fixed(size[1], 3)} mm"

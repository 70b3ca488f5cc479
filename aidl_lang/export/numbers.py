"""Numbers in exported texts: the same digits on every run."""

from __future__ import annotations

import math


def fixed(value: float, decimals: int = 6) -> str:
    """At most this many decimals, without trailing zeros and without a minus before zero."""
    text = f"{value:.{decimals}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def significant(value: float) -> float:
    """Rounded to 12 significant digits, past which rounding errors begin; -0 becomes 0."""
    if value == 0 or not math.isfinite(value):
        return 0.0 if value == 0 else value
    return float(f"{value:.12g}")

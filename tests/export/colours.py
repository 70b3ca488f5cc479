"""Colours of pixels."""

from __future__ import annotations

from collections.abc import Sequence


def near(color: Sequence[int], other: Sequence[int], by: int = 24) -> bool:
    """Whether no channel differs by more."""
    return all(abs(a - b) <= by for a, b in zip(color, other, strict=True))

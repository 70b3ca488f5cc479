"""Calm colours for bodies without a colour of their own, and the ink for everything else."""

from __future__ import annotations

FILLS = (
    "#a7bcd6",  # slate blue
    "#d9c3a0",  # sand
    "#a9c8a4",  # sage
    "#d3aaa5",  # clay
    "#b9aed0",  # lilac
    "#9cc7c5",  # teal
    "#d8cf98",  # straw
    "#bcc0c6",  # stone
)
OUTLINE = "#2f3b4a"
SEAM = "#2f3b4a"
LOOSE = "#c2410c"
CUT = "#ff0000"
ENGRAVE = "#0000ff"
PLAN = "#64748b"
NAME = "#1e293b"
DIMENSION = "#17375e"
POINT = "#1d4ed8"
BOX = "#94a3b8"
GOOD = "#15803d"
BAD = "#dc2626"
FREE = "#b45309"


def body_fill(index: int) -> str:
    """The colour of the body that is drawn as number `index`."""
    return FILLS[index % len(FILLS)]


def rgb(color: str) -> tuple[int, int, int]:
    """Red, green and blue of a CSS colour, from 0 to 255."""
    from PIL import ImageColor

    red, green, blue = ImageColor.getrgb(color)[:3]
    return red, green, blue

"""Calm colours for bodies without a colour of their own, and the ink for everything else."""

from __future__ import annotations

from aidl_lang.common.colors import hexadecimal, rgb

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
PAPER = "#ffffff"
OUTLINE = "#2f3b4a"
LIGHT = "#b4bfcc"
LOOSE = "#c2410c"
PLAN = "#64748b"
NAME = "#1e293b"
DIMENSION = "#17375e"
POINT = "#1d4ed8"
BOX = "#94a3b8"
GOOD = "#15803d"
BAD = "#dc2626"
FREE = "#b45309"

_SHADE = 0.55
"""What is left of the brightness of a fill in its outline."""
_LIGHTEST_OUTLINE = 128
"""Brightness, of 255, up to which an outline is seen well on white paper."""
_DARK = 112
"""Brightness, of 255, up to which dark letters are hard to read."""
_DARKEST = 60
"""Brightness, of 255, up to which a darker line is hard to see."""
_TINT = 0.5
"""The share of white in lines on what is darker."""


def body_fill(index: int) -> str:
    """Returns the colour of the body drawn as number `index`."""
    return FILLS[index % len(FILLS)]


def outline_of(fill: str) -> str:
    """Returns the colour of the outline of a body that the author gave a fill: a darker tone of it, and as
    much darker again as it takes to be seen on white.
    """
    share = _SHADE
    if (bright := _brightness(rgb(fill))) > 0:
        share = min(share, _LIGHTEST_OUTLINE / bright)
    red, green, blue = (share * part for part in rgb(fill))
    return hexadecimal((red, green, blue))


def etched(fill: str) -> str:
    """Returns an ink for lines on a fill: a darker tone of it, or a lighter one of what is very dark."""
    if _brightness(rgb(fill)) > _DARKEST:
        return outline_of(fill)
    return hexadecimal(part + _TINT * (255 - part) for part in rgb(fill))


def contrasting(fill: str) -> str:
    """Returns an ink for letters that can be read on a fill of this colour, and on white beside it."""
    return OUTLINE if _brightness(rgb(fill)) > _DARK else LIGHT


def _brightness(parts: tuple[int, int, int]) -> float:
    """Returns how bright red, green and blue, from 0 to 255, are together."""
    red, green, blue = parts
    return 0.299 * red + 0.587 * green + 0.114 * blue

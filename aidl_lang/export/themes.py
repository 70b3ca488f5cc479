"""The looks of a picture as a whole, and calm colours for bodies without one of their own."""

from __future__ import annotations

from dataclasses import replace

from aidl_lang.common.colors import hexadecimal, rgb
from aidl_lang.common.records import record
from aidl_lang.export.marks import HALO, Area, Curves, Dot, Frame, Group, Mark, Picture, Text, polygon

# --- Calm colours for bodies without a colour of their own, and the ink for everything else.

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
_READABLE = 64
"""Least difference in brightness, of 255, of letters and what they lie on."""
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
    bright = _brightness(rgb(fill))
    share = min(_SHADE, _LIGHTEST_OUTLINE / bright) if bright > 0 else _SHADE
    return hexadecimal(share * part for part in rgb(fill))


def etched(fill: str) -> str:
    """Returns an ink for lines on a fill: a darker tone of it, or a lighter one of what is very dark."""
    if _brightness(rgb(fill)) > _DARKEST:
        return outline_of(fill)
    return hexadecimal(part + _TINT * (255 - part) for part in rgb(fill))


def contrasting(fill: str, own: str | None) -> str:
    """Returns an ink for letters that can be read on a fill: their own, or one for white beside it, too."""
    bright = _brightness(rgb(fill))
    if own is not None and abs(_brightness(rgb(own)) - bright) > _READABLE:
        return own
    return OUTLINE if bright > _DARK else LIGHT


def _brightness(parts: tuple[int, int, int]) -> float:
    """Returns how bright red, green and blue, from 0 to 255, are together."""
    red, green, blue = parts
    return 0.299 * red + 0.587 * green + 0.114 * blue


# --- The looks of a picture as a whole: as the author coloured it, white on blue, or black on white.

AS_COLOURED, FOR_CUTTER = "colour", "cutter"


@record()
class Theme:
    """The colours that a picture is reduced to: of the paper, of what is filled, and of every line.

    Fills that show through, as light and shade do, are left out: of one colour they would be a veil over the
    lines below.
    """

    paper: str
    fill: str
    line: str


REDUCED = {
    "blueprint": Theme("#1d4b87", "#2a5a99", "#eaf2ff"),
    "ink": Theme("#ffffff", "#ffffff", "#000000"),
}
THEMES = (AS_COLOURED, *REDUCED, FOR_CUTTER)


def themed(picture: Picture, name: str) -> Picture:
    """Returns the picture in a theme; unchanged in those that keep its colours. Raises KeyError."""
    if name in (AS_COLOURED, FOR_CUTTER):
        return picture
    theme = REDUCED[name]
    left, bottom, right, top = picture.box
    sheet = polygon((left, bottom), (right, bottom), (right, top), (left, top))
    paper = Group("paper", (Area(sheet, theme.paper, None, "paper"),))
    groups = [paper]
    for group in picture.groups:
        marks = [_reduced(mark, theme) for mark in group.marks]
        kept = (m for m in marks if not isinstance(m, Area) or m.fill or m.ink)
        groups.append(replace(group, marks=tuple(kept)))
    return replace(picture, groups=tuple(groups))


def _reduced(mark: Mark, theme: Theme) -> Mark:
    match mark:
        case Area() if mark.role == HALO:
            return replace(mark, fill=theme.paper)
        case Area() if mark.is_sign:
            return replace(mark, fill=theme.line)
        case Area(ink=ink):
            line = None if ink is None else replace(ink, color=theme.line)
            fill = theme.fill if mark.fill and mark.opacity == 1.0 and not mark.fades else None
            return replace(mark, fill=fill, ink=line, opacity=1.0, gradient=None)
        case Curves(ink=ink):
            color = theme.paper if mark.role == HALO else theme.line
            return replace(mark, ink=replace(ink, color=color))
        case Text():
            return replace(mark, color=theme.line, halo=False)
        case Dot() | Frame():
            return replace(mark, color=theme.line)

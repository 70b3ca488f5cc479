"""Pictures for few pixels: no line thinner than one, and black lines on white without colours."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from aidl_lang.export.marks import Area, Curves, Dot, Frame, Ink, Mark, Picture, Text

_BLACK, _WHITE = "#000000", "#ffffff"
_SHORTEST_DASH = 2.0
"""Pixels; shorter ones cannot be told from a line."""
_SEEN_THROUGH = 0.5
"""Opacity up to which a fill hides nothing where there is black and white alone."""


def framed(picture: Picture, proportion: float) -> Picture:
    """Returns the picture with white around it, `proportion` times as wide as high."""
    left, bottom, right, top = picture.box
    x = max(0.0, picture.height * proportion - picture.width) / 2
    y = max(0.0, picture.width / proportion - picture.height) / 2
    return replace(picture, box=(left - x, bottom - y, right + x, top + y))


def coarse(picture: Picture, pixel: float) -> Picture:
    """Returns the picture with no line thinner than a `pixel`, mm."""
    return _redrawn(picture, lambda mark: _thickened(mark, pixel))


def resolved(picture: Picture, pixel: float) -> Picture:
    """Returns the picture with dashes that no `pixel`, mm, can show as what they look like: a paler line.
    (Of a million dashes resvg draws none.)
    """
    return _redrawn(picture, lambda mark: _blurred(mark, pixel))


def outlined(picture: Picture) -> Picture:
    """Returns the picture in black and white: outlines hide what is below them, and seams are left out."""
    return _redrawn(picture, _plain)


def separated(picture: Picture) -> tuple[Picture, tuple[Text, ...]]:
    """Returns the picture without its texts, and the texts."""
    texts = tuple(mark for group in picture.groups for mark in group.marks if isinstance(mark, Text))
    return _redrawn(picture, lambda mark: None if isinstance(mark, Text) else mark), texts


def _redrawn(picture: Picture, change: Callable[[Mark], Mark | None]) -> Picture:
    groups = (
        replace(group, marks=tuple(new for mark in group.marks if (new := change(mark)) is not None))
        for group in picture.groups
    )
    return replace(picture, groups=tuple(groups))


def _thickened(mark: Mark, pixel: float) -> Mark:
    match mark:
        case Area(ink=Ink() as ink) | Curves(ink=ink):
            dash = ink.dash if ink.dash and min(ink.dash) > _SHORTEST_DASH * pixel else None
            return replace(mark, ink=replace(ink, width=max(ink.width, pixel), dash=dash))
        case Frame():
            return replace(mark, width=max(mark.width, pixel))
        case Dot():
            return replace(mark, radius=max(mark.radius, pixel))
    return mark


def _blurred(mark: Mark, pixel: float) -> Mark:
    match mark:
        case Area(ink=Ink(dash=tuple() as dash) as ink) | Curves(ink=Ink(dash=tuple() as dash) as ink):
            if sum(dash) > _SHORTEST_DASH * pixel:
                return mark
            drawn = sum(dash[::2]) / sum(dash)
            return replace(mark, ink=replace(ink, dash=None, opacity=drawn * ink.opacity))
    return mark


def _plain(mark: Mark) -> Mark | None:
    match mark:
        case Area(ink=ink):
            if mark.is_sign:
                return replace(mark, fill=_BLACK, opacity=1.0)
            is_hiding = mark.fill is not None and mark.opacity > _SEEN_THROUGH and not mark.fades
            fill = _WHITE if is_hiding else None
            line = None if ink is None else _solid(ink)
            return replace(mark, fill=fill, opacity=1.0, ink=line, gradient=None)
        case Curves(role="seam"):
            return None
        case Curves(role="halo", ink=ink):
            return replace(mark, ink=replace(ink, color=_WHITE))
        case Curves(ink=ink):
            return replace(mark, ink=_solid(ink))
        case Text() | Dot() | Frame():
            return replace(mark, color=_BLACK)


def _solid(ink: Ink) -> Ink:
    return replace(ink, color=_BLACK, opacity=1.0)

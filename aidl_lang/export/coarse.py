"""A picture for few pixels: nothing thinner than one, and where there is no colour, black lines on white."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from aidl_lang.export.marks import Area, Curves, Dot, Frame, Ink, Mark, Picture, Text

_BLACK, _WHITE = "#000000", "#ffffff"
_SHORTEST_DASH = 2.0
"""Pixels; shorter ones cannot be told from a line."""


def framed(picture: Picture, proportion: float) -> Picture:
    """The picture with so much more white around it that its width is `proportion` times its height."""
    left, bottom, right, top = picture.box
    x = max(0.0, picture.height * proportion - picture.width) / 2
    y = max(0.0, picture.width / proportion - picture.height) / 2
    return replace(picture, box=(left - x, bottom - y, right + x, top + y))


def coarse(picture: Picture, pixel: float, *, in_colour: bool = True) -> Picture:
    """The picture with all lines at least a `pixel` (mm) wide."""
    return _with(picture, lambda mark: _thick(mark if in_colour else _plain(mark), pixel))

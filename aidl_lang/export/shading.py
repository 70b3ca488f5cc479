"""Gradients of fills: light and shade on round things, and fills that go over into another colour."""

from __future__ import annotations

import math

import numpy as np

from aidl_lang.common.colors import css_color, hexadecimal, rgb
from aidl_lang.export.marks import Gradient, Stop
from aidl_lang.geometry.evaluate import points
from aidl_lang.geometry.measures import region_bounds
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.styles import Shade

_LIGHT: dict[str, tuple[tuple[float, float], ...]] = {
    "round": ((0.0, -0.22), (0.3, 0.34), (0.6, 0.0), (1.0, -0.42)),
    "ball": ((0.0, 0.5), (0.5, 0.0), (1.0, -0.45)),
    "slope": ((0.0, 0.18), (1.0, -0.26)),
}
"""Shares of the way, and of white in the colour there, or of black where they are negative."""
_FADING = ((0.0, 1.0), (0.3, 0.78), (0.6, 0.3), (0.8, 0.09), (1.0, 0.0))
"""Shares of the way out of the middle, and the opacity there: as soft light and shadows end."""
_SPOT = (0.36, 0.66)
"""Where a ball is brightest: shares of the width and the height of its box."""
_REACH = 0.72
"""How far light reaches from there, in the larger side of the box."""
_STEPS = np.linspace(0.0, 1.0, 9)


def gradient_of(shade: Shade, color: str, region: Region) -> Gradient:
    """Returns the fill of a body of a colour."""
    stops = tuple(Stop(share, _toned(color, tone)) for share, tone in _LIGHT.get(shade.kind, ()))
    left, bottom, right, top = region_bounds(region)
    width, height = right - left, top - bottom
    if shade.way is None:
        center = (left + width / 2, bottom + height / 2)
        fading = tuple(Stop(share, color, opacity) for share, opacity in _FADING)
        return Gradient(center, center, fading, width / 2, height / width)
    if shade.kind == "ball":
        spot = (left + _SPOT[0] * width, bottom + _SPOT[1] * height)
        return Gradient(spot, spot, stops, _REACH * max(width, height))
    ways = np.array([math.cos(math.radians(shade.way)), math.sin(math.radians(shade.way))])
    spots = np.concatenate([points(piece, _STEPS) for piece in region.pieces])
    along = spots @ ways
    middle = np.array([(left + right) / 2, (bottom + top) / 2])
    start, end = (middle + (reach - middle @ ways) * ways for reach in (along.min(), along.max()))
    other = css_color([shade.kind])
    if shade.kind == "fade":
        stops = (Stop(0.0, color), Stop(1.0, color, 0.0))
    elif other is not None:
        stops = (Stop(0.0, color), Stop(1.0, other))
    return Gradient((float(start[0]), float(start[1])), (float(end[0]), float(end[1])), stops)


def _toned(color: str, tone: float) -> str:
    """Returns a colour with a share of white in it, or of black where that is negative."""
    goal = 255.0 if tone > 0 else 0.0
    return hexadecimal(part + abs(tone) * (goal - part) for part in rgb(color))

"""Colours as authors write them: CSS names, `#rgb`, `#rrggbb`, or three numbers."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache

_NAMES = """
black silver gray grey white maroon red purple fuchsia green lime olive yellow navy blue teal aqua orange
aliceblue antiquewhite aquamarine azure beige bisque blanchedalmond blueviolet brown burlywood cadetblue
chartreuse chocolate coral cornflowerblue cornsilk crimson cyan darkblue darkcyan darkgoldenrod darkgray
darkgreen darkgrey darkkhaki darkmagenta darkolivegreen darkorange darkorchid darkred darksalmon darkseagreen
darkslateblue darkslategray darkslategrey darkturquoise darkviolet deeppink deepskyblue dimgray dimgrey
dodgerblue firebrick floralwhite forestgreen gainsboro ghostwhite gold goldenrod greenyellow honeydew hotpink
indianred indigo ivory khaki lavender lavenderblush lawngreen lemonchiffon lightblue lightcoral lightcyan
lightgoldenrodyellow lightgray lightgreen lightgrey lightpink lightsalmon lightseagreen lightskyblue
lightslategray lightslategrey lightsteelblue lightyellow limegreen linen magenta mediumaquamarine mediumblue
mediumorchid mediumpurple mediumseagreen mediumslateblue mediumspringgreen mediumturquoise mediumvioletred
midnightblue mintcream mistyrose moccasin navajowhite oldlace olivedrab orangered orchid palegoldenrod
palegreen paleturquoise palevioletred papayawhip peachpuff peru pink plum powderblue rosybrown royalblue
saddlebrown salmon sandybrown seagreen seashell sienna skyblue slateblue slategray slategrey snow springgreen
steelblue tan thistle tomato turquoise violet wheat whitesmoke yellowgreen rebeccapurple
"""
COLOR_NAMES = frozenset(_NAMES.split())
"""The named colours of CSS Color Module Level 4, section 6.1."""

_HEX = re.compile(r"#(?:[0-9a-f]{3}|[0-9a-f]{6})")


def css_color(values: Sequence[object]) -> str | None:
    """Returns a colour that SVG understands, or None if the values are no colour.

    Three numbers are red, green and blue, from 0 to 255, or from 0 to 1 if none is larger and one is a
    fraction.
    """
    if len(values) == 1 and isinstance(name := values[0], str):
        name = re.sub(r"[\s_-]", "", name.strip().lower())
        return name if name in COLOR_NAMES or _HEX.fullmatch(name) else None
    numbers = [float(v) for v in values if isinstance(v, int | float) and not isinstance(v, bool)]
    if len(numbers) != 3 or len(values) != 3:
        return None
    if max(numbers) <= 1 and any(v != int(v) for v in numbers):
        numbers = [255 * v for v in numbers]
    if not all(0 <= v <= 255 for v in numbers):
        return None
    return "#" + "".join(f"{round(v):02x}" for v in numbers)


def similar_colors(name: str) -> list[str]:
    """Known names that a misspelt one may have meant, the likeliest first."""
    from difflib import get_close_matches

    return get_close_matches(name.strip().lower(), sorted(COLOR_NAMES), n=3)


def rgb(color: str) -> tuple[int, int, int]:
    """Red, green and blue of a CSS colour, from 0 to 255."""
    from PIL import ImageColor

    red, green, blue = ImageColor.getrgb(color)[:3]
    return red, green, blue


_ALIKE = 16
"""How far, of 255, each of red, green and blue may differ in colours that are hard to tell apart."""


@lru_cache(maxsize=256)
def look_alike(one: str, other: str) -> bool:
    """Tells whether thin lines of one colour are not seen on the other."""
    return one == other or all(abs(a - b) <= _ALIKE for a, b in zip(rgb(one), rgb(other), strict=True))

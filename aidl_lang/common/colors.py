"""Colours as authors write them: CSS names, `#rrggbb`, `rgb(…)` and `hsl(…)` of CSS, or three numbers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from functools import lru_cache

_TABLE = """
black 000000 silver c0c0c0 gray 808080 grey 808080 white ffffff maroon 800000 red ff0000 purple 800080
fuchsia ff00ff green 008000 lime 00ff00 olive 808000 yellow ffff00 navy 000080 blue 0000ff teal 008080
aqua 00ffff orange ffa500 aliceblue f0f8ff antiquewhite faebd7 aquamarine 7fffd4 azure f0ffff beige f5f5dc
bisque ffe4c4 blanchedalmond ffebcd blueviolet 8a2be2 brown a52a2a burlywood deb887 cadetblue 5f9ea0
chartreuse 7fff00 chocolate d2691e coral ff7f50 cornflowerblue 6495ed cornsilk fff8dc crimson dc143c
cyan 00ffff darkblue 00008b darkcyan 008b8b darkgoldenrod b8860b darkgray a9a9a9 darkgreen 006400
darkgrey a9a9a9 darkkhaki bdb76b darkmagenta 8b008b darkolivegreen 556b2f darkorange ff8c00 darkorchid 9932cc
darkred 8b0000 darksalmon e9967a darkseagreen 8fbc8f darkslateblue 483d8b darkslategray 2f4f4f
darkslategrey 2f4f4f darkturquoise 00ced1 darkviolet 9400d3 deeppink ff1493 deepskyblue 00bfff dimgray 696969
dimgrey 696969 dodgerblue 1e90ff firebrick b22222 floralwhite fffaf0 forestgreen 228b22 gainsboro dcdcdc
ghostwhite f8f8ff gold ffd700 goldenrod daa520 greenyellow adff2f honeydew f0fff0 hotpink ff69b4
indianred cd5c5c indigo 4b0082 ivory fffff0 khaki f0e68c lavender e6e6fa lavenderblush fff0f5
lawngreen 7cfc00 lemonchiffon fffacd lightblue add8e6 lightcoral f08080 lightcyan e0ffff
lightgoldenrodyellow fafad2 lightgray d3d3d3 lightgreen 90ee90 lightgrey d3d3d3 lightpink ffb6c1
lightsalmon ffa07a lightseagreen 20b2aa lightskyblue 87cefa lightslategray 778899 lightslategrey 778899
lightsteelblue b0c4de lightyellow ffffe0 limegreen 32cd32 linen faf0e6 magenta ff00ff mediumaquamarine 66cdaa
mediumblue 0000cd mediumorchid ba55d3 mediumpurple 9370db mediumseagreen 3cb371 mediumslateblue 7b68ee
mediumspringgreen 00fa9a mediumturquoise 48d1cc mediumvioletred c71585 midnightblue 191970 mintcream f5fffa
mistyrose ffe4e1 moccasin ffe4b5 navajowhite ffdead oldlace fdf5e6 olivedrab 6b8e23 orangered ff4500
orchid da70d6 palegoldenrod eee8aa palegreen 98fb98 paleturquoise afeeee palevioletred db7093
papayawhip ffefd5 peachpuff ffdab9 peru cd853f pink ffc0cb plum dda0dd powderblue b0e0e6 rosybrown bc8f8f
royalblue 4169e1 saddlebrown 8b4513 salmon fa8072 sandybrown f4a460 seagreen 2e8b57 seashell fff5ee
sienna a0522d skyblue 87ceeb slateblue 6a5acd slategray 708090 slategrey 708090 snow fffafa
springgreen 00ff7f steelblue 4682b4 tan d2b48c thistle d8bfd8 tomato ff6347 turquoise 40e0d0 violet ee82ee
wheat f5deb3 whitesmoke f5f5f5 yellowgreen 9acd32 rebeccapurple 663399
"""
_WORDS = _TABLE.split()
COLOR_NAMES = dict(zip(_WORDS[::2], _WORDS[1::2], strict=True))
"""The named colours of CSS Color Module Level 4, section 6.1: red, green and blue in hexadecimal."""

_HEX = re.compile(r"#(?:[0-9a-f]{3}|[0-9a-f]{6})")
_PART = r"(\d+(?:\.\d*)?|\.\d+)"
_RGB = re.compile(rf"rgb\(\s*{_PART}[\s,]+{_PART}[\s,]+{_PART}\s*\)")
_HSL = re.compile(rf"hsl\(\s*{_PART}(?:deg)?[\s,]+{_PART}%[\s,]+{_PART}%\s*\)")


def css_color(values: Sequence[object]) -> str | None:
    """Returns a colour that SVG understands, or None if the values are no colour.

    Three numbers are red, green and blue, from 0 to 255, or from 0 to 1 if none is larger and one is a
    fraction.
    """
    if len(values) == 1 and isinstance(name := values[0], str):
        if "(" in name:
            return _of_function(name.strip().lower())
        name = re.sub(r"[\s_-]", "", name.strip().lower())
        return name if name in COLOR_NAMES or _HEX.fullmatch(name) else None
    numbers = [float(v) for v in values if isinstance(v, int | float) and not isinstance(v, bool)]
    if len(numbers) != 3 or len(values) != 3:
        return None
    if max(numbers) <= 1 and any(v != int(v) for v in numbers):
        numbers = [255 * v for v in numbers]
    if not all(0 <= v <= 255 for v in numbers):
        return None
    return hexadecimal(numbers)


def _of_function(text: str) -> str | None:
    """Returns the colour of CSS's `rgb(200, 30, 30)` or `hsl(210, 60%, 50%)`; None for another text."""
    if found := _RGB.fullmatch(text):
        return css_color([float(part) for part in found.groups()])
    if not (found := _HSL.fullmatch(text)):
        return None
    from colorsys import hls_to_rgb

    hue, saturation, lightness = (float(part) for part in found.groups())
    if max(saturation, lightness) > 100:
        return None
    return hexadecimal(255 * part for part in hls_to_rgb(hue % 360 / 360, lightness / 100, saturation / 100))


def hexadecimal(parts: Iterable[float]) -> str:
    """Returns red, green and blue, from 0 to 255, as `#rrggbb`."""
    return "#" + "".join(f"{round(part):02x}" for part in parts)


def similar_colors(name: str) -> list[str]:
    """Returns known names that a misspelt one may have meant, the likeliest first."""
    from difflib import get_close_matches

    return get_close_matches(name.strip().lower(), sorted(COLOR_NAMES), n=3)


def rgb(color: str) -> tuple[int, int, int]:
    """Returns red, green and blue, from 0 to 255, of a colour as `css_color` gives it."""
    digits = COLOR_NAMES.get(color) or color.removeprefix("#")
    if len(digits) == 3:
        digits = "".join(digit * 2 for digit in digits)
    red, green, blue = bytes.fromhex(digits)
    return red, green, blue


_ALIKE = 16
"""Greatest difference, of 255, of each of red, green and blue in colours that are hard to tell apart."""


@lru_cache(maxsize=256)
def look_alike(one: str, other: str) -> bool:
    """Tells whether thin lines of one colour are not seen on the other."""
    return one == other or all(abs(a - b) <= _ALIKE for a, b in zip(rgb(one), rgb(other), strict=True))

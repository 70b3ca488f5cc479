"""The shapes of SVG as curves, in the coordinates of the element."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

from aidl_lang.common.drawings.strokes import TURN, Bow, Stroke, ellipse
from aidl_lang.common.drawings.svg_values import numbers, path, pixels
from aidl_lang.common.drawings.xml import Node

SHAPES = frozenset({"path", "rect", "circle", "ellipse", "line", "polyline", "polygon"})


def outline(node: Node, page: tuple[float, float]) -> tuple[list[Stroke], bool]:
    """Returns the curves of a shape, and whether all of it could be read; `page` is what percentages are of.
    Raises ValueMistake.
    """
    if node.tag == "path":
        return path(node.attributes.get("d", ""))
    return list(_strokes(node, page)), True


def _strokes(node: Node, page: tuple[float, float]) -> Iterator[Stroke]:
    def length(name: str, axis: int) -> float:
        return pixels(node.attributes.get(name, "0"), page[axis])

    match node.tag:
        case "line":
            yield (length("x1", 0), length("y1", 1)), (length("x2", 0), length("y2", 1))
        case "polyline" | "polygon":
            given = numbers(node.attributes.get("points", ""))
            points = list(zip(given[::2], given[1::2], strict=False))
            if node.tag == "polygon":
                points += points[:1]
            yield from pairwise(points)
        case "circle":
            radius = pixels(node.attributes.get("r", "0"), math.hypot(*page) / math.sqrt(2))
            if radius > 0.0:
                yield ellipse((length("cx", 0), length("cy", 1)), (radius, 0.0), (0.0, radius))
        case "ellipse":
            a, b = _radii(node, page)
            if a > 0.0 and b > 0.0:
                yield ellipse((length("cx", 0), length("cy", 1)), (a, 0.0), (0.0, b))
        case _:
            sides = length("x", 0), length("y", 1), length("width", 0), length("height", 1)
            yield from _rectangle(*sides, *_radii(node, page))


def _radii(node: Node, page: tuple[float, float]) -> tuple[float, float]:
    """Returns `rx` and `ry`, of which one may stand for both. Raises ValueMistake."""
    rx, ry = (node.attributes.get(name, "auto").strip() for name in ("rx", "ry"))
    both = (ry if rx == "auto" else rx), (rx if ry == "auto" else ry)
    a, b = (0.0 if text == "auto" else pixels(text, whole) for text, whole in zip(both, page, strict=True))
    return a, b


_QUARTER = TURN / 4


def _rectangle(x: float, y: float, width: float, height: float, rx: float, ry: float) -> Iterator[Stroke]:
    if width <= 0.0 or height <= 0.0:
        return
    right, bottom = x + width, y + height
    rx, ry = min(rx, width / 2), min(ry, height / 2)
    if rx <= 0.0 or ry <= 0.0:
        corners = [(x, y), (right, y), (right, bottom), (x, bottom), (x, y)]
        yield from pairwise(corners)
        return
    centers = [(right - rx, y + ry), (right - rx, bottom - ry), (x + rx, bottom - ry), (x + rx, y + ry)]
    sides = [
        ((right - rx, y), (right, y + ry)),
        ((right, bottom - ry), (right - rx, bottom)),
        ((x + rx, bottom), (x, bottom - ry)),
        ((x, y + ry), (x + rx, y)),
    ]
    here = sides[-1][1]
    for number, (center, (start, end)) in enumerate(zip(centers, sides, strict=True)):
        if start != here:
            yield here, start
        yield Bow(center, (rx, 0.0), (0.0, ry), (number - 1) * _QUARTER, _QUARTER, start, end)
        here = end

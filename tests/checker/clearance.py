"""The room between convex outlines: the widest strip that parts them, over all directions.

Where they overlap every strip is of negative width, and the widest tells how far they must move to part.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from tests.checker.boxes import around, extremes
from tests.checker.tree import Geo, Transform, Vec
from tests.checker.values import Num, Point, UnavailableError, reference

if TYPE_CHECKING:
    from tests.checker.evaluate import Evaluator

_DIRECTIONS = 180
_CONVEX = ("point", "line", "circle", "slot", "rectangle", "square", "rounded_rectangle", "regular_polygon")
_GOLDEN = (math.sqrt(5) - 1) / 2


def clearance(ev: Evaluator, a: Any, b: Any) -> Num:
    for thing in (a, b):
        if not _is_convex(ev, thing):
            raise UnavailableError("outlines that are not convex are measured on the finished drawing")

    def width(angle: float) -> float:
        return -_reach(ev, a, angle) - _reach(ev, b, angle + math.pi)

    step = math.tau / _DIRECTIONS
    sampled = sorted(((width(i * step), i * step) for i in range(_DIRECTIONS)), reverse=True)
    return reference(max(_peak(width, angle - step, angle + step) for _, angle in sampled[:4]))


def _reach(ev: Evaluator, thing: Any, angle: float) -> float:
    """How far a thing reaches in a direction, from the origin."""
    if isinstance(thing, Point):
        return thing.x.value * math.cos(angle) + thing.y.value * math.sin(angle)
    c, s = math.cos(angle), math.sin(angle)
    return around(extremes(thing, Transform(c, -s, s, c).then(ev.frame))).right


def _peak(function: Any, low: float, high: float) -> float:
    """The greatest value of a function with one peak between two places, by golden section."""
    for _ in range(60):
        p, q = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        if function(p) < function(q):
            low = p
        else:
            high = q
    return float(max(function(low), function(high)))


def _is_convex(ev: Evaluator, thing: Any) -> bool:
    if isinstance(thing, Point):
        return True
    if not isinstance(thing, Geo):
        return False
    if thing.type in _CONVEX:
        return True
    edges = [e for e in thing.parts.values() if e.type != "point"]
    corners = [ev.member(e, "start").xy for e in edges if e.type == "line"]
    turns = {_turn(corners, i) > 0 for i in range(len(corners))}
    return len(corners) == len(edges) >= 3 and len(turns) == 1


def _turn(corners: list[Vec], i: int) -> float:
    (ax, ay), (bx, by), (cx, cy) = (corners[i + k - 2] for k in range(3))
    return (bx - ax) * (cy - by) - (by - ay) * (cx - bx)

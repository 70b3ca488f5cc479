"""Relations of boxes: structures, geometry, and lists of them; and the other words for all relations."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any

from tests.checker.boxes import Box
from tests.checker.tree import Array, Vec
from tests.checker.values import MistakeError

if TYPE_CHECKING:
    from tests.checker.evaluate import Evaluator

Relation = Callable[..., list[float]]

SYNONYMS = {
    "perpendicular": "orthogonal square_to right_angle",
    "coincident": "same_point on point_on",
    "horizontal": "level",
    "vertical": "upright",
    "collinear": "aligned",
    "symmetric": "symmetrical",
    "equal_length": "same_length",
    "equal_radius": "same_radius equal_diameter",
    "equal": "same",
    "above": "over",
    "below": "under beneath underneath",
    "on_top_of": "on_top",
    "left_of": "to_the_left_of to_left_of",
    "right_of": "to_the_right_of to_right_of",
    "inside": "within",
    "centered_in": "center_inside centered",
    "centered_horizontally": "center_horizontally",
    "centered_vertically": "center_vertically",
    "same_width": "equal_width",
    "same_height": "equal_height",
    "same_size": "equal_size",
    "stacked_on": "stacked",
    "no_overlap": "not_overlapping",
}


def _members(ev: Evaluator, things: tuple[Any, ...]) -> list[Any]:
    """`f(a, b, c)` and `f([a, b, c])` alike; a list stands for its members."""
    found: list[Any] = []
    for thing in things:
        found += _members(ev, tuple(ev.items(thing))) if isinstance(thing, Array | list) else [thing]
    return found


def _pair(ev: Evaluator, a: Any, b: Any, residual: Callable[[Box, Box], list[float]]) -> list[float]:
    return ev.together(lambda: residual(ev.box(a), ev.box(b)))


def _number(ev: Evaluator, value: Any) -> float:
    return 0.0 if value is None else ev.number(value).value


def _aligned(p: Box, q: Box, align: str | None, across: dict[str, str]) -> list[float]:
    return [] if align in (None, "free") else _agree(p, q, across[align])


def _beyond(near: str, far: str, sign: int, across: dict[str, str]) -> Relation:
    """a's near side at or beyond b's far side, with a gap; `align` lines them up across."""

    def relation(
        ev: Evaluator, a: Any, b: Any, gap: Any = None, at_least: Any = None, align: str | None = None
    ) -> list[float]:
        def residual(p: Box, q: Box) -> list[float]:
            room = sign * (getattr(p, near) - getattr(q, far))
            away = max(0.0, _number(ev, at_least) - room) if gap is None else abs(room - _number(ev, gap))
            return [away, *_aligned(p, q, align, across)]

        return _pair(ev, a, b, residual)

    return relation


def _beside(ev: Evaluator, a: Any, b: Any, **more: Any) -> list[float]:
    """On either side."""
    return min(STRUCTURAL["left_of"](ev, a, b, **more), STRUCTURAL["right_of"](ev, a, b, **more), key=max)


def _agree(p: Box, q: Box, *sides: str) -> list[float]:
    return [abs(getattr(p, side) - getattr(q, side)) for side in sides]


def _lack(p: Box, q: Box, axis: str) -> float:
    """How much of a stretch in common is wanting: a tenth of the smaller one."""
    low, high = ("left", "right") if axis == "x" else ("bottom", "top")
    sizes = [getattr(b, high) - getattr(b, low) for b in (p, q)]
    common = min(getattr(p, high), getattr(q, high)) - max(getattr(p, low), getattr(q, low))
    return max(0.0, min(sizes) / 10 - common)


def _on_top_of(ev: Evaluator, a: Any, b: Any, align: str | None = None) -> list[float]:
    def residual(p: Box, q: Box) -> list[float]:
        touch = abs(p.bottom - q.top)
        if align is not None:
            return [touch, *_agree(p, q, align if align in ("left", "right") else "center_x")]
        return [touch, _lack(p, q, "x")]

    return _pair(ev, a, b, residual)


def _stacked_on(ev: Evaluator, a: Any, b: Any) -> list[float]:
    return _on_top_of(ev, a, b, align="center")


def _inside(ev: Evaluator, a: Any, b: Any, margin: Any = None) -> list[float]:
    """`margin` is a number, or one across and one up."""
    try:
        mx, my = ev.point(margin).xy
    except MistakeError:
        mx = my = _number(ev, margin)

    def residual(p: Box, q: Box) -> list[float]:
        sides = (q.left + mx - p.left, p.right - q.right + mx, q.bottom + my - p.bottom, p.top - q.top + my)
        return [max(0.0, s) for s in sides]

    return _pair(ev, a, b, residual)


def _contains(ev: Evaluator, b: Any, a: Any, margin: Any = None) -> list[float]:
    return _inside(ev, a, b, margin)


def _centered_in(ev: Evaluator, a: Any, b: Any, by: Any = None) -> list[float]:
    x, y = (0.0, 0.0) if by is None else ev.point(by).xy

    def residual(p: Box, q: Box) -> list[float]:
        return [abs(p.center_x - q.center_x - x), abs(p.center_y - q.center_y - y)]

    return _pair(ev, a, b, residual)


def _centered(side: str) -> Relation:
    def relation(ev: Evaluator, a: Any, b: Any, by: Any = None) -> list[float]:
        return _pair(ev, a, b, lambda p, q: [abs(getattr(p, side) - getattr(q, side) - _number(ev, by))])

    return relation


def _centered_between(ev: Evaluator, a: Any, b: Any, c: Any, axis: str | None = None) -> list[float]:
    """The same room on both sides, along the axis that is said, else along either."""
    p, q, r = (ev.box(x) for x in (b, a, c))
    ways = [_gaps([p, q, r] if p.left <= r.left else [r, q, p], w) for w in ([axis] if axis else ["x", "y"])]
    return [min(abs(before - behind) for before, behind in ways)]


def _align(side: str, inwards: int) -> Relation:
    """All agree with the last; `inset` moves the others inwards, `by` to the right or upwards."""

    def relation(ev: Evaluator, *things: Any, inset: Any = None, by: Any = None) -> list[float]:
        *others, last = _members(ev, things)
        shift = inwards * _number(ev, inset) + _number(ev, by)

        def residual(p: Box, q: Box) -> list[float]:
            return [abs(getattr(p, side) - getattr(q, side) - shift)]

        return [r for t in others for r in _pair(ev, t, last, residual)]

    return relation


def _flush(ev: Evaluator, *things: Any, side: str, by: Any = None) -> list[float]:
    return _align(side, 1)(ev, *things, by=by)


def _same(*sizes: str) -> Relation:
    def relation(ev: Evaluator, *things: Any) -> list[float]:
        *others, last = _members(ev, things)
        return [r for t in others for r in _pair(ev, t, last, lambda p, q: _agree(p, q, *sizes))]

    return relation


def _compared(sign: int, *sizes: str) -> Relation:
    """Larger (sign 1) or smaller than another in some sizes, `by` exactly so much."""

    def relation(ev: Evaluator, a: Any, b: Any, by: Any = None, at_least: Any = None) -> list[float]:
        def residual(p: Box, q: Box) -> list[float]:
            found = []
            for size in sizes:
                more = sign * (getattr(p, size) - getattr(q, size))
                short = max(0.0, _number(ev, at_least) - more)
                found.append(short if by is None else abs(more - _number(ev, by)))
            return found

        return _pair(ev, a, b, residual)

    return relation


def _sequence(before: str, after: str, middle: str, sign: int, across: dict[str, str]) -> Relation:
    """Each after the one before it; `pitch` is the way from centre to centre."""

    def relation(
        ev: Evaluator,
        *things: Any,
        gap: Any = None,
        at_least: Any = None,
        pitch: Any = None,
        align: str | None = None,
    ) -> list[float]:
        def residual(p: Box, q: Box) -> list[float]:
            room = sign * (getattr(q, after) - getattr(p, before))
            if pitch is not None:
                away = abs(sign * (getattr(q, middle) - getattr(p, middle)) - _number(ev, pitch))
            elif gap is not None:
                away = abs(room - _number(ev, gap))
            else:
                away = max(0.0, _number(ev, at_least) - room)
            return [away, *_aligned(p, q, align, across)]

        return [r for a, b in pairwise(_members(ev, things)) for r in _pair(ev, a, b, residual)]

    return relation


def _evenly_spaced(
    ev: Evaluator,
    *things: Any,
    axis: str | None = None,
    gap: Any = None,
    spacing: Any = None,
    pitch: Any = None,
) -> list[float]:
    """Equal gaps in the order written, along the axis that is said, else along either; none is negative."""
    boxes = [ev.box(t) for t in _members(ev, things)]
    room = gap if spacing is None else spacing
    ways = [_evenly(ev, boxes, way, room, pitch) for way in ([axis] if axis else ["x", "y"])]
    return min(ways, key=lambda found: max(found, default=0.0))


def _evenly(ev: Evaluator, boxes: list[Box], axis: str, gap: Any, pitch: Any) -> list[float]:
    if pitch is not None:
        centers = [getattr(b, f"center_{axis}") for b in boxes]
        steps = [q - p for p, q in pairwise(centers)]
        back = -1 if axis == "y" and sum(steps) < 0 else 1
        return [abs(back * step - _number(ev, pitch)) for step in steps]
    if gap is not None:
        return [abs(g - _number(ev, gap)) for g in _gaps(boxes, axis)]
    return _uneven(boxes, axis)


def _gaps(boxes: list[Box], axis: str) -> list[float]:
    """From one to the next: to the right along x, along y upwards or downwards."""
    low, high = ("left", "right") if axis == "x" else ("bottom", "top")
    first, last = (getattr(b, low) + getattr(b, high) for b in (boxes[0], boxes[-1]))
    ordered = boxes if axis == "x" or first <= last else boxes[::-1]
    return [getattr(b, low) - getattr(a, high) for a, b in pairwise(ordered)]


def _uneven(boxes: list[Box], axis: str) -> list[float]:
    gaps = _gaps(boxes, axis)
    return [max(0.0, -g) for g in gaps[:1]] + [abs(g - gaps[0]) for g in gaps[1:]]


# --- Places ----------------------------------------------------------------------------------------


def _on_circle(
    ev: Evaluator,
    *things: Any,
    around: Any = None,
    center: Any = None,
    radius: Any = None,
    diameter: Any = None,
    start: Any = None,
    evenly: bool = True,
) -> list[float]:
    """On one circle at equal steps, one way round or the other."""
    found = _members(ev, things)
    if around is None and center is None:
        *found, around = found
    middle = ev.member(around, "center") if center is None else ev.point(center)
    if around is not None:
        r = ev.member(around, "radius").value
    else:
        r = _number(ev, radius) if diameter is None else _number(ev, diameter) / 2
    ways = [(p[0] - middle.xy[0], p[1] - middle.xy[1]) for p in (ev.box(t).center for t in found)]
    away = [abs(math.hypot(*w) - r) for w in ways]
    first = ways[0]
    if start is not None:
        t = math.radians(_number(ev, start))
        first = r * math.cos(t), r * math.sin(t)
    if not evenly:
        return [*away, math.dist(ways[0], first)]
    turns = [
        [math.dist(w, _turned(first, sense * math.tau * i / len(ways))) for i, w in enumerate(ways)]
        for sense in (1, -1)
    ]
    return away + min(turns, key=max)


def _turned(v: Vec, angle: float) -> Vec:
    c, s = math.cos(angle), math.sin(angle)
    return c * v[0] - s * v[1], s * v[0] + c * v[1]


def _at_corners(ev: Evaluator, *things: Any, of: Any = None, inset: Any = None) -> list[float]:
    """Each of four things in a corner of its own."""
    found = list(things)
    box = ev.box(found.pop() if of is None else of)
    try:
        dx, dy = ev.point(inset).xy
    except MistakeError:
        dx = dy = _number(ev, inset)
    spots = [(x, y) for x in (box.left + dx, box.right - dx) for y in (box.bottom + dy, box.top - dy)]
    centers = [ev.box(t).center for t in _members(ev, tuple(found))]
    return [min(math.dist(c, s) for c in centers) for s in spots]


def _spread(
    ev: Evaluator, *things: Any, inside: Any, axis: str | None = None, margin: Any = None
) -> list[float]:
    """Equal gaps through a box, to its border too if no margin is said; along the axis, else along either."""
    frame, boxes = ev.box(inside), [ev.box(t) for t in _members(ev, things)]
    ways = []
    for way in [axis] if axis else ["x", "y"]:
        low, high = ("left", "right") if way == "x" else ("bottom", "top")
        start = min(getattr(b, low) for b in boxes) - getattr(frame, low)
        end = getattr(frame, high) - max(getattr(b, high) for b in boxes)
        if len(boxes) == 1:
            ways.append([abs(start - end)])
        else:
            room = _gaps(boxes, way)[0] if margin is None else _number(ev, margin)
            ways.append([abs(start - room), abs(end - room), *_uneven(boxes, way)])
    return min(ways, key=max)


def _separations(p: Box, q: Box) -> tuple[float, float]:
    """Across and up: positive when apart, 0 when they touch, negative when they share a part."""
    return max(p.left - q.right, q.left - p.right), max(p.bottom - q.top, q.bottom - p.top)


def _touching(ev: Evaluator, a: Any, b: Any) -> list[float]:
    """At a border, with a stretch of it in common."""

    def residual(p: Box, q: Box) -> list[float]:
        across, up = _separations(p, q)
        return [abs(max(across, up)), _lack(p, q, "y" if across >= up else "x")]

    return _pair(ev, a, b, residual)


def _no_overlap(ev: Evaluator, *things: Any, at_least: Any = None) -> list[float]:
    """Each apart from each."""

    def residual(p: Box, q: Box) -> list[float]:
        return [max(0.0, _number(ev, at_least) - max(_separations(p, q)))]

    return [r for a, b in combinations(_members(ev, things), 2) for r in _pair(ev, a, b, residual)]


def _overlapping(ev: Evaluator, a: Any, b: Any) -> list[float]:
    return _pair(ev, a, b, lambda p, q: [_lack(p, q, "x"), _lack(p, q, "y")])


_LEVEL = {"top": "top", "bottom": "bottom", "center": "center_y"}
_UPRIGHT = {"left": "left", "right": "right", "center": "center_x"}

STRUCTURAL: dict[str, Relation] = {
    "above": _beyond("bottom", "top", 1, _UPRIGHT),
    "below": _beyond("top", "bottom", -1, _UPRIGHT),
    "left_of": _beyond("right", "left", -1, _LEVEL),
    "right_of": _beyond("left", "right", 1, _LEVEL),
    "beside": _beside,
    "on_top_of": _on_top_of,
    "stacked_on": _stacked_on,
    "inside": _inside,
    "contains": _contains,
    "centered_in": _centered_in,
    "centered_horizontally": _centered("center_x"),
    "centered_vertically": _centered("center_y"),
    "centered_between": _centered_between,
    "align_left": _align("left", 1),
    "align_right": _align("right", -1),
    "align_top": _align("top", -1),
    "align_bottom": _align("bottom", 1),
    "align_center_x": _align("center_x", 1),
    "align_center_y": _align("center_y", 1),
    "flush": _flush,
    "same_width": _same("width"),
    "same_height": _same("height"),
    "same_size": _same("width", "height"),
    "wider": _compared(1, "width"),
    "taller": _compared(1, "height"),
    "larger": _compared(1, "width", "height"),
    "narrower": _compared(-1, "width"),
    "shorter": _compared(-1, "height"),
    "smaller": _compared(-1, "width", "height"),
    "row": _sequence("right", "left", "center_x", 1, _LEVEL),
    "column": _sequence("bottom", "top", "center_y", -1, _UPRIGHT),
    "evenly_spaced": _evenly_spaced,
    "touching": _touching,
    "no_overlap": _no_overlap,
    "overlapping": _overlapping,
    "on_circle": _on_circle,
    "at_corners": _at_corners,
    "spread": _spread,
}

"""Relations of boxes: structures, geometry, and lists of them; and the other words for all relations."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from tests.checker.boxes import Box
from tests.checker.tree import Array

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


def _beyond(near: str, far: str, sign: int) -> Relation:
    """a's near side at or beyond b's far side, with a gap."""

    def relation(ev: Evaluator, a: Any, b: Any, gap: Any = None, atleast: Any = None) -> list[float]:
        def residual(p: Box, q: Box) -> list[float]:
            room = sign * (getattr(p, near) - getattr(q, far))
            if gap is not None:
                return [abs(room - ev.number(gap).value)]
            wanted = 0.0 if atleast is None else ev.number(atleast).value
            return [max(0.0, wanted - room)]

        return _pair(ev, a, b, residual)

    return relation


def _agree(p: Box, q: Box, *sides: str) -> list[float]:
    return [abs(getattr(p, side) - getattr(q, side)) for side in sides]


def _on_top_of(ev: Evaluator, a: Any, b: Any, align: str | None = None) -> list[float]:
    def residual(p: Box, q: Box) -> list[float]:
        touch = abs(p.bottom - q.top)
        if align is not None:
            return [touch, *_agree(p, q, align if align in ("left", "right") else "center_x")]
        return [touch, max(0.0, p.center_x - q.right, q.left - p.center_x)]

    return _pair(ev, a, b, residual)


def _stacked_on(ev: Evaluator, a: Any, b: Any) -> list[float]:
    return _on_top_of(ev, a, b, align="center")


def _inside(ev: Evaluator, a: Any, b: Any, margin: Any = None) -> list[float]:
    m = 0.0 if margin is None else ev.number(margin).value

    def residual(p: Box, q: Box) -> list[float]:
        sides = (q.left + m - p.left, p.right - q.right + m, q.bottom + m - p.bottom, p.top - q.top + m)
        return [max(0.0, s) for s in sides]

    return _pair(ev, a, b, residual)


def _contains(ev: Evaluator, b: Any, a: Any, margin: Any = None) -> list[float]:
    return _inside(ev, a, b, margin)


def _centered(*sides: str) -> Relation:
    def relation(ev: Evaluator, a: Any, b: Any) -> list[float]:
        return _pair(ev, a, b, lambda p, q: _agree(p, q, *sides))

    return relation


def _align(side: str, inwards: int) -> Relation:
    """All agree with the last; `inset` moves the others inwards."""

    def relation(ev: Evaluator, *things: Any, inset: Any = None) -> list[float]:
        *others, last = _members(ev, things)
        shift = 0.0 if inset is None else inwards * ev.number(inset).value

        def residual(p: Box, q: Box) -> list[float]:
            return [abs(getattr(p, side) - getattr(q, side) - shift)]

        return [r for t in others for r in _pair(ev, t, last, residual)]

    return relation


def _same(*sizes: str) -> Relation:
    def relation(ev: Evaluator, *things: Any) -> list[float]:
        *others, last = _members(ev, things)
        return [r for t in others for r in _pair(ev, t, last, lambda p, q: _agree(p, q, *sizes))]

    return relation


def _at_least(size: str, sign: int) -> Relation:
    def relation(ev: Evaluator, a: Any, b: Any) -> list[float]:
        return _pair(ev, a, b, lambda p, q: [max(0.0, sign * (getattr(q, size) - getattr(p, size)))])

    return relation


def _sequence(before: str, after: str, sign: int, across: dict[str, str]) -> Relation:
    """Each after the one before it with an exact gap; `align` lines them up across."""

    def relation(ev: Evaluator, *things: Any, gap: Any, align: str | None = None) -> list[float]:
        found = _members(ev, things)

        def residual(p: Box, q: Box) -> list[float]:
            room = sign * (getattr(q, after) - getattr(p, before))
            aligned = [] if align is None else _agree(p, q, across[align])
            return [abs(room - ev.number(gap).value), *aligned]

        return [r for a, b in pairwise(found) for r in _pair(ev, a, b, residual)]

    return relation


def _evenly_spaced(ev: Evaluator, *things: Any, axis: str | None = None) -> list[float]:
    """Equal gaps in the order written, along the axis that is said, else along either."""
    boxes = [ev.box(t) for t in _members(ev, things)]
    if len(boxes) < 3:
        return []
    if axis is None:
        return [min(max(_uneven(boxes, "x")), max(_uneven(boxes, "y")))]
    return _uneven(boxes, axis)


def _uneven(boxes: list[Box], axis: str) -> list[float]:
    low, high = ("left", "right") if axis == "x" else ("bottom", "top")
    first, last = (getattr(b, low) + getattr(b, high) for b in (boxes[0], boxes[-1]))
    ordered = boxes if first <= last else boxes[::-1]
    gaps = [getattr(b, low) - getattr(a, high) for a, b in pairwise(ordered)]
    return [abs(g - gaps[0]) for g in gaps[1:]]


def _separations(p: Box, q: Box) -> tuple[float, float]:
    """Across and up: positive when apart, 0 when they touch, negative when they share a part."""
    return max(p.left - q.right, q.left - p.right), max(p.bottom - q.top, q.bottom - p.top)


def _touching(ev: Evaluator, a: Any, b: Any) -> list[float]:
    return _pair(ev, a, b, lambda p, q: [abs(max(_separations(p, q)))])


def _no_overlap(ev: Evaluator, a: Any, b: Any) -> list[float]:
    return _pair(ev, a, b, lambda p, q: [max(0.0, -max(_separations(p, q)))])


def _overlapping(ev: Evaluator, a: Any, b: Any) -> list[float]:
    return _pair(ev, a, b, lambda p, q: [max(0.0, *_separations(p, q))])


_ROW_ACROSS = {"top": "top", "bottom": "bottom", "center": "center_y", "middle": "center_y"}
_COLUMN_ACROSS = {"left": "left", "right": "right", "center": "center_x", "middle": "center_x"}

STRUCTURAL: dict[str, Relation] = {
    "above": _beyond("bottom", "top", 1),
    "below": _beyond("top", "bottom", -1),
    "left_of": _beyond("right", "left", -1),
    "right_of": _beyond("left", "right", 1),
    "on_top_of": _on_top_of,
    "stacked_on": _stacked_on,
    "inside": _inside,
    "contains": _contains,
    "centered_in": _centered("center_x", "center_y"),
    "centered_horizontally": _centered("center_x"),
    "centered_vertically": _centered("center_y"),
    "align_left": _align("left", 1),
    "align_right": _align("right", -1),
    "align_top": _align("top", -1),
    "align_bottom": _align("bottom", 1),
    "align_center_x": _align("center_x", 1),
    "align_center_y": _align("center_y", 1),
    "same_width": _same("width"),
    "same_height": _same("height"),
    "same_size": _same("width", "height"),
    "wider": _at_least("width", 1),
    "taller": _at_least("height", 1),
    "narrower": _at_least("width", -1),
    "shorter": _at_least("height", -1),
    "row": _sequence("right", "left", 1, _ROW_ACROSS),
    "column": _sequence("bottom", "top", -1, _COLUMN_ACROSS),
    "evenly_spaced": _evenly_spaced,
    "touching": _touching,
    "no_overlap": _no_overlap,
    "overlapping": _overlapping,
}

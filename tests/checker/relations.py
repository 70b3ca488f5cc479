"""What the relations of the language mean, in numbers: each gives the residuals of its comparisons."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import combinations, pairwise
from typing import Any

from tests.checker.measures import (
    corner_angle,
    cross,
    distance,
    edge,
    ends,
    field,
    is_line,
    meshing,
    middle,
    mirrored,
    offset,
    point,
)
from tests.checker.model import Angle, Box, Geo, Node, box, fold, together, turned

Relation = Callable[..., list[float]]


def listed(things: Any) -> list[Any]:
    """`f(a, b, c)` and `f([a, b, c])` alike; a list stands for its members."""
    found: list[Any] = []
    for thing in things.values() if isinstance(things, dict) else things:
        found += listed(thing) if isinstance(thing, dict | list | tuple) else [thing]
    return found


def _apart(a: complex, b: complex) -> list[float]:
    return [abs(a.real - b.real), abs(a.imag - b.imag)]


def turn_apart(a: float, b: float) -> float:
    return abs((a - b + 180) % 360 - 180)


def angle_readings(a: float, value: float) -> float:
    """How far an angle between lines is from the nearest meaning of a value."""
    return min(turn_apart(a, v) for v in (value, -value, 180 - value, value - 180))


def _to_last(relation: Callable[[Any, Any], list[float]]) -> Relation:
    """Each with the last."""

    def found(*things: Any, **more: Any) -> list[float]:
        *others, last = listed(things)
        return [r for t in others for r in relation(t, last, **more)]

    return found


# --- Of points and curves ----------------------------------------------------------------------------


def _is_round(thing: Any) -> bool:
    return isinstance(thing, Geo) and thing.type in ("circle", "arc")


def _lies_on(a: Any, b: Any) -> list[float]:
    if is_line(a) and is_line(b):
        return _collinear(a, b)
    if _is_round(a) and _is_round(b):
        return [*_apart(middle(a), middle(b)), abs(a["radius"] - b["radius"])]
    if isinstance(a, Geo) and a.type != "point":
        a, b = b, a
    if is_line(b):
        return [abs(offset(point(a), b))]
    if _is_round(b):
        return [abs(abs(point(a) - b["center"]) - b["radius"])]
    if isinstance(b, Geo) and b.type == "ellipse":
        way = (point(a) - b["center"]) / turned(b["angle"])
        return [abs(math.hypot(way.real / b["rx"], way.imag / b["ry"]) - 1)]
    return _apart(point(a), point(b))


def _on_segment(p: Any, curve: Any) -> list[float]:
    """On a line between its ends; on an arc where it is swept, both ends included."""
    p, (a, b) = point(p), ends(curve)
    if is_line(curve):
        return [abs(abs(a - p) + abs(p - b) - abs(a - b))]
    beyond = cross(b - a, p - a) * cross(b - a, field(curve, "midpoint") - a)
    beside = abs(cross(b - a, p - a)) / abs(a - b)
    return [abs(abs(p - curve["center"]) - curve["radius"]), beside if beyond < 0 else 0.0]


def _all_agree(part: Callable[[complex], float]) -> Relation:
    """Level or upright: a line, or points and the centres of things."""

    def relation(*things: Any) -> list[float]:
        found = listed(things)
        if any(map(is_line, found)):
            return [abs(part(a) - part(b)) for a, b in map(ends, found)]
        values = [part(middle(t)) for t in found]
        return [abs(v - values[0]) for v in values[1:]]

    return relation


def _ways(lines: Any) -> list[complex]:
    return [b - a for a, b in map(ends, lines)]


def _sine(v: complex, w: complex) -> float:
    """0 for parallel directions; lines without a length have none, so that nothing holds of them."""
    sizes = abs(v) * abs(w)
    return abs(cross(v, w)) / sizes if sizes > 1e-9 else math.inf


def _parallel(*lines: Any) -> list[float]:
    first, *others = _ways(listed(lines))
    return [_sine(first, v) for v in others]


def _perpendicular(a: Any, b: Any) -> list[float]:
    """Lines; curves at the end they share; a line and something round whose centre it goes through."""
    if is_line(a) and is_line(b):
        v, w = _ways([a, b])
        return [_sine(v, 1j * w)]
    joint = _joint(a, b)
    if joint is not None:
        return [_sine(_direction(a, joint), 1j * _direction(b, joint))]
    line, other = (a, b) if is_line(a) else (b, a)
    return [abs(offset(middle(other), line))]


def _collinear(*things: Any) -> list[float]:
    found = listed(things)
    lines = [t for t in found if is_line(t)]
    if lines:
        line = max(lines, key=lambda t: abs(t["end"] - t["start"]))
        rest = [t for t in found if t is not line]
        return [abs(offset(p, line)) for t in rest for p in (ends(t) if is_line(t) else [middle(t)])]
    a, b, *others = map(middle, found)
    return [abs(cross(b - a, p - a)) / abs(b - a) for p in others]


def _tangent(a: Any, b: Any, inside: bool | None = None) -> list[float]:
    joint = _joint(a, b)
    if joint is not None and inside is None:
        return [_sine(_direction(a, joint), _direction(b, joint))]
    if is_line(b):
        a, b = b, a
    if is_line(a):
        return [abs(abs(offset(b["center"], a)) - _half_width(b, a))]
    apart, r, s = abs(b["center"] - a["center"]), b["radius"], a["radius"]
    outer, inner = abs(apart - r - s), abs(apart - abs(r - s))
    return [min(outer, inner) if inside is None else inner if inside else outer]


def _half_width(thing: Geo, line: Geo) -> float:
    """How far something round reaches across the direction of a line."""
    if thing.type != "ellipse":
        return float(thing["radius"])
    across = turned(field(line, "angle") - thing["angle"])
    return math.hypot(thing["rx"] * across.imag, thing["ry"] * across.real)


def _tips(thing: Any) -> list[complex]:
    return list(ends(thing)) if thing.type in ("line", "arc", "bezier") else []


def _joint(a: Any, b: Any) -> complex | None:
    """The end that two curves share."""
    return next((p for p in _tips(a) for q in _tips(b) if abs(p - q) < 1e-7), None)


def _direction(thing: Any, p: complex) -> complex:
    """The direction of a curve at one of its ends."""
    if thing.type == "line":
        return _ways([thing])[0]
    if thing.type == "bezier":
        a, b, c, d = thing["points"]
        return b - a if abs(a - p) <= abs(d - p) else d - c  # type: ignore[no-any-return]
    return 1j * (p - thing["center"])  # type: ignore[no-any-return]


# --- Sizes and symmetry ----------------------------------------------------------------------------


def _same_field(name: str) -> Relation:
    return _to_last(lambda a, b: [abs(field(a, name) - field(b, name))])


def _like(a: Any, b: Any) -> list[float]:
    if isinstance(a, Node):
        return _same("width", "height")(a, b)
    if not isinstance(a, Geo) or a.type == "point":
        return compare(a, "==", b)
    if _is_round(a) and _is_round(b):
        return _same_field("radius")(a, b)
    if is_line(a) or is_line(b):
        return _same_field("length")(a, b)
    sizes = [n for n, v in a.data.items() if isinstance(v, float) and n not in ("angle", "heading")]
    return [r for name in sizes for r in _same_field(name)(a, b)]


def _midpoint(p: Any, a: Any, b: Any = None) -> list[float]:
    if b is not None:
        return _apart(middle(p), (middle(a) + middle(b)) / 2)
    if is_line(p) and not is_line(a):
        p, a = a, p
    return _apart(middle(p), field(a, "midpoint"))


def _symmetric(a: Any, b: Any = None, about: Any = None, axis: Any = None) -> list[float]:
    about = axis if about is None else about
    if b is not None:
        return _images(a, b, about)
    if isinstance(a, list | dict):
        items = listed(a)
        return [r for p, q in zip(items, items[::-1], strict=True) for r in _images(p, q, about)]
    return _images(a, a, about)


_MARKS = {"line": ("start", "end"), "circle": ("center",), "arc": ("start", "midpoint", "end")}


def _images(a: Any, b: Any, about: Any) -> list[float]:
    """Whether two things are images: lines and what is round as they are drawn, of other things the boxes, of
    things of two kinds the centres.
    """
    if isinstance(a, list | dict):
        return [r for p, q in zip(listed(a), listed(b), strict=True) for r in _images(p, q, about)]
    kinds = ["structure" if isinstance(t, Node) else getattr(t, "type", "point") for t in (a, b)]
    curves = (*_MARKS, "point", "ellipse", "bezier", "structure")
    if kinds[0] != kinds[1] and (kinds[0] in curves or kinds[1] in curves):
        return _apart(mirrored(middle(a), about), middle(b))
    if a is b and is_line(a) and is_line(about) and _parallel(a, about)[0] < 1e-6:
        return _collinear(a, about)
    if kinds[0] == "point":
        return _apart(mirrored(point(a), about), point(b))
    if kinds[0] == "bezier":
        marks, others = [mirrored(p, about) for p in a["points"]], b["points"]
    elif kinds[0] in _MARKS:
        marks = [mirrored(field(a, n), about) for n in _MARKS[kinds[0]]]
        others = [field(b, n) for n in _MARKS[kinds[0]]]
    else:
        p, q = box(a), box(b)
        return [*_apart(mirrored(p.center, about), q.center), *_agree(p, q, "width", "height")]
    ways = [[abs(p - q) for p, q in zip(marks, order, strict=True)] for order in (others, others[::-1])]
    return min(ways, key=max) + ([abs(a["radius"] - b["radius"])] if kinds[0] == "circle" else [])


# --- Values ------------------------------------------------------------------------------------------


def compare(a: Any, operator: str, b: Any) -> list[float]:
    """Two values by one of `== <= >= < >`."""
    if isinstance(a, str | bool) or isinstance(b, str | bool):
        return [0.0 if (a == b) == (operator == "==") else math.inf]
    if is_line(a) and is_line(b):
        a, b = edge(a), edge(b)
    p, q = plain(a), plain(b)
    if isinstance(p, complex) and isinstance(q, complex) and operator == "==":
        return _apart(p, q)
    if isinstance(p, complex) or isinstance(q, complex):
        raise TypeError(f"a point {operator} a number")
    if operator == "==":
        return [turn_apart(p, q) if isinstance(p, Angle) or isinstance(q, Angle) else abs(p - q)]
    return [max(0.0, p - q if "<" in operator else q - p)]


def plain(value: Any) -> Any:
    """What arithmetic works on: a number or a point."""
    if is_line(value):
        return edge(value)
    return point(value) if isinstance(value, Geo | list) else value


def number(value: Any) -> float:
    return 0.0 if value is None else float(plain(value))


def _bounded(now: float, value: Any = None, at_least: Any = None, at_most: Any = None) -> list[float]:
    found = [] if value is None else [abs(now - number(value))]
    found += [] if at_least is None else [max(0.0, number(at_least) - now)]
    return found + ([] if at_most is None else [max(0.0, now - number(at_most))])


def _measured(measure: Callable[[Any, Any], float]) -> Relation:
    """A measure that has a value, or bounds."""

    def relation(a: Any, b: Any, value: Any = None, at_least: Any = None, at_most: Any = None) -> list[float]:
        return _bounded(measure(a, b), value, at_least, at_most)

    return relation


def _field_is(name: str) -> Relation:
    return lambda thing, value: [abs(field(thing, name) - number(value))]


def _angle(a: Any, b: Any, c: Any = None, value: Any = None, ccw: bool | None = None) -> list[float]:
    """Of two lines, of one to the x axis, or at the middle of three points."""
    if not is_line(a):
        return [abs(abs(corner_angle(a, b, c)) - number(value))]
    if not is_line(b):
        return [min(turn_apart(field(a, "angle"), number(b) + half) for half in (0, 180))]
    wanted = number(c if value is None else value)
    between = field(b, "angle") - field(a, "angle")
    if ccw is None:
        return [angle_readings(between, wanted)]
    return [turn_apart(between, wanted if ccw else -wanted)]


# --- Of boxes ----------------------------------------------------------------------------------------


def _pair(a: Any, b: Any, residual: Callable[[Box, Box], list[float]]) -> list[float]:
    return together(lambda: residual(box(a), box(b)))


def _agree(p: Box, q: Box, *sides: str) -> list[float]:
    return [abs(getattr(p, side) - getattr(q, side)) for side in sides]


_LEVEL = {"top": "top", "bottom": "bottom", "center": "center_y"}
_UPRIGHT = {"left": "left", "right": "right", "center": "center_x"}


def _aligned(p: Box, q: Box, align: str | None, across: dict[str, str]) -> list[float]:
    return [] if align in (None, "free") else _agree(p, q, across[align])


def _beyond(near: str, far: str, sign: int, across: dict[str, str]) -> Relation:
    """a's near side at or beyond b's far side, with a gap; `align` lines them up across."""

    def relation(
        a: Any, b: Any, gap: Any = None, at_least: Any = None, align: str | None = None
    ) -> list[float]:
        def residual(p: Box, q: Box) -> list[float]:
            room = sign * (getattr(p, near) - getattr(q, far))
            away = _bounded(room, gap) or [max(0.0, number(at_least) - room)]
            return away + _aligned(p, q, align, across)

        return _pair(a, b, residual)

    return relation


def _beside(a: Any, b: Any, gap: Any = None, at_least: Any = None, align: str | None = None) -> list[float]:
    return min((RELATIONS[n](a, b, gap, at_least, align) for n in ("leftof", "rightof")), key=max)


_SIDES = {"x": ("left", "right"), "y": ("bottom", "top")}


def _lack(p: Box, q: Box, axis: str) -> float:
    """How much of a stretch in common is wanting: a tenth of the smaller one."""
    low, high = _SIDES[axis]
    sizes = [getattr(b, high) - getattr(b, low) for b in (p, q)]
    common = min(getattr(p, high), getattr(q, high)) - max(getattr(p, low), getattr(q, low))
    return max(0.0, min(sizes) / 10 - common)


def _on_top_of(a: Any, b: Any, align: str | None = None) -> list[float]:
    def residual(p: Box, q: Box) -> list[float]:
        across = [_lack(p, q, "x")] if align is None else _agree(p, q, _UPRIGHT.get(align, "center_x"))
        return [abs(p.bottom - q.top), *across]

    return _pair(a, b, residual)


def _both(value: Any) -> complex:
    """A number, or one across and one up."""
    found = 0.0 if value is None else plain(value)
    return found if isinstance(found, complex) else complex(found, found)


def _inside(a: Any, b: Any, margin: Any = None) -> list[float]:
    m = _both(margin)

    def residual(p: Box, q: Box) -> list[float]:
        across = q.left + m.real - p.left, p.right - q.right + m.real
        return [max(0.0, s) for s in (*across, q.bottom + m.imag - p.bottom, p.top - q.top + m.imag)]

    return _pair(a, b, residual)


def _centered_in(a: Any, b: Any, by: Any = None) -> list[float]:
    return _pair(a, b, lambda p, q: _apart(p.center, q.center + (0j if by is None else point(by))))


def _centered(side: str) -> Relation:
    return lambda a, b, by=None: _pair(
        a, b, lambda p, q: [abs(getattr(p, side) - getattr(q, side) - number(by))]
    )


def _centered_between(a: Any, b: Any, c: Any, axis: str | None = None) -> list[float]:
    """The same room on both sides, along the axis that is said, else along either."""
    p, q, r = (box(x) for x in (b, a, c))
    ways = [_gaps([p, q, r] if p.left <= r.left else [r, q, p], w) for w in ([axis] if axis else ["x", "y"])]
    return [min(abs(before - behind) for before, behind in ways)]


def _align(side: str, inwards: int) -> Relation:
    """All agree with the last; `inset` moves the others inwards, `by` to the right or upwards."""

    def relation(*things: Any, inset: Any = None, by: Any = None) -> list[float]:
        *others, last = listed(things)
        shift = inwards * number(inset) + number(by)
        return [
            r
            for t in others
            for r in _pair(t, last, lambda p, q: [abs(getattr(p, side) - getattr(q, side) - shift)])
        ]

    return relation


def _same(*sizes: str) -> Relation:
    return _to_last(lambda a, b: _pair(a, b, lambda p, q: _agree(p, q, *sizes)))


def _compared(sign: int, *sizes: str) -> Relation:
    """Larger (sign 1) or smaller than another in some sizes, `by` exactly so much."""

    def relation(a: Any, b: Any, by: Any = None, at_least: Any = None) -> list[float]:
        def residual(p: Box, q: Box) -> list[float]:
            more = [sign * (getattr(p, size) - getattr(q, size)) for size in sizes]
            return [max(0.0, number(at_least) - m) if by is None else abs(m - number(by)) for m in more]

        return _pair(a, b, residual)

    return relation


def _sequence(before: str, after: str, middle: str, sign: int, across: dict[str, str]) -> Relation:
    """Each after the one before it; `pitch` is the way from centre to centre."""

    def relation(
        *things: Any, gap: Any = None, at_least: Any = None, pitch: Any = None, align: str | None = None
    ) -> list[float]:
        def residual(p: Box, q: Box) -> list[float]:
            room = sign * (getattr(q, after) - getattr(p, before))
            if pitch is not None:
                away = [abs(sign * (getattr(q, middle) - getattr(p, middle)) - number(pitch))]
            else:
                away = _bounded(room, gap) or [max(0.0, number(at_least) - room)]
            return away + _aligned(p, q, align, across)

        return [r for a, b in pairwise(listed(things)) for r in _pair(a, b, residual)]

    return relation


def _gaps(boxes: list[Box], axis: str) -> list[float]:
    """From one to the next: to the right along x, along y upwards or downwards."""
    low, high = _SIDES[axis]
    first, last = (getattr(b, low) + getattr(b, high) for b in (boxes[0], boxes[-1]))
    ordered = boxes if axis == "x" or first <= last else boxes[::-1]
    return [getattr(b, low) - getattr(a, high) for a, b in pairwise(ordered)]


def _uneven(boxes: list[Box], axis: str) -> list[float]:
    gaps = _gaps(boxes, axis)
    return [max(0.0, -g) for g in gaps[:1]] + [abs(g - gaps[0]) for g in gaps[1:]]


def _evenly_spaced(
    *things: Any, axis: str | None = None, gap: Any = None, spacing: Any = None, pitch: Any = None
) -> list[float]:
    """Equal gaps in the order written, along the axis that is said, else along either; none is negative."""
    boxes, room = [box(t) for t in listed(things)], gap if spacing is None else spacing

    def evenly(way: str) -> list[float]:
        if pitch is not None:
            steps = [q - p for p, q in pairwise(getattr(b, f"center_{way}") for b in boxes)]
            back = -1 if way == "y" and sum(steps) < 0 else 1
            return [abs(back * step - number(pitch)) for step in steps]
        return _uneven(boxes, way) if room is None else [abs(g - number(room)) for g in _gaps(boxes, way)]

    return min(map(evenly, [axis] if axis else ["x", "y"]), key=lambda found: max(found, default=0.0))


def _spread(*things: Any, inside: Any, axis: str | None = None, margin: Any = None) -> list[float]:
    """Equal gaps through a box, to its border too if no margin is said; along the axis, else along either."""
    frame, boxes = box(inside), [box(t) for t in listed(things)]

    def spread(way: str) -> list[float]:
        low, high = _SIDES[way]
        start = min(getattr(b, low) for b in boxes) - getattr(frame, low)
        end = getattr(frame, high) - max(getattr(b, high) for b in boxes)
        if len(boxes) == 1:
            return [abs(start - end)]
        room = _gaps(boxes, way)[0] if margin is None else number(margin)
        return [abs(start - room), abs(end - room), *_uneven(boxes, way)]

    return min(map(spread, [axis] if axis else ["x", "y"]), key=max)


def _on_circle(
    *things: Any,
    around: Any = None,
    center: Any = None,
    radius: Any = None,
    diameter: Any = None,
    start: Any = None,
    evenly: bool = True,
) -> list[float]:
    """On one circle at equal steps, one way round or the other."""
    found = listed(things)
    if around is None and center is None:
        *found, around = found
    at = field(around, "center") if center is None else point(center)
    r = number(radius) if diameter is None else number(diameter) / 2
    r = r if around is None else field(around, "radius")
    ways = [box(t).center - at for t in found]
    away = [abs(abs(w) - r) for w in ways]
    first = ways[0] if start is None else turned(number(start), r)
    if not evenly:
        return [*away, abs(ways[0] - first)]
    steps = [
        [abs(w - first * turned(sense * 360 * i / len(ways))) for i, w in enumerate(ways)]
        for sense in (1, -1)
    ]
    return away + min(steps, key=max)


def _at_corners(*things: Any, of: Any = None, inset: Any = None) -> list[float]:
    """Each of four things in a corner of its own."""
    found = list(things)
    b, d = box(found.pop() if of is None else of), _both(inset)
    spots = [
        complex(x, y)
        for x in (b.left + d.real, b.right - d.real)
        for y in (b.bottom + d.imag, b.top - d.imag)
    ]
    return [min(abs(box(t).center - s) for t in listed(found)) for s in spots]


def _separations(p: Box, q: Box) -> tuple[float, float]:
    """Across and up: positive when apart, 0 when they touch, negative when they share a part."""
    return max(p.left - q.right, q.left - p.right), max(p.bottom - q.top, q.bottom - p.top)


def _touching(a: Any, b: Any) -> list[float]:
    """At a border, with a stretch of it in common."""

    def residual(p: Box, q: Box) -> list[float]:
        across, up = _separations(p, q)
        return [abs(max(across, up)), _lack(p, q, "y" if across >= up else "x")]

    return _pair(a, b, residual)


def _no_overlap(*things: Any, at_least: Any = None) -> list[float]:
    """Each apart from each."""
    return [
        r
        for a, b in combinations(listed(things), 2)
        for r in _pair(a, b, lambda p, q: [max(0.0, number(at_least) - max(_separations(p, q)))])
    ]


_MEANINGS: dict[str, Relation] = {
    "coincident same_point on point_on": _to_last(_lies_on),
    "horizontal level": _all_agree(lambda z: z.imag),
    "vertical upright": _all_agree(lambda z: z.real),
    "parallel": _parallel,
    "perpendicular orthogonal square_to right_angle": _perpendicular,
    "collinear aligned": _collinear,
    "concentric": _to_last(lambda a, b: _apart(middle(a), middle(b))),
    "on_segment": _on_segment,
    "mirror_of symmetric symmetrical": _symmetric,
    "meshes mesh": meshing,
    "tangent": _to_last(_tangent),
    "equal same": _to_last(_like),
    "equal_length same_length": _same_field("length"),
    "equal_radius same_radius equal_diameter": _same_field("radius"),
    "midpoint": _midpoint,
    "distance": _measured(distance),
    "horizontal_distance": _measured(lambda a, b: abs((middle(b) - middle(a)).real)),
    "vertical_distance": _measured(lambda a, b: abs((middle(b) - middle(a)).imag)),
    "length": _field_is("length"),
    "radius": _field_is("radius"),
    "diameter": lambda thing, value: [abs(2 * field(thing, "radius") - number(value))],
    "angle": _angle,
    "above over": _beyond("bottom", "top", 1, _UPRIGHT),
    "below under beneath underneath": _beyond("top", "bottom", -1, _UPRIGHT),
    "left_of to_the_left_of to_left_of": _beyond("right", "left", -1, _LEVEL),
    "right_of to_the_right_of to_right_of": _beyond("left", "right", 1, _LEVEL),
    "beside": _beside,
    "on_top_of on_top": _on_top_of,
    "stacked_on stacked": lambda a, b: _on_top_of(a, b, "center"),
    "inside within": _inside,
    "contains": lambda b, a, margin=None: _inside(a, b, margin),
    "centered_in center_inside centered": _centered_in,
    "centered_horizontally center_horizontally": _centered("center_x"),
    "centered_vertically center_vertically": _centered("center_y"),
    "centered_between": _centered_between,
    "align_left": _align("left", 1),
    "align_right": _align("right", -1),
    "align_top": _align("top", -1),
    "align_bottom": _align("bottom", 1),
    "align_center_x": _align("center_x", 1),
    "align_center_y": _align("center_y", 1),
    "flush": lambda *things, side, by=None: _align(side, 1)(*things, by=by),
    "same_width equal_width": _same("width"),
    "same_height equal_height": _same("height"),
    "same_size equal_size": _same("width", "height"),
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
    "no_overlap not_overlapping": _no_overlap,
    "overlapping": lambda a, b: _pair(a, b, lambda p, q: [_lack(p, q, "x"), _lack(p, q, "y")]),
    "on_circle": _on_circle,
    "at_corners": _at_corners,
    "spread": _spread,
    "dimension": lambda *things, **more: [],  # it is drawn, and nothing has to hold for it
}
RELATIONS = {fold(word): meaning for words, meaning in _MEANINGS.items() for word in words.split()}

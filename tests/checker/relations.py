"""What the relations of the language mean, in numbers: each gives the residuals of its comparisons."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from tests.checker.functions import (
    between,
    cross,
    distance,
    dot,
    ends,
    is_line,
    middle,
    minus,
    offset,
)
from tests.checker.structural import STRUCTURAL, SYNONYMS
from tests.checker.tree import Array, Geo, Node, Vec
from tests.checker.values import Num, fold

if TYPE_CHECKING:
    from tests.checker.evaluate import Evaluator

Relation = Callable[..., list[float]]


def listed(ev: Evaluator, things: tuple[Any, ...]) -> list[Any]:
    """`f(a, b, c)` and `f([a, b, c])` alike; a list stands for its members."""
    found: list[Any] = []
    for thing in things:
        found += listed(ev, tuple(ev.items(thing))) if isinstance(thing, Array | list) else [thing]
    return found


def _is_round(thing: Any) -> bool:
    return isinstance(thing, Geo) and thing.type in ("circle", "arc")


def _apart(a: Vec, b: Vec) -> list[float]:
    return [abs(a[0] - b[0]), abs(a[1] - b[1])]


def _coincident(ev: Evaluator, *things: Any) -> list[float]:
    things = tuple(listed(ev, things))
    if len(things) == 2:
        for a, b in (things, things[::-1]):
            if is_line(b):
                return [abs(offset(ev, ev.point(a).xy, b))]
            if _is_round(b):
                center = ev.member(b, "center").xy
                return [abs(math.dist(ev.point(a).xy, center) - b.data["radius"])]
    points = [ev.point(t).xy for t in things]
    return [r for p in points[1:] for r in _apart(p, points[0])]


def _all_agree(axis: int) -> Relation:
    """Level (axis 1) or upright (axis 0): a line, or points."""

    def relation(ev: Evaluator, *things: Any) -> list[float]:
        found = listed(ev, things)
        if any(map(is_line, found)):
            points = [p for line in found for p in ends(ev, line)]
            return [abs(points[i][axis] - points[i + 1][axis]) for i in range(0, len(points), 2)]
        values = [ev.point(t).xy[axis] for t in found]
        return [abs(v - values[0]) for v in values[1:]]

    return relation


def _ways(ev: Evaluator, *lines: Any) -> list[Vec]:
    return [minus(b, a) for a, b in (ends(ev, line) for line in lines)]


def _parallel(ev: Evaluator, *lines: Any) -> list[float]:
    first, *others = _ways(ev, *listed(ev, lines))
    return [abs(cross(first, v)) / (math.hypot(*first) * math.hypot(*v)) for v in others]


def _perpendicular(ev: Evaluator, a: Any, b: Any) -> list[float]:
    v, w = _ways(ev, a, b)
    return [abs(dot(v, w)) / (math.hypot(*v) * math.hypot(*w))]


def _collinear(ev: Evaluator, *things: Any) -> list[float]:
    things = tuple(listed(ev, things))
    line = next((t for t in things if is_line(t)), None)
    if line is not None:
        points = [
            p for t in things if t is not line for p in (ends(ev, t) if is_line(t) else [ev.point(t).xy])
        ]
        return [abs(offset(ev, p, line)) for p in points]
    a, b, *others = (ev.point(t).xy for t in things)
    return [abs(cross(minus(b, a), minus(p, a))) / math.dist(a, b) for p in others]


def _concentric(ev: Evaluator, *things: Any) -> list[float]:
    centers = [ev.member(t, "center").xy for t in listed(ev, things)]
    return [r for c in centers[1:] for r in _apart(c, centers[0])]


# --- Tangency --------------------------------------------------------------------------------------


def _tangent(ev: Evaluator, a: Any, b: Any, inside: bool | None = None) -> list[float]:
    joint = _joint(ev, a, b)
    if joint is not None:
        v, w = (_direction_at(ev, t, joint) for t in (a, b))
        return [abs(cross(v, w)) / (math.hypot(*v) * math.hypot(*w))]
    if is_line(b):
        a, b = b, a
    center, radius = ev.member(b, "center").xy, b.data["radius"]
    if is_line(a):
        return [abs(abs(offset(ev, center, a)) - radius)]
    apart, other = math.dist(center, ev.member(a, "center").xy), a.data["radius"]
    outer, inner = abs(apart - radius - other), abs(apart - abs(radius - other))
    return [min(outer, inner) if inside is None else inner if inside else outer]


def _joint(ev: Evaluator, a: Any, b: Any) -> Vec | None:
    """The end that two curves share."""
    for p in _tips(ev, a):
        for q in _tips(ev, b):
            if math.dist(p, q) < 1e-7:
                return p
    return None


def _tips(ev: Evaluator, thing: Any) -> list[Vec]:
    if thing.type in ("circle", "ellipse"):
        return []
    return [ev.member(thing, "start").xy, ev.member(thing, "end").xy]


def _direction_at(ev: Evaluator, thing: Any, p: Vec) -> Vec:
    """The direction of a curve at one of its ends."""
    if thing.type == "line":
        return _ways(ev, thing)[0]
    if thing.type == "bezier":
        controls = [ev.member(thing, f"p{i}").xy for i in range(4)]
        at_start = math.dist(controls[0], p) <= math.dist(controls[3], p)
        return minus(controls[1], controls[0]) if at_start else minus(controls[3], controls[2])
    x, y = minus(p, ev.member(thing, "center").xy)
    return -y, x


# --- Sizes and symmetry ----------------------------------------------------------------------------


def _same_field(name: str) -> Relation:
    def relation(ev: Evaluator, *things: Any) -> list[float]:
        values = [ev.member(t, name).value for t in listed(ev, things)]
        return [abs(v - values[0]) for v in values[1:]]

    return relation


def _equal(ev: Evaluator, *things: Any) -> list[float]:
    from tests.checker.conditions import compare

    found = listed(ev, things)
    first = found[0]
    if all(map(is_line, found)):
        return _same_field("length")(ev, *found)
    if all(map(_is_round, found)):
        return _same_field("radius")(ev, *found)
    if isinstance(first, Geo) and first.type == "rectangle":
        return _same_field("width")(ev, *found) + _same_field("height")(ev, *found)
    return [r for t in found[1:] for r in compare(ev, first, "==", t)]


def _midpoint(ev: Evaluator, p: Any, a: Any, b: Any = None) -> list[float]:
    (ax, ay), (bx, by) = ends(ev, a) if b is None else (ev.point(a).xy, ev.point(b).xy)
    return _apart(ev.point(p).xy, ((ax + bx) / 2, (ay + by) / 2))


def _mirrored(ev: Evaluator, p: Vec, about: Any) -> Vec:
    """The image of a point in a line or a point."""
    if not is_line(about):
        x, y = ev.point(about).xy
        return 2 * x - p[0], 2 * y - p[1]
    a, b = ends(ev, about)
    way = minus(b, a)
    t = dot(minus(p, a), way) / dot(way, way)
    foot = (a[0] + t * way[0], a[1] + t * way[1])
    return 2 * foot[0] - p[0], 2 * foot[1] - p[1]


def _axis(ev: Evaluator, axis: Any) -> Geo:
    """`x`, `y`, or the upright line at a coordinate."""
    x = 0.0 if isinstance(axis, str) else ev.number(axis).value
    tip = (1.0, 0.0) if axis == "x" else (x, 1.0)
    ends = {"start": ev.frame.outward((x, 0.0)), "end": ev.frame.outward(tip)}
    return Geo("axis", "axis", "line", ends, {}, construction=True)


def _symmetric(ev: Evaluator, a: Any, b: Any, about: Any = None, axis: Any = None) -> list[float]:
    if axis is not None:
        about = _axis(ev, axis)
    if is_line(a):
        pairs = list(zip(ends(ev, a), ends(ev, b), strict=True))
        straight = [r for p, q in pairs for r in _apart(_mirrored(ev, p, about), q)]
        (p, q), (r, s) = ends(ev, a), ends(ev, b)
        swapped = _apart(_mirrored(ev, p, about), s) + _apart(_mirrored(ev, q, about), r)
        return min(straight, swapped, key=max)
    if _is_round(a):
        centers = [ev.member(t, "center").xy for t in (a, b)]
        radii = abs(a.data["radius"] - b.data["radius"])
        return [*_apart(_mirrored(ev, centers[0], about), centers[1]), radii]
    if isinstance(a, Node):
        box, other = ev.box(a), ev.box(b)
        sizes = [abs(box.width - other.width), abs(box.height - other.height)]
        return _apart(_mirrored(ev, box.center, about), other.center) + sizes
    return _apart(_mirrored(ev, ev.point(a).xy, about), ev.point(b).xy)


# --- Measures set to a value -----------------------------------------------------------------------


def _distance(ev: Evaluator, a: Any, b: Any, value: Any) -> list[float]:
    return [abs(distance(ev, a, b) - ev.number(value).value)]


def _along(axis: int) -> Relation:
    def relation(ev: Evaluator, a: Any, b: Any, value: Any) -> list[float]:
        return [abs(abs(middle(ev, b)[axis] - middle(ev, a)[axis]) - ev.number(value).value)]

    return relation


def _field_is(name: str) -> Relation:
    def relation(ev: Evaluator, thing: Any, value: Any) -> list[float]:
        return [abs(ev.member(thing, name).value - ev.number(value).value)]

    return relation


def _angle(ev: Evaluator, a: Any, b: Any, value: Num, ccw: bool | None = None) -> list[float]:
    from tests.checker.conditions import angle_readings, turn_apart

    if ccw is None:
        return [angle_readings(between(ev, a, b), value.value)]
    return [turn_apart(between(ev, a, b), value.value if ccw else -value.value)]


def _fixed(ev: Evaluator, *things: Any) -> list[float]:
    from tests.checker.definitions import held

    return [r for thing in listed(ev, things) for r in held(ev.here, thing)]


_GEOMETRIC: dict[str, Relation] = {
    "coincident": _coincident,
    "horizontal": _all_agree(1),
    "vertical": _all_agree(0),
    "parallel": _parallel,
    "perpendicular": _perpendicular,
    "collinear": _collinear,
    "concentric": _concentric,
    "tangent": _tangent,
    "equal": _equal,
    "equal_length": _same_field("length"),
    "equal_radius": _same_field("radius"),
    "midpoint": _midpoint,
    "symmetric": _symmetric,
    "distance": _distance,
    "horizontal_distance": _along(0),
    "vertical_distance": _along(1),
    "length": _field_is("length"),
    "radius": _field_is("radius"),
    "diameter": _field_is("diameter"),
    "angle": _angle,
    "fixed": _fixed,
}

_CANONICAL: dict[str, Relation] = {**_GEOMETRIC, **STRUCTURAL}

RELATIONS: dict[str, Relation] = {
    **{fold(name): relation for name, relation in _CANONICAL.items()},
    **{fold(word): _CANONICAL[name] for name, words in SYNONYMS.items() for word in words.split()},
}

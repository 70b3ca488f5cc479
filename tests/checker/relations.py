"""What the relations of the language mean, in numbers: each gives the residuals of its comparisons."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from tests.checker.copies import Copy, away
from tests.checker.functions import (
    between,
    corner_angle,
    cross,
    distance,
    ends,
    is_line,
    middle,
    minus,
    mirrored,
    offset,
)
from tests.checker.gears import meshes
from tests.checker.structural import STRUCTURAL, SYNONYMS
from tests.checker.tree import Array, Geo, Node, Vec
from tests.checker.values import fold

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
    *others, last = listed(ev, things)
    return [r for t in others for r in _lies_on(ev, t, last)]


def _lies_on(ev: Evaluator, a: Any, b: Any) -> list[float]:
    if is_line(a) and is_line(b):
        return _collinear(ev, a, b)
    if _is_round(a) and _is_round(b):
        return [*_concentric(ev, a, b), abs(a.data["radius"] - b.data["radius"])]
    if isinstance(a, Geo) and a.type != "point":
        a, b = b, a
    if is_line(b):
        return [abs(offset(ev, ev.point(a).xy, b))]
    if _is_round(b):
        return [abs(math.dist(ev.point(a).xy, ev.member(b, "center").xy) - b.data["radius"])]
    if isinstance(b, Geo) and b.type == "ellipse":
        return [_off_ellipse(ev, ev.point(a).xy, b)]
    return _apart(ev.point(a).xy, ev.point(b).xy)


def _off_ellipse(ev: Evaluator, p: Vec, ellipse: Geo) -> float:
    """1 is as far as the ellipse is from its centre."""
    x, y = minus(p, ev.member(ellipse, "center").xy)
    t = math.radians(ev.member(ellipse, "angle").value)
    u, v = x * math.cos(t) + y * math.sin(t), y * math.cos(t) - x * math.sin(t)
    return abs(math.hypot(u / ellipse.data["rx"], v / ellipse.data["ry"]) - 1)


def _on_segment(ev: Evaluator, p: Any, curve: Any) -> list[float]:
    """On a line between its ends; on an arc where it is swept, both ends included."""
    point, (a, b) = ev.point(p).xy, ends(ev, curve)
    if is_line(curve):
        return [abs(math.dist(a, point) + math.dist(point, b) - math.dist(a, b))]
    center, half = ev.member(curve, "center").xy, ev.member(curve, "midpoint").xy
    beyond = cross(minus(b, a), minus(point, a)) * cross(minus(b, a), minus(half, a))
    beside = abs(cross(minus(b, a), minus(point, a))) / math.dist(a, b)
    return [abs(math.dist(point, center) - curve.data["radius"]), beside if beyond < 0 else 0.0]


def _all_agree(axis: int) -> Relation:
    """Level (axis 1) or upright (axis 0): a line, or points and the centres of things."""

    def relation(ev: Evaluator, *things: Any) -> list[float]:
        found = listed(ev, things)
        if any(map(is_line, found)):
            points = [p for line in found for p in ends(ev, line)]
            return [abs(points[i][axis] - points[i + 1][axis]) for i in range(0, len(points), 2)]
        values = [middle(ev, t)[axis] for t in found]
        return [abs(v - values[0]) for v in values[1:]]

    return relation


def _ways(ev: Evaluator, *lines: Any) -> list[Vec]:
    return [minus(b, a) for a, b in (ends(ev, line) for line in lines)]


def sine(v: Vec, w: Vec) -> float:
    """0 for parallel directions; lines without a length have none, so that nothing holds of them."""
    sizes = math.hypot(*v) * math.hypot(*w)
    return abs(cross(v, w)) / sizes if sizes > 1e-9 else math.inf


def _cosine(v: Vec, w: Vec) -> float:
    return sine(v, (-w[1], w[0]))


def _parallel(ev: Evaluator, *lines: Any) -> list[float]:
    first, *others = _ways(ev, *listed(ev, lines))
    return [sine(first, v) for v in others]


def _perpendicular(ev: Evaluator, a: Any, b: Any) -> list[float]:
    """Lines; curves at the end they share; a line and something round whose centre it goes through."""
    if is_line(a) and is_line(b):
        return [_cosine(*_ways(ev, a, b))]
    joint = _joint(ev, a, b)
    if joint is not None:
        return [_cosine(*(direction_at(ev, t, joint) for t in (a, b)))]
    line, other = (a, b) if is_line(a) else (b, a)
    return [abs(offset(ev, ev.member(other, "center").xy, line))]


def _collinear(ev: Evaluator, *things: Any) -> list[float]:
    things = tuple(listed(ev, things))
    line = next((t for t in things if is_line(t)), None)
    if line is not None:
        points = [
            p for t in things if t is not line for p in (ends(ev, t) if is_line(t) else [middle(ev, t)])
        ]
        return [abs(offset(ev, p, line)) for p in points]
    a, b, *others = (middle(ev, t) for t in things)
    return [abs(cross(minus(b, a), minus(p, a))) / math.dist(a, b) for p in others]


def _concentric(ev: Evaluator, *things: Any) -> list[float]:
    centers = [middle(ev, t) for t in listed(ev, things)]
    return [r for c in centers[1:] for r in _apart(c, centers[0])]


# --- Tangency --------------------------------------------------------------------------------------


def _tangent(ev: Evaluator, *things: Any, inside: bool | None = None) -> list[float]:
    """Each touches the last."""
    *others, last = listed(ev, things)
    return [_touch(ev, t, last, inside) for t in others]


def _touch(ev: Evaluator, a: Any, b: Any, inside: bool | None) -> float:
    joint = _joint(ev, a, b)
    if joint is not None and inside is None:
        return sine(*(direction_at(ev, t, joint) for t in (a, b)))
    if is_line(b):
        a, b = b, a
    center = ev.member(b, "center").xy
    if is_line(a):
        return abs(abs(offset(ev, center, a)) - _half_width(ev, b, a))
    apart, radius, other = math.dist(center, ev.member(a, "center").xy), b.data["radius"], a.data["radius"]
    outer, inner = float(abs(apart - radius - other)), float(abs(apart - abs(radius - other)))
    return min(outer, inner) if inside is None else inner if inside else outer


def _half_width(ev: Evaluator, thing: Geo, line: Geo) -> float:
    """How far something round reaches across the direction of a line."""
    if thing.type != "ellipse":
        return float(thing.data["radius"])
    t = math.radians(ev.member(line, "angle").value - ev.member(thing, "angle").value)
    return math.hypot(thing.data["rx"] * math.sin(t), thing.data["ry"] * math.cos(t))


def _joint(ev: Evaluator, a: Any, b: Any) -> Vec | None:
    """The end that two curves share."""
    for p in _tips(ev, a):
        for q in _tips(ev, b):
            if math.dist(p, q) < 1e-7:
                return p
    return None


def _tips(ev: Evaluator, thing: Any) -> list[Vec]:
    if thing.type not in ("line", "arc", "bezier"):
        return []
    return [ev.member(thing, "start").xy, ev.member(thing, "end").xy]


def direction_at(ev: Evaluator, thing: Any, p: Vec) -> Vec:
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
    found = listed(ev, things)
    return [r for t in found[:-1] for r in _like(ev, t, found[-1])]


def _like(ev: Evaluator, a: Any, b: Any) -> list[float]:
    from tests.checker.conditions import compare

    if isinstance(a, Node):
        return _same_field("width")(ev, a, b) + _same_field("height")(ev, a, b)
    if not isinstance(a, Geo) or a.type == "point":
        return compare(ev, a, "==", b)
    if _is_round(a) and _is_round(b):
        return _same_field("radius")(ev, a, b)
    if is_line(a) or is_line(b):
        return _same_field("length")(ev, a, b)
    names = ("rx", "ry") if a.type == "ellipse" else _sizes(a)
    return [r for name in names for r in _same_field(name)(ev, a, b)]


def _sizes(shape: Geo) -> list[str]:
    """The numbers that make a shape, its direction aside."""
    told = shape.data.get("params", {})
    return [n for n, v in told.items() if isinstance(v, float) and n not in ("angle", "heading")]


def _midpoint(ev: Evaluator, p: Any, a: Any, b: Any = None) -> list[float]:
    if b is not None:
        (ax, ay), (bx, by) = middle(ev, a), middle(ev, b)
        return _apart(middle(ev, p), ((ax + bx) / 2, (ay + by) / 2))
    if is_line(p) and not is_line(a):
        p, a = a, p
    return _apart(middle(ev, p), ev.member(a, "midpoint").xy)


def _symmetric(ev: Evaluator, a: Any, b: Any = None, about: Any = None, axis: Any = None) -> list[float]:
    about = axis if about is None else about
    if b is not None:
        return _images(ev, a, b, about)
    if isinstance(a, list | Array):
        items = ev.items(a)
        return [r for p, q in zip(items, items[::-1], strict=True) for r in _images(ev, p, q, about)]
    return _images(ev, a, a, about)


def _kind(of: Any) -> str:
    """What a thing is when its image is sought: shapes are of one kind, curves each of their own."""
    if isinstance(of, list | Array):
        return "list"
    if isinstance(of, Node):
        return "structure"
    curves = ("point", "line", "circle", "arc", "ellipse", "bezier")
    return "point" if not isinstance(of, Geo) else of.type if of.type in curves else "shape"


def _images(ev: Evaluator, a: Any, b: Any, about: Any) -> list[float]:
    """Whether two things are images: curves as they are drawn, of shapes and structures the boxes, of things
    of two kinds the centres.
    """
    if _kind(a) != _kind(b):
        return _apart(mirrored(ev, middle(ev, a), about), middle(ev, b))
    if isinstance(a, list | Array):
        pairs = zip(ev.items(a), ev.items(b), strict=True)
        return [r for p, q in pairs for r in _images(ev, p, q, about)]
    if isinstance(a, Geo) and a.type in ("line", "circle", "arc", "ellipse", "bezier"):
        if a is b and is_line(a) and is_line(about) and sine(*_ways(ev, a, about)) < 1e-6:
            return _collinear(ev, a, about)
        return [away(ev.frame, Copy(a, lambda p: mirrored(ev, p, about)), b)]
    if isinstance(a, Geo | Node) and not (isinstance(a, Geo) and a.type == "point"):
        box, other = ev.box(a), ev.box(b)
        sizes = [abs(box.width - other.width), abs(box.height - other.height)]
        return _apart(mirrored(ev, box.center, about), other.center) + sizes
    return _apart(mirrored(ev, ev.point(a).xy, about), ev.point(b).xy)


# --- Measures set to a value -----------------------------------------------------------------------


def _measured(measure: Callable[..., float]) -> Relation:
    """A measure that has a value, or bounds."""

    def relation(
        ev: Evaluator, a: Any, b: Any, value: Any = None, at_least: Any = None, at_most: Any = None
    ) -> list[float]:
        now = measure(ev, a, b)
        found = [] if value is None else [abs(now - ev.number(value).value)]
        found += [] if at_least is None else [max(0.0, ev.number(at_least).value - now)]
        return found + ([] if at_most is None else [max(0.0, now - ev.number(at_most).value)])

    return relation


def _along(axis: int) -> Relation:
    return _measured(lambda ev, a, b: abs(middle(ev, b)[axis] - middle(ev, a)[axis]))


def _field_is(name: str) -> Relation:
    def relation(ev: Evaluator, thing: Any, value: Any) -> list[float]:
        return [abs(ev.member(thing, name).value - ev.number(value).value)]

    return relation


def _angle(
    ev: Evaluator, a: Any, b: Any, c: Any = None, value: Any = None, ccw: bool | None = None
) -> list[float]:
    """Of two lines, of one to the x axis, or at the middle of three points."""
    from tests.checker.conditions import angle_readings, turn_apart

    if not is_line(a):
        found = corner_angle(ev, a, b, c)
        return [abs(abs(found) - ev.number(value).value)]
    if not is_line(b):
        direction, wanted = ev.member(a, "angle").value, ev.number(b).value
        return [min(turn_apart(direction, wanted), turn_apart(direction, wanted - 180))]
    wanted = ev.number(c if value is None else value).value
    if ccw is None:
        return [angle_readings(between(ev, a, b), wanted)]
    return [turn_apart(between(ev, a, b), wanted if ccw else -wanted)]


def _diameter(ev: Evaluator, thing: Any, value: Any) -> list[float]:
    return [abs(2 * ev.member(thing, "radius").value - ev.number(value).value)]


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
    "on_segment": _on_segment,
    "mirror_of": _symmetric,
    "meshes": meshes,
    "tangent": _tangent,
    "equal": _equal,
    "equal_length": _same_field("length"),
    "equal_radius": _same_field("radius"),
    "midpoint": _midpoint,
    "symmetric": _symmetric,
    "distance": _measured(distance),
    "horizontal_distance": _along(0),
    "vertical_distance": _along(1),
    "length": _field_is("length"),
    "radius": _field_is("radius"),
    "diameter": _diameter,
    "angle": _angle,
    "fixed": _fixed,
}

_CANONICAL: dict[str, Relation] = {**_GEOMETRIC, **STRUCTURAL}

RELATIONS: dict[str, Relation] = {
    **{fold(name): relation for name, relation in _CANONICAL.items()},
    **{fold(word): _CANONICAL[name] for name, words in SYNONYMS.items() for word in words.split()},
}

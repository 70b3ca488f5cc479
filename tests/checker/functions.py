"""Functions of the language in numbers: angles are degrees, lengths millimetres."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from tests.checker.boxes import Box
from tests.checker.clearance import clearance
from tests.checker.tree import Array, Geo, Node, Vec
from tests.checker.values import (
    Boxed,
    Exact,
    MistakeError,
    Num,
    Point,
    UnavailableError,
    arithmetic,
    marked,
    point_at,
    reference,
)

if TYPE_CHECKING:
    from tests.checker.evaluate import Evaluator

Function = Callable[..., Any]
EMPTY = Num(0.0)


def _of_numbers(
    compute: Callable[..., float], *, gives_angle: bool = False, keeps_angle: bool = False
) -> Function:
    def function(ev: Evaluator, *arguments: Any, **named: Any) -> Num:
        values = [ev.number(a) for a in (*arguments, *named.values())]
        exact = max((v.exact for v in values), default=Exact.NUMBER)
        is_angle = gives_angle or (keeps_angle and any(v.is_angle for v in values))
        try:
            return Num(compute(*[v.value for v in values]), exact, is_angle)
        except (ArithmeticError, ValueError):
            return Num(math.nan, exact, is_angle)

    return function


def _extreme(choose: Callable[[list[float]], float]) -> Function:
    def function(ev: Evaluator, *arguments: Any) -> Num:
        values = arguments if len(arguments) > 1 else ev.items(arguments[0])
        numbers = [ev.number(v) for v in values]
        return Num(
            choose([n.value for n in numbers]),
            max(n.exact for n in numbers),
            any(n.is_angle for n in numbers),
        )

    return function


def _sum(ev: Evaluator, *arguments: Any) -> Any:
    total: Any = None
    for item in arguments if len(arguments) > 1 else ev.items(arguments[0]):
        total = ev.plain(item) if total is None else arithmetic("+", total, ev.plain(item))
    return Num(0.0) if total is None else total


def _len(ev: Evaluator, values: Any) -> Num:
    return Num(float(len(ev.items(values))))


def _mark(exact: Exact) -> Function:
    def function(ev: Evaluator, value: Any) -> Any:
        if exact == Exact.FIXED and isinstance(value, Geo | Point) and not isinstance(value, Point):
            value = ev.point(value)
        return marked(value, exact)

    return function


# --- Points ----------------------------------------------------------------------------------------


def _polar(ev: Evaluator, radius: Any, angle: Any) -> Point:
    r, turn = ev.number(radius), ev.number(angle)
    exact, t = max(r.exact, turn.exact), math.radians(turn.value)
    return Point(Num(r.value * math.cos(t), exact), Num(r.value * math.sin(t), exact))


def _of_points(compute: Callable[..., Any]) -> Function:
    def function(ev: Evaluator, *arguments: Any) -> Any:
        return compute(*[ev.point(a).xy for a in arguments])

    return function


def _norm(v: Vec) -> Num:
    return reference(math.hypot(*v))


def dot(a: Vec, b: Vec) -> float:
    return a[0] * b[0] + a[1] * b[1]


def cross(a: Vec, b: Vec) -> float:
    return a[0] * b[1] - a[1] * b[0]


def minus(a: Vec, b: Vec) -> Vec:
    return a[0] - b[0], a[1] - b[1]


def _lerp(ev: Evaluator, a: Any, b: Any, t: Any) -> Any:
    if not (isinstance(a, Num) and isinstance(b, Num)):
        a, b = ev.point(a), ev.point(b)
    return arithmetic("+", a, arithmetic("*", arithmetic("-", b, a), ev.number(t)))


def _unit(ev: Evaluator, v: Any) -> Any:
    p = ev.point(v)
    return arithmetic("/", p, Num(math.hypot(*p.xy), max(p.x.exact, p.y.exact)))


def _midpoint(ev: Evaluator, a: Any, b: Any = None) -> Any:
    if b is None:
        return ev.member(a, "midpoint")
    return arithmetic("/", arithmetic("+", ev.point(a), ev.point(b)), Num(2.0))


def _turned(ev: Evaluator, v: Any, angle: Any) -> Point:
    (x, y), t = ev.point(v).xy, math.radians(ev.number(angle).value)
    return Point(reference(x * math.cos(t) - y * math.sin(t)), reference(x * math.sin(t) + y * math.cos(t)))


# --- Measures --------------------------------------------------------------------------------------


def ends(ev: Evaluator, line: Any) -> tuple[Vec, Vec]:
    return ev.member(line, "start").xy, ev.member(line, "end").xy


def offset(ev: Evaluator, p: Vec, line: Any) -> float:
    """The signed distance of a point from an endless line, positive on its left."""
    a, b = ends(ev, line)
    return cross(minus(b, a), minus(p, a)) / math.dist(a, b)


def middle(ev: Evaluator, thing: Any) -> Vec:
    """The point that stands for a thing: itself, its centre, or the centre of its box."""
    if isinstance(thing, Geo) and thing.type == "point":
        return ev.point(thing).xy
    if isinstance(thing, Geo | Node):
        center: Point = ev.member(thing, "center")
        return center.xy
    if isinstance(thing, Boxed | Array) or (isinstance(thing, list) and not isinstance(thing[0], Num)):
        return ev.box(thing).center
    return ev.point(thing).xy


def is_line(thing: Any) -> bool:
    return isinstance(thing, Geo) and thing.type == "line"


def distance(ev: Evaluator, a: Any, b: Any) -> float:
    if is_line(a) and is_line(b):
        return abs(offset(ev, ev.member(b, "midpoint").xy, a))
    if is_line(a) or is_line(b):
        line, other = (a, b) if is_line(a) else (b, a)
        return abs(offset(ev, middle(ev, other), line))
    return math.dist(middle(ev, a), middle(ev, b))


def _along(axis: int) -> Function:
    def function(ev: Evaluator, a: Any, b: Any) -> Num:
        return reference(abs(middle(ev, b)[axis] - middle(ev, a)[axis]))

    return function


def corner_angle(ev: Evaluator, a: Any, corner: Any, b: Any) -> float:
    """The angle at the middle of three points, counter-clockwise from one arm to the other."""
    p, c, q = (ev.point(x).xy for x in (a, corner, b))
    v, w = minus(p, c), minus(q, c)
    return math.degrees(math.atan2(cross(v, w), dot(v, w)))


def _angle(ev: Evaluator, a: Any, b: Any = None, c: Any = None) -> Num:
    if c is not None:
        return reference(abs(corner_angle(ev, a, b, c)), is_angle=True)
    if b is None:
        return reference(ev.member(a, "angle").value, is_angle=True)
    return reference(between(ev, a, b), is_angle=True)


def between(ev: Evaluator, a: Any, b: Any) -> float:
    """The angle from the direction of one line to that of another, counter-clockwise."""
    return float(ev.member(b, "angle").value - ev.member(a, "angle").value)


# --- Lines to be symmetric about -------------------------------------------------------------------


def line(ev: Evaluator, start: Vec, end: Vec) -> Geo:
    """A line that is not drawn, from points as the structure that asks sees them."""
    ends = {"start": ev.frame.outward(start), "end": ev.frame.outward(end)}
    return Geo("line", "line", "line", ends, {}, construction=True)


def _line(ev: Evaluator, start: Any, end: Any = None, length: Any = None, angle: Any = None) -> Geo:
    if end is None:
        end = arithmetic("+", ev.point(start), _polar(ev, length, angle))
    return line(ev, ev.point(start).xy, ev.point(end).xy)


def _through(degrees: float) -> Function:
    return lambda ev, p: _line_through(ev, p, Num(degrees))


def _line_through(ev: Evaluator, p: Any, angle: Any) -> Geo:
    (x, y), t = middle(ev, p), math.radians(ev.number(angle).value)
    return line(ev, (x, y), (x + math.cos(t), y + math.sin(t)))


def mirrored(ev: Evaluator, p: Vec, about: Any) -> Vec:
    """The image of a point in a line, a point, an axis by its letter, or the upright line at an x."""
    if isinstance(about, Num | str):
        x = 0.0 if isinstance(about, str) else about.value
        about = line(ev, (x, 0.0), (1.0, 0.0) if about == "x" else (x, 1.0))
    if not is_line(about):
        x, y = ev.point(about).xy
        return 2 * x - p[0], 2 * y - p[1]
    a, b = ends(ev, about)
    way = minus(b, a)
    t = dot(minus(p, a), way) / dot(way, way)
    return 2 * (a[0] + t * way[0]) - p[0], 2 * (a[1] + t * way[1]) - p[1]


def _between(ev: Evaluator, a: Any, b: Any, share: Any = None) -> Point:
    (ax, ay), (bx, by) = middle(ev, a), middle(ev, b)
    t = 0.5 if share is None else ev.number(share).value
    return point_at((ax + t * (bx - ax), ay + t * (by - ay)))


def _anchor(ev: Evaluator, of: Any, place: str = "center") -> Point:
    box, words = ev.box(of), place.split("_")
    x = box.left if "left" in words else box.right if "right" in words else box.center_x
    y = box.bottom if "bottom" in words else box.top if "top" in words else box.center_y
    return point_at((x, y))


def _spot(ev: Evaluator, of: Any, x: Any, y: Any) -> Point:
    box, (across, up) = ev.box(of), (ev.number(share).value for share in (x, y))
    return point_at((box.left * (1 - across) + box.right * across, box.bottom * (1 - up) + box.top * up))


def _spots(ev: Evaluator, of: Any, points: Any) -> list[Point]:
    places = [ev.point(p).xy for p in ev.items(points)]
    return [_spot(ev, of, Num(x), Num(y)) for x, y in places]


def _circumcenter(ev: Evaluator, a: Any, b: Any, c: Any) -> Point:
    """Where the bisectors of two sides meet."""
    p, q, r = (ev.point(x).xy for x in (a, b, c))
    v, w = minus(q, p), minus(r, p)
    d = 2 * cross(v, w)
    x, y = (w[1] * dot(v, v) - v[1] * dot(w, w)) / d, (v[0] * dot(w, w) - w[0] * dot(v, v)) / d
    return point_at((p[0] + x, p[1] + y))


# --- Lists, texts and records ----------------------------------------------------------------------


def _numbers(ev: Evaluator, first: Any, last: Any = None, step: Any = None) -> list[Num]:
    """`range` as in Python."""
    low, high = (Num(0.0), first) if last is None else (first, last)
    by = 1 if step is None else round(ev.number(step).value)
    return [Num(float(i)) for i in range(round(ev.number(low).value), round(ev.number(high).value), by)]


def _enumerate(ev: Evaluator, values: Any) -> list[list[Any]]:
    return [[Num(float(i)), v] for i, v in enumerate(ev.items(values))]


def _zip(ev: Evaluator, *lists: Any) -> list[list[Any]]:
    return [list(row) for row in zip(*map(ev.items, lists), strict=True)]


def _str(ev: Evaluator, value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return value if isinstance(value, str) else f"{ev.number(value).value:.10g}"


def _choice(ev: Evaluator, word: str, words: list[str]) -> str:
    """The word of a list that is meant."""
    plain = {re.sub(r"[^a-z0-9.]", "", w.lower()): w for w in words}
    return plain[re.sub(r"[^a-z0-9.]", "", word.lower())]


def _nearest(ev: Evaluator, value: Any, candidates: Any) -> Num:
    now = ev.number(value).value
    return min((ev.number(c) for c in ev.items(candidates)), key=lambda c: abs(c.value - now))


def _mirror(ev: Evaluator, x: Any, about: Any) -> Any:
    return point_at(mirrored(ev, ev.point(x).xy, about))


def _on_the_drawing(ev: Evaluator, *things: Any) -> Any:
    raise UnavailableError("areas are measured on the finished drawing")


def room(a: Box, b: Box) -> float:
    """The distance of two boxes; 0 when they touch or overlap."""
    dx = max(0.0, a.left - b.right, b.left - a.right)
    return math.hypot(dx, max(0.0, a.bottom - b.top, b.bottom - a.top))


def same(ev: Evaluator, a: Any, b: Any) -> bool:
    """Equality of values of any kind, to a millionth."""
    if isinstance(a, str | bool) or isinstance(b, str | bool):
        return bool(a == b)
    p, q = ev.plain(a), ev.plain(b)
    if isinstance(p, Num) and isinstance(q, Num):
        return abs(p.value - q.value) <= 1e-6
    if isinstance(p, Point) and isinstance(q, Point):
        return math.dist(p.xy, q.xy) <= 1e-6
    raise MistakeError("a number compared with a point")


def _degrees(compute: Callable[[float], float]) -> Callable[[float], float]:
    return lambda angle: compute(math.radians(angle))


def _near_whole(compute: Callable[[float], float]) -> Callable[[float], float]:
    return lambda x: float(round(x)) if abs(x - round(x)) < 1e-9 * max(1, abs(x)) else float(compute(x))


FUNCTIONS: dict[str, Function] = {
    "sin": _of_numbers(_degrees(math.sin)),
    "cos": _of_numbers(_degrees(math.cos)),
    "tan": _of_numbers(_degrees(math.tan)),
    "asin": _of_numbers(lambda x: math.degrees(math.asin(x)), gives_angle=True),
    "acos": _of_numbers(lambda x: math.degrees(math.acos(x)), gives_angle=True),
    "atan": _of_numbers(lambda x: math.degrees(math.atan(x)), gives_angle=True),
    "atan2": _of_numbers(lambda y, x: math.degrees(math.atan2(y, x)), gives_angle=True),
    "sqrt": _of_numbers(math.sqrt),
    "abs": _of_numbers(abs, keeps_angle=True),
    "square": _of_numbers(lambda x: x * x),
    "hypot": _of_numbers(math.hypot),
    "floor": _of_numbers(_near_whole(math.floor), keeps_angle=True),
    "ceil": _of_numbers(_near_whole(math.ceil), keeps_angle=True),
    "round": _of_numbers(_near_whole(lambda x: math.floor(x + 0.5)), keeps_angle=True),
    "radians": _of_numbers(math.radians),
    "min": _extreme(min),
    "max": _extreme(max),
    "sum": _sum,
    "len": _len,
    "fixed": _mark(Exact.FIXED),
    "guess": _mark(Exact.GUESS),
    "polar": _polar,
    "norm": _of_points(_norm),
    "dot": _of_points(lambda a, b: reference(dot(a, b))),
    "cross": _of_points(lambda a, b: reference(cross(a, b))),
    "lerp": _lerp,
    "unit": _unit,
    "midpoint": _midpoint,
    "turned": _turned,
    "vector": lambda ev, line: arithmetic("-", ev.member(line, "end"), ev.member(line, "start")),
    "direction": lambda ev, line: _unit(
        ev, arithmetic("-", ev.member(line, "end"), ev.member(line, "start"))
    ),
    "distance": lambda ev, a, b: reference(distance(ev, a, b)),
    "offsetfrom": lambda ev, p, line: reference(offset(ev, ev.point(p).xy, line)),
    "horizontaldistance": _along(0),
    "verticaldistance": _along(1),
    "angle": _angle,
    "length": lambda ev, of: ev.member(of, "length"),
    "radius": lambda ev, of: ev.member(of, "radius"),
    "diameter": lambda ev, of: arithmetic("*", ev.member(of, "radius"), Num(2.0)),
    "clearance": clearance,
    "area": _on_the_drawing,
    "perimeter": _on_the_drawing,
    "overlaps": _on_the_drawing,
    "line": _line,
    "verticalthrough": _through(90.0),
    "horizontalthrough": _through(0.0),
    "linethrough": _line_through,
    "between": _between,
    "anchor": _anchor,
    "spot": _spot,
    "spots": _spots,
    "circumcenter": _circumcenter,
    "mirror": _mirror,
    "range": _numbers,
    "enumerate": _enumerate,
    "zip": _zip,
    "reversed": lambda ev, values: ev.items(values)[::-1],
    "str": _str,
    "record": lambda ev, **named: named,
    "choice": _choice,
    "nearest": _nearest,
    "written": lambda ev, value: value,
    "gap": lambda ev, a, b: reference(ev.together(lambda: room(ev.box(a), ev.box(b)))),
}

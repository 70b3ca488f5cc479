"""Functions of the language in numbers: angles are degrees, lengths millimetres."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from tests.checker.boxes import Box
from tests.checker.tree import Geo, Vec
from tests.checker.values import Exact, MistakeError, Num, Point, arithmetic, marked, reference

if TYPE_CHECKING:
    from tests.checker.evaluate import Evaluator

Function = Callable[..., Any]


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
    way = arithmetic("-", ev.point(b), ev.point(a))
    return arithmetic("+", ev.point(a), arithmetic("*", way, ev.number(t)))


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
    """The point that stands for a point or something round."""
    if isinstance(thing, Geo) and thing.type in ("circle", "arc", "ellipse"):
        center: Point = ev.member(thing, "center")
        return center.xy
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


def between(ev: Evaluator, a: Any, b: Any) -> float:
    """The angle from the direction of one line to that of another, counter-clockwise."""
    return float(ev.member(b, "angle").value - ev.member(a, "angle").value)


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
    "angle": lambda ev, a, b: reference(between(ev, a, b), is_angle=True),
    "gap": lambda ev, a, b: reference(ev.together(lambda: room(ev.box(a), ev.box(b)))),
}

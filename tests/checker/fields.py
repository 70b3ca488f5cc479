"""Members of values: fields of geometry, names inside structures, sides of boxes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from aidl_lang.checking.binding import MEMBERS
from tests.checker.tree import Array, Geo, Node, Vec
from tests.checker.values import (
    Boxed,
    Exact,
    MistakeError,
    Num,
    Point,
    Thunk,
    fold,
    point_at,
    reference,
)

if TYPE_CHECKING:
    from tests.checker.evaluate import Evaluator

_SIDES = ("left", "right", "top", "bottom", "width", "height", "center_x", "center_y")
LEVEL = 1e-6


def seen(ev: Evaluator, p: Any) -> Point:
    """A point of the document as the structure that asks sees it."""
    return point_at(ev.frame.inward((p[0], p[1])))


def member(ev: Evaluator, value: Any, name: str) -> Any:
    """`value.name` or what other words mean by it, None when there is no such thing."""
    for word in (name, *MEMBERS.get(fold(name), ())):
        found = _member(ev, value, word)
        if found is not None:
            return found
    return None


def _member(ev: Evaluator, value: Any, name: str) -> Any:
    match value:
        case Point():
            return {"x": value.x, "y": value.y}.get(name) or _of_box(ev, value, name)
        case Boxed():
            return _of_box(ev, value, name)
        case Node():
            return of_structure(ev, value, name)
        case Geo():
            return of_geometry(ev, value, name)
        case dict():
            return _named(value, name)
        case Array() | list():
            items = ev.items(value)
            if isinstance(value, Array) and value.pattern is not None:
                known = value.pattern.field(ev, fold(name))
                if known is not None:
                    return known
            if name in ("bb", *_SIDES[4:]):
                return _of_box(ev, value, name)
            return [ev.member(item, name) for item in items]
        case _:
            return None


def of_structure(ev: Evaluator, node: Node, name: str) -> Any:
    """A member of a structure: what its body names, its frame's axes, else a side of its box."""
    known = _named(node.members(), name)
    if known is not None:
        return known
    if node.env is not None:
        value = _named(node.env.names, name)
        if value is not None:
            return ev.forced(value, node.env) if isinstance(value, Thunk) else value
    if fold(name) in ("origin", "xaxis", "yaxis"):
        return _axis(ev, node, fold(name))
    return _of_box(ev, node, name)


def _named(names: dict[str, Any], name: str) -> Any:
    if name in names:
        return names[name]
    return next((v for n, v in names.items() if fold(n) == fold(name)), None)


def _axis(ev: Evaluator, node: Node, name: str) -> Any:
    if name == "origin":
        exact = Exact.FIXED if node is ev.here else Exact.REFERENCE
        x, y = ev.frame.inward(node.world.outward((0.0, 0.0)))
        return Point(Num(x, exact), Num(y, exact))
    tip = (1.0, 0.0) if name == "xaxis" else (0.0, 1.0)
    ends = {"start": node.world.outward((0.0, 0.0)), "end": node.world.outward(tip)}
    return Geo(name, f"{node.path}.{name}", "line", ends, {}, construction=False)


def _of_box(ev: Evaluator, value: Any, name: str) -> Any:
    if name == "bb":
        return Boxed(tuple(ev.sources(value)))
    if name not in (*_SIDES, "center") and "_" not in name:
        return None
    box = ev.box(value)
    if name in _SIDES:
        return reference(getattr(box, name))
    corner = box.center if name == "center" else box.corner(name)
    return None if corner is None else point_at(corner)


def of_geometry(ev: Evaluator, geo: Geo, name: str) -> Any:
    """A field of a primitive, a part or a derived field of a compound shape, else a side of its box."""
    part = _named(geo.members(), name)
    if part is not None:
        return part
    derived = _FIELDS.get(geo.type, compound)(ev, geo, fold(name))
    if derived is not None:
        return derived
    if name in geo.data.get("params", {}):
        told = geo.data["params"][name]
        return seen(ev, told) if isinstance(told, list) else reference(told)
    if geo.source is not None:
        value = _named(geo.source.names, name)
        if value is not None:
            return ev.forced(value, geo.source)
    return _of_box(ev, geo, name)


def edge(ev: Evaluator, line: Geo) -> Num:
    """The coordinate of a line that is parallel to an axis of the frame that asks."""
    start, end = seen(ev, line.data["start"]).xy, seen(ev, line.data["end"]).xy
    dx, dy = abs(end[0] - start[0]), abs(end[1] - start[1])
    if min(dx, dy) > LEVEL * max(dx, dy, 1.0):
        raise MistakeError(f"{line.path} is not parallel to an axis")
    if max(dx, dy) < LEVEL:
        is_level = _side_name(line) in ("top", "bottom")
    else:
        is_level = dy <= dx
    return reference((start[1] + end[1]) / 2 if is_level else (start[0] + end[0]) / 2)


def _side_name(line: Geo) -> str:
    return line.path.rpartition(".")[2]


# --- Primitives ------------------------------------------------------------------------------------


def heading(a: Vec, b: Vec) -> Num:
    """The direction from one point to another."""
    return reference(math.degrees(math.atan2(b[1] - a[1], b[0] - a[0])), is_angle=True)


def _point(ev: Evaluator, geo: Geo, name: str) -> Any:
    at = seen(ev, geo.data["at"])
    return {"x": at.x, "y": at.y, "at": at}.get(name)


def _line(ev: Evaluator, geo: Geo, name: str) -> Any:
    start, end = seen(ev, geo.data["start"]), seen(ev, geo.data["end"])
    (ax, ay), (bx, by) = start.xy, end.xy
    match name:
        case "start":
            return start
        case "end":
            return end
        case "midpoint" | "center":
            return point_at(((ax + bx) / 2, (ay + by) / 2))
        case "length":
            return reference(math.hypot(bx - ax, by - ay))
        case "angle":
            return heading(start.xy, end.xy)
        case "dx":
            return reference(bx - ax)
        case "dy":
            return reference(by - ay)
        case _:
            return None


def _circle(ev: Evaluator, geo: Geo, name: str) -> Any:
    radius = geo.data["radius"]
    match name:
        case "center":
            return seen(ev, geo.data["center"])
        case "radius":
            return reference(radius)
        case "diameter":
            return reference(2 * radius)
        case _:
            return None


def _arc(ev: Evaluator, geo: Geo, name: str) -> Any:
    start, end, center = (seen(ev, geo.data[f]) for f in ("start", "end", "center"))
    sense = -1 if bool(geo.data.get("clockwise")) != ev.frame.is_mirrored else 1
    first, last = heading(center.xy, start.xy), heading(center.xy, end.xy)
    sweep = (sense * (last.value - first.value)) % 360
    match name:
        case "start":
            return start
        case "end":
            return end
        case "startangle":
            return first
        case "endangle":
            return last
        case "sweep":
            return reference(sweep, is_angle=True)
        case "length":
            return reference(math.radians(sweep) * geo.data["radius"])
        case "midpoint":
            turn = math.radians(first.value + sense * sweep / 2)
            (x, y), r = center.xy, geo.data["radius"]
            return point_at((x + r * math.cos(turn), y + r * math.sin(turn)))
        case _:
            return _circle(ev, geo, name)


def _ellipse(ev: Evaluator, geo: Geo, name: str) -> Any:
    match name:
        case "center":
            return seen(ev, geo.data["center"])
        case "rx" | "ry":
            return reference(geo.data[name])
        case "angle":
            turn = math.radians(geo.data["angle"])
            x, y = geo.data["center"]
            tip = (x + math.cos(turn), y + math.sin(turn))
            return heading(seen(ev, (x, y)).xy, seen(ev, tip).xy)
        case _:
            return None


def _bezier(ev: Evaluator, geo: Geo, name: str) -> Any:
    index = {"p0": 0, "p1": 1, "p2": 2, "p3": 3, "start": 0, "end": 3}.get(name)
    return None if index is None else seen(ev, geo.data["points"][index])


# --- Compound shapes -------------------------------------------------------------------------------


def compound(ev: Evaluator, geo: Geo, name: str) -> Any:
    """What a library shape can be asked for besides its parts, worked out from the parts."""
    corners = [geo.parts.get(n) for n in ("bottom_left", "bottom_right", "top_right", "top_left")]
    known = [ev.point(c).xy for c in corners if c is not None]
    if name == "center":
        return _center(ev, geo, known)
    if len(known) == 4 and geo.type in ("rectangle", "square", "rounded_rectangle"):
        a, b, _, d = known
        match name:
            case "width" | "size":
                return reference(math.dist(a, b))
            case "height":
                return reference(math.dist(a, d))
            case "angle":
                return heading(a, b)
    if name == "radius" and geo.type == "rounded_rectangle":
        return reference(geo.parts["corner_top_left"].data["radius"])
    if name == "height" and geo.type == "trapezoid":
        (ax, ay), (bx, by), (cx, cy), (dx, dy) = known
        return reference(math.hypot(cx + dx - ax - bx, cy + dy - ay - by) / 2)
    if name == "bottomwidth" and geo.type == "trapezoid":
        return reference(math.dist(known[0], known[1]))
    if name == "topwidth" and geo.type == "trapezoid":
        return reference(math.dist(known[2], known[3]))
    return _round_shape(ev, geo, name)


def _center(ev: Evaluator, geo: Geo, corners: list[Vec]) -> Point | None:
    if len(corners) == 4:
        return point_at((sum(x for x, _ in corners) / 4, sum(y for _, y in corners) / 4))
    if "corner[0]" in geo.parts and geo.type == "regular_polygon":
        return _mean(ev, [g for n, g in geo.parts.items() if n.startswith("corner[")])
    if geo.type == "star":
        return _mean(ev, [g for n, g in geo.parts.items() if n.startswith("tip[")])
    for part in ("outer", "rim"):
        if part in geo.parts:
            return seen(ev, geo.parts[part].data["center"])
    if geo.type == "slot":
        ends = [ev.point(seen(ev, geo.parts[n].data["center"])).xy for n in ("start_cap", "end_cap")]
        return point_at(((ends[0][0] + ends[1][0]) / 2, (ends[0][1] + ends[1][1]) / 2))
    return None


def _mean(ev: Evaluator, points: list[Geo]) -> Point:
    found = [ev.point(p).xy for p in points]
    return point_at((sum(x for x, _ in found) / len(found), sum(y for _, y in found) / len(found)))


def _round_shape(ev: Evaluator, geo: Geo, name: str) -> Num | None:
    if geo.type == "ring" and name in ("outerradius", "innerradius"):
        return reference(geo.parts[name.removesuffix("radius")].data["radius"])
    if geo.type in ("sector", "segment") and name == "radius":
        return reference(geo.parts["rim"].data["radius"])
    if geo.type == "regular_polygon" and name == "radius":
        center = _center(ev, geo, [])
        assert center is not None
        return reference(math.dist(center.xy, ev.point(geo.parts["corner[0]"]).xy))
    if geo.type == "slot" and name == "width":
        return reference(2 * geo.parts["end_cap"].data["radius"])
    if geo.type == "slot" and name == "length":
        a, b = (geo.parts[n].data["center"] for n in ("start_cap", "end_cap"))
        return reference(math.dist(a, b) + 2 * geo.parts["end_cap"].data["radius"])
    return None


_FIELDS = {
    "point": _point,
    "line": _line,
    "circle": _circle,
    "arc": _arc,
    "ellipse": _ellipse,
    "bezier": _bezier,
}

"""Fields, measures and functions of the language in numbers, over what the document tells."""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Callable
from typing import Any

from aidl_lang.checking.binding import MEMBERS
from tests.checker.model import (
    Angle,
    Boxed,
    Geo,
    Node,
    UnknownError,
    angle,
    around,
    box,
    extremes,
    fold,
    named,
    together,
    turned,
)

LEVEL = 1e-6


def dot(a: complex, b: complex) -> float:
    return (a.conjugate() * b).real


def cross(a: complex, b: complex) -> float:
    return (a.conjugate() * b).imag


def is_line(thing: Any) -> bool:
    return isinstance(thing, Geo) and thing.type == "line"


def point(value: Any) -> complex:
    match value:
        case complex():
            return value
        case [float() as x, float() as y]:
            return complex(x, y)
        case Geo(type="point"):
            return value["at"]  # type: ignore[no-any-return]
        case list():
            raise UnknownError("what a pattern is asked for, of which the document has the members only")
    raise TypeError(f"{type(value).__name__} is no point")


def ends(line: Any) -> tuple[complex, complex]:
    return field(line, "start"), field(line, "end")


def middle(thing: Any) -> complex:
    """The point that stands for a thing: itself, its centre, or the centre of its box."""
    if isinstance(thing, Geo | Node) and not (isinstance(thing, Geo) and thing.type == "point"):
        return field(thing, "center")  # type: ignore[no-any-return]
    is_many = isinstance(thing, dict) or (isinstance(thing, list) and not isinstance(thing[0], float))
    return box(list(thing.values()) if isinstance(thing, dict) else thing).center if is_many else point(thing)


def edge(line: Geo) -> float:
    """The coordinate of a line that is parallel to an axis."""
    way = line["end"] - line["start"]
    dx, dy = abs(way.real), abs(way.imag)
    if min(dx, dy) > LEVEL * max(dx, dy, 1.0):
        raise TypeError(f"{line.path} is not parallel to an axis")
    is_level = dy <= dx if max(dx, dy) >= LEVEL else line.path.rpartition(".")[2] in ("top", "bottom")
    half: complex = (line["start"] + line["end"]) / 2
    return half.imag if is_level else half.real


# --- Fields ------------------------------------------------------------------------------------------


def field(value: Any, name: str) -> Any:
    """`value.name` or what other words mean by it."""
    for word in (fold(name), *MEMBERS.get(fold(name), ())):
        found = _field(value, fold(word))
        if found is not None:
            return found
    raise UnknownError(f"nothing tells {name} of {type(value).__name__} {getattr(value, 'path', '')}")


def _field(value: Any, name: str) -> Any:
    match value:
        case complex() if name in ("x", "y"):
            return value.real if name == "x" else value.imag
        case Node():
            found = named({**value.geometry, **value.children, **value.params}, name)
            if found is not None:
                return float(found) if type(found) is int else found
            if name in ("xaxis", "yaxis"):
                tip = value.axes[name == "yaxis"]
                return Geo(f"{value.path}.{name}", "line", {"start": value.origin, "end": tip})
            return value.origin if name == "origin" else _of_box(value, name)
        case Geo():
            found = named(value.parts, name)
            found = _of_geometry(value, name) if found is None else found
            if found is None and value.type not in _POINTS:
                found = named(value.data, name)
            return _of_box(value, name) if found is None else found
        case Boxed():
            return _of_box(value, name)
        case dict() if not all(isinstance(k, int) for k in value):
            return named(value, name)
        case dict() | list():
            things = list(value.values()) if isinstance(value, dict) else value
            return _of_box(things, name) if name in ("bb", *_SIZES) else [field(t, name) for t in things]
    return _of_box(value, name)


_SIZES = {"width": "width", "height": "height", "centerx": "center_x", "centery": "center_y"}
_SIDES = {**_SIZES, **{side: side for side in ("left", "right", "top", "bottom", "center")}}
_PLACES = {
    fold(f"{a}_{b}"): f"{a}_{b}"
    for one, other in (("left", "right"), ("top", "bottom"))
    for a, b in ((y, x) for x in ("left", "right", "center") for y in ("top", "bottom", "center"))
    if a != b
}
_PLACES |= {fold("_".join(reversed(v.split("_")))): v for v in _PLACES.values()}


def _of_box(value: Any, name: str) -> Any:
    if name == "bb":
        return Boxed([value])
    if name in _SIDES:
        return getattr(box(value), _SIDES[name])
    return box(value).spot(_PLACES[name]) if name in _PLACES else None


_POINTS = {
    "point": ("at",),
    "line": ("start", "end"),
    "circle": ("center", "radius"),
    "arc": ("center", "radius", "start", "end"),
    "ellipse": ("center", "rx", "ry", "angle"),
    "bezier": (),
}


def _of_geometry(geo: Geo, name: str) -> Any:
    """What a curve can be asked for, and what a shape of the library is by its parts."""
    if name in _POINTS.get(geo.type, ()):
        return geo[name]
    match geo.type, name:
        case "point", "x" | "y":
            return _field(geo["at"], name)
        case "line", ("midpoint" | "center"):
            return (geo["start"] + geo["end"]) / 2
        case "line", "length":
            return abs(geo["end"] - geo["start"])
        case "line", "angle":
            return angle(geo["end"] - geo["start"])
        case "line", "dx" | "dy":
            return _field(geo["end"] - geo["start"], name[1])
        case (("circle" | "arc"), "diameter"):
            return 2 * geo["radius"]
        case "arc", _:
            return _of_arc(geo, name)
        case "bezier", ("p0" | "p1" | "p2" | "p3" | "start" | "end"):
            return geo["points"][{"start": 0, "p1": 1, "p2": 2, "p3": 3, "end": 3}.get(name, 0)]
    return of_shape(geo, name)


def _of_arc(geo: Geo, name: str) -> Any:
    first, last = (angle(geo[e] - geo["center"]) for e in ("start", "end"))
    sense = -1 if geo["clockwise"] else 1
    sweep = (sense * (last - first)) % 360
    found: dict[str, Any] = {
        "startangle": first,
        "endangle": last,
        "sweep": Angle(sweep),
        "length": math.radians(sweep) * geo["radius"],
        "midpoint": geo["center"] + turned(first + sense * sweep / 2, geo["radius"]),
    }
    return found.get(name)


def of_shape(geo: Geo, name: str) -> Any:
    corners = [p["at"] for n in _CORNERS if (p := geo.parts.get(n)) is not None and p.type == "point"]
    for kinds, fields in _SHAPES.items():
        has_all = len(corners) == 4 or not kinds.startswith(("rectangle", "trapezoid"))
        if geo.type in kinds.split() and name in fields and has_all:
            return fields[name](geo.parts, corners)
    if name in ("start", "end"):  # of a chain: a path, a polyline, a spline
        chain = [p for n, p in geo.parts.items() if n.startswith(("edges[", "segment["))]
        return field(chain[0 if name == "start" else -1], name) if chain else None
    return sum(corners) / 4 if name == "center" and len(corners) == 4 else None


_CORNERS = ("bottom_left", "bottom_right", "top_right", "top_left")
Parts = dict[str, Geo]


def _mean(parts: Parts, name: str) -> complex:
    found = [p["at"] for n, p in parts.items() if n.startswith(f"{name}[")]
    return sum(found) / len(found)  # type: ignore[no-any-return]


_SHAPES: dict[str, dict[str, Callable[[Parts, list[complex]], Any]]] = {
    "rectangle square rounded_rectangle": {
        "width": lambda p, c: abs(c[1] - c[0]),
        "size": lambda p, c: abs(c[1] - c[0]),
        "height": lambda p, c: abs(c[3] - c[0]),
        "angle": lambda p, c: angle(c[1] - c[0]),
    },
    "rounded_rectangle": {"radius": lambda p, c: p["corner_top_left"]["radius"]},
    "trapezoid": {
        "height": lambda p, c: abs(c[2] + c[3] - c[0] - c[1]) / 2,
        "bottomwidth": lambda p, c: abs(c[1] - c[0]),
        "topwidth": lambda p, c: abs(c[3] - c[2]),
    },
    "regular_polygon": {
        "center": lambda p, c: _mean(p, "corner"),
        "radius": lambda p, c: abs(_mean(p, "corner") - p["corner[0]"]["at"]),
    },
    "star": {"center": lambda p, c: _mean(p, "tip")},
    "ring": {
        "center": lambda p, c: p["outer"]["center"],
        "outerradius": lambda p, c: p["outer"]["radius"],
        "innerradius": lambda p, c: p["inner"]["radius"],
    },
    "sector segment": {
        "center": lambda p, c: p["rim"]["center"],
        "radius": lambda p, c: p["rim"]["radius"],
    },
    "slot": {
        "center": lambda p, c: (p["start_cap"]["center"] + p["end_cap"]["center"]) / 2,
        "width": lambda p, c: 2 * p["end_cap"]["radius"],
        "length": lambda p, c: (
            abs(p["start_cap"]["center"] - p["end_cap"]["center"]) + 2 * p["end_cap"]["radius"]
        ),
    },
}

# --- Measures ----------------------------------------------------------------------------------------


def offset(p: complex, line: Any) -> float:
    """The signed distance of a point from an endless line, positive on its left."""
    a, b = ends(line)
    return cross(b - a, p - a) / abs(b - a)


def distance(a: Any, b: Any, along: Any = None) -> float:
    if along is not None:  # on a circle
        turn = abs(cmath.phase((middle(a) - middle(along)) / (middle(b) - middle(along))))
        return turn * float(field(along, "radius"))
    if is_line(a) and is_line(b):
        return abs(offset(field(b, "midpoint"), a))
    if is_line(a) or is_line(b):
        line, other = (a, b) if is_line(a) else (b, a)
        return abs(offset(middle(other), line))
    return abs(middle(a) - middle(b))


def corner_angle(a: Any, corner: Any, b: Any) -> Angle:
    """The angle at the middle of three points, counter-clockwise from one arm to the other."""
    p, c, q = (point(x) for x in (a, corner, b))
    return angle((q - c) * (p - c).conjugate())


def line(start: complex, end: complex) -> Geo:
    return Geo("line", "line", {"start": start, "end": end}, construction=True)


def mirrored(p: complex, about: Any) -> complex:
    """The image of a point in a line, a point, an axis by its letter, or the upright line at an x."""
    if isinstance(about, float | str):
        x = 0.0 if isinstance(about, str) else about
        about = line(complex(x, 0), 1 + 0j if about == "x" else complex(x, 1))
    if not is_line(about):
        return 2 * point(about) - p
    a, b = ends(about)
    return a + (b - a) * ((p - a) / (b - a)).conjugate()


def _angle(a: Any, b: Any = None, c: Any = None) -> Angle:
    if c is not None:
        return Angle(abs(corner_angle(a, b, c)))
    return Angle(field(a, "angle") if b is None else field(b, "angle") - field(a, "angle"))


def clearance(a: Any, b: Any) -> float:
    """The room between convex outlines: the widest strip that parts them, over all directions. Where they
    overlap every strip is of negative width, and the widest tells how far they must move to part.
    """
    if not (_is_convex(a) and _is_convex(b)):
        raise UnknownError("outlines that are not convex are measured on the finished drawing")

    def width(degrees: float) -> float:
        return -_reach(a, degrees) - _reach(b, degrees + 180)

    sampled = sorted(((width(i * 2), i * 2) for i in range(180)), reverse=True)
    return max(_peak(width, degrees - 2, degrees + 2) for _, degrees in sampled[:4])


def _reach(thing: Any, degrees: float) -> float:
    """How far a thing reaches in a direction, from the origin."""
    turn = turned(-degrees)
    return around(extremes(thing.turned(turn) if isinstance(thing, Geo) else thing * turn)).right


def _peak(function: Callable[[float], float], low: float, high: float) -> float:
    """The greatest value of a function with one peak between two places, by golden section."""
    share = (math.sqrt(5) - 1) / 2
    for _ in range(60):
        p, q = high - share * (high - low), low + share * (high - low)
        low, high = (p, high) if function(p) < function(q) else (low, q)
    return max(function(low), function(high))


_CONVEX = ("point", "line", "circle", "slot", "rectangle", "square", "rounded_rectangle", "regular_polygon")


def _is_convex(thing: Any) -> bool:
    if isinstance(thing, complex):
        return True
    if not isinstance(thing, Geo) or thing.type in _CONVEX:
        return isinstance(thing, Geo)
    edges = [e for e in thing.parts.values() if e.type != "point"]
    c = [e["start"] for e in edges if e.type == "line"]
    turns = {cross(c[i - 1] - c[i - 2], c[i] - c[i - 1]) > 0 for i in range(len(c))}
    return len(c) == len(edges) >= 3 and len(turns) == 1


# --- Gears: how far apart they stand, and that a tooth meets a gap -----------------------------------


def meshing(a: Geo, b: Geo, backlash: float = 0.0) -> list[float]:
    if a.type != "gear":
        a, b = b, a
    alike = [abs(a[n] - b[n]) for n in ("module", "pressure_angle")]
    apart = {"gear": _gears, "internal_gear": _in_ring, "rack": _on_rack}[b.type]
    return alike + apart(a, b, backlash)


def _pitch_radius(gear: Geo) -> float:
    return float(gear["teeth"] * gear["module"] / 2)


def _hub(gear: Geo) -> complex:
    return gear.parts["root[0]"]["center"]  # type: ignore[no-any-return]


def _tooth(gear: Geo, seen: float) -> float:
    """How many teeth lie between a direction and tooth 0."""
    tip = field(gear.parts["tooth[0]"].parts["tip"], "midpoint") - _hub(gear)
    return float((seen - angle(tip)) / 360)


def _off_gap(gear: Geo, teeth: float) -> float:
    """How far, along the pitch line, a number of pitches is from half a pitch."""
    return float(abs(teeth % 1 - 0.5) * math.pi * gear["module"])


def _gears(a: Geo, b: Geo, room: float) -> list[float]:
    way = _hub(b) - _hub(a)
    phase = _tooth(a, angle(way)) * a["teeth"] + _tooth(b, angle(-way)) * b["teeth"]
    apart = (_pitch_radius(a) + _pitch_radius(b)) * _widened(a, b) + room
    return [abs(abs(way) - apart), _off_gap(a, phase)]


def _widened(a: Geo, b: Geo) -> float:
    """Profile shifts move gears apart: the cosines of the pressure and the working angle, by bisection."""
    pressure = math.radians(b["pressure_angle"])
    shift = 2 * (a["profile_shift"] + b["profile_shift"]) / (a["teeth"] + b["teeth"])
    involute = math.tan(pressure) - pressure + shift * math.tan(pressure)
    low, high = 0.0, math.radians(80)
    for _ in range(80):
        half = (low + high) / 2
        low, high = (half, high) if math.tan(half) - half < involute else (low, half)
    return math.cos(pressure) / math.cos(low)


def _in_ring(a: Geo, b: Geo, room: float) -> list[float]:
    """A gear in a ring: `space`, what the ring leaves free, is a gear, and its tooth is the ring's gap."""
    space = b.parts["space"]
    way = _hub(a) - _hub(space)
    phase = _tooth(a, angle(way)) * a["teeth"] - _tooth(space, angle(way)) * b["teeth"]
    apart = _pitch_radius(b) - _pitch_radius(a) - room
    return [abs(abs(way) - apart), _off_gap(a, phase + 0.5)]


def _on_rack(a: Geo, b: Geo, room: float) -> list[float]:
    """A gear above a bar: its pitch circle on the bar's pitch line, one module below the tips."""
    first, last = ends(b.parts["tooth[0]"].parts["edges[1]"])
    along = (last - first) / abs(last - first)
    from_tip = _hub(a) - (first + last) / 2
    pitches = dot(along, from_tip) / (math.pi * a["module"])
    phase = _tooth(a, angle(along) - 90) * a["teeth"]
    wanted = _pitch_radius(a) - a["module"] + room
    return [abs(cross(along, from_tip) - wanted), _off_gap(a, pitches - phase)]


# --- Functions ---------------------------------------------------------------------------------------


def _near_whole(compute: Callable[[float], float]) -> Callable[[float], float]:
    return lambda x: type(x)(round(x)) if abs(x - round(x)) < 1e-9 * max(1, abs(x)) else type(x)(compute(x))


def items(value: Any) -> list[Any]:
    if isinstance(value, complex):
        return [value.real, value.imag]
    return [value[k] for k in sorted(value)] if isinstance(value, dict) else value  # type: ignore[no-any-return]


def _many(compute: Callable[[list[Any]], Any]) -> Callable[..., Any]:
    return lambda *values: compute(list(values) if len(values) > 1 else items(values[0]))


def _circumcenter(a: Any, b: Any, c: Any) -> complex:
    """Where the bisectors of two sides meet."""
    p, v, w = point(a), point(b) - point(a), point(c) - point(a)
    return p + 1j * (v * dot(w, w) - w * dot(v, v)) / (2 * cross(w, v))


def _gap(a: Any, b: Any) -> float:
    """The distance of two boxes; 0 when they touch or overlap."""
    p, q = box(a), box(b)
    dx = max(0.0, p.left - q.right, q.left - p.right)
    return math.hypot(dx, max(0.0, p.bottom - q.top, q.bottom - p.top))


def _spot(of: Any, x: float, y: float) -> complex:
    b = box(of)
    return complex(b.left * (1 - x) + b.right * x, b.bottom * (1 - y) + b.top * y)


def _edge_point(
    of: Any, x: float | None = None, side: str = "", y: float | None = None, along: float = 0.0
) -> complex:
    """A point of a circle."""
    c, r = middle(of), float(field(of, "radius"))
    if x is None and y is None:
        return c + turned(math.degrees(along / r), r)
    if x is not None:
        return complex(x, c.imag + (-1 if side == "bottom" else 1) * math.sqrt(r * r - (x - c.real) ** 2))
    assert y is not None
    return complex(c.real + (-1 if side == "left" else 1) * math.sqrt(r * r - (y - c.imag) ** 2), y)


def _choice(word: str, words: list[str]) -> str:
    """The word of a list that is meant."""
    return next(w for w in words if _plain(w) == _plain(word))


def _plain(word: str) -> str:
    return re.sub(r"[^a-z0-9.]", "", word.lower())


def _way(line: Any) -> complex:
    a, b = ends(line)
    return b - a


FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sin": lambda x: math.sin(math.radians(x)),
    "cos": lambda x: math.cos(math.radians(x)),
    "tan": lambda x: math.tan(math.radians(x)),
    "asin": lambda x: Angle(math.degrees(math.asin(x))),
    "acos": lambda x: Angle(math.degrees(math.acos(x))),
    "atan": lambda x: Angle(math.degrees(math.atan(x))),
    "atan2": lambda y, x: Angle(math.degrees(math.atan2(y, x))),
    "sqrt": math.sqrt,
    "abs": lambda x: type(x)(abs(x)),
    "square": lambda x: x * x,
    "hypot": math.hypot,
    "floor": _near_whole(math.floor),
    "ceil": _near_whole(math.ceil),
    "round": _near_whole(lambda x: math.floor(x + 0.5)),
    "radians": math.radians,
    "min": _many(min),
    "max": _many(max),
    "sum": _many(lambda values: sum(values[1:], values[0]) if values else 0.0),
    "len": lambda values: float(len(values)),
    "fixed": lambda value: value,
    "guess": lambda value: value,
    "written": lambda value: value,
    "polar": lambda radius, angle: turned(angle, radius),
    "norm": lambda v: abs(point(v)),
    "dot": lambda a, b: dot(point(a), point(b)),
    "cross": lambda a, b: cross(point(a), point(b)),
    "lerp": lambda a, b, t: a + (b - a) * t,
    "unit": lambda v: point(v) / abs(point(v)),
    "midpoint": lambda a, b=None: field(a, "midpoint") if b is None else (point(a) + point(b)) / 2,
    "turned": lambda v, angle: point(v) * turned(angle),
    "vector": _way,
    "direction": lambda line: _way(line) / abs(_way(line)),
    "distance": distance,
    "offsetfrom": lambda p, line: offset(point(p), line),
    "horizontaldistance": lambda a, b: abs((middle(b) - middle(a)).real),
    "verticaldistance": lambda a, b: abs((middle(b) - middle(a)).imag),
    "angle": _angle,
    "length": lambda of: field(of, "length"),
    "radius": lambda of: field(of, "radius"),
    "diameter": lambda of: 2 * field(of, "radius"),
    "clearance": clearance,
    "line": lambda start, end=None, length=None, angle=None: line(
        point(start), point(start) + turned(angle, length) if end is None else point(end)
    ),
    "verticalthrough": lambda p: line(middle(p), middle(p) + 1j),
    "horizontalthrough": lambda p: line(middle(p), middle(p) + 1),
    "linethrough": lambda p, angle: line(middle(p), middle(p) + turned(angle)),
    "between": lambda a, b, share=0.5: middle(a) + share * (middle(b) - middle(a)),
    "anchor": lambda of, place="center": box(of).spot(place),
    "spot": _spot,
    "edgepoint": _edge_point,
    "spots": lambda of, points: [_spot(of, point(p).real, point(p).imag) for p in points],
    "circumcenter": _circumcenter,
    "mirror": lambda x, about: mirrored(point(x), about),
    "range": lambda a, b=None, step=1.0: [
        float(i) for i in (range(int(a)) if b is None else range(int(a), int(b), int(step)))
    ],
    "enumerate": lambda values: [[float(i), v] for i, v in enumerate(items(values))],
    "zip": lambda *lists: [list(row) for row in zip(*map(items, lists), strict=True)],
    "reversed": lambda values: items(values)[::-1],
    "str": lambda value: value if isinstance(value, str) else f"{value:.10g}",
    "choice": _choice,
    "record": lambda **named: named,
    "nearest": lambda value, candidates: min(items(candidates), key=lambda c: abs(c - value)),
    "gap": lambda a, b: together(lambda: _gap(a, b)),
}

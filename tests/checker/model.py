"""The exported JSON as a tree of structures and geometry, in the frame of any structure; and its boxes.

Points are complex numbers, lengths millimetres, angles degrees.
"""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

T = TypeVar("T")


class UnknownError(Exception):
    """The document does not say what is needed."""


class Angle(float):
    """Degrees; two are the same a turn apart."""


def angle(v: complex) -> Angle:
    """The direction of a vector."""
    return Angle(math.degrees(cmath.phase(v)))


def turned(degrees: float, radius: float = 1.0) -> complex:
    return cmath.rect(radius, math.radians(degrees))


@dataclass(frozen=True)
class Frame:
    """Leads from its coordinates to those of the root; `flip` reflects x first."""

    turn: complex = 1
    flip: bool = False
    at: complex = 0

    def outward(self, z: complex) -> complex:
        return self.turn * (-z.conjugate() if self.flip else z) + self.at

    def inward(self, z: complex) -> complex:
        w = (z - self.at) / self.turn
        return -w.conjugate() if self.flip else w

    def inside(self, entry: dict[str, Any]) -> Frame:
        """The frame of a child, as the document tells it."""
        turn = turned(entry["rotation"])
        turn = self.turn * (turn.conjugate() if self.flip else turn)
        at = self.outward(complex(entry["x"], entry["y"]))
        return Frame(turn, self.flip != bool(entry.get("mirrored")), at)


# --- Boxes -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Box:
    left: float
    bottom: float
    right: float
    top: float

    @property
    def width(self) -> float:
        return self.right - self.left

    @property
    def height(self) -> float:
        return self.top - self.bottom

    @property
    def center_x(self) -> float:
        return (self.left + self.right) / 2

    @property
    def center_y(self) -> float:
        return (self.bottom + self.top) / 2

    @property
    def center(self) -> complex:
        return complex(self.center_x, self.center_y)

    def spot(self, place: str) -> complex:
        """`top_left`, `right_center` and their like."""
        words = place.split("_")
        x = self.left if "left" in words else self.right if "right" in words else self.center_x
        y = self.bottom if "bottom" in words else self.top if "top" in words else self.center_y
        return complex(x, y)


def around(points: Iterable[complex]) -> Box:
    found = list(points)
    if not found:
        raise UnknownError("nothing to bound")
    xs, ys = [p.real for p in found], [p.imag for p in found]
    return Box(min(xs), min(ys), max(xs), max(ys))


_used: list[Node] = []
_ignored: list[Node] = []


def together(measure: Callable[[], T]) -> T:
    """One comparison: a box used with the box of a descendant leaves that descendant out."""
    global _used, _ignored
    before = _used, _ignored
    try:
        _used, _ignored = [], []
        found = measure()
        if any(a is not b and a.within(b) for a in _used for b in _used):
            _used, _ignored = [], _used
            found = measure()
        return found
    finally:
        _used, _ignored = before


def extremes(thing: Any) -> Iterator[complex]:
    """Points whose box is that of a thing, holes and construction aside."""
    match thing:
        case complex():
            yield thing
        case Geo():
            for curve in thing.curves():
                yield from _EXTREMES[curve.type](curve)
        case Node():
            _used.append(thing)
            below = [n for n in _ignored if n is not thing and n.within(thing)]
            yield from thing.extremes(below)
        case list() | dict():
            for item in thing.values() if isinstance(thing, dict) else thing:
                yield from extremes(item)
        case _:
            raise TypeError(f"{type(thing).__name__} has no box")


class Boxed(list[Any]):
    """The common box of some things, not yet measured."""


def box(thing: Any) -> Box:
    return thing if isinstance(thing, Box) else around(extremes(thing))


def _arc(geo: Geo) -> Iterator[complex]:
    """The ends, and the quadrant points that the arc passes."""
    first, last = geo["start"], geo["end"]
    yield from (first, last)
    if geo["clockwise"]:
        first, last = last, first
    begin = angle(first - geo["center"])
    sweep = (angle(last - geo["center"]) - begin) % 360
    for quarter in (0, 90, 180, 270):
        if (quarter - begin) % 360 <= sweep:
            yield geo["center"] + turned(quarter, geo["radius"])


def _ellipse(geo: Geo) -> Iterator[complex]:
    along = [turned(geo["angle"], geo["rx"]), turned(geo["angle"] + 90, geo["ry"])]
    reach = complex(math.hypot(*(v.real for v in along)), math.hypot(*(v.imag for v in along)))
    yield from (geo["center"] - reach, geo["center"] + reach)


def _bezier(geo: Geo) -> Iterator[complex]:
    """The ends, and the points where the derivative of a coordinate is 0."""
    p = np.array(geo["points"])
    cubic = np.poly1d(
        [p[3] - 3 * p[2] + 3 * p[1] - p[0], 3 * (p[2] - 2 * p[1] + p[0]), 3 * (p[1] - p[0]), p[0]]
    )
    yield from (geo["points"][0], geo["points"][3])
    for axis in (cubic.coef.real, cubic.coef.imag):
        for t in np.roots(np.polyder(axis)):
            if abs(t.imag) < 1e-12 and 0 < t.real < 1:
                yield complex(cubic(t.real))


_EXTREMES: dict[str, Callable[[Geo], Iterable[complex]]] = {
    "point": lambda geo: [geo["at"]],
    "line": lambda geo: [geo["start"], geo["end"]],
    "circle": lambda geo: [geo["center"] + s * geo["radius"] for s in (-1 - 1j, 1 + 1j)],
    "arc": _arc,
    "ellipse": _ellipse,
    "bezier": _bezier,
}

# --- The tree --------------------------------------------------------------------------------------


@dataclass(eq=False)
class Geo:
    """A geometry: `data` are its fields as the structure that looks sees them, `parts` those of a shape."""

    path: str
    type: str
    data: dict[str, Any]
    parts: dict[str, Geo] = field(default_factory=dict)
    construction: bool = False

    def __getitem__(self, name: str) -> Any:
        return self.data[name]

    def curves(self) -> Iterator[Geo]:
        if not self.parts:
            yield self
        for part in self.parts.values():
            if part.type != "point" and (self.construction or not part.construction):
                yield from part.curves()

    def turned(self, by: complex) -> Geo:
        """The same about the origin, but for ellipses."""
        data = {n: v * by if isinstance(v, complex) else v for n, v in self.data.items()}
        if self.type == "bezier":
            data["points"] = [p * by for p in self["points"]]
        parts = {n: part.turned(by) for n, part in self.parts.items()}
        return Geo(self.path, self.type, data, parts, self.construction)

    def all(self) -> Iterator[Geo]:
        yield self
        for part in self.parts.values():
            yield from part.all()


@dataclass(eq=False)
class Node:
    """A structure, with the points in its empty box."""

    name: str
    path: str
    kind: str
    parent: Node | None
    params: dict[str, Any]
    bb: dict[str, float] | None
    plan: list[complex]
    origin: complex
    axes: tuple[complex, complex]
    geometry: dict[str, Geo] = field(default_factory=dict)
    children: dict[str, Node] = field(default_factory=dict)

    def within(self, other: Node) -> bool:
        return self is other or (self.parent is not None and self.parent.within(other))

    def walk(self) -> Iterator[Node]:
        yield self
        for child in self.children.values():
            yield from child.walk()

    def extremes(self, ignored: list[Node]) -> Iterator[complex]:
        yield from self.plan
        for geo in self.geometry.values():
            if geo.type != "point" and not geo.construction:
                yield from extremes(geo)
        for child in self.children.values():
            if child.kind != "hole" and child not in ignored:
                yield from child.extremes(ignored)


_INDEX = re.compile(r"\[(-?\d+)\]")


def named(things: dict[str, Any], name: str) -> Any:
    """What has a name, spelt alike; `finger[0]` and its like are a dictionary of their indices, or None."""
    for known, thing in things.items():
        if fold(known) == fold(name):
            return thing
    members: dict[int, Any] = {}
    for known, thing in things.items():
        if fold(known.partition("[")[0]) == fold(name):
            here, indices = members, [int(i) for i in _INDEX.findall(known)]
            for index in indices[:-1]:
                here = here.setdefault(index, {})
            here[indices[-1]] = thing
    return members or None


def fold(name: str) -> str:
    """Spellings that mean the same name."""
    return name.replace("_", "").lower()


def read(document: dict[str, Any], path: str | None = None) -> Node:
    """The root of a document in the frame of one of its structures, or in its own."""
    root = Frame().inside(document["root"]["frame"])
    frames = dict(_frames(document["root"], Frame()))
    return _node(document["root"], None, root, Frame() if path is None else frames[path])


def _frames(entry: dict[str, Any], outer: Frame) -> Iterator[tuple[str, Frame]]:
    own = outer.inside(entry["frame"])
    yield entry["path"], own
    for child in entry["structures"]:
        yield from _frames(child, own)


def _node(entry: dict[str, Any], parent: Node | None, own: Frame, seen: Frame) -> Node:
    bb = entry["bb"]
    origin, *tips = (seen.inward(own.outward(z)) for z in (0j, 1 + 0j, 1j))
    corners = [complex(bb[x], bb[y]) for x in ("left", "right") for y in ("bottom", "top")] if bb else []
    node = Node(
        entry["name"],
        entry["path"],
        entry["kind"],
        parent,
        entry["params"],
        None if entry.get("empty") else bb,
        [seen.inward(z) for z in corners] if entry.get("empty") else [],
        origin,
        (tips[0], tips[1]),
    )
    node.geometry = {n: _geo(f"{node.path}.{n}", g, seen) for n, g in entry["geometry"].items()}
    for child in entry["structures"]:
        node.children[child["name"]] = _node(child, node, own.inside(child["frame"]), seen)
    return node


def _geo(path: str, entry: dict[str, Any], seen: Frame) -> Geo:
    def look(value: Any) -> Any:
        is_point = isinstance(value, list) and len(value) == 2 and isinstance(value[0], float | int)
        return seen.inward(complex(*value)) if is_point else value

    data = {n: look(v) for n, v in {**entry, **entry.get("params", {})}.items()}
    if entry["type"] == "bezier":
        data["points"] = [look(p) for p in entry["points"]]
    elif entry["type"] == "arc":
        data["clockwise"] = bool(entry.get("clockwise")) != seen.flip
    elif entry["type"] == "ellipse":
        data["angle"] = angle(seen.inward(turned(entry["angle"])) - seen.inward(0j))
    parts = {n: _geo(f"{path}.{n}", g, seen) for n, g in entry.get("parts", {}).items()}
    return Geo(path, entry["type"], data, parts, bool(entry.get("construction")))

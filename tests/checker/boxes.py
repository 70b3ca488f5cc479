"""Tight boxes of curves in any frame, by sampling no curve: extremes are computed in closed form."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass

from tests.checker.tree import Geo, Node, Transform, Vec


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
    def center(self) -> Vec:
        return self.center_x, self.center_y

    def corner(self, name: str) -> Vec | None:
        """`top_left` … `bottom_right`, `top_center` … `right_center`."""
        for word, x in (("left", self.left), ("right", self.right), ("center", self.center_x)):
            for other, y in (("top", self.top), ("bottom", self.bottom), ("center", self.center_y)):
                if word != other and name in (f"{other}_{word}", f"{word}_{other}"):
                    return x, y
        return None


class NoBoxError(Exception):
    """There is nothing to bound."""


def around(points: Iterable[Vec]) -> Box:
    found = list(points)
    if not found:
        raise NoBoxError
    xs, ys = zip(*found, strict=True)
    return Box(min(xs), min(ys), max(xs), max(ys))


def extremes(geo: Geo, frame: Transform) -> Iterator[Vec]:
    """Points of the curves of a geometry, in `frame`, whose box is the box of the curves."""
    if geo.type == "point":
        yield frame.inward(tuple(geo.data["at"]))
    for curve in geo.curves(even_construction=True):
        yield from _EXTREMES[curve.type](curve, frame)


def structure_extremes(node: Node, frame: Transform, ignored: Collection[Node] = ()) -> Iterator[Vec]:
    """Points of a structure and of its children, holes and the `ignored` ones aside."""
    if node.is_empty:
        bb = node.entry["bb"]
        for x in (bb["left"], bb["right"]):
            for y in (bb["bottom"], bb["top"]):
                yield frame.inward((x, y))
    for geo in node.geometry.values():
        if geo.type != "point" and not geo.construction:
            yield from extremes(geo, frame)
    for child in node.children.values():
        if child.kind != "hole" and child not in ignored:
            yield from structure_extremes(child, frame, ignored)


def _line(geo: Geo, frame: Transform) -> Iterator[Vec]:
    yield frame.inward(tuple(geo.data["start"]))
    yield frame.inward(tuple(geo.data["end"]))


def _circle(geo: Geo, frame: Transform) -> Iterator[Vec]:
    (x, y), r = frame.inward(tuple(geo.data["center"])), geo.data["radius"]
    yield x - r, y - r
    yield x + r, y + r


def _arc(geo: Geo, frame: Transform) -> Iterator[Vec]:
    """The ends, and the quadrant points that the arc passes."""
    center, r = frame.inward(tuple(geo.data["center"])), geo.data["radius"]
    first, last = (frame.inward(tuple(geo.data[e])) for e in ("start", "end"))
    yield first
    yield last
    if bool(geo.data.get("clockwise")) != frame.is_mirrored:
        first, last = last, first
    begin = math.atan2(first[1] - center[1], first[0] - center[0])
    sweep = (math.atan2(last[1] - center[1], last[0] - center[0]) - begin) % math.tau
    for quarter in range(4):
        angle = quarter * math.pi / 2
        if (angle - begin) % math.tau <= sweep:
            yield center[0] + r * math.cos(angle), center[1] + r * math.sin(angle)


def _ellipse(geo: Geo, frame: Transform) -> Iterator[Vec]:
    center = tuple(geo.data["center"])
    turn = math.radians(geo.data["angle"])
    x, y = frame.inward(center)
    ends = []
    for radius, angle in ((geo.data["rx"], turn), (geo.data["ry"], turn + math.pi / 2)):
        tip = frame.inward((center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle)))
        ends.append((tip[0] - x, tip[1] - y))
    dx, dy = (math.hypot(ends[0][i], ends[1][i]) for i in (0, 1))
    yield x - dx, y - dy
    yield x + dx, y + dy


def _bezier(geo: Geo, frame: Transform) -> Iterator[Vec]:
    """The ends, and the points where the derivative of a coordinate is 0."""
    p = [frame.inward(tuple(q)) for q in geo.data["points"]]
    for t in (0.0, 1.0, *_turning(p, 0), *_turning(p, 1)):
        u = 1 - t
        weights = (u**3, 3 * u * u * t, 3 * u * t * t, t**3)
        x, y = (sum(w * q[i] for w, q in zip(weights, p, strict=True)) for i in (0, 1))
        yield x, y


def _turning(p: list[Vec], axis: int) -> Iterator[float]:
    """Parameters between 0 and 1 at which a cubic's coordinate neither rises nor falls."""
    d = [p[i + 1][axis] - p[i][axis] for i in range(3)]
    a, b, c = d[0] - 2 * d[1] + d[2], 2 * (d[1] - d[0]), d[0]
    if abs(a) < 1e-14 * max(map(abs, d), default=0.0):
        roots = [-c / b] if b else []
    else:
        inside = b * b - 4 * a * c
        roots = [] if inside < 0 else [(-b + s * math.sqrt(inside)) / (2 * a) for s in (1, -1)]
    yield from (t for t in roots if 0 < t < 1)


_EXTREMES = {"line": _line, "circle": _circle, "arc": _arc, "ellipse": _ellipse, "bezier": _bezier}

"""The exported JSON as a tree of structures and geometry, and the frames in it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

Vec = tuple[float, float]
_INDEX = re.compile(r"\[(-?\d+)\]")


@dataclass(frozen=True)
class Transform:
    """Coordinates of a frame → of the root: an orthogonal matrix [[a, b], [c, d]] and an offset."""

    a: float = 1.0
    b: float = 0.0
    c: float = 0.0
    d: float = 1.0
    x: float = 0.0
    y: float = 0.0

    @staticmethod
    def of(frame: dict[str, Any]) -> Transform:
        turn = math.radians(frame["rotation"])
        flip = -1.0 if frame.get("mirrored") else 1.0
        c, s = math.cos(turn), math.sin(turn)
        return Transform(c * flip, -s, s * flip, c, frame["x"], frame["y"])

    @property
    def is_mirrored(self) -> bool:
        return self.a * self.d - self.b * self.c < 0

    def outward(self, p: Vec) -> Vec:
        return self.a * p[0] + self.b * p[1] + self.x, self.c * p[0] + self.d * p[1] + self.y

    def inward(self, p: Vec) -> Vec:
        u, v = p[0] - self.x, p[1] - self.y
        return self.a * u + self.c * v, self.b * u + self.d * v

    def then(self, outer: Transform) -> Transform:
        """This frame, seen through the frame around it."""
        ox, oy = outer.outward((self.x, self.y))
        return Transform(
            outer.a * self.a + outer.b * self.c,
            outer.a * self.b + outer.b * self.d,
            outer.c * self.a + outer.d * self.c,
            outer.c * self.b + outer.d * self.d,
            ox,
            oy,
        )


@dataclass(eq=False)
class Geo:
    """A geometry: `data` are its fields in the root frame; `parts` those of a compound shape.

    Set by the walk over the program: `source` are the names inside an instance of a shape, `written` is the
    statement that defines it, and `is_edited` tells of a statement that moves, turns or scales it.
    """

    name: str
    path: str
    type: str
    data: dict[str, Any]
    parts: dict[str, Geo]
    construction: bool
    source: Any = None
    written: Any = None
    is_edited: bool = False
    _members: dict[str, Any] | None = None

    def members(self) -> dict[str, Any]:
        if self._members is None:
            self._members = gathered(self.parts)
        return self._members

    def curves(self, *, even_construction: bool = False) -> Iterator[Geo]:
        if self.construction and not even_construction:
            return
        if self.type != "point" and not self.parts:
            yield self
        for part in self.parts.values():
            yield from part.curves(even_construction=self.construction)


@dataclass(eq=False)
class Node:
    """A structure. `world` leads from its frame to the root's, `local` to the parent's.

    Set by the walk over the program: `env` are the names its body sees, `placed` is its placement, and
    `is_edited` tells of a statement that moves, turns or scales it.
    """

    name: str
    path: str
    kind: str
    world: Transform
    local: Transform
    entry: dict[str, Any]
    parent: Node | None
    geometry: dict[str, Geo] = field(default_factory=dict)
    children: dict[str, Node] = field(default_factory=dict)
    env: Any = None
    placed: Any = None
    is_edited: bool = False
    _members: dict[str, Any] | None = None

    @property
    def is_empty(self) -> bool:
        return bool(self.entry.get("empty"))

    def members(self) -> dict[str, Any]:
        if self._members is None:
            self._members = gathered({**self.geometry, **self.children})
        return self._members

    def within(self, other: Node) -> bool:
        here: Node | None = self
        while here is not None and here is not other:
            here = here.parent
        return here is other

    def walk(self) -> Iterator[Node]:
        yield self
        for child in self.children.values():
            yield from child.walk()


@dataclass
class Array:
    """Members by index; a sparse array has gaps. `pattern` is set where a pattern made them."""

    items: dict[int, Any]
    pattern: Any = None

    def list(self) -> list[Any]:
        return [self.items[i] for i in sorted(self.items)]


def gathered(named: dict[str, Any]) -> dict[str, Any]:
    """Names to things, `finger[3]` and its like gathered in arrays."""
    found: dict[str, Any] = {}
    for name, thing in named.items():
        base, _, _ = name.partition("[")
        indices = [int(i) for i in _INDEX.findall(name)]
        if not indices:
            found[name] = thing
            continue
        array = found.setdefault(base, Array({}))
        for index in indices[:-1]:
            array = array.items.setdefault(index, Array({}))
        array.items[indices[-1]] = thing
    return found


def read(document: dict[str, Any]) -> Node:
    """The root of a document."""
    return _node(document["root"], None)


def _node(entry: dict[str, Any], parent: Node | None) -> Node:
    local = Transform.of(entry["frame"])
    world = local if parent is None else local.then(parent.world)
    node = Node(entry["name"], entry["path"], entry["kind"], world, local, entry, parent)
    node.geometry = {n: _geo(n, node.path, g) for n, g in entry["geometry"].items()}
    node.children = {c["name"]: _node(c, node) for c in entry["structures"]}
    return node


def _geo(name: str, holder: str, entry: dict[str, Any]) -> Geo:
    path = f"{holder}.{name}"
    parts = {n: _geo(n, path, g) for n, g in entry.get("parts", {}).items()}
    return Geo(name, path, entry["type"], entry, parts, bool(entry.get("construction")))

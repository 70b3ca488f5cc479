"""Sketches: problems made around a solution that is known.

A `Sketch` says where everything is when all links hold, and how far from there it is written. The value that
a link is asked to have is the one that it has at the solution, so that any choice of links can be met.
Sketches print as what one would type to build them again.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import TypeAlias

import numpy as np

from aidl_lang.solver import Problem

from .build import E, Model, call
from .check import values_of
from .kinds import KINDS, OPPOSITE, Place

Vector: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class Point:
    """`at` solves the problem, `off` is how far from there it is written; in the frame of its group."""

    at: Vector
    off: Vector = (0.0, 0.0)
    group: int = 0


@dataclass(frozen=True)
class Circle:
    center: int
    radius: float
    off: float = 0.0
    kept: bool = False


@dataclass(frozen=True)
class Group:
    """Where the frame is in that of the parent. The first of a sketch is group 1; the root is group 0."""

    parent: int
    at: Vector = (0.0, 0.0)
    off: Vector = (0.0, 0.0)


@dataclass(frozen=True)
class Link:
    """`on` are points and circles, as the kind wants them. An inequality leaves some `room` at the known
    solution; what has an `excess` does not hold there."""

    kind: str
    on: tuple[int, ...]
    holder: int = 0
    sense: str = "="
    room: float = 0.0
    excess: float = 0.0
    weight: float | None = None
    placed: bool = False


@dataclass(frozen=True)
class Built:
    """The sketch as the solver wants it, and the solution (n,) that it was made around."""

    problem: Problem
    known: np.ndarray


@dataclass(frozen=True)
class Sketch:
    points: tuple[Point, ...] = ()
    circles: tuple[Circle, ...] = ()
    groups: tuple[Group, ...] = ()
    links: tuple[Link, ...] = ()
    unit: float = 1.0
    """What the solver is told is a typical length."""

    def build(self) -> Built:
        """The problem; its unknowns are the sketch's coordinates: points, radii, frames."""
        return _Builder(self).built()

    def problem(self) -> Problem:
        return self.build().problem

    def path(self, group: int) -> Iterator[int]:
        """The group and those that it is in."""
        while group > 0:
            yield group
            group = self.groups[group - 1].parent
        yield 0

    def world(self, point: int) -> Vector:
        """Where the point is in the solution, in the root's frame."""
        at, group = self.points[point].at, self.points[point].group
        frames = [self.groups[g - 1].at for g in self.path(group) if g > 0]
        return at[0] + sum(f[0] for f in frames), at[1] + sum(f[1] for f in frames)

    def anchors(self, link: Link) -> list[int]:
        """The points and centres that it is about."""
        letters = KINDS[link.kind].operands
        return [self.circles[i].center if c == "c" else i for c, i in zip(letters, link.on, strict=True)]

    def is_sound(self, link: Link) -> bool:
        """Whether what it measures is smooth near the solution."""
        at = [self.world(i) for i in self.anchors(link)]
        if any(math.dist(at[i], at[j]) < 1e-3 * self.unit for i, j in KINDS[link.kind].apart):
            return False
        if link.kind == "arc_length":
            start, end = (math.atan2(p[1] - at[0][1], p[0] - at[0][0]) for p in at[1:])
            return 0.5 < (end - start) % (2.0 * math.pi) < 2.0 * math.pi - 0.5
        return True

    # -- the same in other words

    def moved(self, matrix: np.ndarray) -> Sketch:
        """The plane mapped by a similarity. Relations must be of kinds that this leaves what they are."""
        factor = math.sqrt(abs(float(np.linalg.det(matrix))))
        mirrored = float(np.linalg.det(matrix)) < 0.0

        def turned(v: Vector) -> Vector:
            x, y = (matrix @ np.array(v)).tolist()
            return x, y

        def linked(link: Link) -> Link:
            kind, sense = KINDS[link.kind], link.sense
            if mirrored and kind.mirrored < 0:
                sense = OPPOSITE[sense]
            return replace(link, sense=sense, room=link.room * factor if kind.length else link.room)

        return replace(
            self,
            points=tuple(replace(p, at=turned(p.at), off=turned(p.off)) for p in self.points),
            circles=tuple(replace(c, radius=c.radius * factor, off=c.off * factor) for c in self.circles),
            groups=tuple(replace(g, at=turned(g.at), off=turned(g.off)) for g in self.groups),
            links=tuple(map(linked, self.links)),
            unit=self.unit * factor,
        )

    def beside(self, other: Sketch) -> Sketch:
        """Both, without anything in common but the root."""
        points, circles, groups = len(self.points), len(self.circles), len(self.groups)

        def shifted(group: int) -> int:
            return group + groups if group else 0

        def linked(link: Link) -> Link:
            letters = KINDS[link.kind].operands
            on = tuple(i + (circles if c == "c" else points) for c, i in zip(letters, link.on, strict=True))
            return replace(link, on=on, holder=shifted(link.holder))

        return Sketch(
            self.points + tuple(replace(p, group=shifted(p.group)) for p in other.points),
            self.circles + tuple(replace(c, center=c.center + points) for c in other.circles),
            self.groups + tuple(replace(g, parent=shifted(g.parent)) for g in other.groups),
            self.links + tuple(map(linked, other.links)),
            self.unit,
        )

    def halves(self, first: Sketch) -> tuple[np.ndarray, np.ndarray]:
        """Which coordinates of `first.beside(second)` belong to either."""
        counts = [
            (2, self.points, first.points),
            (1, self.circles, first.circles),
            (2, self.groups, first.groups),
        ]
        mine = np.concatenate(
            [np.arange(size * len(every)) < size * len(some) for size, every, some in counts]
        )
        return np.flatnonzero(mine), np.flatnonzero(~mine)

    def flipped(self) -> Sketch:
        """x and y in each other's place."""
        mirrored = self.moved(np.array([[0.0, 1.0], [1.0, 0.0]]))

        def linked(link: Link, before: Link) -> Link:
            name = KINDS[link.kind].swapped
            return replace(link, kind=name, sense=before.sense) if name else link

        return replace(mirrored, links=tuple(map(linked, mirrored.links, self.links)))

    def placed_at(self, coordinates: np.ndarray) -> Sketch:
        """Solved and written at these coordinates."""
        left = iter(coordinates.tolist())
        return replace(
            self,
            points=tuple(replace(p, at=(next(left), next(left)), off=(0.0, 0.0)) for p in self.points),
            circles=tuple(replace(c, radius=next(left), off=0.0) for c in self.circles),
            groups=tuple(replace(g, at=(next(left), next(left)), off=(0.0, 0.0)) for g in self.groups),
        )

    def with_links(self, links: Iterable[Link]) -> Sketch:
        """Further links, as far as they are sound."""
        return replace(self, links=self.links + tuple(link for link in links if self.is_sound(link)))

    def within(self) -> Sketch:
        """All of it in a group of its own below the root, whose frame is not moved by anything."""
        return Sketch(
            tuple(replace(p, group=p.group + 1) for p in self.points),
            self.circles,
            (Group(0), *(replace(g, parent=g.parent + 1) for g in self.groups)),
            tuple(replace(r, holder=r.holder + 1) for r in self.links),
            self.unit,
        )


class _Builder:
    def __init__(self, sketch: Sketch) -> None:
        self.sketch, self.model = sketch, Model()
        m = self.model
        for group in sketch.groups:
            m.group(group.parent)
        entries: list[tuple[float, float, dict[str, object]]] = []
        for p in sketch.points:
            entries.extend((p.at[i], p.off[i], {"group": p.group}) for i in (0, 1))
        for c in sketch.circles:
            group = sketch.points[c.center].group
            entries.append((c.radius, c.off, {"group": group, "kept": c.kept}))
        for child, g in enumerate(sketch.groups, 1):
            entries.extend((g.at[i], g.off[i], {"group": g.parent, "frame": child}) for i in (0, 1))
        self.unknowns = [m.unknown(at + off, scale=sketch.unit, **more) for at, off, more in entries]
        self.known = np.array([at for at, _, _ in entries], dtype=np.float64)

    def point(self, index: int, holder: int = 0) -> Place:
        """As seen from the holder."""
        sketch = self.sketch
        x, y = self.unknowns[2 * index], self.unknowns[2 * index + 1]
        frames = 2 * len(sketch.points) + len(sketch.circles)
        for group in sketch.path(sketch.points[index].group):
            if group == holder:
                break
            at = frames + 2 * (group - 1)
            x, y = x + self.unknowns[at], y + self.unknowns[at + 1]
        return x, y

    def measures(self, link: Link) -> tuple[E, ...]:
        kind, radii = KINDS[link.kind], self.unknowns[2 * len(self.sketch.points) :]
        places = [self.point(i, link.holder) for i in self.sketch.anchors(link)]
        operands = [
            (place, radii[i]) if letter == "c" else place
            for letter, place, i in zip(kind.operands, places, link.on, strict=True)
        ]
        measured = kind.measure(*operands)
        return (measured,) if isinstance(measured, E) else measured

    def built(self) -> Built:
        m, sketch = self.model, self.sketch
        measures = [self.measures(link) for link in sketch.links]
        tape = SimpleNamespace(tape=m.builder.finish())
        wanted = iter(values_of(tape, [e.node for es in measures for e in es], self.known).tolist())
        for link, measured in zip(sketch.links, measures, strict=True):
            self.tie(link, [e - next(wanted) for e in measured])
        for index in range(len(sketch.points)):
            m.observe(sketch.points[index].group, *self.point(index))
        return Built(m.problem(), self.known)

    def tie(self, link: Link, residuals: list[E]) -> None:
        kind, m = KINDS[link.kind], self.model
        scale = self.sketch.unit if kind.length else 1.0
        if link.excess:
            residuals = [e - link.excess for e in residuals]
        if kind.turn:
            residuals = [call("atan2", call("sin", e), call("cos", e)) for e in residuals]
        first = self.sketch.anchors(link)[:1] if link.placed else []
        placed = [self.unknowns[2 * point + axis] for point in first for axis in (0, 1)]
        if link.sense == "=":
            m.equal(*residuals, group=link.holder, placed=placed, scale=scale, weight=link.weight)
        else:
            sign = 1.0 if link.sense == "<=" else -1.0
            residuals = [e * sign - link.room for e in residuals]
            m.at_most(*residuals, group=link.holder, placed=placed, scale=scale, weight=link.weight)

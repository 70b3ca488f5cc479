"""A sketch as a `Problem` of AIDL's solver: all in one group, every unknown free.

What a sketch leaves open (the side of a line, the sense of an angle, which of two circles is the larger) is
read from the first guess and kept, so that residuals are smooth. Lengths have a scale of a millimetre, and
the tolerance is below that of the judge.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from aidl_lang.solver import Problem, Settings, Solution, solve
from aidl_lang.solver.analysis import analyse
from aidl_lang.solver.expression import TapeBuilder
from aidl_lang.solver.problem import Rows
from aidl_lang.version import __version__
from benchmarks.solver.contestant import Contestant
from benchmarks.solver.sketch import Constraint, Sketch

Node: TypeAlias = int
Vector: TypeAlias = tuple[Node, Node]

SETTINGS = Settings(tolerance=1e-8, seconds=600.0)
"""The benchmark has its own limits of time."""


@dataclass
class Attempt:
    """One run."""

    problem: Problem
    solution: Solution[Problem] | None = None


class Ours(Contestant):
    """AIDL's solver."""

    version = __version__

    def build(self, sketch: Sketch) -> Attempt:
        return Attempt(problem_of(sketch))

    def solve(self, built: Attempt) -> str:
        built.solution = solve(built.problem, SETTINGS)
        return built.solution.status.value

    def analyse(self, built: Attempt) -> bool:
        assert built.solution is not None
        analyse(built.solution)
        return True

    def read(self, built: Attempt) -> list[float]:
        assert built.solution is not None
        values: list[float] = built.solution.values.tolist()
        return values


def problem_of(sketch: Sketch) -> Problem:
    """Raises KeyError for a type of constraint that the format does not have."""
    tape = TapeBuilder()
    writer = _Writer(sketch, tape)
    residuals = [_RESIDUALS[c["t"]](_Fields(writer, c)) for c in sketch.constraints]
    residuals += [_arc(writer, *arc) for arc in sketch.arcs]
    expressions = [node for nodes in residuals for node in nodes]
    n, count = sketch.unknowns, len(residuals)
    return Problem(
        tape=tape.finish(),
        initial=sketch.start,
        scale=np.ones(n),
        kept=np.zeros(n, dtype=np.bool_),
        group=np.zeros(n, dtype=np.int64),
        frame_of=np.full(n, -1, dtype=np.int64),
        parent=np.array([-1], dtype=np.int64),
        rows=Rows(
            np.array(expressions, dtype=np.int64),
            np.zeros(len(expressions), dtype=np.bool_),
            np.ones(len(expressions)),
            np.repeat(np.arange(count), [len(nodes) for nodes in residuals]),
        ),
        holder=np.zeros(count, dtype=np.int64),
        weight=np.full(count, np.nan),
        placed=np.zeros((2, 0), dtype=np.int64),
        whole=np.zeros((2, 0), dtype=np.int64),
        inside=np.zeros((2, 0), dtype=np.int64),
        observables=tuple((0, node) for node in writer.unknowns),
    )


class _Writer:
    """Puts the geometry of a sketch on the tape. `guess` are the first guesses."""

    def __init__(self, sketch: Sketch, tape: TapeBuilder) -> None:
        self.sketch, self.tape = sketch, tape
        self.unknowns = [tape.unknown(i) for i in range(sketch.unknowns)]

    def point(self, index: int) -> Vector:
        return self.unknowns[2 * index], self.unknowns[2 * index + 1]

    def minus(self, a: Vector, b: Vector) -> Vector:
        return self.tape.sub(a[0], b[0]), self.tape.sub(a[1], b[1])

    def middle(self, a: Vector, b: Vector) -> Vector:
        tape, half = self.tape, self.tape.constant(0.5)
        return tape.mul(half, tape.add(a[0], b[0])), tape.mul(half, tape.add(a[1], b[1]))

    def length(self, u: Vector) -> Node:
        return self.tape.hypot(*u)

    def dot(self, u: Vector, v: Vector) -> Node:
        return self.tape.add(self.tape.mul(u[0], v[0]), self.tape.mul(u[1], v[1]))

    def cross(self, u: Vector, v: Vector) -> Node:
        return self.tape.sub(self.tape.mul(u[0], v[1]), self.tape.mul(u[1], v[0]))

    def sine(self, u: Vector, v: Vector) -> Node:
        return self.tape.div(self.cross(u, v), self.tape.mul(self.length(u), self.length(v)))

    def cosine(self, u: Vector, v: Vector) -> Node:
        return self.tape.div(self.dot(u, v), self.tape.mul(self.length(u), self.length(v)))

    def turned(self, u: Vector, angle: float) -> Vector:
        """A vector turned counterclockwise by radians."""
        tape, c, s = self.tape, self.tape.constant(math.cos(angle)), self.tape.constant(math.sin(angle))
        return (
            tape.sub(tape.mul(c, u[0]), tape.mul(s, u[1])),
            tape.add(tape.mul(s, u[0]), tape.mul(c, u[1])),
        )

    def between(self, u: Vector, v: Vector) -> Node:
        """The angle from u to v in (-π, π], smooth except where they are opposite."""
        return self.tape.atan2(self.cross(u, v), self.dot(u, v))

    def times(self, factor: float, a: Node) -> Node:
        return self.tape.mul(self.tape.constant(factor), a)


class _Fields:
    """One constraint: its fields on the tape, and what the first guess says of them."""

    def __init__(self, writer: _Writer, constraint: Constraint) -> None:
        self.writer, self.tape, self._constraint = writer, writer.tape, constraint
        self._sketch = writer.sketch

    def get(self, name: str, default: Any = None) -> Any:
        return self._constraint.get(name, default)

    def number(self, name: str) -> Node:
        return self.tape.constant(self._constraint[name])

    def point(self, name: str) -> Vector:
        return self.writer.point(self._constraint[name])

    def ends(self, line: str) -> tuple[Vector, Vector]:
        a, b = self._sketch.lines[self._constraint[line]]
        return self.writer.point(a), self.writer.point(b)

    def vector(self, line: str) -> Vector:
        a, b = self.ends(line)
        return self.writer.minus(b, a)

    def length(self, line: str) -> Node:
        return self.writer.length(self.vector(line))

    def offset(self, place: Vector, line: str) -> Node:
        """The distance of a place from a line, positive on the left."""
        along, across = self.vector(line), self.writer.minus(place, self.ends(line)[0])
        return self.tape.div(self.writer.cross(along, across), self.writer.length(along))

    def centre(self, curve: str) -> Vector:
        return self.writer.point(self._sketch.curve_points(self._constraint[curve])[0])

    def radius(self, curve: str) -> Node:
        kind, index = self._constraint[curve][0], int(self._constraint[curve][1])
        if kind == "c":
            return self.writer.unknowns[2 * len(self._sketch.points) + index]
        centre, start = map(self.writer.point, self._sketch.arcs[index][:2])
        return self.writer.length(self.writer.minus(start, centre))

    def spoke(self, arc: str, end: str) -> Vector:
        points = self._sketch.arcs[self._constraint[arc]]
        at = points[2 if self._constraint[end] else 1]
        return self.writer.minus(self.writer.point(at), self.writer.point(points[0]))

    def arc_length(self) -> Node:
        """Of the arc: the angle from start to end, smooth within (0, 2π), times the radius."""
        centre, start, end = map(self.writer.point, self._sketch.arcs[self._constraint["arc"]])
        first, last = self.writer.minus(start, centre), self.writer.minus(end, centre)
        backward = self.writer.between(first, (self.tape.neg(last[0]), self.tape.neg(last[1])))
        return self.tape.mul(self.tape.add(self.tape.constant(math.pi), backward), self.writer.length(first))

    # -- the first guess

    def side(self, point: int, line: str) -> float:
        """1 if a point is first guessed to the left of a line or on it, else -1."""
        points = self._sketch.points
        (ax, ay), (bx, by) = (points[end] for end in self._sketch.lines[self._constraint[line]])
        px, py = points[point]
        return 1.0 if (bx - ax) * (py - ay) >= (by - ay) * (px - ax) else -1.0

    def heading(self, line: str) -> float:
        """The first guess of the direction of a line in radians."""
        (ax, ay), (bx, by) = (self._sketch.points[i] for i in self._sketch.lines[self._constraint[line]])
        return math.atan2(by - ay, bx - ax)

    def turn(self, line: str, to: str) -> float:
        """The first guess of the angle between two lines, in [-π, π]."""
        return math.remainder(self.heading(to) - self.heading(line), 2.0 * math.pi)

    def guessed_radius(self, curve: str) -> float:
        kind, index = self._constraint[curve]
        if kind == "c":
            return float(self._sketch.circles[index][1])
        centre, start = (self._sketch.points[i] for i in self._sketch.arcs[index][:2])
        return math.dist(centre, start)

    def curve_side(self, curve: str, line: str) -> float:
        return self.side(self._sketch.curve_points(self._constraint[curve])[0], line)


Residuals: TypeAlias = list[Node]


def _each(f: _Fields, a: Vector, b: Vector) -> Residuals:
    return list(f.writer.minus(a, b))


def _equal(f: _Fields, a: Node, b: Node) -> Residuals:
    return [f.tape.sub(a, b)]


def _along(f: _Fields, axis: int, distance: float) -> Residuals:
    """`b` lies further than `a` along an axis by this much."""
    return _equal(f, f.tape.sub(f.point("b")[axis], f.point("a")[axis]), f.tape.constant(distance))


def _distance(f: _Fields) -> Residuals:
    apart = f.writer.minus(f.point("b"), f.point("a"))
    return list(apart) if f.get("v") == 0 else _equal(f, f.writer.length(apart), f.number("v"))


def _angle(f: _Fields) -> Residuals:
    turn, angle, mode = f.turn("l", "m"), math.radians(f.get("v")), f.get("mode", "signed")
    if mode == "cos" and turn < 0.0:
        angle = -angle
    if mode == "mod180" and abs(math.remainder(turn - angle, 2.0 * math.pi)) > 0.5 * math.pi:
        angle += math.pi
    return [f.writer.between(f.writer.turned(f.vector("l"), angle), f.vector("m"))]


def _equal_angle(f: _Fields) -> Residuals:
    u = f.vector("l")
    first, second = f.turn("l", "m"), f.turn("l2", "m2")
    if f.get("flip"):
        u, first = (f.tape.neg(u[0]), f.tape.neg(u[1])), math.remainder(first + math.pi, 2.0 * math.pi)
    angle, other = f.writer.between(u, f.vector("m")), f.writer.between(f.vector("l2"), f.vector("m2"))
    return _equal(
        f, f.writer.times(math.copysign(1.0, first), angle), f.writer.times(math.copysign(1.0, second), other)
    )


def _point_line_distance(f: _Fields) -> Residuals:
    side = 1.0 if f.get("signed") else f.side(f.get("p"), "l")
    return _equal(f, f.offset(f.point("p"), "l"), f.tape.constant(side * f.get("v")))


def _symmetric(f: _Fields) -> Residuals:
    a, b, axis = f.point("a"), f.point("b"), f.vector("l")
    along = f.tape.div(f.writer.dot(axis, f.writer.minus(b, a)), f.writer.length(axis))
    return [f.offset(f.writer.middle(a, b), "l"), along]


def _mirrored(f: _Fields, across: int) -> Residuals:
    a, b = f.point("a"), f.point("b")
    return [f.tape.sub(a[1 - across], b[1 - across]), f.tape.add(a[across], b[across])]


def _unsigned_offset(f: _Fields, point: str, line: str) -> Node:
    return f.writer.times(f.side(f.get(point), line), f.offset(f.point(point), line))


def _tangent_line(f: _Fields) -> Residuals:
    return _equal(f, f.writer.times(f.curve_side("k", "l"), f.offset(f.centre("k"), "l")), f.radius("k"))


def _tangent_curves(f: _Fields) -> Residuals:
    apart = f.writer.length(f.writer.minus(f.centre("k"), f.centre("k2")))
    r, s = f.radius("k"), f.radius("k2")
    if not f.get("internal"):
        return _equal(f, apart, f.tape.add(r, s))
    is_first_larger = f.guessed_radius("k") >= f.guessed_radius("k2")
    return _equal(f, apart, f.tape.sub(r, s) if is_first_larger else f.tape.sub(s, r))


def _arc(writer: _Writer, centre: int, start: int, end: int) -> Residuals:
    middle = writer.point(centre)
    first, last = (writer.length(writer.minus(writer.point(i), middle)) for i in (start, end))
    return [writer.tape.sub(first, last)]


_RESIDUALS: dict[str, Callable[[_Fields], Residuals]] = {
    "fixed": lambda f: _each(f, f.point("p"), (f.number("x"), f.number("y"))),
    "fix_x": lambda f: _equal(f, f.point("p")[0], f.number("v")),
    "fix_y": lambda f: _equal(f, f.point("p")[1], f.number("v")),
    "coincident": lambda f: _each(f, f.point("a"), f.point("b")),
    "horizontal": lambda f: _along(f, 1, 0.0),
    "vertical": lambda f: _along(f, 0, 0.0),
    "hdist": lambda f: _along(f, 0, f.get("v")),
    "vdist": lambda f: _along(f, 1, f.get("v")),
    "distance": _distance,
    "parallel": lambda f: [f.writer.sine(f.vector("l"), f.vector("m"))],
    "perpendicular": lambda f: [f.writer.cosine(f.vector("l"), f.vector("m"))],
    "angle": _angle,
    "equal_angle": _equal_angle,
    "equal_length": lambda f: _equal(f, f.length("l"), f.length("m")),
    "length_ratio": lambda f: _equal(f, f.length("l"), f.writer.times(f.get("v"), f.length("m"))),
    "length_diff": lambda f: _equal(f, f.tape.sub(f.length("l"), f.length("m")), f.number("v")),
    "midpoint": lambda f: _each(f, f.point("p"), f.writer.middle(*f.ends("l"))),
    "symmetric": _symmetric,
    "symmetric_h": lambda f: _mirrored(f, 0),
    "symmetric_v": lambda f: _mirrored(f, 1),
    "point_on_line": lambda f: [f.offset(f.point("p"), "l")],
    "point_line_distance": _point_line_distance,
    "point_on_circle": lambda f: _equal(
        f, f.writer.length(f.writer.minus(f.point("p"), f.centre("k"))), f.radius("k")
    ),
    "radius": lambda f: _equal(f, f.radius("k"), f.number("v")),
    "equal_radius": lambda f: _equal(f, f.radius("k"), f.radius("k2")),
    "tangent_line": _tangent_line,
    "tangent_curves": _tangent_curves,
    "tangent_at_end": lambda f: [f.writer.cosine(f.vector("l"), f.spoke("arc", "end"))],
    "tangent_arcs_at_ends": lambda f: [f.writer.sine(f.spoke("arc", "end"), f.spoke("arc2", "end2"))],
    "arc_length": lambda f: _equal(f, f.arc_length(), f.number("v")),
    "equal_line_arc_len": lambda f: _equal(f, f.arc_length(), f.length("l")),
    "eq_pt_line_dist": lambda f: _equal(f, _unsigned_offset(f, "p", "l"), _unsigned_offset(f, "p2", "l2")),
    "eq_len_pt_line_dist": lambda f: _equal(f, f.length("l"), _unsigned_offset(f, "p", "m")),
}
"""By type, the expressions that shall be zero."""

"""A sketch in the form that every solver of the benchmark is given, and the judge of what they answer.

A sketch is JSON. Points are numbered, and so are lines, circles and arcs, which name points:

    points      [[x, y], …]                 first guesses
    lines       [[point, point], …]
    circles     [[centre, radius], …]       the radius is an unknown, too
    arcs        [[centre, start, end], …]   counterclockwise; both ends are equally far from the centre
    constraints [{"t": type, …}, …]
    expected    {"points": {"3": [x, y]}, …}   for test cases: see `cases.py`

The unknowns are x and y of each point, then the radii. In constraints a, b, p, p2 are points, l, m, l2, m2
lines, arc, arc2 arcs, k, k2 curves (["c", 0] a circle, ["a", 0] an arc), v a length or degrees:

    fixed p x y              fix_x p v                  fix_y p v               coincident a b
    horizontal a b           vertical a b               hdist a b v (b - a)     vdist a b v
    distance a b v           parallel l m               perpendicular l m       angle l m v mode
    equal_length l m         length_ratio l m v         length_diff l m v       midpoint p l
    point_on_line p l        point_line_distance p l v signed                   point_on_circle p k
    symmetric a b l          symmetric_h a b            symmetric_v a b         radius k v
    equal_radius k k2        tangent_line l k           tangent_curves k k2 internal
    tangent_at_end arc end l                            tangent_arcs_at_ends arc end arc2 end2
    arc_length arc v         equal_line_arc_len l arc   equal_angle l m l2 m2 flip
    eq_pt_line_dist p l p2 l2                           eq_len_pt_line_dist l p m

An angle is counted counterclockwise from l to m: modulo a turn ("signed", the default), modulo half a turn
("mod180"), or without sign ("cos"). A signed distance is positive to the left of the line. `symmetric_h` is
about the y axis, `symmetric_v` about the x axis. `end` is 0 for the start of an arc and 1 for its end.

Residuals are in millimetres, those of directions in radians (or the sine or cosine of the error).
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Constraint = dict[str, Any]

TOLERANCE = 1e-6
"""The largest residual with which a sketch counts as solved."""
FULL_TURN = 2.0 * math.pi
_TINY = 1e-300

POINTS = ("p", "p2", "a", "b")
LINES = ("l", "m", "l2", "m2")
_CURVES = ("k", "k2")
_ARCS = {"arc": "end", "arc2": "end2"}
_NUMBERS = ("v", "x", "y")
_FLAGS = ("signed", "internal", "flip")


@dataclass(frozen=True)
class Sketch:
    """See the head of this file."""

    points: list[list[float]]
    lines: list[list[int]]
    circles: list[list[Any]]
    arcs: list[list[int]]
    constraints: list[Constraint]
    expected: Mapping[str, Any] = field(default_factory=dict)
    name: str = ""

    @property
    def unknowns(self) -> int:
        return 2 * len(self.points) + len(self.circles)

    @property
    def start(self) -> Floats:
        """The first guesses (n,): points, then radii."""
        return np.array([v for p in self.points for v in p] + [c[1] for c in self.circles], dtype=np.float64)

    def curve_points(self, curve: tuple[str, int]) -> list[int]:
        """The centre of a circle; the centre and the start of an arc."""
        kind, index = curve
        return self.circles[index][:1] if kind == "c" else self.arcs[index][:2]

    def save(self, path: Path) -> None:
        form = ("name", "points", "lines", "circles", "arcs", "constraints")
        path.write_text(json.dumps({key: getattr(self, key) for key in form}), encoding="utf-8")


def load(path: Path) -> Sketch:
    """Raises ValueError for what is not a sketch."""
    data = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(data, dict) or not {"points", "lines", "constraints"} <= data.keys():
        raise ValueError(f"{path} is not a sketch: it lacks points, lines or constraints")
    return Sketch(
        data["points"],
        data["lines"],
        data.get("circles", []),
        data.get("arcs", []),
        data["constraints"],
        data.get("expected", {}),
        data.get("name", path.stem),
    )


class Columns:
    """All constraints of one type, field by field, at given values of the unknowns.

    Of k constraints, points and vectors are (k, 2), everything else is (k,).
    """

    def __init__(self, sketch: Sketch, fields: Mapping[str, NDArray[Any]], x: Floats) -> None:
        self._sketch, self._fields = sketch, fields
        self._places = x[: 2 * len(sketch.points)].reshape(-1, 2)
        self._radii = x[2 * len(sketch.points) :]

    def number(self, name: str) -> Floats:
        return self._fields[name]

    def flag(self, name: str) -> NDArray[np.bool_]:
        return self._fields[name]

    def point(self, name: str) -> Floats:
        return self._at(self._fields[name])

    def vector(self, line: str) -> Floats:
        ends = self._fields[line]
        return self._at(ends[:, 1]) - self._at(ends[:, 0])

    def length(self, line: str) -> Floats:
        return _length(self.vector(line))

    def middle(self, line: str) -> Floats:
        ends = self._fields[line]
        return (self._at(ends[:, 0]) + self._at(ends[:, 1])) / 2.0

    def offset(self, place: Floats, line: str) -> Floats:
        """Distances of places from lines, positive on the left."""
        along = self.vector(line)
        return _cross(along, place - self._at(self._fields[line][:, 0])) / _positive(_length(along))

    def centre(self, curve: str) -> Floats:
        return self._at(self._fields[curve + ".centre"])

    def radius(self, curve: str) -> Floats:
        unknown = self._fields[curve + ".radius"]
        found = _length(self._at(self._fields[curve + ".start"]) - self.centre(curve))
        found[unknown >= 0] = self._radii[unknown[unknown >= 0]]
        return found

    def spoke(self, arc: str) -> Floats:
        """From the centre of an arc to the end that the constraint names."""
        points, end = self._fields[arc], self._fields[_ARCS[arc]]
        return self._at(points[np.arange(len(end)), end]) - self._at(points[:, 0])

    def arc_length(self, arc: str) -> Floats:
        centre, start, end = (self._at(points) for points in self._fields[arc].T)
        first, last = start - centre, end - centre
        angle = np.arctan2(last[:, 1], last[:, 0]) - np.arctan2(first[:, 1], first[:, 0])
        return (angle % FULL_TURN) * _length(first)

    def _at(self, points: NDArray[np.int64]) -> Floats:
        return np.take(self._places, points, axis=0)


def _cross(u: Floats, v: Floats) -> Floats:
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def _dot(u: Floats, v: Floats) -> Floats:
    return u[:, 0] * v[:, 0] + u[:, 1] * v[:, 1]


def _length(u: Floats) -> Floats:
    return np.hypot(u[:, 0], u[:, 1])


def _positive(lengths: Floats) -> Floats:
    return np.maximum(lengths, _TINY)


def _sine(u: Floats, v: Floats) -> Floats:
    return _cross(u, v) / _positive(_length(u) * _length(v))


def _cosine(u: Floats, v: Floats) -> Floats:
    return _dot(u, v) / _positive(_length(u) * _length(v))


def _angle(c: Columns, period: float) -> Floats:
    u, v = c.vector("l"), c.vector("m")
    error = np.arctan2(_cross(u, v), _dot(u, v)) - np.radians(c.number("v"))
    return (error + period / 2.0) % period - period / 2.0


def _unsigned_angle(c: Columns) -> Floats:
    u, v = c.vector("l"), c.vector("m")
    return np.arctan2(np.abs(_cross(u, v)), _dot(u, v)) - np.radians(c.number("v"))


def _point_line_distance(c: Columns) -> Floats:
    offset = c.offset(c.point("p"), "l")
    return np.where(c.flag("signed"), offset, np.abs(offset)) - c.number("v")


def _symmetric(c: Columns) -> Floats:
    a, b, axis = c.point("a"), c.point("b"), c.vector("l")
    return np.stack([c.offset((a + b) / 2.0, "l"), _dot(b - a, axis) / _positive(_length(axis))])


def _mirrored(c: Columns, across: int) -> Floats:
    """Equal along one coordinate, opposite along `across`."""
    a, b = c.point("a"), c.point("b")
    return np.stack([a[:, 1 - across] - b[:, 1 - across], a[:, across] + b[:, across]])


def _tangent_curves(c: Columns) -> Floats:
    apart = _length(c.centre("k") - c.centre("k2"))
    r, s = c.radius("k"), c.radius("k2")
    return apart - np.where(c.flag("internal"), np.abs(r - s), r + s)


def _equal_angle(c: Columns) -> Floats:
    first = np.where(c.flag("flip"), -1.0, 1.0) * _cosine(c.vector("l"), c.vector("m"))
    return first - _cosine(c.vector("l2"), c.vector("m2"))


RESIDUALS: dict[str, Callable[[Columns], Floats]] = {
    "fixed": lambda c: (c.point("p") - np.stack([c.number("x"), c.number("y")], axis=1)).T,
    "fix_x": lambda c: c.point("p")[:, 0] - c.number("v"),
    "fix_y": lambda c: c.point("p")[:, 1] - c.number("v"),
    "coincident": lambda c: (c.point("a") - c.point("b")).T,
    "horizontal": lambda c: c.point("a")[:, 1] - c.point("b")[:, 1],
    "vertical": lambda c: c.point("a")[:, 0] - c.point("b")[:, 0],
    "hdist": lambda c: c.point("b")[:, 0] - c.point("a")[:, 0] - c.number("v"),
    "vdist": lambda c: c.point("b")[:, 1] - c.point("a")[:, 1] - c.number("v"),
    "distance": lambda c: _length(c.point("b") - c.point("a")) - c.number("v"),
    "parallel": lambda c: _sine(c.vector("l"), c.vector("m")),
    "perpendicular": lambda c: _cosine(c.vector("l"), c.vector("m")),
    "angle": lambda c: _angle(c, FULL_TURN),
    "angle mod180": lambda c: _angle(c, math.pi),
    "angle cos": _unsigned_angle,
    "equal_length": lambda c: c.length("l") - c.length("m"),
    "length_ratio": lambda c: c.length("l") - c.number("v") * c.length("m"),
    "length_diff": lambda c: c.length("l") - c.length("m") - c.number("v"),
    "midpoint": lambda c: (c.point("p") - c.middle("l")).T,
    "point_on_line": lambda c: c.offset(c.point("p"), "l"),
    "point_line_distance": _point_line_distance,
    "point_on_circle": lambda c: _length(c.point("p") - c.centre("k")) - c.radius("k"),
    "symmetric": _symmetric,
    "symmetric_h": lambda c: _mirrored(c, 0),
    "symmetric_v": lambda c: _mirrored(c, 1),
    "radius": lambda c: c.radius("k") - c.number("v"),
    "equal_radius": lambda c: c.radius("k") - c.radius("k2"),
    "tangent_line": lambda c: np.abs(c.offset(c.centre("k"), "l")) - np.abs(c.radius("k")),
    "tangent_curves": _tangent_curves,
    "tangent_at_end": lambda c: _cosine(c.vector("l"), c.spoke("arc")),
    "tangent_arcs_at_ends": lambda c: _sine(c.spoke("arc"), c.spoke("arc2")),
    "arc_length": lambda c: c.arc_length("arc") - c.number("v"),
    "equal_line_arc_len": lambda c: c.arc_length("arc") - c.length("l"),
    "equal_angle": _equal_angle,
    "eq_pt_line_dist": lambda c: np.abs(c.offset(c.point("p"), "l")) - np.abs(c.offset(c.point("p2"), "l2")),
    "eq_len_pt_line_dist": lambda c: c.length("l") - np.abs(c.offset(c.point("p"), "m")),
    "arc": lambda c: _length(c.point("a") - c.point("p")) - _length(c.point("b") - c.point("p")),
}
"""By type and mode, (k,) or (rows, k) residuals; `arc` is what makes three points an arc."""


class Evaluator:
    """The residuals of a sketch at any values, computed on its own: no solver's word counts for anything."""

    def __init__(self, sketch: Sketch) -> None:
        self.sketch = sketch
        by_type: dict[str, list[Constraint]] = {}
        for constraint in sketch.constraints:
            by_type.setdefault(_kind(constraint), []).append(constraint)
        if sketch.arcs:
            by_type["arc"] = [{"p": p, "a": a, "b": b} for p, a, b in sketch.arcs]
        self._batches = [(kind, listed, self._columns(listed)) for kind, listed in by_type.items()]

    def residuals(self, x: Floats) -> Floats:
        return np.concatenate([np.zeros(0), *(r.ravel() for _, r in self._by_type(x))])

    @property
    def equations(self) -> int:
        return len(self.residuals(self.sketch.start))

    def worst(self, x: Floats) -> tuple[float, str]:
        """The largest residual and the type of its constraint; infinite for what is no answer at all."""
        x = np.asarray(x, dtype=np.float64)
        if x.shape != (self.sketch.unknowns,) or not np.isfinite(x).all():
            return math.inf, "no finite values"
        sizes = [(float(np.abs(r).max()), kind) for kind, r in self._by_type(x)]
        return max(sizes, default=(0.0, "nothing"))

    @cached_property
    def pattern(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Row and column of each entry of the Jacobian that may differ from zero."""
        rows: list[int] = []
        columns: list[int] = []
        base = 0
        for (_, listed, _), (_, r) in zip(self._batches, self._by_type(self.sketch.start), strict=True):
            height = r.size // len(listed)
            for i, constraint in enumerate(listed):
                mentioned = sorted(set(_mentioned(self.sketch, constraint)))
                for j in range(height):
                    rows += [base + j * len(listed) + i] * len(mentioned)
                    columns += mentioned
            base += r.size
        return np.array(rows, dtype=np.int64), np.array(columns, dtype=np.int64)

    def _by_type(self, x: Floats) -> Iterator[tuple[str, Floats]]:
        for kind, _, fields in self._batches:
            yield kind, RESIDUALS[kind](Columns(self.sketch, fields, x))

    def _columns(self, listed: list[Constraint]) -> dict[str, NDArray[Any]]:
        columns = {flag: np.array([bool(c.get(flag)) for c in listed]) for flag in _FLAGS}
        for fields, suffix, read in _READERS:
            for name in listed[0].keys() & set(fields):
                columns[name + suffix] = np.array([read(self.sketch, c[name]) for c in listed])
        return columns


_READERS: tuple[tuple[Iterable[str], str, Callable[[Sketch, Any], Any]], ...] = (
    (POINTS, "", lambda _, value: value),
    (_NUMBERS, "", lambda _, value: float(value)),
    (LINES, "", lambda sketch, value: sketch.lines[value]),
    (_ARCS, "", lambda sketch, value: sketch.arcs[value]),
    (_ARCS.values(), "", lambda _, value: 2 if value else 1),
    (_CURVES, ".centre", lambda sketch, value: sketch.curve_points(value)[0]),
    (_CURVES, ".start", lambda sketch, value: sketch.curve_points(value)[-1]),
    (_CURVES, ".radius", lambda _, value: value[1] if value[0] == "c" else -1),
)
"""Fields of constraints, the ending of the column they make, and how a value becomes an entry of it."""


def _kind(constraint: Constraint) -> str:
    mode = constraint.get("mode", "signed")
    kind = str(constraint["t"]) + ("" if mode == "signed" else f" {mode}")
    if kind not in RESIDUALS:
        raise ValueError(f"`{kind}` is no type of constraint")
    return kind


def _mentioned(sketch: Sketch, constraint: Constraint) -> Iterator[int]:
    """The unknowns of a constraint."""
    points = [constraint[name] for name in POINTS if name in constraint]
    for name in LINES:
        if name in constraint:
            points += sketch.lines[constraint[name]]
    for name in _ARCS:
        if name in constraint:
            points += sketch.arcs[constraint[name]]
    for name in _CURVES:
        if name in constraint:
            kind, index = constraint[name]
            points += sketch.curve_points(constraint[name])
            if kind == "c":
                yield 2 * len(sketch.points) + index
    for point in points:
        yield 2 * point
        yield 2 * point + 1

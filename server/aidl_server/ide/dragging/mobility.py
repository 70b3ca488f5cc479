"""The points of a drawing that can be taken hold of, and the numbers that move them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import field, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import box_of, spelled_out
from aidl_lang.building.curves import xy
from aidl_lang.building.expression import Evaluator, Expression, Unknown
from aidl_lang.building.lower import Lowered, lower
from aidl_lang.building.model import Comparison, Constraint, Geometry, Model, Structure, convert, own_geometry
from aidl_lang.building.state import Scope
from aidl_lang.building.values import PointVal, Value
from aidl_lang.checking.types import PRIMITIVES
from aidl_lang.checking.units import LENGTH
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.geometry.curves import Vec
from aidl_lang.solver.array_program import Schedule
from aidl_lang.solver.problem import violations
from aidl_lang.solver.valuation import components, linearise

MOST_PARTS = 16
"""Points of one shape; of a shape with more, only those that it is made by."""


@record()
class Grip:
    """A point of a model.

    id     its key, also in a later model
    path   of its thing, `name` its name there (`top.start`); empty for the thing itself
    x, y   in the frame of the root
    thing  the outermost geometry, or the structure that the point stands for
    depth  how deep inside shapes and structures it lies
    """

    id: str
    path: str
    name: str
    x: Expression
    y: Expression
    thing: Geometry | Structure = field(repr=False)
    depth: int

    def may_move(self, written: AbstractSet[Unknown]) -> bool:
        """Tells whether numbers of the text say where a structure is, which goes where its frame goes."""
        if not isinstance(self.thing, Structure):
            return True
        return not written.isdisjoint(ex.unknowns([self.thing.frame.x, self.thing.frame.y]))

    def at(self, evaluate: Evaluator) -> Vec:
        return evaluate(self.x), evaluate(self.y)


def grips(model: Model) -> Iterator[Grip]:
    """All points of a model by which it might be moved, in order of writing; none of copies."""
    for depth, structure in _structures(model.root, 0):
        if structure.parent is not None:
            box = box_of(structure, model.root)
            middle = box.field("center") if box is not None else None
            if isinstance(middle, PointVal):
                x, y = spelled_out(*xy(middle))
                yield Grip(f"{structure.path} at", structure.path, "", x, y, structure, depth)
        for geometry in structure.own():
            if geometry.source is None and not geometry.construction:
                yield from _of_geometry(model, geometry, depth)


def _structures(structure: Structure, depth: int) -> Iterator[tuple[int, Structure]]:
    if structure.source is None:
        yield depth, structure
        for child in structure.children:
            yield from _structures(child, depth + 1)


def _of_geometry(model: Model, geometry: Geometry, depth: int) -> Iterator[Grip]:
    made_by = list(_arguments(geometry))
    inside = list(_inside(geometry, ""))
    named = made_by + (inside if len(inside) <= MOST_PARTS else [])
    for name, place in named:
        x, y = convert(xy(place), geometry.owner, model.root)
        at = f"{geometry.path}.{name}" if name else geometry.path
        if not (x.is_open or y.is_open):
            yield Grip(at, geometry.path, name, x, y, geometry, depth + name.count("."))


def _arguments(geometry: Geometry) -> Iterator[tuple[str, PointVal]]:
    if isinstance(geometry.scope, Scope):
        for name in geometry.arguments:
            value = geometry.scope.values.get(name)
            if isinstance(value, PointVal):
                yield name, value


def _inside(geometry: Geometry, prefix: str) -> Iterator[tuple[str, PointVal]]:
    """The points of a primitive, and of the parts of a shape: named ones before the ends of edges."""
    for name in PRIMITIVES[geometry.type].types if geometry.type in PRIMITIVES else ():
        value: Value | None = geometry.fields.get(name)
        if isinstance(value, PointVal):
            yield f"{prefix}{name}" if geometry.type != "point" else prefix.removesuffix("."), value
    parts = [part for part in own_geometry(geometry.parts, geometry) if not part.construction]
    seen: set[tuple[Expression, Expression]] = set()
    for part in sorted(parts, key=lambda p: p.type != "point"):
        for name, value in _inside(part, f"{prefix}{part.name or part.type}."):
            if xy(value) not in seen:  # neighbouring edges share their corners
                seen.add(xy(value))
                yield name, value


def is_somewhere(at: Vec) -> bool:
    return math.isfinite(at[0]) and math.isfinite(at[1])


# --- The movable points of a solved model and the numbers that move them: linear algebra at the solution.
#
# A small motion is possible if it changes no equation that holds. The motions of positions alone show the
# points that a first guess moves; those of positions and sizes together, the points that a size moves.

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

MOST_UNKNOWNS = 300
"""Most unknowns of a connected part that is analysed."""
_RANK = 1e-9
_MOVES = 1e-6
"""Velocity, relative to a typical one, below which a point stands still."""
_HOLDS = 1e-6
_NARROW = 1e-3
"""Least size of a second direction, relative to the first."""
AXES: tuple[Vec, Vec] = ((1.0, 0.0), (0.0, 1.0))
_NOWHERE = Span(SourceFile("dragging", ""), 0, 0)


@record()
class Way:
    """The motion of a point along one or two unit vectors.

    by   `own` where a first guess moves it against others, `size` where a kept size of its own does; `whole`
         where it moves with the whole drawing, by first guesses too
    pin  a point that stays, lest everything move
    """

    by: str
    directions: tuple[Vec, ...]
    pin: str | None = None


Ways: TypeAlias = dict[str, Way]
"""The ways of points, by their ids."""


def pull(model: Model, grip: Grip, directions: Sequence[Vec], to: Vec, weight: float | None) -> Constraint:
    """Returns the wish that a point be somewhere along some directions; hard without a weight."""
    rows = []
    for u, v in directions:
        wanted = ex.constant(u * to[0] + v * to[1])
        rows.append(Comparison("==", u * grip.x + v * grip.y, wanted, LENGTH, frozenset()))
    return Constraint(model.root, tuple(rows), grip.id, _NOWHERE, weight)


def ways(
    model: Model,
    grips: Sequence[Grip],
    evaluate: Evaluator,
    written: AbstractSet[Unknown],
    movable: AbstractSet[Unknown],
) -> Ways:
    """Returns the ways of all points; `written` are the unknowns with a number in the text."""
    wishes = {grip: pull(model, grip, AXES, grip.at(evaluate), 1.0) for grip in grips}
    lowered = lower(replace(model, constraints=[*model.constraints, *wishes.values()]))
    found: Ways = {}
    for part in _Scene(lowered, evaluate, wishes, written, movable).parts():
        part.by_positions(found)
        part.by_sizes(found)
    return found


def movable(model: Model, evaluate: Evaluator, written: AbstractSet[Unknown]) -> frozenset[Unknown]:
    """Returns the unknowns that may move: those with a number in the text, and of the others those that a run
    of the changed text moves after them. Those are frames mentioned in a constraint, and positions that the
    structure itself constrains; from outside, a structure is moved as a whole.
    """
    found = set(written)
    found.update(u for u in evaluate.values if u.frame_of is not None)
    for constraint in model.constraints:
        both = (e for c in constraint.comparisons for e in (c.left, c.right))
        found.update(u for u in ex.unknowns(both) if u.owner is constraint.holder and u in evaluate.values)
    return frozenset(u for u in found if not u.kept or u in written)


def values_at(lowered: Lowered, evaluate: Evaluator) -> Floats:
    """Returns the solved values (n,) of the unknowns of a problem."""
    values = evaluate.values
    return np.array([values.get(u, u.guess) for u in lowered.unknowns], dtype=np.float64)


class _Scene:
    """The satisfied equations and the points, over the movable unknowns, in typical units."""

    def __init__(
        self,
        lowered: Lowered,
        evaluate: Evaluator,
        wishes: Mapping[Grip, Constraint],
        written: AbstractSet[Unknown],
        movable: AbstractSet[Unknown],
    ) -> None:
        rows, self.unknowns = lowered.rows, lowered.unknowns
        self.grips = list(wishes)
        at = values_at(lowered, evaluate)
        with np.errstate(all="ignore"):
            far = violations(lowered, Schedule(lowered.tape).evaluate(at))
        number = {stated: index for index, stated in enumerate(lowered.stated) if stated is not None}
        of_row = rows.constraint
        first = np.searchsorted(of_row, [number[wish] for wish in wishes.values()])
        holding = np.isnan(lowered.weight)[of_row] & ~rows.at_most & (far <= _HOLDS * rows.scale)
        equal = np.flatnonzero(holding)
        points = np.stack((first, first + 1), axis=1).ravel()
        self.is_written = np.array([u in written for u in self.unknowns], dtype=np.bool_)
        self.is_free = ~lowered.kept
        may_move = np.array([u in movable for u in self.unknowns], dtype=np.bool_)
        with np.errstate(all="ignore"):
            _, matrix = linearise(lowered.tape, at, rows.expression[np.concatenate((equal, points))])
        scaled = matrix.scaled(np.ones(len(matrix)), lowered.scale)
        self.matrix = scaled.only(may_move[scaled.columns])
        self.equations = len(equal)

    def parts(self) -> Iterator[_Part]:
        """Yields connected parts that contain points."""
        count, width = len(self.matrix), len(self.unknowns)
        x = self.equations + 2 * np.arange(len(self.grips))
        links = np.concatenate((self.matrix.rows, x)), np.concatenate((self.matrix.columns + count, x + 1))
        labels = components(*links, count + width)
        for label in np.unique(labels[x]).tolist():
            columns = np.flatnonzero(labels[count:] == label)
            if 0 < len(columns) <= MOST_UNKNOWNS:
                equations = np.flatnonzero(labels[: self.equations] == label)
                yield _Part(self, columns, equations, np.flatnonzero(labels[x] == label))


class _Part:
    """Connected points, by their ids, with their possible motions (see `Ways`)."""

    def __init__(self, scene: _Scene, columns: Ints, equations: Ints, grips: Ints) -> None:
        self.scene, self.columns = scene, columns
        self.grips = [scene.grips[index] for index in grips.tolist()]
        self.others = len(scene.grips) - len(self.grips)
        rows = scene.equations + np.stack((2 * grips, 2 * grips + 1), axis=1)
        self.velocity = np.stack([self._dense(row) for row in rows])
        self.free, self.written = scene.is_free[columns], scene.is_written[columns]
        jacobian = self._dense(equations)
        self.positions = np.zeros((len(columns), 0))
        if self.free.any():
            null = _null_space(jacobian[:, self.free])
            self.positions = np.zeros((len(columns), null.shape[1]))
            self.positions[self.free] = null
        self.everything = _null_space(jacobian)

    def by_positions(self, found: Ways) -> None:
        """Adds the points that move against most others, and those that move with them."""
        moved = self.velocity @ self.positions
        world, pin = self._world(moved)
        for number, grip in enumerate(self.grips):
            if not (_moves(moved[number]) and self._is_written(moved[number])):
                continue
            if _moves(against := moved[number] - world):
                found[grip.id] = Way("own", _directions(against), pin)
            else:
                found[grip.id] = Way("whole", _directions(moved[number]))

    def by_sizes(self, found: Ways) -> None:
        """Adds the points that move against most others if a size of their own thing changes."""
        for thing in dict.fromkeys(grip.thing for grip in self.grips):
            own = np.array([belongs(self.scene.unknowns[c], thing) for c in self.columns.tolist()])
            own &= ~self.free & self.written
            if not own.any():
                continue
            motions = self.everything @ _null_space(self.everything[~self.free & ~own])
            moved = self.velocity @ motions
            world, pin = self._world(moved)
            for number, grip in enumerate(self.grips):
                is_own = grip.id in found and found[grip.id].by == "own"
                if grip.thing is thing and not is_own and _moves(against := moved[number] - world):
                    found[grip.id] = Way("size", _directions(against), pin)

    def _world(self, moved: Floats) -> tuple[Floats, str | None]:
        """Returns the velocity (2, d) of the largest set of points, of velocities (g, 2, d), that keep
        together in all motions: it stays while others are dragged. With it comes one of them that is to stay,
        if it could be drawn along.
        """
        still = np.abs(moved).max(axis=(1, 2), initial=0.0) <= _MOVES
        most = self.others + int(still.sum())
        velocity: Floats = np.zeros(moved.shape[1:])
        pin = None
        left = np.flatnonzero(~still)
        while len(left) > most:
            like = np.abs(moved[left] - moved[left[0]]).max(axis=(1, 2), initial=0.0) <= _MOVES
            if int(like.sum()) > most:
                most, velocity, pin = int(like.sum()), moved[left[0]], self.grips[left[0]].id
            left = left[~like]
        return velocity, pin

    def _is_written(self, moved: Floats) -> bool:
        """True if numbers of the text take part in the shortest motions of a point."""
        return _moves((self.positions @ np.linalg.pinv(moved, rcond=_MOVES))[self.written])

    def _dense(self, rows: Ints) -> Floats:
        return np.asarray(self.scene.matrix.take(rows).dense(self.columns))


def belongs(unknown: Unknown, thing: Geometry | Structure) -> bool:
    """True for a number of a geometry, or of a structure around it."""
    holder: Geometry | Structure | None = unknown.holder
    if isinstance(holder, Structure):
        around = thing.owner if isinstance(thing, Geometry) else thing
        return around.is_within(holder)
    while isinstance(holder, Geometry):
        if holder is thing:
            return True
        holder = holder.container
    return False


def _directions(velocity: Floats) -> tuple[Vec, ...]:
    """Returns the directions of the velocities (2, d) of a point; the axes if there are two."""
    left, sizes, _ = np.linalg.svd(velocity, full_matrices=False)
    if len(sizes) > 1 and sizes[1] > _NARROW * sizes[0]:
        return AXES
    return ((float(left[0, 0]), float(left[1, 0])),)


def _moves(velocity: Floats) -> bool:
    return bool(velocity.size) and float(np.abs(velocity).max()) > _MOVES


def _null_space(matrix: Floats) -> Floats:
    """The motions (n, d), orthonormal, that change no row (m, n)."""
    width = matrix.shape[1]
    if not matrix.size:
        return np.eye(width)
    lengths = np.linalg.norm(matrix, axis=1)
    rows = matrix[lengths > _MOVES] / lengths[lengths > _MOVES, None]
    if not len(rows):
        return np.eye(width)
    rows = np.asarray(np.linalg.qr(rows, mode="r") if len(rows) > width else rows)
    sizes, basis = np.linalg.svd(rows)[1:]
    rank = int((sizes > _RANK * max(rows.shape)).sum())
    return np.asarray(basis[rank:].T)

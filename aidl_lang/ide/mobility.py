"""Which points of a solved model can be moved, and by which of its numbers: linear algebra at the solution.

A small motion is possible where no equation that holds minds it. The motions of positions alone say where a
first guess moves a point; those of positions and sizes together, where a size would.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import qr

from aidl_lang import expression as ex
from aidl_lang.expression import Evaluator, Unknown
from aidl_lang.ide.draggable import Grip
from aidl_lang.lower import Lowered, lower
from aidl_lang.model import Comparison, Constraint, Geometry, Model, Structure
from aidl_lang.solver.components import components
from aidl_lang.solver.gradients import linearise
from aidl_lang.solver.problem import violations
from aidl_lang.solver.schedule import Schedule
from aidl_lang.source import SourceFile, Span
from aidl_lang.units import LENGTH

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST_UNKNOWNS = 300
"""Unknowns that hang together; a larger part of a model is not looked at."""
_RANK = 1e-9
_MOVES = 1e-6
"""Velocities that count as none, where one is typical."""
_HOLDS = 1e-6
_NOWHERE = Span(SourceFile("dragging", ""), 0, 0)


def pull(model: Model, grip: Grip, x: float, y: float, weight: float) -> Constraint:
    """The wish that a point be somewhere."""
    pairs = ((grip.x, x), (grip.y, y))
    rows = tuple(Comparison("==", e, ex.constant(v), LENGTH, frozenset()) for e, v in pairs)
    return Constraint(model.root, rows, grip.id, _NOWHERE, weight)


@dataclass(frozen=True)
class Ways:
    """
    own    points that a first guess moves against others
    sizes  points that a kept size of their own moves
    whole  points that move only as the drawing slides as a whole, by first guesses too
    """

    own: frozenset[str]
    sizes: frozenset[str]
    whole: frozenset[str]


def ways(model: Model, grips: Sequence[Grip], evaluate: Evaluator, written: AbstractSet[Unknown]) -> Ways:
    """How each point can be moved; `written` are the unknowns that a number of the text stands for."""
    wishes = {grip: pull(model, grip, *grip.at(evaluate), 1.0) for grip in grips}
    lowered = lower(replace(model, constraints=[*model.constraints, *wishes.values()]))
    scene = _Scene(lowered, evaluate, wishes, written)
    own: set[str] = set()
    sizes: set[str] = set()
    whole: set[str] = set()
    for part in scene.parts():
        own |= part.own
        sizes |= part.sizes
        whole |= part.whole
    return Ways(frozenset(own), frozenset(sizes), frozenset(whole))


def values_at(lowered: Lowered, evaluate: Evaluator) -> Floats:
    """The solved values (n,) of the unknowns of a problem."""
    values = evaluate.values
    return np.array([values.get(u, u.guess) for u in lowered.unknowns], dtype=np.float64)


class _Scene:
    """The equations that hold and the points, over the unknowns that may move, in typical units."""

    def __init__(
        self,
        lowered: Lowered,
        evaluate: Evaluator,
        wishes: Mapping[Grip, Constraint],
        written: AbstractSet[Unknown],
    ) -> None:
        problem, rows = lowered.problem, lowered.problem.rows
        self.unknowns = lowered.unknowns
        self.grips = list(wishes)
        at = values_at(lowered, evaluate)
        with np.errstate(all="ignore"):
            far = violations(problem, Schedule(problem.tape).evaluate(at))
        number = {stated: index for index, stated in enumerate(lowered.stated) if stated is not None}
        of_row = rows.constraint
        first = np.searchsorted(of_row, [number[wish] for wish in wishes.values()])
        holding = np.isnan(problem.weight)[of_row] & ~rows.at_most & (far <= _HOLDS * rows.scale)
        equal = np.flatnonzero(holding)
        points = np.stack((first, first + 1), axis=1).ravel()
        self.is_written = np.array([u in written for u in self.unknowns], dtype=np.bool_)
        self.is_free = ~problem.kept
        movable = self.is_free | self.is_written
        with np.errstate(all="ignore"):
            _, matrix = linearise(problem.tape, at, rows.expression[np.concatenate((equal, points))])
        scaled = matrix.scaled(np.ones(len(matrix)), problem.scale)
        self.matrix = scaled.only(movable[scaled.columns])
        self.equations = len(equal)

    def parts(self) -> Iterator[_Part]:
        """What hangs together and has points in it."""
        count, width = len(self.matrix), len(self.unknowns)
        labels = components(self.matrix.rows, self.matrix.columns + count, count + width)
        of_column = labels[count:]
        slides = self.equations + 2 * np.arange(len(self.grips))
        for label in np.unique(labels[self.equations : count]).tolist():
            columns = np.flatnonzero(of_column == label)
            grips = np.flatnonzero((labels[slides] == label) | (labels[slides + 1] == label))
            if 0 < len(columns) <= MOST_UNKNOWNS:
                yield _Part(self, columns, np.flatnonzero(labels[: self.equations] == label), grips)


class _Part:
    """Points that hang together. `own`, `sizes` and `whole` are the ids of those that can be moved so."""

    def __init__(self, scene: _Scene, columns: Ints, equations: Ints, grips: Ints) -> None:
        self.scene, self.columns = scene, columns
        self.own: set[str] = set()
        self.sizes: set[str] = set()
        self.whole: set[str] = set()
        rows = scene.equations + np.stack((2 * grips, 2 * grips + 1), axis=1)
        jacobian = scene.matrix.take(equations).dense(columns) if len(equations) else np.zeros((0, len(columns)))
        velocity = np.stack([self._dense(row) for row in rows])
        free, written = scene.is_free[columns], scene.is_written[columns]
        positions = np.zeros((len(columns), 0))
        if free.any():
            null = _null_space(jacobian[:, free])
            positions = np.zeros((len(columns), null.shape[1]))
            positions[free] = null
        moved = velocity @ positions
        mean = moved.sum(axis=0) / len(scene.grips)
        everything = _null_space(jacobian)
        for number, index in enumerate(grips.tolist()):
            grip = scene.grips[index]
            if _moves(moved[number]) and self._is_written(positions, moved[number], written):
                (self.own if _moves(moved[number] - mean) else self.whole).add(grip.id)
            sizes = ~free & written & self._belongs(grip)
            if sizes.any() and _moves(velocity[number][:, sizes] @ everything[sizes]):
                self.sizes.add(grip.id)

    def _dense(self, rows: Ints) -> Floats:
        return np.asarray(self.scene.matrix.take(rows).dense(self.columns))

    def _is_written(self, motions: Floats, moved: Floats, written: NDArray[np.bool_]) -> bool:
        """Whether numbers of the text take part in the shortest motions that move a point."""
        return _moves((motions @ np.linalg.pinv(moved, rcond=_MOVES))[written])

    def _belongs(self, grip: Grip) -> NDArray[np.bool_]:
        """Which unknowns are of the geometry that a point is of, or of the structure."""
        owners = (_belongs(self.scene.unknowns[column], grip) for column in self.columns.tolist())
        return np.array(list(owners), dtype=np.bool_)


def belongs(unknown: Unknown, grip: Grip) -> bool:
    """Whether a number is one of the geometry that a point is of, or of a structure around it."""
    return _belongs(unknown, grip)


def _belongs(unknown: Unknown, grip: Grip) -> bool:
    thing = grip.thing
    holder: Geometry | Structure | None = unknown.holder
    if isinstance(holder, Structure):
        around = thing.owner if isinstance(thing, Geometry) else thing
        return around.is_within(holder)
    while isinstance(holder, Geometry):
        if holder is thing:
            return True
        holder = holder.container
    return False


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
    basis, triangle, _ = qr(rows.T, pivoting=True)
    rank = int((np.abs(np.diag(triangle)) > _RANK * max(rows.shape)).sum())
    return np.asarray(basis[:, rank:])

"""The observables of a model, their relations, and how motions go on."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np

from aidl_lang.building.curves import DIRECTIONS
from aidl_lang.building.expression import DEGREE
from aidl_lang.building.lower import Lowered, Solved, seen
from aidl_lang.building.model import Constraint, Geometry, Model, Structure
from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Floats, Ints, Mask
from aidl_lang.solver.analysis import Motions, Part
from aidl_lang.solver.linear import Sparse, each_once, scattered
from aidl_lang.solver.valuation import Valuation, linearise

# --- Tests whether a motion goes on as it begins: a slide along a line may be the first of a way around
# something.

STEP = 1e-3
"""Distance to either side over which a motion is followed, in units of the unknowns."""
KINK = 0.1
"""Greatest bend of a row on the way, as a share of the change of its terms: beyond that the row has a corner
there, and the motion is possible to one side.
"""
STRAIGHT = 1e-5
"""The bend that counts as none, in units of the unknowns."""
ROUNDING = 1e-14
"""Relative error of a difference of three values that rounding explains."""
WORK = 2_000_000
"""Greatest size of the matrix of a part whose motions are followed."""


class Bending:
    """The bends of the equations that hold, and of the observables of a problem, along a motion."""

    def __init__(self, solution: Solved) -> None:
        problem = self.problem = solution.problem
        self.at = np.asarray(solution.values, dtype=np.float64)
        rows = problem.rows
        holding = np.isnan(problem.weight) & np.array(solution.satisfied, dtype=np.bool_)
        equal = np.flatnonzero(holding[rows.constraint] & ~rows.at_most)
        self.equations = len(equal)
        observed = np.array([node for _, node in problem.observables], dtype=np.intp)
        self.roots = np.concatenate((rows.expression[equal], observed))

    @cached_property
    def slopes(self) -> Sparse:
        """The slopes of the equations and observables, in units of the unknowns."""
        return self._slopes(self.at)

    @cached_property
    def slopes_beside(self) -> Sparse:
        """The same a little away, where slopes are no zeros by chance."""
        away = STEP * (0.75 + 0.25 * scattered(len(self.at), 1))
        return self._slopes(self.at + self.problem.scale * away)

    @cached_property
    def lengths(self) -> Floats:
        """(r,) of the rows of slopes."""
        return np.maximum(self.slopes.lengths(), self.slopes_beside.lengths())

    @cached_property
    def is_bent(self) -> Mask:
        """(r,) whether the slopes of a row are others a little away."""
        weights = scattered(len(self.at), 2)
        here, beside = (
            np.bincount(m.rows, m.entries * weights[m.columns], len(m))
            for m in (self.slopes, self.slopes_beside)
        )
        found: Mask = np.abs(here - beside) > 1e-9 * self.lengths
        return found

    @cached_property
    def valuation(self) -> Valuation:
        return Valuation(self.problem.tape, self.at.tolist())

    def goes_on(self, part: Part, rates: Floats, wanted: Floats) -> bool:
        """Tells whether observables can accelerate as `wanted` (o,) at these rates of a part's unknowns."""
        columns = part.unknowns
        has_part = np.zeros(len(self.at), dtype=np.bool_)
        has_part[columns] = True
        inside = has_part[self.slopes.columns]
        beside = self.slopes_beside
        touched = has_part[beside.columns] & (beside.entries != 0.0)
        rows = each_once(np.concatenate((self.slopes.rows[inside], beside.rows[touched])))
        if not (self.is_bent[rows].any() or wanted.any()) or len(rows) * len(columns) > WORK:
            return True
        step = STEP / float(np.abs(rates / self.problem.scale[columns]).max())
        bends, rounding = self._second_differences(rows, columns, step * rates)
        asked = np.concatenate((np.zeros(self.equations), wanted))[rows] * step**2
        kept = (np.abs(bends) <= KINK * STEP * self.lengths[rows]) & (self.lengths[rows] > 0.0)
        lengths = self.lengths[rows][kept]
        needed = (asked - bends)[kept] / (STEP**2 * lengths)
        most = float(np.abs(needed).max(initial=0.0))
        # A row that hardly changes is no more than its rounding, however short a step is for it.
        allowed = STRAIGHT * max(1.0, most) + rounding[kept] / (STEP**2 * lengths)
        if (np.abs(needed) <= allowed).all() and most <= 1.0:
            return True
        slopes = self.slopes.only(inside).take(rows[kept]).dense(columns) / lengths[:, None]
        missing = needed - slopes @ np.linalg.lstsq(slopes, needed, rcond=1e-9)[0]
        return bool((np.abs(missing) <= allowed).all())

    def _slopes(self, at: Floats) -> Sparse:
        with np.errstate(all="ignore"):
            matrix = linearise(self.problem.tape, at, self.roots)[1]
        return matrix.scaled(np.ones(len(matrix)), self.problem.scale)

    def _second_differences(self, rows: Ints, columns: Ints, step: Floats) -> tuple[Floats, Floats]:
        """(r,) the second difference of each row over a step either way; and how much may be rounding."""
        valuation, roots = self.valuation, self.roots[rows].tolist()
        cone = valuation.cone(roots)
        values = []
        for sign in (1.0, -1.0, 0.0):
            ahead = self.at[columns] + sign * step
            valuation.assign(zip(columns.tolist(), ahead.tolist(), strict=True))
            valuation.refresh(cone)
            values.append(np.array([valuation.nodes[root] for root in roots]))
        return values[0] - 2.0 * values[2] + values[1], ROUNDING * (1.0 + np.abs(values[2]))


# --- The observables of a model with their axis, their number, and the things that they belong to.

X, Y, NUMBER = 0, 1, 2
ROOT, POINT, GEOMETRY, WHOLE = 0, 1, 2, 3


@record()
class Thing:
    """A point, geometry or structure: the observables from `start` to `stop` that are seen from `anchor`."""

    path: str
    start: int
    stop: int
    rank: int
    """how gladly it is named: a structure before its only geometry, that before its only point"""
    anchor: int


class Scene:
    """
    places  (o,) the value of each observable
    anchor  (o,) the group from whose frame it is seen
    turning (o,) degrees that a direction turns in units of a turn by an angle of one radian
    axis    (o,) X, Y or NUMBER
    number  (o,) the path of the place or number that it belongs to; for a corner of a plan, of its structure
    of      (o,) the things that it belongs to
    known   the things by their paths
    bending the bends of the observables along a motion
    """

    def __init__(self, model: Model, lowered: Lowered, motions: Motions, bending: Bending) -> None:
        self.lowered, self.bending = lowered, bending
        self.places, self.anchor = motions.values, motions.anchor
        count = len(self.places)
        self.turning = np.zeros(count)
        self.axis: Ints = np.full(count, NUMBER)
        self.number: list[str] = [""] * count
        self.things: list[Thing] = []
        self.known: dict[str, Thing] = {}
        structures = list(model.root.walk())
        counts = np.bincount([group for group, _ in lowered.observables], minlength=len(structures))
        starts = np.concatenate(([0], np.cumsum(counts))).tolist()
        for number, s in enumerate(structures):
            stop = starts[number + sum(1 for _ in s.walk())]
            self._add(s.path, starts[number], stop, WHOLE if number else ROOT)
            self._place(s, starts[number], starts[number + 1])
        self.of: list[list[Thing]] = [[] for _ in self.places]
        for thing in self.things:
            for observable in range(thing.start, thing.stop):
                if self.anchor[observable] == thing.anchor:
                    self.of[observable].append(thing)

    def own(self, thing: Thing) -> Ints:
        """Returns the observables of a thing, without those of what rides along in it."""
        return np.flatnonzero(self.anchor[thing.start : thing.stop] == thing.anchor) + thing.start

    def _add(self, path: str, start: int, stop: int, rank: int) -> None:
        if start < stop:
            anchor = int(self.anchor[start:stop].min())
            thing = Thing(path, start, stop, rank, anchor)
            self.things.append(thing)
            self.known.setdefault(path, thing)

    def _place(self, s: Structure, at: int, stop: int) -> None:
        """Numbers the observables of a structure itself, from `at` to `stop`."""
        ranges: dict[Geometry, list[int]] = {}
        for geometry, path, numbers in seen(s):
            if len(numbers) == 2:
                self.axis[at : at + 2] = X, Y
                if isinstance(geometry, Geometry) and not geometry.is_compound:
                    self._add(path, at, at + 2, POINT)
            self.number[at : at + len(numbers)] = [path] * len(numbers)
            if isinstance(geometry, Geometry):
                self.turning[at] = (path.rpartition(".")[2] in DIRECTIONS) / DEGREE
                ranges.setdefault(geometry, [at, at])[1] = at + len(numbers)
            at += len(numbers)
        for geometry, (first, last) in ranges.items():
            self._add(geometry.path, first, last, GEOMETRY)
        lowered = self.lowered
        for variable in range(at, stop):
            node = lowered.observables[variable][1]
            self.number[variable] = lowered.unknowns[int(lowered.tape.operands[node, 0])].path


# --- The things against which a thing moves: those that constraints relate it to, and those beside it.

_INDEX = re.compile(r"\[\d+\]")


class Relations:
    """The relations between the things of a model, as `scene` shows it."""

    def __init__(self, model: Model, scene: Scene) -> None:
        self.scene = scene
        stated = sorted((c for c in model.constraints if not c.is_inherent), key=lambda c: c.span.start)
        self.related = [found for c in stated if len(found := _related(c)) > 1]
        self.beside = {
            child.path: [other.path for other in s.children if other.kind not in ("hole", "drawing")]
            for s in model.root.walk()
            for child in s.children
        }

    def against(self, things: Sequence[str], moving: Ints) -> str:
        """Returns the path of the thing that is related to things and does not go along when these
        observables move, be it free itself or held: that of the first such constraint, in another array if
        there is one; for structures without such, the part beside them. "" if there is none.
        """
        flags = np.zeros(len(self.scene.places), dtype=np.bool_)
        flags[moving] = True
        known = self.scene.known
        beside = ((path, known[path]) for path in self._neighbours(things) if path in known)
        found = dict.fromkeys(path for path, thing in beside if not flags[self.scene.own(thing)].any())
        own = {pattern(thing) for thing in things}
        for path in found:
            if pattern(path) not in own:
                return path
        return next(iter(found), "")

    def _neighbours(self, things: Sequence[str]) -> Iterator[str]:
        for paths in self.related:
            inside = [path for path in paths if any(_is_in(path, thing) for thing in things)]
            for path in paths if inside else ():
                if not any(_is_in(path, thing) or _is_in(thing, path) for thing in things):
                    yield _beside(path, inside[0])
        if all((thing := self.scene.known.get(path)) is not None and thing.rank == WHOLE for path in things):
            yield from (path for path in self.beside.get(things[0], ()) if path not in things)


def _related(constraint: Constraint) -> tuple[str, ...]:
    """Returns the paths of the things that a constraint relates: structures by their boxes, else the holders
    of its unknowns; if these are all one thing, also the other things that it names, which have no unknowns.
    """
    boxes = {s.path for c in constraint.comparisons for s in c.boxes}
    mentioned = {u.holder.path for c in constraint.comparisons for u in c.spoken_of}
    # A frame is mentioned beside what lies in it.
    others = {
        path
        for path in mentioned
        if not any(_is_in(other, path) for other in mentioned | boxes if other != path)
    }
    found = boxes | others
    if len(found) < 2 and constraint.wording is not None:
        found |= {thing.path for thing in constraint.wording.named()}
    return tuple(sorted(found))


def _is_in(path: str, around: str) -> bool:
    return f"{path}.".startswith(f"{around}.")


def _beside(path: str, other: str) -> str:
    """Returns the holder of a path that stands beside the holder of the other: both lie in the same."""
    ends, others = path.split("."), other.split(".")
    common = next((i for i, (a, b) in enumerate(zip(ends, others, strict=False)) if a != b), len(ends))
    return ".".join(ends[: common + 1])


def pattern(path: str) -> str:
    """Returns a path without its indices: the members of an array have the same."""
    return _INDEX.sub("[]", path)

"""The observables of a model with their axis, their number, and the things that they belong to."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from aidl_lang.building.curves import DIRECTIONS
from aidl_lang.building.expression import DEGREE
from aidl_lang.building.lower import Lowered, seen
from aidl_lang.building.model import Geometry, Model, Structure
from aidl_lang.common.records import record
from aidl_lang.geometry.freedom.bending import Bending
from aidl_lang.solver.analysis import Motions

Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.intp]

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
        counts = np.bincount([group for group, _ in lowered.problem.observables], minlength=len(structures))
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
        found: Ints = np.flatnonzero(self.anchor[thing.start : thing.stop] == thing.anchor) + thing.start
        return found

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
        problem = self.lowered.problem
        for variable in range(at, stop):
            node = problem.observables[variable][1]
            self.number[variable] = self.lowered.unknowns[int(problem.tape.operands[node, 0])].path

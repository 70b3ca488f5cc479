"""The motions possible in one part of a model, and the names of what moves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from aidl_lang.building.expression import DEGREE
from aidl_lang.common.arrays import scattered
from aidl_lang.common.records import record
from aidl_lang.geometry.freedom.scene import (
    GEOMETRY,
    NUMBER,
    POINT,
    ROOT,
    WHOLE,
    Floats,
    Ints,
    Scene,
    Thing,
    X,
    Y,
)
from aidl_lang.solver.analysis import Part

Flags: TypeAlias = NDArray[np.bool_]

WORK = 2_000_000
"""Numbers that the velocities of a part may have for every small thing to be tried."""
POSSIBLE = 1e-6
"""Relative error of a velocity that counts as none."""


@record(frozen=False)
class Reach:
    """The velocities possible for a part; `taken` are those reported or known, in the space of all."""

    scene: Scene
    part: Part
    taken: list[Floats] = field(default_factory=list)

    def __post_init__(self) -> None:
        observables = self.part.observables
        self.axis = self.scene.axis[observables]
        self.anchor = self.scene.anchor[observables]
        self.places = self.scene.places[observables]
        self.turning = self.scene.turning[observables]
        # Orthonormal, so that what is out of reach is found by subtraction.
        self.reach, self.triangle = np.linalg.qr(self.part.velocities)

    @property
    def is_done(self) -> bool:
        return len(self.taken) == int(self.reach.shape[1])

    def at(self, observables: Ints) -> Ints:
        """Returns the index in the part of each of the scene's observables, -1 for those that are not in
        it.
        """
        own = self.part.observables
        place = np.minimum(np.searchsorted(own, observables), len(own) - 1)
        return np.where(own[place] == observables, place, -1)

    def of_all(self, axis: int) -> Floats:
        """Returns the velocity of everything along an axis, or in a turn about the origin of the root."""
        if axis != NUMBER:
            found: Floats = ((self.axis == axis) & (self.anchor == 0)).astype(float)
            return found
        at, values = self.part.observables, self.scene.places
        across = np.where(self.axis == X, -values[np.minimum(at + 1, len(values) - 1)], values[at - 1])
        turn = np.where(self.axis == NUMBER, self.turning, across) * (self.anchor == 0)
        return np.asarray(turn * DEGREE, dtype=np.float64)

    # --- What is possible --------------------------------------------------------------------------

    def _missing(self, velocity: Floats) -> Floats:
        """Returns the part of a velocity that is out of reach."""
        missing: Floats = velocity - self.reach @ (self.reach.T @ velocity)
        return missing

    def is_possible(self, velocity: Floats) -> bool:
        return float(np.linalg.norm(self._missing(velocity))) <= POSSIBLE * float(np.linalg.norm(velocity))

    def know(self, velocity: Floats) -> None:
        """Takes up a motion among those that are known, unless it is a combination of them."""
        if (way := self._news(velocity)) is not None:
            self.taken.append(way)

    def _news(self, velocity: Floats) -> Floats | None:
        """Returns the unit part of a motion that is no combination of those known, in the space of all; None
        if there is none.
        """
        size = float(np.linalg.norm(velocity))
        if not size:
            return None
        way = self.reach.T @ velocity / size
        for _ in range(2):
            for other in self.taken:
                way = way - other * (other @ way)
        left = float(np.linalg.norm(way))
        return way / left if left > POSSIBLE else None

    def goes_on(self, velocity: Floats, spin: float) -> bool:
        """Tells whether a possible motion goes on as it begins: straight, or in a circle by `spin`
        radians.
        """
        wanted = np.zeros(len(self.scene.places))
        if spin:
            at_x = self.part.observables[self.axis == X]
            speed = np.zeros(len(wanted) + 1)
            speed[self.part.observables] = velocity
            wanted[at_x], wanted[at_x + 1] = -spin * speed[at_x + 1], spin * speed[at_x]
            at_y = self.part.observables[self.axis == Y]
            wanted[at_y - 1], wanted[at_y] = -spin * speed[at_y], spin * speed[at_y - 1]
        return self.scene.bending.goes_on(self.part, self._rates(velocity), wanted)

    def _rates(self, velocity: Floats) -> Floats:
        """Returns the rates (k,) of the unknowns of the part in a possible motion."""
        found: Floats = self.part.basis @ np.linalg.solve(self.triangle, self.reach.T @ velocity)
        return found

    def rates(self, velocity: Floats) -> dict[str, float]:
        """Returns the rates of the parameters that take part in a possible motion, by path."""
        rates = self._rates(velocity)
        least = POSSIBLE * float(np.abs(rates).max())
        return {
            self.scene.lowered.unknowns[u].path: float(rate)
            for u, rate in zip(self.part.unknowns.tolist(), rates.tolist(), strict=True)
            if abs(rate) > least
        }

    def _moving(self, velocity: Floats) -> Flags:
        found: Flags = np.abs(velocity) > POSSIBLE * float(np.abs(velocity).max())
        return found

    # --- What may move as a whole ------------------------------------------------------------------

    def _clusters(self, anchor: int, axis: int) -> Iterator[Ints]:
        """Yields the coordinates of the places that have the same velocity along an axis in every motion."""
        at = np.flatnonzero((self.axis == axis) & (self.anchor == anchor))
        if not len(at):
            return
        # Equal rows have equal products with numbers at random, and no others do.
        weights = scattered(self.reach.shape[1], 1)
        products = self.reach[at] @ weights
        order = np.argsort(products, kind="stable")
        gaps = np.flatnonzero(np.diff(products[order]) > POSSIBLE * float(np.abs(products).max()))
        for group in np.split(at[order], gaps + 1):
            first = self.part.observables[group] - axis  # x and y stand side by side
            yield np.sort(np.concatenate((first, first + 1)))

    def _inside(self, thing: Thing | None) -> Floats:
        """Returns the observables of a thing, or all, as 0 and 1."""
        found = np.zeros(len(self.axis)) if thing else np.ones(len(self.axis))
        if thing is not None:
            local = self.at(self.scene.own(thing))
            found[local[local >= 0]] = 1.0
        return found

    def _near(self) -> list[Thing]:
        """Returns the things that something of the part belongs to; not the small ones where they are too
        many.
        """
        found = {thing for o in self.part.observables.tolist() for thing in self.scene.of[o]}
        for ranks in ((ROOT, WHOLE), ()):
            if len(found) * self.reach.size > WORK:
                found = {thing for thing in found if thing.rank in ranks}
        return sorted(found, key=lambda t: (-t.rank, t.start, -t.stop))

    def _whole(self, own: Ints, axis: int) -> Floats:
        """Returns the observables of a thing along an axis as 0 and 1; none if some of them do not move."""
        at = self.at(own)[self.scene.axis[own] == axis]
        mask = np.zeros(len(self.axis))
        if (at >= 0).all():
            mask[at] = 1.0
        return mask

    # --- Naming ------------------------------------------------------------------------------------

    def _whole_things(self, thing: Thing | None, mask: Floats) -> list[str]:
        """Returns the names of the things that move as a whole; empty if a thing moves in part."""
        if thing:
            return [thing.path]
        found = self._cover(mask > 0.0)
        return [path for path, _ in found] if all(whole for _, whole in found) else []

    def _cover(self, moving: Flags) -> list[tuple[str, bool]]:
        """Returns the paths of the things that take part, and whether all their places do: structures,
        geometry and points that move as a whole, then other geometry, then numbers.
        """
        left = np.zeros(len(self.scene.places), dtype=np.bool_)
        left[self.part.observables[moving]] = True
        placed = np.isin(self.scene.axis, list(set(self.axis[moving].tolist()) - {NUMBER}))
        entire = left | ~placed
        found: list[tuple[int, str, bool]] = []
        things = {t for o in np.flatnonzero(left & placed).tolist() for t in self.scene.of[o]}
        for whole in (True, False):
            for thing in sorted(things, key=_gladly):
                own = self.scene.own(thing)
                fits = entire[own].all() if whole else thing.rank == GEOMETRY
                if fits and (left & placed)[own].any():
                    found.append((thing.start, thing.path, whole))
                    left[own] = False
        rest = {self.scene.number[o]: o for o in reversed(np.flatnonzero(left).tolist())}
        found += [(o, path, path not in self.scene.known) for path, o in rest.items()]
        partly = tuple(f"{path}." for _, path, whole in found if not whole)
        return [(path, whole) for _, path, whole in sorted(found) if not path.startswith(partly)]


def _gladly(thing: Thing) -> tuple[bool, int, int]:
    """Returns the order in which things are named: structures before geometry and points, large before
    small.
    """
    return thing.rank in (GEOMETRY, POINT), thing.start - thing.stop, -thing.rank

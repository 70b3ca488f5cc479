"""What can still move, in words: the motions of the solver, taken apart into simple ones.

The solver tells for each part of the model which velocities are possible for what is drawn. Here simple
velocities are tried in turn: of points, geometry and structures, the smallest first, a slide along an axis or
another direction, and a turn; then changes of single parameters, then growth. Each that is possible and new
is told; what is left over is told as things that move together.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from aidl_lang.expression import DEGREE, quoted
from aidl_lang.lower import Lowered, seen
from aidl_lang.model import Geometry, Model, Structure
from aidl_lang.primitives import DIRECTIONS
from aidl_lang.solved import Motion
from aidl_lang.solver.analysis import Freedom
from aidl_lang.solver.mobility import Part

Floats: TypeAlias = NDArray[np.float64]
Flags: TypeAlias = NDArray[np.bool_]

MOST = 200
"""Parts of the model that are put into words."""
WORK = 2_000_000
"""Numbers that the velocities of a part may have for every small thing to be tried."""
POSSIBLE = 1e-6
"""Relative error of a velocity that counts as none."""
NAMED = 3
"""Things that are named in one sentence."""
X, Y, NUMBER = 0, 1, 2
ROOT, POINT, GEOMETRY, WHOLE = 0, 1, 2, 3


def motions(model: Model, lowered: Lowered, freedom: Freedom) -> tuple[Motion, ...]:
    """Independent motions of the parts of a model, each as simple as was found."""
    scene = _Scene(model, lowered, freedom)
    return tuple(
        motion for part in freedom.motions.parts[:MOST] for motion in _Telling(scene, part).motions()
    )


def sentences(found: Iterable[Motion], root: str) -> Iterator[str]:
    """One for all that the same things can do, as "`receiver` can slide left–right and turn"."""
    told: dict[tuple[str, ...], list[str]] = {}
    for motion in found:
        told.setdefault(motion.things, []).append(motion.words)
    for things, words in told.items():
        names = [quoted(path.removeprefix(root + ".")) for path in things]
        more = [f"{len(names) - NAMED} more"] if len(names) > NAMED + 1 else []
        named = _listed([*names[: NAMED if more else None], *more])
        slides = sorted(each.removeprefix("slide ") for each in words if each.startswith("slide "))
        others = [each for each in words if not each.startswith("slide ")]
        yield f"{named} can {_listed(['slide ' + _listed(slides)] * bool(slides) + others)}"


def _listed(words: Sequence[str]) -> str:
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


@dataclass(frozen=True)
class _Thing:
    """A point, geometry or structure: the observables from `start` to `stop`."""

    path: str
    start: int
    stop: int
    rank: int
    """how gladly it is named: a structure before its only geometry, that before its only point"""


class _Scene:
    """The observables by what they belong to: their axis, the path of the number, the things around."""

    def __init__(self, model: Model, lowered: Lowered, freedom: Freedom) -> None:
        self.lowered = lowered
        self.places = freedom.motions.values
        self.turning = np.zeros(len(self.places))
        """degrees that a direction turns in units of a turn by an angle of one radian"""
        self.axis = np.full(len(self.places), NUMBER)
        self.number: list[str] = [""] * len(self.places)
        self.things: list[_Thing] = []
        structures = list(model.root.walk())
        counts = np.bincount([group for group, _ in lowered.problem.observables], minlength=len(structures))
        starts = np.concatenate(([0], np.cumsum(counts))).tolist()
        for number, s in enumerate(structures):
            stop = starts[number + sum(1 for _ in s.walk())]
            self.things.append(_Thing(s.path, starts[number], stop, WHOLE if number else ROOT))
            self._place(s, starts[number], starts[number + 1])
        self.of: list[list[_Thing]] = [[] for _ in self.places]
        for thing in self.things:
            for observable in range(thing.start, thing.stop):
                self.of[observable].append(thing)

    def _place(self, s: Structure, at: int, stop: int) -> None:
        """Numbers the observables of a structure itself, from `at` to `stop`."""
        ranges: dict[Geometry, list[int]] = {}
        for geometry, path, numbers in seen(s):
            if len(numbers) == 2:
                self.axis[at : at + 2] = X, Y
                if isinstance(geometry, Geometry) and not geometry.is_compound:
                    self.things.append(_Thing(path, at, at + 2, POINT))
            self.number[at] = path
            if isinstance(geometry, Geometry):
                self.turning[at] = (path.rpartition(".")[2] in DIRECTIONS) / DEGREE
                ranges.setdefault(geometry, [at, at])[1] = at + len(numbers)
            at += len(numbers)
        for geometry, (first, last) in ranges.items():
            self.things.append(_Thing(geometry.path, first, last, GEOMETRY))
        problem = self.lowered.problem
        for variable in range(at, stop):
            node = problem.observables[variable][1]
            self.number[variable] = self.lowered.unknowns[int(problem.tape.operands[node, 0])].path


_Masked: TypeAlias = tuple[_Thing | None, Floats, Floats]
"""A thing, and what of a part is its x and its y, as 0 and 1."""


@dataclass
class _Telling:
    """The motions of one part, one after the other; `taken` are those that were told, in the space of all."""

    scene: _Scene
    part: Part
    taken: list[Floats] = field(default_factory=list)

    def __post_init__(self) -> None:
        observables = self.part.observables
        self.local = np.full(len(self.scene.places), -1)
        self.local[observables] = np.arange(len(observables))
        self.axis = self.scene.axis[observables]
        self.places = self.scene.places[observables]
        self.turning = self.scene.turning[observables]
        # Orthonormal, so that what is out of reach is found by subtraction.
        self.reach, self.triangle = np.linalg.qr(self.part.velocities)

    @property
    def is_done(self) -> bool:
        return len(self.taken) == int(self.reach.shape[1])

    def motions(self) -> list[Motion]:
        things = self._things()
        found = [motion for _, xs, ys in things[-1:] for motion in self._slides(things[-1][0], xs, ys)]
        if self.is_done:  # everything moves as a whole, and in no other way
            return found
        self.taken.clear()
        return list(self._in_turn(things))

    def _in_turn(self, things: Sequence[_Masked]) -> Iterator[Motion]:
        for each in things:
            yield from self._slides(*each)
            yield from self._turns(*each)
        for thing in self._near():
            yield from self._turns_about_a_place(thing)
        yield from self._changes()
        for each in things:
            yield from self._growth(*each)
        for thing in self._near():
            yield from self._growth_from_a_place(thing)
        yield from self._rest()

    def _things(self) -> list[_Masked]:
        """What may move as a whole, the smallest first; None stands for everything in the part."""
        tried: dict[bytes, _Masked] = {}
        for thing in self._near():
            xs, ys = self._whole(thing, X), self._whole(thing, Y)
            if xs.any() or ys.any():
                tried.setdefault(xs.tobytes() + ys.tobytes(), (thing, xs, ys))
        xs, ys = (self.axis == X).astype(float), (self.axis == Y).astype(float)
        if xs.any() or ys.any():
            tried.setdefault(xs.tobytes() + ys.tobytes(), (None, xs, ys))
        return sorted(tried.values(), key=lambda each: float(each[1].sum() + each[2].sum()))

    def _inside(self, thing: _Thing | None) -> Floats:
        """The observables of a thing, or all, as 0 and 1."""
        observables = self.part.observables
        if thing is None:
            return np.ones(len(observables))
        return ((observables >= thing.start) & (observables < thing.stop)).astype(float)

    def _near(self) -> list[_Thing]:
        """The things that something of the part belongs to; not the small ones where they are too many."""
        found = {thing for o in self.part.observables.tolist() for thing in self.scene.of[o]}
        for ranks in ((ROOT, WHOLE), ()):
            if len(found) * self.reach.size > WORK:
                found = {thing for thing in found if thing.rank in ranks}
        return sorted(found, key=lambda t: (-t.rank, t.start, -t.stop))

    def _whole(self, thing: _Thing, axis: int) -> Floats:
        """The observables of a thing along an axis as 0 and 1; none if some of them do not move."""
        own = slice(thing.start, thing.stop)
        at = self.local[own][self.scene.axis[own] == axis]
        mask = np.zeros(len(self.axis))
        if (at >= 0).all():
            mask[at] = 1.0
        return mask

    # --- Trying ------------------------------------------------------------------------------------

    def _missing(self, velocity: Floats) -> Floats:
        """What of a velocity is out of reach."""
        missing: Floats = velocity - self.reach @ (self.reach.T @ velocity)
        return missing

    def _told(self, velocity: Floats, kind: str, things: Sequence[str], words: str) -> Iterator[Motion]:
        """The motion, if it is possible and no combination of those that were told."""
        size = float(np.linalg.norm(velocity))
        if self.is_done or not size or np.linalg.norm(self._missing(velocity)) > POSSIBLE * size:
            return
        way = self.reach.T @ velocity / size
        for _ in range(2):
            for other in self.taken:
                way = way - other * (other @ way)
        if np.linalg.norm(way) <= POSSIBLE:
            return
        self.taken.append(way / np.linalg.norm(way))
        rates = self.part.basis @ np.linalg.solve(self.triangle, self.reach.T @ velocity)
        moves = {
            self.scene.lowered.unknowns[u].path: float(rate)
            for u, rate in zip(self.part.unknowns.tolist(), rates.tolist(), strict=True)
            if abs(rate) > POSSIBLE * float(np.abs(rates).max())
        }
        yield Motion(kind, tuple(things), words, moves)

    def _slides(self, thing: _Thing | None, xs: Floats, ys: Floats) -> Iterator[Motion]:
        things = self._whole_things(thing, xs + ys)
        if not things:
            return
        before = len(self.taken)
        yield from self._told(xs, "slide", things, "slide left–right")
        yield from self._told(ys, "slide", things, "slide up–down")
        if len(self.taken) > before or not (xs.any() and ys.any()):
            return
        missing = np.stack((self._missing(xs), self._missing(ys)), axis=1)
        _, sigma, vt = np.linalg.svd(missing, full_matrices=False)
        if sigma[1] <= POSSIBLE * float(np.linalg.norm(xs)) and np.abs(vt[1]).min() > POSSIBLE:
            angle = math.degrees(math.atan2(vt[1, 1], vt[1, 0])) % 180.0
            velocity = xs * math.cos(math.radians(angle)) + ys * math.sin(math.radians(angle))
            yield from self._told(velocity, "slide", things, f"slide along {_short(angle)}°")

    def _turns(self, thing: _Thing | None, xs: Floats, ys: Floats) -> Iterator[Motion]:
        at_x, at_y = np.flatnonzero(xs), np.flatnonzero(ys)
        things = self._whole_things(thing, xs + ys)
        # The x and y of places stand side by side.
        if self.is_done or not things or len(at_x) != len(at_y):
            return
        x, y = self.places[at_x].mean(), self.places[at_y].mean()
        turn = np.zeros(len(xs))
        turn[at_x], turn[at_y] = y - self.places[at_y], self.places[at_x] - x
        turn += self.turning * self._inside(thing)
        if np.linalg.norm(turn) <= POSSIBLE:
            return
        missing = np.stack((self._missing(xs), self._missing(ys)), axis=1)
        about, *_ = np.linalg.lstsq(missing, -self._missing(turn), rcond=1e-9)
        words = "turn"
        if np.linalg.norm(missing) > POSSIBLE:  # else it can turn about any place
            words = f"turn about ({_short(x - about[1])}, {_short(y + about[0])})"
        velocity = (turn + about[0] * xs + about[1] * ys) * DEGREE
        yield from self._told(velocity, "turn", things, words)

    def _turns_about_a_place(self, thing: _Thing) -> Iterator[Motion]:
        """Of a thing with places that stay, all of them the same."""
        at_x = np.flatnonzero(self.scene.axis[thing.start : thing.stop] == X) + thing.start
        places = np.stack((self.scene.places[at_x], self.scene.places[at_x + 1]))
        local = np.stack((self.local[at_x], self.local[at_x + 1]))
        stays = (local < 0).all(axis=0)
        if self.is_done or stays.all() or not stays.any() or not np.isfinite(places).all():
            return
        x, y = places[:, stays][:, 0]
        needed = np.stack((y - places[1], places[0] - x))
        if np.abs(needed[local < 0]).max() > POSSIBLE:
            return
        velocity = self.turning * self._inside(thing)
        velocity[local[local >= 0]] = needed[local >= 0]
        yield from self._told(
            velocity * DEGREE, "turn", [thing.path], f"turn about ({_short(x)}, {_short(y)})"
        )

    def _changes(self) -> Iterator[Motion]:
        """Single parameters that can change while nothing else does."""
        basis = self.part.basis
        inverse = np.linalg.pinv(basis)
        for i, u in enumerate(self.part.unknowns.tolist()):
            if self.is_done:
                return
            ways = inverse[:, i]
            alone = np.zeros(len(basis))
            alone[i] = 1.0
            if np.abs(basis @ ways - alone).max() > POSSIBLE:
                continue
            path = self.scene.lowered.unknowns[u].path
            yield from self._told(self.part.velocities @ ways, "change", [path], "change")

    def _growth(self, thing: _Thing | None, xs: Floats, ys: Floats) -> Iterator[Motion]:
        missing = np.stack((self._missing(xs), self._missing(ys)), axis=1)
        for mask, words in ((xs, "grow wider"), (ys, "grow taller")):
            if self.is_done or not mask.any() or not self._whole_things(thing, mask):
                continue
            velocity = mask * (self.places - float(self.places @ mask) / float(mask.sum()))
            shift, *_ = np.linalg.lstsq(missing, -self._missing(velocity), rcond=1e-9)
            if np.linalg.norm(velocity) > POSSIBLE:
                things = self._whole_things(thing, mask)
                yield from self._told(velocity + shift[0] * xs + shift[1] * ys, "grow", things, words)

    def _growth_from_a_place(self, thing: _Thing) -> Iterator[Motion]:
        """Of a thing with places that stay, all at one x or y."""
        own = slice(thing.start, thing.stop)
        for axis, words in ((X, "grow wider"), (Y, "grow taller")):
            along = self.scene.axis[own] == axis
            local, places = self.local[own][along], self.scene.places[own][along]
            stays = local < 0
            if self.is_done or stays.all() or not stays.any():
                continue
            needed = places - places[stays][0]
            if np.abs(needed[stays]).max() <= POSSIBLE:
                velocity = np.zeros(len(self.axis))
                velocity[local[~stays]] = needed[~stays]
                yield from self._told(velocity, "grow", [thing.path], words)

    def _rest(self) -> Iterator[Motion]:
        for column in _reduced(self.part.basis).T:
            if self.is_done:
                return
            ways, *_ = np.linalg.lstsq(self.part.basis, column, rcond=None)
            velocity = self.part.velocities @ ways
            things = [path for path, _ in self._cover(np.abs(velocity) > POSSIBLE * np.abs(velocity).max())]
            words = "move together" if len(things) > 1 else "change its shape"
            if not (np.abs(velocity) * (self.axis != NUMBER)).any():
                words = "change together"
            yield from self._told(velocity, "together", things, words)

    # --- Naming ------------------------------------------------------------------------------------

    def _whole_things(self, thing: _Thing | None, mask: Floats) -> list[str]:
        """The names of what moves as a whole; none if some of it does not."""
        if thing:
            return [thing.path]
        found = self._cover(mask > 0.0)
        return [path for path, _ in found] if all(whole for _, whole in found) else []

    def _cover(self, moving: Flags) -> list[tuple[str, bool]]:
        """Paths of what takes part, and whether all places of it do: structures, geometry and points of which
        that is so, then other geometry, then numbers.
        """
        left = np.zeros(len(self.local), dtype=np.bool_)
        left[self.part.observables[moving]] = True
        placed = np.isin(self.scene.axis, list(set(self.axis[moving].tolist()) - {NUMBER}))
        entire = left | ~placed
        found: list[tuple[int, str, bool]] = []
        things = {t for o in np.flatnonzero(left & placed).tolist() for t in self.scene.of[o]}
        for whole in (True, False):
            for thing in sorted(things, key=_gladly):
                own = slice(thing.start, thing.stop)
                fits = entire[own].all() if whole else thing.rank == GEOMETRY
                if fits and (left & placed)[own].any():
                    found.append((thing.start, thing.path, whole))
                    left[own] = False
        found += [(o, self.scene.number[o], True) for o in np.flatnonzero(left).tolist()]
        partly = tuple(f"{path}." for _, path, whole in found if not whole)
        return [(path, whole) for _, path, whole in sorted(found) if not path.startswith(partly)]


def _gladly(thing: _Thing) -> tuple[bool, int, int]:
    """The order in which things are named: structures before geometry and points, large before small."""
    return thing.rank in (GEOMETRY, POINT), thing.start - thing.stop, -thing.rank


def _reduced(basis: Floats) -> Floats:
    """The same space by vectors each of which has an unknown of its own, and so few entries. They do not
    depend on the basis: these unknowns are pivots of the projection onto the space.
    """
    rest = np.linalg.qr(basis)[0]
    own: list[int] = []
    for _ in range(basis.shape[1]):
        own.append(int(np.argmax(np.round((rest * rest).sum(axis=1), 6))))
        direction = rest[own[-1]] / np.linalg.norm(rest[own[-1]])
        rest = rest - np.outer(rest @ direction, direction)
    found: Floats = basis @ np.linalg.inv(basis[own])
    return found


def _short(value: float) -> str:
    return f"{round(value, 3) + 0.0:.6g}"

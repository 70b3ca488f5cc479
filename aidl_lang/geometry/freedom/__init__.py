"""The motions that are left, in words: those of the solver, taken apart into simple ones.

The solver tells for each part of the model which velocities are possible for what is drawn. Here simple
velocities are tried in turn: of points, geometry, structures and of all that keeps together in
every motion, the smallest first, a slide along an axis or another direction, and a turn; then changes of
single parameters, then growth. Each that is possible and new is told; what is left over is told as things
that move together. That the whole drawing can move as one is known beforehand, so nothing is told of it.
`bending` follows each a little further, `relations` finds against what a thing moves, `wording` makes the
report.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import field, replace
from itertools import groupby
from typing import TypeAlias

import numpy as np

from aidl_lang.building.expression import DEGREE, quoted
from aidl_lang.building.lower import Solved
from aidl_lang.building.model import Model
from aidl_lang.common.prose import counted, listed, short
from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Floats, Ints, Mask
from aidl_lang.geometry.freedom.scene import (
    GEOMETRY,
    NUMBER,
    POINT,
    ROOT,
    WHOLE,
    Bending,
    Relations,
    Scene,
    Thing,
    X,
    Y,
    pattern,
)
from aidl_lang.geometry.solved import Motion, SolvedModel
from aidl_lang.solver.analysis import Freedom, Part
from aidl_lang.solver.linear import each_once, scattered
from aidl_lang.solver.valuation import connected

# --- The motions possible in one part of a model, and the names of what moves.


WORK = 2_000_000
"""Numbers that the velocities of a part may have for every small thing to be tried."""
POSSIBLE = 1e-6
"""Relative error of a velocity that counts as none."""


@record(frozen=False)
class _Telling:
    """The motions of a part, by the velocities possible for it; `taken` are those told or known."""

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
        """Returns the index in the part of each of the scene's observables, -1 for others."""
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
        return velocity - self.reach @ (self.reach.T @ velocity)

    def is_possible(self, velocity: Floats) -> bool:
        return float(np.linalg.norm(self._missing(velocity))) <= POSSIBLE * float(np.linalg.norm(velocity))

    def know(self, velocity: Floats) -> None:
        """Takes up a motion among those that are known, unless it is a combination of them."""
        if (way := self._news(velocity)) is not None:
            self.taken.append(way)

    def _news(self, velocity: Floats) -> Floats | None:
        """Returns the unit part of a motion beyond those known, in the space of all; None if it has none."""
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
        """Tells whether a possible motion goes on as it begins: straight, or turning by `spin` radians."""
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
        return self.part.basis @ np.linalg.solve(self.triangle, self.reach.T @ velocity)

    def rates(self, velocity: Floats) -> dict[str, float]:
        """Returns the rates of the parameters that take part in a possible motion, by path."""
        rates = self._rates(velocity)
        least = POSSIBLE * float(np.abs(rates).max())
        return {
            self.scene.lowered.unknowns[u].path: float(rate)
            for u, rate in zip(self.part.unknowns.tolist(), rates.tolist(), strict=True)
            if abs(rate) > least
        }

    def _moving(self, velocity: Floats) -> Mask:
        return np.abs(velocity) > POSSIBLE * float(np.abs(velocity).max())

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
        """Returns the things that something of the part belongs to; of too many, no small ones."""
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

    def _cover(self, moving: Mask) -> list[tuple[str, bool]]:
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
            # Structures before geometry and points, large before small.
            for thing in sorted(
                things, key=lambda t: (t.rank in (GEOMETRY, POINT), t.start - t.stop, -t.rank)
            ):
                own = self.scene.own(thing)
                fits = entire[own].all() if whole else thing.rank == GEOMETRY
                if fits and (left & placed)[own].any():
                    found.append((thing.start, thing.path, whole))
                    left[own] = False
        rest = {self.scene.number[o]: o for o in reversed(np.flatnonzero(left).tolist())}
        found += [(o, path, path not in self.scene.known) for path, o in rest.items()]
        partly = tuple(f"{path}." for _, path, whole in found if not whole)
        return [(path, whole) for _, path, whole in sorted(found) if not path.startswith(partly)]

    # --- The motions, one after the other ----------------------------------------------------------

    def motions(self) -> Iterator[_Told]:
        if self.is_done:
            return
        things = self._things()
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

    # --- What may move as a whole ------------------------------------------------------------------

    def _things(self) -> list[_Masked]:
        """Returns what may move as a whole: things, the smallest first; then what keeps together along an
        axis in every motion, by the number of names it takes to tell; then everything.
        """
        tried: dict[bytes, _Masked] = {}
        for thing in self._near():
            own = self.scene.own(thing)
            _try(tried, thing, self._whole(own, X), self._whole(own, Y))
        for anchor in each_once(self.anchor).tolist():
            for axis in (X, Y):
                for together in self._clusters(anchor, axis):
                    _try(tried, None, self._whole(together, X), self._whole(together, Y))
        _try(tried, None, (self.axis == X).astype(float), (self.axis == Y).astype(float))
        return sorted(tried.values(), key=self._plainness)

    def _plainness(self, each: _Masked) -> tuple[int, float]:
        thing, xs, ys = each
        names = 1 if thing else len({pattern(path) for path, _ in self._cover(xs + ys > 0.0)})
        return names, float(xs.sum() + ys.sum())

    # --- Trying ------------------------------------------------------------------------------------

    def _told(
        self,
        velocity: Floats,
        kind: str,
        things: Sequence[str],
        words: str,
        moving: Mask | None = None,
        spin: float = 0.0,
    ) -> Iterator[_Told]:
        """Yields the motion with what moves in it, if it is possible and no combination of those found
        before. One that soon leaves its line or its centre is marked so; growth and change that soon take
        along something else are left out.
        """
        if self.is_done or not velocity.any() or not self.is_possible(velocity):
            return
        if (way := self._news(velocity)) is None:
            return
        if kind in _FOLLOWED and not self.goes_on(velocity, spin):
            if kind not in _LEAVING:
                return
            words = _LEAVING[kind].format(words.removeprefix("slide along "))
        self.taken.append(way)
        moving = self._moving(velocity) if moving is None else moving
        yield Motion(kind, tuple(things), words, self.rates(velocity)), self.part.observables[moving]

    def _slides(self, thing: Thing | None, xs: Floats, ys: Floats) -> Iterator[_Told]:
        things = self._whole_things(thing, xs + ys)
        if not things:
            return
        before = len(self.taken)
        yield from self._told(xs, "slide", things, "slide along x")
        yield from self._told(ys, "slide", things, "slide along y")
        if len(self.taken) > before or not (xs.any() and ys.any()):
            return
        missing = np.stack((self._missing(xs), self._missing(ys)), axis=1)
        _, sigma, vt = np.linalg.svd(missing, full_matrices=False)
        if sigma[1] <= POSSIBLE * float(np.linalg.norm(xs)) and np.abs(vt[1]).min() > POSSIBLE:
            angle = math.degrees(math.atan2(vt[1, 1], vt[1, 0])) % 180.0
            velocity = xs * math.cos(math.radians(angle)) + ys * math.sin(math.radians(angle))
            yield from self._told(velocity, "slide", things, f"slide along {short(angle, 3)}°")

    def _turns(self, thing: Thing | None, xs: Floats, ys: Floats) -> Iterator[_Told]:
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
            words = f"turn about ({short(x - about[1], 3)}, {short(y + about[0], 3)})"
        velocity = (turn + about[0] * xs + about[1] * ys) * DEGREE
        yield from self._told(velocity, "turn", things, words, spin=DEGREE)

    def _turns_about_a_place(self, thing: Thing) -> Iterator[_Told]:
        """Yields the turn of a thing whose resting places are all the same."""
        own = self.scene.own(thing)
        at_x = own[self.scene.axis[own] == X]
        places = np.stack((self.scene.places[at_x], self.scene.places[at_x + 1]))
        local = np.stack((self.at(at_x), self.at(at_x + 1)))
        stays = (local < 0).all(axis=0)
        if self.is_done or stays.all() or not stays.any() or not np.isfinite(places).all():
            return
        x, y = places[:, stays][:, 0]
        needed = np.stack((y - places[1], places[0] - x))
        if np.abs(needed[local < 0]).max() > POSSIBLE:
            return
        velocity = self.turning * self._inside(thing)
        velocity[local[local >= 0]] = needed[local >= 0]
        words = f"turn about ({short(x, 3)}, {short(y, 3)})"
        yield from self._told(velocity * DEGREE, "turn", [thing.path], words, spin=DEGREE)

    def _changes(self) -> Iterator[_Told]:
        """Yields single parameters that can change while nothing else does."""
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

    def _growth(self, thing: Thing | None, xs: Floats, ys: Floats) -> Iterator[_Told]:
        missing = np.stack((self._missing(xs), self._missing(ys)), axis=1)
        for mask, words in ((xs, "grow wider"), (ys, "grow taller")):
            if self.is_done or not mask.any() or not (things := self._whole_things(thing, mask)):
                continue
            velocity = mask * (self.places - float(self.places @ mask) / float(mask.sum()))
            shift, *_ = np.linalg.lstsq(missing, -self._missing(velocity), rcond=1e-9)
            if np.linalg.norm(velocity) > POSSIBLE:
                yield from self._told(velocity + shift[0] * xs + shift[1] * ys, "grow", things, words)

    def _growth_from_a_place(self, thing: Thing) -> Iterator[_Told]:
        """Yields the growth of a thing whose resting places all lie at one x or y."""
        own = self.scene.own(thing)
        for axis, words in ((X, "grow wider"), (Y, "grow taller")):
            along = self.scene.axis[own] == axis
            local, places = self.at(own)[along], self.scene.places[own][along]
            stays = local < 0
            if self.is_done or stays.all() or not stays.any():
                continue
            needed = places - places[stays][0]
            if np.abs(needed[stays]).max() <= POSSIBLE:
                velocity = np.zeros(len(self.axis))
                velocity[local[~stays]] = needed[~stays]
                yield from self._told(velocity, "grow", [thing.path], words)

    def _rest(self) -> Iterator[_Told]:
        for column in _reduced(self.part.basis).T:
            if self.is_done:
                return
            ways, *_ = np.linalg.lstsq(self.part.basis, column, rcond=None)
            velocity = self.part.velocities @ ways
            yield from self._opposed(velocity)
            moving = self._moving(velocity)
            things = [path for path, _ in self._cover(moving)]
            words = "move together" if len(things) > 1 else "change its shape"
            if all(self._is_turn(path, velocity) for path in things):
                words = "turn together" if len(things) > 1 else "turn"
            if not (moving & (self.axis != NUMBER)).any():
                words = "change together"
            yield from self._told(velocity, "together", things, words)

    def _opposed(self, velocity: Floats) -> Iterator[_Told]:
        """Yields the slide of two groups along one axis, each as a whole: one against the other."""
        moving = self._moving(velocity)
        for axis, words in ((X, "slide along x"), (Y, "slide along y")):
            if (self.axis[moving] != axis).any():
                continue
            first = float(velocity[moving][0])
            alike = moving & (np.abs(velocity - first) <= POSSIBLE * abs(first))
            rest = velocity[moving & ~alike]
            if not len(rest) or np.ptp(rest) > POSSIBLE * abs(float(rest[0])):
                continue
            masks = alike, moving & ~alike
            groups = [(self._whole_things(None, mask.astype(float)), mask) for mask in masks]
            if all(things for things, _ in groups):
                things, mask = min(groups, key=lambda group: len({pattern(path) for path in group[0]}))
                yield from self._told(velocity, "slide", things, words, mask)

    def _is_turn(self, path: str, velocity: Floats) -> bool:
        """Tells whether all places of a thing turn about one."""
        if (thing := self.scene.known.get(path)) is None:
            return False
        own = self.scene.own(thing)
        at = own[self.scene.axis[own] == X]
        x, y = self.scene.places[at], self.scene.places[at + 1]
        local = np.append(velocity, 0.0)  # at -1: what does not move
        u, v = local[self.at(at)], local[self.at(at + 1)]
        dx, dy = x - x.mean(), y - y.mean()
        spread = float((dx * dx + dy * dy).sum())
        turns = local[self.at(own)][self.scene.turning[own] > 0.0] * DEGREE
        speed = (
            float((dx * (v - v.mean()) - dy * (u - u.mean())).sum()) / spread
            if spread
            else float(turns[:1].sum())
        )
        away = np.hypot(u - u.mean() + speed * dy, v - v.mean() - speed * dx)
        return abs(speed) > 0.0 and float(away.max()) <= POSSIBLE * max(
            float(np.hypot(u, v).max()), abs(speed)
        )


# --- Independent motions, each as simple as was found.

MOST = 200
"""Parts of the model that are put into words."""

_KINDS = ("slide", "turn", "grow", "change", "together")
"""Kinds of motion of one thing, the more telling first."""
_FOLLOWED = frozenset(_KINDS) - {"together"}
_LEAVING = {"slide": "slide along a curve that begins along {}", "turn": "turn"}
"""Words for a motion that does not go on as it begins."""


def motions(model: Model, solution: Solved, freedom: Freedom) -> tuple[Motion, ...]:
    """Returns independent motions of a model, the most interesting first, those of the whole drawing last.
    Structures come before geometry, geometry before points and numbers; of these the large before the small,
    and equals in the order of the text.
    """
    if not freedom.motions.found:
        return ()
    scene = Scene(model, solution.problem, freedom.motions, Bending(solution))
    tellings = [_Telling(scene, part) for part in freedom.motions.parts]
    whole = list(_own_place(scene, tellings, model.root.path))
    found = [told for telling in tellings[:MOST] for told in telling.motions()]
    if not found:
        return tuple(whole)
    relations = Relations(model, scene)
    found.sort(key=lambda told: _interest(told, scene))
    return (*(replace(m, against=relations.against(m.things, at)) for m, at in found), *whole)


def _interest(told: _Told, scene: Scene) -> tuple[int, int, int, int]:
    motion, moving = told
    known = [thing for path in motion.things if (thing := scene.known.get(path)) is not None]
    rank = max((WHOLE if thing.rank == ROOT else thing.rank for thing in known), default=-1)
    size = sum(thing.stop - thing.start for thing in known)
    start = min((thing.start for thing in known), default=int(moving.min(initial=0)))
    return -rank, -size, start, _KINDS.index(motion.kind)


def _own_place(scene: Scene, tellings: Sequence[_Telling], root: str) -> Iterator[Motion]:
    """Yields the motions in which everything moves as one, as motions of the part of the model that most
    belongs to: then other motions are told of the others, and of what is small in it.
    """
    size = np.zeros(len(scene.places) + 1)
    for axis, words in ((X, "slide along x"), (Y, "slide along y"), (NUMBER, "turn")):
        pairs = [(t, velocity) for t in tellings if (velocity := t.of_all(axis)).any()]
        if not pairs or not _all_move(scene, tellings, axis):
            continue
        if axis == NUMBER and not _is_one(scene, [t for t, _ in pairs]):
            continue  # that several bodies turn as one is no more than that each of them is free
        if not all(t.is_possible(velocity) for t, velocity in pairs):
            continue
        largest, velocity = max(
            pairs, key=lambda pair: float(size[pair[0].part.observables].sum() + len(pair[1]))
        )
        # Motions along x and along y are often separate: both shall know the same things.
        size[largest.part.observables[velocity != 0.0] + 1] = len(size)
        largest.know(velocity)
        moves = {path: rate for t, each in pairs for path, rate in t.rates(each).items()}
        yield Motion("place", (root,), words, moves)


def _is_one(scene: Scene, tellings: Sequence[_Telling]) -> bool:
    """Tells whether the parts are connected by places with x in one of them and y in another."""
    part = np.full(len(scene.places) + 1, -1)
    for number, telling in enumerate(tellings):
        part[telling.part.observables] = number
    at = np.flatnonzero((scene.axis == X) & (part[:-1] >= 0) & (part[1:] >= 0))
    return not connected(part[at], part[at + 1], len(tellings)).any()


def _all_move(scene: Scene, tellings: Sequence[_Telling], axis: int) -> bool:
    """Tells whether every place moves along an axis; for a turn, along both."""
    stays = scene.anchor == 0
    stays &= (scene.axis == axis) if axis != NUMBER else (scene.axis != NUMBER)
    for telling in tellings:
        stays[telling.part.observables] = False
    return not stays.any()


_Masked: TypeAlias = tuple[Thing | None, Floats, Floats]
"""A thing, and its x and y among a part's observables as 0 and 1; None for what keeps together."""

_Told: TypeAlias = tuple[Motion, Ints]
"""A motion, and the observables that move in it."""


def _try(tried: dict[bytes, _Masked], thing: Thing | None, xs: Floats, ys: Floats) -> None:
    if xs.any() or ys.any():
        tried.setdefault(xs.tobytes() + ys.tobytes(), (thing, xs, ys))


def _reduced(basis: Floats) -> Floats:
    """Returns a basis of the same space whose vectors each have an unknown of their own, and so few entries.
    It does not depend on the given basis: these unknowns are pivots of the projection onto the space.
    """
    rest = np.linalg.qr(basis)[0]
    own: list[int] = []
    for _ in range(basis.shape[1]):
        own.append(int(np.argmax(np.round((rest * rest).sum(axis=1), 6))))
        direction = rest[own[-1]] / np.linalg.norm(rest[own[-1]])
        rest = rest - np.outer(rest @ direction, direction)
    return basis @ np.linalg.inv(basis[own])


# --- The report on what can still move: a line for each group of things that moves against the rest.

_NAMED = 3
"""The most things named in one line."""
_RUN = 3
"""Number of members of an array from which on the first and the last stand for all."""


@record()
class _Line:
    """The motions of things, each of them (`groups` of one thing or more) by itself."""

    groups: tuple[tuple[str, ...], ...]
    words: str
    kinds: frozenset[str]
    against: str


def report(model: SolvedModel, most: int | None = None) -> list[str]:
    """Returns sentences on what can still move against the rest, the most interesting first: "`receiver` can
    slide along x against `base`". Of more than `most` lines, those are left out whose kind of motion is among
    the lines before them. Counts the lines left out, and degrees of freedom beyond the motions listed.
    """
    lines = list(_lines(model.motions))
    shown = lines if most is None or len(lines) <= most else list(_chosen(lines, most))
    told = [_sentence(line, model.root.path) for line in shown]
    if left := len(lines) - len(shown):
        told.append(f"… and {left} more like {'this' if len(shown) == 1 else 'these'}")
    if (untold := (model.degrees or 0) - len(model.ways)) > 0:
        told.append(f"… and {counted(untold, 'more degree')} of freedom, not told apart")
    return told


def _chosen(lines: Sequence[_Line], most: int) -> Iterator[_Line]:
    """Yields the first of each kind, and as many others as there is room for; in their order."""
    kinds: dict[frozenset[str], _Line] = {}
    for line in lines:
        kinds.setdefault(line.kinds, line)
    room = most - 1 - len(kinds)
    for line in lines:
        if kinds[line.kinds] is line:
            yield line
        elif room > 0:
            room -= 1
            yield line


def _lines(motions: Iterable[Motion]) -> Iterator[_Line]:
    """Yields one line for all motions of the same things; alike members of an array share one."""
    told: dict[tuple[str, ...], list[Motion]] = {}
    for motion in motions:
        told.setdefault(motion.things, []).append(motion)
    alike: dict[object, list[_Line]] = {}
    for things, ways in told.items():
        against = next((way.against for way in ways if way.against), "")
        line = _Line((things,), _words(ways), frozenset(way.kind for way in ways), against)
        alike.setdefault((tuple(map(pattern, things)), line.words), []).append(line)
    for members in alike.values():
        first = members[0]
        same = first.against if all(line.against == first.against for line in members) else ""
        yield _Line(tuple(line.groups[0] for line in members), first.words, first.kinds, same)


def _words(ways: Sequence[Motion]) -> str:
    slides = [way.words.removeprefix("slide along ") for way in ways if way.kind == "slide"]
    others = [way.words for way in ways if way.kind != "slide"]
    repeated = [
        f"{words} in {count} ways" if (count := others.count(words)) > 1 else words
        for words in dict.fromkeys(others)
    ]
    slides.sort(key=lambda way: (way.startswith("a curve"), way))
    return listed([f"slide along {listed(slides)}"] * bool(slides) + repeated)


def _sentence(line: _Line, root: str) -> str:
    things = list(dict.fromkeys(thing for group in line.groups for thing in group))
    each = " each" if len(line.groups) > 1 else ""
    together = " together" if not each and len(things) > 1 and not line.words.endswith("together") else ""
    against = f" against {_name(line.against, root)}" if line.against and not line.kinds <= _ALONE else ""
    return f"{_named(things, root)} can{each}{together} {line.words}{against}"


_ALONE = frozenset({"grow", "change", "together"})
"""Motions that are told without a word on what is around."""


def _named(paths: Sequence[str], root: str) -> str:
    names: list[str] = []
    rest = len(paths)
    for run in _runs(paths):
        if len(names) == _NAMED and rest > len(run):
            break
        if len(run) >= _RUN:
            names.append(f"{_name(run[0], root)} … {_name(run[-1], root)}")
        else:
            names += [_name(path, root) for path in run]
        rest -= len(run)
    return listed([*names, f"{rest} more"] if rest else names)


def _runs(paths: Sequence[str]) -> Iterator[list[str]]:
    """Yields members of one array that stand side by side, and all other things by themselves."""
    for key, run in groupby(paths, key=lambda path: pattern(path) if "[" in path else path):
        found = list(run)
        if key in found or len(found) < _RUN:
            yield from ([path] for path in found)
        else:
            yield found


def _name(path: str, root: str) -> str:
    return quoted(path.removeprefix(f"{root}."))

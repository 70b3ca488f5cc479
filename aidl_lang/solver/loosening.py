"""Who gives way when the rows of a stage contradict each other.

At the point where a search ends, what is left of its linearised rows is out of reach: no move of what is free
brings them nearer to zero. Whoever can help has a share in that rest. Of these the cheapest class that
suffices is taken, of that as few parts as can be found, and of each part as few things; among equals, those
that make the way shortest. A set is found by taking what leaves least of the rest, and so on (orthogonal
matching pursuit; Pati, Rezaiifar and Krishnaprasad, Asilomar 1993), and leaving out what proves idle.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver.gradients import gradients
from aidl_lang.solver.operations import Floats
from aidl_lang.solver.problem import Relation
from aidl_lang.solver.tiers import DEEP, ENDLESS, POSITIONS, RIDING

if TYPE_CHECKING:
    from aidl_lang.solver.hierarchy import Hierarchy
    from aidl_lang.solver.tiers import Scope, Tier, Tiers

NOTHING = 1e-6
"""Part of the rest, or of a column, that counts as none."""
MANY = 200_000
"""Entries of the linearised rows above which only parts that help themselves are looked at."""

BOUNDS = 3
"""Rounds of counting inequalities that a step would break."""

Giver: TypeAlias = tuple[tuple[object, ...], list[int]]
"""What gives way as one: a key by which those that help alike are ordered, and its columns."""


def givers(
    hierarchy: Hierarchy, tiers: Tiers, scope: Scope, taken: Collection[int], before: Mapping[int, float]
) -> frozenset[int]:
    """Returns the unknowns that shall give way besides those of `scope`, whose rows are left as they are at
    the current values, found on the way from those `before`; none if nobody can help. Parts of which some are
    `taken` already come first.
    """
    return _Loosening(hierarchy, tiers, scope, taken, before).givers()


@record()
class _Rest:
    """Linearised rows (r,) at a point, over free unknowns (f,) and k that are not.

    free    (r, f) the slopes along the free ones
    others  (r, k) those along the others; `columns` (r, k) without what the free ones reach
    lack    (r,) what the rows need, counted from where the search began
    rest    (r,) the part of it that the free ones do not reach
    owner   (r,) the constraint of each row
    """

    free: Floats
    others: Floats
    lack: Floats
    columns: Floats
    rest: Floats
    owner: Sequence[int]

    @cached_property
    def size(self) -> float:
        return float(np.linalg.norm(self.rest))

    @cached_property
    def contrary(self) -> frozenset[int]:
        """The constraints whose rows contradict each other."""
        shares = zip(self.owner, self.rest, strict=True)
        return frozenset(index for index, share in shares if abs(share) > NOTHING * self.size)

    @cached_property
    def changes(self) -> Floats:
        """The change (k,) by which each of the others by itself takes up most of the rest."""
        square = np.einsum("rk,rk->k", self.columns, self.columns)
        found: Floats = (self.rest @ self.columns) / np.where(square > 0.0, square, np.inf)
        return found

    def left(self, chosen: Sequence[int]) -> float:
        """Returns the part of the rest that is left when some columns have taken up what they can; 0 if that
        is nothing.
        """
        basis = _basis(self.columns[:, chosen])
        left = float(np.linalg.norm(self.rest - basis @ (basis.T @ self.rest))) / self.size
        return left if left > NOTHING else 0.0

    def way(self, chosen: Sequence[int]) -> float:
        """Returns the length of the shortest move of the free unknowns and some others that will do."""
        matrix = np.hstack((self.free, self.others[:, chosen]))
        return float(np.linalg.norm(np.linalg.lstsq(matrix, self.lack, rcond=NOTHING)[0]))

    def fewest(self, among: Sequence[Giver], given: Sequence[int]) -> list[int]:
        """Returns the columns of as few of these as take up, beside those `given`, what all of them can."""
        chosen: list[Giver] = []
        left = self.left(given)
        goal = self.left([*given, *(k for _, columns in among for k in columns)])
        while left > goal + NOTHING:
            held = [*given, *(k for _, columns in chosen for k in columns)]
            tried = [(self.left([*held, *each[1]]), each) for each in among if each not in chosen]
            least = min((length for length, _ in tried), default=left)
            if least >= left * (1.0 - NOTHING):
                break
            ties = [each for length, each in tried if length <= least + NOTHING]
            best = ties[0]
            if len(ties) > 1:
                best = min(ties, key=lambda e: (*e[0], round(self.way([*held, *e[1]]), 6)))
            left = least
            chosen.append(best)
        for each in reversed(chosen[:-1]):
            others = [k for other in chosen if other is not each for k in other[1]]
            if self.left([*given, *others]) <= left:
                chosen.remove(each)
        return sorted({k for _, columns in chosen for k in columns})


class _Loosening:
    def __init__(
        self,
        hierarchy: Hierarchy,
        tiers: Tiers,
        scope: Scope,
        taken: Collection[int],
        before: Mapping[int, float],
    ) -> None:
        self.hierarchy, self.tiers, self.scope = hierarchy, tiers, scope
        self.before, self.taken = before, frozenset(taken)
        self.parts = {int(hierarchy.problem.group[unknown]) for unknown in taken}
        self._free_are(scope.free)
        is_large = len(hierarchy.rows(scope.constraints)) * len(scope.free) > MANY
        self.constraints = hierarchy.unmet(scope.constraints) if is_large else scope.constraints
        """Constraints that contradict each other, maybe among others."""
        thing = hierarchy.problem.thing
        self.thing = thing if thing.any() else np.arange(len(thing))

    def _free_are(self, free: frozenset[int]) -> None:
        self.free = sorted(free)
        values = self.hierarchy.values.unknowns
        moved = np.array([values[unknown] - self.before[unknown] for unknown in self.free])
        self.moved = moved / self.hierarchy.problem.scale[self.free]

    def givers(self) -> frozenset[int]:
        found = self._found()
        if not found and self.taken:
            # They would do by their slopes, but did not: somebody else has to.
            self._free_are(self.scope.free - self.taken)
            found = self._found()
        return found

    def _found(self) -> frozenset[int]:
        found = frozenset[int]()
        for locked, limit in self._circles():
            rest = self._rest(self._binding(locked), locked)
            if not rest.size:
                break
            dear = [self._dearness(unknown) for unknown in locked]
            lost = self._vanishing(rest, locked)
            for last in sorted(set(dear)):
                able = [k for k, dearness in enumerate(dear) if dearness <= last and k not in lost]
                if not rest.left(able):
                    found = self._few(rest, locked, dear, able)
                    break
            else:
                continue
            if last[0] < limit:
                break
        return found

    def _vanishing(self, rest: _Rest, locked: Sequence[int]) -> set[int]:
        """Returns the columns of sizes that would vanish, were they to take up the rest; none of them as long
        as no size was tried.
        """
        if not any(map(self.hierarchy.is_kept, self.taken)):
            return set()
        values, scale = self.hierarchy.values.unknowns, self.hierarchy.problem.scale
        change = rest.changes * scale[list(locked)]
        return {
            k
            for k, size in enumerate(locked)
            if self.tiers.tier(size) > POSITIONS and values[size] * (values[size] + change[k]) <= 0.0
        }

    def _few(
        self, rest: _Rest, locked: Sequence[int], dear: Sequence[tuple[Tier, int]], able: list[int]
    ) -> frozenset[int]:
        """Returns few things in few parts, of those that are `able` (columns), that take up the rest: of the
        dearest class what all cheaper ones leave of it, and so on down.
        """
        able.sort(key=lambda k: self.hierarchy.name(locked[k]))
        found: list[int] = []
        for dearness in sorted({dear[k] for k in able}, reverse=True):
            given = [*found, *(k for k in able if dear[k] < dearness)]
            parts = self._grouped([k for k in able if dear[k] == dearness], lambda k: self._part(locked[k]))
            keys = [self._key(rest, locked, order, each) for order, each in enumerate(parts)]
            chosen = set(rest.fewest(list(zip(keys, parts, strict=True)), given))
            things = self._grouped(
                [k for k in able if k in chosen], lambda k: ("thing", int(self.thing[locked[k]]))
            )
            found += rest.fewest([((), each) for each in things], given)
        return frozenset(locked[k] for k in found)

    def _dearness(self, unknown: int) -> tuple[Tier, int]:
        """Returns the class of an unknown: its tier, and in that first what moves, then what stretches.
        Within parts sizes that are free to change come before both.
        """
        tier, axis = self.tiers.tier(unknown), self.hierarchy.problem.axis
        if self.hierarchy.is_kept(unknown):
            return tier, 2
        return tier, int(tier < DEEP or axis is None or axis[unknown] >= 0)

    @staticmethod
    def _grouped(columns: list[int], name: Callable[[int], tuple[str, int]]) -> list[list[int]]:
        found: dict[tuple[str, int], list[int]] = {}
        for k in columns:
            found.setdefault(name(k), []).append(k)
        return list(found.values())

    def _circles(self) -> Iterator[tuple[list[int], Tier]]:
        """Yields unknowns that may give way, in growing circles, each with the tier below which it settles
        who does: the positions in the parts that have a share in the rest, all positions, and the same with
        sizes.
        """
        hierarchy = self.hierarchy
        problem, tier = hierarchy.problem, self.tiers.tier
        mentioned = frozenset[int]().union(*map(hierarchy.mentions.__getitem__, self.constraints))
        known = sorted(self.tiers.everything(self.scope.constraints).free - self.scope.free)
        is_small = len(known) * len(self.scope.constraints) <= MANY
        for last in (POSITIONS, ENDLESS):
            locked = sorted(u for u in mentioned - self.scope.free if tier(u) < last)
            if not locked:
                continue
            rest = self._rest(self.constraints, locked)
            share, length = np.abs(rest.rest @ rest.columns), np.linalg.norm(rest.columns, axis=0)
            helping = {locked[k] for k in np.flatnonzero(share > NOTHING * length * rest.size)}
            groups = {int(problem.group[u]) for u in helping if tier(u) < POSITIONS}
            around = [
                u for u in known if u in helping or (int(problem.group[u]) in groups and tier(u) < POSITIONS)
            ]
            if helping:
                yield around, RIDING if is_small else last
                if is_small:
                    yield [u for u in known if tier(u) < last], last

    def _binding(self, locked: Sequence[int]) -> list[int]:
        """Returns the constraints of the scope, and those that bind unknowns outside of it."""
        hierarchy = self.hierarchy
        found = {i for unknown in locked for i in hierarchy.solved_mentioning(unknown, self.tiers.group)}
        return sorted(filter(hierarchy.is_hard, found.union(self.constraints)))

    def _rest(self, constraints: Sequence[int], locked: Sequence[int]) -> _Rest:
        """Returns the rest of the rows of some constraints. An inequality counts where it does not hold, or
        would not after the step by which the free unknowns satisfy those that do.
        """
        hierarchy = self.hierarchy
        hierarchy.refresh(constraints)
        owned = [(row, index) for index in constraints for row in hierarchy.rows([index])]
        place = {unknown: k for k, unknown in enumerate([*self.free, *locked])}
        matrix = np.zeros((len(owned), len(place)))
        ends = None if any(map(hierarchy.is_kept, place)) else hierarchy.values.still()
        slopes = gradients(hierarchy.values, [row.expression for row, _ in owned], ends=ends)
        for i, (row, _) in enumerate(owned):
            for unknown, slope in slopes[row.expression].items():
                if unknown in place:
                    matrix[i, place[unknown]] = slope / row.scale
        matrix = np.nan_to_num(matrix * hierarchy.problem.scale[list(place)])
        nodes = hierarchy.values.nodes
        lack = np.nan_to_num(np.array([-nodes[row.expression] / row.scale for row, _ in owned]))
        free = matrix[:, : len(self.free)]
        counts = np.array([row.relation is Relation.EQUAL for row, _ in owned]) | (
            lack < -hierarchy.settings.tolerance
        )
        for _ in range(BOUNDS):
            basis = _basis(free[counts])
            rest = lack[counts] - basis @ (basis.T @ lack[counts])
            if float(np.linalg.norm(rest)) > NOTHING * float(np.linalg.norm(lack[counts])):
                break
            rest[:] = 0.0
            step = np.linalg.lstsq(free[counts], lack[counts], rcond=NOTHING)[0]
            broken = ~counts & (lack - free @ step < -hierarchy.settings.tolerance)
            if not broken.any():
                break
            counts |= broken
        others = matrix[counts, len(self.free) :]
        columns = others - basis @ (basis.T @ others)
        columns[:, np.linalg.norm(columns, axis=0) <= NOTHING * np.linalg.norm(others, axis=0)] = 0.0
        lack = lack[counts] + free[counts] @ self.moved
        owner = [index for (_, index), counted in zip(owned, counts, strict=True) if counted]
        return _Rest(free[counts], others, lack, columns, rest, owner)

    def _part(self, unknown: int) -> tuple[str, int]:
        """Returns what gives way with an unknown: a size, a frame, or the inside of a group."""
        problem = self.hierarchy.problem
        if self.tiers.tier(unknown) > POSITIONS:
            return "size", unknown
        if problem.frame_of[unknown] >= 0:
            return "frame", int(problem.frame_of[unknown])
        return "inside", int(problem.group[unknown])

    def _key(self, rest: _Rest, locked: Sequence[int], order: int, columns: list[int]) -> tuple[object, ...]:
        """Returns what decides between parts of a class that help alike: whether they give way already; of
        sizes, whether a constraint that contradicts others places them, and how much of them changes.
        """
        hierarchy, size = self.hierarchy, locked[columns[0]]
        if self.tiers.tier(size) < POSITIONS:
            return (int(hierarchy.problem.group[size]) not in self.parts,)
        value, change = hierarchy.values.unknowns[size], rest.changes[columns[0]]
        part = abs(float(change) / value) if value else np.inf
        is_placed = any(size in hierarchy.problem.constraints[i].placed for i in rest.contrary)
        return not is_placed, round(part, 6), order


def _basis(matrix: Floats) -> Floats:
    """Returns an orthonormal basis (r, d) of what the columns of a matrix (r, k) reach."""
    length = np.linalg.norm(matrix, axis=0)
    unit = matrix[:, length > 0.0] / length[length > 0.0]
    if not unit.size:
        return np.zeros((len(matrix), 0))
    u, sigma, _ = np.linalg.svd(unit, full_matrices=False)
    found: Floats = u[:, sigma > NOTHING * sigma[0]]
    return found

"""Which constraints of a failed group cannot hold together, each of them needed, and what would fit instead.

The suspects are named by the place where the search stalled (`suspects`). If they fail together they are
reduced: by QuickXplain (Junker, AAAI 2004), in which halves of the constraints are background for one
another, so that k culprits among n are found in about k log(n / k) solves; then by leaving out each member in
turn. What is left is minimal: without any one of them the others hold, and where they do, the member that was
left out says what it would have to ask for instead.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from aidl_lang.solver import branches
from aidl_lang.solver.branches import Task, violation_of
from aidl_lang.solver.gradients import gradients
from aidl_lang.solver.newton import Clock, End, perturbation
from aidl_lang.solver.problem import Relation
from aidl_lang.solver.solution import Failure, Fit, GroupFailure, Member
from aidl_lang.solver.suspects import Linearised, suspects

if TYPE_CHECKING:
    from aidl_lang.solver.group import Scope
    from aidl_lang.solver.hierarchy import Hierarchy

WORK = 20_000
"""Budget of all explanations of one solve: rows times unknowns, summed over the attempts."""
SECONDS = 2.0
"""Time for one explanation, should the budget not be spent by then."""
PATIENCE = 4.0
"""Seconds after the first failure for which explanations are sought at all."""
RESTARTS = 2
"""Perturbed starts for each set that is tried."""
THOROUGH = 5
"""Perturbed starts before a set is called contradictory."""
GIVE, PASSES = 1e-2, 4
"""Unit of the slack of a member whose least violation is sought, in the units of its row, and how often it is
sought, each time from the last place: a slack so dear that once is enough would be lost in rounding.
"""
COSTLY = 1000
"""Work beyond which it is not tried what would fit."""
CURVED = 1e-6
"""Change of a slope, relatively, that shows that a row is not affine."""
SAME = 1e-6
"""Relative difference by which one place is not better than another."""
MANY = 12
"""Suspects above which halves of them are tried before single ones."""


@dataclass(frozen=True)
class _Trial:
    """How an attempt ended, and the values of the free unknowns there."""

    end: End
    reached: dict[int, float]

    @property
    def holds(self) -> bool:
        return self.end is End.CONVERGED


def explain(
    hierarchy: Hierarchy,
    group: int,
    violated: Sequence[int],
    scope: Scope,
    before: dict[int, float],
    best: dict[int, float],
) -> GroupFailure:
    """Why the constraints of `scope` cannot hold with its unknowns free, starting from `before`.

    `best` is the closest that the stages came.
    """
    hierarchy.values.assign(best.items())
    unmet = tuple(_Search.member(hierarchy, index) for index in violated)
    if hierarchy.timed_out:
        return GroupFailure(group, Failure.TIMED_OUT, unmet)
    if not hierarchy.settings.explain:
        return GroupFailure(group, Failure.NOT_CONVERGED, unmet)
    return _Search(hierarchy, scope, before).explain(group, best)


def conflict(hierarchy: Hierarchy, scope: Scope, before: dict[int, float]) -> tuple[list[int], bool]:
    """A set among the constraints of `scope` that cannot hold together with its unknowns free, starting from
    `before`, and whether it is known to be minimal; an empty set if all of them can.
    """
    hierarchy.values.assign(before.items())
    search = _Search(hierarchy, scope, before)
    trial = search._try(tuple(sorted(scope.constraints)))
    if trial.holds:
        return [], True
    found = search._conflict(trial.reached)
    return found, not search._spent


@dataclass
class _Search:
    hierarchy: Hierarchy
    scope: Scope
    before: dict[int, float]
    clock: Clock = field(init=False)
    trials: dict[tuple[int, ...], _Trial] = field(default_factory=dict)
    left: int = field(init=False)
    work: int = 0

    def __post_init__(self) -> None:
        hierarchy = self.hierarchy
        self.clock = Clock(min(SECONDS, hierarchy.patience.left, hierarchy.clock.left / 2.0))
        self.left = WORK - sum(failure.work for failure in hierarchy.failures)

    def explain(self, group: int, best: dict[int, float]) -> GroupFailure:
        hierarchy = self.hierarchy
        conflict = self._conflict(best)
        minimal = not self._spent
        thorough = self._attempt(tuple(conflict), THOROUGH)
        hierarchy.values.assign(thorough.reached.items())
        members = [self.member(hierarchy, index) for index in conflict]
        moving, equations = self._count(conflict)
        reason = Failure.NOT_CONVERGED
        if minimal and thorough.end in (End.INFEASIBLE, End.CONTRARY):
            excess = equations > len(moving) > 0 and self._curved(conflict)
            reason = Failure.OVERDETERMINED if excess else Failure.CONTRADICTORY
            members = [replace(m, fit=self._fit(m.index, conflict, thorough.reached)) for m in members]
        hierarchy.values.assign(self.before.items())
        return GroupFailure(group, reason, tuple(members), minimal, moving, equations, self.work)

    @staticmethod
    def member(hierarchy: Hierarchy, index: int) -> Member:
        """The constraint and how far it is off at the current values."""
        hierarchy.refresh([index])
        return Member(index, max(violation_of(row, hierarchy.values) for row in hierarchy.rows([index])))

    # -- the set

    def _conflict(self, best: dict[int, float]) -> list[int]:
        """A set that cannot hold together; minimal unless the budget was spent."""
        found = next((c for c in self._candidates(best) if not self._holds(c)), None)
        if found is None:
            return self._violated(best)
        if len(found) > MANY:
            found = self._halve([], False, found)
        for index in list(found):
            rest = [other for other in found if other != index]
            if not self._spent and not self._holds(rest):
                found = rest
        return sorted(found)

    def _candidates(self, best: dict[int, float]) -> Iterator[list[int]]:
        """Sets that may fail, those first that are likely to be small."""
        hierarchy, scope = self.hierarchy, self.scope
        hierarchy.values.assign(best.items())
        yield suspects(hierarchy, scope.constraints, scope.free)
        yield self._violated(best)
        yield from self._connected()

    def _violated(self, best: dict[int, float]) -> list[int]:
        self.hierarchy.values.assign(best.items())
        return self.hierarchy.unmet(self.scope.constraints)

    def _connected(self) -> Iterator[list[int]]:
        """The constraints by free unknowns that they share, directly or by others; at last all of them."""
        hierarchy, free = self.hierarchy, self.scope.free
        groups: list[tuple[set[int], list[int]]] = []
        for index in self.scope.constraints:
            unknowns, members = set(hierarchy.mentions[index] & free), [index]
            apart = []
            for other, indices in groups:
                if other.isdisjoint(unknowns):
                    apart.append((other, indices))
                else:
                    unknowns |= other
                    members = indices + members
            groups = [*apart, (unknowns, members)]
        yield from (sorted(members) for _, members in groups)
        yield list(self.scope.constraints)

    def _halve(self, background: list[int], grown: bool, candidates: list[int]) -> list[int]:
        """A smallest part of `candidates` that fails together with `background`."""
        if grown and not self._holds(background):
            return []
        if len(candidates) <= 1 or self._spent:
            return candidates
        half = len(candidates) // 2
        first, second = candidates[:half], candidates[half:]
        from_second = self._halve(background + first, True, second)
        from_first = self._halve(background + from_second, bool(from_second), first)
        return from_first + from_second

    # -- what there is to say of it

    def _count(self, conflict: Sequence[int]) -> tuple[tuple[int, ...], int]:
        """The unknowns that could move for the conflict, and the number of its equations."""
        hierarchy = self.hierarchy
        mentioned = frozenset().union(*map(hierarchy.mentions.__getitem__, conflict))
        rows = hierarchy.rows(conflict)
        return tuple(sorted(mentioned & self.scope.free)), sum(r.relation is Relation.EQUAL for r in rows)

    def _curved(self, conflict: Sequence[int]) -> bool:
        """Whether the slopes of the rows depend on the place."""
        hierarchy = self.hierarchy
        roots = [row.expression for row in hierarchy.rows(conflict)]
        free = sorted(self.scope.free)
        aside = perturbation(len(free)) * hierarchy.problem.scale[free]
        here = hierarchy.save(free)
        slopes = []
        for values in (here, {u: here[u] + step for u, step in zip(free, aside.tolist(), strict=True)}):
            hierarchy.values.assign(values.items())
            hierarchy.refresh(conflict)
            found = gradients(hierarchy.values, roots)
            slopes.append(np.array([found[root].get(u, 0.0) for root in roots for u in free]))
        hierarchy.values.assign(here.items())
        return bool(np.abs(slopes[0] - slopes[1]).max() > CURVED * np.abs(slopes[0]).max())

    def _fit(self, index: int, conflict: Sequence[int], stalled: dict[int, float]) -> Fit | None:
        """What `index` would ask for if it gave way as little as the others allow: all of the scope if
        possible, else those of the conflict.
        """
        hierarchy, everything = self.hierarchy, self.scope.constraints
        for others in (everything, tuple(conflict)):
            rest = tuple(other for other in others if other != index)
            if self._cost(others) > COSTLY or not (trial := self._try(rest)).holds:
                continue
            places = [trial.reached, *self._nearer(index, rest, trial.reached, stalled)]
            residuals = [self._residuals(index, place) for place in places]
            lacks = [self._lack(index, found) for found in residuals]
            best = next(i for i, lack in enumerate(lacks) if lack <= (1.0 + SAME) * min(lacks))
            hierarchy.values.assign(places[0].items())
            pinned = Linearised(hierarchy, (*rest, index), self.scope.free).implies(index)
            hierarchy.values.assign(self.before.items())
            regardless = residuals[best if pinned else 0]
            return Fit(residuals[best], regardless, tuple(sorted(places[best].items())))
        return None

    def _nearer(
        self, index: int, rest: tuple[int, ...], reached: dict[int, float], stalled: dict[int, float]
    ) -> Iterator[dict[int, float]]:
        """Places where `rest` holds and `index` may lack less: that nearest to where the search for all of
        them stalled, and that at which a slack given to `index` is least.
        """
        hierarchy, free = self.hierarchy, self.scope.free
        if (projected := self._attempt(rest, 0, stalled)).holds:
            yield projected.reached
        hard, soft = hierarchy.rows(rest), hierarchy.rows([index])
        task = Task([*hard, *soft], [0.0] * len(hard) + [GIVE / row.scale for row in soft], free)
        for _ in range(PASSES):
            self.work += self._cost(rest)
            hierarchy.values.assign(reached.items())
            found = branches.attempt(task, hierarchy.values, hierarchy.metric, hierarchy.settings, self.clock)
            if not found.satisfied:
                break
            reached = hierarchy.save(free)
        yield reached

    def _residuals(self, index: int, reached: dict[int, float]) -> tuple[float, ...]:
        hierarchy = self.hierarchy
        hierarchy.values.assign(reached.items())
        hierarchy.refresh([index])
        return tuple(hierarchy.values.nodes[row.expression] for row in hierarchy.rows([index]))

    def _lack(self, index: int, residuals: Sequence[float]) -> float:
        """How far the rows are from holding together; infinite if one has no value."""
        rows = self.hierarchy.rows([index])
        lacks = [
            max(value, 0.0) if row.relation is Relation.AT_MOST else value
            for row, value in zip(rows, residuals, strict=True)
        ]
        length = float(np.linalg.norm(lacks))
        return length if length == length else np.inf

    # -- trying

    @property
    def _spent(self) -> bool:
        return self.clock.expired or self.work >= self.left

    def _holds(self, constraints: Sequence[int]) -> bool:
        return self._try(tuple(sorted(constraints))).holds

    def _try(self, constraints: tuple[int, ...]) -> _Trial:
        if constraints not in self.trials:
            empty = _Trial(End.CONVERGED, self.before)
            self.trials[constraints] = self._attempt(constraints, RESTARTS) if constraints else empty
        return self.trials[constraints]

    def _cost(self, constraints: Sequence[int]) -> int:
        unknowns = frozenset().union(*map(self.hierarchy.mentions.__getitem__, constraints))
        return len(self.hierarchy.rows(constraints)) * len(unknowns & self.scope.free)

    def _attempt(
        self, constraints: tuple[int, ...], restarts: int, start: dict[int, float] | None = None
    ) -> _Trial:
        """From `start`, or from where the group was; leaves the values where the group was."""
        hierarchy = self.hierarchy
        self.work += self._cost(constraints)
        hierarchy.values.assign((start or self.before).items())
        end = hierarchy.attempt(replace(self.scope, constraints=constraints), restarts, self.clock).end
        reached = hierarchy.save(self.scope.free)
        hierarchy.values.assign(self.before.items())
        return _Trial(end, reached)

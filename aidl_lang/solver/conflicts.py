"""Which constraints of a failed group cannot hold together: a smallest set, each member needed.

QuickXplain (Junker, AAAI 2004): halves of the constraints are tried as background for one another, so that k
culprits among n are found in about k log(n / k) solves. What is found is verified by solving without each
member in turn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from aidl_lang.solver.newton import Clock, End
from aidl_lang.solver.solution import Failure, GroupFailure

if TYPE_CHECKING:
    from aidl_lang.solver.hierarchy import Hierarchy, Scope

SECONDS = 2.0
"""Time for one explanation."""
RESTARTS = 2
"""Perturbed starts for each set that is tried."""
THOROUGH = 5
"""Perturbed starts before a set is called contradictory."""


def explain(
    hierarchy: Hierarchy,
    group: int,
    violated: Sequence[int],
    scope: Scope,
    before: dict[int, float],
    best: dict[int, float],
) -> GroupFailure:
    """Why the constraints of `scope` cannot hold with its unknowns free, starting from `before`.

    `best` is the closest that the stages came: where no step leads on, the gradients of the rows that are
    violated cancel, so that the culprits are among these.
    """
    if hierarchy.timed_out:
        return GroupFailure(group, Failure.TIMED_OUT, tuple(violated), False)
    if not hierarchy.settings.explain:
        return GroupFailure(group, Failure.NOT_CONVERGED, tuple(violated), False)
    hierarchy.values.assign(best.items())
    suspects = [index for index in scope.constraints if not hierarchy.satisfied(index)]
    search = _Search(hierarchy, scope, before)
    conflict = search.conflict(suspects)
    minimal = not search.clock.expired and search.is_minimal(conflict)
    reason = Failure.CONTRADICTORY if search.contradicts(conflict) else Failure.NOT_CONVERGED
    return GroupFailure(group, reason, tuple(sorted(conflict)), minimal)


class _Search:
    def __init__(self, hierarchy: Hierarchy, scope: Scope, before: dict[int, float]) -> None:
        self.hierarchy, self.scope, self.before = hierarchy, scope, before
        self.clock = Clock(min(SECONDS, hierarchy.clock.left / 2.0))
        self._ends: dict[tuple[int, ...], End] = {}

    def conflict(self, suspects: list[int]) -> list[int]:
        """A set that cannot hold together, among `suspects` if possible; minimal unless the time ran out."""
        candidates = self._connected() if self._holds(suspects) else suspects
        return self._reduce([], False, candidates)

    def is_minimal(self, conflict: Sequence[int]) -> bool:
        return all(self._holds([other for other in conflict if other != index]) for index in conflict)

    def contradicts(self, conflict: Sequence[int]) -> bool:
        """Whether even a thorough search ends where no step leads on, and not for lack of steps."""
        return self._try(tuple(conflict), THOROUGH) in (End.INFEASIBLE, End.CONTRARY)

    def _reduce(self, background: list[int], grown: bool, candidates: list[int]) -> list[int]:
        """A smallest part of `candidates` that fails together with `background`."""
        if grown and not self._holds(background):
            return []
        if len(candidates) <= 1 or self.clock.expired:
            return candidates
        half = len(candidates) // 2
        first, second = candidates[:half], candidates[half:]
        from_second = self._reduce(background + first, True, second)
        from_first = self._reduce(background + from_second, bool(from_second), first)
        return from_first + from_second

    def _connected(self) -> list[int]:
        """The constraints that share free unknowns, directly or by others, with one that fails alone."""
        hierarchy, free = self.hierarchy, self.scope.free
        groups: list[tuple[set[int], list[int]]] = []
        for index in self.scope.constraints:
            unknowns, members = set(hierarchy.cones[index].unknowns & free), [index]
            apart = []
            for other, indices in groups:
                if other.isdisjoint(unknowns):
                    apart.append((other, indices))
                else:
                    unknowns |= other
                    members = indices + members
            groups = [*apart, (unknowns, members)]
        failing = (sorted(members) for _, members in groups if not self._holds(members))
        return next(failing, list(self.scope.constraints))

    def _holds(self, constraints: Sequence[int]) -> bool:
        return self._end(constraints) is End.CONVERGED

    def _end(self, constraints: Sequence[int]) -> End:
        key = tuple(sorted(constraints))
        if key not in self._ends:
            self._ends[key] = self._try(key, RESTARTS) if key else End.CONVERGED
        return self._ends[key]

    def _try(self, constraints: tuple[int, ...], restarts: int) -> End:
        hierarchy = self.hierarchy
        hierarchy.values.assign(self.before.items())
        end = hierarchy.attempt(replace(self.scope, constraints=constraints), restarts, self.clock).end
        hierarchy.values.assign(self.before.items())
        return end

"""The constraints that a stalled search accuses: those whose linearised rows cannot hold together.

Where no step leads on, some combination y of the rows has no slope in any direction, yet is not zero there:
Jᵀ y = 0, y · r ≠ 0, y >= 0 for inequalities. That is Farkas' proof that the linearised rows contradict each
other, and the rows with y ≠ 0 are the suspects. They are thinned out until each is needed, which makes the
proof one of the sparsest (Gleeson and Ryan, Identifying minimally infeasible subsystems of inequalities,
ORSA Journal on Computing 2, 1990). In an affine problem the suspects are a conflict; in others, a good guess.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from aidl_lang.solver.gradients import gradients
from aidl_lang.solver.hierarchy import Hierarchy
from aidl_lang.solver.linear import nearest
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.operations import Floats
from aidl_lang.solver.problem import Problem, Relation, Settings
from aidl_lang.solver.refuting import Relaxation
from aidl_lang.solver.tiers import Scope

FAINT = 1e-3
"""Singular values of unit rows that count as none: the search stops near the singular place, not on it."""
SHARE = 1e-6
"""Part of the greatest multiplier below which a row takes no part."""
MANY = 12
"""Members of a set above which halves of it are tried before single ones."""
FAR = 100.0
"""The longest step that counts as mending rows, in sizes of the rows."""
RESTARTS = 3
"""Perturbed starts."""
FEW = 40
"""Rows up to which all of `within` is searched for together."""


class Linearised:
    """The rows of constraints at the current values, each divided by its slope.

    jacobian   (r, k) unit rows over the free unknowns; zero rows where nothing free changes a row
    distance   (r,) how far each row is from zero, as the shortest step that would bring it there
    inequality (r,)
    owner      (r,) the constraint of each row
    """

    def __init__(self, hierarchy: Hierarchy, constraints: Sequence[int], free: Iterable[int]) -> None:
        rows = hierarchy.rows(constraints)
        hierarchy.refresh(constraints)
        found = gradients(hierarchy.values, [row.expression for row in rows])
        columns = {unknown: k for k, unknown in enumerate(sorted(free))}
        self.jacobian = np.zeros((len(rows), len(columns)))
        self.distance = np.zeros(len(rows))
        self.inequality = np.array([row.relation is Relation.AT_MOST for row in rows], dtype=np.bool_)
        self.owner = np.array(hierarchy.owners(constraints), dtype=np.intp)
        scale = hierarchy.problem.scale
        for i, row in enumerate(rows):
            for unknown, slope in found[row.expression].items():
                if unknown in columns:
                    self.jacobian[i, columns[unknown]] = slope * scale[unknown]
            self.distance[i] = hierarchy.values.nodes[row.expression]
        self.jacobian, self.distance = np.nan_to_num(self.jacobian), np.nan_to_num(self.distance)
        length = np.linalg.norm(self.jacobian, axis=1)
        size = np.array([row.scale for row in rows])
        flat = length * size <= FAINT * np.abs(self.distance)
        self.jacobian[flat] = 0.0
        length = np.where(flat, 1.0, length)
        self.jacobian /= length[:, None]
        self.distance /= length
        self.reach = FAR * float(size.max(initial=1.0))

    def accused(self) -> list[int]:
        """Returns the constraints in the left null space of the rows that are violated or tight."""
        rows = ~self.inequality | (self.distance > -1e-9 * self.reach)
        jacobian, distance = self.jacobian[rows], self.distance[rows]
        gram = jacobian @ jacobian.T + FAINT**2 * np.eye(len(jacobian))
        multipliers = np.abs(np.linalg.solve(gram, distance))
        part = multipliers > SHARE * multipliers.max(initial=0.0)
        return sorted(set(self.owner[rows][part].tolist()))

    def can_hold(self, constraints: Iterable[int]) -> bool:
        """Tells whether the linearised rows of these constraints hold together within a sensible distance."""
        rows: NDArray[np.bool_] = np.isin(self.owner, list(constraints))
        target: Floats = -self.distance[rows]
        step = nearest(self.jacobian[rows], target, self.inequality[rows])
        return step.feasible and float(np.abs(step.point).max(initial=0.0)) <= self.reach


def suspects(hierarchy: Hierarchy, constraints: Sequence[int], free: Iterable[int]) -> list[int]:
    """Returns a set of constraints whose linearised rows contradict each other at the current values, each
    needed for that; empty if there is none.
    """
    rows = Linearised(hierarchy, constraints, free)
    accused = rows.accused()
    if rows.can_hold(accused):
        return []
    return needed(accused, rows.can_hold)


def needed(failing: Sequence[int], holds: Callable[[list[int]], bool]) -> list[int]:
    """Returns a smallest part of a failing set that still fails: tries halves of a large set first, then
    leaves out each member in turn.
    """
    found = list(failing)
    if len(found) > MANY:
        found = _halved([], False, found, holds)
    for index in list(found):
        rest = [other for other in found if other != index]
        if not holds(rest):
            found = rest
    return sorted(found)


def _halved(
    background: list[int], grown: bool, candidates: list[int], holds: Callable[[list[int]], bool]
) -> list[int]:
    """Returns a smallest part of `candidates` that fails together with the `background`, which has `grown`
    since it last held, by QuickXplain (Junker, AAAI 2004): halves are background for one another, so that k
    culprits among n are found in about k log(n / k) trials.
    """
    if grown and not holds(background):
        return []
    if len(candidates) <= 1:
        return candidates
    half = len(candidates) // 2
    first, second = candidates[:half], candidates[half:]
    from_second = _halved(background + first, True, second, holds)
    from_first = _halved(background + from_second, bool(from_second), first, holds)
    return from_first + from_second


def shortfall(
    problem: Problem,
    settings: Settings,
    constraints: Collection[int],
    within: Collection[int],
    start: Mapping[int, float],
) -> float:
    """Returns the violation that constraints keep with the unknowns of `start` free; 0 if a search from there
    satisfies them. If all of `within` are affine, but for choices, and are proved to contradict each other,
    it is measured on all of them: in units of its own, it then changes linearly with a number among them.
    """
    hierarchy = Hierarchy(problem, settings, Clock(settings.seconds))
    hierarchy.refresh(within)
    rows, free = hierarchy.rows(within), frozenset(start)
    relaxation = Relaxation(hierarchy.values, rows, free, settings.tolerance)
    if not relaxation.bends and (off := relaxation.lack()) > 0.0:
        return off
    first, least = hierarchy.save(free), np.inf
    searched = within if len(rows) <= FEW else constraints
    for place in (start, first):
        hierarchy.values.assign(place.items())
        verdict = hierarchy.attempt(Scope(free, tuple(sorted(searched))), RESTARTS)
        least = min(least, 0.0 if verdict.satisfied else verdict.violation)
    return least


def nearby_solution(
    problem: Problem, settings: Settings, constraints: Collection[int], start: Mapping[int, float]
) -> dict[int, float] | None:
    """Returns values near those of `start` at which constraints hold with its unknowns free; None if no
    search found any.
    """
    hierarchy = Hierarchy(problem, settings, Clock(settings.seconds))
    hierarchy.values.assign(start.items())
    verdict = hierarchy.attempt(Scope(frozenset(start), tuple(sorted(constraints))), RESTARTS)
    return hierarchy.save(start) if verdict.satisfied else None


def equations(
    problem: Problem, settings: Settings, constraints: Sequence[int], place: Mapping[int, float]
) -> list[Floats]:
    """Returns the unit slopes (r, k) of the equations of each constraint at `place`, over its unknowns."""
    hierarchy = Hierarchy(problem, settings, Clock(settings.seconds))
    hierarchy.values.assign(place.items())
    there = Linearised(hierarchy, constraints, place)
    return [there.jacobian[(there.owner == index) & ~there.inequality] for index in constraints]


def residual(problem: Problem, settings: Settings, constraint: int, place: Mapping[int, float]) -> float:
    """Returns the value of the row of a constraint that is furthest from zero at `place`, with its sign."""
    hierarchy = Hierarchy(problem, settings, Clock(settings.seconds))
    hierarchy.values.assign(place.items())
    hierarchy.refresh([constraint])
    rows = hierarchy.rows([constraint])
    return max((hierarchy.values.nodes[row.expression] for row in rows), key=abs)

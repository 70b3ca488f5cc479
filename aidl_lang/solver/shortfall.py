"""The distance of some constraints of a problem from holding together."""

from __future__ import annotations

from collections.abc import Collection, Mapping

import numpy as np

from aidl_lang.solver.hierarchy import Hierarchy
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.problem import Problem, Settings
from aidl_lang.solver.refuting import Relaxation
from aidl_lang.solver.tiers import Scope

RESTARTS = 3
"""Perturbed starts."""
FEW = 40
"""Rows up to which all of `within` is searched for together."""


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


def residual(problem: Problem, settings: Settings, constraint: int, place: Mapping[int, float]) -> float:
    """Returns the value of the row of a constraint that is furthest from zero at `place`, with its sign."""
    hierarchy = Hierarchy(problem, settings, Clock(settings.seconds))
    hierarchy.values.assign(place.items())
    hierarchy.refresh([constraint])
    rows = hierarchy.rows([constraint])
    return max((hierarchy.values.nodes[row.expression] for row in rows), key=abs)

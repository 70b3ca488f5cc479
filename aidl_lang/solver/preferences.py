"""Preferences: soft constraints, met as well as the hard ones allow.

They are first tried as if they were hard. If that fails, each gets a slack, an unknown of its own that is
dear (the dearer, the greater the weight); those that then hold but for the give of their slack are made
exact.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from aidl_lang.solver.branches import Task, attempt, violation_of

if TYPE_CHECKING:
    from aidl_lang.solver.hierarchy import Hierarchy
    from aidl_lang.solver.tiers import Scope

FIRMNESS = 1e-5
"""Unit of the slack of a preference of weight 1: its cost compared with moving things."""
NEARLY = 1e-6
"""Weighted violation of a preference that is due to the slack alone."""


def prefer(hierarchy: Hierarchy, scope: Scope, soft: tuple[int, ...]) -> bool:
    """Moves the free unknowns of `scope` towards the preferences; returns whether all of them hold then."""
    before = hierarchy.save(scope.free)
    if hierarchy.attempt(scope, 1).satisfied:
        return True
    hierarchy.values.assign(before.items())
    hard = [index for index in scope.constraints if hierarchy.is_hard(index)]
    rows = hierarchy.rows(hard)
    softness = [0.0] * len(rows)
    for index in soft:
        weight = hierarchy.problem.constraints[index].weight or 0.0
        for row in hierarchy.problem.constraints[index].rows if weight > 0.0 else ():
            rows.append(row)
            softness.append(FIRMNESS / float(np.sqrt(weight)))
    cost = _cost(hierarchy, soft)
    task = Task(rows, softness, scope.free)
    verdict = attempt(task, hierarchy.values, hierarchy.metric, hierarchy.settings, hierarchy.clock)
    if not verdict.satisfied or not _cost(hierarchy, soft) < cost:
        hierarchy.values.assign(before.items())
    else:
        _meet_exactly(hierarchy, scope, hard, soft)
    return False


def _meet_exactly(hierarchy: Hierarchy, scope: Scope, hard: list[int], soft: tuple[int, ...]) -> None:
    """Makes the preferences exact that hold but for the give of their slack."""
    nearly = [index for index in soft if _cost(hierarchy, (index,)) < NEARLY**2]
    reached = hierarchy.save(scope.free)
    if not hierarchy.attempt(replace(scope, constraints=tuple(sorted([*hard, *nearly]))), 0).satisfied:
        hierarchy.values.assign(reached.items())


def _cost(hierarchy: Hierarchy, soft: tuple[int, ...]) -> float:
    """Returns the weighted sum of squares of the violations of preferences."""
    total = 0.0
    hierarchy.refresh(soft)
    for index in soft:
        constraint = hierarchy.problem.constraints[index]
        for row in constraint.rows:
            lack = violation_of(row, hierarchy.values) / row.scale
            total += (constraint.weight or 0.0) * lack * lack
    return total

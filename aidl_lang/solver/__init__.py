"""The constraint solver: `solve(problem) -> Solution`. It knows nothing of the language.

In the order of reading: `operations`, `expression` (the tape), `problem`, `valuation`, `freezing`,
`program` (evaluation), `quadratic`, `newton` (one smooth system), `branches` (one attempt), `hierarchy`
(the stages at each group), `preferences`, `conflicts`, `analysis` (degrees of freedom), `solution`.
"""

from __future__ import annotations

from aidl_lang.solver import analysis
from aidl_lang.solver.branches import violation_of
from aidl_lang.solver.hierarchy import Hierarchy
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.problem import Constraint, Problem, Relation, Row, Settings
from aidl_lang.solver.solution import Solution, Status

__all__ = ["Constraint", "Problem", "Relation", "Row", "Settings", "Solution", "Status", "solve"]


def solve(problem: Problem, settings: Settings = Settings()) -> Solution:
    """Solves `problem` as far as it can be solved. Same input, same output, to the last digit."""
    hierarchy = Hierarchy(problem, settings, Clock(settings.seconds))
    hierarchy.run()
    values = hierarchy.values
    residuals, satisfied = [], []
    for index, constraint in enumerate(problem.constraints):
        satisfied.append(hierarchy.satisfied(index))
        residuals.append(max((violation_of(row, values) for row in constraint.rows), default=0.0))
    freedom = analysis.UNCOUNTED
    if len(problem.observables) * len(problem.initial) <= settings.counted:
        freedom = analysis.degrees_of_freedom(problem, values, satisfied, hierarchy.mentioned)
    return Solution(
        status=_status(hierarchy, satisfied),
        values=hierarchy.solution(),
        residuals=tuple(residuals),
        satisfied=tuple(satisfied),
        changed=tuple(hierarchy.changed()),
        degrees=freedom.degrees,
        group_degrees=freedom.group_degrees,
        free=freedom.free,
        redundant=freedom.redundant,
        failures=tuple(hierarchy.failures),
        stages=tuple(hierarchy.stages),
    )


def _status(hierarchy: Hierarchy, satisfied: list[bool]) -> Status:
    hard = [index for index in range(len(satisfied)) if hierarchy.is_hard(index)]
    if all(satisfied[index] for index in hard):
        return Status.SOLVED
    if hierarchy.timed_out or not any(satisfied[index] for index in hard):
        return Status.FAILED
    return Status.PARTIAL

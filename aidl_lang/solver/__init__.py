"""The constraint solver: `solve(problem) -> Solution`. It knows nothing of the language.

In the order of reading: `operations`, `expression` (the tape), `problem`, `valuation`, `freezing`,
`program` (evaluation), `quadratic`, `newton` (one smooth system), `branches` (one attempt), `hierarchy`
(the stages at each group), `preferences`, `conflicts`, `solution`. What is said of a solution afterwards is
in `analysis`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from aidl_lang.solver.hierarchy import Hierarchy
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.problem import Constraint, Problem, Relation, Row, Settings
from aidl_lang.solver.solution import Solution, Status

__all__ = ["Constraint", "Problem", "Relation", "Row", "Settings", "Solution", "Status", "solve"]


def solve(problem: Problem, settings: Settings = Settings()) -> Solution:
    """Solves `problem` as far as it can be solved. Same input, same output, to the last digit."""
    hierarchy = Hierarchy(problem, settings, Clock(settings.seconds))
    with np.errstate(all="ignore"):  # what overflows is found not to hold
        hierarchy.run()
    violation, rows = hierarchy.violations(), problem.rows
    residuals = np.zeros(len(problem.holder))
    np.maximum.at(residuals, rows.constraint, violation)
    satisfied = np.ones(len(problem.holder), dtype=np.bool_)
    satisfied[rows.constraint[~(violation <= settings.tolerance * rows.scale)]] = False
    return Solution(
        status=_status(satisfied[np.isnan(problem.weight)], hierarchy.timed_out),
        values=hierarchy.reached,
        residuals=tuple(residuals.tolist()),
        satisfied=tuple(satisfied.tolist()),
        changed=tuple(hierarchy.changed()),
        failures=tuple(hierarchy.failures),
        stages=tuple(hierarchy.stages),
    )


def _status(satisfied: NDArray[np.bool_], timed_out: bool) -> Status:
    """From which of the hard constraints hold."""
    if satisfied.all():
        return Status.SOLVED
    if timed_out or not satisfied.any():
        return Status.FAILED
    return Status.PARTIAL

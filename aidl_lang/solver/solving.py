"""Solves a problem."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from aidl_lang.solver.hierarchy import Hierarchy
from aidl_lang.solver.memory import Memory, Recollection
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.problem import Problem
from aidl_lang.solver.settings import Settings, Stages
from aidl_lang.solver.solution import Solution, Status


def solve(problem: Problem, settings: Settings = Settings(), memory: Memory | None = None) -> Solution:
    """Solves `problem` as far as it can be solved. Same input, same output, to the last digit.

    With a `memory`, which is brought up to date, only what has changed since its last solve is solved.
    """
    if settings.stages is Stages.FLAT:
        problem = replace(problem, holder=np.zeros_like(problem.holder))
    hierarchy = Hierarchy(problem, settings, Clock(settings.seconds))
    recollection = None if memory is None else Recollection(memory, problem, settings)
    with np.errstate(all="ignore"):  # what overflows is found not to hold
        hierarchy.run(recollection)
    violation, rows = hierarchy.violations(), problem.rows
    residuals = np.zeros(len(problem.holder))
    np.maximum.at(residuals, rows.constraint, violation)
    satisfied = np.ones(len(problem.holder), dtype=np.bool_)
    satisfied[rows.constraint[~(violation <= settings.tolerance * rows.scale)]] = False
    status = _status(satisfied[np.isnan(problem.weight)], hierarchy.timed_out)
    if recollection is not None:
        recollection.close(hierarchy.stages, status is Status.SOLVED and not hierarchy.failures)
    return Solution(
        status=status,
        values=hierarchy.reached,
        residuals=tuple(residuals.tolist()),
        satisfied=tuple(satisfied.tolist()),
        changed=tuple(hierarchy.changed()),
        failures=tuple(hierarchy.failures),
        stages=tuple(hierarchy.stages),
    )


def _status(satisfied: NDArray[np.bool_], timed_out: bool) -> Status:
    """Returns the status by which of the hard constraints hold."""
    if satisfied.all():
        return Status.SOLVED
    if timed_out or not satisfied.any():
        return Status.FAILED
    return Status.PARTIAL

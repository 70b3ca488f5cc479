"""What the solver answers: an outcome as data, never an exception."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from aidl_lang.solver.problem import Floats


class Status(StrEnum):
    SOLVED = "solved"
    """Every hard constraint holds."""
    PARTIAL = "partial"
    """Some groups could be solved, others not; the values are the best reached."""
    FAILED = "failed"
    """Nothing useful holds together; the values are the best reached."""


class Failure(StrEnum):
    """Why a group could not be solved."""

    CONTRADICTORY = "contradictory"
    NOT_CONVERGED = "not converged"
    TIMED_OUT = "timed out"


@dataclass(frozen=True)
class GroupFailure:
    """A group whose constraints could not be met.

    `conflict` are indices of constraints that cannot hold together, minimal when `minimal`.
    """

    group: int
    reason: Failure
    conflict: tuple[int, ...]
    minimal: bool


@dataclass(frozen=True)
class StageReport:
    """One stage tried while solving one group; for tracing and for tests of the order of stages."""

    group: int
    stage: str
    unknowns: int
    rows: int
    succeeded: bool


@dataclass(frozen=True)
class Solution:
    """
    values         (n,) solved unknowns
    residuals      per constraint, the largest violation of its rows (0 for an inequality that holds),
                   evaluated on the original expressions at `values`, in the units of the row
    satisfied      per constraint
    changed        unknowns of kept sizes that had to change
    degrees        degrees of freedom left in the whole model (kept sizes held); None if the model is too
                   large for them to be counted (`Settings.counted`), then `free` and `redundant` are empty
    group_degrees  the same for what each group itself draws
    free           unknowns that can still move (kept ones never do)
    redundant      equality constraints already implied by others
    stages         what was tried, in order
    """

    status: Status
    values: Floats
    residuals: tuple[float, ...]
    satisfied: tuple[bool, ...]
    changed: tuple[int, ...]
    degrees: int | None
    group_degrees: tuple[int, ...] | None
    free: tuple[int, ...]
    redundant: tuple[int, ...]
    failures: tuple[GroupFailure, ...]
    stages: tuple[StageReport, ...]

"""What the solver answers: an outcome as data, never an exception."""

from __future__ import annotations

from dataclasses import dataclass, field
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
    """The search for the conflict ends from several starts with the same violation."""
    OVERDETERMINED = "over-determined"
    """The same, and curved equations ask more of the unknowns than they are: it is not for their values."""
    NOT_CONVERGED = "not converged"
    TIMED_OUT = "timed out"


@dataclass(frozen=True)
class Fit:
    """What a member of a conflict would ask for, were it to give way to the others.

    residuals  of its rows, where the others hold and it lacks least: `a == 9` would hold as `a == 6` where
               its residual is -3
    regardless of its rows, where the others hold and it has no say: the same, unless they leave a choice
    values     (unknown, value) at the former place
    """

    residuals: tuple[float, ...]
    regardless: tuple[float, ...]
    values: tuple[tuple[int, float], ...] = field(repr=False)


@dataclass(frozen=True)
class Member:
    """A constraint in a conflict. `off` is its greatest violation where the search came nearest, in the units
    of its row; `fit` is None where it is not known.
    """

    index: int
    off: float
    fit: Fit | None = None


@dataclass(frozen=True)
class GroupFailure:
    """A group whose constraints could not be met.

    members   constraints that cannot hold together, by index; without any one of them the others hold when
              `minimal`, else they are those that were violated
    moving    the unknowns that could move for them
    equations the number of their rows that are equations
    work      rows times unknowns of the attempts that this took
    """

    group: int
    reason: Failure
    members: tuple[Member, ...]
    minimal: bool = False
    moving: tuple[int, ...] = ()
    equations: int = 0
    work: int = 0

    @property
    def conflict(self) -> tuple[int, ...]:
        """The indices of the members."""
        return tuple(member.index for member in self.members)


@dataclass(frozen=True, eq=False)
class Giving:
    """What moved at a stage though it is dear: kept sizes, frames that stood where their content is exact,
    what rides along. The values (n,) were those before the stage; `reasons.reasons` finds who left no other
    way.

    unknowns    those that gave way
    free        all that could move
    constraints those that bound them
    """

    unknowns: frozenset[int]
    free: frozenset[int]
    constraints: tuple[int, ...]
    values: Floats


@dataclass(frozen=True)
class StageReport:
    """One stage tried while solving one group; for tracing and for tests of the order of stages."""

    group: int
    stage: str
    unknowns: int
    rows: int
    succeeded: bool
    gave: Giving | None = None


@dataclass(frozen=True)
class Solution:
    """
    values         (n,) solved unknowns
    residuals      per constraint, the largest violation of its rows (0 for an inequality that holds),
                   evaluated on the original expressions at `values`, in the units of the row
    satisfied      per constraint
    changed        unknowns of kept sizes that had to change
    stages         what was tried, in order
    """

    status: Status
    values: Floats
    residuals: tuple[float, ...]
    satisfied: tuple[bool, ...]
    changed: tuple[int, ...]
    failures: tuple[GroupFailure, ...]
    stages: tuple[StageReport, ...]

"""The solution of a problem: the result as data, never an exception."""

from __future__ import annotations

from dataclasses import field
from enum import StrEnum

from aidl_lang.common.records import record
from aidl_lang.solver.problem import Floats


class Status(StrEnum):
    SOLVED = "solved"
    """Every hard constraint holds."""
    PARTIAL = "partial"
    """Some groups could be solved, others not; the values are the best reached."""
    FAILED = "failed"
    """No useful set of constraints holds together; the values are the best reached."""


class Failure(StrEnum):
    """Reason for which a group could not be solved."""

    CONTRADICTORY = "contradictory"
    """A proof refuted it, or the search for the conflict failed from many places."""
    OVERDETERMINED = "over-determined"
    """The same, but there are more equations than unknowns and some are curved: other values would not
    help.
    """
    NOT_CONVERGED = "not converged"
    TIMED_OUT = "timed out"


@record()
class Member:
    """A constraint in a conflict. `off` is its greatest violation where the search came nearest, in the units
    of its row.
    """

    index: int
    off: float


@record()
class GroupFailure:
    """A group whose constraints could not be met.

    members   constraints that cannot hold together, by index; without any one of them the others hold when
              `minimal`, else they are those that were violated
    moving    the unknowns that could move for them
    equations the number of their rows that are equations
    work      rows times unknowns of the attempts that this took
    holds_elsewhere True if the members hold at `nearest` after all, found from another place than the first
              guesses
    within    all constraints that took part in the search, by index
    nearest   (unknown, value) where the search for the members came nearest, of all that was free
    gaps      (member, residual of its one row where the others hold), if equations alone contradict
    is_curved True if the slopes of the members' rows depend on the place
    sizes     the kept sizes in members that hang on no position, as `a.radius == 6` does
    """

    group: int
    reason: Failure
    members: tuple[Member, ...]
    minimal: bool = False
    moving: tuple[int, ...] = ()
    equations: int = 0
    work: int = 0
    holds_elsewhere: bool = False
    within: tuple[int, ...] = field(default=(), repr=False)
    nearest: tuple[tuple[int, float], ...] = field(default=(), repr=False)
    gaps: tuple[tuple[int, float], ...] = ()
    is_curved: bool = False
    sizes: frozenset[int] = frozenset()

    @property
    def conflict(self) -> tuple[int, ...]:
        """The indices of the members."""
        return tuple(member.index for member in self.members)


@record(eq=False)
class Concession:
    """The dear unknowns that moved at a stage: kept sizes, frames that stood where their content is exact,
    unknowns that ride along. The values (n,) are those before the stage; `reasons.reasons` finds the
    constraints that asked for it.

    unknowns    those that gave way
    free        all that could move
    constraints those that bound them
    """

    unknowns: frozenset[int]
    free: frozenset[int]
    constraints: tuple[int, ...]
    values: Floats


@record()
class StageReport:
    """One stage tried while solving one group; for tracing and for tests of the order of stages."""

    group: int
    stage: str
    unknowns: int
    rows: int
    succeeded: bool
    concession: Concession | None = None
    despite: tuple[int, ...] = ()
    """The constraints that no search from the first guesses satisfied, where one from elsewhere did."""


@record()
class Solution:
    """
    values         (n,) solved unknowns
    residuals      per constraint, the largest violation of its rows (0 for an inequality that holds),
                   evaluated on the original expressions at `values`, in the units of the row
    satisfied      per constraint
    changed        unknowns of kept sizes that had to change
    stages         the stages tried, in order
    """

    status: Status
    values: Floats
    residuals: tuple[float, ...]
    satisfied: tuple[bool, ...]
    changed: tuple[int, ...]
    failures: tuple[GroupFailure, ...]
    stages: tuple[StageReport, ...]

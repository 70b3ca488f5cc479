"""The input of the solver and its output, as plain data."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import field, replace
from enum import StrEnum
from functools import cached_property
from typing import Any, Generic, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver import Settings as Settings
from aidl_lang.solver.expression import Tape

# --- The input of the solver: unknowns, expressions and constraints over a tree of groups, as plain arrays.
#
# Nothing here knows of the language. A *group* is what a structure is to the language: it owns unknowns and
# constraints, and has a parent. A constraint held by a group mentions only unknowns of that group's subtree.

Floats = NDArray[np.float64]


class Relation(StrEnum):
    EQUAL = "="
    """`expression == 0`"""
    AT_MOST = "<="
    """`expression <= 0`"""


@record()
class Row:
    """One scalar equation or inequality over the tape.

    `scale` is the magnitude of a typical value of the expression (mm for lengths, 57.3 for an angle in
    degrees, 1 for a ratio): the row holds when its residual is within `Settings.tolerance * scale`.
    """

    expression: int
    relation: Relation
    scale: float = 1.0


@record()
class Constraint:
    """One constraint as the author sees it; a coincidence of points is two rows.

    `placed` are the unknowns that may move first to satisfy it (language design, section 7: what gives way).
    `weight` is None for a hard constraint, else the constraint is a preference.
    `whole` are the groups it names as a whole, by their box or their place, `inside` those in which it names
    something; they count where the problem is `named`.
    """

    group: int
    rows: tuple[Row, ...]
    placed: frozenset[int]
    weight: float | None = None
    whole: frozenset[int] = frozenset()
    inside: frozenset[int] = frozenset()


@record()
class Rows:
    """The rows of all constraints as arrays, those of one constraint side by side and in order.

    expression (r,) tape node
    at_most    (r,) True for `<= 0`, False for `== 0`
    scale      (r,) see `Row`
    constraint (r,) the constraint that each row belongs to, ascending
    """

    expression: NDArray[np.intp]
    at_most: NDArray[np.bool_]
    scale: Floats
    constraint: NDArray[np.intp]


@record()
class Problem:
    """n unknowns, g groups, c constraints with r rows.

    initial  (n,) first guesses
    scale    (n,) length of a change that counts as one unit: the solver prefers the change for which
             sum(((x - initial) / scale)**2) is least
    kept     (n,) True for sizes that change only as a last resort (stage 5)
    group    (n,) the group that owns each unknown
    frame_of (n,) for a translation of a group's frame, that group; else -1. A frame's unknowns are owned by
             the parent of the group they move.
    axis     (n,) 0 for a coordinate of a place along x in its group's frame, 1 along y, -1 for anything else
    longest  (n,) the largest change of each unknown in one Newton step: a sixth of a turn for an angle, so
             that it does not spin near a singular place; infinite for others
    parent   (g,) parent of each group, -1 for the root, which is group 0; parents come before children
    holder   (c,) the group that holds each constraint
    weight   (c,) NaN for a hard constraint, else the weight of the preference
    placed   (2, k) pairs of a constraint and an unknown that may move first to satisfy it, by constraint
    whole    (2, k) pairs of a constraint and a group that it names as a whole, by its box or its place
    inside   (2, k) pairs of a constraint and a group in which it names something
    named    whether these pairs are known; else there is nothing but what the rows mention (see `hierarchy`)
    standing (n,) True for a frame that was written where its content counts as exact: held when others can
             move
    spanned  (n,) True for a kept size that was read off two places: what a constraint places, it may stretch
    rigid    (g,) True for a group of which constraints around it name one thing at most: it moves as a whole,
             and what is in it moves against its frame only as if no constraint named it
    sealed   (n,) depth of the innermost group around an unknown in which nothing moves for constraints of the
             groups around it; 0 for none, -1 for the root
    thing    (n,) the same number for unknowns that are one thing to move, as the coordinates of a point:
             as few things as can be found are moved. If all are one, what is nearest is sought and no more.
    clinging the groups that belong to what is drawn around them, in which no freedom is told where they ride
             along
    observables: (group, tape node) for each coordinate that a reader of the drawing could see move, in the
             root's frame: degrees of freedom are counted on these, so that a frame and its contents
             moving against each other do not count.
    """

    tape: Tape
    initial: Floats
    scale: Floats
    kept: NDArray[np.bool_]
    group: NDArray[np.intp]
    frame_of: NDArray[np.intp]
    parent: NDArray[np.intp]
    rows: Rows
    holder: NDArray[np.intp]
    weight: Floats
    placed: NDArray[np.intp]
    whole: NDArray[np.intp]
    inside: NDArray[np.intp]
    named: bool = False
    axis: NDArray[np.intp] = field(default_factory=lambda: np.zeros(0, dtype=np.intp))
    longest: Floats = field(default_factory=lambda: np.zeros(0))
    standing: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, dtype=np.bool_))
    spanned: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, dtype=np.bool_))
    rigid: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, dtype=np.bool_))
    sealed: NDArray[np.intp] = field(default_factory=lambda: np.zeros(0, dtype=np.intp))
    thing: NDArray[np.intp] = field(default_factory=lambda: np.zeros(0, dtype=np.intp))
    clinging: frozenset[int] = frozenset()
    observables: tuple[tuple[int, int], ...] = ()
    names: tuple[str, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        """Fills in what is not given: nothing is a place along an axis, stands, or is rigid, steps have no
        limit, and all unknowns are one thing.
        """
        for name in ("axis", "longest", "standing", "spanned", "rigid", "sealed", "thing"):
            given, wanted = getattr(self, name), len(self.parent if name == "rigid" else self.initial)
            if len(given) != wanted:
                value = {"axis": -1, "longest": np.inf}.get(name, 0)
                object.__setattr__(self, name, np.full(wanted, value, dtype=given.dtype))

    @cached_property
    def constraints(self) -> tuple[Constraint, ...]:
        """The constraints as objects, for reading one at a time."""
        rows: list[list[Row]] = [[] for _ in self.holder]
        listed = self.rows
        for expression, at_most, scale, owner in zip(
            listed.expression.tolist(),
            listed.at_most.tolist(),
            listed.scale.tolist(),
            listed.constraint.tolist(),
            strict=True,
        ):
            rows[owner].append(Row(expression, Relation.AT_MOST if at_most else Relation.EQUAL, scale))
        listed_pairs = (self.placed, self.whole, self.inside)
        placed, whole, inside = (_by_constraint(pairs, len(rows)) for pairs in listed_pairs)
        return tuple(
            Constraint(
                holder, tuple(rows[i]), placed[i], None if weight != weight else weight, whole[i], inside[i]
            )
            for i, (holder, weight) in enumerate(zip(self.holder.tolist(), self.weight.tolist(), strict=True))
        )

    def with_constraints(self, constraints: Sequence[Constraint]) -> Self:
        """Returns the problem with other constraints on the same unknowns."""
        return replace(self, **constraint_arrays(constraints))


def _by_constraint(pairs: NDArray[np.intp], count: int) -> list[frozenset[int]]:
    found: list[set[int]] = [set() for _ in range(count)]
    for constraint, number in pairs.T.tolist():
        found[constraint].add(number)
    return list(map(frozenset, found))


def _pairs(listed: Iterable[Iterable[int]]) -> NDArray[np.intp]:
    found = [(index, number) for index, numbers in enumerate(listed) for number in sorted(numbers)]
    return np.array(found, dtype=np.intp).reshape(-1, 2).T


def constraint_arrays(constraints: Sequence[Constraint]) -> dict[str, Any]:
    """Returns constraints as the arrays of a `Problem`."""
    rows = [(row, index) for index, constraint in enumerate(constraints) for row in constraint.rows]
    return {
        "rows": Rows(
            np.array([row.expression for row, _ in rows], dtype=np.intp),
            np.array([row.relation is Relation.AT_MOST for row, _ in rows], dtype=np.bool_),
            np.array([row.scale for row, _ in rows], dtype=np.float64),
            np.array([index for _, index in rows], dtype=np.intp),
        ),
        "holder": np.array([c.group for c in constraints], dtype=np.intp),
        "weight": np.array([np.nan if c.weight is None else c.weight for c in constraints]),
        "placed": _pairs(c.placed for c in constraints),
        "whole": _pairs(c.whole for c in constraints),
        "inside": _pairs(c.inside for c in constraints),
    }


def depths(parent: NDArray[np.intp]) -> NDArray[np.intp]:
    """Returns the depth (g,) of each group, 0 for the root; parents (g,) come before children."""
    found: list[int] = []
    for above in parent.tolist():
        found.append(0 if above < 0 else found[above] + 1)
    return np.array(found, dtype=np.intp)


def violations(problem: Problem, nodes: Floats) -> Floats:
    """Returns each row's violation (r,) at values `nodes` (m,), in its units; infinite for no value."""
    value = nodes[problem.rows.expression]
    violation = np.where(problem.rows.at_most, np.maximum(value, 0.0), np.abs(value))
    return np.where(np.isnan(value), np.inf, violation)


# --- The solution of a problem: the result as data, never an exception.


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
    """The same, with more equations than unknowns, some of them curved: other values would not help."""
    NOT_CONVERGED = "not converged"
    TIMED_OUT = "timed out"


@record()
class Member:
    """A constraint in a conflict; `off` is its violation where the search came nearest, in row units."""

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
    unknowns that ride along. The values (n,) are those before the stage; `conflicts.reasons` finds the
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


P = TypeVar("P", bound=Problem)


@record()
class Solution(Generic[P]):
    """
    problem        what was solved
    values         (n,) solved unknowns
    residuals      per constraint, the largest violation of its rows (0 for an inequality that holds),
                   evaluated on the original expressions at `values`, in the units of the row
    satisfied      per constraint
    changed        unknowns of kept sizes that had to change
    stages         the stages tried, in order
    """

    problem: P
    status: Status
    values: Floats
    residuals: tuple[float, ...]
    satisfied: tuple[bool, ...]
    changed: tuple[int, ...]
    failures: tuple[GroupFailure, ...]
    stages: tuple[StageReport, ...]

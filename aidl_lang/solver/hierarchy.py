"""The order of solving: groups from the leaves to the root, and at each group the stages.

Groups of one depth are solved all at once (`levels`) where there are many rows, else one by one (`group`,
which says what the stages are).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from aidl_lang.solver import Settings, Stages
from aidl_lang.solver.branches import Metric, Task, Verdict, attempt, holds, violation_of
from aidl_lang.solver.expression import Bools, Floats, mentioned
from aidl_lang.solver.group import Group
from aidl_lang.solver.loosening import OWN, SEALED, Scope, Tier, stage_name
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.problem import (
    GroupFailure,
    Problem,
    Row,
    Solution,
    StageReport,
    Status,
    depths,
    violations,
)
from aidl_lang.solver.riding import Memory, Recollection, riding_depths
from aidl_lang.solver.valuation import Valuation

if TYPE_CHECKING:
    from aidl_lang.solver.levels import Levels, Stage


FIRM = 1e-3
"""Length of a change of a kept size that counts as much as a change of 1 of a position."""
IDLE = 1e-3
"""A kept size that moved less than this, in units of its scale, was only dragged along."""
CHANGED = 1e-9
"""A kept size that moved less than this, in units of its scale, did not change."""

MANY, LARGE = 50, 1000
"""Numbers of rows from which on all groups of a depth are solved at once: if they are not few, and always."""
FEW = 4
"""Number of groups below which they are few, if there are more of them at other depths."""


class Hierarchy:
    """A solve of a problem. `values`, `failures` and `stages` are the results."""

    def __init__(self, problem: Problem, settings: Settings, clock: Clock) -> None:
        self.problem, self.settings, self.clock = problem, settings, clock
        scale, longest = problem.scale, problem.longest
        self.metric = Metric(scale, scale, longest)
        self.firm = Metric(np.where(problem.kept, FIRM, 1.0) * scale, scale, longest)
        self.failures: list[GroupFailure] = []
        self.stages: list[StageReport] = []
        self.timed_out = False
        self.reached = problem.initial.copy()
        """The values (n,) after the last depth."""
        self._broken: set[int] = set()
        self._levels: Levels | None = None
        self._group_depths = depths(problem.parent)
        # Lists are quicker to read one by one than arrays.
        self.is_kept: list[bool] = problem.kept.tolist()
        """Tells of each unknown whether it is a kept size."""
        self.is_spanned: list[bool] = problem.spanned.tolist()
        """Tells of each unknown whether it is a size that was read off two places."""
        self.is_hard: list[bool] = np.isnan(problem.weight).tolist()
        self._is_frame: list[bool] = (problem.frame_of >= 0).tolist()
        self._is_standing: list[bool] = problem.standing.tolist()
        self._sealed: list[int] = problem.sealed.tolist()
        self._depth: list[int] = self._group_depths[problem.group].tolist()

    @cached_property
    def _rides(self) -> list[int]:
        """The depth, for each unknown, of the innermost group around it (or of the group whose frame it
        places) that no constraint around that group names: for groups above that depth it rides along with
        its parent. 0 if all are named.
        """
        rides: list[int] = riding_depths(self.problem, self._group_depths).tolist()
        return rides

    @cached_property
    def _held_by(self) -> dict[int, list[int]]:
        found: dict[int, list[int]] = {}
        for index, holder in enumerate(self.problem.holder.tolist()):
            found.setdefault(holder, []).append(index)
        return found

    @cached_property
    def patience(self) -> Clock:
        """The time left for explaining failures; it runs from the first one."""
        from aidl_lang.solver import conflicts

        return Clock(conflicts.PATIENCE)

    @cached_property
    def values(self) -> Valuation:
        kept = frozenset(np.flatnonzero(self.problem.kept).tolist())
        if self._levels is None:
            return Valuation(self.problem.tape, self.problem.initial.tolist(), kept)
        nodes = self._levels.nodes().tolist()
        return Valuation(self.problem.tape, self.reached.tolist(), kept, nodes)

    @cached_property
    def mentions(self) -> Mapping[int, frozenset[int]]:
        """The unknowns in each constraint, by its index; found when first asked for."""
        return _Mentions(self.problem, self._levels)

    @cached_property
    def _mentioned_by(self) -> dict[int, list[int]]:
        found: dict[int, list[int]] = {}
        for index, unknown in self._mentions():
            found.setdefault(unknown, []).append(index)
        return found

    def _mentions(self) -> Iterable[tuple[int, int]]:
        """Yields pairs of a constraint and an unknown in it, by constraint."""
        if self._levels is not None:
            return zip(self._levels.constraints.tolist(), self._levels.unknowns.tolist(), strict=True)
        indices = range(len(self.problem.holder))
        return ((index, unknown) for index in indices for unknown in self.mentions[index])

    def run(self, recollection: Recollection | None = None) -> None:
        """Solves the groups depth by depth, from below; recalls those that no change has reached."""
        settings = self.settings
        usual = settings.together and settings.pruning and settings.stages is Stages.FULL
        count = len(self.problem.rows.expression)
        for depth in range(int(self._group_depths.max(initial=0)), -1, -1):
            known = np.zeros(len(self.problem.parent), dtype=np.bool_)
            if recollection is not None:
                known = recollection.recall(depth, self.reached)
                for group in np.flatnonzero(known).tolist():
                    self.stages.extend(recollection.stages(group))
            groups = [g for g in self._held_by if self._group_depths[g] == depth and not known[g]]
            is_small = len(groups) < FEW <= len(self._held_by)
            if usual and count >= (LARGE if is_small else MANY):
                self._solve_together(depth, known)
            else:
                self._solve_with_care(dict.fromkeys(groups, (0, 0)))
            if recollection is not None:
                recollection.note(depth, self.reached)

    def _solve_together(self, depth: int, known: Bools) -> None:
        """Solves the groups at `depth`, but for `known` (g,), at once; then one by one those that remain."""
        if self._levels is None:
            from aidl_lang.solver.levels import Levels

            self._levels = Levels(self.problem, self.reached, self.settings, self.clock, self.metric)
        levels = self._levels
        levels.binding[list(self._broken)] = False
        stages = list(levels.solve(depth, known))
        left = set(levels.unsolved(depth).tolist())
        passed = self._record(stages, left)
        wishing = self.problem.holder[~np.isnan(self.problem.weight)].tolist()
        left.update(group for group in wishing if self._group_depths[group] == depth)
        self._solve_with_care({group: passed.get(group, (0, 0)) for group in left if not known[group]})

    def _solve_with_care(self, groups: Mapping[int, Tier]) -> None:
        """Solves these groups one by one, each of which has passed the given stage."""
        if groups:
            self.values.assign(enumerate(self.reached.tolist()))
            for group in sorted(groups):
                Group(self, group).solve(groups[group])
            self.reached[:] = self.values.unknowns

    def _record(self, stages: list[Stage], left: set[int]) -> dict[int, Tier]:
        """Reports the stages but those that are tried again; returns the last that helped each group."""
        passed: dict[int, Tier] = {}
        for stage in stages:
            name = stage_name(stage.tier)
            columns = (stage.groups, stage.unknowns, stage.rows, stage.solved)
            for group, unknowns, rows, solved in zip(*(column.tolist() for column in columns), strict=True):
                if solved:
                    passed[group] = stage.tier
                if solved or group not in left:
                    self.stages.append(StageReport(group, name, unknowns, rows, solved))
        return passed

    def violations(self) -> Floats:
        """Returns the violation of each row (r,) at the end, in its units; infinite if it has no value."""
        if self._levels is not None:
            return violations(self.problem, self._levels.nodes())
        self.values.assign(enumerate(self.reached.tolist()))
        self.refresh(range(len(self.problem.holder)))
        rows = (row for constraint in self.problem.constraints for row in constraint.rows)
        return np.array([violation_of(row, self.values) for row in rows])

    def changed(self) -> list[int]:
        """Returns the kept sizes that differ from their first guess."""
        moved = np.abs(self.reached - self.problem.initial) > CHANGED * self.problem.scale
        found: list[int] = np.flatnonzero(moved & self.problem.kept).tolist()
        return found

    # -- questions of the groups

    def tier(self, group: int, unknown: int, placed: Mapping[int, int]) -> Tier:
        """Returns the tier of `unknown` at `group`, whose constraints place `placed`."""
        depth = int(self._group_depths[group])
        level = self._depth[unknown] - depth
        if self._sealed[unknown] > depth:
            return SEALED
        match self.settings.stages:
            case Stages.FLAT:
                return OWN
            case Stages.PAPER if self._is_frame[unknown]:
                return (3, 1 + level)
            case Stages.PAPER:
                return (4, level) if level else OWN
        if self.is_kept[unknown]:
            if self.is_spanned[unknown] and unknown in placed:
                return (4, level) if level else (1, 2)
            return (6, 0 if unknown in placed else 1 + level)
        if self._rides[unknown] > depth:
            return (5, level)
        if level == 0:
            return (1, placed[unknown]) if unknown in placed else (2, int(self._is_standing[unknown]))
        is_translated = self._is_frame[unknown] and self.settings.stages is not Stages.LEVEL
        return (3, level) if is_translated else (4, level)

    def held_by(self, group: int) -> list[int]:
        return self._held_by.get(group, [])

    def solved_mentioning(self, unknown: int, group: int) -> Iterable[int]:
        """Yields the constraints of `group` and below it that mention an unknown, without those not met."""
        constraints, broken = self.problem.constraints, self._broken
        return (
            index
            for index in self._mentioned_by.get(unknown, ())
            if constraints[index].group >= group and index not in broken
        )

    def give_up(self, indices: Iterable[int]) -> None:
        """Releases constraints: they no longer bind groups that are solved later."""
        self._broken.update(indices)

    def rows(self, indices: Iterable[int]) -> list[Row]:
        return [row for index in indices for row in self.problem.constraints[index].rows]

    def owners(self, indices: Iterable[int]) -> list[int]:
        """Returns the constraint of each of their `rows`."""
        return [index for index in indices for _ in self.problem.constraints[index].rows]

    def refresh(self, indices: Iterable[int]) -> None:
        """Brings the nodes of these constraints up to date."""
        self.values.update([row.expression for row in self.rows(indices)])

    def unmet(self, indices: Collection[int]) -> list[int]:
        """Returns the constraints that do not hold by the original expressions at the current values."""
        self.refresh(indices)
        constraints, values, tolerance = self.problem.constraints, self.values, self.settings.tolerance
        return [i for i in indices if not all(holds(row, values, tolerance) for row in constraints[i].rows)]

    def attempt(
        self, scope: Scope, restarts: int, clock: Clock | None = None, turning: bool = True
    ) -> Verdict:
        """Tries to satisfy the constraints of `scope` as hard ones; leaves `values` at the result.

        A kept size is dearer than any position: first as few and as little of them change as will do, and
        among the positions that these allow the nearest is taken.
        """
        rows = self.rows(scope.constraints)
        sizes = [unknown for unknown in scope.free if self.is_kept[unknown]]
        metric = self.firm if sizes else self.metric
        before = self.save(scope.free)
        task = Task(rows, [0.0] * len(rows), scope.free, restarts, turning)
        verdict = attempt(task, self.values, metric, self.settings, clock or self.clock)
        if sizes and not verdict.satisfied:
            # The search moves dear unknowns last, and may have ended before that.
            self.values.assign(before.items())
            verdict = attempt(task, self.values, self.metric, self.settings, clock or self.clock)
        idle = {u for u in sizes if abs(self.values.unknowns[u] - before[u]) < IDLE * self.problem.scale[u]}
        if verdict.satisfied and idle:
            reached = self.save(scope.free)
            self.values.assign(before.items())
            fewer = Task(rows, [0.0] * len(rows), scope.free - idle, restarts)
            again = attempt(fewer, self.values, metric, self.settings, clock or self.clock)
            if not again.satisfied:
                self.values.assign(reached.items())
        return verdict

    def save(self, unknowns: Iterable[int]) -> dict[int, float]:
        return {unknown: self.values.unknowns[unknown] for unknown in unknowns}

    def since(self, before: Mapping[int, float], unknowns: Iterable[int]) -> dict[int, float]:
        """Returns the former values of `unknowns`; `before` may lack those that have not moved since."""
        return {unknown: before.get(unknown, self.values.unknowns[unknown]) for unknown in unknowns}

    def moved(self, unknown: int, before: float) -> bool:
        return abs(self.values.unknowns[unknown] - before) > CHANGED * float(self.problem.scale[unknown])

    def name(self, unknown: int) -> str:
        return self.problem.names[unknown] if self.problem.names else ""


class _Mentions(dict[int, frozenset[int]]):
    def __init__(self, problem: Problem, levels: Levels | None) -> None:
        super().__init__()
        self._problem, self._levels = problem, levels
        if levels is not None:
            self._starts = np.searchsorted(levels.constraints, np.arange(len(problem.holder) + 1))

    def __missing__(self, index: int) -> frozenset[int]:
        if self._levels is not None:
            unknowns = self._levels.unknowns[self._starts[index] : self._starts[index + 1]].tolist()
        else:
            rows = self._problem.constraints[index].rows
            unknowns = mentioned(self._problem.tape, [row.expression for row in rows])
        found = self[index] = frozenset(unknowns)
        return found


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
    if satisfied.all():
        return Status.SOLVED
    if timed_out or not satisfied.any():
        return Status.FAILED
    return Status.PARTIAL

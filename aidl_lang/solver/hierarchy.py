"""The order of solving: groups from the leaves to the root, and at each group the stages of section 9.

At a group every unknown of its subtree has a tier, which says at which stage it becomes free:

    (1, 0)  own position that a constraint of the group places
    (2, 0)  own position, or translation of a child's frame (owned by the group, too)
    (3, d)  translation of a frame, owned by a group d levels below
    (4, d)  other position of a group d levels below
    (5, 0)  kept size that a constraint places, at any level
    (5, 1)  own kept size
    (5, 1 + d)  kept size of a group d levels below

A stage frees all tiers up to its own, as far as they are mentioned: by the group's constraints, or by
constraints of descendants that mention something free. Those constraints are the ones that a move could
break, and they join the system; a descendant that nothing outside mentions therefore never moves.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from aidl_lang.solver import conflicts
from aidl_lang.solver.branches import Metric, Task, Verdict, attempt, holds, violation_of
from aidl_lang.solver.gradients import gradients
from aidl_lang.solver.memory import Recollection
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.operations import Bools, Floats
from aidl_lang.solver.preferences import prefer
from aidl_lang.solver.problem import Problem, Row, Settings, depths, violations
from aidl_lang.solver.solution import GroupFailure, StageReport
from aidl_lang.solver.valuation import Cone, Valuation

if TYPE_CHECKING:
    from aidl_lang.solver.levels import Levels, Stage

Tier: TypeAlias = tuple[int, int]
Best: TypeAlias = tuple[float, dict[int, float]]
"""The least violation reached so far, and the values there."""

OWN: Tier = (2, 0)
POSITIONS: Tier = (5, -1)
"""Before the first tier of kept sizes."""
SIZES: Tier = (5, 0)
FIRM = 1e-3
"""How much shorter a change of a kept size is that counts as much as one of a position."""
IDLE = 1e-3
"""A kept size that moved less than this, in units of its scale, was only dragged along."""
FLAT = 1e-9
"""A slope below this is none: coordinates that cancel, as in the width of a box."""
CHANGED = 1e-9
"""A kept size that moved less than this, in units of its scale, did not change."""
LAST_RESTARTS = 5
"""Perturbed starts at the last stage; the earlier ones have one."""
MOST_FAILURES = 20
"""Conflicts that are explained and worked around; after that, only the best effort is kept."""

MANY = 50
"""Number of rows from which on all groups of a depth are solved at once."""

_NAMES = {1: "placed", 2: "own", 3: "translations", 4: "positions", 5: "sizes"}


def stage_name(tier: Tier) -> str:
    """`placed`, `own`, `translations 1`, `positions 2`, `placed sizes`, `own sizes`, `sizes 1`, …"""
    kind, level = tier
    if kind == 5:
        return ("placed sizes", "own sizes")[level] if level < 2 else f"sizes {level - 1}"
    return _NAMES[kind] if kind < 3 else f"{_NAMES[kind]} {level}"


@dataclass(frozen=True)
class Scope:
    """What takes part in one stage: the free unknowns and the indices of the hard constraints."""

    free: frozenset[int]
    constraints: tuple[int, ...]


class Hierarchy:
    """One solve. `values`, `failures` and `stages` are the results."""

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

    # What is looked up one by one is kept in lists, and made when the first group asks.

    @cached_property
    def _kept(self) -> list[bool]:
        return list(map(bool, self.problem.kept))

    @cached_property
    def _frame(self) -> list[bool]:
        return list(map(bool, self.problem.frame_of >= 0))

    @cached_property
    def _hard(self) -> list[bool]:
        return list(map(bool, np.isnan(self.problem.weight)))

    @cached_property
    def _depth(self) -> list[int]:
        """Of each unknown."""
        return list(map(int, self._group_depths[self.problem.group]))

    @cached_property
    def _group_depths(self) -> NDArray[np.int64]:
        return depths(self.problem.parent)

    @cached_property
    def _held_by(self) -> dict[int, list[int]]:
        found: dict[int, list[int]] = {}
        for index, holder in enumerate(self.problem.holder.tolist()):
            found.setdefault(holder, []).append(index)
        return found

    @cached_property
    def patience(self) -> Clock:
        """How long failures are explained; it runs from the first one."""
        return Clock(conflicts.PATIENCE)

    @cached_property
    def values(self) -> Valuation:
        return Valuation(self.problem.tape, self.problem.initial.tolist())

    @cached_property
    def cones(self) -> Cones:
        return Cones(self.problem, self.values)

    @cached_property
    def _mentioned_by(self) -> dict[int, list[int]]:
        found: dict[int, list[int]] = {}
        for index, unknown in self._mentions():
            found.setdefault(unknown, []).append(index)
        return found

    def _mentions(self) -> Iterable[tuple[int, int]]:
        """Pairs of a constraint and an unknown in it, by constraint."""
        if self._levels is not None:
            return zip(self._levels.constraints.tolist(), self._levels.unknowns.tolist(), strict=True)
        indices = range(len(self.problem.holder))
        return ((index, unknown) for index in indices for unknown in self.cones[index].unknowns)

    def run(self, recollection: Recollection | None = None) -> None:
        """Solves the groups depth by depth, from below; those that nothing has changed for are recalled."""
        many = len(self.problem.rows.expression) >= MANY
        turn = self._solve_together if many else self._solve_in_turn
        for depth in range(int(self._group_depths.max(initial=0)), -1, -1):
            known = np.zeros(len(self.problem.parent), dtype=np.bool_)
            if recollection is not None:
                known = recollection.recall(depth, self.reached)
                for group in np.flatnonzero(known).tolist():
                    self.stages.extend(recollection.stages(group))
            turn(depth, known)
            if recollection is not None:
                recollection.note(depth, self.reached)

    def _solve_in_turn(self, depth: int, known: Bools) -> None:
        """Solves the groups at `depth` one by one, but for those that are `known` (g,)."""
        groups = [g for g in self._held_by if self._group_depths[g] == depth and not known[g]]
        self._solve_with_care(dict.fromkeys(groups, (0, 0)))

    def _solve_together(self, depth: int, known: Bools) -> None:
        """Solves the groups at `depth` at once; then, one by one, those for which that was not enough."""
        if self._levels is None:
            from aidl_lang.solver.levels import Levels

            self._levels = Levels(self.problem, self.reached, self.settings, self.clock, self.metric)
        levels = self._levels
        stages = list(levels.solve(depth, known))
        left = set(levels.unsolved(depth).tolist())
        passed = self._record(stages, left)
        wishing = self.problem.holder[~np.isnan(self.problem.weight)].tolist()
        left.update(group for group in wishing if self._group_depths[group] == depth)
        self._solve_with_care({group: passed.get(group, (0, 0)) for group in left if not known[group]})
        levels.binding[list(self._broken)] = False

    def _solve_with_care(self, groups: Mapping[int, Tier]) -> None:
        """Solves these groups one by one, each of which has passed the given stage."""
        if groups:
            self.values.assign(enumerate(self.reached.tolist()))
            for group in sorted(groups):
                _Group(self, group).solve(groups[group])
            self.reached[:] = self.values.unknowns

    def _record(self, stages: list[Stage], left: set[int]) -> dict[int, Tier]:
        """Reports the stages, but for what is tried again; the last stage that helped each group."""
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
        """How far each row (r,) is from holding at the end, in its own units; infinite if it has no value."""
        if self._levels is not None:
            return violations(self.problem, self._levels.nodes())
        self.values.assign(enumerate(self.reached.tolist()))
        found = []
        for index, constraint in enumerate(self.problem.constraints):
            self.values.refresh(self.cones[index])
            found.extend([violation_of(row, self.values) for row in constraint.rows])
        return np.array(found)

    def changed(self) -> list[int]:
        """Kept sizes that are no longer what was written."""
        moved = np.abs(self.reached - self.problem.initial) > CHANGED * self.problem.scale
        found: list[int] = np.flatnonzero(moved & self.problem.kept).tolist()
        return found

    # -- what groups ask

    def tier(self, group: int, unknown: int, placed: frozenset[int]) -> Tier:
        """When `unknown` becomes free at `group`, whose constraints place `placed`."""
        level = self._depth[unknown] - int(self._group_depths[group])
        if self._kept[unknown]:
            return (5, 0 if unknown in placed else 1 + level)
        if level == 0:
            return (1, 0) if unknown in placed else (2, 0)
        return (3, level) if self._frame[unknown] else (4, level)

    @cached_property
    def all_hard(self) -> bool:
        return all(self._hard)

    def is_hard(self, index: int) -> bool:
        return self._hard[index]

    def held_by(self, group: int) -> list[int]:
        return self._held_by.get(group, [])

    def solved_mentioning(self, unknown: int, group: int) -> Iterable[int]:
        """Constraints of `group` and its descendants, those that could not be met excepted."""
        constraints, broken = self.problem.constraints, self._broken
        return (
            index
            for index in self._mentioned_by.get(unknown, ())
            if constraints[index].group >= group and index not in broken
        )

    def give_up(self, indices: Iterable[int]) -> None:
        """These constraints no longer bind what is solved later."""
        self._broken.update(indices)

    def rows(self, indices: Iterable[int]) -> list[Row]:
        return [row for index in indices for row in self.problem.constraints[index].rows]

    def satisfied(self, index: int) -> bool:
        """By the original expressions at the current values."""
        self.values.refresh(self.cones[index])
        return all(
            holds(row, self.values, self.settings.tolerance) for row in self.problem.constraints[index].rows
        )

    def attempt(self, scope: Scope, restarts: int, clock: Clock | None = None) -> Verdict:
        """Tries to satisfy the constraints of `scope` as hard ones; leaves `values` at what was reached.

        A kept size is dearer than any position: first as few and as little of them change as will do, and
        among the positions that these allow the nearest is taken.
        """
        rows = self.rows(scope.constraints)
        sizes = [unknown for unknown in scope.free if self._kept[unknown]]
        metric = self.firm if sizes else self.metric
        before = self.save(scope.free)
        task = Task(rows, [0.0] * len(rows), scope.free, restarts)
        verdict = attempt(task, self.values, metric, self.settings, clock or self.clock)
        if sizes and not verdict.satisfied:
            # What is dear moves last in a search, too, which may end before that.
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


class Cones:
    """What each constraint is made of, by its index; found when first asked for."""

    def __init__(self, problem: Problem, values: Valuation) -> None:
        self._problem, self._values = problem, values
        self._known: dict[int, Cone] = {}

    def __getitem__(self, index: int) -> Cone:
        found = self._known.get(index)
        if found is None:
            rows = self._problem.constraints[index].rows
            found = self._known[index] = self._values.cone(row.expression for row in rows)
        return found


class _Group:
    """The stages of one group."""

    def __init__(self, hierarchy: Hierarchy, group: int) -> None:
        self.hierarchy, self.group = hierarchy, group
        held = hierarchy.held_by(group)
        self.hard = [index for index in held if hierarchy.is_hard(index)]
        self.soft = [index for index in held if not hierarchy.is_hard(index)]
        self.placed = frozenset().union(*(self._placed_by(index) for index in self.hard))
        self._tiers: dict[int, Tier] = {}

    def _placed_by(self, index: int) -> frozenset[int]:
        """What a constraint places, as far as it depends on it."""
        hierarchy = self.hierarchy
        return hierarchy.problem.constraints[index].placed & hierarchy.cones[index].unknowns

    def solve(self, reached: Tier = (0, 0)) -> None:
        """Satisfies the constraints. Those that share nothing that could ever move are problems of their own:
        what one needs does not loosen the other. `reached` is the last stage that some of them needed before.
        """
        for part in self._independent():
            tier = self._solve_part(part)
            if tier is None:
                return
            reached = max(reached, tier)
        self._weigh_preferences(reached)

    def _independent(self) -> list[list[int]]:
        """The hard constraints by what they share, in order of writing."""
        hierarchy = self.hierarchy
        parts: list[list[int]] = []
        left = list(self.hard)
        while left:
            linked = set(self.scope((9, 0), left[:1]).constraints)
            parts.append([index for index in left if index in linked])
            left = [index for index in left if index not in linked]
        return [part for part in parts if not all(map(hierarchy.satisfied, part))]

    def _solve_part(self, part: list[int]) -> Tier | None:
        """The stage that satisfied everything; of a conflict the last one written is left out, and the rest
        solved. None when it is not known what to leave out.
        """
        hierarchy = self.hierarchy
        while True:
            violated = [index for index in part if not hierarchy.satisfied(index)]
            if not violated:
                return (0, 0)
            reached = self._deepen(part, violated)
            if reached is not None:
                return reached
            left_out = self._leave_out()
            if left_out is None:
                return None
            part.remove(left_out)
            self.hard.remove(left_out)
            hierarchy.give_up([left_out])

    def _leave_out(self) -> int | None:
        """The constraint to go on without after a failure; None if it is not known which would help."""
        failure = self.hierarchy.failures[-1]
        own = [index for index in failure.conflict if index in self.hard]
        known = failure.minimal and own and not self.hierarchy.clock.expired
        return max(own) if known and len(self.hierarchy.failures) <= MOST_FAILURES else None

    def tier(self, unknown: int) -> Tier:
        found = self._tiers.get(unknown)
        if found is None:
            found = self._tiers[unknown] = self.hierarchy.tier(self.group, unknown, self.placed)
        return found

    def scope(self, last: Tier, seeds: Iterable[int]) -> Scope:
        """The unknowns up to tier `last` that `seeds` mention, what binds those, what that mentions, …"""
        hierarchy = self.hierarchy
        constraints, free = set(seeds), set[int]()
        stack = list(constraints)
        while stack:
            for unknown in hierarchy.cones[stack.pop()].unknowns:
                if unknown in free or self.tier(unknown) > last:
                    continue
                free.add(unknown)
                for index in hierarchy.solved_mentioning(unknown, self.group):
                    if index not in constraints and hierarchy.is_hard(index):
                        constraints.add(index)
                        stack.append(index)
        return Scope(frozenset(free), tuple(sorted(constraints)))

    # -- stages

    def _deepen(self, part: list[int], violated: list[int]) -> Tier | None:
        """The tier of the first stage that satisfies everything, None if there is none."""
        hierarchy = self.hierarchy
        everything = self.scope((9, 0), part)
        before = hierarchy.save(everything.free)
        best: Best = (np.inf, before)
        tiers = sorted({self.tier(unknown) for unknown in everything.free})
        rigid = self._beyond_positions(part) if tiers and tiers[-1] > POSITIONS else []
        if not set(rigid).isdisjoint(violated):
            broken = self._settle_sizes(rigid, part)
            if broken is not None:
                seeds = sorted({*part, *broken})
                positions = [tier for tier in tiers if tier <= POSITIONS]
                if all(map(hierarchy.satisfied, seeds)):
                    return SIZES
                reached, best = self._climb(positions, seeds, best)
                if reached is not None:
                    return SIZES
                hierarchy.values.assign(before.items())
            tiers = [tier for tier in tiers if tier > POSITIONS]
        reached, best = self._climb(tiers, part, best)
        if reached is None:
            self._fail(violated, everything, before, best[1])
        return reached

    def _climb(self, tiers: list[Tier], seeds: list[int], best: Best) -> tuple[Tier | None, Best]:
        """Tries the stages in order; the first that satisfies `seeds` and all that binds what it moves, or
        None and the values that came nearest.
        """
        hierarchy = self.hierarchy
        everything = self.scope((9, 0), seeds).free
        before = hierarchy.save(everything)
        violated = [index for index in seeds if not hierarchy.satisfied(index)]
        tried: frozenset[int] = frozenset()
        for tier in tiers:
            if not self._promising(violated, tier):
                continue
            scope = self.scope(tier, seeds)
            if scope.free == tried:
                continue
            tried = scope.free
            # What builds on a part that failed is drawn as well as it goes, and not searched for long.
            last = tier == tiers[-1] and not hierarchy.failures
            verdict = hierarchy.attempt(scope, LAST_RESTARTS if last else 1)
            self._report(stage_name(tier), scope, verdict.satisfied)
            if verdict.satisfied:
                return tier, best
            if verdict.violation < 0.99 * best[0]:
                best = (verdict.violation, hierarchy.save(everything))
            hierarchy.values.assign(before.items())
            if hierarchy.clock.expired:
                hierarchy.timed_out = True
                break
        return None, best

    # -- sizes that no position can help

    def _beyond_positions(self, constraints: list[int]) -> list[int]:
        """The constraints among these that hang on kept sizes alone, as `same_width` does."""
        hierarchy = self.hierarchy
        found: list[int] = []
        for index in constraints:
            roots = [row.expression for row in hierarchy.rows([index])]
            hierarchy.values.refresh(hierarchy.cones[index])
            for gradient in gradients(hierarchy.values, roots).values():
                tiers = [self.tier(u) for u, slope in gradient.items() if abs(slope) > FLAT]
                if tiers and min(tiers) > POSITIONS:
                    found.append(index)
                    break
        return found

    def _settle_sizes(self, rigid: list[int], part: list[int]) -> list[int] | None:
        """Changes the sizes that `rigid` need: those they place, then as in the stages for sizes. Returns the
        constraints outside `part` that this broke and positions may mend; None if no sizes will do.
        """
        hierarchy = self.hierarchy
        mentioned = frozenset().union(*(hierarchy.cones[index].unknowns for index in rigid))
        sizes = frozenset(unknown for unknown in mentioned if self.tier(unknown) > POSITIONS)
        unmet = [index for index in rigid if not hierarchy.satisfied(index)]
        placed = sizes & frozenset().union(*(self._placed_by(index) for index in unmet))
        levels = sorted({self.tier(unknown) for unknown in sizes})
        stages = [(level, frozenset(u for u in sizes if self.tier(u) <= level)) for level in levels]
        tried: frozenset[int] = frozenset()
        for level, free in ((SIZES, placed), *stages):
            if free <= tried:
                continue
            tried = free
            before = hierarchy.save(free)
            scope = Scope(free, tuple(sorted(rigid)))
            satisfied = hierarchy.attempt(scope, 1).satisfied
            self._report(stage_name(level), scope, satisfied)
            if satisfied:
                moved = [u for u in free if hierarchy.values.unknowns[u] != before[u]]
                touched = {i for u in moved for i in hierarchy.solved_mentioning(u, self.group)} - set(part)
                return [i for i in sorted(touched) if hierarchy.is_hard(i) and not hierarchy.satisfied(i)]
            hierarchy.values.assign(before.items())
        return None

    def _promising(self, violated: list[int], tier: Tier) -> bool:
        """Whether each violated constraint mentions something free."""
        cones = self.hierarchy.cones
        return all(any(self.tier(unknown) <= tier for unknown in cones[index].unknowns) for index in violated)

    def _report(self, stage: str, scope: Scope, succeeded: bool) -> None:
        rows = len(self.hierarchy.rows(scope.constraints))
        report = StageReport(self.group, stage, len(scope.free), rows, succeeded)
        self.hierarchy.stages.append(report)

    def _fail(
        self, violated: list[int], everything: Scope, before: dict[int, float], best: dict[int, float]
    ) -> None:
        hierarchy = self.hierarchy
        failure = conflicts.explain(hierarchy, self.group, violated, everything, before, best)
        hierarchy.failures.append(failure)
        if self._leave_out() is not None:
            return
        hierarchy.values.assign(best.items())
        involved = set(everything.constraints) | set(self.hard)
        hierarchy.give_up(index for index in sorted(involved) if not hierarchy.satisfied(index))

    # -- preferences

    def _weigh_preferences(self, reached: Tier) -> None:
        """Satisfies preferences as well as possible within what the winning stage had free."""
        hierarchy = self.hierarchy
        if hierarchy.all_hard:
            return
        limit = min(max(reached, OWN), POSITIONS)
        soft = set(self.soft)
        if reached > (0, 0):
            for unknown in self.scope(min(reached, POSITIONS), self.hard).free:
                soft.update(
                    index
                    for index in hierarchy.solved_mentioning(unknown, self.group)
                    if not hierarchy.is_hard(index)
                )
        if all(hierarchy.satisfied(index) for index in soft):
            return
        preferences = tuple(sorted(soft))
        self.placed = self.placed.union(*(self._placed_by(index) for index in preferences))
        self._tiers.clear()
        for tier in sorted({min(max(reached, (1, 0)), POSITIONS), limit}):
            if prefer(hierarchy, self.scope(tier, preferences), preferences):
                break

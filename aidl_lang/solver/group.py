"""The stages of one group.

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

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from aidl_lang.solver import conflicts
from aidl_lang.solver.gradients import gradients
from aidl_lang.solver.preferences import prefer
from aidl_lang.solver.solution import StageReport

if TYPE_CHECKING:
    from aidl_lang.solver.hierarchy import Hierarchy

Tier: TypeAlias = tuple[int, int]
Best: TypeAlias = tuple[float, dict[int, float]]
"""The least violation reached so far, and the values there."""

OWN: Tier = (2, 0)
POSITIONS: Tier = (5, -1)
"""Before the first tier of kept sizes."""
SIZES: Tier = (5, 0)
FLAT = 1e-9
"""A slope below this is none: coordinates that cancel, as in the width of a box."""
LAST_RESTARTS = 5
"""Perturbed starts at the last stage; the earlier ones have one."""
MOST_FAILURES = 20
"""Conflicts that are explained and worked around; after that, only the best effort is kept."""

NAMES = {1: "placed", 2: "own", 3: "translations", 4: "positions", 5: "sizes"}


def stage_name(tier: Tier) -> str:
    """`placed`, `own`, `translations 1`, `positions 2`, `placed sizes`, `own sizes`, `sizes 1`, …"""
    kind, level = tier
    if kind == 5:
        return ("placed sizes", "own sizes")[level] if level < 2 else f"sizes {level - 1}"
    return NAMES[kind] if kind < 3 else f"{NAMES[kind]} {level}"


@dataclass(frozen=True)
class Scope:
    """What takes part in one stage: the free unknowns and the indices of the hard constraints."""

    free: frozenset[int]
    constraints: tuple[int, ...]


class Group:
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
        if self._beyond_positions(violated):
            broken = self._settle_sizes(self._beyond_positions(part), part)
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
            if all(self.tier(unknown) <= POSITIONS for unknown in hierarchy.cones[index].unknowns):
                continue
            reached = [set(map(self.tier, unknowns)) for unknowns in self._reached(index)]
            if any(tiers and min(tiers) > POSITIONS for tiers in reached):
                found.append(index)
        return found

    def _reached(self, index: int) -> Iterator[list[int]]:
        """For each row of a constraint the unknowns that change it where it is now."""
        hierarchy = self.hierarchy
        roots = [row.expression for row in hierarchy.rows([index])]
        hierarchy.values.refresh(hierarchy.cones[index])
        for gradient in gradients(hierarchy.values, roots).values():
            yield [unknown for unknown, slope in gradient.items() if abs(slope) > FLAT]

    def _settle_sizes(self, rigid: list[int], part: list[int]) -> list[int] | None:
        """Changes the sizes that `rigid` need: those they place, then as in the stages for sizes. Returns the
        constraints outside `part` that this broke and positions may mend; None if no sizes will do.
        """
        hierarchy = self.hierarchy
        mentioned = frozenset().union(*(hierarchy.cones[index].unknowns for index in rigid))
        # Another row of such a constraint may hang on positions, which are free as they were before.
        reached = frozenset(u for index in rigid for unknowns in self._reached(index) for u in unknowns)
        positions = frozenset(unknown for unknown in reached if self.tier(unknown) <= POSITIONS)
        sizes = frozenset(unknown for unknown in mentioned if self.tier(unknown) > POSITIONS)
        unmet = [index for index in rigid if not hierarchy.satisfied(index)]
        placed = sizes & frozenset().union(*(self._placed_by(index) for index in unmet))
        levels = sorted({self.tier(unknown) for unknown in sizes})
        stages = [(level, frozenset(u for u in sizes if self.tier(u) <= level)) for level in levels]
        tried: frozenset[int] = frozenset()
        for level, resized in ((SIZES, placed), *stages):
            if resized <= tried:
                continue
            tried, free = resized, resized | positions
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

"""How a group is solved: few parts give way, of these few things, and these by the shortest way.

The paper (appendix B) frees one tier after another (`loosening` has them); here no stage frees a whole one:

1. What the constraints place is freed, with all constraints that bind it. Their rows are solved for the
   nearest point (`branches`, `newton`), where that leaves a choice in turn. If they hold, that was all.
2. Else the search ends where the rows contradict each other. Who can help has a share in what is left of
   them (`loosening`). They are freed besides, the rest stays rigid, and all is solved again from where it
   began; up to `ROUNDS` times. Before a size changes, the positions are tried as a whole.
3. If nobody can help, or it did not help, and no proof refutes the constraints, whole tiers are tried.
4. Where more moved than the rows ask for, things are held again (`thin`).
5. Preferences are first tried as if they were hard, then with slacks: unknowns that are dear.

Each try begins from the values before, so that the order of constraints shows nowhere. Only what fails is
explained (`conflicts`).
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from aidl_lang.solver import Stages
from aidl_lang.solver.branches import Task, attempt, violation_of
from aidl_lang.solver.loosening import (
    ENDLESS,
    OWN,
    POSITIONS,
    Scope,
    Tier,
    Tiers,
    givers,
    spare_sizes,
    stage_name,
    thin,
)
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.problem import Concession, GroupFailure, StageReport

if TYPE_CHECKING:
    from aidl_lang.solver.hierarchy import Hierarchy


Best: TypeAlias = tuple[float, dict[int, float]]
"""The least violation reached so far, and the values there."""

LAST_RESTARTS = 5
"""Perturbed starts at the last stage; the earlier ones have one."""
MOST_FAILURES = 20
"""The most conflicts that are explained and worked around; after them the best effort is kept."""

PATIENCE = 1.0
"""Seconds for stages tried as wholes."""
ROUNDS = 12
"""The most times that something more is freed before all is."""
FIRMNESS = 1e-5
"""Unit of the slack of a preference of weight 1: its cost compared with moving things."""
NEARLY = 1e-6
"""Weighted violation of a preference that is due to the slack alone."""


class Group:
    """The stages of one group."""

    def __init__(self, hierarchy: Hierarchy, group: int) -> None:
        self.hierarchy, self.group = hierarchy, group
        held = hierarchy.held_by.get(group, [])
        self.hard = [index for index in held if hierarchy.is_hard[index]]
        self.soft = [index for index in held if not hierarchy.is_hard[index]]
        self.tiers = Tiers(hierarchy, group)

    def solve(self, reached: Tier = (0, 0)) -> None:
        """Satisfies the constraints. Those that share nothing that could ever move are problems of their own:
        the needs of one do not loosen the other. `reached` is the last stage that some of them needed before.
        """
        hierarchy = self.hierarchy
        unmet = set(hierarchy.unmet(self.hard))
        for part in [part for part in self.tiers.independent(self.hard) if not unmet.isdisjoint(part)]:
            tier = self._solve_part(part)
            if tier is None:
                return
            reached = max(reached, tier)
        self._weigh_preferences(reached)

    def _solve_part(self, part: list[int]) -> Tier | None:
        """Returns the stage that satisfied everything, after leaving out the last written constraint of each
        conflict; None if it is not known what to leave out.
        """
        hierarchy = self.hierarchy
        self.tiers.place(part)
        while True:
            violated = hierarchy.unmet(part)
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
            self.tiers.forget()

    def _leave_out(self) -> int | None:
        """Returns the constraint to go on without after a failure; None if none is known to help."""
        failure = self.hierarchy.failures[-1]
        own = [index for index in failure.conflict if index in self.hard]
        known = failure.minimal and own and not self.hierarchy.clock.expired
        if not known or len(self.hierarchy.failures) > MOST_FAILURES:
            return None
        constraints = self.hierarchy.problem.constraints
        # What names nothing comes with the nature of a thing: a radius is not negative, even where all fails.
        return max(own, key=lambda i: (bool(constraints[i].whole or constraints[i].inside), i))

    # -- stages

    def _deepen(self, part: list[int], violated: list[int]) -> Tier | None:
        """Returns the tier of the dearest thing that had to be freed to satisfy all; None if nothing does."""
        hierarchy = self.hierarchy
        everything = self.tiers.everything(part)
        before = hierarchy.save(everything.free)
        tiers = sorted({self.tiers.tier(unknown) for unknown in everything.free})
        best: Best = (np.inf, before)
        reached: Tier | None = None
        if hierarchy.settings.stages is Stages.FULL:
            reached, tiers, best = self._loosen(tiers, part, best)
        if reached is None:
            from aidl_lang.solver import conflicts

            if not (hierarchy.settings.explain and conflicts.is_refuted(hierarchy, everything)):
                reached, best = self._climb(tiers, part, best)
        if reached is None:
            failure = conflicts.explain(hierarchy, self.group, violated, everything, before, best[1])
            reached = self._from_elsewhere(failure, part, before)
            if reached is None:
                self._fail(failure, everything, best[1])
        return reached

    def _loosen(
        self, tiers: list[Tier], seeds: list[int], best: Best
    ) -> tuple[Tier | None, list[Tier], Best]:
        """Frees what the constraints place; then, where rows contradict each other, who has a share in that.
        Returns the dearest tier that was freed when all was satisfied, or None; the tiers whose stages were
        not tried as wholes; and the values that came nearest.
        """
        hierarchy = self.hierarchy
        everything = self.tiers.everything(seeds).free
        before = hierarchy.save(everything)
        last, extra = tiers[0] if tiers else OWN, frozenset[int]()
        for _ in range(ROUNDS):
            scope = self.tiers.scope(last, seeds, extra)
            reached = max([last, *map(self.tiers.tier, extra)])
            hierarchy.values.assign(before.items())
            verdict = hierarchy.attempt(scope, 1, turning=False)
            if verdict.satisfied and not extra:
                self._place_in_turn(scope, before)
            self._report(reached, scope, before if verdict.satisfied else None)
            if verdict.satisfied:
                return reached, tiers, best
            if verdict.violation < 0.99 * best[0]:
                best = (verdict.violation, hierarchy.save(everything))
            if hierarchy.clock.expired:
                hierarchy.timed_out = True
                break
            more = givers(hierarchy, self.tiers, scope, extra, before)
            if not more:
                break
            positions = [tier for tier in tiers if tier < POSITIONS]
            if positions and max(map(self.tiers.tier, more)) > POSITIONS:
                # Before a size changes, branches that positions choose have their say.
                hierarchy.values.assign(before.items())
                tier, best = self._climb(positions, seeds, best, scope.free if verdict.refuted else None)
                tiers = [tier for tier in tiers if tier > POSITIONS]
                if tier is not None:
                    return tier, tiers, best
            extra |= more
        hierarchy.values.assign(before.items())
        return None, tiers, best

    def _place_in_turn(self, scope: Scope, before: dict[int, float]) -> None:
        """Satisfies `scope` anew from the values `before`, if its unknowns have a choice: first what follows
        nothing else that is placed, then what follows that, and so on, if that can be. So a thing with a long
        way to go pulls nothing along that it follows.
        """
        hierarchy, mentions = self.hierarchy, self.hierarchy.mentions
        left: list[Scope] = []
        for index in scope.constraints:
            placed = hierarchy.problem.constraints[index].placed & scope.free
            same = [block for block in left if block.free & placed]
            indices = [index, *(i for block in same for i in block.constraints)]
            merged = Scope(placed.union(*(block.free for block in same)), tuple(sorted(indices)))
            left = [block for block in left if block not in same] + [merged] * bool(placed)
        if len(left) < 2 or len(scope.free) <= len(hierarchy.rows(scope.constraints)):
            return
        together, ready = hierarchy.save(scope.free), left
        hierarchy.values.assign(before.items())
        while ready:
            waiting = frozenset[int]().union(*(block.free for block in left))
            ready = [b for b in left if not any(mentions[i] & waiting - b.free for i in b.constraints)]
            left = [block for block in left if block not in ready]
            if not all(hierarchy.attempt(block, 1, turning=False).satisfied for block in ready):
                break
        if left or hierarchy.unmet(scope.constraints):
            hierarchy.values.assign(together.items())

    def _from_elsewhere(
        self, failure: GroupFailure, part: list[int], before: dict[int, float]
    ) -> Tier | None:
        """Returns the stage that satisfies all from where the failed constraints hold; None if none does."""
        hierarchy = self.hierarchy
        for tier in (POSITIONS, ENDLESS) if failure.holds_elsewhere else ():
            scope = self.tiers.scope(tier, part)
            hierarchy.values.assign(before.items())
            hierarchy.values.assign(pair for pair in failure.nearest if pair[0] in scope.free)
            if hierarchy.attempt(scope, 1).satisfied:
                self._report(tier, scope, before, failure.conflict)
                return tier
        hierarchy.values.assign(before.items())
        return None

    def _climb(
        self, tiers: list[Tier], seeds: list[int], best: Best, refuted: frozenset[int] | None = None
    ) -> tuple[Tier | None, Best]:
        """Tries stages in order, each with all that its tiers free, branch by branch; the last of them first,
        since none leads anywhere if that does not. `refuted` are free unknowns that are known not to suffice.
        """
        hierarchy = self.hierarchy
        everything = self.tiers.everything(seeds).free
        before = hierarchy.save(everything)
        scopes = {self.tiers.scope(tier, seeds): tier for tier in reversed(tiers)}
        stages = {scope: tier for scope, tier in scopes.items() if scope.free != refuted}
        order = sorted(stages, key=stages.__getitem__)
        reached: tuple[Scope, dict[int, float]] | None = None
        clock = Clock(min(PATIENCE, hierarchy.clock.left))
        for scope in [*order[-1:], *order[:-1]]:
            # Groups above a part that failed are not searched for long: the best effort is drawn.
            is_last = scope is order[-1] and not hierarchy.failures
            verdict = hierarchy.attempt(scope, LAST_RESTARTS if is_last else 1, clock)
            if verdict.satisfied:
                reached = scope, hierarchy.save(scope.free)
            else:
                self._report(stages[scope], scope, None)
                if verdict.violation < 0.99 * best[0]:
                    best = (verdict.violation, hierarchy.save(everything))
            hierarchy.values.assign(before.items())
            if reached is None or (scope is not order[-1] and verdict.satisfied) or clock.expired:
                break
        hierarchy.timed_out |= hierarchy.clock.expired
        if reached is None:
            return None, best
        scope, values = reached
        hierarchy.values.assign(values.items())
        self._report(stages[scope], scope, before)
        return stages[scope], best

    def _report(
        self, tier: Tier, scope: Scope, before: dict[int, float] | None, despite: tuple[int, ...] = ()
    ) -> None:
        """Reports a stage. If it succeeded, starting from the values `before`, first holds the unknowns that
        need not move. `despite` are constraints that hold though a search from `before` had failed.
        """
        hierarchy, concession = self.hierarchy, None
        if before is not None:
            before = hierarchy.since(before, scope.free)
            thin(hierarchy, scope, before, self.tiers.tier)
            spare_sizes(hierarchy, scope, before)
            dear = filter(self.tiers.is_dear, scope.free)
            moved = frozenset(u for u in dear if hierarchy.moved(u, before[u]))
            if moved:
                values = np.array(hierarchy.values.unknowns)
                values[list(before)] = list(before.values())
                concession = Concession(moved, scope.free, scope.constraints, values)
        rows = len(hierarchy.rows(scope.constraints))
        name = "elsewhere" if despite else stage_name(tier)
        report = StageReport(self.group, name, len(scope.free), rows, before is not None, concession, despite)
        hierarchy.stages.append(report)

    def _fail(self, failure: GroupFailure, everything: Scope, best: dict[int, float]) -> None:
        hierarchy = self.hierarchy
        hierarchy.failures.append(failure)
        if self._leave_out() is not None:
            return
        hierarchy.values.assign(best.items())
        involved = set(everything.constraints) | set(self.hard)
        hierarchy.give_up(hierarchy.unmet(sorted(involved)))

    # -- preferences

    def _weigh_preferences(self, reached: Tier) -> None:
        """Satisfies preferences as well as possible with the unknowns that the winning stage had free."""
        hierarchy = self.hierarchy
        if all(hierarchy.is_hard):
            return
        limit = min(max(reached, OWN), POSITIONS)
        soft = set(self.soft)
        if reached > (0, 0):
            for unknown in self.tiers.scope(min(reached, POSITIONS), self.hard).free:
                binding = hierarchy.solved_mentioning(unknown, self.group)
                soft.update(index for index in binding if not hierarchy.is_hard[index])
        if not hierarchy.unmet(soft):
            return
        preferences = tuple(sorted(soft))
        self.tiers.place([*self.hard, *preferences])
        for tier in sorted({min(max(reached, (1, 0)), POSITIONS), limit}):
            if prefer(hierarchy, self.tiers.scope(tier, preferences), preferences):
                break


def prefer(hierarchy: Hierarchy, scope: Scope, soft: tuple[int, ...]) -> bool:
    """Moves the free unknowns of `scope` towards the preferences; returns whether all of them hold then."""
    before = hierarchy.save(scope.free)
    if hierarchy.attempt(scope, 1).satisfied:
        return True
    hierarchy.values.assign(before.items())
    hard = [index for index in scope.constraints if hierarchy.is_hard[index]]
    rows = hierarchy.rows(hard)
    softness = [0.0] * len(rows)
    for index in soft:
        weight = hierarchy.problem.constraints[index].weight or 0.0
        for row in hierarchy.problem.constraints[index].rows if weight > 0.0 else ():
            rows.append(row)
            softness.append(FIRMNESS / float(np.sqrt(weight)))
    cost = _cost(hierarchy, soft)
    task = Task(rows, softness, scope.free)
    verdict = attempt(task, hierarchy.values, hierarchy.metric, hierarchy.settings, hierarchy.clock)
    if not verdict.satisfied or not _cost(hierarchy, soft) < cost:
        hierarchy.values.assign(before.items())
        return False
    # Those that hold but for the give of their slack are made exact.
    nearly = [index for index in soft if _cost(hierarchy, (index,)) < NEARLY**2]
    reached = hierarchy.save(scope.free)
    if not hierarchy.attempt(replace(scope, constraints=tuple(sorted([*hard, *nearly]))), 0).satisfied:
        hierarchy.values.assign(reached.items())
    return False


def _cost(hierarchy: Hierarchy, soft: tuple[int, ...]) -> float:
    """Returns the weighted sum of squares of the violations of preferences."""
    total = 0.0
    hierarchy.refresh(soft)
    for index in soft:
        constraint = hierarchy.problem.constraints[index]
        for row in constraint.rows:
            lack = violation_of(row, hierarchy.values) / row.scale
            total += (constraint.weight or 0.0) * lack * lack
    return total

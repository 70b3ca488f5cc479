"""The stages of one group.

A stage frees the unknowns of the tiers up to its own (`tiers`). Where it leaves a choice, as few things move
as can be found (`thinning`).

A stage whose rows contradict each other says so with a proof. The stages after it are only tried if what they
free has a share in that proof, and among the kept sizes only those that have are freed, one after another.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from aidl_lang.solver.forms import Affine
from aidl_lang.solver.freezing import Freezer
from aidl_lang.solver.gradients import FLAT, gradients
from aidl_lang.solver.preferences import prefer
from aidl_lang.solver.solution import Concession, GroupFailure, StageReport
from aidl_lang.solver.thinning import thin
from aidl_lang.solver.tiers import OWN, POSITIONS, SIZES, Scope, Tier, Tiers, stage_name

if TYPE_CHECKING:
    from aidl_lang.solver.branches import Verdict
    from aidl_lang.solver.hierarchy import Hierarchy

Best: TypeAlias = tuple[float, dict[int, float]]
"""The least violation reached so far, and the values there."""
Proof: TypeAlias = Mapping[int, float]
"""Factors of tape nodes whose sum shows that rows contradict each other; empty if there is no proof."""

LAST_RESTARTS = 5
"""Perturbed starts at the last stage; the earlier ones have one."""
MOST_FAILURES = 20
"""The most conflicts that are explained and worked around; after them the best effort is kept."""

MOST_SIZES = 8
"""The most kept sizes that are freed one after another before all are."""
SHARE = 1e-9
"""Slope, relative to the terms of its sum, below which an unknown has no share in a proof."""


class Group:
    """The stages of one group."""

    def __init__(self, hierarchy: Hierarchy, group: int) -> None:
        self.hierarchy, self.group = hierarchy, group
        held = hierarchy.held_by(group)
        self.hard = [index for index in held if hierarchy.is_hard(index)]
        self.soft = [index for index in held if not hierarchy.is_hard(index)]
        self.tiers = Tiers(hierarchy, group)

    def solve(self, reached: Tier = (0, 0)) -> None:
        """Satisfies the constraints. Those that share nothing that could ever move are problems of their own:
        the needs of one do not loosen the other. `reached` is the last stage that some of them needed before.
        """
        hierarchy = self.hierarchy
        for part in [part for part in self.tiers.independent(self.hard) if hierarchy.unmet(part)]:
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
        """Returns the constraint to go on without after a failure; None if it is not known which would
        help.
        """
        failure = self.hierarchy.failures[-1]
        own = [index for index in failure.conflict if index in self.hard]
        known = failure.minimal and own and not self.hierarchy.clock.expired
        return max(own) if known and len(self.hierarchy.failures) <= MOST_FAILURES else None

    # -- stages

    def _deepen(self, part: list[int], violated: list[int]) -> Tier | None:
        """Returns the tier of the first stage that satisfies everything; None if none does."""
        hierarchy = self.hierarchy
        everything = self.tiers.everything(part)
        before = hierarchy.save(everything.free)
        best: Best = (np.inf, before)
        tiers = sorted({self.tiers.tier(unknown) for unknown in everything.free})
        if self.tiers.beyond_positions(violated):
            broken = self._settle_sizes(self.tiers.beyond_positions(part), part)
            if broken is not None:
                seeds = sorted({*part, *broken})
                positions = [tier for tier in tiers if tier <= POSITIONS]
                if not hierarchy.unmet(seeds):
                    return SIZES
                reached, best, _ = self._climb(positions, seeds, best)
                if reached is not None:
                    return SIZES
                hierarchy.values.assign(before.items())
            positions = []
        else:
            positions = [tier for tier in tiers if tier <= POSITIONS]
        reached, best, obstacle = self._climb(positions, part, best)
        if reached is None:
            reached = self._resize(part, obstacle)
            if reached is None:
                reached, best, _ = self._climb([tier for tier in tiers if tier > POSITIONS], part, best)
        if reached is None:
            from aidl_lang.solver import conflicts

            failure = conflicts.explain(hierarchy, self.group, violated, everything, before, best[1])
            reached = self._from_elsewhere(failure, part, before)
            if reached is None:
                self._fail(failure, everything, best[1])
        return reached

    def _from_elsewhere(
        self, failure: GroupFailure, part: list[int], before: dict[int, float]
    ) -> Tier | None:
        """Returns the stage that satisfies everything from the place at which the failed constraints hold;
        None if none does.
        """
        hierarchy = self.hierarchy
        for tier in (POSITIONS, (9, 0)) if failure.holds_elsewhere else ():
            scope = self.tiers.scope(tier, part)
            hierarchy.values.assign(before.items())
            hierarchy.values.assign(pair for pair in failure.nearest if pair[0] in scope.free)
            if hierarchy.attempt(scope, 1).satisfied:
                self._report(tier, scope, before, failure.conflict)
                return tier
        hierarchy.values.assign(before.items())
        return None

    def _climb(
        self, tiers: list[Tier], seeds: list[int], best: Best
    ) -> tuple[Tier | None, Best, tuple[Tier, Proof]]:
        """Tries the stages in order. Returns the first that satisfies `seeds` and the constraints on all that
        it moves, or None; the values that came nearest; and the last stage tried, with the proof why it
        failed.
        """
        hierarchy = self.hierarchy
        everything = self.tiers.everything(seeds).free
        before = hierarchy.save(everything)
        violated = hierarchy.unmet(seeds)
        tried: dict[bool, frozenset[int]] = {}
        failed: dict[frozenset[int], Verdict] = {}
        obstacle: tuple[Tier, Proof] = ((1, 0), {})
        # A stage is searched branch by branch only when the branches that are active lead nowhere in any.
        for turning, tier in itertools.product((False, True), tiers):
            if not self.tiers.promising(violated, tier):
                continue
            scope = self.tiers.scope(tier, seeds)
            if scope.free in (tried.get(True), tried.get(turning)):
                continue
            if self._stands(obstacle[1], scope.free):
                continue
            tried[turning] = scope.free
            # Groups above a part that failed are not searched for long: the best effort is drawn.
            last = turning and tier == tiers[-1] and not hierarchy.failures
            earlier = failed.get(scope.free) if turning and not last else None
            if earlier is not None and earlier.turned is not None:
                verdict = earlier.turned()
            else:
                verdict = hierarchy.attempt(scope, LAST_RESTARTS if last else 1, turning=turning)
            self._report(tier, scope, before if verdict.satisfied else None)
            if verdict.satisfied:
                return tier, best, obstacle
            failed[scope.free] = verdict
            if verdict.violation < 0.99 * best[0]:
                best = (verdict.violation, hierarchy.save(everything))
            obstacle = tier, self._proof(scope, verdict)
            hierarchy.values.assign(before.items())
            if hierarchy.clock.expired:
                hierarchy.timed_out = True
                break
        return None, best, obstacle

    # -- proofs, and sizes in the way

    def _proof(self, scope: Scope, verdict: Verdict) -> Proof:
        rows = self.hierarchy.rows(scope.constraints)
        return {rows[i].expression: factor for i, factor in verdict.proof.items()}

    def _stands(self, proof: Proof, free: frozenset[int]) -> bool:
        """Tells whether the proof holds with more unknowns free: whether none of them has a share in it."""
        if not proof:
            return False
        values = self.hierarchy.values
        values.update(list(proof))
        freezer = Freezer(values, free)
        total: dict[int, float] = {}
        sizes: dict[int, float] = {}
        for node, factor in proof.items():
            form = freezer.form(node)
            if form is None:
                return False
            for slot, slope in form.terms.items() if isinstance(form, Affine) else ():
                total[slot] = total.get(slot, 0.0) + factor * slope
                sizes[slot] = sizes.get(slot, 0.0) + abs(factor * slope)
        return all(abs(slope) <= SHARE * sizes[slot] for slot, slope in total.items())

    def _resize(self, seeds: list[int], obstacle: tuple[Tier, Proof]) -> Tier | None:
        """Frees the kept sizes that have a share in the proof, one after another, with the positions of the
        last stage that was tried. Returns the stage at which that satisfies everything, or None.
        """
        hierarchy = self.hierarchy
        last, proof = obstacle
        before = hierarchy.save(self.tiers.everything(seeds).free)
        freed: set[int] = set()
        while proof and len(freed) < MOST_SIZES and not hierarchy.clock.expired:
            size = self._cheapest(proof, freed)
            if size is None:
                break
            freed.add(size)
            scope = self.tiers.scope(last, seeds, freed)
            verdict = hierarchy.attempt(scope, 1)
            level = max(map(self.tiers.tier, freed))
            self._report(level, scope, before if verdict.satisfied else None)
            if verdict.satisfied:
                return level
            hierarchy.values.assign(before.items())
            proof = self._proof(scope, verdict)
        return None

    def _cheapest(self, proof: Proof, freed: set[int]) -> int | None:
        """Returns the kept size that would resolve a proof by the smallest change relative to itself, of the
        first stage at which one has a share in it.
        """
        hierarchy = self.hierarchy
        hierarchy.refresh(self.tiers.scope((9, 0), self.hard).constraints)
        slopes: dict[int, float] = {}
        for node, gradient in gradients(hierarchy.values, proof).items():
            for unknown, slope in gradient.items():
                slopes[unknown] = slopes.get(unknown, 0.0) + proof[node] * slope
        lack = sum(factor * hierarchy.values.nodes[node] for node, factor in proof.items())
        choices = []
        for unknown, slope in slopes.items():
            tier = self.tiers.tier(unknown)
            if tier > POSITIONS and unknown not in freed and abs(slope) > FLAT:
                size, change = hierarchy.values.unknowns[unknown], -lack / slope
                vanishes = size * (size + change) <= 0.0
                share = abs(change / size) if size else np.inf
                choices.append((vanishes, tier, round(float(share), 6), hierarchy.name(unknown), unknown))
        return min(choices)[-1] if choices else None

    # -- sizes that no position can help

    def _settle_sizes(self, rigid: list[int], part: list[int]) -> list[int] | None:
        """Changes the sizes that `rigid` need: those they place, then as in the stages for sizes. Returns the
        constraints outside `part` that this broke and positions may mend; None if no sizes satisfy `rigid`.
        """
        hierarchy = self.hierarchy
        mentioned = frozenset().union(*map(hierarchy.mentions.__getitem__, rigid))
        # Another row of such a constraint may hang on positions, which are free as they were before.
        reached = frozenset(u for _, rows in self.tiers.reached(rigid, rigid) for row in rows for u in row)
        positions = frozenset(unknown for unknown in reached if self.tiers.tier(unknown) <= POSITIONS)
        sizes = frozenset(unknown for unknown in mentioned if self.tiers.tier(unknown) > POSITIONS)
        unmet = hierarchy.unmet(rigid)
        placed = sizes & frozenset().union(*(hierarchy.problem.constraints[i].placed for i in unmet))
        levels = sorted({self.tiers.tier(unknown) for unknown in sizes})
        stages = [(level, frozenset(u for u in sizes if self.tiers.tier(u) <= level)) for level in levels]
        tried: frozenset[int] = frozenset()
        for level, resized in ((SIZES, placed), *stages):
            if resized <= tried:
                continue
            tried, free = resized, resized | positions
            before = hierarchy.save(free)
            scope = Scope(free, tuple(sorted(rigid)))
            satisfied = hierarchy.attempt(scope, 1).satisfied
            self._report(level, scope, before if satisfied else None)
            if satisfied:
                moved = [u for u in free if hierarchy.values.unknowns[u] != before[u]]
                touched = {i for u in moved for i in hierarchy.solved_mentioning(u, self.group)} - set(part)
                return hierarchy.unmet(sorted(filter(hierarchy.is_hard, touched)))
            hierarchy.values.assign(before.items())
        return None

    def _report(
        self,
        tier: Tier,
        scope: Scope,
        before: dict[int, float] | None,
        despite: tuple[int, ...] = (),
    ) -> None:
        """Reports a stage. If it succeeded, starting from the values `before`, first holds the unknowns that
        need not move. `despite` are constraints that hold though a search from `before` had failed.
        """
        hierarchy, concession = self.hierarchy, None
        if before is not None:
            before = hierarchy.since(before, scope.free)
            thin(hierarchy, scope, before, self.tiers.tier)
            moved = frozenset(
                u for u in scope.free if self.tiers.is_dear(u) and hierarchy.moved(u, before[u])
            )
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
        if hierarchy.all_hard:
            return
        limit = min(max(reached, OWN), POSITIONS)
        soft = set(self.soft)
        if reached > (0, 0):
            for unknown in self.tiers.scope(min(reached, POSITIONS), self.hard).free:
                soft.update(
                    index
                    for index in hierarchy.solved_mentioning(unknown, self.group)
                    if not hierarchy.is_hard(index)
                )
        if not hierarchy.unmet(soft):
            return
        preferences = tuple(sorted(soft))
        self.tiers.place([*self.hard, *preferences])
        for tier in sorted({min(max(reached, (1, 0)), POSITIONS), limit}):
            if prefer(hierarchy, self.tiers.scope(tier, preferences), preferences):
                break

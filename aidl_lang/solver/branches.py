"""An attempt to satisfy chosen rows over chosen unknowns, with `min`, `max`, `abs` and `select` in them.

Branching operations are replaced by the branch active at the current values, the smooth system that is left
is solved, and the result is judged by the original expressions (paper, appendix B). Where a branch was
crossed on the way, the region in which it stays valid is added as inequalities; only if that has no solution
are the branches chosen anew at the values reached, and so on until they come round again.

Inequalities join the system when they are violated; those that hold all along have no influence.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver import newton
from aidl_lang.solver.array_program import ZERO
from aidl_lang.solver.expression import Floats, Ints, Op
from aidl_lang.solver.freezing import AnyProgram, Branch, Choice, Freezer, Frozen, Root
from aidl_lang.solver.newton import Clock, End, System
from aidl_lang.solver.problem import Relation, Row, Settings
from aidl_lang.solver.valuation import Valuation

TIGHTER = 0.5
"""Newton's tolerance relative to that of the check: both round differently."""
NEIGHBOURS = 12
"""Combinations of other branches tried as a last resort, per perturbed start of the stage."""
DEEPEST = 6
"""The most branches that are turned together."""
SHARE = 1e-7
"""Part of the greatest factor below which a row has no part in a contradiction."""


@record()
class Task:
    """The rows and unknowns of an attempt.

    rows     the rows to satisfy
    softness unit of a slack for each row, 0 where the row is hard
    free     the unknowns that may move
    restarts perturbed starts to try at singular places
    turning  whether branches may be turned as a last resort
    """

    rows: Sequence[Row]
    softness: Sequence[float]
    free: frozenset[int]
    restarts: int = 1
    turning: bool = True


@record()
class Verdict:
    """The result of an attempt.

    violation  the greatest scaled violation of a hard row at the values that were left
    refuted    True if rows without a branch to choose contradict each other wherever the free unknowns are
    """

    end: End
    violation: float
    refuted: bool = False

    @property
    def satisfied(self) -> bool:
        return self.end is End.CONVERGED


def violation_of(row: Row, values: Valuation) -> float:
    """Returns the violation of a row at the current values, in its units; infinite if it has no value."""
    value = values.nodes[row.expression]
    violation = max(value, 0.0) if row.relation is Relation.AT_MOST else abs(value)
    return violation if violation == violation else np.inf


def holds(row: Row, values: Valuation, tolerance: float) -> bool:
    return violation_of(row, values) <= tolerance * row.scale


@record()
class Metric:
    """The units of changes, each (n,).

    scale    length of a change that counts as one
    unit     the same without regard to what is kept
    longest  the largest change in one Newton step
    """

    scale: Floats
    unit: Floats
    longest: Floats

    def of(self, columns: Sequence[int] | Ints) -> Metric:
        """Returns the units of some unknowns."""
        return Metric(self.scale[columns], self.unit[columns], self.longest[columns])


def attempt(task: Task, values: Valuation, metric: Metric, settings: Settings, clock: Clock) -> Verdict:
    """Tries to satisfy `task`, moving its free unknowns the least; leaves `values` at the result."""
    return _Attempt(task, values, metric, settings, clock).run()


class _Attempt:
    def __init__(
        self, task: Task, values: Valuation, metric: Metric, settings: Settings, clock: Clock
    ) -> None:
        self.task, self.values, self.metric, self.settings, self.clock = task, values, metric, settings, clock
        self.cone = values.cone(row.expression for row in task.rows)
        values.refresh(self.cone)
        self.free = sorted(task.free)
        self.origin = [values.unknowns[unknown] for unknown in self.free]
        self.considered: list[int] = []
        """The equations, and the inequalities that were violated at some time."""
        self.blamed: list[int] = []
        """The rows that contradicted each other in the last branch."""
        self.steady = True
        """True if none of the blamed rows hangs on a choice of branches."""

    @cached_property
    def freezer(self) -> Freezer:
        return Freezer(self.values, self.free, self.settings.pruning)

    def run(self) -> Verdict:
        tolerance = self.settings.tolerance
        self.considered = [
            i
            for i, row in enumerate(self.task.rows)
            if row.relation is Relation.EQUAL or not holds(row, self.values, tolerance)
        ]
        verdict = self._follow_branches()
        if verdict.satisfied or verdict.refuted:
            return verdict
        return self._try_neighbours(verdict) if self.task.turning else verdict

    # -- branches

    def _follow_branches(self) -> Verdict:
        """Solves with the active branches, then with those active at the result, until they come again."""
        seen: set[tuple[Branch, ...]] = set()
        base = self.origin
        while True:
            verdict, branches, crossed = self._solve_in_branch(base, frozenset())
            if verdict.refuted:
                return verdict
            if not verdict.satisfied and not crossed:
                # No solution with these branches; where the search ended others may be active.
                rows = [self.task.rows[i].expression for i in self.considered]
                crossed = self.freezer.freeze(rows).branches != branches
            if not crossed or branches in seen or len(seen) >= self.settings.branches:
                return verdict
            seen.add(branches)
            base = self._current()

    def _solve_in_branch(
        self, base: list[float], flipped: frozenset[int]
    ) -> tuple[Verdict, tuple[Branch, ...], bool]:
        """Solves with the branches active at `base`; returns these, and whether the result lies in others."""
        region: list[Root] = []
        outside: tuple[list[float], Verdict] | None = None
        choice = Choice(self.freezer, flipped)
        while True:
            self._move_to(base)
            roots: list[Root] = [self.task.rows[i].expression for i in self.considered]
            frozen = choice.freeze([*roots, *region])
            verdict = self._judge(self._solve(frozen, base, 0 if flipped else self.task.restarts))
            if verdict.satisfied:
                return verdict, frozen.branches, False
            if self.blamed and self.steady:
                return replace(verdict, refuted=True), frozen.branches, False
            if self._join_violated() and not self.clock.expired:
                continue
            crossed, border = self._crossed(frozen.branches)
            if verdict.end is End.CONTRARY and crossed:
                outside = outside or (self._current(), verdict)
                if fresh := [root for root in border if root not in region]:
                    region.extend(fresh)
                    continue
            if outside is not None:
                self._move_to(outside[0])
                return outside[1], frozen.branches, True
            return verdict, frozen.branches, False

    def _crossed(self, branches: tuple[Branch, ...]) -> tuple[bool, list[Root]]:
        """Returns whether other branches are active now, and the expressions that were <= 0 before that."""
        crossed, border = False, []
        for node, choice in branches:
            op, operands = self.values.tape.op_list[node], self.values.tape.operand_lists[node]
            root = _border(op, operands, choice)
            if self._difference(root) > 0.0:
                crossed = True
                border.append(root)
        return crossed, border

    def _difference(self, root: Root) -> float:
        nodes = self.values.nodes
        if isinstance(root, int):
            return nodes[root]
        a, b = root
        return (0.0 if a == ZERO else nodes[a]) - nodes[b]

    def _try_neighbours(self, verdict: Verdict) -> Verdict:
        """Turns branching nodes to their other branch, one and then several together, as the last resort.
        Branches outside a contradiction would not help, so only those below the rows to blame are turned;
        those that decide most about them (the outermost) come first.
        """
        reached, blamed = self._current(), self.blamed
        steady = self._without_branches()
        self._move_to(reached)
        if steady is None or not steady.satisfied:
            return replace(verdict, refuted=steady is not None and steady.refuted)
        waiting = deque([(frozenset[int](), self._turning(blamed))])
        known = {frozenset[int]()}
        left = NEIGHBOURS * max(1, self.task.restarts)
        while waiting:
            turned, nodes = waiting.popleft()
            for node in nodes:
                flipped = turned ^ {node}
                if flipped in known:
                    continue
                if self.clock.expired or not left:
                    self._move_to(reached)
                    return verdict
                known.add(flipped)
                left -= 1
                other, _, _ = self._solve_in_branch(self.origin, flipped)
                if other.satisfied:
                    return other
                if len(flipped) < DEEPEST:
                    waiting.append((flipped, self._turning(self.blamed)))
        self._move_to(reached)
        return verdict

    def _turning(self, blamed: Sequence[int]) -> list[int]:
        """Returns the branching nodes that may help where the rows `blamed` contradict each other, or, if
        none is to blame, those that do not hold at the current values.
        """
        rows, tolerance = self.task.rows, self.settings.tolerance
        unmet = [rows[i].expression for i in blamed] or [
            row.expression for row in rows if not holds(row, self.values, tolerance)
        ]
        nodes = self.freezer.choices(unmet)
        if not blamed:
            others = self.freezer.choices(row.expression for row in rows)
            nodes += [node for node in others if node not in nodes]
        return nodes

    def _without_branches(self) -> Verdict | None:
        """Returns the verdict of the rows that hang on no branch by themselves; None if all rows are such."""
        self._move_to(self.origin)
        rows, softness = self.task.rows, self.task.softness
        steady = sorted(self.freezer.freeze([row.expression for row in rows]).steady)
        if len(steady) == len(rows):
            return None
        alone = Task([rows[i] for i in steady], [softness[i] for i in steady], self.task.free)
        return attempt(alone, self.values, self.metric, self.settings, self.clock)

    # -- solving with fixed branches

    def _solve(self, frozen: Frozen, base: list[float], restarts: int) -> End:
        """Solves each program by itself and moves to the result; returns the worst end of them."""
        ends = [End.CONVERGED]
        self.blamed, self.steady = [], True
        if failing := self._failing_constants(frozen):
            self._blame(frozen, failing[:1])
            if restarts <= 1:
                return End.INFEASIBLE
            ends.append(End.INFEASIBLE)
        start = dict(zip(self.free, base, strict=True))
        origin = dict(zip(self.free, self.origin, strict=True))
        for program in frozen.programs:
            ends.append(self._solve_program(frozen, program, start, origin, restarts))
        self.values.refresh(self.cone)
        return next((end for end in (End.EXHAUSTED, End.INFEASIBLE) if end in ends), End.CONVERGED)

    def _solve_program(
        self,
        frozen: Frozen,
        program: AnyProgram,
        start: dict[int, float],
        origin: dict[int, float],
        restarts: int,
    ) -> End:
        asked, count = self.considered, len(self.considered)
        rows = [self.task.rows[asked[i]] if i < count else None for i in program.rows]
        softness = [self.task.softness[asked[i]] if i < count else 0.0 for i in program.rows]
        metric = self.metric.of(program.columns)
        scale = metric.scale
        anchor = np.array([origin[unknown] for unknown in program.columns])
        row_scale = np.array([row.scale if row else 1.0 for row in rows])
        at_most = np.array([row is None or row.relation is Relation.AT_MOST for row in rows])
        slacks = np.array(softness) if any(softness) else None
        system = System(program, anchor, scale, row_scale, at_most, metric.longest, metric.unit, slacks)
        z = np.zeros(system.size)
        z[: len(scale)] = (np.array([start[unknown] for unknown in program.columns]) - anchor) / scale
        tolerance, iterations = TIGHTER * self.settings.tolerance, self.settings.iterations
        outcome = newton.solve(system, tolerance, iterations, self.clock, z, restarts)
        if outcome.contradiction is not None:
            taking_part = np.flatnonzero(np.abs(outcome.contradiction) > SHARE).tolist()
            if taking_part:
                self._blame(frozen, [int(program.rows[i]) for i in taking_part])
        x = anchor + scale * outcome.z[: len(scale)]
        if np.isfinite(x).all():
            self.values.assign(zip(program.columns, x.tolist(), strict=True))
        return outcome.end

    def _blame(self, frozen: Frozen, rows: Sequence[int]) -> None:
        """Notes rows that contradict each other; rows that hang on no branch replace rows that do."""
        count = len(self.considered)
        steady = frozen.steady.issuperset(rows) and max(rows) < count
        if not self.blamed or (steady and not self.steady):
            self.blamed = [self.considered[i] for i in rows if i < count]
            self.steady = steady

    def _failing_constants(self, frozen: Frozen) -> list[int]:
        """Returns the hard rows that no free unknown moves and that do not hold."""
        return [
            i
            for i in frozen.constant
            if i < len(self.considered)
            and not self.task.softness[self.considered[i]]
            and not holds(self.task.rows[self.considered[i]], self.values, self.settings.tolerance)
        ]

    def _judge(self, end: End) -> Verdict:
        worst = 0.0
        for row, softness in zip(self.task.rows, self.task.softness, strict=True):
            if not softness:
                worst = max(worst, violation_of(row, self.values) / row.scale)
        if worst <= self.settings.tolerance:
            return Verdict(End.CONVERGED, worst)
        return Verdict(End.CONTRARY if end is End.CONVERGED else end, worst)

    def _join_violated(self) -> bool:
        known = set(self.considered)
        others = ((i, row) for i, row in enumerate(self.task.rows) if i not in known)
        fresh = [i for i, row in others if not holds(row, self.values, self.settings.tolerance)]
        self.considered.extend(fresh)
        return bool(fresh)

    def _current(self) -> list[float]:
        return [self.values.unknowns[unknown] for unknown in self.free]

    def _move_to(self, x: list[float]) -> None:
        self.values.assign(zip(self.free, x, strict=True))
        self.values.refresh(self.cone)


def _border(op: int, operands: tuple[int, ...], choice: int) -> Root:
    """Returns the expression that is <= 0 as long as a branching node takes the branch `choice`."""
    if op == Op.SELECT:
        return (ZERO, operands[0]) if choice == 1 else operands[0]
    if op == Op.ABS:
        return operands[0] if choice else (ZERO, operands[0])
    chosen, rival = operands[choice], operands[1 - choice]
    return (chosen, rival) if op == Op.MINIMUM else (rival, chosen)

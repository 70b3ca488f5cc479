"""One attempt: chosen rows over chosen unknowns, with `min`, `max`, `abs` and `select` in them.

Branching operations are replaced by the branch active at the current values, the smooth system that is left
is solved, and the result is judged by the original expressions (paper, appendix B). Where a branch was
crossed on the way, the region in which it stays valid is added as inequalities; only if that has no solution
are the branches chosen anew at the values reached, and so on until they come round again.

Inequalities join the system when they are violated; those that hold all along have no influence.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from aidl_lang.solver import newton
from aidl_lang.solver.array_freezing import ZERO
from aidl_lang.solver.array_program import ArrayProgram
from aidl_lang.solver.freezing import Branch, Frozen, Root, freeze
from aidl_lang.solver.newton import Clock, End, System
from aidl_lang.solver.operations import Floats, Op
from aidl_lang.solver.problem import Relation, Row, Settings
from aidl_lang.solver.program import Program
from aidl_lang.solver.valuation import Cone, Valuation

TIGHTER = 0.5
"""Newton's tolerance relative to that of the check: both round differently."""
LAZY_ROUNDS = 4
"""Rounds of adding violated inequalities before all of them are taken into account."""
NEIGHBOURS = 12
"""Combinations of other branches tried as a last resort, for each perturbed start that the stage is worth."""


@dataclass(frozen=True)
class Task:
    """
    rows     the rows to satisfy
    softness unit of a slack for each row, 0 where the row is hard
    free     the unknowns that may move
    restarts perturbed starts to try at singular places
    """

    rows: Sequence[Row]
    softness: Sequence[float]
    free: frozenset[int]
    restarts: int = 1


@dataclass(frozen=True)
class Verdict:
    """`violation` is the greatest scaled violation of a hard row at the values that were left."""

    end: End
    violation: float

    @property
    def satisfied(self) -> bool:
        return self.end is End.CONVERGED


def violation_of(row: Row, values: Valuation) -> float:
    """How far the row is from holding, in its own units; infinite if it has no value."""
    value = values.nodes[row.expression]
    violation = max(value, 0.0) if row.relation is Relation.AT_MOST else abs(value)
    return violation if violation == violation else np.inf


def holds(row: Row, values: Valuation, tolerance: float) -> bool:
    return violation_of(row, values) <= tolerance * row.scale


@dataclass(frozen=True)
class Metric:
    """How changes are measured, each (n,).

    scale    length of a change that counts as one
    unit     the same without regard to what is kept
    longest  the largest change in one Newton step, if there is one
    """

    scale: Floats
    unit: Floats
    longest: Floats | None


def attempt(task: Task, values: Valuation, metric: Metric, settings: Settings, clock: Clock) -> Verdict:
    """Tries to satisfy `task`, moving its free unknowns the least; leaves `values` at what was reached."""
    return _Attempt(task, values, metric, settings, clock).run()


class _Attempt:
    def __init__(
        self, task: Task, values: Valuation, metric: Metric, settings: Settings, clock: Clock
    ) -> None:
        self.task, self.values, self.metric, self.settings, self.clock = task, values, metric, settings, clock
        self.cone: Cone = values.cone(row.expression for row in task.rows)
        self.free = sorted(task.free & self.cone.unknowns)
        self.origin = [values.unknowns[unknown] for unknown in self.free]
        self.considered: list[int] = []
        """The equations, and the inequalities that were violated at some time."""
        self.joins = 0

    def run(self) -> Verdict:
        self._move_to(self.origin)
        tolerance = self.settings.tolerance
        self.considered = [
            i
            for i, row in enumerate(self.task.rows)
            if row.relation is Relation.EQUAL or not holds(row, self.values, tolerance)
        ]
        verdict = self._follow_branches()
        return verdict if verdict.satisfied else self._try_neighbours(verdict)

    # -- branches

    def _follow_branches(self) -> Verdict:
        """Solves with the active branches, then with those active at the result, until they come again."""
        seen: set[tuple[Branch, ...]] = set()
        base = self.origin
        while True:
            verdict, branches, crossed = self._solve_in_branch(base, frozenset())
            if not verdict.satisfied and not crossed:
                # No solution with these branches; where the search ended others may be active.
                crossed = self._active() != branches
            if not crossed or branches in seen or len(seen) >= self.settings.branches:
                return verdict
            seen.add(branches)
            base = self._current()

    def _active(self) -> tuple[Branch, ...]:
        """The branches active at the current values."""
        return freeze(
            self.values, [self.task.rows[i].expression for i in self.considered], self.free
        ).branches

    def _solve_in_branch(
        self, base: list[float], flipped: frozenset[int]
    ) -> tuple[Verdict, tuple[Branch, ...], bool]:
        """Solves with the branches active at `base`; says which, and whether the result lies in others."""
        region: list[Root] = []
        outside: tuple[list[float], Verdict] | None = None
        while True:
            self._move_to(base)
            roots: list[Root] = [self.task.rows[i].expression for i in self.considered]
            frozen = freeze(self.values, [*roots, *region], self.free, flipped)
            verdict = self._judge(self._solve(frozen, base, 0 if flipped else self.task.restarts))
            if verdict.satisfied:
                return verdict, frozen.branches, False
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
        """Whether other branches are active now, and the expressions that were <= 0 before that."""
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
        """The last resort: one branching node takes its other branch, or two of them do. Those that decide
        most about a row that could not be met (the outermost) come first.
        """
        if not self._hold_without_branches():
            return verdict
        reached = self._current()
        tolerance = self.settings.tolerance
        unmet = [row.expression for row in self.task.rows if not holds(row, self.values, tolerance)]
        self._move_to(self.origin)
        nodes = self._branching(unmet)
        others = self._branching(row.expression for row in self.task.rows)
        others = [node for node in others if node not in nodes]
        flips = itertools.chain(
            itertools.combinations(nodes, 1),
            itertools.combinations(nodes[:NEIGHBOURS], 2),
            itertools.combinations(others, 1),
            itertools.product(nodes[:NEIGHBOURS], others),
        )
        for flipped in itertools.islice(flips, NEIGHBOURS * max(1, self.task.restarts)):
            if self.clock.expired:
                break
            other, _, _ = self._solve_in_branch(self.origin, frozenset(flipped))
            if other.satisfied:
                return other
        self._move_to(reached)
        return verdict

    def _hold_without_branches(self) -> bool:
        """Whether the rows that no other branch could help can be met by themselves."""
        reached = self._current()
        self._move_to(self.origin)
        steady = [i for i, row in enumerate(self.task.rows) if not self._branching([row.expression])]
        if len(steady) == len(self.task.rows):
            self._move_to(reached)
            return False
        rows, softness = self.task.rows, self.task.softness
        alone = Task([rows[i] for i in steady], [softness[i] for i in steady], self.task.free)
        met = attempt(alone, self.values, self.metric, self.settings, self.clock).satisfied
        self._move_to(reached)
        return met

    def _branching(self, roots: Iterable[int]) -> list[int]:
        """The nodes below that choose a branch which the free unknowns decide, outermost first."""
        branches = freeze(self.values, list(roots), self.free).branches
        return sorted((node for node, _ in branches if self._can_flip(node)), reverse=True)

    def _can_flip(self, node: int) -> bool:
        return not self.values.cone([node]).unknowns.isdisjoint(self.free)

    # -- solving with fixed branches

    def _solve(self, frozen: Frozen, base: list[float], restarts: int) -> End:
        """Solves each program by itself and moves to the result; the worst end of them."""
        ends = [End.CONVERGED]
        if frozen.constant and not self._constants_hold(frozen):
            if restarts <= 1:
                return End.INFEASIBLE
            ends.append(End.INFEASIBLE)
        start = dict(zip(self.free, base, strict=True))
        origin = dict(zip(self.free, self.origin, strict=True))
        for program in frozen.programs:
            ends.append(self._solve_program(program, start, origin, restarts))
        self.values.refresh(self.cone)
        return next((end for end in (End.EXHAUSTED, End.INFEASIBLE) if end in ends), End.CONVERGED)

    def _solve_program(
        self,
        program: Program | ArrayProgram,
        start: dict[int, float],
        origin: dict[int, float],
        restarts: int,
    ) -> End:
        rows = [
            self.task.rows[self.considered[i]] if i < len(self.considered) else None for i in program.rows
        ]
        softness = [
            self.task.softness[self.considered[i]] if row else 0.0
            for i, row in zip(program.rows, rows, strict=True)
        ]
        metric, columns = self.metric, program.columns
        scale = metric.scale[columns]
        anchor = np.array([origin[unknown] for unknown in program.columns])
        system = System(
            program,
            anchor,
            scale,
            np.array([row.scale if row else 1.0 for row in rows]),
            np.array([row is None or row.relation is Relation.AT_MOST for row in rows]),
            np.array(softness) if any(softness) else None,
            None if metric.longest is None else metric.longest[columns],
            metric.unit[columns],
        )
        z = np.zeros(system.size)
        z[: len(scale)] = (np.array([start[unknown] for unknown in program.columns]) - anchor) / scale
        outcome = newton.solve(
            system,
            TIGHTER * self.settings.tolerance,
            self.settings.iterations,
            self.clock,
            z,
            restarts,
        )
        x = anchor + scale * outcome.z[: len(scale)]
        if np.isfinite(x).all():
            self.values.assign(zip(program.columns, x.tolist(), strict=True))
        return outcome.end

    def _constants_hold(self, frozen: Frozen) -> bool:
        """Whether the hard rows that no free unknown moves hold as they are."""
        indices = [self.considered[i] for i in frozen.constant if i < len(self.considered)]
        rows = [self.task.rows[i] for i in indices if not self.task.softness[i]]
        return all(holds(row, self.values, self.settings.tolerance) for row in rows)

    def _judge(self, end: End) -> Verdict:
        """The verdict of the original expressions at the current values."""
        worst = 0.0
        for row, softness in zip(self.task.rows, self.task.softness, strict=True):
            if not softness:
                worst = max(worst, violation_of(row, self.values) / row.scale)
        if worst <= self.settings.tolerance:
            return Verdict(End.CONVERGED, worst)
        return Verdict(End.CONTRARY if end is End.CONVERGED else end, worst)

    def _join_violated(self) -> bool:
        """Takes up inequalities that came to be violated; after some rounds, all of them."""
        known = set(self.considered)
        fresh = [
            i
            for i, row in enumerate(self.task.rows)
            if i not in known and not holds(row, self.values, self.settings.tolerance)
        ]
        self.joins += bool(fresh)
        if fresh and self.joins > LAZY_ROUNDS:
            fresh = [i for i in range(len(self.task.rows)) if i not in known]
        self.considered.extend(fresh)
        return bool(fresh)

    def _current(self) -> list[float]:
        return [self.values.unknowns[unknown] for unknown in self.free]

    def _move_to(self, x: list[float]) -> None:
        self.values.assign(zip(self.free, x, strict=True))
        self.values.refresh(self.cone)


def _border(op: int, operands: tuple[int, ...], choice: int) -> Root:
    """What is <= 0 as long as a branching node takes the branch `choice`."""
    if op == Op.SELECT:
        return (ZERO, operands[0]) if choice == 1 else operands[0]
    if op == Op.ABS:
        return operands[0] if choice else (ZERO, operands[0])
    chosen, rival = operands[choice], operands[1 - choice]
    return (chosen, rival) if op == Op.MINIMUM else (rival, chosen)

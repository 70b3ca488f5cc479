"""The order of solving: groups from the leaves to the root, at each the stages; what need not be solved.

Groups of one depth are solved all at once (`levels`) where there are many rows, else one by one (`group`,
which says what the stages are).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver import Stages, expression
from aidl_lang.solver.branches import Metric, Task, Verdict, attempt, holds
from aidl_lang.solver.expression import Bools, Floats, Ints, Op, mentioned
from aidl_lang.solver.group import Group
from aidl_lang.solver.linear import Sparse, each_once, marked
from aidl_lang.solver.loosening import Scope, Tier, tiers_at
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.problem import (
    GroupFailure,
    P,
    Problem,
    Row,
    Settings,
    Solution,
    StageReport,
    Status,
    depths,
    violations,
)
from aidl_lang.solver.valuation import FLAT, Valuation, gradients

if TYPE_CHECKING:
    from aidl_lang.solver.levels import Levels

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

    @cached_property
    def _rides(self) -> Ints:
        return riding_depths(self.problem, self._group_depths)

    @cached_property
    def held_by(self) -> dict[int, list[int]]:
        """The constraints that each group holds, if it holds any."""
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
        """The unknowns in each constraint, by its index."""
        if (levels := self._levels) is None:
            return _Mentions(self.problem)
        starts = np.searchsorted(levels.constraints, np.arange(1, len(self.problem.holder)))
        found = (frozenset(part.tolist()) for part in np.split(levels.unknowns, starts))
        return dict(enumerate(found))

    @cached_property
    def _mentioned_by(self) -> dict[int, list[int]]:
        found: dict[int, list[int]] = {}
        for index in range(len(self.problem.holder)):
            for unknown in self.mentions[index]:
                found.setdefault(unknown, []).append(index)
        return found

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
                    self.stages += recollection.memory.stages.get(group, [])
            groups = [g for g in self.held_by if self._group_depths[g] == depth and not known[g]]
            is_small = len(groups) < FEW <= len(self.held_by)
            if usual and count >= (LARGE if is_small else MANY):
                self._solve_together(depth, known)
            else:
                self._solve_with_care(dict.fromkeys(groups, (0, 0)))
            if recollection is not None:
                recollection.reached[depth] = self.reached.copy()

    def _solve_together(self, depth: int, known: Bools) -> None:
        """Solves the groups at `depth`, but for `known` (g,), at once; then one by one those that remain."""
        if self._levels is None:
            from aidl_lang.solver.levels import Levels

            self._levels = Levels(self.problem, self.reached, self.settings, self.clock, self.metric)
        levels = self._levels
        levels.binding[list(self._broken)] = False
        stages = list(levels.solve(depth, known))
        left = set(levels.unsolved(depth).tolist())
        passed = {report.group: tier for tier, report in stages if report.succeeded}
        self.stages += [r for _, r in stages if r.succeeded or r.group not in left]  # others are tried again
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

    def violations(self) -> Floats:
        """Returns the violation of each row (r,) at the end, in its units; infinite if it has no value."""
        if self._levels is not None:
            return violations(self.problem, self._levels.nodes())
        self.values.assign(enumerate(self.reached.tolist()))
        self.refresh(range(len(self.problem.holder)))
        return violations(self.problem, np.array(self.values.nodes))

    def changed(self) -> list[int]:
        """Returns the kept sizes that differ from their first guess."""
        moved = np.abs(self.reached - self.problem.initial) > CHANGED * self.problem.scale
        found: list[int] = np.flatnonzero(moved & self.problem.kept).tolist()
        return found

    # -- questions of the groups

    def tiers(self, group: int, placed: Mapping[int, int]) -> list[int]:
        """Returns the tiers of all unknowns at `group`, whose constraints place `placed`, as numbers."""
        at, problem = np.full(len(self.reached), -1), self.problem
        at[list(placed)] = list(placed.values())
        around, stages = self._group_depths, self.settings.stages
        depth, depths = int(around[group]), around[problem.group]
        found: list[int] = tiers_at(depth, problem, depths, self._rides, at, stages).tolist()
        return found

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

    def mentioned(self, indices: Iterable[int]) -> frozenset[int]:
        """Returns the unknowns in any of these constraints."""
        return frozenset[int]().union(*map(self.mentions.__getitem__, indices))

    def sloping(self, indices: Iterable[int]) -> set[int]:
        """Returns the unknowns by which a row of these constraints has a slope at the current values."""
        roots = [row.expression for row in self.rows(indices)]
        self.values.update(roots)
        found = gradients(self.values, roots).values()
        return {u for gradient in found for u, slope in gradient.items() if abs(slope) > FLAT}

    def slopes(self, indices: Iterable[int], unknowns: Iterable[int], ends: bytes | None = None) -> Floats:
        """Returns the slopes (r, k) of the rows of these constraints by some unknowns at the current values,
        without what is below the nodes `ends`.
        """
        roots = [row.expression for row in self.rows(indices)]
        self.values.update(roots)
        column = {unknown: k for k, unknown in enumerate(unknowns)}
        matrix = np.zeros((len(roots), len(column)))
        found = gradients(self.values, roots, ends=ends)
        for i, root in enumerate(roots):
            for unknown, slope in found[root].items():
                if unknown in column:
                    matrix[i, column[unknown]] = slope
        return matrix

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
    """The unknowns in each constraint, found when asked for."""

    def __init__(self, problem: Problem) -> None:
        self._problem = problem

    def __missing__(self, index: int) -> frozenset[int]:
        rows = self._problem.constraints[index].rows
        found = self[index] = frozenset(mentioned(self._problem.tape, [row.expression for row in rows]))
        return found


def solve(problem: P, settings: Settings = Settings(), memory: Memory | None = None) -> Solution[P]:
    """Solves `problem` as far as it can be solved. Same input, same output, to the last digit.

    With a `memory`, which is brought up to date, only what has changed since its last solve is solved.
    """
    is_flat = settings.stages is Stages.FLAT
    sought = replace(problem, holder=np.zeros_like(problem.holder)) if is_flat else problem
    hierarchy = Hierarchy(sought, settings, Clock(settings.seconds))
    recollection = None if memory is None else Recollection(memory, sought, settings)
    with np.errstate(all="ignore"):  # what overflows is found not to hold
        hierarchy.run(recollection)
    violation, rows = hierarchy.violations(), problem.rows
    residuals = np.zeros(len(problem.holder))
    np.maximum.at(residuals, rows.constraint, violation)
    broken = rows.constraint[~(violation <= settings.tolerance * rows.scale)]
    satisfied = ~marked(broken, len(problem.holder))
    status = _status(satisfied[np.isnan(problem.weight)], hierarchy.timed_out)
    if recollection is not None:
        recollection.close(hierarchy.stages, status is Status.SOLVED and not hierarchy.failures)
    return Solution(
        problem,
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


# --- Groups that ride along: those that no constraint names keep their place in the group around them.
#
# A group whose frame is not named does not move in the one around it. What it draws moves within it only
# where something in it is named, and so does what a group draws that is only named as a whole: it moves with
# its frame. A group that clings to what is drawn around it, as a hole does to a part, is seen from its own
# frame where it rides along, so that nothing is free to slide in a part of which nobody said where it shall
# stand.

UNMOVED = 1e-9
"""Slopes of unit rows along a shift below which they count as zero."""


@record()
class Riding:
    """
    carried (g,) True for a group that rides along: its frame does not move in the group around it
    anchor  (g,) the group in whose frame the drawing of each is observed: the innermost around it that rides
            along and clings to what is drawn around it; 0 for the root
    movable (n,) the unknowns that may move
    """

    carried: Bools
    anchor: Ints
    movable: Bools

    @property
    def loose(self) -> Bools:
        """The groups (g,) that ride along, though they belong to nothing that is drawn around them."""
        own: Bools = self.anchor == np.arange(len(self.anchor))
        return self.carried & ~own

    def pins(self, problem: Problem, jacobian: Sparse) -> Sparse:
        """Returns a row for each direction in which everything that a carried group draws can shift together:
        one coordinate each is held, which fixes the group's place.
        """
        held: list[int] = []
        home = np.where(self.movable & self.carried[problem.group], problem.group, -1)
        for axis in (0, 1):
            held += _pinned(np.where(problem.axis == axis, home, -1), jacobian, len(self.carried))
        return Sparse(np.arange(len(held) + 1), np.array(held, dtype=np.intp), np.ones(len(held)))


def _pinned(home: Ints, jacobian: Sparse, groups: int) -> list[int]:
    """Returns a coordinate of each group whose coordinates, those at `home` in it, can all shift alike."""
    entries = np.flatnonzero(home[jacobian.columns] >= 0)
    key = jacobian.rows[entries].astype(np.int64) * groups + home[jacobian.columns[entries]]
    pairs, place = np.unique(key, return_inverse=True)
    slope = np.asarray(np.bincount(place, jacobian.entries[entries], len(pairs)), dtype=np.float64)
    held = each_once(pairs[np.abs(slope) > UNMOVED] % groups)
    own, first = np.unique(home, return_index=True)
    return [int(u) for g, u in zip(own.tolist(), first.tolist(), strict=True) if g >= 0 and g not in held]


def groups_riding(problem: Problem) -> Riding:
    """Returns the groups of a problem that ride along, by the names in its constraints."""
    named = naming(problem)
    moved = problem.frame_of
    may_move = named.frames[moved] if problem.named else _in_any_row(problem)
    movable = ~problem.kept & ((moved < 0) | may_move)
    movable &= (moved >= 0) | named.inside[problem.group]
    movable |= _stirred(problem, named, movable)
    movable &= problem.sealed == 0
    carried = ~named.frames & problem.named
    carried[0] = False
    anchor = np.zeros(len(carried), dtype=np.intp)
    for group, parent in enumerate(problem.parent.tolist()):
        if group:
            anchor[group] = group if carried[group] and group in problem.clinging else anchor[parent]
    return Riding(carried, anchor, movable)


def _stirred(problem: Problem, named: Naming, movable: Bools) -> Bools:
    """Returns the mask of unknowns drawn by groups only named as a whole that leave their frame."""
    axis = problem.axis
    moved = np.where(movable, problem.frame_of, -1)
    shifts = np.zeros((3, len(named.whole)), dtype=np.bool_)  # along x, along y, anyhow
    for direction in (0, 1):
        shifts[direction, moved[(moved >= 0) & (axis == direction)]] = True
    shifts[-1, moved[moved >= 0]] = True
    is_content = (problem.frame_of < 0) & ~problem.kept & named.whole[problem.group]
    found: Bools = is_content & ~shifts[axis, problem.group]
    return found


@record()
class Naming:
    """
    frames  (g,) True if a constraint around the group names it or something in it, so that its frame may
            move; the others ride along
    inside  (g,) True if a constraint names something that the group itself draws
    whole   (g,) True if a constraint names it as a whole, by its box or its place
    """

    frames: Bools
    inside: Bools
    whole: Bools


def naming(problem: Problem) -> Naming:
    """Returns the groups that the constraints of a problem name. If only the mentions of their rows are
    known, every group whose frame occurs in a row is named, and so is everything that groups draw.
    """
    groups = len(problem.parent)
    if not problem.named:
        moved = problem.frame_of[_in_any_row(problem)]
        frames = marked(moved[moved >= 0], groups)
        return Naming(frames, np.ones(groups, dtype=np.bool_), frames)
    frames = np.zeros(groups, dtype=np.bool_)
    parent, holder = problem.parent.tolist(), problem.holder.tolist()
    pairs = {(holder[c], g) for named in (problem.whole, problem.inside) for c, g in named.T.tolist()}
    for held_by, group in pairs:
        while group > held_by:  # parents have lower numbers than their children
            frames[group] = True
            group = parent[group]
    inside, whole = marked(problem.inside[1], groups), marked(problem.whole[1], groups)
    own = problem.whole[1] == problem.holder[problem.whole[0]]
    inside |= marked(problem.whole[1][own], groups)  # its own box is what it draws
    inside[0] = True
    return Naming(frames, inside, whole)


def riding_depths(problem: Problem, depths: Ints) -> Ints:
    """Returns for each unknown (n,) the depth of the innermost group around it, or of the group whose frame
    it places, that is rigid or that no constraint around that group names; 0 if there is none. Above that
    depth it rides along with that group, or its parent.
    """
    found = np.zeros(len(problem.parent), dtype=np.intp)
    if problem.named:
        frames = naming(problem).frames
        for group, parent in enumerate(problem.parent.tolist()):
            if parent >= 0:
                found[group] = found[parent] if frames[group] else depths[group]
    placed: Ints = found[np.where(problem.frame_of >= 0, problem.frame_of, problem.group)]
    in_rigid = np.where(problem.axis >= 0, np.where(problem.rigid, depths, 0)[problem.group], 0)
    return np.maximum(placed, in_rigid)


def _in_any_row(problem: Problem) -> Bools:
    found = expression.mentioned(problem.tape, problem.rows.expression.tolist())
    return marked(np.array(found, dtype=np.intp), len(problem.initial))


# --- Solving again after a small change: values that the change cannot have reached are taken from the last
# solve.
#
# The values below a group, once its turn is over, follow from the constraints and unknowns of its subtree
# and from nothing else. Every subtree is therefore given a key made of all that enters into it; where the
# key is that of the last solve, so are the values, and they are taken over. Everything else is solved as if
# for the first time. The answer is the one that a first solve gives, because no step of it is left to the
# start.


@record(frozen=False)
class Memory:
    """The data that one solve leaves for the next; a new memory is empty.

    keys      of each group's subtree (g,)
    reached   by depth, all values (n,) when the groups of that depth had had their turn
    stages    by group
    """

    keys: tuple[int, ...] = ()
    unknowns: int = 0
    reached: dict[int, Floats] = field(default_factory=dict)
    stages: dict[int, list[StageReport]] = field(default_factory=dict)


class Recollection:
    """A solve with a memory: reads the values of the last solve, and at the end stores those of this one."""

    def __init__(self, memory: Memory, problem: Problem, settings: Settings) -> None:
        self.memory, self._problem = memory, problem
        self._keys = subtree_keys(problem, settings)
        self.reached: dict[int, Floats] = {}
        """The values reached once the groups at each depth are solved."""
        alike = len(memory.keys) == len(self._keys) and memory.unknowns == len(problem.initial)
        pairs = zip(memory.keys, self._keys, strict=True) if alike else ()
        self.familiar = np.array([a == b for a, b in pairs] if alike else [False] * len(self._keys))
        """The mask (g,) of groups whose subtree is as it was."""
        self._depths = depths(problem.parent)

    def recall(self, depth: int, x: Floats) -> Bools:
        """Puts remembered values below groups at `depth` into `x` (n,); returns the groups (g,) known."""
        known: Bools = self.familiar & (self._depths == depth)
        if known.any():
            above = ancestors(self._problem.parent, self._depths, depth)[self._problem.group]
            below = (above >= 0) & known[above]
            x[below] = self.memory.reached[depth][below]
        return known

    def close(self, stages: list[StageReport], in_full: bool) -> None:
        """Stores this solve, or nothing if it did not succeed in full: failed groups are tried again."""
        by_group: dict[int, list[StageReport]] = {}
        for stage in stages:
            by_group.setdefault(stage.group, []).append(stage)
        kept = self.memory
        kept.keys, kept.unknowns = (self._keys, len(self._problem.initial)) if in_full else ((), 0)
        kept.reached, kept.stages = (self.reached, by_group) if in_full else ({}, {})


def subtree_keys(problem: Problem, settings: Settings) -> tuple[int, ...]:
    """Returns a hash for each group (g,) of all that the solution of its subtree depends on."""
    nodes = _node_keys(problem)
    rows = problem.rows
    own: list[list[object]] = [[] for _ in problem.parent]
    # Groups that ride along depend on constraints further up, too.
    riding = riding_depths(problem, depths(problem.parent))
    dearness = (problem.standing, problem.spanned, problem.sealed, riding)
    columns = (problem.longest, problem.initial, problem.scale, problem.kept, problem.frame_of, *dearness)
    for index, (group, *entry) in enumerate(zip(problem.group.tolist(), *map(_keyed, columns), strict=True)):
        own[group].append((index, *entry))
    holder = problem.holder.tolist()
    stated = (rows.constraint, rows.expression, rows.at_most, rows.scale)
    for owner, node, at_most, scale in zip(*map(_keyed, stated), strict=True):
        own[holder[owner]].append((owner, nodes[node], at_most, scale))
    for owner, weight in enumerate(_keyed(np.nan_to_num(problem.weight, nan=-1.0))):
        own[holder[owner]].append((owner, weight))
    for owner, unknown in problem.placed.T.tolist():
        own[holder[owner]].append((owner, unknown))
    parents = problem.parent.tolist()
    keys = [0] * len(parents)
    for group in reversed(range(len(parents))):
        keys[group] = hash((settings, *own[group]))
        if parents[group] >= 0:
            own[parents[group]].append((group, keys[group]))
    return tuple(keys)


def _node_keys(problem: Problem) -> list[int]:
    tape = problem.tape
    keys: list[int] = []
    for op, operands, constant in zip(tape.op_list, tape.operand_lists, _keyed(tape.constants), strict=True):
        if op <= Op.UNKNOWN:
            keys.append(hash((op, constant, operands)))
        else:
            keys.append(hash((op, *[keys[operand] for operand in operands])))
    return keys


def _keyed(column: NDArray[np.generic]) -> list[int]:
    """Returns the numbers of a column by their bits: -1.0 and -2.0 have the same hash."""
    found: list[int] = (column.view(np.int64) if column.dtype == np.float64 else column).tolist()
    return found


def ancestors(parent: Ints, depth: Ints, at: int) -> Ints:
    """Returns for each group (g,) the group above it at depth `at`, or itself; -1 for groups further up."""
    found = np.arange(len(parent))
    while (low := depth[found] > at).any():
        found[low] = parent[found[low]]
    found[depth < at] = -1
    return found

"""Solving again after a small change: values that the change cannot have reached are taken from the last
solve.

The values below a group, once its turn is over, follow from the constraints and unknowns of its subtree and
from nothing else. Every subtree is therefore given a key made of all that enters into it; where the key is
that of the last solve, so are the values, and they are taken over. Everything else is solved as if for the
first time. The answer is the one that a first solve gives, because no step of it is left to the start.
"""

from __future__ import annotations

from dataclasses import field

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver.operations import Bools, Floats, Ints, Op
from aidl_lang.solver.problem import Problem, Settings, depths
from aidl_lang.solver.riding import riding_depths
from aidl_lang.solver.solution import StageReport


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
        self._memory, self._problem = memory, problem
        self._keys = subtree_keys(problem, settings)
        self._reached: dict[int, Floats] = {}
        alike = len(memory.keys) == len(self._keys) and memory.unknowns == len(problem.initial)
        pairs = zip(memory.keys, self._keys, strict=True) if alike else ()
        self.familiar = np.array([a == b for a, b in pairs] if alike else [False] * len(self._keys))
        """The mask (g,) of groups whose subtree is as it was."""
        self._depths = depths(problem.parent)

    def recall(self, depth: int, x: Floats) -> Bools:
        """Puts the remembered values below the groups at `depth` into `x` (n,); returns the mask (g,) of
        groups that need not be solved.
        """
        known: Bools = self.familiar & (self._depths == depth)
        if known.any():
            above = ancestors(self._problem.parent, self._depths, depth)[self._problem.group]
            below = (above >= 0) & known[above]
            x[below] = self._memory.reached[depth][below]
        return known

    def stages(self, group: int) -> list[StageReport]:
        """Returns the stages tried for a familiar group."""
        return self._memory.stages.get(group, [])

    def note(self, depth: int, x: Floats) -> None:
        """Keeps the values reached once the groups at `depth` are solved."""
        self._reached[depth] = x.copy()

    def close(self, stages: list[StageReport], in_full: bool) -> None:
        """Stores this solve, or nothing if it did not succeed in full: failed groups are tried again."""
        by_group: dict[int, list[StageReport]] = {}
        for stage in stages:
            by_group.setdefault(stage.group, []).append(stage)
        kept = self._memory
        kept.keys, kept.unknowns = (self._keys, len(self._problem.initial)) if in_full else ((), 0)
        kept.reached, kept.stages = (self._reached, by_group) if in_full else ({}, {})


def subtree_keys(problem: Problem, settings: Settings) -> tuple[int, ...]:
    """Returns a hash for each group (g,) of all that the solution of its subtree depends on."""
    nodes = _node_keys(problem)
    rows, longest = problem.rows, problem.longest
    own: list[list[object]] = [[] for _ in problem.parent]
    bounds = np.zeros(len(problem.initial)) if longest is None else longest
    # Groups that ride along depend on constraints further up, too.
    riding = riding_depths(problem, depths(problem.parent))
    dearness = (problem.standing, problem.spanned, riding)
    columns = (bounds, problem.initial, problem.scale, problem.kept, problem.frame_of, *dearness)
    for index, (group, *entry) in enumerate(zip(problem.group.tolist(), *map(_keyed, columns), strict=True)):
        own[group].append((index, *entry))
    holder = problem.holder.tolist()
    stated = (rows.constraint, rows.expression, rows.at_most, rows.scale)
    for owner, expression, at_most, scale in zip(*map(_keyed, stated), strict=True):
        own[holder[owner]].append((owner, nodes[expression], at_most, scale))
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
    """Returns a hash for each node of the tape of everything below it."""
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

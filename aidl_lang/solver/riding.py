"""What need not be solved: groups that ride along, and values that a small change cannot have reached."""

from __future__ import annotations

from dataclasses import field

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.arrays import each_once
from aidl_lang.common.records import record
from aidl_lang.solver import expression
from aidl_lang.solver.expression import Bools, Floats, Ints, Op
from aidl_lang.solver.linear import Sparse
from aidl_lang.solver.problem import Problem, Settings, StageReport, depths

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
        if problem.axis is not None:
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
    may_move = named.frames[moved] if problem.named else mentioned(problem)
    movable = ~problem.kept & ((moved < 0) | may_move)
    movable &= (moved >= 0) | named.inside[problem.group]
    movable |= _stirred(problem, named, movable)
    movable &= problem.sealed == 0
    carried = ~named.frames & problem.named
    carried[0] = False
    return Riding(carried, _anchors(problem, carried), movable)


def _stirred(problem: Problem, named: Naming, movable: Bools) -> Bools:
    """Returns the mask of unknowns drawn by groups only named as a whole that leave their frame."""
    axis = np.full(len(movable), -1) if problem.axis is None else problem.axis
    moved = np.where(movable, problem.frame_of, -1)
    shifts = np.zeros((3, len(named.whole)), dtype=np.bool_)  # along x, along y, anyhow
    for direction in (0, 1):
        shifts[direction, moved[(moved >= 0) & (axis == direction)]] = True
    shifts[-1, moved[moved >= 0]] = True
    is_content = (problem.frame_of < 0) & ~problem.kept & named.whole[problem.group]
    found: Bools = is_content & ~shifts[axis, problem.group]
    return found


def _anchors(problem: Problem, carried: Bools) -> Ints:
    clinging = problem.clinging or frozenset()
    anchor = np.zeros(len(carried), dtype=np.intp)
    for group, parent in enumerate(problem.parent.tolist()):
        if group:
            anchor[group] = group if carried[group] and group in clinging else anchor[parent]
    return anchor


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
        moved = problem.frame_of[mentioned(problem)]
        frames = _marked(moved[moved >= 0], groups)
        return Naming(frames, np.ones(groups, dtype=np.bool_), frames)
    frames = np.zeros(groups, dtype=np.bool_)
    parent, holder = problem.parent.tolist(), problem.holder.tolist()
    pairs = {(holder[c], g) for named in (problem.whole, problem.inside) for c, g in named.T.tolist()}
    for held_by, group in pairs:
        while group > held_by:  # parents have lower numbers than their children
            frames[group] = True
            group = parent[group]
    inside, whole = _marked(problem.inside[1], groups), _marked(problem.whole[1], groups)
    own = problem.whole[1] == problem.holder[problem.whole[0]]
    inside |= _marked(problem.whole[1][own], groups)  # its own box is what it draws
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
    if problem.axis is None or not problem.rigid.any():
        return placed
    in_rigid = np.where(problem.axis >= 0, np.where(problem.rigid, depths, 0)[problem.group], 0)
    return np.maximum(placed, in_rigid)


def _marked(numbers: Ints, count: int) -> Bools:
    found = np.zeros(count, dtype=np.bool_)
    found[numbers] = True
    return found


def mentioned(problem: Problem) -> Bools:
    """Returns the unknowns (n,) that occur in any row."""
    found = expression.mentioned(problem.tape, problem.rows.expression.tolist())
    return _marked(np.array(found, dtype=np.intp), len(problem.initial))


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
        self._memory, self._problem = memory, problem
        self._keys = subtree_keys(problem, settings)
        self._reached: dict[int, Floats] = {}
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
    dearness = (problem.standing, problem.spanned, problem.sealed, riding)
    columns = (bounds, problem.initial, problem.scale, problem.kept, problem.frame_of, *dearness)
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

"""The groups that constraints name; a group that no constraint names rides along with the group around it.

To name the box of a group is to name the group, and not what lies in it; to name something in a group is to
name all groups around it, up to the one that holds the constraint.
"""

from __future__ import annotations

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver import expression
from aidl_lang.solver.operations import Bools, Ints
from aidl_lang.solver.problem import Problem


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
    found = np.zeros(len(problem.parent), dtype=np.int64)
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
    return _marked(np.array(found, dtype=np.int64), len(problem.initial))

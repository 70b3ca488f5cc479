"""Degrees of freedom, motions and redundant constraints of a solved problem.

A motion is a direction in the null space of the Jacobian of the equations that hold, over all unknowns that
are not kept sizes. Only what can be seen counts: degrees of freedom are the rank of the observables'
Jacobian on that space, so that a frame and its contents moving against each other do not count. An
inequality takes no freedom away. What no constraint names rides along, and adds none (see `riding`).
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum

import numpy as np

from aidl_lang.common.arrays import each_once, others
from aidl_lang.common.records import record
from aidl_lang.solver.dependence import Equations, Redundancy, dependent_rows, redundancies
from aidl_lang.solver.gradients import Sparse, linearise
from aidl_lang.solver.mobility import SEEN, Mobility, Motions, Watch, mobility
from aidl_lang.solver.operations import Bools, Floats, Ints
from aidl_lang.solver.problem import Problem
from aidl_lang.solver.riding import Riding, groups_riding
from aidl_lang.solver.solution import Solution

SINGULAR = 1e-7
"""Slope of a row, in units of its scale, below which it counts as none and says nothing of the constraint."""


class State(StrEnum):
    """State of the constraints of a group and all groups below it."""

    FULLY = "fully"
    UNDER = "under"
    """Something in it can still move."""
    OVER = "over"
    """One of its constraints follows from others."""
    CONTRADICTORY = "contradictory"
    """One of its constraints does not hold."""
    UNKNOWN = "unknown"
    """Its degrees of freedom could not be counted."""


@record()
class Freedom:
    """
    degrees       degrees of freedom left in the whole model (kept sizes held); None if not countable
    group_degrees the same for what each group itself draws
    states        of each group
    free          unknowns that can still move (kept ones never do)
    motions       the possible motions, each part by itself
    redundant     equality constraints already implied by others
    undecided     unknowns of each part of which the degrees of freedom could not be counted
    unclear       constraints whose dependence on others is undecided
    loose         groups that ride along, though they belong to nothing that is drawn around them
    """

    degrees: int | None
    group_degrees: tuple[int | None, ...]
    states: tuple[State, ...]
    free: tuple[int, ...]
    motions: Motions
    redundant: tuple[Redundancy, ...]
    undecided: tuple[tuple[int, ...], ...]
    unclear: tuple[int, ...]
    loose: tuple[int, ...] = ()


def analyse(problem: Problem, solution: Solution, order: Sequence[int] | None = None) -> Freedom:
    """Returns the degrees of freedom that the hard constraints leave which hold, to the first order at the
    solution.

    order  of the constraints: of several that depend on each other the latest counts as redundant
    """
    hard = np.isnan(problem.weight)
    satisfied = np.array(solution.satisfied, dtype=np.bool_)
    equal = _equal_rows(problem, hard & satisfied, order)
    observed = np.array([node for _, node in problem.observables], dtype=np.intp)
    nodes, node_of = np.unique(observed, return_inverse=True)
    riding = groups_riding(problem)
    with np.errstate(all="ignore"):
        _, slopes = linearise(problem.tape, solution.values, problem.rows.expression[equal])
        places, seen = linearise(problem.tape, solution.values, nodes, riding.movable)
        equations, plain = _equations(problem, equal, slopes)
        relations, unclear = dependent_rows(equations.matrix, len(problem.initial))
        new = others(len(equations.row), relations)
        rows, clear = equations.matrix.take(new), ~np.isin(new, unclear)
        found = _mobility(problem, riding, rows, clear, seen.take(node_of), places[node_of])
        redundant = redundancies(problem, solution.values, equations, relations, plain) if relations else []
    return Freedom(
        degrees=found.total,
        group_degrees=tuple(None if count < 0 else count for count in found.degrees.tolist()),
        states=_states(problem, hard & ~satisfied, redundant, found.degrees),
        free=tuple(np.flatnonzero(found.moving).tolist()),
        motions=found.motions,
        redundant=tuple(redundant),
        undecided=tuple(tuple(np.sort(unknowns).tolist()) for unknowns in found.undecided),
        unclear=tuple(each_once(equations.owner[unclear]).tolist()),
        loose=tuple(np.flatnonzero(riding.loose).tolist()),
    )


def _equal_rows(problem: Problem, holding: Bools, order: Sequence[int] | None) -> Ints:
    """Returns the equations of the constraints that are `holding`, in the order that is preferred."""
    rows = problem.rows
    equal = np.flatnonzero(holding[rows.constraint] & ~rows.at_most)
    if order is None:
        return equal
    rank = np.empty(len(problem.holder), dtype=np.intp)
    rank[np.array(order, dtype=np.intp)] = np.arange(len(order))
    return equal[np.argsort(rank[rows.constraint[equal]], kind="stable")]


def _equations(problem: Problem, equal: Ints, slopes: Sparse) -> tuple[Equations, list[int]]:
    """Returns the equations that have a slope, and the constraints all of whose rows are among them."""
    rows = problem.rows
    matrix = slopes.scaled(1.0 / rows.scale[equal], problem.scale)
    lengths = matrix.lengths()
    sloping = lengths > SINGULAR
    matrix = matrix.scaled(1.0 / np.where(sloping, lengths, 1.0), np.ones(len(problem.scale)))
    silent = np.ones(len(rows.constraint), dtype=np.bool_)
    silent[equal[sloping]] = False
    other = set(rows.constraint[silent].tolist())
    owners = dict.fromkeys(rows.constraint[equal[sloping]].tolist())
    plain = [owner for owner in owners if owner not in other]
    sloped = np.flatnonzero(sloping)
    return Equations(equal[sloped], rows.constraint[equal[sloped]], matrix.take(sloped)), plain


def _mobility(
    problem: Problem, riding: Riding, rows: Sparse, clear: Bools, seen: Sparse, places: Floats
) -> Mobility:
    """Counts the motions that the equations `rows` leave; rows that are `clear` are known to be independent.

    seen  the gradients of what is observed, `places` its values
    """
    movable = riding.movable
    groups = np.array([group for group, _ in problem.observables], dtype=np.int64)
    matrix = seen.scaled(np.ones(len(seen)), problem.scale)
    anchor = riding.anchor[groups][matrix.rows] if len(groups) else groups
    is_seen = (anchor == 0) | (anchor == riding.anchor[problem.group[matrix.columns]])
    matrix = matrix.only(movable[matrix.columns] & (np.abs(matrix.entries) > SEEN) & is_seen)
    distinct, row = _distinct(matrix)
    group, row_seen = np.divmod(each_once(groups[row >= 0] * (len(row) + 1) + row[row >= 0]), len(row) + 1)
    jacobian = rows.only(movable[rows.columns])
    known = clear & (np.diff(jacobian.starts) == np.diff(rows.starts))
    pins = riding.pins(problem, jacobian)
    observables, watch = matrix.take(distinct), Watch(group.astype(np.intp), row_seen.astype(np.intp))
    motions = Motions(problem.scale, places, row, riding.anchor[groups] if len(groups) else groups)
    known = np.concatenate((known, np.ones(len(pins), dtype=np.bool_)))
    return mobility(jacobian.above(pins), known, observables, watch, len(problem.parent), motions)


def _distinct(matrix: Sparse) -> tuple[Ints, Ints]:
    """Returns the first of each set of equal rows, and for each row the place of its set in this list; -1 for
    an empty row.
    """
    known: dict[tuple[object, ...], int] = {}
    firsts: list[int] = []
    places: list[int] = []
    starts, columns, entries = matrix.starts.tolist(), matrix.columns.tolist(), matrix.entries.tolist()
    for row in range(len(matrix)):
        here = slice(starts[row], starts[row + 1])
        key = (*columns[here], *entries[here])
        place = known.setdefault(key, len(firsts)) if key else -1
        if place == len(firsts):
            firsts.append(row)
        places.append(place)
    return np.array(firsts, dtype=np.intp), np.array(places, dtype=np.intp)


def _states(
    problem: Problem, broken: Bools, redundant: Sequence[Redundancy], degrees: Ints
) -> tuple[State, ...]:
    contradictory = set(problem.holder[broken].tolist())
    moving, unclear = (degrees > 0).tolist(), (degrees < 0).tolist()
    for group, parent in reversed(list(enumerate(problem.parent.tolist()))):
        if parent >= 0:
            moving[parent] |= moving[group]
            unclear[parent] |= unclear[group]
    over = {int(problem.holder[found.constraint]) for found in redundant}
    states: list[State] = []
    for group in range(len(degrees)):
        if group in contradictory:
            states.append(State.CONTRADICTORY)
        elif group in over:
            states.append(State.OVER)
        elif moving[group]:
            states.append(State.UNDER)
        else:
            states.append(State.UNKNOWN if unclear[group] else State.FULLY)
    return tuple(states)

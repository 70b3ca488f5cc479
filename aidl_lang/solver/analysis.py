"""Degrees of freedom, motions and redundant constraints of a solved problem."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import field
from enum import StrEnum
from functools import cached_property

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver.dependence import Equations, Redundancy, dependent_rows, redundancies
from aidl_lang.solver.expression import Bools, Floats, Ints
from aidl_lang.solver.hierarchy import Riding, groups_riding
from aidl_lang.solver.linear import DOUBT, RANK, Sparse, each_once, marked, others, places
from aidl_lang.solver.problem import P, Problem, Solution
from aidl_lang.solver.valuation import LARGE, Sorted, connected, linearise

# --- The motions that leave every equation as it is, as far as a reader can see them.
#
# For the Jacobians J of the equations and O of the observables, the visible motions of a part that hangs
# together are the row space of O (1 - J⁺ J). Small parts of about one size are settled together as stacks of
# matrices; large ones by sparse elimination, their motions by samples: random combinations of the rows of O,
# taken to the null space of J, lie in the same space, and span it when there are enough of them.

SEEN = 1e-7
"""Motions of observables below this count as none; one is the size of a typical motion."""
NOTHING = 1e-7
"""Components of unit vectors below this count as zero."""
SAMPLES = 48
SPARE = 8
"""Samples beyond the rank that make it clear."""


@record()
class Part:
    """Unknowns that hang together and can move, in `d` independent ways.

    unknowns    (k,) those that take part in a motion
    basis       (k, d) each column a motion, in the units of the unknowns
    observables (o,) those of the problem that see one, ascending
    velocities  (o, d) what they see of it
    """

    unknowns: Ints
    basis: Floats
    observables: Ints
    velocities: Floats


@record()
class Motions:
    """The parts that can move, without large ones that have too many motions to list; made when asked for.

    scale  (n,) of the unknowns
    values (o,) of the observables
    row    (o,) of each observable among those that differ; -1 for those that do not move
    anchor (o,) the group from whose frame each is seen, 0 for the root
    """

    scale: Floats
    values: Floats
    row: Ints
    anchor: Ints
    found: list[tuple[Ints, Floats, Ints, Floats]] = field(default_factory=list, repr=False)

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        same = Sorted(self.row, int(self.row.max(initial=-1)) + 1)
        return tuple(self._part(same, *each) for each in sorted(self.found, key=lambda each: int(each[0][0])))

    def _part(self, same: Sorted, columns: Ints, basis: Floats, rows: Ints, seen: Floats) -> Part:
        moving = np.abs(basis).max(axis=1) > NOTHING
        watching = np.flatnonzero(np.abs(seen).max(axis=1) > SEEN)
        alike = [same.members(row) for row in rows[watching].tolist()]
        velocities = np.repeat(seen[watching], [len(each) for each in alike], axis=0)
        observables = np.concatenate(alike)
        order = np.argsort(observables)
        columns = columns[moving]
        rates = basis[moving] * self.scale[columns, None]
        return Part(columns, rates, observables[order], velocities[order])


@record(frozen=False)
class Mobility:
    """
    degrees    (g,) degrees of freedom of what each group draws; -1 if they could not be counted
    total      degrees of freedom of the whole; None if those of a part could not be counted
    moving     (n,) True for an unknown that takes part in a visible motion
    motions    the motions of the parts that can move
    undecided  the unknowns of each part whose rank is undecided
    """

    degrees: Ints
    moving: Bools
    motions: Motions
    total: int | None = 0
    undecided: list[Ints] = field(default_factory=list)

    def count(self, groups: Ints, degrees: Ints, total: int) -> None:
        counted = self.degrees[groups] >= 0
        np.add.at(self.degrees, groups[counted], degrees[counted])
        if self.total is not None:
            self.total += total

    def add(self, columns: Ints, basis: Floats, rows: Ints, velocities: Floats) -> None:
        self.moving[columns[np.abs(basis).max(axis=1) > NOTHING]] = True
        self.motions.found.append((columns, basis, rows, velocities))

    def give_up(self, unknowns: Ints, groups: Ints) -> None:
        self.undecided.append(unknowns)
        self.degrees[groups] = -1
        self.total = None


class _Parts:
    """The unknowns that observables and equations link, numbered by part, with their rows.

    equations   rows over the unknowns that may move, parts of unit rows
    known       those which are independent of one another for sure
    observables rows over the same, in units of a typical motion, none of them zero
    watching, watched: pairs of a group (p,) and an observable (p,) that it sees, each once
    """

    def __init__(
        self,
        equations: Sparse,
        known: Bools,
        observables: Sparse,
        watching: Ints,
        watched: Ints,
        unknowns: int,
    ) -> None:
        self.equations, self.known, self.observables = equations, known, observables
        self.watching, self.watched = watching, watched
        links = [np.concatenate(ends) for ends in zip(equations.links, observables.links, strict=True)]
        label = connected(links[0], links[1], unknowns)
        seen = each_once(label[observables.columns])
        self.part = places(seen, unknowns)[label]
        """The part of each unknown; -1 for unknowns that no observable sees."""
        self.columns = Sorted(self.part, len(seen))
        self.equation_part = _part_of_rows(equations, self.part)
        self.rows = Sorted(self.equation_part, len(seen))
        self.observable_part = _part_of_rows(observables, self.part)
        self.seen = Sorted(self.observable_part, len(seen))
        self.pairs = Sorted(self.observable_part[watched], len(seen))

    def local(self, matrix: Sparse) -> Sparse:
        """Returns the matrix with its columns numbered within their part."""
        return Sparse(matrix.starts, self.columns.place[matrix.columns], matrix.entries)

    def groups(self, part: int) -> Ints:
        return each_once(self.watching[self.pairs.members(part)])


def _part_of_rows(matrix: Sparse, part: Ints) -> Ints:
    found = np.full(len(matrix), -1)
    filled = np.diff(matrix.starts) > 0
    found[filled] = part[matrix.columns[matrix.starts[:-1][filled]]]
    return found


def _settle_small(parts: _Parts, members: Ints, found: Mobility) -> None:
    slot = places(members, len(parts.columns.count))
    jacobian = _stacked(parts.equations, parts.equation_part, parts.rows, parts.columns, slot)
    observed = _stacked(parts.observables, parts.observable_part, parts.seen, parts.columns, slot)
    if jacobian.shape[1]:
        _, sigma, vt = np.linalg.svd(jacobian, full_matrices=False)
        decided = ~((sigma > DOUBT) & (sigma < RANK)).any(axis=1)
        vt = vt * (sigma >= RANK)[:, :, None]
        visible = observed - (observed @ vt.transpose(0, 2, 1)) @ vt
    else:
        decided, visible = np.ones(len(members), dtype=bool), observed
    _, sigma, vt = np.linalg.svd(visible, full_matrices=False)
    total = np.count_nonzero(sigma > SEEN, axis=1)
    total[~decided] = 0
    most = int(total.max())
    basis = vt[:, :most].transpose(0, 2, 1) * (np.arange(most) < total[:, None])[:, None, :]
    velocities = visible @ basis
    groups, degrees = _by_group(parts, slot, velocities, total)
    found.count(groups, degrees, int(total.sum()))
    for i in np.flatnonzero(~decided).tolist():
        found.give_up(parts.columns.members(members[i]), parts.groups(members[i]))
    for i in np.flatnonzero(total).tolist():
        columns, rows = parts.columns.members(members[i]), parts.seen.members(members[i])
        found.add(columns, basis[i, : len(columns), : total[i]], rows, velocities[i, : len(rows), : total[i]])


def _by_group(parts: _Parts, slot: Ints, velocities: Floats, total: Ints) -> tuple[Ints, Ints]:
    """Returns the groups that see some of a part in `slot`, and the rank of the motions that each sees."""
    part = parts.observable_part[parts.watched]
    pairs = np.flatnonzero(slot[part] >= 0)
    owner, group, row = slot[part[pairs]], parts.watching[pairs], parts.watched[pairs]
    count = int(parts.watching.max()) + 1
    keys, key = np.unique(owner.astype(np.int64) * count + group, return_inverse=True)
    if len(keys) == len(total):
        return (keys % count).astype(np.intp), total[keys // count]
    seen = velocities[owner, parts.seen.place[row]]
    return (keys % count).astype(np.intp), _ranks(seen, key, len(keys), SEEN)


def _settle_large(parts: _Parts, part: int, found: Mobility) -> None:
    from aidl_lang.solver.sparse import UndecidedError

    columns, groups = parts.columns.members(part), parts.groups(part)
    try:
        basis, moving, degrees, total = _large(parts, part, groups)
    except UndecidedError:
        found.give_up(columns, groups)
        return
    found.moving[columns[moving]] = True
    found.count(groups, degrees, total)
    if basis is not None:
        rows = parts.seen.members(part)
        found.add(columns, basis, rows, _times(parts.local(parts.observables.take(rows)), basis))


def _large(parts: _Parts, part: int, groups: Ints) -> tuple[Floats | None, Bools, Ints, int]:
    """Returns the motions of a large part (None if they are too many), the mask of its columns that move, and
    its degrees of freedom by group and in all.
    """
    from aidl_lang.solver.sparse import NullSpace, UndecidedError, independent_rows

    width = int(parts.columns.count[part])
    rows = parts.rows.members(part)
    known = bool(parts.known[rows].all())
    null_space = NullSpace(parts.local(parts.equations.take(rows)), width, known=known)
    observed = parts.local(parts.observables.take(parts.seen.members(part)))

    def degrees_of(rows: Sparse) -> int:
        return len(independent_rows(null_space.rows.above(_unit(rows)), width)) - len(null_space.rows)

    total = degrees_of(observed)
    if not total:
        return None, np.zeros(width, dtype=np.bool_), np.zeros(len(groups), dtype=np.intp), 0
    samples = null_space.sample(_unit(observed), SAMPLES)
    samples /= np.abs(samples).max()
    moving = np.abs(samples).max(axis=1) > RANK
    pairs = parts.pairs.members(part)
    group = np.searchsorted(groups, parts.watching[pairs])
    seen = parts.seen.place[parts.watched[pairs]]
    if total <= SAMPLES - SPARE:
        basis, sigma, _ = np.linalg.svd(samples, full_matrices=False)
        if np.count_nonzero(sigma > RANK) != total:
            raise UndecidedError
        velocities = _times(observed, basis[:, :total])
        return basis[:, :total], moving, _ranks(velocities[seen], group, len(groups), SEEN), total
    few = np.bincount(group) <= SAMPLES - SPARE
    shown = few[group]
    velocities = _times(observed.take(seen[shown]), samples)
    degrees = _ranks(velocities, group[shown], len(groups), RANK)
    for i in np.flatnonzero(~few).tolist():
        degrees[i] = degrees_of(observed.take(seen[group == i]))
    return None, moving, degrees, total


def _unit(matrix: Sparse) -> Sparse:
    lengths = matrix.lengths()
    return Sparse(matrix.starts, matrix.columns, matrix.entries / lengths[matrix.rows])


def _times(matrix: Sparse, dense: Floats) -> Floats:
    product = np.zeros((len(matrix), dense.shape[1]))
    np.add.at(product, matrix.rows, matrix.entries[:, None] * dense[matrix.columns])
    return product


def _ranks(rows: Floats, key: Ints, keys: int, least: float) -> Ints:
    order = Sorted(key, keys)
    found = np.zeros(keys, dtype=np.intp)
    for members in _lots(order.count):
        slot = places(members, keys)
        own = np.flatnonzero(slot[key] >= 0)
        stack = np.zeros((len(members), int(order.count[members].max()), rows.shape[1]))
        stack[slot[key[own]], order.place[own]] = rows[own]
        if stack.size:
            found[members] = np.count_nonzero(np.linalg.svd(stack, compute_uv=False) > least, axis=1)
    return found


def _lots(*sizes: Ints) -> list[Ints]:
    """Groups parts by their sizes, each rounded up to a power of two."""
    exponents = np.ceil(np.log2(np.maximum(np.stack(sizes), 0.5))).astype(np.intp)
    found: dict[tuple[int, ...], list[int]] = defaultdict(list)
    for part, size in enumerate(zip(*exponents.tolist(), strict=True)):
        found[size].append(part)
    return [np.array(parts) for parts in found.values()]


def _stacked(matrix: Sparse, of_row: Ints, rows: Sorted, columns: Sorted, slot: Ints) -> Floats:
    """Returns the rows of each part that has a slot as one matrix of a stack, filled up with zeros."""
    slot_of_row = np.append(slot, -1)[of_row]
    at = np.flatnonzero(slot_of_row >= 0)
    picked = matrix.take(at)
    row = at[picked.rows]
    height, width = (int(sizes.count[slot >= 0].max(initial=0)) for sizes in (rows, columns))
    stack = np.zeros((int(slot.max()) + 1, height, width))
    stack[slot_of_row[row], rows.place[row], columns.place[picked.columns]] = picked.entries
    return stack


# --- Degrees of freedom, motions and redundant constraints of a solved problem.
#
# A motion is a direction in the null space of the Jacobian of the equations that hold, over all unknowns
# that are not kept sizes. Only what can be seen counts: degrees of freedom are the rank of the observables'
# Jacobian on that space, so that a frame and its contents moving against each other do not count. An
# inequality takes no freedom away. What no constraint names rides along, and adds none (see `hierarchy`).

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


def analyse(solution: Solution[P], order: Sequence[int] | None = None) -> Freedom:
    """Returns the degrees of freedom that the hard constraints leave which hold, to the first order at the
    solution.

    order  of the constraints: of several that depend on each other the latest counts as redundant
    """
    problem = solution.problem
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
    rank = places(np.array(order, dtype=np.intp), len(problem.holder))
    return equal[np.argsort(rank[rows.constraint[equal]], kind="stable")]


def _equations(problem: Problem, equal: Ints, slopes: Sparse) -> tuple[Equations, list[int]]:
    """Returns the equations that have a slope, and the constraints all of whose rows are among them."""
    rows = problem.rows
    matrix = slopes.scaled(1.0 / rows.scale[equal], problem.scale)
    lengths = matrix.lengths()
    sloping = lengths > SINGULAR
    matrix = matrix.scaled(1.0 / np.where(sloping, lengths, 1.0), np.ones(len(problem.scale)))
    other = set(rows.constraint[~marked(equal[sloping], len(rows.constraint))].tolist())
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
    motions = Motions(problem.scale, places, row, riding.anchor[groups] if len(groups) else groups)
    unknowns, degrees = len(problem.initial), np.zeros(len(problem.parent), dtype=np.intp)
    found = Mobility(degrees, np.zeros(unknowns, dtype=np.bool_), motions)
    if not len(distinct):
        return found
    known = np.concatenate((known, np.ones(len(pins), dtype=np.bool_)))
    observables, watching, watched = matrix.take(distinct), group.astype(np.intp), row_seen.astype(np.intp)
    parts = _Parts(jacobian.above(pins), known, observables, watching, watched, unknowns)
    for members in _lots(parts.rows.count, parts.columns.count, parts.seen.count):
        if parts.columns.count[members[0]] > LARGE:
            for part in members.tolist():
                _settle_large(parts, part, found)
        else:
            _settle_small(parts, members, found)
    return found


def _distinct(matrix: Sparse) -> tuple[Ints, Ints]:
    """Returns the first of each set of equal rows, and for each row the place of its set; -1 for none."""
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

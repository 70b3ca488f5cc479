"""Who gives way when the rows of a stage contradict each other, and who of those that moved need not have.

At the point where a search ends, what is left of its linearised rows is out of reach: no move of what is free
brings them nearer to zero. Whoever can help has a share in that rest. Of these the cheapest class that
suffices is taken, of that as few parts as can be found, and of each part as few things; among equals, those
that make the way shortest. A set is found by taking what leaves least of the rest, and so on (orthogonal
matching pursuit; Pati, Rezaiifar and Krishnaprasad, Asilomar 1993), and leaving out what proves idle.

The nearest point at which rows hold spreads a change over everything that is free. Where that leaves a
choice, `thin` looks through the columns from what is cheapest to move to what is dearest and keeps those that
reach further than the ones before them (a basis, as in the simplex method). What the rows need is then a
combination of these; things without a share in it are held.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver import Stages
from aidl_lang.solver.expression import Floats, Ints
from aidl_lang.solver.freezing import Freezer
from aidl_lang.solver.problem import Problem, Relation
from aidl_lang.solver.valuation import FLAT, gradients

if TYPE_CHECKING:
    from aidl_lang.solver.hierarchy import Hierarchy

# --- The stages at which the unknowns of a group become free.
#
# At a group every unknown of its subtree has a tier, which says at which stage it becomes free; the table of
# them is in docs/solver.md. What is in a group that is sealed is never freed: its tier is behind them all.
#
# A stage frees all tiers up to its own, as far as they are mentioned: by the group's constraints, or by
# constraints of descendants that mention something free. Those constraints are the ones that a move could
# break, and they join the system; a descendant that nothing outside mentions therefore never moves.

Tier: TypeAlias = tuple[int, int]

PLACED: Tier = (1, 2)
DEEP: Tier = (3, 0)
"""A tier before the first one of what lies deeper than the group itself."""
OWN: Tier = (2, 0)
RIDING: Tier = (5, -1)
"""A tier before the first one of what rides along."""
POSITIONS: Tier = (6, -1)
"""A tier after those of all positions, before the first one of kept sizes."""
SIZES: Tier = (6, 0)
ENDLESS: Tier = (9, 0)
"""A tier after all that may be freed."""
SEALED: Tier = (9, 1)

NAMES = {1: "placed", 2: "own", 3: "translations", 4: "positions", 5: "riding", 6: "sizes"}
DEPTHS = 1 << 20
"""The factor by which a tier (kind, level) becomes one number: kind * DEPTHS + level."""


def tiers_at(
    depth: int, problem: Problem, depths: Ints, rides: Ints, placed: Ints, stages: Stages = Stages.FULL
) -> Ints:
    """Returns the tier of each unknown (n,) below a group at `depth`, as one number.

    depths  (n,) those of the groups that own them
    rides   (n,) the depth above which each rides along
    placed  (n,) the level of those that constraints of the group place; -1 for others
    """
    level, is_frame, is_placed = depths - depth, problem.frame_of >= 0, placed >= 0
    if stages is Stages.FLAT:
        found = np.full(len(level), 2 * DEPTHS)
    elif stages is Stages.PAPER:
        inside = np.where(level > 0, 4, 2) * DEPTHS + level
        found = np.where(is_frame, 3 * DEPTHS + 1 + level, inside)
    else:
        own = np.where(is_placed, DEPTHS + placed, 2 * DEPTHS + problem.standing)
        inside = np.where(is_frame & (stages is not Stages.LEVEL), 3, 4) * DEPTHS + level
        found = np.where(level == 0, own, inside)
        found = np.where(rides > depth, 5 * DEPTHS + level, found)
        spans = np.where(level == 0, DEPTHS + 2, 4 * DEPTHS + level)
        sizes = np.where(problem.spanned & is_placed, spans, 6 * DEPTHS + np.where(is_placed, 0, 1 + level))
        found = np.where(problem.kept, sizes, found)
    return np.where((level < 0) | (problem.sealed > depth), SEALED[0] * DEPTHS + SEALED[1], found)


def stage_name(tier: Tier) -> str:
    """Returns the name of a stage: `placed`, `placed bounds`, `placed spans`, `own`, `own standing`,
    `translations 1`, `positions 2`, `riding 1`, `placed sizes`, `own sizes`, `sizes 1`, …
    """
    kind, level = tier
    if tier >= SIZES:
        return ("placed sizes", "own sizes")[level] if level < 2 else f"sizes {level - 1}"
    if kind < 3:
        return NAMES[kind] + (("", " bounds", " spans"), ("", " standing"))[kind - 1][level]
    return f"{NAMES[kind]} {level}"


@record()
class Scope:
    """The free unknowns of one stage and the indices of its hard constraints."""

    free: frozenset[int]
    constraints: tuple[int, ...]


class Tiers:
    """The tiers of the unknowns in the subtree of a group."""

    def __init__(self, hierarchy: Hierarchy, group: int) -> None:
        self.hierarchy, self.group = hierarchy, group
        self.placed: Mapping[int, int] = {}
        """The own positions and sizes that constraints place, with 0, or 1 if only bounds that hold would."""
        self._codes: list[int] | None = None
        """The tiers as numbers, once one is asked for."""
        self._everything: dict[tuple[int, ...], Scope] = {}
        """The scope with all unknowns free, by the constraints that are to hold."""

    def place(self, indices: Iterable[int]) -> None:
        """Notes the unknowns that these constraints place: those that they name first and that have a share
        in them. A width places nothing that shifts.
        """
        hierarchy, found = self.hierarchy, dict[int, int]()
        constraints, mentions = hierarchy.problem.constraints, hierarchy.mentions
        placing = [index for index in indices if constraints[index].placed & mentions[index]]
        unmet = set(hierarchy.unmet(placing))
        is_kept = hierarchy.is_kept
        sizing = {i for i in placing if any(is_kept[u] for u in constraints[i].placed & mentions[i])}
        for index, reached in self.reached(placing, sizing):
            is_bound = all(row.relation is Relation.AT_MOST for row in constraints[index].rows)
            level = int(is_bound and index not in unmet)
            for unknown in constraints[index].placed & reached:
                found[unknown] = min(level, found.get(unknown, level))
        self.placed = found
        self._codes = None

    def tier(self, unknown: int) -> Tier:
        if self._codes is None:
            self._codes = self.hierarchy.tiers(self.group, self.placed)
        return divmod(self._codes[unknown], DEPTHS)

    def scope(self, last: Tier, seeds: Iterable[int], further: Collection[int] = ()) -> Scope:
        """Returns the closure of `seeds`: the unknowns up to tier `last`, or in `further`, that they mention,
        the constraints that bind those, the unknowns that these mention, …
        """
        hierarchy = self.hierarchy
        constraints, free = set(seeds), set[int]()
        stack = list(constraints)
        while stack:
            for unknown in hierarchy.mentions[stack.pop()]:
                if unknown in free or (self.tier(unknown) > last and unknown not in further):
                    continue
                free.add(unknown)
                for index in hierarchy.solved_mentioning(unknown, self.group):
                    if index not in constraints and hierarchy.is_hard[index]:
                        constraints.add(index)
                        stack.append(index)
        return Scope(frozenset(free), tuple(sorted(constraints)))

    def everything(self, seeds: Sequence[int]) -> Scope:
        """Returns the scope of `seeds` with all unknowns free."""
        key = tuple(seeds)
        if key not in self._everything:
            self._everything[key] = self.scope(ENDLESS, seeds)
        return self._everything[key]

    def reached(self, indices: Sequence[int], sizing: Collection[int]) -> Iterator[tuple[int, set[int]]]:
        """Yields each constraint with the unknowns that change it at the current values; sizes are among them
        only in the constraints `sizing` and in rows that no position changes.
        """
        hierarchy = self.hierarchy
        hierarchy.refresh(indices)
        mentioned = hierarchy.mentioned(indices)
        freezer = Freezer(hierarchy.values, (u for u in mentioned if not hierarchy.is_kept[u]))
        slopes: dict[int, Mapping[int, float]] = {}
        bent: list[int] = []
        for index in indices:
            for row in hierarchy.rows([index]):
                plain = None if index in sizing else freezer.slopes(row.expression)
                if plain and max(map(abs, plain.values())) > FLAT:
                    slopes[row.expression] = plain
                else:
                    bent.append(row.expression)
        slopes.update(gradients(hierarchy.values, bent))
        for index in indices:
            found = (slopes[row.expression].items() for row in hierarchy.rows([index]))
            yield index, {u for gradient in found for u, slope in gradient if abs(slope) > FLAT}

    def is_dear(self, unknown: int) -> bool:
        """Tells whether a move of an unknown is reported: that of a kept size, of what rides along, and of a
        frame that stood where its content is exact, unless a constraint places it.
        """
        tier = self.tier(unknown)
        return tier > RIDING or (tier > PLACED and bool(self.hierarchy.problem.standing[unknown]))

    def independent(self, constraints: Iterable[int]) -> list[list[int]]:
        """Returns the constraints in independent parts, by the unknowns they share that could ever move."""
        parts: list[list[int]] = []
        left = list(constraints)
        while left:
            everything = self.scope(ENDLESS, left[:1])
            linked = set(everything.constraints)
            parts.append([index for index in left if index in linked])
            self._everything[tuple(parts[-1])] = everything
            left = [index for index in left if index not in linked]
        return parts

    def forget(self) -> None:
        """Drops the remembered scopes, as constraints were given up."""
        self._everything.clear()


NOTHING = 1e-6
"""Part of the rest, or of a column, that counts as none."""
MANY = 200_000
"""Entries of the linearised rows above which only parts that help themselves are looked at."""

STILL = 1e-9
"""Moves below this, in units of the unknown's scale, count as none."""
TIGHT = 10.0
"""Factor of its tolerance within which an inequality is on its bound."""
INDEPENDENT = 1e-7
"""Least part of a column that other columns leave if it reaches further than they do."""
REACHED = 1e-6
"""Part of a change within which two changes are the same."""
ASTRAY = 0.2
"""Part of the way promised by slopes by which what bends may end elsewhere."""
SPARING = 8
"""The most changed sizes of which it is tried whether they need change."""
MOST = 400
"""The most moved unknowns that are thinned; above, the nearest point is kept."""


def givers(
    hierarchy: Hierarchy, tiers: Tiers, scope: Scope, taken: frozenset[int], before: Mapping[int, float]
) -> frozenset[int]:
    """Returns the unknowns that shall give way besides those of `scope`, whose rows are left as they are at
    the current values, found on the way from those `before`; none if nobody can help. Where those `taken`
    already would do by their slopes, but did not, somebody else has to.
    """
    found = _Loosening(hierarchy, tiers, scope, scope.free, before).givers()
    if not found and taken:
        found = _Loosening(hierarchy, tiers, scope, scope.free - taken, before).givers()
    return found


@record()
class _Rest:
    """Linearised rows (r,) at a point, over free unknowns (f,) and k that are not.

    free    (r, f) the slopes along the free ones
    others  (r, k) those along the others; `columns` (r, k) without what the free ones reach
    lack    (r,) what the rows need, counted from where the search began
    rest    (r,) the part of it that the free ones do not reach
    owner   (r,) the constraint of each row
    """

    free: Floats
    others: Floats
    lack: Floats
    columns: Floats
    rest: Floats
    owner: Ints

    @cached_property
    def size(self) -> float:
        return float(np.linalg.norm(self.rest))

    def left(self, chosen: Sequence[int]) -> float:
        """Returns the part of the rest that some columns cannot take up; 0 if that is nothing."""
        basis = _basis(self.columns[:, chosen])
        left = float(np.linalg.norm(self.rest - basis @ (basis.T @ self.rest))) / self.size
        return left if left > NOTHING else 0.0

    def way(self, chosen: Sequence[int]) -> float:
        """Returns the length of the shortest move of the free unknowns and some others that will do."""
        matrix = np.hstack((self.free, self.others[:, chosen]))
        return float(np.linalg.norm(np.linalg.lstsq(matrix, self.lack, rcond=NOTHING)[0]))

    def fewest(
        self, among: Sequence[list[int]], given: Sequence[int], first: Collection[int] = ()
    ) -> list[int]:
        """Returns the columns of as few of these as take up, beside those `given`, what all of them can. Of
        those that help alike one that begins with a column of `first` is taken.
        """
        chosen: list[list[int]] = []
        left = self.left(given)
        goal = self.left([*given, *(k for columns in among for k in columns)])
        while left > goal + NOTHING:
            held = [*given, *(k for columns in chosen for k in columns)]
            tried = [(self.left([*held, *each]), each) for each in among if each not in chosen]
            least = min((length for length, _ in tried), default=left)
            if least >= left * (1.0 - NOTHING):
                break
            ties = [each for length, each in tried if length <= least + NOTHING]
            best = ties[0]
            if len(ties) > 1:
                best = min(ties, key=lambda e: (e[0] not in first, round(self.way([*held, *e]), 6)))
            left = least
            chosen.append(best)
        for each in reversed(chosen[:-1]):
            others = [k for other in chosen if other is not each for k in other]
            if self.left([*given, *others]) <= left:
                chosen.remove(each)
        return sorted({k for columns in chosen for k in columns})


class _Loosening:
    def __init__(
        self,
        hierarchy: Hierarchy,
        tiers: Tiers,
        scope: Scope,
        free: frozenset[int],
        before: Mapping[int, float],
    ) -> None:
        self.hierarchy, self.tiers, self.scope = hierarchy, tiers, scope
        self.free = sorted(free)
        moved = np.array([hierarchy.values.unknowns[unknown] - before[unknown] for unknown in self.free])
        self.moved = moved / hierarchy.problem.scale[self.free]
        is_large = len(hierarchy.rows(scope.constraints)) * len(scope.free) > MANY
        self.constraints = hierarchy.unmet(scope.constraints) if is_large else scope.constraints
        """Constraints that contradict each other, maybe among others."""
        thing = hierarchy.problem.thing
        self.thing = thing if thing.any() else np.arange(len(thing))

    def givers(self) -> frozenset[int]:
        found = frozenset[int]()
        for locked, limit in self._circles():
            rest = self._rest(self._binding(locked), locked)
            if not rest.size:
                break
            dear = [self._dearness(unknown) for unknown in locked]
            for last in sorted(set(dear)):
                able = [k for k, dearness in enumerate(dear) if dearness <= last]
                if not rest.left(able):
                    found = self._few(rest, locked, dear, able)
                    break
            else:
                continue
            if last[0] < limit:
                break
        return found

    def _few(
        self, rest: _Rest, locked: Sequence[int], dear: Sequence[tuple[Tier, int]], able: list[int]
    ) -> frozenset[int]:
        """Returns few things in few parts, of those that are `able` (columns), that take up the rest: of the
        dearest class what all cheaper ones leave of it, and so on down.
        """
        able.sort(key=lambda k: self.hierarchy.name(locked[k]))
        constraints = self.hierarchy.problem.constraints
        contrary = rest.owner[np.abs(rest.rest) > NOTHING * rest.size].tolist()
        placed = frozenset[int]().union(*(constraints[i].placed for i in contrary))
        found: list[int] = []
        for dearness in sorted({dear[k] for k in able}, reverse=True):
            given = [*found, *(k for k in able if dear[k] < dearness)]
            parts = self._grouped([k for k in able if dear[k] == dearness], lambda k: self._part(locked[k]))
            following = [k for k in able if dearness[0] > POSITIONS and locked[k] in placed]
            chosen = set(rest.fewest(parts, given, following))
            taken = [k for k in able if k in chosen]
            things = self._grouped(taken, lambda k: ("thing", int(self.thing[locked[k]])))
            found += rest.fewest(things, given)
        return frozenset(locked[k] for k in found)

    def _dearness(self, unknown: int) -> tuple[Tier, int]:
        """Returns the class of an unknown: its tier, and in that first what moves, then what stretches.
        Within parts sizes that are free to change come before both.
        """
        tier = self.tiers.tier(unknown)
        if self.hierarchy.is_kept[unknown]:
            return tier, 2
        return tier, int(tier < DEEP or self.hierarchy.problem.axis[unknown] >= 0)

    @staticmethod
    def _grouped(columns: list[int], name: Callable[[int], tuple[str, int]]) -> list[list[int]]:
        found: dict[tuple[str, int], list[int]] = {}
        for k in columns:
            found.setdefault(name(k), []).append(k)
        return list(found.values())

    def _circles(self) -> Iterator[tuple[list[int], Tier]]:
        """Yields unknowns that may give way, in growing circles, each with the tier below which it settles
        who does: the positions in the parts that have a share in the rest, all positions, and the same with
        sizes.
        """
        hierarchy = self.hierarchy
        problem, tier = hierarchy.problem, self.tiers.tier
        mentioned = hierarchy.mentioned(self.constraints)
        known = sorted(self.tiers.everything(self.scope.constraints).free - self.scope.free)
        is_small = len(known) * len(self.scope.constraints) <= MANY
        for last in (POSITIONS, ENDLESS):
            locked = sorted(u for u in mentioned - self.scope.free if tier(u) < last)
            if not locked:
                continue
            rest = self._rest(self.constraints, locked)
            share, length = np.abs(rest.rest @ rest.columns), np.linalg.norm(rest.columns, axis=0)
            helping = {locked[k] for k in np.flatnonzero(share > NOTHING * length * rest.size)}
            groups = {int(problem.group[u]) for u in helping if tier(u) < POSITIONS}
            beside = {u for u in known if int(problem.group[u]) in groups and tier(u) < POSITIONS}
            around = [u for u in known if u in helping or u in beside]
            if helping:
                yield around, RIDING if is_small else last
                if is_small:
                    yield [u for u in known if tier(u) < last], last

    def _binding(self, locked: Sequence[int]) -> list[int]:
        """Returns the constraints of the scope, and those that bind unknowns outside of it."""
        hierarchy = self.hierarchy
        found = {i for unknown in locked for i in hierarchy.solved_mentioning(unknown, self.tiers.group)}
        return sorted(filter(hierarchy.is_hard.__getitem__, found.union(self.constraints)))

    def _rest(self, constraints: Sequence[int], locked: Sequence[int]) -> _Rest:
        """Returns the rest of the rows of some constraints. An inequality counts where it does not hold, or
        would not after the step by which the free unknowns satisfy those that do.
        """
        hierarchy = self.hierarchy
        owned = hierarchy.rows(constraints)
        owner = np.array(hierarchy.owners(constraints), dtype=np.intp)
        along = [*self.free, *locked]
        ends = None if any(map(hierarchy.is_kept.__getitem__, along)) else hierarchy.values.still()
        row_scale = np.array([row.scale for row in owned])
        slopes = hierarchy.slopes(constraints, along, ends) / row_scale[:, None]
        matrix = np.nan_to_num(slopes * hierarchy.problem.scale[along])
        lack = np.nan_to_num([-hierarchy.values.nodes[row.expression] / row.scale for row in owned])
        free = matrix[:, : len(self.free)]
        counts = np.array([row.relation is Relation.EQUAL for row in owned])
        counts |= lack < -hierarchy.settings.tolerance
        basis = _basis(free[counts])
        rest = lack[counts] - basis @ (basis.T @ lack[counts])
        if float(np.linalg.norm(rest)) <= NOTHING * float(np.linalg.norm(lack[counts])):
            step = np.linalg.lstsq(free[counts], lack[counts], rcond=NOTHING)[0]
            counts |= ~counts & (lack - free @ step < -hierarchy.settings.tolerance)
            basis = _basis(free[counts])
            rest = lack[counts] - basis @ (basis.T @ lack[counts])
            if float(np.linalg.norm(rest)) <= NOTHING * float(np.linalg.norm(lack[counts])):
                rest[:] = 0.0
        others = matrix[counts, len(self.free) :]
        columns = others - basis @ (basis.T @ others)
        columns[:, np.linalg.norm(columns, axis=0) <= NOTHING * np.linalg.norm(others, axis=0)] = 0.0
        lack = lack[counts] + free[counts] @ self.moved
        return _Rest(free[counts], others, lack, columns, rest, owner[counts])

    def _part(self, unknown: int) -> tuple[str, int]:
        """Returns what gives way with an unknown: a size, a frame, or the inside of a group."""
        problem = self.hierarchy.problem
        if self.tiers.tier(unknown) > POSITIONS:
            return "size", unknown
        if problem.frame_of[unknown] >= 0:
            return "frame", int(problem.frame_of[unknown])
        return "inside", int(problem.group[unknown])


def _basis(matrix: Floats) -> Floats:
    """Returns an orthonormal basis (r, d) of what the columns of a matrix (r, k) reach."""
    length = np.linalg.norm(matrix, axis=0)
    unit = matrix[:, length > 0.0] / length[length > 0.0]
    if not unit.size:
        return np.zeros((len(matrix), 0))
    u, sigma, _ = np.linalg.svd(unit, full_matrices=False)
    found: Floats = u[:, sigma > NOTHING * sigma[0]]
    return found


Rank: TypeAlias = "Callable[[int], tuple[int, ...]]"
"""The cost class of moving an unknown: a greater one is dearer."""


def thin(hierarchy: Hierarchy, scope: Scope, before: dict[int, float], rank: Rank) -> None:
    """Holds unknowns of `scope` that need not move. `before` are their values before a move to the current
    ones, which satisfy its constraints.
    """
    moved = _moved(hierarchy, before)
    if len({int(hierarchy.problem.thing[unknown]) for unknown in moved}) < 2 or len(moved) > MOST:
        return
    needed, expected = _needed(hierarchy, scope, moved, rank)
    if len(needed) == len(moved):
        return
    reached = hierarchy.save(scope.free)
    hierarchy.values.assign(before.items())
    verdict = hierarchy.attempt(replace(scope, free=frozenset(needed)), 0)
    now = _moved(hierarchy, before)  # unknowns in curved rows: about as far as the slopes promised?
    off = sum((now.get(unknown, 0.0) - step) ** 2 for unknown, step in expected.items())
    if not verdict.satisfied or off > ASTRAY**2 * sum(step * step for step in expected.values()):
        hierarchy.values.assign(reached.items())


def spare_sizes(hierarchy: Hierarchy, scope: Scope, before: dict[int, float]) -> None:
    """Holds kept sizes of `scope` that changed and need not have, tried one by one: an inequality that a
    change made tight asks for no other change.
    """

    def change(size: int) -> tuple[float, str]:
        off = abs(hierarchy.values.unknowns[size] - before[size])
        return -off / abs(before[size]) if before[size] else -np.inf, hierarchy.name(size)

    known = filter(hierarchy.is_kept.__getitem__, scope.free)
    sizes = [u for u in known if not hierarchy.is_spanned[u] and hierarchy.moved(u, before[u])]
    if not 2 <= len({int(hierarchy.problem.thing[size]) for size in sizes}) <= len(sizes) <= SPARING:
        return
    for size in sorted(sizes, key=change):
        reached = hierarchy.save(scope.free)
        if not hierarchy.moved(size, before[size]):
            continue
        hierarchy.values.assign(before.items())
        narrow = replace(scope, free=scope.free - {size})
        if hierarchy.attempt(narrow, 1).satisfied:
            scope = narrow
        else:
            hierarchy.values.assign(reached.items())


def _moved(hierarchy: Hierarchy, before: dict[int, float]) -> dict[int, float]:
    scale, unknowns = hierarchy.problem.scale, hierarchy.values.unknowns
    found = {u: float((unknowns[u] - x) / scale[u]) for u, x in before.items()}
    return {u: step for u, step in found.items() if abs(step) > STILL}


def _needed(
    hierarchy: Hierarchy, scope: Scope, moved: dict[int, float], rank: Rank
) -> tuple[set[int], dict[int, float]]:
    """Returns enough of the unknowns that moved, and the moves that slopes promise those in curved rows."""
    tolerance, values = hierarchy.settings.tolerance, hierarchy.values
    rows = hierarchy.rows(scope.constraints)
    hierarchy.refresh(scope.constraints)
    roots = [
        row.expression
        for row in rows
        if row.relation is Relation.EQUAL or values.nodes[row.expression] > -TIGHT * tolerance * row.scale
    ]
    thing = hierarchy.problem.thing
    needed: set[int] = set()
    expected: dict[int, float] = {}
    for program in Freezer(values, moved).freeze(roots).programs:
        columns = [int(unknown) for unknown in program.columns]
        steps = np.array([moved[unknown] for unknown in columns])
        program.residuals(np.array([values.unknowns[unknown] for unknown in columns]))
        matrix = program.jacobian(np.ones(len(program.rows)), hierarchy.problem.scale[columns])
        if not isinstance(matrix, np.ndarray):  # large, and left as it is
            needed.update(columns)
            continue
        things: dict[int, list[int]] = {}
        for column, unknown in enumerate(columns):
            things.setdefault(int(thing[unknown]), []).append(column)
        dearness = {
            number: (
                max(rank(columns[i]) for i in members),
                -round(float(np.abs(steps[members]).max()), 6),
                min(hierarchy.name(columns[i]) for i in members),
                members,
            )
            for number, members in things.items()
        }
        order = [column for number in sorted(things, key=dearness.__getitem__) for column in things[number]]
        share = _combination(matrix, matrix @ steps, order)
        chosen = [i for members in things.values() if any(share[i] for i in members) for i in members]
        if len(chosen) == len(columns):  # nothing can stay as a whole
            chosen = [i for members in things.values() for i in _tied(matrix, share, members)]
        needed.update(columns[i] for i in chosen)
        if chosen and not program.linear:
            found = np.linalg.lstsq(matrix[:, chosen], matrix @ steps, rcond=None)[0]
            expected.update(zip((columns[i] for i in chosen), found.tolist(), strict=True))
    return needed, expected


def _tied(matrix: Floats, share: list[bool], members: list[int]) -> list[int]:
    """Returns the columns of a thing that have a share, and those that a row ties to one of them; a
    coordinate that the others do not depend on can stay by itself.
    """
    slopes = np.abs(matrix)
    sloping = slopes > REACHED * slopes.max(axis=1, initial=0.0, keepdims=True)
    moving = sloping[:, [i for i in members if share[i]]].any(axis=1)
    return [i for i in members if share[i] or bool((sloping[:, i] & moving).any())]


def _combination(matrix: Floats, target: Floats, order: list[int]) -> list[bool]:
    """Returns the mask of columns (k,) of a matrix (r, k) that have a share in a combination that gives
    `target` (r,), using up those first that come first in `order`.
    """
    used: list[int] = []
    directions = np.zeros((0, len(target)))
    rest, size = target.copy(), float(np.abs(target).max(initial=0.0))
    for column in order:
        if float(np.abs(rest).max(initial=0.0)) <= REACHED * size:
            break
        vector = matrix[:, column]
        length = float(np.linalg.norm(vector))
        for _ in range(2):  # twice is enough (Giraud, Langou, Rozloznik, doi:10.1016/j.camwa.2005.08.009)
            vector = vector - directions.T @ (directions @ vector)
        if (left := float(np.linalg.norm(vector))) > INDEPENDENT * length > 0.0:
            used.append(column)
            directions = np.vstack((directions, vector / left))
            rest = rest - directions[-1] * float(directions[-1] @ rest)
    found = [False] * matrix.shape[1]
    if used:
        factors = np.linalg.lstsq(matrix[:, used], target, rcond=None)[0]
        for column, factor in zip(used, factors.tolist(), strict=True):
            found[column] = abs(factor) > REACHED * float(np.abs(factors).max())
    return found

"""Finds the constraints of a failed group that cannot hold together, each of them needed for that.

What is refuted (`refuting`) is so for good. Else the suspects are named by the place where the search stalled
(`suspects`). If they fail together they are reduced until each is needed: without any one of them the others
hold. That a search fails is no proof, so for such a set it begins in many other places; curved ones are
called contradictory only if it ends equally far off from most of these, which it does in no merely hard set.

Why something dear gave way is found likewise: it is held where it was, and the constraints that then cannot
hold together ask for it. Where several things did, each such set is asked for by who has a share in it.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import field, replace

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver.branches import violation_of
from aidl_lang.solver.expression import Floats
from aidl_lang.solver.hierarchy import Hierarchy
from aidl_lang.solver.loosening import Scope
from aidl_lang.solver.newton import Clock, End, perturbation
from aidl_lang.solver.problem import Concession, Failure, GroupFailure, Member, Problem, Relation, Settings
from aidl_lang.solver.refuting import MOST_ACCUSED, Linearised, Relaxation, needed, suspects

WORK = 60_000
"""Budget of all explanations of one solve: rows times unknowns, summed over the attempts."""
SECONDS = 2.5
"""Time for one explanation, should the budget not be spent by then."""
PATIENCE = 4.0
"""Seconds after the first failure during which explanations are sought."""
RINGS = 3
"""The number of times that the neighbours of the worst constraint are taken in."""
RESTARTS = 2
"""Perturbed starts for each set that is tried."""
THOROUGH = 5
"""Perturbed starts before a set is called contradictory."""
CURVED = 1e-6
"""Change of a slope, relatively, that shows that a row is not affine."""
STARTS = 32
"""Number of other places in which the search for a set begins before it is called contradictory."""
ALIKE = 1.5
"""Factor of the least violation up to which another one agrees with it."""
FIRST = 8
"""Starts for all constraints together, before a conflict among them is sought."""
LONGEST = 1.0
"""Seconds for these searches."""
COSTLY = 4000
"""Greatest work of one attempt for which all constraints together are tried in other places."""
SPREADS = (0.3, 1.0, 3.0)
"""Distances of these places from the first guesses, in sizes of the drawing."""
SEED = 1


@record()
class _SearchResult:
    """The end of a search: how it came, the values of the free unknowns, and the greatest violation."""

    end: End
    reached: dict[int, float]
    violation: float = 0.0

    @property
    def holds(self) -> bool:
        return self.end is End.CONVERGED


def explain(
    hierarchy: Hierarchy,
    group: int,
    violated: Sequence[int],
    scope: Scope,
    before: dict[int, float],
    best: dict[int, float],
) -> GroupFailure:
    """Explains why the constraints of `scope` cannot hold with its unknowns free, starting from `before`.
    `best` are the values of the stage that came closest.
    """
    hierarchy.values.assign(best.items())
    unmet = tuple(_ConflictSearch.member(hierarchy, index) for index in violated)
    if hierarchy.timed_out:
        return GroupFailure(group, Failure.TIMED_OUT, unmet)
    if not hierarchy.settings.explain:
        return GroupFailure(group, Failure.NOT_CONVERGED, unmet)
    return _ConflictSearch(hierarchy, scope, before).explain(group, best)


def is_refuted(hierarchy: Hierarchy, scope: Scope) -> bool:
    """Tells whether it is proved that the constraints of `scope` cannot hold with its unknowns free."""
    hierarchy.refresh(scope.constraints)
    rows = hierarchy.rows(scope.constraints)
    return Relaxation(hierarchy.values, rows, scope.free, hierarchy.settings.tolerance).is_refuted


def conflict(hierarchy: Hierarchy, scope: Scope, before: dict[int, float]) -> tuple[list[int], bool]:
    """Returns a set of constraints of `scope` that cannot hold together with its unknowns free, starting from
    `before` (empty if all can), and whether it is known to be minimal.
    """
    hierarchy.values.assign(before.items())
    search = _ConflictSearch(hierarchy, scope, before)
    trial = search._try(tuple(sorted(scope.constraints)))
    if trial.holds:
        return [], True
    found = search._conflict(trial.reached, search._refuted(scope.constraints))
    return found, not search._spent


@record(frozen=False)
class _ConflictSearch:
    hierarchy: Hierarchy
    scope: Scope
    before: dict[int, float]
    clock: Clock = field(init=False)
    trials: dict[tuple[int, ...], _SearchResult] = field(default_factory=dict)
    relaxations: dict[tuple[int, ...], Relaxation] = field(default_factory=dict)
    left: int = field(init=False)
    ended: list[float] = field(default_factory=list)
    """The violations at which the searches from other places ended."""
    work: int = 0

    def __post_init__(self) -> None:
        hierarchy = self.hierarchy
        self.clock = Clock(min(SECONDS, hierarchy.patience.left, hierarchy.clock.left / 2.0))
        self.left = WORK - sum(failure.work for failure in hierarchy.failures)

    def explain(self, group: int, best: dict[int, float]) -> GroupFailure:
        hierarchy, scope = self.hierarchy, self.scope
        refuted = self._refuted(scope.constraints)
        if not refuted and self._cost(scope.constraints) <= COSTLY:
            whole = self._nearest(scope.constraints, _SearchResult(End.INFEASIBLE, best, np.inf), FIRST)
            if whole.holds:
                return self._found(group, self._violated(best), whole)
        conflict = self._conflict(best, refuted)
        if refuted or not self._spent:
            conflict = self._said(conflict)
        minimal = not self._spent
        is_proven = self._relaxation(conflict).is_refuted
        thorough = self._attempt(tuple(conflict), THOROUGH)
        nearest = thorough if is_proven else self._nearest(conflict, thorough, STARTS)
        if nearest.holds:
            return self._found(group, conflict, nearest)
        hierarchy.values.assign(nearest.reached.items())
        members = tuple(self.member(hierarchy, index) for index in conflict)
        moving, equations = self._count(conflict)
        is_curved = bool(moving) and self._curved(conflict)
        reason = Failure.NOT_CONVERGED
        failed = minimal and thorough.end in (End.INFEASIBLE, End.CONTRARY)
        near = sum(off <= ALIKE * nearest.violation for off in self.ended)  # searches that ended there
        if is_proven or (failed and (not is_curved or near >= STARTS / 2)):
            excess = equations > len(moving) > 0 and is_curved
            reason = Failure.OVERDETERMINED if excess else Failure.CONTRADICTORY
        hierarchy.values.assign(self.before.items())
        return GroupFailure(
            group,
            reason,
            members,
            minimal,
            moving,
            equations,
            self.work,
            within=tuple(scope.constraints),
            nearest=tuple(sorted(nearest.reached.items())),
            is_curved=is_curved,
            sizes=self._sizes(conflict),
            gaps=self._gaps(conflict) if is_proven else (),
        )

    def _found(self, group: int, failing: Sequence[int], place: _SearchResult) -> GroupFailure:
        """Returns the failure of constraints that hold in another place."""
        hierarchy = self.hierarchy
        hierarchy.values.assign(self.before.items())
        members = tuple(self.member(hierarchy, index) for index in failing)
        return GroupFailure(
            group,
            Failure.NOT_CONVERGED,
            members,
            work=self.work,
            holds_elsewhere=True,
            within=tuple(self.scope.constraints),
            nearest=tuple(sorted(place.reached.items())),
        )

    def _nearest(self, conflict: Sequence[int], best: _SearchResult, starts: int) -> _SearchResult:
        """Returns the best of searches from many places, those with no kept size changed first."""
        hierarchy, clock = self.hierarchy, Clock(min(LONGEST, self.hierarchy.clock.left / 2.0))
        free = sorted(hierarchy.mentioned(conflict) & self.scope.free)
        self.ended = []
        positions = frozenset(u for u in free if not hierarchy.is_kept[u] or hierarchy.is_spanned[u])
        for scope in dict.fromkeys((positions, frozenset(free))):
            for start in itertools.islice(self._starts(sorted(scope)), starts):
                if best.holds or clock.expired:
                    return best
                found = self._attempt(tuple(conflict), 0, {**self.before, **start}, scope)
                self.ended.append(found.violation)
                best = min(best, found, key=lambda trial: trial.violation)
        return best

    def _starts(self, free: Sequence[int]) -> Iterator[dict[int, float]]:
        """Yields places about the first guesses: directions anywhere, sizes from a third to three times."""
        problem, random = self.hierarchy.problem, np.random.default_rng(SEED)
        size = float(problem.rows.scale.max(initial=1.0))
        for turn in range(STARTS):
            spread = SPREADS[turn % len(SPREADS)] * size
            start = {}
            for unknown in free:
                share, here = random.uniform(-1.0, 1.0), self.before[unknown]
                if np.isfinite(problem.longest[unknown]):
                    start[unknown] = 180.0 * share
                elif problem.kept[unknown] and not self.hierarchy.is_spanned[unknown]:
                    start[unknown] = here * 3.0**share
                else:
                    start[unknown] = here + spread * share
            yield start

    @staticmethod
    def member(hierarchy: Hierarchy, index: int) -> Member:
        """Returns the constraint and how far it is off at the current values."""
        hierarchy.refresh([index])
        return Member(index, max(violation_of(row, hierarchy.values) for row in hierarchy.rows([index])))

    # -- the set

    def _conflict(self, best: dict[int, float], refuted: list[int]) -> list[int]:
        """Returns a set that cannot hold together, of the `refuted` if any; minimal within the budget."""
        if refuted:
            return self._needed(refuted)
        found = next((c for c in self._candidates(best) if not self._holds(c)), None)
        if found is None:
            return self._violated(best)
        return self._needed(found)

    def _said(self, conflict: list[int]) -> list[int]:
        """Returns the conflict without bounds of shapes on their own sizes, if the others fail with those of
        these sizes held on which they hang by no slope: beyond its bounds a shape may hold anything.
        """
        hierarchy, constraints = self.hierarchy, self.hierarchy.problem.constraints
        said = [i for i in conflict if constraints[i].whole or constraints[i].inside]
        if not said or len(said) == len(conflict) or not hierarchy.problem.named:
            return conflict
        bounded = hierarchy.mentioned(i for i in conflict if i not in said)
        narrow = replace(self.scope, free=self.scope.free - (bounded - hierarchy.sloping(said)))
        apart = _ConflictSearch(hierarchy, narrow, self.before)
        if apart._holds(said):
            return conflict
        self.scope, self.trials, self.relaxations = narrow, apart.trials, apart.relaxations
        return self._needed(said)

    def _needed(self, found: list[int]) -> list[int]:
        """Returns a smallest failing part of a failing set, or what was left when the budget was spent."""
        return needed(found, lambda part: self._spent or self._holds(part))

    def _refuted(self, constraints: Sequence[int]) -> list[int]:
        """Returns constraints among these that provably never hold together; empty if there is no proof."""
        relaxation = self._relaxation(constraints)
        owner = self.hierarchy.owners(constraints)
        return sorted({owner[row] for row in relaxation.smallest()})

    def _gaps(self, conflict: Sequence[int]) -> tuple[tuple[int, float], ...]:
        """Returns the residual of each member that is one row where the others hold; empty if not known."""
        owner = self.hierarchy.owners(conflict)
        gaps = self._relaxation(conflict).gaps()
        return tuple((owner[row], gap) for row, gap in gaps.items() if owner.count(owner[row]) == 1)

    def _relaxation(self, constraints: Sequence[int]) -> Relaxation:
        hierarchy, key = self.hierarchy, tuple(constraints)
        if key not in self.relaxations:
            hierarchy.values.assign(self.before.items())
            hierarchy.refresh(key)
            rows, free, tolerance = hierarchy.rows(key), self.scope.free, hierarchy.settings.tolerance
            self.relaxations[key] = Relaxation(hierarchy.values, rows, free, tolerance)
        return self.relaxations[key]

    def _candidates(self, best: dict[int, float]) -> Iterator[list[int]]:
        hierarchy, scope = self.hierarchy, self.scope
        hierarchy.values.assign(best.items())
        accused = suspects(hierarchy, scope.constraints, scope.free)
        if len(accused) <= MOST_ACCUSED:
            yield accused
        yield from self._around(best)
        if len(accused) > MOST_ACCUSED:
            yield accused
        yield self._violated(best)
        yield list(scope.constraints)

    def _violated(self, best: dict[int, float]) -> list[int]:
        self.hierarchy.values.assign(best.items())
        return self.hierarchy.unmet(self.scope.constraints)

    def _around(self, best: dict[int, float]) -> Iterator[list[int]]:
        """Yields growing sets: the constraint that is furthest off with those that share free unknowns with
        it, then also the neighbours of these, while they are few.
        """
        hierarchy, free = self.hierarchy, self.scope.free
        violated = self._violated(best)
        if not violated:
            return
        worst = max((self.member(hierarchy, index) for index in violated), key=lambda member: member.off)
        touched, before = hierarchy.mentions[worst.index] & free, 1
        for _ in range(RINGS):
            around = [i for i in self.scope.constraints if not touched.isdisjoint(hierarchy.mentions[i])]
            if len(around) == before:
                return
            yield around
            touched |= hierarchy.mentioned(around) & free
            before = len(around)

    # -- data of the explanation

    def _count(self, conflict: Sequence[int]) -> tuple[tuple[int, ...], int]:
        hierarchy = self.hierarchy
        moving = tuple(sorted(hierarchy.mentioned(conflict) & self.scope.free))
        return moving, sum(row.relation is Relation.EQUAL for row in hierarchy.rows(conflict))

    def _sizes(self, conflict: Sequence[int]) -> frozenset[int]:
        """Returns the kept sizes in those constraints of the conflict that hang on no position."""
        hierarchy, found = self.hierarchy, set[int]()
        for index in conflict:
            reached = hierarchy.sloping([index])
            if all(map(hierarchy.is_kept.__getitem__, reached)):
                found |= reached
        return frozenset(found)

    def _curved(self, conflict: Sequence[int]) -> bool:
        hierarchy = self.hierarchy
        free = sorted(self.scope.free)
        aside = perturbation(len(free)) * hierarchy.problem.scale[free]
        here = hierarchy.save(free)
        slopes = []
        for values in (here, {u: here[u] + step for u, step in zip(free, aside.tolist(), strict=True)}):
            hierarchy.values.assign(values.items())
            slopes.append(hierarchy.slopes(conflict, free))
        hierarchy.values.assign(here.items())
        return bool(np.abs(slopes[0] - slopes[1]).max() > CURVED * np.abs(slopes[0]).max())

    # -- trying

    @property
    def _spent(self) -> bool:
        return self.clock.expired or self.work >= self.left

    def _holds(self, constraints: Sequence[int]) -> bool:
        """Tells whether constraints can hold together, as far as a proof or a search tells."""
        wanted = tuple(sorted(constraints))
        if wanted not in self.trials:
            relaxation = self._relaxation(wanted)
            if (refuted := relaxation.is_refuted) or relaxation.is_exact:
                return not refuted
        return self._try(wanted).holds

    def _try(self, constraints: tuple[int, ...]) -> _SearchResult:
        if constraints not in self.trials:
            self.work += self._cost(constraints)
            empty = _SearchResult(End.CONVERGED, self.before)
            self.trials[constraints] = self._attempt(constraints, RESTARTS) if constraints else empty
        return self.trials[constraints]

    def _cost(self, constraints: Sequence[int]) -> int:
        hierarchy = self.hierarchy
        return len(hierarchy.rows(constraints)) * len(hierarchy.mentioned(constraints) & self.scope.free)

    def _attempt(
        self,
        constraints: tuple[int, ...],
        restarts: int,
        start: dict[int, float] | None = None,
        free: frozenset[int] | None = None,
    ) -> _SearchResult:
        """Searches from `start`, or from where the group was; leaves the values where the group was."""
        hierarchy = self.hierarchy
        hierarchy.values.assign((start or self.before).items())
        scope = replace(self.scope, constraints=constraints, free=self.scope.free if free is None else free)
        verdict = hierarchy.attempt(scope, restarts, self.clock, turning=start is None)
        reached = hierarchy.save(self.scope.free)
        hierarchy.values.assign(self.before.items())
        return _SearchResult(verdict.end, reached, verdict.violation)


# --- Questions about a problem beyond its solution: what is lacking, what is near, why something gave way.

SEARCH_RESTARTS = 3
"""Perturbed starts."""
FEW_ROWS = 40
"""Rows up to which all of `within` is searched for together."""


def shortfall(
    problem: Problem,
    settings: Settings,
    constraints: Collection[int],
    within: Collection[int],
    start: Mapping[int, float],
) -> float:
    """Returns the violation that constraints keep with the unknowns of `start` free; 0 if a search from there
    satisfies them. If all of `within` are affine, but for choices, and are proved to contradict each other,
    it is measured on all of them: in units of its own, it then changes linearly with a number among them.
    """
    hierarchy = _at(problem, settings, {})
    hierarchy.refresh(within)
    rows, free = hierarchy.rows(within), frozenset(start)
    relaxation = Relaxation(hierarchy.values, rows, free, settings.tolerance)
    if not relaxation.bends and (off := relaxation.lack()) > 0.0:
        return off
    first, least = hierarchy.save(free), np.inf
    searched = within if len(rows) <= FEW_ROWS else constraints
    for place in (start, first):
        hierarchy.values.assign(place.items())
        verdict = hierarchy.attempt(Scope(free, tuple(sorted(searched))), SEARCH_RESTARTS)
        least = min(least, 0.0 if verdict.satisfied else verdict.violation)
    return least


def nearby_solution(
    problem: Problem, settings: Settings, constraints: Collection[int], start: Mapping[int, float]
) -> dict[int, float] | None:
    """Returns values near `start` at which constraints hold with its unknowns free; None if not found."""
    hierarchy = _at(problem, settings, start)
    verdict = hierarchy.attempt(Scope(frozenset(start), tuple(sorted(constraints))), SEARCH_RESTARTS)
    return hierarchy.save(start) if verdict.satisfied else None


def equations(
    problem: Problem, settings: Settings, constraints: Sequence[int], place: Mapping[int, float]
) -> list[Floats]:
    """Returns the unit slopes (r, k) of the equations of each constraint at `place`, over its unknowns."""
    hierarchy = _at(problem, settings, place)
    there = Linearised(hierarchy, constraints, place)
    return [there.jacobian[(there.owner == index) & ~there.inequality] for index in constraints]


def residual(problem: Problem, settings: Settings, constraint: int, place: Mapping[int, float]) -> float:
    """Returns the value of the row of a constraint that is furthest from zero at `place`, with its sign."""
    hierarchy = _at(problem, settings, place)
    hierarchy.refresh([constraint])
    rows = hierarchy.rows([constraint])
    return max((hierarchy.values.nodes[row.expression] for row in rows), key=abs)


@record()
class Reason:
    """Unknowns that gave way, and the indices of the constraints that ask for it. If `minimal`, none asks for
    it without the others; there are none if the unknowns need not have given way.
    """

    unknowns: frozenset[int]
    constraints: tuple[int, ...]
    minimal: bool


def reasons(problem: Problem, settings: Settings, concession: Concession, solved: Floats) -> Iterator[Reason]:
    """Yields the reason of each unknown that gave way; `solved` are the values (n,) of the solution. Sizes
    that could have given way instead are held as well.
    """
    hierarchy = _at(problem, settings, dict(enumerate(concession.values.tolist())))
    hierarchy.reached[:] = concession.values
    left = concession.unknowns
    moving = frozenset(u for u in concession.free if u in left or not hierarchy.is_kept[u])
    while left:
        scope = Scope(moving - left, concession.constraints)
        before = {unknown: float(concession.values[unknown]) for unknown in concession.free}
        found, minimal = conflict(hierarchy, scope, before)
        asked = left & hierarchy.mentioned(found)
        share = _bound(hierarchy, found, asked, concession, solved) or asked or left
        rest, more, is_known = concession.constraints, found, len(share) > 1
        while more and is_known:  # several that go together may be asked for more than once
            rest = tuple(index for index in rest if index not in more)
            more, is_known = conflict(hierarchy, Scope(moving - share, rest), before)
            found, minimal = found + more * is_known, minimal and not more
        yield Reason(share, tuple(found), minimal and bool(found))
        left -= share


def _bound(
    hierarchy: Hierarchy,
    constraints: list[int],
    unknowns: frozenset[int],
    concession: Concession,
    solved: Floats,
) -> frozenset[int]:
    """Returns the unknowns that the constraints hold at the solution: put back, each breaks one."""
    if len(unknowns) < 2:
        return unknowns
    kept = hierarchy.save(range(len(solved)))
    hierarchy.values.assign(enumerate(solved.tolist()))
    found = set()
    for unknown in unknowns:
        hierarchy.values.assign([(unknown, float(concession.values[unknown]))])
        if hierarchy.unmet(constraints):
            found.add(unknown)
        hierarchy.values.assign([(unknown, float(solved[unknown]))])
    hierarchy.values.assign(kept.items())
    return frozenset(found)


def _at(problem: Problem, settings: Settings, place: Mapping[int, float]) -> Hierarchy:
    hierarchy = Hierarchy(problem, settings, Clock(settings.seconds))
    hierarchy.values.assign(place.items())
    return hierarchy

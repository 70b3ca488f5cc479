"""Questions about a problem beyond its solution: what is lacking, what is near, why something gave way."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver.conflicts import conflict
from aidl_lang.solver.expression import Floats
from aidl_lang.solver.hierarchy import Hierarchy
from aidl_lang.solver.loosening import Scope
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.problem import Concession, Problem, Settings
from aidl_lang.solver.refuting import Linearised, Relaxation

RESTARTS = 3
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
        verdict = hierarchy.attempt(Scope(free, tuple(sorted(searched))), RESTARTS)
        least = min(least, 0.0 if verdict.satisfied else verdict.violation)
    return least


def nearby_solution(
    problem: Problem, settings: Settings, constraints: Collection[int], start: Mapping[int, float]
) -> dict[int, float] | None:
    """Returns values near `start` at which constraints hold with its unknowns free; None if not found."""
    hierarchy = _at(problem, settings, start)
    verdict = hierarchy.attempt(Scope(frozenset(start), tuple(sorted(constraints))), RESTARTS)
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
        mentioned = frozenset[int]().union(*map(hierarchy.mentions.__getitem__, found))
        share = _bound(hierarchy, found, left & mentioned, concession, solved) or left & mentioned or left
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

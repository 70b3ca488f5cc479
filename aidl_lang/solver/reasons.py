"""The constraints because of which something dear gave way: a size, a frame with exact content, what rides
along.

What gave way is held where it was; the constraints that then cannot hold together ask for it. They are
found as for a conflict. Where several things gave way, each set is asked for by those that have a share in
it.
"""

from __future__ import annotations

from collections.abc import Iterator

from aidl_lang.common.records import record
from aidl_lang.solver.conflicts import conflict
from aidl_lang.solver.hierarchy import Hierarchy
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.operations import Floats
from aidl_lang.solver.problem import Problem, Settings
from aidl_lang.solver.solution import Concession
from aidl_lang.solver.tiers import Scope


@record()
class Reason:
    """Unknowns that gave way, and the indices of the constraints that ask for it. If `minimal`, no constraint
    can be left out; there are none if the unknowns need not have given way.
    """

    unknowns: frozenset[int]
    constraints: tuple[int, ...]
    minimal: bool


def reasons(problem: Problem, settings: Settings, concession: Concession, solved: Floats) -> Iterator[Reason]:
    """Yields the reason of each unknown that gave way; `solved` are the values (n,) of the solution. Sizes
    that could have given way instead are held as well.
    """
    hierarchy = Hierarchy(problem, settings, Clock(settings.seconds))
    hierarchy.reached[:] = concession.values
    hierarchy.values.assign(enumerate(concession.values.tolist()))
    left = concession.unknowns
    moving = frozenset(u for u in concession.free if u in left or not hierarchy.is_kept(u))
    while left:
        scope = Scope(moving - left, concession.constraints)
        before = {unknown: float(concession.values[unknown]) for unknown in concession.free}
        found, minimal = conflict(hierarchy, scope, before)
        mentioned = frozenset[int]().union(*map(hierarchy.mentions.__getitem__, found))
        share = _bound(hierarchy, found, left & mentioned, concession, solved) or left & mentioned or left
        yield Reason(share, tuple(found), minimal and bool(found))
        left -= share


def _bound(
    hierarchy: Hierarchy,
    constraints: list[int],
    unknowns: frozenset[int],
    concession: Concession,
    solved: Floats,
) -> frozenset[int]:
    """Returns the unknowns that the constraints hold at the solution: put back to its value before, each of
    them breaks one.
    """
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

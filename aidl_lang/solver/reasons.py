"""Because of which constraints something dear gave way: a size, a frame with exact content, what rides along.

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
from aidl_lang.solver.problem import Problem, Settings
from aidl_lang.solver.solution import Giving
from aidl_lang.solver.tiers import Scope


@record()
class Reason:
    """The unknowns that gave way, and the constraints, by index, that ask for it; without any one of
    them the others would have, if they are `minimal`. None are given where what gave way need not have.
    """

    unknowns: frozenset[int]
    constraints: tuple[int, ...]
    minimal: bool


def reasons(problem: Problem, settings: Settings, gave: Giving) -> Iterator[Reason]:
    """Why each of the unknowns that gave way did."""
    hierarchy = Hierarchy(problem, settings, Clock(settings.seconds))
    hierarchy.reached[:] = gave.values
    hierarchy.values.assign(enumerate(gave.values.tolist()))
    left = gave.unknowns
    while left:
        scope = Scope(gave.free - left, gave.constraints)
        before = {unknown: float(gave.values[unknown]) for unknown in gave.free}
        found, minimal = conflict(hierarchy, scope, before)
        mentioned = frozenset[int]().union(*map(hierarchy.mentions.__getitem__, found))
        share = left & mentioned or left
        yield Reason(share, tuple(found), minimal and bool(found))
        left -= share

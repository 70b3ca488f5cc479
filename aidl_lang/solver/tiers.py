"""The stages at which the unknowns of a group become free.

At a group every unknown of its subtree has a tier, which says at which stage it becomes free:

    (1, 0)  own position that a constraint of the group places
    (1, 1)  own position that only a bound which holds anyway would place
    (1, 2)  own length or direction between two points of which a constraint places one
    (2, 0)  own position, or translation of a child's frame (owned by the group, too)
    (2, 1)  the same of a frame that stands where its content counts as exact
    (3, d)  translation of a frame, owned by a group d levels below
    (4, d)  other position of a group d levels below, or such a length or direction
    (5, d)  position of what rides along with its parent, since no constraint names it
    (6, 0)  kept size that a constraint places, at any level
    (6, 1)  own kept size
    (6, 1 + d)  kept size of a group d levels below
    (9, 1)  what is in a group that is sealed: it is never freed

A stage frees all tiers up to its own, as far as they are mentioned: by the group's constraints, or by
constraints of descendants that mention something free. Those constraints are the ones that a move could
break, and they join the system; a descendant that nothing outside mentions therefore never moves.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang.common.records import record
from aidl_lang.solver.freezing import Freezer
from aidl_lang.solver.gradients import FLAT, gradients
from aidl_lang.solver.problem import Relation

if TYPE_CHECKING:
    from aidl_lang.solver.hierarchy import Hierarchy

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
        self._known: dict[int, Tier] = {}
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
            for unknown in constraints[index].placed.intersection(itertools.chain(*reached)):
                found[unknown] = min(level, found.get(unknown, level))
        self.placed = found
        self._known.clear()

    def tier(self, unknown: int) -> Tier:
        found = self._known.get(unknown)
        if found is None:
            found = self._known[unknown] = self.hierarchy.tier(self.group, unknown, self.placed)
        return found

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

    def reached(
        self, indices: Sequence[int], sizing: Collection[int]
    ) -> Iterator[tuple[int, list[list[int]]]]:
        """Yields each constraint with the unknowns that change each of its rows at the current values; sizes
        are among them only in the constraints `sizing` and in rows that no position changes.
        """
        hierarchy, mentions = self.hierarchy, self.hierarchy.mentions
        hierarchy.refresh(indices)
        mentioned = frozenset[int]().union(*map(mentions.__getitem__, indices))
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
            found = [slopes[row.expression] for row in hierarchy.rows([index])]
            yield index, [[u for u, slope in gradient.items() if abs(slope) > FLAT] for gradient in found]

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

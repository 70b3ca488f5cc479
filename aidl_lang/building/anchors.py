"""The anchor among equals, which is held: one of `row(a, b, c)`, of `symmetric(a, b)`, of `same_width(a, b)`.

A call over equals says of none that it stays. Any of them that something else places is the anchor, so it can
be chosen only when all constraints are known. If nothing places any, the one stays that is dearest to move:
one whose content is exact in its frame, then one by which others are placed, then the last. An anchor held
this way may still move, only later: holding it is what the solver tries first.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import field, replace
from zlib import crc32

from aidl_lang.building import expression as ex
from aidl_lang.building.expression import Unknown
from aidl_lang.building.model import Comparison, Constraint, Structure
from aidl_lang.building.wording import holds
from aidl_lang.common.records import record

_NUDGE = 1e-4
"""The part by which a position is moved to see whether a comparison feels it: too little to pass another."""
_FLAT = 1e-10
_HOLDS = 1e-9

Unknowns = frozenset[Unknown]


def anchored(constraints: Sequence[Constraint]) -> list[Constraint]:
    """Returns the constraints, each over equals with its anchor held: `moved` of its comparisons lacks it."""
    over_equals = [c for c in constraints if any(p.parties for p in c.comparisons)]
    if not over_equals:
        return list(constraints)
    senses = {holder: _Senses(holder) for holder in dict.fromkeys(c.holder for c in over_equals)}
    ties = [tie for c in over_equals for tie in _ties(c, senses[c.holder])]
    of_interest = frozenset(u for tie in ties for party in tie.parties for u in party.near)
    standings = {holder: _Standing(sense) for holder, sense in senses.items()}
    for constraint in constraints:
        if constraint.weight is None and (standing := standings.get(constraint.holder)) is not None:
            for comparison in constraint.comparisons:
                standing.learn(comparison, of_interest)
    for holder, standing in standings.items():
        _choose([tie for tie in ties if tie.constraint.holder is holder], standing)
    moved: dict[Comparison, frozenset[Unknown]] = {c: tie.moved for tie in ties for c in tie.comparisons}
    return [_with_moved(c, moved) for c in constraints]


@record(frozen=False)
class _Party:
    """One of the equals in some comparisons: all unknowns that place it, and those that would move first."""

    every: Unknowns
    near: Unknowns


@record(frozen=False, eq=False)
class _Tie:
    """The comparisons of one constraint that concern the same coordinates of its parties (the x of all in a
    row, the y of two mirror images), and the unknowns that move first.
    """

    constraint: Constraint
    comparisons: list[Comparison]
    parties: list[_Party]
    is_tied: bool
    moved: Unknowns = frozenset()

    @property
    def key(self) -> tuple[str, str, str, list[str]]:
        """An order of ties that does not depend on the order in which constraints are written."""
        c = self.constraint
        return c.holder.path, c.text, c.label, sorted(u.path for p in self.parties for u in p.near)

    def hold(self, anchor: _Party | None) -> Unknowns:
        """Lets all but the anchor move. Returns the unknowns of these that would move first."""
        others = [p for p in self.parties if p is not anchor]
        kept = anchor.every if anchor is not None else frozenset()
        self.moved = frozenset().union(*(p.every for p in others)) - kept
        return frozenset().union(*(p.near for p in others)) - kept


@record(frozen=False)
class _Standing:
    """The unknowns that the constraints of one structure place, hold and mention, calls over equals aside."""

    senses: _Senses
    placed: set[Unknown] = field(default_factory=set)
    mentioned: set[Unknown] = field(default_factory=set)
    held: set[Unknown] = field(default_factory=set)

    def learn(self, comparison: Comparison, of_interest: Unknowns) -> None:
        if comparison.parties or _idle(comparison):
            return
        mentioned = self.senses.mentioned(comparison)
        if mentioned.isdisjoint(of_interest):
            return
        placed = self.senses.near(comparison, mentioned & comparison.placed)
        self.placed |= placed
        self.mentioned |= self.senses.near(comparison, mentioned - placed)

    def dearness(self, party: _Party) -> tuple[bool, bool]:
        """Returns how dear it is to move a party that nothing places."""
        is_exact = all(u.frame_of is not None for u in party.every)
        return is_exact, not self.mentioned.isdisjoint(party.near)


def _idle(comparison: Comparison) -> bool:
    """Tells whether a comparison moves nothing: a bound that the first guesses keep."""
    if comparison.relation == "==" or comparison.left.is_open or comparison.right.is_open:
        return False
    return holds(comparison, lambda e: e.value, _HOLDS)


def _choose(ties: Iterable[_Tie], standing: _Standing) -> None:
    """Holds an anchor in each tie: first where something else places a party, which then places the others.
    If there is none, one tie has to begin, chosen without regard to the order of constraints.
    """
    waiting = sorted(ties, key=lambda tie: tie.key)
    while waiting:
        begun = [t for t in waiting if t.is_tied or _anchor(t, standing) is not None] or waiting[:1]
        for tie in begun:
            anchor = None if tie.is_tied else _anchor(tie, standing) or _dearest(tie, standing)
            standing.placed |= tie.hold(anchor)
            standing.held |= anchor.near if anchor is not None else frozenset()
        waiting = [t for t in waiting if t not in begun]


def _anchor(tie: _Tie, standing: _Standing) -> _Party | None:
    """Returns the party that an earlier tie holds for its equals, or one that something else places."""
    held = standing.held - standing.placed
    for known in (held, standing.placed):
        for party in tie.parties:
            if not known.isdisjoint(party.near):
                return party
    return None


def _dearest(tie: _Tie, standing: _Standing) -> _Party | None:
    order = enumerate(tie.parties)
    return max(order, key=lambda item: (standing.dearness(item[1]), item[0]), default=(0, None))[1]


def _ties(constraint: Constraint, senses: _Senses) -> Iterator[_Tie]:
    """Yields the comparisons of a call over equals, put together if they concern the same coordinates."""
    groups: list[tuple[set[Unknown], list[tuple[Comparison, list[_Party]]]]] = []
    for comparison in constraint.comparisons:
        if not comparison.parties:
            continue
        parties = list(_parties(comparison, senses))
        touched = {u for p in parties for u in p.near}
        here = [(comparison, parties)]
        apart = []
        for other in groups:
            if other[0].isdisjoint(touched):
                apart.append(other)
            else:
                touched |= other[0]
                here = other[1] + here
        groups = [*apart, (touched, here)]
    for _, members in groups:
        together: dict[Unknowns, Unknowns] = {}
        for _, parties in members:
            for p in parties:
                together[p.every] = together.get(p.every, frozenset()) | p.near
        order = [every for comparison, _ in members for every in comparison.parties]
        known = [every for every in dict.fromkeys(order) if every in together]
        comparisons, is_tied = [each for each, _ in members], any(len(found) == 1 for _, found in members)
        yield _Tie(constraint, comparisons, [_Party(every, together[every]) for every in known], is_tied)


def _parties(comparison: Comparison, senses: _Senses) -> Iterator[_Party]:
    mentioned = senses.mentioned(comparison)
    for every in dict.fromkeys(comparison.parties):
        if near := senses.near(comparison, mentioned & every):
            yield _Party(every, near)


class _Senses:
    """The positions that comparisons of one structure depend on: all are nudged, each by an amount of its
    own, and a comparison is evaluated anew. Shared parts of comparisons are evaluated once.
    """

    def __init__(self, holder: Structure) -> None:
        self.holder = holder
        self.own: dict[Unknown, float] = {}
        self.every: dict[Unknown, float] = {}
        self._of_own, self._of_every = ex.Evaluator(self.own), ex.Evaluator(self.every)

    def mentioned(self, comparison: Comparison) -> Unknowns:
        found = frozenset(u for u in ex.unknowns((comparison.left, comparison.right)) if not u.exact)
        for unknown in found:
            if not unknown.kept and unknown not in self.every:
                nudged = unknown.guess + _NUDGE * (1 + crc32(unknown.path.encode()) / 2**32)
                self.every[unknown] = nudged
                # It is placed at this structure's turn; an empty one's box counts as its frame.
                owner = unknown.owner
                if (owner.parent or owner if unknown.outline else owner) is self.holder:
                    self.own[unknown] = nudged
        return found

    def near(self, comparison: Comparison, unknowns: Unknowns) -> Unknowns:
        """Returns those of some unknowns that would move first to satisfy a comparison: positions in the
        holder itself, then those below, then kept sizes. Positions that cancel, as in a width, do not count.
        """
        sizes = frozenset(u for u in unknowns if u.kept)
        own = unknowns & self.own.keys()
        if own and (own == unknowns or _felt(comparison, self._of_own)):
            return own
        below = unknowns - sizes - own
        return below if below and (below == unknowns or _felt(comparison, self._of_every)) else sizes


def _felt(comparison: Comparison, evaluate: ex.Evaluator) -> bool:
    left, right = comparison.left, comparison.right
    now, then = left.value - right.value, evaluate(left) - evaluate(right)
    return not abs(then - now) <= _FLAT * max(1.0, abs(left.value), abs(right.value))


def _with_moved(constraint: Constraint, moved: dict[Comparison, Unknowns]) -> Constraint:
    if not any(c in moved for c in constraint.comparisons):
        return constraint
    comparisons = tuple(replace(c, moved=moved[c]) if c in moved else c for c in constraint.comparisons)
    return replace(constraint, comparisons=comparisons)

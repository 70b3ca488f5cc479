"""Which of equals is held: the anchor of `row(a, b, c)`, of `symmetric(a, b)`, of `same_width(a, b)`.

A call over equals says of none that it stays. Whichever of them something else places is the anchor, so this
can be told only when all constraints are known. Where nothing places any, the one stays that is dearest to
move: whose content is exact in its frame, then one by which others are placed, then the last. What is held
this way moves later, and not never: it is what the solver tries first.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

from aidl_lang import expression as ex
from aidl_lang.building.conditions import holds
from aidl_lang.expression import Unknown
from aidl_lang.model import Comparison, Constraint, Structure

_NUDGE = 1e-4
"""By how much a position is moved to see whether a comparison feels it: too little to pass another."""
_FLAT = 1e-10
_HOLDS = 1e-9

Unknowns = frozenset[Unknown]


def anchored(constraints: Sequence[Constraint]) -> list[Constraint]:
    """The constraints, each over equals with its anchor held: `moved` of its comparisons is without it."""
    ties = [tie for c in constraints if any(p.parties for p in c.comparisons) for tie in _ties(c)]
    if not ties:
        return list(constraints)
    of_interest = frozenset(u for tie in ties for party in tie.parties for u in party.near)
    standings: dict[Structure, _Standing] = {}
    for constraint in constraints:
        if constraint.weight is None:
            standing = standings.setdefault(constraint.holder, _Standing())
            for comparison in constraint.comparisons:
                standing.learn(comparison, constraint.holder, of_interest)
    for holder in dict.fromkeys(tie.constraint.holder for tie in ties):
        own = [tie for tie in ties if tie.constraint.holder is holder]
        _choose(own, standings.setdefault(holder, _Standing()))
    moved: dict[Comparison, frozenset[Unknown]] = {c: tie.moved for tie in ties for c in tie.comparisons}
    return [_with_moved(c, moved) for c in constraints]


@dataclass
class _Party:
    """One of the equals, in some comparisons: all that places it, and what of it they would move first."""

    every: Unknowns
    near: Unknowns


@dataclass(eq=False)
class _Tie:
    """The comparisons of one constraint that concern the same coordinates of its parties (the x of all in a
    row, the y of two mirror images), and what of them moves first.

    """

    constraint: Constraint
    comparisons: list[Comparison]
    parties: list[_Party]
    moved: Unknowns = frozenset()

    @property
    def key(self) -> tuple[str, str, str, list[str]]:
        """What tells it from others whatever the order in which constraints are written."""
        c = self.constraint
        return c.holder.path, c.text, c.label, sorted(u.path for p in self.parties for u in p.near)

    @property
    def places_all(self) -> bool:
        """Whether it says too much to leave one where it is: each of those spread through a box is placed."""
        equations = sum(c.relation == "==" for c in self.comparisons)
        spare = [len(p.near) for p in self.parties]
        return equations > sum(spare) - max(spare, default=0)

    def hold(self, anchor: _Party | None) -> Unknowns:
        """Lets all but the anchor move; what these would move first."""
        others = [p for p in self.parties if p is not anchor]
        kept = anchor.every if anchor is not None else frozenset()
        self.moved = frozenset().union(*(p.every for p in others)) - kept
        return frozenset().union(*(p.near for p in others)) - kept


@dataclass
class _Standing:
    """What the constraints of one structure say of what they mention, calls over equals aside."""

    placed: set[Unknown] = field(default_factory=set)
    mentioned: set[Unknown] = field(default_factory=set)

    def learn(self, comparison: Comparison, holder: Structure, of_interest: Unknowns) -> None:
        if comparison.parties:
            return
        mentioned = frozenset(ex.unknowns((comparison.left, comparison.right)))
        if mentioned.isdisjoint(of_interest) or _idle(comparison):
            return
        placed = _near(comparison, mentioned & comparison.placed, holder)
        self.placed |= placed
        self.mentioned |= _near(comparison, mentioned - placed, holder)

    def dearness(self, party: _Party) -> tuple[bool, bool]:
        """How dear it is to move a party that nothing places."""
        is_exact = all(u.frame_of is not None for u in party.every)
        return is_exact, not self.mentioned.isdisjoint(party.near)


def _idle(comparison: Comparison) -> bool:
    """Whether it moves nothing: a bound that the first guesses keep."""
    if comparison.relation == "==" or comparison.left.is_open or comparison.right.is_open:
        return False
    return holds(comparison, lambda e: e.value, _HOLDS)


def _choose(ties: Iterable[_Tie], standing: _Standing) -> None:
    """Holds an anchor in each tie: those first where something else places a party, which places the others.
    Where nothing does, one tie has to begin, and which is no matter of the order of constraints.
    """
    waiting = sorted(ties, key=lambda tie: tie.key)
    while waiting:
        ready = [t for t in waiting if t.places_all or _anchor(t, standing) is not None]
        for tie in ready or waiting[:1]:
            anchor = None if tie.places_all else _anchor(tie, standing) or _dearest(tie, standing)
            standing.placed |= tie.hold(anchor)
        done = set(map(id, ready or waiting[:1]))
        waiting = [t for t in waiting if id(t) not in done]


def _anchor(tie: _Tie, standing: _Standing) -> _Party | None:
    """The party that something else places."""
    return next((p for p in tie.parties if not standing.placed.isdisjoint(p.near)), None)


def _dearest(tie: _Tie, standing: _Standing) -> _Party | None:
    order = enumerate(tie.parties)
    return max(order, key=lambda item: (standing.dearness(item[1]), item[0]), default=(0, None))[1]


def _ties(constraint: Constraint) -> Iterator[_Tie]:
    """The comparisons of a call over equals, put together where they concern the same coordinates."""
    groups: list[tuple[set[Unknown], list[tuple[Comparison, list[_Party]]]]] = []
    for comparison in constraint.comparisons:
        if not comparison.parties:
            continue
        parties = list(_parties(comparison, constraint.holder))
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
        yield _Tie(
            constraint,
            [comparison for comparison, _ in members],
            [_Party(every, together[every]) for every in known],
        )


def _parties(comparison: Comparison, holder: Structure) -> Iterator[_Party]:
    """The parties that a comparison could move."""
    mentioned = frozenset(ex.unknowns((comparison.left, comparison.right)))
    for every in dict.fromkeys(comparison.parties):
        if near := _near(comparison, mentioned & every, holder):
            yield _Party(every, near)


def _near(comparison: Comparison, unknowns: Unknowns, holder: Structure) -> Unknowns:
    """Those of some unknowns that would move first to satisfy a comparison: positions in the holder itself,
    then those below, then kept sizes. Positions that cancel, as in a width, are none of it.
    """
    unknowns = frozenset(u for u in unknowns if not u.exact)
    positions = frozenset(u for u in unknowns if not u.kept)
    own = frozenset(u for u in positions if _placer(u) is holder)
    sizes = unknowns - positions
    for candidates in (own, positions - own):
        if candidates and ((not sizes and candidates == unknowns) or _felt(comparison, candidates)):
            return candidates
    return sizes


def _placer(unknown: Unknown) -> Structure | None:
    """At whose turn an unknown is placed: the box of an empty structure as if it were its frame."""
    return unknown.owner.parent or unknown.owner if unknown.outline else unknown.owner


def _felt(comparison: Comparison, positions: Unknowns) -> bool:
    """Whether a comparison feels it when positions move."""
    order = sorted(positions, key=lambda u: u.path)
    nudged = {u: u.guess + _NUDGE * (1 + 0.37 * i) for i, u in enumerate(order)}
    now, then = (
        evaluate(comparison.left) - evaluate(comparison.right)
        for evaluate in (ex.Evaluator({}), ex.Evaluator(nudged))
    )
    return not abs(then - now) <= _FLAT * max(1.0, abs(now))


def _with_moved(constraint: Constraint, moved: dict[Comparison, Unknowns]) -> Constraint:
    if not any(c in moved for c in constraint.comparisons):
        return constraint
    comparisons = tuple(replace(c, moved=moved[c]) if c in moved else c for c in constraint.comparisons)
    return replace(constraint, comparisons=comparisons)

"""What there is to say of a program that cannot be solved: who conflicts, where, and what would fit."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from aidl_lang.building.wording import Wording
from aidl_lang.diagnostics import Diagnostic, Fix, Label
from aidl_lang.expression import Unknown
from aidl_lang.lower import Lowered
from aidl_lang.model import Constraint
from aidl_lang.remedies import Remedy, left_out, remedy, rewritten, says, short, wished
from aidl_lang.solver.solution import Failure, GroupFailure, Member, Solution
from aidl_lang.source import Span
from aidl_lang.units import ANGLE, LENGTH

_PROVEN = (Failure.CONTRADICTORY, Failure.OVERDETERMINED)
"""Reasons that do not depend on where the search began."""
_TOLERANCE = 1e-6
"""Below this a constraint is not called off, in its own units."""
_NAMED = 3
"""Things that a list names."""
_QUOTED = 60
"""Characters of a constraint that a headline quotes."""


def failure_notes(lowered: Lowered, solution: Solution) -> list[Diagnostic]:
    """One error for each group that could not be solved for reasons of its own."""
    return [report.diagnostic() for report in _reports(lowered, solution)]


@dataclass(frozen=True)
class Party:
    """A constraint in a conflict: the structure that holds it, how far it is off where the search came
    nearest, what would fit in it in words ("" if that is not known), and the edit that writes it.
    """

    path: str
    text: str
    span: Span
    off: float
    would_fit: str
    fix: Fix | None


@dataclass(frozen=True)
class Conflict:
    """Constraints that do not hold together, in order of writing. `is_minimal`: without any one of them the
    others do.
    """

    headline: str
    is_minimal: bool
    parties: tuple[Party, ...]


def conflicts(lowered: Lowered, solution: Solution) -> tuple[Conflict, ...]:
    """What the errors of `failure_notes` are about, one for one, as data."""
    return tuple(report.conflict() for report in _reports(lowered, solution))


def _reports(lowered: Lowered, solution: Solution) -> list[_Report]:
    stated = Counter(constraint.span for constraint in lowered.stated if constraint is not None)
    own = [f for f in solution.failures if not _follows(f, solution.failures, lowered.groups)]
    return [_Report(lowered, solution, failure, stated) for failure in own]


def _follows(failure: GroupFailure, failures: Sequence[GroupFailure], paths: Sequence[str]) -> bool:
    """Whether a search that found nothing may owe that to a failure in the same group or inside it."""
    if failure.reason in _PROVEN:
        return False
    here = f"{paths[failure.group]}."
    inside = [f for f in failures if f is not failure and f"{paths[f.group]}.".startswith(here)]
    return any(f.group != failure.group or f.reason in _PROVEN for f in inside)


@dataclass(frozen=True)
class _Party:
    """A constraint in a conflict, as its author knows it, and what would mend it alone."""

    member: Member
    stated: Constraint
    remedy: Remedy | None
    fix: Fix | None

    @property
    def name(self) -> str:
        text = self.stated.text
        return f"`{text if len(text) <= _QUOTED else text[: _QUOTED - 1] + '…'}`"

    @property
    def prominence(self) -> tuple[bool, bool, bool, int]:
        """Who is asked to change: one that can be mended by a number, and of those the last written."""
        literal = self.remedy is not None and self.remedy.is_literal
        return self.fix is not None, literal, self.remedy is not None, self.stated.span.start


class _Report:
    def __init__(
        self, lowered: Lowered, solution: Solution, failure: GroupFailure, stated: Counter[Span]
    ) -> None:
        self.lowered, self.solution, self.failure, self.times = lowered, solution, failure, stated
        self.is_proven = failure.reason in _PROVEN
        stated_here = [s for i in failure.conflict if (s := lowered.stated[i]) is not None]
        self.places = Counter(constraint.span for constraint in stated_here)
        self.sizes = [self._size(i) for i in failure.conflict if lowered.stated[i] is None]
        parties = filter(None, map(self._party, failure.members))
        self.parties = sorted(parties, key=lambda party: party.stated.span.start)

    def diagnostic(self) -> Diagnostic:
        code, headline = self._headline()
        labels = [
            Label(u.holder.span, f"{u.told} would have to become 0")
            for u in self.sizes
            if u.holder.span is not None
        ]
        if not self.parties:
            return Diagnostic(code, headline, secondary=tuple(labels))
        chief = self._chief()
        labels = list(self._labels(chief)) + labels
        hints = tuple(self._hints())
        return Diagnostic(
            code, headline, chief.stated.span, self._claim(chief), tuple(labels), hints, self._fix(chief)
        )

    def conflict(self) -> Conflict:
        return Conflict(self._headline()[1], self.failure.minimal, tuple(map(self._told, self.parties)))

    def _told(self, party: _Party) -> Party:
        """One of the parties; where no number mends it alone, as a wish if an edit can make it one."""
        stated, fix = party.stated, party.fix
        if fix is None and self.is_proven and self._is_single(stated):
            fix = wished(stated)
        would_fit = party.remedy.text if party.remedy else ""
        return Party(stated.holder.path, stated.text, stated.span, party.member.off, would_fit, fix)

    def _party(self, member: Member) -> _Party | None:
        stated = self.lowered.stated[member.index]
        if stated is None:
            return None
        wording, found, fix = stated.wording, None, None
        once = self.places[stated.span] == 1
        if member.fit is not None and once and isinstance(wording, Wording):
            unknowns, problem = self.lowered.unknowns, self.lowered.problem
            values = dict(zip(unknowns, self.solution.values.tolist(), strict=True))
            values.update((unknowns[number], value) for number, value in member.fit.values)
            size = float(problem.rows.scale.max())
            found = remedy(wording, member.fit, values, size, vanishing=bool(self.sizes))
            if found is not None and self._is_single(stated):
                fix = rewritten(wording, found)
        return _Party(member, stated, found, fix)

    def _is_single(self, stated: Constraint) -> bool:
        """Whether an edit at its place changes this constraint and no other: no loop, no template."""
        wording = stated.wording
        own = isinstance(wording, Wording) and wording.node.span == stated.span
        return own and not stated.label and self.times[stated.span] == 1

    def _size(self, index: int) -> Unknown:
        """The size that a constraint which nobody stated keeps from vanishing: `least - size <= 0` or
        `-size <= 0`.
        """
        problem = self.lowered.problem
        operands = problem.tape.operand_lists
        *_, size = operands[problem.constraints[index].rows[0].expression]
        return self.lowered.unknowns[operands[size][0]]

    def _chief(self) -> _Party:
        """The party that the message is about."""
        if self.is_proven:
            return max(self.parties, key=lambda party: party.prominence)
        return max(self.parties, key=lambda party: (party.member.off, party.stated.span.start))

    def _fix(self, chief: _Party) -> Fix | None:
        if not self.is_proven or not self._is_single(chief.stated):
            return None
        if chief.fix is None:
            return wished(chief.stated)
        assert isinstance(chief.stated.wording, Wording)
        said = says(chief.stated.wording, chief.fix)
        if said not in (party.stated.text for party in self.parties):
            return chief.fix
        assert chief.remedy is not None
        return wished(chief.stated) if chief.remedy.is_relation else left_out(chief.stated)

    # -- words

    def _headline(self) -> tuple[str, str]:
        failure = self.failure
        turns: dict[Span, list[_Party]] = {}
        for party in self.parties:
            turns.setdefault(party.stated.span, []).append(party)
        names = listed([_name(parties) for parties in turns.values()])
        names = names or listed([unknown.told for unknown in self.sizes])
        several = len(self.parties) > 1
        match failure.reason:
            case Failure.CONTRADICTORY:
                return "E0601", f"{names} cannot hold{' together' * several}"
            case Failure.OVERDETERMINED:
                moving = len(failure.moving)
                asked = f"{'are' if several else 'is'} {failure.equations} equations"
                return "E0605", f"{names} {asked} for {moving} number{'s' * (moving > 1)} that may move"
            case Failure.NOT_CONVERGED:
                return "E0602", f"no position was found in which {names} hold{'s' * (not several)}"
            case Failure.TIMED_OUT:
                return "E0603", f"the time for solving ran out before {names} held"

    def _claim(self, chief: _Party) -> str:
        """What is wrong with the one that the message is about."""
        if chief.remedy is not None:
            return chief.remedy.text
        off = chief.member.off
        if not math.isfinite(off):
            return "this has no value where the solver stopped"
        if not self.is_proven:
            return f"off by {_measured(off, chief.stated)} at best" if off > _TOLERANCE else ""
        return ("", "", "conflicts with the other", "conflicts with the others")[min(len(self.parties), 3)]

    def _labels(self, chief: _Party) -> Iterator[Label]:
        """The other places, each once."""
        text = "conflicts with this" if self.is_proven else "takes part"
        seen = {chief.stated.span}
        for party in self.parties:
            if party.stated.span not in seen:
                seen.add(party.stated.span)
                yield Label(party.stated.span, f"{text}; {party.remedy.text}" if party.remedy else text)

    def _hints(self) -> Iterator[str]:
        match self.failure.reason:
            case Failure.OVERDETERMINED:
                wordings = [w for party in self.parties if isinstance(w := party.stated.wording, Wording)]
                held = dict.fromkeys(f"`{name}`" for wording in wordings for name in wording.held())
                if held:
                    moving = listed([self.lowered.unknowns[i].told for i in self.failure.moving])
                    yield f"{listed(list(held))} cannot move, only {moving}: a `guess(…)` frees a number"
            case Failure.NOT_CONVERGED:
                yield "the search starts from what is written: first guesses near to what is meant help it"
            case Failure.TIMED_OUT:
                yield "what concerns one part only is solved faster if that part states it"


def _name(parties: Sequence[_Party]) -> str:
    """What is stated at one place, in the turns of a loop perhaps."""
    first, label = parties[0].name, parties[0].stated.label
    if len(parties) > 1:
        return f"{first} ({len(parties)} times)"
    return f"{first} [{label}]" if label else first


def listed(names: Sequence[str], most: int = _NAMED) -> str:
    """`a`; `a and b`; `a, b and c`; `a, b and 3 more`"""
    if len(names) > most:
        names = [*names[: most - 1], f"{len(names) - most + 1} more"]
    return " and ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))


def _measured(value: float, stated: Constraint) -> str:
    """With its unit where all that is compared has the same."""
    dimensions = {comparison.dimension for comparison in stated.comparisons}
    unit = " mm" if dimensions <= {LENGTH, None} else "°" if dimensions == {ANGLE} else ""
    return f"{short(value)}{unit}"

"""Explanations of a program that cannot be solved: what conflicts, where, and what would fit."""

from __future__ import annotations

import itertools
import math
import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

from aidl_lang.building.expression import Evaluator, Unknown, unknowns
from aidl_lang.building.lower import Solved, lower
from aidl_lang.building.model import Constraint, Model, chain
from aidl_lang.building.values import Num
from aidl_lang.building.wording import Wording, rounding
from aidl_lang.checking.units import ANGLE, LENGTH, UNITS
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.prose import listed, named, short, shortened, ticked
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.explaining.remedies import Remedy, RemedySearch, dear, left_out, remedies, wished
from aidl_lang.explaining.trials import Dial, Trials, exact_numbers, written_numbers
from aidl_lang.interp import Interpretation
from aidl_lang.solver import Settings, Status, solve
from aidl_lang.solver.conflicts import nearby_solution
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.problem import Failure, GroupFailure, Member
from aidl_lang.syntax import ast

_PROVEN = (Failure.CONTRADICTORY, Failure.OVERDETERMINED)
"""Reasons that do not depend on where the search began."""
_ROUNDED = 1e-6  # violations up to this, in the constraint's own units, are told as rounding
_FINISHED = 5  # the most fixes that are tried for whether the program then compiles to the end
_LIKE = 2.0
"""Factor up to which a dearer fix is offered in place of one that changes what says nothing new then."""
NAMED = 3
"""The most things that a list names."""
_SHOWN = 12  # the most places shown beside the one that a message is about
_QUOTED = 60  # the most characters of a constraint that a headline quotes


def explained(trials: Trials) -> list[Explanation]:
    """Returns an explanation of each group that failed by itself; `trials` tries remedies once asked."""
    failures, found = trials.solution.failures, list[Explanation]()
    for failure in failures:
        if not _follows(failure, failures, trials.solution.problem.groups):
            found.append(Explanation(failure, trials, tuple(found)))
    return found


@record()
class Party:
    """A constraint in a conflict: the path of the structure that holds it, its violation where the search
    came nearest, what would fit in it in words ("" if unknown), and the edit that writes it.
    """

    path: str
    text: str
    span: Span
    off: float
    would_fit: str
    fix: Fix | None


@record()
class ExactNumber:
    """An exact number behind a conflict: its name if it has one, its place, and what would fit there."""

    name: str
    span: Span
    would_fit: str
    fix: Fix


@record()
class Conflict:
    """Constraints that do not hold together, in order of writing, and exact numbers that have a share in
    that. `is_minimal`: without any one of the constraints the others hold.
    """

    headline: str
    is_minimal: bool
    parties: tuple[Party, ...]
    givens: tuple[ExactNumber, ...] = ()


def _follows(failure: GroupFailure, failures: Sequence[GroupFailure], paths: Sequence[str]) -> bool:
    """Tells whether a search may have found nothing because of a failure in the same group or inside it."""
    if failure.reason in _PROVEN:
        return False
    here = f"{paths[failure.group]}."
    inside = [f for f in failures if f is not failure and f"{paths[f.group]}.".startswith(here)]
    return any(f.group != failure.group or f.reason in _PROVEN for f in inside)


@record()
class _StatedMember:
    """A constraint in a conflict, as its author knows it."""

    member: Member
    stated: Constraint


@record(frozen=False, eq=False)
class Explanation:
    """Why a group could not be solved, and remedies, which may be those of an `earlier` explanation."""

    failure: GroupFailure
    trials: Trials
    earlier: tuple[Explanation, ...]

    def __post_init__(self) -> None:
        failure, self.solution = self.failure, self.trials.solution
        lowered = self.lowered = self.solution.problem
        self.is_proven = failure.reason in _PROVEN
        self.times = Counter(c.span for c in lowered.stated if c is not None)
        self.sizes = [self._size(i) for i in failure.conflict if lowered.stated[i] is None]
        members = failure.members if self.is_proven else self._held()
        parties = [_StatedMember(m, stated) for m in members if (stated := lowered.stated[m.index])]
        self.parties = sorted(parties, key=lambda party: party.stated.span.start)
        self.turns: dict[Span, list[_StatedMember]] = {}
        """The parties by the place at which they are stated; a loop states several at one place."""
        for party in self.parties:
            self.turns.setdefault(party.stated.span, []).append(party)

    @cached_property
    def diagnostic(self) -> Diagnostic:
        code, headline = self._headline()
        known = [(u.holder.span, u.description) for u in self.sizes if self.is_proven]
        labels = [Label(span, f"{what} would have to become 0 or less") for span, what in known if span]
        if not self.parties:
            return Diagnostic(code, headline, secondary=tuple(labels))
        chief = self._chief
        labels = [*self._givens(), *self._labels(chief), *labels]
        span, hints = chief.stated.span, tuple(self._hints())
        return Diagnostic(code, headline, span, self._claim(chief), tuple(labels), hints, self._fix)

    @cached_property
    def conflict(self) -> Conflict:
        parties = tuple(map(self._told, self.parties))
        exact = (r for r in self._remedies if r.dial.is_exact)
        givens = tuple(ExactNumber(r.dial.name, r.dial.place, r.would_fit(), r.fix) for r in exact)
        return Conflict(self._headline()[1], self.failure.minimal, parties, givens)

    def _held(self) -> Sequence[Member]:
        """Returns the members as they are off in what is drawn; of a set that is not minimal, what fails."""
        stated = [index for index in self.failure.conflict if self.lowered.stated[index] is not None]
        found = [Member(index, self.solution.residuals[index]) for index in stated]
        unmet = [member for member in found if not self.solution.satisfied[member.index]]
        return found if self.failure.minimal else unmet or found

    def _told(self, party: _StatedMember) -> Party:
        stated, found = party.stated, self._remedy_of(party)
        fix = found.fix if found else None
        would_fit = found.would_fit() if found else ""
        return Party(stated.holder.path, stated.text, stated.span, party.member.off, would_fit, fix)

    def _size(self, index: int) -> Unknown:
        """Returns the size that an unwritten constraint, `least - size <= 0`, keeps from vanishing."""
        operands = self.lowered.tape.operand_lists
        *_, size = operands[self.lowered.constraints[index].rows[0].expression]
        return self.lowered.unknowns[operands[size][0]]

    # -- remedies

    @cached_property
    def _remedies(self) -> list[Remedy]:
        """Numbers that would fit in the parties, one for each place, and in place of exact ones."""
        if not self.is_proven:
            return []
        searches = list(self._searches())
        if self.sizes:  # of which would have to vanish there is only to say that a sign is wrong
            return list(filter(None, (search.turned() for search in searches)))
        order = {search.dial.place: n for n, search in enumerate(searches)}
        known = [found for earlier in self.earlier for found in earlier._remedies]
        fixed = (found for found in known if found.dial.place in order)
        fixed = (found for found in fixed if self.trials.mends(found.fix.edits, self.failure))
        both = [replace(found, shown=found.fix.edits[0].replacement) for found in fixed]
        done = {found.dial.place for found in both}
        fresh = remedies(search for search in searches if search.dial.place not in done)
        return sorted([*both, *fresh], key=lambda found: order[found.dial.place])

    def _searches(self) -> Iterator[RemedySearch]:
        stated = {span: self._dials(parties[0]) for span, parties in self.turns.items()}

        def order(span: Span) -> tuple[int, bool, float]:
            dials = stated[span]
            # If all rows are straight, the largest numbers change by the smallest part of themselves.
            largest = 0.0 if self.failure.is_curved else max((abs(dial.value) for dial in dials), default=0.0)
            return -self._shares(span), any(dial.is_rough for dial in dials), -largest

        for span in sorted(stated, key=order):
            parties = self.turns[span]
            member = parties[0].member.index if len(parties) == 1 else None
            for dial in stated[span]:
                yield RemedySearch(dial, self.failure, self.trials, span, member)
        if not self.sizes:
            uses = next((w.it.program.resolution.uses for w in self._wordings), {})
            for dial in exact_numbers(
                [p.stated.node for p in self.parties if p.stated.node is not None], uses
            ):
                yield RemedySearch(dial, self.failure, self.trials, dial.place)

    @property
    def _wordings(self) -> Iterator[Wording]:
        return (w for party in self.parties if (w := party.stated.wording) is not None)

    @staticmethod
    def _dials(party: _StatedMember) -> list[Dial]:
        """Returns the numbers of a statement that may be changed: factors are no measures."""
        dials = [] if party.stated.node is None else written_numbers(party.stated.node)
        return [dial for dial in dials if not dial.is_factor]

    def _remedy_of(self, party: _StatedMember) -> Remedy | None:
        span = party.stated.span
        inside = (r for r in self._remedies if not r.dial.is_exact)
        return next((r for r in inside if span.overlaps(r.dial.place)), None)

    @cached_property
    def _fix(self) -> Fix | None:
        """The smallest change of a number that resolves the conflict, preferring those that keep equal
        numbers equal; as a last resort, making one of the constraints a wish.
        """
        cheapest = sorted(self._remedies, key=self._dearness)
        has_others = len(self.solution.failures) > 1
        idle: tuple[Fix, Remedy] | None = None
        for found in filter(self._may_finish, cheapest[:_FINISHED]):
            fix = self._once(found)
            if idle is not None and not self._is_like(found, idle[1]):
                break
            if self.trials.finishes(fix.edits):
                if not self.trials.idles(fix.edits):
                    return fix
                idle = idle or (fix, found)
        if idle is not None:
            return idle[0]
        if has_others and cheapest:  # none mends all that is wrong
            return self._once(cheapest[0])
        for fix in self._last_resorts() if self.is_proven else ():
            edits = fix.edits
            if self.trials.mends(edits, self.failure) and (has_others or self.trials.finishes(edits)):
                return fix
        return None

    def _last_resorts(self) -> Iterator[Fix]:
        """Yields fixes that change no number: a shape with several points placed turns, a party is a wish."""
        equal = [p.stated.comparisons for p in self.parties if isinstance(p.stated.node, ast.Comparison)]
        points = [parts for parts in equal if len(parts) == 2]
        spoken = unknowns(side for parts in points[1:] for part in parts for side in (part.left, part.right))
        shapes = {unknown.holder.span: unknown.holder.path for unknown in spoken}
        for span, path in itertools.islice(shapes.items(), _FINISHED):
            if span is not None and re.search(r"[^(]\)$", span.text) and "rotatable" not in span.text:
                where = replace(span, start=span.end - 1, end=span.end - 1)
                yield Fix(f"let `{path}` turn", (Edit(where, ", rotatable: true"),))
        for party in reversed(self.parties):
            if party.stated.node is not None and self.times[party.stated.span] == 1:
                yield wished(party.stated)

    def _may_finish(self, found: Remedy) -> bool:
        """Tells whether no other proven conflict is left as it is by a remedy."""
        others = (f for f in self.solution.failures if f is not self.failure)
        proven = [spans for f, spans in zip(others, self._others, strict=True) if f.reason in _PROVEN]
        place = found.dial.place
        return found.dial.is_exact or all(any(s.overlaps(place) for s in spans) for spans in proven)

    def _once(self, found: Remedy) -> Fix:
        """Returns the fix; one that leaves the statement out if, changed, it would repeat another party."""
        for party in self.parties:
            span = party.stated.span
            if party.stated.node is None or not span.overlaps(found.dial.place):
                continue
            behind_it = len(span.source.text) - span.end
            text = self.trials.edited(found.fix.edits).text
            said = text[span.start : len(text) - behind_it]
            if any(said == other.stated.span.text for other in self.parties):
                fix = left_out(party.stated)
                if fix is not None and self.trials.mends(fix.edits, self.failure):
                    return fix
        return found.fix

    def _dearness(self, found: Remedy) -> tuple[int, bool, bool, float, int]:
        """Returns the sort key of remedies, cheapest first: before all, numbers in other failures, too."""
        shared = self._shares(found.dial.place)
        others = [d for parties in self.turns.values() for d in self._dials(parties[0])]
        size = abs(found.dial.value)
        twins = [d for d in others if abs(d.value) == size and d.place != found.dial.place]
        breaks = not found.dial.is_exact and bool(twins)
        share = dear(found.dial, found.share, found.plain)
        return -shared, found.counts, breaks, round(share, 4), -found.dial.place.start

    def _is_like(self, found: Remedy, cheaper: Remedy) -> bool:
        *kind, share, _ = self._dearness(found)
        *least, lesser, _ = self._dearness(cheaper)
        return kind == least and share <= _LIKE * lesser

    def _shares(self, place: Span) -> int:
        """Returns the number of other failures in which the statement at a place takes part."""
        return sum(any(span.overlaps(place) for span in spans) for spans in self._others)

    @cached_property
    def _others(self) -> list[set[Span]]:
        others = [f for f in self.solution.failures if f is not self.failure]
        return [{c.span for c in self.lowered.stated_at(f.conflict)} for f in others]

    @cached_property
    def _chief(self) -> _StatedMember:
        """The party that the message is about: that which the fix changes, else the last with a remedy."""
        if not self.is_proven:
            return max(self.parties, key=lambda party: (party.member.off, party.stated.span.start))
        places = [edit.span for edit in self._fix.edits] if self._fix else []
        return max(
            self.parties,
            key=lambda party: (
                any(map(party.stated.span.overlaps, places)),
                self._remedy_of(party) is not None,
                party.stated.span.start,
            ),
        )

    # -- words

    def _headline(self) -> tuple[str, str]:
        failure = self.failure
        names = listed([_name(parties) for parties in self.turns.values()], NAMED)
        names = names or listed([unknown.description for unknown in self.sizes], NAMED)
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

    def _claim(self, chief: _StatedMember) -> str:
        """Returns the label of the party that the message is about: what would fit, or what is wrong."""
        if (would_fit := self._would_fit(chief)) != "":
            return would_fit
        off = chief.member.off
        if not math.isfinite(off):
            return "this has no value where the solver stopped"
        if not self.is_proven:
            is_met = self.solution.satisfied[chief.member.index]
            told = f"off by {measured_in(off, chief.stated)}" if off > _ROUNDED else "holds but for rounding"
            return "" if is_met else f"{told} where the search left it"
        return ("", "", "conflicts with the other", "conflicts with the others")[min(len(self.parties), 3)]

    def _would_fit(self, party: _StatedMember) -> str:
        if (found := self._remedy_of(party)) is None:
            return ""
        assert party.stated.node is not None
        times = self.times[party.stated.span]
        told = found.would_fit(len(written_numbers(party.stated.node)))
        return f"{told}, all {times} times" if times > 1 else told

    def _labels(self, chief: _StatedMember) -> Iterator[Label]:
        """Yields labels at the other places, each once; of too many those at which something would fit."""
        text = "conflicts with this" if self.is_proven else "takes part"
        spans = [span for span in self.turns if span != chief.stated.span]
        fitting = {span: self._would_fit(self.turns[span][0]) for span in spans}
        for span in sorted(spans, key=lambda span: not fitting[span])[:_SHOWN]:
            yield Label(span, "; ".join(filter(None, (text, fitting[span]))))

    def _givens(self) -> Iterator[Label]:
        for found in self._remedies:
            if found.dial.is_exact:
                yield Label(found.dial.place, f"exact; {found.would_fit()}")
        edits = [Edit(place, "") for place in self._rigid()]
        if edits and self.trials.can_edit(edits) and self.trials.holds(edits, self.failure):
            yield from (Label(edit.span, "nothing in it moves against it") for edit in edits)

    def _rigid(self) -> dict[Span, None]:
        """Returns the places where parts that the parties speak of are said to be `@rigid`."""
        comparisons = [c for party in self.parties for c in party.stated.comparisons]
        spoken = (s for c in comparisons for s in (*c.boxes, *(u.owner for u in unknowns([c.left, c.right]))))
        spans = {s.span: None for each in spoken for s in chain(each) if "rigid" in s.attributes and s.span}
        found = [(span, re.search(r"@rigid\b(\s*\([^)]*\))?", span.text)) for span in spans]
        return {Span(s.source, s.start + m.start(), s.start + m.end()): None for s, m in found if m}

    def _hints(self) -> Iterator[str]:
        if (hidden := len(self.turns) - 1 - _SHOWN) > 0:
            yield f"{hidden} more take part, which are not shown"
        for flat in (r.flat_at for r in self._remedies if r.flat_at and r.fix is self._fix):
            yield f"at `{flat}` all would lie flat, with no room to turn: the fix goes a little further"
        if self.failure.conflict in self.trials.cut_short:
            told = "other numbers were" if self._remedies else "what would fit was"
            yield f"{told} not sought to the end, for want of time"
        gaps = dict(self.failure.gaps)
        parties = sorted(self.parties, key=lambda party: party is not self._chief)
        apart = (_apart(p, gaps[p.member.index]) for p in parties if p.member.index in gaps)
        yield from next(filter(None, apart), ())
        match self.failure.reason:
            case Failure.OVERDETERMINED:
                held = dict.fromkeys(f"`{name}`" for each in self._wordings for name in each.held())
                if held:
                    unknowns = self.lowered.unknowns
                    moving = listed([unknowns[i].description for i in self.failure.moving], NAMED)
                    yield f"{listed(held, NAMED)} cannot move, only {moving}: a `guess(…)` frees a number"
            case Failure.NOT_CONVERGED:
                yield "the search starts from what is written: first guesses near to what is meant help it"
            case Failure.TIMED_OUT:
                yield "what concerns one part only is solved faster if that part states it"


def _apart(party: _StatedMember, gap: float) -> tuple[str, ...]:
    """Returns hints on the difference of the sides of `a == b` where the other parties hold; else none."""
    node, stated = party.stated.node, party.stated
    if not isinstance(node, ast.Comparison) or node.operators != ("==",) or len(stated.comparisons) != 1:
        return ()
    (comparison,) = stated.comparisons
    values = [stated.wording and stated.wording.value(operand) for operand in node.operands]
    sides = [value.value if isinstance(value, Num) else None for value in values]
    written = [comparison.left.value, comparison.right.value]  # how it is lowered may have turned them round
    if comparison.dimension == ANGLE or sides != written or written[0] == written[1]:
        return ()
    left, right = (operand.span.one_line for operand in node.operands)
    more = "more" if gap > 0.0 else "less"
    if near := rounding(written[1] + gap, written[1]):
        return near
    return (f"given the others, `{left}` is {short(abs(gap))} {more} than `{right}`",)


def _name(parties: Sequence[_StatedMember]) -> str:
    first, label = f"`{shortened(parties[0].stated.text, _QUOTED)}`", parties[0].stated.label
    if len(parties) > 1:
        return f"{first} ({len(parties)} times)"
    return f"{first} [{label}]" if label else first


def measured_in(value: float, stated: Constraint) -> str:
    """Returns a value with its unit, if all that a constraint compares has the same unit."""
    dimensions = {comparison.dimension for comparison in stated.comparisons}
    unit = " mm" if dimensions <= {LENGTH, None} else "°" if dimensions == {ANGLE} else ""
    return f"{short(value)}{unit}"


# --- Ambiguous calls of programs that do not solve as their first guesses have them, read differently; and
# programs that solve from another place only.
#
# Which angle between two lines is meant, and on which side a circle touches, is read off the first guesses.
# Before anything is refused, and before a size changes much, the calls that take part are tried the other
# ways.

_MOST = 64  # the most ways that are tried
_RANKS = (1, 2, 3)  # ranks by distance of the readings that are tried, after the nearest
_SECONDS, _LONGEST = 4.0, 0.2  # time after which no other way is begun, and for one: what solves does so soon
_MUCH = 0.1  # relative change of a size above which other readings are tried
_STILL = 1e-6
_DIGITS = (2, 3, 6)
_LOOK = "look whether this is how it is meant"


@record()
class Rereading:
    """A program that solved with ambiguous calls read differently; `calls` are their places and readings."""

    built: Interpretation
    solution: Solved
    calls: tuple[tuple[Span, str], ...]


def reread(
    built: Interpretation,
    solution: Solved,
    again: Callable[[Mapping[int, int]], Interpretation | None],
    settings: Settings,
) -> tuple[Rereading | None, Solved]:
    """Returns the program with ambiguous calls read so that it solves and nothing dear gives way (None if it
    does so as it is, or no such reading was found), and the solution as it is: a conflict of such calls is no
    contradiction in it unless every reading was tried.
    """
    readings = list(built.model.readings)
    troubled = _troubled(solution) if readings and settings.explain else ()
    if not troubled:
        return None, solution
    clock, seen = Clock(_SECONDS), [readings]
    quick = replace(settings, explain=False, seconds=min(settings.seconds, _LONGEST))
    near = _numbers(readings, solution, troubled)
    far = _numbers(readings, solution, {i for failure in solution.failures for i in failure.within})
    for turned in _ways([*near, *(n for n in far if n not in near)]):
        if clock.expired or len(seen) > _MOST:
            return None, _undecided(solution, readings)
        other = again(turned)
        if other is None or (taken := list(other.model.readings)) in seen:
            continue
        seen.append(taken)
        made = lower(other.model)
        places = ((f.conflict, dict(f.nearest)) for f in solution.failures)  # by number, the same as before
        if any(nearby_solution(made, quick, *place) is None for place in places):
            continue  # which is known sooner than by solving
        found = solve(made, quick)
        if found.status is Status.SOLVED and not any(stage.concession for stage in found.stages):
            calls = tuple(taken[n] for n in turned if n < len(taken))
            return Rereading(other, found, calls), solution
    return None, solution


def _numbers(readings: Sequence[tuple[Span, str]], solution: Solved, indices: Iterable[int]) -> list[int]:
    spans = {c.span for c in solution.problem.stated_at(indices)}
    return [n for n, (span, _) in enumerate(readings) if any(map(span.overlaps, spans))]


def _ways(numbers: Sequence[int]) -> Iterator[dict[int, int]]:
    """Yields changes of readings, as ranks by number: of one reading, of two, and so on."""
    for count in range(1, len(numbers) + 1):
        for chosen in itertools.combinations(numbers, count):
            for ranks in itertools.product(_RANKS, repeat=count):
                yield dict(zip(chosen, ranks, strict=True))


def _undecided(solution: Solved, readings: Sequence[tuple[Span, str]]) -> Solved:
    """Returns the solution with failures that ambiguous calls have a share in no longer counted as proven."""
    failures = tuple(
        replace(f, reason=Failure.NOT_CONVERGED) if _numbers(readings, solution, f.conflict) else f
        for f in solution.failures
    )
    return replace(solution, failures=failures)


def _troubled(solution: Solved) -> Collection[int]:
    """Returns the constraints that take part in a failure, or that made a size change much."""
    problem, found = solution.problem, {i for failure in solution.failures for i in failure.conflict}
    for stage in solution.stages:
        for unknown in stage.concession.unknowns if stage.concession is not None else ():
            was, now = problem.initial[unknown], solution.values[unknown]
            if problem.kept[unknown] and abs(now - was) > _MUCH * abs(was):
                assert stage.concession is not None
                found.update(stage.concession.constraints)
    return found


def elsewhere_notes(model: Model, other: Rereading | None, trials: Trials) -> Iterator[Diagnostic]:
    """Yields notes, with fitting first guesses, on calls read differently and on places found far off."""
    solution = trials.solution
    if solution.status is not Status.SOLVED:
        return
    if other is not None:
        spans = [span for span, _ in other.calls]
        moved = [c for c in solution.problem.stated if c is not None and any(map(c.span.overlaps, spans))]
        names = listed(ticked(span.one_line for span in spans), NAMED)
        are = "are" if len(spans) > 1 else "is"
        message = f"{names} {are} not taken as the first guesses have it, for which no position was found"
        (first, label), *others = other.calls
        labels = tuple(Label(span, text) for span, text in others)
        fix = _guesses(model, moved, trials)
        yield Diagnostic("N0604", message, first, label, labels, (_LOOK,), fix)
    for stage in solution.stages:
        if despite := solution.problem.stated_at(stage.despite):
            names = named((c.text for c in despite), NAMED)
            hold = "hold" if len(despite) > 1 else "holds"
            first, *rest = dict.fromkeys(c.span for c in despite)
            message = f"near the first guesses no position was found in which {names} {hold}; another one was"
            labels = tuple(Label(span, "takes part") for span in rest)
            fix = _guesses(model, despite, trials)
            yield Diagnostic("N0604", message, first, "holds elsewhere", labels, (_LOOK,), fix)


def _guesses(model: Model, stated: Sequence[Constraint], trials: Trials) -> Fix | None:
    """Returns a fix that writes first guesses from which the program solves as written; or None."""
    lowered = trials.solution.problem
    places, was = map(lowered.by_unknown, (trials.solution.values, lowered.initial))
    mentioned = set(unknowns(e for c in stated for part in c.comparisons for e in (part.left, part.right)))
    everything = {u for u in places if abs(places[u] - was[u]) > _STILL}
    evaluate = Evaluator(places)
    for moved, digits in itertools.product((everything & mentioned, everything), _DIGITS):
        edits: dict[Span, set[str]] = {}
        for literal in model.literals:
            if isinstance(literal.became.payload, Unknown) and literal.became.payload in moved:
                text = _text(literal.node, evaluate(literal.became), digits)
                edits.setdefault(literal.node.span, set()).add(text)
        written = tuple(Edit(span, text) for span, (text, *more) in edits.items() if not more)
        if written and trials.settles(written):
            return Fix("write first guesses that are near to it", written)
    return None


def _text(node: ast.Expression, value: float, digits: int) -> str:
    number = node.operand if isinstance(node, ast.Unary) else node
    unit = number.unit if isinstance(number, ast.Number) and number.unit else ""
    return f"{short(float(f'{value / (UNITS[unit][0] if unit else 1.0):.{digits}g}'))}{unit}"

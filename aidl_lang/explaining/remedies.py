"""Numbers that would make constraints hold which conflict, and the edits that write them."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from aidl_lang.building.lower import Solved
from aidl_lang.building.model import Constraint
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.prose import short
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.explaining.trials import Dial, Trials, exact_numbers, mends, written_numbers
from aidl_lang.solver.problem import Failure, GroupFailure, Member

# --- Numbers that would make constraints hold which conflict, and the edits that write them.
#
# A number of the text is turned a little and the program built again; from how much nearer that brings the
# constraints follows where the number would have to be. It is told only if the program, with just what is
# printed in its place, then solves and nothing gives way.

_NUDGE = 1e-3  # relative change of a number by which its influence is measured
_ABREAST = 6  # number of searches that are compared by the change they would need before they start
_FIXED = 2.0  # factor by which a change of a `fixed` number costs more than the same change of another
_LONG = 2.0  # factor by which a number of many digits costs more
_STEPS = 4  # the most times that the place of a number is sought anew if its influence is not linear
_NOTHING = 1e-9  # relative change of the violation that counts as none
_VANISHES = 1e-4  # relative distance from 0 below which a number is 0
_ARRIVED = 1e-7  # part of the violation that is left by rounding at a number that fits
_FAR = 20.0  # factor of the number's size beyond which no author means another one
_NEAR, _MEANT = 1e-9, 4
"""Relative distance to a shorter number at which that one is meant, and the most decimals of such a one."""
_COARSE = 1e-2  # part of a change that may be added to make a number short, if there is a range
_FURTHER = 0.25  # part of a change that is added to try whether numbers beyond fit as well
_SHARP = 0.03  # part of a change by which a number before the end of a range must fail to fit
_BEYOND = (1.0, 2.0, 4.0, 8.0)  # parts of a change that are added in search of the other end of a range
_INWARD, _INWARD_SHARE = 0.125, 0.02
"""Parts of a change and of a number by which a number lies within a range at whose end all lies flat."""
_LITTLE = 0.02  # part of a number that is tried in place of 0
_DIVISORS = range(2, 65)
_DIGITS = (6, 9, 12)
_SHORT, _PLAIN, _ROUGH = 2, 3, 5
"""Digits of an end that is hardly met by chance, of a number that is easily written, and of one that is worth
mentioning where any point would do.
"""
_WHOLE = (-1.0, 1.0, -2.0, 2.0)  # changes that are tried of a number that must be whole


@record()
class Remedy:
    """
    dial   the number to change
    value  its new value
    fix    the edit that writes it
    shown  the values that fit, in words: `exactly 76 / 3 (about 25.33)`, `at most 50`, `10 to 70`
    share  the relative change
    plain  whether it is a number of few digits
    counts whether it is a number of things
    flat_at the end of the range at which all lies flat, if there is one; the fix goes further
    """

    dial: Dial
    value: float
    fix: Fix
    shown: str
    share: float
    plain: bool
    counts: bool = False
    flat_at: str = ""

    def would_fit(self, numbers: int = 1) -> str:
        """Returns the words of a message; they name the number if its place has several `numbers`."""
        instead = f" instead of `{self.dial.place.text}`" if numbers > 1 else ""
        return f"{self.shown}{instead} would fit"


def dear(dial: Dial, share: float, plain: bool) -> float:
    """Returns the cost of changing a number by a `share` of itself; `plain` if the new one has few digits."""
    return share * (_FIXED if dial.is_exact and not dial.name else 1.0) * (1.0 if plain else _LONG)


def remedies(searches: Iterable[RemedySearch]) -> Iterator[Remedy]:
    """Yields remedies, at most one for each place; none for searches that find no number, or for which there
    is no time, which is noted with the trials. A first remedy of few digits ends what is sought late. Of each
    few searches, those start first that would change least.
    """
    found, is_enough = set[Span](), False
    waiting = iter(searches)
    for first in waiting:
        if first.is_late:
            first.trials.cut_short.add(first.failure.conflict)
            return
        few = [first, *itertools.islice(waiting, _ABREAST - 1)]
        for search in sorted(few, key=lambda search: search.reach):
            if is_enough and search.is_late:
                return
            if search.place not in found and (remedy := search.remedy()) is not None:
                found.add(search.place)
                is_enough = is_enough or remedy.plain
                yield remedy


@record()
class _Written:
    """A number with the text to write and the text to show."""

    value: float
    text: str
    shown: str


class RemedySearch:
    """A search for a number that would fit in place of another. `member` is the one member of the failure
    that contains it, if only one does. One remedy is enough for all numbers at a `place`.
    """

    def __init__(
        self, dial: Dial, failure: GroupFailure, trials: Trials, place: Span, member: int | None = None
    ) -> None:
        self.dial, self.failure, self.trials, self.place = dial, failure, trials, place
        self._member = member if failure.is_curved else None

    @property
    def is_late(self) -> bool:
        """True if the time to begin the search is over."""
        return self.trials.is_late(self.failure)

    @cached_property
    def reach(self) -> float:
        """The relative change of the number that its influence predicts, times its cost; or infinite."""
        value = self.dial.value
        if self.is_late:
            return np.inf
        target = self._pinned_target if self._member is not None else None
        target = self._even_target if target is None else target
        if target is None:
            return np.inf
        plain = _is_plain(float(f"{target:.{_DIGITS[0]}g}"), _PLAIN)
        return dear(self.dial, abs(target - value) / max(abs(value), 1.0), plain)

    def remedy(self) -> Remedy | None:
        if (opposite := self.turned()) is not None:
            return opposite
        if (pinned := self._pinned()) is None:
            return self._found()
        value = self.dial.value
        change = pinned.value - value
        is_range = any(self._lack(value + part * change) == 0.0 for part in (0.5, 1.0 + _FURTHER))
        return (self._found() if is_range else None) or self._remedy(pinned, pinned.shown)

    def turned(self) -> Remedy | None:
        """Returns the remedy that drops the sign of a negative number; None if that does not fit."""
        opposite = self._plain(-self.dial.value)
        fits = self.dial.value < 0.0 and self._fits(opposite)
        return self._remedy(opposite, opposite.shown) if fits else None

    def _found(self) -> Remedy | None:
        return self._whole() if self._even_target is None else self._near(self._even_target)

    @cached_property
    def _even_target(self) -> float | None:
        """The value at which the violation would vanish if it fell linearly with it; None if unknown."""
        value = self.dial.value
        if not (off := self._lack(value)):
            return None
        for step in (self._step, -self._step):
            if (nudged := self._lack(value + step)) is None:
                return None
            if abs(nudged - off) > _NOTHING * off:
                return value - off * step / (nudged - off)
        return None

    @cached_property
    def _pinned_target(self) -> float | None:
        """The value at which the member holds where the other members hold; None if unknown."""
        value, step = self.dial.value, self._step
        now, nudged = self._residual(value), self._residual(value + step)
        if not now or nudged is None or nudged == now:
            return None
        return value - now * step / (nudged - now)

    @property
    def _step(self) -> float:
        return _NUDGE * max(abs(self.dial.value), 1.0)

    def _pinned(self) -> _Written | None:
        if self._member is None or self._pinned_target is None:
            return None
        target = self._rounded(self._pinned_target)
        return self._fitting(self._spelled(target, 0.0)) if self._may_be(target) else None

    def _rounded(self, target: float) -> float:
        return 0.0 if abs(target) <= _VANISHES * max(abs(self.dial.value), 1.0) else target

    def _may_be(self, target: float) -> bool:
        value = self.dial.value
        return self.dial.may_be(target) and abs(target - value) <= _FAR * max(abs(value), 10.0)

    def _near(self, target: float) -> Remedy | None:
        """Returns the remedy at about a target, corrected by secant steps; None if no number there fits."""
        value = self.dial.value
        if not (off := self._lack(value)):
            return None
        before, target = (value, off), self._rounded(target)
        for _ in range(_STEPS):
            if self.trials.is_over or not self._may_be(target) or abs(target - value) <= self._step:
                return None
            change = target - value
            if (now := self._lack(target)) is None:
                return None
            if now <= _ARRIVED * off:
                is_end = self._lack(value + (1.0 + _FURTHER) * change) == 0.0
                written = self._fitting(self._spelled(target, change if is_end else 0.0))
                if written is None:
                    return None
                if not is_end:
                    return self._remedy(written, written.shown)
                return self._range(written, target, change)
            if now >= before[1]:
                return None
            slope = (now - before[1]) / (target - before[0])
            before, target = (target, now), target - now / slope
        return None

    def _whole(self) -> Remedy | None:
        """Returns the remedy for a number that cannot be changed a little, as one that counts things."""
        value = self.dial.value
        if value != round(value) or self.dial.unit or self._lack(value + self._step) is not None:
            return None
        for change in _WHOLE:
            written = self._plain(value + change)
            if value + change > 0.0 and self._fits(written):
                return replace(self._remedy(written, written.shown), counts=True)
        return None

    # -- remedies in words

    def _range(self, end: _Written, target: float, change: float) -> Remedy:
        """Returns the remedy for numbers that fit from an `end` onward, which was sought at a `target`."""
        if self.failure.is_curved and not _is_plain(end.value, _SHORT):
            end = self._end_between(end.value - _SHARP * change, end.value) or end
        end = self._ending(end, target, change)
        further = self._plain(_neat(end.value, change, _FURTHER * abs(change)))
        if not self._is_sharp(end, change) or not self._fits(further):
            return self._remedy(end, end.shown)
        offered, flat = (self._inner(end, change), end.text) if self.failure.is_curved else (None, "")
        if (other := self._other_end(end, change)) is end:
            shown = end.shown
        elif other is not None:
            least, most = sorted((end, other), key=lambda each: each.value)
            shown = f"{least.shown} to {most.shown}"
        else:
            shown = f"{'at least' if change > 0.0 else 'at most'} {end.shown}"
        return replace(self._remedy(offered or end, shown), flat_at=flat if offered else "")

    def _inner(self, end: _Written, change: float) -> _Written | None:
        """Returns a number a little within a range at whose `end` all lies flat, as a triangle without height
        so that nothing could turn; None at any other end.
        """
        inward = math.copysign(max(_INWARD * abs(change), _INWARD_SHARE * abs(end.value)), change)
        inner = self._plain(_neat(end.value + inward, change, abs(inward)))
        both = self._edits(end.text), self._edits(inner.text)
        return inner if self.trials.lies_flat(*both, self.failure) and self._fits(inner) else None

    def _other_end(self, end: _Written, change: float) -> _Written | None:
        """Returns the other end of what fits; `end` if none was found, None if all that may be meant fits."""
        inside = end.value
        for part in _BEYOND:
            outside = end.value + part * change
            if end.value > 0.0 >= outside:  # what turns round is another matter
                outside = _LITTLE * end.value
            if self._lack(outside):
                return self._end_between(outside, inside) or end
            inside = outside
        return None

    def _end_between(self, outside: float, inside: float) -> _Written | None:
        """Returns the end of the numbers that fit `inside`, sought from a number `outside` that does not."""
        found, step = None, _NUDGE * (inside - outside)
        for _ in range(_STEPS):
            off, nudged = self._lack(outside), self._lack(outside + step)
            if not off or nudged is None or nudged >= off:
                break
            # If a nudge is all that lacks, it is the end but for rounding, or lies before that.
            onward = -off * step / (nudged - off) if nudged else 0.0
            found = outside + onward
            if abs(onward) <= abs(step):
                break
            outside = found - _SHARP * onward
        if found is None:
            return None
        written = self._fitting(self._spelled(found, inside - found))
        written = written and self._ending(written, found, step)
        return written if written and self._is_sharp(written, step) else None

    def _ending(self, written: _Written, target: float, onward: float) -> _Written:
        """Returns the short number at a `target`, found going `onward`, if it is an end; else `written`."""
        limits = (self._plain(round(target, digits)) for digits in range(_PLAIN))
        near = 0.1 * _NUDGE * max(abs(target), 1.0)
        limit = next((limit for limit in limits if abs(limit.value - target) <= near), written)
        beyond = limit.value - math.copysign(10.0 * near, onward)
        return limit if limit is not written and self._lack(beyond) and self._fits(limit) else written

    def _is_sharp(self, end: _Written, onward: float) -> bool:
        """Tells whether a number a little before an end, seen in the direction `onward`, does not fit."""
        aside = max(_SHARP * abs(onward), _NUDGE * abs(end.value))
        return bool(self._lack(end.value - math.copysign(aside, onward)))

    def _remedy(self, written: _Written, shown: str) -> Remedy:
        dial = self.dial
        title = f"make `{dial.name}` {written.text}" if dial.name else f"write `{written.text}`"
        share = abs(written.value - dial.value) / max(abs(dial.value), abs(written.value))
        plain = _is_plain(written.value, _PLAIN)
        return Remedy(dial, written.value, Fix(title, self._edits(written.text)), shown, share, plain)

    # -- trying

    def _edits(self, text: str) -> tuple[Edit, ...]:
        return (Edit(self.dial.place, text),)

    def _at(self, value: float) -> tuple[Edit, ...]:
        """Returns the edits that set the number to a value, with all its digits."""
        return self._edits(f"{value + 0.0:.15g}{self.dial.unit}")

    def _lack(self, value: float) -> float | None:
        return self.trials.lack(self._at(value), self.failure)

    def _fitting(self, spelled: Iterable[_Written]) -> _Written | None:
        """Returns the first spelling of a number that fits; no other if digits are not the reason."""
        for written in spelled:
            if self._fits(written):
                return written
            if not self.dial.is_rough and self._lack(written.value) == 0.0:
                return None
        return None

    def _residual(self, value: float) -> float | None:
        assert self._member is not None
        return self.trials.residual(self._at(value), self.failure, self._member)

    def _fits(self, written: _Written) -> bool:
        if self.dial.is_rough and not _is_plain(written.value, _ROUGH):
            return False
        return self.dial.may_be(written.value) and self.trials.mends(self._edits(written.text), self.failure)

    # -- digits

    def _spelled(self, target: float, onward: float) -> Iterator[_Written]:
        """Yields spellings, the shortest first; with `onward` those a little further in that direction."""
        for digits in range(_MEANT + 1):
            if abs(round(target, digits) - target) <= _NEAR * max(1.0, abs(target)):
                yield self._plain(round(target, digits) + 0.0)
                break
        if onward:
            yield self._plain(_neat(target, onward, _COARSE * abs(target - self.dial.value)))
        else:
            yield from self._fraction(target)
        for digits in _DIGITS:
            yield self._plain(float(f"{target:.{digits}g}"))

    def _fraction(self, target: float) -> Iterator[_Written]:
        for divisor in _DIVISORS:
            whole = round(target * divisor, 2)
            if abs(whole / divisor - target) <= _NEAR * max(1.0, abs(target)):
                text = f"{short(whole)}{self.dial.unit} / {divisor}"
                about = f"{target:.4g}{self.dial.unit}"
                written = f"({text})" if self.dial.is_factor else text
                yield _Written(target, written, f"exactly {text} (about {about})")
                return

    def _plain(self, value: float) -> _Written:
        text = f"{value + 0.0:.13g}{self.dial.unit}"
        return _Written(value, text, text)


def _is_plain(value: float, digits: int) -> bool:
    return value == float(f"{value:.{digits}g}")


def _neat(target: float, onward: float, slack: float) -> float:
    """Returns a short number at `target` or, by no more than `slack`, onward from it."""
    for digits in range(8):
        step = 10.0**-digits
        rounded = round((math.floor if onward < 0.0 else math.ceil)(target / step) * step, digits)
        if abs(rounded - target) <= slack:
            return rounded
    return target


_ALLOWING = re.compile(r"@allow\([^()]*\)(\s|//[^\n]*\n|@allow\([^()]*\))*(constrain\s*)?\Z", re.IGNORECASE)
"""`@allow(…)` right before what a constraint states, and all between them."""


def left_out(constraint: Constraint) -> Fix | None:
    """Removes a statement that stands alone on a line or between semicolons, with `@allow(…)` said of it."""
    span, text = constraint.span, constraint.span.source.text
    if (allowing := _ALLOWING.search(text, 0, span.start)) is not None:
        span = replace(span, start=allowing.start())
    line = text.rfind("\n", 0, span.start) + 1
    end = text.find("\n", span.end) + 1 or len(text)
    before, after = text[line : span.start], text[span.end : end]
    if before.strip() in ("", "constrain") and not after.strip():
        where = Span(span.source, line, end)
    elif before.rstrip().endswith(";"):
        where = Span(span.source, line + len(before.rstrip()) - 1, span.end)
    elif after.lstrip().startswith(";") and not before.rstrip().endswith("constrain"):
        where = Span(span.source, span.start, span.end + after.index(";") + 1)
    else:
        return None
    return Fix("leave it out", (Edit(where, ""),))


def wished(constraint: Constraint) -> Fix:
    """Makes a statement a preference."""
    span = constraint.span
    before = span.source.text[: span.start].rstrip(" ")
    if before.endswith("constrain"):
        return Fix("make it a wish", (Edit(Span(span.source, len(before) - 9, len(before)), "prefer"),))
    return Fix("make it a wish", (Edit(replace(span, end=span.start), "prefer "),))


# --- Numbers that would fit where a condition over constants does not hold (E0513, E0604).
#
# Such a condition is put to the solver like any other, as a conflict of one statement; what is told of
# conflicts, numbers that were tried as they are printed, can then be told of it.

NEVER, _ASSERTED = "E0513", "E0604"
_CODES = frozenset({NEVER, _ASSERTED})
_MOST = 0.5  # greatest relative change of a number that is offered as a fix: a greater one is mentioned only
_PLACES = 5  # the most places that a message shows beside its own


def with_failing_constants(solution: Solved) -> Solved:
    """Returns the solution of a problem that states constants, each that does not hold being a failure."""
    found = []
    for index, stated in enumerate(solution.problem.stated):
        sides = (side for part in stated.comparisons for side in (part.left, part.right)) if stated else ()
        if stated and not solution.satisfied[index] and all(side.is_constant for side in sides):
            group, member = int(solution.problem.holder[index]), Member(index, solution.residuals[index])
            found.append(GroupFailure(group, Failure.CONTRADICTORY, (member,), minimal=True, within=(index,)))
    return replace(solution, failures=tuple(found))


def with_remedies(
    found: Sequence[Diagnostic], everything: Sequence[Diagnostic], trials: Trials
) -> list[Diagnostic]:
    """Returns findings about a program, those on constants with what would fit instead; `everything` are all
    findings about it. The trials are those of the program that states constants, with the solution made by
    `with_failing_constants`.
    """
    failures: dict[Span, tuple[Constraint, GroupFailure]] = {}
    for failure in trials.solution.failures:
        if (stated := trials.solution.problem.stated[failure.conflict[0]]) is not None:
            failures.setdefault(stated.span, (stated, failure))
    return [
        _answered(d, *failures[d.span], everything, trials)
        if d.code in _CODES and d.fix is None and d.span in failures
        else d
        for d in found
    ]


def _answered(
    d: Diagnostic, stated: Constraint, failure: GroupFailure, everything: Sequence[Diagnostic], trials: Trials
) -> Diagnostic:
    """Returns a finding with numbers that fit where its values are given, and the least change of these as
    the fix. If there are none, names a number that fits in a constraint; an `assert` is not up for change.
    """
    if (wording := stated.wording) is None or (node := stated.node) is None:
        return d

    def fitting(dials: Sequence[Dial]) -> Iterator[Remedy]:
        searches = (RemedySearch(dial, failure, trials, dial.place) for dial in dials if not dial.is_factor)
        return (each for each in remedies(searches) if mends(d, each.fix, everything, trials))

    uses = wording.it.program.resolution.uses
    given = sorted(fitting(exact_numbers([node], uses)), key=lambda each: (each.counts, each.share))
    if given:
        labels = d.secondary
        for each in given:
            labels = _with(labels, each)
        fix = given[0].fix if given[0].share <= _MOST else None
        return replace(d, secondary=labels[:_PLACES], fix=fix)
    dials = written_numbers(node) if d.code == NEVER else []
    if (own := next(fitting(dials), None)) is None:
        return d
    return replace(d, label="; ".join(filter(None, (d.label, own.would_fit(len(dials))))))


def _with(labels: tuple[Label, ...], found: Remedy) -> tuple[Label, ...]:
    """Returns the labels, with what would fit in place of a number added to one of them or as a new one."""
    place, text = found.dial.place, found.would_fit()
    for index, label in enumerate(labels):
        if found.dial.name and label.span.overlaps(place):
            return *labels[:index], replace(label, text=f"{label.text}; {text}"), *labels[index + 1 :]
    return *labels, Label(place, f"exact; {text}")

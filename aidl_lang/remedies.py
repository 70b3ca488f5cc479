"""What else a number would have to be for constraints that conflict to hold, and the edits that say so.

A number of the text is turned a little and the program built again; from how much nearer that brings the
constraints follows where the number would have to be. It is told only if the program, with just what is
printed in its place, then solves and nothing gives way.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from aidl_lang.diagnostics import Edit, Fix
from aidl_lang.givens import Dial
from aidl_lang.model import Constraint
from aidl_lang.solver.solution import GroupFailure
from aidl_lang.source import Span
from aidl_lang.trials import Trials

_NUDGE = 1e-3
"""How far a number is turned to see what it does, as a share of itself."""
_STEPS = 4
"""Times that the place of a number is sought anew where what it does is not even."""
_NOTHING = 1e-9
"""A change of what is lacking, relatively, that is none."""
_VANISHES = 1e-4
"""A number so near to nothing, relatively, is 0."""
_ARRIVED = 1e-7
"""Part of what is lacking that is left by rounding where a number fits."""
_FAR = 20.0
"""A number so many times as large is not what anyone means."""
_NEAR, _MEANT = 1e-9, 4
"""How near, relatively, a number lies to a shorter one that is meant, and the decimals of such a one."""
_COARSE = 1e-2
"""Part of a change that may be added to make a number short, where there is a choice."""
_FURTHER = 0.25
"""Part of a change at which it is tried whether more of it would do as well."""
_BEYOND = (1.0, 8.0)
"""Parts of a change at which it is tried whether there is an end to that."""
_LITTLE = 0.02
"""Part of a number at which it is tried in the place of nothing."""
_DIVISORS = range(2, 65)
_DIGITS = (6, 9, 12)
_PLAIN, _ROUGH = 3, 5
"""Digits of a number that is easily written, and of one that is worth telling where any point would do."""
_WHOLE = (-1.0, 1.0, -2.0, 2.0)
"""Changes that are tried of a number that must be whole."""


@dataclass(frozen=True)
class Remedy:
    """
    dial   the number that would have to be another one
    value  what it would have to be
    fix    writes that
    shown  that it would fit, as it is told: `exactly 76 / 3 (about 25.33)`, `at most 50`, `10 to 70`
    share  by how much it changes, relative to what it is
    plain  whether it is a number of few digits
    counts whether it is a number of things
    """

    dial: Dial
    value: float
    fix: Fix
    shown: str
    share: float
    plain: bool
    counts: bool = False


def short(value: float) -> str:
    """A number to six digits."""
    return f"{round(value, 6) + 0.0:.6g}"


def remedy(dial: Dial, failure: GroupFailure, trials: Trials, member: int | None = None) -> Remedy | None:
    """What would fit in place of a number; None if no number was found that would, or the time is spent. If
    it stands in one member of the failure alone, that is the `member`.
    """
    search = _Search(dial, failure, trials)
    if (opposite := search.turned()) is not None:
        return opposite
    pinned = search.pinned(member) if member is not None and failure.is_curved else None
    return pinned if pinned is not None and not search.fits_nearer(pinned) else search.found() or pinned


def turned(dial: Dial, failure: GroupFailure, trials: Trials) -> Remedy | None:
    """The number with the other sign, if that would fit."""
    return _Search(dial, failure, trials).turned()


@dataclass(frozen=True)
class _Written:
    """A number as it is written and as it is told."""

    value: float
    text: str
    shown: str


class _Search:
    def __init__(self, dial: Dial, failure: GroupFailure, trials: Trials) -> None:
        self.dial, self.failure, self.trials = dial, failure, trials

    def found(self) -> Remedy | None:
        value = self.dial.value
        off = self._lack(value)
        if not off:
            return None
        step = _NUDGE * max(abs(value), 1.0)
        if (nudged := self._lack(value + step)) is None:
            return self._whole()
        if abs(nudged - off) <= _NOTHING * off:
            step = -step
            nudged = self._lack(value + step)
        if nudged is None or abs(nudged - off) <= _NOTHING * off:
            return None
        return self._near(value - off * step / (nudged - off), off)

    def turned(self) -> Remedy | None:
        """A negative number without its sign."""
        opposite = self._plain(-self.dial.value)
        fits = self.dial.value < 0.0 and self._fits(opposite)
        return self._remedy(opposite, opposite.shown) if fits else None

    def fits_nearer(self, found: Remedy) -> bool:
        """Whether less of a change may do as well."""
        value = self.dial.value
        return self._lack(value + 0.5 * (found.value - value)) == 0.0

    def pinned(self, member: int) -> Remedy | None:
        """What fits where the other members hold."""

        def off(value: float) -> float | None:
            return self.trials.residual(self._at(value), self.failure, member)

        value = self.dial.value
        step = _NUDGE * max(abs(value), 1.0)
        now, nudged = off(value), off(value + step)
        if not now or nudged is None or nudged == now:
            return None
        target = value - now * step / (nudged - now)
        if abs(target) <= _VANISHES * max(abs(value), 1.0):
            target = 0.0
        if not self.dial.may_be(target) or abs(target - value) > _FAR * max(abs(value), 10.0):
            return None
        written = next(filter(self._fits, self._spelled(target, 0.0)), None)
        if written is None:
            return None
        is_end = self._lack(target + _FURTHER * (target - value)) == 0.0
        return self._told(written, target - value, is_end)

    def _near(self, target: float, off: float) -> Remedy | None:
        """What fits at about a number, or where that leads."""
        value = self.dial.value
        before = value, off
        if abs(target) <= _VANISHES * max(abs(value), 1.0):
            target = 0.0
        for _ in range(_STEPS):
            if self.trials.is_over or not abs(target - value) <= _FAR * max(abs(value), 10.0):
                return None
            if not self.dial.may_be(target) or abs(target - value) <= _NUDGE * max(abs(value), 1.0):
                return None
            change = target - value
            is_end = self._lack(value + (1.0 + _FURTHER) * change) == 0.0
            now = self._lack(target)
            if now is None:
                return None
            if now <= _ARRIVED * off:
                spelled = self._spelled(target, change if is_end else 0.0)
                written = next(filter(self._fits, spelled), None)
                return None if written is None else self._told(written, change, is_end)
            if now == before[1]:
                return None
            slope = (now - before[1]) / (target - before[0])
            before, target = (target, now), target - now / slope
        return None

    def _whole(self) -> Remedy | None:
        """What fits in place of a number that cannot be turned a little, as one that counts things."""
        value = self.dial.value
        if value != round(value) or self.dial.unit:
            return None
        for change in _WHOLE:
            written = self._plain(value + change)
            if value + change > 0.0 and self._fits(written):
                return replace(self._remedy(written, written.shown), counts=True)
        return None

    # -- what is said

    def _told(self, written: _Written, change: float, is_end: bool) -> Remedy:
        if not is_end or not self._fits(self._plain(_neat(written.value, change, _FURTHER * abs(change)))):
            return self._remedy(written, written.shown)
        if (other := self._other_end(written.value, change)) is not None:
            ends = sorted((written, other), key=lambda each: each.value)
            return self._remedy(written, f"{ends[0].shown} to {ends[1].shown}")
        choice = "at least" if change > 0.0 else "at most"
        return self._remedy(written, f"{choice} {written.shown}")

    def _other_end(self, end: float, change: float) -> _Written | None:
        """Where the numbers that fit end on the other side; None if no such end was found."""
        inside = end
        for part in _BEYOND:
            outside = end + part * change
            if end > 0.0 >= outside:  # what turns round is another matter
                outside = _LITTLE * end
            if off := self._lack(outside):
                step = _NUDGE * (inside - outside)
                nudged = self._lack(outside + step)
                if nudged is None or nudged >= off:
                    return None
                target = outside - off * step / (nudged - off)
                return next(filter(self._fits, self._spelled(target, end - target)), None)
            inside = outside
        return None

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
        """The number turned to a value, with all its digits."""
        return self._edits(f"{value + 0.0:.15g}{self.dial.unit}")

    def _lack(self, value: float) -> float | None:
        return self.trials.lack(self._at(value), self.failure)

    def _fits(self, written: _Written) -> bool:
        if self.dial.is_rough and not _is_plain(written.value, _ROUGH):
            return False
        return self.dial.may_be(written.value) and self.trials.mends(self._edits(written.text), self.failure)

    # -- digits

    def _spelled(self, target: float, onward: float) -> Iterator[_Written]:
        """Ways to write a number, the shortest first. If `onward` is not 0, what lies a little further that
        way will do as well.
        """
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
                yield _Written(
                    target, f"({text})" if self.dial.is_factor else text, f"exactly {text} (about {about})"
                )
                return

    def _plain(self, value: float) -> _Written:
        text = f"{value + 0.0:.13g}{self.dial.unit}"
        return _Written(value, text, text)


def _is_plain(value: float, digits: int) -> bool:
    return value == float(f"{value:.{digits}g}")


def _neat(target: float, onward: float, slack: float) -> float:
    """A short number at `target` or, by no more than `slack`, onward from it."""
    for digits in range(8):
        step = 10.0**-digits
        rounded = round((math.floor if onward < 0.0 else math.ceil)(target / step) * step, digits)
        if abs(rounded - target) <= slack:
            return rounded
    return target


# --- Other edits -----------------------------------------------------------------------------------


def left_out(constraint: Constraint) -> Fix | None:
    """Removes a statement that has a line for itself, or stands between semicolons."""
    span, text = constraint.span, constraint.span.source.text
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

"""Fillets and chamfers that do not fit: one finding for each fault, with the largest size that does.

A size is only named after the corners were worked out with it, as it is printed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from aidl_lang.checking.units import UNITS
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.prose import named, rough
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.finishing import Result, TooLarge, Work, finish, largest, sized
from aidl_lang.geometry.notes import at, local
from aidl_lang.geometry.solved import Finish, SolvedGeometry, SolvedStructure

Leaves = Sequence[tuple[SolvedGeometry, Piece]]


@record()
class Misfit:
    """A fault of one or several statements, and the largest size that fits in all of them."""

    statements: frozenset[Span]
    most: float
    note: Diagnostic


def misfits(
    result: Result, works: Sequence[Work], reasons: Sequence[Finish], leaves: Leaves, told: SolvedStructure
) -> Iterator[Misfit]:
    """Yields the finishes that do not fit, each fault once: failures of one statement are one, as are those
    that meet.
    """
    reason_of = {id(work): reason for work, reason in zip(works, reasons, strict=True)}
    curves = [curve for _, curve in leaves]
    for group in _groups(result.failures, reason_of):
        yield _Fault(group, curves, works, reason_of, leaves, told).misfit()


def _groups(failures: Sequence[TooLarge], reason_of: dict[int, Finish]) -> list[list[TooLarge]]:
    """Failures that have a statement in common, directly or by others."""
    groups: list[tuple[set[Span], list[TooLarge]]] = []
    for failure in failures:
        spans, found = {reason_of[id(w)].span for w in _works(failure)}, [failure]
        for known in [known for known in groups if known[0] & spans]:
            groups.remove(known)
            spans, found = spans | known[0], known[1] + found
        groups.append((spans, found))
    return [found for _, found in groups]


def _works(failure: TooLarge) -> list[Work]:
    return [failure.work] if failure.other is None else [failure.work, failure.other]


class _Fault:
    """Failures that are one fault. `own` are the works whose size is changed to find one that fits: all that
    take part if they have one size, else those of the last statement.
    """

    def __init__(
        self,
        failures: Sequence[TooLarge],
        curves: Sequence[Piece],
        works: Sequence[Work],
        reason_of: dict[int, Finish],
        leaves: Leaves,
        told: SolvedStructure,
    ) -> None:
        self.failures, self.curves, self.works = failures, curves, works
        self.reason_of, self.leaves, self.told = reason_of, leaves, told
        self.first = failures[0]
        self.reason = reason_of[id(self.first.work)]
        self.spans = frozenset(reason_of[id(w)].span for f in failures for w in _works(f))
        self.own = self._of(self.spans)
        self.is_equal = len({max(w.sizes) for w in self.own}) == 1
        if not self.is_equal:
            self.own = self._of({self.reason.span})
        self.is_cusp = any(f.work.corner.is_cusp for f in failures)

    def _of(self, spans: frozenset[Span] | set[Span]) -> list[Work]:
        return [w for w in self.works if self.reason_of[id(w)].span in spans]

    @property
    def what(self) -> str:
        return "radius" if self.reason.kind == "fillet" else "size"

    def misfit(self) -> Misfit:
        most = 0.0 if self.is_cusp else self._most()
        return Misfit(self.spans, most, self._note(most))

    def _most(self) -> float:
        """Returns the largest size, as it is printed, with which all corners of these statements work out."""
        now = max(max(w.sizes) for w in self.own)
        found = largest(self._fits, now)
        for most in (_floor(found * (1 + 1e-9)), _floor(found)):
            if most > 0 and self._fits(most):
                return most
        return 0.0

    def _fits(self, size: float) -> bool:
        own = {id(w) for w in self.own}
        turned = [sized(w, size) if id(w) in own else w for w in self.works]
        mine = {id(t) for t, w in zip(turned, self.works, strict=True) if id(w) in own}
        result = finish(self.curves, turned)
        return not any(id(w) in mine for failure in result.failures for w in _works(failure))

    def _note(self, most: float) -> Diagnostic:
        failure, f = self.first, self.reason
        message, points = self._message()
        other = self.reason_of[id(failure.other)] if failure.other is not None else f
        labels = (Label(other.span, "the other one"),) if other.span != f.span else ()
        hint = self._hint(most)
        fix = self._fix(most) if most > 0 else None
        return Diagnostic("E0518", message, f.span, "too large", labels, (hint,), fix, points)

    def _message(self) -> tuple[str, tuple[tuple[float, float], ...]]:
        failure, f = self.first, self.reason
        corner = (
            f"`{f.text}`" if f.at is not None else f"the corner at {at(failure.work.corner.at)} of `{f.text}`"
        )
        size = rough(max(failure.work.sizes))
        if failure.other is not None:
            other = self.reason_of[id(failure.other)]
            edge = local(self.told, self.leaves[failure.number][0])
            a, b = failure.other.corner.at, failure.work.corner.at
            return (
                f"the {f.kind} at {at(b)} runs into the {other.kind} at {at(a)} on `{edge}`: "
                f"{self.what} {size} is too large"
            ), (a, b)
        arms = failure.work.corner.arms
        edges = named([local(self.told, self.leaves[arm.number][0]) for arm in arms])
        if self.is_cusp:
            message = f"{corner} has no {f.kind}: {edges} meet there without an angle"
        else:
            room = rough(_floor(failure.largest * (1 + 1e-9)))
            message = (
                f"the {f.kind} of {corner} does not fit: {self.what} {size}, and {edges} have room for {room}"
            )
        return message, (failure.work.corner.at,)

    def _hint(self, most: float) -> str:
        if self.is_cusp:
            return "let them meet at an angle"
        beside = len(self.spans) > 1
        if not most > 0:
            other = "the other one" if beside else "this shape"
            return f"no {self.what} fits here beside {other}: that has to change"
        if beside and self.is_equal:
            return f"with the same {self.what} in all of them at most {rough(most)} fits"
        where = " beside the other" if beside else " at all its corners" if len(self.own) > 1 else ""
        return f"at most {rough(most)} fits{where}"

    def _fix(self, most: float) -> Fix | None:
        """Returns the size in the statements, where each has it as a number that nothing else decides."""
        edits: dict[Span, Edit] = {}
        for work in self.own:
            reason = self.reason_of[id(work)]
            literal = reason.literal()
            if literal is None or len(set(reason.sizes)) > 1:
                return None
            factor = UNITS[literal.unit][0] if literal.unit else 1.0
            if abs(literal.value * factor - max(work.sizes)) > 1e-9 * max(work.sizes):
                return None  # a copy in another size, or a size that gave way
            text = f"{most / factor:.12g}{literal.unit or ''}"
            edits[literal.span] = Edit(literal.span, text)
        texts = list(dict.fromkeys(f"`{edit.replacement}`" for edit in edits.values()))
        where = f" in all {len(edits)}" if len(edits) > 2 else " in both"
        title = f"write {' and '.join(texts)}{where if len(edits) > len(texts) else ''}"
        return Fix(title, tuple(edits.values()))


def merged_notes(found: Sequence[Misfit]) -> list[Diagnostic]:
    """Returns one note for each set of statements: that of the smallest size that fits, which fits
    everywhere.
    """
    least: dict[frozenset[Span], Misfit] = {}
    for misfit in found:
        known = least.get(misfit.statements)
        if known is None or misfit.most < known.most:
            least[misfit.statements] = misfit
    return [misfit.note for misfit in least.values()]


def _floor(value: float) -> float:
    """Returns a size rounded down to four digits, so that the printed size fits."""
    if value <= 0:
        return 0.0
    step = 10.0 ** (math.floor(math.log10(value)) - 3)
    return float(rough(math.floor(value / step) * step))

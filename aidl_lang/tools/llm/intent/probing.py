"""Tries whether losses still fit: puts each back, and compiles the program."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from enum import StrEnum

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import World
from aidl_lang.geometry.solved import ConstraintReport
from aidl_lang.pipeline import Compiled, Settings, compile
from aidl_lang.tools.discretion import Reader
from aidl_lang.tools.llm.intent.changes import Changes, Fate
from aidl_lang.tools.llm.intent.inventory import Inventory, Item, Kind
from aidl_lang.tools.llm.intent.placing import put_back

_SECONDS = 5.0
"""Seconds for solving once with something put back."""
_PATIENCE = 30.0
"""Seconds of processor time after which nothing more is tried."""
_FAILED, _TIMED_OUT = "E0604", "E0603"
_UNSOLVED = frozenset({"E0601", "E0602", "E0605"})
CONTACTS = frozenset({"W0705", "W0712", "W0736"})
"""Remarks on parts that touch nothing; whatever causes one does not fit."""


class State(StrEnum):
    """The state of a loss."""

    UNTRIED = "untried"  # the program has errors, or there was too much to try
    HOMELESS = "homeless"  # what it speaks of, or the place for it, is not there any more
    IMPLIED = "implied"  # other words say it
    FITS = "fits"
    CONFLICTS = "conflicts"
    MENDED = "mended"  # it was in a conflict, and its replacement was changed to hold


@record()
class Finding:
    """The result of trying a loss.

    parties  the statements that a loss conflicts with, as they are written
    reason   the message about the program with it, if it is no conflict of statements
    """

    state: State
    parties: tuple[str, ...] = ()
    reason: str = ""


UNTRIED = Finding(State.UNTRIED)


@record()
class Trial:
    """A program with something put back, compiled."""

    finding: Finding
    source: SourceFile
    compiled: Compiled | None = None


class Prober:
    """Tries losses in one program: at most so many times, and no more after some time. `clashed` are items
    that were in a conflict.
    """

    def __init__(
        self, name: str, world: World | None, settings: Settings, most: int, clashed: Collection[Item]
    ) -> None:
        seconds = min(settings.solving.seconds, _SECONDS)
        self.name, self.world, self.left, self.clashed = name, world, most, clashed
        self.end = time.thread_time() + _PATIENCE
        self.settings = replace(settings, solving=replace(settings.solving, seconds=seconds))

    def compiled(self, source: SourceFile) -> Compiled:
        """Compiles, and counts it."""
        self.left -= 1
        return Reader.of(source).compiled(compile(source, self.world, settings=self.settings))

    def tried(self, item: Item, changes: Changes, base: Compiled | None, is_first: bool = False) -> Trial:
        """Puts an item back into the later program, whose outcome is `base`. If more is to follow, as
        constraints of a structure, it may touch nothing yet.
        """
        here = changes.after.source
        is_over = self.left <= 0 or time.thread_time() > self.end
        if is_over or base is None or not stands(base):
            return Trial(UNTRIED, here)
        edit = put_back(item, changes)
        if edit is None:
            return Trial(Finding(State.HOMELESS), here)
        source = SourceFile(self.name, edit.text)
        result = self.compiled(source)
        new = [d for d in new_errors(changes.before, base, result) if not is_first or d.is_error]
        if any(d.code == _TIMED_OUT for d in new):
            self.left = 0  # each further trial would take as long
            return Trial(UNTRIED, here)
        if result.model is None:
            return Trial(Finding(State.HOMELESS), here)
        own = Span(source, edit.start, edit.end)
        stated = _stated_in(result, own)
        fate, now = changes.fates[item]
        if new:
            solving = [d for d in new if d.code in _UNSOLVED]
            parties = tuple(_parties(solving, own, result))
            if (
                fate is Fate.REWRITTEN
                and now
                and item in self.clashed
                and _is_mended(stated, now, parties, base)
            ):
                return Trial(Finding(State.MENDED), here)
            return Trial(Finding(State.CONFLICTS, parties, "" if solving else new[0].message), here)
        implied = _is_implied(stated, item, fate, own, result)
        return Trial(Finding(State.IMPLIED if implied else State.FITS), source, result)


def stands(compiled: Compiled | None) -> bool:
    """True for a program that solves; an assert of it may fail."""
    if compiled is None or compiled.model is None or compiled.status != "solved":
        return False
    return all(d.code == _FAILED for d in compiled.errors)


def new_errors(before: Inventory, base: Compiled, result: Compiled) -> Iterator[Diagnostic]:
    """Yields errors of a result that its base did not have, and parts that touch nothing, except those that
    touched nothing `before` either.
    """
    contacts = (d for d in before.diagnostics if d.code in CONTACTS)
    known = Counter(_mark(d) for d in (*base.diagnostics, *contacts))
    for d in result.diagnostics:
        if d.is_error or d.code in CONTACTS:
            mark = _mark(d)
            if not known[mark]:
                yield d
            known[mark] -= 1


def _mark(d: Diagnostic) -> tuple[str, str]:
    """Returns a key of a diagnostic; for contacts the part only, as the distance may change."""
    return d.code, d.message.split("`")[1] if d.code in CONTACTS else d.message


def _parties(errors: list[Diagnostic], own: Span, result: Compiled) -> Iterable[str]:
    """Returns the constraints in a conflict as they are written, except the one that was put back."""
    spans = [span for d in errors for span in (d.span, *(label.span for label in d.secondary)) if span]
    others = (span for span in spans if not span.overlaps(own) and _stated_in(result, span))
    return dict.fromkeys(span.one_line for span in sorted(others, key=lambda span: span.start))


def _is_implied(
    stated: Sequence[ConstraintReport], item: Item, fate: Fate, own: Span, result: Compiled
) -> bool:
    """True if the program says as much without an item. An inequality that is simply gone counts as lost even
    if sizes and parameters happen to keep it now; its replacement may say more.
    """
    if item.kind is not Kind.CONSTRAINT and not (item.kind is Kind.ROTATION and stated):
        return False
    return (fate is Fate.REWRITTEN or _is_exact(stated)) and result.follows(own)


def _is_mended(stated: Sequence[ConstraintReport], now: Item, parties: Sequence[str], base: Compiled) -> bool:
    """True if the replacement of a conflicting statement asks for as much: an equation for an equation, or
    anything but the opposite of an inequality.
    """
    heirs = _stated_in(base, now.span)
    if _is_exact(stated):
        return bool(heirs) and _is_exact(heirs)
    return now.text not in parties


def _stated_in(compiled: Compiled, span: Span) -> list[ConstraintReport]:
    constraints = compiled.model.constraints if compiled.model is not None else ()
    text, start, end = span.source.text, span.start, span.end
    return [
        c for c in constraints if c.span.start < end and start < c.span.end and c.span.source.text == text
    ]


def _is_exact(stated: Iterable[ConstraintReport]) -> bool:
    return all(report.exact for report in stated)

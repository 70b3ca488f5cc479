"""Tries both ends of each param, and searches the limit if an end fails: many compiles at a time."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Sequence
from dataclasses import replace
from typing import TypeAlias

from aidl_lang.building.model import Knob
from aidl_lang.common.crew import Broke, Crew
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.processes import Guarded, count
from aidl_lang.common.running import checkpoint
from aidl_lang.tools.ends.results import Sweep, Tried, Turned
from aidl_lang.tools.ends.trying import SweepJob, tried
from aidl_lang.tools.ends.values import Value, ends, limit
from aidl_lang.tools.sweeping.faults import Fault, fault, limit_fault

LONGEST = 300.0
"""Seconds for all of it; ends left then are counted."""
_MOST = 200
"""Most ends that are tried."""
_PATIENCE = 15.0
"""Seconds for one compile, beyond which the limit is not searched."""
_PAUSE = 0.1

Asking: TypeAlias = tuple[Value, bool]
"""A value to try, and whether its faults are to be explained."""
Course: TypeAlias = Generator[Asking, Tried, Turned]


def sweep(
    job: SweepJob,
    knobs: Sequence[Knob],
    known: Sequence[Diagnostic],
    progress: Callable[[int, int], None] = lambda done, count: None,
    seconds: float = LONGEST,
) -> Sweep:
    """Tries a working program at the ends of its params. `known` are its diagnostics as written; `progress`
    is told how many ends are done, of how many.

    Raises Cancelled where nobody waits for it any more (see `cancelling`).
    """
    start = time.monotonic()
    wanted = [(knob, end) for knob in knobs for end in ends(knob)]
    places = frozenset(fault(d).place for d in known)
    courses = [_course(knob, end, places) for knob, end in wanted[:_MOST]]
    if not courses:
        return Sweep((), _rangeless(knobs), 0, 0, 0.0)
    run = _Run(job, [knob for knob, _ in wanted], courses, progress, start + seconds)
    turned = run.turned()
    left = len(wanted) - len(turned)
    return Sweep(turned, _rangeless(knobs), left, run.compiled, time.monotonic() - start)


def _rangeless(knobs: Sequence[Knob]) -> tuple[Knob, ...]:
    return tuple(k for k in knobs if not k.choices and k.low is None and not isinstance(k.value, bool))


def _course(knob: Knob, end: Value, known: frozenset[tuple[str, str | None, int | None]]) -> Course:
    """Tries the value at an end; if it fails, searches the last value that does not."""
    last = yield end, True
    if last.ok:
        return Turned(knob, end, replace(last, faults=_new(last.faults, known)))
    if isinstance(end, str | bool) or knob.choices or last.was_given_up or last.seconds > _PATIENCE:
        return Turned(knob, end, last)
    search = limit(knob, end)
    try:
        value = next(search)
        while True:
            found = yield value, False
            if found.was_given_up:
                return Turned(knob, end, last)
            value = search.send(found.ok)
    except StopIteration as done:
        works, fails = done.value
    beyond = last if fails == end else (yield fails, True)
    return Turned(knob, end, last, works, (fails, beyond))


def _new(faults: Sequence[Fault], known: frozenset[tuple[str, str | None, int | None]]) -> tuple[Fault, ...]:
    return tuple(each for each in faults if each.place not in known)


class _Run:
    """Searches side by side, each one compile after the other."""

    def __init__(
        self,
        job: SweepJob,
        knobs: Sequence[Knob],
        courses: Sequence[Course],
        progress: Callable[[int, int], None],
        until: float,
    ) -> None:
        self.job, self.knobs, self.courses = job, knobs, courses
        self.progress, self.until = progress, until
        self.compiled = 0
        self._results: dict[int, Turned] = {}

    def turned(self) -> tuple[Turned, ...]:
        """Returns the results of the searches, in their order, as far as there was time."""
        workers = Guarded(min(count(), len(self.courses)), "aidl_lang.tools.ends.trying")
        crew: Crew[int, Tried] = Crew(workers)
        try:
            self.progress(0, len(self.courses))
            for number, course in enumerate(self.courses):
                self._ask(crew, number, next(course))
            while crew and time.monotonic() < self.until:
                checkpoint()
                for number, found in crew.came(_PAUSE):
                    self._go_on(crew, number, _came(found))
        finally:
            workers.close()
        return tuple(self._results[number] for number in sorted(self._results))

    def _ask(self, crew: Crew[int, Tried], number: int, asking: Asking) -> None:
        value, explained = asking
        crew.give(number, self.job.seconds, tried, self.job, self.knobs[number].path, value, explained)

    def _go_on(self, crew: Crew[int, Tried], number: int, found: Tried) -> None:
        self.compiled += 1
        try:
            self._ask(crew, number, self.courses[number].send(found))
        except StopIteration as done:
            self._results[number] = done.value
            self.progress(len(self._results), len(self.courses))


def _came(found: Tried | Broke) -> Tried:
    """Returns the result of a process, or the way it ended."""
    if isinstance(found, Tried):
        return found
    if found.limit is None:
        raise found.error
    return Tried(False, (limit_fault(found.limit),), was_given_up=True)

"""Tries a program at the ends of its params: each is set alone, to both ends of its range."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import asdict, field, replace
from functools import lru_cache
from typing import Any, TypeAlias, TypeVar, cast

from aidl_lang import pipeline
from aidl_lang.building.model import Knob
from aidl_lang.common.diagnostics import Diagnostic, Severity
from aidl_lang.common.processes import Broke, Crew, Guarded, Limit, count
from aidl_lang.common.prose import first_few, literal
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.pipeline import Front, Settings
from aidl_lang.tools.sweeping.bundle import BROKEN, Fault, fault, patience

# --- The values of a param to try: the ends of its range, and values between them and the written one.

Value: TypeAlias = float | str | bool
Place: TypeAlias = tuple[str, str | None, int | None]

_SLACK = 1e-9
_FINEST = 1e-3
"""Accuracy of a limit, as a part of the way to the end."""
_COARSEST = 0.125
_SHARES = (0.5, 0.25, 0.75)
"""Places on the way to a limit at which it is tried whether all is well up to there."""


def ends(knob: Knob) -> list[Value]:
    """Returns the ends of the range, or all choices, except the value as written; none for a number or text
    without a range.
    """
    if knob.choices:
        return [choice for choice in knob.choices if choice != knob.value]
    if isinstance(knob.value, bool):
        return [not knob.value]
    if isinstance(knob.value, str) or knob.low is None or knob.high is None:
        return []
    both = dict.fromkeys((allowed(knob, knob.low), allowed(knob, knob.high)))
    return [end for end in both if abs(end - knob.value) > _SLACK * max(1.0, abs(end))]


def has_range(knob: Knob) -> bool:
    return bool(ends(knob))


def allowed(knob: Knob, aim: float) -> float:
    """Returns the value nearest to `aim` that the range and the step of a knob allow."""
    low, high = knob.low, knob.high
    if low is not None and high is not None:
        aim = min(max(aim, low), high)
    if knob.step:
        start = low if low is not None else float(knob.value)
        aim = start + round((aim - start) / knob.step) * knob.step
        if high is not None and aim > high * (1 + 1e-12):
            aim -= knob.step
    return rounded(aim)


def rounded(value: float) -> float:
    return float(f"{value:.9g}")


def limit(knob: Knob, end: float) -> Generator[float, bool, tuple[float, float]]:
    """Yields values between the written one, which works, and an end that does not, and is sent whether they
    do. Returns the last that works and the first that does not, a small step further; some on the way there
    were tried and work as well.
    """
    works, fails = yield from _halved(knob, end)
    known = {float(knob.value), works}
    while between := [value for value in _spread(knob, works) if value not in known]:
        known.add(between[0])
        if not (yield between[0]):
            works, fails = yield from _halved(knob, between[0])
            known.add(works)
    return works, fails


def _halved(knob: Knob, end: float) -> Generator[float, bool, tuple[float, float]]:
    works, fails = float(knob.value), end
    for step in _steps(knob, end):
        while (middle := _between(works, fails, step, knob)) is not None:
            if (yield middle):
                works = middle
            else:
                fails = middle
    return works, fails


def _spread(knob: Knob, works: float) -> list[float]:
    """Returns values at equal distances between the written one and another that works."""
    start = float(knob.value)
    values = (start + share * (works - start) for share in _SHARES)
    return [float(round(value)) if is_whole(knob) else allowed(knob, value) for value in values]


def _steps(knob: Knob, end: float) -> Iterator[float]:
    """Yields steps from coarse to fine, so that a limit is a short number if it may be one."""
    way = abs(end - float(knob.value))
    if knob.step:
        yield knob.step
        return
    if is_whole(knob):
        yield 1.0
        return
    power = math.floor(math.log10(way * _COARSEST))
    while True:
        yield 10.0**power
        if 10.0**power <= way * _FINEST:
            return
        power -= 1


def is_whole(knob: Knob) -> bool:
    """True for a number written so that it may be a count."""
    numbers = (knob.value, knob.low, knob.high)
    return knob.unit == "" and all(isinstance(n, float | int) and float(n).is_integer() for n in numbers)


def _between(works: float, fails: float, step: float, knob: Knob) -> float | None:
    """Returns the multiple of a step nearest to the middle; None without one in between."""
    start = knob.low if knob.step and knob.low is not None else 0.0
    middle = ((works + fails) / 2 - start) / step
    near = (rounded(start + k * step) for k in (round(middle), math.floor(middle), math.ceil(middle)))
    inside = (v for v in near if min(works, fails) + _SLACK * step < v < max(works, fails) - _SLACK * step)
    return next(inside, None)


# --- The results of trying the ends of params.


@record()
class Tried:
    """The result of one value. `faults` has its errors, or else its warnings."""

    ok: bool
    faults: tuple[Fault, ...] = ()
    seconds: float = 0.0
    was_given_up: bool = False


@record()
class Turned:
    """A param at one end of its range, or with another choice.

    works     the last good value on the way there
    beyond    the next value, with its result; None if there are no values in between
    """

    knob: Knob
    value: Value
    tried: Tried
    works: float | None = None
    beyond: tuple[float, Tried] | None = None

    @property
    def ok(self) -> bool:
        return self.tried.ok


@record()
class Sweep:
    """The results at the ends of all params.

    turned     in the order of the params, the lower end before the upper
    rangeless  params without a range or choices, which have nothing to try
    left       ends that were not tried, for want of time or because there are too many
    compiled   number of programs compiled for it
    """

    turned: tuple[Turned, ...]
    rangeless: tuple[Knob, ...]
    left: int
    compiled: int
    seconds: float

    @property
    def ok(self) -> bool:
        return not self.left and all(each.ok for each in self.turned)


# --- Compiles a program with one param set, in a process of its own.


@record()
class SweepJob:
    """A program as passed to another process."""

    name: str
    text: str
    world: World | None = field(default=None, compare=False)
    settings: Settings = field(default=Settings(), compare=False)

    @property
    def seconds(self) -> float:
        """Returns the time that one compile may take."""
        return patience(self.settings)


@lru_cache(maxsize=1)
def checked(job: SweepJob) -> Front:
    """Returns the checked program of a job: in a process it is the same over and over."""
    return pipeline.front(SourceFile(job.name, job.text), job.world, job.settings)


def tried(job: SweepJob, path: str, value: Value, explained: bool) -> Tried:
    """Returns the result of a value. Conflicts are looked into only if `explained`."""
    start = time.perf_counter()
    settings = replace(job.settings, solving=replace(job.settings.solving, explain=explained))
    source = SourceFile(job.name, job.text)
    compiled = pipeline.compile(source, job.world, {path: value}, settings, checked=checked(job))
    wanted = Severity.WARNING if compiled.ok else Severity.ERROR
    found = tuple(fault(d) for d in compiled.diagnostics if d.severity is wanted)
    return Tried(compiled.ok, found, time.perf_counter() - start)


# --- Tries both ends of each param, and searches the limit if an end fails: many compiles at a time.

LONGEST = 300.0
"""Seconds for all of it; ends left then are counted."""
_MOST = 200
"""Most ends that are tried."""
_PATIENCE = 15.0
"""Seconds for one compile, beyond which the limit is not searched."""
_PAUSE = 0.1

T = TypeVar("T")
Course: TypeAlias = Generator[tuple[Any, ...], Any, T]
"""A search in processes: it yields functions with arguments, and is sent their results, or a limit met."""


def sweep(
    job: SweepJob,
    knobs: Sequence[Knob],
    known: Sequence[Diagnostic],
    progress: Callable[[int, int], None] = lambda done, count: None,
    seconds: float = LONGEST,
) -> Sweep:
    """Tries a working program at the ends of its params. `known` are its diagnostics as written; `progress`
    is told how many ends are done, of how many.

    Raises Cancelled where nobody waits for it any more (see `common.running`).
    """
    start = time.monotonic()
    wanted = [(knob, end) for knob in knobs for end in ends(knob)]
    places = frozenset(fault(d).place for d in known)
    courses = [_course(job, knob, end, places) for knob, end in wanted[:_MOST]]
    if not courses:
        return Sweep((), _rangeless(knobs), 0, 0, 0.0)
    turned, compiled = followed("aidl_lang.tools.ends", courses, job.seconds, progress, start + seconds)
    left = len(wanted) - len(turned)
    return Sweep(tuple(turned), _rangeless(knobs), left, compiled, time.monotonic() - start)


def _rangeless(knobs: Sequence[Knob]) -> tuple[Knob, ...]:
    return tuple(k for k in knobs if not k.choices and k.low is None and not isinstance(k.value, bool))


def _course(job: SweepJob, knob: Knob, end: Value, known: frozenset[Place]) -> Course[Turned]:
    """Tries the value at an end; if it fails, searches the last value that does not."""
    last = yield from _asked(job, knob, end, True)
    if last.ok:
        return Turned(knob, end, replace(last, faults=tuple(f for f in last.faults if f.place not in known)))
    if isinstance(end, str | bool) or knob.choices or last.was_given_up or last.seconds > _PATIENCE:
        return Turned(knob, end, last)
    search = limit(knob, end)
    try:
        value = next(search)
        while True:
            found = yield from _asked(job, knob, value, False)
            if found.was_given_up:
                return Turned(knob, end, last)
            value = search.send(found.ok)
    except StopIteration as done:
        works, fails = done.value
    beyond = last if fails == end else (yield from _asked(job, knob, fails, True))
    return Turned(knob, end, last, works, (fails, beyond))


def _asked(job: SweepJob, knob: Knob, value: Value, explained: bool) -> Course[Tried]:
    found = yield tried, job, knob.path, value, explained
    if isinstance(found, Limit):
        return Tried(False, (Fault("E0603", BROKEN[found]),), was_given_up=True)
    return cast(Tried, found)


def followed(
    module: str,
    courses: Sequence[Course[T]],
    seconds: float,
    progress: Callable[[int, int], None],
    until: float,
) -> tuple[list[T], int]:
    """Follows searches side by side, each one call after the other, in processes that have loaded a module.
    Returns their results, in their order, as far as there was time, and the number of calls.
    """
    workers = Guarded(min(count(), len(courses)), module)
    crew: Crew[int, Any] = Crew(workers)
    results: dict[int, T] = {}
    calls = 0
    try:
        progress(0, len(courses))
        for number, course in enumerate(courses):
            crew.give(number, seconds, *next(course))
        while crew and time.monotonic() < until:
            checkpoint()
            for number, found in crew.came(_PAUSE):
                calls += 1
                if isinstance(found, Broke) and found.limit is None:
                    raise found.error
                try:
                    asked = courses[number].send(found.limit if isinstance(found, Broke) else found)
                except StopIteration as done:
                    results[number] = done.value
                    progress(len(results), len(courses))
                else:
                    crew.give(number, seconds, *asked)
    finally:
        workers.close()
    return [results[number] for number in sorted(results)], calls


# --- The results at the ends of params, as sentences and as data.

_ASSERT, _CORNER = "E0604", "E0518"
_TOLD = 3
"""Most faults of one value that a sentence names."""


def valued(knob: Knob, value: Value) -> str:
    """Returns a value as the language writes it."""
    return literal(value, 12, knob.unit)


def sentence(turned: Turned, name: str) -> str:
    """Describes the faults at an end, in a program of that name; "" if there are none."""
    if not turned.tried.faults:
        return ""
    where = f"at `{turned.knob.path} = {valued(turned.knob, turned.value)}` "
    faults = _places(turned.tried)
    told = first_few([_said(fault, name) for fault in faults], _TOLD, "; and {} more", "; ")
    return where + told + _limit(turned, name)


def _places(tried: Tried) -> list[Fault]:
    """Returns one fault of each place: a line in a loop may have one in every turn."""
    return list({fault.place: fault for fault in reversed(tried.faults)}.values())[::-1]


def _said(fault: Fault, name: str) -> str:
    if fault.code == _CORNER:
        return f"`{fault.text}` in {_place(fault, name)} does not fit"
    return clause(fault, name)


def clause(fault: Fault, name: str | None = None) -> str:
    """Returns a fault as a clause, with its file if that is another than `name`."""
    place = _place(fault, name)
    if fault.code == _ASSERT and fault.line is not None:
        numbers = f" ({fault.label})" if fault.label and fault.label != "false as written" else ""
        return f"the assert in {place} fails{numbers}"
    return f"{place}: {fault.message}" if fault.line is not None else fault.message


def _place(fault: Fault, name: str | None) -> str:
    here = name is None or fault.file in (None, name)
    return f"line {fault.line}" if here else f"line {fault.line} of `{fault.file}`"


def _limit(turned: Turned, name: str) -> str:
    """Describes how far the param may go, and the first fault beyond, if that is another one."""
    if turned.works is None or turned.beyond is None:
        return ""
    knob, (beyond, tried) = turned.knob, turned.beyond
    way = "up" if isinstance(turned.value, float) and turned.value > turned.works else "down"
    until = f"{way} to {valued(knob, turned.works)}"
    first, last = _places(tried), _places(turned.tried)
    if not first or first[0].place in {fault.place for fault in last[:1]} or beyond == turned.value:
        return f"; {_subject(last)} {until}"
    return f"; all is well {until}, and at {valued(knob, beyond)} {_said(first[0], name)}"


def _subject(faults: Sequence[Fault]) -> str:
    fault = faults[0]
    if len(faults) == 1 and fault.code == _ASSERT:
        return f"`{fault.text}` holds"
    if len(faults) == 1 and fault.code == _CORNER:
        return "it fits"
    return "all is well"


def described(sweep: Sweep) -> list[dict[str, Any]]:
    return [
        {
            "param": each.knob.path,
            "unit": each.knob.unit,
            "written": each.knob.value,
            "value": each.value,
            "ok": each.ok,
            "findings": _faults(each.tried),
            "works": each.works,
            "beyond": each.beyond and {"value": each.beyond[0], "findings": _faults(each.beyond[1])},
            "seconds": round(each.tried.seconds, 3),
        }
        for each in sweep.turned
    ]


def _faults(tried: Tried) -> list[dict[str, Any]]:
    return [asdict(fault) for fault in tried.faults]

"""The values of a param to try: the ends of its range, and values between them and the written one."""

from __future__ import annotations

import math
from collections.abc import Generator, Iterator
from typing import TypeAlias

from aidl_lang.building.model import Knob

Value: TypeAlias = float | str | bool

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
    """True for a param with values to try."""
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

"""Tries two params at a time, at the ends of their ranges and halfway there: what is of another kind then,
and is not where one of them alone is turned.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import product

from aidl_lang.building.model import Knob
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.compiled import Compiled
from aidl_lang.tools.ends import allowed, is_whole
from aidl_lang.tools.ranges.looks import Change, Look, differences, look

_COARSE = frozenset(("error", "reading", "openings", "pieces", "contact", "warning"))
"""The kinds of changes that can be told between values far from each other: an edge may have been turned."""

Spot = tuple[tuple[str, float], ...]
"""Values of params by path."""


@record()
class Meeting:
    """Values of two params at which something is of another kind only together."""

    values: tuple[float, float]
    changes: tuple[Change, ...]


@record()
class Pair:
    """Two params, the values that were tried of both, and why no more were; "" if all were."""

    one: Knob
    other: Knob
    meetings: tuple[Meeting, ...] = ()
    tried: int = 0
    stopped: str = ""


def coarse(knob: Knob) -> list[float]:
    """Returns the ends of a range and what lies halfway, without the value as written."""
    written, (low, high) = float(knob.value), knob.range or (0.0, 0.0)
    aims = [low, (low + written) / 2, (high + written) / 2, high]
    values = [float(round(aim)) if is_whole(knob) else allowed(knob, aim) for aim in aims]
    return [value for value in dict.fromkeys(values) if abs(value - written) > 1e-9 * max(1.0, abs(written))]


def paired(one: Knob, other: Knob, compiled: Callable[[Spot], Compiled], until: float) -> Pair:
    """Tries two params together; the nearest values first."""
    looks: dict[Spot, Look] = {}

    def at(*spot: tuple[str, float]) -> Look:
        if spot not in looks:
            checkpoint()
            looks[spot] = look(compiled(spot), 0.0, looks.get(()))
        return looks[spot]

    def keys(*spot: tuple[str, float]) -> set[object]:
        return {change.key for change in differences(at(), at(*spot))}

    found: list[Meeting] = []
    tried = 0
    for a, b in sorted(
        product(coarse(one), coarse(other)), key=lambda ab: _far(one, ab[0]) + _far(other, ab[1])
    ):
        if time.monotonic() > until:
            return Pair(one, other, tuple(found), tried, "it takes too long")
        alone = keys((one.path, a)) | keys((other.path, b))
        both = differences(at(), at((one.path, a), (other.path, b)))
        tried += 1
        if new := tuple(c for c in both if c.kind in _COARSE and c.key not in alone):
            found.append(Meeting((a, b), new))
    return Pair(one, other, tuple(found), tried)


def _far(knob: Knob, value: float) -> float:
    low, high = knob.range or (0.0, 1.0)
    return abs(value - float(knob.value)) / (high - low)

"""What a page asks for, read from what it sends. Whatever else is sent is no message."""

from __future__ import annotations

import json
import math
from typing import Any, TypeAlias

from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Vec

LONGEST = 65_536
"""Bytes of a message."""
_LONGEST_NAME = 1_000


@record()
class Ready:
    """The page is there and shows nothing yet."""


@record()
class SetKnob:
    """`final`: it is to be written, else only tried."""

    path: str
    value: float | str | bool
    final: bool


@record()
class Drag:
    """Of a handle to a place in mm."""

    id: str
    to: Vec
    final: bool


@record()
class Cancel:
    """What was tried is over."""


@record()
class ApplyFix:
    """By its number of a problem, by its number in the picture that is shown."""

    problem: int
    fix: int


@record()
class Export:
    format: str


@record()
class Show:
    layers: frozenset[str]


Message: TypeAlias = Ready | SetKnob | Drag | Cancel | ApplyFix | Export | Show


def read(text: str) -> Message | None:
    """The message that a text is; None for any other text, and for what needs no answer."""
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return _message(data) if isinstance(data, dict) else None


def _message(data: dict[str, Any]) -> Message | None:
    match data:
        case {"type": "ready"}:
            return Ready()
        case {"type": "cancel"}:
            return Cancel()
        case {"type": "knob", "path": str(path), "value": value, "final": bool(final)}:
            return SetKnob(path, value, final) if _is_name(path) and _is_value(value) else None
        case {"type": "drag", "id": str(handle), "to": [x, y], "final": bool(final)}:
            is_place = _is_number(x) and _is_number(y)
            return Drag(handle, (float(x), float(y)), final) if _is_name(handle) and is_place else None
        case {"type": "fix", "problem": int(problem), "fix": int(fix)}:
            return ApplyFix(problem, fix)
        case {"type": "export", "format": str(name)}:
            return Export(name)
        case {"type": "show", "layers": [*layers]} if all(isinstance(layer, str) for layer in layers):
            return Show(frozenset(layers))
        case _:
            return None


def _is_name(text: str) -> bool:
    return len(text) <= _LONGEST_NAME


def _is_number(value: object) -> bool:
    return isinstance(value, float | int) and not isinstance(value, bool) and _is_finite(value)


def _is_finite(value: float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer of hundreds of digits
        return False


def _is_value(value: object) -> bool:
    return isinstance(value, bool) or _is_number(value) or (isinstance(value, str) and _is_name(value))

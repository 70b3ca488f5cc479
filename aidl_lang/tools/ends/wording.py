"""The results at the ends of params, as sentences and as data."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from aidl_lang.building.model import Knob
from aidl_lang.common.prose import first_few, literal
from aidl_lang.tools.ends.results import Sweep, Tried, Turned
from aidl_lang.tools.ends.values import Value
from aidl_lang.tools.sweeping.faults import Fault

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
    place = _place(fault, name)
    if fault.code == _ASSERT and fault.line is not None:
        numbers = f" ({fault.label})" if fault.label and fault.label != "false as written" else ""
        return f"the assert in {place} fails{numbers}"
    if fault.code == _CORNER:
        return f"`{fault.text}` in {place} does not fit"
    return f"{place}: {fault.message}" if fault.line is not None else fault.message


def _place(fault: Fault, name: str) -> str:
    return f"line {fault.line}" if fault.file in (None, name) else f"line {fault.line} of `{fault.file}`"


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
    """Returns everything that was tried, as JSON has it."""
    return [_end(each) for each in sweep.turned]


def _end(turned: Turned) -> dict[str, Any]:
    beyond = turned.beyond
    return {
        "param": turned.knob.path,
        "unit": turned.knob.unit,
        "written": turned.knob.value,
        "value": turned.value,
        "ok": turned.ok,
        "findings": _faults(turned.tried),
        "works": turned.works,
        "beyond": None if beyond is None else {"value": beyond[0], "findings": _faults(beyond[1])},
        "seconds": round(turned.tried.seconds, 3),
    }


def _faults(tried: Tried) -> list[dict[str, Any]]:
    return [
        {
            "code": f.code,
            "message": f.message,
            "label": f.label,
            "text": f.text,
            "file": f.file,
            "line": f.line,
        }
        for f in tried.faults
    ]

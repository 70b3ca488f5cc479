"""Calls a tool by its name with arguments from JSON, whatever the protocol, in processes."""

from __future__ import annotations

import asyncio
import json
import math
from collections.abc import Mapping, Sequence
from typing import Any, Literal, get_args, get_origin

from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.names import nearest
from aidl_lang.common.processes import Guarded, Limit, limit_met
from aidl_lang.common.records import record
from aidl_lang.common.render import compact
from aidl_lang.tools.agents.results import Result, data, findings
from aidl_lang.tools.agents.schema import Parameter, Tool, tools
from aidl_lang.tools.agents.tools import Tools
from aidl_lang.tools.agents.workspace import refusal

_SHOWN = 60
"""Most characters of a value that a message quotes."""
_PAIR = {"name", "value"}


@record()
class Answer:
    """The answer to the model: text, data and pictures (PNG). Only for a refused call `is_error` is true."""

    text: str
    data: Mapping[str, Any]
    pictures: tuple[bytes, ...] = ()
    is_error: bool = False


def answer(workshop: Tools, name: str, arguments: Mapping[str, object]) -> Answer:
    """Returns the answer of a tool, also for a call that cannot be answered."""
    try:
        result = call(workshop, name, arguments)
    except AidlError as error:
        listed = findings(error.diagnostics)
        return Answer(compact(error.diagnostics), {"findings": data(listed)}, is_error=True)
    return Answer(result.text, data(result), result.pictures)


def call(workshop: Tools, name: str, arguments: Mapping[str, object]) -> Result:
    """Calls a tool. An argument that is null counts as left out. Raises RefusalError."""
    tool = find(name)
    result: Result = getattr(workshop, tool.name)(**bound(tool, arguments))
    return result


def find(name: str) -> Tool:
    """Returns the tool of a name. Raises RefusalError."""
    known = {tool.name: tool for tool in tools()}
    if name not in known:
        near = [f"did you mean `{n}`?" for n in nearest(name[:_SHOWN], known)]
        raise refusal("E0944", f"there is no tool `{name[:_SHOWN]}`", *near, f"tools: {', '.join(known)}")
    return known[name]


def bound(tool: Tool, arguments: Mapping[str, object]) -> dict[str, object]:
    """Returns the arguments as the function takes them. Raises RefusalError for any that does not fit."""
    given = {name: value for name, value in arguments.items() if value is not None}
    known = {parameter.name: parameter for parameter in tool.parameters}
    for name in given:
        if name not in known:
            near = [f"did you mean `{n}`?" for n in nearest(name[:_SHOWN], known)]
            message = f"`{tool.name}` has no parameter `{name[:_SHOWN]}`"
            raise refusal("E0944", message, *near, f"parameters: {', '.join(known)}")
    for parameter in tool.parameters:
        if parameter.is_required and parameter.name not in given:
            raise refusal("E0944", f"`{tool.name}` needs `{parameter.name}`", parameter.description)
    return {name: _argument(tool, known[name], value) for name, value in given.items()}


def _argument(tool: Tool, parameter: Parameter, value: object) -> object:
    try:
        return _converted(value, parameter.kind)
    except _MisfitError as misfit:
        message = f"`{parameter.name}` of `{tool.name}` takes {misfit.wanted}, not {_shown(misfit.value)}"
        raise refusal("E0944", message, parameter.description) from None


class _MisfitError(Exception):
    def __init__(self, wanted: str, value: object) -> None:
        super().__init__(wanted)
        self.wanted = wanted
        self.value = value


def _converted(value: object, kind: Any) -> object:
    """Converts a value from JSON to a type of Python. Raises _MisfitError."""
    origin, arguments = get_origin(kind), get_args(kind)
    if origin is Literal:
        if value not in arguments:
            raise _MisfitError(f"one of {', '.join(arguments)}", value)
        return value
    if origin is Sequence:
        if not isinstance(value, list | tuple):
            raise _MisfitError("a list", value)
        return tuple(_converted(v, arguments[0]) for v in value)
    if origin is Mapping:
        return {_text(name): _converted(v, arguments[1]) for name, v in _pairs(value)}
    if arguments:
        return _of_union(value, arguments)
    return _primitive(value, kind)


def _of_union(value: object, kinds: Sequence[Any]) -> object:
    wanted = []
    for kind in kinds:
        try:
            return _converted(value, kind)
        except _MisfitError as misfit:
            wanted.append(misfit.wanted)
    raise _MisfitError(" or ".join(wanted), value)


def _pairs(value: object) -> list[tuple[object, object]]:
    """Returns the items of a mapping, or of pairs of name and value as strict schemas have them."""
    if isinstance(value, Mapping):
        return list(value.items())
    if not isinstance(value, list) or not all(isinstance(v, Mapping) and set(v) == _PAIR for v in value):
        raise _MisfitError("an object, from names to values", value)
    return [(pair["name"], pair["value"]) for pair in value]


def _primitive(value: object, kind: Any) -> object:
    if kind is str:
        return _text(value)
    if kind is bool:
        if not isinstance(value, bool):
            raise _MisfitError("true or false", value)
        return value
    if isinstance(value, bool) or not isinstance(value, int | float) or not _is_finite(value):
        raise _MisfitError("a number", value)
    if kind is int and value != int(value):
        raise _MisfitError("a whole number", value)
    return int(value) if kind is int else float(value)


def _is_finite(value: float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:  # a whole number of hundreds of digits
        return False


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise _MisfitError("a text", value)
    try:
        value.encode()
    except UnicodeEncodeError:
        raise _MisfitError("a text in Unicode", "one with half a surrogate pair") from None
    return value


def _shown(value: object) -> str:
    text = json.dumps(value)
    return f"`{text if len(text) <= _SHOWN else text[: _SHOWN - 1] + '…'}`"


# --- Runs calls in processes of their own: a program that hangs or crashes harms nothing else.

SECONDS = 45.0
"""Most seconds of a call; clients wait for a minute."""
_WORKERS = 2


class Workers:
    """A few processes that answer calls one after the other; one that was ended is replaced."""

    def __init__(self, workshop: Tools, seconds: float = SECONDS) -> None:
        self.workshop, self.seconds = workshop, seconds
        self._pool = Guarded(_WORKERS, "aidl_lang.tools.agents.calling")

    async def answer(self, name: str, arguments: Mapping[str, object]) -> Answer:
        """Returns the answer of a tool. Cancelling this ends the process that works on it."""
        future = self._pool.submit(self.seconds, answer, self.workshop, name, arguments)
        try:
            return await asyncio.wrap_future(future)
        except Exception as error:
            if (limit := limit_met(error)) is None:
                raise
            diagnostic = Diagnostic(
                "E0943",
                f"the call {_WHY[limit].format(self.seconds)} and was given up",
                hints=("ask for less: fewer parts, smaller arrays, no outlines worked out of many others",),
            )
            return Answer(compact([diagnostic]), {}, is_error=True)

    def close(self) -> None:
        self._pool.close()


_WHY = {
    Limit.TIME: "took longer than {:g} s",
    Limit.DEATH: "ended the process that worked on it",
    Limit.MEMORY: "needs more memory than there is for it",
}

"""The tools for any protocol: their JSON Schema, calls by name with arguments from JSON, processes.

The schemas (draft 2020-12) are read off the signatures and docstrings of the functions. Those of arguments
are without `$ref`. The `strict` form is what OpenAI's strict mode takes: every parameter is required, one
that may be left out may be null, and a mapping is a list of pairs of a `name` and a `value`.
"""

from __future__ import annotations

import asyncio
import dataclasses
import inspect
import json
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.names import nearest
from aidl_lang.common.prose import did_you_mean, shortened
from aidl_lang.common.records import record
from aidl_lang.common.render import compact
from aidl_lang.tools.agents.results import Result, data, findings, shown_fields
from aidl_lang.tools.agents.tools import Tools
from aidl_lang.tools.agents.workspace import refusal

Json = dict[str, Any]
_PRIMITIVES: Mapping[object, str] = {
    str: "string",
    int: "integer",
    float: "number",
    bool: "boolean",
    NoneType: "null",
}


@record()
class Parameter:
    """`kind` is its type without None, which stands for the default."""

    name: str
    kind: Any
    description: str
    default: object = inspect.Parameter.empty

    @property
    def is_required(self) -> bool:
        return self.default is inspect.Parameter.empty


@record()
class Tool:
    function: Callable[..., Any]

    @property
    def name(self) -> str:
        return self.function.__name__

    @property
    def description(self) -> str:
        return " ".join((self.function.__doc__ or "").split())

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        hints = get_type_hints(self.function, include_extras=True)
        given = inspect.signature(self.function).parameters
        return tuple(_parameter(p, hints[name]) for name, p in given.items() if name != "self")

    @cached_property
    def result(self) -> Json:
        """The schema of the result's data; types that occur in it more than once stand under `$defs`."""
        made: dict[str, Json] = {}
        kind = get_type_hints(self.function)["return"]
        schema = _object(kind, made)
        return {**schema, "$defs": made} if made else schema

    def arguments(self, *, strict: bool = False) -> Json:
        properties = {p.name: _property(p, strict) for p in self.parameters}
        required = [p.name for p in self.parameters if strict or p.is_required]
        return _closed(properties, required)


def tools() -> tuple[Tool, ...]:
    """Returns the tools in the order in which they are defined."""
    functions = (f for name, f in vars(Tools).items() if inspect.isfunction(f) and name[0] != "_")
    return tuple(map(Tool, functions))


def for_openai() -> list[Json]:
    """Returns the `tools` of a request to the Chat Completions API and to servers that speak like it."""
    return [
        {
            "type": "function",
            "function": {
                "name": tool.name,
                "description": tool.description,
                "parameters": tool.arguments(strict=True),
                "strict": True,
            },
        }
        for tool in tools()
    ]


def for_anthropic() -> list[Json]:
    """Returns the `tools` of a request to the Messages API."""
    return [
        {"name": tool.name, "description": tool.description, "input_schema": tool.arguments()}
        for tool in tools()
    ]


def for_mcp() -> list[Json]:
    """Returns the list of tools of a server of the Model Context Protocol."""
    return [
        {
            "name": tool.name,
            "title": tool.name.replace("_", " ").capitalize(),
            "description": tool.description,
            "inputSchema": tool.arguments(),
            "outputSchema": tool.result,
            "annotations": {
                "readOnlyHint": True,
                "destructiveHint": False,
                "idempotentHint": True,
                "openWorldHint": False,
            },
        }
        for tool in tools()
    ]


STYLES: Mapping[str, Callable[[], list[Json]]] = {
    "openai": for_openai,
    "anthropic": for_anthropic,
    "mcp": for_mcp,
}


def _object(kind: type, made: dict[str, Json]) -> Json:
    """Returns the schema of a dataclass of a result; those in it are put into `made`, by their names."""
    hints = get_type_hints(kind)
    names = [field.name for field in shown_fields(kind)]
    properties = {name: _schema(hints[name], made) for name in names}
    return _closed(properties, names, description=" ".join((kind.__doc__ or "").split()))


def _closed(properties: Json, required: list[str], **more: str) -> Json:
    whole = {"properties": properties, "required": required, "additionalProperties": False}
    return {"type": "object", **more, **whole}


def _parameter(parameter: inspect.Parameter, hint: Any) -> Parameter:
    kind, description = get_args(hint)
    if _is_union(kind) and parameter.default is None:
        kind = Union[tuple(k for k in get_args(kind) if k is not NoneType)]  # noqa: UP007 (made at run time)
    return Parameter(parameter.name, kind, description, parameter.default)


def _property(parameter: Parameter, strict: bool) -> Json:
    schema = _strict(_schema(parameter.kind)) if strict else _schema(parameter.kind)
    if parameter.is_required:
        return {**schema, "description": parameter.description}
    if strict:
        return {"anyOf": [schema, {"type": "null"}], "description": parameter.description}
    default = parameter.default
    known = {} if default is None else {"default": list(default) if isinstance(default, tuple) else default}
    return {**schema, "description": parameter.description, **known}


def _strict(schema: Json) -> Json:
    """Returns the schema with a list of pairs in place of a mapping."""
    if not (value := schema.get("additionalProperties")):
        return schema
    pair = _closed({"name": {"type": "string"}, "value": value}, ["name", "value"])
    return {"type": "array", "items": pair}


def _schema(kind: Any, made: dict[str, Json] | None = None) -> Json:
    """Returns the schema of an argument; or of a result's value, whose dataclasses are put into `made`, and
    where a number that is not finite comes as null.
    """
    origin, arguments = get_origin(kind), get_args(kind)
    if made is not None and dataclasses.is_dataclass(kind) and isinstance(kind, type):
        if kind.__name__ not in made:
            made[kind.__name__] = _object(kind, made)
        return {"$ref": f"#/$defs/{kind.__name__}"}
    if kind is Any:
        return {}
    if kind is float and made is not None:
        return {"type": ["number", "null"]}
    if kind in _PRIMITIVES:
        return {"type": _PRIMITIVES[kind]}
    if _is_union(kind):
        return {"anyOf": [_schema(k, made) for k in arguments]}
    if origin is Literal:
        return {"type": "string", "enum": list(arguments)}
    if origin in (Sequence, list):
        return {"type": "array", "items": _schema(arguments[0], made)}
    if origin in (Mapping, dict):
        value = _schema(arguments[1], made)
        return {"type": "object", "additionalProperties": value} if value else {"type": "object"}
    raise TypeError(f"no schema for {kind!r}")


def _is_union(kind: Any) -> bool:
    return get_origin(kind) in (Union, UnionType)


# --- Calls a tool by its name with arguments from JSON.

_SHOWN = 60
"""Most characters of a value that a message quotes."""
_PAIR = {"name", "value"}
_LARGEST = sys.float_info.max


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
        known = {tool.name: tool for tool in tools()}
        if name not in known:
            near = did_you_mean(nearest(name[:_SHOWN], known))
            raise refusal("E0944", f"there is no tool `{name[:_SHOWN]}`", *near, f"tools: {', '.join(known)}")
        result: Result = getattr(workshop, name)(**_bound(known[name], arguments))
    except AidlError as error:
        listed = findings(error.diagnostics)
        return Answer(compact(error.diagnostics), {"findings": data(listed)}, is_error=True)
    return Answer(result.text, data(result), result.pictures)


def _bound(tool: Tool, arguments: Mapping[str, object]) -> dict[str, object]:
    """Returns the arguments as the function takes them; one that is null counts as left out. Raises
    RefusalError for any that does not fit.
    """
    given = {name: value for name, value in arguments.items() if value is not None}
    known = {parameter.name: parameter for parameter in tool.parameters}
    for name in given:
        if name not in known:
            near = did_you_mean(nearest(name[:_SHOWN], known))
            message = f"`{tool.name}` has no parameter `{name[:_SHOWN]}`"
            raise refusal("E0944", message, *near, f"parameters: {', '.join(known)}")
    for parameter in tool.parameters:
        if parameter.is_required and parameter.name not in given:
            raise refusal("E0944", f"`{tool.name}` needs `{parameter.name}`", parameter.description)
    taken: dict[str, object] = {}
    for name, value in given.items():
        try:
            taken[name] = _converted(value, known[name].kind)
        except _MisfitError as misfit:
            wanted, value = misfit.args
            shown = shortened(json.dumps(value), _SHOWN)
            message = f"`{name}` of `{tool.name}` takes {wanted}, not `{shown}`"
            raise refusal("E0944", message, known[name].description) from None
    return taken


class _MisfitError(Exception):
    """Raised with what is wanted, and the value that there is."""


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
            wanted.append(misfit.args[0])
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
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= _LARGEST:
        raise _MisfitError("a number", value)
    if kind is int and value != int(value):
        raise _MisfitError("a whole number", value)
    return int(value) if kind is int else float(value)


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise _MisfitError("a text", value)
    try:
        value.encode()
    except UnicodeEncodeError:
        raise _MisfitError("a text in Unicode", "one with half a surrogate pair") from None
    return value


# --- Runs calls in processes of their own: a program that hangs or crashes harms nothing else.

SECONDS = 45.0
"""Most seconds of a call; clients wait for a minute."""
_WORKERS = 2


class Workers:
    """A few processes that answer calls one after the other; one that was ended is replaced."""

    def __init__(self, workshop: Tools, seconds: float = SECONDS) -> None:
        from aidl_lang.common.processes import Guarded  # which who wants a schema does without

        self.workshop, self.seconds = workshop, seconds
        self._pool = Guarded(_WORKERS, "aidl_lang.tools.agents.calling")

    async def answer(self, name: str, arguments: Mapping[str, object]) -> Answer:
        """Returns the answer of a tool. Cancelling this ends the process that works on it."""
        from aidl_lang.common.processes import limit_met

        future = self._pool.submit(self.seconds, answer, self.workshop, name, arguments)
        try:
            return await asyncio.wrap_future(future)
        except Exception as error:
            if (limit := limit_met(error)) is None:
                raise
            diagnostic = Diagnostic(
                "E0943",
                f"the call {_WHY[limit.value].format(self.seconds)} and was given up",
                hints=("ask for less: fewer parts, smaller arrays, no outlines worked out of many others",),
            )
            return Answer(compact([diagnostic]), {}, is_error=True)

    def close(self) -> None:
        self._pool.close()


_WHY = {
    "time": "took longer than {:g} s",
    "death": "ended the process that worked on it",
    "memory": "needs more memory than there is for it",
}

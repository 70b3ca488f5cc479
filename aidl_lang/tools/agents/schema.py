"""The tools as JSON Schema (draft 2020-12), read off the signatures and docstrings of their functions.

Those of arguments are without `$ref`. The `strict` form is what OpenAI's strict mode takes: every
parameter is required, one that may be left out may be null, and a mapping is a list of pairs of a `name` and
a `value`.
"""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from aidl_lang.common.records import record
from aidl_lang.tools.agents.results import shown_fields
from aidl_lang.tools.agents.tools import Tools

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
    def title(self) -> str:
        return self.name.replace("_", " ").capitalize()

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
        return {
            "type": "object",
            "properties": properties,
            "required": required,
            "additionalProperties": False,
        }


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
            "title": tool.title,
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
    return {
        "type": "object",
        "description": " ".join((kind.__doc__ or "").split()),
        "properties": {name: _given(hints[name], made) for name in names},
        "required": names,
        "additionalProperties": False,
    }


def _given(kind: Any, made: dict[str, Json]) -> Json:
    """Returns the schema of a result's value. A number that is not finite comes as null."""
    if dataclasses.is_dataclass(kind) and isinstance(kind, type):
        if kind.__name__ not in made:
            made[kind.__name__] = _object(kind, made)
        return {"$ref": f"#/$defs/{kind.__name__}"}
    if kind is float:
        return {"type": ["number", "null"]}
    return _schema(kind, lambda inner: _given(inner, made))


def _parameter(parameter: inspect.Parameter, hint: Any) -> Parameter:
    kind, description = get_args(hint)
    if _is_union(kind) and parameter.default is None:
        kind = Union[tuple(k for k in get_args(kind) if k is not NoneType)]  # noqa: UP007 (made at run time)
    return Parameter(parameter.name, kind, description, parameter.default)


def _property(parameter: Parameter, strict: bool) -> Json:
    schema = _strict(parameter.kind) if strict else _taken(parameter.kind)
    if parameter.is_required:
        return {**schema, "description": parameter.description}
    if strict:
        return {"anyOf": [schema, {"type": "null"}], "description": parameter.description}
    default = parameter.default
    known = {} if default is None else {"default": list(default) if isinstance(default, tuple) else default}
    return {**schema, "description": parameter.description, **known}


def _taken(kind: Any) -> Json:
    return _schema(kind, _taken)


def _strict(kind: Any) -> Json:
    if get_origin(kind) is not Mapping:
        return _schema(kind, _strict)
    value = _strict(get_args(kind)[1])
    pair = {
        "type": "object",
        "properties": {"name": {"type": "string"}, "value": value},
        "required": ["name", "value"],
        "additionalProperties": False,
    }
    return {"type": "array", "items": pair}


def _schema(kind: Any, inner: Callable[[Any], Json]) -> Json:
    origin, arguments = get_origin(kind), get_args(kind)
    if kind is Any:
        return {}
    if kind in _PRIMITIVES:
        return {"type": _PRIMITIVES[kind]}
    if origin is Annotated:
        return {**inner(arguments[0]), "description": arguments[1]}
    if _is_union(kind):
        return {"anyOf": [inner(k) for k in arguments]}
    if origin is Literal:
        return {"type": "string", "enum": list(arguments)}
    if origin in (Sequence, list):
        return {"type": "array", "items": inner(arguments[0])}
    if origin in (Mapping, dict):
        value = inner(arguments[1])
        return {"type": "object", "additionalProperties": value} if value else {"type": "object"}
    raise TypeError(f"no schema for {kind!r}")


def _is_union(kind: Any) -> bool:
    return get_origin(kind) in (Union, UnionType)

"""Attributes of structures: which there are, and what they take."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from aidl_lang import ast, units
from aidl_lang.building.evaluate import evaluate
from aidl_lang.building.scopes import Scope
from aidl_lang.building.state import Env, Interpreter, Reach
from aidl_lang.builtins import ATTRIBUTES, WORDED
from aidl_lang.model import Structure
from aidl_lang.names import find
from aidl_lang.values import (
    Nothing,
    Num,
    Text,
    Value,
)


def read_attributes(it: Interpreter, s: Structure, attributes: Iterable[ast.Attribute], scope: Scope) -> None:
    """Read what the checker has found to be attributes."""
    for attribute in attributes:
        name = find(attribute.name.text, dict.fromkeys(ATTRIBUTES))
        if name is None:
            continue
        values: list[Value] = []
        for argument in attribute.arguments:
            value = argument.value
            if name in WORDED and isinstance(value, ast.Name) and scope.find(value.text) is None:
                value = ast.String(value.text, span=value.span)
            values.append(evaluate(it, value, Env(scope, s.parent or s, Reach.OWN)))
        if _fits(it, name, values, attribute):
            s.attributes["color" if name == "colour" else name] = tuple(values)


ORIENTATIONS = ("top", "front", "side")


def _fits(it: Interpreter, name: str, values: Sequence[Value], attribute: ast.Attribute) -> bool:
    """Whether an attribute is given what it takes."""
    if any(isinstance(value, Nothing) for value in values):
        return False
    wanted = ""
    match name, *values:
        case ("orientation", Text(word)) if word in ORIENTATIONS:
            pass
        case ("orientation", *_):
            wanted = "one of `top`, `front` and `side`, as in `@orientation(front)`"
        case ("thickness", Num() as thickness) if thickness.dimension in (None, units.LENGTH):
            wanted = "" if thickness.value > 0 else "a thickness above 0"
        case ("thickness", *_):
            wanted = "a length above 0, as in `@thickness(3mm)`"
        case ("elevation", Num() as elevation) if elevation.dimension in (None, units.LENGTH):
            pass
        case ("elevation", *_):
            wanted = "a length, as in `@elevation(18mm)` or `@elevation(-3)`"
        case ("layer" | "material" | "note", Text()) | ("detached",) | ("detached", bool()):
            pass
        case ("layer" | "material" | "note", *_):
            wanted = f'a text, as in `@{name}("…")`'
        case ("detached", *_):
            wanted = "nothing, or true or false"
    if wanted:
        it.report("E0517", f"`@{attribute.name.text}` takes {wanted}", attribute)
    return not wanted

"""Syntax trees as plain data, which JSON keeps: numbers, texts, lists, None.

A node is `[number of its class, start, end, fields …]`, a tuple `[0, items …]`; everything else stands for
itself. The numbers are those of this version's classes, so data goes with the code that made it.
"""

from __future__ import annotations

from typing import Any

from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast

_TUPLE = 0
_CLASSES: tuple[Any, ...] = (
    tuple,
    *(kind for kind in vars(ast).values() if isinstance(kind, type) and issubclass(kind, ast.Node)),
)
_NUMBERS = {kind: number for number, kind in enumerate(_CLASSES)}


def encoded(value: object) -> object:
    """Returns a tree as data, without the text it was parsed from. Raises TypeError for a value that no tree
    has.
    """
    if isinstance(value, ast.Node):
        names: tuple[str, ...] = value.__match_args__  # every field but the span
        fields = [encoded(getattr(value, name)) for name in names]
        return [_NUMBERS[type(value)], value.span.start, value.span.end, *fields]
    if isinstance(value, tuple):
        return [_TUPLE, *map(encoded, value)]
    if value is None or isinstance(value, str | bool | int | float):
        return value
    raise TypeError(f"{type(value).__name__} is no part of a syntax tree")


def decoded(data: Any, source: SourceFile) -> Any:
    """Returns the tree that `encoded` made into data, in the text it was parsed from."""
    if type(data) is not list:
        return data
    number = data[0]
    if number == _TUPLE:
        return tuple([decoded(item, source) for item in data[1:]])
    fields = [decoded(item, source) if type(item) is list else item for item in data[3:]]
    return _CLASSES[number](*fields, span=Span(source, data[1], data[2]))

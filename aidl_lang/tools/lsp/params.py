"""What requests of our own are asked with. Nothing is certain of what a client sends: what is of other types
is refused.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from operator import eq
from typing import TypeAlias, TypeVar

from attrs import field, frozen
from cattrs import ClassValidationError, Converter, transform_error
from pygls.exceptions import JsonRpcInvalidParams

Value: TypeAlias = float | str | bool
Texts: TypeAlias = tuple[str, ...]
Values: TypeAlias = dict[str, Value]
Point: TypeAlias = tuple[float, float]
T = TypeVar("T")

_LONGEST = 8_000
"""Characters of a name or a URI."""


@frozen(kw_only=True)
class OfDocument:
    """
    uri     of an open document
    viewer  which of those who see the document asks, as the client calls it
    """

    uri: str
    viewer: str = ""


@frozen(kw_only=True)
class Show(OfDocument):
    """
    show    the layers over the drawing
    source  whether the text is wanted, too
    """

    show: Texts = ()
    source: bool = False


@frozen(kw_only=True)
class OfVersion(OfDocument):
    """`version` is that of the text that is meant; None: the text as it is."""

    version: int | None = None


@frozen(kw_only=True)
class Dragged:
    id: str
    to: Point


@frozen(kw_only=True)
class Try(OfVersion):
    knobs: Values = field(factory=dict)
    drag: Dragged | None = None


@frozen(kw_only=True)
class SetKnob(OfVersion):
    path: str
    value: Value


@frozen(kw_only=True)
class Drag(OfVersion):
    """To leave a point where it was dragged."""

    id: str
    to: Point


@frozen(kw_only=True)
class ApplyFix(OfDocument):
    """A fix of a problem of the picture of a version, both by number."""

    version: int
    problem: int
    fix: int


@frozen(kw_only=True)
class Export(OfDocument):
    format: str
    show: Texts = ()


@frozen(kw_only=True)
class Entry:
    """What was said of an entry of a list of completions."""

    uri: str
    list: int
    entry: int


@frozen(kw_only=True)
class Action:
    """What was said of a code action, to be worked out."""

    uri: str
    version: int
    kind: str
    start: int
    end: int


def read(params: object, kind: type[T]) -> T:
    """Returns the parameters that plain data says; what is null is unsaid. Raises JsonRpcInvalidParams."""
    if not isinstance(params, Mapping):
        raise JsonRpcInvalidParams("the parameters are no object")
    try:
        return _converter.structure({k: v for k, v in params.items() if v is not None}, kind)
    except ClassValidationError as error:
        raise JsonRpcInvalidParams("; ".join(transform_error(error))) from None


def _text(value: object, _: object) -> str:
    if not isinstance(value, str):
        raise TypeError
    if len(value) > _LONGEST:
        raise ValueError
    return value


def _truth(value: object, _: object) -> bool:
    if not isinstance(value, bool):
        raise TypeError
    return value


def _whole(value: object, _: object) -> int:
    if not isinstance(value, int) or isinstance(value, bool):
        raise TypeError
    return value


def _number(value: object, _: object) -> float:
    if not isinstance(value, int | float) or isinstance(value, bool):
        raise TypeError
    if not abs(value) < math.inf or abs(value) > 1e300:
        raise ValueError
    return float(value)


def _value(value: object, _: object) -> Value:
    if isinstance(value, bool):
        return value
    return _text(value, str) if isinstance(value, str) else _number(value, float)


def _texts(value: object, _: object) -> Texts:
    if not isinstance(value, list):
        raise TypeError
    return tuple(_text(each, str) for each in value)


def _values(value: object, _: object) -> Values:
    if not isinstance(value, Mapping):
        raise TypeError
    return {_text(name, str): _value(each, Value) for name, each in value.items()}


def _point(value: object, _: object) -> Point:
    if not isinstance(value, list) or len(value) != 2:
        raise TypeError
    return _number(value[0], float), _number(value[1], float)


def _strict() -> Converter:
    """Reads types as they are: the library itself takes `"3"` for a number."""
    made = Converter()
    for kind, hook in {str: _text, bool: _truth, int: _whole, float: _number}.items():
        made.register_structure_hook(kind, hook)
    made.register_structure_hook_func(partial(eq, Value), _value)
    made.register_structure_hook_func(partial(eq, Texts), _texts)
    made.register_structure_hook_func(partial(eq, Values), _values)
    made.register_structure_hook_func(partial(eq, Point), _point)
    return made


_converter = _strict()

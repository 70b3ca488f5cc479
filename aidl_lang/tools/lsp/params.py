"""Parameters of our own requests. Clients may send anything: values of other types are refused."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from operator import eq
from typing import Any, TypeAlias, TypeVar, get_args

from attrs import field, frozen
from cattrs import ClassValidationError, Converter, transform_error
from pygls.exceptions import JsonRpcInvalidParams

Value: TypeAlias = float | str | bool
Texts: TypeAlias = tuple[str, ...]
Values: TypeAlias = dict[str, Value]
Words: TypeAlias = dict[str, str]
Point: TypeAlias = tuple[float, float]
T = TypeVar("T")

_LONGEST = 8_000
"""Most characters of a name or a URI."""


@frozen(kw_only=True)
class OfDocument:
    """Parameters about an open document.

    uri     of the document
    viewer  the asking viewer of the document, as the client calls it
    """

    uri: str
    viewer: str = ""


@frozen(kw_only=True)
class Show(OfDocument):
    """The picture to show: `show` are the layers over the drawing."""

    show: Texts = ()


@frozen(kw_only=True)
class OfVersion(OfDocument):
    """`version` is that of the meant text; None: the text as it is."""

    version: int | None = None


@frozen(kw_only=True)
class DraggedPoint:
    id: str
    to: Point


@frozen(kw_only=True)
class Try(OfVersion):
    """`rests` tells that nothing newer is on the way: what is wrong is then explained."""

    knobs: Values = field(factory=dict)
    drag: DraggedPoint | None = None
    rests: bool = False


@frozen(kw_only=True)
class SetKnob(OfVersion):
    path: str
    value: Value


@frozen(kw_only=True)
class Drag(OfVersion):
    """The parameters for leaving a point where it was dragged."""

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
    """`options` are those of a dialog, as they were typed (see `exports`)."""

    format: str
    show: Texts = ()
    options: Words = field(factory=dict)


@frozen(kw_only=True)
class EntryRequest:
    """The entry of a list of completions that is to be described."""

    uri: str
    list: int
    entry: int


@frozen(kw_only=True)
class ActionRequest:
    """The code action that is to be carried out."""

    uri: str
    version: int
    kind: str
    start: int
    end: int


def read(params: object, kind: type[T]) -> T:
    """Returns the parameters in plain data; null values count as absent. Raises JsonRpcInvalidParams."""
    if not isinstance(params, Mapping):
        raise JsonRpcInvalidParams("the parameters are no object")
    try:
        return _converter.structure({k: v for k, v in params.items() if v is not None}, kind)
    except ClassValidationError as error:
        raise JsonRpcInvalidParams("; ".join(transform_error(error))) from None


_IS: dict[type, Callable[[Any], bool]] = {
    str: lambda value: isinstance(value, str) and len(value) <= _LONGEST,
    bool: lambda value: isinstance(value, bool),
    int: lambda value: type(value) is int,
    float: lambda value: type(value) in (int, float) and abs(value) <= 1e300,
}
"""Checks that plain data has a type without conversion: the library itself takes `"3"` for a number."""


def _plain(value: Any, kind: Any) -> Any:
    if not _IS[kind](value):
        raise ValueError
    return kind(value)


def _value(value: Any, _: object) -> Any:
    return _plain(value, type(value) if isinstance(value, str | bool) else float)


def _mapping(value: Any, kind: Any) -> Any:
    if not isinstance(value, Mapping):
        raise ValueError
    one = _value if kind == Values else _plain
    return {_plain(name, str): one(each, str) for name, each in value.items()}


def _tuple(value: Any, kind: Any) -> Any:
    first, *_ = kinds = get_args(kind)
    if not isinstance(value, list) or (... not in kinds and len(value) != len(kinds)):
        raise ValueError
    return tuple(_plain(each, first) for each in value)


_converter = Converter()
for _kind in _IS:
    _converter.register_structure_hook(_kind, _plain)
_converter.register_structure_hook_func(partial(eq, Value), _value)
_converter.register_structure_hook_func((Values, Words).__contains__, _mapping)
_converter.register_structure_hook_func((Texts, Point).__contains__, _tuple)

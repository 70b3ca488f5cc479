"""Checked reading of values in JSON documents: a wrong one raises a `FormError` that says where it is."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import TypeVar

from tests.solver.problems.notation import LARGEST, FormError, quoted, within

T = TypeVar("T")


class Members:
    """The members of a JSON object, which may only have those that are `known`."""

    def __init__(self, value: object, *known: str) -> None:
        self._values = as_object(value)
        for name in self._values:
            if name not in known:
                raise FormError(f"no member is called {quoted(name)}; there are {', '.join(known)}")

    def __contains__(self, name: str) -> bool:
        return name in self._values

    def read(self, name: str, convert: Callable[[object], T], default: T) -> T:
        """Returns the member `name` as `convert` makes it; `default` if there is none."""
        if name not in self._values:
            return default
        with within(name):
            return convert(self._values[name])

    def table(self, name: str) -> dict[str, object]:
        empty: dict[str, object] = {}
        return self.read(name, as_object, empty)

    def need(self, name: str, convert: Callable[[object], T]) -> T:
        """Returns the member `name` as `convert` makes it; raises `FormError` if there is none."""
        if name not in self._values:
            raise FormError(f"{quoted(name)} is missing")
        with within(name):
            return convert(self._values[name])


def as_object(value: object) -> dict[str, object]:
    if isinstance(value, dict):
        return {as_text(name): member for name, member in value.items()}
    raise _other("an object", value)


def as_list(value: object) -> list[object]:
    if isinstance(value, list):
        return value
    raise _other("a list", value)


def as_text(value: object) -> str:
    if isinstance(value, str):
        return value
    raise _other("a text", value)


def as_flag(value: object) -> bool:
    if isinstance(value, bool):
        return value
    raise _other("true or false", value)


def as_number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise _other("a number", value)
    if not abs(value) <= LARGEST:  # which NaN is not, either
        raise FormError(f"a number between -{LARGEST:g} and {LARGEST:g} is needed")
    return float(value)


def as_positive(value: object) -> float:
    number = as_number(value)
    if number < 1.0 / LARGEST:
        raise FormError(f"a number greater than 0 is needed, not {number:g}")
    return number


def as_not_negative(value: object) -> float:
    number = as_number(value)
    if number < 0.0:
        raise FormError(f"a number that is not below 0 is needed, not {number:g}")
    return number


def as_count(value: object) -> int:
    number = as_not_negative(value)
    if number != int(number):
        raise FormError(f"a whole number is needed, not {number:g}")
    return int(number)


def list_of(convert: Callable[[object], T]) -> Callable[[object], list[T]]:
    """Returns a converter of lists that converts each item."""

    def converted(value: object) -> list[T]:
        items = []
        for index, item in enumerate(as_list(value)):
            with within(f"[{index}]"):
                items.append(convert(item))
        return items

    return converted


def one_of(what: str, known: Collection[str]) -> Callable[[object], str]:
    """Returns a check that takes only the `known` names of things of the kind `what`."""

    def checked(value: object) -> str:
        name = as_text(value)
        if name not in known:
            raise FormError(f"no {what} is called {quoted(name)}")
        return name

    return checked


def _other(needed: str, value: object) -> FormError:
    names = {
        type(None): "null", bool: "true or false", int: "a number", float: "a number",
        str: "a text", list: "a list", dict: "an object",
    }  # fmt: skip
    return FormError(f"{needed} is needed, not {names.get(type(value), type(value).__name__)}")

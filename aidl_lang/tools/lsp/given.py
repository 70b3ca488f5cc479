"""What a request of our own was asked with: a plain dictionary, of which nothing is certain."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NoReturn, TypeAlias

from pygls.exceptions import JsonRpcInvalidParams

Value: TypeAlias = float | str | bool


class Given:
    """Every reader raises JsonRpcInvalidParams where what is there is not what it reads."""

    def __init__(self, params: object) -> None:
        if not isinstance(params, Mapping):
            raise JsonRpcInvalidParams("the parameters are no object")
        self._params = params

    def __contains__(self, name: str) -> bool:
        return self._params.get(name) is not None

    def text(self, name: str) -> str:
        value = self._params.get(name)
        return value if isinstance(value, str) else self._complain(name, "a text")

    def texts(self, name: str) -> tuple[str, ...]:
        """A list of texts, empty where nothing is said."""
        value = self._params.get(name) or []
        if not isinstance(value, list) or not all(isinstance(each, str) for each in value):
            self._complain(name, "a list of texts")
        return tuple(value)

    def whole(self, name: str) -> int:
        value = self._params.get(name)
        if not isinstance(value, int) or isinstance(value, bool):
            self._complain(name, "a whole number")
        return value

    def value(self, name: str) -> Value:
        return self._value(name, self._params.get(name))

    def values(self, name: str) -> dict[str, Value]:
        """Values by name, none where nothing is said."""
        value = self._params.get(name) or {}
        if not isinstance(value, Mapping):
            self._complain(name, "an object")
        return {str(key): self._value(name, each) for key, each in value.items()}

    def point(self, name: str) -> tuple[float, float]:
        value = self._params.get(name)
        if not isinstance(value, list) or len(value) != 2:
            self._complain(name, "two numbers")
        x, y = (self._value(name, each) for each in value)
        if isinstance(x, str | bool) or isinstance(y, str | bool):
            self._complain(name, "two numbers")
        return x, y

    def inner(self, name: str) -> Given:
        return Given(self._params.get(name))

    def _value(self, name: str, value: object) -> Value:
        if isinstance(value, int | float) and not isinstance(value, bool):
            value = float(value) if abs(value) < 1e300 else math.inf
        if isinstance(value, float) and not math.isfinite(value):
            self._complain(name, "a number")
        return value if isinstance(value, float | str | bool) else self._complain(name, "a value")

    def _complain(self, name: str, wanted: str) -> NoReturn:
        raise JsonRpcInvalidParams(f"`{name}` has to be {wanted}")

"""Records: dataclasses that are quick to define and, if frozen, as quick to make as others.

The methods that `dataclasses` writes for a class are compiled while the class is defined, which for a few
hundred classes takes longer than to draw a part. Those of a record are compiled when they are first called.

A frozen dataclass stores each field by way of `object.__setattr__`, so making an object takes three times as
long, and a check makes tens of thousands: nodes, spans, numbers, types. That nobody assigns to a field of a
frozen record is checked where it costs nothing, by mypy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, dataclass, field, fields
from reprlib import recursive_repr
from typing import Any, TypeVar, dataclass_transform

T = TypeVar("T")


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def record(
    *, frozen: bool = True, eq: bool = True, repr: bool = True, kw_only: bool = False, slots: bool = False
) -> Callable[[type[T]], type[T]]:
    """Makes a class a record, as `dataclass(frozen=True, …)` would; one with `eq` is hashed by its fields if
    it is frozen, and otherwise not hashable.
    """

    def made(cls: type[T]) -> type[T]:
        written = {name for name, value in vars(cls).items() if value is not None}  # its own methods stay
        cls.__doc__ = cls.__doc__ or cls.__name__  # dataclass would put the signature there
        # `dataclass` itself works out the fields, inheritance and slots.
        known = dataclass(init=False, repr=False, eq=False, kw_only=kw_only, slots=slots)(cls)
        if "__init__" not in written:
            _compiled_later(known, "__init__", _maker)
        if repr and "__repr__" not in written:
            _add(known, "__repr__", _told)
        if eq and "__eq__" not in written:
            _compiled_later(known, "__eq__", _comparison)
        if eq and "__hash__" not in written:
            if frozen:
                _compiled_later(known, "__hash__", _hash)
            else:
                _add(known, "__hash__", None)
        return known

    return made


def _compiled_later(cls: type, name: str, source: Callable[[type, dict[str, object]], str]) -> None:
    """Gives a class a method whose source is written and compiled when it is first called."""

    def first(self: object, *args: object, **named: object) -> Any:
        space: dict[str, Any] = {}
        exec(source(cls, space), space)
        method = space[name]
        method.__module__ = cls.__module__
        _add(cls, name, method)
        return method(self, *args, **named)

    _add(cls, name, first)


def _add(cls: type, name: str, method: Any) -> None:
    if method is not None:
        method.__qualname__ = f"{cls.__qualname__}.{name}"
    setattr(cls, name, method)


def _maker(cls: type, space: dict[str, object]) -> str:
    """Returns the source of `__init__`; puts the defaults that it needs into its space."""
    space["MISSING"] = MISSING
    positional, named, body = ["self"], ["*"], []
    for each in fields(cls):
        if not each.init:
            continue
        value = parameter = name = each.name
        default = f"default_{name}"
        if each.default_factory is not MISSING:
            space[default] = each.default_factory
            parameter, value = f"{name}=MISSING", f"{default}() if {name} is MISSING else {name}"
        elif each.default is not MISSING:
            space[default] = each.default
            parameter = f"{name}={default}"
        (named if each.kw_only else positional).append(parameter)
        body.append(f"self.{name} = {value}")
    if hasattr(cls, "__post_init__"):
        body.append("self.__post_init__()")
    parameters = ", ".join(positional + named * (len(named) > 1))
    return f"def __init__({parameters}):\n " + "\n ".join(body or ["pass"])


def _comparison(cls: type, _: dict[str, object]) -> str:
    names = [each.name for each in fields(cls) if each.compare]
    return (
        "def __eq__(self, other):\n"
        " if other.__class__ is not self.__class__:\n"
        "  return NotImplemented\n"
        f" return {_gathered('self', names)} == {_gathered('other', names)}"
    )


def _hash(cls: type, _: dict[str, object]) -> str:
    names = [each.name for each in fields(cls) if (each.compare if each.hash is None else each.hash)]
    return f"def __hash__(self):\n return hash({_gathered('self', names)})"


def _gathered(owner: str, names: list[str]) -> str:
    """Returns the source of a tuple of fields."""
    return f"({''.join(f'{owner}.{name}, ' for name in names)})"


@recursive_repr()
def _told(self: Any) -> str:
    shown = (f"{each.name}={getattr(self, each.name)!r}" for each in fields(self) if each.repr)
    return f"{type(self).__qualname__}({', '.join(shown)})"

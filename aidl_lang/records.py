"""Records: dataclasses that the type checker holds to be frozen, and that cost no more than others.

A frozen dataclass stores each field by way of `object.__setattr__`, so making an object takes three times as
long, and a check makes tens of thousands: nodes, spans, numbers, types. That nobody assigns to a field of a
record is checked where it costs nothing, by mypy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeVar, dataclass_transform

T = TypeVar("T")


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def record(
    *, eq: bool = True, repr: bool = True, kw_only: bool = False, slots: bool = False
) -> Callable[[type[T]], type[T]]:
    """What `dataclass(frozen=True, …)` is; with `eq` hashed by its fields, else by identity."""

    def made(cls: type[T]) -> type[T]:
        return dataclass(eq=eq, repr=repr, kw_only=kw_only, slots=slots, unsafe_hash=eq)(cls)

    return made

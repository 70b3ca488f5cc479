"""Arguments arranged for a binding: a pair taken apart, two coordinates made one point."""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.building.values import NOTHING, ListVal, Num, PointVal, Value
from aidl_lang.checking.types import ArgumentSource, Binding
from aidl_lang.checking.units import LENGTH
from aidl_lang.syntax import ast


def arranged(
    binding: Binding, values: Sequence[Value], nodes: Sequence[ast.Node]
) -> tuple[Sequence[Value], Sequence[ast.Node]]:
    """Returns the values that a binding refers to by index, and the text each comes from."""
    if not binding.sources:
        return values, nodes
    return [_value(s, values) for s in binding.sources], [nodes[s.index] for s in binding.sources]


def _value(source: ArgumentSource, values: Sequence[Value]) -> Value:
    value = values[source.index]
    if source.other is not None:
        x, y = value, values[source.other]
        return (
            PointVal(_coordinate(x), _coordinate(y)) if isinstance(x, Num) and isinstance(y, Num) else NOTHING
        )
    match value:
        case PointVal(x, y) if source.part is not None:
            return (x, y)[source.part]
        case ListVal(items) if source.part is not None:
            return items[source.part]
        case _:
            return value


def _coordinate(value: Num) -> Num:
    return Num(value.expression, LENGTH, value.status)

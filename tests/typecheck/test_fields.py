"""The checker's tables of fields say what the builder's do."""

from __future__ import annotations

import pytest

from aidl_lang.building import boxes, curves
from aidl_lang.building.model import Geometry
from aidl_lang.building.values import ListVal, Num, PointVal, Value
from aidl_lang.checking import builtins
from aidl_lang.checking.types import ANY, PRIMITIVES, GeometryType, ListType, NumberType, PointType, Type
from tests.compiled import compiled


@pytest.mark.parametrize("kind", [kind for kind in PRIMITIVES if kind != "traced"])  # made by imports alone
def test_a_primitive_has_each_field_with_the_type_that_the_checker_expects(kind: str) -> None:
    sample = (
        PRIMITIVES[kind].sample.format(x=3, y=7)
        or f'{kind}("a", (0, 0), 5, 0deg, "left", 1, false, false, "DejaVu Sans", false)'
    )
    built = compiled(f"drawing d {{ a = {sample} }}").built
    assert built is not None
    (geometry,) = built.root.own()
    assert geometry.type == kind
    for name, wanted in builtins.PRIMITIVE[kind].items():
        found = curves.field(geometry, name, built.root)
        assert found is not None, name
        assert _type(found) == wanted, name
    assert curves.field(geometry, "nonsense", built.root) is None


def _type(value: Value) -> Type:
    match value:
        case Num(_, dimension, _):
            return NumberType(dimension)
        case PointVal():
            return PointType()
        case ListVal((Geometry(type=kind), *_)):
            return ListType(GeometryType(kind))
        case _:
            return ANY


def test_boxes() -> None:
    assert set(builtins.BOX) == set(boxes.FIELDS)

"""The checker's tables of fields say what the builder's do."""

from __future__ import annotations

from aidl_lang.building import boxes, primitives
from aidl_lang.checking import fields


def test_primitives() -> None:
    assert set(fields.PRIMITIVE) == set(primitives.FIELDS)
    for kind, names in primitives.FIELDS.items():
        assert set(names) <= set(fields.PRIMITIVE[kind])


def test_boxes() -> None:
    assert set(fields.BOX) == set(boxes.FIELDS)

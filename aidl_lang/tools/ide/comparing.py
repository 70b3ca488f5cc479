"""Compares the drawings of two outcomes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields, is_dataclass

from aidl_lang.geometry.curves import Vec
from aidl_lang.geometry.solved import SolvedStructure
from aidl_lang.pipeline import Compiled

SAME = 1e-6
"""Largest difference of two equal drawings, mm."""


def is_same(before: Compiled, after: Compiled, *, slid: bool = False, tolerance: float = SAME) -> bool:
    """Tells whether two outcomes draw the same, name by name; with `slid`, wherever the drawing as a whole
    lies.
    """

    def is_near(a: float, b: float) -> bool:
        return abs(a - b) <= tolerance or (math.isnan(a) and math.isnan(b))

    if before.model is None or after.model is None or before.status != after.status:
        return False
    one, other = (list(_drawn(model.root, slid)) for model in (before.model, after.model))
    return len(one) == len(other) and all(
        name == path and len(a) == len(b) and all(map(is_near, a, b))
        for (name, a), (path, b) in zip(one, other, strict=True)
    )


def _drawn(root: SolvedStructure, slid: bool) -> Iterator[tuple[str, list[float]]]:
    """Yields the path of each thing in a drawing with the numbers that define it."""
    at = (root.box.left, root.box.bottom) if slid and root.box is not None else (0.0, 0.0)
    for structure in root.walk():
        box = structure.box
        corners = [] if box is None else [(box.left, box.bottom), (box.right, box.top)]
        yield structure.path, list(_numbers(corners, at))
        for geometry in structure.drawn:
            for part in geometry.walk():
                place = part.values.get("at") if part.type == "point" else None
                yield f"{part.path}: {part.type}", list(_numbers((part.curve, place), at))


def _numbers(value: object, at: Vec) -> Iterator[float]:
    """Yields the numbers of a curve or a point; a pair is a place, taken relative to `at`."""
    match value:
        case (float() as x, float() as y):
            yield from (x - at[0], y - at[1])
        case float():
            yield value
        case tuple() | list():
            for item in value:
                yield from _numbers(item, at)
        case _ if is_dataclass(value):
            for field in fields(value):
                yield from _numbers(getattr(value, field.name), at)
        case _:
            pass

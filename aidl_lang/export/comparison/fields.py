"""The numbers and words of a structure or geometry, and which of them differ."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TypeGuard

from aidl_lang.export.comparison.changes import Value
from aidl_lang.export.comparison.move import STILL, Move
from aidl_lang.geometry.curves import Arc, Line, Vec
from aidl_lang.geometry.measures import measure
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import Scalar, SolvedGeometry, SolvedStructure

RELATIVE, ABSOLUTE = 1e-6, 1e-9
Values = Mapping[str, Value]
Changed = dict[str, tuple[Value, Value]]


def changed(a: Values, b: Values, move: Move = STILL, tolerance: float = 0.0) -> Changed:
    """Returns the values that differ, in order of writing after. Points that moved by `move` count as
    equal.
    """
    return {
        name: (a.get(name), b.get(name))
        for name in dict.fromkeys([*b, *a])
        if not _went(a.get(name), b.get(name), move, tolerance)
        and not is_same(a.get(name), b.get(name), name)
    }


def is_same(a: Value, b: Value, name: str = "") -> bool:
    """True for equal values: numbers to 1e-6 of themselves, angles up to whole turns."""
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(map(is_same, a, b))
    if _is_number(a) and _is_number(b):
        difference = math.remainder(a - b, 360) if "angle" in name else a - b
        return abs(difference) <= RELATIVE * max(abs(a), abs(b)) + ABSOLUTE
    return type(a) is type(b) and a == b


def _went(a: Value, b: Value, move: Move, tolerance: float) -> bool:
    return _is_point(a) and _is_point(b) and math.dist(move(a), b) <= tolerance


def _is_number(value: Value) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_point(value: Value) -> TypeGuard[Vec]:
    return isinstance(value, tuple) and len(value) == 2 and all(isinstance(x, float) for x in value)


def settings(s: SolvedStructure) -> dict[str, Value]:
    """Returns the kind, the attributes and the finished corners of a structure."""
    found: dict[str, Value] = {"kind": s.kind}
    for name, values in s.attributes.items():
        found[f"@{name}"] = _plain(values) if values else True
    for finish in s.finishes:
        name, number = f"{finish.kind} of {finish.text}", 2
        while name in found:
            name, number = f"{finish.kind} {number} of {finish.text}", number + 1
        found[name] = _plain(finish.sizes)
    return found


def _plain(values: tuple[Scalar, ...]) -> Value:
    return values[0] if len(values) == 1 else values


def sizes(s: SolvedStructure, region: Region | None) -> dict[str, Value]:
    """Returns the size of the box and, for material or a hole, the measures of the region."""
    found: dict[str, Value] = {}
    if s.box is not None:
        found |= {"width": s.box.width, "height": s.box.height}
    if region:
        measures = measure(region)
        found |= {"area": measures.area, "perimeter": measures.perimeter, "centroid": measures.centroid}
    return found


def of_geometry(a: SolvedGeometry, b: SolvedGeometry, move: Move, tolerance: float) -> Changed:
    """Returns the changed fields of a geometry that did not move as a whole; for an outline its corners and
    radii.
    """
    if a.type != b.type:
        return {"type": (a.type, b.type)}
    first, last = _values(a), _values(b)
    both = {name: first[name] for name in first if name in last}, {n: last[n] for n in last if n in first}
    found = changed(*both, move, tolerance)
    if found or not b.parts:
        return found
    corners = dict(_corners(a)), dict(_corners(b))
    return changed(*corners, move, tolerance) | changed(dict(_radii(a)), dict(_radii(b)))


def _values(g: SolvedGeometry) -> dict[str, Value]:
    found: dict[str, Value] = {}
    for name, value in g.values.items():
        if isinstance(value, tuple) and value and isinstance(value[0], tuple):
            found |= {f"{name}[{i}]": p for i, p in enumerate(value) if isinstance(p, tuple)}
        else:
            found[name] = value  # type: ignore[assignment]
    if isinstance(g.curve, Line):
        x, y = (q - p for p, q in zip(g.curve.start, g.curve.end, strict=True))
        found |= {"length": math.hypot(x, y), "angle": math.degrees(math.atan2(y, x))}
    if isinstance(g.curve, Arc):
        found["sweep"] = math.degrees(abs(g.curve.sweep))
    return found


def _corners(g: SolvedGeometry, prefix: str = "") -> Iterator[tuple[str, Value]]:
    for part in g.parts:
        if part.type == "point":
            yield prefix + part.name, part.values["at"]  # type: ignore[misc]
        yield from _corners(part, f"{prefix}{part.name}.")


def _radii(g: SolvedGeometry, prefix: str = "") -> Iterator[tuple[str, Value]]:
    for part in g.parts:
        for name in ("radius", "rx", "ry"):
            if name in part.values:
                yield f"{prefix}{part.name}.{name}", part.values[name]  # type: ignore[misc]
        yield from _radii(part, f"{prefix}{part.name}.")

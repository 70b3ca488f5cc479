"""Small solved models written by hand."""

from __future__ import annotations

import math
from dataclasses import replace

from aidl_lang.geometry.curves import Arc, Circle, Curve, Line, Vec
from aidl_lang.geometry.solved import (
    Box,
    Frame,
    Scalar,
    SolvedGeometry,
    SolvedModel,
    SolvedStructure,
    described,
)


def arc(center: Vec, radius: float, first: float, last: float) -> Arc:
    """From and to angles in degrees; clockwise if `last` is smaller."""

    def at(angle: float) -> Vec:
        a = math.radians(angle)
        return center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)

    return Arc(center, radius, at(first), at(last), math.radians(last - first))


def primitive(name: str, curve: Curve, construction: bool = False) -> SolvedGeometry:
    kind, values = described(curve)
    return SolvedGeometry(name, name, kind, values, curve, (), construction, None)


def compound(name: str, *curves: Curve, type_: str = "polygon") -> SolvedGeometry:
    parts = tuple(primitive(f"edges[{i}]", c) for i, c in enumerate(curves))
    return SolvedGeometry(name, name, type_, {}, None, parts, False, None)


def polygon(name: str, *corners: Vec) -> SolvedGeometry:
    lines = [Line(p, q) for p, q in zip(corners, corners[1:] + corners[:1], strict=True)]
    return compound(name, *lines)


def rectangle(name: str, left: float, bottom: float, right: float, top: float) -> SolvedGeometry:
    return polygon(name, (left, bottom), (right, bottom), (right, top), (left, top))


def circle(name: str, x: float, y: float, r: float) -> SolvedGeometry:
    return primitive(name, Circle((x, y), r))


def structure(
    kind: str,
    name: str,
    *members: SolvedGeometry | SolvedStructure,
    box: Box | None = None,
    **attributes: tuple[Scalar, ...],
) -> SolvedStructure:
    geometry = tuple(m for m in members if isinstance(m, SolvedGeometry))
    children = tuple(m for m in members if isinstance(m, SolvedStructure))
    box = box or Box.around((c for g in geometry for c in g.curves()), children)
    known = attributes, {}, geometry, children, box, not members, None
    return SolvedStructure(name, name, kind, "top", Frame(0.0, 0.0, 0.0), *known)


def model(root: SolvedStructure) -> SolvedModel:
    return SolvedModel("solved", _with_paths(root, ""))


def _with_paths(s: SolvedStructure, prefix: str) -> SolvedStructure:
    path = f"{prefix}{s.name}"

    def below(g: SolvedGeometry, prefix: str) -> SolvedGeometry:
        path = f"{prefix}.{g.name}"
        return replace(g, path=path, parts=tuple(below(p, path) for p in g.parts))

    return replace(
        s,
        path=path,
        geometry=tuple(below(g, path) for g in s.geometry),
        structures=tuple(_with_paths(c, f"{path}.") for c in s.structures),
    )

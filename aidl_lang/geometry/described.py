"""Curves that were worked out as geometry of a solved model."""

from __future__ import annotations

import math

from aidl_lang.geometry.curves import FIELDS, Bezier, Piece
from aidl_lang.geometry.solved import SolvedGeometry, Values


def as_geometry(name: str, of: SolvedGeometry, curve: Piece, around: str = "") -> SolvedGeometry:
    """Returns a curve as a geometry: a part of another, or beside it in a structure."""
    kind, values = described(curve)
    path = f"{around or of.path}.{name}"
    return SolvedGeometry(name, path, kind, values, curve, (), False, of.span)


def described(curve: Piece) -> tuple[str, Values]:
    """Returns the type and the fields of a curve."""
    if isinstance(curve, Bezier):
        return curve.kind, {"points": (curve.p0, curve.p1, curve.p2, curve.p3)}
    values: Values = {}
    for name in FIELDS[type(curve)]:
        value = getattr(curve, name)
        if name == "sweep":
            values["clockwise"] = value < 0
        elif name != "first":
            values[name] = math.degrees(value) if name == "angle" else value
    return curve.kind, values

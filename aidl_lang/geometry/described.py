"""Curves that were worked out as geometry of a solved model."""

from __future__ import annotations

import math

from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line, Piece, Vec
from aidl_lang.geometry.solved import Scalar, SolvedGeometry


def as_geometry(name: str, of: SolvedGeometry, curve: Piece, around: str = "") -> SolvedGeometry:
    """A curve as a geometry: a part of another, or beside it in a structure."""
    kind, values = described(curve)
    path = f"{around or of.path}.{name}"
    return SolvedGeometry(name, path, kind, values, curve, (), False, of.span)


def described(curve: Piece) -> tuple[str, dict[str, Scalar | Vec | tuple[Vec, ...]]]:
    """The type and the fields of a curve."""
    match curve:
        case Line(start, end):
            return "line", {"start": start, "end": end}
        case Circle(center, radius):
            return "circle", {"center": center, "radius": radius}
        case Arc(center, radius, start, end, sweep):
            return "arc", {
                "center": center,
                "radius": radius,
                "start": start,
                "end": end,
                "clockwise": sweep < 0,
            }
        case Bezier(p0, p1, p2, p3):
            return "bezier", {"points": (p0, p1, p2, p3)}
        case Ellipse(center, rx, ry, angle):
            return "ellipse", {"center": center, "rx": rx, "ry": ry, "angle": math.degrees(angle)}
        case EllipseArc(center, rx, ry, angle, start, end, _, sweep):
            return "ellipse_arc", {
                "center": center,
                "rx": rx,
                "ry": ry,
                "angle": math.degrees(angle),
                "start": start,
                "end": end,
                "clockwise": sweep < 0,
            }

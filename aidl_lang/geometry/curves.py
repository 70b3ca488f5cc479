"""Exact curves in the plane: numbers only, millimetres and radians."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any, ClassVar, TypeAlias, get_args

from aidl_lang.common.records import record

Vec: TypeAlias = tuple[float, float]


@record(slots=True)
class Line:
    kind: ClassVar = "line"
    start: Vec
    end: Vec


@record(slots=True)
class Arc:
    """From `start` about `center` through `sweep` radians, positive counter-clockwise, 0 < |sweep| <= 2 pi.

    `end` is stored, so that chained curves share their end points to the last digit.
    """

    kind: ClassVar = "arc"
    center: Vec
    radius: float
    start: Vec
    end: Vec
    sweep: float

    @property
    def start_angle(self) -> float:
        return math.atan2(self.start[1] - self.center[1], self.start[0] - self.center[0])


@record(slots=True)
class Circle:
    kind: ClassVar = "circle"
    center: Vec
    radius: float


@record(slots=True)
class Ellipse:
    """`rx` along `angle` (radians from the x axis), `ry` across it."""

    kind: ClassVar = "ellipse"
    center: Vec
    rx: float
    ry: float
    angle: float


@record(slots=True)
class Bezier:
    """A cubic by its four control points."""

    kind: ClassVar = "bezier"
    p0: Vec
    p1: Vec
    p2: Vec
    p3: Vec


@record(slots=True)
class EllipseArc:
    """A piece of an ellipse, as booleans leave it, through `sweep` radians of the eccentric anomaly.

    Its points are center + R(angle) (rx cos u, ry sin u) for u from `first` to `first + sweep`.
    """

    kind: ClassVar = "ellipse_arc"
    center: Vec
    rx: float
    ry: float
    angle: float
    start: Vec
    end: Vec
    first: float
    sweep: float


Curve: TypeAlias = Line | Arc | Circle | Ellipse | Bezier
Piece: TypeAlias = Line | Arc | Circle | Ellipse | EllipseArc | Bezier
"""A curve of an outline of a region, or an exact part of one."""

FIELDS = {kind: tuple(field.name for field in fields(kind)) for kind in get_args(Piece)}
"""The numbers and points of each curve by their names: what `angle` is a direction, `first` and `sweep` run
counter-clockwise, and any other number a length.
"""

KINDS = frozenset(kind.kind for kind in FIELDS)


def image(
    curve: Piece,
    at: Callable[[Vec], Vec],
    scale: float = 1.0,
    turned: Callable[[float], float] = lambda direction: direction,
    sense: float = 1.0,
) -> Piece:
    """Returns the curve after a similarity, given as maps of points, lengths, directions and turns."""

    def moved(name: str, value: Any) -> Any:
        if isinstance(value, tuple):
            return at(value)
        if name == "angle":
            return turned(value)
        return (sense if name in ("first", "sweep") else scale) * value

    return replace(curve, **{name: moved(name, getattr(curve, name)) for name in FIELDS[type(curve)]})

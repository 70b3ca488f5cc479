"""Kinds of links between points and circles: what each measures, and what becomes of that when all moves."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from .build import E, call, distance

Place: TypeAlias = tuple[E, E]
Round: TypeAlias = tuple[Place, E]
"""Centre and radius."""


def _minus(a: Place, b: Place) -> Place:
    return a[0] - b[0], a[1] - b[1]


def _cross(u: Place, v: Place) -> E:
    return u[0] * v[1] - u[1] * v[0]


def _dot(u: Place, v: Place) -> E:
    return u[0] * v[0] + u[1] * v[1]


def _length(u: Place) -> E:
    return call("hypot", *u)


def _direction(a: Place, b: Place) -> E:
    u = _minus(b, a)
    return call("atan2", u[1], u[0])


def _angle(a: Place, b: Place, c: Place, d: Place) -> E:
    u, v = _minus(b, a), _minus(d, c)
    return call("atan2", _cross(u, v), _dot(u, v))


def _of_unit(product: Callable[[Place, Place], E]) -> Callable[..., E]:
    def measure(a: Place, b: Place, c: Place, d: Place) -> E:
        u, v = _minus(b, a), _minus(d, c)
        return product(u, v) / (_length(u) * _length(v))

    return measure


def _beside(p: Place, a: Place, b: Place) -> E:
    """How far `p` is to the left of the line."""
    u = _minus(b, a)
    return _cross(u, _minus(p, a)) / _length(u)


def _from_middle(p: Place, a: Place, b: Place) -> Place:
    return p[0] - (a[0] + b[0]) * 0.5, p[1] - (a[1] + b[1]) * 0.5


def _mirrored(p: Place, q: Place, a: Place, b: Place) -> Place:
    """How far the middle of `p` and `q` is off the line, and how much they differ along it."""
    u = _minus(b, a)
    middle = ((p[0] + q[0]) * 0.5, (p[1] + q[1]) * 0.5)
    return _beside(middle, a, b), _dot(_minus(p, q), u) / _length(u)


def _arc_length(c: Round, start: Place, end: Place) -> E:
    return c[1] * ((_direction(c[0], end) - _direction(c[0], start)) % (2.0 * math.pi))


def _gap(axis: int) -> Callable[..., E]:
    def measure(a: Place, b: Place, c: Place, d: Place) -> E:
        return call("minimum", c[axis], d[axis]) - call("maximum", a[axis], b[axis])

    return measure


def _extent(axis: int) -> Callable[..., E]:
    def measure(a: Place, b: Place, c: Place) -> E:
        return call("maximum", a[axis], b[axis], c[axis]) - call("minimum", a[axis], b[axis], c[axis])

    return measure


@dataclass(frozen=True)
class Kind:
    """
    operands of each a letter: p for a point, c for a circle
    measure  what is compared with a number, or a pair of that
    apart    operands that must not coincide, or it has no derivative
    rigid    whether it stays what it is when the plane is turned
    mirrored sign that it takes when x changes sign; 0 where that makes something else of it
    swapped  its name when x and y change places, if it has another one, or none but the same rows
    length   whether it is a length, else a ratio or an angle
    turn     whether it is an angle, which counts modulo a turn
    """

    operands: str
    measure: Callable[..., E | Place]
    apart: tuple[tuple[int, int], ...] = ()
    rigid: bool = True
    mirrored: int = 1
    swapped: str = ""
    length: bool = True
    turn: bool = False


FIRST, LAST, BOTH = ((0, 1),), ((2, 3),), ((0, 1), (2, 3))
"""Of four points, those that make a line."""

KINDS: dict[str, Kind] = {
    "distance": Kind("pp", distance, FIRST),
    "offset_x": Kind("pp", lambda p, q: q[0] - p[0], rigid=False, mirrored=-1, swapped="offset_y"),
    "offset_y": Kind("pp", lambda p, q: q[1] - p[1], rigid=False, swapped="offset_x"),
    "x": Kind("p", lambda p: p[0], rigid=False, mirrored=-1, swapped="y"),
    "y": Kind("p", lambda p: p[1], rigid=False, swapped="x"),
    "coincident": Kind("pp", _minus, mirrored=0, swapped="coincident"),
    "direction": Kind("pp", _direction, FIRST, mirrored=-1, length=False, turn=True),
    "angle": Kind("pppp", _angle, BOTH, mirrored=-1, length=False, turn=True),
    "parallel": Kind("pppp", _of_unit(_cross), BOTH, mirrored=-1, length=False),
    "perpendicular": Kind("pppp", _of_unit(_dot), BOTH, length=False),
    "on_line": Kind("ppp", _beside, ((1, 2),), mirrored=-1),
    "equal_length": Kind("pppp", lambda a, b, c, d: distance(a, b) - distance(c, d), BOTH),
    "midpoint": Kind("ppp", _from_middle, mirrored=0, swapped="midpoint"),
    "symmetric": Kind("pppp", _mirrored, LAST, mirrored=0),
    "radius": Kind("c", lambda c: c[1]),
    "equal_radius": Kind("cc", lambda c, d: c[1] - d[1]),
    "on_circle": Kind("cp", lambda c, p: distance(c[0], p) - c[1], FIRST),
    "tangent_line": Kind("cpp", lambda c, a, b: _beside(c[0], a, b) - c[1], ((1, 2),), mirrored=0),
    "tangent_outside": Kind("cc", lambda c, d: distance(c[0], d[0]) - (c[1] + d[1]), FIRST),
    "tangent_inside": Kind("cc", lambda c, d: distance(c[0], d[0]) - (c[1] - d[1]), FIRST),
    "arc_length": Kind("cpp", _arc_length, ((0, 1), (0, 2)), mirrored=0),
    "gap_x": Kind("pppp", _gap(0), rigid=False, mirrored=0, swapped="gap_y"),
    "gap_y": Kind("pppp", _gap(1), rigid=False, mirrored=0, swapped="gap_x"),
    "extent_x": Kind("ppp", _extent(0), rigid=False, swapped="extent_y"),
    "extent_y": Kind("ppp", _extent(1), rigid=False, swapped="extent_x"),
}
OPPOSITE = {"=": "=", "<=": ">=", ">=": "<="}
BRANCHED = frozenset({"gap_x", "gap_y", "extent_x", "extent_y"})
SMOOTH = tuple(name for name in KINDS if name not in BRANCHED)

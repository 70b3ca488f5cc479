"""Many curves as a table of numbers, for points on all of them at once."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from aidl_lang.geometry.curves import Arc, Bezier, Circle, Line, Piece
from aidl_lang.geometry.evaluate import is_closed, round_range

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
_POWERS = np.array([[1, 0, 0, 0], [-3, 3, 0, 0], [3, -6, 3, 0], [-1, 3, -3, 1]])
"""Coefficients of 1, t, t² and t³ of a cubic, from its control points."""


class Table:
    """Curves with a row each: the coefficients of a cubic or a line, else centre, half-axes, their direction,
    first angle and sweep.
    """

    def __init__(self, curves: Sequence[Piece]) -> None:
        self.curves = curves
        self.is_round = np.array([not isinstance(curve, Line | Bezier) for curve in curves], dtype=np.bool_)
        self.is_closed = np.array([is_closed(curve) for curve in curves], dtype=np.bool_)
        self.rows = np.array([_row(curve) for curve in curves]).reshape(-1, 8)
        cubic = ~self.is_round
        self.rows[cubic] = (_POWERS @ self.rows[cubic].reshape(-1, 4, 2)).reshape(-1, 8)

    def at(self, curves: Ints, t: Floats, order: int = 0) -> Floats:
        """Returns the points at parameters of some curves and their derivatives up to an order, by it."""
        found = np.empty((order + 1, len(t), 2))
        is_round = self.is_round[curves]
        if not is_round.all():
            c, u = self.rows[curves[~is_round]].reshape(-1, 4, 2), t[~is_round, None]
            found[0, ~is_round] = ((c[:, 3] * u + c[:, 2]) * u + c[:, 1]) * u + c[:, 0]
            if order:
                found[1, ~is_round] = (3 * c[:, 3] * u + 2 * c[:, 2]) * u + c[:, 1]
            if order > 1:
                found[2, ~is_round] = 6 * c[:, 3] * u + 2 * c[:, 2]
        if is_round.any():
            x, y, rx, ry, cos, sin, first, sweep = self.rows[curves[is_round]].T
            u = first + sweep * t[is_round]
            for k in range(order + 1):
                far = sweep**k
                along, across = far * rx * np.cos(u + k * math.pi / 2), far * ry * np.sin(u + k * math.pi / 2)
                found[k, is_round] = np.stack(
                    (cos * along - sin * across, sin * along + cos * across), axis=1
                )
            found[0, is_round] += np.stack((x, y), axis=1)
        return found

    def within(self, curves: Ints, t: Floats) -> Floats:
        """Returns parameters brought back onto curves: round closed ones, to the ends of others."""
        return np.where(self.is_closed[curves], t % 1.0, np.clip(t, 0.0, 1.0))


def cross(u: Floats, v: Floats) -> Floats:
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def dot(u: Floats, v: Floats) -> Floats:
    return u[..., 0] * v[..., 0] + u[..., 1] * v[..., 1]


def long(u: Floats) -> Floats:
    return np.hypot(u[..., 0], u[..., 1])


def _row(curve: Piece) -> tuple[float, ...]:
    if isinstance(curve, Line):
        (x, y), (u, v) = curve.start, curve.end
        return x, y, x + (u - x) / 3, y + (v - y) / 3, u - (u - x) / 3, v - (v - y) / 3, u, v
    if isinstance(curve, Bezier):
        return *curve.p0, *curve.p1, *curve.p2, *curve.p3
    if isinstance(curve, Arc | Circle):
        return *curve.center, curve.radius, curve.radius, 1.0, 0.0, *round_range(curve)
    turn = math.cos(curve.angle), math.sin(curve.angle)
    return *curve.center, curve.rx, curve.ry, *turn, *round_range(curve)

"""Proofs, for many pairs of curves at once, that two curves meet at most in an end that they share.

Every curve is cut into `PARTS` parts, each within the hull of four points. Two curves are apart where no
boxes of their parts meet; beside a shared end they are where a straight line through it has all of one on one
side and all of the other on the other. In a drawing this is so of nearly every pair, and no crossing need be
sought (`intersect`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Line, Piece
from aidl_lang.geometry.evaluate import ends, round_range

PARTS = 8
_ANGLE = 0.2
"""Radians that must be free beyond a straight angle, for curves to be apart on both sides of an end."""
_MARGIN = 4
"""Distance in tolerances that boxes must have: a crossing may be that far from where both curves are."""
_AT_ONCE = 1 << 14
"""Pairs that are compared in one step, which bounds the memory."""
_REACHES = (PARTS, PARTS // 2, 1)
"""Numbers of parts beside a shared end that a line through it separates."""

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]


def _cutting() -> Floats:
    """Returns the matrix that makes the control points of the parts, four each, from those of a whole
    cubic.
    """
    rows = []
    for k in range(PARTS):
        a, b = k / PARTS, (k + 1) / PARTS
        blends = ((a, a, a), (a, a, b), (a, b, b), (b, b, b))
        rows += [_blossom(*blend) for blend in blends]
    return np.array(rows)


def _blossom(r: float, s: float, t: float) -> list[float]:
    """Returns the shares of the control points in the blossom of a cubic (Farin, Curves and Surfaces, ch.
    4).
    """
    u, v, w = 1 - r, 1 - s, 1 - t
    return [u * v * w, r * v * w + u * s * w + u * v * t, r * s * w + r * v * t + u * s * t, r * s * t]


_CUTTING = _cutting()


def meeting(curves: Sequence[Piece], pairs: Ints, tolerance: float, nodes: Ints, places: Floats) -> Ints:
    """Returns those of some pairs of curves that may meet in more than an end they share.

    nodes   by curve, which points its two ends are
    places  where these points are
    """
    hulls, kept = _Hulls(curves, tolerance), np.zeros(len(pairs), dtype=np.bool_)
    for begin in range(0, len(pairs), _AT_ONCE):
        checkpoint()
        rows = slice(begin, begin + _AT_ONCE)
        kept[rows] = hulls.may_meet(pairs[rows, 0], pairs[rows, 1], nodes, places)
    found: Ints = pairs[kept]
    return found


class _Hulls:
    """The hulls of all parts of some curves, and the boxes of these."""

    def __init__(self, curves: Sequence[Piece], tolerance: float) -> None:
        self._hulls = _hulls(curves)
        self._least = 2 * tolerance
        margin = _MARGIN * tolerance / 2
        # One axis after the other: a reduction over an axis of length two is slow.
        self._low = np.moveaxis(self._hulls.min(axis=2) - margin, 2, 0).copy()
        self._high = np.moveaxis(self._hulls.max(axis=2) + margin, 2, 0).copy()

    def may_meet(self, one: Ints, other: Ints, nodes: Ints, places: Floats) -> Mask:
        meets = np.ones((len(one), PARTS, PARTS), dtype=np.bool_)
        for low, high in zip(self._low, self._high, strict=True):
            meets &= low[one][:, :, None] <= high[other][:, None]
            meets &= low[other][:, None] <= high[one][:, :, None]
        for end, across in product((0, 1), (0, 1)):
            shared = nodes[one, end]
            rows = np.flatnonzero(shared == nodes[other, across])
            for reach in _REACHES:
                rows = rows[meets[rows].any(axis=(1, 2))]
                ours, theirs = _beside(end, reach), _beside(across, reach)
                a, b = self._hulls[one[rows], ours], self._hulls[other[rows], theirs]
                apart = rows[self._on_two_sides(a, b, places[shared[rows]])]
                meets[apart, ours, theirs] = False
        return np.asarray(meets.any(axis=(1, 2)), dtype=np.bool_)

    def _on_two_sides(self, ours: Floats, theirs: Floats, spots: Floats) -> Mask:
        """Tells whether a straight line through a spot tells some parts from others. Points that are as good
        as the spot itself are on either side.
        """
        at = spots[:, None, None]
        ways = np.concatenate((at - ours, theirs - at), axis=1)
        ways = ways.reshape(len(ways), ways.shape[1] * 4, 2)
        angles = np.arctan2(ways[..., 1], ways[..., 0])
        counts = np.hypot(ways[..., 0], ways[..., 1]) > self._least
        some = np.take_along_axis(angles, counts.argmax(axis=1)[:, None], axis=1)
        angles = np.sort(np.where(counts, angles, some), axis=1)
        free = np.diff(angles, axis=1, append=angles[:, :1] + 2 * math.pi).max(axis=1)
        apart: Mask = (free > math.pi + _ANGLE) & counts.any(axis=1)
        return apart


def _beside(end: int, reach: int) -> slice:
    """Returns the parts of a curve that lie beside its start (0) or its end (1)."""
    return slice(PARTS - reach, PARTS) if end else slice(0, reach)


def _hulls(curves: Sequence[Piece]) -> Floats:
    """Returns the four points around each part of each curve."""
    hulls = np.empty((len(curves), PARTS, 4, 2))
    cubic = [k for k, curve in enumerate(curves) if isinstance(curve, Line | Bezier)]
    if cubic:
        control = np.array([_control(curves[k]) for k in cubic])
        hulls[cubic] = (_CUTTING @ control).reshape(-1, PARTS, 4, 2)
    if len(cubic) < len(curves):
        is_round = np.ones(len(curves), dtype=np.bool_)
        is_round[cubic] = False
        rounds = np.flatnonzero(is_round)
        hulls[rounds] = _round_hulls([curves[k] for k in rounds.tolist()])
    if len(curves):  # what was stored is where it ends
        hulls[:, 0, 0], hulls[:, -1, 3] = np.array([ends(curve) for curve in curves]).transpose(1, 0, 2)
    return hulls


def _control(curve: Piece) -> tuple[tuple[float, float], ...]:
    if isinstance(curve, Bezier):
        return curve.p0, curve.p1, curve.p2, curve.p3
    (x0, y0), (x1, y1) = ends(curve)
    dx, dy = (x1 - x0) / 3, (y1 - y0) / 3
    return (x0, y0), (x0 + dx, y0 + dy), (x1 - dx, y1 - dy), (x1, y1)


def _round_hulls(curves: Sequence[Piece]) -> Floats:
    """Returns the ends of each part of a round curve with, twice, the meeting of the tangents in them."""
    rows = []
    for curve in curves:
        assert not isinstance(curve, Line | Bezier)
        if isinstance(curve, Arc | Circle):
            axes = curve.radius, curve.radius, 0.0
        else:
            axes = curve.rx, curve.ry, curve.angle
        rows.append((*curve.center, *axes, *round_range(curve)))
    x, y, rx, ry, turn, first, sweep = np.array(rows).T[:, :, None]
    u = first + sweep * np.arange(2 * PARTS + 1) / (2 * PARTS)
    far = np.where(np.arange(2 * PARTS + 1) % 2, 1 / np.cos(sweep / (2 * PARTS)), 1.0)
    along, across = rx * far * np.cos(u), ry * far * np.sin(u)
    spots = np.stack(
        (x + along * np.cos(turn) - across * np.sin(turn), y + along * np.sin(turn) + across * np.cos(turn)),
        axis=2,
    )
    ends_, corners = spots[:, ::2], spots[:, 1::2]
    return np.stack((ends_[:, :-1], corners, corners, ends_[:, 1:]), axis=2)

"""Proofs, for many pairs of curves at once, that two curves meet at most in an end that they share.

Every curve is cut into `PARTS` parts, each within the hull of four points. Two curves are apart where no
boxes of their parts meet; beside a shared end they are where a straight line through it has all of one on one
side and all of the other on the other. In a drawing this is so of nearly every pair, and no crossing need be
sought (`intersect`).
"""

from __future__ import annotations

import math
from itertools import product

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.evaluate import ends
from aidl_lang.geometry.tables import Table

PARTS = 8
_NO_PLACES = np.zeros((0, 2))
_ANGLE = 0.2
"""Radians that must be free beyond a straight angle, for curves to be apart on both sides of an end."""
_MARGIN = 4
"""Distance in tolerances that boxes must have: a crossing may be that far from where both curves are."""
_AT_ONCE = 1 << 14
"""Pairs that are compared in one step, which bounds the memory."""
_REACHES = (PARTS, PARTS // 2, 1)
"""Numbers of parts beside a shared end that a line through it separates."""

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Mask = NDArray[np.bool_]


class Hulls:
    """The hulls of all parts of some curves, and the boxes of these."""

    def __init__(self, table: Table, tolerance: float) -> None:
        self._hulls = _hulls(table)
        self._least = 2 * tolerance
        margin = _MARGIN * tolerance / 2
        # One axis after the other: a reduction over an axis of length two is slow.
        self._low = np.moveaxis(self._hulls.min(axis=2) - margin, 2, 0).copy()
        self._high = np.moveaxis(self._hulls.max(axis=2) + margin, 2, 0).copy()

    def meeting(self, pairs: Ints, nodes: Ints | None = None, places: Floats = _NO_PLACES) -> Ints:
        """Returns those of some pairs of curves that may meet in more than an end they share.

        nodes   by curve, which points its two ends are; without it they share none
        places  where these points are
        """
        if nodes is None:
            nodes = np.arange(2 * len(self._hulls)).reshape(-1, 2)
        kept = np.zeros(len(pairs), dtype=np.bool_)
        for begin in range(0, len(pairs), _AT_ONCE):
            checkpoint()
            rows = slice(begin, begin + _AT_ONCE)
            kept[rows] = self._may_meet(pairs[rows, 0], pairs[rows, 1], nodes, places)
        found: Ints = pairs[kept]
        return found

    def may_hold(self, curves: Ints, spots: Floats) -> Mask:
        """Tells of some curves whether each may pass a spot."""
        inside = np.ones((len(curves), PARTS), dtype=np.bool_)
        for low, high, place in zip(self._low, self._high, spots.T, strict=True):
            inside &= (low[curves] <= place[:, None]) & (place[:, None] <= high[curves])
        return np.asarray(inside.any(axis=1), dtype=np.bool_)

    def _may_meet(self, one: Ints, other: Ints, nodes: Ints, places: Floats) -> Mask:
        meets = np.ones((len(one), PARTS, PARTS), dtype=np.bool_)
        for low, high in zip(self._low, self._high, strict=True):
            meets &= low[one][:, :, None] <= high[other][:, None]
            meets &= low[other][:, None] <= high[one][:, :, None]
        for end, across in product((0, 1), (0, 1)):
            shared = nodes[one, end]
            rows = np.flatnonzero(shared == nodes[other, across])
            for reach in _REACHES:
                rows = rows[meets[rows].any(axis=(1, 2))] if len(rows) else rows
                if not len(rows):
                    break
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


def _hulls(table: Table) -> Floats:
    """Returns the four points around each part of each curve: its ends, and on the tangents in them the inner
    control points of a cubic, or twice the meeting of the tangents of a round curve.
    """
    count, marks = len(table.curves), np.arange(PARTS + 1) / PARTS
    found = table.at(np.repeat(np.arange(count), len(marks)), np.tile(marks, count), 1)
    spots, ways = found.reshape(2, count, len(marks), 2)
    if count:  # what was stored is where it ends
        spots[:, 0], spots[:, -1] = np.array([ends(c) for c in table.curves]).transpose(1, 0, 2)
    sweep = np.where(table.is_round, table.rows[:, 7], 1.0)
    reach = np.where(table.is_round, np.tan(sweep / (2 * PARTS)) / sweep, 1 / (3 * PARTS))
    off = reach[:, None, None] * ways
    starts, stops = spots[:, :-1], spots[:, 1:]
    return np.stack((starts, starts + off[:, :-1], stops - off[:, 1:], stops), axis=2)

"""The point nearest to the origin among those that satisfy linear equations and inequalities.

Every step of Newton's method and every polishing step is this problem:

    minimise ½ |z|²   subject to   J z = y  (equations),   J z <= y  (inequalities)

It is solved in its dual, whose unknowns are the multipliers, one to a row, by an active-set method in the
manner of Lawson and Hanson (Solving Least Squares Problems, 1974, chapter 23): rows enter by violation and
leave when their multiplier would change sign. Rows that depend on each other are welcome.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver.linear import Matrix, least_norm
from aidl_lang.solver.operations import Floats

MANY = 20
"""Number of inequalities from which on they enter together."""
SOON = 20
"""The most steps of the search for a point at which all rows hold."""
STALLED = 0.9
"""Part of the violations above which two steps are too little progress."""
GIVE = 1e-9
"""Give of rows that depend on each other, relative to the longest."""


@record()
class Nearest:
    """
    point       (n,) the nearest point; in the sense of least squares if there is none
    multipliers (m,) point == -J.T @ multipliers; not negative for inequalities
    feasible    True if the rows can hold together
    unique      True if there is no other point at which they do, beyond doubt
    contradiction (m,) where they cannot: factors, the greatest of them 1 or -1 and none of an inequality
                negative, with which the rows add up to `0 = c` or `0 <= c` for a c that is not; None if not
                known
    """

    point: Floats
    multipliers: Floats
    feasible: bool
    unique: bool = False
    contradiction: Floats | None = None


def nearest(jacobian: Matrix, y: Floats, inequality: NDArray[np.bool_]) -> Nearest:
    """Returns the nearest point for `jacobian` (m, n), `y` (m,); `inequality` (m,) marks the rows that are
    <=.
    """
    if not inequality.any():
        found = least_norm(jacobian, y)
        outside = None if found.outside is None else _scaled(found.outside)
        return Nearest(found.point, found.multipliers, outside is None, found.unique, outside)
    if np.count_nonzero(inequality) > MANY:
        quick = _DualActiveSet(jacobian, y, inequality).solve(together=True)
        if quick.feasible:
            return quick
    return _DualActiveSet(jacobian, y, inequality).solve()


def plainly_hold(jacobian: Floats, y: Floats, inequality: NDArray[np.bool_]) -> bool:
    """Tells whether a point at which the rows hold together is soon found.

    The sum of squares of their violations is minimised by Newton's method (Mangasarian, A finite Newton
    method for classification, 2002, doi:10.1080/1055678021000028375).
    """
    point, slack = np.zeros(jacobian.shape[1]), 1e-13 * max(1.0, float(np.abs(y).max(initial=0.0)))
    before, last = np.inf, np.inf
    for _ in range(SOON):
        lack = y - jacobian @ point
        off = np.flatnonzero(~inequality | (lack < 0.0))
        if float(np.abs(lack[off]).max(initial=0.0)) <= slack:
            return True
        left = float(lack[off] @ lack[off])
        if left > STALLED * before:
            return False
        before, last = last, left
        rows = jacobian[off]
        square = rows @ rows.T
        square.flat[:: len(off) + 1] += GIVE * float(square.diagonal().max())
        point += rows.T @ np.linalg.solve(square, lack[off])
    return False


class _DualActiveSet:
    def __init__(self, jacobian: Matrix, y: Floats, inequality: NDArray[np.bool_]) -> None:
        self.jacobian, self.y, self.inequality = jacobian, y, inequality
        self.active = ~inequality
        self.multipliers = np.zeros(len(y))
        self.point = np.zeros(jacobian.shape[1])
        self.slack = 1e-12 * max(1.0, float(np.abs(y).max(initial=0.0)))
        self.contradiction: Floats | None = None

    def solve(self, together: bool = False) -> Nearest:
        """Returns the nearest point. With `together` all violated rows enter at once, which is quicker for
        many, but may come to no end.
        """
        feasible = self._settle()
        for _ in range(3 * len(self.y) + 10):
            if not feasible:
                break
            violation = np.where(self.active, -np.inf, self.jacobian @ self.point - self.y)
            worst = int(np.argmax(violation))
            if violation[worst] <= self.slack:
                return Nearest(self.point, self.multipliers, True)
            self.active[violation > self.slack if together else worst] = True
            feasible = self._settle()
        return Nearest(self.point, self.multipliers, False, contradiction=self.contradiction)

    def _settle(self) -> bool:
        """Brings the multipliers of the active rows to the optimum, dropping rows on the way; returns False
        if there is none.
        """
        for _ in range(len(self.y) + 1):
            rows = np.flatnonzero(self.active)
            if len(rows) == 0:
                self.point = np.zeros(self.jacobian.shape[1])
                return True
            found = least_norm(self.jacobian[rows], self.y[rows])
            if found.outside is None:
                direction, length = found.multipliers - self.multipliers[rows], 1.0
            else:  # the dual is unbounded this way, unless an inequality leaves
                direction, length = -found.outside, np.inf
            blocking, step = self._first_to_vanish(rows, direction, length)
            if blocking is None:
                self.point = found.point
                self.multipliers[rows] = found.multipliers
                if found.outside is not None:
                    self.contradiction = np.zeros(len(self.y))
                    self.contradiction[rows] = -_scaled(found.outside)
                return found.outside is None
            self.multipliers[rows] += step * direction
            self.multipliers[blocking] = 0.0
            self.active[blocking] = False
        return False

    def _first_to_vanish(
        self, rows: NDArray[np.intp], direction: Floats, length: float
    ) -> tuple[int | None, float]:
        """Returns the inequality whose multiplier reaches zero before `length` along `direction`, and the
        length at which it does.
        """
        current = self.multipliers[rows]
        falling = self.inequality[rows] & (current + direction < 0.0 if length == 1.0 else direction < 0.0)
        candidates = np.flatnonzero(falling)
        if len(candidates) == 0:
            return None, length
        steps = current[candidates] / -direction[candidates]
        first = int(np.argmin(steps))
        return int(rows[candidates[first]]), max(float(steps[first]), 0.0)


def _scaled(factors: Floats) -> Floats:
    """Returns factors in units of the greatest."""
    scaled: Floats = factors / np.abs(factors).max()
    return scaled

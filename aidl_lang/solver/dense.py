"""Dense linear algebra: every factorisation of the solver is here, and nothing else.

A matrix whose rows are clearly independent is factorised by Cholesky's method (of J Jᵀ) or by QR; only
where rank is in doubt are singular values worth their price, which is about ten times higher.
"""

from __future__ import annotations

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver.operations import Floats

RANK = 1e-10
"""Singular values below this fraction of the greatest count as zero, in steps of Newton's method."""
CONSISTENT = 1e-7
"""Part of a right-hand side that may lie out of reach, relative to all of it, by rounding."""
NOISE = 1e-10
"""Part of a right-hand side, in units of its rows, that is below what any row is asked to meet."""
INDEPENDENT = 1e-4
"""Least pivot of Cholesky's method, relative to the greatest, at which no row is in doubt."""
GIVE = 1e-9
"""Give of rows that depend on each other, relative to the longest."""
GIVING_STEPS = 6
"""Steps that take the give away."""
LARGE = 3000
"""Number of entries above which damped steps are solved for one by one."""
SMALL = 300
"""Number of entries below which singular values cost no more than the alternative."""


@record()
class LeastNorm:
    """The shortest z with J z = y for J (m, n), y (m,); in the sense of least squares if there is none.

    point       (n,) z
    multipliers (m,) with z = -Jᵀ multipliers
    outside     (m,) the part of y that is out of reach, None if none is
    unique      whether no other z satisfies the rows, beyond doubt
    """

    point: Floats
    multipliers: Floats
    outside: Floats | None
    unique: bool


def least_norm(jacobian: Floats, y: Floats) -> LeastNorm:
    """Returns the shortest z with J z = y."""
    if len(y) == 1:
        return _least_norm_of_one(jacobian, y)
    if jacobian.size > SMALL and (solved := _least_norm_by_cholesky(jacobian, y) or _by_giving(jacobian, y)):
        return solved
    u, sigma, vt = np.linalg.svd(jacobian, full_matrices=False)
    rank = int(np.count_nonzero(sigma > RANK * sigma[0])) if sigma.any() else 0
    u, sigma, vt = u[:, :rank], sigma[:rank], vt[:rank]
    coordinates = (u.T @ y) / sigma
    multipliers = -(u @ (coordinates / sigma))
    outside = None
    if rank < len(y):
        rest = y - u @ (u.T @ y)
        if float(np.abs(rest).max()) > max(CONSISTENT * float(np.abs(y).max()), NOISE):
            outside = rest
    return LeastNorm(coordinates @ vt, multipliers, outside, rank == jacobian.shape[1])


def _least_norm_of_one(jacobian: Floats, y: Floats) -> LeastNorm:
    gradient = jacobian[0]
    square = float(gradient @ gradient)
    if square == 0.0:
        outside = y if abs(y[0]) > NOISE else None
        return LeastNorm(np.zeros_like(gradient), np.zeros(1), outside, False)
    multiplier = -float(y[0]) / square
    return LeastNorm(gradient * -multiplier, np.array([multiplier]), None, len(gradient) == 1)


def _least_norm_by_cholesky(jacobian: Floats, y: Floats) -> LeastNorm | None:
    """Solves the normal equations and refines the solution once; returns None if they are not to be
    trusted.
    """
    if len(y) > jacobian.shape[1]:
        return None
    gram = jacobian @ jacobian.T
    if not _well_conditioned(gram):
        return None
    try:
        first = np.linalg.solve(gram, -y)
    except np.linalg.LinAlgError:  # a pivot that LU meets as zero, though Cholesky's did not
        return None
    multipliers: Floats = np.asarray(first - np.linalg.solve(gram, gram @ first + y), dtype=np.float64)
    point: Floats = -(jacobian.T @ multipliers)
    error = float(np.abs(jacobian @ point - y).max())
    if error > 1e-10 * float(np.abs(y).max()):
        return None
    return LeastNorm(point, multipliers, None, len(y) == jacobian.shape[1])


def _by_giving(jacobian: Floats, y: Floats) -> LeastNorm | None:
    """Solves the normal equations of rows that depend on each other with a little give, which is taken away
    again (the proximal point method). The result is proved: a point that is a combination of the rows and
    meets them is the shortest; a part of `y` that no column reaches cannot be met. Returns None if neither is
    clear.
    """
    gram = jacobian @ jacobian.T
    if not np.isfinite(gram).all():
        return None
    largest = float(gram.diagonal().max())
    size = float(np.abs(y).max())
    if not 0.0 < largest < np.inf or size == 0.0:
        return None
    giving = np.linalg.inv(gram + GIVE * largest * np.eye(len(y)))
    lengths, rest = np.zeros(len(y)), y
    for _ in range(GIVING_STEPS):
        lengths = lengths + giving @ rest
        before, rest = rest, y - gram @ lengths
        if float(np.abs(rest).max()) <= 1e-12 * size or float(np.abs(rest - before).max()) <= 1e-13 * size:
            break
    left = float(np.abs(rest).max())
    multipliers = -lengths
    if left <= 1e-11 * size:
        unique = len(y) >= jacobian.shape[1] and _well_conditioned(jacobian.T @ jacobian)
        return LeastNorm(jacobian.T @ lengths, multipliers, None, unique)
    slope = float(np.abs(jacobian.T @ rest).max())
    if left > max(CONSISTENT * size, NOISE) and slope <= 1e-9 * left * float(np.sqrt(largest)):
        lengths = giving @ (y - rest)
        lengths = lengths + giving @ (y - rest - gram @ lengths)
        return LeastNorm(jacobian.T @ lengths, -lengths, rest, False)
    return None


def _well_conditioned(gram: Floats) -> bool:
    try:
        pivots = np.diagonal(np.linalg.cholesky(gram))
    except np.linalg.LinAlgError:
        return False
    return float(pivots.min()) > INDEPENDENT * float(pivots.max())


class DampedSteps:
    """The steps -(JᵀJ + mu I)⁻¹ Jᵀ r of Levenberg and Marquardt at one place, for any mu.

    largest  about the greatest eigenvalue of JᵀJ, which mu is measured by
    slope    norm of Jᵀ r, zero where no step leads down
    """

    def __init__(self, jacobian: Floats, residuals: Floats) -> None:
        self._jacobian, self._residuals = jacobian, residuals
        self._small = jacobian.size <= LARGE
        if self._small:
            u, self._sigma, self._vt = np.linalg.svd(jacobian, full_matrices=False)
            self._target = u.T @ residuals
            self.largest = float(np.square(self._sigma.max(initial=0.0)))
        else:
            self._gram = jacobian @ jacobian.T
            self.largest = float(np.abs(self._gram).sum(axis=1).max())
        self.slope = float(np.linalg.norm(jacobian.T @ residuals))

    def step(self, mu: float) -> Floats:
        if self._small:
            shrunk = self._sigma / (self._sigma * self._sigma + mu) * self._target
            step: Floats = -(shrunk @ self._vt)
            return step
        damped = self._gram + max(mu, 1e-10 * self.largest) * np.eye(len(self._gram))
        return np.asarray(-(self._jacobian.T @ np.linalg.solve(damped, self._residuals)))

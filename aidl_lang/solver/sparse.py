"""Sparse linear algebra: the functions of `dense` for matrices too large for it. Needs scipy.

A square matrix is factorised as it is (SuperLU). Any other, and a singular one, by way of

    [ I   Jᵀ  ] [z]   [0]
    [ J  -ε I ] [m] = [y]

whose solution is the shortest z with J z = y for ε → 0 and a damped step for larger ε. Unlike J Jᵀ it does
not square the condition of J, and for ε > 0 it is never singular; iterative refinement takes away what ε
adds. (Björck, Numerical Methods for Least Squares Problems, 1996, sections 2.5.1 and 2.9.)
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import structural_rank
from scipy.sparse.linalg import SuperLU, splu

from aidl_lang.solver.dense import CONSISTENT, NOISE, LeastNorm
from aidl_lang.solver.operations import Floats

REGULAR = 1e-9
"""ε relative to the greatest square of a row."""
ACCURATE = 1e-11
HUGE = 1e150
"""Replacement of slopes that are beyond the range of numbers."""
TINY = 1e-150
"""The least ε: with it, the augmented matrix has a diagonal without zeros, whatever J is."""
REFINEMENTS = 6
SCATTERED = {"relax": 1, "panel_size": 1}
"""Options for matrices with a few entries in a row, whose factors have no dense blocks worth the search."""
GROWTH = 1e9
"""Length of a solution of a square system, relative to its right-hand side, above which it is not trusted."""
SINGULAR = 1e12
"""Length of multipliers, relative to the solution, that betrays a singular matrix even if the rows agree."""


class SparseMatrix:
    """A matrix (m, n) by rows, that remembers its factors."""

    def __init__(self, matrix: sp.csr_array) -> None:
        if not np.isfinite(matrix.data).all():  # finite slopes times their scales may overflow
            np.nan_to_num(matrix.data, copy=False, posinf=HUGE, neginf=-HUGE)
        self.matrix = matrix
        self.shape: tuple[int, int] = matrix.shape

    def __matmul__(self, vector: Floats) -> Floats:
        product: Floats = self.matrix @ vector
        return product

    def __getitem__(self, rows: NDArray[np.bool_] | NDArray[np.intp]) -> SparseMatrix:
        return SparseMatrix(self.matrix[rows])

    @property
    def T(self) -> sp.csc_array:  # noqa: N802  (as numpy calls it)
        return self.matrix.T

    @cached_property
    def lu(self) -> SuperLU | None:
        """The factors of a square matrix, None if it is singular."""
        if self.shape[0] != self.shape[1]:
            return None
        matrix = self.matrix.tocsc()
        matrix.eliminate_zeros()
        if structural_rank(matrix) < self.shape[0]:
            return None  # SuperLU may write where it should not when a whole column cancels
        try:
            return splu(matrix, **SCATTERED)
        except RuntimeError:  # exactly singular
            return None

    @cached_property
    def augmented(self) -> Augmented:
        return Augmented(self, max(REGULAR * self.largest, TINY))

    @cached_property
    def largest(self) -> float:
        """About the greatest eigenvalue of J Jᵀ: the greatest sum of a row of its absolute values."""
        size = abs(self.matrix)
        return float((size @ (size.T @ np.ones(self.shape[0]))).max(initial=0.0)) or 1.0

    def beside(self, right: Floats) -> SparseMatrix:
        """Returns this matrix with further columns (m, s)."""
        return SparseMatrix(sp.hstack((self.matrix, sp.csr_array(right)), format="csr"))


def least_norm(jacobian: SparseMatrix, y: Floats) -> LeastNorm:
    """Returns the shortest z with J z = y for J (m, n), y (m,)."""
    if solved := _square(jacobian, y):
        return solved
    solver = jacobian.augmented
    z, multipliers = solver.solve(y)
    rest = y - jacobian @ z
    size = float(np.abs(y).max())
    for _ in range(REFINEMENTS):
        if float(np.abs(rest).max()) <= ACCURATE * size:
            break
        dz, dm = solver.solve(rest, -(z + jacobian.T @ multipliers))
        better = y - jacobian @ (z + dz)
        if not float(np.abs(better).max()) < 0.5 * float(np.abs(rest).max()):
            break
        z, multipliers, rest = z + dz, multipliers + dm, better
    outside = float(np.abs(rest).max()) > max(CONSISTENT * size, NOISE)
    return LeastNorm(z, multipliers, rest if outside else None, False)


def _square(jacobian: SparseMatrix, y: Floats) -> LeastNorm | None:
    """Solves a square system by LU; returns None if the result is not to be trusted."""
    factors = jacobian.lu
    if factors is None:
        return None
    z: Floats = factors.solve(y)
    size = float(np.abs(y).max())
    if not np.isfinite(z).all() or float(np.abs(z).max()) > GROWTH * size:
        return None
    if float(np.abs(jacobian @ z - y).max()) > 1e-9 * size:
        return None
    multipliers: Floats = -factors.solve(z, "T")
    if not float(np.abs(multipliers).max()) <= SINGULAR * float(np.abs(z).max()):
        return None
    return LeastNorm(z, multipliers, None, True)


class Augmented:
    """The augmented system of a Jacobian (m, n), factorised."""

    def __init__(self, jacobian: SparseMatrix, epsilon: float) -> None:
        rows, self._columns = jacobian.shape
        matrix = sp.block_array(
            [[sp.eye_array(self._columns), jacobian.T], [jacobian.matrix, -epsilon * sp.eye_array(rows)]],
            format="csc",
        )
        try:
            self._factors: SuperLU | None = splu(matrix, **SCATTERED)
        except RuntimeError:  # exactly singular, which takes slopes beyond all measure
            self._factors = None

    def solve(self, y: Floats, above: Floats | None = None) -> tuple[Floats, Floats]:
        right = np.concatenate((np.zeros(self._columns) if above is None else above, y))
        both = np.zeros(len(right)) if self._factors is None else self._factors.solve(right)
        return both[: self._columns], both[self._columns :]


class DampedSteps:
    """See `linear.DampedSteps`."""

    def __init__(self, jacobian: SparseMatrix, residuals: Floats) -> None:
        self._jacobian, self._residuals = jacobian, residuals
        self.largest = jacobian.largest
        self.slope = float(np.linalg.norm(jacobian.T @ residuals))

    def step(self, mu: float) -> Floats:
        return Augmented(self._jacobian, max(mu, 1e-12 * self.largest, TINY)).solve(-self._residuals)[0]

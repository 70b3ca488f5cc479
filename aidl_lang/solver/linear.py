"""Linear algebra by the kind of matrix: `dense` for arrays, `sparse` for those that are too large for it.

Small problems never import scipy: what is sparse was made by `array_program`, which is when it is loaded.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, TypeAlias

import numpy as np

from aidl_lang.solver import dense
from aidl_lang.solver.dense import LeastNorm
from aidl_lang.solver.operations import Floats

if TYPE_CHECKING:
    from aidl_lang.solver.sparse import SparseMatrix

Matrix: TypeAlias = "Floats | SparseMatrix"


class DampedSteps(Protocol):
    """The steps of Levenberg and Marquardt at one place, for any damping mu.

    largest  about the greatest eigenvalue of JᵀJ, which mu is measured by
    slope    norm of Jᵀ r, zero where no step leads down
    """

    largest: float
    slope: float

    def step(self, mu: float) -> Floats:
        """Returns the step -(JᵀJ + mu I)⁻¹ Jᵀ r."""


def least_norm(jacobian: Matrix, y: Floats) -> LeastNorm:
    """Returns the shortest z with J z = y for J (m, n), y (m,)."""
    if isinstance(jacobian, np.ndarray):
        return dense.least_norm(jacobian, y)
    from aidl_lang.solver import sparse

    return sparse.least_norm(jacobian, y)


def damped_steps(jacobian: Matrix, residuals: Floats) -> DampedSteps:
    if isinstance(jacobian, np.ndarray):
        return dense.DampedSteps(jacobian, residuals)
    from aidl_lang.solver import sparse

    return sparse.DampedSteps(jacobian, residuals)


def with_slacks(jacobian: Matrix, slacks: Floats) -> Matrix:
    """Returns the Jacobian (m, n) with further columns (m, s) for slacks that are subtracted."""
    if isinstance(jacobian, np.ndarray):
        return np.hstack((jacobian, -slacks))
    return jacobian.beside(-slacks)

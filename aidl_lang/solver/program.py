"""Some rows as functions of their free unknowns, ready for quick evaluation.

Affine rows are a matrix. Others are straight-line code on plain floats: for the ten to some hundred unknowns
that a structure has, it is quicker than arrays, whose price is paid per operation. Derivatives are
accumulated in reverse, row by row, along a schedule made once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field
from typing import ClassVar, TypeAlias

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver.array_program import CANCELLED
from aidl_lang.solver.operations import Floats
from aidl_lang.solver.valuation import Compiled, run

Partial: TypeAlias = "tuple[Callable[..., tuple[float, ...]], tuple[int, ...], int, tuple[int, ...]]"
"""Function, slots of its operands, slot of the value, edges that take the slopes."""


@record()
class Sweep:
    """Reverse accumulation of one row, from its root to the unknowns in it; `merging` if some slot is reached
    in several ways, whose slopes may cancel.
    """

    root: int
    edges: list[tuple[int, int, int]]
    inputs: list[int]
    touched: list[int]
    merging: bool


@record()
class AffineProgram:
    """Some rows that are affine functions of their free unknowns, with branches fixed.

    rows     (r,) which of the roots given to the freezer
    columns  (k,) the unknowns, ascending
    matrix   (r, k) the slopes
    constant (r,) the values where all unknowns are 0
    """

    rows: list[int]
    columns: list[int]
    matrix: Floats
    constant: Floats
    linear: ClassVar[bool] = True

    def residuals(self, x: Floats) -> Floats:
        """Returns the values (r,) of the rows at the unknowns `x` (k,)."""
        with np.errstate(all="ignore"):
            values: Floats = self.matrix @ x + self.constant
        return values

    def jacobian(self, row_factors: Floats, column_factors: Floats) -> Floats:
        """Returns the (r, k) partial derivatives, times these factors."""
        with np.errstate(all="ignore"):
            matrix: Floats = self.matrix * row_factors[:, None] * column_factors
        return matrix


@record(frozen=False)
class Program:
    """Some rows as functions of their free unknowns, with branches fixed.

    rows    (r,) which of the roots given to the freezer
    columns (k,) the unknowns, ascending
    """

    rows: list[int]
    roots: list[int]
    columns: list[int]
    slots: list[int]
    values: list[float] = field(repr=False)
    weights: list[float] = field(repr=False)
    linear: ClassVar[bool] = False
    code: list[Compiled] = field(default_factory=list, repr=False)
    partials: list[Partial] = field(default_factory=list, repr=False)
    sweeps: list[Sweep] = field(default_factory=list, repr=False)
    scatter: NDArray[np.intp] = field(default_factory=lambda: np.zeros(0, dtype=np.intp), repr=False)

    def residuals(self, x: Floats) -> Floats:
        """Returns the values (r,) of the rows at the unknowns `x` (k,)."""
        values = self.values
        for slot, value in zip(self.slots, x.tolist(), strict=True):
            values[slot] = value
        run(self.code, values)
        return np.array([values[root] for root in self.roots])

    def jacobian(self, row_factors: Floats, column_factors: Floats) -> Floats:
        """Returns the (r, k) partial derivatives where `residuals` was last evaluated, times these
        factors.
        """
        values, weights = self.values, self.weights
        for partial, operands, out, edges in self.partials:
            slopes = partial(*[values[i] for i in operands], values[out])
            for edge, slope in zip(edges, slopes, strict=False):
                weights[edge] = slope
        adjoints = [0.0] * len(values)
        entries: list[float] = []
        for sweep in self.sweeps:
            adjoints[sweep.root] = 1.0
            if sweep.merging:
                self._accumulate_with_care(sweep, adjoints)
            else:
                for parent, child, edge in sweep.edges:
                    adjoints[child] += adjoints[parent] * weights[edge]
            entries.extend([adjoints[slot] for slot in sweep.inputs])
            for slot in sweep.touched:
                adjoints[slot] = 0.0
        flat = np.zeros(len(self.rows) * len(self.columns))
        flat[self.scatter] = entries
        if not np.isfinite(flat).all():  # products of finite slopes may still overflow
            np.nan_to_num(flat, copy=False)
        matrix = flat.reshape(len(self.rows), len(self.columns))
        matrix *= row_factors[:, None]
        matrix *= column_factors
        return matrix

    def _accumulate_with_care(self, sweep: Sweep, adjoints: list[float]) -> None:
        """Accumulates slopes so that those that cancel become zero: a frame that moves all of a row moves
        nothing in it.
        """
        weights, sizes = self.weights, dict.fromkeys(sweep.touched, 0.0)
        for parent, child, edge in sweep.edges:
            slope = adjoints[parent]
            if abs(slope) > CANCELLED * sizes[parent]:
                slope *= weights[edge]
                adjoints[child] += slope
                sizes[child] += abs(slope)
        for slot in sweep.inputs:
            if abs(adjoints[slot]) <= CANCELLED * sizes[slot]:
                adjoints[slot] = 0.0

"""Algebra of matrices too large for `linear`, and the rank of such; all that needs scipy.

A square matrix is factorised as it is (SuperLU). Any other, and a singular one, by way of

    [ I   Jᵀ  ] [z]   [0]
    [ J  -ε I ] [m] = [y]

whose solution is the shortest z with J z = y for ε → 0 and a damped step for larger ε. Unlike J Jᵀ it does
not square the condition of J, and for ε > 0 it is never singular; iterative refinement takes away what ε
adds. (Björck, Numerical Methods for Least Squares Problems, 1996, sections 2.5.1 and 2.9.)

Rank is found by elimination of many pivots at a time, then a dense remainder. In each round pivots are chosen
that do not touch each other (no pivot's row has an entry in the column of another), so that all of them are
eliminated by one product of sparse matrices. The choice is that of Markowitz, little fill first, among
entries that are not small in their row (Duff, Erisman and Reid, Direct Methods for Sparse Matrices, chapters
7 and 10); conflicts are settled as in Luby's search for independent sets. What remains is decided by QR with
pivoting.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
import scipy.linalg
import scipy.sparse as sp
from scipy.sparse.csgraph import structural_rank
from scipy.sparse.linalg import SuperLU, splu

from aidl_lang.solver.expression import Bools, Floats, Ints
from aidl_lang.solver.linear import CONSISTENT, DOUBT, NOISE, RANK, LeastNorm, Sparse, marked, places

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
STABLE = 0.1
"""Least size of a pivot, relative to the greatest entry of its row."""
ROUNDING = 1e-13
"""Entries of unit rows below this are left by cancellation."""
REMAINDER = 150
"""Rows that are few enough for dense algebra."""
DENSITY = 0.15
"""Share of entries above which dense algebra is quicker."""
LARGEST = 2500
"""Rows of the greatest dense remainder that is within the budget."""
ROUNDS = 400
TRIES = 3
"""Searches for more pivots within a round."""


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

    def __getitem__(self, rows: Bools | Ints) -> SparseMatrix:
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

    def damped(self, mu: float) -> Augmented:
        """Returns what gives the damped steps of Levenberg and Marquardt."""
        return Augmented(self, max(mu, 1e-12 * self.largest, TINY))

    @cached_property
    def largest(self) -> float:
        """About the greatest eigenvalue of J Jᵀ: the greatest sum of a row of its absolute values."""
        size = abs(self.matrix)
        return float((size @ (size.T @ np.ones(self.shape[0]))).max(initial=0.0)) or 1.0

    def beside(self, right: Floats) -> SparseMatrix:
        """Returns this matrix with further columns (m, s)."""
        return SparseMatrix(sp.hstack((self.matrix, sp.csr_array(right)), format="csr"))

    def least_norm(self, y: Floats) -> LeastNorm:
        """Returns the shortest z with J z = y for y (m,)."""
        if solved := self._square(y):
            return solved
        solver = self.augmented
        z, multipliers = solver.solve(y)
        rest = y - self @ z
        size = float(np.abs(y).max())
        for _ in range(REFINEMENTS):
            if float(np.abs(rest).max()) <= ACCURATE * size:
                break
            dz, dm = solver.solve(rest, -(z + self.T @ multipliers))
            better = y - self @ (z + dz)
            if not float(np.abs(better).max()) < 0.5 * float(np.abs(rest).max()):
                break
            z, multipliers, rest = z + dz, multipliers + dm, better
        outside = float(np.abs(rest).max()) > max(CONSISTENT * size, NOISE)
        return LeastNorm(z, multipliers, rest if outside else None, False)

    def _square(self, y: Floats) -> LeastNorm | None:
        factors = self.lu
        if factors is None:
            return None
        z: Floats = factors.solve(y)
        size = float(np.abs(y).max())
        if not np.isfinite(z).all() or float(np.abs(z).max()) > GROWTH * size:
            return None
        if float(np.abs(self @ z - y).max()) > 1e-9 * size:
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


class UndecidedError(Exception):
    """Raised if the rank is undecided: too close to call, or too large for the budget."""


def as_csr(matrix: Sparse, width: int) -> sp.csr_array:
    shape = (len(matrix), width)
    return sp.csr_array((matrix.entries, matrix.columns, matrix.starts), shape=shape)


def independent_rows(matrix: Sparse, width: int) -> Ints:
    """Returns the numbers of a largest set of independent rows of a matrix of unit rows, ascending.

    Raises UndecidedError.
    """
    rest, names = as_csr(matrix, width), np.arange(len(matrix))
    chosen: list[Ints] = []
    for _ in range(ROUNDS):
        rest, names = _without_zeros(rest, names)
        columns = np.count_nonzero(np.bincount(rest.indices))
        least = min(rest.shape[0], columns)
        if least <= REMAINDER or rest.nnz > DENSITY * rest.shape[0] * columns:
            break
        rows, pivots = _pivots(rest)
        chosen.append(names[rows])
        rest, names = _eliminate(rest, names, rows, pivots)
    chosen.append(names[_dense_independent_rows(rest)])
    return np.sort(np.concatenate(chosen))


class NullSpace:
    """The null space of a matrix of unit rows. `rows` are those of them that are independent.

    Raises UndecidedError.
    """

    def __init__(self, matrix: Sparse, width: int, *, known: bool) -> None:
        """`known`: all rows are independent."""
        self.rows = matrix if known else matrix.take(independent_rows(matrix, width))
        self._rows = as_csr(self.rows, width)
        self._solve = gram_solver(self._rows)

    def sample(self, matrix: Sparse, count: int) -> Floats:
        """Returns random combinations of rows of `matrix`, projected onto the null space: (width, count)."""
        rows = as_csr(matrix, self._rows.shape[1])
        found: Floats = rows.T @ np.random.default_rng(0).standard_normal((len(matrix), count))
        for _ in range(2):  # the second time for the digits that the square in `gram_solver` costs
            found = found - self._rows.T @ self._solve(self._rows @ found)
        return found


def combinations(rows: Sparse, wanted: Sparse, width: int) -> Floats:
    """Returns the coefficients (w, r) of independent rows that make up each of w wanted ones."""
    basis, target = as_csr(rows, width), as_csr(wanted, width).T.toarray()
    solve = gram_solver(basis)
    found = solve(basis @ target)
    found = found + solve(basis @ (target - basis.T @ found))
    return np.asarray(found.T)


def gram_solver(rows: sp.csr_array) -> Callable[[Floats], Floats]:
    """Solves with J Jᵀ, for rows that are independent. Raises UndecidedError."""
    if not rows.shape[0]:
        return lambda right: right
    gram = sp.csc_array(rows @ rows.T)
    options = {"SymmetricMode": True}
    try:
        factors = splu(gram, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    except RuntimeError as reason:  # exactly singular, by rounding
        raise UndecidedError from reason
    return factors.solve  # type: ignore[no-any-return]


def _without_zeros(rest: sp.csr_array, names: Ints) -> tuple[sp.csr_array, Ints]:
    """Returns the rest without rounding errors and without rows that have no entries left."""
    rest.data[np.abs(rest.data) < ROUNDING] = 0.0
    rest.eliminate_zeros()
    sizes = np.zeros(rest.shape[0])
    filled = np.flatnonzero(np.diff(rest.indptr))
    if len(filled):
        sizes[filled] = np.maximum.reduceat(np.abs(rest.data), rest.indptr[:-1][filled])
    left = sizes > DOUBT / np.sqrt(rest.shape[1])
    return (rest, names) if left.all() else (rest[left], names[left])


def _pivots(rest: sp.csr_array) -> tuple[Ints, Ints]:
    """Returns rows and columns of entries that can be eliminated at the same time; at least one."""
    starts, columns, sizes = rest.indptr[:-1], rest.indices, np.abs(rest.data)
    lengths = np.diff(rest.indptr)
    rows = np.repeat(np.arange(len(lengths)), lengths)
    counts = np.bincount(columns, minlength=rest.shape[1])
    cost = (lengths[rows] - 1.0) * (counts[columns] - 1.0)
    cost[sizes < STABLE * np.maximum.reduceat(sizes, starts)[rows]] = np.inf
    best = np.minimum.reduceat(cost, starts)
    firsts = np.unique(rows[cost == best[rows]], return_index=True)[1]
    candidate = columns[cost == best[rows]][firsts]
    # Distinct, so that of two that touch one goes first; in no order, so that many can.
    order = np.random.default_rng(len(rows)).permutation(len(lengths))
    priority: Floats = best * len(lengths) + order
    priority[best > 4.0 * (best.min() + 1.0)] = np.inf
    by_column = np.argsort(columns, kind="stable")
    return _untouched(rows, columns, by_column, starts, candidate, priority, rest.shape[1])


def _untouched(
    rows: Ints, columns: Ints, by_column: Ints, starts: Ints, candidate: Ints, priority: Floats, width: int
) -> tuple[Ints, Ints]:
    """Returns the candidates (one to a row) before all those they touch, then the same of the rest."""
    column_starts = np.flatnonzero(np.diff(columns[by_column], prepend=-1))
    column_names = columns[by_column][column_starts]
    taken: list[Ints] = []
    for _ in range(TRIES):
        wanted = np.full(width, np.inf)
        np.minimum.at(wanted, candidate, priority)
        priority = np.where(priority == wanted[candidate], priority, np.inf)
        across = np.minimum.reduceat(wanted[columns], starts)
        down = np.full(width, np.inf)
        down[column_names] = np.minimum.reduceat(priority[rows[by_column]], column_starts)
        won = np.flatnonzero((priority < np.inf) & (priority <= across) & (priority <= down[candidate]))
        if not len(won):
            break
        taken.append(won)
        in_row, in_column = marked(won, len(starts)), marked(candidate[won], width)
        touched = marked(columns[in_row[rows]], width)  # columns that a chosen row has an entry in
        reaches = marked(rows[in_column[columns]], len(starts))  # rows with an entry in a chosen column
        priority = np.where(reaches | touched[candidate], np.inf, priority)
    found = np.concatenate(taken)
    return found, candidate[found]


def _eliminate(rest: sp.csr_array, names: Ints, rows: Ints, pivots: Ints) -> tuple[sp.csr_array, Ints]:
    """Returns the Schur complement of the pivots: the other rows without their part along these columns."""
    place = places(pivots, rest.shape[1])
    upper = rest[rows]
    on_pivot = place[upper.indices] == np.repeat(np.arange(len(rows)), np.diff(upper.indptr))
    values: Floats = upper.data[on_pivot]
    other = ~marked(rows, len(names))
    lower = rest[other]
    here = place[lower.indices] >= 0
    shape = (lower.shape[0], len(pivots))
    owner = np.repeat(np.arange(lower.shape[0]), np.diff(lower.indptr))
    at = place[lower.indices[here]]
    factors = sp.csr_array((lower.data[here] / values[at], (owner[here], at)), shape=shape)
    lower.data[here] = 0.0
    upper.data[on_pivot] = 0.0
    return sp.csr_array(lower - factors @ upper), names[other]


def _dense_independent_rows(rest: sp.csr_array) -> Ints:
    if not rest.nnz:
        return np.zeros(0, dtype=np.intp)
    if min(rest.shape[0], len(np.unique(rest.indices))) > LARGEST:
        raise UndecidedError
    dense = rest[:, np.unique(rest.indices)].toarray()
    triangle, order = scipy.linalg.qr(dense.T, mode="r", pivoting=True)
    diagonal = np.abs(np.diagonal(triangle))
    if ((diagonal > DOUBT) & (diagonal < RANK)).any():
        raise UndecidedError
    return np.asarray(order[: np.count_nonzero(diagonal >= RANK)])

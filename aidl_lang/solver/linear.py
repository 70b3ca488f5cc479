"""Linear algebra: shortest solutions of equations, and of inequalities.

A matrix whose rows are clearly independent is factorised by Cholesky's method (of J Jᵀ); only where rank is
in doubt are singular values worth their price, which is about ten times higher. What is too large for arrays
is a `sparse.SparseMatrix`; small problems never import scipy, which that needs.

Every step of Newton's method and every polishing step is this problem (`nearest`):

    minimise ½ |z|²   subject to   J z = y  (equations),   J z <= y  (inequalities)

It is solved in its dual, whose unknowns are the multipliers, one to a row, by an active-set method in the
manner of Lawson and Hanson (Solving Least Squares Problems, 1974, chapter 23): rows enter by violation and
leave when their multiplier would change sign. Rows that depend on each other are welcome.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver.expression import Bools, Floats, Ints

if TYPE_CHECKING:
    from aidl_lang.solver.sparse import SparseMatrix

Matrix: TypeAlias = "Floats | SparseMatrix"

_RANK = 1e-10
"""Singular values below this fraction of the greatest count as zero, in steps of Newton's method."""
CONSISTENT = 1e-7
"""Part of a right-hand side that may lie out of reach, relative to all of it, by rounding."""
NOISE = 1e-10
"""Part of a right-hand side, in units of its rows, that is below what any row is asked to meet."""
INDEPENDENT = 1e-4
"""Least pivot of Cholesky's method, relative to the greatest, at which no row is in doubt."""
GIVE = 1e-9
"""Give of rows that depend on each other, relative to the longest."""
LARGE = 3000
"""Number of entries above which damped steps are solved for one by one."""
SMALL = 300
"""Number of entries below which singular values cost no more than the alternative."""
MANY = 20
"""Number of inequalities from which on they enter together."""
SOON = 20
"""The most steps of the search for a point at which all rows hold."""
STALLED = 0.9
"""Part of the violations above which two steps are too little progress."""


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


def least_norm(jacobian: Matrix, y: Floats) -> LeastNorm:
    """Returns the shortest z with J z = y for J (m, n), y (m,)."""
    if not isinstance(jacobian, np.ndarray):
        return jacobian.least_norm(y)
    if len(y) == 1:
        return _least_norm_of_one(jacobian, y)
    if jacobian.size > SMALL and (solved := _least_norm_by_cholesky(jacobian, y)):
        return solved
    u, sigma, vt = np.linalg.svd(jacobian, full_matrices=False)
    rank = int(np.count_nonzero(sigma > _RANK * sigma[0])) if sigma.any() else 0
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
    """Solves the normal equations and refines the solution once; None if they are not to be trusted."""
    if len(y) > jacobian.shape[1]:
        return None
    gram = jacobian @ jacobian.T
    try:
        pivots = np.diagonal(np.linalg.cholesky(gram))
        if not float(pivots.min()) > INDEPENDENT * float(pivots.max()):
            return None
        first = np.linalg.solve(gram, -y)
    except np.linalg.LinAlgError:  # LU may meet a pivot as zero, though Cholesky's method did not
        return None
    multipliers: Floats = np.asarray(first - np.linalg.solve(gram, gram @ first + y), dtype=np.float64)
    point: Floats = -(jacobian.T @ multipliers)
    error = float(np.abs(jacobian @ point - y).max())
    if error > 1e-10 * float(np.abs(y).max()):
        return None
    return LeastNorm(point, multipliers, None, len(y) == jacobian.shape[1])


def stacked_least_norm(jacobian: Floats, y: Floats, which: Bools) -> tuple[Floats, Floats]:
    """Returns the shortest z (b, k) with J z = y for J (b, m, k), y (b, m), and the part of y that is out of
    reach (b, m).

    Only the systems in `which` (b,) are solved. If J or y is not finite, all of y is out of reach.
    """
    b, m, k = jacobian.shape
    point = np.zeros((b, k))
    outside = np.zeros((b, m))
    chosen = np.flatnonzero(which)
    j, right = jacobian[chosen], y[chosen]
    lengths = np.sqrt(np.einsum("bmk,bmk->bm", j, j))
    clear = (lengths > 0.0).all(axis=1)
    if m > k:
        clear[:] = False
    if clear.any():
        unit = j[clear] / lengths[clear][:, :, None]
        target = right[clear] / lengths[clear]
        gram = unit @ unit.transpose(0, 2, 1)
        pivots = np.linalg.cholesky(gram + 1e-12 * np.eye(m)).diagonal(axis1=1, axis2=2).min(axis=1)
        trusted = pivots > INDEPENDENT
        unit, gram, target = unit[trusted], gram[trusted], target[trusted]
        first = np.linalg.solve(gram, target[:, :, None])
        found = first + np.linalg.solve(gram, target[:, :, None] - gram @ first)
        clear[clear] = trusted
        at = chosen[clear]
        point[at] = (unit.transpose(0, 2, 1) @ found)[:, :, 0]
    finite = np.isfinite(j).all(axis=(1, 2)) & np.isfinite(right).all(axis=1)
    outside[chosen[~finite]] = np.inf
    doubtful = np.flatnonzero(~clear & finite)
    if len(doubtful):
        u, sigma, vt = np.linalg.svd(j[doubtful], full_matrices=False)
        kept = sigma > _RANK * sigma[:, :1]
        target = right[doubtful]
        inner = np.where(kept, np.einsum("bmr,bm->br", u, target), 0.0)
        rest = target - np.einsum("bmr,br->bm", u, inner)
        size = np.abs(target).max(axis=1, keepdims=True)
        at = chosen[doubtful]
        scaled = np.where(kept, inner / np.where(kept, sigma, 1.0), 0.0)
        point[at] = np.einsum("br,brk->bk", scaled, vt)
        worst = np.abs(rest).max(axis=1, keepdims=True)
        outside[at] = np.where(worst > np.maximum(CONSISTENT * size, NOISE), rest, 0.0)
    return point, outside


class DampedSteps:
    """The steps -(JᵀJ + mu I)⁻¹ Jᵀ r of Levenberg and Marquardt at one place, for any mu.

    largest  about the greatest eigenvalue of JᵀJ, which mu is measured by
    slope    norm of Jᵀ r, zero where no step leads down
    """

    def __init__(self, jacobian: Matrix, residuals: Floats) -> None:
        self._jacobian, self._residuals = jacobian, residuals
        self.slope = float(np.linalg.norm(jacobian.T @ residuals))
        self._sigma: Floats | None = None
        if not isinstance(jacobian, np.ndarray):
            self.largest = jacobian.largest
        elif jacobian.size <= LARGE:
            u, self._sigma, self._vt = np.linalg.svd(jacobian, full_matrices=False)
            self._target = u.T @ residuals
            self.largest = float(np.square(self._sigma.max(initial=0.0)))
        else:
            self._gram = jacobian @ jacobian.T
            self.largest = float(np.abs(self._gram).sum(axis=1).max())

    def step(self, mu: float) -> Floats:
        if not isinstance(self._jacobian, np.ndarray):
            return self._jacobian.damped(mu).solve(-self._residuals)[0]
        if self._sigma is not None:
            shrunk = self._sigma / (self._sigma * self._sigma + mu) * self._target
            return np.asarray(-(shrunk @ self._vt))
        damped = self._gram + max(mu, 1e-10 * self.largest) * np.eye(len(self._gram))
        return np.asarray(-(self._jacobian.T @ np.linalg.solve(damped, self._residuals)))


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


def nearest(jacobian: Matrix, y: Floats, inequality: Bools) -> Nearest:
    """Returns the nearest point for `jacobian` (m, n), `y` (m,); `inequality` (m,) marks rows with <=."""
    if not inequality.any():
        found = least_norm(jacobian, y)
        outside = None if found.outside is None else _scaled(found.outside)
        return Nearest(found.point, found.multipliers, outside is None, found.unique, outside)
    if np.count_nonzero(inequality) > MANY:
        quick = _DualActiveSet(jacobian, y, inequality).solve(together=True)
        if quick.feasible:
            return quick
    return _DualActiveSet(jacobian, y, inequality).solve()


def plainly_hold(jacobian: Floats, y: Floats, inequality: Bools) -> bool:
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
    def __init__(self, jacobian: Matrix, y: Floats, inequality: Bools) -> None:
        self.jacobian, self.y, self.inequality = jacobian, y, inequality
        self.active = ~inequality
        self.multipliers = np.zeros(len(y))
        self.point = np.zeros(jacobian.shape[1])
        self.slack = 1e-12 * max(1.0, float(np.abs(y).max(initial=0.0)))
        self.contradiction: Floats | None = None

    def solve(self, together: bool = False) -> Nearest:
        """Returns the nearest point. If violated rows enter `together`, it is quicker, but may never end."""
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
        """Brings the multipliers of the active rows to the optimum, dropping rows; False if there is none."""
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

    def _first_to_vanish(self, rows: Ints, direction: Floats, length: float) -> tuple[int | None, float]:
        """Returns the inequality whose multiplier vanishes along `direction` before `length`, and where."""
        current = self.multipliers[rows]
        falling = self.inequality[rows] & (current + direction < 0.0 if length == 1.0 else direction < 0.0)
        candidates = np.flatnonzero(falling)
        if len(candidates) == 0:
            return None, length
        steps = current[candidates] / -direction[candidates]
        first = int(np.argmin(steps))
        return int(rows[candidates[first]]), max(float(steps[first]), 0.0)


def _scaled(factors: Floats) -> Floats:
    scaled: Floats = factors / np.abs(factors).max()
    return scaled


# --- A matrix by its entries, row by row, and the ranks of such.

RANK = 1e-6
"""Singular values of unit rows above this count towards the rank."""
DOUBT = 1e-8
"""Singular values below this count as zero; between the two the rank is undecided."""


@record()
class Sparse:
    """A matrix by its entries, row by row.

    starts  (r + 1,) where each row begins
    columns (e,)
    entries (e,)
    """

    starts: Ints
    columns: Ints
    entries: Floats

    def __len__(self) -> int:
        return len(self.starts) - 1

    @cached_property
    def rows(self) -> Ints:
        """The row (e,) of each entry."""
        return np.repeat(np.arange(len(self)), np.diff(self.starts))

    def lengths(self) -> Floats:
        """Returns the Euclidean lengths (r,) of the rows."""
        squares = np.bincount(self.rows, self.entries * self.entries, len(self))
        return np.asarray(np.sqrt(squares), dtype=np.float64)

    def scaled(self, rows: Floats, columns: Floats) -> Sparse:
        """Returns the matrix with every entry multiplied by the factors of its row and its column."""
        return Sparse(self.starts, self.columns, self.entries * rows[self.rows] * columns[self.columns])

    def take(self, rows: Ints) -> Sparse:
        """Returns the given rows, in their order."""
        counts = self.starts[rows + 1] - self.starts[rows]
        starts = starts_of(counts)
        picked = np.arange(starts[-1]) + np.repeat(self.starts[rows] - starts[:-1], counts)
        return Sparse(starts, self.columns[picked], self.entries[picked])

    def only(self, entries: NDArray[np.bool_]) -> Sparse:
        """Returns the matrix without the entries that are marked False."""
        starts = starts_of(np.bincount(self.rows[entries], minlength=len(self)))
        return Sparse(starts, self.columns[entries], self.entries[entries])

    def above(self, other: Sparse) -> Sparse:
        """Returns these rows with those of another matrix below them."""
        starts = np.concatenate((self.starts, self.starts[-1] + other.starts[1:]))
        columns = np.concatenate((self.columns, other.columns))
        return Sparse(starts, columns, np.concatenate((self.entries, other.entries)))

    @property
    def links(self) -> tuple[Ints, Ints]:
        """Pairs of columns that share a row, enough of them to connect all that do."""
        firsts = self.columns[np.minimum(self.starts[:-1], max(len(self.columns) - 1, 0))[self.rows]]
        return firsts, self.columns

    def dense(self, columns: Ints) -> Floats:
        """Returns the given columns as a dense matrix; they are ascending and hold every entry."""
        matrix = np.zeros((len(self), len(columns)))
        matrix[self.rows, np.searchsorted(columns, self.columns)] = self.entries
        return matrix


def starts_of(counts: NDArray[np.intp]) -> Ints:
    return np.concatenate((np.zeros(1, dtype=np.intp), np.cumsum(counts, dtype=np.intp)))


# --- Stand-ins for functions of numpy that load parts of it which nothing else needs: `np.unique(x)` loads
# `numpy.ma`, and `np.random` as much again, each longer than most programs take to solve.


def each_once(values: NDArray[np.intp]) -> NDArray[np.intp]:
    """Returns the distinct numbers (k,) of an array, in order."""
    found = np.sort(values, axis=None)
    return found[np.diff(found, prepend=found[:1] - 1) > 0]


def others(count: int, left_out: Iterable[int]) -> NDArray[np.intp]:
    """Returns the numbers (k,) from 0 to `count` that are not left out, in order."""
    return np.flatnonzero(~marked(np.fromiter(left_out, dtype=np.intp), count))


def marked(numbers: Ints | list[int], count: int) -> Bools:
    """Returns the mask (count,) of some numbers below `count`."""
    found = np.zeros(count, dtype=np.bool_)
    found[numbers] = True
    return found


def places(numbers: Ints, count: int) -> Ints:
    """Returns for each number below `count` its place among some distinct ones; -1 for the others."""
    found = np.full(count, -1)
    found[numbers] = np.arange(len(numbers))
    return found


def scattered(count: int, seed: int = 0) -> NDArray[np.float64]:
    """Returns numbers (count,) from -1 to 1 without a pattern: a counter's bits mixed (splitmix64)."""
    z: NDArray[Any] = np.arange(1, count + 1, dtype=np.uint64) + np.uint64(seed << 32)
    z *= np.uint64(0x9E3779B97F4A7C15)
    for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB)):
        z = (z ^ (z >> np.uint64(shift))) * np.uint64(factor)
    mixed: NDArray[np.float64] = ((z ^ (z >> np.uint64(31))) >> np.uint64(11)).astype(np.float64)
    return mixed * 2.0**-52 - 1.0

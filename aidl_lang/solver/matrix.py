"""A matrix by its entries, row by row, and the ranks of such."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver.operations import Floats, Ints

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

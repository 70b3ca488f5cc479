"""Some rows as functions of their free unknowns, ready for quick evaluation.

Affine rows are a matrix. Others are straight-line code on plain floats: for the ten to some hundred unknowns
that a structure has, it is quicker than arrays, whose price is paid per operation. Derivatives are
accumulated in reverse, row by row, along a schedule made once.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import field
from operator import mul
from typing import ClassVar, TypeAlias

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver.array_program import CANCELLED
from aidl_lang.solver.forms import Affine
from aidl_lang.solver.operations import PARTIALS, Floats
from aidl_lang.solver.valuation import Compiled, compiled, run

Partial: TypeAlias = "tuple[Callable[..., tuple[float, ...]], tuple[int, ...], int, tuple[int, ...]]"
"""Function, slots of its operands, slot of the value, edges that take the slopes."""

SUM = -1
"""Operation code of a recipe that is a sum."""
NUMBER = -2
"""Operation code of a recipe that is a number."""
UNUSED = 0
"""Weight that is written for operands without a free unknown and never read."""


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


@record(slots=True)
class SlotRecipe:
    """The computation of a slot from others: an operation, or a sum with these slopes.

    inputs  the free unknowns that it depends on
    """

    op: int
    operands: tuple[int, ...]
    inputs: frozenset[int]
    slopes: tuple[float, ...] = ()
    constant: float = 0.0


class Assembly:
    """Puts together a program of rows that are not all affine, with slots of its own: the unknowns first,
    then what is made of them, operands before results. In the forms of the rows, slots from `width` on are
    recipes.
    """

    def __init__(self, recipes: Sequence[SlotRecipe], width: int, columns: list[int]) -> None:
        self._recipes, self._width, self._columns = recipes, width, columns
        self._local = {unknown: i for i, unknown in enumerate(columns)}
        self._values = [0.0] * len(columns)
        self._edges: list[list[tuple[int, int]]] = [[] for _ in columns]
        self._weights = [0.0]
        self._varies = [True] * len(columns)
        self._program = Program([], [], columns, list(range(len(columns))), self._values, self._weights)

    def program(self, rows: list[int], forms: Sequence[Affine]) -> Program:
        program = self._program
        program.rows = rows
        for form in forms:
            for slot in form.terms:
                self._reach(slot)
        for form in forms:
            operands = tuple(self._local[slot] for slot in form.terms)
            program.roots.append(self._sum(operands, tuple(form.terms.values()), form.constant))
        self._plan_sweeps()
        return program

    def _reach(self, root: int) -> None:
        stack = [root]
        while stack:
            slot = stack[-1]
            if slot in self._local:
                stack.pop()
                continue
            recipe = self._recipes[slot - self._width]
            missing = [a for a in recipe.operands if a not in self._local]
            if missing:
                stack.extend(missing)
            else:
                stack.pop()
                self._local[slot] = self._make(recipe)

    def _make(self, recipe: SlotRecipe) -> int:
        operands = tuple(self._local[slot] for slot in recipe.operands)
        if recipe.op == NUMBER:
            return self._new_slot(recipe.constant, False)
        if recipe.op == SUM:
            return self._sum(operands, recipe.slopes, recipe.constant)
        out = self._new_slot(0.0)
        self._program.code.append(compiled(recipe.op, out, operands))
        edges = tuple(self._new_edge(out, a) if self._varies[a] else UNUSED for a in operands)
        padded = operands if len(operands) > 1 else operands * 2
        self._program.partials.append((PARTIALS[recipe.op], padded, out, edges))
        return out

    def _sum(self, operands: tuple[int, ...], slopes: tuple[float, ...], constant: float) -> int:
        out = self._new_slot(0.0)
        self._program.code.append((_weighted(slopes, constant), operands, -1, out))
        for slot, slope in zip(operands, slopes, strict=True):
            self._weights[self._new_edge(out, slot)] = slope
        return out

    def _new_slot(self, value: float, varies: bool = True) -> int:
        self._values.append(value)
        self._edges.append([])
        self._varies.append(varies)
        return len(self._values) - 1

    def _new_edge(self, parent: int, child: int) -> int:
        self._weights.append(0.0)
        self._edges[parent].append((child, len(self._weights) - 1))
        return len(self._weights) - 1

    def _plan_sweeps(self) -> None:
        program, width = self._program, len(self._columns)
        scatter: list[int] = []
        for i, root in enumerate(program.roots):
            touched = self._below(root)
            edges = [(parent, child, edge) for parent in touched for child, edge in self._edges[parent]]
            leaves = [slot for slot in touched if slot < width]
            merging = len(edges) >= len(touched)
            program.sweeps.append(Sweep(root, edges, leaves, touched, merging))
            scatter.extend(i * width + slot for slot in leaves)
        program.scatter = np.array(scatter, dtype=np.intp)

    def _below(self, root: int) -> list[int]:
        """Slots that the root depends on, and itself, operands last."""
        seen = {root}
        stack = [root]
        while stack:
            for child, _ in self._edges[stack.pop()]:
                if child not in seen:
                    seen.add(child)
                    stack.append(child)
        return sorted(seen, reverse=True)


def _weighted(slopes: tuple[float, ...], constant: float) -> Callable[..., float]:
    def total(*values: float) -> float:
        return sum(map(mul, slopes, values), constant)

    return total

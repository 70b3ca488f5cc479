"""A program of rows that are not all affine: slots in an order in which they can be evaluated."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import mul

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver.forms import Affine
from aidl_lang.solver.operations import PARTIALS
from aidl_lang.solver.program import Program, Sweep
from aidl_lang.solver.valuation import compiled

SUM = -1
"""Operation code of a recipe that is a sum."""
NUMBER = -2
"""Operation code of a recipe that is a number."""
UNUSED = 0
"""Weight that is written for operands without a free unknown and never read."""


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

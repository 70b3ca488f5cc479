"""Gradients of many nodes at one place, as sparse matrices; these in their connected parts.

They are accumulated forward as dictionaries, which for a drawing is quickest; for large models in reverse for
all roots together, by the programs on arrays that solve them. Newton's method, which comes back to the
same rows again and again, does not use this.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from aidl_lang.solver.array_program import ArrayFreezing, Schedule
from aidl_lang.solver.expression import Tape
from aidl_lang.solver.matrix import Sparse, starts_of
from aidl_lang.solver.operations import PARTIALS, Bools, Floats, Ints, Op
from aidl_lang.solver.valuation import Valuation

Gradient: TypeAlias = dict[int, float]
"""Partial derivative by unknown; unknowns that are missing have none."""

FEW = 3000
"""Number of nodes up to which dictionaries are quicker than arrays."""
MANY = 100
"""Nodes to a root above which the whole tape is not evaluated."""
STEEPEST = 1e100
"""Slopes above this are left by overflow."""
NARROW = 50
"""Nodes to a level up to which dictionaries are quicker, as in chains of things that hang on each other."""
FLAT = 1e-9
"""Slopes below this count as zero: coordinates that cancel, as in the width of a box."""
LARGE = 300
"""Rows or columns of a part from which on sparse elimination is quicker."""


def gradients(
    values: Valuation, roots: Iterable[int], among: Sequence[bool] | None = None, ends: bytes | None = None
) -> dict[int, Gradient]:
    """Returns the gradient of each root at the current node values, which must be up to date; by the unknowns
    `among`, if these are given, and without what is below nodes marked as `ends`.
    """
    wanted = list(roots)
    tape, nodes = values.tape, values.nodes
    ops, operands = tape.op_list, tape.operand_lists
    found: dict[int, Gradient] = {}
    sloping: dict[int, list[tuple[int, float]]] = {}
    stack = list(wanted)
    while stack:
        node = stack[-1]
        if node in found:
            stack.pop()
            continue
        op, args = ops[node], operands[node]
        if ends is not None and ends[node]:
            found[node] = {}
            continue
        if op <= Op.UNKNOWN:
            is_free = op == Op.UNKNOWN and (among is None or among[args[0]])
            found[node] = {args[0]: 1.0} if is_free else {}
            continue
        terms = sloping.get(node)
        if terms is None:  # the branches that are not taken are not looked at
            padded = args if len(args) > 1 else args * 2
            slopes = zip(args, PARTIALS[op](*[nodes[a] for a in padded], nodes[node]), strict=False)
            terms = sloping[node] = [(a, slope) for a, slope in slopes if slope != 0.0]
        if missing := [a for a, _ in terms if a not in found]:
            stack += missing
        else:
            found[node] = _combined([(found[a], slope) for a, slope in terms if found[a]])
    return {root: found[root] for root in wanted}


def _combined(terms: Sequence[tuple[Gradient, float]]) -> Gradient:
    """Returns a sum of gradients times their factors; one that stays as it is is shared."""
    if len(terms) == 1 and terms[0][1] == 1.0:
        return terms[0][0]
    total: Gradient = {}
    for gradient, slope in terms:
        for unknown, derivative in gradient.items():
            total[unknown] = total.get(unknown, 0.0) + slope * derivative
    return total


def linearise(tape: Tape, at: Floats, roots: Ints, among: Bools | None = None) -> tuple[Floats, Sparse]:
    """Returns the values (r,) of `roots` at the unknowns `at` (n,), and their finite partial derivatives; by
    the unknowns `among` (n,) only, if these are given.

    Unknowns without influence on a root have no entry; entries that cancel may be zeros, and products that
    overflow count as none.
    """
    wanted = roots.tolist()
    height = int(tape.levels.max(initial=0)) + 1
    if len(tape) <= max(FEW, NARROW * height) or len(wanted) * MANY < len(tape):
        known = Valuation(tape, at.tolist())
        known.update(wanted)
        found = gradients(known, wanted, None if among is None else among.tolist())
        values = np.array([known.nodes[root] for root in wanted])
        matrix = _sparse([found[root] for root in wanted])
    else:
        values, matrix = _all_at_once(tape, at, roots, among)
    sensible = np.abs(matrix.entries) < STEEPEST  # not for those that are not numbers
    return values, replace(matrix, entries=np.where(sensible, matrix.entries, 0.0))


def _sparse(rows: Sequence[Gradient]) -> Sparse:
    starts = np.cumsum([0, *(len(row) for row in rows)], dtype=np.intp)
    columns = np.array([unknown for row in rows for unknown in row], dtype=np.intp)
    return Sparse(starts, columns, np.array([slope for row in rows for slope in row.values()]))


def _all_at_once(tape: Tape, at: Floats, roots: Ints, among: Bools | None) -> tuple[Floats, Sparse]:
    """Returns the values (r,) of `roots` and their partial derivatives, on arrays."""
    schedule = Schedule(tape)
    values = schedule.evaluate(at)
    free = np.ones(len(at), dtype=np.bool_) if among is None else among
    freezing = ArrayFreezing(schedule, values, free)
    counts = np.zeros(len(roots), dtype=np.intp)
    varying = np.flatnonzero(freezing.varies(roots))
    program = freezing.program(roots[varying])
    counts[varying] = np.diff(program.indptr)
    return values[roots], Sparse(starts_of(counts), program.columns[program.indices], program.entries())


# -- connected parts


def components(a: Ints, b: Ints, count: int) -> Ints:
    """Returns the component of each of `count` vertices, numbered from 0; edges (e,) link `a` and `b`."""
    lowest = connected(a, b, count)
    return (np.cumsum(lowest == np.arange(count)) - 1)[lowest]


def connected(a: Ints, b: Ints, count: int) -> Ints:
    """Returns the least vertex of the component of each of `count` vertices; edges (e,) link `a` and `b`."""
    lowest = np.arange(count)
    while True:
        below, above = np.minimum(lowest[a], lowest[b]), np.maximum(lowest[a], lowest[b])
        if (below == above).all():
            return lowest
        np.minimum.at(lowest, above, below)
        while (lowest != (lower := lowest[lowest])).any():
            lowest = lower


class Sorted:
    """Things sorted by the part they belong to: `of[first[p] : first[p] + count[p]]` are those of part p."""

    def __init__(self, part: Ints, parts: int) -> None:
        self.part = part
        self.of = np.argsort(part, kind="stable")
        self.count = np.bincount(part[part >= 0], minlength=parts)
        self.first = np.cumsum(self.count) - self.count + np.count_nonzero(part < 0)
        self.place = np.empty(len(part), dtype=np.intp)
        """The number of each within its part."""
        self.place[self.of] = np.arange(len(part)) - np.append(self.first, 0)[part][self.of]

    def members(self, part: int) -> Ints:
        return self.of[self.first[part] : self.first[part] + self.count[part]]

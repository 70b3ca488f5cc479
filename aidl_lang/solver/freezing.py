"""Makes programs of rows of the tape: holds what is not free, fixes the branches, separates what is
independent.

A `Freezer` takes the forms of the rows (`valuation`) for one attempt, and puts in the values of what is not
free. Knots may then become numbers, or affine. `abs`, `minimum`, `maximum` and `select` are replaced by the
branch active at the current values (paper, appendix B), but for those that no free unknown can decide: two
places on one rigid part keep their order wherever it goes. Only what is left to choose counts as a branch.
Rows that share no free unknown go to programs of their own.

Affine rows are a matrix. Others are straight-line code on plain floats: for the ten to some hundred unknowns
that a structure has, it is quicker than arrays, whose price is paid per operation. Derivatives are
accumulated in reverse, row by row, along a schedule made once.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import field, replace
from operator import mul
from typing import ClassVar, TypeAlias

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver.array_program import CANCELLED, TIE, ZERO, ArrayFreezing, ArrayProgram
from aidl_lang.solver.expression import BRANCHING, PARTIALS, Floats, Op
from aidl_lang.solver.linear import marked
from aidl_lang.solver.valuation import (
    Affine,
    Compiled,
    Form,
    Knot,
    Valuation,
    add_terms,
    applied,
    branched,
    combined,
    compiled,
    components,
    run,
    scaled,
)

Root: TypeAlias = "int | tuple[int, int]"
"""A tape node, or the difference of two, the first of which may be `ZERO`."""

MANY = 400
"""Roots from which on programs work on arrays."""

AnyProgram: TypeAlias = "AffineProgram | Program | ArrayProgram"
"""Some rows as functions of their free unknowns; `linear` ones are affine."""

Branch: TypeAlias = tuple[int, int]
"""A branching node and the number of its branch."""


@record(frozen=False)
class Frozen:
    """Programs without common unknowns, and the rows that do not depend on free unknowns.

    programs  with the rows (indices into the roots given) and unknowns of each
    constant  rows that no free unknown can change
    branches  the choices made at branching nodes that free unknowns decide
    steady    rows that hang on no such choice
    """

    programs: Sequence[AnyProgram]
    constant: list[int]
    branches: tuple[Branch, ...]
    steady: frozenset[int]


class Freezer:
    """Makes programs of rows with the unknowns `free`, for one branch after another. Parts that hang on no
    branch are worked out once. The nodes of the rows must be up to date, and those of them that do not change
    with these unknowns may not change meanwhile. Without `pruning` no branch is chosen: operations that
    branch are evaluated like all others, with the slopes of the branch that is active there.

    A form over free unknowns has the index of an unknown as its slot, or `width` and the number of a recipe.
    """

    def __init__(self, values: Valuation, free: Iterable[int], pruning: bool = True) -> None:
        self.values, self.free, self.pruning = values, frozenset(free), pruning
        self.forms = values.forms(self.free)
        self.recipes: list[SlotRecipe] = []
        self.steady: dict[int, Form] = {}
        """The forms of knots that hang on no choice."""
        self.hanging: set[int] = set()
        """Knots that hang on a choice, which free unknowns decide."""

    def freeze(self, roots: Sequence[Root]) -> Frozen:
        """Returns programs for `roots` in the branches that are active."""
        return Choice(self).freeze(roots)

    def slopes(self, node: int) -> dict[int, float] | None:
        """Returns the slopes of a node in the branch that is active, by unknown; None where it bends."""
        form, width = Choice(self).form(self.forms[node]), self.forms.width
        if isinstance(form, float):
            return {}
        return None if any(slot >= width for slot in form.terms) else dict(form.terms)

    def choices(self, roots: Iterable[int]) -> list[int]:
        """Returns the nodes below `roots` at which free unknowns choose the branch, outermost first."""
        forms, freezing = self.forms, Choice(self)
        found: set[int] = set()
        stack: list[int] = []
        for root in roots:
            freezing.form(forms[root])
            stack.extend(forms.below(forms[root]))
        while stack:
            slot = stack.pop()
            if slot in self.hanging and slot not in found:
                found.add(slot)
                stack.extend(forms.knots[slot].below)
        knots = [forms.knots[slot] for slot in found]
        return sorted((knot.node for knot in knots if knot.op in BRANCHING), reverse=True)


def _freeze_to_arrays(
    values: Valuation, roots: Sequence[Root], free: Iterable[int], flipped: frozenset[int]
) -> Frozen:
    movable = marked(list(free), len(values.unknowns))
    differences = [root for root in roots if not isinstance(root, int)]
    further = itertools.count(len(values.nodes))
    nodes = np.array([root if isinstance(root, int) else next(further) for root in roots], dtype=np.intp)
    freezing = ArrayFreezing(values.schedule, np.array(values.nodes), movable, flipped, differences)
    varying = freezing.varies(nodes)
    rows = np.flatnonzero(varying)
    row, unknown = freezing.pattern(nodes[rows])
    system = components(row, unknown + len(rows), len(rows) + len(movable))[: len(rows)]
    programs = []
    for members in np.split(np.argsort(system, kind="stable"), np.cumsum(np.bincount(system))[:-1]):
        if len(members):
            programs.append(replace(freezing.program(nodes[rows[members]]), rows=rows[members]))
    branches = tuple(freezing.branches(nodes))
    steady = frozenset() if branches else frozenset(range(len(roots)))
    return Frozen(programs, np.flatnonzero(~varying).tolist(), branches, steady)


@record(frozen=False)
class Choice:
    """The choice of the branches that are active when they are first asked for, at values that must be up to
    date; nodes in `flipped` take the other branch.
    """

    freezer: Freezer
    flipped: frozenset[int] = frozenset()
    found: dict[int, Form] = field(default_factory=dict)
    """The forms of knots that hang on a choice."""
    chosen: dict[int, int] = field(default_factory=dict)
    """The choice at each knot that has one."""

    def __post_init__(self) -> None:
        self.forms, self.width = self.freezer.forms, self.freezer.forms.width
        self.steady, self.hanging = self.freezer.steady, self.freezer.hanging
        self.free, self.recipes = self.freezer.free, self.freezer.recipes

    def freeze(self, roots: Sequence[Root]) -> Frozen:
        """Returns programs for `roots`; the values must be those of the choice, and up to date."""
        if len(roots) >= MANY and self.freezer.pruning:
            return _freeze_to_arrays(self.freezer.values, roots, self.free, self.flipped)
        whole = [self._whole(root) for root in roots]
        forms = [self.form(form) for form in whole]
        constant = [row for row, form in enumerate(forms) if isinstance(form, float)]
        rooted = [(row, form) for row, form in enumerate(forms) if isinstance(form, Affine)]
        steady = frozenset(
            row
            for row, (root, form) in enumerate(zip(roots, whole, strict=True))
            if isinstance(root, int) and self.hanging.isdisjoint(self.forms.below(form))
        )
        return Frozen(self._programs(rooted), constant, self._active(whole), steady)

    def _whole(self, root: Root) -> Form:
        """Returns the form with all unknowns free."""
        if isinstance(root, int):
            return self.forms[root]
        a, b = (0.0 if node == ZERO else self.forms[node] for node in root)
        return combined(a, b, -1.0)

    def _active(self, whole: Iterable[Form]) -> tuple[Branch, ...]:
        """Returns the choices that forms hang on, without those within branches that were not taken."""
        found: set[int] = set()
        stack = [slot for form in whole for slot in self.forms.below(form)]
        while stack:
            slot = stack.pop()
            if slot in self.hanging and slot not in found:
                found.add(slot)
                knot, choice = self.forms.knots[slot], self.chosen.get(slot)
                taken = choice is not None and knot.op != Op.ABS
                stack.extend(self.forms.below(knot.parts[choice or 0]) if taken else knot.below)
        chosen = ((self.forms.knots[slot].node, self.chosen.get(slot)) for slot in sorted(found))
        return tuple((node, choice) for node, choice in chosen if choice is not None)

    # -- from forms over all unknowns to forms over what is free

    def form(self, whole: Form) -> Form:
        """Returns a form with the values of unknowns that are not free put in."""
        free, width, unknowns = self.free, self.width, self.freezer.values.unknowns
        if isinstance(whole, float) or whole.terms.keys() <= free:
            return whole
        terms: dict[int, float] = {}
        constant, knotted = whole.constant, False
        for slot, slope in whole.terms.items():
            if slot >= width:
                knotted = True
            elif slot in free:
                terms[slot] = slope
            else:
                constant += slope * unknowns[slot]
        if knotted:
            for slot, slope in whole.terms.items():
                if slot >= width:
                    part = self._knot(slot)
                    if isinstance(part, float):
                        constant += slope * part
                    else:
                        constant += slope * part.constant
                        add_terms(terms, part.terms, slope)
        return Affine(terms, constant) if terms else constant

    def _knot(self, root: int) -> Form:
        knots, steady, found = self.forms.knots, self.steady, self.found
        stack = [root]
        while stack:
            slot = stack[-1]
            if slot in steady or slot in found:
                stack.pop()
            elif missing := [each for each in knots[slot].below if each not in steady and each not in found]:
                stack.extend(missing)
            else:
                self._place(slot, knots[slot])
        form = found.get(root)
        return steady[root] if form is None else form

    def _place(self, slot: int, knot: Knot) -> None:
        op = knot.op
        hangs = not self.hanging.isdisjoint(knot.below)
        parts = [self.form(part) for part in knot.parts]
        form = branched(op, parts) if op in BRANCHING else applied(op, parts)
        if form is None and op in BRANCHING and self.freezer.pruning:
            choice = self.chosen[slot] = self._choice(knot)
            hangs, form = True, parts[0 if op == Op.ABS else choice]
            form = scaled(form, -1.0) if op == Op.ABS and choice else form
        elif form is None:
            operands = tuple([self._slot(part) for part in parts])
            form = Affine({self._new(op, operands): 1.0}, 0.0)
        if hangs:
            self.hanging.add(slot)
            self.found[slot] = form
        else:
            self.steady[slot] = form

    def _choice(self, knot: Knot) -> int:
        """Returns the branch taken: for minimum and maximum 0 or 1, for select 1 or 2, for abs 0 or 1."""
        nodes, operands = self.freezer.values.nodes, self.freezer.values.tape.operand_lists[knot.node]
        first = nodes[operands[0]]
        if knot.op == Op.SELECT:
            choice = int(not first >= 0.0)
        else:
            second = 0.0 if knot.op == Op.ABS else nodes[operands[1]]
            ahead = first - second if knot.op == Op.MINIMUM else second - first
            choice = int(ahead > TIE * (1.0 + abs(first)))
        if knot.node in self.flipped:
            choice = 1 - choice
        return choice + 1 if knot.op == Op.SELECT else choice

    # -- recipes

    def _slot(self, form: Form) -> int:
        if isinstance(form, float):
            return self._new(NUMBER, (), (), form)
        if len(form.terms) == 1 and form.constant == 0.0:
            ((slot, slope),) = form.terms.items()
            if slope == 1.0:
                return slot
        return self._new(SUM, tuple(form.terms), tuple(form.terms.values()), form.constant)

    def _new(
        self, op: int, operands: tuple[int, ...], slopes: tuple[float, ...] = (), constant: float = 0.0
    ) -> int:
        inputs = frozenset[int]().union(*map(self._inputs, operands))
        self.recipes.append(SlotRecipe(op, operands, inputs, slopes, constant))
        return self.width + len(self.recipes) - 1

    def _inputs(self, slot: int) -> frozenset[int]:
        return frozenset((slot,)) if slot < self.width else self.recipes[slot - self.width].inputs

    # -- from forms to programs

    def _programs(self, rooted: list[tuple[int, Affine]]) -> list[AffineProgram | Program]:
        """Returns a program for each set of rows that share unknowns, directly or by way of others."""
        part_of: dict[int, tuple[list[int], set[int]]] = {}
        """The rows and unknowns that hang together, by unknown."""
        for i, (_, form) in enumerate(rooted):
            unknowns: set[int] = set().union(*map(self._inputs, form.terms))
            parts = {id(part_of[u]): part_of[u] for u in unknowns if u in part_of}
            largest = max(parts.values(), key=lambda part: len(part[1]), default=([], set()))
            for part in (([i], unknowns), *parts.values()):
                if part is not largest:
                    largest[0].extend(part[0])
                    part_of.update(dict.fromkeys(part[1] - largest[1], largest))
                    largest[1].update(part[1])
        found = {id(part): (sorted(part[0]), sorted(part[1])) for part in part_of.values()}
        return [self._program([rooted[i] for i in rows], own) for rows, own in sorted(found.values())]

    def _program(self, rows: list[tuple[int, Affine]], columns: list[int]) -> AffineProgram | Program:
        column = {unknown: i for i, unknown in enumerate(columns)}
        numbers = [row for row, _ in rows]
        if any(slot >= self.width for _, form in rows for slot in form.terms):
            return Program(numbers, [form for _, form in rows], columns, self.recipes, self.width)
        matrix = np.zeros((len(rows), len(columns)))
        for i, (_, form) in enumerate(rows):
            for unknown, slope in form.terms.items():
                matrix[i, column[unknown]] = slope
        return AffineProgram(numbers, columns, matrix, np.array([form.constant for _, form in rows]))


# -- programs

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


class Program:
    """Some rows as functions of their free unknowns, with branches fixed.

    rows    (r,) which of the roots given to the freezer
    columns (k,) the unknowns, ascending

    It has slots of its own: the unknowns first, then what is made of them, operands before results. In the
    forms of the rows, slots from `width` on are recipes.
    """

    linear = False

    def __init__(
        self,
        rows: list[int],
        forms: Sequence[Affine],
        columns: list[int],
        recipes: Sequence[SlotRecipe],
        width: int,
    ) -> None:
        self.rows, self.columns, self._recipes, self._width = rows, columns, recipes, width
        self._local = {unknown: i for i, unknown in enumerate(columns)}
        self._values = [0.0] * len(columns)
        self._edges: list[list[tuple[int, int]]] = [[] for _ in columns]
        self._weights = [0.0]
        self._varies = [True] * len(columns)
        self._code: list[Compiled] = []
        self._partials: list[Partial] = []
        for form in forms:
            for slot in form.terms:
                self._reach(slot)
        self._roots: list[int] = []
        for form in forms:
            operands = tuple(self._local[slot] for slot in form.terms)
            self._roots.append(self._sum(operands, tuple(form.terms.values()), form.constant))
        self._sweeps = [self._sweep(root) for root in self._roots]
        k = len(columns)
        scatter = [i * k + slot for i, sweep in enumerate(self._sweeps) for slot in sweep.inputs]
        self._scatter = np.array(scatter, dtype=np.intp)

    def residuals(self, x: Floats) -> Floats:
        """Returns the values (r,) of the rows at the unknowns `x` (k,)."""
        values = self._values
        values[: len(x)] = x.tolist()
        run(self._code, values)
        return np.array([values[root] for root in self._roots])

    def jacobian(self, row_factors: Floats, column_factors: Floats) -> Floats:
        """Returns the (r, k) partial derivatives where `residuals` was evaluated last, by these factors."""
        values, weights = self._values, self._weights
        for partial, operands, out, edges in self._partials:
            slopes = partial(*[values[i] for i in operands], values[out])
            for edge, slope in zip(edges, slopes, strict=False):
                weights[edge] = slope
        adjoints = [0.0] * len(values)
        entries: list[float] = []
        for sweep in self._sweeps:
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
        flat[self._scatter] = entries
        if not np.isfinite(flat).all():  # products of finite slopes may still overflow
            np.nan_to_num(flat, copy=False)
        matrix = flat.reshape(len(self.rows), len(self.columns))
        matrix *= row_factors[:, None]
        matrix *= column_factors
        return matrix

    def _accumulate_with_care(self, sweep: Sweep, adjoints: list[float]) -> None:
        """Adds up slopes so that those that cancel are zero: what moves all of a row moves nothing in it."""
        weights, sizes = self._weights, dict.fromkeys(sweep.touched, 0.0)
        for parent, child, edge in sweep.edges:
            slope = adjoints[parent]
            if abs(slope) > CANCELLED * sizes[parent]:
                slope *= weights[edge]
                adjoints[child] += slope
                sizes[child] += abs(slope)
        for slot in sweep.inputs:
            if abs(adjoints[slot]) <= CANCELLED * sizes[slot]:
                adjoints[slot] = 0.0

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
        self._code.append(compiled(recipe.op, out, operands))
        edges = tuple(self._new_edge(out, a) if self._varies[a] else UNUSED for a in operands)
        padded = operands if len(operands) > 1 else operands * 2
        self._partials.append((PARTIALS[recipe.op], padded, out, edges))
        return out

    def _sum(self, operands: tuple[int, ...], slopes: tuple[float, ...], constant: float) -> int:
        out = self._new_slot(0.0)
        self._code.append((_weighted(slopes, constant), operands, -1, out))
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

    def _sweep(self, root: int) -> Sweep:
        """Returns the sweep of a root over the slots that it depends on, operands last."""
        seen = {root}
        stack = [root]
        while stack:
            for child, _ in self._edges[stack.pop()]:
                if child not in seen:
                    seen.add(child)
                    stack.append(child)
        touched = sorted(seen, reverse=True)
        edges = [(parent, child, edge) for parent in touched for child, edge in self._edges[parent]]
        leaves = [slot for slot in touched if slot < len(self.columns)]
        return Sweep(root, edges, leaves, touched, merging=len(edges) >= len(touched))


def _weighted(slopes: tuple[float, ...], constant: float) -> Callable[..., float]:
    def total(*values: float) -> float:
        return sum(map(mul, slopes, values), constant)

    return total

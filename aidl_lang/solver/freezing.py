"""From rows of the tape to programs: fold what is constant, fix the branches, separate what is independent.

A `Freezer` takes the rows of one attempt. What depends on no free unknown becomes a number, what is affine in
free unknowns a combination of them, so that most rows are affine before any equation is solved. `abs`,
`minimum`, `maximum` and `select` are replaced by the branch active at the current values (paper, appendix B),
but for those that no free unknown can decide: two places on one rigid part keep their order wherever it goes.
Only what is left to choose counts as a branch. Rows that share no free unknown go to programs of their own.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from operator import mul
from typing import TypeAlias

import numpy as np

from aidl_lang.solver.array_freezing import TIE, ZERO, ArrayFreezing
from aidl_lang.solver.array_program import CANCELLED, ArrayProgram
from aidl_lang.solver.components import components
from aidl_lang.solver.operations import BRANCHING, PARTIALS, Op
from aidl_lang.solver.program import AffineProgram, Program, Sweep
from aidl_lang.solver.valuation import Cone, Valuation, compiled, evaluate

Root: TypeAlias = "int | tuple[int, int]"
"""A tape node, or the difference of two, the first of which may be `ZERO`."""

MANY = 400
"""Roots from which on programs work on arrays."""
UNUSED = 0
"""Weight that is written for operands without a free unknown and never read."""

Branch: TypeAlias = tuple[int, int]
"""A branching node and which of its branches is meant."""


@dataclass(frozen=True, slots=True)
class Affine:
    """A combination of slots: the sum of `slope * value`, and a number."""

    terms: Mapping[int, float]
    constant: float


Form: TypeAlias = "float | Affine"
"""What a node became: its value if it depends on no free unknown, else a combination of slots."""


@dataclass(frozen=True, slots=True)
class Recipe:
    """How the value of a slot comes from those of others: an operation, or a sum with these slopes.

    inputs  the slots of the free unknowns that it depends on
    """

    op: int
    operands: tuple[int, ...]
    inputs: frozenset[int]
    slopes: tuple[float, ...] = ()
    constant: float = 0.0


SUM = -1
"""The operation of a recipe that is a sum."""
NUMBER = -2
"""The operation of a recipe that is a number."""


@dataclass
class Frozen:
    """What freezing makes: programs without common unknowns, and what does not depend on free unknowns.

    programs  with the rows (indices into the roots given) and unknowns of each
    constant  rows that no free unknown can change
    branches  the choices made at branching nodes that free unknowns decide
    steady    rows that hang on no such choice
    """

    programs: Sequence[AffineProgram | Program | ArrayProgram]
    constant: list[int]
    branches: tuple[Branch, ...]
    steady: frozenset[int]


class Freezer:
    """Makes programs of rows with the unknowns `free`, for one branch after another. What hangs on no branch
    is worked out once.

    `varying` is what of the rows changes with these unknowns. What they are made of besides must be up to
    date, and may not change meanwhile.
    """

    def __init__(self, values: Valuation, free: Iterable[int], varying: Cone) -> None:
        self._valuation = values
        self._varying = frozenset(varying.nodes)
        self._unknowns = sorted(free)
        self._slot_of_unknown = {unknown: slot for slot, unknown in enumerate(self._unknowns)}
        self._recipes: list[Recipe] = [
            Recipe(Op.UNKNOWN, (unknown,), frozenset((slot,))) for slot, unknown in enumerate(self._unknowns)
        ]
        self._steady: dict[int, Form] = {}
        self._hanging: set[int] = set()
        """Nodes that hang on a choice, which free unknowns decide."""

    def freeze(self, roots: Sequence[Root], flipped: frozenset[int] = frozenset()) -> Frozen:
        """Programs for `roots` at the current values, which must be up to date. Branching nodes in `flipped`
        take the branch that is not active.
        """
        if len(roots) < MANY:
            return _Freezing(self, flipped).freeze(roots)
        return _freeze_to_arrays(self._valuation, roots, self._unknowns, flipped)

    def form(self, node: int) -> Form | None:
        """What a node became; None if that hangs on a choice."""
        _Freezing(self, frozenset()).reach(node)
        return None if node in self._hanging else self._steady[node]

    def unknown(self, slot: int) -> int | None:
        """The unknown whose value a slot has, if it is one."""
        return self._unknowns[slot] if slot < len(self._unknowns) else None

    def choices(self, roots: Iterable[int]) -> list[int]:
        """The nodes below `roots` at which free unknowns choose the branch, outermost first."""
        tape, hanging = self._valuation.tape, self._hanging
        found: set[int] = set()
        stack, freezing = list(roots), _Freezing(self, frozenset())
        for root in stack:
            freezing.reach(root)
        stack = [root for root in stack if root in hanging]
        while stack:
            node = stack.pop()
            if node not in found:
                found.add(node)
                stack.extend(a for a in tape.operand_lists[node] if a in hanging)
        return sorted((node for node in found if tape.op_list[node] in BRANCHING), reverse=True)


def _freeze_to_arrays(
    values: Valuation, roots: Sequence[Root], free: Iterable[int], flipped: frozenset[int]
) -> Frozen:
    movable = np.zeros(len(values.unknowns), dtype=np.bool_)
    movable[list(free)] = True
    differences = [root for root in roots if not isinstance(root, int)]
    further = itertools.count(len(values.nodes))
    nodes = np.array([root if isinstance(root, int) else next(further) for root in roots], dtype=np.int64)
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


@dataclass
class _Freezing:
    """One choice of branches."""

    freezer: Freezer
    flipped: frozenset[int]
    forms: dict[int, Form] = field(default_factory=dict)
    """Of the nodes that hang on a choice."""
    chosen: dict[int, int] = field(default_factory=dict)
    """The choice at each node that has one."""

    def __post_init__(self) -> None:
        self.valuation = self.freezer._valuation
        self.recipes = self.freezer._recipes
        self.varying = self.freezer._varying
        self.steady, self.hanging = self.freezer._steady, self.freezer._hanging

    def freeze(self, roots: Sequence[Root]) -> Frozen:
        hanging = self.hanging
        for root in roots:
            for node in (root,) if isinstance(root, int) else root:
                if node != ZERO:
                    self.reach(node)
        forms = [self._form_of_root(root) for root in roots]
        constant = [row for row, form in enumerate(forms) if isinstance(form, float)]
        rooted = [(row, form) for row, form in enumerate(forms) if isinstance(form, Affine)]
        steady = frozenset(
            row for row, root in enumerate(roots) if isinstance(root, int) and root not in hanging
        )
        return Frozen(self._programs(rooted), constant, self._active(roots), steady)

    def _active(self, roots: Sequence[Root]) -> tuple[Branch, ...]:
        """The choices that the roots hang on, not those within branches that were not taken."""
        tape, hanging, chosen = self.valuation.tape, self.hanging, self.chosen
        found: set[int] = set()
        stack = [node for root in roots for node in ((root,) if isinstance(root, int) else root)]
        while stack:
            node = stack.pop()
            if node in hanging and node not in found:
                found.add(node)
                operands = tape.operand_lists[node]
                choice = chosen.get(node)
                if choice is None or tape.op_list[node] == Op.ABS:
                    stack.extend(operands)
                else:
                    stack.append(operands[choice])
        return tuple((node, chosen[node]) for node in sorted(found) if node in chosen)

    def _form_of_root(self, root: Root) -> Form:
        if isinstance(root, int):
            return self._form(root)
        a, b = (0.0 if node == ZERO else self._form(node) for node in root)
        return self._combine(a, b, -1.0)

    # -- from nodes to forms

    def _form(self, node: int) -> Form:
        found = self.forms.get(node)
        return self.steady[node] if found is None else found

    def reach(self, root: int) -> None:
        """Finds the forms of a node and of what it is made of."""
        operands, steady, forms = self.valuation.tape.operand_lists, self.steady, self.forms
        ops, nodes, varying = self.valuation.tape.op_list, self.valuation.nodes, self.varying
        stack = [root]
        while stack:
            node = stack[-1]
            if node in steady or node in forms:
                stack.pop()
                continue
            if node not in varying:
                steady[node] = nodes[node]
                stack.pop()
                continue
            missing = (
                [a for a in operands[node] if a not in steady and a not in forms]
                if ops[node] > Op.UNKNOWN
                else ()
            )
            if missing:
                stack.extend(missing)
            else:
                stack.pop()
                self._place(node, ops[node], operands[node])

    def _place(self, node: int, op: int, operands: tuple[int, ...]) -> None:
        if op == Op.UNKNOWN:
            self.steady[node] = Affine({self.freezer._slot_of_unknown[operands[0]]: 1.0}, 0.0)
        else:
            hangs = any(a in self.hanging for a in operands)
            parts = [self._form(a) for a in operands]
            form = self._branched(op, parts) if op in BRANCHING else self._applied(op, parts)
            if form is None:
                choice = self._choice(node, op, operands)
                self.chosen[node] = choice
                form, hangs = self._taken(op, parts, choice), True
            if hangs:
                self.hanging.add(node)
                self.forms[node] = form
            else:
                self.steady[node] = form

    def _branched(self, op: int, parts: Sequence[Form]) -> Form | None:
        """The form of a branching node if nothing is left to choose."""
        first = parts[0]
        if op == Op.SELECT:
            if isinstance(first, float):
                return parts[1 if first >= 0.0 else 2]
            alike = self._combine(parts[1], parts[2], -1.0)
            return parts[1] if alike == 0.0 else None
        if op == Op.ABS:
            return abs(first) if isinstance(first, float) else None
        ahead = self._combine(first, parts[1], -1.0)
        if not isinstance(ahead, float):
            return None
        if ahead != ahead:
            return ahead
        return parts[0] if (ahead <= 0.0) == (op == Op.MINIMUM) else parts[1]

    def _choice(self, node: int, op: int, operands: tuple[int, ...]) -> int:
        """Which branch is taken: for minimum and maximum 0 or 1, for select 1 or 2, for abs 0 or 1."""
        nodes = self.valuation.nodes
        first = nodes[operands[0]]
        if op == Op.SELECT:
            choice = int(not first >= 0.0)
        else:
            second = 0.0 if op == Op.ABS else nodes[operands[1]]
            ahead = first - second if op == Op.MINIMUM else second - first
            choice = int(ahead > TIE * (1.0 + abs(first)))
        if node in self.flipped:
            choice = 1 - choice
        return choice + 1 if op == Op.SELECT else choice

    def _taken(self, op: int, parts: Sequence[Form], choice: int) -> Form:
        if op != Op.ABS:
            return parts[choice]
        return _scaled(parts[0], -1.0) if choice else parts[0]

    def _applied(self, op: int, parts: Sequence[Form]) -> Form:
        first, last = parts[0], parts[-1]
        if all(isinstance(part, float) for part in parts):
            return evaluate(op, [part for part in parts if isinstance(part, float)])
        match op:
            case Op.ADD:
                return self._combine(first, last, 1.0)
            case Op.SUB:
                return self._combine(first, last, -1.0)
            case Op.NEG:
                return _scaled(first, -1.0)
            case Op.MUL if isinstance(first, float) and _is_finite(first):
                return _scaled(last, first)
            case Op.MUL if isinstance(last, float) and _is_finite(last):
                return _scaled(first, last)
            case Op.DIV if isinstance(last, float) and last != 0.0 and _is_finite(1.0 / last):
                return _scaled(first, 1.0 / last)
        slots = tuple(self._slot(part) for part in parts)
        return Affine({self._new(op, slots): 1.0}, 0.0)

    def _combine(self, a: Form, b: Form, sign: float) -> Form:
        """`a + sign * b`; slopes that cancel vanish, so that a frame which moves both moves nothing."""
        if isinstance(b, float):
            return a + sign * b if isinstance(a, float) else Affine(a.terms, a.constant + sign * b)
        if isinstance(a, float):
            return Affine({slot: sign * slope for slot, slope in b.terms.items()}, a + sign * b.constant)
        terms = dict(a.terms)
        for slot, slope in b.terms.items():
            known = terms.get(slot)
            if known is None:
                terms[slot] = sign * slope
            elif abs(total := known + sign * slope) > CANCELLED * (abs(known) + abs(slope)):
                terms[slot] = total
            else:
                del terms[slot]
        constant = a.constant + sign * b.constant
        return Affine(terms, constant) if terms else constant

    # -- slots

    def _slot(self, form: Form) -> int:
        """The slot that has the value of a form."""
        recipes = self.recipes
        if isinstance(form, float):
            recipes.append(Recipe(NUMBER, (), frozenset(), (), form))
            return len(recipes) - 1
        if len(form.terms) == 1 and form.constant == 0.0:
            ((slot, slope),) = form.terms.items()
            if slope == 1.0:
                return slot
        return self._new(SUM, tuple(form.terms), tuple(form.terms.values()), form.constant)

    def _new(
        self, op: int, operands: tuple[int, ...], slopes: tuple[float, ...] = (), constant: float = 0.0
    ) -> int:
        recipes = self.recipes
        inputs = frozenset().union(*[recipes[slot].inputs for slot in operands])
        recipes.append(Recipe(op, operands, inputs, slopes, constant))
        return len(recipes) - 1

    # -- from forms to programs

    def _programs(self, rooted: list[tuple[int, Affine]]) -> list[AffineProgram | Program]:
        recipes = self.recipes
        leader: dict[int, int] = {}

        def find(slot: int) -> int:
            while (above := leader.setdefault(slot, slot)) != slot:
                leader[slot] = slot = leader[above]
            return slot

        for _, form in rooted:
            first = None
            for slot in form.terms:
                for unknown in recipes[slot].inputs:
                    at = find(unknown)
                    if first is None:
                        first = at
                    elif at != first:
                        low, high = min(first, at), max(first, at)
                        leader[high] = first = low
        members: dict[int, list[tuple[int, Affine]]] = {}
        for row, form in rooted:
            at = next(unknown for slot in form.terms for unknown in recipes[slot].inputs)
            members.setdefault(find(at), []).append((row, form))
        slots: dict[int, list[int]] = {first: [] for first in members}
        for slot in sorted(leader):
            slots[find(slot)].append(slot)
        return [self._program(rows, slots[first]) for first, rows in members.items()]

    def _program(self, rows: list[tuple[int, Affine]], slots: list[int]) -> AffineProgram | Program:
        columns = [self.freezer._unknowns[slot] for slot in slots]
        column = {slot: i for i, slot in enumerate(slots)}
        numbers = [row for row, _ in rows]
        if any(slot not in column for _, form in rows for slot in form.terms):
            return _Assembly(self.recipes, slots, columns).program(numbers, [form for _, form in rows])
        matrix = np.zeros((len(rows), len(columns)))
        for i, (_, form) in enumerate(rows):
            for slot, slope in form.terms.items():
                matrix[i, column[slot]] = slope
        return AffineProgram(numbers, columns, matrix, np.array([form.constant for _, form in rows]))


class _Assembly:
    """Puts together a program of rows that are not all affine, with slots of its own: the unknowns first,
    then what is made of them, operands before results.
    """

    def __init__(self, recipes: Sequence[Recipe], slots: Sequence[int], columns: list[int]) -> None:
        self._recipes, self._columns = recipes, columns
        self._local = {slot: i for i, slot in enumerate(slots)}
        self._values = [0.0] * len(slots)
        self._edges: list[list[tuple[int, int]]] = [[] for _ in slots]
        self._weights = [0.0]
        self._varies = [True] * len(slots)
        self._program = Program([], [], columns, list(range(len(slots))), self._values, self._weights)

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
            recipe = self._recipes[slot]
            missing = [a for a in recipe.operands if a not in self._local]
            if missing:
                stack.extend(missing)
            else:
                stack.pop()
                self._local[slot] = self._make(recipe)

    def _make(self, recipe: Recipe) -> int:
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


def _scaled(form: Form, factor: float) -> Form:
    if isinstance(form, float):
        return form * factor
    if factor == 0.0:
        return 0.0
    return Affine({slot: slope * factor for slot, slope in form.terms.items()}, form.constant * factor)


def _is_finite(number: float) -> bool:
    return number - number == 0.0

"""From rows of the tape to programs: fold what is constant, fix the branches, separate what is independent.

`freeze` takes the rows of one attempt. What depends on no free unknown becomes a number; `abs`, `minimum`,
`maximum` and `select` are replaced by the branch active at the current values (paper, appendix B); and rows
that share no free unknown go to programs of their own. Many rows become programs on arrays.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np

from aidl_lang.solver.array_freezing import TIE, ZERO, ArrayFreezing
from aidl_lang.solver.array_program import ArrayProgram
from aidl_lang.solver.components import components
from aidl_lang.solver.operations import BRANCHING, LINEAR, PARTIALS, Op
from aidl_lang.solver.program import Program, Sweep
from aidl_lang.solver.valuation import Valuation, compiled, evaluate

Instruction: TypeAlias = tuple[int, int, tuple[int, ...]]
"""Operation, slot of the result, slots of the operands."""

Root: TypeAlias = "int | tuple[int, int]"
"""A tape node, or the difference of two, the first of which may be `ZERO`."""

MANY = 100
"""Roots from which on programs work on arrays."""
UNUSED = 0
"""Weight that is written for operands without a free unknown and never read."""

Branch: TypeAlias = tuple[int, int]
"""A branching node and which of its branches is meant."""


@dataclass
class Frozen:
    """What `freeze` makes: programs without common unknowns, and what does not depend on free unknowns.

    programs  with the rows (indices into the roots given) and unknowns of each
    constant  rows that no free unknown can change
    branches  the choices made at branching nodes that depend on free unknowns
    """

    programs: Sequence[Program | ArrayProgram]
    constant: list[int]
    branches: tuple[Branch, ...]


def freeze(
    values: Valuation, roots: Sequence[Root], free: Iterable[int], flipped: frozenset[int] = frozenset()
) -> Frozen:
    """Programs for `roots` over the `free` unknowns at the current values.

    The roots must have been refreshed. Branching nodes in `flipped` take the branch that is not active.
    """
    if len(roots) < MANY:
        return _Freezer(values, free, flipped).freeze(roots)
    return _freeze_to_arrays(values, roots, free, flipped)


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
    return Frozen(programs, np.flatnonzero(~varying).tolist(), tuple(freezing.branches(nodes)))


@dataclass
class _Freezer:
    """Slots are numbered so that operands come first; the unknowns have the first ones, ascending."""

    valuation: Valuation
    free: Iterable[int]
    flipped: frozenset[int]
    values: list[float] = field(default_factory=list)
    weights: list[float] = field(default_factory=lambda: [0.0])
    code: list[Instruction] = field(default_factory=list)
    edges: list[list[tuple[int, int]]] = field(default_factory=list)
    leader: list[int] = field(default_factory=list)
    branches: list[Branch] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.unknown_of_slot = sorted(self.free)
        self.slot_of_unknown = {unknown: slot for slot, unknown in enumerate(self.unknown_of_slot)}
        self.form: dict[int, int | float] = {}
        """What each node became: a slot (int) if it depends on a free unknown, else its value (float)."""
        for unknown in self.unknown_of_slot:
            self._new_slot(self.valuation.unknowns[unknown])

    def freeze(self, roots: Sequence[Root]) -> Frozen:
        for node in self._needed(roots):
            self._place(node)
        forms = [self._form_of_root(root) for root in roots]
        constant = [row for row, form in enumerate(forms) if isinstance(form, float)]
        programs = self._programs([(row, form) for row, form in enumerate(forms) if isinstance(form, int)])
        return Frozen(programs, constant, tuple(self.branches))

    def _form_of_root(self, root: Root) -> int | float:
        if isinstance(root, int):
            return self.form[root]
        a, b = (0.0 if node == ZERO else self.form[node] for node in root)
        if isinstance(a, float) and isinstance(b, float):
            return a - b
        return self._emit(Op.SUB, [a, b])

    # -- from nodes to slots

    def _needed(self, roots: Iterable[Root]) -> list[int]:
        """Nodes below the roots through active branches only, operands first."""
        tape = self.valuation.tape
        ops, operands = tape.op_list, tape.operand_lists
        seen: set[int] = set()
        stack: list[int] = []
        for root in roots:
            stack.extend((root,) if isinstance(root, int) else (node for node in root if node != ZERO))
        while stack:
            node = stack.pop()
            if node in seen:
                continue
            seen.add(node)
            op = ops[node]
            if op in BRANCHING:
                stack.extend(self._active(node, op))
            elif op > Op.UNKNOWN:
                stack.extend(operands[node])
        return sorted(seen)

    def _choice(self, node: int, op: int) -> int:
        """Which branch is taken: for minimum and maximum 0 or 1, for select 1 or 2, for abs 0 or 1."""
        operands, nodes = self.valuation.tape.operand_lists[node], self.valuation.nodes
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

    def _active(self, node: int, op: int) -> tuple[int, ...]:
        operands = self.valuation.tape.operand_lists[node]
        if op == Op.ABS:
            return operands
        return (operands[self._choice(node, op)],)

    def _place(self, node: int) -> None:
        tape, form = self.valuation.tape, self.form
        op, operands = tape.op_list[node], tape.operand_lists[node]
        if op == Op.CONSTANT:
            form[node] = self.valuation.nodes[node]
        elif op == Op.UNKNOWN:
            slot = self.slot_of_unknown.get(operands[0])
            form[node] = self.valuation.unknowns[operands[0]] if slot is None else slot
        elif op in BRANCHING:
            self._place_branch(node, op)
        elif any(isinstance(form[a], int) for a in operands):
            form[node] = self._emit(op, [form[a] for a in operands])
        else:
            form[node] = evaluate(op, [float(form[a]) for a in operands])

    def _place_branch(self, node: int, op: int) -> None:
        active = [self.form[a] for a in self._active(node, op)]
        choice = self._choice(node, op)
        self.branches.append((node, choice))
        if op != Op.ABS or not choice:
            self.form[node] = active[0]
        else:
            self.form[node] = self._emit(Op.NEG, active) if isinstance(active[0], int) else -active[0]

    def _emit(self, op: int, operands: Sequence[int | float]) -> int:
        slots = tuple(form if isinstance(form, int) else self._new_slot(form) for form in operands)
        out = self._new_slot(0.0)
        self.code.append((op, out, slots))
        for form in operands:
            if isinstance(form, int):
                self._unite(form, out)
        return out

    def _new_slot(self, value: float) -> int:
        self.values.append(value)
        self.edges.append([])
        self.leader.append(len(self.leader))
        return len(self.values) - 1

    # -- from slots to programs

    def _find(self, slot: int) -> int:
        leader = self.leader
        while leader[slot] != slot:
            leader[slot] = slot = leader[leader[slot]]
        return slot

    def _unite(self, a: int, b: int) -> None:
        a, b = self._find(a), self._find(b)
        if a != b:
            self.leader[max(a, b)] = min(a, b)

    def _programs(self, rooted: list[tuple[int, int]]) -> list[Program]:
        rows: dict[int, list[tuple[int, int]]] = {}
        for row, slot in rooted:
            rows.setdefault(self._find(slot), []).append((row, slot))
        slots: dict[int, list[int]] = {leader: [] for leader in rows}
        for slot in range(len(self.unknown_of_slot)):
            if (leader := self._find(slot)) in slots:
                slots[leader].append(slot)
        programs = {
            leader: Program(
                rows=[row for row, _ in members],
                roots=[root for _, root in members],
                columns=[self.unknown_of_slot[slot] for slot in slots[leader]],
                slots=slots[leader],
                values=self.values,
                weights=self.weights,
            )
            for leader, members in rows.items()
        }
        self._distribute_code(programs)
        for program in programs.values():
            self._plan_sweeps(program)
        return list(programs.values())

    def _distribute_code(self, programs: dict[int, Program]) -> None:
        inputs = len(self.unknown_of_slot)
        variable = [slot < inputs for slot in range(len(self.values))]
        for op, out, slots in self.code:
            variable[out] = True
            program = programs[self._find(out)]
            program.code.append(compiled(op, out, slots))
            edges = tuple(self._new_edge(out, a) if variable[a] else UNUSED for a in slots)
            if _is_affine(op, [variable[a] for a in slots]):
                self._fix_weights(op, slots, edges)
            else:
                program.linear = False
                operands = slots if len(slots) > 1 else slots * 2
                program.partials.append((PARTIALS[op], operands, out, edges))

    def _new_edge(self, parent: int, child: int) -> int:
        self.weights.append(0.0)
        self.edges[parent].append((child, len(self.weights) - 1))
        return len(self.weights) - 1

    def _fix_weights(self, op: int, slots: tuple[int, ...], edges: tuple[int, ...]) -> None:
        a, b = self.values[slots[0]], self.values[slots[-1]]
        for edge, slope in zip(edges, PARTIALS[op](a, b, 0.0), strict=False):
            self.weights[edge] = slope

    def _plan_sweeps(self, program: Program) -> None:
        inputs, width = len(self.unknown_of_slot), len(program.columns)
        column = {slot: i for i, slot in enumerate(program.slots)}
        scatter: list[int] = []
        for i, root in enumerate(program.roots):
            touched = self._below(root)
            edges = [(parent, child, edge) for parent in touched for child, edge in self.edges[parent]]
            leaves = [slot for slot in touched if slot < inputs]
            merging = len(edges) >= len(touched)
            program.sweeps.append(Sweep(root, edges, leaves, touched, merging))
            scatter.extend(i * width + column[slot] for slot in leaves)
        program.scatter = np.array(scatter, dtype=np.intp)

    def _below(self, root: int) -> list[int]:
        """Slots that the root depends on, and itself, operands last."""
        seen = {root}
        stack = [root]
        while stack:
            for child, _ in self.edges[stack.pop()]:
                if child not in seen:
                    seen.add(child)
                    stack.append(child)
        return sorted(seen, reverse=True)


def _is_affine(op: int, variable: Sequence[bool]) -> bool:
    """Whether an operation is affine in those of its operands that vary."""
    if op == Op.MUL:
        return not all(variable)
    if op == Op.DIV:
        return not variable[1]
    return op in LINEAR

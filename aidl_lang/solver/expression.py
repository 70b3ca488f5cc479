"""Expressions over the unknowns as one shared graph: the tape.

A tape is a directed acyclic graph in plain arrays, each node after its operands, equal nodes stored once.
`TapeBuilder` makes it; `operations` says what each node means; `freezing` evaluates parts of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver.operations import ARITY, VALUE, Floats, Op

CONSTANT = Op.CONSTANT


@record()
class Tape:
    """m nodes, each of them after its operands.

    ops       (m,)   `Op` of each node
    operands  (m, 4) node ids, -1 where there are fewer; for UNKNOWN the index of the unknown
    constants (m,)   value of a CONSTANT, else 0
    levels    (m,)   0 for leaves, else one more than the highest operand
    """

    ops: NDArray[np.int8]
    operands: NDArray[np.int32]
    constants: Floats
    levels: NDArray[np.int32]

    def __len__(self) -> int:
        return len(self.ops)

    @cached_property
    def op_list(self) -> list[int]:
        """`ops` as a Python list, which is quicker to read one by one."""
        return [int(op) for op in self.ops]

    @cached_property
    def operand_lists(self) -> list[tuple[int, ...]]:
        """The operands of each node: node ids, none for constants, the index for an unknown."""
        arity = [1 if op == Op.UNKNOWN else ARITY[op] for op in self.op_list]
        return [tuple(row[:k]) for row, k in zip(self.operands.tolist(), arity, strict=True)]


def _of_one(op: int) -> Callable[[TapeBuilder, int], int]:
    return lambda tape, a: tape._node(op, a)


def _of_two(op: int) -> Callable[[TapeBuilder, int, int], int]:
    return lambda tape, a, b: tape._node(op, a, b)


class TapeBuilder:
    """Builds a tape; each method returns the id of a node, a new one or an equal one made before.

    Operations on constants are folded, and the neutral elements of + - * / ^ vanish. Angles are in radians.
    """

    def __init__(self) -> None:
        self._ops: list[int] = []
        self._operands: list[tuple[int, ...]] = []
        self._constants: list[float] = []
        self._levels: list[int] = []
        self._known: dict[tuple[object, ...], int] = {}
        self._splits: dict[int, tuple[tuple[int, ...], int]] = {}
        self._shifts: set[int] = set()

    def __len__(self) -> int:
        return len(self._ops)

    def constant(self, value: float) -> int:
        value = float(value) + 0.0  # -0.0 becomes 0.0
        key = (CONSTANT, value if value == value else "nan")
        node = self._known.get(key)
        return self._new(key, CONSTANT, (), value) if node is None else node

    def unknown(self, index: int, shifts: bool = False) -> int:
        """Returns the node of an unknown; one that `shifts` what it is added to is taken out of extremes."""
        index = int(index)
        key = (Op.UNKNOWN, index)
        node = self._known.get(key)
        if node is None:
            node = self._new(key, Op.UNKNOWN, (index,), 0.0)
        if shifts:
            self._shifts.add(node)
        return node

    def add(self, a: int, b: int) -> int:
        ops, constants = self._ops, self._constants
        if ops[a] == CONSTANT and constants[a] == 0.0:
            return b
        if ops[b] == CONSTANT and constants[b] == 0.0:
            return a
        return self._of_two(Op.ADD, a, b) if a <= b else self._of_two(Op.ADD, b, a)

    def sub(self, a: int, b: int) -> int:
        if a == b:
            return self.constant(0.0)
        if self._is(b, 0.0):
            return a
        if self._is(a, 0.0):
            return self.neg(b)
        if self._ops[b] == Op.NEG:
            return self.add(a, self._operands[b][0])
        # Two places in one frame: what moves both takes no part, and must not by rounding either.
        common, (left, right) = self._apart((a, b))
        if common:
            return self.sub(left, right)
        if self._ops[a] == self._ops[b] == Op.ADD:
            for i, j in ((0, 0), (0, 1), (1, 0), (1, 1)):
                if self._operands[a][i] == self._operands[b][j]:
                    return self.sub(self._operands[a][1 - i], self._operands[b][1 - j])
        return self._of_two(Op.SUB, a, b)

    def mul(self, a: int, b: int) -> int:
        for factor, other in ((a, b), (b, a)):
            if self._ops[factor] != CONSTANT:
                continue
            value = self._constants[factor]
            if value == 0.0:
                return factor
            if value == 1.0:
                return other
            if value == -1.0:
                return self.neg(other)
        if a == b:
            return self.square(a)
        return self._of_two(Op.MUL, a, b) if a < b else self._of_two(Op.MUL, b, a)

    def div(self, a: int, b: int) -> int:
        if self._is(b, 1.0):
            return a
        return self._node(Op.DIV, a, b)

    def neg(self, a: int) -> int:
        if self._ops[a] == Op.NEG:
            return self._operands[a][0]
        node = self._node(Op.NEG, a)
        if a in self._shifts:
            self._shifts.add(node)
        return node

    sin, cos, tan, asin, acos, sqrt, abs, square = map(
        _of_one, (Op.SIN, Op.COS, Op.TAN, Op.ASIN, Op.ACOS, Op.SQRT, Op.ABS, Op.SQUARE)
    )
    atan2, hypot, mod = map(_of_two, (Op.ATAN2, Op.HYPOT, Op.MOD))
    """`mod` is the remainder a - b floor(a / b), which has the sign of b."""

    def power(self, base: int, exponent: int) -> int:
        if self._is(exponent, 1.0):
            return base
        if self._is(exponent, 2.0):
            return self.square(base)
        if self._is(exponent, 0.5):
            return self.sqrt(base)
        return self._node(Op.POWER, base, exponent)

    def minimum(self, *args: int) -> int:
        return self._extremum(Op.MINIMUM, args)

    def maximum(self, *args: int) -> int:
        return self._extremum(Op.MAXIMUM, args)

    def select(self, condition: int, a: int, b: int) -> int:
        """Returns the node of `a` where `condition` >= 0, else `b`."""
        if a == b:
            return a
        if self._ops[condition] == Op.CONSTANT:
            return a if self._constants[condition] >= 0.0 else b
        common, (first, second) = self._apart((a, b))
        if common:
            return self._sum(common, self.select(condition, first, second))
        return self._node(Op.SELECT, condition, a, b)

    def cubic_max(self, p0: int, p1: int, p2: int, p3: int) -> int:
        """Returns the node of the greatest value in [0, 1] of the cubic with these Bernstein coefficients."""
        if p0 == p1 == p2 == p3:
            return p0
        common, rests = self._apart((p0, p1, p2, p3))
        if common:
            return self._sum(common, self.cubic_max(*rests))
        return self._node(Op.CUBIC_MAX, p0, p1, p2, p3)

    def finish(self) -> Tape:
        padding = (-1, -1, -1, -1)
        padded = [args + padding[len(args) :] for args in self._operands]
        return Tape(
            np.array(self._ops, dtype=np.int8),
            np.array(padded, dtype=np.int32).reshape(-1, 4),
            np.array(self._constants, dtype=np.float64),
            np.array(self._levels, dtype=np.int32),
        )

    def _is(self, node: int, value: float) -> bool:
        return self._ops[node] == CONSTANT and self._constants[node] == value

    def _extremum(self, op: int, args: Sequence[int]) -> int:
        """Returns a balanced tree of binary nodes, so that the depth of the tape stays logarithmic. What is
        added to several operands is added to the least (greatest) of these: the box of a rigid part is worked
        out once and moved with it.
        """
        if not args:
            raise ValueError("minimum and maximum take at least one operand")
        level = sorted(set(args))
        alike: dict[tuple[int, ...], list[int]] = {}
        for a in level:
            alike.setdefault(self._split(a)[0], []).append(a)
        level = []
        for shifts, members in alike.items():
            if shifts and len(members) > 1:
                rests = [self._split(a)[1] for a in members]
                level.append(self._sum(shifts, self._extremum(op, rests)))
            else:
                level += members
        common, rests = self._apart(level)
        if common:
            return self._sum(common, self._extremum(op, rests))
        while len(level) > 1:
            pairs = [self._extreme(op, *level[i : i + 2]) for i in range(0, len(level) - 1, 2)]
            level = pairs + level[len(pairs) * 2 :]
        return level[0]

    def _extreme(self, op: int, a: int, b: int) -> int:
        return a if a == b else self._of_two(op, min(a, b), max(a, b))

    # -- shifts

    def _split(self, node: int) -> tuple[tuple[int, ...], int]:
        """Returns the shifts among the terms of a node, and the node of what is left."""
        found = self._splits.get(node)
        if found is None:
            op, operands = self._ops[node], self._operands[node]
            if node in self._shifts:
                found = (node,), self.constant(0.0)
            elif op == Op.NEG:
                shifts, rest = self._split(operands[0])
                found = tuple(map(self.neg, shifts)), self.neg(rest)
            elif op == Op.ADD or op == Op.SUB:
                (first, left), (second, right) = map(self._split, operands)
                if op == Op.SUB:
                    second, right = tuple(map(self.neg, second)), self.neg(right)
                found = tuple(sorted(first + second)), self.add(left, right) if first or second else node
            else:
                found = (), node
            self._splits[node] = found
        return found

    def _apart(self, nodes: Sequence[int]) -> tuple[list[int], list[int]]:
        """Returns the shifts that all nodes have in common, and each node without them."""
        splits = [self._split(node) for node in nodes]
        common = list(splits[0][0])
        for shifts, _ in splits[1:]:
            common = _shared(common, shifts)[0]
        if not common:
            return common, list(nodes)
        return common, [self._sum(_shared(shifts, common)[1], rest) for shifts, rest in splits]

    def _sum(self, shifts: Iterable[int], rest: int) -> int:
        total = self.constant(0.0)
        for shift in shifts:
            total = self.add(total, shift)
        return self.add(total, rest)

    def _of_two(self, op: int, a: int, b: int) -> int:
        """Returns the node of an operation on two operands, the most common kind."""
        key = (op, a, b)
        node = self._known.get(key)
        if node is not None:
            return node
        if self._ops[a] == CONSTANT == self._ops[b]:
            return self._node(op, a, b)
        return self._new(key, op, (a, b), 0.0)

    def _node(self, op: int, *args: int) -> int:
        ops, constants = self._ops, self._constants
        if {ops[a] for a in args} == {CONSTANT}:
            values = [constants[a] for a in args]
            folded = VALUE[op](*values) if len(values) > 1 else VALUE[op](values[0], 0.0)
            if math.isfinite(folded):
                return self.constant(folded)
        key = (op, *args)
        node = self._known.get(key)
        return self._new(key, op, args, 0.0) if node is None else node

    def _new(self, key: tuple[object, ...], op: int, operands: tuple[int, ...], constant: float) -> int:
        node = self._known[key] = len(self._ops)
        self._ops.append(op)
        self._operands.append(operands)
        self._constants.append(constant)
        self._levels.append(1 + max(map(self._levels.__getitem__, operands)) if op > Op.UNKNOWN else 0)
        return node


def _shared(nodes: Iterable[int], others: Iterable[int]) -> tuple[list[int], list[int]]:
    """Returns the nodes that are among the others too, each as often as there, and the rest of them."""
    left = list(others)
    shared, rest = list[int](), list[int]()
    for node in nodes:
        if node in left:
            left.remove(node)
            shared.append(node)
        else:
            rest.append(node)
    return shared, rest


def below(tape: Tape, roots: Iterable[int], ends: bytes | None = None) -> list[int]:
    """Returns the nodes that `roots` are made of, operands first; nothing below those marked as `ends`."""
    ops, operands = tape.op_list, tape.operand_lists
    seen = set(roots)
    stack = list(seen)
    while stack:
        node = stack.pop()
        if ops[node] > Op.UNKNOWN and (ends is None or not ends[node]):
            for a in operands[node]:
                if a not in seen:
                    seen.add(a)
                    stack.append(a)
    return sorted(seen)


def mentioned(tape: Tape, roots: Iterable[int]) -> list[int]:
    """Returns the unknowns that `roots` are made of, in the order of their nodes."""
    ops, operands = tape.op_list, tape.operand_lists
    return [operands[node][0] for node in below(tape, roots) if ops[node] == Op.UNKNOWN]

"""Expressions over the unknowns as one shared graph: the tape.

A tape is a directed acyclic graph in plain arrays, each node after its operands, equal nodes stored once.
`TapeBuilder` makes it; `freezing` evaluates parts of it.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record

# --- The operations of the tape: values and partial derivatives, safe on any input.
#
# Values follow IEEE arithmetic: a quotient by zero is infinite, a root of a negative number is NaN, and
# nothing raises or warns. A residual that is not finite never counts as satisfied, and Newton's method never
# steps onto one. Partial derivatives, on the other hand, are always finite, and at singular places they are
# chosen so that Newton's method can leave them:
#
#     sqrt   at 0                   1 (the true slope is infinite, and its Newton step zero)
#     hypot  at (0, 0)              (1, 0): coincident points that shall be apart part along x
#     atan2  at (0, 0)              1 in y: a line without length is taken to point along +x
#     abs    at 0                   1
#     asin, acos at -1 and 1        the slope is capped at 1e8
#
# Each operation has a scalar form; those that are frequent have one on arrays besides, of the same meaning.
# Functions of one operand take a second and ignore it, so that both are called alike.

Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.intp]
Bools: TypeAlias = NDArray[np.bool_]

NAN = math.nan
ROUNDING = 1e-9
"""Distance outside its domain that an operand of sqrt, asin or acos may have by rounding alone."""
STEEPEST = 1e8
"""Cap on the slope of asin and acos at the ends of their domain."""


class Op:
    """The operations by name. Plain numbers: to read a member of an `Enum` costs more than an operation."""

    CONSTANT: Final = 0
    UNKNOWN: Final = 1
    ADD: Final = 2
    SUB: Final = 3
    MUL: Final = 4
    DIV: Final = 5
    NEG: Final = 6
    POWER: Final = 7
    SIN: Final = 8
    COS: Final = 9
    TAN: Final = 10
    ASIN: Final = 11
    ACOS: Final = 12
    ATAN2: Final = 13
    SQRT: Final = 14
    ABS: Final = 15
    SQUARE: Final = 16
    HYPOT: Final = 17
    MINIMUM: Final = 18
    MAXIMUM: Final = 19
    MOD: Final = 20
    SELECT: Final = 21
    CUBIC_MAX: Final = 22


NAMES = {number: name.lower() for name, number in vars(Op).items() if name.isupper()}
"""The name of each operation, which is also that of the builder's method for it."""
ARITY: tuple[int, ...] = (0, 0, 2, 2, 2, 2, 1, 2, 1, 1, 1, 1, 1, 2, 1, 1, 1, 2, 2, 2, 2, 3, 4)
"""Number of operands of each operation, indexed by `Op`."""

BRANCHING = frozenset({Op.ABS, Op.MINIMUM, Op.MAXIMUM, Op.SELECT})
LINEAR = frozenset({Op.ADD, Op.SUB, Op.NEG})
IDENTITY = 40
"""The code, on arrays, of a branching node whose branch is chosen; beyond the codes of `Op`."""


def _div(a: float, b: float) -> float:
    if b != 0.0:
        return a / b
    return NAN if a == 0.0 or a != a else math.copysign(math.inf, a)


def _power(a: float, b: float) -> float:
    try:
        value = a**b
    except ZeroDivisionError:
        return math.inf
    except OverflowError:
        return math.inf if a > 0.0 or b % 2.0 == 0.0 else -math.inf
    return value if isinstance(value, float) else NAN  # a negative base gives a complex number


def _finite_only(function: Callable[[float], float]) -> Callable[[float, float], float]:
    def contained(a: float, _: float) -> float:
        return function(a) if math.isfinite(a) else NAN

    return contained


def _clamp_unit(a: float) -> float:
    """Returns `a` within [-1, 1], NaN if it is outside by more than rounding."""
    if -1.0 <= a <= 1.0:
        return a
    return math.copysign(1.0, a) if abs(a) <= 1.0 + ROUNDING else NAN


def _sqrt(a: float, _: float) -> float:
    if a >= 0.0:
        return math.sqrt(a)
    return 0.0 if a >= -ROUNDING else NAN


def whole_turns(a: float, b: float) -> float:
    """Returns floor(a / b), NaN if the quotient is not finite."""
    quotient = _div(a, b)
    return float(math.floor(quotient)) if math.isfinite(quotient) else NAN


def bernstein_weights(t: float) -> tuple[float, float, float, float]:
    """Returns the four cubic Bernstein polynomials at `t`."""
    s = 1.0 - t
    return s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t


def cubic_maximiser(p0: float, p1: float, p2: float, p3: float) -> float:
    """Returns the t in [0, 1] at which the cubic with Bernstein coefficients p0 … p3 is greatest.

    Critical points are the roots of the derivative, a quadratic with Bernstein coefficients
    p1 - p0, p2 - p1, p3 - p2 (Farin, Curves and Surfaces for CAGD, section 5.3). Of equals the least wins.
    """
    d0, d1, d2 = p1 - p0, p2 - p1, p3 - p2
    best, highest = (0.0, p0) if not p3 > p0 else (1.0, p3)
    for t in _quadratic_roots(d0 - 2.0 * d1 + d2, d1 - d0, d0):
        if 0.0 < t < 1.0:
            w0, w1, w2, w3 = bernstein_weights(t)
            height = w0 * p0 + w1 * p1 + w2 * p2 + w3 * p3
            if height > highest:
                best, highest = t, height
    return best


def _quadratic_roots(a: float, half_b: float, c: float) -> tuple[float, ...]:
    """Returns the real roots of a t² + 2 half_b t + c without cancellation (Numerical Recipes, 5.6)."""
    discriminant = half_b * half_b - a * c
    if not (discriminant >= 0.0 and math.isfinite(discriminant)):
        return ()
    q = -(half_b + math.copysign(math.sqrt(discriminant), half_b))
    roots = [q / a] if a != 0.0 else []
    return tuple([*roots, c / q] if q != 0.0 else roots)


def _cubic_max(p0: float, p1: float, p2: float, p3: float) -> float:
    w0, w1, w2, w3 = bernstein_weights(cubic_maximiser(p0, p1, p2, p3))
    return w0 * p0 + w1 * p1 + w2 * p2 + w3 * p3


VALUE: dict[int, Callable[..., float]] = {
    Op.ADD: operator.add,
    Op.SUB: operator.sub,
    Op.MUL: operator.mul,
    Op.DIV: _div,
    Op.NEG: lambda a, _: -a,
    Op.POWER: _power,
    Op.SIN: _finite_only(math.sin),
    Op.COS: _finite_only(math.cos),
    Op.TAN: _finite_only(math.tan),
    Op.ASIN: lambda a, _: math.asin(_clamp_unit(a)),
    Op.ACOS: lambda a, _: math.acos(_clamp_unit(a)),
    Op.ATAN2: math.atan2,
    Op.SQRT: _sqrt,
    Op.ABS: lambda a, _: abs(a),
    Op.SQUARE: lambda a, _: a * a,
    Op.HYPOT: math.hypot,
    Op.MINIMUM: lambda a, b: a if a <= b else (b if b < a else NAN),
    Op.MAXIMUM: lambda a, b: a if a >= b else (b if b > a else NAN),
    Op.MOD: lambda a, b: a - b * whole_turns(a, b),
    Op.SELECT: lambda c, a, b: a if c >= 0.0 else b,
    Op.CUBIC_MAX: _cubic_max,
}


def _finite(d: float) -> float:
    return d if math.isfinite(d) else 0.0


def _d_inverse_trig(a: float, sign: float) -> float:
    cosine = math.sqrt(max(1.0 - a * a, 0.0)) if a == a else 1.0
    return sign / max(cosine, 1.0 / STEEPEST)


def _parts_of(whole: float, a: float, b: float) -> tuple[float, float]:
    return (_finite(a / whole), _finite(b / whole)) if whole != 0.0 else (1.0, 0.0)


PARTIALS: dict[int, Callable[..., tuple[float, ...]]] = {
    Op.ADD: lambda a, b, _: (1.0, 1.0),
    Op.SUB: lambda a, b, _: (1.0, -1.0),
    Op.NEG: lambda a, b, _: (-1.0, 0.0),
    Op.MUL: lambda a, b, _: (_finite(b), _finite(a)),
    Op.DIV: lambda a, b, _: (_finite(_div(1.0, b)), _finite(_div(-a, b * b))),
    Op.POWER: lambda a, b, value: (
        _finite(b * _power(a, b - 1.0)),
        _finite(value * math.log(a)) if a > 0.0 else 0.0,
    ),
    Op.SIN: lambda a, b, _: (_finite(math.cos(a)) if math.isfinite(a) else 0.0, 0.0),
    Op.COS: lambda a, b, _: (-math.sin(a) if math.isfinite(a) else 0.0, 0.0),
    Op.TAN: lambda a, b, value: (_finite(1.0 + value * value), 0.0),
    Op.ASIN: lambda a, b, _: (_d_inverse_trig(a, 1.0), 0.0),
    Op.ACOS: lambda a, b, _: (_d_inverse_trig(a, -1.0), 0.0),
    Op.ATAN2: lambda y, x, _: _parts_of(x * x + y * y, x, -y),
    Op.SQRT: lambda a, b, root: (0.5 / root if root > 0.0 else 1.0, 0.0),
    Op.ABS: lambda a, b, _: (-1.0 if a < 0.0 else 1.0, 0.0),
    Op.SQUARE: lambda a, b, _: (_finite(2.0 * a), 0.0),
    Op.HYPOT: lambda a, b, length: _parts_of(length, a, b),
    Op.MINIMUM: lambda a, b, _: (1.0, 0.0) if a <= b else (0.0, 1.0),
    Op.MAXIMUM: lambda a, b, _: (1.0, 0.0) if a >= b else (0.0, 1.0),
    Op.MOD: lambda a, b, _: (1.0, _finite(-whole_turns(a, b))),
    Op.SELECT: lambda c, a, b, _: (0.0, 1.0, 0.0) if c >= 0.0 else (0.0, 0.0, 1.0),
    Op.CUBIC_MAX: lambda p0, p1, p2, p3, _: bernstein_weights(cubic_maximiser(p0, p1, p2, p3)),
}


def values_of(op: int, operands: tuple[Floats, ...]) -> Floats:
    """Returns the values (k,) of k nodes of one operation, from (k,) arrays of their operands."""
    if function := _VALUES.get(op):
        return function(*operands)
    return np.array([VALUE[op](*each) for each in _each(operands)])


def partials_of(op: int, operands: tuple[Floats, ...], value: Floats) -> tuple[Floats, ...]:
    """Returns the partial derivatives of k nodes, an array (k,) for each operand; always finite."""
    if function := _SLOPES.get(op):
        return tuple(
            slope if np.isfinite(slope).all() else np.where(np.isfinite(slope), slope, 0.0)
            for slope in function(*operands, value)
        )
    slopes = [PARTIALS[op](*each, v) for each, v in zip(_each(operands), value.tolist(), strict=True)]
    return tuple(np.array(slopes).reshape(len(value), -1).T)


def _each(operands: tuple[Floats, ...]) -> Iterable[tuple[float, ...]]:
    return zip(*(a.tolist() for a in (operands if len(operands) > 1 else operands * 2)), strict=True)


def _each_part_of(whole: Floats, a: Floats, b: Floats) -> tuple[Floats, Floats]:
    singular = whole == 0.0
    return np.where(singular, 1.0, a / whole), np.where(singular, 0.0, b / whole)


def _select(condition: Floats, a: Floats, b: Floats) -> Floats:
    return np.where(condition >= 0.0, a, b)


_VALUES: dict[int, Callable[..., Floats]] = {
    Op.ADD: np.add,
    Op.SUB: np.subtract,
    Op.MUL: np.multiply,
    Op.DIV: lambda a, b: a / (b + 0.0),  # zero has no sign
    Op.NEG: np.negative,
    Op.SIN: np.sin,
    Op.COS: np.cos,
    Op.ATAN2: np.arctan2,
    Op.SQRT: lambda a: np.sqrt(np.where((a < 0.0) & (a >= -ROUNDING), 0.0, a)),
    Op.ABS: np.abs,
    Op.SQUARE: np.square,
    Op.HYPOT: np.hypot,
    Op.MINIMUM: lambda a, b: np.where(a <= b, a, np.where(b < a, b, np.nan)),
    Op.MAXIMUM: lambda a, b: np.where(a >= b, a, np.where(b > a, b, np.nan)),
    Op.SELECT: _select,
    IDENTITY: lambda a: a,
}
_SLOPES: dict[int, Callable[..., tuple[Floats, ...]]] = {
    Op.ADD: lambda a, b, _: (np.ones_like(a), np.ones_like(b)),
    Op.SUB: lambda a, b, _: (np.ones_like(a), np.full_like(b, -1.0)),
    Op.NEG: lambda a, _: (np.full_like(a, -1.0),),
    Op.MUL: lambda a, b, _: (b, a),
    Op.DIV: lambda a, b, _: (1.0 / b, -a / (b * b)),
    Op.SIN: lambda a, _: (np.cos(a),),
    Op.COS: lambda a, _: (-np.sin(a),),
    Op.ATAN2: lambda y, x, _: _each_part_of(x * x + y * y, x, -y),
    Op.SQRT: lambda _, root: (np.where(root > 0.0, 0.5 / root, 1.0),),
    Op.SQUARE: lambda a, _: (2.0 * a,),
    Op.HYPOT: lambda a, b, length: _each_part_of(length, a, b),
    IDENTITY: lambda a, _: (np.ones_like(a),),
}
"""Branching operations are not here: before they are differentiated a branch is chosen."""


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


def _operation(op: int) -> Callable[..., int]:
    return lambda tape, *operands: tape._node(op, *operands)


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
        return self._node(Op.ADD, a, b) if a <= b else self._node(Op.ADD, b, a)

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
        return self._node(Op.SUB, a, b)

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
        return self._node(Op.MUL, a, b) if a < b else self._node(Op.MUL, b, a)

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

    sin, cos, tan, asin, acos, sqrt, abs, square, atan2, hypot, mod = map(
        _operation,
        (Op.SIN, Op.COS, Op.TAN, Op.ASIN, Op.ACOS, Op.SQRT, Op.ABS, Op.SQUARE, Op.ATAN2, Op.HYPOT, Op.MOD),
    )
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
            pairs = [sorted(level[i : i + 2]) for i in range(0, len(level) - 1, 2)]
            made = [a if a == b else self._node(op, a, b) for a, b in pairs]
            level = made + level[len(pairs) * 2 :]
        return level[0]

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

    def _node(self, op: int, *args: int) -> int:
        key = (op, *args)
        node = self._known.get(key)
        if node is not None:
            return node
        if self._ops[args[0]] == CONSTANT and all(self._ops[a] == CONSTANT for a in args):
            values = [self._constants[a] for a in args]
            folded = VALUE[op](*values) if len(values) > 1 else VALUE[op](values[0], 0.0)
            if math.isfinite(folded):
                return self.constant(folded)
        return self._new(key, op, args, 0.0)

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

"""The operations of the tape: values and partial derivatives, safe on any input.

Values follow IEEE arithmetic: a quotient by zero is infinite, a root of a negative number is NaN, and
nothing raises or warns. A residual that is not finite never counts as satisfied, and Newton's method never
steps onto one. Partial derivatives, on the other hand, are always finite, and at singular places they
are chosen so that Newton's method can leave them:

    sqrt   at 0                   1 (the true slope is infinite, and its Newton step zero)
    hypot  at (0, 0)              (1, 0): coincident points that shall be apart part along x
    atan2  at (0, 0)              1 in y: a line without length is taken to point along +x
    abs    at 0                   1
    asin, acos at -1 and 1        the slope is capped at 1e8

Each operation has a scalar form; those that are frequent have one on arrays besides, of the same meaning.
Functions of one operand take a second and ignore it, so that both are called alike.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

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


def _mod(a: float, b: float) -> float:
    turns = whole_turns(a, b)
    return a - b * turns


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


def _minimum(a: float, b: float) -> float:
    return a if a <= b else (b if b < a else NAN)


def _maximum(a: float, b: float) -> float:
    return a if a >= b else (b if b > a else NAN)


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
    Op.MINIMUM: _minimum,
    Op.MAXIMUM: _maximum,
    Op.MOD: _mod,
    Op.SELECT: lambda c, a, b: a if c >= 0.0 else b,
    Op.CUBIC_MAX: _cubic_max,
}


def _finite(d: float) -> float:
    return d if math.isfinite(d) else 0.0


def _d_div(a: float, b: float, _: float) -> tuple[float, float]:
    return _finite(_div(1.0, b)), _finite(_div(-a, b * b))


def _d_power(a: float, b: float, value: float) -> tuple[float, float]:
    return _finite(b * _power(a, b - 1.0)), _finite(value * math.log(a)) if a > 0.0 else 0.0


def _d_inverse_trig(a: float, sign: float) -> float:
    cosine = math.sqrt(max(1.0 - a * a, 0.0)) if a == a else 1.0
    return sign / max(cosine, 1.0 / STEEPEST)


def _d_atan2(y: float, x: float, _: float) -> tuple[float, float]:
    square = x * x + y * y
    if square == 0.0:
        return 1.0, 0.0
    return _finite(x / square), _finite(-y / square)


def _d_hypot(a: float, b: float, length: float) -> tuple[float, float]:
    if length == 0.0:
        return 1.0, 0.0
    return _finite(a / length), _finite(b / length)


def _d_cubic_max(p0: float, p1: float, p2: float, p3: float, _: float) -> tuple[float, ...]:
    return bernstein_weights(cubic_maximiser(p0, p1, p2, p3))


PARTIALS: dict[int, Callable[..., tuple[float, ...]]] = {
    Op.ADD: lambda a, b, _: (1.0, 1.0),
    Op.SUB: lambda a, b, _: (1.0, -1.0),
    Op.NEG: lambda a, b, _: (-1.0, 0.0),
    Op.MUL: lambda a, b, _: (_finite(b), _finite(a)),
    Op.DIV: _d_div,
    Op.POWER: _d_power,
    Op.SIN: lambda a, b, _: (_finite(math.cos(a)) if math.isfinite(a) else 0.0, 0.0),
    Op.COS: lambda a, b, _: (-math.sin(a) if math.isfinite(a) else 0.0, 0.0),
    Op.TAN: lambda a, b, value: (_finite(1.0 + value * value), 0.0),
    Op.ASIN: lambda a, b, _: (_d_inverse_trig(a, 1.0), 0.0),
    Op.ACOS: lambda a, b, _: (_d_inverse_trig(a, -1.0), 0.0),
    Op.ATAN2: _d_atan2,
    Op.SQRT: lambda a, b, root: (0.5 / root if root > 0.0 else 1.0, 0.0),
    Op.ABS: lambda a, b, _: (-1.0 if a < 0.0 else 1.0, 0.0),
    Op.SQUARE: lambda a, b, _: (_finite(2.0 * a), 0.0),
    Op.HYPOT: _d_hypot,
    Op.MINIMUM: lambda a, b, _: (1.0, 0.0) if a <= b else (0.0, 1.0),
    Op.MAXIMUM: lambda a, b, _: (1.0, 0.0) if a >= b else (0.0, 1.0),
    Op.MOD: lambda a, b, _: (1.0, _finite(-whole_turns(a, b))),
    Op.SELECT: lambda c, a, b, _: (0.0, 1.0, 0.0) if c >= 0.0 else (0.0, 0.0, 1.0),
    Op.CUBIC_MAX: _d_cubic_max,
}


def values_of(op: int, operands: tuple[Floats, ...]) -> Floats:
    """Returns the values (k,) of k nodes of one operation, from (k,) arrays of their operands."""
    if function := _VALUES.get(op):
        return function(*operands)
    return np.array([VALUE[op](*each) for each in zip(*_columns(operands), strict=True)])


def partials_of(op: int, operands: tuple[Floats, ...], value: Floats) -> tuple[Floats, ...]:
    """Returns the partial derivatives of k nodes, an array (k,) for each operand; always finite."""
    if function := _SLOPES.get(op):
        return tuple(
            slope if np.isfinite(slope).all() else np.where(np.isfinite(slope), slope, 0.0)
            for slope in function(*operands, value)
        )
    slopes = [PARTIALS[op](*each) for each in zip(*_columns(operands), value.tolist(), strict=True)]
    return tuple(np.array(slopes).reshape(len(value), -1).T)


def _columns(operands: tuple[Floats, ...]) -> list[list[float]]:
    return [a.tolist() for a in (operands if len(operands) > 1 else operands * 2)]


def _over_square(y: Floats, x: Floats, _: Floats) -> tuple[Floats, Floats]:
    square = x * x + y * y
    singular = square == 0.0
    return np.where(singular, 1.0, x / square), np.where(singular, 0.0, -y / square)


def _over_length(a: Floats, b: Floats, length: Floats) -> tuple[Floats, Floats]:
    singular = length == 0.0
    return np.where(singular, 1.0, a / length), np.where(singular, 0.0, b / length)


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
    Op.ATAN2: _over_square,
    Op.SQRT: lambda _, root: (np.where(root > 0.0, 0.5 / root, 1.0),),
    Op.SQUARE: lambda a, _: (2.0 * a,),
    Op.HYPOT: _over_length,
    IDENTITY: lambda a, _: (np.ones_like(a),),
}
"""Branching operations are not here: before they are differentiated a branch is chosen."""

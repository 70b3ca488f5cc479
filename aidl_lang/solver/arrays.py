"""The operations of the tape on whole arrays: values and partial derivatives of many nodes at once.

Same meaning, same rules at singular places, as in `operations`, whose functions answer for one node.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from aidl_lang.solver.operations import PARTIALS, ROUNDING, STEEPEST, VALUE, Floats, Op


def values(op: int, operands: tuple[Floats, ...]) -> Floats:
    """Returns the values (k,) of k nodes of one operation, from (k,) arrays of their operands."""
    if function := _VALUE.get(op):
        return function(*operands)
    scalar = VALUE[op]
    return np.array([scalar(*each) for each in zip(*(a.tolist() for a in operands), strict=True)])


def partials(op: int, operands: tuple[Floats, ...], value: Floats) -> tuple[Floats, ...]:
    """Returns the partial derivatives of k nodes, an array (k,) or a number for each operand; always
    finite.
    """
    if function := _PARTIALS.get(op):
        return tuple(_finite(slope) for slope in function(*operands, value))
    scalar = PARTIALS[op]
    columns = [a.tolist() for a in operands]
    if len(columns) == 1:
        columns *= 2
    slopes = [scalar(*each) for each in zip(*columns, value.tolist(), strict=True)]
    return tuple(np.array(slopes).reshape(len(value), -1).T)


def whole_turns(a: Floats, b: Floats) -> Floats:
    """Returns floor(a / b), NaN if the quotient is not finite."""
    quotient = a / b
    return np.where(np.isfinite(quotient), np.floor(quotient), np.nan)


def _finite(slope: Floats) -> Floats:
    return slope if np.isfinite(slope).all() else np.where(np.isfinite(slope), slope, 0.0)


def _clamped(a: Floats) -> Floats:
    """Returns `a` within [-1, 1], NaN where it is outside by more than rounding."""
    return np.where(np.abs(a) <= 1.0 + ROUNDING, np.clip(a, -1.0, 1.0), np.nan)


def _sqrt(a: Floats) -> Floats:
    return np.sqrt(np.where((a < 0.0) & (a >= -ROUNDING), 0.0, a))


def _select(condition: Floats, a: Floats, b: Floats) -> Floats:
    return np.where(condition >= 0.0, a, b)


_VALUE: dict[int, Callable[..., Floats]] = {
    Op.ADD: np.add,
    Op.SUB: np.subtract,
    Op.MUL: np.multiply,
    Op.DIV: lambda a, b: a / (b + 0.0),  # zero has no sign
    Op.NEG: np.negative,
    Op.SIN: np.sin,
    Op.COS: np.cos,
    Op.TAN: np.tan,
    Op.ASIN: lambda a: np.arcsin(_clamped(a)),
    Op.ACOS: lambda a: np.arccos(_clamped(a)),
    Op.ATAN2: np.arctan2,
    Op.SQRT: _sqrt,
    Op.ABS: np.abs,
    Op.SQUARE: np.square,
    Op.HYPOT: np.hypot,
    Op.MINIMUM: lambda a, b: np.where(a <= b, a, np.where(b < a, b, np.nan)),
    Op.MAXIMUM: lambda a, b: np.where(a >= b, a, np.where(b > a, b, np.nan)),
    Op.MOD: lambda a, b: a - b * whole_turns(a, b),
    Op.SELECT: _select,
}
"""Powers and the greatest value of a cubic are left to the scalar functions."""


def _ones(a: Floats) -> Floats:
    return np.ones(len(a))


def _d_inverse_trig(a: Floats) -> Floats:
    cosine = np.sqrt(np.maximum(1.0 - a * a, 0.0))
    return np.where(np.isnan(a), 1.0, 1.0 / np.maximum(cosine, 1.0 / STEEPEST))


def _d_atan2(y: Floats, x: Floats, _: Floats) -> tuple[Floats, Floats]:
    square = x * x + y * y
    singular = square == 0.0
    return np.where(singular, 1.0, x / square), np.where(singular, 0.0, -y / square)


def _d_hypot(a: Floats, b: Floats, length: Floats) -> tuple[Floats, Floats]:
    singular = length == 0.0
    return np.where(singular, 1.0, a / length), np.where(singular, 0.0, b / length)


def _d_sqrt(_: Floats, root: Floats) -> tuple[Floats]:
    return (np.where(root > 0.0, 0.5 / root, 1.0),)


_PARTIALS: dict[int, Callable[..., tuple[Floats, ...]]] = {
    Op.ADD: lambda a, b, _: (_ones(a), _ones(b)),
    Op.SUB: lambda a, b, _: (_ones(a), -_ones(b)),
    Op.NEG: lambda a, _: (-_ones(a),),
    Op.MUL: lambda a, b, _: (b, a),
    Op.DIV: lambda a, b, _: (1.0 / b, -a / (b * b)),
    Op.SIN: lambda a, _: (np.cos(a),),
    Op.COS: lambda a, _: (-np.sin(a),),
    Op.TAN: lambda _, value: (1.0 + value * value,),
    Op.ASIN: lambda a, _: (_d_inverse_trig(a),),
    Op.ACOS: lambda a, _: (-_d_inverse_trig(a),),
    Op.ATAN2: _d_atan2,
    Op.SQRT: _d_sqrt,
    Op.SQUARE: lambda a, _: (2.0 * a,),
    Op.MOD: lambda a, b, _: (_ones(a), -whole_turns(a, b)),
    Op.HYPOT: _d_hypot,
}
"""Branching operations are not here: before they are differentiated a branch is chosen."""

"""Independent checks of a solution: plain recursive evaluation of the tape with numpy."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import nnls

from aidl_lang.solver import Problem, Relation, Row, Solution
from aidl_lang.solver.expression import Op

ROUNDING = 1e-9
"""Operands of roots, asin and acos may be so far outside."""


def _cubic_max(p0: np.ndarray, p1: np.ndarray, p2: np.ndarray, p3: np.ndarray) -> np.ndarray:
    """At the ends, or where the derivative 3 (a t² + 2 b t + c) is zero."""
    a, b, c = p3 - 3 * p2 + 3 * p1 - p0, p2 - 2 * p1 + p0, p1 - p0
    with np.errstate(all="ignore"):
        root = np.sqrt(b * b - a * c)
        places = [(-b + root) / a, (-b - root) / a, c / (-b - root), c / (-b + root)]
        inside = [np.clip(np.nan_to_num(t), 0.0, 1.0) for t in (0.0 * p0, 0.0 * p0 + 1.0, *places)]
        heights = [
            (1 - t) ** 3 * p0 + 3 * (1 - t) ** 2 * t * p1 + 3 * (1 - t) * t**2 * p2 + t**3 * p3
            for t in inside
        ]
        return np.max(heights, axis=0)


def _unit(a: np.ndarray) -> np.ndarray:
    return np.where(np.abs(a) <= 1.0 + ROUNDING, np.clip(a, -1.0, 1.0), a)


def _root(a: np.ndarray) -> np.ndarray:
    return np.sqrt(np.where(np.abs(a) <= ROUNDING, np.maximum(a, 0.0), a))


_FUNCTIONS = {
    Op.ADD: np.add, Op.SUB: np.subtract, Op.MUL: np.multiply, Op.DIV: np.divide, Op.NEG: np.negative,
    Op.POWER: np.power, Op.SIN: np.sin, Op.COS: np.cos, Op.TAN: np.tan,
    Op.ASIN: lambda a: np.arcsin(_unit(a)), Op.ACOS: lambda a: np.arccos(_unit(a)), Op.ATAN2: np.arctan2,
    Op.SQRT: _root, Op.ABS: np.abs, Op.SQUARE: np.square, Op.HYPOT: np.hypot, Op.MINIMUM: np.minimum,
    Op.MAXIMUM: np.maximum, Op.MOD: lambda a, b: a - b * np.floor(a / b),
    Op.SELECT: lambda c, a, b: np.where(c >= 0, a, b), Op.CUBIC_MAX: _cubic_max,
}  # fmt: skip


def values_of(problem: Problem, nodes: Sequence[int], x: np.ndarray) -> np.ndarray:
    """The values (m,) of some nodes at `x` (n,), or (m, k) at each column of `x` (n, k)."""
    tape, known = problem.tape, dict[int, np.ndarray]()

    def value(node: int) -> np.ndarray:
        if node not in known:
            op, operands = tape.op_list[node], tape.operand_lists[node]
            if op == Op.CONSTANT:
                known[node] = np.full(x.shape[1:], tape.constants[node])
            elif op == Op.UNKNOWN:
                known[node] = x[operands[0]]
            else:
                known[node] = _FUNCTIONS[op](*map(value, operands))
        return known[node]

    return np.array([value(node) for node in nodes], dtype=np.float64).reshape(len(nodes), *x.shape[1:])


def evaluate(problem: Problem, node: int, x: np.ndarray) -> float:
    return float(values_of(problem, [node], x)[0])


def jacobian(problem: Problem, nodes: Sequence[int], x: np.ndarray, step: float = 1e-6) -> np.ndarray:
    steps = step * np.eye(len(x))
    ahead, behind = (values_of(problem, nodes, x[:, None] + side) for side in (steps, -steps))
    return (ahead - behind) / (2 * step)


def assert_solved(problem: Problem, solution: Solution) -> None:
    assert solution.status == "solved"
    for constraint in problem.constraints:
        if constraint.weight is None:
            for row in constraint.rows:
                value = evaluate(problem, row.expression, solution.values)
                violation = max(value, 0.0) if row.relation is Relation.AT_MOST else abs(value)
                assert violation <= 2e-9 * row.scale


def assert_smallest_change(problem: Problem, solution: Solution, tolerance: float = 1e-5) -> None:
    """First-order conditions: the displacement is a combination of gradients of the active rows, and those
    of inequalities push, never pull."""
    rows = [row for c in problem.constraints if c.weight is None for row in c.rows]
    values = values_of(problem, [row.expression for row in rows], solution.values)
    both = [row for row in rows if row.relation is Relation.EQUAL]
    one_way = [
        row
        for row, value in zip(rows, values, strict=True)
        if row.relation is Relation.AT_MOST and abs(value) <= 1e-7 * row.scale
    ]
    displacement = (solution.values - problem.initial) / problem.scale
    gradients = jacobian(problem, [row.expression for row in both + one_way], solution.values) * problem.scale
    gradients /= np.maximum(np.linalg.norm(gradients, axis=1, keepdims=True), 1e-9)
    pushes = np.vstack([-gradients, gradients[: len(both)], np.zeros((1, len(displacement)))])
    _, lack = nnls(pushes.T, displacement)
    assert lack <= tolerance * max(1, np.abs(displacement).max())


def assert_honest(problem: Problem, solution: Solution, tolerance: float = 1e-9) -> None:
    """What the solution says of itself is true: finite values, residuals, flags, status, changed sizes."""
    x = solution.values
    assert x.shape == problem.initial.shape
    assert np.isfinite(x).all()
    for constraint, residual, satisfied in zip(
        problem.constraints, solution.residuals, solution.satisfied, strict=True
    ):
        low, high = _violations(problem, constraint.rows, x)
        bounds = tolerance * np.array([row.scale for row in constraint.rows])
        slack = 1e-3 * bounds.min(initial=np.inf)
        assert low.max(initial=0.0) <= residual + slack
        assert residual <= high.max(initial=0.0) + slack
        assert satisfied >= bool((high <= bounds).all())
        assert satisfied <= bool((low <= bounds).all())
    hard = [s for c, s in zip(problem.constraints, solution.satisfied, strict=True) if c.weight is None]
    late = any(failure.reason == "timed out" for failure in solution.failures)
    expected = "solved" if all(hard) else ("failed" if late or not any(hard) else "partial")
    assert solution.status == expected
    moved = np.abs(x - problem.initial) > tolerance * problem.scale
    assert solution.changed == tuple(np.flatnonzero(moved & problem.kept))
    count = len(problem.constraints)
    assert all(0 <= index < count for failure in solution.failures for index in failure.conflict)


def _violations(problem: Problem, rows: Sequence[Row], x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The least and the greatest violation (r,) of each row when the last digits of the values are others:
    what rounding may make of it. Infinite where a row has no value."""
    ulps = np.random.default_rng(0).integers(-2, 3, (len(x), 16))
    ulps[:, :1] = 0
    with np.errstate(all="ignore"):
        near = x[:, None] + np.spacing(np.abs(x))[:, None] * ulps
        values = values_of(problem, [row.expression for row in rows], near)
    inequality = np.array([[row.relation is Relation.AT_MOST] for row in rows], dtype=np.bool_)
    found = np.where(inequality, np.maximum(values, 0.0), np.abs(values)) if rows else values
    found[np.isnan(found)] = np.inf
    low, high = found.min(axis=1), found.max(axis=1)
    with np.errstate(all="ignore"):
        spread = np.nan_to_num(high - low)
        return np.maximum(low - spread, 0.0), high + spread

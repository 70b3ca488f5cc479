"""Independent checks of a solution: plain recursive evaluation of the tape with numpy."""

from __future__ import annotations

import numpy as np

from aidl_lang.solver import Problem, Relation, Solution
from aidl_lang.solver.operations import Op

_FUNCTIONS = {
    Op.ADD: np.add, Op.SUB: np.subtract, Op.MUL: np.multiply, Op.DIV: np.divide, Op.NEG: np.negative,
    Op.POWER: np.power, Op.SIN: np.sin, Op.COS: np.cos, Op.TAN: np.tan, Op.ASIN: np.arcsin,
    Op.ACOS: np.arccos, Op.ATAN2: np.arctan2, Op.SQRT: np.sqrt, Op.ABS: np.abs, Op.SQUARE: np.square,
    Op.HYPOT: np.hypot, Op.MINIMUM: np.minimum, Op.MAXIMUM: np.maximum, Op.MOD: np.mod,
    Op.SELECT: lambda c, a, b: a if c >= 0 else b,
}  # fmt: skip


def evaluate(problem: Problem, node: int, x: np.ndarray) -> float:
    op, operands = problem.tape.ops[node], problem.tape.operand_lists[node]
    if op == Op.CONSTANT:
        return float(problem.tape.constants[node])
    if op == Op.UNKNOWN:
        return float(x[operands[0]])
    return float(_FUNCTIONS[Op(op)](*(evaluate(problem, a, x) for a in operands)))


def jacobian(problem: Problem, nodes: list[int], x: np.ndarray, step: float = 1e-6) -> np.ndarray:
    columns = []
    for i in range(len(x)):
        ahead, behind = x.copy(), x.copy()
        ahead[i] += step
        behind[i] -= step
        columns.append(
            [(evaluate(problem, n, ahead) - evaluate(problem, n, behind)) / (2 * step) for n in nodes]
        )
    return np.array(columns).T


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
    active = [
        row
        for row in rows
        if row.relation is Relation.EQUAL
        or abs(evaluate(problem, row.expression, solution.values)) <= 1e-7 * row.scale
    ]
    displacement = (solution.values - problem.initial) / problem.scale
    gradients = jacobian(problem, [row.expression for row in active], solution.values) * problem.scale
    multipliers, *_ = np.linalg.lstsq(gradients.T, -displacement, rcond=1e-9)
    assert np.abs(gradients.T @ multipliers + displacement).max() <= tolerance * max(
        1, np.abs(displacement).max()
    )
    for row, multiplier in zip(active, multipliers, strict=True):
        assert row.relation is Relation.EQUAL or multiplier >= -tolerance

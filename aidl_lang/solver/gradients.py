"""Gradients of many nodes at once, each as the few unknowns that it depends on.

Forward accumulation over the shared graph, once through: the right tool where every gradient is wanted a
single time, as in counting degrees of freedom. Newton's method uses `Program.jacobian`.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeAlias

from aidl_lang.solver.operations import PARTIALS, Op
from aidl_lang.solver.valuation import Valuation, reachable

Gradient: TypeAlias = dict[int, float]
"""Partial derivative by unknown; unknowns that are missing have none."""


def gradients(values: Valuation, roots: Iterable[int]) -> dict[int, Gradient]:
    """The gradient of each root at the current node values, which must be up to date."""
    tape, nodes = values.tape, values.nodes
    ops, operands = tape.op_list, tape.operand_lists
    wanted = list(roots)
    found: dict[int, Gradient] = {}
    for node in reachable(tape, wanted, [False] * len(tape)):
        op, args = ops[node], operands[node]
        if op == Op.UNKNOWN:
            found[node] = {args[0]: 1.0}
        elif op == Op.CONSTANT:
            found[node] = {}
        else:
            found[node] = _chain(op, args, nodes, node, found)
    return {root: found[root] for root in wanted}


def _chain(
    op: int, args: tuple[int, ...], nodes: list[float], node: int, found: dict[int, Gradient]
) -> Gradient:
    """The chain rule for one operation."""
    inner = [found[a] for a in args]
    if not any(inner):
        return {}
    padded = args if len(args) > 1 else args * 2
    slopes = PARTIALS[op](*[nodes[a] for a in padded], nodes[node])
    total: Gradient = {}
    for gradient, slope in zip(inner, slopes, strict=False):
        if slope == 1.0 and not total:
            total = gradient  # shared, hence copied before it is added to
        elif slope != 0.0 and gradient:
            total = dict(total)
            for unknown, derivative in gradient.items():
                total[unknown] = total.get(unknown, 0.0) + slope * derivative
    return total

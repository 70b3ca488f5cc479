"""Every operation: its value against an independent formula, its derivative against finite differences."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from aidl_lang.solver.expression import Tape, TapeBuilder
from aidl_lang.solver.freezing import Freezer
from aidl_lang.solver.valuation import Valuation
from tests.amount import tries

from .build import Model, call

REFERENCE: dict[str, tuple[int, Callable[..., float]]] = {
    "add": (2, lambda a, b: a + b),
    "sub": (2, lambda a, b: a - b),
    "mul": (2, lambda a, b: a * b),
    "div": (2, lambda a, b: a / b),
    "neg": (1, lambda a: -a),
    "power": (2, lambda a, b: a**b),
    "sin": (1, np.sin),
    "cos": (1, np.cos),
    "tan": (1, np.tan),
    "asin": (1, np.arcsin),
    "acos": (1, np.arccos),
    "atan2": (2, np.arctan2),
    "sqrt": (1, np.sqrt),
    "abs": (1, abs),
    "square": (1, lambda a: a * a),
    "hypot": (2, np.hypot),
    "minimum": (2, min),
    "maximum": (2, max),
    "mod": (2, lambda a, b: a - b * math.floor(a / b)),
    "select": (3, lambda c, a, b: a if c >= 0 else b),
    "cubic_max": (4, lambda *p: np.max(bezier(p, np.linspace(0, 1, 20001)))),
}

DOMAIN = {"asin": (-0.95, 0.95), "acos": (-0.95, 0.95), "sqrt": (0.05, 50.0), "power": (0.3, 3.0),
          "tan": (-1.3, 1.3), "div": (0.3, 20.0)}  # fmt: skip


def bezier(p: tuple[float, ...], t: Any) -> Any:
    s = 1 - t
    return s**3 * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t**3 * p[3]


def tape_of(operation: str) -> tuple[Tape, int]:
    builder = TapeBuilder()
    root = getattr(builder, operation)(*(builder.unknown(i) for i in range(REFERENCE[operation][0])))
    return builder.finish(), root


def evaluate(tape: Tape, root: int, x: list[float]) -> float:
    values = Valuation(tape, x)
    values.refresh(values.cone([root]))
    return values.nodes[root]


def gradient(tape: Tape, root: int, x: list[float]) -> np.ndarray:
    values = Valuation(tape, x)
    values.refresh(values.cone([root]))
    result = np.zeros(len(x))
    for program in Freezer(values, range(len(x))).freeze([root]).programs:
        program.residuals(np.array([x[i] for i in program.columns]))
        result[program.columns] = program.jacobian(np.ones(1), np.ones(len(program.columns)))[0]
    return result


@pytest.mark.parametrize("operation", REFERENCE)
@given(data=st.data())
@tries(30)
def test_value_and_derivative(operation: str, data: st.DataObject) -> None:
    arity, reference = REFERENCE[operation]
    low, high = DOMAIN.get(operation, (-20.0, 20.0))
    x = [data.draw(st.floats(low, high)) for _ in range(arity)]
    if operation == "mod":
        x[1] = 0.5 + abs(x[1])
        assume(1e-3 < x[0] % x[1] < x[1] - 1e-3)
    if operation in ("hypot", "atan2"):
        assume(math.hypot(*x) > 0.1 and not (operation == "atan2" and x[1] < 0 and abs(x[0]) < 1e-3))
    if operation in ("minimum", "maximum"):
        assume(abs(x[0] - x[1]) > 1e-3)
    if operation in ("abs", "select"):
        assume(abs(x[0]) > 1e-3)
    tape, root = tape_of(operation)
    assert evaluate(tape, root, x) == pytest.approx(reference(*x), rel=1e-6, abs=1e-6)
    if operation == "cubic_max":
        assume(np.ptp(x) > 1.0)
        ts = np.linspace(0, 1, 501)
        heights = bezier(tuple(x), ts)
        assume(np.ptp(ts[heights > heights.max() - 1e-2]) < 0.2)  # no second maximum nearly as high
    step = 1e-6
    for i, slope in enumerate(gradient(tape, root, x)):
        ahead, behind = list(x), list(x)
        ahead[i] += step
        behind[i] -= step
        numeric = (evaluate(tape, root, ahead) - evaluate(tape, root, behind)) / (2 * step)
        assert slope == pytest.approx(numeric, rel=1e-4, abs=2e-3 if operation == "cubic_max" else 1e-4)


HOSTILE = [0.0, -0.0, 1.0, -1.0, 1e308, -1e308, 1e-320, math.inf, -math.inf, math.nan]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("operation", REFERENCE)
def test_hostile_values_neither_raise_nor_give_infinite_slopes(operation: str) -> None:
    tape, root = tape_of(operation)
    arity = REFERENCE[operation][0]
    for first in HOSTILE:
        for second in HOSTILE:
            x = [first, second, *[first] * 2][:arity]
            evaluate(tape, root, x)
            assert np.isfinite(gradient(tape, root, x)).all()


@pytest.mark.parametrize(("operation", "x"), [("sqrt", [0.0]), ("hypot", [0.0, 0.0]), ("abs", [0.0]),
                                              ("atan2", [0.0, 0.0]), ("acos", [1.0])])  # fmt: skip
def test_singular_places_can_be_left(operation: str, x: list[float]) -> None:
    assert np.abs(gradient(*tape_of(operation), x)).max() > 0.0


def test_equal_expressions_are_one_node() -> None:
    b = TapeBuilder()
    x, y = b.unknown(0), b.unknown(1)
    assert b.add(x, y) == b.add(y, x)
    assert b.mul(x, b.constant(1)) == x
    assert b.add(b.constant(2), b.constant(3)) == b.constant(5)
    assert b.neg(b.neg(x)) == x
    assert b.minimum(x, x) == x
    assert b.select(b.constant(-1), x, y) == y
    assert b.maximum(x, y) == b.maximum(y, x)


def test_operands_come_first() -> None:
    b = TapeBuilder()
    node = b.maximum(*(b.square(b.unknown(i)) for i in range(9)))
    tape = b.finish()
    assert node == len(tape) - 1
    assert all(a < i for i, row in enumerate(tape.operand_lists) if tape.ops[i] > 1 for a in row)


def test_a_frozen_branch_has_the_derivative_of_that_branch() -> None:
    m = Model()
    x, y = m.unknown(1.0), m.unknown(2.0)
    root = call("minimum", x * 3.0, y * 5.0)
    assert gradient(m.builder.finish(), root.node, [1.0, 2.0]).tolist() == [3.0, 0.0]

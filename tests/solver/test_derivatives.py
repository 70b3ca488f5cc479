"""Values and derivatives: every way of finding them, against finite differences and against each other."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import assume, given, note
from hypothesis import strategies as st

from aidl_lang.solver import Problem, expression
from aidl_lang.solver.array_program import ArrayFreezing, Schedule
from aidl_lang.solver.expression import ARITY, BRANCHING, NAMES, PARTIALS, VALUE, Op
from aidl_lang.solver.freezing import Freezer
from aidl_lang.solver.valuation import Valuation, linearise

from .check import values_of
from .kinds import KINDS
from .random_expressions import HOSTILE, PLAIN, WORST, Tangle, tangles
from .random_problems import Taste, profile, sketches
from .sketches import Sketch

STEPS = 10.0 ** np.arange(-2.0, -7.0, -0.5)
OVERFLOWN = 1e300
"""Products of slopes beyond this need only be finite."""
KINK = 1e-3
"""Differences ahead and behind that disagree by more say that there is no derivative."""
Derivative = Callable[[Problem, list[int], np.ndarray], np.ndarray]


# ---- the ways -------------------------------------------------------------------------------------------


def by_dictionaries(problem: Problem, nodes: list[int], x: np.ndarray) -> np.ndarray:
    """Forward accumulation, root by root."""
    return np.vstack([_linearised(problem, [node], x) for node in nodes])


def by_levels(problem: Problem, nodes: list[int], x: np.ndarray) -> np.ndarray:
    """Adjoints as arrays: asked for so many roots that this way is taken."""
    return _linearised(problem, nodes * 100, x)[: len(nodes)]


def _linearised(problem: Problem, nodes: list[int], x: np.ndarray) -> np.ndarray:
    _, sparse = linearise(problem.tape, x, np.array(nodes, dtype=np.int64))
    return sparse.dense(np.arange(len(x)))


def by_program(problem: Problem, nodes: list[int], x: np.ndarray) -> np.ndarray:
    values = Valuation(problem.tape, x.tolist())
    values.refresh(values.cone(nodes))
    found = np.zeros((len(nodes), len(x)))
    for program in Freezer(values, range(len(x))).freeze(nodes).programs:
        program.residuals(x[program.columns])
        found[np.ix_(program.rows, program.columns)] = program.jacobian(
            np.ones(len(program.rows)), np.ones(len(program.columns))
        )
    return found


def by_array_program(problem: Problem, nodes: list[int], x: np.ndarray) -> np.ndarray:
    schedule, roots = Schedule(problem.tape), np.array(nodes, dtype=np.int64)
    freezing = ArrayFreezing(schedule, schedule.evaluate(x), np.ones(len(x), dtype=np.bool_))
    found = np.zeros((len(nodes), len(x)))
    varies = np.flatnonzero(freezing.varies(roots))
    if len(varies):
        program = freezing.program(roots[varies])
        program.residuals(x[program.columns])
        matrix = program.jacobian(np.ones(len(varies)), np.ones(len(program.columns)))
        found[np.ix_(varies, program.columns)] = (
            matrix if isinstance(matrix, np.ndarray) else matrix.toarray()
        )
    return found


WAYS: dict[str, Derivative] = {
    "dictionaries": by_dictionaries,
    "levels": by_levels,
    "program": by_program,
    "array program": by_array_program,
}


# ---- against finite differences -------------------------------------------------------------------------


def differences(problem: Problem, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Central differences (m, n) of all nodes at the step where they change least from one step to the next,
    and what they are good for: by how much they change there; infinite at a kink, and above one."""
    nodes = range(len(problem.tape))
    shifts = np.concatenate([side * h * np.eye(len(x)) for h in STEPS for side in (1.0, -1.0)], axis=1)
    values = values_of(problem, nodes, x[:, None] + shifts).reshape(len(nodes), len(STEPS), 2, len(x))
    ahead, behind = values[:, :, 0], values[:, :, 1]
    slopes = (ahead - behind) / (2.0 * STEPS[:, None])
    changes = np.abs(np.diff(slopes, axis=1))
    changes[~np.isfinite(changes)] = np.inf
    best = changes.argmin(axis=1)[:, None]
    error = np.take_along_axis(changes, best, 1)[:, 0]
    bend = (ahead + behind - 2.0 * values_of(problem, nodes, x)[:, None, None])[:, -1] / STEPS[-1]
    error[~(np.abs(bend) < KINK)] = np.inf
    for node in nodes:
        if problem.tape.op_list[node] > Op.UNKNOWN:
            below = error[list(problem.tape.operand_lists[node])]
            error[node, np.isinf(below).any(axis=0)] = np.inf
    return np.take_along_axis(slopes, best, 1)[:, 0], error


def assert_derivative(way: Derivative, problem: Problem, nodes: list[int], x: np.ndarray) -> int:
    """Wherever finite differences can tell; says in how many places that is."""
    with np.errstate(all="ignore"):
        expected, error = (found[nodes] for found in differences(problem, x))
    found = way(problem, nodes, x)
    assert np.isfinite(found).all()
    size = 1.0 + np.abs(expected)
    certain = error < 1e-6 * size
    note((found, expected, error))
    assert (np.abs(found - expected)[certain] <= (10.0 * error + 1e-7 * size)[certain]).all()
    return int(certain.sum())


@pytest.mark.parametrize("way", WAYS)
@given(tangle=tangles(PLAIN))
@profile(60)
def test_derivatives_of_any_expression(way: str, tangle: Tangle) -> None:
    model, found = tangle.model()
    problem = model.problem()
    assert_derivative(WAYS[way], problem, [e.node for e in found], problem.initial)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("kind", KINDS)
@given(data=st.data())
@profile(4)
def test_derivatives_of_what_links_measure(kind: str, way: str, data: st.DataObject) -> None:
    taste = Taste(kinds=(kind,), points=(4, 6), circles=(2, 3), groups=2, links=(1, 3), noise=2.0)
    sketch: Sketch = data.draw(sketches(taste))
    assume(sketch.links)
    problem = sketch.problem()
    nodes = problem.rows.expression.tolist()
    assert assert_derivative(WAYS[way], problem, nodes, problem.initial) > 0


# ---- the ways against each other ------------------------------------------------------------------------


def same(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Equal to the last digits; NaN equals NaN."""
    with np.errstate(all="ignore"):
        near = np.abs(one - other) <= 1e-14 * np.abs(one)
    return (np.isnan(one) & np.isnan(other)) | (one == other) | near


def values_both_ways(op: int, places: list[tuple[float, ...]]) -> tuple[np.ndarray, np.ndarray]:
    """By numbers and by arrays."""
    with np.errstate(all="ignore"):
        found = expression.values_of(op, tuple(np.array(column) for column in zip(*places, strict=True)))
    return np.array([VALUE[op](*(place if len(place) > 1 else place * 2)) for place in places]), found


OPERATIONS = pytest.mark.parametrize("op", [op for op in NAMES if op > Op.UNKNOWN], ids=NAMES.__getitem__)


@OPERATIONS
@given(data=st.data())
@profile(40)
def test_arrays_mean_what_numbers_mean(op: int, data: st.DataObject) -> None:
    unsigned = WORST.map(lambda value: value + 0.0)
    places = data.draw(st.lists(st.tuples(*[unsigned] * ARITY[op]), min_size=1, max_size=8))
    expected, found = values_both_ways(op, places)
    note((found, expected))
    assert same(found, expected).all()
    if op in BRANCHING:
        return
    operands = tuple(np.array(column) for column in zip(*places, strict=True))
    padded = [place if len(place) > 1 else place * 2 for place in places]
    slopes = np.array([PARTIALS[op](*p, v) for p, v in zip(padded, expected.tolist(), strict=True)])
    with np.errstate(all="ignore"):
        partials = np.array(expression.partials_of(op, operands, expected)).T
    note((partials, slopes))
    assert np.isfinite(partials).all()
    assert same(partials[:, : ARITY[op]], slopes[:, : ARITY[op]]).all()


@pytest.mark.parametrize("op", [Op.DIV, Op.ATAN2, Op.MINIMUM, Op.MAXIMUM], ids=NAMES.__getitem__)
def test_zeros_with_a_sign(op: int) -> None:
    """1 / -0 may be held against a bound, and `atan2` tells one zero from the other."""
    expected, found = values_both_ways(op, list(itertools.product((0.0, -0.0, 1.0, -1.0), repeat=2)))
    assert same(found, expected).all()
    assert (np.signbit(found) == np.signbit(expected))[~np.isnan(expected)].all()


@given(tangle=tangles(PLAIN), data=st.data())
@profile(150)
def test_held_unknowns_are_put_into_forms(tangle: Tangle, data: st.DataObject) -> None:
    """Rows over some of the unknowns are the expressions, wherever these are and whichever sizes are held."""
    model, found = tangle.model()
    problem = model.problem()
    nodes, every = [e.node for e in found], range(len(problem.initial))
    some = st.frozensets(st.sampled_from(every))
    values = Valuation(problem.tape, problem.initial.tolist(), data.draw(some))
    for _ in range(2):
        values.refresh(values.cone(nodes))
        free = data.draw(some)
        frozen = Freezer(values, free).freeze(nodes)
        rows = [*frozen.constant, *(i for p in frozen.programs for i in p.rows)]
        assert sorted(rows) == list(range(len(nodes)))
        x, before = np.array(values.unknowns), np.array(values.nodes)
        for program in frozen.programs:
            assert free.issuperset(program.columns)
            residuals = program.residuals(x[program.columns])
            assert near(residuals, before[[nodes[i] for i in program.rows]]).all()
        values.assign((u, data.draw(PLAIN)) for u in data.draw(some))
        values.refresh(values.cone(nodes))
        moved = {u for u in every if values.unknowns[u] != x[u]}
        if moved <= free and not frozen.branches:
            constant = [nodes[i] for i in frozen.constant]
            assert near(np.array(values.nodes)[constant], before[constant]).all()


def near(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Equal but for rounding; what is not finite equals nothing and everything."""
    with np.errstate(all="ignore"):
        close = np.abs(one - other) <= 1e-9 * (1.0 + np.abs(one) + np.abs(other))
    return close | ~np.isfinite(one) | ~np.isfinite(other)


@given(tangles(HOSTILE))
@profile(150)
def test_numbers_and_arrays_agree_on_whole_expressions(tangle: Tangle) -> None:
    model, found = tangle.model()
    problem, nodes = model.problem(), [e.node for e in found]
    x = problem.initial + 0.0  # without negative zeros
    values = Valuation(problem.tape, x.tolist())
    values.refresh(values.cone(nodes))
    expected = np.array([values.nodes[node] for node in nodes])
    whole = Schedule(problem.tape).evaluate(x)[nodes]
    note((whole, expected))
    assume((np.signbit(whole) == np.signbit(expected))[expected == 0.0].all())  # `test_zeros_with_a_sign`
    assert same(whole, expected).all()
    jacobians = {name: way(problem, nodes, x) for name, way in WAYS.items()}
    note(jacobians)
    assert all(np.isfinite(matrix).all() for matrix in jacobians.values())
    for one, other in (("dictionaries", "levels"), ("program", "array program")):
        a, b = (jacobians[name][np.isfinite(expected)] for name in (one, other))
        inside = np.maximum(np.abs(a), np.abs(b)) < OVERFLOWN
        assert (np.abs(a - b) <= 1e-9 * np.abs(a).max(initial=1.0, where=inside))[inside].all()


def test_every_operation_has_a_value_and_partials() -> None:
    assert set(VALUE) == set(PARTIALS) == {op for op in NAMES if op > Op.UNKNOWN}

"""Degrees of freedom, motions, redundancy: against the dense rank by finite differences."""

from __future__ import annotations

import math
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, reject
from hypothesis import strategies as st

from aidl_lang.solver import Problem, Solution, Status, dependence, solve, valuation
from aidl_lang.solver import analysis as mobility
from aidl_lang.solver.analysis import Freedom, analyse
from aidl_lang.solver.expression import Op
from tests.amount import tries

from .build import E, Model, distance
from .check import evaluate, jacobian


def redundant(freedom: Freedom) -> dict[int, tuple[int, ...]]:
    return {found.constraint: found.follows_from for found in freedom.redundant}


# ---- random problems --------------------------------------------------------------------------------


def random_problem(seed: int, groups: int = 3) -> tuple[Model, Problem]:
    """Points in groups with frames, and constraints of several kinds that hold where they are written, some
    of them following from others."""
    rng = np.random.default_rng(seed)
    m = Model()
    children = [m.group() for _ in range(groups)]
    frames = [m.frame(child, *rng.uniform(-5, 5, 2)) for child in children]
    points: list[tuple[E, E]] = []
    for child, frame in zip(children, frames, strict=True):
        for _ in range(int(rng.integers(1, 4))):
            x, y = m.unknown(rng.uniform(-9, 9), child), m.unknown(rng.uniform(-9, 9), child)
            points.append((frame[0] + x, frame[1] + y))
            m.observe(child, *points[-1])
        m.unknown(rng.uniform(1, 4), child, kept=bool(rng.integers(2)), visible=True)
    start = np.array(m.initial)
    for _ in range(int(rng.integers(2, 4 * groups))):
        i, j = rng.integers(0, len(points), 2)
        k = int(rng.integers(0, 2))
        u, v = rng.integers(0, len(m.initial), 2)
        rows = {
            0: [distance(points[i], points[j])] if i != j else [points[i][k]],
            1: [points[i][k] - points[j][k]] if i != j else [points[i][k]],
            2: [points[i][0] - points[j][0] * 1.0, points[i][1] - points[j][1]] if i != j else [points[i][k]],
            3: [E(m.builder, m.builder.unknown(int(u))) + E(m.builder, m.builder.unknown(int(v))) * 0.5],
            4: [points[i][0] * points[j][1]],
        }[int(rng.integers(0, 5))]
        tape = m.problem()
        m.equal(*[row - evaluate(tape, row.node, start) for row in rows])
    return m, m.problem()


def dense(problem: Problem, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit rows of the equations, those of the observables, and which unknowns may move."""
    rows = [row.expression for c in problem.constraints for row in c.rows]
    slopes = jacobian(problem, rows, x)
    slopes /= np.linalg.norm(slopes, axis=1, keepdims=True)
    seen = jacobian(problem, [node for _, node in problem.observables], x)
    mentioned = np.isin(np.arange(len(x)), [u for node in rows for u in unknowns(problem, node)])
    return slopes, seen, ~problem.kept & ((problem.frame_of < 0) | mentioned)


@contextmanager
def only_clear_ones() -> Iterator[None]:
    try:
        yield
    except UnclearError:
        reject()


def unknowns(problem: Problem, node: int) -> set[int]:
    """What an expression mentions."""
    operands = problem.tape.operand_lists[node]
    if problem.tape.ops[node] == Op.UNKNOWN:
        return set(operands)
    return set().union(*(unknowns(problem, a) for a in operands))


class UnclearError(Exception):
    """The matrix is close to one of another rank, which is no matter of these tests."""


def rank(matrix: np.ndarray) -> int:
    if not matrix.size:
        return 0
    sigma = np.linalg.svd(matrix[:, matrix.any(axis=0)], compute_uv=False)
    if ((sigma > 1e-7) & (sigma < 1e-4)).any():
        raise UnclearError
    return int(np.count_nonzero(sigma > 1e-5))


def assert_right(problem: Problem, freedom: Freedom, x: np.ndarray) -> None:
    assert_right_for(problem, freedom, *dense(problem, x))


def assert_right_for(
    problem: Problem, freedom: Freedom, slopes: np.ndarray, seen: np.ndarray, movable: np.ndarray
) -> None:
    """With unit rows of the equations, rows of the observables, and which unknowns may move."""
    j, o = slopes[:, movable], seen[:, movable]
    assert freedom.degrees == rank(np.vstack((j, o))) - rank(j)
    groups = np.array([group for group, _ in problem.observables])
    for group, count in enumerate(freedom.group_degrees):
        assert count == rank(np.vstack((j, o[groups == group]))) - rank(j)
    # The motions: none disturbs an equation, they are independent, and all of them can be seen.
    found = np.zeros((len(movable), 0))
    for part in freedom.motions.parts:
        columns = np.zeros((len(movable), part.basis.shape[1]))
        columns[part.unknowns] = part.basis
        assert np.allclose(seen[part.observables] @ columns, part.velocities, atol=1e-6)
        found = np.hstack((found, columns))
    assert not found[~movable].any()
    assert np.abs(slopes @ found).max(initial=0.0) < 1e-6
    assert rank(seen @ found) == found.shape[1] == freedom.degrees
    assert freedom.free == tuple(np.flatnonzero(np.abs(found).max(axis=1, initial=0.0) > 1e-6))
    assert_explained(problem, freedom, slopes)


def assert_explained(problem: Problem, freedom: Freedom, slopes: np.ndarray) -> None:
    """What is redundant lies in the span of what it follows from, and of no less."""
    owner = np.array([i for i, c in enumerate(problem.constraints) for _ in c.rows])
    told = redundant(freedom)
    for constraint, others in told.items():
        own, by = slopes[owner == constraint], slopes[np.isin(owner, others)]
        assert others
        assert not set(others) & set(told)
        assert rank(np.vstack((by, own))) == rank(by)
        for left_out in others if np.bincount(owner).max() == 1 and len(others) < 20 else ():
            fewer = slopes[np.isin(owner, [other for other in others if other != left_out])]
            with suppress(UnclearError):  # a share that is small, but one
                assert rank(np.vstack((fewer, own))) > rank(fewer)
    kept = slopes[~np.isin(owner, list(told))]
    assert rank(kept) == rank(slopes)


@given(st.integers(0, 100_000))
@tries(60)
def test_counts_motions_and_reasons_are_those_of_the_dense_matrices(seed: int) -> None:
    _, problem = random_problem(seed)
    freedom = analyse(solve(problem))
    with only_clear_ones():
        assert_right(problem, freedom, problem.initial)


@given(st.integers(0, 100_000))
@tries(40)
def test_sparse_elimination_says_the_same(seed: int) -> None:
    _, problem = random_problem(seed, 4)
    solution = solve(problem)
    small = analyse(solution)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mobility, "LARGE", 0)
        patch.setattr(dependence, "LARGE", 0)
        large = analyse(solution)
    with only_clear_ones():
        assert_right(problem, large, problem.initial)
    assert large.free == small.free
    assert large.redundant == small.redundant


# ---- large models -----------------------------------------------------------------------------------


def unsolved(m: Model) -> Solution[Problem]:
    """Where a problem holds as it is written, as its solution."""
    problem = m.problem()
    count = len(problem.constraints)
    return Solution(problem, Status.SOLVED, problem.initial, (0.0,) * count, (True,) * count, (), (), ())


def bars(places: np.ndarray, ends: list[tuple[int, int]], groups: int = 1) -> tuple[Model, np.ndarray]:
    """Points, each of them seen, with bars between them, and the unit rows of the bars."""
    m = Model()
    of = [m.group() if groups > 1 else 0 for _ in range(groups)]
    at = [m.point(x, y, of[i * groups // len(places)]) for i, (x, y) in enumerate(places.tolist())]
    slopes = np.zeros((len(ends), 2 * len(places)))
    for row, (i, j) in enumerate(ends):
        between = places[i] - places[j]
        m.equal(distance(at[i], at[j]) - float(np.linalg.norm(between)))
        slopes[row, [2 * i, 2 * i + 1]] = between / np.linalg.norm(between) / math.sqrt(2.0)
        slopes[row, [2 * j, 2 * j + 1]] = -slopes[row, [2 * i, 2 * i + 1]]
    return m, slopes


def frame_of_bars(columns: int, rows: int = 2, extra: float = 0.0) -> tuple[Model, np.ndarray]:
    """A disturbed grid with bars along its lines and diagonals, and `extra` of those across."""
    rng = np.random.default_rng(1)
    grid = [(i, j) for i in range(columns) for j in range(rows)]
    number = {place: k for k, place in enumerate(grid)}
    ends = [
        (number[i, j], number[q])
        for i, j in grid
        for q in [(i + 1, j), (i, j + 1), (i + 1, j + 1), (i + 1, j - 1)]
        if q in number and (q[1] >= j or rng.uniform() < extra)
    ]
    return bars(np.array(grid) * (10.0, 8.0) + rng.uniform(-1, 1, (len(grid), 2)), ends)


@pytest.mark.parametrize(
    ("columns", "rows", "extra"),
    [(120, 2, 0.0), (90, 2, 0.1), pytest.param(13, 13, 0.0, marks=pytest.mark.slow)],
)
def test_a_large_frame_of_bars(columns: int, rows: int, extra: float) -> None:
    m, slopes = frame_of_bars(columns, rows, extra)
    solution = unsolved(m)
    count = len(solution.values)
    assert count > valuation.LARGE
    freedom = analyse(solution)
    assert_right_for(solution.problem, freedom, slopes, np.eye(count), np.ones(count, dtype=bool))
    assert freedom.degrees == 3
    assert len(freedom.redundant) == len(slopes) - count + 3


def test_a_large_chain_has_too_many_motions_to_list() -> None:
    places = np.stack((10.0 * np.arange(200), np.random.default_rng(0).uniform(-5, 5, 200)), axis=1)
    freedom = analyse(unsolved(bars(places, list(pairwise(range(200))), 40)[0]))
    assert freedom.degrees == 201
    assert freedom.group_degrees == (0,) + (6,) * 40
    assert freedom.free == tuple(range(400))
    assert freedom.motions.parts == ()


def test_a_long_circle_of_sums_is_explained_and_a_distance_that_says_more_is_not() -> None:
    m = Model()
    at = [m.point(10.0 * i, 0.0) for i in range(400)]
    steps = [m.equal(q[0] - p[0] - 10.0) for p, q in pairwise(at)]
    m.equal(distance(at[0], at[-1]) - 3990.0)
    around = m.equal(at[-1][0] - at[0][0] - 3990.0)
    freedom = analyse(unsolved(m))
    assert redundant(freedom) == {around: tuple(steps)}
    assert freedom.degrees == 401


def test_too_many_reasons_are_not_told_but_motions_are_counted() -> None:
    m, slopes = frame_of_bars(20, 20)
    freedom = analyse(unsolved(m))
    assert (freedom.degrees, freedom.redundant) == (3, ())
    assert freedom.undecided == ()
    # All but what hangs on by two bars that nothing else could replace.
    assert len(freedom.unclear) > len(slopes) - 20


def test_what_is_too_close_to_call_is_not_guessed() -> None:
    m = Model()
    x, y, z = (m.unknown(0.0, visible=True) for _ in range(3))
    m.equal(y)
    m.equal(y - x * 1e-7)
    m.equal(z)
    freedom = analyse(solve(m.problem()))
    assert (freedom.degrees, freedom.group_degrees, freedom.undecided) == (None, (None,), ((0, 1),))
    assert freedom.redundant == ()


def test_a_large_one_is_undecided_as_well() -> None:
    m, _ = frame_of_bars(160)
    first = E(m.builder, m.builder.unknown(0))
    x, y = m.point(0.0, 0.0)
    m.equal(y - x * 1e-7)
    m.equal(y)
    m.equal(x - first + m.initial[0] + y)
    freedom = analyse(solution := unsolved(m))
    assert freedom.degrees is None
    assert freedom.undecided == (tuple(range(len(solution.values))),)


def test_small_programs_do_without_scipy_and_without_fonts() -> None:
    program = (
        "import sys; from aidl_lang import pipeline; from aidl_lang.common.source import SourceFile;"
        "text = 'drawing d { a = line((0, 0), (3, 1)); constrain { a.length == 5; a.length == 5 } }';"
        "made = pipeline.compile(SourceFile('p', text));"
        "assert (made.model.degrees, [d.code for d in made.diagnostics]) == (2, ['N0602']);"
        "assert not {'scipy', 'fontTools'} & sys.modules.keys()"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


@pytest.mark.slow  # large frames are analysed, and rightly, above
@pytest.mark.parametrize("kind", ["one part", "many groups"])
def test_large_models_take_about_linear_time(kind: str) -> None:
    """Four times the size takes less than ten times as long."""
    seconds = []
    for size in (500, 2000):
        if kind == "one part":
            m, _ = frame_of_bars(size)
        else:
            m = Model()
            for _ in range(size):
                group = m.group()
                p, q = m.point(0, 0, group), m.point(3, 4, group)
                m.equal(distance(p, q) - 5.0, group=group)
        solution = unsolved(m)
        analyse(solution)
        start = time.process_time()
        freedom = analyse(solution)
        seconds.append(time.process_time() - start)
        assert freedom.degrees == (3 if kind == "one part" else 3 * size)
    assert seconds[1] < 10 * seconds[0]

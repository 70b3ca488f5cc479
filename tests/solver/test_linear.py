"""Linear algebra: dense, sparse and stacked forms against numpy's pseudo-inverse."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import csr_array

from aidl_lang.solver import linear
from aidl_lang.solver.sparse import SparseMatrix
from tests.amount import tries

KINDS = ("wide", "square", "tall", "redundant", "singular square")


def system(seed: int, kind: str, consistent: bool = True) -> tuple[np.ndarray, np.ndarray]:
    """A matrix with few entries in a row, and a right-hand side that is within reach if `consistent`."""
    random = np.random.default_rng(seed)
    m, n = {"wide": (8, 13), "square": (11, 11), "tall": (14, 9)}.get(kind, (10, 14))
    matrix = random.uniform(-2.0, 2.0, (m, n)) * (random.uniform(size=(m, n)) < 0.4)
    if kind == "redundant":
        matrix[7:] = random.uniform(-1.0, 1.0, (3, 7)) @ matrix[:7]
    elif kind == "singular square":
        matrix = matrix[:, :10]
        matrix[9] = matrix[0] - 2.0 * matrix[3]
    elif kind == "square":
        matrix += 3.0 * np.eye(m)
    y = matrix @ random.uniform(-5.0, 5.0, matrix.shape[1])
    return matrix, y if consistent else y + random.uniform(-5.0, 5.0, len(y))


def least_norm(way: str, matrix: np.ndarray, y: np.ndarray) -> linear.LeastNorm:
    return linear.least_norm(matrix if way == "dense" else SparseMatrix(csr_array(matrix)), y)


@pytest.mark.parametrize("way", ["dense", "sparse"])
@pytest.mark.parametrize("kind", KINDS)
@given(seed=st.integers(0, 10_000))
@tries(20)
def test_the_shortest_solution(way: str, kind: str, seed: int) -> None:
    matrix, y = system(seed, kind)
    found = least_norm(way, matrix, y)
    size = 1.0 + np.abs(y).max()
    sigma = np.linalg.svd(matrix, compute_uv=False)
    if sigma[sigma > 1e-10].min() < 1e-3:
        return  # the shortest one is badly determined
    assert found.outside is None
    assert np.abs(matrix @ found.point - y).max() <= 1e-9 * size
    assert np.abs(found.point - np.linalg.pinv(matrix) @ y).max() <= 1e-6 * size
    assert np.abs(found.point + matrix.T @ found.multipliers).max() <= 1e-6 * size
    assert not found.unique or np.linalg.matrix_rank(matrix) == matrix.shape[1]


@given(
    seed=st.integers(0, 100_000), kind=st.sampled_from(["column", "row", "copy", "stored zeros", "overflow"])
)
@tries(100)
def test_singular_square_matrices_are_no_danger(seed: int, kind: str) -> None:
    """SuperLU itself may crash on a matrix with an empty column."""
    random = np.random.default_rng(seed)
    n = int(random.integers(2, 30))
    matrix = random.uniform(-2.0, 2.0, (n, n)) * (random.uniform(size=(n, n)) < random.uniform(0.03, 0.5))
    sparse_matrix = csr_array(matrix)
    if kind == "copy":
        matrix[-1] = matrix[0]
    elif kind != "overflow":
        matrix[(slice(None), -1) if kind != "row" else -1] = 0.0
    if kind == "stored zeros":
        sparse_matrix.data[sparse_matrix.indices == n - 1] = 0.0
    else:
        sparse_matrix = csr_array(matrix)
    if kind == "overflow" and len(sparse_matrix.data):
        sparse_matrix.data[0] = np.inf
    with np.errstate(all="ignore"):
        found = linear.least_norm(SparseMatrix(sparse_matrix), np.ones(n))
    assert found.point.shape == (n,)
    if kind != "overflow" and found.outside is None:
        assert np.abs(matrix @ found.point - 1.0).max() <= 1e-6


@pytest.mark.parametrize("way", ["dense", "sparse"])
@given(seed=st.integers(0, 10_000))
@tries(20)
def test_what_is_out_of_reach(way: str, seed: int) -> None:
    matrix, y = system(seed, "redundant", consistent=False)
    found = least_norm(way, matrix, y)
    rest = y - matrix @ (np.linalg.pinv(matrix) @ y)
    assert found.outside is not None
    assert np.abs(found.outside - rest).max() <= 1e-5 * (1.0 + np.abs(y).max())


@given(seed=st.integers(0, 10_000), damping=st.floats(-4.0, 2.0))
@tries(30)
def test_damped_steps(seed: int, damping: float) -> None:
    matrix, residuals = system(seed, "redundant", consistent=False)
    mu = 10.0**damping
    expected = -np.linalg.solve(matrix.T @ matrix + mu * np.eye(matrix.shape[1]), matrix.T @ residuals)
    for kind in (matrix, SparseMatrix(csr_array(matrix))):
        steps = linear.DampedSteps(kind, residuals)
        assert np.abs(steps.step(mu) - expected).max() <= 1e-6 * (1.0 + np.abs(expected).max())
        assert steps.slope == pytest.approx(np.linalg.norm(matrix.T @ residuals))
        assert steps.largest >= 0.99 * np.linalg.norm(matrix, 2) ** 2


@given(st.lists(st.tuples(st.integers(0, 10_000), st.booleans()), min_size=1, max_size=6))
@tries(30)
def test_a_stack_is_its_members(members: list[tuple[int, bool]]) -> None:
    systems = [system(seed, "redundant", consistent) for seed, consistent in members]
    matrices, sides = (np.array(column) for column in zip(*systems, strict=True))
    points, outside = linear.stacked_least_norm(matrices, sides, np.ones(len(members), dtype=np.bool_))
    for matrix, y, point, rest, (_, consistent) in zip(
        matrices, sides, points, outside, members, strict=True
    ):
        assert bool(rest.any()) == (not consistent)
        alone = linear.least_norm(matrix, y)
        assert np.abs(point - alone.point).max() <= 1e-6 * (1.0 + np.abs(point).max())


@given(st.integers(0, 10_000))
@tries(40)
def test_many_inequalities_enter_together_and_end_at_the_same_point(seed: int) -> None:
    random = np.random.default_rng(seed)
    matrix, y = random.uniform(-1.0, 1.0, (40, 15)), random.uniform(-1.0, 0.5, 40)
    inequality = np.arange(40) >= 3
    one_by_one = linear._DualActiveSet(matrix, y, inequality).solve()
    found = linear.nearest(matrix, y, inequality)
    assert found.feasible == one_by_one.feasible
    if found.feasible:
        assert np.abs(found.point - one_by_one.point).max() <= 1e-8
        assert (matrix @ found.point - y)[3:].max() <= 1e-9
        assert found.multipliers[3:].min() >= -1e-12

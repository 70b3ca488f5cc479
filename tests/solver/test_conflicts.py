"""Conflicts against the judgement of linear programs, and what is said of conflicts of distances."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations, pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from aidl_lang.solver import Settings, Solution, conflicts, solve
from aidl_lang.solver.conflicts import shortfall
from aidl_lang.solver.problem import GroupFailure
from tests.amount import TRIES_ALL, tries

from .build import E, Model, distance
from .test_linear_programming import Linear, random_problem

SEEDS = st.integers(0, 100_000)


# -- affine


@given(SEEDS)
@tries(40)
def test_what_is_lacking_tells_what_would_fit(seed: int) -> None:
    problem = random_problem(seed)
    count = len(problem.right)
    assume(not problem.feasible(range(count + len(problem.bound))))
    (failure, *_) = solve(problem.model().problem()).failures

    def changed(member: int, shift: float) -> Linear:
        right, bound = problem.right.copy(), problem.bound.copy()
        (right if member < count else bound)[member if member < count else member - count] += shift
        return replace(problem, right=right, bound=bound)

    def lacking(member: int, shift: float) -> float:
        model = changed(member, shift).model().problem()
        return shortfall(model, Settings(), failure.conflict, failure.conflict, dict(failure.nearest))

    for member in failure.conflict:
        off, nudged = lacking(member, 0.0), lacking(member, 1e-3)
        shift = off / (off - nudged) * 1e-3
        assert lacking(member, shift) <= 1e-7 * off
        assert changed(member, shift * (1.0 + 1e-6)).feasible(failure.conflict) or member < count
        assert not changed(member, shift * (1.0 - 1e-3)).feasible(failure.conflict)


@given(SEEDS, st.randoms(use_true_random=False))
@tries(20)
def test_the_order_of_writing_does_not_make_a_conflict_wrong(seed: int, random: object) -> None:
    problem = random_problem(seed)
    assume(not problem.feasible(range(len(problem.right) + len(problem.bound))))
    model = problem.model()
    order = list(range(len(model.constraints)))
    random.shuffle(order)  # type: ignore[attr-defined]
    shuffled = model.problem().with_constraints([model.constraints[i] for i in order])
    failures = solve(shuffled).failures
    assert failures
    for failure in failures:
        conflict = [order[i] for i in failure.conflict]
        assert failure.minimal
        assert not problem.feasible(conflict)
        assert all(problem.feasible([j for j in conflict if j != i]) for i in conflict)


# -- distances


@dataclass
class Distances:
    """Points of the plane, some of which cannot move, and distances between pairs of them."""

    points: np.ndarray
    held: int
    pairs: list[tuple[int, int]]
    lengths: np.ndarray

    def model(self) -> Model:
        m = Model()
        zero = E(m.builder, m.builder.constant(0.0))
        points = [
            (zero + float(x), zero + float(y)) if i < self.held else m.point(float(x), float(y))
            for i, (x, y) in enumerate(self.points)
        ]
        for (a, b), length in zip(self.pairs, self.lengths, strict=True):
            m.equal(distance(points[a], points[b]) - float(length))
        return m


# -- what is said of them


def anchored(lengths: Sequence[float]) -> Distances:
    anchors = np.array([[0.0, 0.0], [40.0, 0.0], [20.0, 30.0]])
    points = np.vstack([anchors, [[18.0, 10.0]]])
    return Distances(points, 3, [(0, 3), (1, 3), (2, 3)], np.array(lengths))


def only_failure(solution: Solution) -> GroupFailure:
    (failure,) = solution.failures
    return failure


def test_without_time_what_did_not_hold_is_named() -> None:
    failure = only_failure(solve(anchored([25.0, 25.0, 20.0]).model().problem(), Settings(seconds=0.0)))
    assert failure.reason == "timed out"
    assert not failure.minimal
    assert all(member.off > 0.0 for member in failure.members)


def test_explanations_keep_to_their_budget(monkeypatch: pytest.MonkeyPatch) -> None:
    count, budget = (10, conflicts.WORK) if TRIES_ALL else (6, 1_000)
    monkeypatch.setattr(conflicts, "WORK", budget)
    m = Model()
    points = [m.point(10.0 * i, float(i % 3)) for i in range(count)]
    for a, b in combinations(range(count), 2):
        m.equal(distance(points[a], points[b]) - 7.0 - (a + b) % 5)
    failures = solve(m.problem()).failures
    assert failures
    whole = len(m.constraints) * len(m.initial)
    assert 0 < sum(failure.work for failure in failures) <= budget + 10 * whole


# -- large ones


def test_a_long_chain_is_a_conflict_in_all_its_links() -> None:
    m = Model()
    at = [m.unknown(10.0 * i) for i in range(50)]
    chain = [m.equal(at[0] - 0.0)]
    chain += [m.equal(after - before - 10.0) for before, after in pairwise(at)]
    aside = [m.equal(m.unknown(1.0) - x - 3.0) for x in at]
    chain.append(m.equal(at[-1] - 700.0))
    failure = only_failure(solve(m.problem()))
    assert failure.minimal
    assert failure.reason == "contradictory"
    assert sorted(failure.conflict) == chain
    assert not set(aside) & set(failure.conflict)


def test_a_distance_in_a_long_strip_conflicts_with_its_neighbours() -> None:
    rng = np.random.default_rng(3)
    points = np.column_stack([10.0 * np.arange(24), np.resize([0.0, 8.0], 24)]) + rng.normal(size=(24, 2))
    pairs = [(i - k, i) for i in range(24) for k in (1, 2) if i - k >= 0]
    lengths = np.array([float(np.linalg.norm(points[a] - points[b])) for a, b in pairs])
    broken = pairs.index((11, 12))
    lengths[broken] += 40.0
    failures = solve(Distances(points, 0, pairs, lengths).model().problem()).failures
    triangles = [{(10, 11), (10, 12), (11, 12)}, {(11, 12), (11, 13), (12, 13)}]
    assert failures
    for failure in failures:
        assert failure.minimal
        assert {pairs[i] for i in failure.conflict} in triangles

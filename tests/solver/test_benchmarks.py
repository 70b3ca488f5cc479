"""The benchmark of the solver measures what it says: the judge is right, the families are well posed, ours is
stated correctly, and nobody who fails is left out.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from aidl_lang.solver import solve
from benchmarks.solver.assemblies import assembly, flattened, worst_violation
from benchmarks.solver.cases import judge, judge_ours
from benchmarks.solver.families import FAMILIES
from benchmarks.solver.ours import SETTINGS, Ours
from benchmarks.solver.race import Runner
from benchmarks.solver.sketch import TOLERANCE, Evaluator, Sketch


def drawn(*constraints: dict[str, object]) -> Sketch:
    """A rectangle of 4 × 3 with a diagonal, two circles, and arcs of one, one and three quarters."""
    return Sketch(
        points=[[0, 0], [4, 0], [4, 3], [0, 3], [1, 2], [0, -4], [0, 4], [1, 0]],
        lines=[[0, 1], [1, 2], [0, 2], [3, 2], [2, 3]],
        circles=[[4, 1.0], [3, 2.0]],
        arcs=[[0, 1, 6], [1, 2, 7], [0, 1, 5]],
        constraints=list(constraints),
    )


def test_what_is_no_answer_is_no_solution() -> None:
    sketch, solution = FAMILIES["truss"].sketch(3)
    evaluator = Evaluator(sketch)
    assert evaluator.worst(solution[:-1])[0] == math.inf
    assert evaluator.worst(np.where(np.arange(len(solution)) == 3, np.nan, solution))[0] == math.inf


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("unknowns", [10, 100, 1000])
def test_families_are_well_posed(family: str, unknowns: int) -> None:
    sketch, solution = FAMILIES[family].sketch(FAMILIES[family].size_for(unknowns))
    evaluator = Evaluator(sketch)
    assert evaluator.equations == sketch.unknowns
    assert abs(sketch.unknowns / unknowns - 1.0) < 0.25
    assert evaluator.worst(solution)[0] < 1e-12
    assert evaluator.worst(sketch.start)[0] > 0.1


@pytest.mark.parametrize("family", FAMILIES)
def test_ours_solves_the_families(family: str) -> None:
    sketch, _ = FAMILIES[family].sketch(FAMILIES[family].size_for(60), noise=0.3)
    ours = Ours()
    built = ours.build(sketch)
    assert ours.solve(built) == "solved"
    assert Evaluator(sketch).worst(np.array(ours.read(built)))[0] < TOLERANCE


@pytest.mark.parametrize("shape", ["tree-1", "row-5"])
def test_assemblies_are_solved_by_groups_and_in_one(shape: str) -> None:
    problem, root = assembly(shape)
    assert worst_violation(root, problem.initial) > 0.5
    for each in (problem, flattened(problem)):
        assert worst_violation(root, solve(each, SETTINGS).values) < TOLERANCE
    assert not solve(problem, SETTINGS).changed


def test_a_case_is_judged_by_what_it_expects() -> None:
    sketch = drawn({"t": "fixed", "p": 0, "x": 0.0, "y": 0.0})
    sketch = Sketch(**{**vars(sketch), "expected": {"points": {"1": [4, 0]}, "distances": [[0, 2, 5]]}})
    assert judge(sketch, sketch.start)[0] == "matched"
    moved = sketch.start.copy()
    moved[4] += 1.0
    assert judge(Sketch(**{**vars(sketch), "arcs": []}), moved)[0] == "satisfied"
    moved[0] += 1.0
    assert judge(sketch, moved)[0] == "failed"


def test_a_case_without_a_solution_is_explained() -> None:
    fixed = [{"t": "fixed", "p": 0, "x": x, "y": 0.0} for x in (0.0, 1.0)]
    sketch = Sketch([[0.3, 0.2]], [], [], [], fixed, {"satisfiable": False})
    verdict, why = judge_ours(sketch)
    assert verdict == "explained"
    assert "['fixed', 'fixed']" in why


def test_who_is_too_slow_is_stopped_and_may_start_again(tmp_path: Path) -> None:
    sketch, _ = FAMILIES["truss"].sketch(3)
    sketch.save(path := tmp_path / "truss.json")
    with Runner("ours", 1e-3) as runner:
        assert runner.run(path, Evaluator(sketch)).trouble == "> 0.001 s"
        runner.limit = 60.0
        assert runner.run(path, Evaluator(sketch)).is_solved


def test_a_peer_that_is_not_installed_is_missing(tmp_path: Path) -> None:
    with Runner("slvs", 1.0, tmp_path) as runner:
        assert "does not exist" in runner.missing
        assert runner.run(tmp_path, Evaluator(drawn())).trouble == "missing"

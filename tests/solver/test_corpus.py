"""The corpus of hard problems: files (see `reading.py`) that say what is expected."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from aidl_lang.solver import Relation, Solution, freezing, hierarchy, solve
from aidl_lang.solver.analysis import analyse

from .check import assert_solved, evaluate
from .reading import Case, read

CORPUS = sorted((Path(__file__).parent / "corpus").glob("*.json"))
KINDS = {
    "singular", "far", "redundant", "scales", "tangent", "arc", "inequality", "branch", "angle", "conflict",
    "kept", "groups", "prefer", "empty",
}  # fmt: skip
FAILING = {
    "branch-remainder-of-another-turn": "no other number of turns is tried",
}
"""What the solver does not manage yet, and why."""


def _cases() -> list[object]:
    reasons = {path: FAILING.get(path.stem) for path in CORPUS}
    return [
        pytest.param(
            path, id=path.stem, marks=[pytest.mark.xfail(reason=reason, strict=True)] if reason else []
        )
        for path, reason in reasons.items()
    ]


@pytest.mark.parametrize("path", _cases())
@pytest.mark.parametrize("many", [10**9, 0], ids=["one by one", "all at once"])
def test_case(path: Path, many: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Group by group on numbers, and all groups of a depth at once on arrays."""
    monkeypatch.setattr(hierarchy, "MANY", many)
    monkeypatch.setattr(freezing, "MANY", many)
    case = read(path)
    solution = solve(case.problem)
    assert solution.status == case.expected["status"]
    with np.errstate(all="ignore"):
        _check_constraints(case, solution)
    _check_expected(case, solution)


def _check_constraints(case: Case, solution: Solution) -> None:
    """By plain evaluation: what is said to hold holds, what is said not to does not."""
    problem = case.problem
    if solution.status == "solved":
        assert_solved(problem, solution)
    for constraint, satisfied in zip(problem.constraints, solution.satisfied, strict=True):
        holds = True
        for row in constraint.rows:
            value = evaluate(problem, row.expression, solution.values)
            off = max(value, 0.0) if row.relation is Relation.AT_MOST else abs(value)
            holds &= off <= (2e-9 if satisfied else 0.5e-9) * row.scale
        assert holds == satisfied


def _check_expected(case: Case, solution: Solution) -> None:
    expected, names = case.expected, case.problem.names
    freedom = analyse(solution)
    found = dict(zip(names, solution.values.tolist(), strict=True))
    for name, value in expected.get("values", {}).items():
        assert found[name] == pytest.approx(value, rel=0, abs=expected.get("tolerance", 1e-6)), name
    if "degrees" in expected:
        assert freedom.degrees == expected["degrees"]
    if "conflicts" in expected:
        conflicts = [{case.tags[i] for i in failure.conflict} for failure in solution.failures]
        assert sorted(map(sorted, conflicts)) == sorted(map(sorted, expected["conflicts"]))
    if "changed" in expected:
        assert {names[i] for i in solution.changed} == set(expected["changed"])
    if "redundant" in expected:
        assert {case.tags[found.constraint] for found in freedom.redundant} == set(expected["redundant"])


def test_every_case_says_what_is_hard_and_what_comes_of_it() -> None:
    assert len(CORPUS) >= 130
    for path in CORPUS:
        case = read(path)
        assert case.about, path.stem
        assert "\n" not in case.about, path.stem
        assert case.expected["status"] is not None, path.stem
        assert bool(case.expected.get("conflicts")) == (case.expected["status"] != "solved"), path.stem
        assert path.stem.split("-")[0] in KINDS
    assert FAILING.keys() <= {path.stem for path in CORPUS}

"""The motions that are told, against the equations of the problem by finite differences."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from aidl_lang import pipeline
from aidl_lang.freedom import motions
from aidl_lang.interp import interpret
from aidl_lang.lower import lower
from aidl_lang.solver import Relation, solve
from aidl_lang.solver.analysis import analyse
from aidl_lang.source import SourceFile
from tests.solver.check import evaluate

EXAMPLES = sorted((Path(__file__).parents[1] / "examples").glob("*.aidl"))
STEP = 1e-4


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_every_motion_is_possible_and_new(path: Path) -> None:
    program, _ = pipeline.front(SourceFile(path.name, path.read_text("utf-8")))
    model = interpret(program).model
    lowered = lower(model)
    problem = lowered.problem
    solution = solve(problem)
    freedom = analyse(problem, solution)
    told = motions(model, lowered, freedom)
    number = {unknown.path: i for i, unknown in enumerate(lowered.unknowns)}
    ways = np.zeros((len(told), len(number)))
    for way, motion in zip(ways, told, strict=True):
        for name, rate in motion.moves.items():
            way[number[name]] = rate
    equations = [
        row
        for c in problem.constraints
        if c.weight is None
        for row in c.rows
        if row.relation is Relation.EQUAL
    ]
    for way in ways / np.abs(ways).max(axis=1, keepdims=True):
        for row in equations:
            ahead, behind = (
                evaluate(problem, row.expression, solution.values + sign * STEP * way) for sign in (1, -1)
            )
            assert abs(ahead - behind) / (2 * STEP) < 1e-5
    seen = np.array(
        [
            [evaluate(problem, node, solution.values + way) - evaluate(problem, node, solution.values)
             for _, node in problem.observables]
            for way in STEP * ways
        ]
    )  # fmt: skip
    assert np.linalg.matrix_rank(seen / STEP, tol=1e-5) == len(told) == freedom.degrees

"""The benchmark of the solver measures what it says: the judge is right, the families are well posed, ours is
stated correctly, and nobody who fails is left out.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from aidl_lang.solver import solve
from benchmarks.solver.assemblies import assembly, worst_violation
from benchmarks.solver.cases import judge
from benchmarks.solver.families import FAMILIES
from benchmarks.solver.ours import SETTINGS, Ours
from benchmarks.solver.sketch import RESIDUALS, TOLERANCE, Evaluator, Sketch

CIRCLE, LARGER, QUARTER, SECOND = ["c", 0], ["c", 1], ["a", 0], ["a", 1]

BY_HAND = [
    ({"t": "fixed", "p": 4, "x": 1.0, "y": 1.0}, [0.0, 1.0]),
    ({"t": "fix_x", "p": 4, "v": 3.0}, [2.0]),
    ({"t": "fix_y", "p": 4, "v": 1.0}, [1.0]),
    ({"t": "coincident", "a": 4, "b": 0}, [1.0, 2.0]),
    ({"t": "horizontal", "a": 0, "b": 4}, [2.0]),
    ({"t": "vertical", "a": 0, "b": 4}, [1.0]),
    ({"t": "hdist", "a": 0, "b": 4, "v": 3.0}, [2.0]),
    ({"t": "hdist", "a": 4, "b": 0, "v": 3.0}, [4.0]),
    ({"t": "vdist", "a": 0, "b": 4, "v": 3.0}, [1.0]),
    ({"t": "distance", "a": 0, "b": 2, "v": 4.0}, [1.0]),
    ({"t": "distance", "a": 0, "b": 2, "v": 0.0}, [5.0]),
    ({"t": "parallel", "l": 0, "m": 2}, [0.6]),
    ({"t": "perpendicular", "l": 0, "m": 2}, [0.8]),
    ({"t": "angle", "l": 0, "m": 2, "v": 0.0}, [math.atan2(3, 4)]),
    ({"t": "angle", "l": 2, "m": 0, "v": 90.0}, [math.atan2(3, 4) + math.pi / 2]),
    ({"t": "angle", "l": 2, "m": 0, "v": 90.0, "mode": "cos"}, [math.pi / 2 - math.atan2(3, 4)]),
    ({"t": "angle", "l": 0, "m": 4, "v": 30.0, "mode": "mod180"}, [math.pi / 6]),
    ({"t": "equal_length", "l": 0, "m": 1}, [1.0]),
    ({"t": "length_ratio", "l": 0, "m": 1, "v": 2.0}, [2.0]),
    ({"t": "length_diff", "l": 0, "m": 1, "v": 3.0}, [2.0]),
    ({"t": "midpoint", "p": 4, "l": 0}, [1.0, 2.0]),
    ({"t": "point_on_line", "p": 4, "l": 0}, [2.0]),
    ({"t": "point_line_distance", "p": 4, "l": 3, "v": 3.0}, [2.0]),
    ({"t": "point_line_distance", "p": 4, "l": 3, "v": 3.0, "signed": True}, [4.0]),
    ({"t": "point_line_distance", "p": 4, "l": 4, "v": 3.0, "signed": True}, [2.0]),
    ({"t": "point_on_circle", "p": 0, "k": CIRCLE}, [math.sqrt(5) - 1.0]),
    ({"t": "point_on_circle", "p": 4, "k": QUARTER}, [4.0 - math.sqrt(5)]),
    ({"t": "symmetric", "a": 0, "b": 6, "l": 0}, [2.0, 0.0]),
    ({"t": "symmetric_h", "a": 4, "b": 1}, [2.0, 5.0]),
    ({"t": "symmetric_v", "a": 4, "b": 1}, [3.0, 2.0]),
    ({"t": "radius", "k": CIRCLE, "v": 3.0}, [2.0]),
    ({"t": "radius", "k": QUARTER, "v": 3.0}, [1.0]),
    ({"t": "equal_radius", "k": CIRCLE, "k2": QUARTER}, [3.0]),
    ({"t": "tangent_line", "l": 0, "k": CIRCLE}, [1.0]),
    ({"t": "tangent_line", "l": 3, "k": SECOND}, [0.0]),
    ({"t": "tangent_curves", "k": CIRCLE, "k2": LARGER}, [3.0 - math.sqrt(2)]),
    ({"t": "tangent_curves", "k": CIRCLE, "k2": LARGER, "internal": True}, [math.sqrt(2) - 1.0]),
    ({"t": "tangent_at_end", "arc": 0, "end": 0, "l": 2}, [0.8]),
    ({"t": "tangent_at_end", "arc": 0, "end": 1, "l": 2}, [0.6]),
    ({"t": "tangent_arcs_at_ends", "arc": 0, "end": 0, "arc2": 1, "end2": 0}, [1.0]),
    ({"t": "tangent_arcs_at_ends", "arc": 0, "end": 0, "arc2": 1, "end2": 1}, [0.0]),
    ({"t": "arc_length", "arc": 0, "v": 1.0}, [2.0 * math.pi - 1.0]),
    ({"t": "arc_length", "arc": 2, "v": 17.0}, [6.0 * math.pi - 17.0]),
    ({"t": "equal_line_arc_len", "l": 0, "arc": 0}, [2.0 * math.pi - 4.0]),
    ({"t": "equal_angle", "l": 0, "m": 2, "l2": 0, "m2": 1}, [0.8]),
    ({"t": "equal_angle", "l": 0, "m": 2, "l2": 2, "m2": 1, "flip": True}, [1.4]),
    ({"t": "eq_pt_line_dist", "p": 4, "l": 0, "p2": 3, "l2": 0}, [1.0]),
    ({"t": "eq_len_pt_line_dist", "l": 0, "p": 4, "m": 0}, [2.0]),
]
"""A constraint over the geometry of `drawn`, and its residuals worked out by hand, without sign."""


def drawn(*constraints: dict[str, object]) -> Sketch:
    """A rectangle of 4 × 3 with a diagonal, two circles, and arcs of one, one and three quarters."""
    return Sketch(
        points=[[0, 0], [4, 0], [4, 3], [0, 3], [1, 2], [0, -4], [0, 4], [1, 0]],
        lines=[[0, 1], [1, 2], [0, 2], [3, 2], [2, 3]],
        circles=[[4, 1.0], [3, 2.0]],
        arcs=[[0, 1, 6], [1, 2, 7], [0, 1, 5]],
        constraints=list(constraints),
    )


def identify(value: object) -> str | None:
    return " ".join(map(str, value.values())) if isinstance(value, dict) else ""


@pytest.mark.parametrize(("constraint", "expected"), BY_HAND, ids=identify)
def test_the_judge_agrees_with_residuals_worked_out_by_hand(
    constraint: dict[str, object], expected: list[float]
) -> None:
    sketch = drawn(constraint)
    found = np.abs(Evaluator(sketch).residuals(sketch.start))
    np.testing.assert_allclose(found[: len(expected)], expected, atol=1e-12)
    np.testing.assert_allclose(found[len(expected) :], 0.0, atol=1e-12)  # the arcs are arcs
    assert len(found) == len(expected) + len(sketch.arcs)


def test_every_type_is_worked_out_by_hand() -> None:
    types = {" ".join(filter(None, (str(c["t"]), c.get("mode")))) for c, _ in BY_HAND}
    assert types | {"arc"} == set(RESIDUALS)


@pytest.mark.parametrize("constraint", [c for c, _ in BY_HAND], ids=identify)
def test_ours_satisfies_every_type(constraint: dict[str, object]) -> None:
    sketch = drawn(constraint)
    sketch.points[:] = (
        np.array(sketch.points) + np.random.default_rng(3).uniform(-0.1, 0.1, (8, 2))
    ).tolist()
    ours = Ours()
    built = ours.build(sketch)
    said = ours.solve(built)
    assert (said, Evaluator(sketch).worst(np.array(ours.read(built)))[0] < TOLERANCE) == ("solved", True)


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


@pytest.mark.parametrize("shape", ["tree-1", "tree-2", "row-5"])
def test_assemblies_are_solved_by_groups(shape: str) -> None:
    problem, root = assembly(shape)
    assert worst_violation(root, problem.initial) > 0.5
    solution = solve(problem, SETTINGS)
    assert worst_violation(root, solution.values) < TOLERANCE
    assert not solution.changed


def test_the_check_of_assemblies_sees_every_row() -> None:
    """Wherever a row is violated, so is the geometry: each unknown is moved off a solution."""
    problem, root = assembly("row-3")
    x = solve(problem, SETTINGS).values
    assert all(worst_violation(root, x + step) > 0.1 for step in 0.9 * np.eye(len(x)))


def test_a_case_is_judged_by_what_it_expects() -> None:
    sketch = drawn({"t": "fixed", "p": 0, "x": 0.0, "y": 0.0})
    sketch = Sketch(**{**vars(sketch), "expected": {"points": {"1": [4, 0]}, "distances": [[0, 2, 5]]}})
    assert judge(sketch, sketch.start)[0] == "matched"
    moved = sketch.start.copy()
    moved[4] += 1.0
    assert judge(Sketch(**{**vars(sketch), "arcs": []}), moved)[0] == "satisfied"
    moved[0] += 1.0
    assert judge(sketch, moved)[0] == "failed"

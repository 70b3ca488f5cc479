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
from benchmarks.solver.race import Answer, Runner, Times, race
from benchmarks.solver.sketch import RESIDUALS, TOLERANCE, Evaluator, Sketch, load

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


def test_the_pattern_covers_the_jacobian() -> None:
    sketch = drawn(*(c for c, _ in BY_HAND))
    evaluator = Evaluator(sketch)
    x = sketch.start + np.random.default_rng(5).uniform(-0.1, 0.1, sketch.unknowns)
    pattern = np.zeros((evaluator.equations, sketch.unknowns))
    pattern[evaluator.pattern] = 1.0
    steps = 1e-6 * np.eye(sketch.unknowns)
    jacobian = np.stack(
        [evaluator.residuals(x + step) - evaluator.residuals(x - step) for step in steps], axis=1
    )
    assert np.abs(jacobian[pattern == 0.0]).max() == 0.0
    assert (np.abs(jacobian) > 1e-9).sum() > 0.6 * pattern.sum()


def test_what_is_no_answer_is_no_solution() -> None:
    sketch, solution = FAMILIES["truss"].sketch(3)
    evaluator = Evaluator(sketch)
    assert evaluator.worst(solution[:-1])[0] == math.inf
    assert evaluator.worst(np.where(np.arange(len(solution)) == 3, np.nan, solution))[0] == math.inf


def test_an_unknown_type_is_refused() -> None:
    with pytest.raises(ValueError, match="no type of constraint"):
        Evaluator(drawn({"t": "glued", "a": 0, "b": 1}))


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("unknowns", [10, 100, 1000])
def test_families_are_well_posed(family: str, unknowns: int) -> None:
    sketch, solution = FAMILIES[family].sketch(FAMILIES[family].size_for(unknowns))
    evaluator = Evaluator(sketch)
    assert evaluator.equations == sketch.unknowns
    assert abs(sketch.unknowns / unknowns - 1.0) < 0.25
    assert evaluator.worst(solution)[0] < 1e-12
    assert evaluator.worst(sketch.start)[0] > 0.1


def test_noise_is_seeded_and_bounded() -> None:
    family = FAMILIES["grid"]
    (one, solution), (same, _), (other, _) = (family.sketch(4, seed=seed, noise=0.3) for seed in (1, 1, 2))
    assert one == same
    assert one != other
    assert 2.5 < np.abs(one.start - solution)[: 2 * 16].max() <= 3.0


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


@pytest.mark.parametrize("shape", ["tree-1", "row-5"])
def test_assemblies_are_solved_in_one_group(shape: str) -> None:
    problem, root = assembly(shape)
    assert worst_violation(root, solve(flattened(problem), SETTINGS).values) < TOLERANCE


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


def test_a_case_without_a_solution_is_explained() -> None:
    fixed = [{"t": "fixed", "p": 0, "x": x, "y": 0.0} for x in (0.0, 1.0)]
    sketch = Sketch([[0.3, 0.2]], [], [], [], fixed, {"satisfiable": False})
    verdict, why = judge_ours(sketch)
    assert verdict == "explained"
    assert "['fixed', 'fixed']" in why


def test_a_sketch_that_is_none_is_refused(tmp_path: Path) -> None:
    (tmp_path / "bad.json").write_text('{"points": []}')
    with pytest.raises(ValueError, match="lacks"):
        load(tmp_path / "bad.json")


def test_a_race_of_ours() -> None:
    sketch, _ = FAMILIES["chain"].sketch(1)
    with Runner("ours", 60.0) as runner:
        times = race([runner], sketch, 2, 60.0)["ours"]
    assert times.trouble == ""
    assert len(times.kept) == 2
    assert 0.0 < times.solve < 60.0


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


def test_the_word_of_a_contestant_counts_for_nothing() -> None:
    good, wrong = Answer(said="solved", residual=1e-9), Answer(said="solved", residual=1e-3)
    assert Times([good, good]).trouble == ""
    assert Times([good, wrong]).trouble == "solved, off by 1e-03"

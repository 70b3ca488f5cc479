"""What holds for every problem, whatever the way in which it is solved.

Sketches are made around a known solution (`sketches`), and written so near that there is one answer to give
(`regularity`). `AIDL_EXAMPLES=50 pytest …` tries fifty times as many of them, others each time.
"""

from __future__ import annotations

import math
import os
import pickle
import random
import subprocess
import sys
from dataclasses import replace
from hashlib import sha256

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import minimize

from aidl_lang.solver import Constraint, Problem, Settings, Solution, solve
from aidl_lang.solver.analysis import analyse
from tests.documents import ROOT
from tests.interrupts import within

from .check import assert_honest, assert_smallest_change, assert_solved, jacobian, values_of
from .kinds import KINDS
from .random_expressions import HOSTILE, Tangle, tangles
from .random_problems import Taste, kinds_where, links, profile, sketches
from .regularity import is_regular, neighbours
from .sketches import Built, Circle, Link, Point, Sketch

CLOSE = 1e-6
"""How far two answers to the same question may be apart, in units of the sketch."""
EXACTLY = 1e-7

EQUATIONS = Taste()
INEQUALITIES = Taste(senses=("=", "=", "<=", ">="))
BOXES = Taste(kinds=tuple(KINDS), senses=("=", "<=", ">="))
RIGID = Taste(kinds=kinds_where(lambda kind: kind.rigid))
TREES = Taste(groups=3, circles=(0, 1), links=(1, 6))


def regular(taste: Taste) -> st.SearchStrategy[Sketch]:
    """Sketches whose known solution lies on a smooth surface of solutions."""

    def at_known(sketch: Sketch) -> bool:
        built = sketch.build()
        return is_regular(built.problem, built.known)

    return sketches(taste).filter(at_known)


def solved(problem: Problem) -> Solution:
    solution = solve(problem)
    assert_solved(problem, solution)
    return solution


def coordinates(sketch: Sketch) -> np.ndarray:
    """The sketch's coordinates where they are solved."""
    return solved(sketch.problem()).values


def assert_same(one: np.ndarray, other: np.ndarray, tolerance: float = CLOSE) -> None:
    assert np.abs(one - other).max(initial=0.0) <= tolerance


# ---- solved, honestly, by the smallest change -----------------------------------------------------------


def change(built: Built, values: np.ndarray) -> float:
    return float(np.linalg.norm((values - built.problem.initial) / built.problem.scale))


@given(regular(INEQUALITIES))
@profile(100)
def test_what_can_hold_is_solved_by_no_more_than_the_known_change(sketch: Sketch) -> None:
    built = sketch.build()
    solution = solved(built.problem)
    assert_honest(built.problem, solution)
    assert solution.failures == ()
    assert change(built, solution.values) <= change(built, built.known) * (1.0 + 1e-6) + 1e-9


@given(regular(INEQUALITIES))
@profile(60)
def test_no_neighbour_is_nearer(sketch: Sketch) -> None:
    built = sketch.build()
    solution = solved(built.problem)
    assert_smallest_change(built.problem, solution)
    reached = change(built, solution.values)
    for neighbour in neighbours(built.problem, solution.values):
        assert change(built, neighbour) >= reached - 1e-7 * (1.0 + reached)


@given(regular(INEQUALITIES))
@profile(30)
def test_another_optimiser_finds_nothing_nearer(sketch: Sketch) -> None:
    built = sketch.build()
    problem, solution = built.problem, solved(built.problem)
    rows = [row for constraint in problem.constraints for row in constraint.rows]
    sides = {
        "eq": [row for row in rows if row.relation == "="],
        "ineq": [row for row in rows if row.relation == "<="],
    }

    def constraint(kind: str, sign: float) -> dict[str, object]:
        nodes = [row.expression for row in sides[kind]]
        return {
            "type": kind,
            "fun": lambda x: sign * values_of(problem, nodes, x),
            "jac": lambda x: sign * jacobian(problem, nodes, x),
        }

    for start in (problem.initial, solution.values):
        found = minimize(
            lambda x: float(np.sum((x - problem.initial) ** 2)),
            start,
            jac=lambda x: 2.0 * (x - problem.initial),
            method="SLSQP",
            constraints=[
                constraint(kind, sign) for kind, sign in (("eq", 1.0), ("ineq", -1.0)) if sides[kind]
            ],
            options={"ftol": 1e-12, "maxiter": 200},
        )
        if found.success:  # it gives up where rows depend on each other
            assert change(built, found.x) >= change(built, solution.values) * (1.0 - 1e-6) - 1e-6


@given(tangles(HOSTILE, rows=5))
@profile(120)
def test_unkind_problems_are_answered_honestly_and_soon(tangle: Tangle) -> None:
    problem = tangle.problem()
    with within(10.0):
        solution = solve(problem, Settings(seconds=1.0))
    assert_honest(problem, solution)


@given(sketches(replace(BOXES, groups=2, noise=8.0, kept=True, links=(2, 6))), st.data())
@profile(25)
def test_what_cannot_hold_is_not_claimed(sketch: Sketch, data: st.DataObject) -> None:
    """Links are said twice, and the second time with another value."""
    again = [replace(link, excess=data.draw(st.sampled_from([0.0, 3.0]))) for link in sketch.links[:3]]
    problem = sketch.with_links(again).problem()
    assert_honest(problem, solve(problem))


@given(regular(replace(BOXES, noise=2.0)))
@profile(40)
def test_boxes_are_solved_honestly(sketch: Sketch) -> None:
    problem = sketch.problem()
    assert_honest(problem, solved(problem))


# ---- the same in other words ----------------------------------------------------------------------------


def rotation(angle: float) -> np.ndarray:
    return np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])


TURN, QUARTER = st.floats(-math.pi, math.pi), st.sampled_from([1, 2, 3])
SIMILARITIES: dict[str, tuple[Taste, st.SearchStrategy[np.ndarray]]] = {
    "quarter turns": (
        RIGID,
        QUARTER.map(lambda k: np.linalg.matrix_power(np.array([[0, -1], [1, 0]]), k) * 1.0),
    ),
    "turns": (RIGID, TURN.map(rotation)),
    "mirror": (Taste(kinds=kinds_where(lambda kind: kind.mirrored != 0)), st.just(np.diag([-1.0, 1.0]))),
    "size": (INEQUALITIES, st.floats(-4.0, 4.0).map(lambda e: 10.0**e * np.eye(2))),
}


@pytest.mark.parametrize("name", SIMILARITIES)
@pytest.mark.parametrize("groups", [0, 2])
@given(data=st.data())
@profile(20)
def test_what_is_turned_mirrored_or_scaled_is_solved_alike(
    name: str, groups: int, data: st.DataObject
) -> None:
    taste, matrices = SIMILARITIES[name]
    sketch = data.draw(regular(replace(taste, groups=groups)))
    matrix = data.draw(matrices)
    moved = sketch.moved(matrix)
    assume(all(map(moved.is_sound, moved.links)))
    expected = sketch.placed_at(coordinates(sketch)).moved(matrix).build()
    assert_same(coordinates(moved), expected.known, CLOSE * moved.unit)


@given(
    regular(replace(INEQUALITIES, kinds=kinds_where(lambda kind: kind.mirrored != 0 or kind.swapped != "")))
)
@profile(25)
def test_what_is_flipped_about_the_diagonal_is_solved_alike(sketch: Sketch) -> None:
    flipped = sketch.flipped()
    expected = sketch.placed_at(coordinates(sketch)).flipped().build()
    assert_same(coordinates(flipped), expected.known)


# ---- order ----------------------------------------------------------------------------------------------


def shuffled(problem: Problem, chance: random.Random) -> Problem:
    """Its constraints and the rows of each in another order."""

    def mixed(constraint: Constraint) -> Constraint:
        return replace(constraint, rows=tuple(chance.sample(constraint.rows, len(constraint.rows))))

    constraints = [mixed(constraint) for constraint in problem.constraints]
    chance.shuffle(constraints)
    return problem.with_constraints(constraints)


@given(regular(replace(INEQUALITIES, groups=2)), st.randoms(use_true_random=False))
@profile(60)
def test_the_order_of_constraints_and_rows_does_not_matter(sketch: Sketch, chance: random.Random) -> None:
    problem = sketch.problem()
    assert_same(solved(shuffled(problem, chance)).values, solved(problem).values)


# ---- what changes nothing -------------------------------------------------------------------------------


@given(regular(replace(INEQUALITIES, groups=2)), st.data())
@profile(50)
def test_a_copy_changes_nothing_but_the_note(sketch: Sketch, data: st.DataObject) -> None:
    problem = sketch.problem()
    assume(problem.constraints)
    copied = data.draw(st.integers(0, len(problem.constraints) - 1))
    copies = problem.with_constraints([*problem.constraints, problem.constraints[copied]])
    plain, more = solve(problem), solve(copies)
    assert_same(more.values, plain.values, EXACTLY)
    assert more.status == plain.status
    before, after = analyse(plain), analyse(more)
    assert after.degrees == before.degrees
    redundant = {found.constraint for found in after.redundant}
    assert redundant >= {found.constraint for found in before.redundant}
    rows = problem.constraints[copied].rows
    slopes = jacobian(problem, [row.expression for row in rows], plain.values)
    if sketch.links[copied].sense == "=" and np.linalg.norm(slopes, axis=1).min() > 1e-6:
        assert len(problem.constraints) in redundant


@given(regular(replace(INEQUALITIES, groups=2)), st.data())
@profile(50)
def test_an_inequality_with_room_to_spare_changes_nothing(sketch: Sketch, data: st.DataObject) -> None:
    plain = solve(sketch.problem())
    loose = [replace(data.draw(links(sketch, EQUATIONS)), sense="<=", room=100.0) for _ in range(2)]
    more = solve(sketch.with_links(loose).problem())
    assert more.values.tobytes() == plain.values.tobytes()
    assert more.status == plain.status
    if not sketch.groups:  # a frame that is mentioned counts as free
        before, after = analyse(plain), analyse(more)
        assert (after.degrees, after.free) == (before.degrees, before.free)


@given(sketches(TREES), sketches(TREES))
@profile(40)
def test_what_is_unrelated_changes_nothing(sketch: Sketch, other: Sketch) -> None:
    mine, _ = sketch.beside(other).halves(sketch)
    together, alone = sketch.beside(other).build(), sketch.build()
    values = solve(together.problem).values
    assert_same(values[mine], solve(alone.problem).values, 0.0)


@given(st.lists(regular(replace(TREES, kept=True)), min_size=2, max_size=4), st.integers(1, 12))
@profile(8)
def test_each_of_many_is_solved_as_if_alone(several: list[Sketch], times: int) -> None:
    many, places = several[0].within(), [np.arange(len(several[0].within().build().known))]
    for sketch in several[1:] * times:
        more = many.beside(sketch.within())
        mine, others = more.halves(many)
        many, places = more, [*(mine[place] for place in places), others]
    alone = [coordinates(sketch.within()) for sketch in several]
    values = coordinates(many)
    assert_same(values[places[0]], alone[0], EXACTLY)
    for place, expected in zip(places[1:], alone[1:] * times, strict=True):
        assert_same(values[place], expected, EXACTLY)


# ---- the tree -------------------------------------------------------------------------------------------


@given(sketches(TREES), sketches(replace(TREES, noise=0.0)))
@profile(30)
def test_a_descendant_that_nothing_mentions_is_rigid(sketch: Sketch, other: Sketch) -> None:
    both = sketch.beside(other.within())
    _, inner = both.halves(sketch)
    built = both.build()
    values = solve(built.problem).values
    assert_same(values[inner], built.problem.initial[inner], 0.0)


def assert_others_stay(built: Built, free: np.ndarray) -> Solution:
    """Written so that moving what is `free` (n,) is enough; then nothing else moves."""
    assume(is_regular(built.problem, built.known, free))
    problem = replace(built.problem, initial=np.where(free, built.problem.initial, built.known))
    solution = solved(problem)
    assert solution.values[~free].tobytes() == built.known[~free].tobytes()
    return solution


@given(sketches(replace(EQUATIONS, kept=True, groups=2)))
@profile(40)
def test_sizes_stay_if_positions_suffice(sketch: Sketch) -> None:
    built = sketch.build()
    assert assert_others_stay(built, ~built.problem.kept).changed == ()


# ---- preferences ----------------------------------------------------------------------------------------


@given(regular(replace(TREES, kept=True)), st.data())
@profile(40)
def test_preferences_cost_nothing_and_help(sketch: Sketch, data: st.DataObject) -> None:
    """They break no constraint and change no size, and afterwards they lack no more than before."""
    taste = replace(EQUATIONS, links=(1, 3))
    soft = [replace(data.draw(links(sketch, taste)), weight=w, excess=e) for w, e in ((1.0, 0.0), (4.0, 2.0))]
    plain, problem = solved(sketch.problem()), sketch.with_links(soft).problem()
    solution = solved(problem)
    assert_honest(problem, solution)
    assert solution.changed == plain.changed
    assert lack(problem, solution.values) <= lack(problem, plain.values) * (1.0 + 1e-6) + 1e-12


def lack(problem: Problem, values: np.ndarray) -> float:
    """The weighted squares of what the preferences lack."""
    rows = [(row, c.weight) for c in problem.constraints if c.weight is not None for row in c.rows]
    residuals = values_of(problem, [row.expression for row, _ in rows], values)
    return sum(weight * (r / row.scale) ** 2 for (row, weight), r in zip(rows, residuals, strict=True))


# ---- degrees of freedom ---------------------------------------------------------------------------------


@given(regular(replace(INEQUALITIES, kept=True)))
@profile(40)
def test_degrees_of_freedom_are_unknowns_less_rank(sketch: Sketch) -> None:
    built = sketch.build()
    problem, free = built.problem, ~built.problem.kept
    solution = solved(problem)
    assume(is_regular(problem, solution.values, free))
    equations = [row for c in problem.constraints for row in c.rows if row.relation == "="]
    matrix = jacobian(problem, [row.expression for row in equations], solution.values)[:, free]
    assert analyse(solution).degrees == int(free.sum()) - np.linalg.matrix_rank(matrix, tol=1e-5)


# ---- determinism ----------------------------------------------------------------------------------------

DIGEST = (
    "import pickle, sys; from hashlib import sha256; from aidl_lang.solver import solve;"
    "[print(sha256(solve(p).values.tobytes()).hexdigest()) for p in pickle.load(sys.stdin.buffer)]"
)


@given(st.lists(sketches(replace(BOXES, groups=2, noise=4.0, kept=True)), min_size=6, max_size=10))
@profile(3)
def test_the_same_digits_twice_and_in_any_process(several: list[Sketch]) -> None:
    problems = [sketch.problem() for sketch in several]
    digests = [sha256(solve(p).values.tobytes()).hexdigest() for p in problems]
    assert [sha256(solve(p).values.tobytes()).hexdigest() for p in problems] == digests
    run = subprocess.run(
        [sys.executable, "-c", DIGEST],
        input=pickle.dumps(problems),
        env={**os.environ, "PYTHONHASHSEED": "1", "PYTHONPATH": str(ROOT)},
        capture_output=True,
        check=True,
    )
    assert run.stdout.decode().split() == digests


# ---- where it once went wrong ---------------------------------------------------------------------------


def test_an_arc_may_begin_where_atan2_jumps() -> None:
    """Its start is to the left of its centre."""
    points = (Point((0.0, 0.0)), Point((-10.0, 0.0), (0.0, 0.05)), Point((0.0, -10.0), (0.05, 0.0)))
    coordinates(Sketch(points, (Circle(0, 5.0, 0.25, kept=True),), links=(Link("arc_length", (0, 1, 2)),)))

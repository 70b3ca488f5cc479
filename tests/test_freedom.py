"""The motions that are told, against the equations of the problem by finite differences."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from aidl_lang import pipeline
from aidl_lang.building.expression import DEGREE
from aidl_lang.building.lower import Lowered, lower
from aidl_lang.building.model import Model
from aidl_lang.common.source import SourceFile
from aidl_lang.geometry.freedom import motions, report
from aidl_lang.geometry.freedom.scene import Bending, Scene, X, Y
from aidl_lang.geometry.solved import Motion, SolvedModel
from aidl_lang.interp import interpret
from aidl_lang.solver import Relation, Solution, Status, solve
from aidl_lang.solver.analysis import Freedom, analyse
from aidl_lang.solver.valuation import linearise
from tests.amount import tries
from tests.compiled import LIGHTER, compiled
from tests.solver.check import evaluate

STEP = 1e-4


class Analysed:
    """A program, and what is told of its freedom."""

    def __init__(self, name: str, text: str) -> None:
        program, _ = pipeline.front(SourceFile(name, text))
        self.model: Model = interpret(program).model
        self.lowered: Lowered = lower(self.model)
        self.solution: Solution = solve(self.lowered.problem)
        self.freedom: Freedom = analyse(self.lowered.problem, self.solution)
        bending = Bending(self.lowered.problem, self.solution)
        self.scene = Scene(self.model, self.lowered, self.freedom.motions, bending)
        self.ways: tuple[Motion, ...] = motions(self.model, self.lowered, self.solution, self.freedom)

    def rates(self, motion: Motion) -> np.ndarray:
        """How fast the unknowns change."""
        number = {unknown.path: i for i, unknown in enumerate(self.lowered.unknowns)}
        way = np.zeros(len(number))
        for name, rate in motion.moves.items():
            way[number[name]] = rate
        return way

    def velocity(self, motion: Motion) -> np.ndarray:
        """How fast the observables change, by finite differences."""
        way, problem = self.rates(motion), self.lowered.problem
        step = STEP / np.abs(way).max()
        ahead, behind = (
            np.array([evaluate(problem, node, at) for _, node in problem.observables])
            for at in (self.solution.values + step * way, self.solution.values - step * way)
        )
        return (ahead - behind) / (2 * step)

    def equations(self) -> list[int]:
        """Every equation that holds."""
        constraints = zip(self.lowered.problem.constraints, self.solution.satisfied, strict=True)
        held = (c for c, holds in constraints if c.weight is None and holds)
        return [row.expression for c in held for row in c.rows if row.relation is Relation.EQUAL]

    def residuals(self) -> list[tuple[float, float]]:
        """Of every equation that holds, a step along and a step against every motion."""
        problem, at = self.lowered.problem, self.solution.values
        ways = [self.rates(motion) for motion in self.ways]
        steps = [STEP * way / np.abs(way).max() for way in ways]
        pairs = [(node, step) for step in steps for node in self.equations()]
        return [
            (evaluate(problem, node, at + step), evaluate(problem, node, at - step)) for node, step in pairs
        ]

    def misses(self, motion: Motion, amount: float) -> float:
        """How far the equations are from holding where the things of a motion have gone on as its words say,
        and what stays stays.
        """
        problem, scene = self.lowered.problem, self.scene
        seen = np.flatnonzero(scene.anchor == 0)
        equal = self.equations()
        roots = np.array([*equal, *(problem.observables[o][1] for o in seen)], dtype=np.int64)
        wanted = np.concatenate((np.zeros(len(equal)), self._gone(motion, amount)[seen]))
        kept = np.array(problem.kept, dtype=np.bool_)
        at = np.array(self.solution.values)
        for _ in range(30):
            values, slopes = linearise(problem.tape, at, roots)
            jacobian = np.zeros((len(roots), len(at)))
            jacobian[slopes.rows, slopes.columns] = slopes.entries
            jacobian[:, kept] = 0.0
            at = at + np.linalg.lstsq(jacobian, wanted - values, rcond=1e-9)[0]
        return float(np.abs(linearise(problem.tape, at, roots)[0] - wanted).max())

    def _gone(self, motion: Motion, amount: float) -> np.ndarray:
        """Where the observables are when a motion has gone on by so much."""
        scene, seen = self.scene, self.velocity(motion)
        own = np.concatenate([scene.own(scene.known[path]) for path in motion.things])
        own = own[scene.anchor[own] == 0]
        seen = seen * amount / np.abs(seen[own]).max()
        gone = scene.places + seen
        if motion.kind != "turn":
            return gone
        x, y = (scene.places[own[scene.axis[own] == axis]] for axis in (X, Y))
        u, v = (seen[own[scene.axis[own] == axis]] for axis in (X, Y))
        dx, dy = x - x.mean(), y - y.mean()
        spin = (dx @ (v - v.mean()) - dy @ (u - u.mean())) / (dx @ dx + dy @ dy)
        cx, cy = x.mean() - v.mean() / spin, y.mean() + u.mean() / spin
        if about := re.search(r"about \((.*), (.*)\)", motion.words):
            assert (cx, cy) == pytest.approx([float(each) for each in about.groups()], abs=1e-3)
        gone[own] = scene.places[own] + np.degrees(spin) * scene.turning[own] * DEGREE
        gone[own[scene.axis[own] == X]] = cx + (x - cx) * np.cos(spin) - (y - cy) * np.sin(spin)
        gone[own[scene.axis[own] == Y]] = cy + (x - cx) * np.sin(spin) + (y - cy) * np.cos(spin)
        return gone

    def hold_true(self) -> None:
        """Every motion disturbs no equation beyond the second order, and they are as many as are counted."""
        assert all(abs(ahead - behind) / (2 * STEP) < 1e-5 for ahead, behind in self.residuals())
        ways = self.ways
        assert len(ways) == self.freedom.degrees
        if ways:
            seen = np.array([self.velocity(motion) for motion in self.ways])
            scaled = seen / np.abs(seen).max(axis=1, keepdims=True)
            assert np.linalg.matrix_rank(scaled, tol=1e-5) == len(ways)


@pytest.mark.parametrize("path", LIGHTER)
def test_every_motion_is_possible_and_new(path: Path) -> None:
    Analysed(path.name, path.read_text("utf-8")).hold_true()


# --- Random assemblies -----------------------------------------------------------------------------

RELATIONS = (
    "{a}.left == {b}.right + {n}",
    "{a}.bottom == {b}.top + {n}",
    "align_center_y({a}, {b})",
    "centered_horizontally({a}, {b})",
    "{a}.body.center == {b}.body.center + ({n}, 3)",
    "{a}.rim.center.x - {b}.rim.center.x == {n}",
    "{a}.left >= {b}.right - 500",
    "distance({a}.body.center, {b}.body.center) == {d}",
)


@st.composite
def relations(
    draw: st.DrawFn, count: int, most: int, templates: Sequence[str], numbers: st.SearchStrategy[int]
) -> list[str]:
    """Up to `most` relations of parts p0, p1, … to earlier ones."""
    pairs = st.tuples(st.integers(0, count - 1), st.integers(0, count - 1)).filter(lambda p: p[0] < p[1])
    stated = []
    for a, b in draw(st.lists(pairs, max_size=most, unique=True)):
        relation = draw(st.sampled_from(templates))
        stated.append(relation.format(a=f"p{b}", b=f"p{a}", n=draw(numbers), d=40 * (b - a)))
    return stated


@st.composite
def assemblies(draw: st.DrawFn) -> str:
    count = draw(st.integers(2, 5))
    parts = []
    for i in range(count):
        x, y = 40 * i, draw(st.integers(-5, 5))
        inner = "hole eye { rim = circle(center: (1, 2), radius: 2) }" if draw(st.booleans()) else ""
        own = "constrain rim.center.y == body.center.y" if draw(st.booleans()) else ""
        parts.append(
            f"solid p{i} {{ body = rectangle(center: ({x}, {y}), width: 10, height: 8)"
            f" rim = circle(center: ({x + 2}, {y}), radius: 2) {inner} {own} }}"
        )
    stated = draw(relations(count, 5, RELATIONS, st.integers(-20, 20)))
    return "assembly top {\n" + "\n".join(parts) + "\nconstrain {\n" + "\n".join(stated) + "\n}\n}"


TURNING = (
    "{a}.body.bottom_left == {b}.body.top_right",
    "{a}.origin == {b}.rim.center",
    "distance({a}.rim.center, {b}.rim.center) == {d}",
    "tangent({a}.rim, {b}.rim)",
    "coincident({a}.rim.center, {b}.body.top)",
    "equal({a}.rim, {b}.rim)",
    "{a}.body.width == 2 * {b}.body.height",
    "parallel({a}.body.top, {b}.body.top)",
    "align_center_y({a}.rim, {b}.rim)",
    "{a}.rim.center.x - {b}.rim.center.x == {n}",
)


@st.composite
def linkages(draw: st.DrawFn) -> str:
    """Assemblies whose parts turn and grow."""
    count = draw(st.integers(2, 4))
    parts = []
    for i in range(count):
        turned = draw(st.sampled_from(["", f"rotated guess({draw(st.integers(-40, 40))}deg)"]))
        width, height, radius = (draw(st.sampled_from([f"{n}", f"guess({n})"])) for n in (10, 8, 2))
        place = draw(st.sampled_from([f"({40 * i}, {7 * i})", f"fixed(({40 * i}, {7 * i}))"]))
        where = draw(st.sampled_from(["(2, 1)", "fixed((2, 1))"]))
        parts.append(
            f"solid p{i} at {place} {turned} {{ body = rectangle(center: fixed((0, 0)), width: {width},"
            f" height: {height}) rim = circle(center: {where}, radius: {radius}) }}"
        )
    stated = draw(relations(count, 3, TURNING, st.integers(10, 40)))
    return "@detached assembly top {\n" + "\n".join(parts) + "\nconstrain {\n" + "\n".join(stated) + "\n}\n}"


@tries(60)
@given(assemblies() | linkages())
def test_what_is_told_goes_on_as_it_is_told(text: str) -> None:
    """Things gone on by a twentieth of their size as the words say leave every constraint as it was; those of
    which it is told that they leave their line or their centre do not.
    """
    analysed = Analysed("top.aidl", text)
    assume(analysed.solution.status is Status.SOLVED and analysed.freedom.degrees is not None)
    # Where two things make the side of a box together, one of them is taken: no motion both ways is left.
    assume(all(abs(ahead + behind) < 1e-2 * STEP for ahead, behind in analysed.residuals()))
    analysed.hold_true()
    for motion in analysed.ways:
        if motion.kind not in ("slide", "turn", "grow") or not analysed.scene.known.keys() >= set(
            motion.things
        ):
            continue
        missed = analysed.misses(motion, 0.5)
        assert missed <= 1e-5 or "a curve" in motion.words or motion.words == "turn", (motion, missed)
        assert missed > 1e-5 or "a curve" not in motion.words, (motion, missed)


# --- The report ------------------------------------------------------------------------------------


def model(text: str) -> SolvedModel:
    found = compiled(text).model
    assert found is not None
    return found


CIRCLES = "\n".join(f"c{'abcdefgh'[i]} = circle(center: ({9 * i}, 0), radius: 1)" for i in range(8))


def test_lines_that_say_nothing_new_are_counted() -> None:
    found = model(f"drawing d {{ base = line(fixed((0, 0)), fixed((9, 0))) {CIRCLES} }}")
    assert len(report(found)) == 8
    assert report(found, 8) == report(found)
    assert report(found, 4) == [*report(found)[:3], "… and 5 more like these"]
    assert report(found, 2) == ["`ca` can slide along x and y", "… and 7 more like this"]


def test_a_line_that_differs_in_kind_is_told_beyond_the_limit() -> None:
    found = model(f"drawing d {{ {CIRCLES} pin = circle(center: fixed((0, 9)), radius: guess(3)) }}")
    assert report(found, 4)[1:] == [
        "`cb` can slide along x and y",
        "`pin.radius` can change",
        "… and 6 more like these",
    ]


def test_what_a_large_model_has_beside_its_ways_is_counted() -> None:
    def many(number: int) -> list[str]:
        circles = f"for i in 0..<{number} {{ c[i] = circle(center: (9 * i, 0), radius: 3) }}"
        return report(model(f"drawing d {{ {circles} }}"))

    assert many(100) == ["`c[1]` … `c[99]` can each slide along x and y"]
    assert many(130) == [*many(100), "… and 60 more degrees of freedom, not told apart"]

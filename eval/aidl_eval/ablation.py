"""The solver's parts put to the test: programs are solved without one of them, or in another order. Asks no
model.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from aidl_eval.statistics import Floats
from aidl_lang import SourceFile, pipeline
from aidl_lang.building.expression import Evaluator
from aidl_lang.building.lower import Lowered, lower, seen
from aidl_lang.building.model import Model, Structure
from aidl_lang.common.world import World
from aidl_lang.interp import interpret
from aidl_lang.solver import Problem, Stages, solve
from aidl_lang.solver.array_program import Schedule
from aidl_lang.solver.problem import violations
from aidl_lang.typecheck import Program

FULL = "full"
WRONG = "wrong"
_MOVED = 1e-5
"""Change in mm, or in degrees, up to which all is as it was; far above the solver's tolerance."""
_TIMES = 3
"""Solves of which the quickest counts, where the first was quick."""
_QUICK = 1.0
_DIGITS = 6
"""Of a drift; further ones are the solver's tolerance."""
_SETTINGS = pipeline.Settings()
_SECONDS = 120.0
"""The most for one solve: six times the usual, so that no slow way is cut off near its end."""


@dataclass(frozen=True)
class Way:
    """A way to solve; whether boxes are `whole` is a matter of the problem, which is built anew for it."""

    meaning: str
    stages: Stages = Stages.FULL
    pruning: bool = True
    together: bool = True
    whole_boxes: bool = False


WAYS = {
    FULL: Way("the solver as it is"),
    "in-turn": Way("structures one by one, never all of a depth at once; so the next four", together=False),
    "paper": Way("the paper's: own geometry, translations by level, all else; no size is kept", Stages.PAPER),
    "level": Way("no preference for translations over the geometry of what lies deeper", Stages.LEVEL),
    "flat": Way("all constraints as one system, with everything free at once", Stages.FLAT),
    "no-pruning": Way("`min`, `max`, `abs` and `select` stay in the equations of a search", pruning=False),
    "no-box-rule": Way("a box compared with that of a descendant does not leave it out", whole_boxes=True),
}
"""All ways by name. To solve all of a depth at once is left out but in `full` and where boxes are whole."""


@dataclass(frozen=True)
class Solved:
    """The solve of one program in one way.

    thing      what is drawn: programs of one thing are alike
    parts      structures that draw something themselves, of which
    disturbed  own geometry is not where it was in the structure's frame, and
    bent       it is not the same geometry, moved and turned as a whole
    drift      root mean square of all changes from the first guesses, each in units of its own scale
    sizes      sizes that were written and had to change
    missed     constraints that do not hold as the program means them
    is_other   the problem solved is not that of the full solver
    """

    program: str
    thing: str
    way: str
    status: str
    seconds: float = 0.0
    parts: int = 0
    disturbed: int = 0
    bent: int = 0
    drift: float = 0.0
    sizes: int = 0
    missed: int = 0
    is_other: bool = False


def recorded(place: Path) -> list[tuple[SourceFile, str]]:
    """Returns the programs in AIDL of a recording, each with what it draws. Raises RecordingError."""
    from aidl_eval import recordings
    from aidl_eval.plan import VARIANTS
    from aidl_lang.tools.llm.aidl import Aidl
    from aidl_lang.tools.llm.messages import find_program

    found: list[tuple[SourceFile, str]] = []
    for conversation in recordings.load(place):
        job, language = conversation.job, VARIANTS[conversation.job.variant]
        if isinstance(language, Aidl):
            for number, reply in enumerate(conversation.replies, 1):
                program, _ = find_program(reply.text, language.fences, language.reads)
                if program is not None:
                    found.append((SourceFile(f"{job.key}, reply {number}", program), job.prompt))
    if not found:
        why = f"`{place}` holds no program in AIDL"
        raise recordings.RecordingError("E0994", why, "--solver is for programs in AIDL and its subsets")
    return found


def compare(source: SourceFile, world: World | None = None, thing: str = "") -> Iterator[Solved]:
    """Yields the solves of a program in every way; for a wrong program one with the status `wrong`."""
    names = source.name, thing or source.name
    program, found = pipeline.front(source, world, _SETTINGS)
    meant = None if any(d.is_error for d in found) else _built(program)
    if meant is None:
        yield Solved(*names, FULL, WRONG)
        return
    for name, way in WAYS.items():
        built = _built(program, whole_boxes=True) if way.whole_boxes else meant
        if built is None:
            yield Solved(*names, name, WRONG)
        else:
            status, seconds, values, sizes = _solve(built, way)
            if is_other := built.is_other(meant):
                values = _carried(values, built, meant)
            solved = Solved(*names, name, status, seconds, sizes=sizes, is_other=is_other)
            yield _measured(solved, meant, values)


@dataclass(frozen=True)
class _Built:
    model: Model
    lowered: Lowered

    @property
    def problem(self) -> Problem:
        return self.lowered.problem

    def is_other(self, one: _Built) -> bool:
        """Tells whether what is to hold is not the same."""
        mine, its = self.problem.tape, one.problem.tape
        return not (
            np.array_equal(mine.ops, its.ops)
            and np.array_equal(mine.operands, its.operands)
            and np.array_equal(mine.constants, its.constants, equal_nan=True)
        )


def _built(program: Program, whole_boxes: bool = False) -> _Built | None:
    """Returns what a program builds; None if it is wrong."""
    built = interpret(program, {}, _SETTINGS.building, whole_boxes=whole_boxes)
    return None if any(d.is_error for d in built.diagnostics) else _Built(built.model, lower(built.model))


def _solve(built: _Built, way: Way) -> tuple[str, float, Floats, int]:
    """Returns the status, the seconds of the processor, the values, and how many sizes gave way."""
    settings = replace(
        _SETTINGS.solving,
        stages=way.stages,
        pruning=way.pruning,
        together=way.together,
        seconds=_SECONDS,
        explain=False,
    )
    seconds: list[float] = []
    while len(seconds) < _TIMES and max(seconds, default=0.0) <= _QUICK:
        begun = time.process_time()
        solution = solve(built.problem, settings)
        seconds.append(time.process_time() - begun)
    return str(solution.status), min(seconds), solution.values, len(solution.changed)


def _carried(values: Floats, built: _Built, meant: _Built) -> Floats:
    """Returns values of one problem of a program as those of the other. The program makes the unknowns of
    both in the same order, as what it builds hangs on no comparison of boxes.
    """
    at = {unknown: number for number, unknown in enumerate(built.model.unknowns)}
    known = {at[u]: value for u, value in zip(built.lowered.unknowns, values.tolist(), strict=True)}
    order = {unknown: number for number, unknown in enumerate(meant.model.unknowns)}
    return np.array([known.get(order[u], u.guess) for u in meant.lowered.unknowns])


def _measured(solved: Solved, meant: _Built, values: Floats) -> Solved:
    problem = meant.problem
    change = (values - problem.initial) / problem.scale
    before, after = Evaluator({}), Evaluator(dict(zip(meant.lowered.unknowns, values.tolist(), strict=True)))
    drawn = [(was, _drawn(s, after)) for s in meant.model.root.walk() if len((was := _drawn(s, before))[0])]
    return replace(
        solved,
        parts=len(drawn),
        disturbed=sum(_is_disturbed(*each) for each in drawn),
        bent=sum(_is_bent(*each) for each in drawn),
        drift=round(float(np.sqrt(np.mean(change**2))), _DIGITS) if len(change) else 0.0,
        missed=_missed(problem, values),
    )


_Drawn = tuple[Floats, Floats]
"""The points of a structure's own geometry in its frame, as complex numbers, and its other numbers."""


def _drawn(s: Structure, number: Evaluator) -> _Drawn:
    """Returns the geometry of a structure itself; the box of an empty one from its corner on, as that is
    placed as a frame is.
    """
    found = [tuple(map(number, at)) for _, _, at in seen(s)]
    if s.plan:
        *_, width, height = map(number, s.plan)
        return np.array([0.0, width, 1j * height]), np.zeros(0)
    points = [complex(*at) for at in found if len(at) == 2]
    return np.array(points, dtype=complex), np.array([at[0] for at in found if len(at) == 1])


def _is_disturbed(was: _Drawn, now: _Drawn) -> bool:
    return any(bool((np.abs(b - a) > _MOVED).any()) for a, b in zip(was, now, strict=True))


def _is_bent(was: _Drawn, now: _Drawn) -> bool:
    """Tells whether no move and turn of the whole leads from one to the other. A number may stay, or, if it
    is an angle, turn along.
    """
    a, b = (points - points.mean() for points in (was[0], now[0]))
    turn = float(np.angle(np.vdot(a, b)))  # that after which the points lie nearest
    change = now[1] - was[1]
    left = (change - np.degrees(turn) + 180.0) % 360.0 - 180.0
    apart = np.abs(b - a * np.exp(1j * turn)), np.minimum(np.abs(change), np.abs(left))
    return any(bool((each > _MOVED).any()) for each in apart)


def _missed(problem: Problem, values: Floats) -> int:
    """Returns how many constraints of a problem do not hold."""
    rows, off = problem.rows, violations(problem, Schedule(problem.tape).evaluate(values))
    is_off = ~(off <= _SETTINGS.solving.tolerance * rows.scale) & np.isnan(problem.weight[rows.constraint])
    return len(np.unique(rows.constraint[is_off]))

"""What the stages of the solver are worth: programs solved by each way of freeing unknowns. Asks no model."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import has_errors
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.interp import interpret
from aidl_lang.solver import solve
from aidl_lang.solver.settings import Stages

if TYPE_CHECKING:
    from aidl_lang.solver.problem import Problem
    from aidl_lang.solver.solution import Solution

MEANINGS = {
    Stages.FULL: "the solver as it is",
    Stages.PAPER: "the paper's: own geometry, translations level by level, then all else; no size is kept",
    Stages.LEVEL: "no preference for translations over the geometry of what lies deeper",
    Stages.FLAT: "all constraints as one system, with everything free at once",
}
_MOVED = 1e-6
"""Change, in units of an unknown's scale, up to which it is where it was."""
_TIMES = 3
"""Solves of which the quickest counts."""


@record()
class Solved:
    """The solve of one program in one way.

    disturbed  structures whose own geometry changed in their frame, of `parts`; to be moved as a whole does
               not count
    drift      root mean square of all changes from the first guesses, each in units of its own scale
    sizes      sizes that were written and had to change
    """

    program: str
    stages: Stages
    status: str
    seconds: float
    parts: int = 0
    disturbed: int = 0
    drift: float = 0.0
    sizes: int = 0


def compare(source: SourceFile, world: World | None = None) -> Iterator[Solved]:
    """Yields the solves of a program in every way; for a wrong program one with the status `wrong`."""
    from aidl_lang.building.lower import lower

    settings = pipeline.Settings()
    program, found = pipeline.front(source, world, settings)
    if not has_errors(found):
        built = interpret(program, {}, settings.building)
        found = [*found, *built.diagnostics]
    if has_errors(found):
        yield Solved(source.name, Stages.FULL, "wrong", 0.0)
        return
    problem = lower(built.model).problem
    for stages in MEANINGS:
        chosen = replace(settings.solving, stages=stages, explain=False)
        seconds, solutions = [], []
        for _ in range(_TIMES):
            begun = time.perf_counter()
            solutions.append(solve(problem, chosen))
            seconds.append(time.perf_counter() - begun)
        yield _told(source.name, stages, problem, solutions[0], min(seconds))


def _told(name: str, stages: Stages, problem: Problem, solution: Solution, seconds: float) -> Solved:
    change = (solution.values - problem.initial) / problem.scale
    is_geometry = problem.frame_of < 0
    moved = (np.abs(change) > _MOVED) & is_geometry
    return Solved(
        name,
        stages,
        str(solution.status),
        seconds,
        parts=len(np.unique(problem.group[is_geometry])),
        disturbed=len(np.unique(problem.group[moved])),
        drift=float(np.sqrt(np.mean(change**2))) if len(change) else 0.0,
        sizes=len(solution.changed),
    )


def markdown(solves: Sequence[Solved]) -> str:
    """Returns a table of all solves, and one of the ways over the programs that all of them solve."""
    lines = [
        "| program | stages | status | seconds | parts disturbed | drift | sizes changed |",
        f"|{7 * '---|'}",
    ]
    for s in solves:
        if s.status == "wrong":
            lines.append(f"| {s.program} | | wrong | | | | |")
            continue
        lines.append(
            f"| {s.program} | {s.stages.value} | {s.status} | {s.seconds:.3f} | {s.disturbed} of {s.parts} "
            f"| {s.drift:.3g} | {s.sizes} |"
        )
    return "\n".join([*lines, "", *_totals(solves), "", *_meanings()]) + "\n"


def _totals(solves: Sequence[Solved]) -> Iterator[str]:
    asked = dict.fromkeys(s.program for s in solves if s.status != "wrong")
    failing = {s.program for s in solves if s.status != "solved"}
    fair = [name for name in asked if name not in failing]
    yield "| stages | solved | seconds | parts disturbed | drift | sizes changed |"
    yield f"|{6 * '---|'}"
    for stages in MEANINGS:
        own = [s for s in solves if s.stages is stages and s.status != "wrong"]
        both = [s for s in own if s.program in fair]
        done = sum(s.status == "solved" for s in own)
        told = f"| {stages.value} | {done} of {len(own)} "
        if both:
            share = sum(s.disturbed for s in both) / max(1, sum(s.parts for s in both))
            drift = float(np.mean([s.drift for s in both]))
            seconds, sizes = sum(s.seconds for s in both), sum(s.sizes for s in both)
            told += f"| {seconds:.3f} | {100 * share:.0f} % | {drift:.3g} | {sizes} |"
        else:
            told += "| | | | |"
        yield told
    yield ""
    yield f"All but `solved` are over the {len(fair)} programs of {len(asked)} that every way solves."


def _meanings() -> Iterator[str]:
    yield from (f"- `{stages.value}`: {meaning}" for stages, meaning in MEANINGS.items())

"""The solver's parts put to the test: programs are solved without one of them, or in another order. Asks no
model.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from aidl_eval import recordings, table
from aidl_eval.plan import VARIANTS
from aidl_eval.statistics import RESAMPLES, Floats
from aidl_eval.summary import Figure, Mean, Row, Share, pairs
from aidl_lang import SourceFile, pipeline
from aidl_lang.building.expression import Evaluator
from aidl_lang.building.lower import lower, seen
from aidl_lang.building.model import Structure
from aidl_lang.common.world import World
from aidl_lang.interp import interpret
from aidl_lang.solver import Problem, Settings, Solution, Stages, solve
from aidl_lang.tools.llm.aidl import Aidl
from aidl_lang.tools.llm.messages import find_program

FULL = "full"
WRONG = "wrong"
WAYS: Mapping[str, Mapping[str, Any]] = {
    FULL: {},
    "in-turn": {"together": False},
    "paper": {"together": False, "stages": Stages.PAPER},
    "level": {"together": False, "stages": Stages.LEVEL},
    "flat": {"together": False, "stages": Stages.FLAT},
    "no-pruning": {"together": False, "pruning": False},
}
"""All ways to solve, by what is other than usual; `eval/README.md` tells what each is."""

_MOVED = 1e-5
"""Change in mm, or in degrees, up to which all is as it was; far above the solver's tolerance."""
_TIMES = 3
"""Solves of which the quickest counts, where the first was quick."""
_QUICK = 1.0
_DIGITS = 6
"""Of a drift; further ones are the solver's tolerance."""
_SECONDS = 120.0
"""The most for one solve: six times the usual, so that no slow way is cut off near its end."""


@dataclass(frozen=True)
class Solved:
    """The solve of one program in one way.

    thing      what is drawn: programs of one thing are alike
    parts      structures that draw something themselves, of which
    disturbed  own geometry is not where it was in the structure's frame
    drift      root mean square of all changes from the first guesses, each in units of its own scale
    sizes      sizes that were written and had to change
    """

    program: str
    thing: str
    way: str
    status: str
    seconds: float = 0.0
    parts: int = 0
    disturbed: int = 0
    drift: float = 0.0
    sizes: int = 0


def recorded(place: Path) -> list[tuple[SourceFile, str]]:
    """Returns the programs in AIDL of a recording, each with what it draws. Raises RecordingError."""
    found: list[tuple[SourceFile, str]] = []
    for job, conversation in recordings.load(place).items():
        language = VARIANTS[job.variant]
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
    settings = pipeline.Settings()
    program, found = pipeline.front(source, world, settings)
    built = None if any(d.is_error for d in found) else interpret(program, {}, settings.building)
    if built is None or any(d.is_error for d in built.diagnostics):
        yield Solved(*names, FULL, WRONG)
        return
    problem, structures = lower(built.model), list(built.model.root.walk())
    before = [_drawn(s, Evaluator({})) for s in structures]
    for name, way in WAYS.items():
        solution, seconds = _timed(problem, replace(settings.solving, seconds=_SECONDS, explain=False, **way))
        after = Evaluator(problem.by_unknown(solution.values))
        drawn = [(was, _drawn(s, after)) for s, was in zip(structures, before, strict=True) if len(was[0])]
        change = (solution.values - problem.initial) / problem.scale
        drift = round(float(np.sqrt(np.mean(change**2))), _DIGITS) if len(change) else 0.0
        disturbed = sum(_is_disturbed(was, now) for was, now in drawn)
        status, sizes = str(solution.status), len(solution.changed)
        yield Solved(*names, name, status, seconds, len(drawn), disturbed, drift, sizes)


def _timed(problem: Problem, settings: Settings) -> tuple[Solution[Problem], float]:
    """Returns the solution and the seconds of the processor for it."""
    seconds: list[float] = []
    while len(seconds) < _TIMES and max(seconds, default=0.0) <= _QUICK:
        begun = time.process_time()
        solution = solve(problem, settings)
        seconds.append(time.process_time() - begun)
    return solution, min(seconds)


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


# --- Ways compared, as Markdown: programs, means with intervals, differences to `full`.

_FIGURES = ("solved", "milliseconds", "disturbed", "drift", "sizes")


def markdown(solves: Sequence[Solved]) -> str:
    """Returns a table of all solves, one of the ways over the programs that all of them solve, and one of
    their differences to the full solver.
    """
    tried = [s for s in solves if s.status != WRONG]
    failing = {s.program for s in tried if s.status != "solved"}
    fair = [s for s in tried if s.program not in failing]
    rows = [_row([s for s in tried if s.way == way], [s for s in fair if s.way == way], way) for way in WAYS]
    differing = [
        pair
        for pair in pairs(rows, _FIGURES, FULL)
        if pair.comparison.difference or any(pair.comparison.interval or ())
    ]
    things = len({s.thing for s in fair})
    parts = [
        "# Ways to solve",
        table.tabulated([["program", "way", "status", *_FIGURES[1:]], *map(_line, solves)]),
        "## Means",
        f"All but `solved` are over the {len(fair) // len(WAYS)} programs of {len(tried) // len(WAYS)} that "
        f"every way solves; they draw {things} things. In square brackets 95 % intervals by drawing things "
        f"with replacement, with all programs of each ({RESAMPLES:,} resamples); after ± the standard "
        "deviation; in round brackets what figures are taken over.",
        table.tabulated(
            [["way", *_FIGURES], *([r.variant, *map(table.shown, r.figures.values())] for r in rows)]
        ),
        f"## Less `{FULL}`",
        "By thing: each counts once (1.00 is 100 %). Two-sided p of the paired permutation test; Holm's "
        "correction is for the ways compared in one figure. Where no line is, there is no difference in any "
        "thing.",
        table.compared(differing, "ways", "things"),
    ]
    return "\n\n".join(parts) + "\n"


def _row(tried: Sequence[Solved], fair: Sequence[Solved], way: str) -> Row:
    figures: Mapping[str, Figure] = {
        "solved": Share.of(((s.thing, int(s.status == "solved"), 1) for s in tried), several=True),
        "milliseconds": Mean.of((s.thing, 1000.0 * s.seconds) for s in fair),
        "disturbed": Share.of(((s.thing, s.disturbed, s.parts) for s in fair), several=True),
        "drift": Mean.of((s.thing, s.drift) for s in fair),
        "sizes": Mean.of((s.thing, s.sizes) for s in fair),
    }
    return Row(way, None, len(tried), 0, figures)


def _line(s: Solved) -> list[str]:
    if s.status == WRONG:
        return [s.program, s.way, s.status, *[""] * (len(_FIGURES) - 1)]
    numbers = f"{1000.0 * s.seconds:.1f}", f"{s.disturbed} of {s.parts}", f"{s.drift:.3g}", str(s.sizes)
    return [s.program, s.way, s.status, *numbers]

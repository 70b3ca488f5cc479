"""The solver's parts put to the test: programs are solved without one of them, or in another order. Asks no
model.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from aidl_eval import table
from aidl_eval.statistics import RESAMPLES, Floats
from aidl_eval.summary import Figure, Mean, Pair, Row, Share, pairs
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
    problem: Lowered

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
    known = {at[u]: value for u, value in zip(built.problem.unknowns, values.tolist(), strict=True)}
    order = {unknown: number for number, unknown in enumerate(meant.model.unknowns)}
    return np.array([known.get(order[u], u.guess) for u in meant.problem.unknowns])


def _measured(solved: Solved, meant: _Built, values: Floats) -> Solved:
    problem = meant.problem
    change = (values - problem.initial) / problem.scale
    before, after = Evaluator({}), Evaluator(problem.by_unknown(values))
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
    rows, off = problem.rows, violations(problem, Schedule(problem.tape).evaluate(values))
    is_off = ~(off <= _SETTINGS.solving.tolerance * rows.scale) & np.isnan(problem.weight[rows.constraint])
    return len(np.unique(rows.constraint[is_off]))


# --- Ways compared, as Markdown and CSV: programs, means with intervals, differences to `full`.

_ALL = "solved"
"""The one figure that is over all programs."""
_MEANINGS = {
    _ALL: "programs all of whose constraints hold, of those that are no error",
    "milliseconds": "of the processor, for a program; the quickest of three solves if the first was quick",
    "disturbed": "structures whose own geometry is not where it was in their frame, of those that draw",
    "bent": "structures whose own geometry is another, however it is moved and turned as a whole",
    "drift": "root mean square of all changes from the first guesses, in mm; a turn counts as what it "
    "moves at the size of the drawing",
    "sizes": "written sizes that had to change, of a program",
    "missed": "constraints of a program that do not hold as it means them",
}


def markdown(solves: Sequence[Solved]) -> str:
    """Returns a table of all solves, one of the ways over the programs that all of them solve, and one of
    their differences to the full solver.
    """
    fair, tried = _fair(solves), [s for s in solves if s.way == FULL and s.status != WRONG]
    things = len(dict.fromkeys(s.thing for s in fair if s.way == FULL))
    means = [[row.variant, *(table.shown(row.figures[name]) for name in _MEANINGS)] for row in _rows(solves)]
    parts = [
        "# Ways to solve",
        table.tabulated([["program", "way", "status", *list(_MEANINGS)[1:]], *map(_line, solves)]),
        "## Means",
        f"All but `{_ALL}` are over the {len(fair) // len(WAYS)} programs of {len(tried)} that every way "
        f"solves; they draw {things} things. In square brackets 95 % intervals by drawing things with "
        f"replacement, with all programs of each ({RESAMPLES:,} resamples); after ± the standard deviation; "
        "in round brackets what figures are taken over.",
        table.tabulated([["way", *_MEANINGS], *means]),
        f"## Less `{FULL}`",
        "By thing: each counts once (1.00 is 100 %). Two-sided p of the paired permutation test; Holm's "
        "correction is for the ways compared in one figure. Where no line is, there is no difference in any "
        "thing.",
        table.compared([p for p in _pairs(solves) if _do_differ(p)], "ways", "things"),
        "## What the words mean",
        "\n".join(_meanings(solves)),
    ]
    return "\n\n".join(parts) + "\n"


def to_csv(solves: Sequence[Solved]) -> str:
    """Returns one line for each figure of each way, over all programs and for each, then the differences."""
    each = [_row_of(s.way, [s], [s], s.program) for s in solves if s.status != WRONG]
    return table.to_csv([*_rows(solves), *each], _pairs(solves))


def _fair(solves: Sequence[Solved]) -> list[Solved]:
    failing = {s.program for s in solves if s.status != "solved"}
    return [s for s in solves if s.program not in failing]


def _rows(solves: Sequence[Solved]) -> list[Row]:
    fair, of_error = _fair(solves), {s.program for s in solves if s.way == FULL and s.status == WRONG}
    tried = [s for s in solves if s.program not in of_error]
    return [
        _row_of(way, [s for s in tried if s.way == way], [s for s in fair if s.way == way]) for way in WAYS
    ]


def _row_of(way: str, tried: Sequence[Solved], fair: Sequence[Solved], program: str | None = None) -> Row:
    figures: Mapping[str, Figure] = {
        _ALL: Share.of(((s.thing, int(s.status == "solved"), 1) for s in tried), several=True),
        "milliseconds": Mean.of((s.thing, 1000.0 * s.seconds) for s in fair),
        "disturbed": Share.of(((s.thing, s.disturbed, s.parts) for s in fair), several=True),
        "bent": Share.of(((s.thing, s.bent, s.parts) for s in fair), several=True),
        "drift": Mean.of((s.thing, s.drift) for s in fair),
        "sizes": Mean.of((s.thing, s.sizes) for s in fair),
        "missed": Mean.of((s.thing, s.missed) for s in fair),
    }
    return Row(way, program, len(tried), 0, figures)


def _pairs(solves: Sequence[Solved]) -> list[Pair]:
    return pairs(_rows(solves), _MEANINGS, FULL)


def _do_differ(pair: Pair) -> bool:
    found = pair.comparison
    return found.difference != 0.0 or found.interval not in (None, (0.0, 0.0))


def _line(s: Solved) -> list[str]:
    if s.status == WRONG:
        return [s.program, s.way, s.status, *[""] * (len(_MEANINGS) - 1)]
    of = (f"{count} of {s.parts}" for count in (s.disturbed, s.bent))
    numbers = (f"{1000.0 * s.seconds:.1f}", *of, f"{s.drift:.3g}", str(s.sizes), str(s.missed))
    return [s.program, s.way, s.status, *numbers]


def _meanings(solves: Sequence[Solved]) -> Iterator[str]:
    yield from (f"- {name}: {meaning}" for name, meaning in _MEANINGS.items())
    yield from (f"- `{name}`: {way.meaning}" for name, way in WAYS.items())
    for name, way in WAYS.items():
        own = [s for s in solves if s.way == name and s.status != WRONG]
        if way.whole_boxes:
            others = sum(s.is_other for s in own)
            yield f"- The problem of `{name}` is another one in {others} of {len(own)} programs."

"""Rereads ambiguous calls of programs that do not solve as their first guesses have them, or solves from
another place.

Which angle between two lines is meant, and on which side a circle touches, is read off the first guesses.
Before anything is refused, and before a size changes much, the calls that take part are tried the other ways.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from aidl_lang.building.expression import Evaluator, Unknown, unknowns
from aidl_lang.building.lower import Lowered, lower
from aidl_lang.building.model import Constraint, Model
from aidl_lang.checking.units import UNITS
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.prose import listed, named, short, ticked
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.explaining.failures import NAMED
from aidl_lang.explaining.trials import Trials
from aidl_lang.interp import Interpretation
from aidl_lang.solver import Settings, Solution, Status, solve
from aidl_lang.solver.conflicts import nearby_solution
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.problem import Failure
from aidl_lang.syntax import ast

_MOST = 64
"""The most ways that are tried."""
_RANKS = (1, 2, 3)
"""Ranks by distance of the readings that are tried, after the nearest."""
_SECONDS, _LONGEST = 4.0, 0.2
"""Time after which no other way is begun, and for one: what solves does so soon."""
_MUCH = 0.1
"""Relative change of a size above which other readings are tried."""
_STILL = 1e-6
_DIGITS = (2, 3, 6)
_LOOK = "look whether this is how it is meant"


@record()
class Rereading:
    """A program that solved with ambiguous calls read differently; `calls` are their places and readings."""

    built: Interpretation
    lowered: Lowered
    solution: Solution
    calls: tuple[tuple[Span, str], ...]


def reread(
    built: Interpretation,
    lowered: Lowered,
    solution: Solution,
    again: Callable[[Mapping[int, int]], Interpretation | None],
    settings: Settings,
) -> tuple[Rereading | None, Solution]:
    """Returns the program with ambiguous calls read so that it solves and nothing dear gives way (None if it
    does so as it is, or no such reading was found), and the solution as it is: a conflict of such calls is no
    contradiction in it unless every reading was tried.
    """
    readings = list(built.model.readings)
    troubled = _troubled(lowered, solution) if readings and settings.explain else ()
    if not troubled:
        return None, solution
    clock, seen = Clock(_SECONDS), [readings]
    quick = replace(settings, explain=False, seconds=min(settings.seconds, _LONGEST))
    near = _numbers(readings, lowered, troubled)
    far = _numbers(readings, lowered, {i for failure in solution.failures for i in failure.within})
    for turned in _ways([*near, *(n for n in far if n not in near)]):
        if clock.expired or len(seen) > _MOST:
            return None, _undecided(lowered, solution, readings)
        other = again(turned)
        if other is None or (taken := list(other.model.readings)) in seen:
            continue
        seen.append(taken)
        made = lower(other.model)
        places = ((f.conflict, dict(f.nearest)) for f in solution.failures)  # by number, the same as before
        if any(nearby_solution(made.problem, quick, *place) is None for place in places):
            continue  # which is known sooner than by solving
        found = solve(made.problem, quick)
        if found.status is Status.SOLVED and not any(stage.concession for stage in found.stages):
            calls = tuple(taken[n] for n in turned if n < len(taken))
            return Rereading(other, made, found, calls), solution
    return None, solution


def _numbers(readings: Sequence[tuple[Span, str]], lowered: Lowered, indices: Iterable[int]) -> list[int]:
    spans = {c.span for i in indices if (c := lowered.stated[i]) is not None}
    return [n for n, (span, _) in enumerate(readings) if any(map(span.overlaps, spans))]


def _ways(numbers: Sequence[int]) -> Iterator[dict[int, int]]:
    """Yields changes of readings, as ranks by number: of one reading, of two, and so on."""
    for count in range(1, len(numbers) + 1):
        for chosen in itertools.combinations(numbers, count):
            for ranks in itertools.product(_RANKS, repeat=count):
                yield dict(zip(chosen, ranks, strict=True))


def _undecided(lowered: Lowered, solution: Solution, readings: Sequence[tuple[Span, str]]) -> Solution:
    """Returns the solution with failures that ambiguous calls have a share in no longer counted as proven."""
    failures = tuple(
        replace(f, reason=Failure.NOT_CONVERGED) if _numbers(readings, lowered, f.conflict) else f
        for f in solution.failures
    )
    return replace(solution, failures=failures)


def _troubled(lowered: Lowered, solution: Solution) -> Collection[int]:
    """Returns the constraints that take part in a failure, or that made a size change much."""
    found = {i for failure in solution.failures for i in failure.conflict}
    for stage in solution.stages:
        for unknown in stage.concession.unknowns if stage.concession is not None else ():
            was, now = lowered.problem.initial[unknown], solution.values[unknown]
            if lowered.problem.kept[unknown] and abs(now - was) > _MUCH * abs(was):
                assert stage.concession is not None
                found.update(stage.concession.constraints)
    return found


def elsewhere_notes(
    model: Model, lowered: Lowered, solution: Solution, other: Rereading | None, trials: Trials
) -> Iterator[Diagnostic]:
    """Yields notes, with fitting first guesses, on calls read differently and on places found far off."""
    if solution.status is not Status.SOLVED:
        return
    if other is not None:
        spans = [span for span, _ in other.calls]
        moved = [c for c in lowered.stated if c is not None and any(map(c.span.overlaps, spans))]
        names = listed(ticked(span.one_line for span in spans), NAMED)
        are = "are" if len(spans) > 1 else "is"
        message = f"{names} {are} not taken as the first guesses have it, for which no position was found"
        (first, label), *others = other.calls
        labels = tuple(Label(span, text) for span, text in others)
        fix = _guesses(model, lowered, solution, moved, trials)
        yield Diagnostic("N0604", message, first, label, labels, (_LOOK,), fix)
    for stage in solution.stages:
        despite = [c for i in stage.despite if (c := lowered.stated[i]) is not None]
        if despite:
            names = named((c.text for c in despite), NAMED)
            hold = "hold" if len(despite) > 1 else "holds"
            first, *rest = dict.fromkeys(c.span for c in despite)
            message = f"near the first guesses no position was found in which {names} {hold}; another one was"
            labels = tuple(Label(span, "takes part") for span in rest)
            fix = _guesses(model, lowered, solution, despite, trials)
            yield Diagnostic("N0604", message, first, "holds elsewhere", labels, (_LOOK,), fix)


def _guesses(
    model: Model, lowered: Lowered, solution: Solution, stated: Sequence[Constraint], trials: Trials
) -> Fix | None:
    """Returns a fix that writes first guesses from which the program solves as written; or None."""
    places = dict(zip(lowered.unknowns, solution.values.tolist(), strict=True))
    was = dict(zip(lowered.unknowns, lowered.problem.initial.tolist(), strict=True))
    mentioned = set(unknowns(e for c in stated for part in c.comparisons for e in (part.left, part.right)))
    everything = {u for u in places if abs(places[u] - was[u]) > _STILL}
    evaluate = Evaluator(places)
    for moved, digits in itertools.product((everything & mentioned, everything), _DIGITS):
        edits: dict[Span, set[str]] = {}
        for literal in model.literals:
            if isinstance(literal.became.payload, Unknown) and literal.became.payload in moved:
                text = _text(literal.node, evaluate(literal.became), digits)
                edits.setdefault(literal.node.span, set()).add(text)
        written = tuple(Edit(span, text) for span, (text, *more) in edits.items() if not more)
        if written and trials.settles(written):
            return Fix("write first guesses that are near to it", written)
    return None


def _text(node: ast.Expression, value: float, digits: int) -> str:
    number = node.operand if isinstance(node, ast.Unary) else node
    unit = number.unit if isinstance(number, ast.Number) and number.unit else ""
    return f"{short(float(f'{value / (UNITS[unit][0] if unit else 1.0):.{digits}g}'))}{unit}"

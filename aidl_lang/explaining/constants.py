"""Numbers that would fit where a condition over constants does not hold (E0513, E0604).

Such a condition is put to the solver like any other, as a conflict of one statement; what is told of
conflicts, numbers that were tried as they are printed, can then be told of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from aidl_lang.building.lower import Lowered
from aidl_lang.building.model import Constraint
from aidl_lang.building.wording import Wording
from aidl_lang.common.diagnostics import Diagnostic, Label
from aidl_lang.common.source import Span
from aidl_lang.explaining.givens import Dial, exact_numbers, written_numbers
from aidl_lang.explaining.remedies import Remedy, RemedySearch, remedies
from aidl_lang.explaining.trials import Trials, mends
from aidl_lang.solver import Solution
from aidl_lang.solver.solution import Failure, GroupFailure, Member

NEVER, _ASSERTED = "E0513", "E0604"
_CODES = frozenset({NEVER, _ASSERTED})
_MOST = 0.5
"""Greatest relative change of a number that is offered as a fix: a greater one is mentioned only."""
_PLACES = 5
"""The most places that a message shows beside its own."""


def with_failing_constants(lowered: Lowered, solution: Solution) -> Solution:
    """Returns the solution of a problem of constants; each constraint that fails is a failure."""
    found = []
    for index, stated in enumerate(lowered.stated):
        sides = (side for part in stated.comparisons for side in (part.left, part.right)) if stated else ()
        if stated and not solution.satisfied[index] and all(side.is_constant for side in sides):
            group, member = int(lowered.problem.holder[index]), Member(index, solution.residuals[index])
            found.append(GroupFailure(group, Failure.CONTRADICTORY, (member,), minimal=True, within=(index,)))
    return replace(solution, failures=tuple(found))


def with_remedies(
    found: Sequence[Diagnostic], everything: Sequence[Diagnostic], trials: Trials
) -> list[Diagnostic]:
    """Returns findings about a program, those on constants with what would fit instead; `everything` are all
    findings about it. The trials are those of the program that states constants, with the solution made by
    `with_failing_constants`.
    """
    failures: dict[Span, tuple[Constraint, GroupFailure]] = {}
    for failure in trials.solution.failures:
        stated = trials.lowered.stated[failure.conflict[0]]
        if stated is not None:
            failures.setdefault(stated.span, (stated, failure))
    return [
        _answered(d, *failures[d.span], everything, trials)
        if d.code in _CODES and d.fix is None and d.span in failures
        else d
        for d in found
    ]


def _answered(
    d: Diagnostic, stated: Constraint, failure: GroupFailure, everything: Sequence[Diagnostic], trials: Trials
) -> Diagnostic:
    """Returns a finding with numbers that fit where its values are given, and the least change of these as
    the fix. If there are none, names a number that fits in a constraint; an `assert` is not up for change.
    """
    wording = stated.wording
    if not isinstance(wording, Wording) or wording.node.span != stated.span:
        return d

    def fitting(dials: Sequence[Dial]) -> Iterator[Remedy]:
        searches = (RemedySearch(dial, failure, trials, dial.place) for dial in dials if not dial.is_factor)
        return (each for each in remedies(searches) if mends(d, each.fix, everything, trials))

    uses = wording.it.program.resolution.uses
    given = sorted(fitting(exact_numbers([wording.node], uses)), key=lambda each: (each.counts, each.share))
    if given:
        labels = d.secondary
        for each in given:
            labels = _with(labels, each)
        fix = given[0].fix if given[0].share <= _MOST else None
        return replace(d, secondary=labels[:_PLACES], fix=fix)
    dials = written_numbers(wording.node) if d.code == NEVER else []
    if (own := next(fitting(dials), None)) is None:
        return d
    return replace(d, label="; ".join(filter(None, (d.label, own.would_fit(len(dials))))))


def _with(labels: tuple[Label, ...], found: Remedy) -> tuple[Label, ...]:
    """Returns the labels, with what would fit in place of a number added to one of them or as a new one."""
    place, text = found.dial.place, found.would_fit()
    for index, label in enumerate(labels):
        if found.dial.name and label.span.overlaps(place):
            return *labels[:index], replace(label, text=f"{label.text}; {text}"), *labels[index + 1 :]
    return *labels, Label(place, f"exact; {text}")

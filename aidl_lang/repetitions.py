"""What is said of constraints that follow from others, and of parts of which that could not be told."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

import numpy as np

from aidl_lang.building.wording import Wording
from aidl_lang.diagnostics import Diagnostic, Fix, Label
from aidl_lang.lower import Lowered
from aidl_lang.model import Constraint
from aidl_lang.remedies import left_out
from aidl_lang.solver import Settings, Solution, solve
from aidl_lang.solver.analysis import Freedom
from aidl_lang.solver.redundancy import Redundancy
from aidl_lang.source import Span

_NAMED = 4
"""Constraints that are named in the headline."""
_LARGEST = 2000
"""Unknowns of a model that is solved again to see whether a constraint can be left out."""
_SAME = 1e-6
"""Change of a value, in units of its scale, that counts as none."""


def preference(lowered: Lowered) -> list[int]:
    """The constraints in the order in which they are taken for granted: unwritten ones, then as written."""

    def place(index: int) -> tuple[bool, str, int, int]:
        stated = lowered.stated[index]
        if stated is None:
            return (False, "", 0, index)
        return (stated.wording is not None, stated.span.source.name, stated.span.start, index)

    return sorted(range(len(lowered.stated)), key=place)


def repetition_notes(lowered: Lowered, solution: Solution, freedom: Freedom) -> list[Diagnostic]:
    """A note for each stated constraint that follows from others, and for each part that is undecided."""
    redundant = [found for found in freedom.redundant if _stated(lowered, found.constraint)]
    times = Counter(stated.span for stated in lowered.stated if stated is not None)
    can_go = [found.constraint for found in redundant if _is_single(lowered.stated[found.constraint], times)]
    if not _changes_nothing(lowered, solution, can_go):
        can_go = []
    notes = [_note(lowered, found, found.constraint in can_go) for found in redundant]
    return [*notes, *_undecided(lowered, freedom)]


def _stated(lowered: Lowered, index: int) -> Constraint | None:
    """The constraint if somebody wrote it."""
    stated = lowered.stated[index]
    return stated if stated is not None and stated.wording is not None else None


def _note(lowered: Lowered, found: Redundancy, can_go: bool) -> Diagnostic:
    stated = lowered.stated[found.constraint]
    assert stated is not None
    others = [other for i in found.follows_from if (other := lowered.stated[i]) is not None]
    names = list(dict.fromkeys(_name(other) for other in others))
    if len(names) > _NAMED:
        names = [*names[: _NAMED - 1], f"{len(names) - _NAMED + 1} more"]
    reason = " and ".join(filter(None, [", ".join(names[:-1]), *names[-1:]])) or "the other constraints"
    labels = dict.fromkeys(Label(other.span, "from this") for other in others if other.span != stated.span)
    fix = left_out(stated) if can_go else None
    return Diagnostic(
        "N0602",
        f"{_name(stated)} follows from {reason}",
        stated.span,
        "says nothing new",
        tuple(labels),
        fix=Fix(f"leave out {_name(stated)}", fix.edits) if fix else None,
    )


def _name(stated: Constraint) -> str:
    return f"`{stated.text}` [{stated.label}]" if stated.label else f"`{stated.text}`"


def _is_single(stated: Constraint | None, times: Counter[Span]) -> bool:
    """Whether its place states this constraint and no other: no loop, no template."""
    if stated is None or not isinstance(stated.wording, Wording):
        return False
    return stated.wording.node.span == stated.span and not stated.label and times[stated.span] == 1


def _changes_nothing(lowered: Lowered, solution: Solution, left_out: Sequence[int]) -> bool:
    """Whether the drawing is the same without these constraints: they may have said what moves first."""
    problem = lowered.problem
    if not left_out or len(problem.initial) > _LARGEST:
        return False
    others = [c for i, c in enumerate(problem.constraints) if i not in set(left_out)]
    again = solve(problem.with_constraints(others), Settings(seconds=2.0, explain=False))
    return bool((np.abs(again.values - solution.values) <= _SAME * problem.scale).all())


def _undecided(lowered: Lowered, freedom: Freedom) -> Iterator[Diagnostic]:
    for unknowns in freedom.undecided:
        owner = lowered.unknowns[unknowns[0]].owner
        while any(not lowered.unknowns[u].owner.is_within(owner) for u in unknowns) and owner.parent:
            owner = owner.parent
        yield Diagnostic(
            "N0603",
            f"the degrees of freedom of `{owner.path}` could not be counted",
            owner.span,
            "some of its constraints nearly follow from others, or it is too large to tell",
        )
    unclear = [stated for i in freedom.unclear if (stated := _stated(lowered, i)) is not None]
    if unclear and not freedom.undecided:
        first = min(unclear, key=lambda stated: stated.span.start)
        yield Diagnostic(
            "N0603",
            f"which of {len(unclear)} constraints follow from others could not be told",
            first.span,
            "this is the first of them",
        )

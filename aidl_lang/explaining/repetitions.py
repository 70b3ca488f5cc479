"""Reports constraints that follow from others and parts whose freedom is undecided; tells whether one
constraint follows.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from aidl_lang.building.lower import Lowered
from aidl_lang.building.model import Constraint
from aidl_lang.building.wording import Wording
from aidl_lang.common.diagnostics import Diagnostic, Fix, Label
from aidl_lang.common.prose import listed
from aidl_lang.common.source import Span
from aidl_lang.explaining.remedies import left_out
from aidl_lang.solver import Constraint as SolverConstraint
from aidl_lang.solver import Problem, Relation, Settings, Solution, Status, solve
from aidl_lang.solver.analysis import Freedom, analyse
from aidl_lang.solver.dependence import Redundancy
from aidl_lang.solver.expression import mentioned
from aidl_lang.solver.operations import Op
from aidl_lang.solver.solution import Failure

_NAMED = 4
"""The most constraints that the headline names."""
_LARGEST = 2000
"""The most unknowns of a model that is solved again to see whether a constraint can be left out."""
_SAME = 1e-6
"""Change of a value, in units of its scale, that counts as none."""
_BROKEN = 1e-2
"""Violation of an inequality, in units of its scale, that is tried to see whether others forbid it."""
_TRIED = 20
"""The most inequalities that are tried so, one by one."""
_SECONDS = 1.0
"""Time for each of them."""


def repetition_notes(lowered: Lowered, solution: Solution, freedom: Freedom) -> list[Diagnostic]:
    """Returns a note for each written constraint that follows from others, and each undecided part."""
    redundant = [found for found in freedom.redundant if _stated(lowered, found.constraint)]
    times = Counter(stated.span for stated in lowered.stated if stated is not None)
    can_go = [found.constraint for found in redundant if _is_single(lowered.stated[found.constraint], times)]
    if not _changes_nothing(lowered, solution, can_go):
        can_go = []
    notes = [_note(lowered, found, found.constraint in can_go) for found in redundant]
    return [*notes, *_undecided(lowered, freedom)]


def _stated(lowered: Lowered, index: int) -> Constraint | None:
    stated = lowered.stated[index]
    return stated if stated is not None and stated.wording is not None else None


def _note(lowered: Lowered, found: Redundancy, can_go: bool) -> Diagnostic:
    stated = lowered.stated[found.constraint]
    assert stated is not None
    others = [other for i in found.follows_from if (other := lowered.stated[i]) is not None]
    names = list(dict.fromkeys(_name(other) for other in others))
    reason = listed(names, _NAMED) or "the other constraints"
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
    """Tells whether its place states this constraint and no other: no loop, no template."""
    if stated is None or not isinstance(stated.wording, Wording):
        return False
    return stated.wording.node.span == stated.span and not stated.label and times[stated.span] == 1


def _changes_nothing(lowered: Lowered, solution: Solution, left_out: Sequence[int]) -> bool:
    """Tells whether the solution stays without these constraints, which may decide what moves first."""
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


# --- One constraint ------------------------------------------------------------------------------------


def follows(lowered: Lowered, solution: Solution, span: Span) -> bool:
    """Tells whether the statement at a place of a solved model holds wherever the other constraints hold: an
    equation near by and with sizes kept, as degrees of freedom are counted; an inequality everywhere. Returns
    False as well if that is too costly to decide.
    """
    problem = lowered.problem
    own = {i for i, stated in enumerate(lowered.stated) if stated is not None and stated.span.overlaps(span)}
    hard = [(i, c) for i, c in enumerate(problem.constraints) if c.weight is None or i in own]
    others = [c for i, c in hard if i not in own]
    rows = [replace(c, rows=(row,), weight=None) for i, c in hard if i in own for row in c.rows]
    equations = [c for c in rows if c.rows[0].relation is Relation.EQUAL]
    inequalities = [c for c in rows if c.rows[0].relation is Relation.AT_MOST]
    return (
        len(inequalities) <= _TRIED
        and _are_redundant(problem, solution, others, equations)
        and not any(_can_be_broken(problem, solution, [*others, *equations], c) for c in inequalities)
    )


def _are_redundant(
    problem: Problem,
    solution: Solution,
    others: Sequence[SolverConstraint],
    equations: Sequence[SolverConstraint],
) -> bool:
    """Tells whether equations follow from others while sizes are kept."""
    tape = problem.tape
    is_size = tape.ops == Op.UNKNOWN
    is_size[is_size] = problem.kept[tape.operands[is_size, 0]]
    sizes = np.flatnonzero(is_size)
    ops, operands, constants = tape.ops.copy(), tape.operands.copy(), tape.constants.copy()
    constants[sizes] = solution.values[operands[sizes, 0]]
    ops[sizes], operands[sizes] = Op.CONSTANT, -1
    fixed = replace(tape, ops=ops, operands=operands, constants=constants)
    moving = [c for c in equations if mentioned(fixed, [c.rows[0].expression])]
    known = replace(problem, tape=fixed).with_constraints([*others, *moving])
    count = len(others) + len(moving)
    found = analyse(known, replace(solution, satisfied=(True,) * count)).redundant if moving else ()
    return {each.constraint for each in found} >= set(range(len(others), count))


def _can_be_broken(
    problem: Problem, solution: Solution, others: Sequence[SolverConstraint], inequality: SolverConstraint
) -> bool:
    """Tells whether the others hold where an inequality does not; True, too, if the time runs out."""
    (row,), tape = inequality.rows, problem.tape
    node, level = len(tape), tape.levels[row.expression] + 1
    longer = replace(  # by a difference that is at most zero where the inequality is off
        tape,
        ops=np.append(tape.ops, [Op.CONSTANT, Op.SUB]).astype(tape.ops.dtype),
        operands=np.vstack((tape.operands, [[-1] * 4, [node, row.expression, -1, -1]])).astype(np.int32),
        constants=np.append(tape.constants, [_BROKEN * row.scale, 0.0]),
        levels=np.append(tape.levels, [0, level]).astype(tape.levels.dtype),
    )
    opposite = replace(inequality, rows=(replace(row, expression=node + 1),))
    tried = replace(problem, tape=longer, initial=solution.values).with_constraints([*others, opposite])
    result = solve(tried, Settings(seconds=_SECONDS, explain=False))
    timed_out = any(failure.reason is Failure.TIMED_OUT for failure in result.failures)
    return timed_out or result.status is Status.SOLVED

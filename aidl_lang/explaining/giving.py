"""What gave way unasked, and what follows from other constraints."""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from aidl_lang.building.expression import Unknown
from aidl_lang.building.lower import Lowered, Solved
from aidl_lang.building.model import Constraint, Structure, told
from aidl_lang.common.diagnostics import Diagnostic, Fix, Label
from aidl_lang.common.prose import listed, short
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.explaining.failures import NAMED
from aidl_lang.explaining.remedies import left_out
from aidl_lang.geometry.solved import Change, SolvedModel
from aidl_lang.solver import Constraint as SolverConstraint
from aidl_lang.solver import Relation, Settings, Status, solve
from aidl_lang.solver.analysis import Freedom, analyse
from aidl_lang.solver.conflicts import Reason, reasons
from aidl_lang.solver.dependence import Redundancy
from aidl_lang.solver.expression import Op, mentioned
from aidl_lang.solver.problem import Failure

# --- The sizes and frames that gave way unasked, with the constraints that ask for it: sizes that changed,
# frames that moved though their content is exact or no constraint names them (language, "What gives way").

_A_TENTH = 0.1 + 1e-9  # greatest relative change of a size that is no warning
_STILL = 1e-6  # moves of a frame below this, in mm or degrees, count as none


@record()
class GaveWay:
    """Unknowns that gave way together, with the values they had and have, and the constraints that ask for
    it, in order of writing; without any one of them they would have stayed, if these are `minimal`.
    """

    moved: Mapping[Unknown, tuple[float, float]]
    because: tuple[Constraint, ...]
    minimal: bool


def gave_way(solution: Solved, settings: Settings) -> tuple[GaveWay, ...]:
    """Returns what gave way in a solution, by reason."""
    found, seen = list[GaveWay](), set[int]()
    for stage in reversed(solution.stages):
        if (concession := stage.concession) is None:
            continue
        together: dict[tuple[Constraint, ...], GaveWay] = {}
        for reason in reasons(solution.problem, settings, concession, solution.values):
            one = _given(solution, reason, seen)
            seen |= reason.unknowns
            if one.moved:
                # A constraint inherent in a shape is reported with the author's constraints on that shape.
                said = tuple(c for c in one.because if not c.is_inherent)
                known = together.get(said, one)
                chief = min(one, known, key=lambda each: len(each.because))
                together[said] = replace(chief, moved={**known.moved, **one.moved})
        found += together.values()
    return tuple(reversed(found))


def _given(solution: Solved, reason: Reason, seen: Container[int]) -> GaveWay:
    lowered, moved = solution.problem, dict[Unknown, tuple[float, float]]()
    for index in sorted(reason.unknowns):
        before, now = float(lowered.initial[index]), float(solution.values[index])
        if index not in seen and abs(now - before) > _STILL:
            moved[lowered.unknowns[index]] = before, now
    stated = sorted(lowered.stated_at(reason.constraints), key=lambda c: c.span.start)
    return GaveWay(moved, tuple(stated), reason.minimal)


def with_reasons(model: SolvedModel, given: Sequence[GaveWay], lowered: Lowered) -> SolvedModel:
    """Returns the model with the reasons of its changed sizes, but for ways between literal points."""
    texts = {u.path: tuple(c.text for c in g.because) for g in given for u in g.moved}
    bare = {change.path for change in model.changed} - texts.keys()
    for unknown in lowered.unknowns:
        if unknown.implied and unknown.path in bare:
            texts[unknown.path] = tuple(c.text for c in _speaking_of(unknown, lowered))
    changed = tuple(replace(c, because=texts.get(c.path, ())) for c in model.changed)
    return replace(model, changed=changed)


def _speaking_of(unknown: Unknown, lowered: Lowered) -> Iterator[Constraint]:
    """Yields the constraints that somebody stated and that speak of what an unknown is a number of."""
    for stated in filter(None, lowered.stated):
        spoken = (u.holder for part in stated.comparisons for u in part.spoken_of)
        if not stated.is_inherent and unknown.holder in spoken:
            yield stated


def giving_notes(given: Sequence[GaveWay], model: SolvedModel) -> Iterator[Diagnostic]:
    """Yields one message for all sizes that changed for one reason, and one for each frame that moved."""
    changes = {change.path: change for change in model.changed}
    for one in given:
        sizes = [changes[u.path] for u in one.moved if u.path in changes and not _is_asked(u, one)]
        visible = [c for c in sizes if short(c.written) != short(c.solved)]
        if visible:
            yield _of_sizes(visible, one)
        frames: dict[Structure, list[Unknown]] = {}
        for unknown in one.moved:
            if not unknown.kept:
                moved = unknown.frame_of or unknown.owner
                frames.setdefault(moved, []).append(unknown)
        for structure, unknowns in frames.items():
            yield _of_frame(structure, unknowns, one)


def _is_asked(unknown: Unknown, given: GaveWay) -> bool:
    """Tells whether a change is what was asked: that of a way between literal points, for which no number was
    written, by constraints that all speak of these points.
    """
    if not unknown.implied:
        return False
    spoken = ({u.holder for part in c.comparisons for u in part.spoken_of} for c in given.because)
    return unknown.angular or all(unknown.holder in holders for holders in spoken)


def _of_sizes(sizes: Sequence[Change], given: GaveWay) -> Diagnostic:
    chief = max(sizes, key=lambda c: (round(_share(c), 6), -c.span.start if c.span else 0))
    rest = [c for c in sizes if c is not chief]
    written, solved = short(chief.written), short(chief.solved)
    message = f"{chief.description} was written {written} and became {solved}"
    if rest:
        others = [f"{c.description} {short(c.written)} → {short(c.solved)}" for c in rest]
        message += f", and with it {listed(others, NAMED)}"
    changes = [(c.span, f"was written {short(c.written)} and became {short(c.solved)}") for c in rest]
    labels = tuple(Label(span, text) for span, text in changes if span is not None and span != chief.span)
    if _share(chief) <= _A_TENTH:
        hints = (*_whose(given), f"write {solved} to agree, or `fixed({written})` to insist")
        return _told("N0601", message, chief.span, given, labels, hints)
    how = _distortion(chief)
    whose = {0: "look for a constraint that says", 1: "see whether it says"}
    hints = (
        *_whose(given),
        f"{whose.get(len(given.because), 'look among them for one that says')} something else than you mean",
        "if it may become what it will, write it as a `guess(…)`",
    )
    return _told("W0601", f"{message}, {how}" if how else message, chief.span, given, labels, hints)


def _share(change: Change) -> float:
    """Returns the relative change of a size; 0 for an angle, an offset, or a size written as 0."""
    if not change.is_size or not change.written:
        return 0.0
    return abs(change.solved / change.written - 1.0)


def _distortion(change: Change) -> str:
    """Returns words for a change of a size that is hardly meant; "" for a smaller one."""
    share = change.solved / change.written
    if share < 0.0:
        return "turned around"
    if share < 0.5 - _STILL:
        return "less than half"
    return "more than twice as much" if share > 2.0 + _STILL else ""


def _of_frame(structure: Structure, unknowns: Sequence[Unknown], given: GaveWay) -> Diagnostic:
    way = {u.field.rpartition(".")[2]: now - before for u in unknowns for before, now in [given.moved[u]]}
    parent = structure.parent
    assert parent is not None
    if all(u.frame_of is None for u in unknowns):
        what = f"something in `{structure.path}` moved"
    else:
        by = [f"{short(way[axis])} in {axis}" for axis in ("x", "y") if axis in way]
        if "rotation" in way:
            by.append(f"turned by {short(way['rotation'])}°")
        what = f"`{structure.path}` moved against `{parent.path}`: {' and '.join(by)}"
    if _is_named(structure, given) and all(u.frame_of is None for u in unknowns):
        why, moves = "as it fits nowhere as a whole", "it moves as a whole if it can"
        gives = "write what shall give way in it as a `guess(…)`"
        hint = f"where constraints name one thing of a structure {moves}: {gives}"
    elif _is_named(structure, given):
        why = "something in it is exact, as `fixed(…)`, a `param` or `origin` makes it"
        frame = f"`{structure.name} at fixed((0, 0))`"
        hint = f"`fixed(…)` is exact in its own frame, which may move: {frame} holds that as well"
    else:
        why = "though no constraint names it"
        hint = f"name `{structure.name}` in the constraint that is to move it, or hold it by `at fixed(…)`"
    return _told("W0602", f"{what}, {why}", structure.span, given, (), (*_whose(given), hint))


def _is_named(structure: Structure, given: GaveWay) -> bool:
    parts = [part for c in given.because for part in c.comparisons]
    spoken = {s for part in parts for s in part.boxes}
    spoken.update(u.frame_of or u.owner for part in parts for u in part.spoken_of)
    return any(s.is_within(structure) for s in spoken)


def _whose(given: GaveWay) -> tuple[str, ...]:
    if not given.because:
        return ()
    names = [told(c) for c in given.because]
    ask = f"{listed(names, 6)} ask{'s' * (len(names) == 1)} for it"
    single = len(names) > 1 and given.minimal
    return (f"{ask}: without any one of them it would have stayed" if single else ask,)


def _told(
    code: str,
    message: str,
    span: Span | None,
    given: GaveWay,
    labels: tuple[Label, ...],
    hints: tuple[str, ...],
) -> Diagnostic:
    places = dict.fromkeys(c.span for c in given.because)
    asked = tuple(Label(place, "asks for it") for place in places if place != span)
    return Diagnostic(code, message, span, "this gave way", (*labels, *asked), hints)


# --- Reports constraints that follow from others and parts whose freedom is undecided; tells whether one
# constraint follows.

_NAMED = 4  # the most constraints that the headline names
_LARGEST = 2000
"""The most unknowns of a model that is solved again to see whether a constraint can be left out."""
_SAME = 1e-6  # change of a value, in units of its scale, that counts as none
_BROKEN = 1e-2
"""Violation of an inequality, in units of its scale, that is tried to see whether others forbid it."""
_TRIED = 20  # the most inequalities that are tried so, one by one
_SECONDS = 1.0  # time for each of them


def repetition_notes(solution: Solved, freedom: Freedom) -> list[Diagnostic]:
    """Returns a note for each written constraint that follows from others, and each undecided part."""
    lowered = solution.problem
    redundant = [(f, stated) for f in freedom.redundant if (stated := _stated(lowered, f.constraint))]
    times = Counter(stated.span for stated in lowered.stated if stated is not None)
    # What a loop or a template states may follow in one turn only.
    single = [(f, c) for f, c in redundant if c.node is not None and not c.label and times[c.span] == 1]
    can_go = [f.constraint for f, _ in single]
    if not _changes_nothing(solution, can_go):
        can_go = []
    notes = [_note(lowered, f, stated, f.constraint in can_go) for f, stated in redundant]
    return [*notes, *_undecided(lowered, freedom)]


def _stated(lowered: Lowered, index: int) -> Constraint | None:
    stated = lowered.stated[index]
    return stated if stated is not None and stated.wording is not None else None


def _note(lowered: Lowered, found: Redundancy, stated: Constraint, can_go: bool) -> Diagnostic:
    others = lowered.stated_at(found.follows_from)
    names = list(dict.fromkeys(told(other) for other in others))
    reason = listed(names, _NAMED) or "the other constraints"
    labels = dict.fromkeys(Label(other.span, "from this") for other in others if other.span != stated.span)
    name, left = told(stated), left_out(stated) if can_go else None
    fix = Fix(f"leave out {name}", left.edits) if left else None
    message = f"{name} follows from {reason}"
    return Diagnostic("N0602", message, stated.span, "says nothing new", tuple(labels), fix=fix)


def _changes_nothing(solution: Solved, left_out: Sequence[int]) -> bool:
    """Tells whether the solution is the same without these constraints: they may decide what moves first."""
    problem = solution.problem
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
        message = f"the degrees of freedom of `{owner.path}` could not be counted"
        label = "some of its constraints nearly follow from others, or it is too large to tell"
        yield Diagnostic("N0603", message, owner.span, label)
    unclear = [stated for i in freedom.unclear if (stated := _stated(lowered, i)) is not None]
    if unclear and not freedom.undecided:
        first = min(unclear, key=lambda stated: stated.span.start)
        message = f"which of {len(unclear)} constraints follow from others could not be told"
        yield Diagnostic("N0603", message, first.span, "this is the first of them")


def follows(solution: Solved, span: Span) -> bool:
    """Tells whether the statement at a place of a solved model holds wherever the other constraints hold: an
    equation near by and with sizes kept, as degrees of freedom are counted; an inequality everywhere. Returns
    False as well if that is too costly to decide.
    """
    problem = solution.problem
    own = {i for i, stated in enumerate(problem.stated) if stated is not None and stated.span.overlaps(span)}
    hard = [(i, c) for i, c in enumerate(problem.constraints) if c.weight is None or i in own]
    others = [c for i, c in hard if i not in own]
    rows = [replace(c, rows=(row,), weight=None) for i, c in hard if i in own for row in c.rows]
    equations = [c for c in rows if c.rows[0].relation is Relation.EQUAL]
    inequalities = [c for c in rows if c.rows[0].relation is Relation.AT_MOST]
    if len(inequalities) > _TRIED or not _are_redundant(solution, others, equations):
        return False
    return not any(_can_be_broken(solution, [*others, *equations], c) for c in inequalities)


def _are_redundant(
    solution: Solved, others: Sequence[SolverConstraint], equations: Sequence[SolverConstraint]
) -> bool:
    """Tells whether equations follow from others while sizes are kept."""
    problem, tape = solution.problem, solution.problem.tape
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
    found = analyse(replace(solution, problem=known, satisfied=(True,) * count)).redundant if moving else ()
    return {each.constraint for each in found} >= set(range(len(others), count))


def _can_be_broken(
    solution: Solved, others: Sequence[SolverConstraint], inequality: SolverConstraint
) -> bool:
    """Tells whether the others hold where an inequality does not; True as well if the time runs out."""
    (row,), problem, tape = inequality.rows, solution.problem, solution.problem.tape
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

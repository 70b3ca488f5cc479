"""What there is to say of a solved model: conflicts, sizes that had to change, assertions that fail."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from aidl_lang.building.conditions import holds
from aidl_lang.building.functions import Measurement
from aidl_lang.diagnostics import Diagnostic, Label
from aidl_lang.expression import Evaluator
from aidl_lang.geometry.boolean import clearance, overlap_area
from aidl_lang.geometry.drawing import Drawing, draw
from aidl_lang.geometry.measures import area, perimeter
from aidl_lang.geometry.region import Region
from aidl_lang.lower import Lowered
from aidl_lang.model import Assertion, Comparison, Condition, Constraint, Geometry, Model, Structure
from aidl_lang.solved import Frame, SolvedGeometry, SolvedModel, SolvedStructure
from aidl_lang.solver.solution import Failure, GroupFailure, Solution, Status

_TOLERANCE = 1e-6
"""How far an assertion may be off, relative to what it compares (and never less than this in mm)."""


def solution_notes(lowered: Lowered, solution: Solution, model: SolvedModel) -> list[Diagnostic]:
    """Failures as errors; for a model that solved, changed sizes and redundant constraints as notes."""
    found = [_failure(lowered, solution, failure) for failure in solution.failures]
    if solution.status is not Status.SOLVED:
        return found
    for change in model.changed:
        if _short(change.written) == _short(change.solved):
            continue
        found.append(
            Diagnostic(
                "N0601",
                f"`{change.path}` was written {_short(change.written)} and became {_short(change.solved)}",
                change.span,
                "the constraints could not hold otherwise",
                hints=(
                    f"write {_short(change.solved)} to agree, or `fixed({_short(change.written)})` to insist",
                ),
            )
        )
    if solution.degrees is None:
        message = "the model is too large for its degrees of freedom to be counted"
        found.append(Diagnostic("N0603", message, lowered.unknowns[0].owner.span))
    for index in solution.redundant:
        stated = lowered.stated[index]
        if stated is not None and stated.span is not None:
            found.append(
                Diagnostic("N0602", f"`{stated.text}` follows from the other constraints", stated.span)
            )
    return found


_HEADLINE = {
    Failure.CONTRADICTORY: ("E0601", "these constraints cannot hold together"),
    Failure.NOT_CONVERGED: ("E0602", "the solver did not reach a position in which these constraints hold"),
    Failure.TIMED_OUT: ("E0603", "the time for solving ran out before these constraints held"),
}


def _failure(lowered: Lowered, solution: Solution, failure: GroupFailure) -> Diagnostic:
    code, headline = _HEADLINE[failure.reason]
    conflict: list[tuple[int, Constraint]] = []
    for index in failure.conflict:
        stated = lowered.stated[index]
        if stated is not None:
            conflict.append((index, stated))
    if not conflict:
        return Diagnostic(code, headline)
    worst = max(conflict, key=lambda pair: solution.residuals[pair[0]])
    if len(conflict) == 1:
        headline = (
            f"`{worst[1].text}` cannot hold" if code == "E0601" else f"`{worst[1].text}` was not reached"
        )
    others = tuple(
        Label(stated.span, "conflicts with this" if failure.minimal else "takes part")
        for index, stated in conflict
        if index != worst[0]
    )
    named = ", ".join(f"`{_named(stated)}`" for _, stated in conflict[:6])
    hints = [f"were any one looser, the rest would hold: {named}"] if failure.minimal and others else []
    hints.append(
        "let one number follow from the others: `guess(…)` frees it, `prefer` states a wish; "
        "a `param` or `fixed(…)` never moves"
    )
    if len(conflict) < len(failure.conflict):
        hints.insert(0, "a size that was written may change, but it does not vanish")
    off = solution.residuals[worst[0]]
    label = f"off by {_short(off)}" if off > _TOLERANCE else "against the others"
    if not math.isfinite(off):
        label = "this has no value where the solver stopped"
    return Diagnostic(code, headline, worst[1].span, label, others, tuple(hints))


def _named(stated: Constraint) -> str:
    return f"{stated.text} [{stated.label}]" if stated.label else stated.text


def _short(value: float) -> str:
    return f"{round(value, 6) + 0.0:.6g}"


# --- Assertions ----------------------------------------------------------------------------------


def assertion_notes(
    model: Model, solved: SolvedModel, drawing: Drawing, evaluator: Evaluator, *, solved_fully: bool
) -> list[Diagnostic]:
    """Assertions that do not hold on the solved model; nothing when it did not solve."""
    if not solved_fully:
        return []
    evaluator.measure = _Measure(solved, drawing)
    return [_failed(a, evaluator) for a in model.assertions if not holds(a.condition, evaluator, _TOLERANCE)]


def _failed(assertion: Assertion, evaluate: Evaluator) -> Diagnostic:
    message = assertion.message or f"`{assertion.text}` does not hold"
    where = f" [{assertion.label}]" if assertion.label else ""
    shown = "; ".join(_compared(c, evaluate) for c in _false_parts(assertion.condition, evaluate))
    return Diagnostic(
        "E0604",
        f"assertion failed: {message}{where}",
        assertion.span,
        f"here {shown}" if shown else "false as written",
        hints=("an `assert` steers nothing: to make it hold, state it with `constrain` as well",),
    )


def _false_parts(
    condition: Condition | Comparison | bool, evaluate: Callable[..., float]
) -> Iterator[Comparison]:
    if isinstance(condition, Comparison):
        if not holds(condition, evaluate, _TOLERANCE):
            yield condition
    elif isinstance(condition, Condition) and condition.operator != "not":
        for part in condition.parts:
            yield from _false_parts(part, evaluate)


def _compared(comparison: Comparison, evaluate: Callable[..., float]) -> str:
    left, right = evaluate(comparison.left), evaluate(comparison.right)
    return f"{_short(left)} {comparison.relation} {_short(right)}"


class _Measure:
    """Answers what only the drawing can: areas, perimeters, clearances, overlaps."""

    def __init__(self, model: SolvedModel, drawing: Drawing) -> None:
        self.model = model
        self.drawing = drawing

    def __call__(self, payload: object) -> float:
        assert isinstance(payload, Measurement)
        regions = [self._region(thing) for thing in payload.of]
        match payload.kind:
            case "area":
                return area(regions[0])
            case "perimeter":
                return perimeter(regions[0])
            case "clearance":
                return clearance(*regions)
            case _:
                return float(overlap_area(*regions) > _TOLERANCE * self.drawing.size)

    def _region(self, thing: Structure | Geometry) -> Region:
        """What a structure covers in the drawing; what a geometry would cover as a solid of its own."""
        if isinstance(thing, Structure):
            return self.drawing.regions.get(thing.path, Region(()))
        geometry = tuple(g for g in _all_geometry(self.model.root) if g.path == thing.path)
        frame = Frame(0.0, 0.0, 0.0)
        alone = SolvedStructure("it", "it", "solid", "top", frame, {}, {}, geometry, (), None, False, 0, None)
        drawing, _ = draw(SolvedModel(self.model.status, alone, (), 0, (), ()))
        return drawing.regions.get("it", Region(()))


def _all_geometry(root: SolvedStructure) -> Iterator[SolvedGeometry]:
    for structure in root.walk():
        stack = list(structure.geometry)
        while stack:
            yield (top := stack.pop())
            stack.extend(top.parts)

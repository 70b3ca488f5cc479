"""Diagnostics of a solved model: conflicts, sizes that had to change, assertions that fail."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from aidl_lang.building.boxes import SIDES, constrain_sources
from aidl_lang.building.expression import Evaluator, nodes
from aidl_lang.building.lower import Lowered
from aidl_lang.building.model import (
    Assertion,
    Comparison,
    Condition,
    Geometry,
    Measurement,
    Model,
    Part,
    Structure,
    told,
)
from aidl_lang.building.wording import RELATIONS, differences, givens, holds, rounding
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.prose import fixed, rough
from aidl_lang.common.source import Span
from aidl_lang.geometry.curves import Piece, inward, larger_side, union_bounds
from aidl_lang.geometry.drawing import Drawing, all_geometry, region_alone
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import SolvedModel, SolvedStructure
from aidl_lang.solver.problem import Solution, Status

if TYPE_CHECKING:
    from aidl_lang.explaining.failures import Explanation
    from aidl_lang.explaining.giving import GaveWay
    from aidl_lang.solver.analysis import Freedom

_TOLERANCE = 1e-6
"""Violation that an assertion may have, relative to the values compared (and never less than this in mm)."""
_WORD = "assert"


def solution_notes(
    root: Structure,
    lowered: Lowered,
    solution: Solution,
    freedom: Freedom,
    model: SolvedModel,
    given: Sequence[GaveWay],
    failures: Sequence[Explanation],
) -> list[Diagnostic]:
    """Returns failures as errors; for a model that solved, notes on what gave way and what is redundant."""
    found = [failure.diagnostic for failure in failures]
    if solution.status is not Status.SOLVED:
        return found
    if given:
        from aidl_lang.explaining.giving import giving_notes

        found += giving_notes(given, model)
    from aidl_lang.explaining.staying import leaving_notes

    found += leaving_notes(root, lowered, solution)
    found += _wishes(lowered, solution)
    if freedom.redundant or freedom.undecided or freedom.unclear:
        from aidl_lang.explaining.giving import repetition_notes

        found += repetition_notes(lowered, solution, freedom)
    return found


def _wishes(lowered: Lowered, solution: Solution) -> Iterator[Diagnostic]:
    for stated, off, is_met in zip(lowered.stated, solution.residuals, solution.satisfied, strict=True):
        if stated is None or stated.weight is None or is_met:
            continue
        from aidl_lang.explaining.failures import measured_in

        message = f"the wish {told(stated)} is not met"
        label = f"off by {measured_in(off, stated)}" if math.isfinite(off) else "it has no value here"
        hint = "a wish gives way to every constraint; without `prefer` it is told what stands against it"
        yield Diagnostic("N0605", message, stated.span, label, hints=(hint,))


def assertion_notes(
    model: Model, solved: SolvedModel, drawing: Drawing, evaluator: Evaluator, *, solved_fully: bool
) -> list[Diagnostic]:
    """Returns a diagnostic for each assertion that does not hold; none for a model that did not solve."""
    if not solved_fully:
        return []
    evaluator.measure = measure = _Measure(solved.root, drawing)
    asked = [a for a in model.assertions if a.outline is None or measure.is_drawn(a.outline)]
    return [d for a in asked if (d := assertion_note(a, evaluator)) is not None]


def assertion_note(assertion: Assertion, evaluate: Evaluator) -> Diagnostic | None:
    """Returns a diagnostic, with numbers, for an assertion that does not hold at some values; else None."""
    if holds(assertion.condition, evaluate, _TOLERANCE):
        return None
    if assertion.is_followed:
        return _lost_way(assertion)
    if assertion.extent:
        return _too_long(assertion, evaluate)
    message = assertion.message or f"`{assertion.text}` does not hold"
    where = f" [{assertion.label}]" if assertion.label else ""
    false = list(_false_parts(assertion.condition, evaluate))
    wording = assertion.wording
    shown = differences(wording, evaluate, _TOLERANCE) if wording is not None else []
    if assertion.outline is not None:
        if _is_fitted(false, assertion.outline, evaluate):
            return None
        return _other_box(assertion, assertion.outline, shown or [_compared(c, evaluate) for c in false])
    places = givens(wording) if wording is not None and not false and not assertion.shape else ()
    near = [h for c in false if c.relation == "==" for h in rounding(evaluate(c.left), evaluate(c.right))]
    span = assertion.span
    label = "; ".join(shown or [_compared(c, evaluate) for c in false]) or "false as written"
    hints = tuple(near) or (_hint(assertion, false, places),)
    fix = _stated(assertion)
    return Diagnostic("E0604", f"assertion failed: {message}{where}", span, label, places, hints, fix)


def _lost_way(assertion: Assertion) -> Diagnostic:
    """Returns the diagnostic for places along a curve that came out in another form."""
    message = f"`{assertion.span.one_line}` is not where it says: the curve was solved to another form"
    label = "laid out along the curve as it was written"
    hint = "write the points of the curve near to where the constraints bring them"
    return Diagnostic("E0608", message, assertion.span, label, hints=(hint,))


def _too_long(assertion: Assertion, evaluate: Evaluator) -> Diagnostic:
    """Returns the warning about a text that is longer than the curve that it is written along."""
    assert isinstance(assertion.condition, Condition)
    (fits,) = assertion.condition.comparisons()
    length, room = evaluate(fits.left), evaluate(fits.right)
    height = math.floor(100 * room / assertion.extent) / 100
    span = assertion.span
    behind = span.text.rfind('"') + 1  # not in the text itself
    stated = re.compile(r"\bheight\s*:\s*([\d.]+(?:mm)?)(?=\s*[,)])").search(span.text, behind)
    fix = None
    if stated is not None and height > 0:
        at = Span(span.source, *(span.start + place for place in stated.span(1)))
        edit = Edit(at, fixed(height))
        fix = Fix(f"write letters of {fixed(height)} mm", (edit,))
    message = f"this text is {rough(length)} mm long, and the way along which it is written {rough(room)} mm"
    label = "it goes on past the end, and on a round way over itself"
    fitting = f"letters of {fixed(height)} mm fit: `height: {fixed(height)}`"
    return Diagnostic("W0761", message, span, label, (), (fitting, "or write it along a longer way"), fix)


def _is_fitted(false: Sequence[Comparison], outline: Geometry, evaluate: Evaluator) -> bool:
    """Tells whether the box of an outline is off by no more than its curves are: parallel curves of cubics
    and ellipses are fitted, and true only towards the axes of the drawing, while a structure may be turned.
    """
    from aidl_lang.geometry.offsets import FIT

    assert isinstance(evaluate.measure, _Measure)
    slack = FIT * evaluate.measure.extent(outline)
    return all(abs(evaluate(c.left) - evaluate(c.right)) <= slack for c in false)


def _other_box(assertion: Assertion, outline: Geometry, shown: Sequence[str]) -> Diagnostic:
    """Returns the diagnostic for a constraint on the box of an outline that came out otherwise."""
    message = f"{told(assertion)} does not hold for `{outline.path}` as it is drawn"
    hint = f"it was solved with the boxes of what goes into `{outline.type}`, and less is left of them"
    hints = hint, constrain_sources(outline, assertion.holder)
    return Diagnostic("E0607", message, assertion.span, "; ".join(shown), hints=hints)


def _hint(assertion: Assertion, false: Sequence[Comparison], places: Sequence[Label]) -> str:
    """Returns a hint on an assertion that does not hold; it proposes nothing that would be an error."""
    if assertion.shape:
        return f"`{assertion.shape}` asks this of its arguments: see `aidl doc {assertion.shape}`"
    if not false and isinstance(assertion.condition, bool):
        change = "change one of these, or" if places else "change a number, or"
        return f"nothing in it moves, so `constrain` would not help: {change} what the `assert` asks"
    if _is_measured(false):
        return (
            "this is measured on what is drawn, which `constrain` cannot steer: change the sizes that it "
            "follows from, or what the `assert` asks"
        )
    return "an `assert` steers nothing: it is looked at once everything is solved"


def _stated(assertion: Assertion) -> Fix | None:
    """Returns a fix that constrains what an `assert` of the author asks, before it; None if impossible."""
    span, wording = assertion.span, assertion.wording
    before = span.source.text[: span.start].rstrip()
    is_own = wording is not None and wording.node.span == span
    if not is_own or not before.endswith(_WORD) or not _can_be_stated(assertion.condition):
        return None
    start = len(before) - len(_WORD)
    indent = before[before.rfind("\n") + 1 : start]
    beside = "; " if indent.strip() else f"\n{indent}"
    edit = Edit(Span(span.source, start, start), f"constrain {span.text}{beside}")
    return Fix("state it with `constrain` as well", (edit,))


def _is_measured(comparisons: Sequence[Comparison]) -> bool:
    sides = (side for c in comparisons for side in (c.left, c.right) if side.is_open)
    return any(isinstance(node.payload, Measurement) for node in nodes(sides, only_open=True))


def _can_be_stated(condition: Condition | bool) -> bool:
    """Tells whether `constrain` takes a condition: comparisons, all to hold, of values known in solving."""
    if not isinstance(condition, Condition) or condition.operator != "and":
        return False
    parts = [part for part in condition.parts if isinstance(part, Comparison) and part.relation in RELATIONS]
    return len(parts) == len(condition.parts) and not _is_measured(parts)


def _false_parts(condition: Part, evaluate: Evaluator) -> Iterator[Comparison]:
    if isinstance(condition, Comparison):
        if not holds(condition, evaluate, _TOLERANCE):
            yield condition
    elif isinstance(condition, Condition) and condition.operator != "not":
        for part in condition.parts:
            yield from _false_parts(part, evaluate)


def _compared(comparison: Comparison, evaluate: Evaluator) -> str:
    from aidl_lang.common.prose import short

    left, right = evaluate(comparison.left), evaluate(comparison.right)
    return f"{short(left)} is not {comparison.relation} {short(right)}"


def measured(kind: str, regions: Sequence[Region], size: float) -> float:
    """Returns a measurement of what is drawn; `size` is that of the drawing."""
    from aidl_lang.geometry.boolean import clearance, common

    match kind:
        case "area":
            return regions[0].area
        case "perimeter":
            return regions[0].perimeter
        case "clearance":
            return clearance(*regions)
        case _:
            return float(common(*regions).area > _TOLERANCE * size)


class _Measure:
    """Measures what only the drawing knows: areas, perimeters, clearances, overlaps."""

    def __init__(self, root: SolvedStructure, drawing: Drawing) -> None:
        self.root = root
        self.drawing = drawing

    def __call__(self, payload: object) -> float:
        assert isinstance(payload, Measurement)
        if payload.kind in SIDES:
            return self._side(payload)
        return measured(payload.kind, [self._region(thing) for thing in payload.of], self.drawing.size)

    def _side(self, payload: Measurement) -> float:
        """Returns a side of the box of an outline worked out after solving, in the frame of a structure."""
        assert payload.here is not None
        curves = self._curves(payload.of[0].path)
        frames, here = [], self.root
        while here.path != payload.here.path:
            here = next(s for s in here.structures if f"{payload.here.path}.".startswith(f"{s.path}."))
            frames.append(here.frame)
        for frame in frames:
            curves = [inward(c, (frame.x, frame.y), frame.rotation, frame.mirrored) for c in curves]
        left, bottom, right, top = union_bounds([c.box for c in curves])
        return {"left": left, "bottom": bottom, "right": right, "top": top}[payload.kind]

    def extent(self, outline: Geometry) -> float:
        return larger_side(union_bounds([c.box for c in self._curves(outline.path)]))

    def is_drawn(self, outline: Geometry) -> bool:
        """Tells whether an outline did not come out empty, which is told by itself."""
        return bool(self._curves(outline.path))

    def _curves(self, path: str) -> list[Piece]:
        found = [g for g in all_geometry(self.root) if g.path == path]
        return [c for g in found for c in replace(g, construction=False).curves()]

    def _region(self, thing: Structure | Geometry) -> Region:
        """Returns what a structure covers in the drawing, or what a geometry would cover as a solid."""
        if isinstance(thing, Structure):
            return self.drawing.regions.get(thing.path, Region(()))
        return region_alone(self.root, thing.path)

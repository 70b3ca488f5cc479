"""Diagnostics of a solved model: conflicts, sizes that changed, assertions that fail, details left behind."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

from aidl_lang.building.boxes import SIDES, box_of, constrain_sources, source_unknowns
from aidl_lang.building.expression import Evaluator, Expression, Unknown, nodes
from aidl_lang.building.lower import Lowered, Solved
from aidl_lang.building.model import (
    Assertion,
    Comparison,
    Condition,
    Constraint,
    Geometry,
    Measurement,
    Model,
    Part,
    Structure,
    told,
)
from aidl_lang.building.wording import RELATIONS, differences, givens, holds, rounding
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.prose import fixed, named, rough, short
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.geometry.curves import Piece, inward, larger_side, union_bounds
from aidl_lang.geometry.drawing import Drawing, all_geometry, region_alone
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import SolvedModel, SolvedStructure
from aidl_lang.solver import Settings
from aidl_lang.solver.problem import Status
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.explaining.failures import Explanation
    from aidl_lang.explaining.giving import GaveWay
    from aidl_lang.solver.analysis import Freedom

_TOLERANCE = 1e-6
"""Violation that an assertion may have, relative to the values compared (and never less than this in mm)."""
_WORD = "assert"


def solution_notes(
    root: Structure,
    solution: Solved,
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
    found += leaving_notes(root, solution)
    found += _wishes(solution)
    if freedom.redundant or freedom.undecided or freedom.unclear:
        from aidl_lang.explaining.giving import repetition_notes

        found += repetition_notes(solution, freedom)
    return found


def _wishes(solution: Solved) -> Iterator[Diagnostic]:
    rows = zip(solution.problem.stated, solution.residuals, solution.satisfied, strict=True)
    for stated, off, is_met in rows:
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
    message = f"`{assertion.span.one_line}` is not where it says: the curve was solved to another form"
    label = "laid out along the curve as it was written"
    hint = "write the points of the curve near to where the constraints bring them"
    return Diagnostic("E0608", message, assertion.span, label, hints=(hint,))


def _too_long(assertion: Assertion, evaluate: Evaluator) -> Diagnostic:
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


@record(eq=False)
class _Measure:
    """Measures what only the drawing knows: areas, perimeters, clearances, overlaps."""

    root: SolvedStructure
    drawing: Drawing

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


# --- Things left where they were written though what they were drawn for moved: details that were drawn
# inside of something, ways of which constraints take both ends.

_STILL = 1e-6  # moves below this, in mm, count as none
_FAR = 0.1  # the part of its own extent, or of both, by which something may move without a word
_NAMED = 3  # siblings told by name
_SIDES = ("left", "bottom", "right", "top")
_ENDS = frozenset({"start", "end"})
_MEASURED = frozenset({"edges", "length"})
_FORMED = frozenset({"path", "polygon", "polyline", "spline"})

Naming = Mapping[Unknown | Structure, Sequence[Constraint]]
"""The constraints that mention an unknown, or the box of a structure."""
Sides = tuple[float, ...]
"""Left, bottom, right, top."""


def _staying_notes(
    root: Structure, before: Mapping[Unknown, float], after: Mapping[Unknown, float], naming: Naming
) -> Iterator[Diagnostic]:
    """Yields a warning for each thing that moved away from what was drawn inside it and no constraint names,
    and for each way that lost its form because constraints took both its ends.
    """
    moved = {u for u in after if abs(after[u] - before[u]) > _STILL}
    now = Evaluator(after)
    for structure in root.walk():
        things: list[Geometry | Structure] = [
            *(g for g in structure.own() if g.type != "point" and not g.construction),
            *structure.children,
        ]
        seen = [_Seen(thing, structure, now, naming) for thing in things if thing.source is None]
        if any(not moved.isdisjoint(one.unknowns) for one in seen):
            yield from _left_inside([one for one in seen if one.is_placed], structure)
    yield from _lost_form(moved, before, after, naming)


@record(frozen=False, eq=False)
class _Seen:
    """A thing as the structure that holds it sees it: its box as written and as solved."""

    thing: Geometry | Structure
    here: Structure
    now: Evaluator
    naming: Naming

    @cached_property
    def unknowns(self) -> frozenset[Unknown]:
        return frozenset(source_unknowns(self.thing, self.here))

    @cached_property
    def constraints(self) -> tuple[Constraint, ...]:
        boxes = self.thing.walk() if isinstance(self.thing, Structure) else ()
        return tuple(dict.fromkeys(c for key in (*boxes, *self.unknowns) for c in self.naming.get(key, ())))

    @cached_property
    def written(self) -> Sides:
        return tuple(side.value for side in self._sides)

    @cached_property
    def solved(self) -> Sides:
        return tuple(map(self.now, self._sides))

    @cached_property
    def _sides(self) -> Sequence[Expression]:
        box = box_of(self.thing, self.here)
        assert box is not None
        return [box.side(name) for name in _SIDES]

    @property
    def is_placed(self) -> bool:
        return all(map(math.isfinite, (*self.written, *self.solved)))

    @property
    def extent(self) -> float:
        left, bottom, right, top = self.written
        return max(right - left, top - bottom)

    @property
    def way(self) -> float:
        """How far its middle moved."""
        return math.dist(_middle(self.written), _middle(self.solved))

    @property
    def stayed(self) -> bool:
        off = max(abs(a - b) for a, b in zip(self.written, self.solved, strict=True))
        return off <= _STILL and not self.constraints


def _middle(sides: Sides) -> tuple[float, float]:
    return (sides[0] + sides[2]) / 2, (sides[1] + sides[3]) / 2


def _holds(outer: Sides, inner: Sides) -> bool:
    (left, bottom, right, top), (x_min, y_min, x_max, y_max) = outer, inner
    return left <= x_min and bottom <= y_min and right >= x_max and top >= y_max


def _left_inside(seen: Sequence[_Seen], here: Structure) -> Iterator[Diagnostic]:
    """Yields a warning for each thing that left what it was drawn on: inside it, with nothing in between."""
    left: dict[int, list[_Seen]] = {}
    for number, inner in enumerate(seen):
        below = [o for o in seen[:number] if o.extent > inner.extent and _holds(o.written, inner.written)]
        if not below or not inner.stayed or inner.thing.name is None:
            continue
        nearest = below[-1]
        x, y = _middle(inner.solved)
        if (
            nearest.way > _FAR * nearest.extent
            and nearest.constraints
            and not _holds(nearest.solved, (x, y, x, y))
        ):
            left.setdefault(seen.index(nearest), []).append(inner)
    for index, inside in sorted(left.items()):
        yield _left(seen[index], inside, here)


def _left(outer: _Seen, inside: Sequence[_Seen], here: Structure) -> Diagnostic:
    names = named([one.thing.name or "" for one in inside], _NAMED)
    chief, other = outer.thing.name, inside[0].thing.name
    spans = dict.fromkeys(c.span for c in outer.constraints)
    stands = "stands" if len(inside) == 1 else "stand"
    moved = f"`{chief}` moved by {short(outer.way)} in `{here.path}`"
    message = f"{moved}, and {names}, drawn inside it, {stands} where written"
    labels = tuple(Label(span, f"moves `{chief}`") for span in spans)
    where = f"say where it belongs, as in `{other}.center == {chief}.center`"
    hint = f"{where}, or draw both in one structure and constrain that"
    return Diagnostic("W0604", message, inside[0].thing.span, "no constraint names it", labels, (hint,))


def _lost_form(
    moved: set[Unknown], before: Mapping[Unknown, float], after: Mapping[Unknown, float], naming: Naming
) -> Iterator[Diagnostic]:
    """Yields a warning for each open way of several literal points that constraints hold by both ends, so
    that one stretch took up all the difference, for each polygon of which they measure a side, and for what
    was written from one point to another and now points back.
    """
    ways: dict[Geometry, list[Unknown]] = {}
    for unknown in before:
        if unknown.implied and isinstance(unknown.holder, Geometry):
            ways.setdefault(unknown.holder, []).append(unknown)
    for way, lengths in ways.items():
        changed = [u for u in lengths if u in moved]
        has_form = way.type in _FORMED and sum(not u.angular for u in lengths) > 1  # two points adapt
        turns = {u: math.radians(after[u] - before[u]) for u in changed if u.field == "end.angle"}
        turned = next((u for u, turn in turns.items() if math.cos(turn) < -_STILL), None)
        if way.name is None or not (turned or has_form) or not changed:
            continue
        unknowns = source_unknowns(way, way.owner)
        asking = list(dict.fromkeys(c for u in unknowns for c in naming.get(u, ()) if not c.is_inherent))
        labels = tuple(dict.fromkeys(c.span for c in asking))
        if turned and not has_form:
            was, now = short(before[turned]), short(after[turned] % 360)
            ends = f"it was written towards {was}° and points towards {now}°"
            message = f"`{way.path}` was turned around: {ends}"
            told = "its ends are where the constraints put them"
            meant = "if that is meant, write its points so"
            hint = f"{meant}; a distance without a sign keeps the side of the first guesses"
            places = tuple(Label(span, "places an end") for span in labels)
            yield Diagnostic("W0605", message, way.span, told, places, (hint,))
            continue
        if len(changed) == len(lengths):
            continue
        if way.type == "polygon":
            is_lost = bool(asking) and all(_MEASURED & set(_members_in(c)) for c in asking)
            how, label = "was measured at one side and", "is measured"
            hint = "say where its corners shall be, or draw what keeps its angles, as a `rectangle` does"
        else:
            is_lost = {name for c in asking for name in _members_in(c)} >= _ENDS
            how, label = "is held by both ends and", "holds an end"
            hint = (
                "for what spans two parts there are `cord`, `strip`, `coil` and `s_curve`, which take their "
                "points; or hold one end and write the others as `guess(…)`"
            )
        if not is_lost:
            continue
        chief = max(changed, key=lambda u: abs(after[u] - before[u]))
        if not abs(after[chief] - before[chief]) > _FAR * max(abs(before[u]) for u in lengths):
            continue
        change = f"{chief.description} was {short(before[chief])} and became {short(after[chief])}"
        message = f"`{way.path}` {how} lost its form: {change}"
        places = tuple(Label(span, label) for span in labels)
        told = "literal points keep their distances as well as they can"
        yield Diagnostic("W0605", message, way.span, told, places, (hint,))


def _members_in(constraint: Constraint) -> Iterator[str]:
    if constraint.wording is not None:
        for node in ast.walk(constraint.wording.node):
            if isinstance(node, ast.Member):
                yield node.name.text


# --- Details that constraints from outside moved within their structure, away from what is drawn beside
# them.
_SECONDS = 1.0  # for the search for a place of a structure as a whole


@record()
class _Detail:
    """A geometry of a structure, how far it moved there, and the constraints that name it."""

    geometry: Geometry
    moved: float
    constraints: tuple[Constraint, ...]

    def left_by(self, structure: Structure) -> bool:
        """Tells whether the detail moved for constraints from outside alone."""
        outside = [not c.holder.is_within(structure) for c in self.constraints]
        return self.moved > _STILL and bool(outside) and all(outside)

    @property
    def stayed(self) -> bool:
        """Tells whether it is drawn and stayed where it was written, with no constraint on it."""
        is_drawn = self.geometry.type != "point" and not self.geometry.construction
        return is_drawn and not self.constraints and self.moved <= _STILL


def leaving_notes(root: Structure, solution: Solved) -> Iterator[Diagnostic]:
    """Yields a warning for each structure of which a part was taken away from the rest by constraints that a
    structure around it holds, and for what else was left behind.
    """
    lowered = solution.problem
    written, solved = map(lowered.by_unknown, (lowered.initial, solution.values))
    naming: dict[Unknown | Structure, list[Constraint]] = {}
    for stated in filter(None, lowered.stated):
        for comparison in stated.comparisons:
            for unknown in comparison.spoken_of:
                naming.setdefault(unknown, []).append(stated)
            for structure in comparison.boxes:
                naming.setdefault(structure, []).append(stated)
    places: dict[Structure, dict[Geometry, list[Unknown]]] = {}
    for unknown in written:
        holder = unknown.holder
        is_place = not (unknown.kept or unknown.angular or unknown.frame_of or unknown.outline)
        if is_place and isinstance(holder, Geometry) and unknown.owner.parent is not None:
            places.setdefault(unknown.owner, {}).setdefault(holder, []).append(unknown)
    for structure, found in places.items():
        details = []
        for geometry, unknowns in found.items():
            way = max(abs(solved[u] - written[u]) for u in unknowns)
            asking = tuple(dict.fromkeys(c for u in unknowns for c in naming.get(u, ())))
            details.append(_Detail(geometry, way, asking))
        stayed = [detail for detail in details if detail.stayed]
        left = [detail for detail in details if detail.left_by(structure)]
        extent = _extent([u for d in (*stayed, *left) for u in found[d.geometry]], written)
        left = [detail for detail in left if detail.moved > _FAR * extent]
        if left and stayed:
            yield _left_outside(structure, left, stayed, _fits(structure, lowered))
    yield from _staying_notes(root, written, solved, naming)


def _fits(structure: Structure, lowered: Lowered) -> bool:
    """Tells whether a place is found for a structure as a whole, with all other positions free."""
    from aidl_lang.solver.conflicts import nearby_solution

    start = {
        index: float(lowered.initial[index])
        for index, unknown in enumerate(lowered.unknowns)
        if unknown.frame_of is structure or not (unknown.kept or unknown.owner.is_within(structure))
    }
    hard = [index for index, weight in enumerate(lowered.weight.tolist()) if weight != weight]
    return nearby_solution(lowered, Settings(seconds=_SECONDS), hard, start) is not None


def _extent(unknowns: Sequence[Unknown], written: Mapping[Unknown, float]) -> float:
    spans = []
    for axis in ("x", "y"):
        along = [written[u] for u in unknowns if u.field.rpartition(".")[2] == axis]
        spans.append(max(along) - min(along) if along else 0.0)
    return max(spans)


def _left_outside(
    structure: Structure, left: Sequence[_Detail], stayed: Sequence[_Detail], fits: bool
) -> Diagnostic:
    chief = max(left, key=lambda detail: detail.moved)
    inside = f"{structure.path}."
    stays = named([d.geometry.path.removeprefix(inside) for d in stayed], _NAMED)
    asking = list(dict.fromkeys(c for d in left for c in d.constraints))
    name = chief.geometry.path.removeprefix(inside)
    message = (
        f"`{name}` moved by {short(chief.moved)} within `{structure.path}`, and {stays} stayed where written"
    )
    labels = tuple(Label(span, "asks for it") for span in dict.fromkeys(c.span for c in asking))
    fixing, whole = f"with `fixed(…)` for `{name}`", f"`{structure.name}`"
    hints = (
        f"{fixing} others give way: {whole} fits as a whole then"
        if fits
        else f"{whole} as a whole has no place that fits: {fixing} it is told what stands against it",
        f"if `{name}` shall move alone, say by a constraint in {whole} where the others are",
    )
    span = chief.geometry.span or structure.span
    return Diagnostic("W0603", message, span, "left what stands beside it", labels, hints)

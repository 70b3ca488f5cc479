"""Details away from what they were drawn for: left where they were written, or moved from outside."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property

from aidl_lang.building.boxes import box_of, source_unknowns
from aidl_lang.building.expression import Evaluator, Expression, Unknown
from aidl_lang.building.lower import Lowered
from aidl_lang.building.model import Constraint, Geometry, Structure
from aidl_lang.common.diagnostics import Diagnostic, Label
from aidl_lang.common.prose import named, short
from aidl_lang.common.records import record
from aidl_lang.solver import Settings, Solution
from aidl_lang.syntax import ast

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
    return Diagnostic(
        "W0604",
        f"`{chief}` moved by {short(outer.way)} in `{here.path}`, and {names}, drawn inside it, {stands} "
        "where written",
        inside[0].thing.span,
        "no constraint names it",
        tuple(Label(span, f"moves `{chief}`") for span in spans),
        (
            f"say where it belongs, as in `{other}.center == {chief}.center`, or draw both in one structure "
            "and constrain that",
        ),
    )


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
            yield Diagnostic(
                "W0605",
                f"`{way.path}` was turned around: it was written towards {short(before[turned])}° and points "
                f"towards {short(after[turned] % 360)}°",
                way.span,
                "its ends are where the constraints put them",
                tuple(Label(span, "places an end") for span in labels),
                (
                    "if that is meant, write its points so; a distance without a sign keeps the side of the "
                    "first guesses",
                ),
            )
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


def leaving_notes(root: Structure, lowered: Lowered, solution: Solution) -> Iterator[Diagnostic]:
    """Yields a warning for each structure of which a part was taken away from the rest by constraints that a
    structure around it holds, and for what else was left behind.
    """
    written = dict(zip(lowered.unknowns, map(float, lowered.problem.initial), strict=True))
    solved = dict(zip(lowered.unknowns, map(float, solution.values), strict=True))
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

    problem = lowered.problem
    start = {
        index: float(problem.initial[index])
        for index, unknown in enumerate(lowered.unknowns)
        if unknown.frame_of is structure or not (unknown.kept or unknown.owner.is_within(structure))
    }
    hard = [index for index, weight in enumerate(problem.weight.tolist()) if weight != weight]
    return nearby_solution(problem, Settings(seconds=_SECONDS), hard, start) is not None


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
    return Diagnostic(
        "W0603",
        f"`{name}` moved by {short(chief.moved)} within `{structure.path}`, and {stays} stayed where written",
        chief.geometry.span or structure.span,
        "left what stands beside it",
        tuple(Label(span, "asks for it") for span in dict.fromkeys(c.span for c in asking)),
        (
            f"with `fixed(…)` for `{name}` others give way: `{structure.name}` fits as a whole then"
            if fits
            else f"`{structure.name}` as a whole has no place that fits: with `fixed(…)` for `{name}` it is "
            "told what stands against it",
            f"if `{name}` shall move alone, say by a constraint in `{structure.name}` where the others are",
        ),
    )

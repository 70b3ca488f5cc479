"""Things left where they were written though what they were drawn for moved: details that were drawn inside
of something, ways of which constraints take both ends.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property

from aidl_lang.building.boxes import box_of, source_unknowns
from aidl_lang.building.expression import Evaluator, Expression, Unknown
from aidl_lang.building.lower import Lowered
from aidl_lang.building.model import Constraint, Geometry, Structure
from aidl_lang.building.wording import Wording
from aidl_lang.common.diagnostics import Diagnostic, Label
from aidl_lang.common.prose import named, short
from aidl_lang.common.records import record
from aidl_lang.solver import Solution
from aidl_lang.syntax import ast

_STILL = 1e-6
_FAR = 0.1
"""The part of its own extent by which something may move without a word."""
_NAMED = 3
_SIDES = ("left", "bottom", "right", "top")
_ENDS = frozenset({"start", "end"})
_MEASURED = frozenset({"edges", "length"})
_FORMED = frozenset({"path", "polygon", "polyline", "spline"})

Naming = Mapping[Unknown | Structure, Sequence[Constraint]]
"""The constraints that mention an unknown, or the box of a structure."""
Sides = tuple[float, float, float, float]


def staying_notes(
    root: Structure, lowered: Lowered, solution: Solution, naming: Naming
) -> Iterator[Diagnostic]:
    """Yields a warning for each thing that moved away from what was drawn inside it and no constraint names,
    and for each way that lost its form because constraints took both its ends.
    """
    after = dict(zip(lowered.unknowns, map(float, solution.values), strict=True))
    before = dict(zip(lowered.unknowns, map(float, lowered.problem.initial), strict=True))
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
        left, bottom, right, top = (side.value for side in self._sides)
        return left, bottom, right, top

    @cached_property
    def solved(self) -> Sides:
        left, bottom, right, top = map(self.now, self._sides)
        return left, bottom, right, top

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
    return all(o <= i for o, i in zip(outer[:2], inner[:2], strict=True)) and all(
        o >= i for o, i in zip(outer[2:], inner[2:], strict=True)
    )


def _left_inside(seen: Sequence[_Seen], here: Structure) -> Iterator[Diagnostic]:
    """Yields a warning for each thing that moved away from others that were drawn on it: inside it, and on
    nothing that was written in between.
    """
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
        turned = next((u for u in changed if u.field == "end.angle" and _is_back(after[u] - before[u])), None)
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
        yield Diagnostic(
            "W0605",
            f"`{way.path}` {how} lost its form: {chief.description} was "
            f"{short(before[chief])} and became {short(after[chief])}",
            way.span,
            "literal points keep their distances as well as they can",
            tuple(Label(span, label) for span in labels),
            (hint,),
        )


def _is_back(turn: float) -> bool:
    """Tells whether a turn in degrees leads more back than on."""
    return math.cos(math.radians(turn)) < -_STILL


def _members_in(constraint: Constraint) -> Iterator[str]:
    """Yields the names of the members that a constraint speaks of."""
    if isinstance(constraint.wording, Wording):
        for node in ast.walk(constraint.wording.node):
            if isinstance(node, ast.Member):
                yield node.name.text

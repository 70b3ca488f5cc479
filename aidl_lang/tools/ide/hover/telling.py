"""Solved values in words: `radius = 16 mm, kept`."""

from __future__ import annotations

import math
from collections.abc import Iterator

from aidl_lang.building import boxes
from aidl_lang.building import expression as ex
from aidl_lang.building.conditions import holds
from aidl_lang.building.expression import Unknown
from aidl_lang.building.model import Condition, Geometry, Structure
from aidl_lang.building.state import Env, Scope
from aidl_lang.building.values import Exactness, Num, PointVal, TextVal, Value
from aidl_lang.checking.types import PRIMITIVES
from aidl_lang.checking.units import ANGLE, AREA, LENGTH, PLAIN, MaybeDimension
from aidl_lang.common.prose import fixed
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.hover.solved_values import BuiltValue, Solved, items_of, spelled

DECIMALS = 4
_MOST_ITEMS = 4
_TOLERANCE = 1e-6
_UNITS = {LENGTH: " mm", ANGLE: "°", AREA: " mm²"}
_STATES = {
    "fully": "fully constrained",
    "under": "can still move",
    "over": "constrained more than once",
    "contradictory": "its constraints do not hold together",
}


def number_text(value: float, dimension: MaybeDimension) -> str:
    """Returns a number as people write it, with its unit: `112.4 mm`."""
    if not math.isfinite(value):
        return "no number"
    if dimension is None or dimension == PLAIN:
        return fixed(value, DECIMALS)
    return fixed(value, DECIMALS) + _UNITS.get(dimension, f" {dimension}")


def lines(solved: Solved, name: str, found: list[BuiltValue]) -> list[str]:
    """Returns a line with the value for each instance or turn."""
    told: list[str] = []
    for each in found:
        head = f"{each.label}: " if each.label else ""
        told += [head + line for line in _lines(solved, name, each.value, each.env)]
    return told


def compared(solved: Solved, sides: list[tuple[str, list[BuiltValue]]]) -> list[str]:
    """Returns lines for the sides of a comparison, which read the boxes in it together."""
    told: list[str] = []
    for row in zip(*(found for _, found in sides), strict=False):
        head = f"{row[0].label}: " if row[0].label else ""
        values = spelled(*(each.value for each in row))
        for (name, _), value, each in zip(sides, values, row, strict=True):
            told += [head + line for line in _lines(solved, name, value, each.env)]
    return told


def _lines(solved: Solved, name: str, value: Value, env: Env) -> Iterator[str]:
    value = spelled(value)[0]
    match value:
        case Num():
            text = _number(solved, value)
            if text is not None:
                yield f"{name} = {text}"
        case PointVal():
            text = _point(solved, value)
            if text is not None:
                yield f"{name} = {text}{_frame(env)}"
        case Geometry():
            yield from _geometry(solved, name, value, env)
        case Structure():
            yield from _structure(solved, name, value)
        case TextVal(text, _):
            yield f'{name} = "{text}"'
        case bool() | Condition():
            yield f"{name} = {_truth(solved, value)}"
        case _ if (items := items_of(value)) is not None:
            yield f"{name}: {len(items)} members"
            for index, item in items[:_MOST_ITEMS]:
                yield from _lines(solved, f"{name}{index}", item, env)
            if len(items) > _MOST_ITEMS:
                yield "…"
        case _:
            pass


def _number(solved: Solved, value: Num) -> str | None:
    number = solved.number(value)
    if number is None:
        return None
    return ", ".join(filter(None, (number_text(number, value.dimension), standing(solved, value))))


def standing(solved: Solved, value: Num) -> str:
    """Returns how far a number may change: `free`, `kept`, `solved`, `exact`; "" for a constant, and if that
    is not known.
    """
    unknowns = list(ex.unknowns([value.expression]))
    changing = [u for u in unknowns if not u.exact and u in solved.evaluate.values]
    if not changing:
        return _exact(value, unknowns)
    if isinstance(value.expression.payload, Unknown):
        return _of_one(solved, changing[0])
    if all(u.kept for u in changing):
        return "kept"
    if not any(u.path in solved.free for u in changing):
        return "solved"
    moves = solved.moves(value)
    return "" if moves is None else "free" if moves else "solved"


def _exact(value: Num, unknowns: list[Unknown]) -> str:
    if value.status is Exactness.PARAM:
        return "exact (param)"
    if value.status >= Exactness.FIXED:
        return "exact"
    return "as written" if unknowns else ""


def _of_one(solved: Solved, unknown: Unknown) -> str:
    if unknown.kept:
        model = solved.outcome.model
        changed = {c.path: c for c in model.changed} if model is not None else {}
        change = changed.get(unknown.path)
        return "kept" if change is None else f"had to change from {fixed(change.written, DECIMALS)}"
    return "free" if unknown.path in solved.free else "solved"


def _point(solved: Solved, value: PointVal) -> str | None:
    x, y = solved.number(value.x), solved.number(value.y)
    if x is None or y is None:
        return None
    ways = list(dict.fromkeys(standing(solved, n) for n in (value.x, value.y)))
    how = ways[0] if len(ways) == 1 else f"x {ways[0]}, y {ways[1]}" if all(ways) else ""
    return f"({fixed(x, DECIMALS)}, {fixed(y, DECIMALS)})" + (f", {how}" if how else "")


def _frame(env: Env) -> str:
    """Returns the name of the frame of coordinates, unless it is the root's."""
    return f" (in {env.here.name})" if env.here.parent is not None else ""


def _geometry(solved: Solved, name: str, geometry: Geometry, env: Env) -> Iterator[str]:
    primitive = PRIMITIVES.get(geometry.type)
    for field in primitive.shown if primitive is not None else geometry.arguments:
        value = solved.read(_member(geometry, field), _named(env, geometry))
        if isinstance(value, Num | PointVal):
            yield from _lines(solved, f"{name}.{field}", value, env)
    if geometry.is_compound and (size := _box_size(solved, geometry, env)) is not None:
        yield f"{name}: {size}"


_SUBJECT = "subject"


def _member(geometry: Geometry, field: str) -> ast.Member:
    """Returns `subject.field`; `_named` replaces the subject."""
    span = geometry.span
    assert span is not None or geometry.owner.span is not None
    at = span or geometry.owner.span
    assert at is not None
    return ast.Member(ast.Name(_SUBJECT, span=at), ast.Identifier(field, span=at), span=at)


def _named(env: Env, geometry: Geometry) -> Env:
    scope = Scope(env.scope, turn=True)
    scope.values[_SUBJECT] = geometry
    return Env(scope, env.here, env.reach)


def _box_size(solved: Solved, thing: Geometry, env: Env) -> str | None:
    box = boxes.box_of(thing, env.here)
    sides = [v for side in ("width", "height") if box is not None and (v := box.field(side)) is not None]
    numbers = [solved.number(side) for side in spelled(*sides) if isinstance(side, Num)]
    if len(numbers) != 2 or any(n is None or not math.isfinite(n) for n in numbers):
        return None
    return f"{fixed(numbers[0] or 0.0, DECIMALS)} × {fixed(numbers[1] or 0.0, DECIMALS)} mm"


def _structure(solved: Solved, name: str, structure: Structure) -> Iterator[str]:
    model = solved.outcome.model
    found = model.root.find(structure.path) if model is not None else None
    if model is None or found is None:
        return
    if found.box is not None:
        box = found.box
        size = f"{fixed(box.width, DECIMALS)} × {fixed(box.height, DECIMALS)} mm"
        across = f"x {fixed(box.left, DECIMALS)} … {fixed(box.right, DECIMALS)}"
        up = f"y {fixed(box.bottom, DECIMALS)} … {fixed(box.top, DECIMALS)}"
        yield f"{name}: {found.kind}, {size}, {across}, {up}"
    else:
        yield f"{name}: {found.kind}, nothing drawn"
    count, state = model.mobility().of(found)
    degrees = f"{count} degrees of freedom" if count is not None else ""
    if count == 1:
        degrees = "1 degree of freedom"
    said = ", ".join(filter(None, (_STATES.get(state, ""), degrees)))
    if said:
        yield f"{name}: {said}"


def _truth(solved: Solved, value: bool | Condition) -> str:
    return "true" if holds(value, solved.evaluate, _TOLERANCE) else "false"


def constraint_lines(solved: Solved, span: Span) -> list[str]:
    """Tells how well the constraint at a place holds; for one in a loop, in how many turns."""
    model = solved.outcome.model
    reports = [r for r in model.constraints if r.span == span] if model is not None else []
    if not reports:
        return []
    wrong = [abs(r.residual) for r in reports if not r.satisfied]
    is_wish = reports[0].soft
    if not wrong:
        return [
            ("This wish is fulfilled" if is_wish else "This constraint holds") + _times(len(reports)) + "."
        ]
    head = "This wish is not wholly fulfilled" if is_wish else "This constraint does not hold"
    count = f" in {len(wrong)} of {len(reports)} cases" if len(reports) > 1 else ""
    return [f"{head}{count}: it is off by {fixed(max(wrong), DECIMALS)}."]


def _times(count: int) -> str:
    return f" in all {count} cases" if count > 1 else ""

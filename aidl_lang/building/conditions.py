"""Conditions: comparing values, joining comparisons, and testing whether a condition holds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TypeAlias

from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import box_of, boxes_in, source_unknowns, spelled_out
from aidl_lang.building.coerce import as_point, numeric
from aidl_lang.building.expression import Expression, Unknown
from aidl_lang.building.model import Comparison, Condition, Geometry, Structure
from aidl_lang.building.state import Env, Interpreter
from aidl_lang.building.values import (
    NOTHING,
    Array,
    ListVal,
    Nothing,
    Num,
    PointVal,
    TextVal,
    Value,
    members,
    type_of,
)
from aidl_lang.checking import rules, units
from aidl_lang.checking.rules import shown
from aidl_lang.checking.units import ANGLE
from aidl_lang.syntax import ast

RELATIONS = ("==", "<=", ">=", "<", ">")
"""Relations that can constrain; `!=` can only be asserted or tested."""

EXACT = 1e-9
"""The part of their size by which constants may differ and still count as equal."""


def compare(
    it: Interpreter,
    relation: str,
    left: Value,
    right: Value,
    node: ast.Node,
    env: Env,
    left_node: ast.Node,
    right_node: ast.Node,
) -> Value:
    """Returns `left relation right`, a truth if both are constants; of a list it is asked of each member."""
    if isinstance(left, Nothing) or isinstance(right, Nothing):
        return NOTHING
    if isinstance(left, TextVal | bool) or isinstance(right, TextVal | bool):
        if relation not in ("==", "!=") or type(left) is not type(right):
            return _incomparable(it, relation, left, right, node, left_node, right_node)
        one, other = (side.value if isinstance(side, TextVal) else side for side in (left, right))
        return (one == other) == (relation == "==")
    if (pairs := _one_by_one(relation, left, right)) is not None:
        every: Value = True
        for first, second in pairs:
            pair = compare(it, relation, first, second, node, env, left_node, right_node)
            every = conjunction(it, "and", every, pair, node)
        return every
    a, b = as_point(it, left, left_node, env), as_point(it, right, right_node, env)
    if a is not None and b is not None:
        return _compare_points(it, relation, a, b, node)
    if a is not None or b is not None:
        return _incomparable(it, relation, left, right, node, left_node, right_node)
    x, y = numeric(it, left, left_node, env), numeric(it, right, right_node, env)
    return compare_numbers(it, relation, x, y, node) if x is not None and y is not None else NOTHING


def _one_by_one(relation: str, left: Value, right: Value) -> list[tuple[Value, Value]] | None:
    """Returns the pairs that a relation with a list in it is asked of: each member and the other side, or
    those of two lists of one length in their order; None where two values compare as they are.
    """
    lists = [members(side) if isinstance(side, ListVal | Array) else None for side in (left, right)]
    one, other = lists
    if relation == "!=" or (one is None and other is None):
        return None
    if one is not None and other is not None:
        return list(zip(one, other, strict=True)) if len(one) == len(other) else None
    if one is not None:
        return None if _is_pair(one) and _is_point(right) else [(each, right) for each in one]
    assert other is not None
    return None if _is_pair(other) and _is_point(left) else [(left, each) for each in other]


def _is_pair(values: Sequence[Value]) -> bool:
    """Tells whether the members of a list may be the coordinates of a point."""
    return len(values) == 2 and all(isinstance(value, Num) for value in values)


def _is_point(value: Value) -> bool:
    return isinstance(value, PointVal) or (isinstance(value, Geometry) and value.type == "point")


def _incomparable(
    it: Interpreter,
    relation: str,
    left: Value,
    right: Value,
    node: ast.Node,
    left_node: ast.Node,
    right_node: ast.Node,
) -> Nothing:
    sides = shown(left_node), shown(right_node)
    it.misfit(rules.no_comparison(relation, type_of(left), type_of(right), *sides), node)
    return NOTHING


def _compare_points(it: Interpreter, relation: str, a: PointVal, b: PointVal, node: ast.Node) -> Value:
    if relation not in ("==", "!="):
        it.misfit(rules.no_order(relation), node)
        return NOTHING
    both = conjunction(
        it, "and", compare_numbers(it, "==", a.x, b.x, node), compare_numbers(it, "==", a.y, b.y, node), node
    )
    return both if relation == "==" else negation(it, both, node)


def compare_numbers(it: Interpreter, relation: str, a: Num, b: Num, node: ast.Node) -> Value:
    try:
        dimension = units.add(a.dimension, b.dimension)
    except units.UnequalError as pair:
        it.misfit(rules.unequal(f"`{relation}` does not compare", *pair.args), node)
        return NOTHING
    left, right = spelled_out(a.expression, b.expression, equal=relation == "==", whole=it.whole_boxes)
    if left.is_constant and right.is_constant:
        return _relates(relation, left.value, right.value, dimension == ANGLE, EXACT, strict=True)
    boxes, beside = boxes_in(a.expression, b.expression)
    return Condition("and", (Comparison(relation, left, right, dimension, None, boxes, beside),))


def _relates(
    relation: str, a: float, b: float, is_angle: bool, tolerance: float, *, strict: bool = False
) -> bool:
    """Tells whether a relation holds within a tolerance; if `strict`, `<` and `>` do not hold for equals."""
    difference = a - b
    if is_angle and relation in ("==", "!="):
        difference = (difference + 180.0) % 360.0 - 180.0
    near = abs(difference) <= tolerance * max(1.0, abs(a), abs(b))
    match relation:
        case "==":
            return near
        case "!=":
            return not near
        case "<=":
            return near or difference < 0
        case "<":
            return not strict if near else difference < 0
        case ">":
            return not strict if near else difference > 0
        case _:
            return near or difference > 0


def conjunction(it: Interpreter, operator: str, left: Value, right: Value, node: ast.Node) -> Value:
    """Returns `left and right` or `left or right`, without constants that decide nothing."""
    if isinstance(left, Nothing) or isinstance(right, Nothing):
        return NOTHING
    for side in (left, right):
        if not isinstance(side, bool | Condition):
            it.misfit(rules.needed("a condition", type_of(side)), node)
            return NOTHING
    neutral = operator == "and"
    if left is neutral:
        return right
    if right is neutral:
        return left
    if isinstance(left, bool) or isinstance(right, bool):
        return not neutral
    assert isinstance(left, Condition)
    assert isinstance(right, Condition)
    if left.operator == right.operator == operator:
        return Condition(operator, left.parts + right.parts)
    return Condition(operator, (left, right))


def negation(it: Interpreter, value: Value, node: ast.Node) -> Value:
    match value:
        case bool():
            return not value
        case Condition():
            return Condition("not", (value,))
        case Nothing():
            return NOTHING
        case _:
            it.misfit(rules.needed("a condition", type_of(value)), node)
            return NOTHING


def all_of(parts: Iterable[Value]) -> Value:
    """Returns the conjunction of conditions; NOTHING if one of them failed."""
    found: list[Condition | Comparison | bool] = []
    for part in parts:
        if isinstance(part, Nothing):
            return NOTHING
        if isinstance(part, Condition):
            found += part.parts if part.operator == "and" else (part,)
        elif part is False:
            found.append(False)
    return Condition("and", tuple(found)) if found else True


def holds(
    condition: Condition | Comparison | bool,
    evaluate: Callable[[Expression], float],
    tolerance: float,
    *,
    strict: bool = False,
) -> bool:
    """Tells whether a condition is true at given values, within a tolerance relative to their size; `strict`
    keeps `<` and `>` from holding for equals.
    """
    if isinstance(condition, bool):
        return condition
    if isinstance(condition, Comparison):
        a, b = evaluate(condition.left), evaluate(condition.right)
        if not (math.isfinite(a) and math.isfinite(b)):
            return False
        return _relates(condition.relation, a, b, condition.dimension == ANGLE, tolerance, strict=strict)
    parts = (holds(part, evaluate, tolerance, strict=strict) for part in condition.parts)
    match condition.operator:
        case "and":
            return all(parts)
        case "or":
            return any(parts)
        case _:
            return not all(parts)


Parties: TypeAlias = tuple[frozenset[Unknown], ...]


def placed_by(comparison: Comparison, placed: frozenset[Unknown], parties: Parties = ()) -> Comparison:
    return replace(comparison, moved=placed, parties=parties)


def replace_placed(condition: Condition, placed: frozenset[Unknown], parties: Parties = ()) -> Condition:
    """Returns the same condition, with other unknowns moving first."""
    parts: list[Condition | Comparison | bool] = []
    for part in condition.parts:
        if isinstance(part, Comparison):
            part = placed_by(part, placed, parties)
        parts.append(replace_placed(part, placed, parties) if isinstance(part, Condition) else part)
    return Condition(condition.operator, tuple(parts))


def value_unknowns(value: Value, here: Structure) -> Iterator[Unknown]:
    """Yields the unknowns that place a value, as seen from a structure."""
    match value:
        case Num(expression=e):
            yield from ex.unknowns([e])
        case PointVal(x, y):
            yield from ex.unknowns([x.expression, y.expression])
        case ListVal() | Array():
            for item in members(value) or ():
                yield from value_unknowns(item, here)
        case _:
            box = box_of(value, here)
            for source in box.sources if box else ():
                yield from source_unknowns(source, here)

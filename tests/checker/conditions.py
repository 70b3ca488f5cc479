"""Residuals of conditions: how far each comparison that a constraint makes is from holding."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from aidl_lang.syntax import ast
from tests.checker.functions import FUNCTIONS, between, is_line
from tests.checker.relations import RELATIONS
from tests.checker.tree import Geo
from tests.checker.values import MistakeError, Num, Point, Scope, Thunk, fold

if TYPE_CHECKING:
    from tests.checker.evaluate import Evaluator


def residuals(ev: Evaluator, e: ast.Expression, scope: Scope) -> list[float]:
    """One residual for each comparison; 0 where it holds."""
    match e:
        case ast.Comparison(operands, operators):
            return [
                r
                for i, operator in enumerate(operators)
                for r in _compared(ev, operands[i], operator, operands[i + 1], scope)
            ]
        case ast.Membership():
            return _member_of(ev, e, scope)
        case ast.Binary("and", left, right):
            return residuals(ev, left, scope) + residuals(ev, right, scope)
        case ast.Conditional(test, then, otherwise):
            return residuals(ev, then if ev.truth(test, scope) else otherwise, scope)
        case ast.Call():
            return _call(ev, e, scope)
        case ast.Name(text):
            found = scope.find(text)
            if found is not None and isinstance(found[0], Thunk):
                return residuals(ev, found[0].expression, found[0].scope)
    value = ev.value(e, scope)
    if not isinstance(value, bool):
        raise MistakeError(f"{type(value).__name__} is no condition")
    return [0.0 if value else math.inf]


def _compared(
    ev: Evaluator, left: ast.Expression, operator: str, right: ast.Expression, scope: Scope
) -> list[float]:
    if operator == "==" and (found := _ambiguous_angle(ev, left, right, scope)) is not None:
        return found
    return ev.together(lambda: compare(ev, ev.value(left, scope), operator, ev.value(right, scope)))


def _ambiguous_angle(
    ev: Evaluator, left: ast.Expression, right: ast.Expression, scope: Scope
) -> list[float] | None:
    """`angle(a, b) == v` holds in any of its readings."""
    for call, other in ((left, right), (right, left)):
        if isinstance(call, ast.Call) and fold(call.callee.text) == "angle":
            lines, _ = ev.arguments(call, scope)
            if len(lines) == 2 and all(map(is_line, lines)):
                return [angle_readings(between(ev, *lines), ev.number(ev.value(other, scope)).value)]
    return None


def angle_readings(angle: float, value: float) -> float:
    """How far an angle between lines is from the nearest meaning of a value."""
    return min(turn_apart(angle, v) for v in (value, -value, 180 - value, value - 180))


def turn_apart(a: float, b: float) -> float:
    return abs((a - b + 180) % 360 - 180)


def compare(ev: Evaluator, a: Any, operator: str, b: Any) -> list[float]:
    """Two values by one of `== <= >= < >`."""
    if isinstance(a, str | bool) or isinstance(b, str | bool):
        holds = {"==": a == b, "!=": a != b}[operator]
        return [0.0 if holds else math.inf]
    p, q = _sides(ev, a, b)
    if isinstance(p, Point) and isinstance(q, Point) and operator == "==":
        return [abs(p.x.value - q.x.value), abs(p.y.value - q.y.value)]
    if not (isinstance(p, Num) and isinstance(q, Num)):
        raise MistakeError(f"{type(a).__name__} {operator} {type(b).__name__}")
    match operator:
        case "==" if p.is_angle or q.is_angle:
            return [turn_apart(p.value, q.value)]
        case "==":
            return [abs(p.value - q.value)]
        case "<=" | "<":
            return [max(0.0, p.value - q.value)]
        case ">=" | ">":
            return [max(0.0, q.value - p.value)]
    raise MistakeError(f"`{operator}` does not constrain")


def _sides(ev: Evaluator, a: Any, b: Any) -> tuple[Any, Any]:
    if isinstance(a, Geo) and isinstance(b, Geo) and a.type == b.type == "line":
        return ev.number(a), ev.number(b)
    return ev.plain(a), ev.plain(b)


def _member_of(ev: Evaluator, e: ast.Membership, scope: Scope) -> list[float]:
    value = ev.value(e.value, scope)
    if isinstance(e.container, ast.Range):
        low, high = (ev.value(x, scope) for x in (e.container.start, e.container.end))
        return compare(ev, value, ">=", low) + compare(ev, value, "<=", high)
    items = ev.items(ev.value(e.container, scope))
    return [min(max(compare(ev, value, "==", item)) for item in items)] if items else [math.inf]


def _call(ev: Evaluator, e: ast.Call, scope: Scope) -> list[float]:
    """A relation of a program, else one of the vocabulary, else a condition that a function gives."""
    positional, named = ev.arguments(e, scope)
    found = ev.entered(scope.own(e.callee.text), positional, named)
    if found is not None and isinstance(found[0], ast.ConstraintDefinition):
        return [r for item in items(ev, found[0].body, found[1]) for r in item]
    if found is not None and isinstance(found[0], ast.FunctionDefinition):
        return residuals(ev, found[0].value, found[1])
    name = fold(scope.canonical(e.callee.text))
    if name == "dimension":  # it is drawn, and nothing has to hold for it
        return []
    relation = RELATIONS.get(fold(e.callee.text)) or RELATIONS.get(name)
    if relation is not None:
        return relation(ev, *positional, **ev.renamed(relation, named))
    if name in FUNCTIONS:
        value = FUNCTIONS[name](ev, *positional, **named)
        if isinstance(value, bool):
            return [0.0 if value else math.inf]
    raise MistakeError(f"no relation named {e.callee.text}")


def items(ev: Evaluator, body: ast.Block, scope: Scope) -> Iterator[list[float]]:
    """The residuals of each item of a block of constraints; soft ones left out."""
    for expression, inner in expressions(ev, body, scope):
        yield residuals(ev, expression, inner)


def expressions(ev: Evaluator, body: ast.Block, scope: Scope) -> Iterator[tuple[ast.Expression, Scope]]:
    """The constraining expressions of a block, loops and branches taken, each with the names it sees."""
    for item in body.statements:
        match item:
            case ast.ExpressionStatement(value):
                yield value, scope
            case ast.Equation(left, right):
                yield ast.Comparison((left, right), ("==",), span=item.span), scope
            case ast.Assign(name, (), value):
                target = ast.Name(name.text, span=name.span)
                yield ast.Comparison((target, value), ("==",), span=item.span), scope
            case ast.Constrain(inner_body):
                yield from expressions(ev, inner_body, scope)
            case ast.Let(name, value):
                scope = Scope(scope, {name.text: Thunk(value, scope)})
            case ast.For(variables, iterable, inner_body):
                for value in ev.items(ev.value(iterable, scope)):
                    yield from expressions(ev, inner_body, ev.bound(variables, value, scope))
            case ast.If(test, then, otherwise):
                branch = then if ev.truth(test, scope) else otherwise
                if branch is not None:
                    yield from expressions(ev, branch, scope)

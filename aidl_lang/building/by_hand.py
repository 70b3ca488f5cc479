"""Dimensions that the program asks for: `dimension(a, b, offset: 8)`."""

from __future__ import annotations

from collections.abc import Iterator

from aidl_lang.building.boxes import Box
from aidl_lang.building.evaluate import evaluate
from aidl_lang.building.model import Constraint, Geometry, Structure
from aidl_lang.building.state import Env, Interpreter
from aidl_lang.building.values import Nothing, Num, PointVal, TextVal, Value
from aidl_lang.building.wording import Wording
from aidl_lang.common.materials import is_fit
from aidl_lang.common.names import fold
from aidl_lang.syntax import ast

NAME = "dimension"
OPTIONS = ("offset", "tolerance", "fit")
LEVEL = frozenset({"left", "right", "center_x", "x"})
UPRIGHT = frozenset({"bottom", "top", "center_y", "y"})

_MEASURED_ALONE = frozenset({"line", "circle", "arc"})


def is_by_hand(it: Interpreter, node: ast.Call) -> bool:
    """Tells whether a call is that of the library's `dimension`."""
    candidates = it.program.resolution.candidates.get(node, ())
    return it.spelled(node.callee) == NAME and all(candidate.standard for candidate in candidates)


def measured(node: ast.Call) -> list[ast.Expression]:
    """Returns the things that a dimension measures, as they are written."""
    receiver = [node.receiver] if node.receiver is not None else []
    return [*receiver, *(a.value for a in node.arguments if a.name is None or a.name.text not in OPTIONS)]


def options(node: ast.Call) -> dict[str, ast.Expression]:
    return {a.name.text: a.value for a in node.arguments if a.name is not None and a.name.text in OPTIONS}


def record_dimension(it: Interpreter, node: ast.Call, env: Env) -> None:
    """Notes a dimension for the drawing; reports one that measures nothing."""
    if isinstance(evaluate(it, node, env), Nothing):
        return
    things = measured(node)
    values = [evaluate(it, thing, env) for thing in things]
    reason = next(_reasons(it, things, values), "")
    if reason:
        hint = "as in `dimension(body.left, eye.center)`, `dimension(a.x, b.x)` or `dimension(rim)`"
        it.report("E0590", f"this dimension measures nothing: {reason}", node, hints=[hint])
        return
    said = {name: evaluate(it, value, env) for name, value in options(node).items()}
    fit, tolerance = said.get("fit"), said.get("tolerance")
    if isinstance(fit, TextVal) and fit.value and not is_fit(fit.value):
        hint = "holes are H6 to H11, F7, G7, K7, N7, P7 …; shafts h6 to h11, f7, g6, k6, n6, p6 …"
        it.report("E0590", f"there is no fit `{fit.value}`", options(node)["fit"], hints=[hint])
    elif isinstance(tolerance, Num) and not tolerance.value >= 0:
        hint = "`tolerance: 0.1` is written as ±0.1"
        it.report("E0590", "a tolerance is above 0", options(node)["tolerance"], hints=[hint])
    else:
        text, span, turn = it.said(node, env)
        wording = Wording(node, it, env, evaluate)
        it.by_hand.append(Constraint(env.here, (), text, span, None, turn, wording))


def axis_of(node: ast.Expression, value: Value) -> int | None:
    """Returns the axis along which something is a coordinate; None for a place in the plane."""
    if isinstance(value, Num) and isinstance(node, ast.Member):
        name = fold(node.name.text)
        return next((k for k, names in enumerate((LEVEL, UPRIGHT)) if name in set(map(fold, names))), None)
    return None


def _reasons(it: Interpreter, things: list[ast.Expression], values: list[Value]) -> Iterator[str]:
    for thing, value in zip(things, values, strict=True):
        is_coordinate = axis_of(thing, value) is not None
        if not is_coordinate and not isinstance(value, PointVal | Geometry | Structure | Box):
            yield f"`{thing.span.one_line}` is no part of the drawing"
    axes = [axis_of(thing, value) for thing, value in zip(things, values, strict=True)]
    if len(set(axes) - {None}) > 1:
        yield "one end is a place from left to right, the other one a place from bottom to top"
    if len(things) == 1:
        (value,) = values
        if not isinstance(value, Geometry) or value.type not in _MEASURED_ALONE:
            yield f"`{things[0].span.one_line}` alone is no line, circle or arc"

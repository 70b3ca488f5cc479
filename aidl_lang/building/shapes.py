"""Questions about shapes that the library cannot answer in AIDL: sizes, corners, a way to refuse."""

from __future__ import annotations

import math
from collections.abc import Sequence

from aidl_lang.building.coerce import look
from aidl_lang.building.model import Geometry
from aidl_lang.building.scopes import Scope
from aidl_lang.building.state import Arguments, Env, Interpreter
from aidl_lang.building.values import NOTHING, ListVal, Num, PointVal, TextVal, Value
from aidl_lang.checking.units import LENGTH
from aidl_lang.syntax import ast

_NONE = ListVal(())


def _sizes(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns the lengths among a compound shape's parameters, in their order; none for anything else."""
    shape = a["of"]
    if not isinstance(shape, Geometry) or not isinstance(shape.scope, Scope):
        return _NONE
    found = (shape.scope.values.get(name) for name in shape.arguments)
    return ListVal(tuple(v for v in found if isinstance(v, Num) and v.dimension == LENGTH))


def _convex_corners(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns the corners of a shape of straight edges, in order, if it is convex as written; none
    otherwise.

    Corners that were given one by one may become something else while solving, so they do not count.
    """
    shape = a["of"]
    if not isinstance(shape, Geometry) or not isinstance(shape.scope, Scope):
        return _NONE
    edges = [part for part in shape.primitives() if part.type != "point"]
    given_one_by_one = any(isinstance(shape.scope.values.get(n), ListVal) for n in shape.arguments)
    if given_one_by_one or any(edge.type != "line" for edge in edges):
        return _NONE
    starts, ends = ([look(it, edge, node, env)[name] for edge in edges] for name in ("start", "end"))
    at = [_at(p) for p in starts]
    closed = all(
        math.dist(_at(p), q) < 1e-9 * math.dist(at[0], q) + 1e-9 for p, q in zip(ends, _next(at), strict=True)
    )
    return ListVal(tuple(starts)) if closed and _is_convex(at) else _NONE


def _at(point: Value) -> tuple[float, float]:
    assert isinstance(point, PointVal)
    return point.x.value, point.y.value


def _is_convex(corners: Sequence[tuple[float, float]]) -> bool:
    """Tells whether all corners turn to the same side, and together once around."""
    ways = [(q[0] - p[0], q[1] - p[1]) for p, q in zip(corners, _next(corners), strict=True)]
    turns = [
        math.atan2(v[0] * w[1] - v[1] * w[0], v[0] * w[0] + v[1] * w[1])
        for v, w in zip(ways, _next(ways), strict=True)
    ]
    return len(turns) > 2 and abs(abs(sum(turns)) - math.tau) < 1e-6 and (min(turns) > 0 or max(turns) < 0)


def _next(items: Sequence[tuple[float, float]]) -> Sequence[tuple[float, float]]:
    return [*items[1:], *items[:1]]


def _refuse(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    why = a["why"]
    assert isinstance(why, TextVal)
    it.refuse(node, why.value)
    return NOTHING


FUNCTIONS = {"sizes": _sizes, "convex_corners": _convex_corners, "refuse": _refuse}

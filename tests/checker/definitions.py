"""Definitions against the document: what was written exactly is there exactly, kept sizes are kept."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any

from aidl_lang.syntax import ast
from tests.checker.binding import respelled
from tests.checker.evaluate import Evaluator
from tests.checker.paths import OUTLINES, joints
from tests.checker.tree import Geo, Node
from tests.checker.values import Exact, MistakeError, Num, Point, Scope, fold

_P, _S, _A = "point", "size", "angle"

_CONSTRUCTORS: dict[str, tuple[dict[str, str], ...]] = {
    "point": ({"x": "coordinate", "y": "coordinate"},),
    "line": ({"start": _P, "end": _P}, {"start": _P, "length": _S, "angle": _A}),
    "circle": ({"center": _P, "radius": _S}, {"center": _P, "diameter": _S}),
    "arc": (
        {"center": _P, "start": _P, "end": _P},
        {"center": _P, "radius": _S, "start_angle": _A, "end_angle": _A},
        {"start": _P, "end": _P, "radius": _S},
        {"start": _P, "mid": "through", "end": _P},
    ),
    "ellipse": ({"center": _P, "rx": _S, "ry": _S, "angle": _A},),
    "bezier": ({"p0": _P, "p1": _P, "p2": _P, "p3": _P},),
    "rectangle": ({"center": _P, "width": _S, "height": _S, "angle": _A},),
    "square": ({"center": _P, "size": _S, "angle": _A},),
    "rounded_rectangle": ({"center": _P, "width": _S, "height": _S, "radius": _S},),
    "trapezoid": ({"center": _P, "bottom_width": _S, "top_width": _S, "height": _S},),
    "ring": ({"center": _P, "outer_radius": _S, "inner_radius": _S},),
    "regular_polygon": ({"center": _P, "radius": _S},),
    "slot": ({"center": _P, "length": _S, "width": _S},),
    "sector": ({"center": _P, "radius": _S},),
}

_OPTIONS = ("clockwise", "large", "rotatable", "sides", "start_angle", "end_angle", "angle")


@dataclass(frozen=True)
class Expected:
    """A field of a geometry and what was written for it."""

    name: str
    residual: float


def expected(
    ev: Evaluator,
    s: ast.Assign,
    geo: Geo,
    scope: Scope,
    changed: Collection[str],
    least: Exact = Exact.FIXED,
) -> list[Expected]:
    """The fields of a geometry that had no freedom, with how far they are from what was written.

    `least` is the exactness from which a position is exact: a constraint may hold what is written less so.
    """
    return [] if geo.is_edited else _as_written(ev, s.value, geo, scope, changed, least)


def _as_written(
    ev: Evaluator, value: ast.Expression, geo: Geo, scope: Scope, changed: Collection[str], least: Exact
) -> list[Expected]:
    """By a constructor that is known here, also where a function or a branch leads to it."""
    if isinstance(value, ast.Conditional):
        value = value.then if ev.truth(value.test, scope) else value.otherwise
        return _as_written(ev, value, geo, scope, changed, least)
    if not isinstance(value, ast.Call):
        return list(_shared_point(ev, value, geo, scope, least))
    name = scope.canonical(value.callee.text)
    if fold(name) == "tiled":  # it has tests of its own, and no fields
        return []
    if fold(name) in OUTLINES and not scope.own(name):
        return [Expected(n, r) for n, r in joints(ev, value, geo, scope, changed)]
    kinds = next((c for n, c in _CONSTRUCTORS.items() if fold(n) == fold(name)), ())
    written = {} if scope.own(name) else _written(ev, value, scope, kinds)
    if not written:
        inner = _within(ev, value, scope)
        return [] if inner is None else _as_written(ev, inner[0], geo, inner[1], changed, least)
    found: list[Expected] = []
    for word, (kind, value) in written.items():
        if kind == "through":
            continue
        if kind == _P:
            found += _position(ev, geo, word, ev.point(value), least)
        elif kind != "coordinate":
            found += _size(ev, geo, word, value, changed)
    return found + _rigid(ev, geo, written, changed)


def _within(ev: Evaluator, call: ast.Call, scope: Scope) -> tuple[ast.Expression, Scope] | None:
    """What a function is made of."""
    positional, named = ev.arguments(call, scope)
    found = ev.entered(scope.candidates(call.callee.text), positional, named)
    if found is None or not isinstance(found[0], ast.FunctionDefinition):
        return None
    return found[0].value, found[1]


def _shared_point(
    ev: Evaluator, value: ast.Expression, geo: Geo, scope: Scope, least: Exact
) -> Iterator[Expected]:
    """`p = (10, 20)`, or a point that follows others."""
    if geo.type == "point":
        at = ev.point(geo)
        try:
            written = ev.point(ev.value(value, scope))
        except MistakeError:
            return
        for axis in ("x", "y"):
            number: Num = getattr(written, axis)
            if number.exact >= least:
                yield Expected(axis, abs(number.value - getattr(at, axis).value))


def _written(
    ev: Evaluator, call: ast.Call, scope: Scope, kinds: tuple[dict[str, str], ...]
) -> dict[str, tuple[str, Any]]:
    """The arguments of a constructor by the names of its parameters, in the overload they fit."""
    positional, named = ev.arguments(call, scope)
    named = {n: v for n, v in named.items() if v is not None}
    for parameters in kinds:
        words = respelled([*parameters, *_OPTIONS], named)
        free = [p for p in parameters if p not in words]
        if len(positional) > len(free) or not all(n in parameters or n in _OPTIONS for n in words):
            continue
        bound = dict(zip(free, positional, strict=False))
        bound |= {n: v for n, v in words.items() if n in parameters}
        if all(_fits(ev, parameters[p], v) for p, v in bound.items()):
            return {p: (parameters[p], v) for p, v in bound.items()}
    return {}


def _fits(ev: Evaluator, kind: str, value: Any) -> bool:
    try:
        if kind in (_P, "through"):
            ev.point(value)
        else:
            ev.number(value)
    except MistakeError:
        return False
    return True


def _position(ev: Evaluator, geo: Geo, word: str, written: Point, least: Exact) -> Iterator[Expected]:
    actual: Point = ev.point(ev.member(geo, word))
    for axis in ("x", "y"):
        number: Num = getattr(written, axis)
        if number.exact >= least:
            yield Expected(f"{word}.{axis}", abs(number.value - getattr(actual, axis).value))


def _size(ev: Evaluator, geo: Geo, word: str, value: Any, changed: Collection[str]) -> Iterator[Expected]:
    """Exact when it says so; kept otherwise, unless the document tells that it changed."""
    number = ev.number(value)
    if number.exact == Exact.GUESS or (geo.type == "arc" and "angle" in word):
        return
    if number.exact == Exact.NUMBER and _told(geo, changed):
        return
    actual = ev.number(ev.member(geo, word)).value
    apart = abs(actual - number.value)
    yield Expected(word, abs((apart + 180) % 360 - 180) if word == "angle" else apart)


def _rigid(
    ev: Evaluator, geo: Geo, written: dict[str, tuple[str, Any]], changed: Collection[str]
) -> list[Expected]:
    """Of several literal points the differences are kept sizes."""
    if _told(geo, changed) or geo.type not in ("line", "arc", "bezier"):
        return []
    points = {w: ev.point(v) for w, (kind, v) in written.items() if kind == _P}
    literal = {w: p for w, p in points.items() if p.x.exact == p.y.exact == Exact.NUMBER}
    if len(literal) < 2 or "radius" in written:
        return []
    if geo.type == "arc" and "center" in written and len(literal) == 3:
        return []  # its two radii may differ as written, and something must give
    (first, p), *others = literal.items()
    base = ev.point(ev.member(geo, first)).xy
    found = []
    for word, q in others:
        actual = ev.point(ev.member(geo, word)).xy
        moved = (actual[0] - base[0] - q.xy[0] + p.xy[0], actual[1] - base[1] - q.xy[1] + p.xy[1])
        found.append(Expected(f"{word} - {first}", math.hypot(*moved)))
    return found


def _told(geo: Geo, changed: Collection[str]) -> bool:
    return any(c.startswith(f"{geo.path}.") for c in changed)


def frame(
    ev: Evaluator,
    child: Node,
    placement: ast.Placement | None,
    scope: Scope,
    least: Exact = Exact.FIXED,
) -> Iterator[Expected]:
    """`at` and `rotated` where they are exact; rotation is exact unless it is a guess."""
    local = child.local
    if child.is_edited:
        return
    if placement is not None and placement.at is not None:
        at = ev.point(ev.value(placement.at, scope))
        for axis, actual in (("x", local.x), ("y", local.y)):
            number: Num = getattr(at, axis)
            if number.exact >= least:
                yield Expected(f"at.{axis}", abs(number.value - actual))
    elif least < Exact.FIXED:
        yield Expected("at", math.hypot(local.x, local.y))
    angle = Num(0.0)
    if placement is not None and placement.rotated is not None:
        angle = ev.number(ev.value(placement.rotated, scope))
    if angle.exact != Exact.GUESS:
        actual = math.degrees(math.atan2(-local.b, local.d))
        yield Expected("rotated", abs((actual - angle.value + 180) % 360 - 180))


def held(here: Node, thing: Geo | Node) -> list[float]:
    """How far a thing is from where it was written, its contents and the frames up to `here` included."""
    found: list[Expected] = []
    holder = thing if isinstance(thing, Node) else thing.written.node
    while holder is not None and holder is not here:
        if holder.placed is not None:
            task = holder.placed
            found += frame(Evaluator(task.node), holder, task.statement, task.scope, Exact.GUESS)
        holder = holder.parent
    geometry = [thing] if isinstance(thing, Geo) else [g for n in thing.walk() for g in n.geometry.values()]
    for geo in geometry:
        task = geo.written
        found += expected(Evaluator(task.node), task.statement, geo, task.scope, (), Exact.GUESS)
    return [e.residual for e in found]

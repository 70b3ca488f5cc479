"""Paths and splines: each segment goes on where the one before ends, smooth and wide as its step says."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from aidl_lang.syntax import ast
from tests.checker.relations import direction_at, sine
from tests.checker.tree import Geo
from tests.checker.values import Exact, Scope, fold

if TYPE_CHECKING:
    from tests.checker.evaluate import Evaluator

OUTLINES = ("path", "spline", "rectilinearpolygon")
_GOES_ON = ("arc_by", "arc_tangent")


def joints(
    ev: Evaluator, call: ast.Call, geo: Geo, scope: Scope, changed: Collection[str]
) -> Iterator[tuple[str, float]]:
    """What is expected of an outline, each with how far it is from that."""
    segments = [p for n, p in geo.parts.items() if n.startswith("segment[")]
    for i, (a, b) in enumerate(pairwise(segments)):
        yield f"joint[{i + 1}]", math.dist(ev.member(a, "end").xy, ev.member(b, "start").xy)
    for name, point in geo.parts.items():
        if point.type == "point":
            index = int(name.rstrip("]").partition("[")[2])
            at, side = (index, "start") if index < len(segments) else (-1, "end")
            yield name, math.dist(ev.point(point).xy, ev.member(segments[at], side).xy)
    closes = math.dist(ev.member(segments[-1], "end").xy, ev.member(segments[0], "start").xy) < 1e-9
    if geo.type == "spline":
        for i, (a, b) in enumerate(pairwise([*segments, *(segments[:1] if closes else [])])):
            yield f"knot[{i + 1}]", _corner(ev, a, b)
    elif fold(scope.canonical(call.callee.text)) == "rectilinearpolygon":
        for i, segment in enumerate(segments):
            a, b = ev.member(segment, "start").xy, ev.member(segment, "end").xy
            yield f"segment[{i}]", min(abs(a[0] - b[0]), abs(a[1] - b[1]))
        yield "closed", 0.0 if closes else math.inf
    else:
        is_told = any(c.startswith(f"{geo.path}.") for c in changed)
        yield from _steps(ev, _records(ev, call, scope), segments, is_told)


def _steps(
    ev: Evaluator, steps: list[dict[str, Any]], segments: list[Geo], is_told: bool
) -> Iterator[tuple[str, float]]:
    for i, (step, segment) in enumerate(zip(steps, segments, strict=False)):
        if i and (step["smooth"] or step["kind"] in _GOES_ON):
            yield f"smooth[{i}]", _corner(ev, segments[i - 1], segment)
        radius = step.get("radius")
        if (
            radius is not None
            and radius.exact != Exact.GUESS
            and not (is_told and radius.exact < Exact.PARAM)
        ):
            yield f"radius[{i}]", abs(segment.data["radius"] - radius.value)
    if any(s["kind"] == "close" for s in steps):
        a, b = ev.member(segments[-1], "end").xy, ev.member(segments[0], "start").xy
        yield "closed", math.dist(a, b)


def _corner(ev: Evaluator, a: Geo, b: Geo) -> float:
    """The sine of the angle between two segments where one goes over into the other."""
    return sine(direction_at(ev, a, ev.member(a, "end").xy), direction_at(ev, b, ev.member(b, "start").xy))


def _records(ev: Evaluator, call: ast.Call, scope: Scope) -> list[dict[str, Any]]:
    """The steps; a plain point is a line that goes there."""
    positional, named = ev.arguments(call, scope)
    steps = list(_flat(positional))
    if not {"from", "start"} & set(named):
        del steps[0]  # where it starts
    return [s if isinstance(s, dict) else {"kind": "line_to", "smooth": False} for s in steps]


def _flat(items: list[Any]) -> Iterator[Any]:
    for item in items:
        if isinstance(item, list):
            yield from _flat(item)
        else:
            yield item

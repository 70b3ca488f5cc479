"""Points that follow a `param`: found by turning each param a little; the value wanted by a secant."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import TypeAlias

from aidl_lang import pipeline
from aidl_lang.building.model import Knob
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.names import fold
from aidl_lang.common.prose import shortest
from aidl_lang.geometry.curves import Vec
from aidl_lang.syntax import ast
from aidl_lang.tools.agents.workspace import RefusalError, edit_at
from aidl_lang.tools.ide.dragging.mobility import grips, is_somewhere
from aidl_lang.tools.ide.references import Refusal
from aidl_lang.tools.ide.workspace import View, hasty, run

MOST_KNOBS = 12
_SECONDS = 0.6
"""Time for trying all params once; the rest are not used for dragging."""
_NUDGE = 1e-3
"""Change of a param that shows what follows it, as a share of its range or value."""
_FOLLOWS = 1e-2
"""Least motion of a point that follows a param, mm per unit."""
_LAZY = 0.1
"""Motion per unit, mm, at which a param is preferred half as much as one with a large effect."""
_ROUNDS = 3
_BESIDE = 0.3
"""Sine of the least angle between the ways of two params that count as different."""

_KEPT = 16
"""Most values of params whose places are kept for the next step of a drag."""
Values: TypeAlias = frozenset[tuple[str, float]]
"""Values of params by their paths."""


def turned(view: View, grip: str, to: Vec, step: float) -> tuple[View, Vec, tuple[Edit, ...]] | Refusal:
    """Returns the program with one or two params changed, the point, and the edits of their defaults."""
    ways, tries = dict(slopes(view).get(grip, {})), _tries(view)
    values: dict[str, float] = {}
    at = _places(view).get(grip)
    for _ in range(2):
        if at is None or not ways or math.dist(at, to) <= step:
            break
        wanted = to[0] - at[0], to[1] - at[1]
        best = max(ways, key=lambda path: _promise(tries.knobs[path], wanted, ways[path]))
        way = ways.pop(best)
        value = tries.value(grip, best, values, to, way, step)
        if value is not None:
            values[best] = value
            at = tries.place(grip, values)
            ways = {path: other for path, other in ways.items() if _is_beside(other, way)}
    shown = tries.run(values)
    at = _places(shown).get(grip)
    if at is None:
        return Refusal("the program does not solve with the param turned that far")
    try:
        edits = tuple(edit for path, value in values.items() for edit in _set(view, path, value))
    except RefusalError as refused:
        return Refusal(refused.diagnostics[0].message)
    return shown, at, edits


@lru_cache(maxsize=4)
def slopes(view: View) -> Mapping[str, Mapping[str, Vec]]:
    """Returns for each point the params that it follows, with its velocity per unit of each."""
    before, found = _places(view), dict[str, dict[str, Vec]]()
    until = time.monotonic() + _SECONDS
    for knob in list(_numeric(view))[:MOST_KNOBS] if before else ():
        if time.monotonic() > until:
            break
        nudge = _nudge(knob)
        for name, at in _turned(view, {knob.path: float(knob.value) + nudge}).items():
            if name in before:
                x, y = ((b - a) / nudge for a, b in zip(before[name], at, strict=True))
                if is_somewhere((x, y)) and math.hypot(x, y) > _FOLLOWS:
                    found.setdefault(name, {})[knob.path] = x, y
    return found


def _numeric(view: View) -> Iterator[Knob]:
    """Yields the params with a number in the text of the view that are not set from outside."""
    assert view.outcome is not None
    given = {fold(name.strip()) for name in view.params or ()}
    for knob in view.outcome.knobs:
        is_number = isinstance(knob.value, float) and not knob.choices
        if is_number and _declaration(view, knob) is not None and fold(knob.path) not in given:
            yield knob


def _declaration(view: View, knob: Knob) -> ast.Param | None:
    if knob.span is None or knob.span.source is not view.source:
        return None
    if (node := view.params_written.get(knob.span)) is None:
        return None
    number = node.value.operand if isinstance(node.value, ast.Unary) else node.value
    return node if isinstance(number, ast.Number) else None


def _set(view: View, path: str, value: float) -> Iterator[Edit]:
    """Yields the edits that set a param. Raises RefusalError for a value that does not fit."""
    for knob in view.outcome.knobs if view.outcome is not None else ():
        declared = _declaration(view, knob)
        if knob.path == path and declared is not None:
            yield edit_at(knob, declared, value)


def _nudge(knob: Knob) -> float:
    value = float(knob.value)
    if knob.low is None or knob.high is None:
        return knob.step or _NUDGE * max(1.0, abs(value))
    nudge = knob.step or _NUDGE * (knob.high - knob.low) or _NUDGE
    return nudge if value + nudge <= knob.high else -nudge


def _places(view: View) -> dict[str, Vec]:
    """Returns all points; none of a program that does not solve."""
    outcome = view.outcome
    if outcome is None or outcome.built is None or outcome.evaluate is None or outcome.status != "solved":
        return {}
    return {grip.id: grip.at(outcome.evaluate) for grip in grips(outcome.built)}


def _turned(view: View, values: Mapping[str, float]) -> dict[str, Vec]:
    """Returns all points with other values of params; none if that does not solve."""
    found = pipeline.placed(view.program, {**(view.params or {}), **values})
    return {} if found is None else {grip.id: grip.at(found[1]) for grip in grips(found[0])}


class _Tries:
    """Runs of a view with other params. The last ones are kept: a drag begins each step at the nearest."""

    def __init__(self, view: View) -> None:
        assert view.outcome is not None
        self.view = view
        self.knobs = {knob.path: knob for knob in reversed(view.outcome.knobs)}
        self._shown: dict[Values, View] = {}
        self._places: dict[Values, Mapping[str, Vec]] = {}

    def run(self, values: Mapping[str, float]) -> View:
        """Returns the view with these values, drawn."""
        key = frozenset(values.items())
        if key not in self._shown:
            shown = run(self.view, self.view, params={**(self.view.params or {}), **values}, settings=hasty())
            self._shown = {key: shown}
        return self._shown[key]

    def place(self, grip: str, values: Mapping[str, float], *, likely: bool = False) -> Vec | None:
        """Returns a point's place with these values, None if unsolved. `likely` ones will be shown."""
        key = frozenset(values.items())
        if key not in self._places:
            is_shown = likely or key in self._shown
            found = _places(self.run(values)) if is_shown else _turned(self.view, values)
            self._places = {**dict(list(self._places.items())[1 - _KEPT :]), key: found}
        return self._places[key].get(grip)

    def nearest(self, grip: str, path: str, values: Mapping[str, float], to: Vec) -> tuple[float, Vec] | None:
        """Returns the value of a param, beside others, that brought a point nearest to a place; and where."""
        beside = frozenset((other, value) for other, value in values.items() if other != path)
        known = [
            (value, at)
            for key, places in self._places.items()
            if (at := places.get(grip)) is not None and beside <= key and len(key) == len(beside) + 1
            for name, value in key - beside
            if name == path
        ]
        return min(known, key=lambda each: math.dist(each[1], to), default=None)

    def value(
        self, grip: str, path: str, values: Mapping[str, float], to: Vec, way: Vec, step: float
    ) -> float | None:
        """Returns the value that brings a point nearest to a place along its way; None if no other solves."""
        knob, slope = self.knobs[path], math.hypot(*way)
        value, best = float(knob.value), None
        at = self.place(grip, values) if values else _places(self.view).get(grip)
        if (known := self.nearest(grip, path, values, to)) is not None:
            value, at = known
            best = value
        for _ in range(_ROUNDS):
            if at is None:
                break
            off = _along((to[0] - at[0], to[1] - at[1]), way)
            if best is not None and abs(off) <= step:
                break
            aimed = _rounded(knob, _clamped(knob, value + off / slope), step / slope)
            if aimed == value:
                break
            before, value = (value, at), aimed
            at = self.place(grip, {**values, path: value}, likely=best is not None)
            if at is not None:
                best = value
                gone = _along((at[0] - before[1][0], at[1] - before[1][1]), way)
                slope = gone / (value - before[0]) if abs(gone) > _FOLLOWS * abs(value - before[0]) else slope
        return None if best == float(knob.value) else best


@lru_cache(maxsize=4)
def _tries(view: View) -> _Tries:
    return _Tries(view)


def _promise(knob: Knob, wanted: Vec, way: Vec) -> float:
    """Returns how far a param could move a point along a way in its range, weighted by effect per unit."""
    slope, along, value = math.hypot(*way), _along(wanted, way), float(knob.value)
    room = abs(_clamped(knob, value + along / slope) - value) * slope
    return min(abs(along), room) * slope / (slope + _LAZY)


def _clamped(knob: Knob, value: float) -> float:
    low = -math.inf if knob.low is None else knob.low
    high = math.inf if knob.high is None else knob.high
    return min(max(value, low), high)


def _rounded(knob: Knob, value: float, tolerance: float) -> float:
    """Rounds a value to the steps of a param, or to few digits; keeps the ends of its range."""
    if value in (knob.low, knob.high):
        return value
    if knob.step:
        start = knob.low or 0.0
        value = start + round((value - start) / knob.step) * knob.step
        return _clamped(knob, float(shortest(value, 1e-9)))
    return _clamped(knob, float(shortest(value, abs(tolerance) / 2)))


def _along(v: Vec, way: Vec) -> float:
    return (v[0] * way[0] + v[1] * way[1]) / math.hypot(*way)


def _is_beside(a: Vec, b: Vec) -> bool:
    return abs(a[0] * b[1] - a[1] * b[0]) > _BESIDE * math.hypot(*a) * math.hypot(*b)

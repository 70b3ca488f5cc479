"""Patterns: members alike, at equal steps along a way or around a centre."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from aidl_lang.syntax import ast
from tests.checker.copies import Copy, away, own_center, turn
from tests.checker.tree import Array, Geo, Node, Vec
from tests.checker.values import Exact, MistakeError, Num, Point, Scope, fold, point_at, reference

if TYPE_CHECKING:
    from tests.checker.evaluate import Evaluator

KINDS = ("lineararray", "grid", "polararray")


@dataclass(frozen=True)
class Pattern:
    """A call of a pattern in a structure, and its members by their indices."""

    node: Node
    call: ast.Call
    scope: Scope
    array: Array

    @property
    def kind(self) -> str:
        return fold(self.scope.canonical(self.call.callee.text))

    def members(self) -> list[Geo | Node]:
        return [member for row in self.array.list() for member in (row.list() if _is_row(row) else [row])]

    def arguments(self, ev: Evaluator) -> dict[str, Any]:
        """What is said besides the thing, by name."""
        given = [(a.name, a.value) for a in self.call.arguments]
        if self.call.receiver is None:
            given = given[1:]
        names = _POSITIONAL[self.kind]
        values = [ev.value(v, self.scope) for n, v in given if n is None]
        return dict(zip(names, values, strict=False)) | {
            _WORDS.get(fold(n.text), fold(n.text)): ev.value(v, self.scope) for n, v in given if n is not None
        }

    def field(self, ev: Evaluator, name: str) -> Any:
        """`bolt.radius`, `row.pitch`, `row.center`, …, read off the members."""
        places = [own_center(ev, m) for m in self.members()]
        if self.kind == "polararray":
            center = self.center(ev, places)
            match name:
                case "center":
                    return point_at(center)
                case "radius":
                    return reference(math.dist(center, places[0]))
            return None
        columns = self.columns()
        match name:
            case "start":
                return point_at(places[0])
            case "center":
                return point_at(_middle([places[0], places[-1]]))
            case "pitch" | "pitchx":
                step = 1 if self.kind == "lineararray" else len(places) // columns
                return reference(math.dist(places[0], places[step]))
            case "pitchy":
                return reference(math.dist(places[0], places[1]))
        return None

    def columns(self) -> int:
        return len(self.array.items)

    def step(self, ev: Evaluator) -> float:
        """The angle from one member of a circle to the next."""
        n = len(self.members())
        sweep = self.arguments(ev).get("sweep")
        degrees = 360.0 if sweep is None else ev.number(sweep).value
        return degrees / n if abs(abs(degrees) - 360) < 1e-9 else degrees / max(n - 1, 1)

    def center(self, ev: Evaluator, places: list[Vec]) -> Vec:
        """The point about which the second place is the first one turned by a step."""
        step = self.step(ev)
        if len(places) < 2 or abs(step) % 360 < 1e-9:
            raise MistakeError("one member has no circle")
        (ax, ay), (bx, by) = places[:2]
        half = math.tan(math.radians(step) / 2)
        return (ax + bx) / 2 - (by - ay) / (2 * half), (ay + by) / 2 + (bx - ax) / (2 * half)

    def residuals(self, ev: Evaluator, changed: Collection[str]) -> Iterator[float]:
        """Each member against the first, and what was written of the pattern itself."""
        given = self.arguments(ev)
        members = self.members()
        places = [own_center(ev, m) for m in members]
        first = members[0]
        for place, member in zip(places[1:], members[1:], strict=True):
            yield away(ev.frame, self._copy(ev, first, places[0], place, given), member)
        yield from self._placed(ev, places, given)
        if not any(c.startswith(f"{self.node.path}.{self._name()}") for c in changed):
            yield from self._kept(ev, given)

    def _name(self) -> str:
        return self.members()[-1].name.partition("[")[0]

    def _copy(self, ev: Evaluator, first: Geo | Node, at: Vec, place: Vec, given: dict[str, Any]) -> Copy:
        """The motion that takes the first member's place to another's."""
        if self.kind != "polararray" or given.get("turn") is False:
            return Copy(first, lambda p: (p[0] + place[0] - at[0], p[1] + place[1] - at[1]))
        center = self.center(ev, [own_center(ev, m) for m in self.members()])
        a, b = (math.atan2(q[1] - center[1], q[0] - center[0]) for q in (at, place))
        return Copy(first, lambda p: turn(p, math.degrees(b - a), center))

    def _placed(self, ev: Evaluator, places: list[Vec], given: dict[str, Any]) -> Iterator[float]:
        """Equal steps."""
        if self.kind == "polararray":
            center = self.center(ev, places)
            for i, place in enumerate(places):
                yield math.dist(turn(places[0], i * self.step(ev), center), place)
        elif self.kind == "lineararray":
            for i, place in enumerate(places):
                yield math.dist(_at(places[0], places[1], i), place)
        else:
            rows = len(places) // self.columns()
            for i, place in enumerate(places):
                column, row = divmod(i, rows)
                x, y = _at(places[0], places[rows], column)[0], _at(places[0], places[1], row)[1]
                yield math.dist((x, y), place)

    def _kept(self, ev: Evaluator, given: dict[str, Any]) -> Iterator[float]:
        """The sizes that were written, and the places that are exact."""
        for name, value in given.items():
            if name in ("center", "start") and not isinstance(value, Num):
                yield from self._exact_place(ev, name, ev.point(value))
            elif name in ("pitch", "pitchx", "pitchy", "radius"):
                number = ev.number(value)
                if number.exact != Exact.GUESS:
                    found = self.field(ev, name)
                    yield abs(ev.number(found).value - abs(number.value))
                    if name == "pitch" and self.kind == "grid":
                        yield abs(ev.number(self.field(ev, "pitchy")).value - abs(number.value))

    def _exact_place(self, ev: Evaluator, name: str, written: Point) -> Iterator[float]:
        actual = self.field(ev, name)
        for axis in ("x", "y"):
            if getattr(written, axis).exact >= Exact.FIXED:
                yield abs(getattr(written, axis).value - getattr(actual, axis).value)


def _is_row(row: Any) -> bool:
    return isinstance(row, Array)


def _at(a: Vec, b: Vec, steps: int) -> Vec:
    return a[0] + steps * (b[0] - a[0]), a[1] + steps * (b[1] - a[1])


def _middle(points: list[Vec]) -> Vec:
    return sum(p[0] for p in points) / len(points), sum(p[1] for p in points) / len(points)


_POSITIONAL = {
    "lineararray": ("n", "pitch"),
    "grid": ("columns", "rows", "pitch"),
    "polararray": ("n", "radius"),
}
_WORDS = {"spacing": "pitch", "r": "radius", "count": "n"}

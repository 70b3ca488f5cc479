"""Ways along cubics: places at lengths of the curve, over expressions.

The length of a cubic is an integral, and where it has reached a length an equation. The equation is solved at
the first guesses, and some steps of Newton's method, written out, follow the control points from there to
where these come to lie: exact as long as the curve keeps its form, in whatever size and place, and very near
where it bends. What is left is looked at once everything is solved.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import cached_property

from aidl_lang.building import expression as ex
from aidl_lang.building.expression import Expression
from aidl_lang.building.motion import Place
from aidl_lang.common.quadrature import gauss
from aidl_lang.common.records import record

_NODES = (4, 6, 8, 12, 16)
"""The terms of a length: as few as do."""
_EXACT = 1e-10
_DEEPEST = 10
_STEPS = 60
_FOLLOWING = 3
_NEAR = 1e-15
_STALLED = 1e-6
_QUARTER = 4
"""Cubics to a quarter of an ellipse, which are off by 7e-8 of its radius."""


@record(slots=True)
class _Span:
    """A part of a cubic between two parameters, and the length before it."""

    t0: float
    t1: float
    nodes: int
    before: Expression


@record(eq=False)
class Cubic:
    """A cubic that is walked from its start on."""

    points: tuple[Place, Place, Place, Place]

    @property
    def start(self) -> Place:
        return self.points[0]

    @property
    def last(self) -> Place:
        return self.points[3]

    @property
    def end(self) -> tuple[float, float]:
        x, y = self.last
        return x.value, y.value

    @property
    def turned_round(self) -> Cubic:
        a, b, c, d = self.points
        return Cubic((d, c, b, a))

    @cached_property
    def _ways(self) -> tuple[Place, Place, Place]:
        """A third of the derivative at the control points of its own."""
        a, b, c, d = self.points
        return way(a, b), way(b, c), way(c, d)

    @cached_property
    def _spans(self) -> tuple[_Span, ...]:
        """Parts whose lengths are sums of few terms."""
        found: list[_Span] = []
        before = ex.ZERO
        for t0, t1, nodes in self._divided(0.0, 1.0, 0):
            found.append(_Span(t0, t1, nodes, before))
            before = ex.add(before, self._between(t0, ex.constant(t1 - t0), nodes))
        return (*found, _Span(1.0, 1.0, 0, before))

    def _divided(self, t0: float, t1: float, depth: int) -> Iterator[tuple[float, float, int]]:
        middle = (t0 + t1) / 2
        exact = self._long(t0, middle, _NODES[-1]) + self._long(middle, t1, _NODES[-1])
        for nodes in _NODES:
            if abs(self._long(t0, t1, nodes) - exact) <= _EXACT * exact or depth == _DEEPEST:
                yield t0, t1, nodes
                return
        yield from self._divided(t0, middle, depth + 1)
        yield from self._divided(middle, t1, depth + 1)

    def _long(self, t0: float, t1: float, nodes: int) -> float:
        return sum((t1 - t0) * w * self._speed_guessed(t0 + (t1 - t0) * u) for u, w in gauss(nodes))

    def _speed_guessed(self, t: float) -> float:
        (ax, ay), (bx, by), (cx, cy) = self._ways_guessed
        u, v, w = (1 - t) ** 2, 2 * t * (1 - t), t * t
        return 3 * math.hypot(u * ax + v * bx + w * cx, u * ay + v * by + w * cy)

    @cached_property
    def _ways_guessed(self) -> tuple[tuple[float, float], ...]:
        return tuple((x.value, y.value) for x, y in self._ways)

    @property
    def length(self) -> Expression:
        return self._spans[-1].before

    def parameter(self, way: Expression) -> tuple[Expression, Expression]:
        """Returns the parameter at a length from the start, and the length that is missing there."""
        span = self._spans[sum(s.before.value <= way.value for s in self._spans[1:-1])]
        first = self._reached(span, way.value - span.before.value)
        to_first = ex.add(span.before, self._between(span.t0, ex.constant(first - span.t0), span.nodes))
        missing, start = ex.sub(way, to_first), ex.constant(first)
        step, rest = ex.ZERO, missing
        for _ in range(_FOLLOWING):
            step = ex.add(step, ex.div(rest, self._speed(ex.add(start, step))))
            rest = ex.sub(missing, self._between(first, step, _NODES[0]))
        return ex.add(start, step), rest

    def _reached(self, span: _Span, way: float) -> float:
        """Returns the parameter at a length from the start of a span on at the first guesses."""
        low, high = span.t0, span.t1
        t = low + (high - low) / 2
        for _ in range(_STEPS):
            off = self._long(span.t0, t, span.nodes) - way
            low, high = (low, t) if off > 0 else (t, high)
            speed = self._speed_guessed(t)
            newton = t - off / speed if speed else t
            to = newton if low <= newton <= high else (low + high) / 2
            if abs(to - t) <= _NEAR:
                break
            t = to
        if not self._speed_guessed(t) > _STALLED * self.length.value:
            return min(max(t, _STALLED), 1.0 - _STALLED)  # the ends have a direction beside them
        return t

    def _between(self, t0: float, step: Expression, nodes: int) -> Expression:
        """Returns the length from a parameter on, over a step."""
        total = ex.ZERO
        for u, w in gauss(nodes):
            t = ex.add(ex.constant(t0), ex.mul(ex.constant(u), step))
            total = ex.add(total, ex.mul(ex.constant(w), self._speed(t)))
        return ex.mul(total, step)

    def _speed(self, t: Expression) -> Expression:
        x, y = self._derivative(t)
        return ex.mul(ex.constant(3.0), ex.apply("hypot", x, y))

    def _derivative(self, t: Expression) -> Place:
        s = ex.sub(ex.ONE, t)
        return _weighed(self._ways, (ex.mul(s, s), ex.mul(ex.constant(2.0), ex.mul(s, t)), ex.mul(t, t)))

    def at(self, t: Expression) -> tuple[Place, Expression]:
        """Returns the place and the direction at a parameter."""
        s, three = ex.sub(ex.ONE, t), ex.constant(3.0)
        s2, t2 = ex.mul(s, s), ex.mul(t, t)
        weights = ex.mul(s2, s), ex.mul(three, ex.mul(s2, t)), ex.mul(three, ex.mul(s, t2)), ex.mul(t2, t)
        x, y = self._derivative(t)
        return _weighed(self.points, weights), ex.atan2(y, x)


def way(a: Place, b: Place) -> Place:
    return ex.sub(b[0], a[0]), ex.sub(b[1], a[1])


def _weighed(points: Sequence[Place], weights: Sequence[Expression]) -> Place:
    x = y = ex.ZERO
    for p, w in zip(points, weights, strict=True):
        x, y = ex.add(x, ex.mul(w, p[0])), ex.add(y, ex.mul(w, p[1]))
    return x, y


def of_ellipse(
    center: Place, rx: Expression, ry: Expression, angle: Expression, *, clockwise: bool
) -> list[Cubic]:
    """Returns the cubics of an ellipse, from the end of its first half axis on."""
    count = 4 * _QUARTER
    turn = math.tau / count * (-1 if clockwise else 1)
    handle = 4 / 3 * math.tan(turn / 4)
    cos, sin = ex.cos(angle), ex.sin(angle)

    def place(u: float, v: float) -> Place:
        along, across = ex.mul(ex.constant(u), rx), ex.mul(ex.constant(v), ry)
        return (
            ex.add(center[0], ex.sub(ex.mul(cos, along), ex.mul(sin, across))),
            ex.add(center[1], ex.add(ex.mul(sin, along), ex.mul(cos, across))),
        )

    found = []
    for k in range(count):
        (c0, s0), (c1, s1) = ((math.cos(a), math.sin(a)) for a in (turn * k, turn * (k + 1)))
        ends = place(c0, s0), place(c1, s1)
        found.append(
            Cubic(
                (
                    ends[0],
                    place(c0 - handle * s0, s0 + handle * c0),
                    place(c1 + handle * s1, s1 - handle * c1),
                    ends[1],
                )
            )
        )
    return found

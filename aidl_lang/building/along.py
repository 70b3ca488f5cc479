"""The ways along curves: places and directions at lengths from the start, over expressions."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from itertools import accumulate, pairwise

from aidl_lang.building import expression as ex
from aidl_lang.building.curves import (
    NOWHERE,
    Piece,
    clockwise,
    direction,
    distance,
    gauss,
    is_reflected,
    number,
    pieces,
    sweep,
    view,
    xy,
)
from aidl_lang.building.expression import Expression, Place
from aidl_lang.building.model import Geometry, Structure
from aidl_lang.common.records import record

# --- Ways along cubics: places at lengths of the curve, over expressions.
#
# The length of a cubic is an integral, and where it has reached a length an equation. The equation is solved
# at the first guesses, and some steps of Newton's method, written out, follow the control points from there
# to where these come to lie: exact as long as the curve keeps its form, in whatever size and place, and very
# near where it bends. What is left is looked at once everything is solved.

_NODES = (4, 6, 8, 12, 16)  # the terms of a length: as few as do
_EXACT = 1e-10
_DEEPEST = 10
_STEPS = 60
_FOLLOWING = 3
_NEAR = 1e-15
_STALLED = 1e-6
_QUARTER = 4  # cubics to a quarter of an ellipse, which are off by 7e-8 of its radius


Met = tuple[Place, list[Expression]]
"""A place on a curve, and what is 0 as long as it lies there."""


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

    points: Piece

    @property
    def start(self) -> Place:
        return self.points[0]

    @property
    def last(self) -> Place:
        return self.points[3]

    @property
    def turned_round(self) -> Cubic:
        a, b, c, d = self.points
        return Cubic((d, c, b, a))

    @cached_property
    def _ways(self) -> tuple[Place, Place, Place]:
        """A third of the derivative at the control points of its own."""
        a, b, c, d = self.points
        return b - a, c - b, d - c

    @cached_property
    def _spans(self) -> tuple[_Span, ...]:
        """Parts whose lengths are sums of few terms."""
        found: list[_Span] = []
        before = ex.ZERO
        for t0, t1, nodes in self._divided(0.0, 1.0, 0):
            found.append(_Span(t0, t1, nodes, before))
            before = before + self._between(t0, ex.constant(t1 - t0), nodes)
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
        (ax, ay), (bx, by), (cx, cy) = self._guesses
        u, v, w = (1 - t) ** 2, 2 * t * (1 - t), t * t
        return 3 * math.hypot(u * ax + v * bx + w * cx, u * ay + v * by + w * cy)

    @cached_property
    def _guesses(self) -> tuple[tuple[float, float], ...]:
        return tuple(way.written for way in self._ways)

    @property
    def length(self) -> Expression:
        return self._spans[-1].before

    def parameter(self, way: Expression) -> tuple[Expression, Expression]:
        """Returns the parameter at a length from the start, and the length that is missing there."""
        span = self._spans[sum(s.before.value <= way.value for s in self._spans[1:-1])]
        first = self._reached(span, way.value - span.before.value)
        to_first = span.before + self._between(span.t0, ex.constant(first - span.t0), span.nodes)
        missing, start = way - to_first, ex.constant(first)
        step, rest = ex.ZERO, missing
        for _ in range(_FOLLOWING):
            step = step + rest / self._speed(start + step)
            rest = missing - self._between(first, step, _NODES[0])
        return start + step, rest

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
        return self._moving(t)

    def _moving(self, t: float) -> float:
        """Returns a parameter, or if the curve stands still there one beside it, where it has a direction."""
        is_still = not self._speed_guessed(t) > _STALLED * self.length.value
        return min(max(t, _STALLED), 1.0 - _STALLED) if is_still else t

    def _between(self, t0: float, step: Expression, nodes: int) -> Expression:
        """Returns the length from a parameter on, over a step."""
        speeds = (w * self._speed(t0 + u * step) for u, w in gauss(nodes))
        return sum(speeds, ex.ZERO) * step

    def _speed(self, t: Expression) -> Expression:
        return 3.0 * self._derivative(t).length

    def _derivative(self, t: Expression) -> Place:
        """Returns a third of it."""
        s = 1.0 - t
        return _weighed(self._ways, (s * s, 2.0 * (s * t), t * t))

    def crossings(self, axis: int, at: Expression) -> Iterator[Met]:
        """Yields the places that have an x (`axis` 0) or a y."""
        import numpy as np

        def off(t: Expression) -> tuple[Expression, Expression]:
            return at - self.at(t)[0][axis], 3.0 * self._derivative(t)[axis]

        a, b, c, d = (p[axis].value for p in self.points)
        for root in np.roots((d - 3 * c + 3 * b - a, 3 * (c - 2 * b + a), 3 * (b - a), a - at.value)):
            if abs(root.imag) <= _MEETS and -_MEETS <= root.real <= 1 + _MEETS:
                t = ex.constant(float(root.real))
                rest, speed = off(t)
                if abs(speed.value) > _STALLED * self.length.value:  # else it only touches there
                    t, rest = self._solved(t.value, off)
                yield self.at(t)[0], [rest, *_beyond(t, ex.ONE)]

    def foot(self, p: Place) -> tuple[Expression, Place, Expression]:
        """Returns the way up to the place nearest to a point, the place, and what is 0 as long as it is."""
        least = ex.constant(_STALLED**2 * self.length.value)  # where handles lie on an end, it stands still

        def off(t: Expression) -> tuple[Expression, Expression]:
            (x, y), (u, v) = p - self.at(t)[0], 3.0 * self._derivative(t)
            speed = ex.apply("maximum", self._speed(t), least)
            bends = [b - a for a, b in pairwise(self._ways)]
            k, j = _weighed(bends, (6.0 * (1.0 - t), 6.0 * t))
            turning = (x * k + y * j) / speed
            return (x * u + y * v) / speed, speed - turning

        shares = (k / _STEPS for k in range(_STEPS + 1))
        first = min(shares, key=lambda t: math.dist(self.at(ex.constant(t))[0].written, p.written))
        first = min(max(self._solved(self._moving(first), off)[0].value, 0.0), 1.0)
        t, rest = self._solved(self._moving(first), off)
        t = _within(t, ex.ONE)
        span = self._spans[sum(s.t0 <= first for s in self._spans[1:-1])]
        own = span.before + self._between(span.t0, t - span.t0, span.nodes)
        return own, self.at(t)[0], rest

    def _solved(
        self, first: float, off: Callable[[Expression], tuple[Expression, Expression]]
    ) -> tuple[Expression, Expression]:
        """Returns the parameter near a first one where something is 0, and what is left of it there; `off`
        tells it of a parameter, and how fast it falls.
        """
        t = ex.constant(first)
        for _ in range(2 * _FOLLOWING):  # the point may come from further off
            rest, fall = off(t)
            t = t + rest / fall
        return t, off(t)[0]

    def at(self, t: Expression) -> tuple[Place, Expression]:
        """Returns the place and the direction at a parameter."""
        s = 1.0 - t
        s2, t2 = s * s, t * t
        weights = s2 * s, 3.0 * (s2 * t), 3.0 * (s * t2), t2 * t
        return _weighed(self.points, weights), self._derivative(t).direction


def _within(own: Expression, whole: Expression) -> Expression:
    return ex.apply("minimum", ex.apply("maximum", own, ex.ZERO), whole)


def _beyond(own: Expression, whole: Expression) -> list[Expression]:
    """Returns by how much a way is before its start and behind its end."""
    return [ex.apply("maximum", ex.ZERO, over) for over in (-own, own - whole)]


def _weighed(points: Sequence[Place], weights: Sequence[Expression]) -> Place:
    return sum((w * p for p, w in zip(points, weights, strict=True)), NOWHERE)


def _of_ellipse(curve: Geometry, here: Structure) -> Iterator[Piece]:
    """Yields the control points of the cubics of an ellipse, from the end of its first half axis on."""
    core = view(curve, here)
    rx, ry = number(core["rx"]), number(core["ry"])
    facing = ex.towards(number(core["angle"]))
    count = 4 * _QUARTER
    turn = math.tau / count * (-1 if is_reflected(curve.owner, here) else 1)
    handle = 4 / 3 * math.tan(turn / 4)

    def place(u: float, v: float) -> Place:
        return xy(core["center"]) + Place(u * rx, v * ry).turned(facing)

    for k in range(count):
        (c0, s0), (c1, s1) = ((math.cos(a), math.sin(a)) for a in (turn * k, turn * (k + 1)))
        inner = place(c0 - handle * s0, s0 + handle * c0), place(c1 + handle * s1, s1 - handle * c1)
        yield place(c0, s0), *inner, place(c1, s1)


KINDS = frozenset({"line", "arc", "circle"})
"""Curves whose length is an expression; others are walked as the cubics and lines that they are made of."""

_SMOOTH = 1e-4  # degrees by which what goes on without a corner may turn
_BESIDE = 0.125  # share of a stretch from its ends where a place may come to lie on the one beside it
_DEGREES = ex.constant(180.0 / math.pi)
_RADIANS = ex.constant(math.pi / 180.0)
_MEETS = 1e-6  # distance of two ends that are one, relative to the extent of the curves or in mm


@record(eq=False)
class Stretch:
    """A line or an arc that is walked from `start` on.

    length  in mm
    bow     the angle (degrees) that its direction turns by in each mm, counter-clockwise; nothing for a line
    heading its direction at the start
    """

    start: Place
    heading: Expression
    length: Expression
    center: Place | None = None
    bow: Expression = ex.ZERO

    def at(self, way: Expression) -> Place:
        if self.center is None:
            return self.start + way * ex.towards(self.heading)
        return self.center + (self.start - self.center).turned(ex.towards(self.bow * way))

    def crossings(self, axis: int, at: Expression) -> Iterator[Met]:
        """Yields the places that have an x (`axis` 0) or a y."""
        others: list[Expression] = []
        run, off = self.last - self.start, at - self.start[axis]
        is_along = self.center is None and abs(run[axis].value) <= _STALLED * self.length.value
        if is_along and abs(off.value) <= _MEETS:
            others = [self.start[1 - axis], self.last[1 - axis]]
        elif self.center is None and not is_along:
            others = [self.start[1 - axis] + off / run[axis] * run[1 - axis]]
        elif self.center is not None:
            radius, off = (self.start - self.center).length, at - self.center[axis]
            square = ex.apply("square", radius) - ex.apply("square", off)
            if square.value >= 0:
                reach = ex.apply("sqrt", ex.apply("maximum", ex.ZERO, square))
                others = [self.center[1 - axis] + reach, self.center[1 - axis] - reach]
        for other in others:
            place = Place(at, other) if axis == 0 else Place(other, at)
            unmet = _beyond(self._beside(place), self.length) + [off] * is_along
            if self.center is not None:
                unmet.append((place - self.center).length - radius)
            if all(abs(e.value) <= _MEETS for e in unmet):
                yield place, unmet

    def foot(self, p: Place) -> tuple[Expression, Place, Expression]:
        """Returns the way up to the place nearest to a point, the place, and 0: it is known at once."""
        own = _within(self._beside(p), self.length)
        return own, self.at(own), ex.ZERO

    def _beside(self, p: Place) -> Expression:
        """Returns the length up to the place nearest to a point, on the whole line or circle."""
        if self.center is None:
            (x, y), (cos, sin) = p - self.start, ex.towards(self.heading)
            return x * cos + y * sin
        sense = ex.constant(math.copysign(1.0, self.bow.value))
        turn = sense * ((p - self.center).direction - (self.start - self.center).direction)
        whole, swept = ex.constant(360.0), sense * (self.bow * self.length)
        left = (whole - swept) * 0.5  # beside the arc, the nearer of its ends is meant
        turn = ex.apply("mod", turn + left, whole) - left
        return turn / (sense * self.bow)

    def direction(self, way: Expression) -> Expression:
        return self.heading + self.bow * way

    @property
    def turned_round(self) -> Stretch:
        """The same curve, walked from its end."""
        heading = self.direction(self.length) + 180.0
        return Stretch(self.at(self.length), heading, self.length, self.center, -self.bow)

    @property
    def last(self) -> Place:
        return self.at(self.length)


@record(eq=False)
class Way:
    """Stretches that go on from one another, and whether the last ends where the first begins."""

    stretches: tuple[Stretch | Cubic, ...]
    is_closed: bool

    @property
    def length(self) -> Expression:
        return self._lengths[-1]

    @cached_property
    def _lengths(self) -> tuple[Expression, ...]:
        """The lengths from the start up to each of the joints, and to the end."""
        return tuple(accumulate((stretch.length for stretch in self.stretches), initial=ex.ZERO))

    @property
    def is_free(self) -> bool:
        """Tells whether places are followed from those at the first guesses, and have to be checked."""
        return any(isinstance(stretch, Cubic) for stretch in self.stretches)

    def followed(self, way: Expression) -> tuple[Place, Expression, list[Expression]]:
        """Returns the place at a length from the start and the direction there, on the stretch where it lies
        at the first guesses or on one beside it if it is near, and what is 0 as long as that is so.
        """
        index = sum(low.value <= way.value for low in self._lengths[1:-1])
        whole = self.stretches[index].length
        own = way - self._lengths[index]
        before = index > 0 and own.value < _BESIDE * whole.value
        after = index < len(self.stretches) - 1 and whole.value - own.value < _BESIDE * whole.value
        place, heading, unmet = self._on(index, own, at_least=before, at_most=after)
        for k in [index - 1] * before + [index + 1] * after:
            reached = way - self._lengths[k]
            met, _, more = self._on(k, reached, at_least=k > index, at_most=k < index)
            joint = self.stretches[k].start if k > index else self.stretches[k].last
            place = place + (met - joint)
            unmet += more
        return place, heading, unmet

    def _on(
        self, index: int, own: Expression, *, at_least: bool = False, at_most: bool = False
    ) -> tuple[Place, Expression, list[Expression]]:
        """Returns the place at a length of a stretch, which is kept from running over its start or its end
        where it could be met on the stretch beside it.
        """
        stretch = self.stretches[index]
        whole = stretch.length
        overs = zip(_beyond(own, whole), (at_least, at_most), strict=True)
        unmet = [over for over, is_kept in overs if not is_kept]
        own = ex.apply("maximum", own, ex.ZERO) if at_least else own
        own = ex.apply("minimum", own, whole) if at_most else own
        if isinstance(stretch, Stretch):
            return stretch.at(own), stretch.direction(own), unmet
        t, rest = stretch.parameter(own)
        return *stretch.at(t), [*unmet, rest]

    def up_to(self, p: Place) -> tuple[Expression, Expression]:
        """Returns the way up to the place nearest to a point, and what is 0 as long as it is that."""
        feet = []
        for before, stretch in zip(self._lengths, self.stretches, strict=False):
            own, place, rest = stretch.foot(p)
            feet.append(((p - place).length, before + own, rest))
        nearest, *found = feet[0]
        for away, *other in feet[1:]:
            nearer = nearest - away
            found = [ex.apply("select", nearer, *pair) for pair in zip(other, found, strict=True)]
            nearest = ex.apply("minimum", nearest, away)
        return found[0], found[1]

    def at(self, way: Expression) -> tuple[Place, Expression]:
        """Returns the place at a length from the start, wherever the joints come to lie, and the direction of
        the stretch on which it lies at the first guesses. Beyond its ends the way runs on as they do.
        """
        stretches = [s for s in self.stretches if isinstance(s, Stretch)]
        place = stretches[0].start
        rest, heading = way, stretches[0].heading
        for index, stretch in enumerate(stretches):
            is_last = index == len(stretches) - 1
            own = rest
            if index > 0:
                own = ex.apply("maximum", own, ex.ZERO)
            if not is_last:
                own = ex.apply("minimum", own, stretch.length)
            if index == 0 or (rest.value >= -_MEETS and (is_last or rest.value > _MEETS)):
                heading = stretch.direction(own)
            place = place + (stretch.at(own) - stretch.start)
            rest = rest - stretch.length
        return place, heading


def within(way: Way, margin: Expression) -> tuple[Way, list[Expression], list[Expression]] | None:
    """Returns the way a margin within a closed one of lines and arcs, the lengths of it up to its corners (of
    round ones, arcs between two lines, up to their middles), and what is 0 as long as that is so.
    None where an arc meets something at an angle, and for free curves.
    """
    whole = [s for s in way.stretches if isinstance(s, Stretch)]
    rim = [s.at(s.length * (k / 3)).written for s in whole for k in range(3)]
    area = sum(a * d - b * c for (a, b), (c, d) in pairwise([*rim, rim[0]]))
    aside = math.copysign(1.0, area) * margin  # to the left
    bows = [_RADIANS * s.bow for s in whole]
    shares = [1.0 - aside * bow for bow in bows]
    kept = [i for i, share in enumerate(shares) if share.value > 1e-9]
    if len(whole) < len(way.stretches) or not kept:
        return None
    cuts: dict[int, Expression] = {}
    unmet = []
    for before, i in zip([kept[-1], *kept], kept, strict=False):
        lost = [k % len(whole) for k in range(before + 1, i + len(whole) * (i <= before))]
        joined = [before, *lost, i]
        turns = [_turn(whole[a].direction(whole[a].length), whole[b].heading) for a, b in pairwise(joined)]
        turn = _turn(whole[before].direction(whole[before].length), whole[i].heading)
        is_smooth = all(abs(t.value) < _SMOOTH for t in turns)
        if not lost and is_smooth:
            continue
        if len(lost) > 1 or (lost and not is_smooth) or whole[i].center or whole[before].center:
            return None
        reach = aside - 1.0 / bows[lost[0]] if lost else aside
        cuts[i] = reach * (ex.sin(turn * 0.5) / ex.cos(turn * 0.5))
        unmet += [ex.apply("maximum", ex.ZERO, shares[k]) for k in lost]
    made: list[Stretch] = []
    corners, at = [], ex.ZERO
    for i, after in zip(kept, [*kept[1:], kept[0]], strict=True):
        s, cut = whole[i], cuts.get(i, ex.ZERO)
        length = s.length * shares[i] - (cut + cuts.get(after, ex.ZERO))
        cos, sin = ex.towards(s.heading)
        start = s.start + Place(cut * cos - aside * sin, cut * sin + aside * cos)
        is_round = s.center is not None and len(kept) > 2 and not whole[kept[kept.index(i) - 1]].center
        if i in cuts or (is_round and not whole[after].center):
            corners.append(at + length * 0.5 if is_round else at)
        made.append(Stretch(start, s.heading, length, s.center, s.bow / shares[i]))
        unmet.append(ex.apply("maximum", ex.ZERO, -length))
        at = at + length
    return Way(tuple(made), is_closed=True), corners, unmet


def _turn(before: Expression, after: Expression) -> Expression:
    """Returns the angle from one direction to another, between -180 and 180 degrees at the first guesses."""
    turn = after - before
    return turn - 360.0 * round(turn.value / 360.0)


def way_along(curves: Sequence[Geometry], here: Structure) -> Way | None:
    """Returns the way along curves joined at their ends, in the sense of the first; None if not one line."""
    if len(curves) == 1 and curves[0].type == "circle":
        return Way((_circle(curves[0], here),), is_closed=True)
    if any(curve.type == "circle" or (curve.type == "ellipse" and len(curves) > 1) for curve in curves):
        return None
    both = [pair for c in curves for pair in _stretches(c, here)]
    if not both:
        return None
    near = _MEETS * max(
        1.0, *(abs(v) for pair in both for v in (*pair[0].start.written, *pair[0].last.written))
    )
    first, *rest = both
    walked = _walked(first[0], rest, near)
    if rest:  # the first lies in the middle
        turned = {backward: forward for pair in both for forward, backward in (pair, pair[::-1])}
        walked = [*(turned[s] for s in reversed(_walked(first[1], rest, near)[1:])), *walked]
    if rest:
        return None
    meets = math.dist(walked[-1].last.written, walked[0].start.written) <= near
    return Way(tuple(walked), meets and (len(walked) > 1 or isinstance(walked[0], Cubic)))


def crossings(curves: Sequence[Geometry], here: Structure, axis: int, at: Expression) -> list[Met]:
    """Returns the places of curves that have an x (`axis` 0) or a y, in order of the other coordinate."""
    stretches = (pair[0] for c in curves for pair in _stretches(c, here))
    found = (met for piece in stretches for met in piece.crossings(axis, at))
    return sorted(found, key=lambda met: met[0][1 - axis].value)


_Pair = tuple["Stretch | Cubic", "Stretch | Cubic"]


def _stretches(curve: Geometry, here: Structure) -> list[_Pair]:
    """Returns a curve in stretches, forwards and backwards; cubics without length are left out."""
    if curve.type == "circle":
        return [(_circle(curve, here), _circle(curve, here))]
    if curve.type == "arc":
        return [(_arc(curve, here), _arc(curve, here, reverse=True))]
    of = _of_ellipse(curve, here) if curve.type == "ellipse" else pieces(curve, here)
    pairs = [(_stretch(piece), _stretch(piece[::-1])) for piece in of]
    return [pair for pair in pairs if isinstance(pair[0], Stretch) or pair[0].length.value > 0]


def _stretch(piece: Piece) -> Stretch | Cubic:
    if len(piece) == 4:
        return Cubic(piece)
    start, end = piece
    return Stretch(start, (end - start).direction, (end - start).length)


def _walked(stretch: Stretch | Cubic, rest: list[_Pair], near: float) -> list[Stretch | Cubic]:
    """Returns a stretch and those that go on from it, which are taken out of the rest."""
    walked = [stretch]
    while True:
        end = walked[-1].last.written
        ways = ((pair, s) for pair in rest for s in pair if math.dist(s.start.written, end) <= near)
        if (found := next(ways, None)) is None:
            return walked
        rest.remove(found[0])
        walked.append(found[1])


def _circle(curve: Geometry, here: Structure, *, inside: bool | None = None) -> Stretch:
    """Returns a circle from its right on in its own sense, or as one writes in or outside of it."""
    core = view(curve, here)
    center, radius = xy(core["center"]), number(core["radius"])
    turn = ex.constant(1.0 if inside or (inside is None and not clockwise(curve, here)) else -1.0)
    length, bend = 2 * math.pi * radius, turn * _DEGREES / radius
    if inside is not None:
        start = Place(center.x, center.y + turn * radius)
        return Stretch(start, ex.constant(180.0), length, center, bend)
    return Stretch(Place(center.x + radius, center.y), turn * 90.0, length, center, bend)


def _arc(curve: Geometry, here: Structure, *, reverse: bool = False) -> Stretch:
    core = view(curve, here)
    start = core["end"] if reverse else core["start"]
    is_clockwise = clockwise(curve, here)
    radius = distance(core["center"], core["start"])
    turn = ex.constant(-1.0 if is_clockwise != reverse else 1.0)
    ahead = direction(core["center"], start) + turn * 90.0
    length, bend = _RADIANS * sweep(core, is_clockwise) * radius, turn * _DEGREES
    return Stretch(xy(start), ahead, length, xy(core["center"]), bend / radius)


def reading_way(curves: Sequence[Geometry], here: Structure, *, inside: bool | None) -> Way | None:
    """Returns the way of writing that goes along curves: from left to right, by their middle at the first
    guesses; around a circle clockwise on its outside, from the bottom. `inside` tells the side of a circle or
    an arc; of other curves it is the one that is not read from left to right. None for curves that are no one
    line, or closed.
    """
    if len(curves) == 1 and curves[0].type == "circle":
        return Way((_circle(curves[0], here, inside=inside is True),), is_closed=True)
    way = way_along(curves, here)
    if way is None or way.is_closed:
        return None
    if len(curves) == 1 and curves[0].type == "arc" and inside is not None:
        backwards = clockwise(curves[0], here) == inside
    else:
        ahead = way.at(way.length * 0.5)[1].value
        backwards = (-90.0 < (ahead + 180.0 - 1e-9) % 360.0 - 180.0 <= 90.0) == (inside is True)
    return Way(tuple(s.turned_round for s in reversed(way.stretches)), is_closed=False) if backwards else way

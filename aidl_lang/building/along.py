"""The ways along curves: places and directions at lengths from the start, over expressions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise

from aidl_lang.building import expression as ex
from aidl_lang.building.cubics_along import Cubic, of_ellipse
from aidl_lang.building.expression import Expression
from aidl_lang.building.model import Geometry, Structure
from aidl_lang.building.motion import Place
from aidl_lang.building.primitives import (
    clockwise,
    direction,
    distance,
    is_reflected,
    number,
    sweep,
    view,
    xy,
)
from aidl_lang.common.records import record

KINDS = frozenset({"line", "arc", "circle"})
"""Curves whose length is an expression."""
FREE_KINDS = frozenset({"bezier", "ellipse"})
"""Curves that are walked as cubics."""

_SMOOTH = 1e-4
"""Degrees by which what goes on without a corner may turn."""
_BESIDE = 0.125
"""Share of a stretch from its ends where a place may come to lie on the one beside it."""
_DEGREES = ex.constant(180.0 / math.pi)
_RADIANS = ex.constant(math.pi / 180.0)
_MEETS = 1e-6
"""Distance of two ends that are one, relative to the extent of the curves or in mm."""


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
        x, y = self.start
        if self.center is None:
            cos, sin = ex.cos(self.heading), ex.sin(self.heading)
            return ex.add(x, ex.mul(way, cos)), ex.add(y, ex.mul(way, sin))
        turn = ex.mul(self.bow, way)
        cos, sin = ex.cos(turn), ex.sin(turn)
        u, v = ex.sub(x, self.center[0]), ex.sub(y, self.center[1])
        return (
            ex.add(self.center[0], ex.sub(ex.mul(cos, u), ex.mul(sin, v))),
            ex.add(self.center[1], ex.add(ex.mul(sin, u), ex.mul(cos, v))),
        )

    def direction(self, way: Expression) -> Expression:
        return ex.add(self.heading, ex.mul(self.bow, way))

    @property
    def turned_round(self) -> Stretch:
        """The same curve, walked from its end."""
        heading = ex.add(self.direction(self.length), ex.constant(180.0))
        return Stretch(self.at(self.length), heading, self.length, self.center, ex.apply("neg", self.bow))

    @property
    def last(self) -> Place:
        return self.at(self.length)

    @property
    def end(self) -> tuple[float, float]:
        return _value(self.last)


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
        found = [ex.ZERO]
        for stretch in self.stretches:
            found.append(ex.add(found[-1], stretch.length))
        return tuple(found)

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
        own = ex.sub(way, self._lengths[index])
        before = index > 0 and own.value < _BESIDE * whole.value
        after = index < len(self.stretches) - 1 and whole.value - own.value < _BESIDE * whole.value
        (x, y), heading, unmet = self._on(index, own, at_least=before, at_most=after)
        for k in [index - 1] * before + [index + 1] * after:
            reached = ex.sub(way, self._lengths[k])
            (u, v), _, more = self._on(k, reached, at_least=k > index, at_most=k < index)
            joint = self.stretches[k].start if k > index else self.stretches[k].last
            x, y = ex.add(x, ex.sub(u, joint[0])), ex.add(y, ex.sub(v, joint[1]))
            unmet += more
        return (x, y), heading, unmet

    def _on(
        self, index: int, own: Expression, *, at_least: bool = False, at_most: bool = False
    ) -> tuple[Place, Expression, list[Expression]]:
        """Returns the place at a length of a stretch, which is kept from running over its start or its end
        where it could be met on the stretch beside it.
        """
        stretch = self.stretches[index]
        whole = stretch.length
        unmet = [
            ex.apply("maximum", ex.ZERO, over)
            for over, is_kept in ((ex.apply("neg", own), at_least), (ex.sub(own, whole), at_most))
            if not is_kept
        ]
        own = ex.apply("maximum", own, ex.ZERO) if at_least else own
        own = ex.apply("minimum", own, whole) if at_most else own
        if isinstance(stretch, Stretch):
            return stretch.at(own), stretch.direction(own), unmet
        t, rest = stretch.parameter(own)
        return *stretch.at(t), [*unmet, rest]

    def at(self, way: Expression) -> tuple[Place, Expression]:
        """Returns the place at a length from the start, wherever the joints come to lie, and the direction of
        the stretch on which it lies at the first guesses. Beyond its ends the way runs on as they do.
        """
        stretches = [s for s in self.stretches if isinstance(s, Stretch)]
        x, y = stretches[0].start
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
            to, start = stretch.at(own), stretch.start
            x, y = ex.add(x, ex.sub(to[0], start[0])), ex.add(y, ex.sub(to[1], start[1]))
            rest = ex.sub(rest, stretch.length)
        return (x, y), heading


def within(way: Way, margin: Expression) -> tuple[Way, list[Expression], list[Expression]] | None:
    """Returns the way a margin within a closed one of lines and arcs, the lengths of it up to its corners (of
    round ones, arcs between two lines, up to their middles), and what is 0 as long as that is so.
    None where an arc meets something at an angle, and for free curves.
    """
    whole = [s for s in way.stretches if isinstance(s, Stretch)]
    rim = [_value(s.at(ex.mul(s.length, ex.constant(k / 3)))) for s in whole for k in range(3)]
    area = sum(a * d - b * c for (a, b), (c, d) in pairwise([*rim, rim[0]]))
    aside = ex.mul(ex.constant(math.copysign(1.0, area)), margin)  # to the left
    bows = [ex.mul(_RADIANS, s.bow) for s in whole]
    shares = [ex.sub(ex.ONE, ex.mul(aside, bow)) for bow in bows]
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
        reach = ex.sub(aside, ex.div(ex.ONE, bows[lost[0]])) if lost else aside
        cuts[i] = ex.mul(reach, ex.div(ex.sin(ex.half(turn)), ex.cos(ex.half(turn))))
        unmet += [ex.apply("maximum", ex.ZERO, shares[k]) for k in lost]
    made: list[Stretch] = []
    corners, at = [], ex.ZERO
    for i, after in zip(kept, [*kept[1:], kept[0]], strict=True):
        s, cut = whole[i], cuts.get(i, ex.ZERO)
        length = ex.sub(ex.mul(s.length, shares[i]), ex.add(cut, cuts.get(after, ex.ZERO)))
        cos, sin = ex.cos(s.heading), ex.sin(s.heading)
        x = ex.add(s.start[0], ex.sub(ex.mul(cut, cos), ex.mul(aside, sin)))
        y = ex.add(s.start[1], ex.add(ex.mul(cut, sin), ex.mul(aside, cos)))
        is_round = s.center is not None and len(kept) > 2 and not whole[kept[kept.index(i) - 1]].center
        if i in cuts or (is_round and not whole[after].center):
            corners.append(ex.add(at, ex.half(length)) if is_round else at)
        made.append(Stretch((x, y), s.heading, length, s.center, ex.div(s.bow, shares[i])))
        unmet.append(ex.apply("maximum", ex.ZERO, ex.apply("neg", length)))
        at = ex.add(at, length)
    return Way(tuple(made), is_closed=True), corners, unmet


def _turn(before: Expression, after: Expression) -> Expression:
    """Returns the angle from one direction to another, between -180 and 180 degrees at the first guesses."""
    turn = ex.sub(after, before)
    return ex.sub(turn, ex.constant(360.0 * round(turn.value / 360.0)))


def way_along(curves: Sequence[Geometry], here: Structure) -> Way | None:
    """Returns the way along curves that are joined at their ends, in the sense in which the first is written;
    None for such as are not one line.
    """
    if len(curves) == 1 and curves[0].type == "circle":
        return Way((_circle(curves[0], here),), is_closed=True)
    if any(curve.type == "circle" or (curve.type == "ellipse" and len(curves) > 1) for curve in curves):
        return None
    both = [pair for c in curves for pair in _stretches(c, here)]
    if not both:
        return None
    near = _MEETS * max(1.0, *(abs(v) for pair in both for v in (*_value(pair[0].start), *pair[0].end)))
    first, *rest = both
    walked = _walked(first[0], rest, near)
    if rest:  # the first lies in the middle
        turned = {backward: forward for pair in both for forward, backward in (pair, pair[::-1])}
        walked = [*(turned[s] for s in reversed(_walked(first[1], rest, near)[1:])), *walked]
    if rest:
        return None
    meets = math.dist(walked[-1].end, _value(walked[0].start)) <= near
    return Way(tuple(walked), meets and (len(walked) > 1 or isinstance(walked[0], Cubic)))


_Pair = tuple["Stretch | Cubic", "Stretch | Cubic"]


def _stretches(curve: Geometry, here: Structure) -> list[_Pair]:
    """Returns a curve in stretches, forwards and backwards; those without length are left out."""
    if curve.type not in FREE_KINDS:
        return [(_stretch(curve, here), _stretch(curve, here, reverse=True))]
    if curve.type == "ellipse":
        core = view(curve, here)
        axes = (number(core[name]) for name in ("rx", "ry", "angle"))
        cubics = of_ellipse(xy(core["center"]), *axes, clockwise=is_reflected(curve.owner, here))
    else:
        a, b, c, d = (xy(view(curve, here)[name]) for name in ("p0", "p1", "p2", "p3"))
        cubics = [Cubic((a, b, c, d))]
    return [(c, c.turned_round) for c in cubics if c.length.value > 0]


def _walked(stretch: Stretch | Cubic, rest: list[_Pair], near: float) -> list[Stretch | Cubic]:
    """Returns a stretch and those that go on from it, which are taken out of the rest."""
    walked = [stretch]
    while (found := _next(rest, walked[-1].end, near)) is not None:
        rest.remove(found[0])
        walked.append(found[1])
    return walked


def _next(
    rest: Sequence[_Pair], end: tuple[float, float], near: float
) -> tuple[_Pair, Stretch | Cubic] | None:
    for pair in rest:
        for stretch in pair:
            if math.dist(_value(stretch.start), end) <= near:
                return pair, stretch
    return None


def _circle(curve: Geometry, here: Structure) -> Stretch:
    core = view(curve, here)
    x, y = xy(core["center"])
    radius = number(core["radius"])
    turn = ex.constant(-1.0 if clockwise(curve, here) else 1.0)
    return Stretch(
        (ex.add(x, radius), y),
        ex.mul(turn, ex.constant(90.0)),
        ex.mul(ex.constant(2 * math.pi), radius),
        (x, y),
        ex.div(ex.mul(turn, _DEGREES), radius),
    )


def _stretch(curve: Geometry, here: Structure, *, reverse: bool = False) -> Stretch:
    core = view(curve, here)
    start, end = (core["end"], core["start"]) if reverse else (core["start"], core["end"])
    if curve.type == "line":
        return Stretch(xy(start), direction(start, end), distance(start, end))
    is_clockwise = clockwise(curve, here)
    radius = distance(core["center"], core["start"])
    turn = ex.constant(-1.0 if is_clockwise != reverse else 1.0)
    return Stretch(
        xy(start),
        ex.add(direction(core["center"], start), ex.mul(turn, ex.constant(90.0))),
        ex.mul(ex.mul(_RADIANS, sweep(core, is_clockwise)), radius),
        xy(core["center"]),
        ex.div(ex.mul(turn, _DEGREES), radius),
    )


def reading_way(curves: Sequence[Geometry], here: Structure, *, inside: bool | None) -> Way | None:
    """Returns the way of writing that goes along curves: from left to right, by their middle at the first
    guesses; around a circle clockwise on its outside, from the bottom. `inside` tells the side of a circle or
    an arc; of other curves it is the one that is not read from left to right. None for curves that are no one
    line, or closed.
    """
    if len(curves) == 1 and curves[0].type == "circle":
        return Way((_written_round(curves[0], here, inside=inside is True),), is_closed=True)
    way = way_along(curves, here)
    if way is None or way.is_closed:
        return None
    if len(curves) == 1 and curves[0].type == "arc" and inside is not None:
        backwards = clockwise(curves[0], here) == inside
    else:
        ahead = way.at(ex.mul(way.length, ex.constant(0.5)))[1].value
        backwards = (-90.0 < (ahead + 180.0 - 1e-9) % 360.0 - 180.0 <= 90.0) == (inside is True)
    return Way(tuple(s.turned_round for s in reversed(way.stretches)), is_closed=False) if backwards else way


def _written_round(circle: Geometry, here: Structure, *, inside: bool) -> Stretch:
    core, turn = view(circle, here), 1.0 if inside else -1.0
    (x, y), radius = xy(core["center"]), number(core["radius"])
    return Stretch(
        (x, ex.add(y, ex.mul(ex.constant(turn), radius))),
        ex.constant(180.0),
        ex.mul(ex.constant(2 * math.pi), radius),
        (x, y),
        ex.div(ex.mul(ex.constant(turn), _DEGREES), radius),
    )


def _value(place: Place) -> tuple[float, float]:
    return place[0].value, place[1].value

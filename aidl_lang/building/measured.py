"""Area, perimeter and centroid of closed geometry by formulas (Green's theorem), for what constrains them.

Which ends meet, which way round an outline runs and which lies in which is read off the first guesses; the
formulas hold as long as that stays. What is drawn is measured again once all is solved.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Iterator, Sequence
from functools import partial, reduce

from aidl_lang.building import expression as ex
from aidl_lang.building.along import Cubic
from aidl_lang.building.curves import NOWHERE, clockwise, gauss, number, pieces, sweep, view, xy
from aidl_lang.building.expression import Expression, Place
from aidl_lang.building.model import Geometry, Measurement, Structure
from aidl_lang.common.records import record

FORMULAS = (
    "a closed geometry of lines, arcs, circles, ellipses and Béziers has formulas, and a structure of one "
    "with holes inside"
)
OTHERWISE = "by the outline it does, but what is drawn is rounded, clipped, crossed or cut by more"
_MEET = 1e-6  # how near ends have to be to meet, relative to the extent of the outline
_SAMPLES = 16
_MOMENTS = 5  # terms that are exact for the moments of a cubic: polynomials of degree 8
_MEANS = 6  # steps of the arithmetic-geometric mean: exact for ellipses up to 1000 times as long as wide


@record(eq=False)
class _Side:
    """A piece of an outline: `area` is ½∮(x dy - y dx) and `moments` ½∮x² dy, -½∮y² dx over it."""

    ends: tuple[Place, Place] | None
    length: Expression
    area: Expression
    moments: Place
    sampled: tuple[tuple[float, float], ...]


def formula(of: Measurement) -> Expression | None:
    """Returns the area or perimeter of a closed geometry or of a structure of one with holes; else None."""
    if of.kind not in ("area", "perimeter") or len(of.of) != 1:
        return None
    thing = of.of[0]
    outlines, children = (
        (list(thing.own()), thing.children) if isinstance(thing, Structure) else ([thing], [])
    )
    if len(outlines) != 1 or any(c.children or c.kind not in ("hole", "drawing") for c in children):
        return None
    holes = [g for c in children if c.kind == "hole" for g in c.own()]
    total = ex.ZERO
    for sign, geometry in [(1, outlines[0]), *((-1, g) for g in holes)]:
        if (loops := _loops(geometry, geometry.owner)) is None:
            return None
        for share, sides in loops:
            shares = (side.length if of.kind == "perimeter" else side.area for side in sides)
            factor = 1 if of.kind == "perimeter" else sign * share
            total = total + factor * reduce(operator.add, shares)
    return total


def centroid(geometry: Geometry, here: Structure) -> Place | None:
    """Returns the centroid of what a closed geometry encloses; None if no formula tells."""
    if (loops := _loops(geometry, here)) is None:
        return None
    pieces = [(share, side) for share, sides in loops for side in sides]
    area = sum((share * side.area for share, side in pieces), ex.ZERO)
    x, y = sum((share * side.moments for share, side in pieces), NOWHERE)
    return Place(x / area, y / area)


def _loops(geometry: Geometry, here: Structure) -> list[tuple[int, list[_Side]]] | None:
    """Returns the outlines of a geometry, with 1 for those that run counter-clockwise around material and -1
    for others; None if it is not closed, or a piece has no formula.
    """
    sides: list[_Side] = []
    for primitive in geometry.primitives(even_construction=True):
        if primitive.type == "point":
            continue
        made = [] if primitive.recipe is not None or primitive.finishes else _sides(primitive, here)
        if not made:
            return None
        sides += made
    loops = list(_chained(sides)) if sides and not geometry.finishes else []
    if not all(loops) or not loops:
        return None
    outlines = [
        [p for side, forth in loop for p in (side.sampled if forth else side.sampled[::-1])] for loop in loops
    ]
    result = []
    for k, (loop, outline) in enumerate(zip(loops, outlines, strict=True)):
        depth = sum(_encloses(other, outline[0]) for j, other in enumerate(outlines) if j != k)
        sense = (1 if _signed(outline) > 0 else -1) * (-1 if depth % 2 else 1)
        result += [(sense if forth else -sense, [side]) for side, forth in loop]
    return result


def _chained(sides: Sequence[_Side]) -> Iterator[list[tuple[_Side, bool]]]:
    """Yields the closed outlines of pieces, each with whether it runs from its start; [] for an open one."""
    left = list(sides)
    extent = max(max(map(abs, p)) for side in sides for p in side.sampled)
    while left:
        chain = [(left.pop(0), True)]
        if chain[0][0].ends is None:
            yield chain
            continue
        start, at = _values(chain[0][0])
        while math.dist(start, at) > _MEET * extent:
            ends = ((k, j, e) for k, s in enumerate(left) if s.ends for j, e in enumerate(_values(s)))
            near = [(math.dist(e, at), k, j) for k, j, e in ends]
            if not near or min(near)[0] > _MEET * extent:
                yield []
                return
            _, k, j = min(near)
            chain.append((side := left.pop(k), j == 0))
            at = _values(side)[1 - j]
        yield chain


def _values(side: _Side) -> list[tuple[float, float]]:
    assert side.ends is not None
    return [end.written for end in side.ends]


def _signed(outline: Sequence[tuple[float, float]]) -> float:
    pairs = zip(outline, [*outline[1:], outline[0]], strict=True)
    return sum(ax * by - ay * bx for (ax, ay), (bx, by) in pairs)


def _encloses(outline: Sequence[tuple[float, float]], spot: tuple[float, float]) -> bool:
    x, y = spot
    pairs = zip(outline, [*outline[1:], outline[0]], strict=True)
    crossed = (
        ax + (y - ay) / (by - ay) * (bx - ax) > x for (ax, ay), (bx, by) in pairs if (ay > y) != (by > y)
    )
    return sum(crossed) % 2 == 1


def _cross(a: Place, b: Place) -> Expression:
    return a.x * b.y - a.y * b.x


_square = partial(ex.apply, "square")


def _sides(g: Geometry, here: Structure) -> list[_Side]:
    """Returns the pieces of a primitive; none if they have no formula."""
    if g.type in _ROUND:
        return [_ROUND[g.type](g, here)]
    return [_line(*piece) if len(piece) == 2 else _cubic(*piece) for piece in pieces(g, here)]


def _line(a: Place, b: Place) -> _Side:
    way = b - a

    def squares(p: Expression, q: Expression) -> Expression:
        return _square(p) + p * q + _square(q)

    moments = Place(1 / 6 * (way.y * squares(a.x, b.x)), -1 / 6 * (way.x * squares(a.y, b.y)))
    return _Side((a, b), way.length, 0.5 * _cross(a, b), moments, (a.written, b.written))


def _arc(g: Geometry, here: Structure) -> _Side:
    core, is_clockwise = view(g, here), clockwise(g, here)
    c, r, a, b = xy(core["center"]), number(core["radius"]), xy(core["start"]), xy(core["end"])
    turn = sweep(core, is_clockwise) * ex.DEGREE
    phi = -turn if is_clockwise else turn
    (x, y), (x0, y0) = c.written, a.written
    first = math.atan2(y0 - y, x0 - x)
    at = (first + phi.value * k / _SAMPLES for k in range(_SAMPLES + 1))
    sampled = tuple((x + r.value * math.cos(t), y + r.value * math.sin(t)) for t in at)
    (u, v), (s, t), swept = a - c, b - c, _square(r) * phi
    area = 0.5 * swept + 0.5 * (c.x * (t - v) - c.y * (s - u))

    def moment(middle: Expression, low: Expression, high: Expression, both: Expression) -> Expression:
        """Returns ½∮ (middle + r cos)² r cos over the arc; `low` and `high` are r sin at its ends, `both` the
        half sum of the sweep and of cos sin, times r².
        """
        above, below = (_square(r) * p - 1 / 3 * (p * _square(p)) for p in (high, low))
        return 0.5 * (_square(middle) * (high - low)) + middle * both + 0.5 * (above - below)

    product = s * t - u * v
    moments = Place(
        moment(c.x, v, t, 0.5 * swept + 0.5 * product), moment(c.y, -u, -s, 0.5 * swept + -0.5 * product)
    )
    return _Side((a, b), r * turn, area, moments, sampled)


def _round(g: Geometry, here: Structure) -> _Side:
    """Returns a circle or an ellipse as a piece without ends."""
    core = view(g, here)
    c = xy(core["center"])
    rx, ry = (number(core[name]) for name in (("rx", "ry") if g.type == "ellipse" else ("radius", "radius")))
    area = math.pi * (rx * ry)
    length = _around(rx, ry) if g.type == "ellipse" else math.tau * rx
    angle = math.radians(number(core["angle"]).value) if g.type == "ellipse" else 0.0
    cos, sin = math.cos(angle), math.sin(angle)
    turns = (math.tau * k / _SAMPLES for k in range(_SAMPLES))
    on = ((rx.value * math.cos(t), ry.value * math.sin(t)) for t in turns)
    sampled = tuple((c.x.value + x * cos - y * sin, c.y.value + x * sin + y * cos) for x, y in on)
    return _Side(None, length, area, area * c, sampled)


def _around(rx: Expression, ry: Expression) -> Expression:
    """Returns the perimeter of an ellipse by the arithmetic-geometric mean (Abramowitz and Stegun, 17.6)."""
    a, b = rx, ry
    total = 0.5 * _square(a) + 0.5 * _square(b)
    for k in range(_MEANS):
        off = 0.5 * a + -0.5 * b
        a, b = 0.5 * a + 0.5 * b, ex.apply("sqrt", a * b)
        total = total - 2.0**k * _square(off)
    return math.tau * total / a


def _cubic(*points: Place) -> _Side:
    a, b, c, d = points
    shares = ((6, a, b), (3, a, c), (1, a, d), (3, b, c), (3, b, d), (6, c, d))
    area = reduce(operator.add, (w / 20 * _cross(p, q) for w, p, q in shares))
    moments = NOWHERE
    for t, w in gauss(_MOMENTS):
        s = 1 - t
        of_place = s**3, 3 * s * s * t, 3 * s * t * t, t**3
        of_way = -3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t
        place, way = (reduce(operator.add, map(operator.mul, each, points)) for each in (of_place, of_way))
        moments = moments + Place(0.5 * w * (_square(place.x) * way.y), -0.5 * w * (_square(place.y) * way.x))
    at = ((k / _SAMPLES, 1 - k / _SAMPLES) for k in range(_SAMPLES + 1))
    weights = ((s**3, 3 * s * s * t, 3 * s * t * t, t**3) for t, s in at)
    xs, ys = zip(*(p.written for p in points), strict=True)
    sampled = tuple((sum(map(operator.mul, w, xs)), sum(map(operator.mul, w, ys))) for w in weights)
    return _Side((a, d), Cubic((a, b, c, d)).length, area, moments, sampled)


_ROUND = {"arc": _arc, "circle": _round, "ellipse": _round}

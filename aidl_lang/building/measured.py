"""Area, perimeter and centroid of closed geometry by formulas (Green's theorem), for what constrains them.

Which ends meet, which way round an outline runs and which lies in which is read off the first guesses; the
formulas hold as long as that stays. What is drawn is measured again once all is solved.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from functools import reduce

from aidl_lang.building import expression as ex
from aidl_lang.building.along import Cubic, way
from aidl_lang.building.curves import Place, clockwise, gauss, number, sweep, view, xy
from aidl_lang.building.expression import Expression
from aidl_lang.building.model import Geometry, Measurement, Structure
from aidl_lang.common.records import record

FORMULAS = (
    "a closed geometry of lines, arcs, circles, ellipses and Béziers has formulas, and a structure of one "
    "with holes inside"
)
OTHERWISE = "by the outline it does, but what is drawn is rounded, clipped, crossed or cut by more"
_MEET = 1e-6
"""How near ends have to be to meet, relative to the extent of the outline."""
_SAMPLES = 16
_MOMENTS = 5
"""Terms that are exact for the moments of a cubic: polynomials of degree 8."""
_MEANS = 6
"""Steps of the arithmetic-geometric mean: exact for ellipses up to 1000 times as long as wide."""


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
            total = ex.add(total, ex.mul(ex.constant(factor), reduce(ex.add, shares)))
    return total


def centroid(geometry: Geometry, here: Structure) -> Place | None:
    """Returns the centroid of what a closed geometry encloses; None if no formula tells."""
    if (loops := _loops(geometry, here)) is None:
        return None
    area = x = y = ex.ZERO
    for share, sides in loops:
        for side in sides:
            by = ex.constant(share)
            area = ex.add(area, ex.mul(by, side.area))
            x, y = (ex.add(m, ex.mul(by, own)) for m, own in zip((x, y), side.moments, strict=True))
    return ex.div(x, area), ex.div(y, area)


def _loops(geometry: Geometry, here: Structure) -> list[tuple[int, list[_Side]]] | None:
    """Returns the outlines of a geometry, with 1 for those that run counter-clockwise around material and -1
    for others; None if it is not closed, or a piece has no formula.
    """
    sides: list[_Side] = []
    for primitive in geometry.primitives(even_construction=True):
        if primitive.type == "point":
            continue
        if primitive.type not in _SIDES or primitive.recipe is not None or primitive.finishes:
            return None
        sides.append(_SIDES[primitive.type](primitive, here))
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
    return [(x.value, y.value) for x, y in side.ends]


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


def _sum(*terms: tuple[float, Expression]) -> Expression:
    return reduce(ex.add, (ex.mul(ex.constant(by), term) for by, term in terms))


def _cross(a: Place, b: Place) -> Expression:
    return ex.sub(ex.mul(a[0], b[1]), ex.mul(a[1], b[0]))


def _line(g: Geometry, here: Structure) -> _Side:
    core = view(g, here)
    a, b = xy(core["start"]), xy(core["end"])
    dx, dy = ex.sub(b[0], a[0]), ex.sub(b[1], a[1])

    def squares(p: Expression, q: Expression) -> Expression:
        return _sum((1.0, ex.apply("square", p)), (1.0, ex.mul(p, q)), (1.0, ex.apply("square", q)))

    moments = _sum((1 / 6, ex.mul(dy, squares(a[0], b[0])))), _sum((-1 / 6, ex.mul(dx, squares(a[1], b[1]))))
    sampled = tuple((x.value, y.value) for x, y in (a, b))
    return _Side((a, b), ex.apply("hypot", dx, dy), _sum((0.5, _cross(a, b))), moments, sampled)


def _arc(g: Geometry, here: Structure) -> _Side:
    core, is_clockwise = view(g, here), clockwise(g, here)
    c, r, a, b = xy(core["center"]), number(core["radius"]), xy(core["start"]), xy(core["end"])
    turn = ex.mul(sweep(core, is_clockwise), ex.constant(ex.DEGREE))
    phi = ex.apply("neg", turn) if is_clockwise else turn
    first = math.atan2(a[1].value - c[1].value, a[0].value - c[0].value)
    at = (first + phi.value * k / _SAMPLES for k in range(_SAMPLES + 1))
    sampled = tuple((c[0].value + r.value * math.cos(t), c[1].value + r.value * math.sin(t)) for t in at)
    ((u, v), (s, t)), swept = (way(c, p) for p in (a, b)), ex.mul(ex.apply("square", r), phi)
    area = _sum((0.5, swept), (0.5, ex.sub(ex.mul(c[0], ex.sub(t, v)), ex.mul(c[1], ex.sub(s, u)))))

    def moment(middle: Expression, low: Expression, high: Expression, both: Expression) -> Expression:
        """Returns ½∮ (middle + r cos)² r cos over the arc; `low` and `high` are r sin at its ends, `both` the
        half sum of the sweep and of cos sin, times r².
        """
        cubes = (
            ex.sub(ex.mul(ex.apply("square", r), p), _sum((1 / 3, ex.mul(p, ex.apply("square", p)))))
            for p in (high, low)
        )
        flat = ex.mul(ex.apply("square", middle), ex.sub(high, low))
        return _sum((0.5, flat), (1.0, ex.mul(middle, both)), (0.5, reduce(ex.sub, cubes)))

    product = ex.sub(ex.mul(s, t), ex.mul(u, v))
    moments = (
        moment(c[0], v, t, _sum((0.5, swept), (0.5, product))),
        moment(c[1], ex.apply("neg", u), ex.apply("neg", s), _sum((0.5, swept), (-0.5, product))),
    )
    return _Side((a, b), ex.mul(r, turn), area, moments, sampled)


def _round(g: Geometry, here: Structure) -> _Side:
    """Returns a circle or an ellipse as a piece without ends."""
    core = view(g, here)
    c = xy(core["center"])
    radii = [number(core[name]) for name in (("rx", "ry") if g.type == "ellipse" else ("radius", "radius"))]
    area = ex.mul(ex.constant(math.pi), ex.mul(*radii))
    length = _around(*radii) if g.type == "ellipse" else ex.mul(ex.constant(math.tau), radii[0])
    angle = math.radians(number(core["angle"]).value) if g.type == "ellipse" else 0.0
    cos, sin = math.cos(angle), math.sin(angle)
    turns = (math.tau * k / _SAMPLES for k in range(_SAMPLES))
    on = ((radii[0].value * math.cos(t), radii[1].value * math.sin(t)) for t in turns)
    sampled = tuple((c[0].value + x * cos - y * sin, c[1].value + x * sin + y * cos) for x, y in on)
    return _Side(None, length, area, (ex.mul(area, c[0]), ex.mul(area, c[1])), sampled)


def _around(rx: Expression, ry: Expression) -> Expression:
    """Returns the perimeter of an ellipse by the arithmetic-geometric mean (Abramowitz and Stegun, 17.6)."""
    a, b = rx, ry
    total = _sum((0.5, ex.apply("square", a)), (0.5, ex.apply("square", b)))
    for k in range(_MEANS):
        off = _sum((0.5, a), (-0.5, b))
        a, b = _sum((0.5, a), (0.5, b)), ex.apply("sqrt", ex.mul(a, b))
        total = ex.sub(total, _sum((2.0**k, ex.apply("square", off))))
    return ex.div(ex.mul(ex.constant(math.tau), total), a)


def _bezier(g: Geometry, here: Structure) -> _Side:
    core = view(g, here)
    a, b, c, d = (xy(core[name]) for name in ("p0", "p1", "p2", "p3"))
    cubic = Cubic((a, b, c, d))
    shares = ((6, a, b), (3, a, c), (1, a, d), (3, b, c), (3, b, d), (6, c, d))
    area = _sum(*((w / 20, _cross(p, q)) for w, p, q in shares))
    moments = [ex.ZERO, ex.ZERO]
    for t, w in gauss(_MOMENTS):
        s = 1 - t
        of_place = s**3, 3 * s * s * t, 3 * s * t * t, t**3
        of_way = -3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t
        axes = list(zip(a, b, c, d, strict=True))
        place, way = ([_sum(*zip(w, axis, strict=True)) for axis in axes] for w in (of_place, of_way))
        for axis, sign in ((0, 0.5), (1, -0.5)):
            moments[axis] = ex.add(
                moments[axis], _sum((sign * w, ex.mul(ex.apply("square", place[axis]), way[1 - axis])))
            )
    at = ((k / _SAMPLES, 1 - k / _SAMPLES) for k in range(_SAMPLES + 1))
    weights = ((s**3, 3 * s * s * t, 3 * s * t * t, t**3) for t, s in at)
    values = [[p[axis].value for p in (a, b, c, d)] for axis in (0, 1)]
    sampled = tuple((_dot(w, values[0]), _dot(w, values[1])) for w in weights)
    return _Side((a, d), cubic.length, area, (moments[0], moments[1]), sampled)


def _dot(weights: Iterable[float], values: Iterable[float]) -> float:
    return sum(w * v for w, v in zip(weights, values, strict=True))


_SIDES = {"line": _line, "arc": _arc, "circle": _round, "ellipse": _round, "bezier": _bezier}
"""The formulas of each kind of piece."""

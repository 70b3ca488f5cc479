"""Regions grown, shrunk, drawn with a thick pen, and the hulls of curves."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Floats, Line, Piece, Vec, extent, turn_between
from aidl_lang.geometry.region import Face, Loop, Region
from aidl_lang.geometry.sections import Outlined, Section, outlined, overlaid, union

# --- The pieces that offsets are put together from: strips along curves, wedges at corners, caps at ends.
#
# What lies within a distance of a curve is swept by its normals. A point is nearest to the inside of a
# curve, where the normal leads to it, or to a corner; so strips along all curves and wedges at all corners
# cover exactly the points within the distance (but for caps). A strip need not reach beyond the centre of
# curvature, where other points of the curve are nearer. Each strip is bounded by exact curves, except beside
# Bézier curves and ellipses: their parallel curves are fitted by cubics.

Outline = tuple[Piece, ...]
Strip = tuple[Outline, ...]
"""A closed outline, or an outer and an inner one."""

FIT = 1e-5
"""Largest error of a fitted parallel curve, relative to its distance plus the extent of the curve."""
_DEEPEST = 6
_SHORTEST = 1e-6
"""Shares of a curve that are no part of their own."""
_BEND = 0.3
"""Radians that a part may turn under a straight top."""
_SHARPEST = math.radians(168.5)
"""Corners that turn further are rounded: their point would stand out more than ten times the distance."""


def beside(curve: Piece, left: float) -> Iterator[Strip]:
    """Yields the strips within a distance to the left of a curve (to its right for a negative one)."""
    if isinstance(curve, Line):
        yield (_between(curve, Line(curve.parallel(0.0, left), curve.parallel(1.0, left))),)
    elif isinstance(curve, Circle):
        other = curve.radius - left
        yield ((curve,), (Circle(curve.center, other),)) if other > 0 else ((curve,),)
    elif isinstance(curve, Arc):
        yield (_beside_arc(curve, left),)
    else:
        yield from _beside_free(curve, left)


def _between(curve: Piece, other: Piece) -> Outline:
    """Returns the outline from a curve to one beside it and back."""
    (a, b), (c, d) = curve.ends, other.ends
    return tuple(
        p
        for p in (curve, Line(b, d), other.reversed(), Line(c, a))
        if not isinstance(p, Line) or p.start != p.end
    )


def _beside_arc(arc: Arc, left: float) -> Outline:
    radius = arc.radius - math.copysign(left, left * arc.sweep)
    if radius <= 0:
        return (arc, Line(arc.end, arc.center), Line(arc.center, arc.start))
    share, (x, y) = radius / arc.radius, arc.center
    start, end = ((x + share * (p[0] - x), y + share * (p[1] - y)) for p in (arc.start, arc.end))
    return _between(arc, Arc(arc.center, radius, start, end, arc.sweep))


# --- Curves whose parallels are no curves of their kind ------------------------------------------------


def _beside_free(curve: Piece, left: float) -> Iterator[Strip]:
    """Yields strips in parts short enough to fit; their far side is straight where the curve bends closer
    than the distance. A part ends where the curve is level or upright, and there the fit is exact: the box of
    the parallel curve is that of the curve moved out.
    """
    x0, y0, x1, y1 = curve.box
    scale = abs(left) + max(x1 - x0, y1 - y0)
    inner = sorted(t for t in curve.extremes() if _SHORTEST < t < 1 - _SHORTEST)
    cuts = [t for t, after in pairwise([*inner, 1.0]) if after - t > _SHORTEST]
    stack = [(t0, t1, 0) for t0, t1 in pairwise([0.0, *cuts, 1.0])][::-1]
    while stack:
        t0, t1, depth = stack.pop()
        bent = [_stretch(curve, t0 + (t1 - t0) * k / 8, left) <= 0 for k in range(9)]
        top: Piece
        if not any(bent):
            top = _fitted(curve, t0, t1, left)
            is_fine = _error(curve, t0, t1, left, top) <= FIT * scale
        else:
            top = Line(*(_reached(curve, t, left) for t in (t0, t1)))
            is_fine = all(bent) and abs(turn_between(curve.direction(t0), curve.direction(t1))) < _BEND
        if is_fine or depth >= _DEEPEST:
            yield (_between(curve.part(t0, t1, curve.point(t0), curve.point(t1)), top),)
        else:
            half = (t0 + t1) / 2
            stack += [(half, t1, depth + 1), (t0, half, depth + 1)]


def _reached(curve: Piece, t: float, left: float) -> Vec:
    """Returns the end of a normal a little beyond the centre of curvature, but within the distance."""
    stretch = _stretch(curve, t, left)
    return curve.parallel(t, left * min(1.0, 1.1 / abs(1 - stretch)) if stretch != 1 else left)


def _stretch(curve: Piece, t: float, left: float) -> float:
    """Returns the length of a step on the parallel curve for one on the curve: 1 - left · curvature."""
    (dx, dy), (ax, ay) = curve.derivative(t), curve.second_derivative(t)
    speed = math.hypot(dx, dy)
    return 1 - left * (dx * ay - dy * ax) / speed**3 if speed else 1.0


def _fitted(curve: Piece, t0: float, t1: float, left: float) -> Bezier:
    """Returns the cubic with the ends and the derivatives of the parallel curve."""
    p, q = curve.parallel(t0, left), curve.parallel(t1, left)
    (ax, ay), (bx, by) = curve.derivative(t0), curve.derivative(t1)
    u, v = (_stretch(curve, t, left) * (t1 - t0) / 3 for t in (t0, t1))
    return Bezier(p, (p[0] + u * ax, p[1] + u * ay), (q[0] - v * bx, q[1] - v * by), q)


def _error(curve: Piece, t0: float, t1: float, left: float, fitted: Bezier) -> float:
    """Returns the greatest distance of the fitted curve from the parallel one, along the normals of that."""
    worst = 0.0
    for s in (0.2, 0.35, 0.5, 0.65, 0.8):
        t = t0 + s * (t1 - t0)
        (px, py), (qx, qy), (dx, dy) = curve.parallel(t, left), fitted.point(s), curve.direction(t)
        worst = max(worst, abs((qx - px) * dy - (qy - py) * dx))
    return worst


# --- Corners and ends ----------------------------------------------------------------------------


def wedge(at: Vec, arriving: Vec, leaving: Vec, left: float, sharp: bool) -> list[Strip]:
    """Returns the strip that a corner adds on its outer side; none if that is not the side asked for.
    `arriving` and `leaving` are unit directions.
    """
    turn = turn_between(arriving, leaving)
    if abs(turn) < 1e-9 or (turn * left >= 0 and abs(turn) < math.pi - 1e-9):
        return []
    p = at[0] - left * arriving[1], at[1] + left * arriving[0]
    q = at[0] - left * leaving[1], at[1] + left * leaving[0]
    if sharp and abs(turn) < _SHARPEST:
        reach = math.tan(turn / 2) * -left
        tip = p[0] + reach * arriving[0], p[1] + reach * arriving[1]
        return [((Line(at, p), Line(p, tip), Line(tip, q), Line(q, at)),)]
    sweep = -math.copysign(abs(turn), left)
    return [((Line(at, p), Arc(at, abs(left), p, q, sweep), Line(q, at)),)]


def cap(at: Vec, outward: Vec, half: float, form: str) -> list[Strip]:
    """Returns the strip that an end adds to both sides: `round`, `square`, or none for `butt`."""
    p = at[0] + half * outward[1], at[1] - half * outward[0]
    q = at[0] - half * outward[1], at[1] + half * outward[0]
    if form == "butt":
        return []
    if form == "round":
        return [((Arc(at, half, p, q, math.pi), Line(q, p)),)]
    x, y = half * outward[0], half * outward[1]
    a, b = (p[0] + x, p[1] + y), (q[0] + x, q[1] + y)
    return [((Line(p, a), Line(a, b), Line(b, q), Line(q, p)),)]


# --- Regions grown, shrunk and drawn with a thick pen: exact sums of curves and discs.
#
# Every offset is the region with its strips and wedges (see `strips`) united or cut off by the booleans that
# all drawings use. So whatever crosses itself, splits or vanishes comes out as it must.

NEAR = 1e-6
"""Ends that are closer, relative to the size of what they belong to, are one point."""


def offset(region: Region, distance: float, sharp: bool = True) -> Region:
    """Returns all within a distance of the region; for a negative one, the region without its border."""
    if distance == 0 or not region:
        return region
    strips: list[Strip] = []
    loops: list[Loop] = []
    for loop in region.loops:
        left = distance if loop.reversed else -distance  # material lies to the left
        parts: list[Piece] = []
        for piece, after in zip(loop.pieces, (*loop.pieces[1:], loop.pieces[0]), strict=True):
            along = list(beside(piece, left))
            strips += along
            if not piece.is_closed:
                strips += wedge(piece.ends[1], piece.direction(1.0), after.direction(0.0), left, sharp)
            # Cut where its strips are, so that the outline and they have the same curves.
            is_whole = isinstance(piece, Line | Arc | Circle)
            parts += [piece] if is_whole else [strip[0][0] for strip in along]
        loops.append(Loop(tuple(parts), loop.reversed))
    # Loops are only filled together here, so that they may all count as outer ones.
    return _combined(Region(tuple(map(Face, loops))), strips, cut=distance < 0)


def thick(curves: Sequence[Piece], width: float, caps: str = "round", sharp: bool = False) -> Region:
    """Returns what a pen of a width draws along curves; where more than two meet, the joint is round."""
    half = width / 2
    near = NEAR * extent(curves)
    strips: list[Strip] = [s for c in curves for side in (half, -half) for s in beside(c, side)]
    for at, leaving in _joints(curves, near):
        if len(leaving) > 2:
            strips.append(((Circle(at, half),),))
            continue
        arriving = -leaving[0][0], -leaving[0][1]
        if len(leaving) == 2:
            strips += [s for side in (half, -half) for s in wedge(at, arriving, leaving[1], side, sharp)]
        else:
            strips += cap(at, arriving, half, caps)
    return _combined(Region(), strips, cut=False)


def _joints(curves: Sequence[Piece], near: float) -> list[tuple[Vec, list[Vec]]]:
    """Returns the points where open curves end, with the directions in which they leave them."""
    found: list[tuple[Vec, list[Vec]]] = []
    for curve in curves:
        if curve.is_closed:
            continue
        (start, end), (dx, dy) = curve.ends, curve.direction(1.0)
        for p, way in ((start, curve.direction(0.0)), (end, (-dx, -dy))):
            ways = next((w for q, w in found if math.dist(p, q) <= near), None)
            if ways is None:
                found.append((p, [way]))
            else:
                ways.append(way)
    return found


def _combined(region: Region, strips: Sequence[Strip], *, cut: bool) -> Region:
    def area(base: Section, *sections: Section) -> Sequence[Section]:
        added = union(sections)
        return [base - added if cut else union([base, added])]

    # Normals of a curve that bends closely cross: all that a single outline goes around counts.
    shapes: list[Outlined] = [(strip, "NonZero" if len(strip) == 1 else "EvenOdd") for strip in strips]
    return overlaid([outlined(region), *shapes], area)[0]


# --- The convex hull of curves: parts of the curves themselves, and the straight lines that touch two of
# them.
#
# A fine sampling tells which curves the hull runs along, and in which order; the points of touch are then
# found exactly, by alternating projection.

_SAMPLES = 720
_NEAR = 1e-9
"""Points closer than this, relative to the size, are one."""


@record(slots=True)
class _HullContact:
    """A curve along the hull, about from `t0` to `t1` (past 1 on a closed curve), or only its end there."""

    curve: Piece
    t0: float
    t1: float


def hull(curves: Sequence[Piece]) -> Region:
    """Returns the least convex region around the curves; empty if they lie on one line."""
    contacts = _contacts(_distinct(curves))
    if len(contacts) == 1 and contacts[0].curve.is_closed:
        return Region((Face(Loop((contacts[0].curve,))),))
    spots = [_touch(a, b) for a, b in zip(contacts, contacts[1:] + contacts[:1], strict=True)]
    pieces: list[Piece] = []
    for k, contact in enumerate(contacts):
        arrived, left = spots[k - 1][1], spots[k][0]
        p, q = contact.curve.point(arrived), contact.curve.point(left)
        stop = left
        if contact.curve.is_closed:  # the hull runs round it forwards, about as far as its samples do
            share = (contact.t1 - contact.t0) % 1.0
            stop = arrived + share + math.remainder(left - arrived - share, 1.0)
            if stop - arrived > 1 - _NEAR:
                return Region((Face(Loop((contact.curve,))),))
        if arrived != stop:
            pieces.append(contact.curve.part(arrived, stop, p, q))
        pieces.append(Line(q, contacts[(k + 1) % len(contacts)].curve.point(spots[k][1])))
    size = max((math.dist(a.ends[0], pieces[0].ends[0]) for a in pieces), default=0.0)
    kept = [p for p in pieces if math.dist(*p.ends) > _NEAR * size]
    return Region((Face(Loop(tuple(_joined(kept)))),)) if len(kept) > 1 else Region()


def _distinct(curves: Sequence[Piece]) -> list[Piece]:
    """Returns each curve once, without those in the disc of a circle, where no line touches two."""
    kept: list[Piece] = []
    for curve in sorted(dict.fromkeys(curves), key=lambda c: -c.radius if isinstance(c, Circle) else 0.0):
        if not isinstance(curve, Arc | Circle) or not any(
            math.dist(c.center, curve.center) + curve.radius <= c.radius * (1 + _NEAR)
            for c in kept
            if isinstance(c, Circle)
        ):
            kept.append(curve)
    return kept


def _contacts(curves: Sequence[Piece]) -> list[_HullContact]:
    """Returns the stretches of curves that the hull of the samples touches, counter-clockwise."""
    samples = [_spread(curve) for curve in curves]
    owner = [number for number, ts in enumerate(samples) for _ in ts]
    place = [k for ts in samples for k in range(len(ts))]
    around = _convex(np.concatenate([c.points(ts) for c, ts in zip(curves, samples, strict=True)]))
    if len(around) < 3:
        return []
    runs: list[list[int]] = []

    def follows(a: int, b: int) -> bool:
        count = len(samples[owner[a]])
        step = abs(place[a] - place[b])
        around_end = curves[owner[a]].is_closed and step == count - 1
        return owner[a] == owner[b] and not isinstance(curves[owner[a]], Line) and (step == 1 or around_end)

    for k in around:
        if runs and follows(runs[-1][-1], k):
            runs[-1].append(k)
        else:
            runs.append([k])
    if len(runs) > 1 and follows(runs[-1][-1], runs[0][0]):
        runs[0] = runs.pop() + runs[0]
    return [
        _HullContact(curves[owner[run[0]]], *(float(samples[owner[k]][place[k]]) for k in (run[0], run[-1])))
        for run in runs
    ]


def _spread(curve: Piece) -> Floats:
    if isinstance(curve, Line):
        return np.array([0.0, 1.0])
    return np.arange(_SAMPLES + (not curve.is_closed)) / _SAMPLES


def _convex(p: Floats) -> list[int]:
    """Numbers of the points of the convex hull, counter-clockwise (Andrew's monotone chain)."""
    order = np.lexsort((p[:, 1], p[:, 0])).tolist()
    xy = p.tolist()

    def half(numbers: list[int]) -> list[int]:
        chain: list[int] = []
        for k in numbers:
            while len(chain) > 1:
                (ax, ay), (bx, by), (cx, cy) = xy[chain[-2]], xy[chain[-1]], xy[k]
                if (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) > 0:
                    break
                chain.pop()
            chain.append(k)
        return chain

    return half(order)[:-1] + half(order[::-1])[:-1]


def _touch(a: _HullContact, b: _HullContact) -> tuple[float, float]:
    """Returns where the line from one contact to the next leaves the one and reaches the other: the tangent
    to each from the point of touch on the other, by turns. An error of one is squared in the other.
    """
    t, s = a.t1, b.t0
    for _ in range(100):
        before = t, s
        t = _tangent_from(a.curve, b.curve.point(s), t)
        s = _tangent_from(b.curve, a.curve.point(t), s)
        if abs(t - before[0]) + abs(s - before[1]) < 1e-14:
            break
    return t, s


def _tangent_from(curve: Piece, p: Vec, t: float) -> float:
    """Returns the parameter near t where the tangent passes through a point; an end stays an end."""
    if isinstance(curve, Line):
        return t

    def across(t: float) -> float:
        (x, y), (dx, dy) = curve.point(t), curve.derivative(t)
        return dx * (p[1] - y) - dy * (p[0] - x)

    low, high = t - 1.5 / _SAMPLES, t + 1.5 / _SAMPLES
    if not curve.is_closed:
        low, high = max(0.0, low), min(1.0, high)
    first = across(low)
    if first * across(high) > 0:
        on_it = curve.locate(p, _NEAR * extent([curve]))  # a point on a curve is where it is touched
        if on_it is not None:
            away = math.remainder(on_it - t, 1.0) if curve.is_closed else on_it - t
            return on_it if abs(away) < 2 / _SAMPLES else t
        return t
    while low < (middle := (low + high) / 2) < high:
        low, high = (middle, high) if across(middle) * first > 0 else (low, middle)
    return middle


def _joined(pieces: list[Piece]) -> list[Piece]:
    """Returns the pieces with each starting where the one before it ends."""
    result: list[Piece] = []
    for k, piece in enumerate(pieces):
        start = pieces[k - 1].ends[1]
        end = piece.ends[1]
        result.append(Line(start, end) if isinstance(piece, Line) else piece.part(0.0, 1.0, start, end))
    return result

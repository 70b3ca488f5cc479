"""The convex hull of curves: parts of the curves themselves, and the straight lines that touch two of them.

A fine sampling tells which curves the hull runs along, and in which order; the points of touch are then found
exactly: in closed form for points, arcs and circles, by alternating projection for the others.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Arc, Circle, Line, Piece, Vec
from aidl_lang.geometry.evaluate import derivative, ends, is_closed, nearest, part, point, points
from aidl_lang.geometry.region import Face, Loop, Region

_SAMPLES = 720
_NEAR = 1e-9
"""Points closer than this, relative to the size, are one."""


@record(slots=True)
class _HullContact:
    """A curve that the hull runs along, about from `t0` to `t1` (which may pass 1 on a closed curve), or
    only its end there.
    """

    curve: Piece
    t0: float
    t1: float


def hull(curves: Sequence[Piece]) -> Region:
    """Returns the least convex region around the curves; empty if they lie on one line."""
    contacts = _contacts(_distinct(curves))
    if len(contacts) == 1 and is_closed(contacts[0].curve):
        return Region((Face(Loop((contacts[0].curve,))),))
    spots = [_touch(a, b) for a, b in zip(contacts, contacts[1:] + contacts[:1], strict=True)]
    pieces: list[Piece] = []
    for k, contact in enumerate(contacts):
        arrived, left = spots[k - 1][1], spots[k][0]
        p, q = point(contact.curve, arrived), point(contact.curve, left)
        if arrived != left:
            # the hull runs round closed ones forwards
            stop = arrived + (left - arrived) % 1.0 if is_closed(contact.curve) else left
            pieces.append(part(contact.curve, arrived, stop, p, q))
        pieces.append(Line(q, point(contacts[(k + 1) % len(contacts)].curve, spots[k][1])))
    size = max((math.dist(ends(a)[0], ends(pieces[0])[0]) for a in pieces), default=0.0)
    kept = [p for p in pieces if math.dist(*ends(p)) > _NEAR * size]
    return Region((Face(Loop(tuple(_joined(kept)))),)) if len(kept) > 1 else Region()


def _distinct(curves: Sequence[Piece]) -> list[Piece]:
    """Returns each curve once, without those in the disc of a circle: on circles that all but coincide, no
    line touches two.
    """
    kept: list[Piece] = []
    for curve in sorted(dict.fromkeys(curves), key=lambda c: -c.radius if isinstance(c, Circle) else 0.0):
        if not (isinstance(curve, Arc | Circle) and any(_holds(c, curve) for c in kept)):
            kept.append(curve)
    return kept


def _holds(outer: Piece, inner: Arc | Circle) -> bool:
    """Tells whether one curve is a circle in whose disc the other lies."""
    if not isinstance(outer, Circle):
        return False
    return math.dist(outer.center, inner.center) + inner.radius <= outer.radius * (1 + _NEAR)


def _contacts(curves: Sequence[Piece]) -> list[_HullContact]:
    """Returns the stretches of curves that the hull of the samples touches, counter-clockwise."""
    samples = [_spread(curve) for curve in curves]
    owner = [number for number, ts in enumerate(samples) for _ in ts]
    place = [k for ts in samples for k in range(len(ts))]
    around = _convex(np.concatenate([points(c, ts) for c, ts in zip(curves, samples, strict=True)]))
    if len(around) < 3:
        return []
    runs: list[list[int]] = []

    def follows(a: int, b: int) -> bool:
        count = len(samples[owner[a]])
        step = abs(place[a] - place[b])
        around_end = is_closed(curves[owner[a]]) and step == count - 1
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


def _spread(curve: Piece) -> NDArray[np.float64]:
    """Returns the parameters of the samples of a curve."""
    if isinstance(curve, Line):
        return np.array([0.0, 1.0])
    return np.arange(_SAMPLES + (not is_closed(curve))) / _SAMPLES


def _convex(p: NDArray[np.float64]) -> list[int]:
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
    """Returns the parameters where the line from one contact to the next leaves the one and reaches the
    other.
    """
    t, s = a.t1, b.t0
    one, other = _disc(a.curve, t), _disc(b.curve, s)
    while one is not None and other is not None and (ways := _tangent(*one, *other)) is not None:
        # A point of touch beyond the end of an arc: the hull touches the end itself.
        u, v = (_parameter(c.curve, p, at) for c, p, at in ((a, ways[0], t), (b, ways[1], s)))
        if u is None:
            one = point(a.curve, t), 0.0
        if v is None:
            other = point(b.curve, s), 0.0
        if u is not None and v is not None:
            found = u if one[1] else t, v if other[1] else s
            if _is_near(a.curve, found[0], t) and _is_near(b.curve, found[1], s):
                return found
            break  # discs that all but coincide are touched anywhere
    for _ in range(100):
        before = t, s
        t = _tangent_from(a.curve, point(b.curve, s), t)
        s = _tangent_from(b.curve, point(a.curve, t), s)
        if abs(t - before[0]) + abs(s - before[1]) < 1e-14:
            break
    return t, s


def _is_near(curve: Piece, t: float, sampled: float) -> bool:
    """Tells whether a parameter lies between the samples around the one that the sampling told."""
    away = abs(t - sampled)
    return min(away, 1 - away if is_closed(curve) else away) < 2 / _SAMPLES


def _disc(curve: Piece, t: float) -> tuple[Vec, float] | None:
    """Returns a centre and a radius; the end of a line is a disc without extent."""
    if isinstance(curve, Line):
        return point(curve, t), 0.0
    return (curve.center, curve.radius) if isinstance(curve, Arc | Circle) else None


def _tangent(c: Vec, r: float, d: Vec, s: float) -> tuple[Vec, Vec] | None:
    """Returns the points of touch of the line that has both discs on its left; None if one lies in the
    other.
    """
    x, y = d[0] - c[0], d[1] - c[1]
    square = x * x + y * y
    rest = square - (r - s) ** 2
    if min(r, s) == 0 and abs(rest) <= 2 * _NEAR * square:
        rest = 0.0  # a point on the circle is where it is touched: the root of a rounding error is none
    elif rest <= 0:
        return None
    if square == 0:
        return None
    # The outward normal n has length 1 and n·(d - c) = r - s.
    k, h = (r - s) / square, math.sqrt(rest) / square
    n = k * x + h * y, k * y - h * x
    return (c[0] + r * n[0], c[1] + r * n[1]), (d[0] + s * n[0], d[1] + s * n[1])


def _parameter(curve: Piece, p: Vec, about: float) -> float | None:
    """Returns the parameter at which a curve passes a point of its circle; None if that is beyond the end
    that the hull touches.
    """
    if isinstance(curve, Line):
        return about
    t = nearest(curve, p)
    size = curve.radius if isinstance(curve, Arc | Circle) else 1.0
    if is_closed(curve) or about not in (0.0, 1.0):
        return t
    if math.dist(point(curve, about), p) <= _NEAR * size:
        return about
    # A point off the arc, or one elsewhere on it, where the same circle is touched from another side.
    on_arc = math.dist(point(curve, t), p) <= _NEAR * size
    return t if on_arc and _is_near(curve, t, about) else None


def _tangent_from(curve: Piece, p: Vec, t: float) -> float:
    """Returns the parameter near t at which the tangent of a curve passes through a point; an end stays an
    end.
    """
    if isinstance(curve, Line):
        return t

    def across(t: float) -> float:
        (x, y), (dx, dy) = point(curve, t), derivative(curve, t)
        return dx * (p[1] - y) - dy * (p[0] - x)

    low, high = t - 1.5 / _SAMPLES, t + 1.5 / _SAMPLES
    if not is_closed(curve):
        low, high = max(0.0, low), min(1.0, high)
    first = across(low)
    if first * across(high) > 0:
        return t
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if across(middle) * first > 0 else (low, middle)
    return (low + high) / 2


def _joined(pieces: list[Piece]) -> list[Piece]:
    """Returns the pieces with each starting where the one before it ends."""
    result: list[Piece] = []
    for k, piece in enumerate(pieces):
        start = ends(pieces[k - 1])[1]
        end = ends(piece)[1]
        result.append(Line(start, end) if isinstance(piece, Line) else part(piece, 0.0, 1.0, start, end))
    return result

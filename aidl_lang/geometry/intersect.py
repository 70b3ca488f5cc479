"""The points where two curves meet: closed forms for lines and circles, `carriers` for one of those and
another curve, Newton from a sampling for two others.

A near miss within the tolerance counts as a touch. Curves that lie on each other have no crossing here; what
they share begins and ends at end points, which `network` places on both.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from aidl_lang.geometry.carriers import on_carrier
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, Line, Piece, Vec
from aidl_lang.geometry.evaluate import (
    derivative,
    ends,
    is_closed,
    locate,
    point,
    points,
    second_derivative,
)

_SAMPLES = {Line: 1, Arc: 32, Circle: 48, Ellipse: 64, Bezier: 32}
Crossing = tuple[float, float, Vec]


def intersections(a: Piece, b: Piece, tolerance: float) -> list[Crossing]:
    """Crossings and touches as (parameter on a, parameter on b, point)."""
    if isinstance(a, Line) and isinstance(b, Line):
        return _line_line(a, b, tolerance)
    if isinstance(a, Line | Arc | Circle) and isinstance(b, Line | Arc | Circle):
        candidates = _round_candidates(a, b, tolerance)
        return _on_both(a, b, candidates, tolerance)
    if isinstance(b, Line | Arc | Circle):
        return [(t, s, p) for s, t, p in intersections(b, a, tolerance)]
    if not isinstance(a, Line | Arc | Circle):
        return _sampled(a, b, tolerance)
    crossings = [(locate(a, point(b, s), tolerance), s, point(b, s)) for s in on_carrier(a, b, tolerance)]
    found = _apart([(t, s, p) for t, s, p in crossings if t is not None], tolerance)
    may_lie = len(found) + sum(_on(a, p, tolerance) for p in ends(b)) > 1
    return [] if may_lie and _lie_on_each_other(a, b, tolerance) else found


def meet(a: Piece, b: Piece, tolerance: float) -> bool:
    """Tells whether two curves have a point in common: a crossing, a touch, an end of one on the other."""
    return (
        any(locate(a, p, tolerance) is not None for p in ends(b))
        or any(locate(b, p, tolerance) is not None for p in ends(a))
        or bool(intersections(a, b, tolerance))
    )


def _on_both(a: Piece, b: Piece, candidates: list[Vec], tolerance: float) -> list[Crossing]:
    found = []
    for p in candidates:
        t, s = locate(a, p, tolerance), locate(b, p, tolerance)
        if t is not None and s is not None:
            found.append((t, s, p))
    return found


def _line_line(a: Line, b: Line, tolerance: float) -> list[Crossing]:
    (x0, y0), (x1, y1) = a.start, a.end
    (u0, v0), (u1, v1) = b.start, b.end
    ax, ay, bx, by = x1 - x0, y1 - y0, u1 - u0, v1 - v0
    cross = ax * by - ay * bx
    if abs(cross) <= 1e-9 * math.hypot(ax, ay) * math.hypot(bx, by):
        return []
    t = ((u0 - x0) * by - (v0 - y0) * bx) / cross
    s = ((u0 - x0) * ay - (v0 - y0) * ax) / cross
    slack_a, slack_b = tolerance / math.hypot(ax, ay), tolerance / math.hypot(bx, by)
    if not (-slack_a <= t <= 1 + slack_a and -slack_b <= s <= 1 + slack_b):
        return []
    t, s = min(1.0, max(0.0, t)), min(1.0, max(0.0, s))
    return [(t, s, point(a, t))]


def _round_candidates(a: Line | Arc | Circle, b: Line | Arc | Circle, tolerance: float) -> list[Vec]:
    """Returns meeting points of the endless lines and whole circles that carry the two curves."""
    if isinstance(a, Line):
        assert not isinstance(b, Line)
        return line_circle(a, b, tolerance)
    if isinstance(b, Line):
        return line_circle(b, a, tolerance)
    return circle_circle(a, b, tolerance)


def line_circle(line: Line, circle: Arc | Circle, tolerance: float) -> list[Vec]:
    (x, y), r = circle.center, circle.radius
    dx, dy = line.end[0] - line.start[0], line.end[1] - line.start[1]
    length = math.hypot(dx, dy)
    if not length:
        return []
    dx, dy = dx / length, dy / length
    along = (x - line.start[0]) * dx + (y - line.start[1]) * dy
    foot = line.start[0] + along * dx, line.start[1] + along * dy
    distance = math.hypot(foot[0] - x, foot[1] - y)
    if distance > r + tolerance:
        return []
    if distance >= r - tolerance:
        return [foot]
    half = math.sqrt((r - distance) * (r + distance))
    return [(foot[0] + k * dx, foot[1] + k * dy) for k in (-half, half)]


def circle_circle(a: Arc | Circle, b: Arc | Circle, tolerance: float) -> list[Vec]:
    dx, dy = b.center[0] - a.center[0], b.center[1] - a.center[1]
    d, ra, rb = math.hypot(dx, dy), a.radius, b.radius
    if d <= tolerance or d > ra + rb + tolerance or d < abs(ra - rb) - tolerance:
        return []
    dx, dy = dx / d, dy / d
    if d >= ra + rb - tolerance or d <= abs(ra - rb) + tolerance:
        k = ra if d > rb or ra > rb else -ra
        return [(a.center[0] + k * dx, a.center[1] + k * dy)]
    k = (d * d + (ra - rb) * (ra + rb)) / (2 * d)
    h = math.sqrt(max(0.0, (ra - k) * (ra + k)))
    x, y = a.center[0] + k * dx, a.center[1] + k * dy
    return [(x - h * dy, y + h * dx), (x + h * dy, y - h * dx)]


def _sampled(a: Piece, b: Piece, tolerance: float) -> list[Crossing]:
    """Crossings and touches, from those of the two polylines and from where these come nearest."""
    if _lie_on_each_other(a, b, tolerance):
        return []
    na, nb = _SAMPLES.get(type(a), 48), _SAMPLES.get(type(b), 48)
    p, q = points(a, np.linspace(0, 1, na + 1)), points(b, np.linspace(0, 1, nb + 1))
    found: list[Crossing] = []
    for t, s in _crossed(p, q):
        crossing = _newton(a, b, t / na, s / nb, tolerance)
        if crossing:
            found.append(_touch_beside(a, b, crossing, tolerance) or crossing)
    for i, j in _nearest_samples(p, q):
        touch = _touch(a, b, i / na, j / nb, tolerance)
        if touch:
            found.append(touch)
    return _apart(found, tolerance)


def _apart(found: list[Crossing], tolerance: float) -> list[Crossing]:
    """Returns crossings in order, one of those at one point."""
    kept: list[Crossing] = []
    for crossing in sorted(found):
        if all(math.dist(crossing[2], other[2]) > tolerance for other in kept):
            kept.append(crossing)
    return kept


def _lie_on_each_other(a: Piece, b: Piece, tolerance: float) -> bool:
    """Tells whether the curves share a stretch: between two ends that lie on both, all else does."""
    if is_closed(a):
        a, b = b, a
    marks = [0.0, 1.0]
    if not is_closed(a):
        spots = list(ends(a)) if is_closed(b) else [*ends(a), *ends(b)]
        on_both = [
            t for p in spots if (t := locate(a, p, tolerance)) is not None and _on(b, point(a, t), tolerance)
        ]
        marks = sorted(on_both)
    return any(
        all(_on(b, point(a, t0 + (t1 - t0) * k / 8), tolerance) for k in range(1, 8))
        for t0, t1 in pairwise(marks)
        if math.dist(point(a, t0), point(a, t1)) > tolerance or t1 - t0 > 0.5
    )


def _on(curve: Piece, p: Vec, tolerance: float) -> bool:
    return locate(curve, p, tolerance) is not None


def _crossed(p: NDArray[np.float64], q: NDArray[np.float64]) -> list[tuple[float, float]]:
    """Returns the crossings of two polylines, counted in their sides."""
    dp, dq = np.diff(p, axis=0)[:, None, :], np.diff(q, axis=0)[None, :, :]
    gap = q[None, :-1, :] - p[:-1, None, :]
    cross = dp[..., 0] * dq[..., 1] - dp[..., 1] * dq[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (gap[..., 0] * dq[..., 1] - gap[..., 1] * dq[..., 0]) / cross
        s = (gap[..., 0] * dp[..., 1] - gap[..., 1] * dp[..., 0]) / cross
        # The curves bulge beyond their chords: look a little past each segment.
        hit = (t >= -0.2) & (t <= 1.2) & (s >= -0.2) & (s <= 1.2)
    return [(float(i + t[i, j]), float(j + s[i, j])) for i, j in np.argwhere(hit)]


def _nearest_samples(p: NDArray[np.float64], q: NDArray[np.float64]) -> list[tuple[int, int]]:
    """Returns pairs of samples that are nearer than those beside them, and no further apart than neighbouring
    samples.
    """
    away = np.hypot(*np.moveaxis(p[:, None, :] - q[None, :, :], -1, 0))
    padded = np.pad(away, 1, constant_values=np.inf)
    n, m = away.shape
    beside = [padded[i : i + n, j : j + m] for i in range(3) for j in range(3)]
    step = max(np.hypot(*np.diff(x, axis=0).T).max() for x in (p, q))
    return [(int(i), int(j)) for i, j in np.argwhere((away <= np.min(beside, axis=0)) & (away <= step))]


def _touch_beside(a: Piece, b: Piece, crossing: Crossing, tolerance: float) -> Crossing | None:
    """Returns the touch that a crossing belongs to, if the curves run so close from one to the other that
    they are one there.
    """
    t, s, _ = crossing
    (ax, ay), (bx, by) = derivative(a, t), derivative(b, s)
    if abs(ax * by - ay * bx) > 0.1 * math.hypot(ax, ay) * math.hypot(bx, by):
        return None
    touch = _touch(a, b, t, s, tolerance)
    if touch is None:
        return None
    way = math.remainder(touch[0] - t, 1.0) if is_closed(a) else touch[0] - t
    return touch if _on(b, point(a, t + way / 2), tolerance) else None


def _touch(a: Piece, b: Piece, t: float, s: float, tolerance: float) -> Crossing | None:
    """Returns the touch where the curves are parallel and within the tolerance, by Newton on (b - a)·a' = 0
    and a' x b' = 0.
    """
    for _ in range(30):
        t, s = _within(a, t), _within(b, s)
        (x, y), (u, v) = point(a, t), point(b, s)
        ex, ey = u - x, v - y
        (ax, ay), (bx, by) = derivative(a, t), derivative(b, s)
        (cx, cy), (dx, dy) = second_derivative(a, t), second_derivative(b, s)
        f, g = ex * ax + ey * ay, ax * by - ay * bx
        ft, fs = ex * cx + ey * cy - ax * ax - ay * ay, bx * ax + by * ay
        gt, gs = cx * by - cy * bx, ax * dy - ay * dx
        determinant = ft * gs - fs * gt
        if not determinant:
            break
        dt, ds = (fs * g - gs * f) / determinant, (gt * f - ft * g) / determinant
        t, s = t + max(-0.1, min(0.1, dt)), s + max(-0.1, min(0.1, ds))
        if abs(dt) + abs(ds) < 1e-14:
            break
    t, s = _within(a, t), _within(b, s)
    p, (ax, ay), (bx, by) = point(a, t), derivative(a, t), derivative(b, s)
    parallel = abs(ax * by - ay * bx) <= 1e-6 * math.hypot(ax, ay) * math.hypot(bx, by)
    return (t, s, p) if parallel and math.dist(p, point(b, s)) <= tolerance else None


def _newton(a: Piece, b: Piece, t: float, s: float, tolerance: float) -> Crossing | None:
    for _ in range(20):
        t, s = _within(a, t), _within(b, s)
        (x, y), (u, v) = point(a, t), point(b, s)
        ex, ey = u - x, v - y
        (ax, ay), (bx, by) = derivative(a, t), derivative(b, s)
        cross = ax * by - ay * bx
        if abs(cross) <= 1e-12 * math.hypot(ax, ay) * math.hypot(bx, by):
            break
        dt, ds = (ex * by - ey * bx) / cross, (ex * ay - ey * ax) / cross
        t, s = t + dt, s + ds
        if abs(dt) + abs(ds) < 1e-14:
            break
    t, s = _within(a, t), _within(b, s)
    p = point(a, t)
    return (t, s, p) if math.dist(p, point(b, s)) <= tolerance else None


def _within(curve: Piece, t: float) -> float:
    return t % 1.0 if is_closed(curve) else min(1.0, max(0.0, t))


def self_crossing(curve: Bezier) -> tuple[float, float] | None:
    """Returns the two parameters at which a cubic passes one point, if its loop is within 0..1.

    With p = a t³ + b t² + c t + d and u = s + t, v = s t, p(s) = p(t) gives a (u² - v) + b u + c = 0.
    """
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = curve.p0, curve.p1, curve.p2, curve.p3
    ax, ay = x3 - 3 * x2 + 3 * x1 - x0, y3 - 3 * y2 + 3 * y1 - y0
    bx, by = 3 * (x2 - 2 * x1 + x0), 3 * (y2 - 2 * y1 + y0)
    cx, cy = 3 * (x1 - x0), 3 * (y1 - y0)
    across = ax * by - ay * bx
    if abs(across) <= 1e-12 * (math.hypot(ax, ay) * math.hypot(bx, by) + 1e-300):
        return None
    u = -(ax * cy - ay * cx) / across
    v = u * u + ((ax * bx + ay * by) * u + ax * cx + ay * cy) / (ax * ax + ay * ay)
    root = u * u - 4 * v
    if root <= 1e-12:
        return None
    s, t = (u - math.sqrt(root)) / 2, (u + math.sqrt(root)) / 2
    return (s, t) if s > 1e-9 and t < 1 - 1e-9 else None


def sorted_cuts(cuts: list[tuple[float, int]]) -> list[tuple[float, int]]:
    """Returns cuts in order of their parameter, a node that follows itself kept once."""
    cuts = sorted(cuts)
    return cuts[:1] + [b for a, b in pairwise(cuts) if b[1] != a[1]]

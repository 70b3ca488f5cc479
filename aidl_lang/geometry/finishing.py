"""Corners rounded (fillet) or cut off (chamfer) after solving.

An arm is a curve seen from a corner where it ends: u = 0 at the corner, 1 at its other end. The arc of a
fillet is tangent to both arms, inside the angle between them: its centre lies on both arms moved sideways by
the radius. Lines and arcs meet there in closed form; with other curves the two parameters are found by
Newton's method, following the radius up from 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import field, replace

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Arc, Circle, Line, Piece, Vec, meeting, turn_between
from aidl_lang.geometry.intersect import circle_circle, line_circle
from aidl_lang.geometry.region import length

SMOOTH = 1e-7
"""Curves whose directions differ by less, in radians, run on smoothly: there is no corner."""
_EXACT = 1e-9
_STEPS = 16
_HALVINGS = 60


@record(slots=True)
class Arm:
    """A curve from the corner on; `number` is that of the curve, `first` whether it starts at the corner."""

    curve: Piece
    number: int
    first: bool

    @property
    def way(self) -> Vec:
        """The direction in which it leaves the corner, of length 1."""
        return self.curve.direction(0.0)


@record(slots=True)
class Corner:
    """A point where two curves end."""

    at: Vec
    arms: tuple[Arm, Arm]

    @property
    def turn(self) -> float:
        """The angle from the first arm to the second, in radians, positive counter-clockwise."""
        return turn_between(self.arms[0].way, self.arms[1].way)

    @property
    def is_smooth(self) -> bool:
        return math.pi - abs(self.turn) < SMOOTH

    @property
    def is_cusp(self) -> bool:
        return abs(self.turn) < SMOOTH


@record(slots=True)
class Work:
    """A corner to be finished; `sizes` are the radius, or the distances on the two arms."""

    kind: str
    corner: Corner
    sizes: tuple[float, float]


@record(slots=True)
class Finished:
    """The shares that the arms of a corner lose, and the curve that takes its place."""

    work: Work
    cuts: tuple[float, float]
    piece: Piece


@record(slots=True)
class TooLarge:
    """A finish that does not fit: there is room for `largest`, or it meets `other` on curve `number`."""

    work: Work
    largest: float
    other: Work | None = None
    number: int = -1


@record(frozen=False)
class Result:
    """Curves by their old numbers (None where nothing is left), and those that are new."""

    curves: list[Piece | None]
    finished: list[Finished] = field(default_factory=list)
    failures: list[TooLarge] = field(default_factory=list)


def arms_at(curves: Sequence[Piece], p: Vec, tolerance: float) -> list[Arm]:
    """Returns the arms of all curves that end at a point, first those that arrive there."""
    found = []
    for number, curve in enumerate(curves):
        if curve.is_closed:
            continue
        start, end = curve.ends
        if math.dist(start, p) <= tolerance:
            found.append(Arm(curve, number, first=True))
        if math.dist(end, p) <= tolerance:
            found.append(Arm(curve.reversed(), number, first=False))
    return sorted(found, key=lambda arm: arm.first)


def corners_of(curves: Sequence[Piece], tolerance: float) -> list[Corner]:
    """Returns all points where exactly two curves end, at an angle."""
    found: list[Corner] = []
    seen: list[Vec] = []
    for p in (p for c in curves if not c.is_closed for p in c.ends):
        if any(math.dist(p, q) <= tolerance for q in seen):
            continue
        seen.append(p)
        arms = arms_at(curves, p, tolerance)
        if len(arms) == 2 and not (corner := Corner(p, (arms[0], arms[1]))).is_smooth:
            found.append(corner)
    return found


def finish(curves: Sequence[Piece], works: Sequence[Work]) -> Result:
    """Returns every corner finished; those that do not fit are left sharp and told."""
    result = Result(list(curves))
    done: list[Finished] = []
    for work in works:
        made = solve(work)
        if made is None:
            # `largest` is done with the function when it returns.
            fits = largest(lambda size: solve(sized(work, size)) is not None, max(work.sizes))  # noqa: B023
            result.failures.append(TooLarge(work, fits))
        else:
            done.append(made)
    # By curve and end: the finish there, the share it takes, and the point where it touches.
    lost: dict[tuple[int, bool], tuple[Work, float, Vec]] = {}
    for made in done:
        for arm, cut, at in zip(made.work.corner.arms, made.cuts, made.piece.ends, strict=True):
            lost[arm.number, arm.first] = made.work, cut, at
    numbers = sorted({number for number, _ in lost})
    for number in numbers:
        a, b = lost.get((number, True)), lost.get((number, False))
        if a is not None and b is not None and a[1] + b[1] > 1 + _EXACT:
            result.failures.append(TooLarge(b[0], 0.0, a[0], number))
    if not result.failures:
        result.finished = done
        for number in numbers:
            start, end = (curve := curves[number]).ends
            _, t0, start = lost.get((number, True), (None, 0.0, start))
            _, rest, end = lost.get((number, False), (None, 0.0, end))
            t1 = 1 - rest
            result.curves[number] = curve.part(t0, t1, start, end) if t1 - t0 > _EXACT else None
    return result


def sized(work: Work, size: float) -> Work:
    """Returns the finish with its larger size changed, the other in proportion."""
    share = size / max(work.sizes)
    return Work(work.kind, work.corner, (work.sizes[0] * share, work.sizes[1] * share))


def largest(fits: Callable[[float], bool], too_large: float, halvings: int = _HALVINGS) -> float:
    """Returns the largest size below one that is too large, by halving."""
    low, high = 0.0, too_large
    for _ in range(halvings):
        middle = (low + high) / 2
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


# --- One corner ----------------------------------------------------------------------------------


def solve(work: Work) -> Finished | None:
    """Returns the finish of a corner by itself; None if an arm is too short for it."""
    corner, (a, b) = work.corner, (arm.curve for arm in work.corner.arms)
    if work.kind == "chamfer":
        u, v = (_along(curve, size) for curve, size in zip((a, b), work.sizes, strict=True))
        if u is None or v is None:
            return None
        return Finished(work, (u, v), Line(a.point(u), b.point(v)))
    touch = None if corner.is_cusp else _round(corner, work.sizes[0])
    if touch is None:
        return None
    u, v, center = touch
    p, q = a.point(u), b.point(v)
    # From the first arm to the second: with the second one to its left, the arc turns right.
    first, last = (math.atan2(e[1] - center[1], e[0] - center[0]) for e in (p, q))
    sweep = (last - first) % math.tau if corner.turn < 0 else -((first - last) % math.tau)
    return Finished(work, (u, v), Arc(center, work.sizes[0], p, q, sweep))


def _along(curve: Piece, distance: float) -> float | None:
    """Returns the parameter at a distance along a curve from its start; None beyond its end."""
    whole = length(curve)
    if distance > whole * (1 + _EXACT):
        return None
    if isinstance(curve, Line | Arc):
        return min(1.0, distance / whole)
    start = curve.ends[0]
    return largest(lambda t: length(curve.part(0.0, t, start, curve.point(t))) < distance, 1.0)


def _round(corner: Corner, radius: float) -> tuple[float, float, Vec] | None:
    """Returns the parameters at which a fillet touches both arms, and its centre; None if it does not fit."""
    a, b = corner.arms[0].curve, corner.arms[1].curve
    side = math.copysign(1.0, corner.turn)
    if not (isinstance(a, Line | Arc) and isinstance(b, Line | Arc)):
        return _round_by_newton(a, b, side, radius)
    carriers = _moved(a, side * radius), _moved(b, -side * radius)
    if carriers[0] is None or carriers[1] is None:
        return None
    best: tuple[float, float, Vec] | None = None
    for center in _meet(carriers[0], carriers[1]):
        u, v = _foot(a, center), _foot(b, center)
        if u is None or v is None or max(u, v) > 1 + _EXACT:
            continue
        u, v = min(u, 1.0), min(v, 1.0)
        if best is None or u * length(a) + v * length(b) < best[0] * length(a) + best[1] * length(b):
            best = u, v, center
    return best


def _moved(curve: Line | Arc, left: float) -> Line | Circle | None:
    """Returns the endless line or whole circle of all points at a distance to the left of a curve."""
    if isinstance(curve, Line):
        return Line(curve.parallel(0.0, left), curve.parallel(1.0, left))
    radius = curve.radius - math.copysign(left, left * curve.sweep)
    return Circle(curve.center, radius) if radius > 0 else None


def _meet(a: Line | Circle, b: Line | Circle) -> list[Vec]:
    if isinstance(a, Circle):
        slack = _EXACT * a.radius
        return line_circle(b, a, slack) if isinstance(b, Line) else circle_circle(a, b, slack)
    if isinstance(b, Circle):
        return line_circle(a, b, _EXACT * b.radius)
    return [at] if (at := meeting(a, b)) is not None else []


def _foot(curve: Line | Arc, p: Vec) -> float | None:
    """Returns the parameter of the point of an arm nearest to p; None before its start."""
    if isinstance(curve, Line):
        dx, dy = curve.derivative(0.0)
        t = ((p[0] - curve.start[0]) * dx + (p[1] - curve.start[1]) * dy) / (dx * dx + dy * dy)
        return t if t >= 0 else None
    turn = math.atan2(p[1] - curve.center[1], p[0] - curve.center[0]) - curve.start_angle
    return float((turn % math.copysign(math.tau, curve.sweep)) / curve.sweep)


def _round_by_newton(a: Piece, b: Piece, side: float, radius: float) -> tuple[float, float, Vec] | None:
    """Follows the touching points from the corner as the radius grows; None once one leaves its arm."""

    def gap(u: float, v: float, r: float) -> Vec:
        p, q = a.parallel(u, side * r), b.parallel(v, -side * r)
        return p[0] - q[0], p[1] - q[1]

    u = v = 0.0
    for step in range(1, _STEPS + 1):
        r = radius * step / _STEPS
        for _ in range(30):
            x, y = gap(u, v, r)
            h = 1e-6
            ux, uy = ((p - q) / (2 * h) for p, q in zip(gap(u + h, v, r), gap(u - h, v, r), strict=True))
            vx, vy = ((p - q) / (2 * h) for p, q in zip(gap(u, v + h, r), gap(u, v - h, r), strict=True))
            across = ux * vy - uy * vx
            if across == 0:
                return None
            du, dv = (x * vy - y * vx) / across, (ux * y - uy * x) / across
            u, v = u - du, v - dv
            if abs(du) + abs(dv) < 1e-14:
                break
        if not (math.hypot(*gap(u, v, r)) < _EXACT * max(1.0, radius) and min(u, v) >= 0 and max(u, v) <= 1):
            return None
    return u, v, a.parallel(u, side * radius)


# --- Fillets and chamfers as large as fits: the sizes that `max` stands for.

_DOUBLINGS = 40
_SAME = 1e-8
_NOTHING = 1e-6
_MORE = 1e-6
"""A size that may not grow by this share does not grow."""


def fitted(curves: Sequence[Piece], works: Sequence[Work], runs: Sequence[int], extent: float) -> list[Work]:
    """Returns works with sizes: all of a run have the largest that fits, 0 if none does; those of run 0 have
    one already. Runs grow together, and each until one of its corners has no more room.
    """
    sizes: dict[int, float] = {}

    def sized_by(sizes: Mapping[int, float]) -> list[Work]:
        pairs = zip(works, runs, strict=True)
        return [replace(work, sizes=(sizes[run], sizes[run])) if run else work for work, run in pairs]

    def fit(tried: Mapping[int, float], asked: Collection[int]) -> bool:
        """Tells whether nothing of the runs that are asked for fails or runs into another."""
        checkpoint()
        pairs = zip(sized_by({**sizes, **tried}), runs, strict=True)
        sized = [(work, run) for work, run in pairs if work.sizes[0] > 0]
        own = {id(work) for work, run in sized if run in asked}
        failures = finish(curves, [work for work, _ in sized]).failures
        return not any(id(f.work) in own or id(f.other) in own for f in failures)

    while growing := sorted({run for run in runs if run and run not in sizes}):
        size = _largest(lambda size: fit(dict.fromkeys(growing, size), growing), extent)
        level = dict.fromkeys(growing, size)
        larger = max(size * (1 + _MORE), 2 * _NOTHING * extent)
        stuck = [run for run in growing if not fit(level | {run: larger}, [run])]
        sizes |= dict.fromkeys(stuck or growing, size)
    return sized_by(sizes)


def _largest(fits: Callable[[float], bool], extent: float) -> float:
    """Returns the largest size that fits, by doubling and halving: a short number if it is one."""
    high = extent
    for _ in range(_DOUBLINGS):
        if not fits(high):
            break
        high *= 2
    found = largest(fits, high)
    if found <= _NOTHING * extent:
        return 0.0
    short = float(f"{found:.6g}")
    return short if abs(short - found) <= _SAME * found and fits(short) else found

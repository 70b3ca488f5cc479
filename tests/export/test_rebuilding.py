"""Parts are made again from their drawing sheets: from what is seen of the outline and from the dimensions.

Who reads a sheet sees how an outline goes on (edges along the axes, smooth joints, right corners, what
stands on one level, axes of symmetry) and knows the numbers. Both are equations; solved from a sketch drawn
by a shaky hand they must give the part, and none of the numbers may be left out. Nothing here is shared
with what chooses the dimensions.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
import pytest

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld
from aidl_lang.export.drafting.contents import View, contents
from aidl_lang.geometry.curves import Arc, Circle, Line, Piece, Vec
from aidl_lang.geometry.drawing import Body
from aidl_lang.geometry.solved import Dimension, Length, Opening, Roundness
from tests.documents import ROOT

Equation = tuple[tuple[int, ...], Callable[[Sequence[complex]], complex]]
Pair = tuple[int, int]

SHAKE = 0.0005
"""How far the hand is off, relative to the part."""
EXACT = 1e-6


class Part:
    """A part as it is seen on a sheet: numbers without values, and the equations that anybody sees."""

    def __init__(
        self, body: Body, circles: Sequence[Circle], filed: set[Vec], *, has_more: bool, is_whole: bool
    ) -> None:
        self.size = max(body.box[2] - body.box[0], body.box[3] - body.box[1])
        self.near = 1e-6 * self.size
        self.truth: list[float] = []
        self.points: list[tuple[Pair, Vec]] = []
        self.centers: list[tuple[Pair, Vec]] = []
        """those that have lines"""
        self.rounds: list[tuple[Pair, int, Circle | Arc]] = []
        self.edges: list[tuple[Pair, Pair, Line]] = []
        self.levels: tuple[list[int], list[int]] = ([], [])
        self.seen: list[Equation] = []
        self.is_partial = False
        self.filed: list[Piece] = []
        for loop in body.region.loops:
            pieces = list(loop.pieces)
            if any(not isinstance(p, Line | Arc | Circle) or middle(p) in filed for p in pieces) or (
                is_whole and len(body.region.pieces) > 60
            ):
                self.is_partial = True
                self.filed += pieces
            elif isinstance(pieces[0], Circle):
                self.round(pieces[0], True)
            else:
                self.outline(joined(pieces))
        for circle in circles:
            self.round(circle, True)
        self.has_more = has_more or self.is_partial
        """something is drawn that is as in the file"""
        self.known: set[int] = set()
        for side, end in enumerate(body.box):
            if any(abs(box[side] - end) <= self.near for box in (piece.box for piece in self.filed)):
                self.known.add(self.number(end))
                self.levels[side % 2].insert(0, len(self.truth) - 1)
        self.box = body.box
        self.aligned()
        for axis in (0, 1):
            self.mirrored(body, axis)

    def number(self, value: float) -> int:
        self.truth.append(value)
        return len(self.truth) - 1

    def pair(self, at: Vec) -> Pair:
        return self.number(at[0]), self.number(at[1])

    def say(self, needs: Sequence[int], of: Callable[[Sequence[complex]], complex]) -> None:
        self.seen.append((tuple(needs), of))

    def held(self) -> list[Equation]:
        """Where the part lies on the table nobody tells; an outline that is as in the file lies there."""
        first = {next((i for i in own if i in self.known), own[0]) for own in self.levels if own}
        return [((i,), lambda z, i=i: z[i] - self.truth[i]) for i in self.known | first]

    def placed(self, circle: Circle, at: Vec, datum: Vec) -> list[Equation]:
        """The place of a hole of a table, from where the axes of the table begin."""
        center, size, _ = next(r for r in self.rounds if r[2] == circle)
        found: list[Equation] = [((size,), lambda z: z[size] - circle.radius)]
        for axis in (0, 1):
            low = next(i for i in self.levels[axis] if abs(self.truth[i] - datum[axis]) <= self.near)
            one = self.apart(
                ((low, low), None, 0.0), (center, None, 0.0), (1.0 - axis, float(axis)), at[axis]
            )
            assert one is not None
            found.append(one)
        return found

    def is_of_file(self, of: Dimension, own: Sequence[Equation]) -> bool:
        """Tells whether a dimension measures an outline that is as in the file: how large to make it."""
        return self.is_partial and (
            of.origin == "overall" or all(set(needs) <= self.known for needs, _ in own)
        )

    def same(self, i: int, j: int) -> None:
        self.say((i, j), lambda z: z[i] - z[j])

    # --- What is seen ------------------------------------------------------------------------------

    def round(self, curve: Circle | Arc, is_seen: bool) -> tuple[Pair, int]:
        center, radius = self.pair(curve.center), self.number(curve.radius)
        for other, size, known in self.rounds:  # of one circle
            if (
                math.dist(known.center, curve.center) <= self.near
                and abs(known.radius - curve.radius) <= self.near
            ):
                self.same(center[0], other[0])
                self.same(center[1], other[1])
                self.same(radius, size)
                break
        self.rounds.append((center, radius, curve))
        self.points.append((center, curve.center))
        if is_seen:
            self.centers.append((center, curve.center))
            for axis in (0, 1):
                self.levels[axis].append(center[axis])
        return center, radius

    def outline(self, pieces: list[Piece]) -> None:
        count = len(pieces)
        corners = [self.pair(p.ends[0]) for p in pieces]
        self.points += [(pair, p.ends[0]) for pair, p in zip(corners, pieces, strict=True)]
        arcs: dict[int, tuple[Pair, int]] = {}
        for k, p in enumerate(pieces):
            if isinstance(p, Arc):
                arcs[k] = self.round(p, abs(p.sweep) >= math.pi - 1e-6)
                for pair in (corners[k], corners[(k + 1) % count]):
                    self.say((*pair, *arcs[k][0], arcs[k][1]), on_circle(pair, *arcs[k]))
            else:
                assert isinstance(p, Line)
                self.edge(corners[k], corners[(k + 1) % count], p)
        for k in range(count):
            self.joint(pieces, corners, arcs, k)
        for k in arcs:
            self.rounded(pieces, corners, k)

    def joint(
        self, pieces: list[Piece], corners: list[Pair], arcs: dict[int, tuple[Pair, int]], k: int
    ) -> None:
        """What is seen where a piece begins."""
        count = len(pieces)
        before, after = pieces[k - 1], pieces[k]
        pair, far = corners[k], (corners[k - 1], corners[(k + 1) % count])
        if not smooth(before, after):
            for axis in (0, 1):
                self.levels[axis].append(pair[axis])
            if is_right(before, after):
                self.turned(far[0], pair, pair, far[1], dot)
            return
        own = [arcs[n % count][0] for n in (k - 1, k) if n % count in arcs]
        if len(own) == 2:
            self.turned(pair, own[0], pair, own[1], cross)
        else:
            self.turned(pair, own[0], pair, far[0] if isinstance(before, Line) else far[1], dot)

    def rounded(self, pieces: list[Piece], corners: list[Pair], k: int) -> None:
        """What is seen of a rounded corner or a round end."""
        count, arc = len(pieces), pieces[k]
        before, after = pieces[k - 1], pieces[(k + 1) % count]
        if not (isinstance(before, Line) and isinstance(after, Line) and isinstance(arc, Arc)):
            return
        if not (smooth(before, arc) and smooth(arc, after)):
            return
        a, b, c, d = (corners[(k + n) % count] for n in (-1, 0, 1, 2))
        if is_right(before, after):
            self.turned(a, b, c, d, dot)
        elif abs(abs(arc.sweep) - math.pi) < 1e-6:
            self.turned(a, b, c, d, cross)
        if (at := crossing_of(before, after)) is not None:
            self.corner(a, b, c, d, at)

    def edge(self, start: Pair, end: Pair, line: Line) -> None:
        self.edges.append((start, end, line))
        for axis in (0, 1):
            if abs(line.start[axis] - line.end[axis]) <= self.near:
                self.same(start[axis], end[axis])
                self.levels[axis].append(start[axis])

    def corner(self, a: Pair, b: Pair, c: Pair, d: Pair, at: Vec) -> None:
        """The corner that two edges had before it was rounded."""
        pair = self.pair(at)
        self.turned(a, b, b, pair, cross)
        self.turned(c, d, c, pair, cross)
        self.points.append((pair, at))

    def turned(self, a: Pair, b: Pair, c: Pair, d: Pair, of: Callable[..., complex]) -> None:
        self.say((*a, *b, *c, *d), lambda z: of(way(a, b, z), way(c, d, z)) / self.size)

    def aligned(self) -> None:
        for numbers in self.levels:
            ordered = sorted(numbers, key=lambda n: self.truth[n])
            for i, j in pairwise(ordered):
                if abs(self.truth[i] - self.truth[j]) <= self.near and i != j:
                    self.same(i, j)

    def mirrored(self, body: Body, axis: int) -> None:
        """What is drawn on both sides of an axis of the whole part is alike."""
        twice = body.box[axis] + body.box[axis + 2]

        def flip(p: Vec) -> Vec:
            return (twice - p[0], p[1]) if axis == 0 else (p[0], twice - p[1])

        spots = {key for p in body.region.pieces for key in keys(p, lambda q: q, self.near)}
        if any(key not in spots for p in body.region.pieces for key in keys(p, flip, self.near)):
            return
        axle = self.number(twice / 2)
        if self.is_partial:
            self.say((axle,), lambda z: z[axle] - twice / 2)
        for i in self.levels[axis]:
            if abs(self.truth[i] - twice / 2) <= self.near:
                self.same(i, axle)
        for (a, p), (b, q) in combinations(self.points, 2):
            if math.dist(flip(p), q) <= 2 * self.near:
                self.say((a[axis], b[axis], axle), lambda z, i=a[axis], j=b[axis]: z[i] + z[j] - 2 * z[axle])
                self.same(a[1 - axis], b[1 - axis])
        for (_, r, c), (_, s, d) in combinations(self.rounds, 2):
            if math.dist(flip(c.center), d.center) <= 2 * self.near and abs(c.radius - d.radius) <= self.near:
                self.same(r, s)

    # --- What is said ------------------------------------------------------------------------------

    def said(self, of: Dimension) -> list[Equation]:
        """Returns the equations of a dimension; none if it is about an outline that is as in the file."""
        match of:
            case Length(along=along, value=value):
                for a in self.spots(of.start, along):
                    for b in self.spots(of.end, along):
                        if (one := self.apart(a, b, along, value)) is not None:
                            return [one]
                for spots, others in ((of.start, of.end), (of.end, of.start)):
                    for end in self.spots(spots, along):
                        for a, b, line in self.edges:
                            if (
                                on_line(others[0], line, self.near)
                                and abs(dot(span(line), along)) <= 1e-6 * self.size
                            ):
                                return [from_edge(end, a, b, value)]
                return []
            case Roundness(origin="pattern", curve=ring):
                return self.ring(ring, of.value / 2)
            case Roundness(curve=curve, value=value):
                radius = value / 2 if isinstance(curve, Circle) else value
                return [
                    ((r,), lambda z, r=r: z[r] - radius)
                    for _, r, c in self.rounds
                    if math.dist(c.center, curve.center) <= self.near
                    and abs(c.radius - curve.radius) <= self.near
                ]
            case Opening(corner=corner, first=first, value=value):
                return self.angle(corner, first, value)
        raise TypeError(of)

    def spots(self, points: Sequence[Vec], along: Vec) -> Iterator[tuple[Pair, int | None, float]]:
        """The numbers at points: of a corner or a centre, of a tip of what is round, of a level."""
        for p in points:
            yield from ((pair, None, 0.0) for pair, at in self.points if math.dist(p, at) <= self.near)
            yield from self.tips(lambda tip, p=p: math.dist(p, tip) <= self.near, along)
        if along in ((1.0, 0.0), (0.0, 1.0)):
            axis, value = int(along[1]), points[0][int(along[1])]
            for i in self.levels[axis]:
                if abs(self.truth[i] - value) <= self.near:
                    yield (i, i), None, 0.0
            yield from self.tips(lambda tip: abs(tip[axis] - value) <= self.near, along)

    def tips(self, is_there: Callable[[Vec], bool], along: Vec) -> Iterator[tuple[Pair, int | None, float]]:
        for pair, r, c in self.rounds:
            for side in (-1.0, 1.0):
                if is_there(
                    (c.center[0] + side * c.radius * along[0], c.center[1] + side * c.radius * along[1])
                ):
                    yield pair, r, side

    def apart(self, a, b, along: Vec, value: float) -> Equation | None:
        (p, r, s), (q, t, u) = a, b
        needs = [*p, *q, *(n for n in (r, t) if n is not None)]
        if along in ((1.0, 0.0), (0.0, 1.0)):
            k = int(along[1])
            return tuple(needs), lambda z: z[q[k]] + tip(z, t, u) - z[p[k]] - tip(z, r, s) - value
        flat = self.truth[q[0]] - self.truth[p[0]], self.truth[q[1]] - self.truth[p[1]]
        if abs(cross(flat, along)) > self.near:
            return None
        sense = math.copysign(1.0, dot(flat, along)) if math.hypot(*flat) > self.near else 0.0

        def of(z):
            v = way(p, q, z)
            return (sense * dot(v, v) ** 0.5 if sense else 0) + tip(z, t, u) - tip(z, r, s) - value

        return tuple(needs), of

    def ring(self, ring: Circle | Arc, radius: float) -> list[Equation]:
        middle_ = next((p for p, at in self.centers if math.dist(at, ring.center) <= self.near), None)
        assert middle_ is not None, "a circle of holes about nothing"
        found: list[Equation] = []
        for pair, _, c in self.rounds:
            if isinstance(c, Circle) and abs(math.dist(c.center, ring.center) - radius) <= self.near:
                turn = math.atan2(c.center[1] - ring.center[1], c.center[0] - ring.center[0])
                for k, off in enumerate((radius * math.cos(turn), radius * math.sin(turn))):
                    i, j = pair[k], middle_[k]
                    found.append(((i, j), lambda z, i=i, j=j, off=off: z[i] - z[j] - off))
        return found

    def angle(self, corner: Vec, first: float, value: float) -> list[Equation]:
        arms = []
        for degrees in (first, first + value):
            u = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
            arms.append(
                next(
                    (
                        (a, b, math.copysign(1.0, dot(span(line), u)))
                        for a, b, line in self.edges
                        if on_line(corner, line, self.near) and abs(cross(span(line), u)) <= 1e-6 * self.size
                    ),
                    None,
                )
            )
        one, other = arms
        if other is None or (one is None and abs(math.remainder(first, 90)) > 1e-6):
            return []
        flat = math.cos(math.radians(first)), math.sin(math.radians(first))
        turn = math.radians(value)
        needs = [*other[0], *other[1], *((*one[0], *one[1]) if one is not None else ())]

        def of(z):
            u = way(one[0], one[1], z) if one is not None else flat
            v = way(other[0], other[1], z)
            sense = other[2] * (one[2] if one is not None else 1.0)
            long = (dot(u, u) * dot(v, v)) ** 0.5
            return sense * (cross(u, v) * math.cos(turn) - dot(u, v) * math.sin(turn)) / long * self.size

        return [(tuple(needs), of)]


def tip(z, radius: int | None, side: float):
    return 0.0 if radius is None else side * z[radius]


def from_edge(end, a: Pair, b: Pair, value: float) -> Equation:
    pair, r, _ = end
    needs = (*pair, *a, *b, *(() if r is None else (r,)))

    def of(z):
        u = way(a, b, z)
        away = cross(u, way(a, pair, z)) / dot(u, u) ** 0.5
        return (away if away.real > 0 else -away) + (0.0 if r is None else z[r]) - value

    return needs, of


def on_circle(pair: Pair, center: Pair, radius: int):
    def of(z):
        u = way(center, pair, z)
        return dot(u, u) ** 0.5 - z[radius]

    return of


def way(a: Pair, b: Pair, z):
    return z[b[0]] - z[a[0]], z[b[1]] - z[a[1]]


def dot(u, v):
    return u[0] * v[0] + u[1] * v[1]


def cross(u, v):
    return u[0] * v[1] - u[1] * v[0]


def span(line: Line) -> Vec:
    return line.end[0] - line.start[0], line.end[1] - line.start[1]


def on_line(p: Vec, line: Line, near: float) -> bool:
    u = span(line)
    return abs(cross(u, (p[0] - line.start[0], p[1] - line.start[1]))) <= near * math.hypot(*u)


def middle(piece: Piece) -> Vec:
    x, y = piece.point(0.5)
    return round(x, 6), round(y, 6)


def smooth(a: Piece, b: Piece) -> bool:
    u, v = a.derivative(1.0), b.derivative(0.0)
    return abs(cross(u, v)) <= 1e-6 * math.hypot(*u) * math.hypot(*v) and dot(u, v) > 0


def is_right(a: Piece, b: Piece) -> bool:
    if not (isinstance(a, Line) and isinstance(b, Line)):
        return False
    return abs(dot(span(a), span(b))) <= 1e-6 * math.hypot(*span(a)) * math.hypot(*span(b))


def crossing_of(a: Line, b: Line) -> Vec | None:
    u, v = span(a), span(b)
    if abs(cross(u, v)) <= 1e-9 * math.hypot(*u) * math.hypot(*v):
        return None
    t = cross((b.start[0] - a.start[0], b.start[1] - a.start[1]), v) / cross(u, v)
    return a.start[0] + t * u[0], a.start[1] + t * u[1]


def is_one_circle(a: Arc, b: Arc) -> bool:
    return math.dist(a.center, b.center) + abs(a.radius - b.radius) < 1e-9 * a.radius


def joined(pieces: list[Piece]) -> list[Piece]:
    """The pieces with edges and arcs that go straight on as one."""
    k = 0
    while k < len(pieces) and len(pieces) > 1:
        a, b = pieces[k], pieces[(k + 1) % len(pieces)]
        one: Piece | None = None
        if isinstance(a, Line) and isinstance(b, Line) and smooth(a, b):
            one = Line(a.start, b.end)
        elif isinstance(a, Arc) and isinstance(b, Arc) and smooth(a, b) and is_one_circle(a, b):
            one = Arc(a.center, a.radius, a.start, b.end, a.sweep + b.sweep)
        if one is None:
            k += 1
        else:
            pieces = [one, *pieces[1:k]] if k == len(pieces) - 1 else [*pieces[:k], one, *pieces[k + 2 :]]
    return pieces


def keys(piece: Piece, flip: Callable[[Vec], Vec], near: float) -> Iterator[object]:
    """What tells a piece from others, in either direction, whatever rounding did."""
    spots = [piece.center] if isinstance(piece, Circle) else [piece.point(t) for t in (0, 0.5, 1)]
    flat = sorted(tuple(round(n / (200 * near)) for n in flip(p)) for p in spots)
    yield type(piece).__name__, tuple(flat), round(piece.box[2] - piece.box[0], 3)


# --- Solving ---------------------------------------------------------------------------------------


def matrix(equations: Sequence[Equation], z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    rows, off = np.zeros((len(equations), len(z))), np.zeros(len(equations))
    at = [complex(v) for v in z]
    for k, (needs, of) in enumerate(equations):
        off[k] = complex(of(at)).real
        for n in set(needs):
            known, at[n] = at[n], at[n] + 1e-30j
            rows[k, n] = complex(of(at)).imag / 1e-30
            at[n] = known
    return rows, off


def rank(rows: np.ndarray) -> int:
    size = np.linalg.norm(rows, axis=1)
    rows = rows[size > 0] / size[size > 0, None]
    return int(np.linalg.matrix_rank(rows, tol=1e-5)) if len(rows) else 0


def solved(equations: Sequence[Equation], start: np.ndarray) -> np.ndarray:
    z = start
    for _ in range(60):
        rows, off = matrix(equations, z)
        step = np.linalg.lstsq(rows, -off, rcond=1e-9)[0]
        z = z + step
        if np.abs(step).max() < 1e-12 * max(1.0, np.abs(z).max()):
            break
    return z


def rebuilt(part: Part, view: View) -> tuple[float, list[str]]:
    """How far the part that was made from a sheet is off, and the dimensions that it did not need."""
    said = [(group, [e for of in group for e in part.said(of)]) for group in view.wanted]
    table = [e for hole in view.holes for e in part.placed(hole.circle, (hole.x, hole.y), view.datum)]
    # The sizes of an outline that is as in the file tell how large to make it, and where it ends.
    of_file = [e for group, own in said if part.is_of_file(group[0], own) for e in own]
    needed = [
        e
        for group, own in said
        for e in own
        if not group[0].is_auxiliary and not part.is_of_file(group[0], own)
    ]
    equations = [*part.seen, *part.held(), *table, *needed]
    truth = np.array(part.truth)
    shake = np.random.default_rng(len(truth)).uniform(-1, 1, len(truth))
    found = solved([*equations, *of_file], truth + SHAKE * part.size * shake)
    off = float(np.abs(found - truth).max(initial=0.0)) / part.size
    rows = matrix(equations, truth)[0]
    whole = rank(rows)
    idle = []
    for group, own in said:
        words = f"{group[0].kind} {group[0].value:g} ({group[0].origin})"
        if not own and not part.has_more:
            idle.append(f"{words}: about nothing that is seen")
        elif own and not part.is_of_file(group[0], own) and not group[0].is_auxiliary:
            kept = [k for k, e in enumerate(equations) if not any(e is other for other in own)]
            if rank(rows[kept]) == whole:
                idle.append(words)
    return off, idle


@cache
def sheets(path: Path | None, text: str) -> list[tuple[str, Part, View]]:
    found = pipeline.compile(SourceFile(str(path), text), DiskWorld(path.parent if path else ROOT))
    assert found.model is not None
    assert found.drawing is not None
    filed = {
        middle(curve)
        for g in found.model.root.walk_geometry()
        if g.type in ("glyphs", "traced")
        for curve in g.curves()
    }
    parts = []
    for content in contents(found.model, found.drawing):
        for view in content.views if not content.items else ():
            strokes = [s.pieces for s in view.drawing.strokes]
            circles = [p[0] for p in strokes if len(p) == 1 and isinstance(p[0], Circle)]
            for body in view.drawing.bodies:
                # A part of very many levels is as in the file altogether, and its sheet says so.
                clear = not any(not isinstance(p, Line | Arc | Circle) for p in body.region.pieces)
                is_whole = clear and body.path in view.free
                part = Part(body, circles, filed, has_more=len(circles) < len(strokes), is_whole=is_whole)
                parts.append((content.subject.path, part, view))
    return parts


def check(path: Path | None, text: str) -> None:
    wrong = []
    for name, part, view in sheets(path, text):
        off, idle = rebuilt(part, view)
        if off > EXACT:
            wrong.append(f"{name}: made from its sheet it is off by {off:.3g} of its size")
        wrong += [f"{name}: {words} tells nothing more" for words in idle]
    assert not wrong, "\n".join(wrong)


QUICK = {"fence_bracket", "flange", "key_rack", "linkage", "pi_case"}
FILES = [
    pytest.param(path, id=path.stem, marks=[] if path.stem in QUICK else [pytest.mark.slow])
    for path in sorted((ROOT / "examples").rglob("*.aidl"))
]


@pytest.mark.parametrize("path", FILES)
def test_parts_are_made_again_from_their_sheets(path: Path):
    check(path, path.read_text("utf-8"))


@pytest.mark.parametrize(
    "body",
    [
        "b = rectangle(width: 100, height: 60) hole a { c = circle(center: (0, -12), diameter: 6) }"
        " hole d { c = circle(center: (30, 10), diameter: 8) }",
        "b = circle(radius: 40) hole a { c = circle(center: (10, 12), radius: 4) }",
        "b = rounded_rectangle(width: 90, height: 50, radius: 5)"
        " hole w { s = slot(center: (-5, 8), length: 30, width: 8, angle: 20deg) }",
        "b = polygon([(0, 0), (60, 0), (75, 25), (40, 50), (0, 30)]) fillet(b.corners, 4)",
        "b = polygon([(0, 0), (60, 0), (75, 25), (40, 50), (0, 30)])"
        " hole h { r = rectangle(center: (30, 18), width: 20, height: 10, angle: 30deg) }",
        "b = circle(radius: 30) flat = rectangle(left: 20, right: 45, bottom: -10, top: 10)",
        "b = intersect(circle(radius: 30), rectangle(width: 80, height: 40))",
        "for i in 0..11 { hole h[i] { c = circle(center: fixed((9 * i, (7 * i * i) % 31)), radius: 2) } }"
        " b = rectangle(left: -10, right: 120, bottom: -10, top: 50)",
        "b = rectangle(width: 80, height: 50) dimension(b.left, b.right) dimension(b.left, h.c.center)"
        " dimension(h.c.center, b.right) hole h { c = circle(center: (7, 5), radius: 4) }",
    ],
)
def test_small_parts_are_made_again(body: str):
    check(None, f"solid s {{ {body} }}")


def test_a_sheet_without_one_of_its_dimensions_is_not_enough():
    """The rebuilding itself tells what is missing."""
    ((_, part, view),) = sheets(None, "solid s { b = rectangle(width: 80, height: 50) }")
    assert rebuilt(part, view)[0] <= EXACT
    assert rebuilt(part, replace(view, wanted=view.wanted[:-1]))[0] > EXACT
    assert rebuilt(part, replace(view, wanted=view.wanted * 2))[1]

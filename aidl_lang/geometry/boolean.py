"""Questions about finished regions: booleans, distances, contacts, and curves cut to their inside."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import field
from functools import lru_cache
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Literal

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.common.running import Later, checkpoint
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Floats, Line, Piece, Vec, larger_side, union_bounds
from aidl_lang.geometry.intersect import Crossing, Table, all_intersections, inside, near_rows
from aidl_lang.geometry.network import CHORD, RELATIVE_TOLERANCE, Hulls, Network
from aidl_lang.geometry.region import Face, Loop, Region
from aidl_lang.geometry.sections import Section, closed_loop, faces_of, outlined, overlaid, union

if TYPE_CHECKING:
    from aidl_lang.common.font_files import Curve

# --- Least distances between outlines, exact for lines, arcs and circles.

_SAMPLES = np.linspace(0, 1, 49)
Closest = tuple[float, Vec, Vec]
"""A distance and the points on either side where it is found."""


def region_distance(a: Region, b: Region) -> Closest | None:
    """Returns the distance between the outlines of two regions that do not overlap; None if one is empty."""
    if not (a and b):
        return None
    away = _apart(a.boxes, b.boxes).ravel()
    # Pairs of pieces, those first whose boxes are nearest; few are nearer than the first two pieces.
    first = int(np.argmin(away))
    best = _between(a, b, first)
    near = np.flatnonzero(away < best[0])
    for k in near[np.argsort(away[near], kind="stable")].tolist():
        if away[k] >= best[0]:
            break
        checkpoint()
        if k != first and (found := _between(a, b, k))[0] < best[0]:
            best = found
    return best


def lie_within(a: Region, b: Region, reach: float) -> bool:
    """Tells whether the outlines of two regions that do not overlap come as close to each other as that."""
    away = _apart(a.boxes, b.boxes).ravel()
    near = np.flatnonzero(away <= reach)
    return any(_between(a, b, k)[0] <= reach for k in near[np.argsort(away[near], kind="stable")].tolist())


def nearest_region(ours: Sequence[Region], others: Sequence[Region]) -> tuple[float, int]:
    """Returns the least distance of outlines on either side, and the place of the other one's region."""
    best = math.inf, 0
    away = _apart(*(np.array([region.box for region in side]) for side in (ours, others)))
    for pair in np.argsort(away, axis=None, kind="stable").tolist():
        i, j = divmod(pair, len(others))
        if away[i, j] >= best[0]:
            break
        if (found := region_distance(ours[i], others[j])) is not None and found[0] < best[0]:
            best = found[0], j
    return best


def _apart(a: Floats, b: Floats) -> Floats:
    """Returns the distance of each box of a table from each of another."""
    gaps = np.maximum(np.maximum(a[:, None, :2] - b[:, 2:], b[:, :2] - a[:, None, 2:]), 0.0)
    return np.hypot(gaps[..., 0], gaps[..., 1])


def _between(a: Region, b: Region, pair: int) -> Closest:
    i, j = divmod(pair, len(b.pieces))
    return piece_distance(a.pieces[i], b.pieces[j])


def piece_distance(a: Piece, b: Piece) -> Closest:
    """Returns the least distance between two curves that do not cross."""
    candidates = [_to(b, p) for p in _candidates(a, b)]
    candidates += [(d, q, p) for d, p, q in (_to(a, p) for p in _candidates(b, a))]
    return min(candidates, key=lambda c: c[0])


def _to(curve: Piece, p: Vec) -> Closest:
    q = curve.point(curve.nearest(p))
    return math.dist(p, q), p, q


def _candidates(a: Piece, b: Piece) -> list[Vec]:
    """Returns points of `a` nearest to `b` if any are: its ends, and those where the normals agree."""
    if not isinstance(a, Line | Arc | Circle) or not isinstance(b, Line | Arc | Circle):
        return _sampled_candidates(a, b)
    spots = [] if a.is_closed else list(a.ends)
    if isinstance(b, Line):
        return spots
    if isinstance(a, Line):
        return [*spots, a.point(a.nearest(b.center))]
    dx, dy = b.center[0] - a.center[0], b.center[1] - a.center[1]
    d = math.hypot(dx, dy)
    ux, uy = (dx / d, dy / d) if d else (1.0, 0.0)
    for sign in (-1, 1):
        p = a.center[0] + sign * a.radius * ux, a.center[1] + sign * a.radius * uy
        spots.append(a.point(a.nearest(p)))
    return spots


def _sampled_candidates(a: Piece, b: Piece) -> list[Vec]:
    """Returns the ends of a, and the nearest of a sampling, polished."""
    away = ((a.points(_SAMPLES)[:, None, :] - b.points(_SAMPLES)[None, :, :]) ** 2).sum(axis=2)
    i, j = divmod(int(np.argmin(away)), len(_SAMPLES))
    t = _facing(a, b, float(_SAMPLES[i]), float(_SAMPLES[j]))
    if t is not None:
        return [*a.ends, a.point(t)]
    if {i, j} & {0, len(_SAMPLES) - 1} and not a.is_closed and not b.is_closed:
        return list(a.ends)  # an end is nearest, of one or of the other
    p = a.point(float(_SAMPLES[i]))
    for _ in range(50):  # by projecting to and fro
        before, p = p, a.point(a.nearest(b.point(b.nearest(p))))
        if p == before:
            break
    return [*a.ends, p]


def _facing(a: Piece, b: Piece, t: float, s: float) -> float | None:
    """Returns the parameter on `a` at which the way to `b` is at right angles to both, by Newton on e·a' = 0
    and e·b' = 0 with e = b - a from parameters nearby. None if that leads off the curves, or to no minimum.
    """
    for _ in range(30):
        (x, y), (u, v) = a.point(t), b.point(s)
        (ax, ay), (bx, by) = a.derivative(t), b.derivative(s)
        (cx, cy), (dx, dy) = a.second_derivative(t), b.second_derivative(s)
        ex, ey = u - x, v - y
        f, g = -(ex * ax + ey * ay), ex * bx + ey * by
        ftt = ax * ax + ay * ay - ex * cx - ey * cy
        fss = bx * bx + by * by + ex * dx + ey * dy
        fts = -(ax * bx + ay * by)
        determinant = ftt * fss - fts * fts
        if not (ftt > 0 and determinant > 0):
            return None
        dt, ds = (fts * g - fss * f) / determinant, (fts * f - ftt * g) / determinant
        t, s = t + dt, s + ds
        if not (0 <= t <= 1 and 0 <= s <= 1):
            return None
        if abs(dt) + abs(ds) < 1e-14:
            return t
    return None


# --- Booleans on finished regions, for those who ask about true outlines: `overlaps`, `clearance`.


def united(*regions: Region) -> Region:
    """Returns the union of regions."""
    return combined(regions, lambda *sections: [union(sections)])[0]


def without(a: Region, *others: Region) -> Region:
    """Returns the region `a` without the others."""
    return combined((a, *others), lambda base, *sections: [base - union(sections)])[0]


def common(a: Region, *others: Region) -> Region:
    """Returns what of other regions lies in the region `a`."""
    return combined((a, *others), lambda base, *sections: [base & union(sections)])[0]


def clearance(a: Region, b: Region) -> float:
    """Returns the least distance of two regions, mm; 0 where they meet, infinite if one is empty."""
    if len(near_rows([a.box, b.box], 0.0)) and common(a, b).area > 0:
        return 0.0
    closest = region_distance(a, b)
    return closest[0] if closest else float("inf")


def combined(regions: Sequence[Region], areas: Callable[..., Sequence[Section]]) -> list[Region]:
    """Returns the regions of areas that are put together from those of some regions."""
    return overlaid([outlined(region) for region in regions], areas)


# --- Outlines that touch each other in a point, with a joint there: boundary representations want a vertex
# where two outlines of a face meet.


def jointed(face: Face) -> Face:
    """Returns the face with the pieces of its outlines divided where these touch."""
    network = Network([piece for loop in face.loops for piece in loop.pieces])
    number, loops = 0, []
    for loop in face.loops:
        numbers = range(number, number + len(loop.pieces))
        number = numbers.stop
        pieces = [network.piece(use) for k in numbers for use in network.uses[k]]
        if loop.reversed and len(pieces) > 1:
            loops.append(Loop(tuple(piece.reversed() for piece in reversed(pieces))))
        else:
            loops.append(Loop(tuple(pieces), loop.reversed))
    return Face(loops[0], tuple(loops[1:]))


# --- Curves cut to the inside of a region, each by itself: they are not cut where they cross each other.


@record(slots=True)
class Clipped:
    """The parts of a curve that lie inside, and the others; `is_whole` if none of these is off the border."""

    inner: tuple[Piece, ...]
    outer: tuple[Piece, ...]
    is_whole: bool


@record(slots=True)
class Stretch:
    """The part of a curve from one cut to the next; its parameters may run past 1 on a closed curve."""

    t0: float
    t1: float
    start: Vec
    end: Vec
    on_border: bool

    @property
    def middle(self) -> float:
        return (self.t0 + self.t1) / 2


def clipped_each(curves: Sequence[Piece], region: Region, *, with_border: bool = False) -> list[Clipped]:
    """Returns for each curve what of it lies inside, or along the border where that counts as inside."""
    if not curves or not region:
        return [Clipped((), (curve,), is_whole=False) for curve in curves]
    boxes = np.concatenate((np.array([c.box for c in curves]), region.boxes))
    size = float((boxes[:, 2:].max(axis=0) - boxes[:, :2].min(axis=0)).max()) or 1.0
    tolerance = RELATIVE_TOLERANCE * size
    stretches = stretches_beside(curves, region.pieces, boxes, tolerance)
    spots = [c.point(s.middle) for c, of in zip(curves, stretches, strict=True) for s in of]
    polygons = region.polygons(CHORD * size)
    within = iter(inside(polygons, np.array(spots).reshape(-1, 2)).tolist())
    return [
        _clipped(c, of, [next(within) for _ in of], with_border)
        for c, of in zip(curves, stretches, strict=True)
    ]


def stretches_beside(
    curves: Sequence[Piece], borders: Sequence[Piece], boxes: Floats, tolerance: float
) -> list[list[Stretch]]:
    """Returns the parts of each curve between some borders; `boxes`: of the curves, then the borders."""
    every, count = [*curves, *borders], len(curves)
    near = near_rows(boxes, tolerance)
    near = near[(near[:, 0] < count) & (near[:, 1] >= count)]
    table = Table(every)
    pairs = Hulls(table, tolerance).meeting(near)
    found: list[tuple[list[Piece], list[Crossing]]] = [([], []) for _ in curves]
    for (i, j), crossings in zip(pairs.tolist(), all_intersections(table, pairs, tolerance), strict=True):
        found[i][0].append(every[j])
        found[i][1].extend(crossings)
    return [_stretches(c, *own, tolerance) for c, own in zip(curves, found, strict=True)]


def _stretches(
    curve: Piece, borders: Sequence[Piece], crossings: Sequence[Crossing], tolerance: float
) -> list[Stretch]:
    """Returns a curve in parts between the places where it meets the border."""
    checkpoint()
    cuts = [(t, p) for t, _, p in crossings]
    spots = (p for border in borders for p in border.ends)
    cuts += [(t, p) for p in spots if (t := curve.locate(p, tolerance)) is not None]
    start, end = curve.ends
    cuts.sort(key=lambda cut: cut[0])
    if cuts and curve.is_closed:
        cuts.append((cuts[0][0] + 1, cuts[0][1]))
    else:
        cuts = [(0.0, start), *cuts, (1.0, end)]
    apart = cuts[:1]
    for t, p in cuts[1:]:
        t0, before = apart[-1]
        if max(math.dist(before, curve.point((t0 + t) / 2)), math.dist(before, p)) > tolerance:
            apart.append((t, p))
        elif t == cuts[-1][0] and len(apart) > 1:
            apart[-1] = (t, p)
    found = []
    for (t0, p), (t1, q) in pairwise(apart):
        middle = curve.point((t0 + t1) / 2)
        on_border = any(border.locate(middle, 2 * tolerance) is not None for border in borders)
        found.append(Stretch(t0, t1, p, q, on_border))
    return found


def _clipped(
    curve: Piece, stretches: Sequence[Stretch], within: Sequence[bool], with_border: bool
) -> Clipped:
    sides: tuple[list[Stretch], list[Stretch]] = ([], [])
    for stretch, is_within in zip(stretches, within, strict=True):
        same = sides[0 if (with_border if stretch.on_border else is_within) else 1]
        if same and same[-1].t1 == stretch.t0:
            before = same.pop()
            stretch = Stretch(before.t0, stretch.t1, before.start, stretch.end, on_border=False)
        same.append(stretch)
    for same in sides if curve.is_closed else ():
        if len(same) > 1 and same[-1].t1 == same[0].t0 + 1:
            last, first = same.pop(), same[0]
            same[0] = Stretch(last.t0, first.t1 + 1, last.start, first.end, on_border=False)
    is_whole = all(s.on_border or is_in for s, is_in in zip(stretches, within, strict=True))
    inner, outer = (
        tuple(curve if s.t1 - s.t0 == 1 else curve.part(s.t0, s.t1, s.start, s.end) for s in same)
        for same in sides
    )
    return Clipped(inner, outer, is_whole)


# --- The contacts between the bodies of a drawing: touching, apart or overlapping.
#
# All is worked out when it is asked for: which pairs touch or overlap, which takes little, and how far apart
# they are, or by how much they overlap. Up to `ALL_PAIRS` bodies every pair is listed. In larger drawings
# only pairs whose boxes are closer than `NEAR` times the size of the drawing are, so that hundreds of bodies
# stay cheap; a pair that is not listed is apart.

ALL_PAIRS = 24
NEAR = 0.05
UNNOTICED = 1e-3
"""A gap in mm that nobody who makes the parts will see: flanks of gears are a little less than touching."""

Relation = Literal["touching", "apart", "overlapping"]


@record(slots=True)
class Contact:
    """The contact of two bodies, by paths; `gap` (mm) if they are apart, `area` (mm²) of an overlap."""

    a: str
    b: str
    relation: Relation
    gap: float | None = None
    area: float | None = None


@record()
class Solid:
    """A body, or an area that others lie on: its place in the order of drawing, and its colour, if it has
    one. One that `is_clear` hides nothing.
    """

    path: str
    section: Section
    place: float
    color: str | None
    is_clear: bool


@record()
class Contacts:
    """The pairs of some bodies, in order: those `near` touch or overlap; of `all` see above."""

    bodies: Sequence[tuple[str, Region]] = ()
    near: Callable[[], tuple[tuple[str, str], ...]] = field(default=tuple, repr=False, compare=False)
    all: Callable[[], tuple[Contact, ...]] = field(default=tuple, repr=False, compare=False)

    def nearest(self, path: str) -> tuple[float, str]:
        """Returns the distance (mm) from a body to the nearest other, and its path."""
        own = [region for name, region in self.bodies if name == path]
        others = [(name, region) for name, region in self.bodies if name != path]
        gap, place = nearest_region(own, [region for _, region in others])
        return gap, others[place][0]


def contacts(network: Network, solids: Sequence[Solid]) -> Contacts:
    """Returns the contacts between some bodies, whose sections are those of a network."""

    def near() -> tuple[tuple[str, str], ...]:
        reach = max(UNNOTICED, network.tolerance)
        pairs = sorted(near_rows([s.section.region.box for s in solids], reach + network.tolerance).tolist())
        couples = ((solids[i], solids[j]) for i, j in pairs)
        return tuple(
            (a.path, b.path)
            for a, b in couples
            if _shared(a, b, exactly=False) > 0 or lie_within(a.section.region, b.section.region, reach)
        )

    def everything() -> tuple[Contact, ...]:
        pairs: Iterable[tuple[int, int]] = combinations(range(len(solids)), 2)
        if len(solids) > ALL_PAIRS:
            pairs = sorted(near_rows([s.section.region.box for s in solids], NEAR * network.size).tolist())
        return tuple(_compare(network, solids[i], solids[j]) for i, j in pairs)

    return Contacts(tuple((s.path, s.section.region) for s in solids), Later(near), Later(everything))


def _shared(a: Solid, b: Solid, *, exactly: bool) -> float:
    """Returns the area that two bodies share; that of their polygons will do if it is no thin one."""
    common = a.section & b.section
    if common.is_nothing:
        return 0.0
    return common.region.area if exactly or common.is_thin else common.area


def _compare(network: Network, a: Solid, b: Solid) -> Contact:
    if (shared := _shared(a, b, exactly=True)) > 0:
        return Contact(a.path, b.path, "overlapping", area=shared)
    closest = region_distance(a.section.region, b.section.region)
    gap = closest[0] if closest and closest[0] > network.tolerance else None
    return Contact(a.path, b.path, "touching" if gap is None else "apart", gap)


# --- The areas of letters that a drawing fills, with their counters open; letters with overlapping contours
# united; letters of stencils, with bridges to what they enclose.


def lettered_region(letters: Sequence[Sequence[Piece]]) -> Region | None:
    """Returns the region of letters whose contours follow one another, do not cross, and turn one way and the
    other where they are nested: nothing need be arranged for it. None if one is open, or two may meet.
    """
    boxes = [union_bounds([piece.box for piece in letter]) for letter in letters]
    tolerance = RELATIVE_TOLERANCE * larger_side(union_bounds(boxes))
    if len(near_rows(boxes, tolerance)):
        return None
    faces: list[Face] = []
    for letter in letters:
        checkpoint()
        contours = list(_contours(letter))
        if any(contour[0].ends[0] != contour[-1].ends[1] for contour in contours):
            return None
        areas = [Loop(contour).area for contour in contours]
        sense = math.copysign(1.0, max(areas, key=abs))
        turned = [c if sense > 0 else tuple(piece.reversed() for piece in reversed(c)) for c in contours]
        loops = (closed_loop(contour, tolerance) for contour in turned)
        faces += faces_of([(sense * area, loop) for area, loop in zip(areas, loops, strict=True)])
    return Region(tuple(sorted(faces, key=lambda face: face.outer.start)))


@lru_cache(maxsize=512)
def united_character(outline: tuple[Curve, ...]) -> tuple[Curve, ...]:
    """Returns the outline of what the contours of a character enclose together, by the non-zero rule."""
    curves = [Line(*c) if len(c) == 2 else Bezier(*c) for c in outline]
    (region,) = overlaid([(list(_contours(curves)), "NonZero")], lambda whole: [whole])
    return tuple(map(_points, region.pieces))


_ROUNDS = 4
"""How often what is still enclosed gets bridges: a ring in a ring needs two."""


@lru_cache(maxsize=512)
def stencilled(outline: tuple[Curve, ...], width: float) -> tuple[Curve, ...]:
    """Returns the outline of a character through which bridges lead to all that it encloses: upright ones of
    that width, above and below the middle of each counter, through the strokes next to it.
    """
    region = lettered_region([[Line(*c) if len(c) == 2 else Bezier(*c) for c in outline]]) or Region()
    for wider in range(_ROUNDS):
        counters = [hole for face in region.faces for hole in face.holes]
        if not counters:
            break
        beyond = width * 2**wider
        region = without(region, *(bar for hole in counters for bar in _bridges(region, hole, width, beyond)))
    return tuple(map(_points, region.pieces))


def _bridges(region: Region, counter: Loop, width: float, beyond: float) -> Iterator[Region]:
    """Yields the areas of a letter to be taken away for a counter. They reach `beyond` the far side of a
    stroke, which may be slanted, but no further than half of the way to the next one.
    """
    left, low, right, high = counter.box
    x, middle = (left + right) / 2, (low + high) / 2
    _, bottom, _, top = region.box
    line = _rectangle(x - 1e-3 * width, bottom - width, x + 1e-3 * width, top + width)
    strokes = sorted(face.outer.box[1::2] for face in common(region, line).faces)
    above = [stroke for stroke in strokes if stroke[0] > middle]
    below = [stroke for stroke in reversed(strokes) if stroke[1] < middle]
    if above:
        end = min([above[0][1] + beyond, *((above[0][1] + next_low) / 2 for next_low, _ in above[1:2])])
        yield _rectangle(x - width / 2, middle, x + width / 2, end)
    if below:
        end = max([below[0][0] - beyond, *((below[0][0] + next_high) / 2 for _, next_high in below[1:2])])
        yield _rectangle(x - width / 2, end, x + width / 2, middle)


def _rectangle(left: float, bottom: float, right: float, top: float) -> Region:
    corners = ((left, bottom), (right, bottom), (right, top), (left, top))
    return Region((Face(Loop(tuple(Line(a, b) for a, b in pairwise((*corners, corners[0]))))),))


def _points(piece: Piece) -> Curve:
    if isinstance(piece, Bezier):
        return piece.p0, piece.p1, piece.p2, piece.p3
    assert isinstance(piece, Line)
    return piece.start, piece.end


def _contours(outline: Sequence[Piece]) -> Iterator[tuple[Piece, ...]]:
    """Yields the runs of curves of which each begins where the one before it ends."""
    first = 0
    for k, piece in enumerate(outline):
        is_closed = outline[first].ends[0] == piece.ends[1]
        if is_closed or k + 1 == len(outline) or outline[k + 1].ends[0] != piece.ends[1]:
            yield tuple(outline[first : k + 1])
            first = k + 1

"""Booleans of plane polygons, and the way back from these to exact curves."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property, lru_cache
from importlib import import_module
from itertools import accumulate
from typing import Any, Literal, TypeVar

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Arc, Bounds, Circle, Floats, Line, Mask, Piece, Vec
from aidl_lang.geometry.intersect import inside
from aidl_lang.geometry.network import NODE, RELATIVE_TOLERANCE, UNKNOWN, Edge, Network, with_finer_chords
from aidl_lang.geometry.region import Face, Loop, Polygon, Region, length, polygon_area
from aidl_lang.solver.linear import each_once

# --- A thin layer over Manifold's plane booleans, on polygons in grid units (see `network`).

NEGLIGIBLE = 16 * RELATIVE_TOLERANCE
"""Width in grid units below which an area is rounding: the drawing measures about 16 of them."""


Rule = Literal["EvenOdd", "NonZero"]
Outlined = tuple[Sequence[Sequence[Piece]], Rule]
"""Outlines, and the rule by which they are filled."""

_CORNERS = 32
"""Of the polygon that stands for a circle around a corner."""


class Section:
    """An area of the plane bounded by polygons: a `CrossSection` of Manifold, with its area and its box. One
    of a network has its exact outlines, too. An empty one may be of none.
    """

    def __init__(self, shape: Any, network: Network | None = None) -> None:
        self._shape, self.network = shape, network
        self.is_empty: bool = shape.is_empty()
        self.area: float = shape.area()
        self.box: Bounds = shape.bounds()

    @cached_property
    def _outlines(self) -> tuple[Region, frozenset[int]]:
        return _trace([self])[0]

    @property
    def region(self) -> Region:
        """The exact region, faces and loops in a canonical order."""
        return self._outlines[0]

    @property
    def edges(self) -> frozenset[int]:
        """The edges of the network that bound it."""
        return self._outlines[1]

    def num_contour(self) -> int:
        return int(self._shape.num_contour())

    def num_vert(self) -> int:
        return int(self._shape.num_vert())

    def to_polygons(self) -> list[Polygon]:
        return list(self._shape.to_polygons())

    def decompose(self) -> list[Section]:
        """Returns its connected parts."""
        return [Section(part, self.network) for part in self._shape.decompose()]

    def holes(self) -> list[Section]:
        """Returns the areas that its inner outlines enclose."""
        whole = fill([p for p in self.to_polygons() if polygon_area(p) > 0], "NonZero", self.network)
        return (whole - self).decompose()

    def __sub__(self, other: Section) -> Section:
        return Section(self._shape - other._shape, self.network) if self.may_meet(other) else self

    def __and__(self, other: Section) -> Section:
        return Section(self._shape ^ other._shape, self.network) if self.may_meet(other) else union([])

    def may_meet(self, other: Section) -> bool:
        """Tells whether the boxes overlap by more than nothing."""
        if self.is_empty or other.is_empty:
            return False
        (a0, a1, a2, a3), (b0, b1, b2, b3) = self.box, other.box
        return a0 < b2 and b0 < a2 and a1 < b3 and b1 < a3

    def is_boxed_by(self, other: Section) -> bool:
        """Tells whether its box lies in that of the other."""
        (a0, a1, a2, a3), (b0, b1, b2, b3), e = self.box, other.box, NEGLIGIBLE
        return a0 >= b0 - e and a1 >= b1 - e and a2 <= b2 + e and a3 <= b3 + e

    @property
    def is_nothing(self) -> bool:
        """Whether it is empty, or thinner than the tolerance."""
        left, bottom, right, top = self.box
        return self._is_below((right - left) + (top - bottom))

    @property
    def is_thin(self) -> bool:
        """Whether it may be but the difference of curves and chords."""
        left, bottom, right, top = self.box
        return self._is_below(100 * self.num_contour() * ((right - left) + (top - bottom)))

    def _is_below(self, scale: float) -> bool:
        return self.is_empty or abs(self.area) <= NEGLIGIBLE * scale

    def overlaps(self, other: Section) -> bool:
        return not (self & other).is_nothing

    def covers(self, other: Section) -> bool:
        """Tells whether nothing of the other lies outside."""
        if self.is_empty or other.is_empty or not other.is_boxed_by(self):
            return False
        return (other - self)._is_below(math.sqrt(abs(other.area)))

    def mask(self, spots: Polygon) -> Mask:
        """Returns the mask of the points inside, in grid units."""
        within = np.zeros(len(spots), dtype=np.bool_)
        if not self.is_empty:
            left, bottom, right, top = self.box
            near = np.flatnonzero(((spots >= (left, bottom)) & (spots <= (right, top))).all(axis=1))
            if len(near):
                within[near] = inside(self.to_polygons(), spots[near])
        return within


@lru_cache(maxsize=1)
def _manifold() -> Any:
    # Not imported at the top: checking and formatting a program need no kernel.
    return import_module("manifold3d")


def fill(polygons: Sequence[Polygon], rule: Rule, network: Network | None = None) -> Section:
    m = _manifold()
    kept = [p for p in polygons if len(p) > 2]
    return Section(m.CrossSection(kept, getattr(m.FillRule, rule)) if kept else m.CrossSection(), network)


def section_of(region: Region, network: Network) -> Section:
    """Returns the section of a region whose outlines are not those of the network that has its grid."""
    found = fill([network.on_grid(p) for p in region.polygons(network.tolerance)], "EvenOdd", network)
    found._outlines = region, frozenset()
    return found


def widened(polygon: Polygon, by: float, rough: float = 0.0) -> Polygon:
    """Returns the outer boundary of all within a distance of a polygon, or a little further out: up to twice
    `rough`, for which corners that matter less are left out, but no further than its box.
    """
    m = _manifold()

    def grown(by: float) -> Any:
        reach = by / math.cos(math.pi / _CORNERS)  # of a round corner's chords
        section = m.CrossSection([polygon], m.FillRule.NonZero)
        return section.offset(reach, m.JoinType.Round, 2.0, _CORNERS)

    section = grown(by)
    if rough:
        left, bottom, right, top = section.bounds()
        box = m.CrossSection.square((right - left, top - bottom)).translate((left, bottom))
        section = grown(by + rough).simplify(rough) ^ box
    return max(
        (np.asarray(p, np.float64) for p in section.to_polygons()),
        key=lambda p: float(np.ptp(p, axis=0).max()),
    )


def union(sections: Sequence[Section]) -> Section:
    """Returns the union of any number of sections."""
    m = _manifold()
    full = [s for s in sections if not s.is_empty]
    if len(full) < 2:
        return full[0] if full else Section(m.CrossSection())
    return Section(m.CrossSection.batch_boolean([s._shape for s in full], m.OpType.Add), full[0].network)


def overlaid(shapes: Sequence[Outlined], areas: Callable[..., Sequence[Section]]) -> list[Region]:
    """Returns the regions of areas that are put together from those of some shapes, in one network."""

    def found(network: Network) -> list[Region]:
        curves, sections = iter(network.uses), []
        for outlines, rule in shapes:
            walks = ([use for _ in outline for use in next(curves)] for outline in outlines)
            # One too small to see has no edges.
            sections.append(fill([network.polyline(walk) for walk in walks if walk], rule, network))
        return traced(areas(*sections))

    pieces = [piece for outlines, _ in shapes for outline in outlines for piece in outline]
    return with_finer_chords(Network(pieces), found)


def outlined(region: Region) -> Outlined:
    return [loop.pieces for loop in region.loops], "EvenOdd"


# --- Turns the polygons of a boolean back into outlines of exact curves.
#
# Each vertex of a result is a vertex of the network (see there), so the edge it belongs to is looked up, not
# guessed. Runs of vertices along one edge become one part of its curve, and parts that continue each other
# are joined again, over the nodes that other curves left on them.

T = TypeVar("T")
STRAIGHT = -3
"""Stands for the edge of a result that no curve owns: the straight way between its two vertices."""


@record(slots=True)
class Run:
    """The part `t0..t1` of a curve (None: straight) between two points."""

    curve: int | None
    t0: float
    t1: float
    start: Vec
    end: Vec


def traced(sections: Sequence[Section]) -> list[Region]:
    """Returns the exact regions of many sections of a network, found at once, which spares most of the table
    look-ups.
    """
    for section, found in zip(sections, _trace(sections), strict=True):
        section._outlines = found
    return [section.region for section in sections]


def _trace(sections: Sequence[Section]) -> list[tuple[Region, frozenset[int]]]:
    full = [section for section in sections if not section.is_empty]
    if not full:
        return [(Region(), frozenset())] * len(sections)
    network = full[0].network
    assert network is not None
    parts = [_components(section) for section in sections]
    sides = _Sides(network, [polygon for section in parts for part in section for polygon in part])
    number, result = 0, []
    for section in parts:
        used, faces = set[int](), list[Face]()
        for part in section:
            checkpoint()
            numbers = range(number, number + len(part))
            faces += faces_of([loop for k in numbers for loop in sides.loops(k, used)])
            number += len(part)
        faces.sort(key=lambda face: face.outer.start)
        result.append((Region(tuple(faces)), frozenset(used)))
    return result


def _components(section: Section) -> list[list[Polygon]]:
    """Returns the polygons of the connected faces, of which each has one outer one."""
    polygons = section.to_polygons()
    if len(polygons) < 2 or sum(polygon_area(polygon) > 0 for polygon in polygons) == 1:
        return [polygons] if polygons else []
    return [part.to_polygons() for part in section.decompose()]


def faces_of(loops: list[tuple[float, Loop]]) -> list[Face]:
    """Returns faces: outer loops with the holes that lie in them, which are one loop or touch."""
    outers = [loop for _, loop in sorted(loops, key=lambda pair: pair[0]) if _ > 0]
    inner = [loop for area, loop in loops if area < 0 and outers]
    holes: list[list[Loop]] = [[] for _ in outers]
    for hole, holder in zip(inner, _holders(outers, inner), strict=True):
        holes[holder].append(hole)
    return [
        Face(o, tuple(sorted(h, key=lambda hole: hole.start))) for o, h in zip(outers, holes, strict=True)
    ]


def _holders(outers: list[Loop], holes: list[Loop]) -> list[int]:
    if len(outers) == 1 or not holes:
        return [0] * len(holes)
    holder = np.full(len(holes), -1)
    spots = np.array([hole.pieces[0].point(0.5) for hole in holes]).reshape(-1, 2)
    ts = np.linspace(0, 1, 65)
    for number, outer in enumerate(outers):
        left, bottom, right, top = outer.box
        within = (spots >= (left, bottom)).all(axis=1) & (spots <= (right, top)).all(axis=1)
        seekers = np.flatnonzero(within & (holder < 0))
        if len(seekers):
            polygon = np.concatenate([piece.points(ts)[:-1] for piece in outer.pieces])
            holder[seekers[inside([polygon], spots[seekers])]] = number
    return [int(k) for k in holder]


class _Sides:
    """The sides of many polygons in one table: where each vertex belongs, and the edge each side follows.

    Polygon k has the rows `bounds[k]:bounds[k + 1]`; `starts[k]` are those at which another edge begins.
    """

    def __init__(self, network: Network, polygons: list[Floats]) -> None:
        """Looks up all vertices, then finds the edge from each to the next one of its polygon."""
        self.network = network
        bounds = self.bounds = [0, *accumulate(len(p) for p in polygons)]
        vertices = self.vertices = np.concatenate(polygons)
        after = np.arange(1, len(vertices) + 1)
        after[[b - 1 for b in bounds[1:]]] = bounds[:-1]
        before = np.empty_like(after)
        before[after] = np.arange(len(after))
        owner, place = self.owner, self.place = network.look_up(vertices)
        owner_after = owner[after]
        edges = np.where(owner >= 0, owner, np.where(owner_after >= 0, owner_after, STRAIGHT))
        between = np.flatnonzero((owner == NODE) & (owner_after == NODE))
        ways = zip(place[between].tolist(), place[after[between]].tolist(), strict=True)
        edges[between] = [network.straight.get(way, STRAIGHT) for way in ways]
        # Chords that cross where their curves only touch leave vertices unknown to the network.
        changed = (owner >= 0) & (owner_after >= 0) & (owner != owner_after)
        unsure = np.flatnonzero((owner == UNKNOWN) | (owner_after == UNKNOWN) | changed)
        if len(unsure):
            network.blur(vertices[each_once(np.concatenate((unsure, after[unsure])))])
            edges[unsure] = network.nearest_edges((vertices[unsure] + vertices[after[unsure]]) / 2)
        for k in np.flatnonzero(owner == UNKNOWN):
            node = _touched_node(network, int(edges[before[k]]), int(edges[k]), network.position(vertices[k]))
            if node is not None:
                owner[k], place[k] = NODE, node
        begins = (edges[after] != edges)[before] | (owner == NODE) | (edges == STRAIGHT)
        rows = np.flatnonzero(begins)
        self.edges = edges
        self.starts = [part.tolist() for part in np.split(rows, np.searchsorted(rows, bounds[1:-1]))]

    def loops(self, number: int, used: set[int]) -> list[tuple[float, Loop]]:
        """Returns the exact loops of a polygon with their areas, without those thinner than the tolerance;
        adds the edges that they follow to `used`.
        """
        network = self.network
        low, high = self.bounds[number], self.bounds[number + 1]
        starts = self.starts[number] or [low]
        runs: list[Run] = []
        for begin, end in zip(starts, [*starts[1:], starts[0]], strict=True):
            edge = int(self.edges[begin])
            used.add(edge)
            second = begin + 1 if begin + 1 < high else low
            last = end - 1 if end > low else high - 1
            runs.append(self._run(edge, (begin, second), (end, last)))
        used.discard(STRAIGHT)
        result = []
        for simple in _split_at_pinches(_snapped(runs, network.tolerance)):
            loop = _to_loop(network, joined(simple, lambda a, b: _continue(network, a, b)))
            area = loop.area
            if abs(area) > network.tolerance * sum(map(length, loop.pieces)) / 2:
                result.append((area, loop))
        return result

    def _run(self, number: int, begin: tuple[int, int], end: tuple[int, int]) -> Run:
        """Returns the run along one edge; its ends are given with the vertices of the run beside them."""
        first, start = self._spot(begin[0])
        last, stop = self._spot(end[0])
        if number == STRAIGHT:
            return Run(None, 0.0, 1.0, start, stop)
        edge = self.network.edges[number]
        if first is not None and last is not None and {first, last} == {edge.start, edge.end}:
            forward = first == edge.start
            if edge.start == edge.end:
                forward = int(self.place[begin[1]]) < len(self.network.inner((number, True))) / 2
            t0, t1 = (edge.t0, edge.t1) if forward else (edge.t1, edge.t0)
        else:
            t0, t1 = (self._parameter(edge, vertex, beside) for vertex, beside in (begin, end))
        return Run(edge.curve, t0, t1, start, stop)

    def _spot(self, vertex: int) -> tuple[int | None, Vec]:
        """Returns the node at a vertex, if there is one, and its place in millimetres."""
        if self.owner[vertex] == NODE:
            node = int(self.place[vertex])
            return node, self.network.nodes[node]
        return None, self.network.position(self.vertices[vertex])

    def _parameter(self, edge: Edge, vertex: int, beside: int) -> float:
        node, p = self._spot(vertex)
        curve = self.network.curves[edge.curve]
        if node in (edge.start, edge.end):
            if edge.start != edge.end:
                return edge.t0 if node == edge.start else edge.t1
            # Both ends of the part are here: the one that the vertex beside it is near to.
            t = curve.nearest(self._spot(beside)[1])
            return edge.t0 if t < (edge.t0 + edge.t1) / 2 else edge.t1
        return min(edge.t1, max(edge.t0, curve.nearest(p)))


def _touched_node(network: Network, a: int, b: int, p: Vec) -> int | None:
    """Returns the node at which two edges touch, if from a point between them to there they are one.

    Near a touch chords cross however fine they are, and an outline changes from edge to edge too soon.
    """
    if a == b or STRAIGHT in (a, b):
        return None
    one, other = network.edges[a], network.edges[b]
    shared = {one.start, one.end} & {other.start, other.end}
    if not shared or one.start == one.end or other.start == other.end:
        return None
    node = min(shared, key=lambda n: math.dist(network.nodes[n], p))
    curve, across, reach = network.curves[one.curve], network.curves[other.curve], 4 * network.tolerance
    t, there = curve.nearest(p), one.t0 if node == one.start else one.t1
    spots = (curve.point(t + (there - t) * k / 4) for k in range(4))
    is_one = all(across.locate(spot, reach) is not None for spot in spots)
    return node if is_one and math.dist(curve.point(t), p) <= reach else None


def _split_at_pinches(runs: list[Run]) -> list[list[Run]]:
    """Returns loops that pass no point twice, of a polygon that may (as a circle in a square does)."""
    if len({run.start for run in runs}) == len(runs):
        return [runs] if runs else []
    loops: list[list[Run]] = []
    stack: list[Run] = []
    place: dict[Vec, int] = {}
    for run in runs:
        place[run.start] = len(stack)
        stack.append(run)
        if (first := place.get(run.end)) is not None:
            loops.append(stack[first:])
            for passed in stack[first:]:
                del place[passed.start]
            del stack[first:]
    return loops


def _snapped(runs: list[Run], tolerance: float) -> list[Run]:
    """Returns the runs without those that go nowhere; their neighbours meet in one point."""
    kept = [
        r for r in runs if r.t0 != r.t1 and (r.curve is not None or math.dist(r.start, r.end) > tolerance)
    ]
    return [
        r if r.end == after.start else replace(r, end=after.start)
        for r, after in zip(kept, kept[1:] + kept[:1], strict=True)
    ]


def _continue(network: Network, a: Run, b: Run) -> Run | None:
    """Returns one run for two that follow each other on one curve; None for others."""
    if a.curve is None or a.curve != b.curve or (a.t1 > a.t0) != (b.t1 > b.t0):
        return None
    if a.t1 == b.t0:
        return Run(a.curve, a.t0, b.t1, a.start, b.end)
    if network.curves[a.curve].is_closed and abs(math.remainder(a.t1 - b.t0, 1.0)) <= 1e-12:  # rounding
        return Run(a.curve, a.t0, a.t1 + (b.t1 - b.t0), a.start, b.end)
    return None


def _to_loop(network: Network, runs: list[Run]) -> Loop:
    if len(runs) == 1 and runs[0].curve is not None and (curve := network.curves[runs[0].curve]).is_closed:
        return Loop((curve,), reversed=runs[0].t1 < runs[0].t0)
    pieces = [
        Line(r.start, r.end) if r.curve is None else network.curves[r.curve].part(r.t0, r.t1, r.start, r.end)
        for r in runs
    ]
    return closed_loop(pieces, network.tolerance)


def closed_loop(pieces: Sequence[Piece], tolerance: float) -> Loop:
    """Returns the loop of pieces that follow each other, in a canonical form."""
    pieces = joined(pieces, lambda a, b: _fuse(a, b, tolerance))
    if len(pieces) == 1 and isinstance(arc := pieces[0], Arc) and abs(arc.sweep) > math.tau - 1e-6:
        return Loop((Circle(arc.center, arc.radius),), reversed=arc.sweep < 0)

    # The leftmost point begins, the lowest of those: compared coarsely, so that rounding does not choose.
    def begins(number: int) -> tuple[int, ...]:
        return tuple(round(c / (2 * tolerance)) for c in pieces[number].ends[0])

    first = min(range(len(pieces)), key=begins)
    return Loop((*pieces[first:], *pieces[:first]))


def _fuse(a: Piece, b: Piece, tolerance: float) -> Piece | None:
    """Returns one piece for two that follow each other on the same line or circle; None for others."""
    if isinstance(a, Arc) and isinstance(b, Arc):
        same = math.dist(a.center, b.center) <= tolerance and abs(a.radius - b.radius) <= tolerance
        if same and a.sweep * b.sweep > 0 and abs(a.sweep + b.sweep) <= math.tau + 1e-9:
            return Arc(a.center, a.radius, a.start, b.end, a.sweep + b.sweep)
    if not (isinstance(a, Line) and isinstance(b, Line)):
        return None
    (ax, ay), (dx, dy) = a.way, Line(a.start, b.end).way
    own, whole = math.hypot(ax, ay), math.hypot(dx, dy)
    if whole <= tolerance or ax * dx + ay * dy <= 0 or own >= whole:
        return None
    away = abs(ax * dy - ay * dx) / whole
    return Line(a.start, b.end) if away <= min(tolerance, 1e-5 * min(own, whole - own)) else None


def joined(items: Sequence[T], join: Callable[[T, T], T | None]) -> list[T]:
    """Returns neighbours joined where they can be, around the end as well."""
    result: list[T] = []
    for item in items:
        both = join(result[-1], item) if result else None
        if both is None:
            result.append(item)
        else:
            result[-1] = both
    while len(result) > 1 and (both := join(result[-1], result[0])) is not None:
        result = [both, *result[1:-1]]
    return result

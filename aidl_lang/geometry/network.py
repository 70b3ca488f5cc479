"""The exact arrangement under the booleans."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from itertools import pairwise, product
from typing import TypeVar

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint, give_up
from aidl_lang.geometry.curves import Bezier, Bounds, Floats, Ints, Line, Mask, Piece, Vec, union_bounds
from aidl_lang.geometry.intersect import Sides, Table, all_intersections, near_rows, self_crossing

# --- Proofs, for many pairs of curves at once, that two curves meet at most in an end that they share.
#
# Every curve is cut into `PARTS` parts, each within the hull of four points. Two curves are apart where no
# boxes of their parts meet; beside a shared end they are where a straight line through it has all of one on
# one side and all of the other on the other. In a drawing this is so of nearly every pair, and no crossing
# need be sought (`intersect`).

PARTS = 8
_NO_PLACES = np.zeros((0, 2))
_ANGLE = 0.2
"""Radians that must be free beyond a straight angle, for curves to be apart on both sides of an end."""
_MARGIN = 4
"""Distance in tolerances that boxes must have: a crossing may be that far from where both curves are."""
_AT_ONCE = 1 << 14
"""Pairs that are compared in one step, which bounds the memory."""
_REACHES = (PARTS, PARTS // 2, 1)
"""Numbers of parts beside a shared end that a line through it separates."""


class Hulls:
    """The hulls of all parts of some curves, and the boxes of these."""

    def __init__(self, table: Table, tolerance: float) -> None:
        self._hulls = _hulls(table)
        self._least = 2 * tolerance
        margin = _MARGIN * tolerance / 2
        # One axis after the other: a reduction over an axis of length two is slow.
        self._low = np.moveaxis(self._hulls.min(axis=2) - margin, 2, 0).copy()
        self._high = np.moveaxis(self._hulls.max(axis=2) + margin, 2, 0).copy()

    def meeting(self, pairs: Ints, nodes: Ints | None = None, places: Floats = _NO_PLACES) -> Ints:
        """Returns those of some pairs of curves that may meet in more than an end they share.

        nodes   by curve, which points its two ends are; without it they share none
        places  where these points are
        """
        if nodes is None:
            nodes = np.arange(2 * len(self._hulls)).reshape(-1, 2)
        kept = np.zeros(len(pairs), dtype=np.bool_)
        for begin in range(0, len(pairs), _AT_ONCE):
            checkpoint()
            rows = slice(begin, begin + _AT_ONCE)
            kept[rows] = self._may_meet(pairs[rows, 0], pairs[rows, 1], nodes, places)
        return pairs[kept]

    def may_hold(self, curves: Ints, spots: Floats) -> Mask:
        """Tells of some curves whether each may pass a spot."""
        inside = np.ones((len(curves), PARTS), dtype=np.bool_)
        for low, high, place in zip(self._low, self._high, spots.T, strict=True):
            inside &= (low[curves] <= place[:, None]) & (place[:, None] <= high[curves])
        return np.asarray(inside.any(axis=1), dtype=np.bool_)

    def _may_meet(self, one: Ints, other: Ints, nodes: Ints, places: Floats) -> Mask:
        meets = np.ones((len(one), PARTS, PARTS), dtype=np.bool_)
        for low, high in zip(self._low, self._high, strict=True):
            meets &= low[one][:, :, None] <= high[other][:, None]
            meets &= low[other][:, None] <= high[one][:, :, None]
        for end, across in product((0, 1), (0, 1)):
            shared = nodes[one, end]
            rows = np.flatnonzero(shared == nodes[other, across])
            for reach in _REACHES:
                rows = rows[meets[rows].any(axis=(1, 2))] if len(rows) else rows
                if not len(rows):
                    break
                ours, theirs = _beside(end, reach), _beside(across, reach)
                a, b = self._hulls[one[rows], ours], self._hulls[other[rows], theirs]
                apart = rows[self._on_two_sides(a, b, places[shared[rows]])]
                meets[apart, ours, theirs] = False
        return np.asarray(meets.any(axis=(1, 2)), dtype=np.bool_)

    def _on_two_sides(self, ours: Floats, theirs: Floats, spots: Floats) -> Mask:
        """Tells whether a straight line through a spot tells some parts from others. Points that are as good
        as the spot itself are on either side.
        """
        at = spots[:, None, None]
        ways = np.concatenate((at - ours, theirs - at), axis=1)
        ways = ways.reshape(len(ways), ways.shape[1] * 4, 2)
        angles = np.arctan2(ways[..., 1], ways[..., 0])
        counts = np.hypot(ways[..., 0], ways[..., 1]) > self._least
        some = np.take_along_axis(angles, counts.argmax(axis=1)[:, None], axis=1)
        angles = np.sort(np.where(counts, angles, some), axis=1)
        free = np.diff(angles, axis=1, append=angles[:, :1] + 2 * math.pi).max(axis=1)
        apart: Mask = (free > math.pi + _ANGLE) & counts.any(axis=1)
        return apart


def _beside(end: int, reach: int) -> slice:
    """Returns the parts of a curve that lie beside its start (0) or its end (1)."""
    return slice(PARTS - reach, PARTS) if end else slice(0, reach)


def _hulls(table: Table) -> Floats:
    """Returns the four points around each part of each curve: its ends, and on the tangents in them the inner
    control points of a cubic, or twice the meeting of the tangents of a round curve.
    """
    count, marks = len(table.curves), np.arange(PARTS + 1) / PARTS
    found = table.at(np.repeat(np.arange(count), len(marks)), np.tile(marks, count), 1)
    spots, ways = found.reshape(2, count, len(marks), 2)
    if count:  # what was stored is where it ends
        spots[:, 0], spots[:, -1] = np.array([c.ends for c in table.curves]).transpose(1, 0, 2)
    sweep = np.where(table.is_round, table.rows[:, 7], 1.0)
    reach = np.where(table.is_round, np.tan(sweep / (2 * PARTS)) / sweep, 1 / (3 * PARTS))
    off = reach[:, None, None] * ways
    starts, stops = spots[:, :-1], spots[:, 1:]
    return np.stack((starts, starts + off[:, :-1], stops - off[:, 1:], stops), axis=2)


# --- All curves of a drawing cut at the points where they meet: the exact arrangement under the booleans.
#
# Ends and crossings closer than the tolerance (1e-6 of the drawing's size) become one node, so gaps that
# rounding left are closed and neighbours share their ends to the last digit. Between nodes run edges; curves
# that lie on each other share them. Each edge also has a polyline on an integer grid, fine enough to have
# the topology of the curve. Booleans work on these polylines, and because their vertices are known here,
# every edge of a result leads back to the curve it came from (`trace`).

RELATIVE_TOLERANCE = 1e-6
CHORD = 1e-4
"""Largest distance of a chord from its curve, relative to the size of the drawing."""
FINE_CHORD = CHORD / 100
"""The same for curves that come so close to each other that their chords cross."""
_MOST_CHORDS = 2000
"""Chords of an edge, however fine."""
_PER_PAIR = 1e-4
"""Seconds of a processor that it takes at least to find where two cubics meet that may."""
GRID = 1e-8
"""Manifold rounds plane coordinates to this step; the drawing is scaled to about 16 units before."""

NODE, UNKNOWN = -1, -2

T = TypeVar("T")
Use = tuple[int, bool]
"""An edge and whether it is run through forwards."""


@record(slots=True)
class Edge:
    """The part `t0..t1` of a curve between two nodes."""

    curve: int
    t0: float
    t1: float
    start: int
    end: int


class Joined:
    """Groups of things that hang together (union-find)."""

    def __init__(self) -> None:
        self._parent: dict[object, object] = {}

    def root(self, thing: object) -> object:
        while (above := self._parent.get(thing, thing)) != thing:
            self._parent[thing] = thing = self._parent.get(above, above)
        return thing

    def join(self, one: object, other: object) -> None:
        self._parent[self.root(one)] = self.root(other)

    def groups(self, things: Iterable[T], end: Callable[[T], object] = lambda thing: thing) -> list[list[T]]:
        """Returns the things in groups, in order of first mention; `end` is what was joined of each."""
        groups: dict[object, list[T]] = {}
        for thing in things:
            groups.setdefault(self.root(end(thing)), []).append(thing)
        return list(groups.values())


class TooCoarse(Exception):  # noqa: N818 (not an error of ours: what is under way begins again)
    """Raised if a result has vertices that no curve owns, and finer chords would help."""


class Weld:
    """Points by number; one within the tolerance of another is the same point."""

    def __init__(self, tolerance: float) -> None:
        self.tolerance = tolerance
        self.points: list[Vec] = []
        self._cells: dict[tuple[int, int], list[int]] = {}

    def number(self, p: Vec) -> int:
        """Returns the number of p, a new one if none is near in the four cells the tolerance can reach."""
        step = 2 * self.tolerance
        column, row = math.floor(p[0] / step), math.floor(p[1] / step)
        beside = column + (1 if p[0] - column * step > self.tolerance else -1)
        beyond = row + (1 if p[1] - row * step > self.tolerance else -1)
        for cell in ((column, row), (beside, row), (column, beyond), (beside, beyond)):
            for number in self._cells.get(cell, ()):
                if math.dist(self.points[number], p) <= self.tolerance:
                    return number
        self.points.append(p)
        self._cells.setdefault((column, row), []).append(len(self.points) - 1)
        return len(self.points) - 1


class Network:
    """Nodes and edges of a set of curves. `uses[i]` lists the edges of curve i in its own direction.

    A result may have vertices that no curve owns: chords crossed where their curves do not. `blurred` has the
    numbers of these curves; work done by `with_finer_chords` is then begun again with these curves cut finer.
    `box` is that of the whole drawing, of which these may be a part.
    """

    def __init__(
        self, curves: Sequence[Piece], boxes: Sequence[Bounds] | None = None, box: Bounds | None = None
    ) -> None:
        self.curves = list(curves)
        self.boxes = [c.box for c in self.curves] if boxes is None else list(boxes)
        self.box = union_bounds(self.boxes) if box is None else box
        left, bottom, right, top = self.box
        self.size = max(right - left, top - bottom) or 1.0
        self.tolerance = RELATIVE_TOLERANCE * self.size
        self.middle = (left + right) / 2, (bottom + top) / 2
        self.scale = 2.0 ** math.floor(math.log2(16 / self.size))
        self.blurred: set[int] = set()
        self.may_refine = False
        self._weld, self._middles = Weld(self.tolerance), Weld(self.tolerance)
        self.nodes = self._weld.points
        self.node = cache(self._weld.number)
        self.edges: list[Edge] = []
        self._known: dict[tuple[int, ...], int] = {}
        self._fine: set[int] = set()
        self._table = Table(self.curves)
        self.uses: list[list[Use]] = self._arrange()
        self._draw_polylines()

    def on_grid(self, xy: Floats) -> Floats:
        """Returns points in grid units, as Manifold takes them."""
        return self._steps(xy) * np.float64(GRID)

    def _steps(self, xy: Floats) -> Ints:
        grid: Ints = np.rint((xy - np.array(self.middle)) * (self.scale / GRID)).astype(np.int64)
        return grid

    # -- cutting -----------------------------------------------------------------------------------------

    def _arrange(self) -> list[list[Use]]:
        both = [curve.ends for curve in self.curves]
        # In order of place: which of two near ends the node takes must not depend on the order of writing.
        for p in sorted(p for pair in both for p in pair):
            self.node(p)
        cuts = [[(0.0, self.node(start)), (1.0, self.node(end))] for start, end in both]
        own_ends = [(c[0][1], c[1][1]) for c in cuts]
        for curve, own in zip(self.curves, cuts, strict=True):
            if isinstance(curve, Bezier) and (loop := self_crossing(curve)) is not None:
                node, middle = self.node(curve.point(loop[0])), sum(loop) / 2
                own += [(loop[0], node), (middle, self.node(curve.point(middle))), (loop[1], node)]
        own_nodes = np.array(own_ends, dtype=np.intp).reshape(-1, 2)
        places = np.array(self.nodes).reshape(-1, 2)
        hulls = Hulls(self._table, self.tolerance)
        pairs = hulls.meeting(near_rows(self.boxes, self.tolerance), own_nodes, places)
        is_cubic = np.array([isinstance(curve, Bezier) for curve in self.curves], dtype=np.bool_)
        give_up(_PER_PAIR * np.count_nonzero(is_cubic[pairs].all(axis=1)))
        # One curve twice is not cut: its edges are shared.
        pairs = pairs[[self.curves[i] != self.curves[j] for i, j in pairs.tolist()]]
        for number, node in self._ends_on_others(hulls, pairs, own_nodes, places):
            t = self.curves[number].locate(self.nodes[node], self.tolerance)
            if t is not None:
                cuts[number].append((t, node))
        crossings = all_intersections(self._table, pairs, self.tolerance)
        for (i, j), found in zip(pairs.tolist(), crossings, strict=True):
            for t, s, p in found:
                node = self.node(p)
                for number, at in ((i, t), (j, s)):
                    if node not in own_ends[number]:
                        cuts[number].append((at, node))
        return [self._split(i, sorted(c)) for i, c in enumerate(cuts)]

    def _ends_on_others(
        self, hulls: Hulls, pairs: Ints, own_nodes: Ints, places: Floats
    ) -> Iterator[tuple[int, int]]:
        """Yields the curves that may pass an end of one they are paired with, and the node there."""
        for one, other in (pairs.T, pairs.T[::-1]):
            for side in (0, 1):
                node = own_nodes[one, side]
                is_new = (own_nodes[other] != node[:, None]).all(axis=1)
                if side:
                    is_new &= node != own_nodes[one, 0]
                is_new[is_new] = hulls.may_hold(other[is_new], places[node[is_new]])
                yield from zip(other[is_new].tolist(), node[is_new].tolist(), strict=True)

    def _split(self, number: int, cuts: list[tuple[float, int]]) -> list[Use]:
        """Returns the edges of a curve between cuts in order; a node that follows itself is kept once."""
        curve = self.curves[number]
        cuts = cuts[:1] + [b for a, b in pairwise(cuts) if b[1] != a[1]]
        if len(cuts) == 1:
            # Both ends in one node: a whole circle or ellipse, else too short to see.
            node = cuts[0][1]
            left, bottom, right, top = self.boxes[number]
            is_large = max(right - left, top - bottom) > 4 * self.tolerance
            whole = curve.is_closed or (not isinstance(curve, Line) and is_large)
            return [self._edge(number, 0.0, 1.0, node, node)] if whole else []
        return [self._edge(number, t0, t1, a, b) for (t0, a), (t1, b) in pairwise(cuts)]

    def _edge(self, number: int, t0: float, t1: float, start: int, end: int) -> Use:
        """Returns the edge for this part of a curve: the one that lies there already, or a new one."""
        curve = self.curves[number]
        middle = -1 if isinstance(curve, Line) else self._middles.number(curve.point((t0 + t1) / 2))
        key = (min(start, end), max(start, end), middle)
        known = self._known.get(key)
        if known is not None:
            edge = self.edges[known]
            return known, self._same_way(edge, number, t0, t1, start)
        self._known[key] = len(self.edges)
        self.edges.append(Edge(number, t0, t1, start, end))
        return len(self.edges) - 1, True

    def _same_way(self, edge: Edge, number: int, t0: float, t1: float, start: int) -> bool:
        if edge.start != edge.end:
            return edge.start == start
        early = self.curves[number].point(t0 + (t1 - t0) / 8)
        ways = (edge.t1 - edge.t0) / 8
        first, last = (self.curves[edge.curve].point(t) for t in (edge.t0 + ways, edge.t1 - ways))
        return math.dist(early, first) <= math.dist(early, last)

    # -- polylines and the way back ------------------------------------------------------------------------

    def _draw_polylines(self) -> None:
        """Finds the points in each edge, and sorts all grid points with their edge (-1 for nodes)."""
        edges, curves = self.edges, self.curves
        chords = [self.size * (FINE_CHORD if e.curve in self._fine else CHORD) for e in edges]
        counts = [
            min(curves[e.curve].chords(chord, e.t1 - e.t0, math.tau / 32), _MOST_CHORDS)
            for e, chord in zip(edges, chords, strict=True)
        ]
        inner = self._sizes = np.array(counts, dtype=np.intp) - 1
        begins = np.cumsum(inner) - inner
        number = np.repeat(np.arange(len(edges)), inner)
        share = (np.arange(1, len(number) + 1) - begins[number]) / (inner[number] + 1)
        parts = np.array([(e.curve, e.t0, e.t1 - e.t0) for e in edges]).reshape(-1, 3)[number]
        spots = self._table.at(parts[:, 0].astype(np.intp), parts[:, 1] + parts[:, 2] * share)[0]
        nodes = np.array(self.nodes, dtype=float).reshape(-1, 2)
        self._grid = self._steps(np.concatenate((nodes, spots)))
        self._offset = begins + len(nodes) if edges else np.zeros(1, dtype=np.intp)
        self.node_grid = self._grid[: len(nodes)]
        keys, owner = pack(self._grid), np.concatenate((np.full(len(nodes), -1), number))
        order = np.lexsort((owner, keys))
        self._keys, self._owner, self._number = keys[order], owner[order], order
        self._sides: tuple[Ints, Sides] | None = None
        self.straight: dict[tuple[int, int], int] = {}  # the line edge between two nodes
        for k in np.flatnonzero(inner == 0).tolist():
            edge = edges[k]
            self.straight[edge.start, edge.end] = self.straight[edge.end, edge.start] = k

    def first(self, use: Use) -> int:
        """Returns the node at which the use of an edge begins."""
        edge = self.edges[use[0]]
        return edge.start if use[1] else edge.end

    def last(self, use: Use) -> int:
        """Returns the node at which the use of an edge ends."""
        return self.first((use[0], not use[1]))

    def inner(self, use: Use) -> Ints:
        """Returns the grid points strictly between the ends of an edge, in the direction of the use."""
        begin = self._offset[use[0]]
        found = self._grid[begin : begin + self._sizes[use[0]]]
        return found if use[1] else found[::-1]

    def refine(self) -> None:
        """Cuts the curves finer whose chords crossed."""
        self._fine |= self.blurred
        self.blurred = set()
        self._draw_polylines()

    def polyline(self, uses: Sequence[Use]) -> Floats:
        """Returns the closed polygon through these edges, in grid units as Manifold takes them."""
        rows: list[Ints] = []
        for use in uses:
            node = self.first(use)
            rows += [self.node_grid[node : node + 1], self.inner(use)]
        return np.concatenate(rows).astype(np.float64) * GRID

    def meeting(self, numbers: Iterable[int]) -> Counter[int]:
        """Returns how many of some curves go through each node."""
        uses = ([self.edges[edge] for edge, _ in self.uses[number]] for number in numbers)
        return Counter(node for own in uses for node in {n for edge in own for n in (edge.start, edge.end)})

    def piece(self, use: Use) -> Piece:
        """Returns the part of its curve that runs along an edge, in the direction of the use."""
        edge = self.edges[use[0]]
        t0, t1 = (edge.t0, edge.t1) if use[1] else (edge.t1, edge.t0)
        return self.curves[edge.curve].part(t0, t1, self.nodes[self.first(use)], self.nodes[self.last(use)])

    def midpoints(self, numbers: Sequence[int]) -> Floats:
        """Returns a point about halfway along each of some edges, in grid units."""
        edges = np.array(numbers, dtype=np.intp)
        count = self._sizes[edges]
        nodes = [(self.edges[k].start, self.edges[k].end) for k in numbers]
        straight = self.node_grid[np.array(nodes, dtype=np.intp).reshape(-1, 2)].sum(axis=1) * (GRID / 2)
        inner = self._grid[np.where(count, self._offset[edges] + count // 2, 0)] * GRID
        return np.where(count[:, None] > 0, inner, straight)

    def look_up(self, polygon: Floats) -> tuple[Ints, Ints]:
        """Returns for each vertex of a result the edge it lies inside of, and its place there.

        For a node the edge is NODE and the place its number; for a vertex of no edge it is UNKNOWN.
        """
        keys = pack(np.rint(polygon / GRID).astype(np.int64))
        at = np.minimum(np.searchsorted(self._keys, keys), len(self._keys) - 1)
        owner = np.where(self._keys[at] == keys, self._owner[at], UNKNOWN)
        place = self._number[at] - np.where(owner >= 0, self._offset[np.maximum(owner, 0)], 0)
        return owner, place

    def position(self, vertex: Floats) -> Vec:
        """Returns a vertex of a result in millimetres."""
        x, y = vertex / self.scale + np.array(self.middle)
        return float(x), float(y)

    def nearest_edges(self, spots: Floats) -> Ints:
        """Returns for each spot on a result the edge whose polyline passes nearest."""
        numbers, sides = self._all_sides()
        return numbers[sides.nearest(spots, 4 * GRID)]

    def blur(self, vertices: Floats) -> None:
        """Notes the curves whose chords pass a vertex that none of them owns."""
        numbers, sides = self._all_sides()
        _, near, _ = sides.near(vertices, 4 * GRID)
        found = {*numbers[near].tolist(), *self.nearest_edges(vertices).tolist()}
        self.blurred |= {self.edges[k].curve for k in found}
        if self.may_refine and self.blurred - self._fine:
            raise TooCoarse

    def _all_sides(self) -> tuple[Ints, Sides]:
        if self._sides is None:
            lines = []
            for number, edge in enumerate(self.edges):
                nodes = self.node_grid[[edge.start, edge.end]]
                line = np.concatenate((nodes[:1], self.inner((number, True)), nodes[1:])) * GRID
                lines.append(np.concatenate((line[:-1], line[1:]), axis=1))
            numbers = np.repeat(np.arange(len(lines)), [len(line) for line in lines])
            self._sides = numbers, Sides(np.concatenate(lines))
        return self._sides


def with_finer_chords(network: Network, work: Callable[[Network], T]) -> T:
    """Returns the result of work, done again with finer chords while curves come too close for them."""
    network.may_refine = True
    while True:
        checkpoint()
        try:
            result = work(network)
        except TooCoarse:
            network.refine()
        else:
            network.may_refine = False
            return result


def pack(grid: Ints) -> Ints:
    """Returns one number for each grid point; coordinates have at most 32 bits."""
    return (grid[:, 0] << 32) + grid[:, 1]

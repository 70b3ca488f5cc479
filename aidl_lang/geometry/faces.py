"""The faces that a structure draws itself.

A closed geometry (a circle, a compound shape) is filled by itself, its nested loops alternating.
Free-standing curves are chained across names: what lies inside their outlines is filled, dangling ends are
trimmed. Free curves that close only together with the outline of a closed geometry (an arc on top of a
rectangle) add what they enclose outside of it.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import field

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.network import Network, Use, with_finer_chords
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.sections import Section, difference, fill, inside_mask, is_nothing, union
from aidl_lang.geometry.solved import SolvedGeometry
from aidl_lang.geometry.tessellate import polygon_area
from aidl_lang.geometry.trace import trace
from aidl_lang.geometry.tracing import CONTOURS, Crossing, enclosed


@record()
class Shape:
    """A named geometry of a structure: its primitives that have curves, with the numbers of these in the
    network.
    """

    geometry: SolvedGeometry
    leaves: tuple[tuple[SolvedGeometry, int], ...]

    @property
    def numbers(self) -> list[int]:
        return [number for _, number in self.leaves]


@record()
class OwnFace:
    """The area that one named geometry, or some free curves together, enclose."""

    geometries: tuple[SolvedGeometry, ...]
    section: Section


@record(frozen=False)
class OwnFaces:
    """The faces of a structure, the primitives that bound none, and imported outlines that cross
    themselves.
    """

    faces: list[OwnFace] = field(default_factory=list)
    loose: list[tuple[SolvedGeometry, int]] = field(default_factory=list)
    crossed: list[Crossing] = field(default_factory=list)


def own_faces(network: Network, shapes: Sequence[Shape]) -> OwnFaces:
    """Returns the faces of the shapes of one structure, in order of writing, those of free curves after
    them.
    """
    result = OwnFaces()
    free: list[tuple[SolvedGeometry, int]] = []
    outlines: list[Use] = []
    for shape in shapes:
        uses = [use for number in shape.numbers for use in network.uses[number]]
        closed = _is_closed(network, shape, uses)
        kept = _without_dangling(network, uses) if closed else []
        if kept:
            section, crossed = _area(network, shape, kept)
            result.crossed += crossed
            if is_nothing(section):  # flat, or twice the same outline
                result.loose += shape.leaves
            else:
                result.faces.append(OwnFace((shape.geometry,), section))
            outlines += kept
        used = {edge for edge, _ in kept} - _bridges(network, kept)
        free += [leaf for leaf in shape.leaves if not _touches(network, leaf[1], used)]
    if free:
        _chain_free(network, free, outlines, result)
    return result


def _area(network: Network, shape: Shape, uses: list[Use]) -> tuple[Section, list[Crossing]]:
    """Returns what a closed shape encloses by these edges of it, and what of it crosses itself."""
    files = {part.path: part for part in shape.geometry.walk() if part.type in CONTOURS}
    if not files:
        return union([_alternating(network, uses) for uses in _by_letter(network, shape, uses)]), []
    numbers: dict[str, list[int]] = defaultdict(list)
    for leaf, number in shape.leaves:
        numbers[leaf.path.rpartition(".")[0]].append(number)
    contours = ((part, numbers[path]) for path, part in files.items())
    return enclosed(network, contours, set(uses), _alternating)


def _by_letter(network: Network, shape: Shape, uses: list[Use]) -> Iterator[list[Use]]:
    """Yields what alternates by itself: each letter of a text, as letters may overlap."""
    letters = [part for part in shape.geometry.walk() if part.type == "glyph"]
    if len(letters) < 2:
        yield uses
        return
    letter_of = {id(leaf): k for k, letter in enumerate(letters) for leaf in letter.walk()}
    closed = set(uses)
    parts: dict[int | None, list[Use]] = defaultdict(list)
    for leaf, number in shape.leaves:
        parts[letter_of.get(id(leaf))] += [use for use in network.uses[number] if use in closed]
    yield from parts.values()


def _is_closed(network: Network, shape: Shape, uses: list[Use]) -> bool:
    """Tells whether the shape may be a face by itself: not a single open curve."""
    if shape.geometry.parts or len(shape.leaves) > 1:
        return True
    return bool(uses) and first_node(network, uses[0]) == last_node(network, uses[-1])


def _touches(network: Network, curve: int, edges: set[int]) -> bool:
    return any(edge in edges for edge, _ in network.uses[curve])


def first_node(network: Network, use: Use) -> int:
    """Returns the node at which the use of an edge begins."""
    edge = network.edges[use[0]]
    return edge.start if use[1] else edge.end


def last_node(network: Network, use: Use) -> int:
    """Returns the node at which the use of an edge ends."""
    return first_node(network, (use[0], not use[1]))


def _without_dangling(network: Network, uses: Iterable[Use]) -> list[Use]:
    """Returns the edges without those that lead to an open end, removed repeatedly."""
    kept = list(uses)
    while True:
        degree = _degrees(network, kept)
        if min(degree.values(), default=2) > 1:
            return kept
        ends = ((use, network.edges[use[0]]) for use in kept)
        kept = [use for use, edge in ends if degree[edge.start] > 1 and degree[edge.end] > 1]


def _degrees(network: Network, uses: Iterable[Use]) -> Counter[int]:
    """Returns how many edges end in each node."""
    edges = [network.edges[number] for number, _ in uses]
    return Counter([*(edge.start for edge in edges), *(edge.end for edge in edges)])


def _bridges(network: Network, uses: Sequence[Use]) -> set[int]:
    """Returns the edges that join loops and bound no face, but for those that are run through twice. There
    are none where every node has an even degree.
    """
    if not any(d % 2 for d in _degrees(network, uses).values()):
        return set()
    _, bounding = _outlines(network, uses)
    return {edge for edge, count in Counter(edge for edge, _ in uses).items() if count == 1} - bounding


def _alternating(network: Network, uses: list[Use]) -> Section:
    """Returns the loops of one shape under the even-odd rule; where a node has an odd degree, all that is
    enclosed.
    """
    if any(d % 2 for d in _degrees(network, uses).values()):
        return fill(_outlines(network, uses)[0], "NonZero")
    return fill([network.polyline(loop) for loop in _loops(network, uses)], "EvenOdd")


def _loops(network: Network, uses: list[Use]) -> list[list[Use]]:
    """Returns closed walks that use every edge once; every node has an even degree."""
    ways: dict[int, list[Use]] = defaultdict(list)
    for edge, forward in reversed(uses):
        ways[first_node(network, (edge, forward))].append((edge, forward))
        ways[last_node(network, (edge, forward))].append((edge, not forward))
    left: dict[int, int] = defaultdict(int)
    for edge, _ in uses:
        left[edge] += 1
    loops = []
    for use in uses:
        if left[use[0]]:
            loops.append(_walk(network, use, ways, left))
    return loops


def _walk(network: Network, first: Use, ways: dict[int, list[Use]], left: dict[int, int]) -> list[Use]:
    """Returns the loop of edges from the first onwards until its start comes round again."""
    loop = [first]
    left[first[0]] -= 1
    while (node := last_node(network, loop[-1])) != first_node(network, first):
        following = next(use for use in ways[node] if left[use[0]])
        left[following[0]] -= 1
        loop.append(following)
    return loop


def _outlines(network: Network, uses: Iterable[Use]) -> tuple[list[NDArray[np.float64]], set[int]]:
    """Returns the outer outline of each connected part of a planar graph, and the edges that bound some face
    of it.

    Walks the graph keeping the face on the left, turning at each node to the next way clockwise.
    """
    edges = list(dict.fromkeys(edge for edge, _ in uses))
    turn = _next_clockwise(network, edges)
    cycle_of: dict[Use, int] = {}
    polygons: list[NDArray[np.float64]] = []
    for start in ((edge, forward) for edge in edges for forward in (True, False)):
        if start in cycle_of:
            continue
        cycle, use = [], start
        while use not in cycle_of:
            cycle_of[use] = len(polygons)
            cycle.append(use)
            use = turn[use]
        polygons.append(network.polyline(cycle))
    bounding = {edge for edge in edges if cycle_of[edge, True] != cycle_of[edge, False]}
    return [p[::-1] for p in polygons if polygon_area(p) < 0], bounding


def _next_clockwise(network: Network, edges: list[int]) -> dict[Use, Use]:
    """Returns for each way along an edge the next one, clockwise at its end."""
    leaving: dict[int, list[tuple[float, Use]]] = defaultdict(list)
    for edge in edges:
        for forward in (True, False):
            use = (edge, forward)
            leaving[first_node(network, use)].append((_direction(network, use), use))
    turn: dict[Use, Use] = {}
    for ways in leaving.values():
        around = [use for _, use in sorted(ways)]
        for k, (edge, forward) in enumerate(around):
            turn[edge, not forward] = around[k - 1]
    return turn


def _direction(network: Network, use: Use) -> float:
    """Returns the angle at which the polyline of an edge leaves its start."""
    inner = network.inner(use)
    target = inner[0] if len(inner) else network.node_grid[last_node(network, use)]
    dx, dy = target - network.node_grid[first_node(network, use)]
    return math.atan2(dy, dx)


def _chain_free(
    network: Network, free: list[tuple[SolvedGeometry, int]], outlines: list[Use], result: OwnFaces
) -> None:
    """Faces of free curves, first by themselves, then together with the outlines of closed shapes."""
    uses = [use for _, number in free for use in network.uses[number]]
    kept = _without_dangling(network, uses)
    used: set[int] = set()
    for part in _connected(network, kept):
        polygons, bounding = _outlines(network, part)
        section = fill(polygons, "NonZero")
        if not is_nothing(section):
            names = tuple(g for g, number in free if _touches(network, number, bounding))
            result.faces.append(OwnFace(names, section))
            used |= bounding
    rest = [leaf for leaf in free if not _touches(network, leaf[1], used)]
    if rest and outlines:
        used |= _close_with_outlines(network, rest, outlines, result)
    result.loose += [leaf for leaf in rest if not _touches(network, leaf[1], used)]


def _close_with_outlines(
    network: Network, rest: list[tuple[SolvedGeometry, int]], outlines: list[Use], result: OwnFaces
) -> set[int]:
    """Adds the areas that the remaining curves enclose outside the closed shapes; returns the edges that took
    part.
    """
    uses = [use for _, number in rest for use in network.uses[number]]
    together, bounding = _outlines(network, _without_dangling(network, [*uses, *outlines]))
    hull, _ = _outlines(network, outlines)
    added = difference(fill(together, "NonZero"), fill(hull, "NonZero"))
    if is_nothing(added):
        return set()
    boundary = trace(network, added).edges
    edges = [e for e in dict.fromkeys(e for e, _ in uses) if e in bounding]
    within = inside_mask(added, network.midpoints(edges))
    used = {e for e, is_inside in zip(edges, within, strict=True) if is_inside or e in boundary}
    names = tuple(g for g, number in rest if _touches(network, number, used))
    if names:
        result.faces.append(OwnFace(names, added))
    return used


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


def _connected(network: Network, uses: list[Use]) -> list[list[Use]]:
    """Returns the uses by connected part, in order of first mention."""
    joined = Joined()
    for use in uses:
        joined.join(first_node(network, use), last_node(network, use))
    parts: dict[object, list[Use]] = defaultdict(list)
    for use in uses:
        parts[joined.root(first_node(network, use))].append(use)
    return list(parts.values())


def region_of(
    geometry: Iterable[tuple[SolvedGeometry, Sequence[tuple[SolvedGeometry, Piece]]]],
) -> tuple[Region, list[SolvedGeometry]]:
    """Returns the region that geometries enclose together, each given with its primitives and their curves,
    and the primitives that bound nothing.
    """
    curves: list[Piece] = []
    shapes = []
    for g, leaves in geometry:
        shapes.append(Shape(g, tuple((leaf, k) for k, (leaf, _) in enumerate(leaves, len(curves)))))
        curves += [curve for _, curve in leaves]
    if not curves:
        return Region(), []
    network = Network(curves)

    def traced() -> tuple[Region, list[SolvedGeometry]]:
        found = own_faces(network, shapes)
        return trace(network, union_of(found.faces)).region, [leaf for leaf, _ in found.loose]

    return with_finer_chords(network, traced)


def union_of(faces: Iterable[OwnFace]) -> Section:
    """Returns all faces united."""
    return union([face.section for face in faces])

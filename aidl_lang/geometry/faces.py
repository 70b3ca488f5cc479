"""The faces that a structure draws itself."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang.building.model import Geometry
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import (
    Arc,
    Bezier,
    Circle,
    Ellipse,
    EllipseArc,
    Line,
    Piece,
    Vec,
    image,
    in_runs,
)
from aidl_lang.geometry.network import Joined, Network, Use, with_finer_chords
from aidl_lang.geometry.region import Polygon, Region, polygon_area
from aidl_lang.geometry.sections import Section, fill, union
from aidl_lang.geometry.solved import Scalar, SolvedGeometry, Values, described

if TYPE_CHECKING:
    from aidl_lang.common.drawings import Element, Stroke

# --- Outlines of drawings of other programs, as exact curves, and what they enclose.
#
# A shape of a file is filled by its own rule, and shapes that cross are united. What lies in another without
# crossing it alternates, as the outlines of parts do: a circle in a plate is a hole, and one in that is
# material again.

WINDING = "winding_contours"
CONTOURS = ("contours", WINDING)
ENGRAVED = "engraved_contours"
"""The types of a part that is one shape of a file: filled by alternation, or by the non-zero rule."""

Crossing: TypeAlias = tuple[SolvedGeometry, tuple[Vec, ...]]
"""A shape of a file, and the places where it crosses itself."""

_ROUND = 1e-8
"""Difference of the radii of an ellipse, relative to them, below which it is a circle."""
_FLAT = 1e-12


def curve_of(stroke: Stroke) -> Piece:
    """Returns the exact curve of a stroke."""
    if isinstance(stroke, tuple):
        return Line(*stroke) if len(stroke) == 2 else Bezier(*stroke)
    (ux, uy), (vx, vy) = stroke.u, stroke.v
    # Conjugate half-diameters become those of the axes by a shift of the parameter.
    shift = 0.5 * math.atan2(2 * (ux * vx + uy * vy), ux * ux + uy * uy - vx * vx - vy * vy)
    c, s = math.cos(shift), math.sin(shift)
    long, short = (ux * c + vx * s, uy * c + vy * s), (vx * c - ux * s, vy * c - uy * s)
    sense = math.copysign(1.0, long[0] * short[1] - long[1] * short[0])
    rx, ry = math.hypot(*long), math.hypot(*short)
    if ry <= _FLAT * rx:
        return Line(stroke.start, stroke.end)
    angle, sweep = math.atan2(long[1], long[0]), sense * stroke.sweep
    if rx - ry <= _ROUND * rx:
        radius = (rx + ry) / 2
        if stroke.is_whole:
            return Circle(stroke.center, radius)
        return Arc(stroke.center, radius, stroke.start, stroke.end, sweep)
    if stroke.is_whole:
        return Ellipse(stroke.center, rx, ry, angle)
    first = sense * (stroke.first - shift)
    return EllipseArc(stroke.center, rx, ry, angle, stroke.start, stroke.end, first, sweep)


def parts_of(
    g: Geometry, at: Callable[[Vec], Vec], unit: float, direction: float, sense: float
) -> tuple[SolvedGeometry, ...]:
    """Returns the shapes of a drawing in place, each with its curves as parts. `at` maps points, `unit` is
    that of lengths, `direction` the turn in radians, and `sense` negative if it is turned over.
    """
    assert g.trace is not None

    def turned(angle: float) -> float:
        return direction + sense * angle

    return tuple(
        _contours(
            g,
            f"{element.names[-1] if element.names else g.trace.name}[{k}]",
            [image(curve_of(s), at, unit, turned, sense) for s in element.strokes],
            element,
        )
        for k, element in enumerate(g.trace.elements)
    )


def _contours(g: Geometry, name: str, curves: Sequence[Piece], element: Element) -> SolvedGeometry:
    checkpoint()
    edges = as_edges(g, curves, f"{name}.")
    kind, is_filled = CONTOURS[element.is_winding], g.filled
    looks: dict[str, tuple[Scalar, ...]] = {}
    if (engraving := element.engraving) is not None:
        kind, is_filled = ENGRAVED, is_filled or engraving.is_area
        looks = {k: (v,) for k, v in (("layer", engraving.layer), ("color", engraving.color)) if v}
    known = name, f"{g.path}.{name}", kind, Values(), None, edges, g.construction, g.span
    return SolvedGeometry(*known, attributes=looks, filled=is_filled)


def as_edges(of: Geometry, curves: Iterable[Piece], within: str = "") -> tuple[SolvedGeometry, ...]:
    """Returns the curves that a primitive is made of; `within`: the part of it that they are parts of."""
    found = []
    for k, curve in enumerate(curves):
        (kind, values), name = described(curve), f"edge[{k}]"
        known = name, f"{of.path}.{within}{name}", kind, values, curve, (), of.construction, of.span
        found.append(SolvedGeometry(*known, piece_of=of.path))
    return tuple(found)


# --- What they enclose -----------------------------------------------------------------------------


def _enclosed(
    network: Network,
    shapes: Iterable[tuple[SolvedGeometry, Sequence[int]]],
    closed: set[Use],
) -> tuple[Section, list[Crossing]]:
    """Returns the area of shapes of a file, each given with the numbers of its curves, and those that cross
    themselves; `closed` are the edges that lead to no open end.
    """
    sections: list[Section] = []
    crossed: list[Crossing] = []
    nodes: list[set[int]] = []
    for shape, numbers in shapes:
        checkpoint()
        uses = [use for number in numbers for use in network.uses[number] if use in closed]
        if not uses:
            continue
        if shape.type == WINDING:
            walks = [network.polyline(walk) for walk in _walks(network, uses)]
            sections.append(fill(walks, "NonZero", network))
        else:
            sections.append(_alternating(network, uses))
        nodes.append(set(_ends(network, uses)))
        if places := _crossings(network, uses):
            crossed.append((shape, tuple(network.nodes[node] for node in places)))
    groups = [union([sections[k] for k in group]) for group in _crossing(sections, nodes)]
    polygons = [polygon for group in groups for polygon in group.to_polygons()]
    return fill(polygons, "EvenOdd", network), crossed


def _ends(network: Network, uses: Iterable[Use]) -> Iterator[int]:
    for number, _ in uses:
        edge = network.edges[number]
        yield edge.start
        yield edge.end


def _crossings(network: Network, uses: Sequence[Use]) -> list[int]:
    """Returns the nodes that one contour passes more than once."""
    passed = (Counter(_ends(network, walk)) for walk in _walks(network, uses))
    return list(dict.fromkeys(node for ends in passed for node, count in ends.items() if count > 2))


def _walks(network: Network, uses: Iterable[Use]) -> list[list[Use]]:
    """Returns the runs of edges of which each begins where the one before it ends, as the file has them."""
    return in_runs(uses, lambda before, use: network.last(before) == network.first(use))


def _crossing(sections: Sequence[Section], nodes: Sequence[set[int]]) -> list[list[int]]:
    """Returns the numbers of sections in groups of those that cross one another, directly or by others."""
    owners: Mapping[int, list[int]] = defaultdict(list)
    for k, own in enumerate(nodes):
        for node in own:
            owners[node].append(k)
    pairs = {(i, j) for at in owners.values() for i in at for j in at if i < j}
    joined = Joined()
    for i, j in sorted(pairs):
        if joined.root(i) != joined.root(j) and _cross(sections[i], sections[j]):
            joined.join(i, j)
    return joined.groups(range(len(sections)))


def _cross(a: Section, b: Section) -> bool:
    """Tells whether two areas have something in common, and each something that the other has not."""
    checkpoint()
    if not a.overlaps(b):
        return False
    return not (a - b).is_nothing and not (b - a).is_nothing


# --- A closed geometry (a circle, a compound shape) is filled by itself, its nested loops alternating. Free-
# standing curves are chained across names: what lies inside their outlines is filled, dangling ends are
# trimmed. Free curves that close only together with the outline of a closed geometry (an arc on top of a
# rectangle) add what they enclose outside of it.


@record()
class Shape:
    """A named geometry of a structure: its primitives with curves, and their numbers in the network."""

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
    """The faces of a structure, primitives that bound none, and imported outlines that cross themselves."""

    faces: list[OwnFace] = field(default_factory=list)
    loose: list[tuple[SolvedGeometry, int]] = field(default_factory=list)
    crossed: list[Crossing] = field(default_factory=list)


def own_faces(network: Network, shapes: Sequence[Shape]) -> OwnFaces:
    """Returns the faces of the shapes of a structure in order of writing, those of free curves last."""
    result = OwnFaces()
    free: list[tuple[SolvedGeometry, int]] = []
    outlines: list[Use] = []
    for shape in shapes:
        uses = [use for number in shape.numbers for use in network.uses[number]]
        is_curve = not shape.geometry.parts and len(shape.leaves) == 1
        is_open = is_curve and uses and network.first(uses[0]) != network.last(uses[-1])
        kept = [] if is_open else _without_dangling(network, uses)
        if kept:
            section, crossed = _area(network, shape, kept)
            result.crossed += crossed
            if section.is_nothing:  # flat, or twice the same outline
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
    return _enclosed(network, contours, set(uses))


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


def _touches(network: Network, curve: int, edges: set[int]) -> bool:
    return any(edge in edges for edge, _ in network.uses[curve])


def _without_dangling(network: Network, uses: Iterable[Use]) -> list[Use]:
    """Returns the edges without those that lead to an open end, removed repeatedly."""
    kept = list(uses)
    while True:
        degree = Counter(_ends(network, kept))
        if min(degree.values(), default=2) > 1:
            return kept
        ends = ((use, network.edges[use[0]]) for use in kept)
        kept = [use for use, edge in ends if degree[edge.start] > 1 and degree[edge.end] > 1]


def _has_odd_node(network: Network, uses: Iterable[Use]) -> bool:
    return any(degree % 2 for degree in Counter(_ends(network, uses)).values())


def _bridges(network: Network, uses: Sequence[Use]) -> set[int]:
    """Returns the edges that join loops and bound no face, but for those that are run through twice. There
    are none where every node has an even degree.
    """
    if not _has_odd_node(network, uses):
        return set()
    _, bounding = _outlines(network, uses)
    return {edge for edge, count in Counter(edge for edge, _ in uses).items() if count == 1} - bounding


def _alternating(network: Network, uses: list[Use]) -> Section:
    """Returns the loops of one shape by the even-odd rule; at a node of odd degree, all enclosed."""
    if _has_odd_node(network, uses):
        return fill(_outlines(network, uses)[0], "NonZero", network)
    return fill([network.polyline(loop) for loop in _loops(network, uses)], "EvenOdd", network)


def _loops(network: Network, uses: list[Use]) -> list[list[Use]]:
    """Returns closed walks that use every edge once; every node has an even degree."""
    ways: dict[int, list[Use]] = defaultdict(list)
    for edge, forward in reversed(uses):
        ways[network.first((edge, forward))].append((edge, forward))
        ways[network.last((edge, forward))].append((edge, not forward))
    left = Counter(edge for edge, _ in uses)
    loops = []
    for first in uses:
        if not left[first[0]]:
            continue
        loop = [first]
        left[first[0]] -= 1
        while (node := network.last(loop[-1])) != network.first(first):
            following = next(use for use in ways[node] if left[use[0]])
            left[following[0]] -= 1
            loop.append(following)
        loops.append(loop)
    return loops


def _outlines(network: Network, uses: Iterable[Use]) -> tuple[list[Polygon], set[int]]:
    """Returns the outer outline of each connected part of a planar graph, and the edges that bound some face
    of it.

    Walks the graph keeping the face on the left, turning at each node to the next way clockwise.
    """
    edges = list(dict.fromkeys(edge for edge, _ in uses))
    turn = _next_clockwise(network, edges)
    cycle_of: dict[Use, int] = {}
    polygons: list[Polygon] = []
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
            inner, node = network.inner(use), network.first(use)
            target = inner[0] if len(inner) else network.node_grid[network.last(use)]
            dx, dy = target - network.node_grid[node]
            leaving[node].append((math.atan2(dy, dx), use))
    turn: dict[Use, Use] = {}
    for ways in leaving.values():
        around = [use for _, use in sorted(ways)]
        for k, (edge, forward) in enumerate(around):
            turn[edge, not forward] = around[k - 1]
    return turn


def _chain_free(
    network: Network, free: list[tuple[SolvedGeometry, int]], outlines: list[Use], result: OwnFaces
) -> None:
    """Faces of free curves, first by themselves, then together with the outlines of closed shapes."""
    uses = [use for _, number in free for use in network.uses[number]]
    kept = _without_dangling(network, uses)
    used: set[int] = set()
    joined = Joined()
    for use in kept:
        joined.join(network.first(use), network.last(use))
    for part in joined.groups(kept, lambda use: network.first(use)):
        polygons, bounding = _outlines(network, part)
        section = fill(polygons, "NonZero", network)
        if not section.is_nothing:
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
    """Adds what the other curves enclose outside the closed shapes; returns the edges with a part in it."""
    uses = [use for _, number in rest for use in network.uses[number]]
    together, bounding = _outlines(network, _without_dangling(network, [*uses, *outlines]))
    hull, _ = _outlines(network, outlines)
    added = fill(together, "NonZero", network) - fill(hull, "NonZero", network)
    if added.is_nothing:
        return set()
    boundary = added.edges
    edges = [e for e in dict.fromkeys(e for e, _ in uses) if e in bounding]
    within = added.mask(network.midpoints(edges))
    used = {e for e, is_inside in zip(edges, within, strict=True) if is_inside or e in boundary}
    names = tuple(g for g, number in rest if _touches(network, number, used))
    if names:
        result.faces.append(OwnFace(names, added))
    return used


def region_of(
    geometry: Iterable[tuple[SolvedGeometry, Sequence[tuple[SolvedGeometry, Piece]]]],
) -> tuple[Region, list[SolvedGeometry]]:
    """Returns the region of geometries with their primitives, and primitives that bound nothing."""
    curves: list[Piece] = []
    shapes = []
    for g, leaves in geometry:
        shapes.append(Shape(g, tuple((leaf, k) for k, (leaf, _) in enumerate(leaves, len(curves)))))
        curves += [curve for _, curve in leaves]
    if not curves:
        return Region(), []

    def traced(network: Network) -> tuple[Region, list[SolvedGeometry]]:
        found = own_faces(network, shapes)
        return union_of(found.faces).region, [leaf for leaf, _ in found.loose]

    return with_finer_chords(Network(curves), traced)


def union_of(faces: Iterable[OwnFace]) -> Section:
    """Returns all faces united."""
    return union([face.section for face in faces])

"""Outlines of drawings of other programs, as exact curves, and what they enclose.

A shape of a file is filled by its own rule, and shapes that cross are united. What lies in another without
crossing it alternates, as the outlines of parts do: a circle in a plate is a hole, and one in that is
material again.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TypeAlias

from aidl_lang.building.model import Geometry
from aidl_lang.common.drawings.drawing import Element
from aidl_lang.common.drawings.strokes import Bow, Stroke
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line, Piece, Vec, image
from aidl_lang.geometry.described import described
from aidl_lang.geometry.network import Joined, Network, Use
from aidl_lang.geometry.sections import Section, difference, fill, intersection, is_nothing, union
from aidl_lang.geometry.solved import Scalar, SolvedGeometry

_WINDING = "winding_contours"
CONTOURS = ("contours", _WINDING)
ENGRAVED = "engraved_contours"
"""The types of a part that is one shape of a file: filled by alternation, or by the non-zero rule."""

Crossing: TypeAlias = tuple[SolvedGeometry, tuple[Vec, ...]]
"""A shape of a file, and the places where it crosses itself."""

_ROUND = 1e-8
"""Difference of the radii of an ellipse, relative to them, below which it is a circle."""
_FLAT = 1e-12


# --- Curves ----------------------------------------------------------------------------------------


def curve_of(stroke: Stroke) -> Piece:
    """Returns the exact curve of a stroke."""
    if not isinstance(stroke, Bow):
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
    path = f"{g.path}.{name}"

    def edge(k: int, curve: Piece) -> SolvedGeometry:
        kind, values = described(curve)
        own = f"edge[{k}]"
        return SolvedGeometry(
            own, f"{path}.{own}", kind, values, curve, (), g.construction, g.span, piece_of=g.path
        )

    edges = tuple(edge(k, curve) for k, curve in enumerate(curves))
    kind, is_filled = CONTOURS[element.is_winding], g.filled
    looks: dict[str, tuple[Scalar, ...]] = {}
    if (engraving := element.engraving) is not None:
        kind, is_filled = ENGRAVED, is_filled or engraving.is_area
        looks = {k: (v,) for k, v in (("layer", engraving.layer), ("color", engraving.color)) if v}
    made = SolvedGeometry(name, path, kind, {}, None, edges, g.construction, g.span, filled=is_filled)
    return replace(made, attributes=looks)


def is_winding(shape: SolvedGeometry) -> bool:
    """Tells whether a shape of a file is filled by the non-zero rule."""
    return shape.type == _WINDING


# --- What they enclose -----------------------------------------------------------------------------


def enclosed(
    network: Network,
    shapes: Iterable[tuple[SolvedGeometry, Sequence[int]]],
    closed: set[Use],
    alternating: Callable[[Network, list[Use]], Section],
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
        if is_winding(shape):
            sections.append(fill([network.polyline(loop) for loop in _walks(network, uses)], "NonZero"))
        else:
            sections.append(alternating(network, uses))
        nodes.append(set(_ends(network, uses)))
        if places := _crossings(network, uses):
            crossed.append((shape, tuple(network.nodes[node] for node in places)))
    groups = [union([sections[k] for k in group]) for group in _crossing(sections, nodes)]
    return fill([polygon for group in groups for polygon in group.to_polygons()], "EvenOdd"), crossed


def _ends(network: Network, uses: Iterable[Use]) -> Iterator[int]:
    for number, _ in uses:
        yield network.edges[number].start
        yield network.edges[number].end


def _crossings(network: Network, uses: Sequence[Use]) -> list[int]:
    """Returns the nodes that one contour passes more than once."""
    passed = (Counter(_ends(network, walk)) for walk in _walks(network, uses))
    return list(dict.fromkeys(node for ends in passed for node, count in ends.items() if count > 2))


def _walks(network: Network, uses: Sequence[Use]) -> Iterator[list[Use]]:
    """Yields the runs of edges of which each begins where the one before it ends, as the file has them."""
    walk: list[Use] = []
    here = -1
    for number, forward in uses:
        edge = network.edges[number]
        start, end = (edge.start, edge.end) if forward else (edge.end, edge.start)
        if walk and start != here:
            yield walk
            walk = []
        walk.append((number, forward))
        here = end
    yield walk


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
    if is_nothing(intersection(a, b)):
        return False
    return not is_nothing(difference(a, b)) and not is_nothing(difference(b, a))

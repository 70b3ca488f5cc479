"""Outlines that cross themselves: their parts alternate, so what should be material may be open.

The crossings are those of the arrangement: nodes that a way goes through twice, changing sides.
"""

from __future__ import annotations

import math
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.prose import counted
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.geometry.curves import Line, Vec
from aidl_lang.geometry.evaluate import NO_LENGTH, derivative
from aidl_lang.geometry.faces import Shape, first_node, last_node
from aidl_lang.geometry.intersect import meet
from aidl_lang.geometry.network import Network, Use
from aidl_lang.geometry.notes import at, local
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure

_WAYS = frozenset({"path", "polygon", "polyline", "spline"})
"""Types of outlines that are drawn point by point."""
_FLAT = 1e-6
"""Angle in radians below which two ways run alike: they touch, or follow each other."""
_MOST_CORNERS = 24
"""Corners up to which an order without crossings is looked for."""


_NUMBER = r"[-+]?[\d.]+(?:mm|cm|m|in|ft)?"
_POINT = rf"\(\s*{_NUMBER}\s*,\s*{_NUMBER}\s*\)"
_POLYGON = re.compile(rf"polygon\(\s*(?:points\s*:\s*)?\[?((?:\s*{_POINT}\s*,?)+)")
_TURNED = re.compile(r"\b(wave_to|zigzag_to)\(")


@record()
class Crossing:
    """A place at which an outline crosses itself, and the parts of it that do."""

    place: Vec
    parts: tuple[SolvedGeometry, SolvedGeometry]


@record()
class _Pass:
    """Where a way goes through a node: the uses of edges by which it leaves, backwards and onwards."""

    node: int
    back: Use
    on: Use
    part: SolvedGeometry


def crossing_notes(
    network: Network, root: SolvedStructure, shapes: Mapping[str, Sequence[Shape]]
) -> list[Diagnostic]:
    """Returns a warning for each statement of closed outlines that cross themselves, in what is filled."""
    told: dict[object, Diagnostic] = {}
    paths: set[str] = set()
    for structure in root.walk():
        for shape in shapes[structure.path] if structure.kind != "drawing" else ():
            numbers = {id(leaf): number for leaf, number in shape.leaves}
            for way in _ways(shape.geometry):
                found = [c for ring in _rings(network, way, numbers) for c in _crossings(network, ring)]
                if found and way.source not in paths:
                    told.setdefault(way.span or way.path, _note(structure, way, found))
                if found:
                    paths.add(way.path)
    return list(told.values())


def _ways(geometry: SolvedGeometry) -> Iterator[SolvedGeometry]:
    """Yields the outlines in a geometry that are drawn point by point."""
    if geometry.type in _WAYS:
        yield geometry
        return
    for part in geometry.parts:
        yield from _ways(part)


def _rings(network: Network, way: SolvedGeometry, numbers: Mapping[int, int]) -> Iterator[list[_Pass]]:
    """Yields how each closed round of a way goes through its nodes."""
    leaves = [leaf for leaf in way.walk() if id(leaf) in numbers and network.uses[numbers[id(leaf)]]]
    ring: list[tuple[Use, SolvedGeometry]] = []
    for place, leaf in enumerate(leaves):
        uses = network.uses[numbers[id(leaf)]]
        if ring and last_node(network, ring[-1][0]) not in _ends(network, uses):
            yield from _closed(network, ring)
            ring = []
        if ring:
            is_turned = first_node(network, uses[0]) != last_node(network, ring[-1][0])
        else:  # a curve may be drawn against the way: the next one begins where it ends
            following = network.uses[numbers[id(leaves[place + 1])]] if place + 1 < len(leaves) else uses
            is_turned = last_node(network, uses[-1]) not in _ends(network, following)
        ring += [(use, leaf) for use in (map(_back, reversed(uses)) if is_turned else uses)]
    yield from _closed(network, ring)


def _closed(network: Network, ring: list[tuple[Use, SolvedGeometry]]) -> Iterator[list[_Pass]]:
    """Yields the passes of a round if it ends where it begins, and comes to a node twice."""
    nodes = {first_node(network, use) for use, _ in ring}
    if len(nodes) < len(ring) and first_node(network, ring[0][0]) == last_node(network, ring[-1][0]):
        rolled = [*ring[1:], ring[0]]
        yield [
            _Pass(first_node(network, on), _back(use), on, leaf)
            for (use, leaf), (on, _) in zip(ring, rolled, strict=True)
        ]


def _ends(network: Network, uses: Sequence[Use]) -> tuple[int, int]:
    return first_node(network, uses[0]), last_node(network, uses[-1])


def _back(use: Use) -> Use:
    return use[0], not use[1]


def _crossings(network: Network, ring: list[_Pass]) -> Iterator[Crossing]:
    """Yields where a closed round crosses itself, in the order of its way."""
    meeting: dict[int, list[_Pass]] = defaultdict(list)
    for one in ring:
        meeting[one.node].append(one)
    for one in ring:
        others = meeting[one.node]
        for other in others[others.index(one) + 1 :]:
            if _do_cross(network, one, other):
                # without what rounding left of a 0
                x, y = (0.0 if abs(c) < network.tolerance else c for c in network.nodes[one.node])
                yield Crossing((x, y), (one.part, other.part))


def _do_cross(network: Network, one: _Pass, other: _Pass) -> bool:
    """Tells whether two ways through a node change sides; what touches, or runs along, does not."""
    ways = (derivative(network.piece(use), 0) for use in (one.back, one.on, other.back, other.on))
    base, *rest = (math.atan2(dy, dx) for dx, dy in ways)
    on, *others = ((angle - base) % math.tau for angle in rest)
    if any(min(abs(a - b), math.tau - abs(a - b)) < _FLAT for a in others for b in (0.0, on)):
        return False
    return (others[0] < on) != (others[1] < on)


# --- What is said ---


def _note(structure: SolvedStructure, way: SolvedGeometry, found: Sequence[Crossing]) -> Diagnostic:
    first, *more = found
    one, other = (local(structure, part) for part in first.parts)
    times = f" {counted(len(found), 'time')}, first" if more else ""
    crosses = f"`{one}` crosses `{other}`" if one != other else f"`{one}` crosses itself"
    turned = _TURNED.search(way.span.text) if way.span and way.type == "path" else None
    amount = "amplitude" if turned and turned[1] == "wave_to" else "height"
    usual = (
        f"`{turned[1]}` goes first to the left of its way: turn the sign of `{amount}`, or make it smaller"
        if turned
        else "look at the order of the points: each must follow the one before it around the outline"
    )
    return Diagnostic(
        "W0728",
        f"`{local(structure, way)}` in {structure.kind} `{structure.path}` crosses itself{times} at "
        f"{at(first.place)}: {crosses}",
        way.span or structure.span,
        "its parts alternate between filled and open",
        hints=(usual, f'if that is meant, say so: `@allow("W0728")` before `{way.name}`'),
        fix=_order_fix(way) if way.type == "polygon" else None,
        points=tuple(crossing.place for crossing in found[:1]),
    )


def _order_fix(way: SolvedGeometry) -> Fix | None:
    """Returns the fix that swaps two neighbouring corners of a polygon of literals; None unless there is one
    polygon without crossings that is found so.
    """
    written = _POLYGON.search(way.span.text) if way.span else None
    sides = list(way.curves())
    corners = [side.start for side in sides if isinstance(side, Line)]
    literals = list(re.finditer(_POINT, written[1])) if written else []
    if not (written and way.span and len(literals) == len(corners) == len(sides) <= _MOST_CORNERS):
        return None
    found: dict[frozenset[frozenset[Vec]], tuple[int, int]] = {}
    for k in range(len(corners)):
        swap = (k, (k + 1) % len(corners))
        others = _sides(corners, swap)
        if _is_simple(others):
            found.setdefault(frozenset(frozenset((side.start, side.end)) for side in others), swap)
    if len(found) != 1:
        return None
    (swap,) = found.values()
    spans = [_within(way.span, written.start(1), literals[k]) for k in swap]
    edits = [Edit(span, literals[k][0]) for span, k in zip(spans, reversed(swap), strict=True)]
    return Fix(f"swap the corners {literals[swap[0]][0]} and {literals[swap[1]][0]}", tuple(edits))


def _within(span: Span, start: int, part: re.Match[str]) -> Span:
    return Span(span.source, span.start + start + part.start(), span.start + start + part.end())


def _sides(corners: Sequence[Vec], swap: tuple[int, int]) -> list[Line]:
    """Returns the sides of a polygon with two corners swapped."""
    order = list(corners)
    order[swap[0]], order[swap[1]] = corners[swap[1]], corners[swap[0]]
    return [Line(*ends) for ends in zip(order, [*order[1:], order[0]], strict=True)]


def _is_simple(sides: Sequence[Line]) -> bool:
    """Tells whether only neighbours among the sides of a polygon meet."""
    last = len(sides) - 1
    apart = (pair for pair in combinations(range(last + 1), 2) if pair[1] - pair[0] not in (1, last))
    return not any(meet(sides[i], sides[j], NO_LENGTH) for i, j in apart)

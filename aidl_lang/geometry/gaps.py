"""Closes outlines with small gaps: open ends of curves that lie close together become one, and each gap is
reported.

Numbers written by hand have two or three decimals, so the ends of two curves that are meant to meet may be a
hundredth of a millimetre apart. One of them is moved onto the other, and its curve changes as little as that
takes: it stays a line, an arc, a Bézier curve. Only curves that enclose nothing otherwise are joined, and
only where they enclose something then.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from aidl_lang.common.records import record
from aidl_lang.geometry.bodies import Finding, LooseCurves
from aidl_lang.geometry.curves import TAU, Arc, Bezier, Line, Piece, Vec, bounds, ends, is_closed, larger_side
from aidl_lang.geometry.faces import Shape
from aidl_lang.geometry.nearness import near_pairs
from aidl_lang.geometry.network import Network
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure

WIDEST = 5e-4
"""Width of a gap that is closed, relative to the size of the drawing: two decimals in a drawing of 30 mm."""
WIDEST_MM = 0.05
ROUNDING = 1e-8
"""Distance of two ends, relative to the size, that is rounding and no gap."""


@record()
class End:
    """The start or the end of a curve, by its number in the network."""

    geometry: SolvedGeometry
    number: int
    at: Vec
    is_last: bool


@record()
class Gap:
    """Two ends that count as one: `moved` was brought to where `kept` is."""

    structure: SolvedStructure
    moved: End
    kept: End

    @property
    def width(self) -> float:
        return math.dist(self.moved.at, self.kept.at)


def open_gaps(
    network: Network, findings: Iterable[Finding], shapes: Mapping[str, Sequence[Shape]]
) -> list[Gap]:
    """Returns the gaps beside curves of solids and holes that enclose nothing, narrow enough to be closed."""
    widest = min(WIDEST * network.size, WIDEST_MM)
    curves = list(network.curves)
    gaps = []
    for finding in findings:
        if not isinstance(finding, LooseCurves) or finding.structure.kind not in ("solid", "hole"):
            continue
        loose = {number for _, number in finding.curves}
        for a, b in _nearest_first(_open_ends(network, shapes[finding.structure.path]), widest):
            if not loose & {a.number, b.number}:
                continue
            for moved, kept in ((b, a), (a, b)):
                curve = _with_end(curves[moved.number], moved.is_last, kept, widest)
                if curve is not None:
                    curves[moved.number] = curve
                    gaps.append(Gap(finding.structure, moved, kept))
                    break
    return gaps


def without_gaps(curves: Sequence[Piece], gaps: Iterable[Gap]) -> list[Piece]:
    """Returns the curves with the moved ends where they are to be."""
    result = list(curves)
    for gap in gaps:
        number, widest = gap.moved.number, 2 * gap.width
        result[number] = _with_end(result[number], gap.moved.is_last, gap.kept, widest) or result[number]
    return result


def effective(gaps: Iterable[Gap], findings: Iterable[Finding]) -> list[Gap]:
    """Returns the gaps whose curves both enclose something."""
    loose = {number for f in findings if isinstance(f, LooseCurves) for _, number in f.curves}
    return [gap for gap in gaps if not loose & {gap.moved.number, gap.kept.number}]


def welded_gaps(
    network: Network,
    findings: Iterable[Finding],
    structures: Iterable[SolvedStructure],
    shapes: Mapping[str, Sequence[Shape]],
) -> Iterator[Gap]:
    """Yields gaps between ends, in outlines of single curves, that became one node without quite meeting."""
    gaps = []
    for structure in structures:
        if structure.kind not in ("solid", "hole"):
            continue
        meeting: dict[int, list[End]] = defaultdict(list)
        for shape in shapes[structure.path]:
            if not shape.geometry.parts:
                for end in _ends(network, [shape]):
                    meeting[network.node(end.at)].append(end)
        for here in meeting.values():
            first = here[0]
            last = max(here, key=lambda end: math.dist(end.at, first.at))
            if math.dist(last.at, first.at) > ROUNDING * network.size:
                gaps.append(Gap(structure, last, first))
    yield from effective(gaps, findings)


def _ends(network: Network, shapes: Iterable[Shape]) -> list[End]:
    return [
        End(geometry, number, at, is_last)
        for shape in shapes
        for geometry, number in shape.leaves
        if not is_closed(network.curves[number])
        for at, is_last in zip(ends(network.curves[number]), (False, True), strict=True)
    ]


def _open_ends(network: Network, shapes: Sequence[Shape]) -> list[End]:
    """Returns the ends at which no other curve of the structure has a node."""
    meeting = network.meeting(number for shape in shapes for number in shape.numbers)
    return [end for end in _ends(network, shapes) if meeting[network.node(end.at)] == 1]


def _nearest_first(found: Sequence[End], widest: float) -> Iterator[tuple[End, End]]:
    """Yields pairs of ends, each end once, the nearest pair first, in each the one written earlier first."""
    boxes = [(*end.at, *end.at) for end in found]
    pairs = sorted((math.dist(found[i].at, found[j].at), i, j) for i, j in near_pairs(boxes, widest))
    taken: set[int] = set()
    for distance, i, j in pairs:
        if distance <= widest and not taken & {i, j}:
            taken |= {i, j}
            yield found[i], found[j]


def _with_end(curve: Piece, is_last: bool, kept: End, widest: float) -> Piece | None:
    """Returns such a curve with its end elsewhere; None if that would change more than its end."""
    if larger_side(bounds(curve)) <= 10 * widest:
        return None
    start, end = ends(curve)
    start, end = (start, kept.at) if is_last else (kept.at, end)
    if isinstance(curve, Line):
        return Line(start, end)
    if isinstance(curve, Bezier):
        (ax, ay), (bx, by) = _way(curve.p0, start), _way(curve.p3, end)
        p1, p2 = (curve.p1[0] + ax, curve.p1[1] + ay), (curve.p2[0] + bx, curve.p2[1] + by)
        return Bezier(start, p1, p2, end)
    return _arc_through(curve, start, end, widest) if isinstance(curve, Arc) else None


def _way(p: Vec, q: Vec) -> Vec:
    return q[0] - p[0], q[1] - p[1]


def _arc_through(arc: Arc, start: Vec, end: Vec, widest: float) -> Arc | None:
    """Returns the arc between two points whose centre is nearest to that of another, and not far from it."""
    if start == end:
        return replace(arc, start=start, end=end, sweep=math.copysign(TAU, arc.sweep))
    (x, y), (cx, cy), (dx, dy) = start, arc.center, _way(start, end)
    chord = math.hypot(dx, dy)
    off = ((cx - (x + end[0]) / 2) * dx + (cy - (y + end[1]) / 2) * dy) / chord
    center = cx - off * dx / chord, cy - off * dy / chord
    radius = math.dist(center, start)
    if math.dist(center, arc.center) > 2 * widest or abs(radius - arc.radius) > 2 * widest:
        return None
    first, last = (math.atan2(p[1] - center[1], p[0] - center[0]) for p in (start, end))
    sweep = arc.sweep + math.remainder(last - first - arc.sweep, TAU)
    return Arc(center, radius, start, end, sweep) if 0 < abs(sweep) < TAU else None

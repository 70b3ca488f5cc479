"""What cannot be seen of a drawing, what reaches out of its part, and outlines that cross themselves."""

from __future__ import annotations

import math
import re
from bisect import bisect_left, bisect_right
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from aidl_lang.common.colors import look_alike
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.prose import counted, named, rough
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.geometry.boolean import Solid, stretches_beside
from aidl_lang.geometry.curves import NO_LENGTH, Bounds, Line, Piece, Vec, are_near, union_bounds
from aidl_lang.geometry.faces import Shape
from aidl_lang.geometry.intersect import from_sides, inside, meet
from aidl_lang.geometry.network import Network, Use
from aidl_lang.geometry.notes import local
from aidl_lang.geometry.pieces import LETTERING
from aidl_lang.geometry.region import Region, length
from aidl_lang.geometry.sections import Section, union
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure, at

if TYPE_CHECKING:
    from aidl_lang.geometry.drawing import Body, Stroke


# --- Finds strokes that cannot be seen on a ground of their colour, and lettering that parts cover.

COVERED = 0.1
"""Part of the letters that may be covered: they can be read though the hand of a clock lies over them."""
_WHOLE = 0.995


@record()
class Ground:
    """The bodies that strokes lie on, or under, from back to front. `curves` are those of all strokes, which
    go by their numbers; `boxes` are theirs; `order` has the places of structures and geometry.
    """

    network: Network
    bodies: Sequence[Solid]
    curves: Sequence[Piece]
    boxes: Sequence[Bounds]
    order: Mapping[str, int]

    def hides(self, color: str | None, curves: Sequence[int], place: float, *, wholly: bool) -> bool:
        """Tells whether the body below some curves has nearly their colour: all along them, or somewhere."""
        count = bisect_left(self._places, place)
        below = self._around(curves, range(count))
        seen = ((k, self.bodies[k].color) for k in below)
        alike = {k for k, own in seen if own is not None and color is not None and look_alike(own, color)}
        if not alike:
            return False
        asked = all if wholly else any
        if asked(top in alike for top in self._tops(curves, count)) is not wholly:
            return not wholly
        # By the middles alone it may still be otherwise.
        return asked(bool(on) and on[-1] in alike for _, on in self._parts(curves, below))

    def below(self, curves: Sequence[int], place: float) -> str | None:
        """Returns the colour of the body that most of some curves lie on; None if it has none."""
        ((top, _),) = Counter(self._tops(curves, bisect_left(self._places, place))).most_common(1)
        return None if top is None else self.bodies[top].color

    def _tops(self, curves: Sequence[int], count: int) -> Iterator[int | None]:
        """Yields the last of the first `count` bodies that the middle of each of some curves lies in."""
        return (max((k for k in self._at_middles[c] if k < count), default=None) for c in curves)

    def covering(self, curves: Sequence[int], place: float) -> str | None:
        """Returns the path of a body that is drawn over all of some curves; None if there is none."""
        box = union_bounds([self.boxes[curve] for curve in curves])
        over = [k for k in self._above(curves, place) if _lies_within(box, self.bodies[k].section.region.box)]
        over = [k for k in over if all(k in self._at_middles[curve] for curve in curves)]
        within = [on for _, on in self._parts(curves, over)]
        return next((self.bodies[k].path for k in over if all(k in on for on in within)), None)

    def covered_part(self, curves: Sequence[int], place: float) -> tuple[float, list[str]]:
        """Returns the share of the length of some curves that later bodies cover, and these bodies."""
        parts = [(length(piece), over) for piece, over in self._parts(curves, self._above(curves, place))]
        by = sorted({k for long, over in parts for k in over if long > 0})
        covered = sum(long for long, over in parts if over)
        return covered / (sum(long for long, _ in parts) or 1.0), [self.bodies[k].path for k in by]

    def _above(self, curves: Sequence[int], place: float) -> list[int]:
        """Returns the bodies that are drawn over a place and may hide some curves."""
        later = range(bisect_right(self._places, place), len(self.bodies))
        return self._around(curves, [k for k in later if not self.bodies[k].is_clear])

    def _around(self, curves: Sequence[int], bodies: Iterable[int]) -> list[int]:
        box = union_bounds([self.boxes[curve] for curve in curves])
        return [k for k in bodies if curves and are_near(box, self.bodies[k].section.region.box)]

    def hidden_part(self, faces: Section, place: float) -> tuple[float, list[str]]:
        """Returns the share of faces that later bodies cover, and these, but for inlays within the faces."""
        above = [b for b in self.bodies if b.place > place and not b.is_clear]
        above = [b for b in above if b.section.may_meet(faces) and not faces.covers(b.section)]
        by = [b.path for b in above if b.section.overlaps(faces)]
        hidden = union([b.section for b in above]) & faces if by else None
        return (hidden.area / faces.area if hidden is not None else 0.0), by

    @cached_property
    def _places(self) -> list[float]:
        return [body.place for body in self.bodies]

    def _parts(self, curves: Sequence[int], bodies: Sequence[int]) -> list[tuple[Piece, list[int]]]:
        """Returns the parts of curves between outlines of some bodies, each with the bodies it lies in."""
        if not bodies:
            return []
        own, boxes = [self.curves[k] for k in curves], [self.boxes[k] for k in curves]
        outlines = [self.bodies[k].section.region for k in bodies]
        around = union_bounds(boxes)
        near = [(p, b) for r in outlines for p, b in zip(r.pieces, r.boxes.tolist(), strict=True)]
        near = [(p, b) for p, b in near if are_near(around, b)]
        boxes += [b for _, b in near]
        cut = stretches_beside(own, [p for p, _ in near], np.array(boxes), self.network.tolerance)
        parts = [(curve, stretch) for curve, of in zip(own, cut, strict=True) for stretch in of]
        holders = self._holders([curve.point(stretch.middle) for curve, stretch in parts], bodies)
        pieces = (c.part(s.t0, s.t1, s.start, s.end) for c, s in parts)
        return list(zip(pieces, holders, strict=True))

    @cached_property
    def _at_middles(self) -> list[list[int]]:
        return self._holders([curve.point(0.5) for curve in self.curves], range(len(self.bodies)))

    def _holders(self, spots: Sequence[Vec], bodies: Sequence[int]) -> list[list[int]]:
        """Returns for each spot those of some bodies that it lies in."""
        on_grid = self.network.on_grid(np.array(spots))
        order = np.argsort(on_grid[:, 0], kind="stable")
        along, found = on_grid[order, 0], [list[int]() for _ in spots]
        for k in bodies:
            left, _, right, _ = self.bodies[k].section.box
            beside = order[np.searchsorted(along, left) : np.searchsorted(along, right, side="right")]
            for n in beside[self.bodies[k].section.mask(on_grid[beside])].tolist():
                found[n].append(k)
        return found


def _lies_within(inner: Bounds, outer: Bounds) -> bool:
    return outer[0] < inner[0] and outer[1] < inner[1] and inner[2] < outer[2] and inner[3] < outer[3]


def covered_note(drawing: SolvedStructure, names: Sequence[str], by: str) -> Diagnostic:
    """Returns the diagnostic on curves of a drawing that a later body covers."""
    around, _, name = by.rpartition(".")
    hint = f"write the drawing below `{name}`, or inside it"
    if around == drawing.path:
        hint = f"write {'it' if len(names) == 1 else 'them'} below `{name}`"
    elif around == drawing.path.rpartition(".")[0]:
        hint += f", or say `@in_front({name})` before it"
    return Diagnostic(
        "W0709",
        f"{named(names)} of drawing `{drawing.path}` cannot be seen: `{by}` is drawn over it",
        drawing.span,
        "what stands further down is drawn over it",
        hints=(hint,),
    )


def lettering_note(
    structure: SolvedStructure, text: SolvedGeometry, share: float, by: Sequence[str]
) -> Diagnostic:
    """Returns the diagnostic on letters that later bodies cover, in part or as a whole."""
    part = f"{max(1, round(100 * share))} % of the" if share < _WHOLE else "the"
    names = [path.rpartition(".")[2] for path in by]
    over = "is" if len(by) == 1 else "are"
    order = f"write {named(names)} before what the letters belong to"
    if structure.kind == "drawing":
        order = f"write the drawing below {named(names)}"
    return Diagnostic(
        "W0713",
        f"{part} lettering `{text.path}` cannot be seen: {named(by)} {over} drawn over it",
        text.span or structure.span,
        "what stands further down is drawn over it",
        hints=(f"move one of them, or {order}",),
    )


def unseen_note(drawing: SolvedStructure, names: Sequence[str], color: str) -> Diagnostic:
    """Returns the diagnostic on curves of a drawing that was given the colour of what they lie on."""
    return Diagnostic(
        "W0709",
        f"{named(names)} of drawing `{drawing.path}` cannot be seen: {color} on what has that colour",
        drawing.span,
        "strokes of the colour of what is below",
        hints=(
            'give it another colour, as `@color("dimgray")`',
            "with no `@color` of its own it gets one that shows",
        ),
    )


# --- Drawings that reach out of the part that they are engraved on.

UNSEEN = 0.05
"""mm that a drawing may reach out without a word."""
_TIMES = np.linspace(0, 1, 5)
_MOST = 400
"""Spots outside of a part of which the distance to it is measured."""


class Holders:
    """Finds the body that a stroke is drawn in."""

    def __init__(self, bodies: Sequence[Body]) -> None:
        self._bodies = {body.path: body for body in bodies}
        self._around = {owner(self._bodies, body.path.rpartition(".")[0]) for body in bodies}

    def of(self, stroke: Stroke) -> Body | None:
        """Returns that body; None if there is none, or others are in it, on which the stroke may be."""
        path = owner(self._bodies, stroke.path)
        return None if path is None or path in self._around else self._bodies[path]


def owner(bodies: Mapping[str, Body], path: str) -> str | None:
    """Returns the nearest body at a path or above it."""
    while path and path not in bodies:
        path = path.rpartition(".")[0]
    return path or None


def overhang(pieces: Sequence[Piece], region: Region, *, partly: bool = False) -> float:
    """Returns how far curves reach out of the outer outlines of a region, mm, by samples; 0 for none, and if
    `partly` for those that lie beside it altogether.
    """
    size = float(np.ptp(region.boxes.reshape(-1, 2), axis=0).max(initial=0.0))
    polygons = [face.outer.polygon(1e-5 * size) for face in region.faces]
    spots = np.concatenate([piece.points(_TIMES) for piece in pieces])
    out = ~inside(polygons, spots)
    if partly and out.all():
        return 0.0
    spots = spots[out]
    spots = spots[:: len(spots) // _MOST + 1]
    if not len(spots):
        return 0.0
    start = np.concatenate(polygons)
    way = np.concatenate([np.roll(p, -1, axis=0) - p for p in polygons])
    furthest = max(float(from_sides(spot - start, way).min()) for spot in spots)
    return furthest if furthest > max(UNSEEN, 1e-3 * size) else 0.0


def overhanging_notes(
    root: SolvedStructure, bodies: Sequence[Body], strokes: Sequence[Stroke]
) -> Iterator[Diagnostic]:
    """Yields a warning for each geometry that reaches out of its part: what is drawn in one of some stock,
    and letters of which some lie on it.
    """
    holders = Holders(bodies)
    drawn = {g.path: g for s in root.walk() for top in s.drawn for g in top.walk()}
    letters = {path for path, g in drawn.items() if g.type == LETTERING}
    found: dict[str, tuple[Body, float]] = {}
    for stroke in strokes:
        body = holders.of(stroke) if stroke.role == "drawing" else None
        is_stock = body is not None and bool(body.style.thickness or body.style.material)
        if body is not None and (is_stock or stroke.geometry in letters):
            far = overhang(stroke.pieces, body.region, partly=not is_stock)
            if far > found.get(stroke.geometry, (body, 0.0))[1]:
                found[stroke.geometry] = body, far
    for path, (body, far) in found.items():
        yield Diagnostic(
            "W0763",
            f"`{path}` reaches {rough(round(far, 2))} mm out of `{body.path}`, on which it is engraved",
            drawn[path].span if path in drawn else None,
            hints=(
                "make it smaller or move it inwards: a cutter burns what lies beside the part, too",
                f"or have it end at the edge: `@clip({body.path.rpartition('.')[2]})` before the drawing",
            ),
        )


_Boxed = tuple[Bounds, Sequence[Piece], Sequence[Bounds]]


def colliding_notes(
    root: SolvedStructure, strokes: Sequence[Stroke], tolerance: float
) -> Iterator[Diagnostic]:
    """Yields a warning for each text that runs into another of its structure; a like one is its shadow."""
    inked: dict[str, list[Piece]] = defaultdict(list)
    for stroke in strokes:
        inked[stroke.geometry] += stroke.pieces
    for structure in root.walk():
        texts: list[tuple[SolvedGeometry, _Boxed]] = []
        for top in structure.drawn:
            if own := [p for g in top.walk() if g.type == LETTERING for p in inked.get(g.path, ())]:
                boxes = [piece.box for piece in own]
                texts.append((top, (union_bounds(boxes), own, boxes)))
        texts.sort(key=lambda text: text[1][0])
        for k, (one, boxed) in enumerate(texts):
            for other, beside in texts[k + 1 :]:
                if beside[0][0] > boxed[0][2]:
                    break
                if _run_together(boxed, beside, tolerance):
                    first, second = sorted((one, other), key=lambda top: top.path)
                    message = f"the letters of `{first.path}` and `{second.path}` run into each other"
                    hint = "move one of them, or write both with less `height`"
                    yield Diagnostic("W0764", message, second.span, hints=(hint,))


def _run_together(one: _Boxed, other: _Boxed, tolerance: float) -> bool:
    (box, own, boxes), (around, others, theirs) = one, other
    size, like = ((len(of), b[2] - b[0], b[3] - b[1]) for b, of in ((box, own), (around, others)))
    if not are_near(box, around) or np.allclose(size, like, atol=tolerance):
        return False
    near = [(p, b) for p, b in zip(own, boxes, strict=True) if are_near(b, around)]
    pairs = ((p, q) for q, b in zip(others, theirs, strict=True) for p, c in near if are_near(b, c))
    return any(meet(p, q, tolerance) for p, q in pairs)


# --- Outlines that cross themselves: their parts alternate, so what should be material may be open.
#
# The crossings are those of the arrangement: nodes that a way goes through twice, changing sides.

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
    for inner in geometry.parts:
        yield from _ways(inner)


def _rings(network: Network, way: SolvedGeometry, numbers: Mapping[int, int]) -> Iterator[list[_Pass]]:
    """Yields how each closed round of a way goes through its nodes."""
    leaves = [leaf for leaf in way.walk() if id(leaf) in numbers and network.uses[numbers[id(leaf)]]]
    ring: list[tuple[Use, SolvedGeometry]] = []
    for place, leaf in enumerate(leaves):
        uses = network.uses[numbers[id(leaf)]]
        if ring and network.last(ring[-1][0]) not in _ends(network, uses):
            yield from _closed(network, ring)
            ring = []
        if ring:
            is_turned = network.first(uses[0]) != network.last(ring[-1][0])
        else:  # a curve may be drawn against the way: the next one begins where it ends
            following = network.uses[numbers[id(leaves[place + 1])]] if place + 1 < len(leaves) else uses
            is_turned = network.last(uses[-1]) not in _ends(network, following)
        ring += [(use, leaf) for use in (map(_back, reversed(uses)) if is_turned else uses)]
    yield from _closed(network, ring)


def _closed(network: Network, ring: list[tuple[Use, SolvedGeometry]]) -> Iterator[list[_Pass]]:
    """Yields the passes of a round if it ends where it begins, and comes to a node twice."""
    nodes = {network.first(use) for use, _ in ring}
    if len(nodes) < len(ring) and network.first(ring[0][0]) == network.last(ring[-1][0]):
        rolled = [*ring[1:], ring[0]]
        yield [
            _Pass(network.first(on), _back(use), on, leaf)
            for (use, leaf), (on, _) in zip(ring, rolled, strict=True)
        ]


def _ends(network: Network, uses: Sequence[Use]) -> tuple[int, int]:
    return network.first(uses[0]), network.last(uses[-1])


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
    ways = (network.piece(use).derivative(0) for use in (one.back, one.on, other.back, other.on))
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
    """Returns the fix that swaps neighbouring corners of a literal polygon, if just one has no crossings."""
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
    at = way.span.start + written.start(1)
    spans = [Span(way.span.source, at + literals[k].start(), at + literals[k].end()) for k in swap]
    edits = [Edit(span, literals[k][0]) for span, k in zip(spans, reversed(swap), strict=True)]
    return Fix(f"swap the corners {literals[swap[0]][0]} and {literals[swap[1]][0]}", tuple(edits))


def _sides(corners: Sequence[Vec], swap: tuple[int, int]) -> list[Line]:
    order = list(corners)
    order[swap[0]], order[swap[1]] = corners[swap[1]], corners[swap[0]]
    return [Line(*ends) for ends in zip(order, [*order[1:], order[0]], strict=True)]


def _is_simple(sides: Sequence[Line]) -> bool:
    """Tells whether only neighbours among the sides of a polygon meet."""
    last = len(sides) - 1
    apart = (pair for pair in combinations(range(last + 1), 2) if pair[1] - pair[0] not in (1, last))
    return not any(meet(sides[i], sides[j], NO_LENGTH) for i, j in apart)

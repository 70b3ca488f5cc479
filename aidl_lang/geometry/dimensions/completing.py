"""Completes the dimensions of a part, so that it can be made from them alone.

Along each axis an outline has levels: those of its edges, of its corners, of the centres of what is round. A
dimension ties two levels to each other. A level that nothing ties to the left (or lower) end of the part
cannot be found by who makes it, so a dimension from there is added; one that ties what is tied already is
left out, unless the program asks for it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Arc, Circle, Line, Piece, Vec
from aidl_lang.geometry.dimensions.features import X_AXIS, Y_AXIS, length_between, meeting
from aidl_lang.geometry.dimensions.fields import round_dimension
from aidl_lang.geometry.drawing import Body, Drawing
from aidl_lang.geometry.evaluate import bounds, derivative
from aidl_lang.geometry.region import Loop
from aidl_lang.geometry.solved import Dimension, Length, Roundness

Group = tuple[Dimension, ...]

DERIVED = "derived"
"""The origin of a dimension that the program does not state."""
MOST_HOLES = 8
"""More round holes than this that stand in no row or circle are told in a table."""
MOST_LEVELS = 150
"""A part with more levels than this is made from a file, not from dimensions."""

_SLACK = 1e-6
_EVEN = 1e-4
"""Degrees by which equal steps on a circle may differ."""
_ALONG = (X_AXIS, Y_AXIS)
_NEEDED = ("size", "pattern", DERIVED)
"""Origins of dimensions that are left out where others tell as much."""


@record()
class Completed:
    """Dimensions that tell a drawing. `free`: outlines that no dimension tells, of the bodies at these
    paths; `holes`: round ones that are to be told in a table, by their places.
    """

    groups: tuple[Group, ...]
    free: tuple[str, ...] = ()
    holes: tuple[Circle, ...] = ()


def completed(drawing: Drawing, stated: Sequence[Group]) -> Completed:
    """Returns the stated dimensions that are needed, and those that are missing."""
    slack = _SLACK * drawing.size
    pieces = [piece for body in drawing.bodies for piece in body.region.pieces]
    stated = [
        group
        for group in stated
        if not (group[0].origin == "pattern" and isinstance(group[0], Roundness))
        or _is_told_by(group[0].curve, _centers_on(group[0].curve, pieces, slack))
    ]
    holes = _scattered(drawing, stated, slack)
    groups = [group for group in _together(stated) if not any(_is_about(d, holes, slack) for d in group)]
    free = []
    for body in drawing.bodies:
        part = _Part(body, slack, holes)
        if part.is_free:
            free.append(body.path)
            continue
        groups = part.needed(groups)
        groups += part.missing()
    return Completed(tuple(groups), tuple(free), holes)


def _centers_on(ring: Circle | Arc, pieces: Iterable[Piece], slack: float) -> list[Vec]:
    """Returns the centres of whole circles that lie on a circle."""
    centers = [p.center for p in pieces if isinstance(p, Circle)]
    return [c for c in centers if abs(math.dist(c, ring.center) - ring.radius) <= slack]


def _is_told_by(ring: Circle | Arc, centers: Sequence[Vec]) -> bool:
    """Tells whether a circle through centres tells where they are: they stand at equal steps on it, and one
    of them, or a middle between two, straight beside the centre or above it.
    """
    (x0, y0), turns = ring.center, []
    for x, y in centers:
        turns.append(math.degrees(math.atan2(y - y0, x - x0)) % 360)
    turns.sort()
    steps = [b - a for a, b in pairwise([*turns, turns[0] + 360])] if turns else []
    if not steps or max(steps) - min(steps) > _EVEN:
        return False
    half = steps[0] / 2
    return any(abs((t - quarter + half / 2) % half - half / 2) <= _EVEN for t in turns for quarter in (0, 90))


def _scattered(drawing: Drawing, stated: Sequence[Group], slack: float) -> tuple[Circle, ...]:
    """Returns the round holes for a table: those in no pattern, if they are many."""
    ordered: list[Vec] = []
    rings: list[Circle | Arc] = []
    for dimension in (d for group in stated for d in group if d.origin == "pattern"):
        if isinstance(dimension, Length):
            ordered += [*dimension.start, *dimension.end]
        elif isinstance(dimension, Roundness):
            rings.append(dimension.curve)

    def is_ordered(c: Circle) -> bool:
        in_row = any(math.dist(c.center, p) <= slack for p in ordered)
        return in_row or any(abs(math.dist(c.center, r.center) - r.radius) <= slack for r in rings)

    holes = [
        piece
        for body in drawing.bodies
        for face in body.region.faces
        for loop in face.holes
        for piece in loop.pieces
        if isinstance(piece, Circle) and not is_ordered(piece)
    ]
    return tuple(holes) if len(holes) > MOST_HOLES else ()


def _is_about(of: Dimension, holes: Sequence[Circle], slack: float) -> bool:
    """Tells whether a dimension is told by the table of holes."""
    if of.origin == "hand":
        return False
    match of:
        case Length(start=start, end=end):
            return any(math.dist(c.center, p) <= slack for c in holes for p in (*start, *end))
        case Roundness(curve=curve):
            return any(_is_same(c, curve, slack) for c in holes)
    return False


def mirror_levels(body: Body, slack: float) -> tuple[float | None, float | None]:
    """Returns the x of the upright axis that a body is symmetric about, and the y of the level one."""
    return _mirror(body, 0, slack), _mirror(body, 1, slack)


def _mirror(body: Body, axis: int, slack: float) -> float | None:
    twice = body.box[axis] + body.box[axis + 2]

    def key(low: float, high: float, box: tuple[float, ...], piece: Piece) -> tuple[object, ...]:
        numbers = (low, high, box[1 - axis], box[3 - axis])
        return type(piece).__name__, *(round(n / (10 * slack)) for n in numbers)

    here, there = [], []
    for piece in body.region.pieces:
        box = bounds(piece)
        here.append(key(box[axis], box[axis + 2], box, piece))
        there.append(key(twice - box[axis + 2], twice - box[axis], box, piece))
    return twice / 2 if sorted(map(str, here)) == sorted(map(str, there)) else None


def _together(groups: Sequence[Group]) -> Iterator[Group]:
    """Yields the groups, those of equal whole circles as one, wherever they are written."""
    alike: dict[object, list[Dimension]] = {}
    for number, group in enumerate(groups):
        first = group[0]
        is_circle = isinstance(first, Roundness) and isinstance(first.curve, Circle)
        is_plain = is_circle and first.origin != "pattern" and first.limits is None and not first.fit
        key = ("circle", round(first.value, 9)) if is_plain else number
        alike.setdefault(key, []).extend(group)
    return map(tuple, alike.values())


class _Axis:
    """The levels of a part along an axis, and which of them are tied."""

    def __init__(self, axis: int, slack: float) -> None:
        self.axis, self.slack = axis, slack
        self.values: list[float] = []
        self.spots: list[list[Vec]] = []
        self.wanted: set[int] = set()
        self.triples: list[tuple[int, int, int]] = []
        self.pairs: list[tuple[int, int]] = []
        self._root: list[int] = []

    def level(self, value: float, *points: Vec, wanted: bool = False) -> int:
        """Returns the number of a level, which is new if there is none there."""
        near = (n for n, known in enumerate(self.values) if abs(known - value) <= self.slack)
        number = next(near, len(self.values))
        if number == len(self.values):
            self.values.append(value)
            self.spots.append([])
            self._root.append(number)
        self.spots[number] += [p for p in points if p not in self.spots[number]]
        if wanted:
            self.wanted.add(number)
        return number

    def root(self, number: int) -> int:
        while self._root[number] != number:
            number = self._root[number]
        return number

    def tied(self, a: int, b: int) -> bool:
        return self.root(a) == self.root(b)

    def tie(self, a: int, b: int) -> None:
        self._root[self.root(a)] = self.root(b)

    def follow(self) -> None:
        """Ties what follows: of a level amid two others, with any two of them the third."""
        changed = True
        while changed:
            changed = False
            for triple in self.triples:
                roots = {self.root(n) for n in triple}
                if len(roots) == 2:
                    self.tie(triple[0], triple[1])
                    self.tie(triple[1], triple[2])
                    changed = True


class _Part:
    def __init__(self, body: Body, slack: float, holes: Sequence[Circle] = ()) -> None:
        self.body, self.slack = body, slack
        self.axes = _Axis(0, slack), _Axis(1, slack)
        self.rounds: list[Circle | Arc] = []
        self.told: set[int] = set()
        pieces = body.region.pieces
        self.is_free = any(not isinstance(p, Line | Arc | Circle) for p in pieces)
        if self.is_free:
            return
        for loop in body.region.loops:
            if loop.pieces[0] not in holes:
                self._read(loop)
        self.seen = tuple(frozenset(range(len(axis.values))) for axis in self.axes)
        self.is_free = any(len(axis.wanted) > MOST_LEVELS for axis in self.axes)
        for axis, middle in zip(self.axes, mirror_levels(body, slack), strict=True):
            if middle is None:
                continue
            at = axis.level(middle)
            for number in range(len(axis.values)):
                other = axis.level(2 * middle - axis.values[number])
                if number < other:
                    axis.triples.append((number, at, other))
                    axis.pairs.append((number, other))

    # --- Levels ------------------------------------------------------------------------------------

    def _read(self, loop: Loop) -> None:
        """Notes the levels of an outline, and what of them follows from the rest."""
        pieces = loop.pieces
        for k, piece in enumerate(pieces):
            if isinstance(piece, Line):
                self._line(pieces, k, piece)
            elif isinstance(piece, Circle | Arc) and not self._is_fillet(pieces, k):
                self.rounds.append(piece)
                for axis in self.axes:
                    axis.level(piece.center[axis.axis], piece.center, wanted=True)
            elif isinstance(piece, Arc):
                self.rounds.append(piece)
        boxes = [bounds(p) for p in pieces]
        for axis in self.axes:
            low = min(b[axis.axis] for b in boxes)
            high = max(b[axis.axis + 2] for b in boxes)
            axis.triples.append((axis.level(low), axis.level((low + high) / 2), axis.level(high)))

    def _line(self, pieces: Sequence[Piece], k: int, line: Line) -> None:
        (x0, y0), (x1, y1) = line.start, line.end
        if abs(x1 - x0) <= self.slack:
            self.axes[0].level(x0, line.start, line.end, wanted=True)
        elif abs(y1 - y0) <= self.slack:
            self.axes[1].level(y0, line.start, line.end, wanted=True)
        else:
            for step, end in ((-1, line.start), (1, line.end)):
                if (corner := self._corner(pieces, k, step, end)) is not None:
                    for axis in self.axes:
                        axis.level(corner[axis.axis], corner, wanted=True)

    def _corner(self, pieces: Sequence[Piece], k: int, step: int, end: Vec) -> Vec | None:
        """Returns the corner at an end of a slanted line, as if it were not rounded; None if the line touches
        something round there, which tells where it ends.
        """
        beside = (k + step) % len(pieces)
        if not isinstance(pieces[beside], Arc) or not self._is_smooth(pieces, k if step > 0 else beside):
            return end
        beyond, line = pieces[(beside + step) % len(pieces)], pieces[k]
        if self._is_fillet(pieces, beside) and isinstance(beyond, Line) and isinstance(line, Line):
            return meeting(line, beyond)
        return None

    def _is_smooth(self, pieces: Sequence[Piece], k: int) -> bool:
        """Tells whether a piece goes over into the next one without a corner."""
        (u0, v0), (u1, v1) = derivative(pieces[k], 1.0), derivative(pieces[(k + 1) % len(pieces)], 0.0)
        size = math.hypot(u0, v0) * math.hypot(u1, v1)
        return abs(u0 * v1 - v0 * u1) <= 1e-6 * size and u0 * u1 + v0 * v1 > 0

    def _is_fillet(self, pieces: Sequence[Piece], k: int) -> bool:
        """Tells whether an arc rounds the corner between two lines."""
        piece, before, after = pieces[k], pieces[k - 1], pieces[(k + 1) % len(pieces)]
        if not (isinstance(piece, Arc) and isinstance(before, Line) and isinstance(after, Line)):
            return False
        is_smooth = self._is_smooth(pieces, (k - 1) % len(pieces)) and self._is_smooth(pieces, k)
        return is_smooth and meeting(before, after) is not None

    # --- What is told ------------------------------------------------------------------------------

    def needed(self, groups: Iterable[Group]) -> list[Group]:
        """Returns the groups without those that tell nothing more than the ones before them."""
        kept = []
        for group in groups:
            lengths = [d for d in group if isinstance(d, Length) and d.along in _ALONG]
            may_go = len(lengths) == len(group) and group[0].origin in _NEEDED
            if may_go and all(self._is_known(d) or not self._is_seen(d) for d in lengths):
                continue
            for dimension in group:
                self._learn(dimension)
            for axis in self.axes:
                axis.follow()
            kept.append(group)
        return kept

    def _is_seen(self, of: Length) -> bool:
        """Tells whether both ends are levels of the outline: edges may be hidden in what is united."""
        axis = self.axes[int(of.along == Y_AXIS)]
        known = [axis.values[n] for n in self.seen[axis.axis]]
        ends = [p[0][axis.axis] for p in (of.start, of.end)]
        return all(any(abs(end - value) <= self.slack for value in known) for end in ends)

    def _is_known(self, of: Length) -> bool:
        axis = self.axes[int(of.along == Y_AXIS)]
        low, high = (axis.level(p[0][axis.axis]) for p in (of.start, of.end))
        axis.follow()
        return axis.tied(low, high)

    def _learn(self, of: Dimension) -> None:
        match of:
            case Length() if of.along in _ALONG:
                axis = self.axes[int(of.along == Y_AXIS)]
                axis.tie(*(axis.level(p[0][axis.axis]) for p in (of.start, of.end)))
            case Roundness(origin="pattern", curve=Circle() as ring):
                self._learn_ring(ring)
            case Roundness(curve=curve):
                for number, own in enumerate(self.rounds):
                    if _is_same(own, curve, self.slack):
                        self._learn_round(number)

    def _learn_round(self, number: int) -> None:
        self.told.add(number)
        curve = self.rounds[number]
        for axis in self.axes:
            middle = axis.level(curve.center[axis.axis])
            for side in (-1, 1):
                axis.tie(middle, axis.level(curve.center[axis.axis] + side * curve.radius))

    def _learn_ring(self, ring: Circle) -> None:
        """Learns that the centres on a circle stand at equal steps, if it is seen where these begin."""
        on = _centers_on(ring, self.body.region.pieces, self.slack)
        if not _is_told_by(ring, on):
            return
        for axis in self.axes:
            middle = axis.level(ring.center[axis.axis], ring.center)
            for center in on:
                axis.tie(middle, axis.level(center[axis.axis]))

    # --- What is missing ---------------------------------------------------------------------------

    def missing(self) -> list[Group]:
        found = list(self._rounds())
        for axis in self.axes:
            found += self._levels(axis)
        return found

    def _rounds(self) -> Iterator[Group]:
        """Yields the sizes of what is round and has none, equal ones together."""
        open_ones: dict[tuple[str, int], list[int]] = {}
        for number, curve in enumerate(self.rounds):
            if number in self.told:
                continue
            if self._is_spanned(curve):
                self._learn_round(number)
                continue
            key = type(curve).__name__, round(curve.radius / self.slack)
            open_ones.setdefault(key, []).append(number)
        for numbers in open_ones.values():
            for number in numbers:
                self._learn_round(number)
            yield tuple(
                _derived(round_dimension(self.rounds[n]), ("round", self.body.path, *numbers))
                for n in numbers
            )
        for axis in self.axes:
            axis.follow()

    def _is_spanned(self, curve: Circle | Arc) -> bool:
        """Tells whether a length across a half-round end tells its radius."""
        if isinstance(curve, Circle) or abs(curve.sweep) < math.pi - 1e-6:
            return False
        for axis in self.axes:
            c, r = curve.center[axis.axis], curve.radius
            low, high = axis.level(c - r), axis.level(c + r)
            if axis.tied(low, high):
                return True
        return False

    def _levels(self, axis: _Axis) -> Iterator[Group]:
        """Yields lengths that tie the levels that are tied to nothing."""
        datum = axis.level(self.body.box[axis.axis])
        axis.follow()
        partners = dict(axis.pairs) | {b: a for a, b in axis.pairs}
        for number in sorted(axis.wanted, key=lambda n: abs(axis.values[n] - axis.values[datum])):
            if axis.tied(number, datum):
                continue
            other = partners.get(number)
            is_pair = other is not None and axis.spots[other] and other != number
            start, end = (number, other) if is_pair and other is not None else (datum, number)
            found = self._between(axis, start, end)
            axis.tie(start, end)
            axis.follow()
            if found.value > self.slack:
                yield (_derived(found, ("level", self.body.path, axis.axis, number)),)

    def _between(self, axis: _Axis, a: int, b: int) -> Length:
        starts, finishes = (axis.spots[n] or self._ends_at(axis, axis.values[n]) for n in (a, b))
        return length_between(starts, finishes, _ALONG[axis.axis])

    def _ends_at(self, axis: _Axis, value: float) -> list[Vec]:
        """Returns the points of the outline at a level."""
        found = []
        for piece in self.body.region.pieces:
            box = bounds(piece)
            for side in (axis.axis, axis.axis + 2):
                if abs(box[side] - value) <= self.slack:
                    middle = (box[1 - axis.axis] + box[3 - axis.axis]) / 2
                    found.append((value, middle) if axis.axis == 0 else (middle, value))
        return found or [(value, self.body.box[1]) if axis.axis == 0 else (self.body.box[0], value)]


def _derived(of: Dimension, group: object) -> Dimension:
    return replace(of, origin=DERIVED, group=group)


def _is_same(a: Circle | Arc, b: Circle | Arc, slack: float) -> bool:
    """Tells whether two curves are of one circle."""
    return abs(a.radius - b.radius) <= slack and math.dist(a.center, b.center) <= slack

"""The dimensions that a drawing of a solved model should state: of geometry, of constraints, of the whole.

A dimension measures what is drawn: a size that nothing drawn has is not stated.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import chain, pairwise, product

import numpy as np

from aidl_lang.building.expression import Evaluator, Expression
from aidl_lang.building.model import Model, Structure
from aidl_lang.building.state import ParamBinding, Scope
from aidl_lang.building.values import Num
from aidl_lang.common.records import record
from aidl_lang.geometry.curves import LARGEST, NO_LENGTH, Arc, Circle, Line, Piece, Vec
from aidl_lang.geometry.dimensions import features
from aidl_lang.geometry.dimensions import sketch as sk
from aidl_lang.geometry.dimensions.constraints import Scene, by_hand, stated_lengths
from aidl_lang.geometry.drawing import Body, Drawing
from aidl_lang.geometry.region import Loop
from aidl_lang.geometry.solved import Dimension, Length, Opening, Roundness, SolvedModel

# --- Completes the dimensions of a part, so that it can be made from them alone, and nothing is said twice.
#
# Dimensions are taken in their order as long as they tell something new (see `sketch`); then what is still
# missing is added: sizes of what is round, then the levels of edges and centres from the left and lower end
# of the part, or from the centre of what is round there, or across the axis of a symmetric part, then
# corners.

Group = tuple[Dimension, ...]

DERIVED = "derived"
"""The origin of a dimension that the program does not state."""
MOST_HOLES = 8
"""More round holes than this that stand in no row or circle are told in a table."""
MOST_LEVELS = 100
"""A part with more levels than this is made from a file, not from dimensions."""

_SLACK = 1e-6
_NEEDED = 1e-6
"""What is left of a number without a dimension, from which on it is not told without it."""
_AUXILIARY = ("hand", "overall")
"""Origins of dimensions that stand in brackets if others tell as much; further ones are left out."""
_EVEN = 1e-4
"""Degrees by which equal steps on a circle may differ."""


@record()
class Completed:
    """Dimensions that tell a drawing. `free`: outlines that no dimension tells, of the bodies at these
    paths; `holes`: round ones that are to be told in a table, by their places from `datum`.
    """

    groups: tuple[Group, ...]
    free: tuple[str, ...] = ()
    holes: tuple[Circle, ...] = ()
    datum: Vec = (0.0, 0.0)


Labels = Sequence[tuple[Circle, str, str]]
"""Circles with what stands in place of their diameter, and behind it."""


def completed(
    drawing: Drawing, stated: Sequence[Group], filed: Iterable[Piece] = (), labels: Labels = ()
) -> Completed:
    """Returns the stated dimensions that are needed, and those that are missing. `filed`: curves of letters
    and of imported drawings, which no dimensions tell; `labels`: of circles, with what is said of them.
    """
    slack = _SLACK * drawing.size
    pieces = [piece for body in drawing.bodies for piece in body.region.pieces]
    stated = [
        group
        for group in stated
        if not (group[0].origin == "pattern" and isinstance(group[0], Roundness))
        or _is_told_by(group[0].curve, pieces, slack)
    ]
    holes = _scattered(drawing, stated, slack)
    said = sk.Places[tuple[str, str]](slack)
    for circle, label, remark in labels:
        said.add((*circle.center, circle.radius), (label, remark))
    groups = [
        group
        for group in _together(_labelled(stated, said))
        if not any(_is_about(d, holes, slack) for d in group)
    ]
    drawn = [stroke.pieces for stroke in drawing.strokes]
    told_apart = sk.Places[Piece](slack)
    for piece in filed:
        told_apart.add(_middle(piece), piece)
    free, datum = [], (0.0, 0.0)
    for body in drawing.bodies:
        part = _Part(body, drawn, slack, holes, told_apart)
        if part.loose:
            free.append(body.path)
        tips = [group for group in groups if part.is_of_tip(group)]
        groups = part.needed(group for group in groups if group not in tips)
        groups += [group for each in part.missing() for group in _labelled([each], said)]
        groups = part.pruned([*groups, *part.needed(tips)])
        datum = part.datums[0].value, part.datums[1].value
    return Completed(tuple(groups), tuple(free), holes, datum)


def _is_told_by(ring: Circle | Arc, pieces: Iterable[Piece], slack: float) -> bool:
    """Tells whether a circle through centres tells where they are: they stand at equal steps on it, and one
    of them, or a middle between two, straight beside the centre or above it.
    """
    (x0, y0), centers = ring.center, (p.center for p in pieces if isinstance(p, Circle))
    on_it = (c for c in centers if sk.is_on(ring, c, slack))
    turns = sorted(math.degrees(math.atan2(y - y0, x - x0)) % 360 for x, y in on_it)
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
        return in_row or any(sk.is_on(ring, c.center, slack) for ring in rings)

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
    if of.origin == "hand":
        return False
    match of:
        case Length(start=start, end=end):
            return any(math.dist(c.center, p) <= slack for c in holes for p in (*start, *end))
        case Roundness(curve=curve):
            return any(_is_same(c, curve, slack) for c in holes)
    return False


def _labelled(groups: Iterable[Group], said: sk.Places[tuple[str, str]]) -> Iterator[Group]:
    """Yields the groups with what is said of their circles; apart where that differs."""
    for group in groups:
        apart: dict[tuple[str, str], list[Dimension]] = {}
        for of in group:
            words = "", ""
            if isinstance(of, Roundness) and isinstance(of.curve, Circle) and of.origin != "pattern":
                words = said.find((*of.curve.center, of.curve.radius)) or words
            apart.setdefault(words, []).append(replace(of, label=words[0], remark=words[1]))
        yield from map(tuple, apart.values())


def _together(groups: Iterable[Group]) -> Iterator[Group]:
    """Yields the groups, those of equal whole circles as one, wherever they are written."""
    alike: dict[object, list[Dimension]] = {}
    for number, group in enumerate(groups):
        first = group[0]
        is_circle = isinstance(first, Roundness) and isinstance(first.curve, Circle)
        is_plain = is_circle and first.origin != "pattern" and first.limits is None and not first.fit
        key = ("circle", round(first.value, 9), first.label, first.remark) if is_plain else number
        alike.setdefault(key, []).extend(group)
    return map(tuple, alike.values())


class _Part:
    """A body with the circles that are drawn on it. `loose`: pieces of outlines that no dimensions tell."""

    def __init__(
        self,
        body: Body,
        drawn: Sequence[Sequence[Piece]],
        slack: float,
        holes: Sequence[Circle],
        filed: sk.Places[Piece],
    ) -> None:
        self.body, self.slack = body, slack
        loops = [loop for loop in body.region.loops if loop.pieces[0] not in holes]
        clear = [
            loop
            for loop in loops
            if all(isinstance(p, Line | Arc | Circle) and filed.find(_middle(p)) is None for p in loop.pieces)
        ]
        circles = [Loop((p[0],)) for p in drawn if len(p) == 1 and isinstance(p[0], Circle)]
        self.sketch = sk.Sketch([*clear, *circles], body.box, slack)
        seen = [level for level in self.sketch.levels() if level.rank < sk.HIDDEN]
        if len(seen) > MOST_LEVELS:
            clear, self.sketch = [], sk.Sketch([], body.box, slack)
        self.loose = [piece for loop in loops if loop not in clear for piece in loop.pieces]
        self.drawn = [piece for pieces in drawn for piece in pieces]
        self.datums = [self._datum(axis) for axis in (0, 1)]
        known = [*(datum.reading for datum in self.datums), *self._filed()]
        self.middles = mirror_levels(body, slack)
        for axis, middle in enumerate(self.middles):
            if middle is not None:
                axle = self.sketch.mirror(axis, middle)
                known += [] if self.datums[axis].reading.needs else [axle]
        self.seen, self.span = (sk.Span(self.sketch.count) for _ in range(2))
        self.rows = [self.sketch.row(reading) for reading in (*self.sketch.equations, *known)]
        for span in (self.seen, self.span):
            span.add_all(self.rows)

    def _datum(self, axis: int) -> sk.Level:
        """Returns what levels are measured from: the left or lower end, the centre of what is round there."""
        low = self.body.box[axis]
        levels = [level for level in self.sketch.levels() if level.axis == axis]
        at_end = next((n for n in levels if n.rank < sk.HIDDEN and abs(n.value - low) <= self.slack), None)
        if at_end is not None:
            return at_end
        rounds = [
            r for r in self.sketch.rounds if abs(r.curve.center[axis] - r.curve.radius - low) <= self.slack
        ]
        for own in sorted(rounds, key=lambda r: -r.curve.radius):
            return next(n for n in levels if n.reading.needs == own.center.along(axis).needs)
        self.sketch.fixed[axis] = low
        return sk.Level(axis, low, sk.Reading((), lambda _: low), tuple(self._ends_at(axis, low)), sk.EDGE)

    def _filed(self) -> Iterator[sk.Reading]:
        """Yields the levels of the ends of the part that an outline without dimensions reaches."""
        boxes = [piece.box for piece in self.loose]
        for side, end in enumerate(self.body.box):
            number = self.sketch.level(side % 2, end)
            if number is not None and any(abs(box[side] - end) <= self.slack for box in boxes):
                yield sk.plain(number)

    # --- What is told ------------------------------------------------------------------------------

    def needed(self, groups: Iterable[Group]) -> list[Group]:
        """Returns the groups that tell more than those before them; by hand, others stay as auxiliary."""
        kept: list[Group] = []
        for group in groups:
            members, is_new, is_judged = [], False, True
            for of in map(self._shifted, group):
                readings = sk.told(self.sketch, of)
                if self.loose and of.origin == "overall":
                    is_judged = False
                elif readings:
                    is_new |= self._learn(readings)
                elif of.origin == "hand" or self._is_on_loose(of):
                    is_judged = False
                else:
                    continue
                members.append(of)
            if is_new or (members and not is_judged):
                kept.append(tuple(members))
            elif members and members[0].origin in _AUXILIARY:
                kept.append(_bracketed(members))
        return kept

    def is_of_tip(self, group: Group) -> bool:
        """Tells whether the size of the whole ends at a rounded corner, so that others tell it better."""
        if group[0].origin != "overall":
            return False
        readings = sk.told(self.sketch, group[0]) or ()
        return any(self.sketch.fillets.intersection(reading.needs) for reading in readings)

    def pruned(self, groups: Sequence[Group]) -> list[Group]:
        """Returns the groups that others do not tell after all: later ones may make one needless."""
        own = [self._rows_of(group) for group in groups]
        rows = [row / np.linalg.norm(row) for row in chain(self.rows, *own) if row.any()]
        gram = np.array(rows).T @ np.array(rows) if rows else np.zeros((0, 0))
        inverse, kept = None, list(groups)
        for k in reversed(range(len(groups))):
            told_here = [row / np.linalg.norm(row) for row in own[k] if row.any()]
            if not told_here or max(map(len, own)) == 1:
                continue
            if inverse is None:
                inverse = np.linalg.pinv(gram, rcond=1e-12, hermitian=True)
            taken = np.array(told_here)
            # The rest spans as much if no part of the group weighs as much as all that there is of it.
            if np.linalg.eigvalsh(taken @ inverse @ taken.T)[-1] < 1 - _NEEDED:
                gram, inverse = gram - taken.T @ taken, None
                kept[k] = _bracketed(groups[k]) if groups[k][0].origin in _AUXILIARY else ()
        return [group for group in kept if group]

    def _rows_of(self, group: Group) -> list[sk.Row]:
        if group[0].is_auxiliary or (self.loose and group[0].origin == "overall"):
            return []
        return [self.sketch.row(reading) for of in group for reading in sk.told(self.sketch, of) or ()]

    def _learn(self, readings: Iterable[sk.Reading]) -> bool:
        return self.span.add_all(map(self.sketch.row, readings))

    def _shifted(self, of: Dimension) -> Dimension:
        """Returns a length along an axis between points that are seen, if some are as far from each other."""
        if not isinstance(of, Length) or of.along not in sk.ALONG or of.origin == "hand":
            return of
        if sk.told(self.sketch, of) and self._is_there(of.start) and self._is_there(of.end):
            return of
        axis = sk.ALONG.index(of.along)
        seen = [n for n in self.sketch.levels() if n.axis == axis and n.rank < sk.HIDDEN]
        found = [
            (abs(a.value - of.start[0][axis]), k, replace(of, start=a.points, end=b.points))
            for k, (a, b) in enumerate(product(seen, seen))
            if abs(b.value - a.value - of.value) <= self.slack
        ]
        away, _, best = min(found, default=(math.inf, 0, of))
        return best if away <= of.value else of

    def _is_there(self, points: Sequence[Vec]) -> bool:
        """Tells whether any of some points is seen: on an outline, or as a centre with its lines."""
        centers = [own.curve.center for own in self.sketch.rounds if own.is_seen]
        return self._is_on(self.body.region.pieces, points) or any(
            math.dist(p, center) <= self.slack for p in points for center in centers
        )

    def _is_on(self, pieces: Iterable[Piece], points: Sequence[Vec]) -> bool:
        return any(
            math.dist(piece.point(piece.nearest(p)), p) <= self.slack for piece in pieces for p in points
        )

    def _is_on_loose(self, of: Dimension) -> bool:
        """Tells whether a dimension measures what is told by no dimensions: free outlines, drawings."""
        match of:
            case Length(start=start, end=end):
                loose = (*self.loose, *self.drawn)
                return self._is_on(loose, start) or self._is_on(loose, end)
            case Roundness(curve=curve):
                return any(_is_same(p, curve, self.slack) for p in (*self.loose, *self.drawn))
            case _:
                return False

    # --- What is missing ---------------------------------------------------------------------------

    def missing(self) -> list[Group]:
        return [*self._rounds(), *self._levels()]

    def _rounds(self) -> Iterator[Group]:
        """Yields the sizes of what is round and has none, equal ones together."""
        lacking: dict[tuple[str, int], list[sk.Round]] = {}
        for own in self.sketch.rounds:
            if self.span.lacks(self.sketch.row(sk.plain(own.radius))):
                key = type(own.curve).__name__, round(own.curve.radius / self.slack)
                lacking.setdefault(key, []).append(own)
        for rounds in lacking.values():
            first = self.sketch.row(sk.plain(rounds[0].radius))
            group = "round", self.body.path, *rounds[0].curve.center
            told_here = [
                _derived(features.round_dimension(own.curve), group)
                for own in rounds
                if self._learn([sk.plain(own.radius)])
                or not self.seen.lacks(self.sketch.row(sk.plain(own.radius)) - first)
            ]
            if told_here:
                yield tuple(told_here)

    def _levels(self) -> Iterator[Group]:
        """Yields lengths that tie the levels that are tied to nothing."""
        levels = self.sketch.levels()
        known = (sk.Places[sk.Level](self.slack), sk.Places[sk.Level](self.slack))
        for level in levels:
            if level.rank < sk.HIDDEN and level.points:
                known[level.axis].add((level.value,), level)

        def turn(level: sk.Level) -> tuple[int, int, float]:
            return level.rank, level.axis, abs(level.value - self.datums[level.axis].value)

        for level in sorted(levels, key=turn):
            datum, middle = self.datums[level.axis], self.middles[level.axis]
            if not self.span.lacks(self.sketch.row(sk.less(level.reading, datum.reading))):
                continue
            other = datum
            if middle is not None and level.rank < sk.HIDDEN:
                other = known[level.axis].find((2 * middle - level.value,)) or datum
                other = datum if other is level else other
            number = sk.less(level.reading, other.reading)
            self._learn([number])
            if abs(level.value - other.value) <= self.slack:
                self.rows.append(self.sketch.row(number))  # seen to be on one level
            else:
                found = features.length_between(other.points, level.points, sk.ALONG[level.axis])
                yield (_derived(found, ("level", self.body.path, level.axis, *level.points[0])),)

    def _ends_at(self, axis: int, value: float) -> list[Vec]:
        found = []
        for piece in self.body.region.pieces:
            box = piece.box
            for side in (axis, axis + 2):
                if abs(box[side] - value) <= self.slack:
                    middle = (box[1 - axis] + box[3 - axis]) / 2
                    found.append((value, middle) if axis == 0 else (middle, value))
        return found


def _bracketed(group: Iterable[Dimension]) -> Group:
    return tuple(replace(of, is_auxiliary=True) for of in group)


def _derived(of: Dimension, group: object) -> Dimension:
    return replace(of, origin=DERIVED, group=group)


def mirror_levels(body: Body, slack: float) -> tuple[float | None, float | None]:
    """Returns the x of the upright axis that a body is symmetric about, and the y of the level one."""
    places = sk.Places[Piece](slack)
    for piece in body.region.pieces:
        places.add(_middle(piece), piece)

    def is_mirrored(piece: Piece, axis: int, middle: float) -> bool:
        there = places.all(sk.flipped(_middle(piece), axis, middle))
        return any(_is_mirror(piece, other, axis, middle, 4 * slack) for other in there)

    found = []
    for axis in (0, 1):
        middle = (body.box[axis] + body.box[axis + 2]) / 2
        is_even = all(is_mirrored(piece, axis, middle) for piece in body.region.pieces)
        found.append(middle if is_even else None)
    return found[0], found[1]


def _middle(piece: Piece) -> Vec:
    return piece.center if isinstance(piece, Circle) else piece.point(0.5)


def _is_mirror(a: Piece, b: Piece, axis: int, middle: float, slack: float) -> bool:
    if isinstance(a, Circle) or isinstance(b, Circle):
        return isinstance(a, Circle) and isinstance(b, Circle) and abs(a.radius - b.radius) <= slack
    spots = [sk.flipped(a.point(t), axis, middle) for t in (0.0, 0.25, 1.0)]
    return type(a) is type(b) and any(
        all(math.dist(p, b.point(t)) <= slack for p, t in zip(spots, ways, strict=True))
        for ways in ((0.0, 0.25, 1.0), (1.0, 0.75, 0.0))
    )


def _is_same(a: Piece, b: Circle | Arc, slack: float) -> bool:
    if not isinstance(a, Circle | Arc):
        return False
    return abs(a.radius - b.radius) <= slack and math.dist(a.center, b.center) <= slack


RANKS = ("hand", "param", "overall", "constraint", "size", "pattern")
"""Origins of dimensions, the more important first."""


def sizes(model: Model, solved: SolvedModel, evaluate: Evaluator) -> tuple[Dimension, ...]:
    """Returns the dimensions that the program states: exact sizes, what constraints measure, kept sizes."""
    names = _param_names(model.root)
    scene = Scene(model, solved.root, evaluate, names)
    found = [*by_hand(model, scene), *features.field_sizes(model, solved.root, evaluate, names)]
    found += stated_lengths(model, scene)
    found = [d for d in found if abs(d.value) <= LARGEST]  # of what has a place
    return tuple(sorted(found, key=lambda d: RANKS.index(d.origin)))


def _param_names(root: Structure) -> dict[Expression, str]:
    """Returns the params by their numbers: one that is passed on as it is stays the same expression."""
    names: dict[Expression, str] = {}
    for structure in root.walk():
        assert isinstance(structure.scope, Scope)
        for scope in structure.scope.chain():
            for name, binding in scope.values.items():
                if isinstance(binding, ParamBinding) and isinstance(binding.known, Num):
                    names[binding.known.expression] = name
    return names


def dimensions(model: SolvedModel, drawing: Drawing) -> list[tuple[Dimension, ...]]:
    """Returns all dimensions, each place once; equal ones of one group stand together and are to be shown
    once. The more important come first, that of the whole before all.
    """
    tolerance = 1e-6 * drawing.size
    stated = _grouped([*overall(drawing), *features.left_of(model.sizes, model.root)], tolerance)
    # A diameter tells width and height of what is round.
    rounds = [g[0].curve for g in stated if isinstance(g[0], Roundness) and isinstance(g[0].curve, Circle)]
    stated = [
        g for g in stated if g[0].origin != "overall" or not any(_spans(c, g[0], tolerance) for c in rounds)
    ]
    everything = [d for g in stated for d in g]
    everything += [d for g in stated for d in features.pattern_pitches(g, tolerance)]
    return sorted(_grouped(everything, tolerance), key=lambda g: not _is_overall(g[0], drawing))


def _grouped(found: Iterable[Dimension], tolerance: float) -> list[tuple[Dimension, ...]]:
    groups: dict[object, list[Dimension]] = {}
    places: set[object] = set()
    for dimension in sorted(found, key=lambda d: RANKS.index(d.origin)):
        place = _place(dimension, tolerance)
        if dimension.value > NO_LENGTH and place not in places:
            places.add(place)
            key = (dimension.group or place, type(dimension), round(dimension.value / tolerance))
            groups.setdefault(key, []).append(dimension)
    return [tuple(g) for g in groups.values()]


def _spans(circle: Circle | Arc, whole: Dimension, tolerance: float) -> bool:
    assert isinstance(whole, Length)
    low = features.dot(circle.center, whole.along) - circle.radius
    same = abs(2 * circle.radius - whole.value) <= tolerance
    return same and abs(low - features.dot(whole.start[0], whole.along)) <= tolerance


def overall(drawing: Drawing) -> Iterator[Length]:
    """Yields width and height of all that is drawn."""
    curves = [p for b in drawing.bodies for loop in b.region.loops for p in loop.pieces]
    curves += [p for stroke in drawing.strokes for p in stroke.pieces]
    if curves:
        for along in sk.ALONG:
            yield replace(features.length_along(curves, along), origin="overall")


def _is_overall(dimension: Dimension, drawing: Drawing) -> bool:
    if not isinstance(dimension, Length) or dimension.along not in sk.ALONG:
        return False
    axis = sk.ALONG.index(dimension.along)
    whole = drawing.box[axis + 2] - drawing.box[axis]
    return abs(dimension.value - whole) <= 1e-6 * drawing.size


def _place(dimension: Dimension, tolerance: float) -> object:
    """Returns a key that dimensions of the same place share."""

    def rounded(numbers: Iterable[float]) -> tuple[int, ...]:
        return tuple(round(n / tolerance) for n in numbers)

    match dimension:
        case Length(start=start, end=end, along=(u, v)):
            ends = sorted(p[0] * u + p[1] * v for p in (start[0], end[0]))
            across = [] if (u, v) in sk.ALONG else [p[1] * u - p[0] * v for p in (start[0], end[0])]
            return Length, rounded([*ends, *across, u * 100 * tolerance, v * 100 * tolerance])
        case Roundness(curve=curve):
            return Roundness, rounded([*curve.center, curve.radius])
        case Opening(corner=corner, first=first, value=value):
            return Opening, rounded(corner), round(first * 100), round(value * 100)
        case _:
            raise TypeError(dimension)

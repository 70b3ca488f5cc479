"""The marks of dimensions, in the manner of ISO 129-1, and what a further one would cover on its sheet."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.prose import fixed
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.export.marks import CAPITAL, DIMENSION, Area, Block, Curves, Ink, Mark, Text, arrowhead
from aidl_lang.geometry.curves import Arc, Bounds, Circle, Line, Piece, Vec, union_bounds
from aidl_lang.geometry.dimensions.features import dot
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.intersect import from_sides
from aidl_lang.geometry.solved import Dimension, Length, Opening, Roundness

# --- The marks of one dimension at a given place, in the manner of ISO 129-1: extension lines, a dimension
# line with arrowheads, and the value above it, to be read from below or from the right.

Segment: TypeAlias = tuple[Vec, Vec]

HEIGHT = 3.5
"""Height of digits on paper, mm."""
HEAD, HEAD_WIDTH, GAP, BEYOND, RAISED, LINE = 3.0, 1.0, 1.0, 2.0, 1.3, 0.18
"""Arrowheads, gaps before and ends of extension lines, values above their line, line width: mm on paper."""
DIGIT = 0.64
"""Width of a digit relative to the size of the font."""


@record()
class PlacedDimension:
    """A dimension at its place: lines with arrowheads (tip and direction), extension lines, the value,
    crosses (centre and length of arms) at ends off any outline, a circle through centres.
    """

    lines: tuple[Segment, ...]
    extensions: tuple[Segment, ...]
    heads: tuple[tuple[Vec, Vec], ...]
    text: Text
    arc: Arc | None = None
    crosses: tuple[tuple[Vec, float], ...] = ()
    ring: Circle | None = None


@record()
class Pen:
    """The scale of the marks. `mm`: a millimetre on paper in units of the drawing."""

    mm: float

    @property
    def font(self) -> float:
        return HEIGHT / CAPITAL * self.mm

    def width(self, text: str) -> float:
        return DIGIT * self.font * len(text)

    def block(self, text: Text, clear: float = 0.4) -> Block:
        """Returns the rectangle of a text of digits with `clear` (mm on paper) around it."""
        air, half = clear * self.mm, DIGIT * text.size * len(text.text) / 2
        return Block(text.at, text.angle, (-half - air, -air, half + air, CAPITAL * text.size + air))

    def head_block(self, head: tuple[Vec, Vec]) -> Block:
        tip, (u, v) = head
        half = HEAD_WIDTH / 2 * self.mm
        return Block(tip, math.degrees(math.atan2(v, u)), (-HEAD * self.mm, -half, 0.0, half))

    def text(self, words: str, middle: Vec, angle: float = 0.0) -> Text:
        return Text(middle, words, self.font, DIMENSION, "middle", angle=angle)

    def marks(self, placed: PlacedDimension) -> Iterator[Mark]:
        ink = Ink(DIMENSION, LINE * self.mm)
        for role, segments in (("extension", placed.extensions), ("dimension", placed.lines)):
            if segments:
                yield Curves(tuple(Line(*s) for s in segments), ink, role)
        if placed.ring is not None:
            yield Curves((placed.ring,), replace(ink, dash=(4 * self.mm, 1.2 * self.mm)), "center")
        for (x, y), arm in placed.crosses:
            cross = Line((x - arm, y), (x + arm, y)), Line((x, y - arm), (x, y + arm))
            yield Curves(cross, ink, "center")
        if placed.arc is not None:
            yield Curves((placed.arc,), ink, "dimension")
        for head in placed.heads:
            face = arrowhead(*head, HEAD * self.mm, HEAD_WIDTH * self.mm)
            yield Area(face, DIMENSION, None, "arrow")
        yield placed.text

    def box_of(self, placed: PlacedDimension) -> Bounds:
        segments = [*placed.lines, *placed.extensions]
        boxes = [(min(a[0], b[0]), min(a[1], b[1]), max(a[0], b[0]), max(a[1], b[1])) for a, b in segments]
        return union_bounds(
            [self.block(placed.text).box, *(self.head_block(h).box for h in placed.heads), *boxes]
        )

    # --- Kinds -------------------------------------------------------------------------------------

    def straight(self, of: Length, words: str, level: float, after: bool) -> PlacedDimension:
        """Places a length with its line at `level` across its direction. A value without room between the
        ends stands after the second, or before the first.
        """
        mm, (u, v) = self.mm, of.along
        n = -v, u

        def at(along: float, across: float) -> Vec:
            return along * u + across * n[0], along * v + across * n[1]

        low, high = (dot(p[0], of.along) for p in (of.start, of.end))
        room, width = high - low, self.width(words)
        is_tight = room < 2.5 * HEAD * mm
        fits = room >= width + 0.5 * mm
        tail = 2 * HEAD * mm if is_tight else 0.0
        first, last = low - tail, high + tail
        middle = (low + high) / 2
        if not fits:
            aside = (HEAD + 1) * mm if is_tight else BEYOND * mm
            if after:
                last, middle = high + aside + width + mm, high + aside + width / 2
            else:
                first, middle = low - aside - width - mm, low - aside - width / 2
        sense = -1.0 if is_tight else 1.0
        ways = (-sense * u, -sense * v), (sense * u, sense * v)
        angle = math.degrees(math.atan2(v, u))
        text = self.text(words, at(middle, level + RAISED * mm), angle)
        extensions = []
        for pair, along in ((of.start, low), (of.end, high)):
            across = min((dot(p, n) for p in pair), key=lambda c: abs(c - level))
            side = math.copysign(1.0, level - across)
            if abs(level - across) > 1.5 * GAP * mm:
                extensions.append(
                    (at(along, across + side * GAP * mm), at(along, level + side * BEYOND * mm))
                )
        line = at(first, level), at(last, level)
        heads = (at(low, level), ways[0]), (at(high, level), ways[1])
        return PlacedDimension((line,), tuple(extensions), heads, text)

    def leader(self, tip: Vec, way: Vec, reach: float, to_right: bool, words: str) -> PlacedDimension:
        """Places a leader from a round outline along `way`, with the value on its shoulder."""
        mm, width = self.mm, self.width(words)
        elbow = tip[0] + reach * way[0], tip[1] + reach * way[1]
        side = 1.0 if to_right else -1.0
        end = elbow[0] + side * (width + mm), elbow[1]
        text = self.text(words, ((elbow[0] + end[0]) / 2, elbow[1] + RAISED * mm))
        head = tip, (-way[0], -way[1])
        return PlacedDimension(((tip, elbow), (elbow, end)), (), (head,), text)

    def angle(self, of: Opening, words: str, radius: float) -> PlacedDimension:
        """Places an angle as an arc between its two arms."""
        mm, corner = self.mm, of.corner
        first, last = math.radians(of.first), math.radians(of.first + of.value)

        def at(angle: float, r: float) -> Vec:
            return corner[0] + r * math.cos(angle), corner[1] + r * math.sin(angle)

        is_tight = radius * (last - first) < 2.5 * HEAD * mm
        tail = 2 * HEAD * mm / radius if is_tight else 0.0
        arc = Arc(corner, radius, at(first - tail, radius), at(last + tail, radius), last - first + 2 * tail)
        sense = -1.0 if is_tight else 1.0
        heads = []
        for angle, turn in ((first, -sense), (last, sense)):
            # A straight arrowhead lies on the arc when it points along the chord of its own length.
            lean = angle - turn * HEAD * mm / (2 * radius)
            heads.append((at(angle, radius), (-turn * math.sin(lean), turn * math.cos(lean))))
        middle = (first + last) / 2
        c, s = math.cos(middle), math.sin(middle)
        away = radius + RAISED * mm + abs(c) * self.width(words) / 2 + abs(s) * HEIGHT * mm / 2
        x, y = at(middle, away)
        extensions = []
        for angle, (near, far) in zip((first, last), of.arms, strict=True):
            if far < radius - GAP * mm:
                extensions.append((at(angle, max(far, 0.0) + GAP * mm), at(angle, radius + BEYOND * mm)))
            elif near > radius + GAP * mm:
                extensions.append((at(angle, near - GAP * mm), at(angle, radius - BEYOND * mm)))
        return PlacedDimension(
            (), tuple(extensions), tuple(heads), self.text(words, (x, y - HEIGHT * mm / 2)), arc
        )


def words_of(of: Dimension, count: int = 1) -> str:
    """Returns `10× ⌀8`: the value with at most two decimals, more only if nothing would be left."""
    decimals = 2 if of.value >= 0.1 else min(12, 1 - math.floor(math.log10(of.value)))
    number = fixed(of.value, decimals)
    match of:
        case Roundness():
            number = of.label or f"{'⌀' if of.kind == 'diameter' else 'R'}{number}"
        case Opening():
            number += "°"
    number += _tolerance(of) + (f" {of.remark}" if of.remark else "")
    number = f"{count}× {number}" if count > 1 else number
    return f"({number})" if of.is_auxiliary else number


def _tolerance(of: Dimension) -> str:
    """Returns what stands behind a value: ± as one number, other limits with the fit that they belong to."""
    fit = f" {of.fit}" if of.fit else ""
    if of.limits is None:
        return fit
    low, high = of.limits
    unit = "°" if isinstance(of, Opening) else ""
    if -low == high:
        return f"{fit} ±{fixed(high, 4)}{unit}"
    return f"{fit} ({_signed(high)}/{_signed(low)})"


def _signed(value: float) -> str:
    return f"{'+' if value > 0 else ''}{fixed(value, 4)}"


# --- The marks on a sheet so far, and what a further dimension would cover or cross.

Segments = NDArray[np.float64]
"""Shape (n, 4): x and y of both ends."""

CLEAR = 1.8
"""Around a value, mm on paper."""
ROOM = 5.5
"""Between a dimension line and another that runs beside it, mm on paper; half of it to an outline."""

_FINE, _COARSE, _MANY = 24, 8, 800


class Sheet:
    """Outlines as short segments; values and arrowheads as boxes; lines of the dimensions placed so far."""

    def __init__(self, drawing: Drawing, pen: Pen) -> None:
        bodies = {
            b.path: _chords([p for loop in b.region.loops for p in loop.pieces]) for b in drawing.bodies
        }
        strokes = _chords([p for s in drawing.strokes for p in s.pieces])
        self.pen, self.box = pen, drawing.box
        self.edges = np.concatenate((np.empty((0, 4)), *bodies.values()))
        for pair in drawing.pairs:
            if pair.relation == "overlapping":
                bodies[pair.a] = _uncovered(bodies[pair.a], bodies[pair.b])
        self.outlines = np.concatenate((strokes, *bodies.values()))
        self.texts: list[Block] = []
        self.heads: list[Block] = []
        self._lines: list[Segment] = []
        self._extensions: list[Segment] = []
        self.lines = self.extensions = np.empty((0, 4))

    def add(self, placed: PlacedDimension) -> None:
        self.texts.append(self.pen.block(placed.text))
        self.heads += map(self.pen.head_block, placed.heads)
        self._lines += _all_lines(placed)
        self._extensions += placed.extensions
        self.lines, self.extensions = _array(self._lines), _array(self._extensions)

    def is_free(self, placed: PlacedDimension) -> bool:
        """True if its value keeps clear of others' values, arrowheads and lines, and theirs of its own."""
        text = self.pen.block(placed.text)
        heads = list(map(self.pen.head_block, placed.heads))
        if any(text.overlaps(other) for other in (*self.texts, *self.heads, *heads)):
            return False
        if crossings(self.lines, text) or any(h.overlaps(other) for h in heads for other in self.texts):
            return False
        lines = _array(_all_lines(placed))
        return not any(crossings(lines, other) for other in self.texts)

    def harm(self, placed: PlacedDimension) -> float:
        """Returns the cost of a place: what its value covers and its lines cross."""
        checkpoint()
        text, lines = self.pen.block(placed.text, CLEAR), _array(_all_lines(placed))
        extensions = _array(placed.extensions)
        cost = 6.0 * min(crossings(self.outlines, text), 4) + 2.0 * crossings(self.extensions, text)
        cost += 3.0 * self._crossed(lines, self.lines) + 2.5 * self._crossed(lines, self.extensions)
        cost += 2.0 * self._crossed(extensions, self.lines)
        for line in placed.lines if len(placed.heads) == 2 else ():
            cost += 3.0 * crossings(self.lines, self._lane(line, ROOM))
            cost += 2.0 * min(crossings(self.outlines, self._lane(line, ROOM / 2)), 4)
        cost += 1.5 * sum(crossings(extensions, other) for other in self.texts)
        return cost + 1.2 * min(self._crossed(lines, self.outlines), 8)

    def _lane(self, line: Segment, room: float) -> Block:
        """Returns the strip that a line should have for itself."""
        (x0, y0), (x1, y1) = line
        short, across = 0.5 * self.pen.mm, room * self.pen.mm
        angle = math.degrees(math.atan2(y1 - y0, x1 - x0))
        return Block((x0, y0), angle, (short, -across, math.hypot(x1 - x0, y1 - y0) - short, across))

    def covers_material(self, placed: PlacedDimension) -> bool:
        left, bottom, right, top = self.pen.block(placed.text).box
        return self.is_material(((left + right) / 2, (bottom + top) / 2))

    def is_material(self, p: Vec) -> bool:
        """True for a point in a body: an odd number of edges is above it."""
        return bool(_inside(np.array([p]), self.edges)[0])

    def is_drawn(self, p: Vec) -> bool:
        """True if an outline runs through the point."""
        checkpoint()
        reach = 1.2 * self.pen.mm
        near = _within(self.outlines, (p[0] - reach, p[1] - reach, p[0] + reach, p[1] + reach))
        if not len(near):
            return False
        return bool(from_sides(np.array(p) - near[:, :2], near[:, 2:] - near[:, :2]).min() < reach)

    def seen(self, points: tuple[Vec, ...]) -> tuple[Vec, ...]:
        """Returns the points on an outline, else such between them: the end of an edge may be hidden."""
        (x0, y0), (x1, y1) = points[0], points[-1]
        between = tuple((x0 + k / 12 * (x1 - x0), y0 + k / 12 * (y1 - y0)) for k in range(1, 12))
        return next(filter(None, (tuple(filter(self.is_drawn, spots)) for spots in (points, between))), ())

    @staticmethod
    def _crossed(lines: Segments, others: Segments) -> int:
        return sum(_cross(line, others) for line in lines) if len(others) else 0


def _inside(spots: NDArray[np.float64], edges: Segments) -> NDArray[np.bool_]:
    """Marks the points inside the edges: an odd number of edges is above them."""
    x0, y0, x1, y1 = edges.T
    found = np.zeros(len(spots), dtype=bool)
    for k, (x, y) in enumerate(spots):
        checkpoint()
        over = (x0 > x) != (x1 > x)
        height = y0[over] + (x - x0[over]) * (y1[over] - y0[over]) / (x1[over] - x0[over])
        found[k] = np.count_nonzero(height > y) % 2
    return found


def _uncovered(outline: Segments, cover: Segments) -> Segments:
    """Returns the segments of an outline that `cover`, drawn later, does not hide."""
    middles = (outline[:, :2] + outline[:, 2:]) / 2
    ends = cover.reshape(-1, 2)
    near = np.all((middles > ends.min(axis=0)) & (middles < ends.max(axis=0)), axis=1)
    near[near] = _inside(middles[near], cover)
    uncovered: Segments = outline[~near]
    return uncovered


def crossings(segments: Segments, block: Block) -> int:
    """Counts the segments that meet a rectangle."""
    segments = _within(segments, block.box)
    if not len(segments):
        return 0
    turn, box = np.array(block.axes).T, block.sides
    segments = ((segments.reshape(-1, 2) - np.array(block.at)) @ turn).reshape(-1, 4)
    start, way = segments[:, :2], segments[:, 2:] - segments[:, :2]
    with np.errstate(divide="ignore", invalid="ignore"):
        low = (np.array(box[:2]) - start) / way
        high = (np.array(box[2:]) - start) / way
    # Along an axis in which a segment does not extend, it is in the box always or never.
    still = way == 0
    within = (start > np.array(box[:2])) & (start < np.array(box[2:]))
    enter = np.where(still, np.where(within, -np.inf, np.inf), np.minimum(low, high)).max(axis=1)
    leave = np.where(still, np.where(within, np.inf, -np.inf), np.maximum(low, high)).min(axis=1)
    return int(np.count_nonzero(np.maximum(enter, 0) < np.minimum(leave, 1)))


def broken(segment: Segment, blocks: Iterable[Block]) -> list[Segment]:
    """Returns the parts of a line that blocks do not interrupt."""
    parts = [segment]
    for block in blocks:
        parts = [piece for part in parts for piece in _around(part, block)]
    return parts


def _around(segment: Segment, block: Block) -> list[Segment]:
    (x0, y0), (x1, y1) = segment
    start, way = (x0 - block.at[0], y0 - block.at[1]), (x1 - x0, y1 - y0)
    low, high = 0.0, 1.0
    for axis, near, far in zip(block.axes, block.sides[:2], block.sides[2:], strict=True):
        at, go = (v[0] * axis[0] + v[1] * axis[1] for v in (start, way))
        if abs(go) < 1e-12:
            if not near < at < far:
                return [segment]
            continue
        a, b = sorted(((near - at) / go, (far - at) / go))
        low, high = max(low, a), min(high, b)
    if low >= high:
        return [segment]
    first, last = ((x0 + t * way[0], y0 + t * way[1]) for t in (low, high))
    return [part for part, keep in ((((x0, y0), first), low > 0), ((last, (x1, y1)), high < 1)) if keep]


def _within(segments: Segments, box: Bounds) -> Segments:
    """Returns the segments whose own boxes meet `box`; the others cannot meet it."""
    if not len(segments):
        return segments
    x0, y0, x1, y1 = segments.T
    beyond = (np.maximum(x0, x1) < box[0]) | (np.minimum(x0, x1) > box[2])
    beyond |= (np.maximum(y0, y1) < box[1]) | (np.minimum(y0, y1) > box[3])
    within: Segments = segments[~beyond]
    return within


def _cross(line: NDArray[np.float64], others: Segments) -> int:
    """Counts the segments that a line truly crosses, not merely touches."""
    x, y = sorted(line[::2].tolist()), sorted(line[1::2].tolist())
    others = _within(others, (x[0], y[0], x[1], y[1]))
    p, r = line[:2], line[2:] - line[:2]
    q, s = others[:, :2], others[:, 2:] - others[:, :2]
    cross = r[0] * s[:, 1] - r[1] * s[:, 0]
    offset = q - p
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (offset[:, 0] * s[:, 1] - offset[:, 1] * s[:, 0]) / cross
        k = (offset[:, 0] * r[1] - offset[:, 1] * r[0]) / cross
    slack = 1e-6
    found = (t > slack) & (t < 1 - slack) & (k > -slack) & (k < 1 + slack) & (cross != 0)
    return int(np.count_nonzero(found))


def _chords(pieces: Sequence[Piece]) -> Segments:
    count = _FINE if len(pieces) < _MANY else _COARSE
    t = np.linspace(0, 1, count + 1)
    found = [np.empty((0, 4))]
    for piece in pieces:
        spots = np.array(piece.ends) if isinstance(piece, Line) else piece.points(t)
        found.append(np.concatenate((spots[:-1], spots[1:]), axis=1))
    return np.concatenate(found)


def _all_lines(placed: PlacedDimension) -> list[Segment]:
    if placed.arc is None:
        return [*placed.lines]
    return [*placed.lines, *pairwise(placed.arc.point(k / 12) for k in range(13))]


def _array(segments: Sequence[Segment]) -> Segments:
    return np.array([(*a, *b) for a, b in segments]).reshape(-1, 4)

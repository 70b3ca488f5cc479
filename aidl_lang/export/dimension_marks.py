"""The marks of one dimension at a given place, in the manner of ISO 129-1: extension lines, a dimension line
with arrowheads, and the value above it, to be read from below or from the right.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import TypeAlias

from aidl_lang.common.numbers import fixed
from aidl_lang.common.records import record
from aidl_lang.export import palette
from aidl_lang.export.marks import Area, Curves, Ink, Mark, Text, polygon
from aidl_lang.geometry.curves import Arc, Circle, Line, Vec
from aidl_lang.geometry.evaluate import Bounds, point
from aidl_lang.geometry.network import union_bounds
from aidl_lang.geometry.solved import Dimension, Length, Opening, Roundness

Segment: TypeAlias = tuple[Vec, Vec]

HEIGHT, CAPITAL = 3.5, 0.73
"""Height of digits on paper in mm, and relative to the size of the font."""
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
class Block:
    """A rectangle turned by `angle` degrees about `at`; `sides` in its own frame."""

    at: Vec
    angle: float
    sides: Bounds

    @cached_property
    def axes(self) -> tuple[Vec, Vec]:
        c, s = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        return (c, s), (-s, c)

    @cached_property
    def corners(self) -> tuple[Vec, ...]:
        (c, s), _ = self.axes
        left, bottom, right, top = self.sides
        at = ((left, bottom), (right, bottom), (right, top), (left, top))
        return tuple((self.at[0] + c * x - s * y, self.at[1] + s * x + c * y) for x, y in at)

    @cached_property
    def box(self) -> Bounds:
        xs, ys = zip(*self.corners, strict=True)
        return min(xs), min(ys), max(xs), max(ys)

    def overlaps(self, other: Block) -> bool:
        """Tells whether two rectangles overlap: no side of one has the other beyond it."""
        a, b = self.box, other.box
        if a[0] >= b[2] or b[0] >= a[2] or a[1] >= b[3] or b[1] >= a[3]:
            return False
        for axis in (*self.axes, *other.axes):
            (low, high), (first, last) = (_range(block.corners, axis) for block in (self, other))
            if high <= first or last <= low:
                return False
        return True


def _range(points: tuple[Vec, ...], axis: Vec) -> tuple[float, float]:
    along = [_dot(p, axis) for p in points]
    return min(along), max(along)


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

    def _triangle(self, tip: Vec, way: Vec) -> tuple[Vec, Vec, Vec]:
        """Returns an arrowhead that points along `way`."""
        (x, y), (u, v) = tip, way
        back, half = HEAD * self.mm, HEAD_WIDTH / 2 * self.mm
        return (
            tip,
            (x - back * u - half * v, y - back * v + half * u),
            (x - back * u + half * v, y - back * v - half * u),
        )

    def text(self, words: str, middle: Vec, angle: float = 0.0) -> Text:
        return Text(middle, words, self.font, palette.DIMENSION, "middle", angle=angle)

    def marks(self, placed: PlacedDimension) -> Iterator[Mark]:
        ink = Ink(palette.DIMENSION, LINE * self.mm)
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
            yield Area(polygon(*self._triangle(*head)), palette.DIMENSION, None, "arrow")
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

        low, high = (_dot(p[0], of.along) for p in (of.start, of.end))
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
        for points, along in ((of.start, low), (of.end, high)):
            across = min((_dot(p, n) for p in points), key=lambda c: abs(c - level))
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


def arc_segments(arc: Arc) -> list[Segment]:
    spots = [point(arc, k / 12) for k in range(13)]
    return list(pairwise(spots))


def _dot(p: Vec, q: Vec) -> float:
    return p[0] * q[0] + p[1] * q[1]

"""Outlines as machines follow them: nothing but lines and arcs, and no piece too short to be cut.

Curves are fitted by pairs of arcs. A pair has the ends and the directions of the part it stands for, so that
arcs run on smoothly wherever the curve does; a part whose pair departs too far is halved. Lines and arcs long
enough to be cut stay what they are.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TypeVar

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Arc, Circle, Floats, Line, Piece, Vec, turn_between
from aidl_lang.geometry.intersect import from_sides
from aidl_lang.geometry.region import Face, Loop, Region, length

T = TypeVar("T")

SHORTEST = 3.0
"""Pieces shorter than so many tolerances are not left where a machine is to follow."""
JOINED = 10.0
"""Lines and arcs shorter than so many become part of a curve that runs on from them."""
FINEST = 1e-7
"""The least tolerance, relative to the size of the outline: past it arcs without number would say no more."""
COARSEST = 0.01
"""The greatest, likewise: outlines smaller than a tolerance would become something else."""
_SMOOTH = math.radians(1)
"""Pieces whose directions differ by less run on: fitting curves and parallels leaves such bends."""
_WIDEST = 2.0
"""Most radians that one arc of a pair goes through."""
_STRAIGHT = 1e-9
"""Height of an arc over its chord, relative to it, up to which it is a line."""
_PROBES = np.linspace(0, 1, 17)
_FEWEST, _MOST = 16, 4096
"""Samples of a piece that is fitted."""
_GRAIN = 1 / 32
"""Share of the tolerance by which a curve may depart from the chords between its samples."""
_FEWEST_LEFT = 3
"""Stretches of an outline: with fewer it might be flat."""
_LEEWAY = 0.9
"""Share of the tolerance by which a corner may move."""


def as_arcs(pieces: Sequence[Piece], closed: bool, tolerance: float) -> tuple[Piece, ...]:
    """Returns lines and arcs (or a circle) that are within a tolerance of the pieces, and these of them."""
    return _Outline(pieces, closed, tolerance).pieces()


def has_slivers(pieces: Sequence[Piece], tolerance: float) -> bool:
    """Tells whether some of several pieces are too short to be cut."""
    return len(pieces) > 1 and min(map(length, pieces)) < SHORTEST * tolerance


@record(slots=True)
class _Stretch:
    """Pieces that are drawn as one; `has_corners`: they do not run on smoothly."""

    pieces: tuple[Piece, ...]
    has_corners: bool = False

    @property
    def start(self) -> Vec:
        return self.pieces[0].ends[0]

    @property
    def end(self) -> Vec:
        return self.pieces[-1].ends[1]

    @property
    def length(self) -> float:
        return sum(map(length, self.pieces))


class _Outline:
    """Pieces end to end, to be drawn anew within a tolerance; only short lines and arcs change."""

    def __init__(self, pieces: Sequence[Piece], closed: bool, tolerance: float) -> None:
        self._whole, self._closed = tuple(pieces), closed
        spots = np.concatenate([p.points(_PROBES) for p in pieces])
        size = float(np.ptp(spots, axis=0).max())
        self._tolerance = min(max(tolerance, FINEST * size), COARSEST * size)
        self._shortest, self._joined = SHORTEST * self._tolerance, JOINED * self._tolerance

    def pieces(self) -> tuple[Piece, ...]:
        if len(self._whole) == 1 and isinstance(self._whole[0], Circle | Line | Arc):
            return self._whole
        stretches = self._with_few_short(self._stretches())
        places = self._places(stretches)
        found: list[Piece] = []
        for stretch, (start, end) in zip(stretches, places, strict=True):
            checkpoint()
            if start != end or len(stretches) == 1:
                found += self._drawn(stretch, start, end)
        return tuple(found)

    def _stretches(self) -> list[_Stretch]:
        """Returns the pieces in stretches: each by itself that can stay, the others as long as they run on
        smoothly. A closed outline begins where one of them does.
        """
        pieces = self._whole
        exact = [isinstance(p, Line | Arc) and length(p) >= self._joined for p in pieces]
        runs_on = [
            not (exact[k - 1] or exact[k])
            and abs(turn_between(pieces[k - 1].direction(1.0), pieces[k].direction(0.0))) < _SMOOTH
            for k in range(len(pieces))
        ]
        return [_Stretch(group) for group in self._grouped(pieces, runs_on, runs_on)]

    def _with_few_short(self, stretches: Sequence[_Stretch]) -> list[_Stretch]:
        """Returns the stretches with those that are too short and follow each other made one."""
        is_short = [s.length < self._shortest for s in stretches]
        follows = [is_short[k - 1] and is_short[k] for k in range(len(stretches))]
        return [
            group[0]
            if len(group) == 1
            else _Stretch(tuple(p for s in group for p in s.pieces), has_corners=True)
            for group in self._grouped(stretches, follows, is_short)
        ]

    def _grouped(
        self, things: Sequence[T], follows: Sequence[bool], is_inner: Sequence[bool]
    ) -> list[tuple[T, ...]]:
        """Returns things with those that follow the one before; a ring begins at none that is inner."""
        first = is_inner.index(False) if self._closed and False in is_inner else 0
        found: list[tuple[T, ...]] = []
        for k in (*range(first, len(things)), *range(first)):
            if found and follows[k]:
                found[-1] = (*found[-1], things[k])
            else:
                found.append((things[k],))
        return found

    def _places(self, stretches: Sequence[_Stretch]) -> list[tuple[Vec, Vec]]:
        """Returns the ends of the stretches. Both of a too short one come to where its neighbours meet."""
        starts, count = [s.start for s in stretches], len(stretches)
        starts.append(starts[0] if self._closed else stretches[-1].end)
        short = [k for k, s in enumerate(stretches) if s.length < self._shortest]
        if count - len(short) >= _FEWEST_LEFT:
            for k in short:
                before = stretches[k - 1] if k or self._closed else None
                after = stretches[(k + 1) % count] if k < count - 1 or self._closed else None
                if (place := self._merged(stretches[k], before, after)) is not None:
                    starts[k] = starts[k + 1] = place
                    if self._closed and k == count - 1:
                        starts[0] = place
                    elif self._closed and k == 0:
                        starts[-1] = place
        return list(pairwise(starts))

    def _merged(self, stretch: _Stretch, before: _Stretch | None, after: _Stretch | None) -> Vec | None:
        """Returns the place that both ends of a stretch can move to; None if that would be too far."""
        start, end = stretch.start, stretch.end
        if before is None or after is None:
            return start if before is None else end
        middle = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
        reach = _LEEWAY * 2 * self._tolerance
        tip = _crossing(start, before.pieces[-1].direction(1.0), end, after.pieces[0].direction(0.0))
        if tip is not None and math.dist(tip, middle) <= reach:
            return (tip[0] + middle[0]) / 2, (tip[1] + middle[1]) / 2
        return middle if math.dist(start, end) <= reach else None

    def _drawn(self, stretch: _Stretch, start: Vec, end: Vec) -> Iterator[Piece]:
        first = stretch.pieces[0]
        if len(stretch.pieces) == 1 and isinstance(first, Line):
            yield Line(start, end)
        elif len(stretch.pieces) == 1 and isinstance(first, Arc) and first.ends == (start, end):
            yield first
        else:
            fit = _Fit(stretch.pieces, start, end, self._tolerance)
            yield from fit.lines() if stretch.has_corners else fit.arcs()


def _crossing(p: Vec, u: Vec, q: Vec, v: Vec) -> Vec | None:
    """Returns the place where a way on from `p` meets the way back from `q`; None if they do not."""
    across = u[0] * v[1] - u[1] * v[0]
    if abs(across) < 1e-6:
        return None
    dx, dy = q[0] - p[0], q[1] - p[1]
    on, back = (dx * v[1] - dy * v[0]) / across, (dx * u[1] - dy * u[0]) / across
    return (p[0] + on * u[0], p[1] + on * u[1]) if on >= 0 >= back else None


class _Fit:
    """Arcs for pieces that run on smoothly; the first starts and the last ends where it is told to."""

    def __init__(self, pieces: Sequence[Piece], start: Vec, end: Vec, tolerance: float) -> None:
        self._tolerance = (1 - _GRAIN) * tolerance
        spots, self._at = [], list[tuple[Piece, float]]()
        for piece in pieces:
            count = piece.chords(_GRAIN * tolerance)
            count = count if isinstance(piece, Line) else max(_FEWEST, min(_MOST, count))
            spots.append(piece.points(np.arange(count) / count))
            self._at += [(piece, k / count) for k in range(count)]
        self._at.append((pieces[-1], 1.0))
        spots.append(np.array([pieces[-1].point(1.0)]))
        self._spots = np.concatenate(spots)
        steps = np.hypot(*np.diff(self._spots, axis=0).T)
        self._along = np.concatenate(([0.0], np.cumsum(steps)))
        self._start, self._end = start, end

    def arcs(self) -> Iterator[Piece]:
        stack = [(0, len(self._spots) - 1)]
        while stack:
            i, j = stack.pop()
            if (found := self._pair(i, j)) is not None:
                yield from found
                continue
            half = int(np.searchsorted(self._along, (self._along[i] + self._along[j]) / 2))
            half = min(max(half, i + 1), j - 1)
            stack += [(half, j), (i, half)]

    def lines(self) -> Iterator[Line]:
        """Yields lines as long as they can be."""
        last, i = len(self._spots) - 1, 0
        while i < last:
            j = i + 1
            while j < last and self._is_near(
                [Line(self._place(i), self._place(j + 1))], self._spots[i : j + 2]
            ):
                j += 1
            yield Line(self._place(i), self._place(j))
            i = j

    def _place(self, k: int) -> Vec:
        if k == 0:
            return self._start
        if k == len(self._spots) - 1:
            return self._end
        x, y = self._spots[k]
        return float(x), float(y)

    def _pair(self, i: int, j: int) -> list[Piece] | None:
        """Returns the arcs for the samples from `i` to `j`; None if they are to be halved."""
        start, end = self._place(i), self._place(j)
        if j - i == 1 or self._along[j] - self._along[i] <= self._tolerance:
            return [Line(start, end)] if start != end else []
        (first, t0), (last, t1) = self._at[i], self._at[j]
        found = _pair(start, first.direction(t0), end, last.direction(t1))
        return found if found is not None and self._is_near(found, self._spots[i : j + 1]) else None

    def _is_near(self, arcs: Sequence[Piece], spots: Floats) -> bool:
        """Tells whether arcs are near a part of the curve, and it is near them."""
        off = np.minimum.reduce([_distances(arc, spots) for arc in arcs])
        if off.max() > self._tolerance:
            return False
        probes = np.concatenate([arc.points(_PROBES) for arc in arcs])
        gaps = from_sides(probes[:, None, :] - spots[:-1], np.diff(spots, axis=0)).min(axis=1)
        return bool(gaps.max() <= self._tolerance)


def _pair(start: Vec, leaving: Vec, end: Vec, arriving: Vec) -> list[Piece] | None:
    """Returns two arcs that meet smoothly (or a line), with these ends and unit directions; None if they
    would go a long way round.

    Each has tangents of one length d at its two ends: |v - d (a + b)| = 2 d for the way v between the ends.
    """
    vx, vy = end[0] - start[0], end[1] - start[1]
    way = vx * vx + vy * vy
    tx, ty = leaving[0] + arriving[0], leaving[1] + arriving[1]
    a = 2 * (1 - leaving[0] * arriving[0] - leaving[1] * arriving[1])
    b = 2 * (vx * tx + vy * ty)
    below = b + math.sqrt(b * b + 4 * a * way)
    if not way > 0 or not below > 1e-9 * math.sqrt(way):
        return None
    d = 2 * way / below
    middle = (
        (start[0] + end[0] + d * (leaving[0] - arriving[0])) / 2,
        (start[1] + end[1] + d * (leaving[1] - arriving[1])) / 2,
    )
    first = _arc(start, leaving, middle)
    second = _arc(end, (-arriving[0], -arriving[1]), middle)
    if first is None or second is None:
        return None
    if isinstance(first, Line) and isinstance(second, Line):
        return [Line(start, end)]
    return [first, second.reversed()]


def _arc(start: Vec, way: Vec, end: Vec) -> Arc | Line | None:
    """Returns the arc that leaves a point in a direction and leads to another."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    chord = math.hypot(dx, dy)
    if chord == 0:
        return None
    sweep = 2 * turn_between(way, (dx, dy))
    if abs(sweep) > _WIDEST:
        return None
    if abs(sweep) < 8 * _STRAIGHT:
        return Line(start, end)
    radius = chord / (2 * math.sin(sweep / 2))  # to the left, if positive
    center = start[0] - radius * way[1], start[1] + radius * way[0]
    return Arc(center, abs(radius), start, end, sweep)


def _distances(piece: Piece, spots: Floats) -> Floats:
    (x0, y0), (x1, y1) = piece.ends
    if isinstance(piece, Line):
        return from_sides(spots - (x0, y0), np.array((x1 - x0, y1 - y0)))
    assert isinstance(piece, Arc)
    from_center = spots - piece.center
    turned = np.arctan2(from_center[:, 1], from_center[:, 0]) - piece.start_angle
    turned = np.mod(turned * math.copysign(1.0, piece.sweep), math.tau)
    off: Floats = np.abs(np.hypot(*from_center.T) - piece.radius)
    at_ends = np.minimum(np.hypot(*(spots - (x0, y0)).T), np.hypot(*(spots - (x1, y1)).T))
    return np.where(turned <= abs(piece.sweep), off, at_ends)


# --- Straight gaps about as wide as the cut of a machine, which makes them in one pass along their middle.

WIDEST = 1.5
"""Width of a gap, in cuts, up to which the second of two passes would burn most of the first again."""
_SLENDER = 3
"""Length of a slit in widths: a shorter gap is a hole."""
_PARALLEL = 1e-6


@record()
class Slit:
    """The way of a cut, and how wide the gap was drawn, mm."""

    way: Line
    width: float


def without_slits(region: Region, cut: float) -> tuple[Region, list[Slit]]:
    """Returns a region with the holes and open gaps filled that one pass of a cut makes, and these."""
    slits: list[Slit] = []
    faces = []
    for face in region.faces:
        outer, *holes = (_without(loop, cut, slits, is_hole=loop is not face.outer) for loop in face.loops)
        assert outer is not None
        faces.append(Face(outer, tuple(hole for hole in holes if hole is not None)))
    return (Region(tuple(faces)) if slits else region), slits


def _without(loop: Loop, cut: float, slits: list[Slit], *, is_hole: bool) -> Loop | None:
    """Returns an outline without its slits, which are added to those found; None for a hole that is one."""
    pieces = loop.pieces
    if is_hole and len(pieces) == 4:
        for k in (0, 1):
            a, tip, b, end = (*pieces[k:], *pieces[:k])
            if (slit := _slit((a, tip, b), cut, end.point(0.5), -cut / 2)) is not None:
                slits.append(slit)
                return None
    first = next((k for k in (-2, -1) if _open(pieces[k:] + pieces[:k], cut) is not None), 0)
    rest, kept, found = list(pieces[first:] + pieces[:first])[::-1], list[Piece](), len(slits)
    while rest:
        opened = _open(rest[:-4:-1], cut)
        if opened is None:
            kept.append(rest.pop())
            continue
        slit, mouth = opened
        slits.append(slit)
        kept.append(mouth)
        del rest[-3:]
    return replace(loop, pieces=tuple(kept)) if len(slits) > found else loop


def _open(pieces: Sequence[Piece], cut: float) -> tuple[Slit, Line] | None:
    """Returns the slit that the first three pieces of an outline are, and its mouth."""
    if len(pieces) < 3 or not isinstance(pieces[0], Line) or not isinstance(pieces[2], Line):
        return None
    mouth = Line(pieces[0].start, pieces[2].end)
    slit = _slit(pieces[:3], cut, mouth.point(0.5), cut / 2)
    return None if slit is None else (slit, mouth)


def _slit(sides: Sequence[Piece], cut: float, end: Vec, beyond: float) -> Slit | None:
    """Returns the slit between two sides and the tip between them, if they are lines and near enough. Its way
    begins half a cut within the tip, and ends beyond its other end.
    """
    a, tip, b = sides
    if not isinstance(a, Line) or not isinstance(b, Line):
        return None
    (ax, ay), (bx, by) = a.way, b.way
    long, other = math.hypot(ax, ay), math.hypot(bx, by)
    across = (b.start[0] - a.end[0], b.start[1] - a.end[1])
    # Material lies to the left of an outline, so that the way around a gap turns to the right.
    width = (ay * across[0] - ax * across[1]) / long
    if not 0 < width <= WIDEST * cut or min(long, other) < _SLENDER * max(width, cut):
        return None
    if abs(ax * by - ay * bx) > _PARALLEL * long * other or ax * bx + ay * by > 0:
        return None
    x, y = start = tip.point(0.5)
    far = math.dist(start, end)
    ux, uy = (end[0] - x) / far, (end[1] - y) / far
    ends = (x + ux * cut / 2, y + uy * cut / 2), (end[0] + ux * beyond, end[1] + uy * beyond)
    return Slit(Line(*ends), width)

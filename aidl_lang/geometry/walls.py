"""The thinnest wall and the narrowest gap of a region, and where they are.

A wall is a straight chord through the material, a gap one through the empty space beside it, that meets the
outline at a right angle at both ends. A corner counts as if it were rounded a little: a chord may end there
in any direction between the normals of its two edges. So a rectangle has the wall of its shorter side, a
circle that of its diameter, a ring, an L-profile and a comb that of their legs, and a corner where two edges
simply meet is no wall.

Where a part gets narrower towards its end, no chord is at right angles to both sides; there the end counts:
one edge or round whose two neighbours leave it at 90 to 105 degrees, from tip to tip.

Where the outline touches itself, the material hangs together by a point, and the wall is 0.

Pairs of elements of the outline are tried in growing distance from each other until nothing shorter can come.
The shortest chord that crosses nothing is the answer. Chords that end on ellipses or Bézier curves are found
on chords of the curve, and settled by Newton's method.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.materials import least_wall
from aidl_lang.common.prose import short
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.boolean import piece_distance
from aidl_lang.geometry.chords import ANGLE, Chords, Skeleton, chords, direction, joined, within
from aidl_lang.geometry.curves import Arc, Circle, Floats, Line, Vec
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import SolvedStructure

_LEAN = math.radians(15)
"""Greatest lean of each side of a narrowing end towards the other."""
_ASIDE = 1e-6
"""Distance beside a chord within which crossings are sought, relative to its length."""
_EQUAL = 1e-9
"""Part of their length by which equal chords may differ."""
_NEAR_END = 1e-4
"""Part of a chord at each end where it may touch the outline."""


@record(slots=True)
class Chord:
    """A length in mm and the two places of the outline that it joins."""

    length: float
    a: Vec
    b: Vec


class Widths(NamedTuple):
    """The least chord through the material, and through the empty space; None where there is none."""

    wall: Chord | None
    gap: Chord | None


WALL, GAP = 1, -1


def widths(region: Region) -> Widths:
    """Returns the thinnest wall and the narrowest gap of a region."""
    if not region:
        return Widths(None, None)
    outline = Skeleton(region)
    ends_of_tapers = list(_tapers(outline))
    wall, gap = (
        _ChordSearch(outline, kind, [c for k, c in ends_of_tapers if k == kind]) for kind in (WALL, GAP)
    )
    if (touch := _touch(outline)) is not None:
        wall.best, wall.is_done = Chord(0.0, touch, touch), True
    reach = outline.size / math.sqrt(len(outline))
    while searches := [s for s in (wall, gap) if not s.is_done]:
        limit = math.inf if reach >= outline.size else reach - 2 * outline.error
        useful = min(limit, max(s.bound for s in searches)) + 2 * outline.error
        some = [c.where(c.length <= useful) for c in chords(outline, reach, outline.tolerance)]
        found = joined([c for c in some if len(c)] or some[:1])
        for search in searches:
            search.run(found, limit)
        reach *= 2
    return Widths(wall.best or wall.tip, gap.best or gap.tip)


def thin_wall(region: Region, least: float) -> Chord | None:
    """Returns the thinnest wall of a region as `widths` has it, if it is shorter than `least`."""
    outline = Skeleton(region)
    if (touch := _touch(outline)) is not None:
        return Chord(0.0, touch, touch)
    search = _ChordSearch(outline, WALL, [c for kind, c in _tapers(outline) if kind == WALL])
    reach = least + 2 * outline.error
    for found in chords(outline, reach, outline.tolerance):
        search.run(found, reach)
    wall = search.best or search.tip
    return wall if wall is not None and wall.length < least else None


class _ChordSearch:
    """A search for the shortest chord of a kind; `tip` is the least end of a taper, if none is shorter."""

    def __init__(self, outline: Skeleton, kind: int, tips: list[Chord]) -> None:
        self.outline = outline
        self.kind = kind
        self.is_done = False
        self.best: Chord | None = None
        self.tip = min(tips, key=lambda c: c.length, default=None)

    @property
    def bound(self) -> float:
        """The length that a chord must not exceed, or must stay below if one was found."""
        if self.best:
            return self.best.length * (1 - _EQUAL)
        return self.tip.length * (1 + _EQUAL) if self.tip else math.inf

    def run(self, found: Chords, limit: float) -> None:
        """Looks through chords, of which there are all up to the limit."""
        o = self.outline
        mine = found.where(found.kind == self.kind)
        # Of equal chords the one that ends on edges, not on corners, is shown.
        corners = (o.first[mine.i] > 1).astype(int) + (o.first[mine.j] > 1)
        for k in np.argsort(mine.length * (1 + _EQUAL * corners), kind="stable"):
            if mine.length[k] - 2 * o.error >= self.bound:
                break
            checkpoint()
            chord = _settled(o, mine, k)
            if chord and chord.length < self.bound and _is_clear(o, chord, self.kind):
                self.best = chord
        self.is_done = self.bound <= limit


def _touch(o: Skeleton) -> Vec | None:
    """Returns a place where two parts of the outline meet that do not follow each other."""
    for found in chords(o, o.tolerance + 2 * o.error, -1.0):
        slack = np.where(o.free[found.i] | o.free[found.j], 2 * o.error, 0.0)
        close = found.where(found.length <= o.tolerance + slack)
        for i, j in zip(o.piece[close.i], o.piece[close.j], strict=True):
            ours = {int(i), o.after[i]}
            if ours.isdisjoint((int(j), o.before[j], o.after[j])):
                distance, p, _ = piece_distance(o.pieces[i], o.pieces[j])
                if distance <= o.tolerance:
                    return p
    return None


# --- Chords that end on free curves --------------------------------------------------------------


def _settled(o: Skeleton, found: Chords, k: int) -> Chord | None:
    """Returns the chord, or the one at right angles nearby where curves are neither straight nor round."""
    a, b = ((float(x), float(y)) for x, y in (found.a[k], found.b[k]))
    if not (o.free[found.i[k]] or o.free[found.j[k]]):
        return Chord(float(found.length[k]), a, b)
    one = _End(o, int(found.i[k]), float(found.s[k]), a)
    other = _End(o, int(found.j[k]), float(found.t[k]), b)
    if not _polish(one, other):
        return None
    chord = Chord(math.dist(one.at, other.at), one.at, other.at)
    return chord if chord.length > 0 and abs(chord.length - found.length[k]) <= 4 * o.error else None


class _End:
    """An end of a chord: a place on a piece at the parameter `t`, or a fixed place."""

    def __init__(self, o: Skeleton, element: int, share: float, at: Vec) -> None:
        self.piece = o.pieces[o.piece[element]]
        self.is_fixed = bool(o.first[element] > 1)
        if o.free[element]:
            self.t = float(o.first[element] + share * (o.last[element] - o.first[element]))
        else:
            is_clockwise = isinstance(self.piece, Arc) and self.piece.sweep < 0
            self.t = 1 - share if is_clockwise else share
            if isinstance(self.piece, Circle):
                turn = math.atan2(at[1] - self.piece.center[1], at[0] - self.piece.center[0])
                self.t = turn / (2 * math.pi)
        self.at = at if self.is_fixed else self.piece.point(self.t)

    def slopes(self) -> tuple[Vec, Vec]:
        return self.piece.derivative(self.t), self.piece.second_derivative(self.t)

    def move(self, step: float) -> None:
        if not self.is_fixed:
            self.t += step
            if not self.piece.is_closed:
                self.t = min(1.0, max(0.0, self.t))
            self.at = self.piece.point(self.t)


def _polish(one: _End, other: _End) -> bool:
    """Moves a chord by Newton's method to right angles to both curves; returns whether it arrived."""
    for _ in range(30):
        x, y = one.at[0] - other.at[0], one.at[1] - other.at[1]
        (p, pp), (q, qq) = one.slopes(), other.slopes()
        first = p[0] ** 2 + p[1] ** 2 + x * pp[0] + y * pp[1]
        second = q[0] ** 2 + q[1] ** 2 - x * qq[0] - y * qq[1]
        mixed = -(p[0] * q[0] + p[1] * q[1])
        matrix = np.array(((first, mixed), (mixed, second)))
        value = np.array((x * p[0] + y * p[1], -(x * q[0] + y * q[1])))
        if one.is_fixed:
            matrix[0], matrix[:, 0], value[0] = 0.0, 0.0, 0.0
        if other.is_fixed:
            matrix[1], matrix[:, 1], value[1] = 0.0, 0.0, 0.0
        long = math.hypot(x, y)
        missed = max(abs(value[0]) / (math.hypot(*p) or 1.0), abs(value[1]) / (math.hypot(*q) or 1.0))
        if missed <= 1e-12 * long:
            break
        step = np.linalg.lstsq(matrix, -value, rcond=1e-10)[0]
        one.move(float(np.clip(step[0], -0.1, 0.1)))
        other.move(float(np.clip(step[1], -0.1, 0.1)))
    return bool(missed <= 1e-7 * long)


# --- Ends of tapers ------------------------------------------------------------------------------


def _tapers(o: Skeleton) -> Iterator[tuple[int, Chord]]:
    """Yields ends towards which a part, or an opening, gets narrower (see above)."""
    for k, piece in enumerate(o.pieces):
        if piece.is_closed:
            continue
        checkpoint()
        p, q = piece.ends
        along = math.atan2(q[1] - p[1], q[0] - p[0])
        # The lean of the neighbours towards each other, as turns from the chord: a quarter is straight up.
        back = math.remainder(direction(o.pieces[o.before[k]], 1.0) + math.pi - along, 2 * math.pi)
        on = math.remainder(direction(o.pieces[o.after[k]], 0.0) - along, 2 * math.pi)
        kind = WALL if back > 0 else GAP
        leans = (kind * back - math.pi / 2, math.pi / 2 - kind * on)
        length = math.dist(p, q)
        if length and all(-ANGLE <= lean <= _LEAN for lean in leans):
            chord = Chord(length, p, q)
            if isinstance(piece, Line) or _is_clear(o, chord, kind):
                yield kind, chord


# --- What lies between the ends ------------------------------------------------------------------


def _is_clear(o: Skeleton, chord: Chord, kind: int) -> bool:
    """Tells whether a chord runs through its kind of space alone.

    It is looked at a little to its left and right, so that a corner it passes by does not count, and one
    through which it enters something does. A chord that runs along an edge is none.
    """
    way = np.subtract(chord.b, chord.a)
    beside = _ASIDE * np.array((-way[1], way[0]))
    starts = [chord.a + sign * beside for sign in (1, -1)]
    margin = min(0.25, _NEAR_END + 4 * o.error / chord.length)
    within_kind = [start for start in starts if _covers(o, start + way / 2) == (kind == WALL)]
    if len(within_kind) < len(starts) and _runs_along(o, chord):
        return False
    return any(not _crosses(o, start, way, margin) for start in within_kind)


def _runs_along(o: Skeleton, chord: Chord) -> bool:
    """Tells whether the middle of a chord lies on a line of the outline in its direction."""
    n = o.straight
    middle = np.array(((chord.a[0] + chord.b[0]) / 2, (chord.a[1] + chord.b[1]) / 2))
    offset = middle - o.start[:n]
    along = (offset * o.way).sum(axis=1)
    across = np.abs(o.way[:, 0] * offset[:, 1] - o.way[:, 1] * offset[:, 0])
    return bool(np.any((across <= _ASIDE * chord.length) & (along > 0) & (along < o.length)))


def _crosses(o: Skeleton, start: Floats, way: Floats, margin: float) -> bool:
    """Tells whether a segment crosses the outline, its parts near the ends aside."""
    n = o.straight
    length = float(np.hypot(way[0], way[1]))
    offset = o.start[:n] - start
    cross = way[0] * o.way[:, 1] - way[1] * o.way[:, 0]
    steep = np.abs(cross) > 1e-12 * length
    cross = np.where(steep, cross, 1.0)
    u = (offset[:, 0] * o.way[:, 1] - offset[:, 1] * o.way[:, 0]) / cross
    v = (offset[:, 0] * way[1] - offset[:, 1] * way[0]) / cross
    if np.any(steep & (u > margin) & (u < 1 - margin) & (v >= 0) & (v <= o.length)):
        return True
    center, r = o.start[n:] - start, o.radius
    foot = center @ way / length
    square = r * r - (way[0] * center[:, 1] - way[1] * center[:, 0]) ** 2 / length**2
    half = np.sqrt(np.maximum(square, 0.0))
    for sign in (1, -1):
        u = (foot + sign * half) / length
        spot = u[:, None] * way - center
        on = within(np.arctan2(spot[:, 1], spot[:, 0]), o.middle, o.half, 0.0)
        if np.any((r > 0) & (square > 0) & (u > margin) & (u < 1 - margin) & on):
            return True
    return False


def _covers(o: Skeleton, spot: Floats) -> bool:
    """Tells whether a place lies in the material: how often the outline goes round it, by angles seen."""
    n = o.straight
    turns = _seen(o.start[:n] - spot, o.start[:n] + o.way * o.length[:, None] - spot).sum()
    is_arc = o.radius > 0
    center, r = o.start[n:][is_arc] - spot, o.radius[is_arc, None]
    middle, half, side = o.middle[is_arc], o.half[is_arc], o.side[is_arc]
    whole = half > math.pi - 1e-12
    first, last = middle - side * half, middle + side * half
    begin = center + r * np.stack((np.cos(first), np.sin(first)), axis=1)
    end = center + r * np.stack((np.cos(last), np.sin(last)), axis=1)
    chord = end - begin
    # Between an arc and its chord the arc is seen the other way round.
    right = side * (chord[:, 1] * begin[:, 0] - chord[:, 0] * begin[:, 1])
    within_circle = np.hypot(center[:, 0], center[:, 1]) < r[:, 0]
    between = within_circle & (whole | (right < 0))
    turns += np.where(whole, 0.0, _seen(begin, end)).sum() + 2 * math.pi * (side * between).sum()
    return bool(turns > math.pi)


def _seen(a: Floats, b: Floats) -> Floats:
    """Returns the signed angles under which segments are seen from the origin."""
    angles: Floats = np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(axis=1))
    return angles


# --- Finds walls that are thinner than their material allows.


def thin_wall_notes(
    root: SolvedStructure, bodies: Sequence[tuple[str, Region, str | None]]
) -> Iterator[Diagnostic]:
    """Yields a warning for each body, with its region and material, that is somewhere too thin."""
    spans = {s.path: s.span for s in root.walk()}
    for path, region, material in bodies:
        least = least_wall(material) if material and region else None
        wall = thin_wall(region, least) if least is not None else None
        if wall is None or least is None:
            continue
        x, y = ((a + b) / 2 for a, b in zip(wall.a, wall.b, strict=True))
        yield Diagnostic(
            "W0715",
            f"`{path}` is {short(wall.length, 3)} mm wide at ({short(x, 3)}, {short(y, 3)}), and walls of "
            f"{material} hold from {short(least)} mm",
            spans.get(path),
            "too thin there",
            hints=("`aidl measure` shows the thinnest wall of each part",),
        )

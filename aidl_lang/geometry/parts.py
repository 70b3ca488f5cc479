"""The parts of a drawing, each by itself, with what is engraved on it."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.geometry.boolean import Contacts, clipped_each, common, without
from aidl_lang.geometry.curves import (
    NO_LENGTH,
    Bounds,
    Piece,
    are_near,
    bounds,
    inward,
    larger_side,
    union_bounds,
)
from aidl_lang.geometry.drawing import SLIT, Body, Drawing, Seam, Stroke
from aidl_lang.geometry.legibility import Holders, owner
from aidl_lang.geometry.region import Region, face_polygons, length, region_bounds
from aidl_lang.geometry.solved import SolvedStructure

# --- The parts that drawings are engraved on, for drawings whose parts are taken from one another.


def engraved(
    bodies: Sequence[Body], strokes: Sequence[Stroke]
) -> tuple[dict[str, list[Stroke]], list[Stroke]]:
    """Returns the strokes of drawings by the path of their body, and the strokes on no body."""
    holders = Holders(bodies)
    on: dict[str, list[Stroke]] = {}
    off: list[Stroke] = []
    for stroke in strokes:
        if stroke.role not in ("drawing", SLIT):
            continue
        holder = holders.of(stroke)
        if holder is not None:
            on.setdefault(holder.path, []).append(stroke)
            continue
        rest: Stroke | None = stroke
        for body in _by_cover(stroke, bodies):
            if rest is None:
                break
            inside, rest = _cut_off(rest, body.region)
            if inside is not None:
                on.setdefault(body.path, []).append(inside)
        if rest is not None and _length(rest.pieces) > NO_LENGTH:
            off.append(rest)
    return on, off


def _cut_off(stroke: Stroke, region: Region) -> tuple[Stroke | None, Stroke | None]:
    """Returns a stroke as far as it lies on a region, and the rest of it: areas as areas, lines as lines."""
    inside, outside = divided(stroke.pieces, region)
    if not outside or not inside:
        return (stroke, None) if inside else (None, stroke)
    if not stroke.faces:
        return replace(stroke, pieces=inside), replace(stroke, pieces=outside)
    area = Region(stroke.faces)
    found = (operation(area, region) for operation in (common, without))
    here, there = (replace(stroke, pieces=a.pieces, faces=a.faces) if a else None for a in found)
    return here, there


def _by_cover(stroke: Stroke, bodies: Sequence[Body]) -> list[Body]:
    """Returns the bodies under a stroke, first the one that has most of it."""
    box = union_bounds([bounds(piece) for piece in stroke.pieces])
    near = [body for body in reversed(bodies) if are_near(box, body.box)]
    if len(near) < 2:
        return near
    cover = {body.path: _length(divided(stroke.pieces, body.region)[0]) for body in near}
    return sorted(near, key=lambda body: -round(cover[body.path], 6))


def divided(curves: Sequence[Piece], region: Region) -> tuple[tuple[Piece, ...], tuple[Piece, ...]]:
    """Returns the parts of curves in or along a region, and those outside; uncut ones stay as they were."""
    found = clipped_each(curves, region, with_border=True)
    return tuple(p for one in found for p in one.inner), tuple(p for one in found for p in one.outer)


def _length(pieces: Sequence[Piece]) -> float:
    return sum(map(length, pieces))


# --- The parts of a drawing, each by itself: laid flat by its own frame, with what is engraved on it.

COARSE = 0.05
"""Millimetres from an outline to the polygon that stands for it where places are sought."""
_ALIKE = 1e-6
"""Relative difference of parts that are equal."""
_OFF_BEAT = 0.2137
"""Shifts what is rounded, so that round numbers lie between two steps of it and not on their border."""
_WORTH_TURNING = 1e-6
"""Relative area that a turned rectangle has to save."""

Size = tuple[float, float]
T = TypeVar("T")


@record()
class Motion:
    """A turn about the origin, degrees counter-clockwise, then a shift, mm."""

    turn: float = 0.0
    x: float = 0.0
    y: float = 0.0

    def piece(self, piece: Piece) -> Piece:
        # Where the shift takes the origin is where the curve is seen from.
        angle = math.radians(self.turn)
        c, s = math.cos(angle), math.sin(angle)
        origin = -(c * self.x + s * self.y), s * self.x - c * self.y
        return inward(piece, origin, -self.turn, mirrored=False)

    def pieces(self, pieces: Iterable[Piece]) -> tuple[Piece, ...]:
        return tuple(map(self.piece, pieces))


@record()
class Part:
    """A body with its engraving, its seams, and the regions of the structures it was made of."""

    body: Body
    strokes: tuple[Stroke, ...]
    seams: tuple[Seam, ...]
    regions: dict[str, Region]
    box: Bounds

    @property
    def size(self) -> Size:
        return self.box[2] - self.box[0], self.box[3] - self.box[1]

    @property
    def stock(self) -> tuple[str, float]:
        """What it is made of, by which parts are sorted: material and thickness."""
        return self.body.style.material or "", self.body.style.thickness or 0.0

    def moved(self, by: Motion) -> Part:
        region = self.body.region.mapped(by.piece)
        strokes = tuple(
            replace(s, pieces=by.pieces(s.pieces), faces=tuple(f.mapped(by.piece) for f in s.faces))
            for s in self.strokes
        )
        box = region_bounds(region)
        return Part(
            replace(self.body, region=region, box=box),
            strokes,
            tuple(replace(seam, pieces=by.pieces(seam.pieces)) for seam in self.seams),
            {path: below.mapped(by.piece) for path, below in self.regions.items()},
            union_bounds([box, *(bounds(piece) for s in strokes for piece in s.pieces)]),
        )


def parts_of(root: SolvedStructure, drawing: Drawing) -> tuple[list[Part], list[Stroke]]:
    """Returns the parts, each turned as its own frame is, and what drawings have beside all of them."""
    on, off = engraved(drawing.bodies, drawing.strokes)
    turns = dict(_turns(root))
    found = [
        part.moved(Motion(-turn)) if (turn := turns[part.body.path] % 360.0) else part
        for part in _parts(drawing, on)
    ]
    return found, off


def _turns(root: SolvedStructure) -> Iterator[tuple[str, float]]:
    """Yields the path of each structure and how far it is turned, degrees."""

    def visit(s: SolvedStructure, turn: float, sense: float) -> Iterator[tuple[str, float]]:
        turn += sense * s.frame.rotation
        yield s.path, turn
        for child in s.structures:
            yield from visit(child, turn, -sense if s.frame.mirrored else sense)

    yield from visit(root, 0.0, 1.0)


def _parts(drawing: Drawing, on: dict[str, list[Stroke]]) -> Iterator[Part]:
    bodies = {body.path: body for body in drawing.bodies}
    below: dict[str, dict[str, Region]] = {path: {} for path in bodies}
    shared: dict[str, Region] = {}  # holes of an assembly may cut several of its bodies
    for path, region in drawing.regions.items():
        above = owner(bodies, path)
        (shared if above is None else below[above])[path] = region
    seams: dict[str, list[Seam]] = {path: [] for path in bodies}
    for seam in drawing.seams:
        seams[seam.body].append(seam)
    for body in drawing.bodies:
        strokes = tuple(on.get(body.path, ()))
        box = union_bounds([body.box, *(bounds(piece) for s in strokes for piece in s.pieces)])
        regions = below[body.path]
        regions |= {p: r for p, r in shared.items() if are_near(region_bounds(r), body.box)}
        yield Part(body, strokes, tuple(seams[body.path]), regions, box)


def drawn(drawing: Drawing, parts: Sequence[Part], box: Bounds | None = None) -> Drawing:
    """Returns the drawing of some parts alone, in a box or that of the parts."""
    regions = dict[str, Region]()
    for part in parts:
        for path, below in part.regions.items():
            faces = regions.get(path, Region()).faces
            regions[path] = Region(faces + below.faces)
    return Drawing(
        tuple(part.body for part in parts),
        regions,
        tuple(seam for part in parts for seam in part.seams),
        tuple(stroke for part in parts for stroke in part.strokes),
        (),
        Contacts(),
        drawing.styles,
        union_bounds([part.box for part in parts]) if box is None else box,
    )


def alike(parts: Iterable[Part]) -> list[list[Part]]:
    """Returns parts with equal ones together, in order of writing."""
    return gathered(parts, lambda part: (shape_of(part.body), _engraving(part)))


def gathered(things: Iterable[T], key: Callable[[T], Hashable]) -> list[list[T]]:
    """Returns things with those of one key together, in their order."""
    groups: dict[Hashable, list[T]] = {}
    for thing in things:
        groups.setdefault(key(thing), []).append(thing)
    return list(groups.values())


def shape_of(body: Body) -> Hashable:
    """Returns a key that bodies share which are moved copies of each other, and of one stock."""
    box, style = region_bounds(body.region), body.style
    places = _places(body.region.pieces, box)
    return style.material, style.thickness, style.quantity, round(larger_side(box), 6), places


def _engraving(part: Part) -> Hashable:
    box = region_bounds(part.body.region)
    return tuple(sorted((s.style.layer or "", _places(s.pieces, box)) for s in part.strokes))


def _places(pieces: Iterable[Piece], around: Bounds) -> tuple[tuple[int, ...], ...]:
    """Returns the boxes of pieces in one, in steps of it so small that equal ones are the same."""
    step, origin = _ALIKE * larger_side(around), around[:2] * 2
    boxes = (zip(bounds(p), origin, strict=True) for p in pieces)
    return tuple(sorted(tuple(round((v - o) / step + _OFF_BEAT) for v, o in box) for box in boxes))


def upright_turn(part: Part) -> float:
    """Returns the turn, degrees, after which the box around a part is smallest; 0 if no turn saves area."""
    from scipy.spatial import ConvexHull

    outer = np.concatenate([face_polygons(face, COARSE)[0] for face in part.body.region.faces])
    corners = outer[ConvexHull(outer).vertices]
    ways = np.roll(corners, -1, axis=0) - corners
    angles = np.unique(np.round(np.arctan2(ways[:, 1], ways[:, 0]) % (math.pi / 2), 12))
    c, s = np.cos(angles)[:, None], np.sin(angles)[:, None]
    along, across = c * corners[:, 0] + s * corners[:, 1], c * corners[:, 1] - s * corners[:, 0]
    areas = np.ptp(along, axis=1) * np.ptp(across, axis=1)
    best = int(areas.argmin())
    width, height = np.ptp(outer, axis=0)
    if areas[best] >= (1 - _WORTH_TURNING) * width * height:
        return 0.0
    return -math.degrees(float(angles[best]))


def smallest_size(part: Part) -> Size:
    """Returns the sides of the smallest rectangle around the material of a part, mm; the longer one first
    where the part is turned for it.
    """
    turn = upright_turn(part)
    left, bottom, right, top = (
        region_bounds(part.body.region.mapped(Motion(turn).piece)) if turn else part.body.box
    )
    width, height = right - left, top - bottom
    return (max(width, height), min(width, height)) if turn else (width, height)

"""The parts of a drawing, each by itself, with what is engraved on it, and their places in space."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from aidl_lang.building.expression import exact_turn
from aidl_lang.common.diagnostics import Diagnostic, ordered
from aidl_lang.common.records import record
from aidl_lang.geometry.boolean import Contacts, clipped_each, common, without
from aidl_lang.geometry.curves import NO_LENGTH, Bounds, Piece, are_near, inward, larger_side, union_bounds
from aidl_lang.geometry.drawing import SLIT, Body, Drawing, Seam, Stroke
from aidl_lang.geometry.legibility import Holders, owner
from aidl_lang.geometry.notes import united_notes
from aidl_lang.geometry.region import COARSE, Region, length
from aidl_lang.geometry.solved import Frame, SolvedStructure

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
    box = union_bounds([piece.box for piece in stroke.pieces])
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
            replace(
                s,
                pieces=by.pieces(s.pieces),
                faces=tuple(f.mapped(by.piece) for f in s.faces),
                whole=by.pieces(s.whole),
            )
            for s in self.strokes
        )
        return Part(
            replace(self.body, region=region),
            strokes,
            tuple(replace(seam, pieces=by.pieces(seam.pieces)) for seam in self.seams),
            {path: below.mapped(by.piece) for path, below in self.regions.items()},
            union_bounds([region.box, *(piece.box for s in strokes for piece in s.pieces)]),
        )


def parts_of(drawing: Drawing) -> tuple[list[Part], list[Stroke]]:
    """Returns the parts, each turned as its own frame is, and what drawings have beside all of them."""
    on, off = engraved(drawing.bodies, drawing.strokes)
    found = [
        part.moved(Motion(-turn)) if (turn := part.body.style.turn.own) else part
        for part in _parts(drawing, on)
    ]
    return found, off


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
        box = union_bounds([body.box, *(piece.box for s in strokes for piece in s.pieces)])
        regions = below[body.path]
        regions |= {p: r for p, r in shared.items() if are_near(r.box, body.box)}
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
    box, style = body.region.box, body.style
    places = _places(body.region.pieces, box)
    return style.material, style.thickness, style.quantity, round(larger_side(box), 6), places


def _engraving(part: Part) -> Hashable:
    box = part.body.region.box
    return tuple(sorted((s.style.layer or "", _places(s.pieces, box)) for s in part.strokes))


def _places(pieces: Iterable[Piece], around: Bounds) -> tuple[tuple[int, ...], ...]:
    """Returns the boxes of pieces in one, in steps of it so small that equal ones are the same."""
    step, origin = _ALIKE * larger_side(around), around[:2] * 2
    boxes = (zip(p.box, origin, strict=True) for p in pieces)
    return tuple(sorted(tuple(round((v - o) / step + _OFF_BEAT) for v, o in box) for box in boxes))


def upright_turn(part: Part) -> float:
    """Returns the turn, degrees, after which the box around a part is smallest; 0 if no turn saves area."""
    from scipy.spatial import ConvexHull

    outer = np.concatenate([face.polygons(COARSE)[0] for face in part.body.region.faces])
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
    """Returns the sides, mm, of the least rectangle around a part, the longer first if turned for it."""
    turn = upright_turn(part)
    left, bottom, right, top = part.body.region.mapped(Motion(turn).piece).box if turn else part.body.box
    width, height = right - left, top - bottom
    return (max(width, height), min(width, height)) if turn else (width, height)


# --- The place of the flat drawing of each structure in space, and notes on bodies that have a thickness.
#
# World axes: x to the right, y to the back, z up, mm. `top` is drawn in x and y and grows up from there,
# `front` in x and z and grows to the back, `side` in y and z and grows to the right.

Matrix = NDArray[np.float64]

_UP: Matrix = np.array((0.0, 0.0, 1.0))
_RIGHT: Matrix = np.array((1.0, 0.0, 0.0))
_BACK: Matrix = np.array((0.0, 1.0, 0.0))
_AXES = {"top": (_RIGHT, _BACK, _UP), "front": (_RIGHT, _UP, _BACK), "side": (_BACK, _UP, _RIGHT)}
"""Directions, by orientation, of the x and the y of the sketch and of the growth of its material."""


@record()
class Plane:
    """A plane in space for coordinates of the root frame: (x, y) lies at origin + x u + y v.

    `u` and `v` are at right angles and of length 1; `growth` is the unit normal on the side of the material.
    """

    origin: Matrix
    u: Matrix
    v: Matrix
    growth: Matrix

    def at(self, x: float, y: float) -> Matrix:
        return self.origin + x * self.u + y * self.v

    def shifted(self, distance: float) -> Plane:
        """Returns the plane moved towards where the material grows."""
        return replace(self, origin=self.origin + distance * self.growth)

    def placed(self, thickness: float = 0.0) -> Matrix:
        """Returns the rigid motion, shape (3, 4), from 0 to `thickness` over the root's plane to the
        structure's place: rotation, then shift. It never mirrors: material that grows away from the viewer
        begins at its far side.
        """
        normal = np.cross(self.u, self.v)
        depth = min(0.0, thickness * float(normal @ self.growth))
        return np.column_stack((self.u, self.v, normal, self.origin + depth * normal))


GROUND = Plane(np.zeros(3), *_AXES["top"])
"""Where material grows up from what is drawn, which lies flat."""


def planes(root: SolvedStructure) -> dict[str, Plane]:
    """Returns the plane of each structure, by its path.

    What has another orientation than the structure around it is hinged at the origin of its frame: that
    point stays in the plane around it, and its sketch, turned by its own frame alone, stands in the world
    axes of its orientation.
    """
    found: dict[str, Plane] = {}

    def visit(s: SolvedStructure, plane: Plane, origin: Matrix, turn: Matrix) -> None:
        found[s.path] = plane = plane.shifted(_elevation(s))
        for child in s.structures:
            hinge, inside = origin + turn @ (child.frame.x, child.frame.y), plane
            if child.orientation != s.orientation:
                inside = _hinged(plane.at(*hinge), hinge, turn, child.orientation)
            visit(child, inside, hinge, turn @ _turn(child.frame))

    visit(root, _hinged(np.zeros(3), np.zeros(2), np.eye(2), root.orientation), np.zeros(2), np.eye(2))
    return found


def _hinged(point: Matrix, hinge: Matrix, turn: Matrix, orientation: str) -> Plane:
    """Returns the plane of an orientation in which `hinge`, in root coordinates, lies at a point of space.
    `turn` is that of the frame around it, which is undone.
    """
    right, up, growth = _AXES[orientation]
    u, v = turn @ (right, up)
    return Plane(point - hinge[0] * u - hinge[1] * v, u, v, growth)


def _turn(frame: Frame) -> Matrix:
    c, s = exact_turn(frame.rotation)
    flip = -1.0 if frame.mirrored else 1.0
    return np.array(((flip * c, -s), (flip * s, c)))


def _elevation(s: SolvedStructure) -> float:
    (value,) = s.attributes.get("elevation", (0.0,))
    return float(value)


def thickness_of(body: Body, default: float | None) -> float | None:
    """Returns the thickness in mm; None for a body that stays flat."""
    return default if body.style.thickness is None else body.style.thickness


def placement_notes(root: SolvedStructure, drawing: Drawing) -> list[Diagnostic]:
    """Returns notes on attributes of the third dimension that have no effect, or not the one expected."""
    united = united_notes(root, {body.path for body in drawing.bodies}, partial(_other, drawing))
    return ordered([*_in_turned(root, np.eye(2)), *united])


def _in_turned(s: SolvedStructure, turn: Matrix) -> Iterator[Diagnostic]:
    """Yields notes on structures with an orientation of their own in one that is turned, by a matrix."""
    for child in s.structures:
        if child.orientation != s.orientation and np.abs(turn - np.eye(2)).max() > 1e-9:
            yield Diagnostic(
                "W0726",
                f"`{child.path}` stands unturned in `{s.path}`, which is turned",
                child.span,
                f"seen from the {child.orientation}, as written here",
                hints=(
                    "what is around a structure of another orientation moves its origin and does not turn "
                    f"it: turn `{child.name}` itself, or give it the orientation that is meant",
                ),
            )
        yield from _in_turned(child, turn @ _turn(child.frame))


def _other(drawing: Drawing, s: SolvedStructure, body: SolvedStructure) -> list[str]:
    """Returns the attributes by which a structure differs from the body it is in: in space it cannot."""
    stated = s.attributes.keys()
    found = ["orientation"] if "orientation" in stated and s.orientation != body.orientation else []
    if _elevation(s):
        found.append("elevation")
    if "thickness" in stated and drawing.styles[s.path].thickness != drawing.styles[body.path].thickness:
        found.append("thickness")
    return found

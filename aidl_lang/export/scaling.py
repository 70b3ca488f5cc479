"""Scales and moves pictures and what is in them."""

from __future__ import annotations

from dataclasses import replace

from aidl_lang.common.records import record
from aidl_lang.export.marks import Area, Curves, Dot, Frame, Gradient, Group, Ink, Mark, Picture, Text
from aidl_lang.geometry.curves import Piece, Vec, image
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.geometry.region import Face, Loop


def scaled(picture: Picture, factor: float) -> Picture:
    """Returns the picture with all its lengths multiplied."""
    scale = Placing(factor)
    return Picture(scale.box(picture.box), tuple(map(scale.group, picture.groups)))


@record()
class Placing:
    """Multiplies all lengths, then moves by `shift`."""

    factor: float
    shift: Vec = (0.0, 0.0)

    def point(self, p: Vec) -> Vec:
        return self.factor * p[0] + self.shift[0], self.factor * p[1] + self.shift[1]

    def box(self, box: Bounds) -> Bounds:
        return *self.point(box[:2]), *self.point(box[2:])

    def group(self, group: Group) -> Group:
        clip = None if group.clip is None else self.box(group.clip)
        return replace(group, marks=tuple(map(self.mark, group.marks)), clip=clip)

    def mark(self, mark: Mark) -> Mark:
        k = self.factor
        match mark:
            case Area(face=face, ink=ink, gradient=gradient):
                return replace(
                    mark,
                    face=self.face(face),
                    ink=None if ink is None else self.ink(ink),
                    gradient=None if gradient is None else self.gradient(gradient),
                )
            case Curves(pieces=pieces, ink=ink):
                return replace(mark, pieces=tuple(map(self.piece, pieces)), ink=self.ink(ink))
            case Text(at=at, size=size):
                return replace(mark, at=self.point(at), size=k * size)
            case Dot(at=at, radius=radius):
                return replace(mark, at=self.point(at), radius=k * radius)
            case Frame(box=box, width=width, dash=dash):
                return replace(mark, box=self.box(box), width=k * width, dash=k * dash)

    def gradient(self, gradient: Gradient) -> Gradient:
        radius = None if gradient.radius is None else self.factor * gradient.radius
        start, end = self.point(gradient.start), self.point(gradient.end)
        return replace(gradient, start=start, end=end, radius=radius)

    def ink(self, ink: Ink) -> Ink:
        dash = None if ink.dash is None else tuple(self.factor * part for part in ink.dash)
        return replace(ink, width=self.factor * ink.width, dash=dash)

    def face(self, face: Face) -> Face:
        return Face(self.loop(face.outer), tuple(map(self.loop, face.holes)))

    def loop(self, loop: Loop) -> Loop:
        return replace(loop, pieces=tuple(map(self.piece, loop.pieces)))

    def piece(self, piece: Piece) -> Piece:
        return image(piece, self.point, self.factor)

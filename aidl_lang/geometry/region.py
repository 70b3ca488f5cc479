"""Regions of the plane, bounded by exact curves."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Circle, Ellipse, Piece
from aidl_lang.geometry.evaluate import bounds


@record(slots=True)
class Loop:
    """A closed outline; each piece starts where the one before it ends, to the last digit.

    A whole circle or ellipse is a loop of one piece and counts as counter-clockwise; `reversed` turns it
    around.
    """

    pieces: tuple[Piece, ...]
    reversed: bool = False

    @property
    def is_whole(self) -> bool:
        """True if the loop is a single closed curve without ends."""
        return len(self.pieces) == 1 and isinstance(self.pieces[0], Circle | Ellipse)


@record(slots=True)
class Face:
    """A connected area: `outer` counter-clockwise, `holes` clockwise."""

    outer: Loop
    holes: tuple[Loop, ...] = ()

    @property
    def loops(self) -> tuple[Loop, ...]:
        return (self.outer, *self.holes)


@record()
class Region:
    """Any number of faces that do not overlap."""

    faces: tuple[Face, ...] = field(default=())

    @property
    def loops(self) -> tuple[Loop, ...]:
        return tuple(loop for face in self.faces for loop in face.loops)

    @property
    def circle(self) -> Circle | None:
        """The circle that it is, if it is one."""
        only = self.faces[0].outer.pieces[0] if len(self.loops) == 1 else None
        return only if isinstance(only, Circle) else None

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """All that it is bounded by, loop by loop."""
        return tuple(piece for loop in self.loops for piece in loop.pieces)

    @cached_property
    def boxes(self) -> NDArray[np.float64]:
        """The box of each piece, a row each."""
        return np.array([bounds(piece) for piece in self.pieces]).reshape(-1, 4)

    def __bool__(self) -> bool:
        return bool(self.faces)

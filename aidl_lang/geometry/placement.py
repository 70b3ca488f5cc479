"""The place of the flat drawing of each structure in space, and notes on bodies that have a thickness.

World axes: x to the right, y to the back, z up, mm. `top` is drawn in x and y and grows up from there,
`front` in x and z and grows to the back, `side` in y and z and grows to the right.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from aidl_lang.building.expression import exact_turn
from aidl_lang.common.diagnostics import Diagnostic, ordered
from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Floats
from aidl_lang.geometry.drawing import Body, Drawing
from aidl_lang.geometry.notes import united_notes
from aidl_lang.geometry.solved import Frame, SolvedStructure

Matrix = Floats

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

"""Boundary representations in the terms of STEP (ISO 10303-42): solids, sheets and curves of exact pieces.

An outline is a chain of edges that share their vertices, so that solids are watertight by construction. The
sides of a solid are planes over lines, cylinders over arcs, and linear extrusions of all else; a curve that
is closed by itself has one edge, and a side with a seam.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line, Piece, Vec
from aidl_lang.geometry.evaluate import TAU, derivative, ends, reverse, round_range
from aidl_lang.geometry.placement import Matrix, Plane
from aidl_lang.geometry.region import Face, Loop

_IN_A_LINE = 10
_WHOLE_TURN = TAU - 1e-12


@dataclass
class Entities:
    """The numbered entities of a STEP file (ISO 10303-21). Points and directions are written once."""

    lines: list[str] = field(default_factory=list)
    known: dict[str, str] = field(default_factory=dict)

    def add(self, entity: str) -> str:
        """Append an entity; its name, as `#12`."""
        name = f"#{len(self.lines) + 1}"
        self.lines.append(f"{name} = {entity};")
        return name

    def point(self, p: Iterable[float]) -> str:
        return self._once(f"CARTESIAN_POINT('',{listed(map(real, p))})")

    def direction(self, d: Iterable[float]) -> str:
        return self._once(f"DIRECTION('',{listed(map(real, d))})")

    def axes(self, origin: Matrix, z: Matrix, x: Matrix) -> str:
        return self.add(
            f"AXIS2_PLACEMENT_3D('',{self.point(origin)},{self.direction(z)},{self.direction(x)})"
        )

    def _once(self, entity: str) -> str:
        if entity not in self.known:
            self.known[entity] = self.add(entity)
        return self.known[entity]


def real(value: float) -> str:
    """A number with a decimal point and all its digits."""
    digits, e, exponent = repr(float(value) + 0.0).partition("e")
    return f"{digits if '.' in digits else digits + '.'}{e.upper()}{exponent}".replace(".0E", ".E")


def text(value: str) -> str:
    """A string, with what is not ASCII as code points."""
    return "'" + "".join(map(_encoded, value)) + "'"


def _encoded(character: str) -> str:
    code = ord(character)
    if 32 <= code < 127:
        return character * 2 if character in "'\\" else character
    return f"\\X2\\{code:04X}\\X0\\" if code < 0x10000 else f"\\X4\\{code:08X}\\X0\\"


def listed(items: Iterable[str]) -> str:
    """A list, broken into lines that people and old readers can take."""
    found = list(items)
    rows = [",".join(found[k : k + _IN_A_LINE]) for k in range(0, len(found), _IN_A_LINE)]
    return "(" + ",\n".join(rows) + ")"


@dataclass(frozen=True)
class _Joint:
    """Where two pieces of an outline meet: a vertex below, and one above with the edge up to it."""

    below: str
    above: str
    upright: str


class Shapes:
    """Writes what stands from 0 to `thickness` over a plane, or lies in it."""

    def __init__(self, entities: Entities, plane: Plane, thickness: float = 0.0) -> None:
        self.entities, self.thickness = entities, thickness
        placed = plane.placed(thickness)
        self.u, self.v, self.normal, self.origin = placed.T

    # --- Bodies --------------------------------------------------------------------------------

    def solid(self, face: Face, name: str) -> str:
        """A MANIFOLD_SOLID_BREP over a face."""
        lower: list[list[str]] = []
        upper: list[list[str]] = []
        sides: list[str] = []
        for pieces, turned in map(_pieces, face.loops):
            below, above, around = self._walls(pieces, turned)
            lower.append([f"ORIENTED_EDGE('',*,*,{edge},.F.)" for edge in reversed(below)])
            upper.append([f"ORIENTED_EDGE('',*,*,{edge},.T.)" for edge in above])
            sides += around
        caps = (self._flat(0.0, lower, ".F."), self._flat(self.thickness, upper, ".T."))
        shell = self.entities.add(f"CLOSED_SHELL('',{listed((*caps, *sides))})")
        return self.entities.add(f"MANIFOLD_SOLID_BREP({text(name)},{shell})")

    def sheet(self, faces: Sequence[Face], name: str) -> str:
        """A SHELL_BASED_SURFACE_MODEL of plane faces."""
        shells = []
        for face in faces:
            bounds = []
            for pieces, turned in map(_pieces, face.loops):
                corners = [self._vertex(ends(piece)[0], 0.0) for piece in pieces]
                edges = self._edges(pieces, turned, corners, 0.0)
                bounds.append([f"ORIENTED_EDGE('',*,*,{edge},.T.)" for edge in edges])
            shells.append(self.entities.add(f"OPEN_SHELL('',({self._flat(0.0, bounds, '.T.')}))"))
        return self.entities.add(f"SHELL_BASED_SURFACE_MODEL({text(name)},{listed(shells)})")

    def curves(self, pieces: Iterable[Piece], name: str) -> str:
        """A GEOMETRIC_CURVE_SET of the pieces, each by itself."""
        curves = [self._trimmed(_upright(piece)) for piece in pieces]
        return self.entities.add(f"GEOMETRIC_CURVE_SET({text(name)},{listed(curves)})")

    # --- Topology ------------------------------------------------------------------------------

    def _walls(self, pieces: Sequence[Piece], turned: bool) -> tuple[list[str], list[str], list[str]]:
        """Of an outline with the material on its left: the edges below and above, and the faces between."""
        joints = [self._joint(ends(piece)[0]) for piece in pieces]
        below = self._edges(pieces, turned, [j.below for j in joints], 0.0)
        above = self._edges(pieces, turned, [j.above for j in joints], self.thickness)
        sides = []
        for k, piece in enumerate(pieces):
            following = joints[(k + 1) % len(joints)]
            around = (
                f"ORIENTED_EDGE('',*,*,{below[k]},.T.)",
                f"ORIENTED_EDGE('',*,*,{following.upright},.T.)",
                f"ORIENTED_EDGE('',*,*,{above[k]},.F.)",
                f"ORIENTED_EDGE('',*,*,{joints[k].upright},.F.)",
            )
            sides.append(self._face([around], self._side(piece), _sense(piece, turned)))
        return below, above, sides

    def _joint(self, p: Vec) -> _Joint:
        below, above = self._vertex(p, 0.0), self._vertex(p, self.thickness)
        line = self._line(self._at(p, 0.0), self.normal)
        return _Joint(below, above, self.entities.add(f"EDGE_CURVE('',{below},{above},{line},.T.)"))

    def _vertex(self, p: Vec, z: float) -> str:
        return self.entities.add(f"VERTEX_POINT('',{self.entities.point(self._at(p, z))})")

    def _edges(self, pieces: Sequence[Piece], turned: bool, corners: Sequence[str], z: float) -> list[str]:
        """An edge for each piece, along the outline, between the vertices at their starts."""
        return [
            self.entities.add(
                f"EDGE_CURVE('',{corners[k]},{corners[(k + 1) % len(corners)]},"
                f"{self._curve(piece, z)},{_sense(piece, turned)})"
            )
            for k, piece in enumerate(pieces)
        ]

    def _flat(self, z: float, bounds: Sequence[Sequence[str]], sense: str) -> str:
        axes = self.entities.axes(self._at((0.0, 0.0), z), self.normal, self.u)
        return self._face(bounds, self.entities.add(f"PLANE('',{axes})"), sense)

    def _face(self, bounds: Sequence[Sequence[str]], surface: str, sense: str) -> str:
        """A face of oriented edges; the first bound is the outer one."""
        add = self.entities.add
        names = []
        for bound in bounds:
            loop = add(f"EDGE_LOOP('',{listed(map(add, bound))})")
            names.append(add(f"FACE_{'BOUND' if names else 'OUTER_BOUND'}('',{loop},.T.)"))
        return add(f"ADVANCED_FACE('',{listed(names)},{surface},{sense})")

    # --- Geometry ------------------------------------------------------------------------------

    def _at(self, p: Vec, z: float) -> Matrix:
        found: Matrix = self.origin + p[0] * self.u + p[1] * self.v + z * self.normal
        return found

    def _along(self, x: float, y: float) -> Matrix:
        """The direction of a vector of the plane."""
        size = math.hypot(x, y)
        found: Matrix = x / size * self.u + y / size * self.v
        return found

    def _line(self, start: Matrix, direction: Matrix) -> str:
        vector = self.entities.add(f"VECTOR('',{self.entities.direction(direction)},1.)")
        return self.entities.add(f"LINE('',{self.entities.point(start)},{vector})")

    def _axes(self, piece: Arc | Circle | Ellipse | EllipseArc, z: float) -> str:
        """Axes at the centre; a whole turn begins where its angle is 0."""
        angle = 0.0
        if isinstance(piece, Ellipse | EllipseArc):
            angle = piece.angle
        elif isinstance(piece, Arc) and abs(piece.sweep) >= _WHOLE_TURN:
            angle = piece.start_angle
        x = self._along(math.cos(angle), math.sin(angle)) if angle else self.u
        return self.entities.axes(self._at(piece.center, z), self.normal, x)

    def _curve(self, piece: Piece, z: float) -> str:
        """The whole curve of a piece; round ones run counter-clockwise."""
        match piece:
            case Line(start, _):
                return self._line(self._at(start, z), self._along(*derivative(piece, 0.0)))
            case Arc() | Circle():
                return self.entities.add(f"CIRCLE('',{self._axes(piece, z)},{real(piece.radius)})")
            case Ellipse() | EllipseArc():
                return self.entities.add(
                    f"ELLIPSE('',{self._axes(piece, z)},{real(piece.rx)},{real(piece.ry)})"
                )
            case Bezier(p0, p1, p2, p3):
                points = listed(self.entities.point(self._at(p, z)) for p in (p0, p1, p2, p3))
                return self.entities.add(
                    f"B_SPLINE_CURVE_WITH_KNOTS('',3,{points},.UNSPECIFIED.,.F.,.F.,(4,4),(0.,1.),"
                    ".PIECEWISE_BEZIER_KNOTS.)"
                )

    def _side(self, piece: Piece) -> str:
        """The surface over a piece, with its normal to the right of the curve."""
        match piece:
            case Line(start, _):
                along = self._along(*derivative(piece, 0.0))
                axes = self.entities.axes(self._at(start, 0.0), np.cross(along, self.normal), along)
                return self.entities.add(f"PLANE('',{axes})")
            case Arc() | Circle():
                return self.entities.add(
                    f"CYLINDRICAL_SURFACE('',{self._axes(piece, 0.0)},{real(piece.radius)})"
                )
            case _:
                vector = self.entities.add(f"VECTOR('',{self.entities.direction(self.normal)},1.)")
                return self.entities.add(
                    f"SURFACE_OF_LINEAR_EXTRUSION('',{self._curve(piece, 0.0)},{vector})"
                )

    def _trimmed(self, piece: Piece) -> str:
        curve = self._curve(piece, 0.0)
        if isinstance(piece, Line):
            trims = (0.0, math.dist(piece.start, piece.end))
        elif isinstance(piece, Arc | EllipseArc) and abs(piece.sweep) < _WHOLE_TURN:
            first, sweep = round_range(piece)
            first = min(first, first + sweep) % TAU
            trims = (first, first + abs(sweep))
        else:
            return curve
        a, b = (f"(PARAMETER_VALUE({real(t)}))" for t in trims)
        return self.entities.add(f"TRIMMED_CURVE('',{curve},{a},{b},.T.,.PARAMETER.)")


def _pieces(loop: Loop) -> tuple[list[Piece], bool]:
    """The pieces of an outline in its direction; whether they are a whole curve run clockwise."""
    pieces = [_upright(piece) for piece in loop.pieces]
    if loop.reversed and not loop.is_whole:
        return [reverse(piece) for piece in reversed(pieces)], False
    return pieces, loop.reversed


def _upright(piece: Piece) -> Piece:
    """Ellipses have their longer half-axis first, as STEP wants."""
    if not isinstance(piece, Ellipse | EllipseArc) or piece.rx >= piece.ry:
        return piece
    rx, ry, angle = piece.ry, piece.rx, piece.angle + math.pi / 2
    if isinstance(piece, Ellipse):
        return Ellipse(piece.center, rx, ry, angle)
    first = piece.first - math.pi / 2
    return EllipseArc(piece.center, rx, ry, angle, piece.start, piece.end, first, piece.sweep)


def _sense(piece: Piece, turned: bool) -> str:
    """Whether an outline runs along the curve of its piece."""
    against = piece.sweep < 0 if isinstance(piece, Arc | EllipseArc) else turned
    return ".F." if against else ".T."

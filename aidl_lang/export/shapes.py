"""Builds shapes of Open CASCADE from exact outlines: solids, plane faces and curves.

Where two pieces of an outline meet they share one vertex, so that solids are watertight by construction.
Lines become planes and arcs cylinders, all else linear extrusions; nothing is approximated.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from OCP.BRep import BRep_Builder
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCone, BRepPrimAPI_MakePrism
from OCP.collections import Array1_gp_Pnt
from OCP.Geom import Geom_BezierCurve, Geom_Circle, Geom_Ellipse, Geom_Line, Geom_Plane
from OCP.gp import gp_Ax2, gp_Ax3, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.StdFail import StdFail_NotDone
from OCP.TopAbs import TopAbs_Orientation, TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS_Compound, TopoDS_Edge, TopoDS_Face, TopoDS_Shape, TopoDS_Vertex, TopoDS_Wire

from aidl_lang.common.running import checkpoint
from aidl_lang.export.solids import Recess
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line, Piece, Vec
from aidl_lang.geometry.evaluate import TAU, ends, round_range
from aidl_lang.geometry.placement import Plane
from aidl_lang.geometry.region import Face, Loop

_UP = gp_Dir(0.0, 0.0, 1.0)
_WHOLE_TURN = TAU - 1e-12


class Shapes:
    """Makes extrusions from 0 to `thickness` over a plane, or shapes in it. Ends meet within `tolerance`,
    mm.
    """

    def __init__(self, plane: Plane, tolerance: float, thickness: float = 0.0) -> None:
        self._build = BRep_Builder()
        self._tolerance = tolerance
        self._motion = gp_Trsf()
        self._motion.SetValues(*plane.placed(thickness).flatten().tolist())
        self._growth = gp_Vec(0.0, 0.0, thickness).Transformed(self._motion)
        self._vertices: dict[Vec, TopoDS_Vertex] = {}

    def solid(self, face: Face) -> TopoDS_Shape:
        return BRepPrimAPI_MakePrism(self.face(face), self._growth).Shape()

    def face(self, face: Face) -> TopoDS_Face:
        self._vertices.clear()
        made = TopoDS_Face()
        plane = Geom_Plane(gp_Ax3(gp_Pnt(), _UP).Transformed(self._motion))
        self._build.MakeFace(made, plane, self._tolerance)
        for loop in face.loops:
            checkpoint()
            self._build.Add(made, self._wire(loop))
        return made

    def recess(self, of: Recess) -> Iterator[TopoDS_Shape]:
        """Yields the solids that a recess is, on its plane."""
        circle = of.region.circle
        if of.narrowing and circle is not None:
            axes = _axes(circle.center, 0.0).Transformed(self._motion)
            bottom = circle.radius - of.narrowing
            yield BRepPrimAPI_MakeCone(axes, bottom, circle.radius, of.depth).Shape()
        else:
            yield from map(self.solid, of.region.faces)

    def curves(self, pieces: Iterable[Piece]) -> list[TopoDS_Edge]:
        """Returns an edge for each piece."""
        self._vertices.clear()
        return [self._edge(piece, *self._ends(piece)) for piece in map(_upright, pieces)]

    def _ends(self, piece: Piece) -> tuple[TopoDS_Vertex, TopoDS_Vertex]:
        start, end = ends(piece)
        return self._vertex(start), self._vertex(end)

    def _wire(self, loop: Loop) -> TopoDS_Shape:
        made = TopoDS_Wire()
        self._build.MakeWire(made)
        pieces = [_upright(piece) for piece in loop.pieces]
        corners = [self._vertex(ends(piece)[0]) for piece in pieces]
        for piece, start, end in zip(pieces, corners, corners[1:] + corners[:1], strict=True):
            self._build.Add(made, self._edge(piece, start, end))
        made.Closed(True)
        return made.Reversed() if loop.reversed else made

    def _vertex(self, p: Vec) -> TopoDS_Vertex:
        """Returns the vertex of a place; outlines that touch share it."""
        if p not in self._vertices:
            made = self._vertices[p] = TopoDS_Vertex()
            self._build.MakeVertex(made, _point(p).Transformed(self._motion), self._tolerance)
        return self._vertices[p]

    def _edge(self, piece: Piece, start: TopoDS_Vertex, end: TopoDS_Vertex) -> TopoDS_Shape:
        """Returns an edge along its curve; a clockwise arc runs against a counter-clockwise circle."""
        curve, first, last = _curve(piece)
        curve.Transform(self._motion)
        is_clockwise = isinstance(piece, Arc | EllipseArc) and piece.sweep < 0
        if is_clockwise:
            start, end = end, start
        made = TopoDS_Edge()
        self._build.MakeEdge(made, curve, self._tolerance)
        self._build.Add(made, start.Oriented(TopAbs_Orientation.TopAbs_FORWARD))
        self._build.Add(made, end.Oriented(TopAbs_Orientation.TopAbs_REVERSED))
        self._build.Range(made, first, last)
        return made.Reversed() if is_clockwise else made


def without(solid: TopoDS_Shape, tools: Iterable[TopoDS_Shape]) -> list[TopoDS_Shape]:
    """Returns the solids that are left of one."""
    for tool in tools:
        cut = BRepAlgoAPI_Cut(solid, tool)
        if not cut.IsDone():
            raise StdFail_NotDone("not cut")
        solid = cut.Shape()
    found, solids = TopExp_Explorer(solid, TopAbs_ShapeEnum.TopAbs_SOLID), []
    while found.More():
        solids.append(found.Current())
        found.Next()
    return solids


def together(shapes: Sequence[TopoDS_Shape]) -> TopoDS_Shape:
    """Returns a compound of several shapes, and a single shape itself."""
    if len(shapes) == 1:
        return shapes[0]
    made, build = TopoDS_Compound(), BRep_Builder()
    build.MakeCompound(made)
    for shape in shapes:
        build.Add(made, shape)
    return made


def _curve(piece: Piece) -> tuple[Any, float, float]:
    """Returns the curve of a piece in the plane z = 0 and the parameters where it begins and ends. Round ones
    run counter-clockwise; a whole turn begins where its angle is 0.
    """
    match piece:
        case Line((x0, y0), (x1, y1)):
            direction = gp_Vec(x1 - x0, y1 - y0, 0.0)
            return Geom_Line(_point(piece.start), gp_Dir(direction)), 0.0, direction.Magnitude()
        case Bezier(p0, p1, p2, p3):
            poles = Array1_gp_Pnt(1, 4)
            for number, p in enumerate((p0, p1, p2, p3), 1):
                poles.SetValue(number, _point(p))
            return Geom_BezierCurve(poles), 0.0, 1.0
    first, sweep = round_range(piece)
    first = min(first, first + sweep) % TAU
    last = first + abs(sweep)
    match piece:
        case Ellipse() | EllipseArc():
            return Geom_Ellipse(_axes(piece.center, piece.angle), piece.rx, piece.ry), first, last
        case Arc() if abs(sweep) >= _WHOLE_TURN:
            return Geom_Circle(_axes(piece.center, first), piece.radius), 0.0, TAU
        case Arc() | Circle():
            return Geom_Circle(_axes(piece.center, 0.0), piece.radius), first, last


def _axes(center: Vec, angle: float) -> gp_Ax2:
    return gp_Ax2(_point(center), _UP, gp_Dir(math.cos(angle), math.sin(angle), 0.0))


def _point(p: Vec) -> gp_Pnt:
    return gp_Pnt(*p, 0.0)


def _upright(piece: Piece) -> Piece:
    """Returns ellipses with their longer half-axis first, as Open CASCADE and STEP want."""
    if not isinstance(piece, Ellipse | EllipseArc) or piece.rx >= piece.ry:
        return piece
    rx, ry, angle = piece.ry, piece.rx, piece.angle + math.pi / 2
    if isinstance(piece, Ellipse):
        return Ellipse(piece.center, rx, ry, angle)
    first = piece.first - math.pi / 2
    return EllipseArc(piece.center, rx, ry, angle, piece.start, piece.end, first, piece.sweep)

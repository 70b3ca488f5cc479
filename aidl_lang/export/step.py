"""STEP (AP214), written by Open CASCADE: solids of bodies that have a thickness, plane faces of others."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from itertools import count
from typing import Any

import OCP.Standard
from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.BRep import BRep_Builder
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCone, BRepPrimAPI_MakePrism
from OCP.collections import Array1_gp_Pnt, HArray1_StepRepr_RepresentationItem
from OCP.Geom import Geom_BezierCurve, Geom_Circle, Geom_Ellipse, Geom_Line, Geom_Plane
from OCP.gp import gp_Ax2, gp_Ax3, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Interface import Interface_Static
from OCP.Message import Message
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.StdFail import StdFail_NotDone
from OCP.StepBasic import StepBasic_Product
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Writer
from OCP.STEPConstruct import STEPConstruct, STEPConstruct_RenderingProperties, STEPConstruct_Styles
from OCP.StepData import StepData_StepModel
from OCP.StepRepr import StepRepr_NextAssemblyUsageOccurrence
from OCP.StepVisual import StepVisual_MechanicalDesignGeometricPresentationRepresentation
from OCP.TCollection import TCollection_ExtendedString
from OCP.TCollection import TCollection_HAsciiString as _ascii
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_Orientation, TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Compound, TopoDS_Edge, TopoDS_Face, TopoDS_Shape, TopoDS_Vertex, TopoDS_Wire
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool
from OCP.XSControl import XSControl_WorkSession

from aidl_lang.common.colors import rgb
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.export.job import Exported, ExportError, Job
from aidl_lang.export.mesh import Recess, placed_bodies, placed_strokes
from aidl_lang.geometry.boolean import jointed
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line, Piece, Vec
from aidl_lang.geometry.parts import Plane, placement_notes
from aidl_lang.geometry.region import Face, Loop
from aidl_lang.geometry.styles import Style
from aidl_lang.version import __version__

# --- Builds shapes of Open CASCADE from exact outlines: solids, plane faces and curves.
#
# Where two pieces of an outline meet they share one vertex, so that solids are watertight by construction.
# Lines become planes and arcs cylinders, all else linear extrusions; nothing is approximated.

_UP = gp_Dir(0.0, 0.0, 1.0)
_WHOLE_TURN = math.tau - 1e-12


class Shapes:
    """Makes extrusions from 0 to `thickness` over a plane, or shapes in it, with a `tolerance`, mm."""

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
        self._vertices.clear()
        return [self._edge(piece, *map(self._vertex, piece.ends)) for piece in map(_upright, pieces)]

    def _wire(self, loop: Loop) -> TopoDS_Shape:
        made = TopoDS_Wire()
        self._build.MakeWire(made)
        pieces = [_upright(piece) for piece in loop.pieces]
        corners = [self._vertex(piece.ends[0]) for piece in pieces]
        for piece, start, end in zip(pieces, corners, corners[1:] + corners[:1], strict=True):
            self._build.Add(made, self._edge(piece, start, end))
        made.Closed(True)
        return made.Reversed() if loop.reversed else made

    def _vertex(self, p: Vec) -> TopoDS_Vertex:
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
    first, sweep = piece.range
    first = min(first, first + sweep) % math.tau
    last = first + abs(sweep)
    match piece:
        case Ellipse() | EllipseArc():
            return Geom_Ellipse(_axes(piece.center, piece.angle), piece.rx, piece.ry), first, last
        case Arc() if abs(sweep) >= _WHOLE_TURN:
            return Geom_Circle(_axes(piece.center, first), piece.radius), 0.0, math.tau
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


# Every body is a product of its own in an assembly named after the root.

_NO_TIME = "1970-01-01T00:00:00"
"""A fixed time, which readers want: the same drawing gives the same file at any time."""
_ACCURACY = 1e-9
"""Distance within which ends meet, relative to the size of the drawing."""
_SETTINGS = {
    "write.step.schema": "AP214IS",
    "write.step.unit": "MM",
    "write.surfacecurve.mode": "Off",
    "write.precision.mode": "User",
}
_CHECKED = 500
"""Most edges of a face that is checked: a thousand take 4 s, and the time grows with their square."""
_REFUSALS = (
    *(c for c in vars(OCP.Standard).values() if isinstance(c, type) and issubclass(c, Exception)),
    StdFail_NotDone,
    RuntimeError,
)
"""What Open CASCADE raises; the classes have no base of their own."""


@record()
class Product:
    """A product: its name, its solids, faces or edges, and its style."""

    name: str
    shapes: list[TopoDS_Shape]
    style: Style
    is_stroke: bool = False


def to_step(job: Job) -> Exported:
    """Writes the STEP file. Raises ExportError (E0918) for a body that cannot be placed or made solid."""
    tolerance, parts = products(job)
    with _settings(tolerance):
        data = _File(job.model.root.path, parts).data()
    return Exported(data, notes=tuple(placement_notes(job.model.root, job.drawing)))


def products(job: Job) -> tuple[float, list[Product]]:
    """Returns the distance within which ends meet, mm, and the shapes. Raises as `to_step` does."""
    tolerance = max(1e-7, _ACCURACY * job.drawing.size)
    return tolerance, [*_bodies(job, tolerance), *_strokes(job, tolerance)]


def _bodies(job: Job, tolerance: float) -> Iterator[Product]:
    for placed in placed_bodies(job):
        body = placed.body
        with _refusals(body.path):
            shapes = Shapes(placed.plane, tolerance, placed.thickness or 0.0)
            make = shapes.face if placed.thickness is None else shapes.solid
            made = [_valid(make, face) for face in body.region.faces]
            tools = [t for r in placed.recesses for t in Shapes(r.plane, tolerance, r.depth).recess(r)]
            if tools:
                made = [solid for shape in made for solid in without(shape, tools)]
        yield Product(body.path, made, body.style)


def _strokes(job: Job, tolerance: float) -> Iterator[Product]:
    for stroke, plane in placed_strokes(job):
        with _refusals(stroke.geometry):
            made = Shapes(plane, tolerance).curves(stroke.pieces)
        yield Product(stroke.geometry, made, stroke.style, is_stroke=True)


def _valid(make: Callable[[Face], TopoDS_Shape], face: Face) -> TopoDS_Shape:
    """Returns the shape of a face; where outlines touch, they get a common vertex."""
    made = make(face)
    if sum(len(loop.pieces) for loop in face.loops) > _CHECKED or BRepCheck_Analyzer(made).IsValid():
        return made
    made = make(jointed(face))
    if not BRepCheck_Analyzer(made).IsValid():
        raise StdFail_NotDone("not valid")
    return made


@contextmanager
def _refusals(path: str) -> Iterator[None]:
    """Raises errors of Open CASCADE as ExportError that names the body."""
    try:
        yield
    except _REFUSALS as reason:
        message = f"`{path}` cannot be written as STEP: Open CASCADE makes no valid shape of it"
        hint = "look for a size that was written in another unit, or sides that almost coincide"
        raise ExportError("E0918", message, hint) from reason


@contextmanager
def _settings(tolerance: float) -> Iterator[None]:
    """Sets Open CASCADE's settings, global to the process, drops its messages, and restores both."""
    STEPCAFControl_Controller.Init_s()
    wanted = _SETTINGS | {"write.precision.val": repr(tolerance)}
    before = {name: Interface_Static.CVal_s(name) for name in wanted}
    messenger = Message.DefaultMessenger_s()
    printers = list(messenger.Printers())
    try:
        for name, value in wanted.items():
            Interface_Static.SetCVal_s(name, value)
        for printer in printers:
            messenger.RemovePrinter(printer)
        yield
    finally:
        for name, value in before.items():
            Interface_Static.SetCVal_s(name, value)
        for printer in printers:
            messenger.AddPrinter(printer)


class _File:
    """An XDE document of the parts, and the file that Open CASCADE writes of it.

    A text is written as a number that `data` replaces, since Open CASCADE leaves non-ASCII text as it is and
    breaks long texts anywhere.
    """

    def __init__(self, root: str, parts: Sequence[Product]) -> None:
        self._numbers: dict[str, int] = {}
        self._name = root
        self._parts = parts
        self._document = TDocStd_Document(TCollection_ExtendedString("MDTV-XCAF"))
        XCAFDoc_DocumentTool.SetLengthUnit_s(self._document, 1e-3)  # mm
        main = self._document.Main()
        self._shapes = XCAFDoc_DocumentTool.ShapeTool_s(main)
        self._layers = XCAFDoc_DocumentTool.LayerTool_s(main)
        if [part.name for part in parts] == [root]:
            self._root = self._product(parts[0])
        else:
            self._root = self._assembly()

    def data(self) -> bytes:
        with _refusals(self._name):
            out = io.BytesIO()
            if self._transferred().WriteStream(out) != IFSelect_ReturnStatus.IFSelect_RetDone:
                raise StdFail_NotDone("not written")
        texts = [_text(text) for text in self._numbers]
        return re.sub(rb"'~(\d+)~'", lambda found: texts[int(found[1])], out.getvalue())

    def _transferred(self) -> STEPCAFControl_Writer:
        """Returns the writer with the entities of the document.

        Its own controller leaves out the repair of shapes that Open CASCADE begins with otherwise: there is
        nothing to repair, and it takes a time that grows with the square of the edges of a face.
        """
        writer = STEPCAFControl_Writer()
        writer.SetColorMode(False)
        controller = STEPCAFControl_Controller()
        actor = controller.ActorWrite()
        actor.SetStdMode(False)
        if XCAFDoc_ShapeTool.IsAssembly_s(self._root):
            actor.RegisterAssembly(XCAFDoc_ShapeTool.GetShape_s(self._root))
        session = writer.ChangeWriter().WS()
        session.TransferWriter().SetController(controller)
        if not writer.Transfer(self._document):
            raise StdFail_NotDone("not transferred")
        model = session.Model()
        self._head(model)
        self._describe(model)
        self._paint(session, model)
        return writer

    def _head(self, model: StepData_StepModel) -> None:
        header = APIHeaderSection_MakeHeader(model)
        header.SetName(_ascii(self._number(self._name)))
        header.SetTimeStamp(_ascii(_NO_TIME))
        header.SetOriginatingSystem(_ascii(f"AIDL {__version__}"))
        header.SetAuthorValue(1, _ascii(""))
        header.SetOrganizationValue(1, _ascii(""))
        header.SetAuthorisation(_ascii(""))

    def _describe(self, model: StepData_StepModel) -> None:
        """Puts materials into the descriptions of the products, and numbers the uses of products, which Open
        CASCADE does for the whole process. (Its own unit for the density of materials is g³ cm².)
        """
        materials = {
            self._number(part.name): self._number(part.style.material)
            for part in self._parts
            if part.style.material is not None
        }
        uses = count(1)
        for number in range(1, model.NbEntities() + 1):
            entity = model.Value(number)
            if isinstance(entity, StepBasic_Product):
                entity.SetDescription(_ascii(materials.get(entity.Name().ToCString(), "")))
            elif isinstance(entity, StepRepr_NextAssemblyUsageOccurrence):
                entity.SetId(_ascii(str(next(uses))))

    def _paint(self, session: XSControl_WorkSession, model: StepData_StepModel) -> None:
        """Adds colours in the order of the parts; Open CASCADE would go by addresses in memory."""
        styles = STEPConstruct_Styles(session)
        for part in self._parts:
            found = [STEPConstruct.FindEntity_s(styles.FinderProcess(), shape) for shape in part.shapes]
            if None in found:
                raise StdFail_NotDone("not transferred")
            if part.style.color is None or not found:
                continue
            parts = (value / 255 for value in rgb(part.style.color))
            said = Quantity_Color(*parts, Quantity_TypeOfColor.Quantity_TOC_sRGB)
            color = STEPConstruct_Styles.EncodeColor_s(said)
            colors = (None, color) if part.is_stroke else (color, None)
            shown = STEPConstruct_RenderingProperties()
            if part.style.is_clear and not part.is_stroke:
                opacity = 1.0 if part.style.opacity is None else part.style.opacity
                shown = STEPConstruct_RenderingProperties(color, 1.0 - opacity)
            items = HArray1_StepRepr_RepresentationItem(1, len(found))
            for number, item in enumerate(found, 1):
                look = styles.MakeColorPSA(item, *colors, shown)
                items.SetValue(number, styles.AddStyle(item, look, None))
            looks = StepVisual_MechanicalDesignGeometricPresentationRepresentation()
            looks.Init(_ascii(""), items, styles.FindContext(part.shapes[0]))
            model.AddWithRefs(looks)

    def _assembly(self) -> TDF_Label:
        whole = self._shapes.NewShape()
        self._call(whole, self._name)
        for part in self._parts:
            use = self._shapes.AddComponent(whole, self._product(part), TopLoc_Location())
            self._call(use, part.name)
        self._shapes.UpdateAssemblies()
        return whole

    def _product(self, part: Product) -> TDF_Label:
        label = self._shapes.AddShape(together(part.shapes), False)
        self._call(label, part.name)
        if part.style.layer is not None:
            self._layers.SetLayer(label, self._wide(part.style.layer))
        return label

    def _call(self, label: TDF_Label, name: str) -> None:
        TDataStd_Name.Set_s(label, self._wide(name))

    def _wide(self, text: str) -> TCollection_ExtendedString:
        return TCollection_ExtendedString(self._number(text))

    def _number(self, text: str) -> str:
        return f"~{self._numbers.setdefault(text, len(self._numbers))}~"


def _text(value: str) -> bytes:
    """Returns a string of STEP, with what is not printable ASCII as code points (ISO 10303-21, 6.4.3)."""
    return f"'{''.join(map(_encoded, value))}'".encode("ascii")


def _encoded(character: str) -> str:
    code = ord(character)
    if 32 <= code < 127:
        return character * 2 if character in "'\\" else character
    return f"\\X2\\{code:04X}\\X0\\" if code < 0x10000 else f"\\X4\\{code:08X}\\X0\\"

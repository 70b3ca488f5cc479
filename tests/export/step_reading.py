"""STEP files as Open CASCADE reads them: parts by name, with their exact measures."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from OCP.Bnd import Bnd_Box
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.collections import Sequence_TDF_Label
from OCP.GProp import GProp_GProps
from OCP.Message import Message
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Shape
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

_CASTS = {"EDGE": TopoDS.Edge, "FACE": TopoDS.Face, "SHELL": TopoDS.Shell, "SOLID": TopoDS.Solid}


@dataclass(frozen=True)
class Part:
    """A component of the assembly, or the one part of a file without assembly."""

    name: str
    shape: TopoDS_Shape
    color: tuple[int, int, int] | None

    def each(self, kind: str) -> Iterator[TopoDS_Shape]:
        """Its faces, edges, shells or solids."""
        found = TopExp_Explorer(self.shape, getattr(TopAbs_ShapeEnum, f"TopAbs_{kind}"))
        while found.More():
            yield _CASTS[kind](found.Current())
            found.Next()

    def count(self, kind: str) -> int:
        return len(list(self.each(kind)))

    @property
    def is_valid(self) -> bool:
        return bool(BRepCheck_Analyzer(self.shape).IsValid())

    @property
    def is_closed(self) -> bool:
        """Whether it has shells, and all are watertight."""
        shells = list(self.each("SHELL"))
        return bool(shells) and all(shell.Closed() for shell in shells)

    @property
    def surfaces(self) -> Counter[str]:
        """How many faces there are of each type: `Plane`, `Cylinder`, `SurfaceOfExtrusion`."""
        return Counter(_word(BRepAdaptor_Surface(face).GetType()) for face in self.each("FACE"))

    @property
    def curves(self) -> Counter[str]:
        """How many edges there are of each type, each once: `Line`, `Circle`, `Ellipse`, `BSplineCurve`."""
        seen: list[TopoDS_Shape] = []
        for edge in self.each("EDGE"):
            if not any(edge.IsSame(other) for other in seen):
                seen.append(edge)
        return Counter(_word(BRepAdaptor_Curve(edge).GetType()) for edge in seen)

    @property
    def volume(self) -> float:
        measured = GProp_GProps()
        BRepGProp.VolumeProperties_s(self.shape, measured, 1e-12)
        return float(measured.Mass())

    @property
    def area(self) -> float:
        measured = GProp_GProps()
        BRepGProp.SurfaceProperties_s(self.shape, measured, 1e-12)
        return float(measured.Mass())

    @property
    def bounds(self) -> tuple[float, ...]:
        """Least x, y, z, then greatest."""
        box = Bnd_Box()
        BRepBndLib.AddOptimal_s(self.shape, box, False, False)
        low, high = box.CornerMin(), box.CornerMax()
        return low.X(), low.Y(), low.Z(), high.X(), high.Y(), high.Z()


@dataclass(frozen=True)
class StepFile:
    name: str
    parts: tuple[Part, ...]

    def __getitem__(self, name: str) -> Part:
        (found,) = [part for part in self.parts if part.name == name]
        return found


def read(data: bytes, folder: Path) -> StepFile:
    """What a reader finds in a STEP file."""
    _silence()
    path = folder / "read.step"
    path.write_bytes(data)
    document = TDocStd_Document(TCollection_ExtendedString("test"))
    XCAFApp_Application.GetApplication_s().NewDocument(TCollection_ExtendedString("MDTV-XCAF"), document)
    reader = STEPCAFControl_Reader()
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    reader.ReadFile(str(path))
    assert reader.Transfer(document)
    free = Sequence_TDF_Label()
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    shapes.GetFreeShapes(free)
    (root,) = [free.Value(k) for k in range(1, free.Length() + 1)]
    found = Sequence_TDF_Label()
    if XCAFDoc_ShapeTool.IsAssembly_s(root):
        XCAFDoc_ShapeTool.GetComponents_s(root, found)
    labels = [found.Value(k) for k in range(1, found.Length() + 1)] or [root]
    return StepFile(_name(root), tuple(_part(document, label) for label in labels))


def _part(document: TDocStd_Document, label: TDF_Label) -> Part:
    shape = XCAFDoc_ShapeTool.GetShape_s(label)
    referred = TDF_Label()
    name = _name(referred if XCAFDoc_ShapeTool.GetReferredShape_s(label, referred) else label)
    assert name == _name(label)
    return Part(name, shape, _color(document, referred if not referred.IsNull() else label))


def _name(label: TDF_Label) -> str:
    attribute = TDataStd_Name()
    assert label.FindAttribute(TDataStd_Name.GetID_s(), attribute)
    return str(attribute.Get().ToExtString())


def _color(document: TDocStd_Document, label: TDF_Label) -> tuple[int, int, int] | None:
    """Of a part or of what it is made of, as sRGB from 0 to 255."""
    below = Sequence_TDF_Label()
    XCAFDoc_ShapeTool.GetSubShapes_s(label, below)
    colors = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    for place in (label, *(below.Value(k) for k in range(1, below.Length() + 1))):
        for kind in ("Surf", "Gen", "Curv"):
            found = Quantity_Color()
            if colors.GetColor_s(place, getattr(XCAFDoc_ColorType, f"XCAFDoc_Color{kind}"), found):
                values = found.Values(Quantity_TypeOfColor.Quantity_TOC_sRGB)
                red, green, blue = (round(255 * v) for v in values)
                return red, green, blue
    return None


def _word(kind: object) -> str:
    return str(kind).rpartition("_")[2]


def _silence() -> None:
    messenger = Message.DefaultMessenger_s()
    for printer in list(messenger.Printers()):
        messenger.RemovePrinter(printer)

"""What independent readers find in exported files, in one form: loops of curves by the name of their body.

Curves are taken as the reader of a format evaluates them (svgelements, ezdxf, pdfium, OpenCascade, trimesh);
of the package under test nothing is used here.
"""

from __future__ import annotations

import io
import math
import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Curve = Callable[[Points], Points]
"""From parameters between 0 and 1 to points (n, 2), mm."""

FINE = 256


@dataclass
class Loop:
    """A closed chain of curves."""

    curves: list[Curve]

    def polygon(self, count: int) -> Points:
        ts = np.arange(count) / count
        return np.concatenate([curve(ts) for curve in self.curves])

    @property
    def area(self) -> float:
        """Without sign. Polygons with n and 2 n sides for each curve err by c/n² and c/4n²."""
        coarse, fine = (polygon_area(self.polygon(n)) for n in (FINE, 2 * FINE))
        return abs(4 * fine - coarse) / 3

    @property
    def length(self) -> float:
        coarse, fine = (_length(self.polygon(n)) for n in (FINE, 2 * FINE))
        return (4 * fine - coarse) / 3

    def gap(self) -> float:
        """The largest distance between the end of a curve and the start of the next."""
        one, zero = np.array([1.0]), np.array([0.0])
        ends = [curve(one)[0] for curve in self.curves]
        starts = [curve(zero)[0] for curve in self.curves[1:] + self.curves[:1]]
        return max(math.dist(p, q) for p, q in zip(ends, starts, strict=True))


@dataclass
class Body:
    """The loops of a body, and how many faces they bound, where the format has them."""

    loops: list[Loop] = field(default_factory=list)
    faces: int = 0

    @property
    def area(self) -> float:
        """Loops in an odd number of others are holes."""
        polygons = [loop.polygon(16) for loop in self.loops]
        total = 0.0
        for k, loop in enumerate(self.loops):
            spot = polygons[k][0]
            depth = sum(_holds(p, spot) for j, p in enumerate(polygons) if j != k)
            total += (-1) ** depth * loop.area
        return total

    @property
    def perimeter(self) -> float:
        return sum(loop.length for loop in self.loops)

    @property
    def box(self) -> tuple[float, float, float, float]:
        points = np.concatenate([loop.polygon(1024) for loop in self.loops])
        (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
        return left, bottom, right, top


def polygon_area(p: Points) -> float:
    x, y = (p - p[0]).T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def _length(p: Points) -> float:
    return float(np.hypot(*(np.roll(p, -1, axis=0) - p).T).sum())


def _holds(polygon: Points, spot: Points) -> bool:
    from shapely import Point, Polygon

    return bool(Polygon(polygon).buffer(0).contains(Point(spot)))


def _straight(p: Any, q: Any) -> Curve:
    start, way = np.array(p, dtype=float)[:2], np.array(q, dtype=float)[:2] - np.array(p, dtype=float)[:2]
    return lambda t: start + np.multiply.outer(t, way)


# --- SVG -----------------------------------------------------------------------------------------


def svg_paths(data: bytes) -> list[Any]:
    """All paths of a document, in mm to three decimals: the reader takes an inch for 1/0.0393701 mm."""
    from svgelements import SVG, Path

    return list(SVG.parse(io.BytesIO(data), ppi=25.4).elements(lambda e: isinstance(e, Path)))


def read_svg(data: bytes) -> dict[str, Body]:
    """Filled paths of bodies, without areas on them, by the path of their structure."""
    bodies: dict[str, Body] = defaultdict(Body)
    for path, role, fill in svg_fills(data):
        if not role:
            bodies[path].faces += 1
            bodies[path].loops += fill.loops
    return dict(bodies)


def svg_fills(data: bytes) -> Iterator[tuple[str, str, Body]]:
    """Each filled path as one body, after the path of its structure and its class; in mm as the physical size
    of the document has it.
    """
    import svgelements

    # To the reader a millimetre is 0.0393701 inches: with so many pixels an inch it is one pixel.
    document = svgelements.SVG.parse(io.StringIO(data.decode()), ppi=1 / 0.0393701)
    for group in document.select(lambda e: isinstance(e, svgelements.Group) and "data-path" in e.values):
        for path in group.select(lambda e: isinstance(e, svgelements.Path)):
            if path.values["fill"] != "none":
                loops = [
                    Loop([_of_svg(s) for s in sub if not isinstance(s, svgelements.Move) and s.length() > 0])
                    for sub in map(svgelements.Path, path.as_subpaths())
                ]
                yield group.values["data-path"], path.values.get("class") or "", Body(loops, faces=1)


def svg_origin(data: bytes) -> tuple[float, float]:
    """Where the corner of the document, from which the reader counts, has the origin of the drawing."""
    left, top, *_ = (float(x) for x in re.search(rb'viewBox="([^"]*)"', data)[1].split())  # type: ignore[index]
    return -left, top


def _of_svg(segment: Any) -> Curve:
    return lambda t: segment.npoint(t) * (1, -1)


# --- DXF -----------------------------------------------------------------------------------------


def dxf_of(data: bytes, encoding: str = "utf-8") -> Any:
    """The document as ezdxf has it."""
    import ezdxf

    return ezdxf.read(io.StringIO(data.decode(encoding)))


def read_dxf(data: bytes) -> dict[str, Body]:
    """Closed polylines, circles and ellipses, and other entities chained by their ends; by the path that each
    carries. Areas of colour in a solid are left out.
    """
    document = dxf_of(data)
    assert not document.audit().errors
    bodies: dict[str, Body] = defaultdict(Body)
    chains: dict[str, list[Curve]] = defaultdict(list)
    pairs = [
        ("".join(tag.value for tag in entity.get_xdata("AIDL") if tag.code == 1000), entity)
        for entity in document.modelspace()
    ]
    solid = {path for path, entity in pairs if entity.dxf.layer != "drawing"}
    for path, entity in pairs:
        if path in solid and entity.dxf.layer == "drawing":
            continue
        kind = entity.dxftype()
        if kind == "LWPOLYLINE" and entity.closed:
            bodies[path].loops.append(Loop(_chained([_of_dxf(e) for e in entity.virtual_entities()])[0]))
        elif kind == "CIRCLE" or (
            kind == "ELLIPSE" and math.isclose(entity.construction_tool().param_span, math.tau)
        ):
            bodies[path].loops.append(Loop([_of_dxf(entity)]))
        else:
            chains[path].append(_of_dxf(entity))
    for path, curves in chains.items():
        bodies[path].loops += [Loop(chain) for chain in _chained(curves) if Loop(chain).gap() < 1e-6]
    return {path: body for path, body in bodies.items() if body.loops}


def _of_dxf(entity: Any) -> Curve:
    dxf = entity.dxf
    match entity.dxftype():
        case "LINE":
            return _straight(dxf.start, dxf.end)
        case "CIRCLE" | "ARC" as kind:
            first, span = (0.0, math.tau) if kind == "CIRCLE" else (math.radians(dxf.start_angle), 0.0)
            if kind == "ARC":
                span = math.radians((dxf.end_angle - dxf.start_angle) % 360)
            x, y, r = dxf.center.x, dxf.center.y, dxf.radius
            return lambda t: np.stack(
                (x + r * np.cos(first + span * t), y + r * np.sin(first + span * t)), axis=1
            )
        case "ELLIPSE":
            begin, span = dxf.start_param, entity.construction_tool().param_span
            return lambda t: np.array([(p.x, p.y) for p in entity.vertices(begin + span * t)])
        case "SPLINE":
            spline = entity.construction_tool()
            return lambda t: np.array([(p.x, p.y) for p in spline.points(t)])
        case other:
            raise AssertionError(other)


def _chained(curves: Iterable[Curve]) -> list[list[Curve]]:
    """Curves joined where an end meets a start or an end, turned round where needed."""
    left, chains = list(curves), []
    while left:
        chain = [left.pop(0)]
        while left:
            end = chain[-1](np.array([1.0]))[0]
            for k, curve in enumerate(left):
                start, stop = curve(np.array([0.0]))[0], curve(np.array([1.0]))[0]
                if min(math.dist(end, start), math.dist(end, stop)) < 1e-6:
                    turn = math.dist(end, start) > math.dist(end, stop)
                    chain.append((lambda c: lambda t: c(1 - t))(curve) if turn else curve)
                    del left[k]
                    break
            else:
                break
        chains.append(chain)
    return chains


# --- PDF -----------------------------------------------------------------------------------------


def read_pdf(data: bytes) -> list[Body]:
    """One body for each filled path on the first page, in order of drawing; mm, y upwards."""
    import pypdfium2.raw as pdfium
    from pypdfium2 import PdfDocument

    document = PdfDocument(data)
    found = []
    for item in document[0].get_objects():
        if item.type != pdfium.FPDF_PAGEOBJ_PATH:
            continue
        mode, stroke = pdfium.c_int(), pdfium.c_int()  # type: ignore[attr-defined]
        pdfium.FPDFPath_GetDrawMode(item.raw, mode, stroke)
        if mode.value != pdfium.FPDF_FILLMODE_NONE:
            found.append(Body(_of_pdf(item.raw, item.get_matrix()), faces=1))
    document.close()
    return found


def _of_pdf(path: Any, matrix: Any) -> list[Loop]:
    import ctypes

    import pypdfium2.raw as pdfium

    loops: list[Loop] = []
    at, pending = (0.0, 0.0), []
    for k in range(pdfium.FPDFPath_CountSegments(path)):
        segment = pdfium.FPDFPath_GetPathSegment(path, k)
        x, y = ctypes.c_float(), ctypes.c_float()
        pdfium.FPDFPathSegment_GetPoint(segment, x, y)
        u, v = matrix.on_point(x.value, y.value)
        p = u * 25.4 / 72, v * 25.4 / 72
        kind = pdfium.FPDFPathSegment_GetType(segment)
        if kind == pdfium.FPDF_SEGMENT_MOVETO:
            loops.append(Loop([]))
            start = at = p
        elif kind == pdfium.FPDF_SEGMENT_LINETO:
            loops[-1].curves.append(_straight(at, p))
            at = p
        else:
            pending.append(p)
            if len(pending) == 3:
                loops[-1].curves.append(_cubic(at, *pending))
                at, pending = p, []
        if pdfium.FPDFPathSegment_GetClose(segment) and math.dist(at, start) > 1e-9:
            loops[-1].curves.append(_straight(at, start))
    return loops


def _cubic(*points: Any) -> Curve:
    control = np.array(points)

    def curve(t: Points) -> Points:
        s = 1 - t
        return np.stack((s**3, 3 * s * s * t, 3 * s * t * t, t**3), axis=1) @ control

    return curve


# --- Bodies: readers that take seconds to load --------------------------------------------------------


def read_step(data: bytes, folder: Path) -> Any:
    """The `StepFile` that Open CASCADE reads."""
    from tests.export.step_reading import read

    return read(data, folder)


def read_meshes(data: bytes, suffix: str) -> dict[str, Any]:
    """The bodies of an STL or a 3MF by name."""
    import trimesh

    return dict(trimesh.load_scene(io.BytesIO(data), file_type=suffix.removeprefix(".")).geometry)


def read_mesh(path: Path) -> Any:
    """The one body of such a file."""
    (mesh,) = read_meshes(path.read_bytes(), path.suffix).values()
    return mesh


def united(meshes: Iterable[Any]) -> Any:
    import trimesh

    return trimesh.boolean.union(list(meshes), engine="manifold")

"""DXF files as outlines: millimetres, as seen from above, with blocks in their places."""

from __future__ import annotations

import io
import logging
import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from fontTools.misc.transform import Identity, Scale, Transform

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.drawings import Bow, Collector, DrawingError, Engraving, Stroke, bow, ends, mapped
from aidl_lang.common.font_files import FAULTS, Curve, Vec, point_of, quadratic
from aidl_lang.common.prose import counted
from aidl_lang.common.running import checkpoint

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.math import BSpline

MOST_ENTITIES = 100_000
_MOST_INSERTS = 20_000
_DEEPEST = 20
ENGRAVED = "AIDL_ENGRAVED"
"""The application under which AIDL says of an entity that it is engraved, and how."""

_NAMES = {
    kind: name
    for name, kinds in {
        "text": "TEXT MTEXT ATTRIB ATTDEF",
        "dimension": "DIMENSION ARC_DIMENSION",
        "leader": "LEADER MULTILEADER",
        "hatch": "HATCH MPOLYGON",
        "point": "POINT",
        "image": "IMAGE",
        "viewport": "VIEWPORT",
        "filled face": "SOLID TRACE 3DFACE",
        "mesh": "MESH",
        "endless line": "RAY XLINE",
    }.items()
    for kind in kinds.split()
}
"""How entities that are no outlines are called."""

logging.getLogger("ezdxf").addHandler(logging.NullHandler())


def read(data: bytes, name: str) -> tuple[Collector, list[Diagnostic]]:
    """Returns the elements of a DXF file and what there is to be told of it. Raises DrawingError."""
    document = _loaded(data, name)
    walk = _Walk(document, name)
    try:
        walk.entities(document.modelspace(), (), "")
    except FAULTS as reason:
        raise _broken(name) from reason
    return walk.done()


def _broken(name: str) -> DrawingError:
    return DrawingError("E0362", f"`{name}` is no DXF file, or is broken", "export it anew as DXF")


def _loaded(data: bytes, name: str) -> Drawing:
    """Returns a document; one with faults is mended as far as that goes. Raises DrawingError."""
    import ezdxf
    from ezdxf import recover
    from ezdxf.filemanagement import dxf_stream_info

    if data.startswith(b"AutoCAD Binary DXF"):
        hint = "export it as text: ASCII DXF"
        raise DrawingError("E0362", f"`{name}` is a binary DXF file, which is not read", hint)
    codes = data.split(b"\n")[::2]  # every second line is a value
    if sum(code.strip() == b"0" for code in codes) > MOST_ENTITIES:
        hint = "export fewer of its layers, or simplify it"
        message = f"`{name}` is refused: it has more than {MOST_ENTITIES:,} entities"
        raise DrawingError("E0363", message, hint)
    faults = (*FAULTS, ezdxf.DXFError)  # type: ignore[attr-defined]
    try:
        encoding = dxf_stream_info(io.StringIO(data.decode("utf-8", "ignore"))).encoding
        text = data.decode(encoding, "surrogateescape").replace("\r\n", "\n")
        return ezdxf.read(io.StringIO(text))  # type: ignore[attr-defined]
    except faults:
        checkpoint()
    try:
        document, _ = recover.read(io.BytesIO(data))
    except faults:
        raise _broken(name) from None
    return document


class _Walk:
    def __init__(self, document: Drawing, name: str) -> None:
        self.document = document
        self.name = name
        self.found = Collector(name)
        self.open: dict[tuple[tuple[str, ...], Engraving | None], list[Stroke]] = defaultdict(list)
        self.inserts = self.fitted = 0
        self.circular: list[str] = []
        hidden = (layer for layer in document.layers if layer.is_off() or layer.is_frozen())
        self.hidden = {layer.dxf.name.lower() for layer in hidden}
        self.unit = _millimetres(document.header.get("$INSUNITS", 0))

    def done(self) -> tuple[Collector, list[Diagnostic]]:
        for (names, engraving), strokes in self.open.items():
            self.found.add(names, strokes, engraving=engraving)
        return self.found, list(self._remarks())

    def entities(self, entities: Iterable[Any], blocks: tuple[str, ...], around: str) -> None:
        """Reads entities; `around` is the layer of the block that they stand in."""
        for entity in entities:
            checkpoint()
            layer = str(entity.dxf.get("layer", "0"))
            if layer == "0" and around:
                layer = around
            if entity.dxf.get("invisible", 0) or layer.lower() in self.hidden:
                self.found.left_out["hidden entity"] += 1
            elif entity.dxftype() == "INSERT":
                self._insert(entity, blocks, layer)
            else:
                self._entity(entity, (layer, *(b for b in blocks if not b.startswith("*"))))

    def _insert(self, entity: Any, blocks: tuple[str, ...], layer: str) -> None:
        block = str(entity.dxf.name)
        if block in blocks or len(blocks) > _DEEPEST:
            self.circular.append(block)
            return
        self.inserts += entity.mcount
        if self.inserts > _MOST_INSERTS:
            message = f"`{self.name}` is refused: its blocks stand in more than {_MOST_INSERTS:,} places"
            raise DrawingError("E0363", message, "export fewer of its layers, or simplify it")
        if entity.block() is None:
            self.found.left_out["dangling block reference"] += 1
            return
        if entity.mcount > 1:
            for one in entity.multi_insert():
                self.entities(one.virtual_entities(), (*blocks, block), layer)
        else:
            self.entities(entity.virtual_entities(), (*blocks, block), layer)

    def _entity(self, entity: Any, names: tuple[str, ...]) -> None:
        kind = entity.dxftype()
        strokes = list(self._strokes(kind, entity))
        if not strokes:
            if kind not in _READ or kind == "POLYLINE":
                self.found.left_out[_NAMES.get(kind, f"`{kind[:20]}` object")] += 1
            return
        strokes = [mapped(s, Scale(self.unit or 1.0)) for s in strokes]
        engraving = _engraving(entity)
        # The outlines of one area alternate.
        is_alone = engraving is None or not engraving.is_area
        if is_alone and ends(strokes[0])[0] == ends(strokes[-1])[1]:
            self.found.add(names, strokes, engraving=engraving)
        else:
            self.open[names, engraving] += strokes
            self.found.curves += len(strokes)
            self.found.check()

    def _strokes(self, kind: str, entity: Any) -> Iterator[Stroke]:
        match kind:
            case "LINE":
                yield _flat(entity.dxf.start), _flat(entity.dxf.end)
            case "CIRCLE" | "ARC":
                yield _round(entity, is_whole=kind == "CIRCLE")
            case "ELLIPSE":
                yield _ellipse(entity)
            case "LWPOLYLINE":
                points = [(float(x), float(y), float(bulge)) for x, y, bulge in entity.get_points("xyb")]
                height = entity.dxf.get("elevation", 0.0)
                yield from _bulged(points, entity.closed, _plane(entity, height))
            case "POLYLINE" if entity.is_2d_polyline or entity.is_3d_polyline:
                yield from _polyline(entity)
            case "SPLINE":
                curves, is_exact = _cubics(entity)
                self.fitted += not is_exact
                yield from curves

    def _remarks(self) -> Iterator[Diagnostic]:
        if self.circular:
            block = f"a block that stands in itself, `{self.circular[0]}`"
            hint = "export it anew in the program that drew it"
            yield Diagnostic("W0752", f"`{self.name}` has {block}: it is left out there", hints=(hint,))
        if self.fitted:
            splines = f"{counted(self.fitted, 'spline')} of `{self.name}`"
            message = f"{splines} are followed by cubics, to a ten millionth of their size"
            hint = "rational splines, and those of a degree above 3, are no Bézier curves"
            yield Diagnostic("N0752", message, hints=(hint,))
        if self.unit is None and self.found.elements:
            message = f"`{self.name}` does not say its unit, and is taken to be in millimetres"
            hint = "if it is in inches, write `scale: 25.4`; or set `$INSUNITS` where it is drawn"
            yield Diagnostic("N0753", message, hints=(hint,))


def _engraving(entity: Any) -> Engraving | None:
    """Returns the operation and the layer that AIDL notes on an engraved entity; None for others."""
    if not entity.has_xdata(ENGRAVED):
        return None
    operation, layer = ([text for code, text in entity.get_xdata(ENGRAVED) if code == 1000] + ["", ""])[:2]
    color = entity.rgb
    return Engraving(
        layer or None, None if color is None else "#{:02x}{:02x}{:02x}".format(*color), operation == "fill"
    )


def _millimetres(units: object) -> float | None:
    """Returns the millimetres in the units of `$INSUNITS`; None if it names none."""
    from ezdxf.enums import InsertUnits
    from ezdxf.units import conversion_factor

    try:
        unit = InsertUnits(int(str(units)))
        if unit is InsertUnits.Unitless:
            return None
        return float(f"{conversion_factor(unit, InsertUnits.Millimeters):.9g}")  # without its rounding
    except (TypeError, ValueError):
        return None


_READ = frozenset({"LINE", "CIRCLE", "ARC", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "SPLINE"})


def _plane(entity: Any, height: float = 0.0) -> Transform:
    """Returns the map of an entity's own coordinates to the world's, seen from above."""
    system = entity.ocs()
    return Transform(*(v for p in ((1, 0, 0), (0, 1, 0), (0, 0, height)) for v in _flat(system.to_wcs(p))))


def _round(entity: Any, *, is_whole: bool) -> Stroke:
    center, radius = entity.dxf.center, float(entity.dxf.radius)
    first, sweep = 0.0, math.tau
    if not is_whole:
        first = math.radians(entity.dxf.start_angle)
        sweep = math.radians(entity.dxf.end_angle) - first
        sweep = sweep % math.tau or math.tau
    made = bow(_flat(center), (radius, 0.0), (0.0, radius), first, sweep)
    return mapped(made, _plane(entity, center[2]))


def _ellipse(entity: Any) -> Stroke:
    first = float(entity.dxf.start_param)
    sweep = (float(entity.dxf.end_param) - first) % math.tau
    if sweep < 1e-9 or sweep > math.tau - 1e-9:
        sweep = math.tau
    return bow(_flat(entity.dxf.center), _flat(entity.dxf.major_axis), _flat(entity.minor_axis), first, sweep)


def _polyline(entity: Any) -> Iterator[Stroke]:
    if entity.is_3d_polyline:
        points = [(*_flat(v.dxf.location), 0.0) for v in entity.vertices]
        yield from _bulged(points, entity.is_closed, Identity)
        return
    kept = [v for v in entity.vertices if not v.dxf.flags & 16]  # without the frame of a fitted spline
    points = [(*_flat(v.dxf.location), float(v.dxf.get("bulge", 0.0))) for v in kept]
    height = entity.dxf.elevation[2] if entity.dxf.hasattr("elevation") else 0.0
    yield from _bulged(points, entity.is_closed, _plane(entity, height))


def _bulged(
    points: Sequence[tuple[float, float, float]], is_closed: bool, plane: Transform
) -> Iterator[Stroke]:
    """Yields the edges of a polyline: lines, and arcs by their bulge, tan(sweep / 4)."""
    if is_closed and len(points) > 1:
        points = [*points, (*points[0][:2], 0.0)]
    for (x0, y0, bulge), (x1, y1, _) in pairwise(points):
        start, end = (x0, y0), (x1, y1)
        if bulge == 0.0 or start == end:
            yield mapped((start, end), plane)
            continue
        dx, dy = x1 - x0, y1 - y0
        off = (1.0 - bulge * bulge) / (4.0 * bulge)
        cx, cy = (x0 + x1) / 2 - off * dy, (y0 + y1) / 2 + off * dx
        radius = math.hypot(dx, dy) * (1.0 + bulge * bulge) / (4.0 * abs(bulge))
        first, sweep = math.atan2(y0 - cy, x0 - cx), 4.0 * math.atan(bulge)
        yield mapped(Bow((cx, cy), (radius, 0.0), (0.0, radius), first, sweep, start, end), plane)


# --- B-splines as cubic Bézier curves.

_NEAR = 1e-7
"""Distance of a cubic from the curve that it follows, relative to the size of that."""
_HALVINGS = 10


def _cubics(entity: Any) -> tuple[list[Curve], bool]:
    """Returns the cubics of a SPLINE, and whether they are the same curve."""
    spline: BSpline = entity.construction_tool()
    if spline.degree <= 3 and not spline.is_rational and spline.is_clamped:
        pieces = (tuple(map(_flat, piece)) for piece in spline.bezier_decomposition())
        return [quadratic(*piece) if len(piece) == 3 else piece for piece in pieces], True
    points = [_flat(p) for p in spline.control_points]
    size = max(max(axis) - min(axis) for axis in zip(*points, strict=True)) or 1.0
    knots = sorted(set(spline.knots()[spline.degree : len(spline.knots()) - spline.degree]))
    found = [
        curve
        for first, last in pairwise(knots)
        for curve in _followed(spline, first, last, _NEAR * size, _HALVINGS)
    ]
    # Each begins where the one before it ends, to the last digit.
    return [(found[k - 1][-1], *curve[1:]) if k else curve for k, curve in enumerate(found)], False


def _flat(p: Any) -> Vec:
    return float(p[0]), float(p[1])


def _followed(spline: BSpline, first: float, last: float, near: float, halvings: int) -> Iterator[Curve]:
    """Yields cubics with the ends and the derivatives of a part of a spline, halved until they are near."""
    checkpoint()
    step = last - first
    inside = [first + 1e-12 * step, last - 1e-12 * step]  # of the part, should its ends be corners
    (start, heading), (end, arrival) = ((_flat(p), _flat(d)) for p, d in spline.derivatives(inside, 1))
    one = start[0] + heading[0] * step / 3, start[1] + heading[1] * step / 3
    two = end[0] - arrival[0] * step / 3, end[1] - arrival[1] * step / 3
    middle = (first + last) / 2
    off = max(
        math.dist(point_of((start, one, two, end), k / 4), _flat(spline.point(first + k / 4 * step)))
        for k in (1, 2, 3)
    )
    if off <= near or halvings == 0:
        yield start, one, two, end
        return
    yield from _followed(spline, first, middle, near, halvings - 1)
    yield from _followed(spline, middle, last, near, halvings - 1)

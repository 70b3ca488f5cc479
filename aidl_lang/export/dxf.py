"""DXF for laser cutters, routers and other CAD systems: 1:1 in mm or inches, y upwards.

Each outline is one entity: a circle, or a polyline of lines and arcs, closed if the outline is. Curves of
other kinds are fitted by arcs (`geometry.arcs`). Outer outlines run counter-clockwise, inner ones clockwise.
On request the file is one of R12, which says the same in older words; or it is exact, and an outline with
other curves in it has an entity for each piece.

The order is that of `cuts`, the layers those of `dxf_layers`, the lines those of `dxf_lines`.

Each entity carries the path of its body as XDATA of the application AIDL, and that of the hole it comes from
as XDATA of AIDL_HOLE; what is engraved has the operation and its layer as XDATA of AIDL_ENGRAVED. A GROUP
would need the path changed to what DXF takes as a name, and is lost when an
entity is copied to another file.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from aidl_lang.common.cancelling import checkpoint
from aidl_lang.common.drawings.dxf import ENGRAVED
from aidl_lang.export import UNITS, Exported, Job
from aidl_lang.export.cuts import Outline, outlines
from aidl_lang.export.dxf_layers import Layers, color_attributes
from aidl_lang.export.dxf_lines import Lines
from aidl_lang.export.labels import labels
from aidl_lang.export.marks import Text
from aidl_lang.export.profiles import FILL, ON_PARTS, PLAIN, SCORE, Look, Profile
from aidl_lang.geometry.arcs import as_arcs
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line, Piece, Vec
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.evaluate import TAU, ends, point, reverse, round_range

BODY, HOLE = "AIDL", "AIDL_HOLE"
INSUNITS, MEASUREMENT = {"mm": 4, "in": 1}, {"mm": 1, "in": 0}
"""Numbers by which a header says the units, and the kind of units."""
LONGEST = 1.75 * math.pi
"""Largest sweep of an arc in a polyline. The nearer its ends, the less they tell of its radius."""
THINNEST = 1e-6
"""Smallest ratio of the axes that DXF takes for an ellipse; it moves no point by more."""
DIGITS = 13
"""Coordinates have this many digits of the size of the drawing, past which rounding errors begin."""
LABELS, GREY = "labels", "#808080"
"""The layer for names and numbers of parts."""
CAPITAL = 0.73
"""Height of capitals, by which DXF has the size of a text, relative to the size of the font."""
TEXT_BYTES, ESCAPED = 255, 7
"""Bytes of a text in XDATA, and of a character that the file's encoding lacks."""
PATTERN_GOES_ON = 128
"""Flag of a polyline whose dashes do not begin anew at each corner."""


def to_dxf(job: Job) -> Exported:
    """Writes the outlines and lines of a drawing as a DXF document."""
    import ezdxf
    from ezdxf.document import Drawing as Document

    library: Any = ezdxf
    before = library.options.write_fixed_meta_data_for_testing
    # Else the document holds the time and random numbers.
    library.options.write_fixed_meta_data_for_testing = True
    try:
        is_old = job.options.dxf == "r12"
        # R12 has no place for the unit; `new` would set one, and complain on standard error.
        document = Document.new("R12") if is_old else library.new("R2010", units=INSUNITS[job.options.units])
        return _written(document, job, is_old)
    finally:
        library.options.write_fixed_meta_data_for_testing = before


def _written(document: Any, job: Job, is_old: bool) -> Exported:
    profile = job.options.followed
    found = outlines(job.model, job.drawing, profile or PLAIN)
    if profile is not None:
        found = [outline for outline in found if outline.operation]
    for application in (BODY, HOLE, ENGRAVED):
        document.appids.new(application)
    if not is_old:
        document.header["$MEASUREMENT"] = MEASUREMENT[job.options.units]
    tolerance = None if job.options.dxf == "splines" else job.options.tolerance
    entities = _Entities(document.modelspace(), job.drawing, tolerance, is_old)
    layers, lines = (
        Layers(document, job.model, is_old),
        Lines(document, job.drawing.size, is_old, job.options.units),
    )
    for outline in found:
        checkpoint()
        if profile is not None:
            attributes = _followed(outline, profile, layers)
        else:
            attributes = {"layer": layers.name(outline.layer)} | lines.attributes(outline.style)
            if outline.style.color is not None:
                attributes |= color_attributes(outline.style.color, is_old)
        names = [(BODY, outline.path)] + ([(HOLE, outline.hole)] if outline.hole else [])
        said = [outline.operation, outline.style.layer or ""] if outline.operation in ON_PARTS else []
        if outline.operation in (FILL, SCORE) and not outline.style.layer:
            said[1] = outline.operation
        for entity in entities.add(outline, attributes):
            if said:
                entity.set_xdata(ENGRAVED, [(1000, text[: TEXT_BYTES // ESCAPED]) for text in said])
            for application, path in names:
                entity.set_xdata(application, [(1000, text) for text in _split(path)])
    _add_labels(document, labels(job), layers)
    factor = _scaled(document, job.options.units)
    if found:
        _set_view(document, job.drawing, factor)
    _order_classes(document)
    text = io.StringIO()
    document.write(text)
    data = text.getvalue().encode(document.output_encoding, errors="dxfreplace")
    return Exported(data, notes=tuple(layers.notes))


def _scaled(document: Any, units: str) -> float:
    """Multiplies what was drawn in mm so that it is in `units`, and returns the factor."""
    from ezdxf import transform

    factor = 1 / UNITS[units]
    if factor != 1:
        transform.scale_uniform(document.modelspace(), factor)
    return factor


def _followed(outline: Outline, profile: Profile, layers: Layers) -> dict[str, Any]:
    """Returns the layer of an outline for a cutter, and its colour where that is not the layer's."""
    look, color = profile.look(outline.style.layer, outline.operation), profile.color(outline)
    name = layers.name(look.layer or outline.layer, look)
    own = {} if layers.has_color(name, color) else color_attributes(color, layers.is_old)
    return {"layer": name} | own


def _add_labels(document: Any, texts: Iterable[Text], layers: Layers) -> None:
    """Adds texts on a layer of their own, which is not plotted: a machine leaves it out."""
    from ezdxf.enums import TextEntityAlignment

    for text in texts:
        layer = layers.name(LABELS, Look(GREY))
        document.layers.get(layer).dxf.plot = 0
        made = document.modelspace().add_text(
            text.text, height=CAPITAL * text.size, dxfattribs={"layer": layer}
        )
        made.set_placement(text.at, align=TextEntityAlignment.CENTER)


def _order_classes(document: Any) -> None:
    """Orders the registered classes: the library goes through a set, in another order in each process."""
    document.classes.add_required_classes(document.dxfversion)
    classes = document.classes.classes
    for key in sorted(classes):
        classes.move_to_end(key)


def _set_view(document: Any, drawing: Drawing, factor: float) -> None:
    """Sets extents, limits and a first view that show the drawing with its lengths multiplied."""
    left, bottom, right, top = (factor * side for side in drawing.box)
    space = document.modelspace()
    space.dxf.extmin, space.dxf.extmax = (left, bottom, 0.0), (right, top, 0.0)
    space.dxf.limmin, space.dxf.limmax = (left, bottom), (right, top)
    for name, p in (("EXTMIN", (left, bottom, 0.0)), ("EXTMAX", (right, top, 0.0))):
        document.header[f"${name}"] = p
    document.header["$LIMMIN"], document.header["$LIMMAX"] = (left, bottom), (right, top)
    document.set_modelspace_vport(1.1 * factor * drawing.size, ((left + right) / 2, (bottom + top) / 2))


def _split(path: str) -> list[str]:
    """Splits a path into texts of the length that XDATA allows."""
    count = TEXT_BYTES if path.isascii() else TEXT_BYTES // ESCAPED
    return [path[k : k + count] for k in range(0, len(path), count)]


class _Entities:
    """Writes outlines as entities, of arcs within a `tolerance` or, without one, of the curves themselves."""

    def __init__(self, space: Any, drawing: Drawing, tolerance: float | None, is_old: bool) -> None:
        self._space, self._tolerance, self._is_old = space, tolerance, is_old
        self._decimals = DIGITS - 1 - math.floor(math.log10(drawing.size))

    def _rounded(self, value: float) -> float:
        return round(value, self._decimals) + 0.0

    def _at(self, p: Vec) -> Vec:
        return self._rounded(p[0]), self._rounded(p[1])

    def add(self, outline: Outline, attributes: dict[str, Any]) -> Iterator[Any]:
        """Yields the entities of an outline, made one by one."""
        pieces = outline.pieces
        if self._tolerance is not None:
            pieces = as_arcs(pieces, outline.closed, self._tolerance)
        if outline.clockwise:
            pieces = tuple(reverse(piece) for piece in reversed(pieces))
        if len(pieces) > 1 and all(isinstance(piece, Line | Arc) for piece in pieces):
            yield self._polyline(pieces, outline.closed, attributes)
        else:
            for piece in pieces:
                yield self._single(piece, attributes)

    def _polyline(self, pieces: Sequence[Piece], closed: bool, attributes: dict[str, Any]) -> Any:
        corners = [corner for piece in pieces for corner in self._corners(piece)]
        if not closed:
            corners.append((*self._at(ends(pieces[-1])[1]), 0.0))
        add = self._space.add_polyline2d if self._is_old else self._space.add_lwpolyline
        made = add(corners, format="xyb", close=closed, dxfattribs=attributes)
        if "linetype" in attributes:
            made.dxf.flags |= PATTERN_GOES_ON
        return made

    def _corners(self, piece: Piece) -> Iterator[tuple[float, float, float]]:
        """Yields x, y and bulge at the start of a piece and where it is split. The bulge is tan(sweep /
        4).
        """
        if not isinstance(piece, Arc):
            yield (*self._at(ends(piece)[0]), 0.0)
            return
        parts = math.ceil(abs(piece.sweep) / LONGEST)
        bulge = math.tan(piece.sweep / parts / 4)
        for k in range(parts):
            yield (*self._at(point(piece, k / parts)), bulge)

    def _single(self, piece: Piece, attributes: dict[str, Any]) -> Any:
        space = self._space
        match piece:
            case Line(start, end):
                return space.add_line(self._at(start), self._at(end), dxfattribs=attributes)
            case Circle(center, radius):
                return space.add_circle(self._at(center), self._rounded(radius), dxfattribs=attributes)
            case Arc():
                return self._arc(piece, attributes)
            case Bezier(p0, p1, p2, p3):
                # The knots of the one span are 0 0 0 0 1 1 1 1: a Bézier curve.
                return space.add_open_spline(list(map(self._at, (p0, p1, p2, p3))), 3, dxfattribs=attributes)
            case Ellipse() | EllipseArc():
                return self._ellipse(piece, attributes)

    def _arc(self, arc: Arc, attributes: dict[str, Any]) -> Any:
        """Adds an arc; DXF runs from the first angle to the last counter-clockwise."""
        center, radius = self._at(arc.center), self._rounded(arc.radius)
        if abs(arc.sweep) >= TAU:
            return self._space.add_circle(center, radius, dxfattribs=attributes)
        first, last = (
            math.degrees(math.atan2(p[1] - arc.center[1], p[0] - arc.center[0])) % 360
            for p in ((arc.start, arc.end) if arc.sweep > 0 else (arc.end, arc.start))
        )
        return self._space.add_arc(center, radius, first, last, dxfattribs=attributes)

    def _ellipse(self, piece: Ellipse | EllipseArc, attributes: dict[str, Any]) -> Any:
        """Adds an ellipse. DXF has the larger half-axis first, and runs from the first eccentric anomaly to
        the last counter-clockwise.
        """
        major, minor, angle = piece.rx, piece.ry, piece.angle
        first, sweep = round_range(piece)
        if minor > major:
            major, minor, angle, first = minor, major, angle + TAU / 4, first - TAU / 4
        if sweep < 0:
            first, sweep = first + sweep, -sweep
        whole = sweep >= TAU
        return self._space.add_ellipse(
            self._at(piece.center),
            self._at((major * math.cos(angle), major * math.sin(angle))),
            max(minor / major, THINNEST),
            0.0 if whole else first % TAU,
            TAU if whole else (first + sweep) % TAU,
            dxfattribs=attributes,
        )

"""DXF for laser cutters, routers and other CAD systems: 1:1 in mm or inches, y upwards."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from aidl_lang.common.colors import rgb
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.drawings.dxf import ENGRAVED
from aidl_lang.common.prose import fixed, shortened
from aidl_lang.common.running import checkpoint
from aidl_lang.common.source import Span
from aidl_lang.export.cuts import Outline, outlines
from aidl_lang.export.job import UNITS, Exported, Job
from aidl_lang.export.marks import CAPITAL, Text
from aidl_lang.export.overlay import labels
from aidl_lang.export.profiles import FILL, ON_PARTS, PLAIN, SCORE, Look
from aidl_lang.geometry.arcs import as_arcs
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line, Piece, Vec
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.styles import Style

# --- The lines of a DXF: weights that it knows, and a linetype for each pattern of dashes.

WEIGHTS = (
    *(0, 5, 9, 13, 15, 18, 20, 25, 30, 35, 40, 50, 53, 60, 70, 80, 90, 100, 106, 120, 140, 158, 200, 211),
)
"""Hundredths of a millimetre: DXF takes no others."""
DASHED = "DASHED"


def weight(width: float) -> int:
    """Returns the weight nearest to a width, mm."""
    return min(WEIGHTS, key=lambda known: abs(known - 100 * width))


# --- Layers of a DXF: names that it can hold, and a colour for each.

OWN = {"solid": 7, "assembly": 7, "hole": 1, "drawing": 5, "open": 6}
"""Layers for outlines (black or white), holes (red), drawings on parts (blue) and what bounds nothing
(magenta) without a layer of their own; colours in the AutoCAD Color Index.
"""
FURTHER = (3, 4, 30, 200, 140, 54, 8)
"""Colours for layers of the author, in turn, since some programs tell layers apart by colour alone."""


_NEW = (
    255,
    re.compile('[<>/\\\\":;?*|,=`^\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff]'),
    'names in DXF have 1 to 255 characters and none of < > / \\ " : ; ? * | , = ` ^',
)
_OLD = (31, re.compile("[^A-Za-z0-9$_-]"), "names in DXF R12 have 1 to 31 letters, digits, $, - and _")
"""The longest name of a layer, what it may not have, and how that is said."""
_ALIKE = "DXF makes no difference between capital and small letters in names, and keeps some for itself"
_NEVER_PLOTTED = "defpoints"


def color_attributes(color: str, is_old: bool) -> dict[str, int]:
    """Returns the attributes for a colour: R12 knows those of the AutoCAD Color Index alone."""
    from ezdxf.colors import aci2rgb

    red, green, blue = wanted = rgb(color)
    # White and black are one colour of the index, by the background.
    nearest = min(range(1, 256), key=lambda index: math.dist(aci2rgb(index), wanted)) if any(wanted) else 7
    return {"color": nearest} if is_old else {"true_color": red << 16 | green << 8 | blue}


class Looks:
    """The layers and the linetypes in use, each made on first use. DXF ignores case in names, so one of two
    that differ only in case is changed. R12 (`is_old`) knows no weights, and no points in names.
    """

    def __init__(self, document: Any, job: Job, is_old: bool) -> None:
        self._document, self._job, self._is_old = document, job, is_old
        self._names: dict[str, str] = {}
        self._taken = {_NEVER_PLOTTED, *OWN}
        self._colors: dict[str, str] = {}
        self.notes: list[Diagnostic] = []

    def of(self, outline: Outline) -> dict[str, Any]:
        """Returns the layer of an outline and its looks; for a cutter a colour that is not the layer's."""
        profile, style = self._job.options.followed, outline.style
        if profile is None:
            found = {"layer": self.layer(outline.layer)} | self._line(style)
            return found if style.color is None else found | color_attributes(style.color, self._is_old)
        look, color = profile.look(style.layer, outline.operation), profile.color(outline)
        name = self.layer(look.layer or outline.layer, look)
        own = {} if self._colors.get(name) == color else color_attributes(color, self._is_old)
        return {"layer": name} | own

    def _line(self, style: Style) -> dict[str, Any]:
        found: dict[str, Any] = {}
        if style.width is not None and not self._is_old:
            found["lineweight"] = weight(style.width)
        if (dashes := style.dashes(self._job.drawing.size)) is not None:
            found["linetype"] = self._linetype(dashes, is_named=bool(style.dash))
        return found

    def _linetype(self, dashes: tuple[float, ...], *, is_named: bool) -> str:
        """Returns the name of a pattern; the one that goes by the size of the drawing is just dashed."""
        name = "_".join((DASHED, *map(fixed, dashes))) if is_named else DASHED
        if self._is_old:
            name = name.replace(".", "_")
        if name not in self._document.linetypes:
            units = self._job.options.units
            parts = [part / UNITS[units] for part in dashes]
            pattern = [-part if k % 2 else part for k, part in enumerate(parts)]
            said = f"dashes and gaps in {units}"
            self._document.linetypes.add(name, [sum(parts), *pattern], description=said)
        return name

    def layer(self, wanted: str, look: Look | None = None) -> str:
        """Returns the document's name for a layer of the program, which is made on first use, with a look."""
        if wanted not in self._names:
            self._names[wanted] = name = wanted if wanted in OWN else self._free(wanted)
            if name not in self._document.layers:
                own = sum(known not in OWN for known in self._names) - 1
                color = OWN.get(name) or FURTHER[own % len(FURTHER)]
                self._document.layers.add(name, **({"color": color} if look is None else self._like(look)))
            if look is not None:
                self._colors[name] = look.color
        return self._names[wanted]

    def _like(self, look: Look) -> dict[str, int]:
        """Returns the attributes of a layer; programs that know no true colours take that of the index."""
        index = color_attributes(look.color, is_old=True)
        if self._is_old:
            return index
        return index | color_attributes(look.color, is_old=False) | {"lineweight": weight(look.width)}

    def _free(self, wanted: str) -> str:
        longest, refused, rule = _OLD if self._is_old else _NEW
        allowed = refused.sub("_", wanted).strip()[:longest] or "_"
        name, count = allowed, 1
        while name.casefold() in self._taken:
            count += 1
            name = f"{allowed[: longest - len(str(count)) - 1]}_{count}"
        self._taken.add(name.casefold())
        if name != wanted:
            message = f"the layer `{shortened(wanted, 60)}` is called `{shortened(name, 60)}` in the DXF"
            why = _ALIKE if count > 1 else rule
            self.notes.append(Diagnostic("W0720", message, self._place(wanted), hints=(why,)))
        return name

    def _place(self, layer: str) -> Span | None:
        said = ((s.attributes.get("layer"), s.span) for s in self._job.model.root.walk())
        return next((span for values, span in said if values and str(values[0]) == layer), None)


# Each outline is one entity: a circle, or a polyline of lines and arcs, closed if the outline is. Curves of
# other kinds are fitted by arcs (`geometry.arcs`). Outer outlines run counter-clockwise, inner ones
# clockwise. On request the file is one of R12, which says the same in older words; or it is exact, and an
# outline with other curves in it has an entity for each piece.
#
# The order is that of `cuts`.
#
# Each entity carries the path of its body as XDATA of the application AIDL, and that of the hole it comes
# from as XDATA of AIDL_HOLE; what is engraved has the operation and its layer as XDATA of AIDL_ENGRAVED. A
# GROUP would need the path changed to what DXF takes as a name, and is lost when an entity is copied to
# another file.

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
    looks = Looks(document, job, is_old)
    for outline in found:
        checkpoint()
        names = [(BODY, outline.path)] + ([(HOLE, outline.hole)] if outline.hole else [])
        said = [outline.operation, outline.style.layer or ""] if outline.operation in ON_PARTS else []
        if outline.operation in (FILL, SCORE) and not outline.style.layer:
            said[1] = outline.operation
        for entity in entities.add(outline, looks.of(outline)):
            if said:
                entity.set_xdata(ENGRAVED, [(1000, text[: TEXT_BYTES // ESCAPED]) for text in said])
            for application, path in names:
                entity.set_xdata(application, [(1000, text) for text in _split(path)])
    _add_labels(document, labels(job), looks)
    factor = 1 / UNITS[job.options.units]
    if factor != 1:  # it was drawn in mm
        from ezdxf import transform

        transform.scale_uniform(document.modelspace(), factor)
    if found:
        _set_view(document, job.drawing, factor)
    # The library goes through a set of classes, in another order in each process.
    document.classes.add_required_classes(document.dxfversion)
    classes = document.classes.classes
    for key in sorted(classes):
        classes.move_to_end(key)
    text = io.StringIO()
    document.write(text)
    return Exported(document.encode(text.getvalue()), notes=tuple(looks.notes))


def _add_labels(document: Any, texts: Iterable[Text], looks: Looks) -> None:
    """Adds texts on a layer of their own, which is not plotted: a machine leaves it out."""
    from ezdxf.enums import TextEntityAlignment

    for text in texts:
        layer = looks.layer(LABELS, Look(GREY))
        document.layers.get(layer).dxf.plot = 0
        looked = {"layer": layer}
        made = document.modelspace().add_text(text.text, height=CAPITAL * text.size, dxfattribs=looked)
        made.set_placement(text.at, align=TextEntityAlignment.CENTER)


def _set_view(document: Any, drawing: Drawing, factor: float) -> None:
    left, bottom, right, top = (factor * side for side in drawing.box)
    space = document.modelspace()
    space.dxf.limmin, space.dxf.limmax = (left, bottom), (right, top)
    space.dxf.extmin = document.header["$EXTMIN"] = (left, bottom, 0.0)
    space.dxf.extmax = document.header["$EXTMAX"] = (right, top, 0.0)
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
            pieces = tuple(piece.reversed() for piece in reversed(pieces))
        if len(pieces) > 1 and all(isinstance(piece, Line | Arc) for piece in pieces):
            yield self._polyline(pieces, outline.closed, attributes)
        else:
            for piece in pieces:
                yield self._single(piece, attributes)

    def _polyline(self, pieces: Sequence[Piece], closed: bool, attributes: dict[str, Any]) -> Any:
        corners = [corner for piece in pieces for corner in self._corners(piece)]
        if not closed:
            corners.append((*self._at(pieces[-1].ends[1]), 0.0))
        add = self._space.add_polyline2d if self._is_old else self._space.add_lwpolyline
        made = add(corners, format="xyb", close=closed, dxfattribs=attributes)
        if "linetype" in attributes:
            made.dxf.flags |= PATTERN_GOES_ON
        return made

    def _corners(self, piece: Piece) -> Iterator[tuple[float, float, float]]:
        """Yields x, y and bulge, tan(sweep / 4), where a piece starts and where it is split."""
        if not isinstance(piece, Arc):
            yield (*self._at(piece.ends[0]), 0.0)
            return
        parts = math.ceil(abs(piece.sweep) / LONGEST)
        bulge = math.tan(piece.sweep / parts / 4)
        for k in range(parts):
            yield (*self._at(piece.point(k / parts)), bulge)

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
        if abs(arc.sweep) >= math.tau:
            return self._space.add_circle(center, radius, dxfattribs=attributes)
        first, last = (
            math.degrees(math.atan2(p[1] - arc.center[1], p[0] - arc.center[0])) % 360
            for p in ((arc.start, arc.end) if arc.sweep > 0 else (arc.end, arc.start))
        )
        return self._space.add_arc(center, radius, first, last, dxfattribs=attributes)

    def _ellipse(self, piece: Ellipse | EllipseArc, attributes: dict[str, Any]) -> Any:
        """Adds an ellipse; DXF has the larger half-axis first, and anomalies that run counter-clockwise."""
        major, minor, angle = piece.rx, piece.ry, piece.angle
        first, sweep = piece.range
        if minor > major:
            major, minor, angle, first = minor, major, angle + math.tau / 4, first - math.tau / 4
        if sweep < 0:
            first, sweep = first + sweep, -sweep
        whole = sweep >= math.tau
        return self._space.add_ellipse(
            self._at(piece.center),
            self._at((major * math.cos(angle), major * math.sin(angle))),
            max(minor / major, THINNEST),
            0.0 if whole else first % math.tau,
            math.tau if whole else (first + sweep) % math.tau,
            dxfattribs=attributes,
        )

"""The data of a preview, its JSON (`pane/protocol.d.ts`), and the numbered elements of a drawing."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any, TypeAlias

from aidl_lang.common.diagnostics import Fix
from aidl_lang.common.prose import rounded, short
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.geometry.curves import Arc, Bounds, Circle, Ellipse, Line, Piece, Vec, bounds, union_bounds
from aidl_lang.geometry.solved import ConstraintReport, SolvedGeometry, SolvedModel, SolvedStructure
from aidl_lang.tools.ide.dragging import Handle
from aidl_lang.tools.ide.workspace import Positions, View

# --- The data of a preview. Coordinates in mm in the frame of the root, y upwards; places are spans.

FREEDOM = "freedom"
"""The layer of remaining motions, which are listed beside the picture and not drawn in it."""
LAYERS = ("names", "points", "bbox", "constraints", "dof", "plan", "dimensions")
"""Layers that may be drawn over the picture."""


@record()
class Element:
    """A drawn thing; its number in the picture is its index.

    kind  `structure` or `geometry`; `type` tells which of them
    span  its place in the present text; for a thing made by the library, the call. None if an edit removed it
    hint  a line about it
    """

    path: str
    kind: str
    type: str
    span: Span | None
    hint: str


@record()
class Slider:
    """A `param`: `span` is the place of its value; `editable` says whether that can be written."""

    path: str
    name: str
    kind: str
    """`number`, `choice`, `truth` or `text`"""
    value: float | str | bool
    unit: str
    low: float | None
    high: float | None
    step: float | None
    choices: tuple[float | str | bool, ...]
    doc: str
    span: Span | None
    editable: bool


@record()
class Problem:
    """A diagnostic with the numbers of its elements, and points of the drawing."""

    severity: str
    code: str
    message: str
    hints: tuple[str, ...]
    span: Span | None
    elements: tuple[int, ...]
    points: tuple[Vec, ...]
    fixes: tuple[Fix, ...]


@record()
class Party:
    """A constraint of a conflict; `off` is its residual, None if that has no value."""

    text: str
    span: Span
    elements: tuple[int, ...]
    off: float | None


@record()
class Conflict:
    headline: str
    constraints: tuple[Party, ...]


@record()
class Arrow:
    start: Vec
    end: Vec


@record()
class Turn:
    """An arc about `center`; angles in degrees, counter-clockwise."""

    center: Vec
    radius: float
    start: float
    sweep: float


@record()
class Way:
    """A remaining motion of some elements: in words, and drawn."""

    words: str
    elements: tuple[int, ...]
    arrows: tuple[Arrow, ...]
    turns: tuple[Turn, ...]


@record()
class Preview:
    """A picture of a program with the data beside it.

    status  `solved`, `partial`, `failed` or `wrong`, of the present text, as are knobs and problems
    stale   True for the picture of an earlier text, since this one does not draw
    tried   True for a picture with other values than the text has
    handles the draggable points, as far as known
    svg     None if nothing was ever drawn, or painting it takes too long
    box     of the drawing
    """

    status: str
    stale: bool
    tried: bool
    seconds: float
    svg: str | None
    box: Bounds
    elements: tuple[Element, ...]
    knobs: tuple[Slider, ...]
    handles: tuple[Handle, ...]
    problems: tuple[Problem, ...]
    conflicts: tuple[Conflict, ...]
    motions: tuple[Way, ...]
    degrees: int | None


Json: TypeAlias = dict[str, Any]


class Writer:
    """Writes the JSON of one view; `uri_of` names its files."""

    def __init__(self, view: View, uri_of: Callable[[Path], str] = Path.as_uri) -> None:
        self._view, self._uri_of = view, uri_of
        self._positions: dict[SourceFile, Positions] = {}
        self._uris: dict[SourceFile, str | None] = {}

    def preview(self, preview: Preview, version: int) -> Json:
        """Returns the preview; numbers without a value are null."""
        said = {"uri": self._uri_of(self._view.path), "version": version, **self._fields(preview)}
        made: Json = rounded(said)
        return made

    def place(self, span: Span | None) -> Json:
        """Returns `range` and `uri` of a place; both null for the library, or without a place."""
        uri = None if span is None else self._uri(span.source)
        if span is None or uri is None:
            return {"range": None, "uri": None}
        return {"range": self.range(span), "uri": uri}

    def range(self, span: Span) -> Json:
        positions = self.positions(span.source)
        start, end = (positions.position(offset) for offset in (span.start, span.end))
        return {
            "start": {"line": start[0], "character": start[1]},
            "end": {"line": end[0], "character": end[1]},
        }

    def positions(self, source: SourceFile) -> Positions:
        if source not in self._positions:
            self._positions[source] = Positions(source.text)
        return self._positions[source]

    def _uri(self, source: SourceFile) -> str | None:
        if source not in self._uris:
            path = None if self._view.is_library(source) else self._view.file(source)
            self._uris[source] = None if path is None else self._uri_of(path)
        return self._uris[source]

    def _fields(self, made: Any) -> Json:
        """Returns what a record says, by the names of its fields; its span as range and file."""
        said: Json = {}
        for each in fields(made):
            value = getattr(made, each.name)
            said |= self.place(value) if each.name == "span" else {each.name: self._json(value)}
        return said

    def _json(self, value: Any) -> Any:
        match value:
            case tuple():
                return [self._json(each) for each in value]
            case Arrow(start, end):
                return {"from": start, "to": end}
            case Problem(fixes=fixes):
                return {
                    **self._fields(replace(value, fixes=())),
                    "fixes": len(fixes),
                    "titles": [fix.title for fix in fixes],
                }
            case _:
                return self._fields(value) if is_dataclass(value) else value


# --- Converts places in the drawn program to places in the present text, which may be a later one.


class Places:
    """Converts spans of the drawn outcome to spans of a view's texts."""

    def __init__(self, view: View) -> None:
        self._view = view
        self._now = {module.source.name: module.source for module in view.program.resolution.modules}
        self._now[view.source.name] = view.source
        self._shifts: dict[SourceFile, _Shift | None] = {}

    def now(self, span: Span | None) -> Span | None:
        """Returns the present place; None in the library, or if an edit has changed it."""
        if span is None or self._view.is_library(span.source):
            return None
        source = span.source
        if source not in self._shifts:
            current = self._now.get(source.name)
            self._shifts[source] = None if current is None else _Shift(source, current)
        shift = self._shifts[source]
        return None if shift is None else shift(span)


class _Shift:
    """Converts offsets between two texts that differ in one place."""

    def __init__(self, before: SourceFile, after: SourceFile) -> None:
        self.before, self.after = before, after
        if before.text == after.text:
            self.same = self.rest = len(before.text)
            return
        # Offsets up to `same` stay; those from `rest` on count from the end.
        one, other = before.text, after.text
        self.same = alike(one, other)
        self.rest = len(one) - alike(one[self.same :][::-1], other[self.same :][::-1])

    def __call__(self, span: Span) -> Span | None:
        start, end = self._start(span.start), self._end(span.end)
        return None if start is None or end is None or start > end else Span(self.after, start, end)

    def _start(self, offset: int) -> int | None:
        if offset < self.same or offset == self.same < self.rest:
            return offset
        return self._from_end(offset)

    def _end(self, offset: int) -> int | None:
        return offset if offset <= self.same else self._from_end(offset)

    def _from_end(self, offset: int) -> int | None:
        """Returns None for an offset in the changed text."""
        return None if offset < self.rest else offset + len(self.after.text) - len(self.before.text)


def alike(one: Sequence[object], other: Sequence[object]) -> int:
    """Counts what is equal at the beginning of two texts or lists."""
    pairs = zip(one, other, strict=False)
    return next((k for k, (a, b) in enumerate(pairs) if a != b), min(len(one), len(other)))


# --- The numbered elements of a drawing: structures, their geometry, and the parts of shapes.

MOST_PARTS = 40
"""Most parts told apart: a gear has hundreds, and a text a curve for each stroke."""


@record()
class DrawnElement:
    """An element, its counterpart in the model, and its structure."""

    element: Element
    model: SolvedStructure | SolvedGeometry
    owner: SolvedStructure


class Elements:
    """The elements of a picture in order of writing: a structure before its contents."""

    def __init__(self, drawn: Iterable[DrawnElement]) -> None:
        self.drawn = tuple(drawn)
        self.values = tuple(each.element for each in self.drawn)
        self.number: Mapping[str, int] = {
            each.element.path: k for k, each in reversed(list(enumerate(self.drawn)))
        }
        self._of_span: dict[tuple[SourceFile, int, int], list[int]] = defaultdict(list)
        for k, element in enumerate(self.values):
            if (span := element.span) is not None:
                self._of_span[span.source, span.start, span.end].append(k)

    def near(self, path: str) -> int | None:
        """Returns the element at a path, or the innermost one around it."""
        while path:
            if path in self.number:
                return self.number[path]
            path = path[: max(path.rfind("."), path.rfind("["), 0)]
        return None

    def all_near(self, paths: Iterable[str]) -> list[int]:
        """Returns the elements at or around these paths, each once."""
        return list(dict.fromkeys(k for path in paths if (k := self.near(path)) is not None))

    def written_at(self, span: Span) -> list[int]:
        """Returns the elements written in exactly this place, including copies and turns of loops."""
        return list(self._of_span.get((span.source, span.start, span.end), ()))

    def around(self, span: Span) -> list[int]:
        """Returns the elements of the smallest place that contains this one."""
        places = [
            (end - start, numbers)
            for (source, start, end), numbers in self._of_span.items()
            if source is span.source and start <= span.start and span.end <= end
        ]
        return list(min(places, key=lambda place: place[0])[1]) if places else []


def elements(view: View) -> Elements:
    """Returns the elements in the picture of a view; none without a picture."""
    if view.drawn is None or view.drawn.model is None:
        return Elements(())
    return Elements(_Reading(view).all(view.drawn.model))


class _Reading:
    def __init__(self, view: View) -> None:
        self.places = Places(view)

    def all(self, model: SolvedModel) -> Iterator[DrawnElement]:
        return self._structure(model.root, None)

    def _structure(self, structure: SolvedStructure, around: Span | None) -> Iterator[DrawnElement]:
        span = self.places.now(structure.span) or around
        about = ", ".join(filter(None, (structure.kind, _extent(structure))))
        element = Element(structure.path, "structure", structure.kind, span, about)
        yield DrawnElement(element, structure, structure)
        for geometry in structure.drawn:
            yield from self._geometry(geometry, structure, span)
        for child in structure.structures:
            yield from self._structure(child, span)

    def _geometry(
        self, geometry: SolvedGeometry, owner: SolvedStructure, around: Span | None
    ) -> Iterator[DrawnElement]:
        span = self.places.now(geometry.span) or around
        element = Element(geometry.path, "geometry", geometry.type, span, _of_geometry(geometry))
        yield DrawnElement(element, geometry, owner)
        if geometry.type in ("glyphs", "traced") or sum(1 for _ in geometry.walk()) > MOST_PARTS + 1:
            return
        for part in geometry.parts:
            yield from self._part(part, owner, span)

    def _part(
        self, part: SolvedGeometry, owner: SolvedStructure, around: Span | None
    ) -> Iterator[DrawnElement]:
        span = self.places.now(part.span)
        if span is None or (around is not None and _is_value_of(span, around)):
            span = around  # the statement, in place of the call in it
        element = Element(part.path, "geometry", part.type, span, _of_geometry(part))
        yield DrawnElement(element, part, owner)
        for inner in part.parts:
            yield from self._part(inner, owner, span)


def _is_value_of(span: Span, statement: Span) -> bool:
    return span.source is statement.source and statement.start <= span.start and span.end == statement.end


def curves_of(geometry: SolvedGeometry) -> Iterator[Piece]:
    """Yields the curves of a geometry and its parts, including construction geometry."""
    for each in geometry.walk():
        if each.curve is not None:
            yield each.curve


def point_of(geometry: SolvedGeometry) -> Vec | None:
    """Returns the place of a point; None for other geometry, and for a point without finite coordinates."""
    match geometry.values.get("at"):
        case (float() as x, float() as y) if math.isfinite(x) and math.isfinite(y):
            return x, y
        case _:
            return None


def box_of(thing: SolvedStructure | SolvedGeometry) -> Bounds | None:
    """Returns the box of a structure, or of the curves of a geometry; None without one in finite numbers."""
    if isinstance(thing, SolvedStructure):
        own = thing.box
        box = None if own is None else (own.left, own.bottom, own.right, own.top)
    else:
        boxes = [bounds(curve) for curve in curves_of(thing)]
        box = union_bounds(boxes) if boxes else None
    return box if box is not None and all(map(math.isfinite, box)) else None


def _of_geometry(geometry: SolvedGeometry) -> str:
    kind = f"construction {geometry.type}" if geometry.construction else geometry.type
    return ", ".join(filter(None, (kind.replace("_", " "), _sizes(geometry))))


def _sizes(geometry: SolvedGeometry) -> str:
    match geometry.curve:
        case Circle(radius=radius):
            return f"radius {_mm(radius)} mm"
        case Arc(radius=radius, sweep=sweep):
            return f"radius {_mm(radius)} mm, {_mm(abs(math.degrees(sweep)))}°"
        case Line(start=start, end=end):
            return f"{_mm(math.dist(start, end))} mm"
        case Ellipse(rx=rx, ry=ry):
            return f"radii {_mm(rx)} and {_mm(ry)} mm"
        case _ if (at := point_of(geometry)) is not None:
            return f"({_mm(at[0])}, {_mm(at[1])})"
        case _:
            return _extent(geometry)


def _extent(thing: SolvedStructure | SolvedGeometry) -> str:
    box = box_of(thing)
    return "" if box is None else f"{_mm(box[2] - box[0])} × {_mm(box[3] - box[1])} mm"


def _mm(value: float) -> str:
    """Writes a length to a thousandth, as fine as anybody makes."""
    return short(value, 3) if math.isfinite(value) else "?"


def elements_at(view: View, offset: int) -> list[int]:
    """Returns the elements that the text at an offset defines or constrains."""
    found, place = elements(view), view.span(offset, offset)
    numbers = found.around(place)
    if any(found.values[k].kind == "geometry" for k in numbers):
        return numbers  # a part shared with other geometry is a constraint, too
    return _constrained(view, found, place) or numbers


def _constrained(view: View, found: Elements, place: Span) -> list[int]:
    if view.drawn is None or view.drawn.model is None:
        return []
    places, around = Places(view), list[tuple[int, ConstraintReport]]()
    for report in view.drawn.model.constraints:
        span = places.now(report.span)
        if span is not None and span.source is place.source and span.start <= place.start <= span.end:
            around.append((span.end - span.start, report))
    least = min((length for length, _ in around), default=0)
    return found.all_near(path for length, r in around if length == least for path in r.mentions())

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
from aidl_lang.geometry.curves import Arc, Bounds, Circle, Ellipse, Line, Piece, Vec
from aidl_lang.geometry.solved import Box, SolvedGeometry, SolvedStructure
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
        self._kept: dict[SourceFile, tuple[int, int]] = {}

    def now(self, span: Span | None) -> Span | None:
        """Returns the present place; None in the library, or if an edit has changed it."""
        if span is None or self._view.is_library(span.source) or span.source.name not in self._now:
            return None
        before, after = span.source, self._now[span.source.name]
        if before not in self._kept:
            self._kept[before] = _kept(before.text, after.text)
        same, rest = self._kept[before]

        def moved(offset: int, *, stays: bool) -> int | None:
            if stays:
                return offset
            return None if offset < rest else offset + len(after.text) - len(before.text)

        start = moved(span.start, stays=span.start < same or span.start == same < rest)
        end = moved(span.end, stays=span.end <= same)
        return None if start is None or end is None or start > end else Span(after, start, end)


def _kept(before: str, after: str) -> tuple[int, int]:
    """Returns the offset up to which two texts are the same, and that from which they are so again."""
    if before == after:
        return len(before), len(before)
    same = alike(before, after)
    return same, len(before) - alike(before[same:][::-1], after[same:][::-1])


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
        self._of_span: dict[Span | None, list[int]] = defaultdict(list)
        for k, element in enumerate(self.values):
            self._of_span[element.span].append(k)

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
        return self._of_span.get(span, [])


def elements(view: View) -> Elements:
    """Returns the elements in the picture of a view; none without a picture."""
    if view.drawn is None or view.drawn.model is None:
        return Elements(())
    return Elements(_of_structure(view.drawn.model.root, Places(view), None))


def _of_structure(structure: SolvedStructure, places: Places, around: Span | None) -> Iterator[DrawnElement]:
    span = places.now(structure.span) or around
    about = ", ".join(filter(None, (structure.kind, _extent(structure))))
    element = Element(structure.path, "structure", structure.kind, span, about)
    yield DrawnElement(element, structure, structure)
    for geometry in structure.drawn:
        is_one = geometry.type in ("glyphs", "traced") or sum(1 for _ in geometry.walk()) > MOST_PARTS + 1
        parts = () if is_one else geometry.parts
        yield from _of_part(geometry, structure, places, places.now(geometry.span) or span, parts)
    for child in structure.structures:
        yield from _of_structure(child, places, span)


def _of_part(
    part: SolvedGeometry,
    owner: SolvedStructure,
    places: Places,
    span: Span | None,
    parts: Sequence[SolvedGeometry],
) -> Iterator[DrawnElement]:
    """Yields a geometry that is written at a place, and its parts, as far as they are told apart."""
    kind = f"construction {part.type}" if part.construction else part.type
    about = ", ".join(filter(None, (kind.replace("_", " "), _sizes(part))))
    yield DrawnElement(Element(part.path, "geometry", part.type, span, about), part, owner)
    for inner in parts:
        place = places.now(inner.span)
        if place is None or (span is not None and _is_value_of(place, span)):
            place = span  # the statement, in place of the call in it
        yield from _of_part(inner, owner, places, place, inner.parts)


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
    box = thing.box if isinstance(thing, SolvedStructure) else Box.around(curves_of(thing), ())
    return box.bounds if box is not None and all(map(math.isfinite, box.bounds)) else None


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

"""The data of a preview and its JSON (`pane/protocol.d.ts`): numbered elements, sliders, problems."""

from __future__ import annotations

import math
import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import cache
from pathlib import Path
from typing import Any, TypeAlias

from aidl_lang.building.model import Knob
from aidl_lang.common.diagnostics import Diagnostic, Edit
from aidl_lang.common.prose import rounded, short
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.geometry.curves import Arc, Bounds, Circle, Ellipse, Line, Piece, Vec
from aidl_lang.geometry.solved import Box, ConstraintReport, SolvedGeometry, SolvedStructure
from aidl_lang.syntax import ast
from aidl_lang.tools.agents import workspace
from aidl_lang.tools.agents.workspace import refusal
from aidl_lang.tools.ends import is_whole
from aidl_server.ide.dragging import Handle
from aidl_server.ide.workspace import Positions, View, edited, hasty

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
    fixes: int
    titles: tuple[str, ...]
    """of its fixes"""


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
class Turn:
    """An arc about `center`; angles in degrees, counter-clockwise."""

    center: Vec
    radius: float
    start: float
    sweep: float


@record()
class Way:
    """A remaining motion of some elements: in words, and drawn; an arrow has its ends `from` and `to`."""

    words: str
    elements: tuple[int, ...]
    arrows: tuple[Mapping[str, Vec], ...]
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
        self._positions = cache(lambda source: Positions(source.text))
        self._uri = cache(self._found)

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
        positions = self._positions(span.source)
        ends = (positions.position(offset) for offset in (span.start, span.end))
        start, end = ({"line": line, "character": character} for line, character in ends)
        return {"start": start, "end": end}

    def _found(self, source: SourceFile) -> str | None:
        path = None if self._view.is_library(source) else self._view.file(source)
        return None if path is None else self._uri_of(path)

    def _fields(self, made: Any) -> Json:
        """Returns what a record says, by the names of its fields; its span as range and file."""
        said: Json = {}
        for each in fields(made):
            value = getattr(made, each.name)
            said |= self.place(value) if each.name == "span" else {each.name: self._json(value)}
        return said

    def _json(self, value: Any) -> Any:
        if isinstance(value, tuple):
            return [self._json(each) for each in value]
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
        self.of_span: dict[Span | None, list[int]] = defaultdict(list)
        """those written in a place, including copies and turns of loops"""
        for k, element in enumerate(self.values):
            self.of_span[element.span].append(k)

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
        is_in_span = place and span and place.source is span.source and span.start <= place.start
        if place is None or (span is not None and is_in_span and place.end == span.end):
            place = span  # the statement, in place of the call in it
        yield from _of_part(inner, owner, places, place, inner.parts)


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


# --- What stands beside a drawing: the `param`s of a program as sliders.

Value: TypeAlias = float | str | bool

_LITERALS = (ast.Number, ast.String, ast.Boolean)
_SLACK = 1e-9
"""Tolerance at the ends of a range, relative to the number."""


def sliders(view: View) -> Iterator[Slider]:
    """Yields the params in order of writing; of a broken text those of the picture, which are read only."""
    known, places = view.knobs, Places(view)
    if not known and view.is_stale and view.drawn is not None:
        known = view.drawn.knobs
    for knob in known:
        declared = view.declaration(knob)
        # a count: a whole number without a unit, with a range from one whole number to another
        is_count = declared is not None and is_whole(knob) and declared.value.span.text.isdecimal()
        yield Slider(
            knob.path,
            knob.path.rpartition(".")[2],
            _kind(knob),
            knob.value,
            knob.unit,
            knob.low,
            knob.high,
            1.0 if is_count and knob.step is None else knob.step,
            knob.choices,
            knob.doc or "",
            declared.value.span if declared is not None else places.now(knob.span),
            declared is not None and _is_literal(declared.value),
        )


def set_knob(view: View, path: str, value: Value) -> list[Edit]:
    """Returns the edits that make a value, or a text's worth, a param's default. Raises RefusalError."""
    knob = workspace.find(view.knobs, path)
    declared = view.declaration(knob)
    if declared is None:
        raise refusal("E0945", f"`{knob.path}` is declared in the library, and cannot be changed there")
    if not _is_literal(declared.value):
        written = declared.value.span.one_line
        raise refusal("E0945", f"`{knob.path}` is worked out, as `{written}`; change what it is made of")
    worth = _worth(knob, value)
    _require_allowed(knob, value if worth is None else worth)
    edits = [workspace.edit_at(knob, declared, value)]
    if worth is not None:
        _require_sense(view, edits)
    return edits


def worked_out(view: View, values: Mapping[str, Value]) -> dict[str, Value]:
    """Returns values of params with texts for numbers worked out. Raises RefusalError for an invalid one."""
    found = dict(values)
    for path, value in values.items():
        if (
            isinstance(value, str)
            and (worth := _worth(knob := workspace.find(view.knobs, path), value)) is not None
        ):
            _require_allowed(knob, worth)
            found[path] = worth
    return found


def _worth(knob: Knob, value: Value) -> float | None:
    """Returns the number that a text means for a param that is one; None for others. Raises RefusalError."""
    is_number = _kind(knob) in ("number", "choice") and not isinstance(knob.value, str)
    return workspace.typed(knob, value).value if is_number and isinstance(value, str) else None


def _require_allowed(knob: Knob, value: Value) -> None:
    if knob.choices:
        is_allowed, why = value in knob.choices, "none of its choices"
    elif knob.range is None or not isinstance(value, float | int):
        return  # what does not fit at all is told by what writes it
    else:
        low, high = knob.range
        slack = _SLACK * max(1.0, abs(low), abs(high))
        is_allowed = math.isfinite(value) and low - slack <= value <= high + slack
        why = f"outside its range {low:.6g}..{high:.6g}" + (f" {knob.unit}" if knob.unit else "")
    if not is_allowed:
        said = f"{value:.6g}" if isinstance(value, float) else str(value)
        raise refusal("E0945", f"`{knob.path}` cannot be `{said}`: that is {why}")


def _require_sense(view: View, edits: list[Edit]) -> None:
    """Raises RefusalError if the text could no longer be built, as with a length where a number was."""
    again = edited(view, edits, hasty())
    if view.solved is None or again.solved is not None:
        return
    for wrong in again.diagnostics:
        if wrong.is_error:
            raise refusal("E0945", f"the program cannot be built with this: {wrong.message}")


def _is_literal(node: ast.Expression) -> bool:
    return isinstance(node, _LITERALS) or (isinstance(node, ast.Unary) and _is_literal(node.operand))


def _kind(knob: Knob) -> str:
    if isinstance(knob.value, bool):
        return "truth"
    if knob.choices:
        return "choice"
    return "text" if isinstance(knob.value, str) else "number"


# --- Problems on the drawing, each with its elements and points.

_QUOTED = re.compile("`([^`]+)`")


def problems(
    view: View, elements: Elements, painting: Sequence[Diagnostic] = (), *, tried: bool = False
) -> Iterator[Problem]:
    """Yields the diagnostics with elements and points; of values that are only tried none has a fix."""
    finder = _Finder(view, elements)
    for found in (*view.diagnostics, *painting):
        has_fix = found.fix is not None and not tried
        yield Problem(
            found.severity.value,
            found.code,
            found.message,
            found.hints if found.fix is None or has_fix else (),
            found.span,
            tuple(finder.about(found)),
            tuple(p for p in found.points if all(map(math.isfinite, p))),
            int(has_fix),
            (found.fix.title,) if found.fix is not None and has_fix else (),
        )


def conflicts(view: View, elements: Elements) -> Iterator[Conflict]:
    """Yields the conflicting constraints of a program that does not solve."""
    if view.outcome is None or view.outcome.status == "solved":
        return
    finder = _Finder(view, elements)
    for conflict in view.outcome.conflicts():
        parties = []
        for party in conflict.parties:
            found = tuple(finder.related(party.span, party.path))
            off = party.off if math.isfinite(party.off) else None
            parties.append(Party(party.text, party.span, found, off))
        yield Conflict(conflict.headline, tuple(parties))


class _Finder:
    def __init__(self, view: View, elements: Elements) -> None:
        self.elements = elements
        self.constraints: dict[Span, list[ConstraintReport]] = {}
        model = view.drawn.model if view.drawn is not None else None
        places = Places(view)
        for report in model.constraints if model is not None else ():
            if (span := places.now(report.span)) is not None:
                self.constraints.setdefault(span, []).append(report)

    def about(self, found: Diagnostic) -> list[int]:
        """Returns the elements written, or constrained, in the places that a diagnostic names.

        If several share a place, as the turns of a loop do, only those whose paths the message quotes, before
        it names what is beside them.
        """
        spans = [s for s in (found.span, *(label.span for label in found.secondary)) if s is not None]
        here = [k for span in spans for k in self.elements.of_span.get(span) or self.related(span)]
        quoted = set(_QUOTED.findall(found.message.partition(";")[0]))
        named = [k for k in here if self.elements.values[k].path in quoted]
        return list(dict.fromkeys(named or here))

    def related(self, span: Span, holder: str | None = None) -> list[int]:
        """Returns the elements that the constraints in a place relate; only those of `holder`, if given."""
        reports = self.constraints.get(span, [])
        paths = [path for r in reports if holder in (None, r.path) for path in r.mentions()]
        return self.elements.all_near(paths)

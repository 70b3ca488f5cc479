"""The data of a preview, and the JSON that the pane and its hosts understand (`pane/protocol.d.ts`)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeAlias

from aidl_lang.common.diagnostics import Fix
from aidl_lang.common.prose import rounded
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.geometry.curves import Bounds, Vec
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
    parties: tuple[Party, ...]


@record()
class Arrow:
    start: Vec
    end: Vec


@record()
class Turn:
    """An arc about `center`; angles in degrees, counter-clockwise."""

    center: Vec
    radius: float
    first: float
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
    ways: tuple[Way, ...]
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
        made: Json = rounded(
            {
                "uri": self._uri_of(self._view.path),
                "version": version,
                "status": preview.status,
                "stale": preview.stale,
                "tried": preview.tried,
                "seconds": preview.seconds,
                "svg": preview.svg,
                "box": preview.box,
                "elements": list(map(self._fields, preview.elements)),
                "knobs": list(map(self._fields, preview.knobs)),
                "handles": list(map(self._fields, preview.handles)),
                "problems": list(map(self._problem, preview.problems)),
                "conflicts": list(map(self._conflict, preview.conflicts)),
                "motions": [_motion(way) for way in preview.ways],
                "degrees": preview.degrees,
            }
        )
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
            said |= self.place(value) if each.name == "span" else {each.name: value}
        return said

    def _problem(self, problem: Problem) -> Json:
        titles = [fix.title for fix in problem.fixes]
        return {**self._fields(problem), "fixes": len(titles), "titles": titles}

    def _conflict(self, conflict: Conflict) -> Json:
        return {"headline": conflict.headline, "constraints": list(map(self._fields, conflict.parties))}


def _motion(way: Way) -> Json:
    return {
        "words": way.words,
        "elements": way.elements,
        "arrows": [{"from": arrow.start, "to": arrow.end} for arrow in way.arrows],
        "turns": [
            {"center": t.center, "radius": t.radius, "start": t.first, "sweep": t.sweep} for t in way.turns
        ],
    }

"""A preview as the JSON that the pane and its hosts understand (`preview/pane/protocol.d.ts`)."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeAlias

from aidl_lang.common.prose import rounded
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.tools.ide.positions import Positions
from aidl_lang.tools.ide.preview.values import Conflict, Element, Preview, Problem, Slider, Way
from aidl_lang.tools.ide.workspace import View

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
                "elements": [self._element(element) for element in preview.elements],
                "knobs": [self._knob(knob) for knob in preview.knobs],
                "handles": [
                    {"id": h.id, "path": h.path, "at": h.at, "moves": h.moves, "hint": h.hint}
                    for h in preview.handles
                ],
                "problems": [self._problem(problem) for problem in preview.problems],
                "conflicts": [self._conflict(conflict) for conflict in preview.conflicts],
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

    def _element(self, element: Element) -> Json:
        return {
            "path": element.path,
            "kind": element.kind,
            "type": element.type,
            **self.place(element.span),
            "hint": element.hint,
        }

    def _knob(self, knob: Slider) -> Json:
        return {
            "path": knob.path,
            "name": knob.name,
            "kind": knob.kind,
            "value": knob.value,
            "unit": knob.unit,
            "low": knob.low,
            "high": knob.high,
            "step": knob.step,
            "choices": knob.choices,
            "doc": knob.doc,
            **self.place(knob.span),
            "editable": knob.editable,
        }

    def _problem(self, problem: Problem) -> Json:
        return {
            "severity": problem.severity,
            "code": problem.code,
            "message": problem.message,
            "hints": problem.hints,
            **self.place(problem.span),
            "elements": problem.elements,
            "points": problem.points,
            "fixes": len(problem.fixes),
            "titles": [fix.title for fix in problem.fixes],
        }

    def _conflict(self, conflict: Conflict) -> Json:
        return {
            "headline": conflict.headline,
            "constraints": [
                {"text": p.text, **self.place(p.span), "elements": p.elements, "off": p.off}
                for p in conflict.parties
            ],
        }


def _motion(way: Way) -> Json:
    return {
        "words": way.words,
        "elements": way.elements,
        "arrows": [{"from": arrow.start, "to": arrow.end} for arrow in way.arrows],
        "turns": [
            {"center": t.center, "radius": t.radius, "start": t.first, "sweep": t.sweep} for t in way.turns
        ],
    }

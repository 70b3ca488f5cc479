"""Publishes diagnostics to the client, for each file."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from lsprotocol import types

from aidl_lang.common.diagnostics import Diagnostic, Label, Severity
from aidl_lang.common.resources import resource
from aidl_lang.tools.lsp.convert import START, Converter
from aidl_lang.tools.lsp.documents import Document, VersionedView

SOURCE = "aidl"
_SEVERITY = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    Severity.NOTE: types.DiagnosticSeverity.Information,
}
_UNNECESSARY = frozenset({"W0201", "W0202", "W0502", "W0701", "W0703"})
"""Codes of unnecessary text, which editors show faint."""


def converted(
    found: Iterable[Diagnostic], convert: Converter, own: str
) -> Iterator[tuple[str, types.Diagnostic]]:
    """Yields diagnostics with the URI of the file that shows each. Those without a place in a file of the
    user's appear at the beginning of the program, whose URI is `own`.
    """
    for diagnostic in found:
        span = diagnostic.span
        if span is None or convert.view.is_library(span.source) or (uri := convert.uri(span.source)) is None:
            uri, place = own, START
        else:
            place = convert.range(span)
        yield uri, _converted(diagnostic, convert, place)


def _converted(diagnostic: Diagnostic, convert: Converter, place: types.Range) -> types.Diagnostic:
    return types.Diagnostic(
        range=place,
        message=worded(diagnostic),
        severity=_SEVERITY[diagnostic.severity],
        code=diagnostic.code,
        code_description=types.CodeDescription(_page(diagnostic.code)),
        source=SOURCE,
        tags=[types.DiagnosticTag.Unnecessary] if diagnostic.code in _UNNECESSARY else None,
        related_information=list(_related(diagnostic, convert)) or None,
    )


def worded(diagnostic: Diagnostic) -> str:
    """Returns the message and the hints, line by line."""
    said = [diagnostic.message, *(f"hint: {hint}" for hint in diagnostic.hints)]
    return "\n".join(said)


def _related(diagnostic: Diagnostic, convert: Converter) -> Iterator[types.DiagnosticRelatedInformation]:
    own = [Label(diagnostic.span, diagnostic.label)] if diagnostic.span and diagnostic.label else []
    for label in (*own, *diagnostic.secondary):
        if (place := convert.location(label.span)) is not None:
            yield types.DiagnosticRelatedInformation(place, label.text or diagnostic.message)


def _page(code: str) -> str:
    return resource(f"docs/diagnostics/{code}.md").as_uri()


class Publisher:
    """Publishes for each file the diagnostics of all programs that use it."""

    def __init__(self, send: Callable[[types.PublishDiagnosticsParams], None]) -> None:
        self._send = send
        self._told: dict[Document, dict[str, list[types.Diagnostic]]] = {}
        self._serials: dict[Document, int] = {}

    def publish(
        self, document: Document, known: VersionedView, found: list[tuple[str, types.Diagnostic]]
    ) -> None:
        """Replaces the diagnostics of a program; does nothing if those before were of a newer text."""
        if known.serial < self._serials.get(document, known.serial):
            return
        self._serials[document] = known.serial
        by_uri: dict[str, list[types.Diagnostic]] = {document.uri: []}
        for uri, diagnostic in found:
            by_uri.setdefault(uri, []).append(diagnostic)
        before = self._told.get(document, {})
        self._told[document] = by_uri
        self._tell(document.uri, known.version)
        for uri in before | by_uri:
            if uri != document.uri and before.get(uri) != by_uri.get(uri):
                self._tell(uri)

    def forget(self, document: Document) -> None:
        """Removes the diagnostics of a program."""
        self._serials.pop(document, None)
        for uri in self._told.pop(document, {}):
            self._tell(uri)

    def _tell(self, uri: str, version: int | None = None) -> None:
        said = [each for by_uri in self._told.values() for each in by_uri.get(uri, ())]
        unique = {(repr(each.range), each.code, each.message): each for each in said}
        self._send(types.PublishDiagnosticsParams(uri, list(unique.values()), version))

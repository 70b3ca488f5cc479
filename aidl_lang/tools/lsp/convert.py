"""Values of the server made those of the protocol, and settings read from it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Any

from lsprotocol import types

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.tools.ide.positions import Positions, Unit
from aidl_lang.tools.ide.workspace import View
from aidl_lang.tools.lsp.documents import Documents

LONGEST_DELAY = 5_000


@record()
class Settings:
    """The settings of a user.

    solved_values  inlay hints for the solved values of first guesses
    readings       inlay hints for chosen readings of ambiguous constraints
    lenses         code lenses on structures
    delay          seconds after a change before the program is run
    """

    solved_values: bool = True
    readings: bool = True
    lenses: bool = True
    delay: float = 0.0

    @classmethod
    def read(cls, said: object) -> Settings:
        """Reads nested objects as `{"inlayHints": {"readings": false}}`; invalid values count as absent."""
        delay = _value(said, "run.delay")
        is_number = isinstance(delay, int | float) and not isinstance(delay, bool)
        return cls(
            solved_values=_value(said, "inlayHints.solvedValues") is not False,
            readings=_value(said, "inlayHints.readings") is not False,
            lenses=_value(said, "codeLens.enabled") is not False,
            delay=min(max(float(delay), 0.0), LONGEST_DELAY) / 1000 if is_number else 0.0,
        )


def _value(said: object, path: str) -> Any:
    for name in path.split("."):
        if not isinstance(said, Mapping):
            return None
        said = said.get(name)
    return said


START = types.Range(types.Position(0, 0), types.Position(0, 0))


@record(eq=False)
class Converter:
    """Converts for the view of the document `own`; `versions` are those of the open files at that time."""

    view: View
    own: str
    documents: Documents
    unit: Unit
    versions: Mapping[Path, int] = field(default_factory=dict)
    _positions: dict[SourceFile, Positions] = field(default_factory=dict)

    def _of(self, source: SourceFile) -> Positions:
        if source not in self._positions:
            self._positions[source] = Positions(source.text, self.unit)
        return self._positions[source]

    def position(self, source: SourceFile, offset: int) -> types.Position:
        return types.Position(*self._of(source).position(offset))

    def range(self, span: Span) -> types.Range:
        of = self._of(span.source)
        return types.Range(types.Position(*of.position(span.start)), types.Position(*of.position(span.end)))

    def offset(self, position: types.Position) -> int:
        """Returns the offset of a position in the text of the view."""
        return self._of(self.view.source).offset(position.line, position.character)

    def span(self, wanted: types.Range) -> Span:
        """Returns the span of a range in the text of the view."""
        start, end = sorted((self.offset(wanted.start), self.offset(wanted.end)))
        return self.view.span(start, end)

    def uri(self, source: SourceFile) -> str | None:
        """Returns the URI of a source; None for one without a file."""
        path = self.view.file(source)
        return None if path is None else self.uri_of(path)

    def uri_of(self, path: Path) -> str:
        """Returns the URI of a file; of two that mean the file of the document, its own."""
        return self.own if path == self.view.path else self.documents.uri_of(path)

    def location(self, span: Span) -> types.Location | None:
        uri = self.uri(span.source)
        return None if uri is None else types.Location(uri, self.range(span))

    def edit(self, edit: Edit) -> types.TextEdit:
        return types.TextEdit(self.range(edit.span), edit.replacement)

    def edits(self, edits: Iterable[Edit]) -> list[types.TextEdit]:
        return [self.edit(edit) for edit in edits]

    def by_file(self, edits: Iterable[Edit]) -> dict[Path, list[Edit]]:
        """Groups edits by file; drops those without a file."""
        found: dict[Path, list[Edit]] = {}
        for edit in edits:
            if (path := self.view.file(edit.span.source)) is not None:
                found.setdefault(path, []).append(edit)
        return found

    def changes(self, edits: Mapping[Path, Sequence[Edit]], with_versions: bool) -> types.WorkspaceEdit:
        """Returns edits by file; for a client that knows of versions, each with the version it was made
        for.
        """
        made = {path: self.edits(each) for path, each in edits.items()}
        if not with_versions:
            return types.WorkspaceEdit(changes={self.uri_of(path): each for path, each in made.items()})
        return types.WorkspaceEdit(
            document_changes=[
                types.TextDocumentEdit(
                    types.OptionalVersionedTextDocumentIdentifier(self.uri_of(path), self.versions.get(path)),
                    each,
                )
                for path, each in made.items()
            ]
        )

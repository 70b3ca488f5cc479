"""What stands beside the text and comes of solving it: code lenses."""

from __future__ import annotations

from lsprotocol import types

from aidl_lang.ide.lenses import lenses
from aidl_lang.lsp.documents import Document
from aidl_lang.lsp.server import Asked, Server

_PATIENCE = 0.5
"""Seconds to wait for the outcome; where it comes later, the client is told to ask again."""
_OPEN_PREVIEW = "aidl.openPreview"
"""A command of the client's; one that has none shows the title all the same."""


def register(server: Server) -> None:
    answered = _Answered(server)
    options = types.CodeLensOptions()

    @server.answers_to(types.TEXT_DOCUMENT_CODE_LENS, options, patience=_PATIENCE)
    def lens(asked: Asked, params: types.CodeLensParams) -> list[types.CodeLens]:
        answered.note(asked)
        if not asked.settings.lenses:
            return []
        return [
            types.CodeLens(
                asked.convert.range(each.span),
                types.Command(each.title, _OPEN_PREVIEW, arguments=[asked.uri]),
            )
            for each in lenses(asked.view)
        ]


class _Answered:
    """Notes what the client was told, and has it ask again when there is more to tell of the same text."""

    def __init__(self, server: Server) -> None:
        self._server = server
        self._told: dict[str, tuple[int, int | None]] = {}
        """By document, the version that was told of, and the serial of its outcome."""
        server.on_solved.append(self._solved)
        server.on_closed.append(self._closed)

    def note(self, asked: Asked) -> None:
        known = asked.known
        self._told[asked.uri] = known.version, known.serial if known.view.outcome is not None else None

    def _solved(self, document: Document) -> None:
        told, ran = self._told.get(document.uri), document.ran
        if told is not None and ran is not None and told[0] == ran.version and told[1] != ran.serial:
            self._server.refresh_hints()

    def _closed(self, document: Document) -> None:
        self._told.pop(document.uri, None)

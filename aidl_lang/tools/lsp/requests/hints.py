"""Inlay hints and code lenses, which depend on the solution."""

from __future__ import annotations

from typing import Any

from lsprotocol import types

from aidl_lang.tools.ide.lenses import Inlay, InlayKind, end_lenses, inlays, lenses
from aidl_lang.tools.lsp.documents import Document
from aidl_lang.tools.lsp.requests.ends import CHECK_ENDS, Ends
from aidl_lang.tools.lsp.server import Asked, Server

_PATIENCE = 0.5
"""Seconds to wait for the outcome; the client is told to ask again for a later one."""
_OPEN_PREVIEW = "aidl.openPreview"
"""A command of the client's; one without it shows the title all the same."""


def register_hints(server: Server) -> None:
    answered, ends = _Answered(server), Ends(server)

    @server.command(CHECK_ENDS)
    async def check_ends(*arguments: Any) -> dict[str, Any]:
        """Try the ends of all params of a document, which is the argument."""
        return await ends.check(arguments[0] if arguments else None)

    @server.answers_to(types.TEXT_DOCUMENT_CODE_LENS, types.CodeLensOptions(), patience=_PATIENCE)
    def lens(asked: Asked, params: types.CodeLensParams) -> list[types.CodeLens]:
        answered.note(asked)
        if not asked.settings.lenses:
            return []
        made = []
        for each in lenses(asked.view):
            command = types.Command(each.title, _OPEN_PREVIEW, arguments=[asked.uri])
            made.append(types.CodeLens(asked.convert.range(each.span), command))
        for each in end_lenses(asked.view, ends.of(asked)):
            command = types.Command(each.title, CHECK_ENDS, arguments=[asked.uri])
            made.append(types.CodeLens(asked.convert.range(each.span), command))
        return made

    @server.answers_to(types.TEXT_DOCUMENT_INLAY_HINT, types.InlayHintOptions(), patience=_PATIENCE)
    def inlay(asked: Asked, params: types.InlayHintParams) -> list[types.InlayHint]:
        answered.note(asked)
        found = inlays(asked.view, asked.convert.span(params.range))
        return [_hint(each, asked) for each in found if _is_wanted(each, asked)]


class _Answered:
    """The answers given to the client, which asks again when there are more for the same text."""

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


def _is_wanted(inlay: Inlay, asked: Asked) -> bool:
    settings = asked.settings
    return settings.readings if inlay.kind is InlayKind.READING else settings.solved_values


def _hint(inlay: Inlay, asked: Asked) -> types.InlayHint:
    return types.InlayHint(
        asked.convert.position(asked.view.source, inlay.offset),
        inlay.text,
        text_edits=asked.convert.edits(inlay.edits) or None,
        tooltip=inlay.tooltip or None,
        padding_left=True,
    )

"""The picture beside the text, for clients that show it: requests of our own, all below `aidl/`."""

from __future__ import annotations

import base64
import logging
from collections.abc import Mapping, Sequence
from functools import partial
from itertools import count
from typing import Any

from lsprotocol import types
from pygls.exceptions import (
    JsonRpcContentModified,
    JsonRpcException,
    JsonRpcInvalidParams,
    JsonRpcRequestCancelled,
)

from aidl_lang.agents.workspace import RefusalError
from aidl_lang.cancelling import Cancelled
from aidl_lang.diagnostics import Edit
from aidl_lang.export import FORMATS, ExportError, Options
from aidl_lang.ide.preview import LAYERS, Writer, preview, set_knob, tried
from aidl_lang.ide.view import View
from aidl_lang.lsp.documents import Document
from aidl_lang.lsp.given import Given, Value
from aidl_lang.lsp.running import LIMITS
from aidl_lang.lsp.server import FAILED, Asked, Server

_LONGEST_WAIT = 30.0
"""Seconds for an outcome: longer than a run may take."""

log = logging.getLogger(__name__)


def register(server: Server) -> None:
    Previews(server)


class Previews:
    """Who sees which pictures. A document that is shown is told of after each of its runs."""

    def __init__(self, server: Server) -> None:
        self.server = server
        self._shown: dict[Document, tuple[str, ...]] = {}
        self._requests = count()
        for method, answer in {
            "aidl/preview": self._open,
            "aidl/previewClose": self._close,
            "aidl/try": self._try,
            "aidl/setKnob": self._set_knob,
            "aidl/fix": self._fix,
            "aidl/export": self._export,
        }.items():
            server.feature(method)(_coroutine(answer))
        server.on_solved.append(self._solved)
        server.on_closed.append(self._closed)

    async def _open(self, given: Given) -> dict[str, Any] | None:
        document = self._document(given)
        self._shown[document] = given.texts("show")
        self.server.runner.active = document
        await document.until_solved(document.serial, _LONGEST_WAIT)
        return await self._picture(document, ("picture", next(self._requests)))

    async def _close(self, given: Given) -> None:
        document = self.server.documents.get(given.text("uri"))
        if document is not None:
            self._shown.pop(document, None)

    async def _try(self, given: Given) -> dict[str, Any]:
        asked, document = await self._solved_view(given)
        knobs, show = given.values("knobs"), self._shown.get(document, ())
        version = asked.known.version

        def attempt() -> dict[str, Any]:
            view = tried(asked.view, knobs, document.memory, LIMITS)
            return _written(asked, view, show, version, is_tried=True)

        def is_unwanted() -> bool:
            return document.version != version or not document.is_open

        try:
            return await self.server.runner.work(("try", document), attempt, is_unwanted)
        except Cancelled:
            raise JsonRpcRequestCancelled() from None

    async def _set_knob(self, given: Given) -> dict[str, Any]:
        asked, _ = await self._solved_view(given)
        path, value = given.text("path"), given.value("value")
        try:
            edits = await self.server.answers.ask(lambda: set_knob(asked.view, path, value))
        except RefusalError as refusal:
            return {"applied": False, "reason": str(refusal)}
        return await self._apply(asked, edits, f"Set {path}")

    async def _fix(self, given: Given) -> dict[str, Any]:
        asked, _ = await self._solved_view(given)
        problem, fix = given.whole("problem"), given.whole("fix")
        found = asked.view.diagnostics
        fixes = [found[problem].fix] if 0 <= problem < len(found) else []
        if not 0 <= fix < len(fixes) or (chosen := fixes[fix]) is None:
            return {"applied": False, "reason": "there is no such fix"}
        return await self._apply(asked, chosen.edits, chosen.title)

    async def _export(self, given: Given) -> dict[str, str]:
        suffix = f".{given.text('format')}"
        show = frozenset(given.texts("show"))
        if suffix not in FORMATS:
            raise JsonRpcInvalidParams(f"there is no format `{suffix}`")
        document = self._document(given)
        await document.until_solved(document.serial, _LONGEST_WAIT)
        outcome = document.ran.view.outcome if document.ran is not None else None
        if outcome is None or outcome.model is None or outcome.drawing is None:
            raise JsonRpcException("the program does not draw, so there is nothing to export", FAILED)
        options = Options(show & set(LAYERS) - {"dimensions"}, dimension="dimensions" in show)
        try:
            data = await self.server.searches.ask(lambda: outcome.export(suffix, options))
        except ExportError as reason:
            raise JsonRpcException(str(reason), FAILED) from None
        return {"name": document.path.stem + suffix, "data": base64.b64encode(data).decode("ascii")}

    def _closed(self, document: Document) -> None:
        self._shown.pop(document, None)

    def _solved(self, document: Document) -> None:
        if document.ran is None:
            return
        self._tell_status(document)
        if document in self._shown:
            self.server.in_background(self._send(document))

    async def _send(self, document: Document) -> None:
        if (picture := await self._picture(document, ("picture", document))) is not None:
            self.server.protocol.tell("aidl/previewChanged", picture)

    async def _picture(self, document: Document, key: object) -> dict[str, Any] | None:
        """Of the newest run; None where there was none."""
        known = document.ran
        if known is None or not document.is_open:
            return None
        asked, show = self.server.asked_now(document, known), self._shown.get(document, ())
        make = partial(_written, asked, known.view, show, known.version)
        try:
            return await self.server.runner.work(key, make, lambda: not document.is_open)
        except Cancelled:
            return None  # a newer one follows, or nobody is there to see it

    def _tell_status(self, document: Document) -> None:
        known = document.ran
        outcome = known.view.outcome if known is not None else None
        if known is None or outcome is None:
            return
        severities = [diagnostic.severity.value for diagnostic in outcome.diagnostics]
        self.server.protocol.tell(
            "aidl/status",
            {
                "uri": document.uri,
                "version": known.version,
                "status": outcome.status,
                "degrees": outcome.model.degrees if outcome.model is not None else None,
                "seconds": sum(outcome.timings.values()),
                "problems": {
                    "errors": severities.count("error"),
                    "warnings": severities.count("warning"),
                },
            },
        )

    def _document(self, given: Given) -> Document:
        document = self.server.documents.get(given.text("uri"))
        if document is None:
            raise JsonRpcInvalidParams("this document is not open")
        return document

    async def _solved_view(self, given: Given) -> tuple[Asked, Document]:
        """The outcome of the version that is spoken of. Raises JsonRpcContentModified where that is gone."""
        document, version = self._document(given), given.whole("version")
        await document.until_solved(document.serial, _LONGEST_WAIT)
        known = document.ran
        if known is None or known.version != version or document.version != version:
            raise JsonRpcContentModified("the text has changed")
        return self.server.asked_now(document, known), document

    async def _apply(self, asked: Asked, edits: Sequence[Edit], label: str) -> dict[str, Any]:
        """Have the client change the text."""
        convert = asked.convert
        changes = convert.changes(
            convert.by_file(edits), asked.can("workspace.workspace_edit.document_changes")
        )
        answer = await self.server.workspace_apply_edit_async(types.ApplyWorkspaceEditParams(changes, label))
        if answer.applied:
            return {"applied": True}
        return {"applied": False, "reason": answer.failure_reason or "the editor did not change the text"}


def _coroutine(answer: Any) -> Any:
    """A handler that pygls takes for one: a plain coroutine function of the parameters."""

    async def handler(params: Mapping[str, Value] | None) -> Any:
        return await answer(Given(params))

    return handler


def _written(
    asked: Asked, view: View, show: Sequence[str], version: int, *, is_tried: bool = False
) -> dict[str, Any]:
    """In the solving thread."""
    made = preview(view, show, tried=is_tried)
    return Writer(view, asked.convert.uri_of).preview(made, version)

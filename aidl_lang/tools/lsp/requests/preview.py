"""The picture beside the text, for clients that show it: requests of our own, all below `aidl/`."""

from __future__ import annotations

import base64
from collections.abc import Awaitable, Callable, Sequence
from itertools import count
from typing import Any, TypeVar

from lsprotocol import types
from pygls.exceptions import (
    JsonRpcContentModified,
    JsonRpcException,
    JsonRpcInvalidParams,
    JsonRpcRequestCancelled,
)

from aidl_lang.common.cancelling import Cancelled
from aidl_lang.common.diagnostics import Edit
from aidl_lang.export import FORMATS, ExportError, Options
from aidl_lang.tools.agents.workspace import RefusalError
from aidl_lang.tools.ide.dragging import Dragged, drag
from aidl_lang.tools.ide.preview import LAYERS, set_knob, tried
from aidl_lang.tools.ide.refusing import Refusal
from aidl_lang.tools.ide.view import View
from aidl_lang.tools.lsp.documents import Document
from aidl_lang.tools.lsp.given import Given
from aidl_lang.tools.lsp.pictures import Json, Pictures
from aidl_lang.tools.lsp.running import LIMITS
from aidl_lang.tools.lsp.server import FAILED, Asked, Server

_LONGEST_WAIT = 30.0
"""Seconds for an outcome: longer than a run may take."""
_DIMENSIONS = "dimensions"

T = TypeVar("T")


def register(server: Server) -> None:
    requests = _Requests(server)
    for method, answer in {
        "aidl/preview": requests.preview,
        "aidl/previewClose": requests.close,
        "aidl/try": requests.attempt,
        "aidl/setKnob": requests.set_knob,
        "aidl/drag": requests.drag,
        "aidl/fix": requests.fix,
        "aidl/export": requests.export,
    }.items():
        server.feature(method)(_handler(answer))


def _handler(answer: Callable[[Given], Awaitable[Any]]) -> Callable[[Any], Awaitable[Any]]:
    """What pygls knows for a coroutine function of the parameters, which may not be typed as `object`."""

    async def handler(params: Any) -> Any:
        return await answer(Given(params))

    return handler


class _Requests:
    def __init__(self, server: Server) -> None:
        self.server = server
        self.pictures = Pictures(server)
        self._numbers = count()

    async def preview(self, given: Given) -> Json | None:
        """Shows a document from now on."""
        document = self._document(given)
        self.pictures.show(document, given.texts("show"))
        self.server.runner.active = document
        await document.until_solved(document.serial, _LONGEST_WAIT)
        return await self.pictures.picture(document, next(self._numbers))

    async def close(self, given: Given) -> None:
        document = self.server.documents.get(given.text("uri"))
        if document is not None:
            self.pictures.forget(document)

    async def attempt(self, given: Given) -> Json:
        """The picture with other values of params, or with a point dragged; nothing is written."""
        asked, document = await self._solved(given)
        if "drag" in given:
            wanted = given.inner("drag")
            handle, to = wanted.text("id"), wanted.point("to")

            def view() -> View:
                return _agreed(drag(asked.view, handle, to)).view
        else:
            knobs = given.values("knobs")

            def view() -> View:
                return tried(asked.view, knobs, document.memory, LIMITS)

        def picture() -> Json:
            return self.pictures.drawn(asked, document, view(), is_tried=True)

        return await self._work("try", document, asked, picture)

    async def set_knob(self, given: Given) -> Json:
        asked, _ = await self._solved(given)
        path, value = given.text("path"), given.value("value")
        try:
            edits = await self.server.answers.ask(lambda: set_knob(asked.view, path, value))
        except RefusalError as refusal:
            return _not_applied(str(refusal))
        return await self._apply(asked, edits, f"Set {path}")

    async def drag(self, given: Given) -> Json:
        asked, document = await self._solved(given)
        handle, to = given.text("id"), given.point("to")

        def edits() -> Sequence[Edit] | Refusal:
            dragged = drag(asked.view, handle, to)
            return dragged if isinstance(dragged, Refusal) else dragged.edits

        made = await self._work("drag", document, asked, edits)
        if isinstance(made, Refusal):
            return _not_applied(made.reason)
        return await self._apply(asked, made, "Drag")

    async def fix(self, given: Given) -> Json:
        asked, _ = await self._solved(given)
        problem, number = given.whole("problem"), given.whole("fix")
        found = asked.view.diagnostics
        fix = found[problem].fix if 0 <= problem < len(found) and number == 0 else None
        if fix is None:
            return _not_applied("there is no such fix")
        return await self._apply(asked, fix.edits, fix.title)

    async def export(self, given: Given) -> Json:
        suffix, show = f".{given.text('format')}", frozenset(given.texts("show"))
        if suffix not in FORMATS:
            raise JsonRpcInvalidParams(f"there is no format `{suffix}`")
        document = self._document(given)
        await document.until_solved(document.serial, _LONGEST_WAIT)
        outcome = document.ran.view.outcome if document.ran is not None else None
        if outcome is None or outcome.model is None or outcome.drawing is None:
            raise JsonRpcException("the program does not draw, so there is nothing to export", FAILED)
        options = Options(show & set(LAYERS) - {_DIMENSIONS}, dimension=_DIMENSIONS in show)
        try:
            data = await self.server.searches.ask(lambda: outcome.export(suffix, options))
        except ExportError as reason:
            raise JsonRpcException(str(reason), FAILED) from None
        return {"name": document.path.stem + suffix, "data": base64.b64encode(data).decode("ascii")}

    def _document(self, given: Given) -> Document:
        document = self.server.documents.get(given.text("uri"))
        if document is None:
            raise JsonRpcInvalidParams("this document is not open")
        return document

    async def _solved(self, given: Given) -> tuple[Asked, Document]:
        """The outcome of the version that is spoken of. Raises JsonRpcContentModified where that is gone."""
        document, version = self._document(given), given.whole("version")
        await document.until_solved(document.serial, _LONGEST_WAIT)
        known = document.ran
        if known is None or known.version != version or document.version != version:
            raise JsonRpcContentModified("the text has changed")
        return self.server.asked_now(document, known), document

    async def _work(self, kind: str, document: Document, asked: Asked, function: Callable[[], T]) -> T:
        """In the solving thread, unless the text changes meanwhile, or more of the kind is asked."""

        def is_unwanted() -> bool:
            return document.version != asked.known.version or not document.is_open

        try:
            return await self.server.runner.work((kind, document), function, is_unwanted)
        except Cancelled:
            raise JsonRpcRequestCancelled("there is something newer") from None

    async def _apply(self, asked: Asked, edits: Sequence[Edit], label: str) -> Json:
        """Have the client change the text."""
        convert = asked.convert
        versioned = asked.can("workspace.workspace_edit.document_changes")
        changes = convert.changes(convert.by_file(edits), versioned)
        answer = await self.server.workspace_apply_edit_async(types.ApplyWorkspaceEditParams(changes, label))
        if answer.applied:
            return {"applied": True}
        return _not_applied(answer.failure_reason or "the editor did not change the text")


def _agreed(made: Dragged | Refusal) -> Dragged:
    """Raises JsonRpcException where a point cannot be dragged."""
    if isinstance(made, Refusal):
        raise JsonRpcException(made.reason, FAILED)
    return made


def _not_applied(reason: str) -> Json:
    return {"applied": False, "reason": reason}

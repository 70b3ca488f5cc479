"""The pictures of the documents that are shown: made after each run, and sent."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Hashable
from functools import partial
from typing import Any, TypeAlias, TypeVar

from aidl_lang.common.cancelling import Cancelled
from aidl_lang.common.records import record
from aidl_lang.tools.ide.dragging import Handle
from aidl_lang.tools.ide.preview import Preview, Writer, preview, with_handles
from aidl_lang.tools.ide.view import View
from aidl_lang.tools.lsp.documents import Document
from aidl_lang.tools.lsp.server import Asked, Server

_PAUSE = 0.25
"""Seconds without a change after which it is looked into what can be dragged: that takes as long as a run."""

Json: TypeAlias = dict[str, Any]
T = TypeVar("T")


@record(frozen=False, eq=False)
class _Shown:
    """The layers that are wanted, and what could be dragged when that was looked into last."""

    layers: tuple[str, ...] = ()
    handles: tuple[Handle, ...] = ()


class Pictures:
    """Who sees what. A document that is shown is told of after each of its runs; what of it can be dragged
    takes longer to find out, and follows.
    """

    def __init__(self, server: Server) -> None:
        self.server = server
        self._shown: dict[Document, _Shown] = {}
        server.on_solved.append(self._solved)
        server.on_closed.append(self.forget)

    def show(self, document: Document, layers: tuple[str, ...]) -> None:
        self._shown.setdefault(document, _Shown()).layers = layers

    def forget(self, document: Document) -> None:
        self._shown.pop(document, None)

    def drawn(self, asked: Asked, document: Document, view: View, *, is_tried: bool = False) -> Json:
        """The message for a view. To be called in the solving thread."""
        return self._written(asked, self._made(document, view, is_tried=is_tried), view)

    async def picture(self, document: Document, key: Hashable) -> Json | None:
        """The message for the newest run; None where there was none. What can be dragged follows."""
        known = document.ran
        if known is None or not document.is_open:
            return None
        asked = self.server.asked_now(document, known)
        made = await self._work(("picture", key), document, partial(self._made, document, known.view))
        if made is None:
            return None
        if document in self._shown and document.ran is known:
            self.server.in_background(self._complete(document, asked, made))
        return self._written(asked, made, known.view)

    def _made(self, document: Document, view: View, *, is_tried: bool = False) -> Preview:
        shown = self._shown.get(document, _Shown())
        return preview(view, shown.layers, tried=is_tried, known=shown.handles)

    def _written(self, asked: Asked, made: Preview, view: View) -> Json:
        return Writer(view, asked.convert.uri_of).preview(made, asked.known.version)

    def _solved(self, document: Document) -> None:
        if document.ran is None:
            return
        self._tell_status(document)
        if document in self._shown:
            self.server.in_background(self._send(document))

    async def _send(self, document: Document) -> None:
        if (message := await self.picture(document, document)) is not None:
            self.server.protocol.tell("aidl/previewChanged", message)

    async def _complete(self, document: Document, asked: Asked, made: Preview) -> None:
        """Find out what can be dragged, and tell of the picture again if that is news."""
        await asyncio.sleep(_PAUSE)
        if document.ran is not asked.known or document not in self._shown:
            return
        view = asked.known.view
        full = await self._work(
            ("handles", document), document, partial(with_handles, made, view), first=False
        )
        shown = self._shown.get(document)
        if full is None or shown is None or document.ran is not asked.known:
            return
        shown.handles = full.handles
        if full.handles != made.handles:
            message = self._written(asked, full, view)
            self.server.protocol.tell("aidl/previewChanged", message)

    async def _work(
        self, key: Hashable, document: Document, function: Callable[[], T], *, first: bool = True
    ) -> T | None:
        """In the solving thread; None where the document is closed, something newer asked, or, unless it goes
        first, the text changed.
        """
        serial = document.serial

        def is_unwanted() -> bool:
            return not document.is_open or not (first or document.serial == serial)

        try:
            return await self.server.runner.work(key, function, is_unwanted, first=first)
        except Cancelled:
            return None

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

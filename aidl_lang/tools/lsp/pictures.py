"""Pictures of the shown documents: made after each run, and sent."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import field, replace
from functools import partial
from typing import Any, TypeAlias, TypeVar

from aidl_lang.common.records import record
from aidl_lang.common.running import Cancelled
from aidl_lang.tools.ide.dragging import Handle
from aidl_lang.tools.ide.preview import Preview, Writer, preview, with_handles
from aidl_lang.tools.ide.workspace import View
from aidl_lang.tools.lsp.documents import Document, VersionedView
from aidl_lang.tools.lsp.params import Show
from aidl_lang.tools.lsp.server import Asked, Server

_PAUSE = 0.25
"""Seconds without a change before handles are searched, which takes as long as a run."""

Json: TypeAlias = dict[str, Any]
Look: TypeAlias = frozenset[str]
"""The layers over a picture."""
T = TypeVar("T")
_PLAIN: Look = frozenset()


@record(frozen=False, eq=False)
class _Shown:
    """A document that is shown.

    viewers  those who see a document, each with the wanted layers
    handles  the draggable points found last
    made     the pictures made last, each of a run
    """

    viewers: dict[str, Look] = field(default_factory=dict)
    handles: tuple[Handle, ...] = ()
    made: dict[Look, tuple[VersionedView, Preview]] = field(default_factory=dict)

    def looks(self) -> dict[Look, list[str]]:
        """Returns the viewers grouped by the picture they see."""
        return {
            look: [viewer for viewer, wanted in self.viewers.items() if wanted == look]
            for look in self.viewers.values()
        }


class Pictures:
    """The viewers of documents. They are told after each run; handles take longer to find, and follow."""

    def __init__(self, server: Server) -> None:
        self.server = server
        self._shown: dict[Document, _Shown] = {}
        server.on_solved.append(self._solved)
        server.on_closed.append(self._forget)

    def show(self, document: Document, wanted: Show) -> None:
        shown = self._shown.setdefault(document, _Shown())
        shown.viewers[wanted.viewer] = frozenset(wanted.show)

    def close(self, document: Document, viewer: str) -> None:
        """Stops telling a viewer of a document."""
        shown = self._shown.get(document)
        if shown is not None and shown.viewers.pop(viewer, None) is not None and not shown.viewers:
            self._forget(document)

    def _forget(self, document: Document) -> None:
        self._shown.pop(document, None)

    def tried(self, asked: Asked, document: Document, view: View, viewer: str) -> Json:
        """Returns the message for a view of another text. To be called in the solving thread."""
        shown = self._shown.get(document, _Shown())
        layers = shown.viewers.get(viewer, _PLAIN)
        made = preview(view, layers, tried=True, known=shown.handles)
        return _written(asked, made, view)

    async def picture(self, document: Document, viewer: str, key: Hashable) -> Json | None:
        """Returns the message for the newest run; None without one. Handles follow."""
        known = document.ran
        if known is None or not document.is_open:
            return None
        asked = self.server.asked_now(document, known)
        shown = self._shown.get(document, _Shown())
        look = shown.viewers.get(viewer, _PLAIN)
        made = await self._work(
            ("picture", key), document, lambda: preview(known.view, look, known=shown.handles)
        )
        if made is None:
            return None
        if document in self._shown and document.ran is known:
            shown.made = {each: of for each, of in shown.made.items() if of[0] is known} | {
                look: (known, made)
            }
            self.server.in_background(self._complete(document, asked, made))
        return _written(asked, made, known.view)

    def _solved(self, document: Document) -> None:
        if document.ran is None:
            return
        self._tell_status(document)
        shown = self._shown.get(document, _Shown())
        for look, viewers in shown.looks().items():
            self.server.in_background(self._send(document, look, viewers))

    async def _send(self, document: Document, look: Look, viewers: Sequence[str]) -> None:
        if (message := await self.picture(document, viewers[0], (document, look))) is not None:
            self._tell(viewers, message)

    def _tell(self, viewers: Iterable[str], message: Json) -> None:
        for viewer in viewers:
            self.server.protocol.tell("aidl/previewChanged", {"viewer": viewer, **message})

    async def _complete(self, document: Document, asked: Asked, made: Preview) -> None:
        """Finds the handles, and sends the picture again if they are new."""
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
        for look, viewers in shown.looks().items():
            known, before = shown.made.get(look, (None, made))
            if known is asked.known and before.handles != full.handles:
                complete = replace(before, handles=full.handles)
                self._tell(viewers, _written(asked, complete, view))

    async def _work(
        self, key: Hashable, document: Document, function: Callable[[], T], *, first: bool = True
    ) -> T | None:
        """Returns the result of a function run in the solving thread; None if the document is closed, a newer
        request came, or, unless it goes first, the text changed.
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


def _written(asked: Asked, made: Preview, view: View) -> Json:
    return Writer(view, asked.convert.uri_of).preview(made, asked.known.version)

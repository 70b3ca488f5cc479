"""The command that tries the ends of params, and its results for the lenses above them."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from typing import Any
from uuid import uuid4

from lsprotocol import types
from pygls.capabilities import get_capability
from pygls.exceptions import JsonRpcContentModified, JsonRpcException, JsonRpcInvalidParams

from aidl_lang.common.running import Cancelled
from aidl_lang.tools.ends import Sweep, described
from aidl_lang.tools.ide.lenses import can_be_tried, tried
from aidl_lang.tools.lsp.documents import Document, VersionedView
from aidl_lang.tools.lsp.running import LIMITS
from aidl_lang.tools.lsp.server import FAILED, Asked, Server

CHECK_ENDS = "aidl.checkEnds"
_LONGEST = 120.0
"""Most seconds for all ends."""
_PAUSE = 0.2
"""Seconds between checks whether the text has changed."""
_NOTHING = "there is nothing to try: the program must work as written, and have a param with a range"
_TITLE = "Trying the ends of the params"


class Ends:
    """The results by document, for the version asked about only."""

    def __init__(self, server: Server) -> None:
        self._server = server
        self._found: dict[str, tuple[int, Sweep]] = {}
        server.on_closed.append(lambda document: self._forget(document.uri))

    def of(self, asked: Asked) -> Sweep | None:
        version, found = self._found.get(asked.uri, (None, None))
        return found if version == asked.known.version else None

    def _forget(self, uri: str) -> None:
        self._found.pop(uri, None)

    async def check(self, uri: object) -> dict[str, Any]:
        """Tries each param of a document at its ends; the document may not change meanwhile."""
        document = self._server.documents.get(uri) if isinstance(uri, str) else None
        if document is None:
            raise JsonRpcInvalidParams("this document is not open")
        await document.until_solved(document.serial, _LONGEST)
        known = document.ran
        if known is None or known.version != document.version:
            raise JsonRpcContentModified("the text has changed")
        if not can_be_tried(known.view):
            raise JsonRpcException(_NOTHING, FAILED)
        found = await self._swept(document, known)
        self._found[document.uri] = known.version, found
        self._server.refresh_hints()
        return {"ok": found.ok, "tried": described(found), "left": found.left, "seconds": found.seconds}

    async def _swept(self, document: Document, known: VersionedView) -> Sweep:
        """Returns the results. Raises JsonRpcContentModified if the text changes before."""
        loop = asyncio.get_running_loop()
        told = await self._progress()

        def progress(done: int, count: int) -> None:
            loop.call_soon_threadsafe(told, done, count)

        work = partial(tried, known.view, LIMITS, progress, _LONGEST)
        task = loop.create_task(self._server.sweeps.ask(work))
        try:
            while not task.done():
                await asyncio.wait([task], timeout=_PAUSE)
                if document.version != known.version or not document.is_open:
                    raise JsonRpcContentModified("the text has changed")
            return task.result()
        except Cancelled:
            raise JsonRpcContentModified("the server is closing") from None
        finally:
            task.cancel()
            told(0, 0)

    async def _progress(self) -> Callable[[int, int], None]:
        """Returns a function that shows a client how many ends are done; `told(0, 0)` ends it."""
        server = self._server
        if not get_capability(server.client_capabilities, "window.work_done_progress", False):
            return lambda done, count: None
        token = str(uuid4())
        await server.work_done_progress.create_async(token)
        server.work_done_progress.begin(token, types.WorkDoneProgressBegin(_TITLE, percentage=0))

        is_over = False

        def told(done: int, count: int) -> None:
            nonlocal is_over
            if is_over:
                return
            if not count:
                is_over = True
                server.work_done_progress.end(token, types.WorkDoneProgressEnd())
                return
            message, share = f"{done} of {count}", 100 * done // count
            report = types.WorkDoneProgressReport(message=message, percentage=share)
            server.work_done_progress.report(token, report)

        return told

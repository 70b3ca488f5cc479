"""The host of the pages that show a program: a client of the language server whose text is a file.

A page speaks the server's requests (`lsp/requests/preview.py`), and is answered by it. Here pages have turns:
of each one order is under way, and one attempt; of attempts the newest waits. An edit that the server asks
for is written into the file.
"""

from __future__ import annotations

import asyncio
import json
from collections import deque
from collections.abc import Callable, Iterable
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any, TypeAlias

from attrs import field, frozen
from lsprotocol.types import ErrorCodes, LSPErrorCodes, MessageType
from pygls.exceptions import JsonRpcInvalidParams

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.tools.ide.positions import Positions
from aidl_lang.tools.ide.refusing import CannotError
from aidl_lang.tools.ide.view import SETTINGS
from aidl_lang.tools.lsp.documents import Document
from aidl_lang.tools.lsp.params import read
from aidl_lang.tools.lsp.serve import make
from aidl_lang.tools.preview import files

Json: TypeAlias = dict[str, Any]

LONGEST = 65_536
"""Most bytes of a page's message."""
MOST_ORDERS = 8
"""Most waiting orders of one page."""
MOST_UNTAKEN = 16
"""Messages waiting for a page above which it is not heard."""
BUSY_AFTER = 0.15
"""Seconds of a run after which the pages are told."""

_ATTEMPT = "aidl/try"
_EDITS = frozenset({"aidl/setKnob", "aidl/drag", "aidl/fix"})
_METHODS = _EDITS | {_ATTEMPT, "aidl/preview", "aidl/export"}
"""Requests that a page may send to the server."""
_TOO_MUCH = "this page asks for more than can be done at once: what it asked for last was left out"
_CLIENT: Json = {
    "general": {"positionEncodings": ["utf-16"]},
    "workspace": {"applyEdit": True, "workspaceEdit": {"documentChanges": True}},
}


@frozen(kw_only=True)
class Request:
    """A request of a page; `id` is its own."""

    id: int
    method: str
    params: dict[str, Any] = field(factory=dict)


class Page:
    """One open page. Messages wait until it takes them; of pictures only the newest, of equals one."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self.orders: deque[Request] = deque()
        self.is_ordering = False
        """whether an order is under way"""
        self.attempt: Request | None = None
        """what is tried next"""
        self.is_trying = False
        self._is_held_up = False
        self._waiting: list[tuple[bool, str]] = []
        self._news = asyncio.Event()

    @property
    def is_behind(self) -> bool:
        """True if it asks for more than it takes."""
        return len(self._waiting) >= MOST_UNTAKEN

    def post(self, message: Json, *, is_picture: bool = False) -> None:
        text = json.dumps({"jsonrpc": "2.0", **message})
        if is_picture:
            self._waiting = [each for each in self._waiting if not each[0]]
        if (is_picture, text) not in self._waiting:
            self._waiting.append((is_picture, text))
        self._news.set()

    def tell(self, message: str) -> None:
        """Sends a message for people."""
        params = {"type": MessageType.Error.value, "message": message}
        self.post({"method": "window/showMessage", "params": params})

    def refuse(self, request: Request, code: int, message: str) -> None:
        self.post({"id": request.id, "error": {"code": code, "message": message}})

    def hold_up(self) -> None:
        """Tells it once that its requests are left out."""
        if not self._is_held_up:
            self._is_held_up = True
            self.tell(_TOO_MUCH)

    async def next(self) -> str:
        """Returns the next message for it."""
        while not self._waiting:
            self._news.clear()
            await self._news.wait()
        self._is_held_up = False
        return self._waiting.pop(0)[1]


class Host:
    """All methods belong to the loop's thread. `start` is called once, in the loop that serves the pages."""

    def __init__(self, path: Path, write: files.Write) -> None:
        self.path, self._write = path, write
        self.uri = path.as_uri()
        self.pages: list[Page] = []
        self.server = make(SETTINGS)
        self._gone = Page()
        """carries out the edits of pages that left"""
        self._text: str | None = None
        self._version = 0
        self._trouble = ""
        self._numbers = count(1)
        self._asked: dict[int, Callable[[Json], None]] = {}
        self._busy: asyncio.TimerHandle | None = None

    def start(self) -> None:
        self._loop = asyncio.get_running_loop()
        self.server.start()
        self.server.protocol.set_writer(self, include_headers=False)
        self._ask("initialize", {"processId": None, "rootUri": None, "capabilities": _CLIENT}, _ignore)
        self._say("initialized", {})
        self.look()

    def close(self) -> None:
        """Cancels the work under way."""
        self._rested()
        self.server.close()

    # --- The text

    def changed(self, paths: Iterable[Path] = ()) -> None:
        """Takes note of files that have, or may have changed; the program's own is read in any case."""
        others = [{"uri": path.as_uri(), "type": 2} for path in paths if path != self.path]
        if others:
            self._say("workspace/didChangeWatchedFiles", {"changes": others})
        try:
            text = files.text_of(self.path)
        except CannotError as reason:
            self._tell_trouble(str(reason))
            return
        self._tell_trouble("")
        if text != self._text:
            self._renew(text)

    def look(self) -> None:
        """Reads the program's files again: any may have changed before anybody watched it."""
        self.changed(self._sources())

    def _renew(self, text: str) -> None:
        self._version += 1
        named: Json = {"uri": self.uri, "version": self._version}
        if self._text is None:
            self._say("textDocument/didOpen", {"textDocument": {**named, "languageId": "aidl", "text": text}})
        else:
            self._say("textDocument/didChange", {"textDocument": named, "contentChanges": [{"text": text}]})
        self._text = text
        if self._busy is None:
            self._busy = self._loop.call_later(BUSY_AFTER, self._tell_all, {"method": "aidl/busy"})

    def _rested(self) -> None:
        if self._busy is not None:
            self._busy.cancel()
            self._busy = None

    def _tell_trouble(self, message: str) -> None:
        """Tells once that the file cannot be read, not at each reading."""
        if message and message != self._trouble:
            for page in self.pages:
                page.tell(message)
        self._trouble = message

    def _tell_all(self, message: Json) -> None:
        for page in self.pages:
            page.post(message)

    def _sources(self) -> dict[Path, SourceFile]:
        """Returns the files of the program, as they were run last."""
        document: Document | None = self.server.documents.get(self.uri)
        if document is None or document.ran is None:
            return {}
        view = document.ran.view
        sources = [m.source for m in view.resolution.modules if not view.is_library(m.source)]
        return {path: source for source in sources if (path := view.file(source)) is not None}

    # --- Pages

    def join(self) -> Page:
        page = Page(str(next(self._numbers)))
        self.pages.append(page)
        return page

    def leave(self, page: Page) -> None:
        """Closes a page; edits among its orders are still carried out."""
        self.pages.remove(page)
        for request in page.orders:
            if request.method in _EDITS and len(self._gone.orders) < MOST_ORDERS:
                self._gone.orders.append(request)
        page.orders.clear()
        page.attempt = None
        self._go_on(self._gone)
        self._ask("aidl/previewClose", {"uri": self.uri, "viewer": page.name}, _ignore)

    def hear(self, page: Page, text: str) -> None:
        """Takes a message; the answer comes when there is one. Skips what is no request."""
        if page.is_behind:
            page.hold_up()
            return
        try:
            request = read(json.loads(text), Request)
        except (ValueError, RecursionError, JsonRpcInvalidParams):
            return
        if request.method not in _METHODS:
            page.refuse(request, ErrorCodes.MethodNotFound, "pages cannot ask for this")
        elif request.method == _ATTEMPT:
            if page.attempt is not None:
                page.refuse(page.attempt, LSPErrorCodes.RequestCancelled, "there is something newer")
            page.attempt = request
            self._try(page)
        elif len(page.orders) == MOST_ORDERS:
            page.refuse(request, LSPErrorCodes.RequestFailed, _TOO_MUCH)
        else:
            page.orders.append(request)
            self._go_on(page)

    def _try(self, page: Page) -> None:
        if page.attempt is not None and not page.is_trying:
            request, page.attempt, page.is_trying = page.attempt, None, True
            self._forward(page, request, partial(self._tried, page))

    def _tried(self, page: Page) -> None:
        page.is_trying = False
        self._try(page)

    def _go_on(self, page: Page) -> None:
        if page.orders and not page.is_ordering:
            page.is_ordering = True
            self._forward(page, page.orders.popleft(), partial(self._carried_out, page))

    def _carried_out(self, page: Page) -> None:
        page.is_ordering = False
        self._go_on(page)

    def _forward(self, page: Page, request: Request, then: Callable[[], None]) -> None:
        """Has the server answer a page."""

        def answered(message: Json) -> None:
            if page in self.pages:
                page.post({**message, "id": request.id})
            then()

        self._ask(request.method, {**request.params, "viewer": page.name}, answered)

    # --- The server

    def _ask(self, method: str, params: Json, answered: Callable[[Json], None]) -> None:
        number = next(self._numbers)
        self._asked[number] = answered
        self._receive({"id": number, "method": method, "params": params})

    def _say(self, method: str, params: Json) -> None:
        self._receive({"method": method, "params": params})

    def _receive(self, message: Json) -> None:
        self.server.protocol.receive(json.dumps({"jsonrpc": "2.0", **message}).encode())

    def write(self, data: bytes) -> None:
        """Takes what the server sends; see `pygls`."""
        self._loop.call_soon(self._heard, json.loads(data))

    def _heard(self, message: Json) -> None:
        method: str | None = message.get("method")
        params: Json = message.get("params") or {}
        if method is None:
            self._asked.pop(message["id"])(message)
        elif "id" in message:
            made = self._edited(params) if method == "workspace/applyEdit" else None
            self._receive({"id": message["id"], "result": made})
        elif method == "aidl/previewChanged":
            self._rested()
            for page in self.pages:
                if page.name == params["viewer"]:
                    page.post(message, is_picture=True)
        elif method == "aidl/status":
            self._rested()
        elif method == "window/showMessage":
            self._tell_all(message)

    def _edited(self, params: Json) -> Json:
        """Writes an edit into the files."""
        try:
            self._edit(params["edit"]["documentChanges"])
        except CannotError as reason:
            return {"applied": False, "failureReason": str(reason)}
        self.look()
        return {"applied": True}

    def _edit(self, changes: list[Json]) -> None:
        """Edits each file as a whole or not at all. Raises CannotError."""
        known = {
            self.server.documents.uri_of(path): (path, source) for path, source in self._sources().items()
        }
        written = []
        for change in changes:
            path, source = known.get(change["textDocument"]["uri"], (None, None))
            if path is None or source is None:
                raise CannotError("this cannot be changed from here")
            if change["textDocument"]["version"] not in (None, self._version):
                raise CannotError("the text has changed meanwhile")
            written.append((path, files.rewritten(path, source, _edits(source, change["edits"]))))
        files.write(written, self._write)


def _edits(source: SourceFile, edits: Iterable[Json]) -> list[Edit]:
    positions = Positions(source.text)

    def offset(place: Json) -> int:
        return positions.offset(place["line"], place["character"])

    return [
        Edit(Span(source, offset(e["range"]["start"]), offset(e["range"]["end"])), e["newText"])
        for e in edits
    ]


def _ignore(message: Json) -> None:
    """Ignores an answer that nobody waits for."""

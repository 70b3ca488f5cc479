"""Serves the open pages of a preview: a client of the language server, in this process."""

from __future__ import annotations

import asyncio
import json
import re
from collections import deque
from collections.abc import Callable, Coroutine, Iterable, Mapping, Sequence
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any, TypeAlias

from attrs import field, frozen
from lsprotocol.types import ErrorCodes, LSPErrorCodes, MessageType
from pygls.exceptions import JsonRpcInvalidParams

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.source import SourceFile
from aidl_server.ide.references import CannotError
from aidl_server.ide.workspace import SETTINGS, Positions
from aidl_server.lsp.documents import Document, read, whole
from aidl_server.lsp.serve import make
from aidl_server.lsp.server import Asked
from aidl_server.preview import files
from aidl_server.preview.files import Manuscript

# --- One open page: what it has asked for, and what waits to be sent to it.

Json: TypeAlias = dict[str, Any]

MOST_UNTAKEN = 16
"""Messages waiting for a page above which it is not heard."""
TOO_MUCH = "this page asks for more than can be done at once: what it asked for last was left out"


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
        self.version = 0
        """of the text that it has"""
        self.state: Json = {}
        """what it was told of the text beside its words"""
        self.orders: deque[Request] = deque()
        self.attempt: Request | None = None
        """what is tried next"""
        self.under_way: set[str] = set()
        """of an order, an attempt and a walk, those that are"""
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
        self.post({"method": "window/showMessage", "params": {"type": MessageType.Error, "message": message}})

    def refuse(self, request: Request, code: int, message: str) -> None:
        self.post({"id": request.id, "error": {"code": code, "message": message}})

    def hold_up(self) -> None:
        """Tells it once that its requests are left out."""
        if not self._is_held_up:
            self._is_held_up = True
            self.tell(TOO_MUCH)

    async def next(self) -> str:
        while not self._waiting:
            self._news.clear()
            await self._news.wait()
        self._is_held_up = False
        return self._waiting.pop(0)[1]


# --- What a page types, as changes of the text that it has.

_LINE_END = re.compile("\r\n|\n|\r")
_INVALID = "this page sent no changes of a text"


def typed(text: str, changes: Any) -> str:
    """Returns a text after changes counted in it, with its line ends. Raises CannotError for what is none."""
    if not isinstance(changes, list):
        raise CannotError(_INVALID)
    positions, found = Positions(text), _LINE_END.search(text)
    end = found[0] if found is not None else "\n"
    later = len(text)
    for start, stop, words in sorted((_edit(positions, change) for change in changes), reverse=True):
        if stop > later:
            raise CannotError(_INVALID)
        text = text[:start] + _LINE_END.sub(end, words) + text[stop:]
        later = start
    return text


def _edit(positions: Positions, change: Any) -> tuple[int, int, str]:
    match change:
        case {
            "text": str(words),
            "start": {"line": int(line), "character": int(character)},
            "end": {"line": int(last), "character": int(behind)},
        } if not any(isinstance(number, bool) for number in (line, character, last, behind)):
            start, stop = positions.offset(line, character), positions.offset(last, behind)
            if start <= stop:
                return start, stop, whole(words)
    raise CannotError(_INVALID)


# --- The host of the pages that show a program: a client of the language server whose text is a file.
#
# A page speaks the server's requests (`lsp/preview.py`), and is answered by it. Here pages have
# turns: of each one order is under way, and one attempt; of attempts the newest waits. What changes the
# text, by order of the server or of a page, goes through the `Manuscript`, of which all pages are told.

LONGEST = 2_000_000
"""Most bytes of a page's message: it may hold what somebody pastes."""
MOST_ORDERS = 8
"""Most waiting orders of one page."""
BUSY_AFTER = 0.15
"""Seconds of a run after which the pages are told."""

_ATTEMPT = "aidl/try"
_EDITS = frozenset({"aidl/setKnob", "aidl/drag", "aidl/fix"})
_WALK = "aidl/ranges"
_METHODS = _EDITS | {_ATTEMPT, _WALK, "aidl/preview", "aidl/export", "aidl/exports"}
"""Requests that a page may send to the server."""
_TYPING = "aidl/type"
OWN: Mapping[str, Callable[[Manuscript, Json], None]] = {
    "aidl/undo": lambda text, _: text.undo(),
    "aidl/redo": lambda text, _: text.redo(),
    "aidl/save": lambda text, given: text.save(anyway=given.get("anyway") is True),
    "aidl/takeFile": lambda text, _: text.take_file(),
}
"""Requests about the text, which are answered here."""
_CLIENT: Json = {"general": {"positionEncodings": ["utf-16"]}}


class Host:
    """All methods belong to the loop's thread. `start` is called once, in the loop that serves the pages.

    Files are read and written in other threads, so that a slow one holds up no page: one change of the text
    at a time, in order.
    """

    def __init__(self, path: Path, write: files.Write) -> None:
        self.path = path
        self.text = Manuscript(path, write)
        self.uri = path.as_uri()
        self.pages: list[Page] = []
        self.server = make(SETTINGS, self._apply)
        self._gone = Page()
        """carries out the edits of pages that left"""
        self._version = 0
        """of the text that the server has"""
        self._trouble = ""
        self._numbers = count(1)
        self._asked: dict[int, Callable[[Json], None]] = {}
        self._busy: asyncio.TimerHandle | None = None
        self._turn = asyncio.Lock()
        """held by who changes the text"""
        self._tasks: set[asyncio.Task[None]] = set()

    async def start(self) -> None:
        self._loop = asyncio.get_running_loop()
        self.server.start()
        self.server.protocol.set_writer(self, include_headers=False)
        self._ask("initialize", {"processId": None, "rootUri": None, "capabilities": _CLIENT})
        self._say("initialized", {})
        await self.noticed()

    def close(self) -> None:
        self._rested()
        self.server.close()

    # --- The text

    async def noticed(self, paths: Iterable[Path] | None = None) -> None:
        """Takes note of files that may have changed, all unless given; the program's own in any case."""
        while True:
            looks = self.text.looks
            found = asyncio.ensure_future(asyncio.to_thread(files.text_of, self.path))
            await asyncio.wait([found])
            async with self._turn:
                if looks == self.text.looks:  # else what was found is older than what is known by now
                    self._take(self._sources() if paths is None else paths, found)
                    return

    def _take(self, paths: Iterable[Path], found: asyncio.Future[str]) -> None:
        others = [{"uri": path.as_uri(), "type": 2} for path in paths if path != self.path]
        if others:
            self._say("workspace/didChangeWatchedFiles", {"changes": others})
        trouble = ""
        try:
            self.text.take(found.result())
        except CannotError as reason:
            trouble = str(reason)
        if trouble and trouble != self._trouble:  # told once, not at each reading
            for page in self.pages:
                page.tell(trouble)
        self._trouble = trouble
        self._renew()

    def _renew(self) -> None:
        if self.text.version != self._version:
            named: Json = {"uri": self.uri, "version": self.text.version}
            if self._version == 0:
                opened = {**named, "languageId": "aidl", "text": self.text.text}
                self._say("textDocument/didOpen", {"textDocument": opened})
            else:
                changes = [{"text": self.text.text}]
                self._say("textDocument/didChange", {"textDocument": named, "contentChanges": changes})
            self._version = self.text.version
            if self._busy is None:
                self._busy = self._loop.call_later(BUSY_AFTER, self._tell_all, {"method": "aidl/busy"})
        for page in self.pages:
            self._tell_text(page)

    def _tell_text(self, page: Page) -> None:
        """Tells a page of the text, with its words if it has others."""
        text = self.text
        state = {
            "version": text.version,
            "saved": text.is_saved,
            "contested": text.is_contested,
            "undo": text.undoes,
            "redo": text.redoes,
        }
        if text.text is not None and (page.version, page.state) != (text.version, state):
            words = text.text if page.version != text.version else None
            page.version, page.state = text.version, state
            page.post({"method": "aidl/text", "params": {**state, "text": words}})

    def _rested(self) -> None:
        if self._busy is not None:
            self._busy.cancel()
            self._busy = None

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
        self._tell_text(page)
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
        self._ask("aidl/previewClose", {"uri": self.uri, "viewer": page.name})

    def hear(self, page: Page, text: str) -> None:
        """Takes a message; the answer comes when there is one. Skips what is no request."""
        if page.is_behind:
            page.hold_up()
            return
        try:
            request = read(json.loads(text), Request)
        except (ValueError, RecursionError, JsonRpcInvalidParams):
            return
        if request.method == _TYPING:
            self._spawn(self._answer(page, request, partial(self._type, page)))
        elif request.method not in _METHODS and request.method not in OWN:
            page.refuse(request, ErrorCodes.MethodNotFound, "pages cannot ask for this")
        elif request.method == _ATTEMPT:
            if page.attempt is not None:
                page.refuse(page.attempt, LSPErrorCodes.RequestCancelled, "there is something newer")
            page.attempt = request
            self._go_on(page)
        elif request.method == _WALK and "walk" not in page.under_way:
            self._begin(page, request, "walk")  # it takes seconds, in which orders and attempts go on
        elif request.method == _WALK or len(page.orders) == MOST_ORDERS:
            page.refuse(request, LSPErrorCodes.RequestFailed, TOO_MUCH)
        else:
            page.orders.append(request)
            self._go_on(page)

    def _go_on(self, page: Page) -> None:
        if page.attempt is not None and "attempt" not in page.under_way:
            request, page.attempt = page.attempt, None
            self._begin(page, request, "attempt")
        if page.orders and "order" not in page.under_way:
            self._begin(page, page.orders.popleft(), "order")

    def _begin(self, page: Page, request: Request, turn: str) -> None:
        page.under_way.add(turn)

        def over() -> None:
            page.under_way.discard(turn)
            self._go_on(page)

        self._forward(page, request, over)

    def _forward(self, page: Page, request: Request, then: Callable[[], None]) -> None:
        if request.method in OWN:
            self._spawn(self._answer(page, request, partial(OWN[request.method], self.text), then))
            return

        def answered(message: Json) -> None:
            if page in self.pages:
                page.post({**message, "id": request.id})
            then()

        self._ask(request.method, {**request.params, "viewer": page.name}, answered)

    # --- The text

    async def _answer(
        self,
        page: Page,
        request: Request,
        change: Callable[[Json], None],
        then: Callable[[], None] | None = None,
    ) -> None:
        """Changes the text for a page, and answers it; with files unless it was only typed."""
        async with self._turn:
            try:
                await asyncio.to_thread(change, request.params)
            except CannotError as reason:
                result = {"applied": False, "reason": str(reason)}
            else:
                result = {"applied": True, "version": self.text.version}
            if page in self.pages:
                page.post({"id": request.id, "result": result})
            self._renew()
        if then is not None:
            then()
            await self.noticed(self._sources() if result["applied"] else ())

    def _type(self, page: Page, given: Json) -> None:
        """Changes the text as a page types; one that does not have it yet is told of it first."""
        if given.get("version") != self.text.version or self.text.text is None:
            raise CannotError("the text has changed meanwhile")
        self.text.type(typed(self.text.text, given.get("changes")), page.name, self._loop.time())
        page.version = self.text.version

    # --- The server

    def _ask(self, method: str, params: Json, answered: Callable[[Json], None] = lambda _: None) -> None:
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
        elif method == "aidl/previewChanged":
            self._rested()
            for page in (each for each in self.pages if each.name == params["viewer"]):
                page.post(message, is_picture=True)
        elif method == "aidl/status":
            self._rested()
        elif method == "window/showMessage":
            self._tell_all(message)

    async def _apply(self, asked: Asked, edits: Sequence[Edit], label: str) -> str:
        """Makes the edits that the server asks for; returns why it cannot, or ""."""
        async with self._turn:
            try:
                await asyncio.to_thread(self._edit, asked, edits, label)
            except CannotError as reason:
                return str(reason)
        await self.noticed()
        return ""

    def _edit(self, asked: Asked, edits: Sequence[Edit], label: str) -> None:
        """Edits each file as a whole or not at all. Raises CannotError."""
        by_source: dict[SourceFile, list[Edit]] = {}
        for edit in edits:
            by_source.setdefault(edit.span.source, []).append(edit)
        own: SourceFile | None = None
        others = {}
        for source, made in by_source.items():
            path = asked.view.file(source)
            if path is None or asked.view.is_library(source):
                raise CannotError("this cannot be changed from here")
            if path != self.path:
                others[path] = files.rewritten(path, source, made)
            elif asked.known.version == self._version:
                own = source
            else:
                raise CannotError("the text has changed meanwhile")
        self.text.set(label, own, by_source.get(own, []) if own is not None else [], others)

    def _spawn(self, work: Coroutine[Any, Any, None]) -> None:
        task = self._loop.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

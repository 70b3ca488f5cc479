"""The host of the pane in a worker: one program, whose file is in the worker's memory and in the page's
keeping.

Whatever is typed is written at once, as a page has no file that could be older than its text.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable, Hashable, Mapping
from pathlib import Path
from typing import Protocol, TypeVar

from lsprotocol.types import LSPErrorCodes

from aidl_lang.common.resources import resource
from aidl_server.lsp.serve import make_room
from aidl_server.preview.host import OWN, Host, Json, Page, Request

FOLDER = Path("/programs")
"""Where programs lie, and what they import."""
_POINTS = 3.0
"""Seconds in which the points that can be dragged are looked for: nothing is heard meanwhile."""
_BLANK: Json = {
    "version": 1,
    "status": "Stopped",
    "stale": False,
    "seconds": 0,
    "svg": None,
    "box": [0, 0, 0, 0],
    "degrees": None,
    **{name: [] for name in ("elements", "knobs", "handles", "problems", "conflicts", "motions")},
}
"""The picture of a program that is held."""
T = TypeVar("T")
_BESIDE = (".svg", ".dxf")
"""Of what examples import."""


class Outside(Protocol):
    """What the page is told: the URI of a program that is open from now on, messages for the pane, and the
    text whenever it has changed. `scipy` has that fetched.
    """

    def opened(self, uri: str) -> None: ...
    def scipy(self) -> Awaitable[None]: ...
    def say(self, message: str) -> None: ...
    def keep(self, name: str, text: str) -> None: ...


class Kept(Host):
    """The host of a program that is kept by the page. One that is held is shown as a text, and run only when
    that has changed: it is what somebody has stopped.
    """

    def __init__(self, path: Path, outside: Outside, is_held: bool) -> None:
        self._outside, self._is_held = outside, is_held
        self._wish: tuple[Page, Request] | None = None
        """who wants to be shown what is held"""
        super().__init__(path, self._put)

    async def start(self) -> None:
        await super().start()
        self._has_asked = False
        self._crashed, self.server.crashed = self.server.crashed, self._lacking  # type: ignore[method-assign]
        self._work, self.server.runner.work = self.server.runner.work, self._limited  # type: ignore[method-assign]

    def _lacking(self, error: BaseException) -> None:
        """Has scipy fetched for a program so large that the solver asks for it, and runs that again."""
        is_large = isinstance(error, ModuleNotFoundError) and (error.name or "").startswith("scipy")
        if is_large and not self._has_asked:
            self._has_asked = True
            self._spawn(self._enlarge())
        else:
            self._crashed(error)

    async def _enlarge(self) -> None:
        await self._outside.scipy()
        if (document := self.server.documents.get(self.uri)) is not None:
            self.server.runner.renew(document, active=True)

    async def _limited(
        self, key: Hashable, function: Callable[[], T], is_unwanted: Callable[[], bool], *, first: bool = True
    ) -> T:
        """Does work of the server; what nobody has asked for within a limit of time."""
        until: list[float] = []

        def is_late() -> bool:
            if not until:
                until.append(time.monotonic() + _POINTS)
            return is_unwanted() or (not first and time.monotonic() > until[0])

        return await self._work(key, function, is_late, first=first)

    def _put(self, path: Path, data: bytes) -> None:
        path.write_bytes(data)
        if path == self.path:
            self._outside.keep(path.name, data.decode("utf-8-sig"))

    def _forward(self, page: Page, request: Request, then: Callable[[], None]) -> None:
        if self._is_held and request.method not in OWN:
            self._wish = (page, request) if request.method == "aidl/preview" else self._wish
            if request.method == "aidl/preview":
                page.post({"id": request.id, "result": {"uri": self.uri, **_BLANK}})
            else:
                page.refuse(request, LSPErrorCodes.RequestCancelled, "this was stopped")
            then()
        else:
            super()._forward(page, request, then)

    def _renew(self) -> None:
        self._is_held &= self.text.version <= 1
        if self._is_held:
            for page in self.pages:
                self._tell_text(page)
            return
        super()._renew()
        if self._wish is not None:
            page, request = self._wish
            self._wish = None
            super()._forward(page, request, lambda: None)

    def _say(self, method: str, params: Json) -> None:
        if method != "initialized":  # which warms the server up, for longer than the first program takes
            super()._say(method, params)

    def _type(self, page: Page, given: Json) -> None:
        super()._type(page, given)
        self.text.save()


class Desk:
    """The program that is open, and the pane that shows it."""

    def __init__(self, outside: Outside) -> None:
        self._outside = outside
        self.host: Kept | None = None
        self._page: Page | None = None
        self._sending: asyncio.Task[None] | None = None
        make_room()
        FOLDER.mkdir(exist_ok=True)
        for file in resource("examples").rglob("*"):
            if file.suffix in _BESIDE:
                (FOLDER / file.name).write_bytes(file.read_bytes())

    async def open(self, name: str, text: str, beside: Mapping[str, bytes], is_held: bool = False) -> None:
        """Opens a program in place of the one before; `beside` are files that it imports."""
        self.close()
        for each, data in beside.items():
            (FOLDER / Path(each).name).write_bytes(data)
        path = FOLDER / Path(name).name
        path.write_text(text, "utf-8")
        self.host = host = Kept(path, self._outside, is_held)
        await host.start()
        self._page = page = host.join()
        self._outside.opened(host.uri)
        self._sending = asyncio.ensure_future(self._send(page))  # kept, as the loop keeps no tasks alive

    def hear(self, message: str) -> None:
        """Takes a message of the pane."""
        if self.host is not None and self._page is not None:
            self.host.hear(self._page, message)

    def close(self) -> None:
        """Closes the program that is open, if there is one."""
        if self.host is not None:
            self.host.close()
        if self._page is not None:
            page, self._page = self._page, None
            page.post({"method": "exit"})  # wakes what sends

    async def _send(self, page: Page) -> None:
        """Sends what there is for the pane, until another program is open."""
        while (message := await page.next()) and page is self._page:
            self._outside.say(message)

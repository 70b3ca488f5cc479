"""The host of the pane in a worker: one program, whose file is in the worker's memory and in the page's keeping.

Whatever is typed is written at once, as a page has no file that could be older than its text.
"""

from __future__ import annotations

import asyncio
import json
import logging
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Protocol

from lsprotocol.types import LSPErrorCodes

from aidl_lang.common.resources import resource
from aidl_lang.tools.preview.host import OWN, Host
from aidl_lang.tools.preview.page import Json, Page, Request

FOLDER = Path("/programs")
"""Where programs lie, and what they import."""
_RECURSION = 10_000
_BESIDE = (".svg", ".dxf")
"""Of what examples import."""


class Outside(Protocol):
    """What the page is told: the URI of a program that is open from now on, messages for the pane, and the text
    whenever it has changed.
    """

    def opened(self, uri: str) -> None: ...
    def say(self, message: str) -> None: ...
    def keep(self, name: str, text: str) -> None: ...


class Kept(Host):
    """The host of a program that is kept by the page. One that is held is shown as a text, and run only when that
    has changed: it is what somebody has stopped.
    """

    def __init__(self, path: Path, outside: Outside, is_held: bool) -> None:
        self._outside, self._is_held = outside, is_held
        self._wish: tuple[Page, Request] | None = None
        """who wants to be shown what is held"""
        super().__init__(path, self._put)

    def _put(self, path: Path, data: bytes) -> None:
        path.write_bytes(data)
        if path == self.path:
            self._outside.keep(path.name, data.decode("utf-8-sig"))

    def _forward(self, page: Page, request: Request, then: Callable[[], None]) -> None:
        if self._is_held and request.method not in OWN:
            self._wish = (page, request) if request.method == "aidl/preview" else self._wish
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
        self._host: Kept | None = None
        self._page: Page | None = None
        self._sending: asyncio.Task[None] | None = None
        sys.setrecursionlimit(max(sys.getrecursionlimit(), _RECURSION))
        logging.basicConfig(stream=sys.stderr, format="%(levelname)s %(name)s: %(message)s")
        FOLDER.mkdir(exist_ok=True)
        for file in resource("examples").rglob("*"):
            if file.suffix in _BESIDE:
                (FOLDER / file.name).write_bytes(file.read_bytes())

    async def open(self, name: str, text: str, beside: Mapping[str, bytes], is_held: bool = False) -> None:
        """Opens a program in place of the one before; `beside` are files that it imports."""
        if self._host is not None:
            self._close(self._host)
        for each, data in beside.items():
            (FOLDER / Path(each).name).write_bytes(data)
        path = FOLDER / Path(name).name
        path.write_text(text, "utf-8")
        self._host = host = Kept(path, self._outside, is_held)
        await host.start()
        self._page = page = host.join()
        self._outside.opened(host.uri)
        self._sending = asyncio.ensure_future(self._send(page))

    def hear(self, message: str) -> None:
        """Takes a message of the pane."""
        if self._host is not None and self._page is not None:
            self._host.hear(self._page, message)

    def _close(self, host: Kept) -> None:
        if self._sending is not None:
            self._sending.cancel()
        host.close()

    async def _send(self, page: Page) -> None:
        while True:
            self._outside.say(await page.next())


"""`aidl preview` as a server: the pages of one program and their WebSocket, on a socket of this machine."""

from __future__ import annotations

import asyncio
import html
import secrets
from collections.abc import AsyncIterator, Collection
from contextlib import asynccontextmanager
from functools import cache
from pathlib import Path

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

from aidl_server.lsp.serve import make_room
from aidl_server.preview.files import watch
from aidl_server.preview.host import LONGEST, Host, Page
from aidl_server.preview.local import HEADERS, KINDS, PANE, STRICT, Door, Guard, file_named

MOST_PAGES = 16
"""Most pages that are served at once."""
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'nonce-{nonce}'; connect-src 'self'; "
    "img-src 'self' data:; font-src 'self'"
)
"""What a page may load. The editor of the text makes a style sheet of its own: `nonce` is for that."""
_TRY_AGAIN = 1013
_NO_TEXT = 1003
_TOO_BIG = 1009


def site(host: Host, token: str, addresses: Collection[str]) -> ASGIApp:
    """Returns the application, which answers to these values of `Host`, as `localhost:80`."""
    routes = [
        Route("/{token}/", _index),
        Route("/{token}/pane/{name}", _file),
        WebSocketRoute("/{token}/socket", _socket),
    ]
    app = Starlette(routes=routes, lifespan=_working)
    app.state.host, app.state.token = host, token
    return Guard(app, addresses, token)


@asynccontextmanager
async def _working(app: Starlette) -> AsyncIterator[None]:
    """Runs the host, and watches its files, while the application runs."""
    host: Host = app.state.host
    await host.start()
    watching = asyncio.create_task(watch(host.path, host.noticed, host.noticed))
    yield
    host.close()
    watching.cancel()
    await asyncio.wait([watching])
    if not watching.cancelled():
        watching.result()


async def _index(request: Request) -> Response:
    text = (PANE / "index.html").read_text("utf-8")
    uri, nonce = request.app.state.host.uri, secrets.token_urlsafe(16)
    policy = POLICY.format(nonce=nonce)
    values = {"csp": policy, "root": "pane/", "nonce": nonce, "socket": "socket", "uri": uri}
    for name, value in values.items():
        text = text.replace(f"{{{{{name}}}}}", html.escape(value))
    headers = {**HEADERS, "Content-Security-Policy": f"{policy}; {STRICT}"}
    return Response(text, media_type="text/html", headers=headers)


@cache
def _files() -> dict[str, Path]:
    return {file.name: file for file in PANE.iterdir() if file.suffix in KINDS}


async def _file(request: Request) -> Response:
    return file_named(_files(), request.path_params["name"])


async def _socket(socket: WebSocket) -> None:
    host: Host = socket.app.state.host
    await socket.accept()
    if len(host.pages) >= MOST_PAGES:
        await socket.close(_TRY_AGAIN, f"{MOST_PAGES} pages show this program already: close one of them.")
        return
    page = host.join()
    sending = asyncio.create_task(_send(socket, page))
    try:
        await _listen(socket, host, page)
    finally:
        host.leave(page)
        sending.cancel()
        await asyncio.wait([sending])
        if not sending.cancelled():
            sending.exception()  # it could send no more


async def _send(socket: WebSocket, page: Page) -> None:
    while True:
        await socket.send_text(await page.next())


async def _listen(socket: WebSocket, host: Host, page: Page) -> None:
    """Listens until the page goes, or sends an invalid message."""
    while (message := await socket.receive())["type"] == "websocket.receive":
        text = message.get("text")
        if text is None:
            await socket.close(_NO_TEXT, "This page sent what is no text.")
            return
        if len(text) > LONGEST:
            await socket.close(_TOO_BIG, "This page sent a message that is too long.")
            return
        host.hear(page, text)


_CONNECTIONS = 8 * MOST_PAGES
"""Most connections. A browser opens some more for the files of a page; others are refused."""


def serve(host: Host, door: Door) -> None:
    make_room()
    app = site(host, door.token, door.addresses)
    door.serve(app, _CONNECTIONS, ws_max_size=LONGEST, ws_max_queue=8, ws_per_message_deflate=False)

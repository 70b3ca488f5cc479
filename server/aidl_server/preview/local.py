"""Pages for this machine alone: the door that requests come through, and the server behind it.

A page of the web that the user has open elsewhere can send requests to localhost, too. It does not know the
token that all addresses begin with, its requests name another `Host` once its own name is made to mean this
machine, and its WebSockets another `Origin`.
"""

from __future__ import annotations

import secrets
from collections.abc import Collection
from pathlib import Path
from socket import AF_INET6, socket
from typing import Any

import uvicorn
from starlette.responses import Response
from starlette.types import ASGIApp, Receive, Scope, Send
from starlette.websockets import WebSocket

PANE = Path(__file__).parent / "pane"
HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": "default-src 'none'; frame-ancestors 'none'",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}
STRICT = "frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
"""What the policy of every page ends with."""
KINDS = {".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml"}
"""Media types of the files that pages load."""
_GRACE = 1
"""Seconds that pages have to say goodbye."""


class Door:
    """A listening socket that is bound to this machine, and the token of its pages."""

    def __init__(self, listener: socket) -> None:
        self._listener = listener
        self.token = secrets.token_urlsafe(24)
        address, self._port = listener.getsockname()[:2]
        self._name = f"[{address}]" if listener.family == AF_INET6 else str(address)

    @property
    def url(self) -> str:
        return f"http://{self._name}:{self._port}/{self.token}/"

    @property
    def addresses(self) -> list[str]:
        """Returns the values of `Host` by which the pages may be called."""
        return [f"{name}:{self._port}" for name in {self._name, "localhost", "127.0.0.1", "[::1]"}]

    def serve(self, app: ASGIApp, connections: int, **options: Any) -> None:
        """Serves until it is interrupted; `options` are more of uvicorn's."""
        config = uvicorn.Config(
            app,
            log_level="warning",
            access_log=False,
            proxy_headers=False,
            server_header=False,
            limit_concurrency=connections,
            timeout_graceful_shutdown=_GRACE,
            **options,
        )
        uvicorn.Server(config).run(sockets=[self._listener])


class Guard:
    """Admits requests that call this machine by its own name and know the token."""

    def __init__(self, app: ASGIApp, addresses: Collection[str], token: str) -> None:
        self._app, self._addresses, self._token = app, frozenset(addresses), token

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        refusal = self._refusal(scope)
        if refusal is None:
            await self._app(scope, receive, send)
        elif scope["type"] == "websocket":
            await WebSocket(scope, receive, send).close()  # before it was opened: 403
        else:
            await Response(status_code=refusal, headers=HEADERS)(scope, receive, send)

    def _refusal(self, scope: Scope) -> int | None:
        headers = [(name.lower(), value.decode("latin-1")) for name, value in scope["headers"]]
        hosts = [value for name, value in headers if name == b"host"]
        if len(hosts) != 1 or hosts[0].lower() not in self._addresses:
            return 421
        origins = [value for name, value in headers if name == b"origin"]
        if any(origin.lower() != f"http://{hosts[0].lower()}" for origin in origins):
            return 403
        given = scope["path"].removeprefix("/").partition("/")[0]
        return None if secrets.compare_digest(given.encode(), self._token.encode()) else 404


def file_named(files: dict[str, Path], name: str) -> Response:
    """Returns the answer to a page that asks for one of these files."""
    file = files.get(name)
    if file is None:
        return Response(status_code=404, headers=HEADERS)
    return Response(file.read_bytes(), media_type=KINDS[file.suffix], headers=HEADERS)

"""`aidl preview` as a server: one program, on a socket that is bound to this machine."""

from __future__ import annotations

import secrets
from pathlib import Path
from socket import AF_INET6, socket

import uvicorn

from aidl_lang.tools.lsp.serve import make_room
from aidl_lang.tools.preview.files import Write
from aidl_lang.tools.preview.host import LONGEST, Host
from aidl_lang.tools.preview.site import MOST_PAGES, site

_CONNECTIONS = 8 * MOST_PAGES
"""Most connections. A browser opens some more for the files of a page; others are told that there are too
many.
"""
_GRACE = 1
"""Seconds that pages have to say goodbye."""


class Served:
    """A program shown at `url` while `run` runs."""

    def __init__(self, path: Path, write: Write, listener: socket) -> None:
        self._listener = listener
        self._token = secrets.token_urlsafe(24)
        self._host = Host(path, write)
        address, self._port = listener.getsockname()[:2]
        self._name = f"[{address}]" if listener.family == AF_INET6 else str(address)

    @property
    def url(self) -> str:
        return f"http://{self._name}:{self._port}/{self._token}/"

    def rescue(self) -> Path | None:
        """Returns where what was typed and not saved is kept, if there is any. Raises CannotError."""
        return self._host.text.rescue()

    def run(self) -> None:
        """Serves until it is interrupted."""
        make_room()
        names = {self._name, "localhost", "127.0.0.1", "[::1]"}
        config = uvicorn.Config(
            site(self._host, self._token, [f"{name}:{self._port}" for name in names]),
            log_level="warning",
            access_log=False,
            ws_max_size=LONGEST,
            ws_max_queue=8,
            ws_per_message_deflate=False,
            proxy_headers=False,
            server_header=False,
            limit_concurrency=_CONNECTIONS,
            timeout_graceful_shutdown=_GRACE,
        )
        uvicorn.Server(config).run(sockets=[self._listener])

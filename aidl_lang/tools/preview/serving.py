"""`aidl preview` as a server: one program, on a socket that is bound to this machine."""

from __future__ import annotations

from pathlib import Path
from socket import socket

from aidl_lang.tools.lsp.serve import make_room
from aidl_lang.tools.preview.files import Write
from aidl_lang.tools.preview.host import LONGEST, Host
from aidl_lang.tools.preview.local import Door
from aidl_lang.tools.preview.site import MOST_PAGES, site

_CONNECTIONS = 8 * MOST_PAGES
"""Most connections. A browser opens some more for the files of a page; others are refused."""


class Served:
    """A program shown at `url` while `run` runs."""

    def __init__(self, path: Path, write: Write, listener: socket) -> None:
        self._door = Door(listener)
        self._host = Host(path, write)

    @property
    def url(self) -> str:
        return self._door.url

    def rescue(self) -> Path | None:
        """Returns where what was typed and not saved is kept, if there is any. Raises CannotError."""
        return self._host.text.rescue()

    def run(self) -> None:
        """Serves until it is interrupted."""
        make_room()
        self._door.serve(
            site(self._host, self._door.token, self._door.addresses),
            _CONNECTIONS,
            ws_max_size=LONGEST,
            ws_max_queue=8,
            ws_per_message_deflate=False,
        )

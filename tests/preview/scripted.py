"""A host of the preview pane that does what a test says: it serves the pane and talks by a WebSocket."""

from __future__ import annotations

import html
import json
import mimetypes
import threading
from collections.abc import Callable
from http import HTTPStatus
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response
from websockets.sync.server import Server, ServerConnection, serve

PANE = Path(__file__).resolve().parents[2] / "aidl_lang" / "tools" / "preview" / "pane"
CSP = (
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
    "img-src 'self' data:; font-src 'self'"
)
PATIENCE = 10.0
"""Seconds after which what a test waits for is not coming."""

Message = dict[str, Any]


def page(root: str = "", nonce: str = "", socket: str = "socket", csp: str = CSP) -> str:
    """`index.html` as a host completes it."""
    text = (PANE / "index.html").read_text("utf-8")
    for name, value in {"csp": csp, "root": root, "nonce": nonce, "socket": socket}.items():
        text = text.replace("{{" + name + "}}", html.escape(value))
    return text


class ScriptedHost:
    """Serves until it is left. `heard` are the messages of the pane, in order."""

    def __init__(self, csp: str = CSP) -> None:
        self.csp = csp
        self.heard: list[Message] = []
        self.requests: list[str] = []
        self.is_away = False
        """Whether connections are refused."""
        self._changed = threading.Condition()
        self._connection: ServerConnection | None = None
        self._server: Server = serve(
            self._converse, "127.0.0.1", 0, process_request=self._answer, close_timeout=1
        )
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self._server.socket.getsockname()[1]}/"

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.is_away = True
        self.drop()
        self._server.shutdown()
        self._thread.join(PATIENCE)

    def say(self, message: Message) -> None:
        """Send to the pane that is connected, or to the next that is."""
        self.say_text(json.dumps(message))

    def say_text(self, text: str) -> None:
        self.wait(lambda: self._connection is not None)
        assert self._connection is not None
        self._connection.send(text)

    def drop(self) -> None:
        """End the connection."""
        connection = self._connection
        if connection is not None:
            connection.close()
            self.wait(lambda: self._connection is not connection)

    def of(self, kind: str) -> list[Message]:
        """What was heard of a type."""
        return [message for message in self.heard if message["type"] == kind]

    def hears(self, kind: str, count: int = 1) -> Message:
        """The message of a type that is so manieth, once it has come."""
        self.wait(lambda: len(self.of(kind)) >= count)
        return self.of(kind)[count - 1]

    def forget(self) -> None:
        """What was heard and asked for until now."""
        with self._changed:
            self.heard.clear()
            self.requests.clear()

    def wait(self, condition: Callable[[], bool]) -> None:
        with self._changed:
            if not self._changed.wait_for(condition, PATIENCE):
                raise TimeoutError(f"it did not come; heard were {self.heard}")

    def _converse(self, connection: ServerConnection) -> None:
        with self._changed:
            self._connection = connection
            self._changed.notify_all()
        try:
            for text in connection:
                with self._changed:
                    self.heard.append(json.loads(text))
                    self._changed.notify_all()
        except ConnectionClosed:
            pass
        finally:
            with self._changed:
                if self._connection is connection:
                    self._connection = None
                self._changed.notify_all()

    def _answer(self, connection: ServerConnection, request: Request) -> Response | None:
        path = request.path.partition("?")[0]
        self.requests.append(path)
        if path == "/socket":
            return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, "") if self.is_away else None
        if path == "/":
            return _response(page(csp=self.csp).encode(), "text/html; charset=utf-8")
        file = PANE / path.removeprefix("/")
        if "/" in path[1:] or not file.is_file():
            return connection.respond(HTTPStatus.NOT_FOUND, "")
        return _response(file.read_bytes(), mimetypes.guess_type(file.name)[0] or "text/plain")


def _response(body: bytes, kind: str) -> Response:
    headers = {"Content-Type": kind, "Content-Length": str(len(body)), "Cache-Control": "max-age=600"}
    return Response(HTTPStatus.OK, "OK", Headers({**headers, "Connection": "close"}), body)

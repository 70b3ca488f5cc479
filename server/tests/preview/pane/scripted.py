"""A host of the preview pane that does what a test says: it serves the pane and talks by a WebSocket."""

from __future__ import annotations

import html
import json
import mimetypes
import threading
from collections.abc import Callable
from http import HTTPStatus
from types import TracebackType
from typing import Any, Self

from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response
from websockets.sync.server import Server, ServerConnection, serve

from server.tests.preview.pane.messages import URI
from tests.documents import ROOT

PANE = ROOT / "server" / "aidl_server" / "preview" / "pane"
NONCE = "n0nce"
CSP = (
    f"default-src 'none'; script-src 'self'; style-src 'self' 'nonce-{NONCE}'; connect-src 'self'; "
    "img-src 'self' data:; font-src 'self'"
)
PATIENCE = 10.0
"""Seconds after which what a test waits for is not coming."""

Message = dict[str, Any]
_EDITS = {"aidl/setKnob", "aidl/drag", "aidl/fix", "aidl/undo", "aidl/redo", "aidl/save", "aidl/takeFile"}


def page(root: str = "", nonce: str = NONCE, socket: str = "socket", csp: str = CSP, uri: str = URI) -> str:
    """`index.html` as a host completes it."""
    text = (PANE / "index.html").read_text("utf-8")
    for name, value in {"csp": csp, "root": root, "nonce": nonce, "socket": socket, "uri": uri}.items():
        text = text.replace("{{" + name + "}}", html.escape(value))
    return text


class ScriptedHost:
    """Serves until it is left. `heard` are the messages of the pane, in order. It carries out edits, or says
    why not if there is a `refusal`; everything else is answered when a test says so.
    """

    def __init__(self, csp: str = CSP) -> None:
        self.csp = csp
        self.heard: list[Message] = []
        self.requests: list[str] = []
        self.refusal = ""
        self._open: list[Message] = []
        """Requests that were not answered."""
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

    def tell(self, method: str, params: Message) -> None:
        """Tell the pane that is connected, or the next that is."""
        self.say_text(json.dumps({"jsonrpc": "2.0", "method": method, "params": params}))

    def fail(self, message: str) -> None:
        """Tell what people are to know."""
        self.tell("window/showMessage", {"type": 1, "message": message})

    def is_asked(self, method: str) -> bool:
        """Whether an answer is waited for."""
        return any(request["method"] == method for request in self._open)

    def answer(self, method: str, result: object = None, error: str = "", code: int = -32803) -> None:
        """Answer what was asked last."""
        self.wait(lambda: self.is_asked(method))
        request = next(request for request in reversed(self._open) if request["method"] == method)
        self._open = [other for other in self._open if other["method"] != method]
        outcome = {"error": {"code": code, "message": error}} if error else {"result": result}
        self.say_text(json.dumps({"jsonrpc": "2.0", "id": request["id"], **outcome}))

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

    def of(self, method: str) -> list[Message]:
        """What was heard of a method."""
        return [message["params"] for message in self.heard if message["method"] == method]

    def hears(self, method: str, count: int = 1) -> Message:
        """The parameters of the message of a method that is so manieth, once it has come."""
        self.wait(lambda: len(self.of(method)) >= count)
        return self.of(method)[count - 1]

    def forget(self) -> None:
        """What was heard and asked for until now."""
        with self._changed:
            self.heard.clear()
            self.requests.clear()
            self.refusal = ""

    def wait(self, condition: Callable[[], bool]) -> None:
        with self._changed:
            if not self._changed.wait_for(condition, PATIENCE):
                raise TimeoutError(f"it did not come; heard were {self.heard}")

    def _converse(self, connection: ServerConnection) -> None:
        with self._changed:
            self._connection = connection
            self._open.clear()
            self._changed.notify_all()
        try:
            for text in connection:
                message = json.loads(text)
                with self._changed:
                    self.heard.append(message)
                    if message["method"] not in _EDITS and "id" in message:
                        self._open.append(message)
                    self._changed.notify_all()
                if message["method"] in _EDITS:
                    result = {"applied": not self.refusal, "reason": self.refusal}
                    connection.send(json.dumps({"jsonrpc": "2.0", "id": message["id"], "result": result}))
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

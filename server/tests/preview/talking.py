"""Pages of `aidl preview` without a browser: they speak JSON-RPC by a WebSocket."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from starlette.testclient import TestClient, WebSocketTestSession

    from aidl_server.preview.files import Write

TOKEN, ADDRESS = "tok-En_123", "127.0.0.1:8123"
TEXT = "param width = 60mm in 20..100\nsolid a { body = rectangle(width: width, height: 20) }\n"
CHANGED, WORDS = "aidl/previewChanged", "aidl/text"

_numbers = itertools.count(1)


def write_bytes(path: Path, data: bytes) -> None:
    path.write_bytes(data)


def serving(file: Path, write: Write = write_bytes) -> TestClient:
    from starlette.testclient import TestClient

    from aidl_server.preview.host import Host
    from aidl_server.preview.site import site

    app = site(Host(file, write), TOKEN, [ADDRESS, "localhost:8123"])
    return TestClient(app, base_url=f"http://{ADDRESS}")


class Talk:
    """A page that is open."""

    def __init__(self, socket: WebSocketTestSession, uri: str) -> None:
        self.socket, self.uri = socket, uri
        self.heard: list[dict[str, Any]] = []
        """what came while an answer was waited for"""

    def ask(self, method: str, **params: Any) -> int:
        """Asks, and does not wait for the answer to this number."""
        number = next(_numbers)
        request = {"id": number, "method": method, "params": {"uri": self.uri, **params}}
        self.socket.send_text(json.dumps({"jsonrpc": "2.0", **request}))
        return number

    def answer(self, method: str, **params: Any) -> Any:
        """What comes of asking: a result, or an error as {"error": …}."""
        return self.answered(self.ask(method, **params))

    def answered(self, number: int) -> Any:
        while (message := self._next()).get("id") != number:
            self.heard.append(message)
        return message["result"] if "result" in message else {"error": message["error"]}

    def preview(self, show: tuple[str, ...] = ()) -> dict[str, Any]:
        """The picture, as the pane asks for it."""
        made: dict[str, Any] = self.answer("aidl/preview", show=show)
        return made

    def told(self, method: str, **wanted: Any) -> dict[str, Any]:
        """What is told next of which this holds."""
        while True:
            message = self.heard.pop(0) if self.heard else self._next()
            params: dict[str, Any] = message.get("params", {})
            if message.get("method") == method and all(params.get(k) == v for k, v in wanted.items()):
                return params

    def text(self) -> dict[str, Any]:
        """What is told next of the text, with its words."""
        while (told := self.told(WORDS))["text"] is None:
            pass
        return told

    def _next(self) -> dict[str, Any]:
        message: dict[str, Any] = json.loads(self.socket.receive_text())
        return message


@contextmanager
def talking(client: TestClient, file: Path, **headers: str) -> Iterator[Talk]:
    # The client says `testserver` unless it is told.
    with client.websocket_connect(f"/{TOKEN}/socket", headers={"host": ADDRESS, **headers}) as socket:
        yield Talk(socket, file.as_uri())

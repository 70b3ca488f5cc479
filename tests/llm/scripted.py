"""A language model by script: a server on loopback that speaks OpenAI's chat protocol and Anthropic's.

    with Scripted(["a reply", Limited(), Cut("half of")]) as server:
        provider = server.provider()            # or server.provider("anthropic")
        ...
        assert server.requests[0].messages[-1].text == "an old-school telephone"

Each request takes the next step; a string is `Says(string)`, a function gets the request and gives a step.
A request beyond the last step is refused with words that say so.
"""

from __future__ import annotations

import base64
import json
import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from aidl_lang.tools.llm.messages import Image, Message
from aidl_lang.tools.llm.providers import Closable, Connection, connect

Json = dict[str, Any]
Event = tuple[str, Json | str]
"""The name of a server-sent event (empty for none) and its data."""


@dataclass(frozen=True)
class Says:
    """A whole reply. The reason it ended is in OpenAI's words: stop, length, content_filter."""

    text: str
    finish: str = "stop"
    usage: tuple[int, int] | None = (100, 10)
    """Tokens in and out; None if the server tells none."""
    cost: float | None = None
    """Dollars, as OpenRouter tells them."""
    reasoning: str = ""
    stream: bool = True
    """Otherwise one JSON document, whatever was asked for."""
    size: int = 16
    """Characters in a piece."""

    @property
    def pieces(self) -> list[str]:
        return [self.text[i : i + self.size] for i in range(0, len(self.text), self.size)]


@dataclass(frozen=True)
class Cut:
    """A stream that breaks off: the connection is lost, or (`clean`) it ends without a reason.

    The provider asks again, so the next step follows at once.
    """

    text: str
    clean: bool = False


@dataclass(frozen=True)
class Failed:
    """An error. Whoever may ask again is told to wait a millisecond, so that tests do not sleep."""

    status: int = 500
    message: str = "the server is out of order"
    code: str = ""
    wait: tuple[str, str] = ("retry-after-ms", "1")


def Limited(message: str = "too many requests") -> Failed:
    return Failed(429, message)


@dataclass(frozen=True)
class Garbage:
    """Status 200 and something else than the protocol."""

    body: str = "<html><body>Please log in</body></html>"
    content_type: str = "text/html"


@dataclass(frozen=True)
class Hangs:
    """No answer until the server is closed; `text` is sent before."""

    text: str = ""


Step = str | Says | Cut | Failed | Garbage | Hangs


@dataclass(frozen=True)
class Request:
    """What was asked, in one form for both protocols."""

    path: str
    headers: dict[str, str]
    """By names in small letters."""
    body: Json

    @property
    def is_anthropic(self) -> bool:
        return self.path.endswith("/messages")

    @property
    def messages(self) -> list[Message]:
        """With the system prompt as the first message, as it was before it was sent."""
        system = [{"role": "system", "content": self.body["system"]}] if "system" in self.body else []
        return [_message(said) for said in [*system, *self.body["messages"]]]

    @property
    def texts(self) -> list[str]:
        return [message.text for message in self.messages]


@dataclass
class Scripted:
    """The server. It listens once made; `with` or `close` ends it and every provider it gave out."""

    steps: Sequence[Step | Callable[[Request], Step]]
    models: Sequence[str] = ("test-model",)
    requests: list[Request] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._lock = threading.Lock()
        self.closing = threading.Event()
        self._providers: list[Closable] = []
        self._server = ThreadingHTTPServer(("127.0.0.1", 0), partial(_Handler, self))
        self._server.daemon_threads = False  # so that closing waits for them
        self._thread = threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.01})
        self._thread.start()

    @property
    def base_url(self) -> str:
        """For OpenAI's protocol; Anthropic's has no `/v1` at its end."""
        return f"{self.address}/v1"

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self._server.server_port}"

    @property
    def environment(self) -> dict[str, str]:
        """For a command that is to find the server by itself."""
        return {"AIDL_PROVIDER": "openai", "OPENAI_BASE_URL": self.base_url, "AIDL_MODEL": self.models[0]}

    def provider(self, kind: str = "openai", **more: Any) -> Closable:
        """Connected to this server, whatever the environment says; `more` are fields of Connection."""
        url = self.address if kind == "anthropic" else self.base_url
        wanted = {"model": self.models[0], "base_url": url, "timeout": 20.0, "retries": 2, **more}
        provider = connect(Connection(kind, **wanted), {})
        self._providers.append(provider)
        return provider

    def take(self, request: Request) -> Step:
        """Record a request and give what comes next."""
        with self._lock:
            step = self.steps[len(self.requests)] if len(self.requests) < len(self.steps) else None
            self.requests.append(request)
        if step is None:
            return Failed(400, f"the script has only {len(self.steps)} steps")
        return step(request) if callable(step) else step

    def close(self) -> None:
        self.closing.set()
        for provider in self._providers:
            provider.close()
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def __enter__(self) -> Scripted:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _message(said: Json) -> Message:
    content = said["content"]
    parts = [{"type": "text", "text": content}] if isinstance(content, str) else content
    text = "".join(part["text"] for part in parts if part["type"] == "text")
    return Message(said["role"], text, tuple(_image(part) for part in parts if part["type"] != "text"))


def _image(part: Json) -> Image:
    if part["type"] == "image":
        return Image(part["source"]["media_type"], base64.b64decode(part["source"]["data"], validate=True))
    head, _, data = part["image_url"]["url"].partition(";base64,")
    return Image(head.removeprefix("data:"), base64.b64decode(data, validate=True))


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def __init__(self, script: Scripted, *args: Any) -> None:
        self.script = script
        super().__init__(*args)

    def do_GET(self) -> None:
        if self.path == "/v1/models":
            self._json(
                200, {"object": "list", "data": [{"id": m, "object": "model"} for m in self.script.models]}
            )
        else:
            self._json(404, {"error": {"message": f"there is nothing at {self.path}"}})

    def do_POST(self) -> None:
        body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        request = Request(self.path, {k.lower(): v for k, v in self.headers.items()}, body)
        try:
            self._answer(request, self.script.take(request))
        except (BrokenPipeError, ConnectionResetError):
            self.close_connection = True  # whoever asked has gone

    def _answer(self, request: Request, step: Step) -> None:
        protocol = _Anthropic(request) if request.is_anthropic else _OpenAI(request)
        match step:
            case str():
                self._answer(request, Says(step))
            case Failed():
                error = {"message": step.message, "type": step.code or "error", "code": step.code or None}
                self._json(step.status, {"type": "error", "error": error}, step.wait)
            case Garbage(body, content_type):
                self._send(200, content_type, body.encode())
            case Says(stream=False):
                self._json(200, protocol.document(step))
            case Says():
                self._stream(protocol.events(step))
            case Cut(text, clean):
                self._stream(protocol.events(Says(text), whole=False), ends=clean)
            case Hangs(text):
                if text:
                    self._stream(protocol.events(Says(text), whole=False), ends=False)
                self.script.closing.wait()

    def _json(self, status: int, document: Json, *headers: tuple[str, str]) -> None:
        self._send(status, "application/json", json.dumps(document).encode(), *headers)

    def _send(self, status: int, content_type: str, body: bytes, *headers: tuple[str, str]) -> None:
        self._head(status, content_type, ("Content-Length", str(len(body))), *headers)
        self.wfile.write(body)

    def _stream(self, events: Iterator[Event], ends: bool = True) -> None:
        """Chunks of HTTP/1.1; one that does not end looks like a lost connection when it is closed."""
        self._head(200, "text/event-stream", ("Transfer-Encoding", "chunked"))
        for name, data in events:
            text = data if isinstance(data, str) else json.dumps(data)
            event = f"event: {name}\ndata: {text}\n\n" if name else f"data: {text}\n\n"
            self.wfile.write(f"{len(event.encode()):x}\r\n{event}\r\n".encode())
        if ends:
            self.wfile.write(b"0\r\n\r\n")

    def _head(self, status: int, content_type: str, *headers: tuple[str, str]) -> None:
        self.send_response(status)
        for header in (("Content-Type", content_type), ("Connection", "close"), *headers):
            self.send_header(*header)
        self.end_headers()

    def log_message(self, format: str, *args: Any) -> None:
        """Standard error belongs to what is tested."""


class _OpenAI:
    def __init__(self, request: Request) -> None:
        self.shared = {"id": "chatcmpl-1", "created": 0, "model": request.body.get("model")}
        self.tells_usage = (request.body.get("stream_options") or {}).get("include_usage", False)

    def events(self, step: Says, whole: bool = True) -> Iterator[Event]:
        yield self._chunk({"role": "assistant", "content": ""})
        if step.reasoning:
            yield self._chunk({"reasoning_content": step.reasoning})
        for piece in step.pieces:
            yield self._chunk({"content": piece})
        if not whole:
            return
        yield self._chunk({}, step.finish)
        if step.usage and self.tells_usage:
            yield "", {**self._frame(), "choices": [], "usage": self._usage(step)}
        yield "", "[DONE]"

    def document(self, step: Says) -> Json:
        message = {"role": "assistant", "content": step.text, "reasoning_content": step.reasoning}
        choice = {"index": 0, "message": message, "finish_reason": step.finish}
        usage = {"usage": self._usage(step)} if step.usage else {}
        return {**self.shared, "object": "chat.completion", "choices": [choice], **usage}

    def _frame(self) -> Json:
        return {**self.shared, "object": "chat.completion.chunk"}

    def _chunk(self, delta: Json, finish: str | None = None) -> Event:
        return "", {**self._frame(), "choices": [{"index": 0, "delta": delta, "finish_reason": finish}]}

    @staticmethod
    def _usage(step: Says) -> Json:
        tokens_in, tokens_out = step.usage or (0, 0)
        cost = {} if step.cost is None else {"cost": step.cost}
        total = tokens_in + tokens_out
        return {"prompt_tokens": tokens_in, "completion_tokens": tokens_out, "total_tokens": total, **cost}


_REASONS = {"stop": "end_turn", "length": "max_tokens", "content_filter": "refusal"}


class _Anthropic:
    def __init__(self, request: Request) -> None:
        self.model = request.body.get("model")

    def events(self, step: Says, whole: bool = True) -> Iterator[Event]:
        usage = {**self._usage(step), "output_tokens": 1} if step.usage else {}
        message = {**self._frame(), "content": [], "stop_reason": None, "usage": usage}
        yield "message_start", {"type": "message_start", "message": message}
        yield "ping", {"type": "ping"}
        if step.reasoning:
            delta = {"type": "thinking_delta", "thinking": step.reasoning}
            yield self._event("content_block_start", content_block={"type": "thinking", "thinking": ""})
            yield self._event("content_block_delta", delta=delta)
            yield self._event("content_block_stop")
        yield self._event("content_block_start", content_block={"type": "text", "text": ""})
        for piece in step.pieces:
            yield self._event("content_block_delta", delta={"type": "text_delta", "text": piece})
        if not whole:
            return
        yield self._event("content_block_stop")
        usage = {"output_tokens": step.usage[1]} if step.usage else {}
        delta = {"stop_reason": self._reason(step)}
        yield "message_delta", {"type": "message_delta", "delta": delta, "usage": usage}
        yield "message_stop", {"type": "message_stop"}

    def document(self, step: Says) -> Json:
        said = {"content": [{"type": "text", "text": step.text}], "stop_reason": self._reason(step)}
        return {**self._frame(), **said, "usage": self._usage(step)}

    def _frame(self) -> Json:
        return {"id": "msg_1", "type": "message", "role": "assistant", "model": self.model}

    def _event(self, kind: str, **more: Json) -> Event:
        return kind, {"type": kind, "index": 0, **more}

    def _reason(self, step: Says) -> str:
        return _REASONS.get(step.finish, step.finish)

    @staticmethod
    def _usage(step: Says) -> Json:
        """Half of the input is told as read from the cache."""
        if not step.usage:
            return {}
        cached = step.usage[0] // 2
        return {
            "input_tokens": step.usage[0] - cached,
            "cache_read_input_tokens": cached,
            "cache_creation_input_tokens": 0,
            "output_tokens": step.usage[1],
        }

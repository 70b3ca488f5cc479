"""Providers behind a server: what they have in common, and the protocols of OpenAI and Anthropic."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from difflib import get_close_matches
from types import ModuleType
from typing import Any, ClassVar
from urllib.parse import urlsplit

import httpx2

from aidl_lang.tools.llm.messages import Finish, Message, ProviderError, Reply, Sampling, Usage
from aidl_lang.tools.llm.providers import (
    DEFAULT_URL,
    UNKNOWN,
    Connection,
    Draft,
    count,
    dig,
    dollars,
    one_line,
    without_credentials,
    words,
)

# --- The HTTP client for both SDKs: it neither waits for hours nor repeats requests that were too slow.

_CONNECT = 10.0
_LONGEST_WAIT = 120.0
_AGAIN = "x-should-retry"  # both SDKs obey it
_SILENT = {_AGAIN: "false", "x-aidl-silent": "true"}


class Client(httpx2.Client):
    """A client that does not repeat requests after a timeout, which the SDKs do at a cost without effect."""

    def send(self, request: httpx2.Request, **options: Any) -> httpx2.Response:
        try:
            response = super().send(request, **options)
        except httpx2.ReadTimeout:
            return httpx2.Response(408, headers=_SILENT, request=request)
        if not _is_soon(response.headers.get("retry-after", "0")):
            response.headers[_AGAIN] = "false"
        return response

    def __del__(self) -> None:
        """Closes the client, as those do that the SDKs make for themselves."""
        if not self.is_closed:
            self.close()


def options(connection: Connection) -> dict[str, Any]:
    """Returns arguments for the constructor of either SDK's client."""
    timeout = httpx2.Timeout(connection.timeout, connect=min(_CONNECT, connection.timeout))
    client = Client(timeout=timeout, follow_redirects=True)
    return {"timeout": timeout, "max_retries": connection.retries, "http_client": client}


def _is_soon(retry_after: str) -> bool:
    """True for a number of seconds worth waiting for; it may be a date too."""
    try:
        return float(retry_after) <= _LONGEST_WAIT
    except ValueError:
        return False


# --- Common to providers behind a server: reads streams, retries broken ones, and reports failures.
#
# The SDKs of OpenAI and Anthropic have the same errors under the same names; `sdk` is either.

_SHOWN = 8
_GRAMMAR = ("grammar", "ebnf", "structured_outputs")
_TOO_LONG = ("context length", "context window", "context size", "context_length", "too long", "too large")


class _BrokenOffError(Exception):
    """Raised if the stream ended before the reply did."""


class Server(ABC):
    """A model behind a server. The connection is one that `decide` has filled in."""

    kind: ClassVar[str]
    takes_seeds = True
    takes_grammars = True

    def __init__(self, sdk: ModuleType, client: Any, connection: Connection) -> None:
        self._sdk = sdk
        self._client = client
        self._connection = connection
        self._model = connection.model
        if not self._model:
            self._model = self._only_model()

    @property
    def name(self) -> str:
        return f"{self.kind}:{self._model}"

    def close(self) -> None:
        self._client.close()

    def reply(self, messages: Sequence[Message], sampling: Sampling, hear: Callable[[str], None]) -> Reply:
        """Returns a reply, retrying broken streams; the cost of a broken one, and so the sum, is unknown."""
        spent = Usage()
        for _ in range(self._connection.retries + 1):
            draft = Draft(hear, self._model)
            try:
                with self._failures():
                    stream = self._send(messages, sampling)
                self._receive(stream, draft)
            except _BrokenOffError:
                spent = UNKNOWN
            else:
                reply = draft.reply(self._connection.price)
                return replace(reply, usage=spent + reply.usage)
        hint = "look at the server, and at what stands between you and it"
        why = f"the reply of {self.name} broke off, however often it was asked for"
        raise ProviderError("E0938", why, hint)

    @abstractmethod
    def _send(self, messages: Sequence[Message], sampling: Sampling) -> Any:
        """Sends the request and returns the SDK's stream; raises the SDK's errors."""

    @abstractmethod
    def _read(self, document: object, draft: Draft) -> None:
        """Reads one event of the stream, or the one document of a server that does not stream."""

    def _receive(self, stream: Any, draft: Draft) -> None:
        with stream:
            for document in self._documents(stream):
                self._refuse_error(document)
                self._read(document, draft)
        if not draft.started:
            raise self._not_protocol(stream)
        if draft.finish is None:
            raise _BrokenOffError

    def _documents(self, stream: Any) -> Iterator[object]:
        """Yields the events of a stream as JSON; reports all errors of reading them."""
        with self._failures():
            try:
                yield from _events(stream)
            except (httpx2.TimeoutException, self._sdk.APITimeoutError):
                raise self._silence() from None
            except (httpx2.HTTPError, self._sdk.APIConnectionError):
                raise _BrokenOffError from None
            except (ValueError, RecursionError):  # of the JSON
                raise self._not_protocol(stream) from None

    def _refuse_error(self, document: object) -> None:
        """Raises the error that some servers send in place of a reply, or in its middle."""
        if error := dig(document, "error"):
            raise self._out_of_order(self._words(error))

    @contextmanager
    def _failures(self) -> Iterator[None]:
        sdk = self._sdk
        try:
            yield
        except sdk.APIStatusError as error:
            is_silent = "x-aidl-silent" in error.response.headers
            raise (self._silence() if is_silent else self._refusal(error)) from None
        except sdk.APITimeoutError:
            raise self._silence() from None
        except sdk.APIConnectionError as error:
            why = without_credentials(one_line(str(error.__cause__)))
            message = f"there is no connection to {self._connection.address}: {why}"
            hint = "is the server running, and is the base URL right?"
            raise ProviderError("E0936", message, hint) from None
        except sdk.APIError as error:  # told in the middle of a stream
            raise self._out_of_order(self._words(error.body) or self._words(error.message)) from None
        except UnicodeEncodeError:
            raise ProviderError("E0935", "the messages hold characters that are not Unicode text") from None

    def _refusal(self, error: Any) -> ProviderError:
        status: int = error.status_code
        said = self._words(error.body)
        because = f" ({status}): {said}" if said else f" ({status})"
        if status in (401, 403):
            return ProviderError(
                "E0932", f"the key was refused{because}", f"look at {self.kind.upper()}_API_KEY"
            )
        if status in (402, 429):
            hint = "wait, or raise the limit at the provider"
            return ProviderError("E0933", f"the limit on requests is reached{because}", hint)
        if status == 404:
            return ProviderError("E0934", f"there is no model `{self._model}`{because}", *self._models_hint())
        if status < 400 or status >= 500:
            # A stream that has begun well keeps its status when an error is told in its middle.
            return self._out_of_order(said or f"status {status}")
        return ProviderError("E0935", f"the request was refused{because}", *_remedies(said.lower()))

    def _models_hint(self) -> Iterator[str]:
        try:
            known = self._models()
        except self._sdk.APIError:
            known = []
        if not known:
            yield f"is {self._connection.address} right? Most base URLs end in /v1"
            return
        near = get_close_matches(self._model, known, n=_SHOWN, cutoff=0.3) or known
        yield f"the server has {_few(near, known)}"

    def _models(self) -> list[str]:
        try:
            listed = dig(self._client.models.list().model_dump(warnings=False), "data")
        except (ValueError, AttributeError):  # something else than a list came
            return []
        ids = [one_line(dig(entry, "id")) for entry in listed] if isinstance(listed, list) else []
        return sorted(name for name in ids if name)

    def _only_model(self) -> str:
        """Returns the model of a private server that has exactly one."""
        known: list[str] = []
        if self._connection.base_url != DEFAULT_URL[self.kind]:
            with self._failures(), suppress(self._sdk.NotFoundError):
                known = self._models()
        if len(known) == 1:
            return known[0]
        self.close()
        shown = [f"{self._connection.address} has {_few(known, known)}"] if known else []
        raise ProviderError("E0930", "no model is named", "say --model NAME, or set AIDL_MODEL", *shown)

    def _silence(self) -> ProviderError:
        why = f"{self._connection.address} was silent for {self._connection.timeout:g} seconds"
        hint = "--timeout SECONDS gives it longer; a model in main memory may need minutes to read the guide"
        return ProviderError("E0937", why, hint)

    def _out_of_order(self, said: str) -> ProviderError:
        because = f": {said}" if said else ", and does not say why"
        return ProviderError("E0936", f"{self._connection.address} fails{because}", "try again later")

    def _not_protocol(self, stream: Any) -> ProviderError:
        kind = stream.response.headers.get("content-type", "nothing")
        return ProviderError(
            "E0938",
            f"{self._connection.address} sent no reply in the protocol of {self.kind} but {one_line(kind)}",
            "look at the base URL, and at what stands between you and the server",
        )

    def _words(self, error: object) -> str:
        """Returns a server's message in one line, without control characters, and without the key."""
        places = (("error", "message"), ("message",), ("detail",), ("error",))
        said = words(error) or next((text for place in places if (text := words(dig(error, *place)))), "")
        if said.lstrip().startswith("<"):
            return ""  # a page for people
        return one_line(said, self._connection.key)


def _events(stream: Any) -> Iterator[object]:
    """Yields the events of a stream, or the one document of a server that does not stream."""
    if "json" in stream.response.headers.get("content-type", ""):
        stream.response.read()
        yield stream.response.json()
        return
    for event in stream:
        dump = getattr(event, "model_dump", None)
        yield dump(warnings=False) if dump else event


def _few(names: list[str], known: list[str]) -> str:
    shown = names[:_SHOWN]
    return ", ".join([*shown, "…"] if len(shown) < len(known) else shown)


def _remedies(said: str) -> Iterator[str]:
    if any(sign in said for sign in _TOO_LONG):
        yield "guide and conversation are longer than the model reads: take one that reads more"
        yield "servers of your own: OLLAMA_CONTEXT_LENGTH=16384, llama-server -c, vllm --max-model-len"
    if "image" in said:
        yield "take a model that sees pictures, or leave --image out"
    if any(sign in said for sign in _GRAMMAR):
        yield "does --constrain name the kind of server that answers? Without it no grammar is sent"
    yield from (f"leave --{name} out" for name in ("temperature", "seed") if name in said)


# --- Servers that speak OpenAI's chat protocol: OpenAI, OpenRouter, Ollama, vLLM, llama.cpp and others.

_FINISH = {"length": Finish.CUT, "content_filter": Finish.REFUSED}
_LIMITS = ("max_tokens", "max_completion_tokens")
_NEWER = ("api.openai.com", ".openai.azure.com")


class OpenAI(Server):
    """The limit on tokens has two names.

    Newer models of OpenAI refuse the old one, and many servers do not know the new one: the host decides, and
    the new one is used when a server asks for it.
    """

    kind = "openai"

    def __init__(self, connection: Connection) -> None:
        import openai

        client = openai.OpenAI(
            api_key=connection.key or "none", base_url=connection.base_url, **options(connection)
        )
        host = urlsplit(connection.base_url).hostname or ""
        self._limit = _LIMITS[host.endswith(_NEWER)]
        self._tells_usage = True
        super().__init__(openai, client, connection)

    def _send(self, messages: Sequence[Message], sampling: Sampling) -> Any:
        said = [{"role": message.role, "content": _content(message)} for message in messages]
        while True:  # it adapts twice at most
            wanted = {
                "seed": sampling.seed,
                "temperature": sampling.temperature,
                self._limit: sampling.max_tokens,
                "stream_options": {"include_usage": True} if self._tells_usage else None,
            }
            options: dict[str, Any] = {name: v for name, v in wanted.items() if v is not None}
            try:
                return self._client.chat.completions.create(
                    model=self._model, messages=said, stream=True, extra_body=dict(sampling.extra), **options
                )
            except (self._sdk.BadRequestError, self._sdk.UnprocessableEntityError) as error:
                if not self._adapt(self._words(error.body), options):
                    raise

    def _adapt(self, said: str, sent: Mapping[str, object]) -> bool:
        """Drops what a server refused from further requests, if it is a matter of the protocol."""
        if "stream_options" in said and "stream_options" in sent:
            self._tells_usage = False
            return True
        if "max_tokens" in sent and "max_completion_tokens" in said:
            self._limit = "max_completion_tokens"
            return True
        return False

    def _read(self, document: object, draft: Draft) -> None:
        choice = dig(document, "choices", 0)
        said = dig(choice, "delta") or dig(choice, "message")
        draft.started |= isinstance(dig(document, "choices"), list)
        draft.model = one_line(dig(document, "model")) or draft.model
        draft.say(_text(dig(said, "content")))
        if refusal := words(dig(said, "refusal")):
            draft.say(refusal)
            draft.finish = Finish.REFUSED
        self._refuse_error(choice)
        reason = words(dig(choice, "finish_reason"))
        if reason or dig(choice, "message") is not None:
            draft.finish = draft.finish or _FINISH.get(reason, Finish.COMPLETE)
        if usage := dig(document, "usage"):
            draft.usage = Usage(
                count(dig(usage, "prompt_tokens")),
                count(dig(usage, "completion_tokens")),
                dollars(dig(usage, "cost")),
            )


def _content(message: Message) -> str | list[dict[str, object]]:
    """Returns text alone as a string, which is all that some servers take."""
    if not message.images:
        return message.text
    pictures: list[dict[str, object]] = [
        {"type": "image_url", "image_url": {"url": image.uri}} for image in message.images
    ]
    return [*pictures, {"type": "text", "text": message.text}]


def _text(content: object) -> str:
    """Returns the text of a content that is a string, or a list of parts, of which some may be reasoning."""
    if isinstance(content, list):
        return "".join(words(dig(part, "text")) for part in content if dig(part, "type") == "text")
    return words(content)


# --- Anthropic's messages API.

MAX_TOKENS = 8192
"""The default limit: the API wants one, and every model allows at least this."""

_FINISH_ANTHROPIC = {
    "max_tokens": Finish.CUT,
    "model_context_window_exceeded": Finish.CUT,
    "refusal": Finish.REFUSED,
}
_INPUT = ("input_tokens", "cache_read_input_tokens", "cache_creation_input_tokens")


class Anthropic(Server):
    """The system prompt, which is long and the same every time, is kept in Anthropic's cache.

    The input counted is all that was read, from the cache or not.
    """

    kind = "anthropic"
    takes_seeds = False
    takes_grammars = False

    def __init__(self, connection: Connection) -> None:
        import anthropic

        client = anthropic.Anthropic(
            api_key=connection.key or "none",
            base_url=connection.base_url.removesuffix("/v1"),
            **options(connection),
        )
        super().__init__(anthropic, client, connection)

    def _send(self, messages: Sequence[Message], sampling: Sampling) -> Any:
        if sampling.seed is not None:
            raise ProviderError("E0935", "Anthropic's API takes no seed", "leave --seed out")
        system = "\n\n".join(message.text for message in messages if message.role == "system")
        cached = {"type": "text", "text": system, "cache_control": {"type": "ephemeral"}}
        # Older models take a temperature; the SDK no longer knows of it, and newer ones refuse it.
        heat = {} if sampling.temperature is None else {"temperature": sampling.temperature}
        return self._client.messages.create(
            model=self._model,
            max_tokens=sampling.max_tokens or MAX_TOKENS,
            messages=[_turn(message) for message in messages if message.role != "system"],
            stream=True,
            extra_body={**heat, **sampling.extra},
            **({"system": [cached]} if system else {}),
        )

    def _read(self, document: object, draft: Draft) -> None:
        match dig(document, "type"):
            case "message":  # of a server that does not stream
                self._start(document, draft)
                parts = dig(document, "content")
                for part in parts if isinstance(parts, list) else ():
                    draft.say(words(dig(part, "text")))
                self._end(dig(document, "stop_reason") or "end_turn", draft)
            case "message_start":
                self._start(dig(document, "message"), draft)
            case "content_block_start":
                draft.say(words(dig(document, "content_block", "text")))
            case "content_block_delta":
                draft.say(words(dig(document, "delta", "text")))
            case "message_delta":
                self._count(dig(document, "usage"), draft)
                self._end(dig(document, "delta", "stop_reason"), draft)

    def _start(self, message: object, draft: Draft) -> None:
        draft.started = True
        draft.model = one_line(dig(message, "model")) or draft.model
        self._count(dig(message, "usage"), draft)

    @staticmethod
    def _end(reason: object, draft: Draft) -> None:
        if reason:
            draft.finish = _FINISH_ANTHROPIC.get(words(reason), Finish.COMPLETE)

    @staticmethod
    def _count(usage: object, draft: Draft) -> None:
        """Adds the counts of an event, which are running totals of those that have changed."""
        read = [n for name in _INPUT if (n := count(dig(usage, name))) is not None]
        written = count(dig(usage, "output_tokens"))
        known = draft.usage
        draft.usage = Usage(
            sum(read) if read else known.input, known.output if written is None else written, None
        )


def _turn(message: Message) -> dict[str, object]:
    pictures: list[dict[str, object]] = [
        {"type": "image", "source": {"type": "base64", "media_type": image.media_type, "data": image.base64}}
        for image in message.images
    ]
    text = message.text if message.text.strip() else "(nothing)"  # the API refuses an empty text
    return {"role": message.role, "content": [*pictures, {"type": "text", "text": text}]}

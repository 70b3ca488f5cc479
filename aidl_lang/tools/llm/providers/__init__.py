"""Providers: servers that speak OpenAI's protocol, Anthropic's, or a command; and constrained decoding."""

from __future__ import annotations

import codecs
import json
import math
import os
import re
import selectors
import shlex
import signal
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import field, replace
from typing import IO, Protocol
from urllib.parse import urlsplit

from aidl_lang.common.diagnostics import has_errors
from aidl_lang.common.prose import shortened
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.tools.grammars import export
from aidl_lang.tools.llm.messages import Finish, Message, Provider, ProviderError, Reply, Sampling, Usage

# --- Chooses the model and its server from options and the environment.

OPENAI, ANTHROPIC, EXEC = "openai", "anthropic", "exec:"
DEFAULT_URL = {OPENAI: "https://api.openai.com/v1", ANTHROPIC: "https://api.anthropic.com"}

_WAYS = (
    "OPENAI_API_KEY=… or ANTHROPIC_API_KEY=… in the environment, and --model NAME",
    "--base-url http://localhost:11434/v1 --model NAME asks a server of your own (Ollama, vLLM, llama.cpp)",
    "--provider 'exec:COMMAND' asks a command",
    "AIDL_PROVIDER, AIDL_MODEL and OPENAI_BASE_URL say the same in the environment",
)


@record()
class Price:
    """Dollars per million tokens."""

    input: float
    output: float

    @classmethod
    def parse(cls, text: str) -> Price:
        """Parses `IN/OUT`, as in `2.5/10`; raises ValueError."""
        numbers = [float(part.strip().removeprefix("$")) for part in text.split("/")]
        if len(numbers) != 2 or not all(0 <= number < math.inf for number in numbers):
            raise ValueError(f"expected dollars per million tokens in and out, as in 2.5/10, not `{text}`")
        return cls(*numbers)

    def of(self, usage: Usage) -> float | None:
        if usage.input is None or usage.output is None:
            return None
        return (usage.input * self.input + usage.output * self.output) / 1e6


@record()
class Connection:
    """The options for a model; empty ones are left to the environment.

    provider  `openai` for every server that speaks OpenAI's protocol, `anthropic`, or `exec:COMMAND`
    timeout   seconds without a sign of life
    retries   how often a request is repeated when the server is busy, fails, or loses the connection
    price     used if the server does not report the cost of a reply
    """

    provider: str = ""
    model: str = ""
    base_url: str = ""
    timeout: float = 600.0
    retries: int = 3
    price: Price | None = None
    key: str = ""

    @property
    def address(self) -> str:
        """The base URL as it may be shown."""
        return without_credentials(self.base_url)


def without_credentials(text: str) -> str:
    """Returns a text without the user, the password and the query of a URL in it."""
    return re.sub(r"\?[^\s#]+", "?…", re.sub(r"(^|//)[^/\s]*@", r"\1…@", text))


def decide(said: Connection, environment: Mapping[str, str]) -> Connection:
    """Returns the connection completed from the environment; only `model` may stay empty."""
    provider = said.provider or environment.get("AIDL_PROVIDER", "") or _by_environment(said, environment)
    if not provider.startswith(EXEC) and provider not in DEFAULT_URL:
        raise ProviderError(
            "E0930", f"there is no provider `{provider}`", "there are openai, anthropic and exec:COMMAND"
        )
    decided = replace(
        said,
        provider=provider,
        model=said.model or environment.get("AIDL_MODEL", ""),
        price=said.price or _price(environment.get("AIDL_PRICE", "")),
    )
    return decided if provider.startswith(EXEC) else _server(decided, environment)


def _by_environment(said: Connection, environment: Mapping[str, str]) -> str:
    if said.base_url:
        return OPENAI
    found = [
        kind
        for kind in (OPENAI, ANTHROPIC)
        if any(environment.get(f"{kind.upper()}_{what}") for what in ("API_KEY", "BASE_URL"))
    ]
    if not found:
        raise ProviderError("E0930", "nothing says which language model to ask", *_WAYS)
    if len(found) > 1:
        hint = "say --provider openai or --provider anthropic, or set AIDL_PROVIDER"
        raise ProviderError("E0930", "the environment speaks for two providers, openai and anthropic", hint)
    return found[0]


def _server(decided: Connection, environment: Mapping[str, str]) -> Connection:
    prefix = decided.provider.upper()
    key = decided.key or environment.get(f"{prefix}_API_KEY", "").strip()
    given = decided.base_url or environment.get(f"{prefix}_BASE_URL", "").strip()
    if given and not _is_address(given):
        hint = "it starts with http:// or https://, as http://localhost:11434/v1"
        raise ProviderError("E0930", f"`{without_credentials(given)}` is no base URL", hint)
    if not key and not given:
        ways = f"set {prefix}_API_KEY", "a server of your own needs no key: name it with --base-url"
        raise ProviderError("E0932", f"there is no key for {decided.provider}", *ways)
    if not key.isascii() or not key.isprintable():
        raise ProviderError(
            "E0932", f"{prefix}_API_KEY holds characters that no key has", "copy the key again"
        )
    return replace(decided, key=key, base_url=(given or DEFAULT_URL[decided.provider]).rstrip("/"))


def _is_address(url: str) -> bool:
    try:
        parts = urlsplit(url)
        _ = parts.port  # raises when it is not a number
    except ValueError:
        return False
    return parts.scheme in ("http", "https") and bool(parts.hostname)


def _price(text: str) -> Price | None:
    if not text:
        return None
    try:
        return Price.parse(text)
    except ValueError:
        raise ProviderError(
            "E0930", f"AIDL_PRICE is `{text}`", "it has dollars per million tokens in and out, as in 2.5/10"
        ) from None


class Closable(Provider, Protocol):
    def close(self) -> None:
        """Releases connections; without it they go with the object."""


def connect(said: Connection, environment: Mapping[str, str] = os.environ) -> Closable:
    """Returns the provider that options and environment name; raises ProviderError if they name none.

    Without a model a server of one's own is asked for its list, and its one model is taken; `name` tells it.
    """
    connection = decide(said, environment)
    if connection.provider.startswith(EXEC):
        return Command(connection)
    try:
        from aidl_lang.tools.llm.providers.server import Anthropic, OpenAI

        return (Anthropic if connection.provider == ANTHROPIC else OpenAI)(connection)
    except ImportError as error:
        missing = f"the package `{error.name}` is not installed" if error.name else str(error)
        raise ProviderError("E0931", missing, "pip install 'aidl-lang[models]'") from None


# --- A reply while it arrives, and what is read of a document from outside.

MAX_TEXT = 1_000_000
"""Most characters; a program has thousands. A looping model would go on for ever."""

_LINE = 300
UNKNOWN = Usage(None, None, None)


@record(frozen=False)
class Draft:
    """The reply so far; `finish` stays None until it has ended."""

    hear: Callable[[str], None]
    model: str
    usage: Usage = UNKNOWN
    finish: Finish | None = None
    started: bool = False
    """True once anything came that belongs to the protocol."""

    _pieces: list[str] = field(default_factory=list)
    _length: int = 0

    def say(self, text: str) -> None:
        if not text:
            return
        self._length += len(text)
        if self._length > MAX_TEXT:
            raise too_long()
        self._pieces.append(text)
        self.hear(text)

    @property
    def text(self) -> str:
        return "".join(self._pieces)

    def reply(self, price: Price | None) -> Reply:
        usage = self.usage
        if usage.cost is None and price is not None:
            usage = replace(usage, cost=price.of(usage))
        return Reply(self.text, usage, self.finish or Finish.COMPLETE, self.model)


def too_long() -> ProviderError:
    hint = "the model repeats itself: set --max-tokens, or take another model"
    return ProviderError("E0938", f"the reply has more than {MAX_TEXT:,} characters", hint)


def dig(value: object, *path: str | int) -> object:
    """Returns the value at a place in a JSON document; None without such a place."""
    for step in path:
        if isinstance(value, dict) and isinstance(step, str):
            value = value.get(step)
        elif isinstance(value, list) and isinstance(step, int) and step < len(value):
            value = value[step]
        else:
            return None
    return value


def words(value: object) -> str:
    """Returns a text of a document; "" for another value."""
    return value if isinstance(value, str) else ""


def one_line(value: object, secret: str = "") -> str:
    """Returns a text from outside as a short line to show, without control characters and without the key."""
    text = words(value)
    if secret:
        text = text.replace(secret, "…")
    return shortened(" ".join("".join(c if c.isprintable() else " " for c in text).split()), _LINE)


def count(value: object) -> int | None:
    """Returns a number of tokens; None for another value."""
    return value if isinstance(value, int) and not isinstance(value, bool) and value >= 0 else None


def dollars(value: object) -> float | None:
    """Returns a sum of money; None for another value."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return float(value) if 0 <= value < math.inf else None


# --- A command in place of a server: it reads one JSON document and writes the reply.

_BLOCK = 65_536
_TAIL = 2_000
_LINES = 3
_OTHERS = tuple(f"{kind.upper()}_" for kind in DEFAULT_URL)
"""Beginnings of variables that are for other providers, as those of their keys."""


class Command:
    """`exec:COMMAND`, split as a shell would but not run by one. It is started anew for every reply."""

    takes_seeds = True
    takes_grammars = True

    def __init__(self, connection: Connection) -> None:
        self.name = connection.provider
        self._connection = connection
        try:
            self._command = shlex.split(connection.provider.removeprefix(EXEC))
        except ValueError as error:
            raise ProviderError("E0930", f"`{self.name}` cannot be split into words: {error}") from None
        if not self._command:
            raise ProviderError("E0930", "`exec:` names no command", "as in 'exec:python reply.py'")
        if os.name != "posix":
            raise ProviderError("E0936", "commands are run on Linux, macOS and other POSIX systems only")

    def close(self) -> None:
        """Nothing is kept between replies."""

    def reply(self, messages: Sequence[Message], sampling: Sampling, hear: Callable[[str], None]) -> Reply:
        asked = json.dumps(_document(messages, sampling, self._connection.model))
        # A file instead of a pipe: a command that does not read it holds nothing up.
        with tempfile.TemporaryFile() as file:
            file.write(asked.encode())
            file.seek(0)
            with self._running(file) as process:
                return self._receive(process, hear)

    @contextmanager
    def _running(self, asked: IO[bytes]) -> Iterator[subprocess.Popen[bytes]]:
        """Runs the process in a group of its own; kills the whole group if it does not end."""
        pipe = subprocess.PIPE
        try:
            process = subprocess.Popen(
                self._command,
                stdin=asked,
                stdout=pipe,
                stderr=pipe,
                start_new_session=True,
                env={name: value for name, value in os.environ.items() if not name.startswith(_OTHERS)},
            )
        except (OSError, ValueError) as error:
            why = f"`{self._command[0]}` cannot be run: {getattr(error, 'strerror', None) or error}"
            hint = "is the path right, and may it be executed? A script may want `python` or `sh` before it"
            raise ProviderError("E0936", why, hint) from None
        with process:
            try:
                yield process
            except BaseException:
                with suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)
                raise

    def _receive(self, process: subprocess.Popen[bytes], hear: Callable[[str], None]) -> Reply:
        draft = Draft(_unless_json(hear), self._connection.model or self.name)
        decode = codecs.getincrementaldecoder("utf-8")().decode
        said_beside = b""
        try:
            for is_output, block in self._blocks(process):
                if is_output:
                    draft.say(decode(block))
                else:
                    said_beside = (said_beside + block)[-_TAIL:]
            draft.say(decode(b"", True))
            code = process.wait(self._connection.timeout)
        except UnicodeDecodeError:
            raise self._unusable("its output is not UTF-8 text", said_beside) from None
        except subprocess.TimeoutExpired:
            raise self._silence(said_beside) from None
        if code:
            ending = f"exit code {code}" if code > 0 else signal.Signals(-code).name
            raise ProviderError("E0936", f"`{self.name}` ended with {ending}", *_last(said_beside))
        if not draft.text.strip():
            raise self._unusable("it wrote nothing", said_beside)
        return self._finished(draft, hear)

    def _blocks(self, process: subprocess.Popen[bytes]) -> Iterator[tuple[bool, bytes]]:
        """Yields output until standard output is closed, with True for standard output."""
        total = 0
        with selectors.DefaultSelector() as pipes:
            for pipe in (process.stdout, process.stderr):
                assert pipe
                pipes.register(pipe, selectors.EVENT_READ, pipe is process.stdout)
            while any(key.data for key in pipes.get_map().values()):
                ready = pipes.select(self._connection.timeout)
                if not ready:
                    raise self._silence(b"")
                # Standard error first, so that what was said is known when the output ends.
                for key, _ in sorted(ready, key=lambda pair: bool(pair[0].data)):
                    block = os.read(key.fd, _BLOCK)
                    total += len(block)
                    if total > 4 * MAX_TEXT:
                        raise too_long()
                    if not block:
                        pipes.unregister(key.fileobj)
                    yield key.data, block
            yield from ((False, os.read(key.fd, _BLOCK)) for key, _ in pipes.select(0))

    def _finished(self, draft: Draft, hear: Callable[[str], None]) -> Reply:
        """Returns the reply as written, or the `text` of a JSON object."""
        document = _parsed(draft.text)
        if dig(document, "text") is None:
            if draft.text.lstrip().startswith("{"):
                hear(draft.text)
            return draft.reply(self._connection.price)
        whole = Draft(hear, one_line(dig(document, "model")) or draft.model)
        text, finish = dig(document, "text"), dig(document, "finish") or "complete"
        if not isinstance(text, str):
            raise self._unusable("`text` in its JSON is not a string", b"")
        if not isinstance(finish, str) or finish not in set(Finish):
            raise self._unusable(f"`finish` in its JSON is none of {', '.join(Finish)}", b"")
        whole.say(text)
        whole.finish = Finish(finish)
        usage = dig(document, "usage")
        whole.usage = Usage(
            count(dig(usage, "input")), count(dig(usage, "output")), dollars(dig(usage, "cost"))
        )
        return whole.reply(self._connection.price)

    def _unusable(self, why: str, said: bytes) -> ProviderError:
        return ProviderError("E0938", f"the reply of `{self.name}` cannot be used: {why}", *_last(said))

    def _silence(self, said: bytes) -> ProviderError:
        why = f"`{self.name}` was silent for {self._connection.timeout:g} seconds and was stopped"
        return ProviderError("E0937", why, "--timeout SECONDS gives it longer", *_last(said))


def _document(messages: Sequence[Message], sampling: Sampling, model: str) -> dict[str, object]:
    return {
        "messages": [
            {"role": said.role, "content": said.text, "images": [image.uri for image in said.images]}
            for said in messages
        ],
        "sampling": {
            "seed": sampling.seed,
            "temperature": sampling.temperature,
            "max_tokens": sampling.max_tokens,
            **sampling.extra,
        },
        "model": model,
    }


def _unless_json(hear: Callable[[str], None]) -> Callable[[str], None]:
    """Passes on text at once, unless it starts like JSON: then its text at the end."""
    first = ""

    def pass_on(piece: str) -> None:
        nonlocal first
        first = first or piece.lstrip()[:1]
        if first != "{":
            hear(piece)

    return pass_on


def _parsed(text: str) -> object:
    try:
        return json.loads(text)
    except (ValueError, RecursionError):  # a reply may be anything
        return None


def _last(said: bytes) -> list[str]:
    lines = [line for text in said.decode(errors="replace").splitlines() if (line := one_line(text))]
    return [f"it said: {line}" for line in lines[-_LINES:]]


# --- Constrained decoding: the grammar goes with each request, in the form that a kind of server reads.

_MEMBERS: dict[str, Callable[[str], dict[str, object]]] = {
    "llama.cpp": lambda grammar: {"grammar": grammar},
    "sglang": lambda grammar: {"ebnf": grammar},
    "vllm": lambda grammar: {"structured_outputs": {"grammar": grammar}},
}
_ENGINE = ":llguidance"
SERVERS = (*_MEMBERS, *(kind + _ENGINE for kind in _MEMBERS))
"""Kinds of servers: plain, and with llguidance as the engine that decodes."""

_REPLY = re.compile(r"(?:(?!```).)*^```aidl\r?\n(?P<program>.*)```\s*", re.M | re.S)


def members(server: str, fenced: bool = True) -> Mapping[str, object]:
    """Returns more members of a request to one of SERVERS; without `fenced` the reply is a bare program."""
    format = "llguidance" if server.endswith(_ENGINE) else "gbnf"
    return _MEMBERS[server.removesuffix(_ENGINE)](export(format, fenced))


class Constrained:
    """A provider whose server keeps the model to the grammar, free text first.

    Servers ignore members of a request that they do not know. So a complete reply is checked, and one that
    the grammar does not allow is an error.
    """

    def __init__(self, provider: Closable, server: str) -> None:
        """Raises ProviderError for a provider that takes no grammar."""
        if not provider.takes_grammars:
            raise ProviderError("E0950", f"{provider.name} takes no grammar", "leave --constrain out")
        self.name = f"{provider.name} (constrained: {server})"
        self.takes_seeds, self.takes_grammars = provider.takes_seeds, True
        self._provider = provider
        self._members = members(server)

    def close(self) -> None:
        self._provider.close()

    def reply(self, messages: Sequence[Message], sampling: Sampling, hear: Callable[[str], None]) -> Reply:
        asked = replace(sampling, extra={**sampling.extra, **self._members})
        reply = self._provider.reply(messages, asked, hear)
        if reply.finish is not Finish.COMPLETE:
            return reply
        # free text and one block, whose program has no errors of syntax
        found = _REPLY.fullmatch(reply.text)
        if found is None or has_errors(parse(SourceFile("", found["program"])).diagnostics):
            raise ProviderError(
                "E0951",
                f"the reply of {self._provider.name} does not keep to the grammar: "
                f"`{', '.join(self._members)}` in the request was not heeded",
                f"does --constrain name the kind of server that answers? It knows {', '.join(SERVERS)}",
                "without --constrain, mistakes of syntax are told to the model",
            )
        return reply

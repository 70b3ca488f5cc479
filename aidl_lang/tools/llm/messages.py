"""Messages to and from a language model, for all providers."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from enum import StrEnum
from typing import Literal, Protocol

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record

Role = Literal["system", "user", "assistant"]


@record()
class Image:
    """A picture as part of a message, with its media type (`image/png`)."""

    media_type: str
    data: bytes

    @property
    def base64(self) -> str:
        return b64encode(self.data).decode()

    @property
    def uri(self) -> str:
        """The picture as a data URI."""
        return f"data:{self.media_type};base64,{self.base64}"


@record()
class Message:
    role: Role
    text: str
    images: tuple[Image, ...] = ()


@record()
class Sampling:
    """Parameters of a reply. None leaves them to the server."""

    seed: int | None = None
    temperature: float | None = None
    max_tokens: int | None = None
    extra: Mapping[str, object] = field(default_factory=dict)
    """Further members of the request, as a grammar for servers that constrain decoding."""


@record()
class Usage:
    """Tokens, and dollars where they are known; None is unknown, and stays so in a sum."""

    input: int | None = 0
    output: int | None = 0
    cost: float | None = 0.0

    def __add__(self, other: Usage) -> Usage:
        unknown = None in (self.cost, other.cost)
        return Usage(
            _total(self.input, other.input),
            _total(self.output, other.output),
            None if unknown else (self.cost or 0.0) + (other.cost or 0.0),
        )


def _total(a: int | None, b: int | None) -> int | None:
    return None if a is None or b is None else a + b


class Finish(StrEnum):
    """The reason why a reply ended."""

    COMPLETE = "complete"
    CUT = "cut"  # at the limit on tokens
    REFUSED = "refused"


@record()
class Reply:
    text: str
    usage: Usage
    finish: Finish
    model: str
    """The model that answered, as the server names it."""

    seconds: float | None = None
    """Time until the whole reply was there."""

    date: str | None = None
    """The day of the reply, as in 2026-01-31."""


class ProviderError(Exception):
    """Raised if no reply could be had after all retries; the diagnostic gives the reason and a remedy."""

    def __init__(self, code: str, message: str, *hints: str) -> None:
        super().__init__(message)
        self.diagnostic = Diagnostic(code, message, hints=hints)


class ConversationOver(Exception):  # noqa: N818 (what came of it, no error of ours)
    """Raised by a provider that has no further reply and is not to be asked again: a recording that ends."""


class Provider(Protocol):
    """The source of replies: a server or a command."""

    @property
    def name(self) -> str:
        """Its name for people and records: `openai:gpt-5`, `exec:./reply.py`; without any key."""

    @property
    def takes_seeds(self) -> bool:
        """True if a request may contain a seed."""

    @property
    def takes_grammars(self) -> bool:
        """True if a request may contain a grammar for the reply."""

    def reply(self, messages: Sequence[Message], sampling: Sampling, hear: Callable[[str], None]) -> Reply:
        """Ask for the next message. `hear` gets the pieces of the text as they arrive.

        A reply that breaks off is asked for again, and its pieces are heard from the beginning.

        Raises ProviderError or ConversationOver. May be called from several threads at once.
        """

"""A reply while it arrives."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import field, replace

from aidl_lang.common.records import record
from aidl_lang.tools.llm.messages import Finish, ProviderError, Reply, Usage
from aidl_lang.tools.llm.providers.connection import Price

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
        """Returns the complete reply."""
        usage = self.usage
        if usage.cost is None and price is not None:
            usage = replace(usage, cost=price.of(usage))
        return Reply(self.text, usage, self.finish or Finish.COMPLETE, self.model)


def too_long() -> ProviderError:
    return ProviderError(
        "E0938",
        f"the reply has more than {MAX_TEXT:,} characters",
        "the model repeats itself: set --max-tokens, or take another model",
    )


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
    line = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    return line if len(line) <= _LINE else line[: _LINE - 1] + "…"


def count(value: object) -> int | None:
    """Returns a number of tokens; None for another value."""
    return value if isinstance(value, int) and not isinstance(value, bool) and value >= 0 else None


def dollars(value: object) -> float | None:
    """Returns a sum of money; None for another value."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return float(value) if 0 <= value < math.inf else None

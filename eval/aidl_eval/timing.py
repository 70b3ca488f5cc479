"""What a reply took, and when it came."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime

from aidl_lang.tools.llm.messages import Message, Provider, Reply, Sampling


@dataclass(frozen=True)
class Timed:
    """A provider whose replies carry their seconds and their day (UTC). Repeats and pauses count."""

    provider: Provider

    @property
    def name(self) -> str:
        return self.provider.name

    @property
    def takes_seeds(self) -> bool:
        return self.provider.takes_seeds

    @property
    def takes_grammars(self) -> bool:
        return self.provider.takes_grammars

    def reply(self, messages: Sequence[Message], sampling: Sampling, hear: Callable[[str], None]) -> Reply:
        begun = time.monotonic()
        reply = self.provider.reply(messages, sampling, hear)
        today = datetime.now(UTC).date().isoformat()
        return replace(reply, seconds=round(time.monotonic() - begun, 3), date=today)

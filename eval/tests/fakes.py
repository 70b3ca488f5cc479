"""Languages and programs for the tests of the runner, in a module that worker processes can import."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass, field

from aidl_lang.tools.llm.messages import Verdict


@dataclass(frozen=True)
class Fake:
    """Its programs are words: `hang`, `die`, `raise`, `eat`, or anything else, which is valid."""

    name: str = "fake"
    suffix: str = ".fake"
    fences: tuple[str, ...] = ("fake",)

    def guide(self) -> str:
        return "Say a word."

    def reads(self, text: str) -> bool:
        return obey(text)

    def conversation(self, before: str | None = None) -> FakeConversation:
        return FakeConversation([before] if before else [])


@dataclass
class FakeConversation:
    heard: list[str] = field(default_factory=list)

    def judge(self, program: str) -> Verdict:
        obey(program)
        self.heard.append(program)
        return Verdict(True, "done", "", program, missing=tuple(self.heard), weight=(len(self.heard),))

    def finish(self, verdict: Verdict) -> Verdict:
        return Verdict(True, "finished", "", verdict.program, missing=tuple(self.heard))


def obey(program: str) -> bool:
    if program == "hang":
        time.sleep(600)
    if program == "die":
        os._exit(1)
    if program == "raise":
        raise RuntimeError("no such luck")
    if program == "eat":
        return bool(bytearray(64 << 30))
    return True

"""The interface between a conversation and the language of its programs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import TYPE_CHECKING, Protocol

from aidl_lang.common.records import record
from aidl_lang.tools.llm.messages import Image

if TYPE_CHECKING:
    from aidl_lang.pipeline import Compiled


@record()
class Verdict:
    """The judgement of one program."""

    ok: bool
    stage: str
    """The stage that failed, or `done`."""

    feedback: str
    """For the model: the errors and their remedies; for a right program, remarks or nothing."""

    program: str
    """The program after mending."""

    fixes: tuple[str, ...] = ()
    """The titles of the fixes that were made."""

    codes: tuple[str, ...] = ()
    """The codes of the errors left."""

    is_partial: bool = False
    """True for a program to be continued: the model is shown its state, and asked to go on."""

    images: tuple[Image, ...] = ()
    """Pictures that go with the feedback."""

    missing: tuple[str, ...] = ()
    """Intents of earlier programs of the conversation that this one lost, a phrase each."""

    weight: tuple[int, ...] = ()
    """Distance from right, to choose the best of several: less is better."""

    numbers: Mapping[str, float] = field(default_factory=dict)
    """Counts of structures, constraints, degrees."""

    compiled: Compiled | None = None


class Conversation(Protocol):
    """Judges the programs of one conversation in turn; remembers the intents of earlier ones."""

    def judge(self, program: str) -> Verdict: ...

    def finish(self, verdict: Verdict) -> Verdict:
        """Returns the last verdict on the kept program, with everything lost put back that fits."""


class Language(Protocol):
    @property
    def name(self) -> str:
        """`full`, `no-hierarchy`, `no-constraints`, `openscad`."""

    @property
    def suffix(self) -> str:
        """The suffix of its files: `.aidl`."""

    @property
    def fences(self) -> tuple[str, ...]:
        """Names after the opening fence of a block that may hold a program, in small letters."""

    def guide(self) -> str:
        """The system prompt."""

    def reads(self, text: str) -> bool:
        """Tells whether a text without a fence is a program."""

    def conversation(self, before: str | None = None) -> Conversation:
        """Returns a new conversation; `before` is the program to be changed, if any."""

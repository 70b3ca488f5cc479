"""What a conversation needs to know of the language that the programs are written in."""

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
    """What there is to say of one program."""

    ok: bool
    stage: str
    """How far it came: the stage that failed, or `done`."""

    feedback: str
    """For the model: what is wrong and how to mend it; for a program that is right, remarks or nothing."""

    program: str
    """The program after mending; as it came where nothing was mended."""

    fixes: tuple[str, ...] = ()
    """The titles of the fixes that were made."""

    codes: tuple[str, ...] = ()
    """The codes of the errors left."""

    is_partial: bool = False
    """It says that it is to be continued: the model is shown how far it has come, and asked to go on."""

    images: tuple[Image, ...] = ()
    """Pictures that go with the feedback."""

    missing: tuple[str, ...] = ()
    """What earlier programs of the conversation meant and this one lost, a phrase each."""

    weight: tuple[int, ...] = ()
    """How far it is from right, to choose the best of several: less is better."""

    numbers: Mapping[str, float] = field(default_factory=dict)
    """What was counted: structures, constraints, degrees."""

    compiled: Compiled | None = None


class Conversation(Protocol):
    """Judges the programs of one conversation in turn; it remembers what earlier ones meant."""

    def judge(self, program: str) -> Verdict: ...

    def finish(self, verdict: Verdict) -> Verdict:
        """The last word on the program that is kept: what can be put back into it is."""


class Language(Protocol):
    @property
    def name(self) -> str:
        """`full`, `no-hierarchy`, `no-constraints`, `openscad`."""

    @property
    def suffix(self) -> str:
        """Of its files: `.aidl`."""

    @property
    def fences(self) -> tuple[str, ...]:
        """Names after the opening fence of a block that may hold a program, in small letters."""

    def guide(self) -> str:
        """The system prompt."""

    def reads(self, text: str) -> bool:
        """Whether a text without a fence is a program."""

    def conversation(self, before: str | None = None) -> Conversation:
        """A new one; `before` is the program that is to be changed, if one is."""

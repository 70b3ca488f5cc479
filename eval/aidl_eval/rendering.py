"""The interface of the languages beside AIDL: what they are written in, how they run, and what comes out.

A language gives its guide, the numbers of a program that can be turned, and runs a program with some of them
turned: errors worded for a model, or regions. All else (judging, measuring, editing, drawing) is the same.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from aidl_eval.regions import Regions
from aidl_lang.tools.llm.messages import Verdict

SECONDS = 30
"""Seconds that a program may run."""
MEMORY, OUTPUT = 4 << 30, 32 << 20
"""Most bytes of memory that it may take, and that it may write."""
LARGEST = 1e9
"""What a coordinate must stay below."""
NOTHING = "error: nothing is drawn"
UNBOUNDED = "error: a coordinate is not a finite number, or too large"
_SHOWN = 8
"""Most messages that the model is shown."""


@dataclass(frozen=True)
class Rendered:
    """The result of a program: what it draws, and messages, errors first."""

    regions: Regions = field(default_factory=Regions)
    errors: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    @property
    def ok(self) -> bool:
        return not self.errors


class RenderedLanguage(ABC):
    name: str
    suffix: str
    fences: tuple[str, ...]

    def guide(self) -> str:
        return Path(__file__).with_name("guides").joinpath(f"{self.name}.md").read_text("utf-8")

    def conversation(self, before: str | None = None) -> RenderedConversation:
        return RenderedConversation(self)

    @abstractmethod
    def reads(self, text: str) -> bool: ...

    @abstractmethod
    def missing(self) -> str | None:
        """Returns the reason why its programs cannot be run here; None if they can."""

    @abstractmethod
    def structures(self, program: str) -> int:
        """Returns the number of parts that a program defines by name."""

    @abstractmethod
    def knobs(self, program: str) -> Mapping[str, float]:
        """Returns the named numbers that somebody who edits a program would turn."""

    @abstractmethod
    def run(self, program: str, edits: Sequence[Mapping[str, float]] = ({},)) -> list[Rendered]:
        """Runs a program once for each edit, with these values for some of its knobs."""

    def judged(self, program: str) -> Rendered:
        """Returns what a program draws, which need not be taken apart."""
        return as_written(self, program)


_last: list[tuple[RenderedLanguage, str, Rendered]] = []
"""The last program that was valid in this process."""


def as_written(language: RenderedLanguage, program: str) -> Rendered:
    """Returns what a program draws as it is written. It is judged, drawn and edited in turn, and is run once
    for all of them.
    """
    for known, text, rendered in _last:
        if (known, text) == (language, program):
            return rendered
    (rendered,) = language.run(program)
    if rendered.ok:
        _last[:] = [(language, program, rendered)]
    return rendered


@dataclass
class RenderedConversation:
    """Judges each program by itself; a remark is made once."""

    language: RenderedLanguage
    told: set[str] = field(default_factory=set)

    def judge(self, program: str) -> Verdict:
        rendered = self.language.judged(program)
        said = "\n".join((*rendered.errors, *rendered.warnings)[:_SHOWN])
        if rendered.ok and said in self.told:
            said = ""
        self.told.add(said)
        return Verdict(
            ok=rendered.ok,
            stage="done" if rendered.ok else "render",
            feedback=f"{said}\n\n{self._request(rendered.ok)}" if said else "",
            program=program,
            codes=tuple(re.split(r" \(|:", error)[0] for error in rendered.errors),
            weight=(int(not rendered.ok), len(rendered.errors), len(rendered.warnings)),
            numbers={"structures": self.language.structures(program), "warnings": len(rendered.warnings)},
        )

    def finish(self, verdict: Verdict) -> Verdict:
        return verdict

    def _request(self, ok: bool) -> str:
        fence = self.language.fences[0]
        whole = f"answer with the whole program in one block that opens with ```{fence}."
        if ok:
            return f"The program draws something. If what is said above is not meant so, change it; {whole}"
        return f"Mend this without leaving out any part of the drawing, and {whole}"

"""Replies that are said beforehand, in a folder of the test's own, and `aidl eval` run over them."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from aidl_eval import command, requirements
from aidl_eval.measures import Edits
from aidl_eval.plan import VARIANTS
from aidl_lang.tools.llm.messages import Finish, Message, ProviderError, Reply, Sampling, Usage
from eval.tests import asked
from eval.tests.study import results
from tests import interrupts as interrupts
from tests.commands import Aidl, Result
from tests.commands import aidl as aidl
from tests.documents import ROOT


@dataclass
class Model:
    """Gives the replies that are `said` of a prompt, a variant and a run, which it tells from the messages
    and the seed; the last one again when there are no more.
    """

    said: dict[tuple[str, str, int], tuple[str, ...]] = field(default_factory=dict)
    name: str = "exec:said"
    takes_seeds: bool = True
    takes_grammars: bool = False

    def reply(self, messages: Sequence[Message], sampling: Sampling, hear: Callable[[str], None]) -> Reply:
        system, request = (next(m.text for m in messages if m.role == role) for role in ("system", "user"))
        variant = next(n for n, language in VARIANTS.items() if language.guide().strip() == system.strip())
        texts = asked.TEXTS
        prompt = max((n for n, text in texts.items() if text in request), key=lambda n: len(texts[n]))
        replies = self.said.get((prompt, variant, sampling.seed or 0))
        if replies is None:
            raise ProviderError("E0936", f"nothing is said of {prompt}, {variant}, run {sampling.seed}")
        had = sum(m.role == "assistant" for m in messages)
        text = replies[min(had, len(replies) - 1)]
        return Reply(text, Usage(None, None, None), Finish.COMPLETE, "")


@dataclass(frozen=True)
class Evaluation:
    """A working directory where results go to `out`."""

    folder: Path
    called: Aidl
    model: Model

    @property
    def out(self) -> Path:
        return self.folder / "out"

    def say(self, prompt: str, variant: str, run: int, *replies: str) -> None:
        """Says the replies of a conversation beforehand."""
        self.model.said[prompt, variant, run] = replies

    def command(self, *arguments: str) -> list[str]:
        return [sys.executable, "-m", "aidl_lang", "eval", "--out", str(self.out), "--jobs", "2", *arguments]

    def __call__(self, *arguments: str) -> Result:
        """What comes of `aidl eval`, run in this process."""
        return self.called(*self.command(*arguments)[3:])

    def record(self, prompt: str, variant: str, run: int) -> dict[str, Any]:
        found: dict[str, Any] = json.loads(
            (self.out / "records" / prompt / variant / f"{run}.json").read_bytes()
        )
        return found

    def figures(self, variant: str) -> Mapping[str, Mapping[str, Any]]:
        """What is known of the figures of a language, as numbers."""
        own = [line for line in results.figures(self.out) if line["variant"] == variant]
        return {line["figure"]: line for line in own if not line["against"]}

    def contents(self) -> dict[str, bytes]:
        """Every file that came out, by its path."""
        return {str(p.relative_to(self.out)): p.read_bytes() for p in self.out.rglob("*") if p.is_file()}


def unedited(*_: object) -> Edits:
    """Takes the place of `measures.edit`, which compiles dozens of times, where nothing is asked of edits."""
    return Edits(0, ())


@pytest.fixture
def evaluation(aidl: Aidl, folder: Path, monkeypatch: pytest.MonkeyPatch) -> Evaluation:
    """In a folder of the test's own, and nothing of whoever runs it in the environment."""
    model, named = Model(), command.provider
    monkeypatch.setattr(command, "provider", lambda given: named(given) if given.provider else model)
    return Evaluation(folder, aidl, model)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in [n for n in os.environ if n.startswith(("AIDL_", "OPENAI", "ANTHROPIC"))]:
        monkeypatch.delenv(name)
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setattr(requirements, "load", asked.load)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join((str(ROOT), str(ROOT / "eval"))))
    return tmp_path

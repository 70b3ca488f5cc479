"""Recorded replies in a folder of the test's own, and `aidl eval` run over them."""

from __future__ import annotations

import json
import os
import shlex
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from aidl_eval import requirements
from eval.tests import asked
from tests import interrupts as interrupts
from tests.commands import Result
from tests.commands import aidl as aidl
from tests.documents import ROOT

REPLAY = Path(__file__).with_name("replay.py")


@dataclass(frozen=True)
class Evaluation:
    """A working directory with `recordings`, where results go to `out`."""

    folder: Path
    called: Callable[..., Result]

    @property
    def out(self) -> Path:
        return self.folder / "out"

    def say(self, prompt: str, variant: str, run: int, *replies: str) -> None:
        """Record the replies of a conversation."""
        place = self.folder / "recordings" / prompt / variant / str(run)
        place.mkdir(parents=True)
        for number, reply in enumerate(replies, 1):
            (place / f"{number}.md").write_text(reply, encoding="utf-8")

    def command(self, *arguments: str) -> list[str]:
        replay = shlex.join([sys.executable, str(REPLAY), str(self.folder / "recordings")])
        given = [] if {"--provider", "--report"} & set(arguments) else ["--provider", f"exec:{replay}"]
        return [
            sys.executable,
            "-m",
            "aidl_lang",
            "eval",
            "--out",
            str(self.out),
            "--jobs",
            "2",
            *given,
            *arguments,
        ]

    def __call__(self, *arguments: str) -> Result:
        """What comes of `aidl eval`, run in this process."""
        return self.called(*self.command(*arguments)[3:])

    def record(self, prompt: str, variant: str, run: int) -> dict[str, Any]:
        found: dict[str, Any] = json.loads(
            (self.out / "records" / prompt / variant / f"{run}.json").read_bytes()
        )
        return found

    def figures(self, variant: str) -> Mapping[str, Mapping[str, Any]]:
        found = json.loads((self.out / "evaluation.json").read_bytes())["variants"]
        return {line["figure"]: line for line in found if line["variant"] == variant}

    def contents(self) -> dict[str, bytes]:
        """Every file that came out, by its path."""
        return {str(p.relative_to(self.out)): p.read_bytes() for p in self.out.rglob("*") if p.is_file()}


@pytest.fixture
def evaluation(aidl: Callable[..., Result], folder: Path) -> Evaluation:
    """In a folder of the test's own, and nothing of whoever runs it in the environment."""
    return Evaluation(folder, aidl)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in [n for n in os.environ if n.startswith(("AIDL_", "OPENAI", "ANTHROPIC"))]:
        monkeypatch.delenv(name)
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setattr(requirements, "load", asked.load)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join((str(ROOT), str(ROOT / "eval"))))
    return tmp_path

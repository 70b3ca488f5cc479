"""Recorded replies in a folder of the test's own, and `aidl eval` run over them."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from tests.documents import ROOT

REPLAY = ROOT / "tests" / "evaluation" / "replay.py"


@dataclass(frozen=True)
class Evaluation:
    """A working directory with `recordings`, where results go to `out`."""

    folder: Path

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

    @property
    def environment(self) -> dict[str, str]:
        kept = {
            name: value
            for name, value in os.environ.items()
            if not name.startswith(("AIDL_", "OPENAI", "ANTHROPIC"))
        }
        return {**kept, "NO_COLOR": "1", "PYTHONPATH": str(ROOT)}

    def __call__(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        done = subprocess.run(
            self.command(*arguments),
            cwd=self.folder,
            env=self.environment,
            capture_output=True,
            text=True,
            check=False,
        )
        print(done.stdout, done.stderr)
        return done

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
def evaluation(tmp_path: Path) -> Callable[..., Any]:
    return Evaluation(tmp_path)

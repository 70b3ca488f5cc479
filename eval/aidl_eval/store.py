"""Finished work on disk: a JSON record and a picture for each job, and the common settings.

Everything is written in one step, so that an interrupted run leaves whole records or none.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from aidl_eval.plan import VARIANTS, Job, Plan, digest
from aidl_eval.requirements import Prompt
from aidl_lang import Diagnostic, __version__
from aidl_lang.common.prose import shortened
from aidl_lang.common.world import replace
from aidl_lang.tools.cli.files import UseError
from aidl_lang.tools.llm.generation import Attempt, Generation

Record = dict[str, Any]

SETTINGS = "settings.json"
_SHOWN = 60


class StoreError(UseError):
    """Raised if the folder cannot be used; the diagnostic gives the reason and a remedy."""


class Store:
    """A folder of records."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def begin(self, plan: Plan, provider: str) -> None:
        """Writes the settings of a plan. Raises StoreError if the records come from others."""
        known, now = self._read(self.folder / SETTINGS) or {}, _settings(plan, provider)
        differing = [
            f"{name}: `{_told(known[name])}` then, `{_told(now[name])}` now"
            for name in sorted(known.keys() & now.keys())
            if known[name] != now[name]
        ]
        if differing:
            raise StoreError(
                "E0946",
                f"`{self.folder}` holds runs with other settings",
                *differing,
                "give these runs a folder of their own with --out, or use the settings of those there",
            )
        self.write(SETTINGS, _json(known | now))

    def settings(self) -> Mapping[str, Any]:
        """Returns the settings of the records there, empty without any. Raises StoreError."""
        return self._read(self.folder / SETTINGS) or {}

    def record(self, job: Job) -> Record | None:
        """Returns the record of a job, if any. Raises StoreError for a file that is no record."""
        found = self._read(self.folder / _record_path(job))
        if found is not None and not _is_record(found, job):
            raise _damaged(self.folder / _record_path(job))
        return found

    def records(self) -> list[Record]:
        """Returns all records, by prompt, variant and run."""
        found = []
        for path in (self.folder / "records").glob("*/*/*.json"):
            if path.stem.isdecimal():
                job = Job(path.parent.parent.name, path.parent.name, int(path.stem))
                record = self.record(job)
                found.append((job.prompt, list(VARIANTS).index(job.variant), job.run, record))
        found.sort(key=lambda item: item[:3])
        return [record for *_, record in found if record is not None]

    def keep(self, job: Job, record: Record, png: bytes | None) -> None:
        """Writes the picture, then the record that refers to it."""
        if png is not None:
            self.write(picture_path(job.key), png)
        self.write(_record_path(job), _json(record))

    def write(self, name: str, data: bytes) -> None:
        """Writes a file below the folder in one step. Raises StoreError."""
        path = self.folder / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            replace(path, data)
        except OSError as error:
            raise StoreError("E0948", f"`{path}` cannot be written: {error.strerror or error}") from None

    def _read(self, path: Path) -> dict[str, Any] | None:
        try:
            found = json.loads(path.read_bytes())
        except FileNotFoundError:
            return None
        except (OSError, ValueError):
            raise _damaged(path) from None
        if not isinstance(found, dict):
            raise _damaged(path)
        return found


def picture_path(key: str) -> str:
    return f"pictures/{key}.png"


def _record_path(job: Job) -> str:
    return f"records/{job.key}.json"


def _damaged(path: Path) -> StoreError:
    return StoreError("E0948", f"`{path}` is no record of a run", "remove it: the run is made again")


def _is_record(found: Record, job: Job) -> bool:
    names = {"attempts", "ok", "program", "missing", "fixes", "usage", "request"}
    is_about = all(found.get(name) == value for name, value in asdict(job).items())
    return is_about and job.variant in VARIANTS and ("failure" in found or names <= found.keys())


def measured_with(prompt: Prompt) -> str:
    """Returns a digest of what measures depend on beside the program: a new one makes them outdated."""
    return digest(f"{__version__}\n{prompt.source.text}")


_OF_VERDICT = ("ok", "stage", "codes", "fixes", "missing", "numbers")


def recorded(job: Job, prompt: Prompt, generation: Generation) -> Record:
    """Returns the record of a conversation, not yet measured."""
    verdict = generation.verdict
    asked = [message.text for message in generation.messages if message.role == "user"]
    return {
        **asdict(job),
        "text": prompt.text,
        "request": asked[0] if asked else "",
        "attempts": [_attempt(attempt) for attempt in generation.attempts],
        "ok": generation.ok,
        "program": verdict.program if verdict else None,
        "missing": list(verdict.missing) if verdict else [],
        "fixes": list(verdict.fixes) if verdict else [],
        "usage": asdict(generation.usage),
    }


def failed(job: Job, failure: Diagnostic) -> Record:
    """Returns the record of a conversation that broke off, to be repeated."""
    return {**asdict(job), "failure": {"code": failure.code, "message": failure.message}}


def _attempt(attempt: Attempt) -> Record:
    reply, verdict = asdict(attempt.reply), attempt.verdict
    return {
        "reply": reply.pop("text"),
        **reply,
        "program": attempt.program,
        "verdict": None if verdict is None else {name: getattr(verdict, name) for name in _OF_VERDICT},
        "answer": attempt.answer,
    }


def _settings(plan: Plan, provider: str) -> Record:
    """Returns the settings that records in one table share; prompts and variants may be added."""
    sampling = plan.settings.sampling
    return {
        "provider": provider,
        "attempts": plan.settings.attempts,
        "seed": sampling.seed,
        "temperature": sampling.temperature,
        "max_tokens": sampling.max_tokens,
        "extra": dict(sampling.extra),
        "help": plan.has_help,
        **plan.facts,
        **{f"prompt {prompt.name}": prompt.text for prompt in plan.prompts},
    }


def _told(value: object) -> str:
    return shortened(" ".join(str(value).split()), _SHOWN)


def _json(value: Mapping[str, Any]) -> bytes:
    return (json.dumps(value, indent=1, ensure_ascii=False, allow_nan=False, default=str) + "\n").encode(
        "utf-8", "backslashreplace"
    )

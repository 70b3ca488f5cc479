"""Conversations kept as text, which go through the evaluation again without a model.

A recording is JSON Lines, one conversation a line; `eval/README.md` has its members. The folder that is
replayed may hold several such files.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import date
from difflib import get_close_matches
from pathlib import Path
from typing import Any, NoReturn

from aidl_eval.plan import VARIANTS, Job, Plan, key_of
from aidl_eval.requirements import Prompt
from aidl_lang import SourceFile
from aidl_lang.tools.cli.files import UseError
from aidl_lang.tools.llm.generation import Settings
from aidl_lang.tools.llm.messages import (
    ConversationOver,
    Finish,
    Message,
    Reply,
    Sampling,
    Usage,
)

VERSION = 1
SUFFIX = ".jsonl"
RECORDING, NOTE, GUIDE = "recording of ", "note on ", "guide of "
"""What names of settings begin with."""
_NAME = "aidl_recording"
_LARGEST = 256 << 20
"""Most bytes of a file."""


class RecordingError(UseError):
    """Raised for what is no recording; the diagnostic gives the place, the reason and a remedy."""


@dataclass(frozen=True)
class Recorded:
    """One conversation; `guide` tells what the model had read, `note` what readers of figures must know."""

    job: Job
    text: str
    replies: tuple[Reply, ...]
    guide: str | None = None
    note: str | None = None
    line: str = ""

    @property
    def digest(self) -> str:
        return hashlib.sha256(self.line.encode()).hexdigest()[:16]


# --- reading ----------------------------------------------------------------------------------------


def load(place: Path) -> tuple[Recorded, ...]:
    """Returns the conversations of a file, or of all files `*.jsonl` of a folder. Raises RecordingError."""
    found: dict[Job, Recorded] = {}
    for file in _files(place):
        for where, line in _lines(file):
            conversation = _conversation(line, where)
            if conversation.job in found:
                _refuse(where, f"the conversation `{conversation.job.key}` stands there twice")
            found[conversation.job] = conversation
    if not found:
        raise RecordingError("E0993", f"`{place}` holds no conversation", _FORM)
    return tuple(found.values())


_FORM = f"a recording has one JSON object a line, in files `*{SUFFIX}`; eval/README.md has its members"


def _files(place: Path) -> list[Path]:
    try:
        return sorted(place.glob(f"*{SUFFIX}")) if place.is_dir() else [place]
    except OSError as error:
        raise _unreadable(place, error) from None


def _lines(file: Path) -> Iterator[tuple[str, str]]:
    try:
        if not file.is_file():
            raise RecordingError("E0993", f"`{file}` is no file and no folder", _FORM)
        if file.stat().st_size > _LARGEST:
            large = f"`{file}` is larger than {_LARGEST >> 20} MB"
            raise RecordingError("E0993", large, "part it into several files of a folder")
        text = file.read_text(encoding="utf-8")
    except OSError as error:
        raise _unreadable(file, error) from None
    except UnicodeDecodeError:
        raise RecordingError("E0993", f"`{file}` is not UTF-8", _FORM) from None
    for number, line in enumerate(text.split("\n"), 1):
        if line.strip():
            yield f"{file}:{number}", line


def _unreadable(place: Path, error: OSError) -> RecordingError:
    return RecordingError("E0993", f"`{place}` cannot be read: {error.strerror or error}")


def _refuse(where: str, why: str) -> NoReturn:
    raise RecordingError("E0993", f"`{where}` is no conversation: {why}", _FORM)


_MEMBERS = frozenset({_NAME, "prompt", "text", "variant", "run", "model", "date", "guide", "note", "replies"})
_OF_REPLY = frozenset({"text", "model", "date", "finish", "input", "output", "cost", "seconds"})


def _conversation(line: str, where: str) -> Recorded:
    try:
        said = json.loads(line)
    except (ValueError, RecursionError) as error:
        _refuse(where, f"it is no JSON ({str(error)[:80]})")
    reader = _Reader(said, where, "", _MEMBERS)
    if said.get(_NAME) != VERSION:
        _refuse(where, f"`{_NAME}` is to be {VERSION}")
    job = Job(reader.name("prompt"), reader.variant(), reader.run())
    replies = said.get("replies")
    if not isinstance(replies, list) or not replies:
        _refuse(where, "`replies` is to be a list with at least one reply")
    model, day = reader.text("model"), reader.date("date")
    return Recorded(
        job,
        reader.text("text") or job.prompt.replace("_", " "),
        tuple(_reply(reply, where, number, model, day) for number, reply in enumerate(replies, 1)),
        reader.text("guide"),
        reader.text("note"),
        line.strip(),
    )


def _reply(said: object, where: str, number: int, model: str | None, day: str | None) -> Reply:
    if isinstance(said, str):
        return Reply(said, Usage(None, None, None), Finish.COMPLETE, model or "", date=day)
    reader = _Reader(said, where, f"replies[{number}].", _OF_REPLY)
    text = reader.text("text")
    if text is None:
        _refuse(where, f"`replies[{number}].text` is missing")
    finish = reader.text("finish") or Finish.COMPLETE
    if finish not in tuple(Finish):
        _refuse(where, f"`replies[{number}].finish` is to be one of {', '.join(Finish)}")
    usage = Usage(reader.whole("input"), reader.whole("output"), reader.number("cost"))
    return Reply(
        text,
        usage,
        Finish(finish),
        reader.text("model") or model or "",
        reader.number("seconds"),
        reader.date("date") or day,
    )


class _Reader:
    """Takes the members of an object, each by its kind."""

    def __init__(self, said: object, where: str, within: str, known: frozenset[str]) -> None:
        if not isinstance(said, dict):
            _refuse(where, f"{f'`{within[:-1]}`' if within else 'it'} is to be an object, as in {{…}}")
        if strange := sorted(map(str, said.keys() - known)):
            there = ", ".join(sorted(known))
            _refuse(where, f"it has no member `{within}{strange[0][:60]}`; there are {there}")
        self._said, self._where, self._within = said, where, within

    def _wrong(self, name: str, wanted: str) -> NoReturn:
        _refuse(self._where, f"`{self._within}{name}` is to be {wanted}")

    def text(self, name: str) -> str | None:
        found = self._said.get(name)
        if found is not None and not isinstance(found, str):
            self._wrong(name, "a text, or null where it is not known")
        return found

    def name(self, name: str) -> str:
        """Returns a name, which also is the name of a folder of the results."""
        found = self.text(name)
        if found is None or not found.replace("_", "a").replace("-", "a").isalnum() or len(found) > 100:
            self._wrong(name, "a name of letters, digits, `_` and `-`")
        return found

    def variant(self) -> str:
        found = self.text("variant")
        if found not in VARIANTS:
            self._wrong("variant", f"one of {', '.join(VARIANTS)}")
        return found

    def run(self) -> int:
        found = self.whole("run")
        if found is None or not 1 <= found <= 10_000:
            self._wrong("run", "a whole number from 1 to 10000")
        return found

    def date(self, name: str) -> str | None:
        found = self.text(name)
        try:
            return found and date.fromisoformat(found).isoformat()
        except ValueError:
            self._wrong(name, "a day as in 2026-01-31, or null where it is not known")

    def whole(self, name: str) -> int | None:
        found = self.number(name)
        if found is not None and found != int(found):
            self._wrong(name, "a whole number")
        return None if found is None else int(found)

    def number(self, name: str) -> float | None:
        found = self._said.get(name)
        is_number = isinstance(found, int | float) and not isinstance(found, bool)
        if found is not None and not (is_number and 0 <= found < 1e15 and math.isfinite(found)):
            self._wrong(name, "a number from 0 on, or null where it is not known")
        return found


# --- replaying --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Replay:
    """Takes the place of a provider. It keeps no state, so that threads may share it."""

    name: str
    conversations: Mapping[Job, Recorded]

    def of(self, job: Job) -> Speaker:
        """Returns the provider of one conversation."""
        return Speaker(self.name, self.conversations[job])


@dataclass(frozen=True)
class Speaker:
    """A provider of the replies of one conversation, in order."""

    name: str
    recorded: Recorded
    takes_seeds: bool = False
    takes_grammars: bool = False

    def reply(self, messages: Sequence[Message], sampling: Sampling, hear: Callable[[str], None]) -> Reply:
        """Returns the reply after those in `messages`. Raises ConversationOver after the last one."""
        had = sum(message.role == "assistant" for message in messages)
        if had >= len(self.recorded.replies):
            raise ConversationOver
        reply = self.recorded.replies[had]
        hear(reply.text)
        return reply


@dataclass(frozen=True)
class RecordedPlan(Plan):
    """The plan whose jobs are the conversations of a recording, in their order."""

    recorded: tuple[Recorded, ...] = field(default=())

    def jobs(self) -> Iterator[Job]:
        for conversation in self.recorded:
            yield conversation.job

    @property
    def facts(self) -> dict[str, str]:
        """Returns what results must have in common to stand in one folder, and what readers must know."""
        found = {}
        for conversation in self.recorded:
            key = conversation.job.key
            found[f"{RECORDING}{key}"] = conversation.digest
            found[f"{NOTE}{key}"] = conversation.note or ""
            found[f"{GUIDE}{key}"] = conversation.guide or ""
        return found


def chosen(
    recorded: Sequence[Recorded], prompts: Sequence[str], variants: Sequence[str], runs: int | None
) -> tuple[Recorded, ...]:
    """Returns the conversations about some prompts (none: all), in some variants. Raises RecordingError."""
    known = dict.fromkeys(conversation.job.prompt for conversation in recorded)
    for name in prompts:
        if name not in known:
            near = get_close_matches(name, known, n=1)
            hint = f"did you mean `{near[0]}`?" if near else f"there are {', '.join(known)}"
            raise RecordingError("E0994", f"the recording has no prompt `{name}`", hint)
    found = tuple(
        conversation
        for conversation in recorded
        if (not prompts or conversation.job.prompt in prompts)
        and conversation.job.variant in variants
        and (runs is None or conversation.job.run <= runs)
    )
    if not found:
        there = ", ".join(dict.fromkeys(conversation.job.variant for conversation in recorded))
        raise RecordingError("E0994", "the recording has no such conversations", f"its variants are {there}")
    return found


def plan(recorded: Sequence[Recorded], known: Iterable[Prompt], settings: Settings) -> RecordedPlan:
    """Returns the plan of some conversations. Where a prompt is `known`, what it requires is examined; it is
    asked for in the words of the recording.
    """
    by_name = {prompt.name: prompt for prompt in known}
    prompts = dict[str, Prompt]()
    for conversation in recorded:
        name, text = conversation.job.prompt, conversation.text
        bare = Prompt(name, text, (), (), {}, SourceFile(f"{name}.aidl", ""))
        asked = prompts.setdefault(name, replace(by_name.get(name, bare), text=text))
        if asked.text != text:
            raise RecordingError(
                "E0995",
                f"the recording asks for `{name}` in two ways: `{asked.text[:60]}` and `{text[:60]}`",
                "give one of them another name",
            )
    used = {conversation.job.variant for conversation in recorded}
    return RecordedPlan(
        tuple(prompts.values()),
        tuple(name for name in VARIANTS if name in used),
        max(conversation.job.run for conversation in recorded),
        settings,
        recorded=tuple(recorded),
    )


# --- writing ----------------------------------------------------------------------------------------


def notes(records: Iterable[Mapping[str, Any]], settings: Mapping[str, Any]) -> tuple[str, ...]:
    """Returns what must be known of conversations, each note once, after the languages that it is about."""
    about: dict[str, dict[str, None]] = {}
    for r in records:
        if note := settings.get(f"{NOTE}{key_of(r)}"):
            about.setdefault(note, {})[r["variant"]] = None
    return tuple(f"{', '.join(variants)}: {note}" for note, variants in about.items())


def written(records: Iterable[Mapping[str, Any]], settings: Mapping[str, Any]) -> str:
    """Returns the conversations of the records of an evaluation as a recording."""
    return "".join(_line(r, settings) for r in records if "failure" not in r and r["attempts"])


def _line(kept: Mapping[str, Any], settings: Mapping[str, Any]) -> str:
    key = key_of(kept)
    replies = [
        {
            "text": attempt["reply"],
            "model": attempt["model"] or None,
            "date": attempt.get("date"),
            "finish": attempt["finish"],
            **attempt["usage"],
            "seconds": attempt.get("seconds"),
        }
        for attempt in kept["attempts"]
    ]
    said = {
        _NAME: VERSION,
        **{name: kept[name] for name in ("prompt", "text", "variant", "run")},
        "guide": settings.get(f"{GUIDE}{key}", settings.get(f"{GUIDE}{kept['variant']}")) or None,
        "note": settings.get(f"{NOTE}{key}") or None,
        "replies": replies,
    }
    return json.dumps(said, ensure_ascii=False) + "\n"

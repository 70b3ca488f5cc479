"""Conversations kept as text, which go through the evaluation again without a model.

A recording is JSON Lines, one conversation a line; `eval/README.md` has its members. The folder that is
replayed may hold several such files.
"""

from __future__ import annotations

import datetime
import json
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from aidl_eval import strict
from aidl_eval.plan import GUIDE, VARIANTS, Job, Plan, digest, key_of
from aidl_eval.requirements import Prompt
from aidl_lang import SourceFile
from aidl_lang.common.names import nearest
from aidl_lang.common.prose import did_you_mean
from aidl_lang.tools.cli.files import UseError
from aidl_lang.tools.llm.generation import Settings
from aidl_lang.tools.llm.messages import ConversationOver, Finish, Message, Reply, Sampling, Usage

VERSION = 1
SUFFIX = ".jsonl"
_RECORDING, _NOTE = "recording of ", "note on "
"""What names of settings begin with, as `GUIDE`."""
_FORM = f"a recording has one JSON object a line, in files `*{SUFFIX}`; eval/README.md has its members"


class RecordingError(UseError):
    """Raised for what is no recording; the diagnostic gives the place, the reason and a remedy."""


@dataclass(frozen=True)
class _Reply:
    """A reply as it is written."""

    text: str
    model: str | None = None
    date: datetime.date | None = None
    finish: Finish = Finish.COMPLETE
    input: int | None = None
    output: int | None = None
    cost: float | None = None
    seconds: float | None = None

    def __post_init__(self) -> None:
        for number in (self.input, self.output, self.cost, self.seconds):
            if number is not None and not 0 <= number < 1e15:
                raise ValueError("a number is to be from 0 on")


@dataclass(frozen=True)
class Recorded:
    """One conversation as it is written; `guide` tells what the model had read, `note` what readers of
    figures must know.
    """

    aidl_recording: int
    prompt: str
    variant: str
    run: int
    replies: tuple[_Reply, ...]
    text: str | None = None
    model: str | None = None
    date: datetime.date | None = None
    guide: str | None = None
    note: str | None = None

    def __post_init__(self) -> None:
        for is_so, wanted in (
            (self.aidl_recording == VERSION, f"`aidl_recording` is to be {VERSION}"),
            # also a folder of the results
            (
                re.fullmatch(r"[\w-]{1,100}", self.prompt),
                "`prompt` is to be a name of letters, digits, `_` and `-`",
            ),
            (self.variant in VARIANTS, f"`variant` is to be one of {', '.join(VARIANTS)}"),
            (1 <= self.run <= 10_000, "`run` is to be a whole number from 1 to 10000"),
            (self.replies, "`replies` is to be a list with at least one reply"),
        ):
            if not is_so:
                raise ValueError(wanted)

    @property
    def job(self) -> Job:
        return Job(self.prompt, self.variant, self.run)

    @property
    def asked(self) -> str:
        return self.text or self.prompt.replace("_", " ")

    def reply(self, number: int) -> Reply:
        said = self.replies[number]
        day = said.date or self.date
        return Reply(
            said.text,
            Usage(said.input, said.output, said.cost),
            said.finish,
            said.model or self.model or "",
            said.seconds,
            day.isoformat() if day else None,
        )


def load(place: Path) -> dict[Job, Recorded]:
    """Returns the conversations of a file, or of all files `*.jsonl` of a folder. Raises RecordingError."""
    found: dict[Job, Recorded] = {}
    try:
        for file in sorted(place.glob(f"*{SUFFIX}")) if place.is_dir() else [place]:
            for number, line in enumerate(file.read_text(encoding="utf-8").split("\n"), 1):
                if line.strip():
                    conversation = _conversation(line, where := f"{file}:{number}")
                    if conversation.job in found:
                        raise _refused(where, f"the conversation `{conversation.job.key}` stands there twice")
                    found[conversation.job] = conversation
    except OSError as error:
        raise RecordingError("E0993", f"`{place}` cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise RecordingError("E0993", f"`{place}` is not UTF-8", _FORM) from None
    if not found:
        raise RecordingError("E0993", f"`{place}` holds no conversation", _FORM)
    return found


def _conversation(line: str, where: str) -> Recorded:
    try:
        said = json.loads(line)
        if isinstance(said, dict) and isinstance(said.get("replies"), list):
            said["replies"] = [{"text": r} if isinstance(r, str) else r for r in said["replies"]]
        return strict.read(said, Recorded)
    except strict.WrongError as error:
        raise _refused(where, str(error)) from None
    except (ValueError, RecursionError) as error:
        raise _refused(where, f"it is no JSON ({str(error)[:80]})") from None


def _refused(where: str, why: str) -> RecordingError:
    return RecordingError("E0993", f"`{where}` is no conversation: {why}", _FORM)


@dataclass(frozen=True)
class Speaker:
    """A provider of the replies of one conversation, in order. It keeps no state."""

    recorded: Recorded
    name: str = "recording"
    takes_seeds: bool = False
    takes_grammars: bool = False

    def reply(self, messages: Sequence[Message], sampling: Sampling, hear: Callable[[str], None]) -> Reply:
        """Returns the reply after those in `messages`. Raises ConversationOver after the last one."""
        had = sum(message.role == "assistant" for message in messages)
        if had >= len(self.recorded.replies):
            raise ConversationOver
        reply = self.recorded.reply(had)
        hear(reply.text)
        return reply


def chosen(
    recorded: Iterable[Recorded], prompts: Sequence[str], variants: Sequence[str], runs: int | None
) -> list[Recorded]:
    """Returns the conversations about some prompts (none: all), in some variants. Raises RecordingError."""
    recorded = list(recorded)
    known = dict.fromkeys(one.prompt for one in recorded)
    for name in prompts:
        if name not in known:
            hints = did_you_mean(nearest(name, known)) or [f"there are {', '.join(known)}"]
            raise RecordingError("E0994", f"the recording has no prompt `{name}`", *hints)
    found = [
        one
        for one in recorded
        if one.prompt in (prompts or known) and one.variant in variants and (runs is None or one.run <= runs)
    ]
    if not found:
        there = ", ".join(dict.fromkeys(one.variant for one in recorded))
        raise RecordingError("E0994", "the recording has no such conversations", f"its variants are {there}")
    return found


def plan(recorded: Sequence[Recorded], known: Mapping[str, Prompt], settings: Settings) -> Plan:
    """Returns the plan of some conversations. Where a prompt is `known`, what it requires is examined; it is
    asked for in the words of the recording.
    """
    prompts = dict[str, Prompt]()
    facts = dict[str, str]()
    for one in recorded:
        name, text = one.prompt, one.asked
        bare = Prompt(name, text, (), SourceFile(f"{name}.aidl", ""))
        asked = prompts.setdefault(name, replace(known.get(name, bare), text=text))
        if asked.text != text:
            raise RecordingError(
                "E0995",
                f"the recording asks for `{name}` in two ways: `{asked.text[:60]}` and `{text[:60]}`",
                "give one of them another name",
            )
        facts[f"{_RECORDING}{one.job.key}"] = digest(repr(one.replies))
        facts[f"{_NOTE}{one.job.key}"] = one.note or ""
        facts[f"{GUIDE}{one.job.key}"] = one.guide or ""
    return Plan(list(prompts.values()), [one.job for one in recorded], settings, True, facts)


def notes(records: Iterable[Mapping[str, Any]], settings: Mapping[str, Any]) -> tuple[str, ...]:
    """Returns what must be known of conversations, each note once, after the languages that it is about."""
    about: dict[str, dict[str, None]] = {}
    for r in records:
        if note := settings.get(f"{_NOTE}{key_of(r)}"):
            about.setdefault(note, {})[r["variant"]] = None
    return tuple(f"Note on {', '.join(variants)}: {note}." for note, variants in about.items())


def written(records: Iterable[Mapping[str, Any]], settings: Mapping[str, Any]) -> str:
    """Returns the conversations of the records of an evaluation as a recording."""
    return "".join(_line(r, settings) for r in records if "failure" not in r and r["attempts"])


def _line(kept: Mapping[str, Any], settings: Mapping[str, Any]) -> str:
    key, variant = key_of(kept), kept["variant"]
    replies = tuple(
        _Reply(a["reply"], a["model"] or None, a["date"], a["finish"], **a["usage"], seconds=a["seconds"])
        for a in kept["attempts"]
    )
    guide = settings.get(f"{GUIDE}{key}", settings.get(f"{GUIDE}{variant}")) or None
    note = settings.get(f"{_NOTE}{key}") or None
    about = kept["prompt"], variant, kept["run"]
    said = Recorded(VERSION, *about, replies, text=kept["text"], guide=guide, note=note)
    return json.dumps(asdict(said), ensure_ascii=False) + "\n"

"""Conversations kept as text, which go through the evaluation again without a model.

A recording is JSON Lines, one conversation a line; `eval/README.md` has its members. The folder that is
replayed may hold several such files.
"""

from __future__ import annotations

import datetime
import json
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from cattrs import BaseValidationError, Converter, ForbiddenExtraKeysError, transform_error
from cattrs.gen import make_dict_structure_fn

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


def _number(said: object, kind: type) -> Any:
    is_number = type(said) is int or (kind is float and type(said) is float)
    if not is_number or not 0 <= said < 1e15:  # type: ignore[operator]
        raise ValueError(f"it is to be a {'whole ' * (kind is int)}number from 0 on")
    return said


def _text(said: object, _: type) -> str:
    if not isinstance(said, str):
        raise ValueError("it is to be a text")
    return said


_CONVERTER = Converter(forbid_extra_keys=True)
_CONVERTER.register_structure_hook(datetime.date, lambda said, _: datetime.date.fromisoformat(said))
_CONVERTER.register_structure_hook(Finish, lambda said, _: Finish(said))
_CONVERTER.register_structure_hook(int, _number)
_CONVERTER.register_structure_hook(float, _number)
_CONVERTER.register_structure_hook(str, _text)
_of_object = make_dict_structure_fn(_Reply, _CONVERTER, _cattrs_forbid_extra_keys=True)


def _reply(said: object, kind: type) -> _Reply:
    if isinstance(said, str):
        return _Reply(said)
    if not isinstance(said, dict):
        raise ValueError("it is to be a text or an object")
    return _of_object(said, kind)


_CONVERTER.register_structure_hook(_Reply, _reply)


# --- reading ----------------------------------------------------------------------------------------


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
    except (ValueError, RecursionError) as error:
        raise _refused(where, f"it is no JSON ({str(error)[:80]})") from None
    if not isinstance(said, dict):
        raise _refused(where, "it is to be an object, as in {…}")
    try:
        return _CONVERTER.structure(said, Recorded)
    except BaseValidationError as error:
        why, _, member = transform_error(error, "", _told)[0].rpartition(" @ ")
        raise _refused(where, f"`{member.lstrip('.')}`: {why}" if member else why) from None


def _told(error: BaseException, _: type | None) -> str:
    match error:
        case KeyError():
            return "it is missing"
        case ForbiddenExtraKeysError(extra_fields=strange):
            return f"there is no member `{min(strange)[:60]}`"
    return str(error)[:200]


def _refused(where: str, why: str) -> RecordingError:
    return RecordingError("E0993", f"`{where}` is no conversation: {why}", _FORM)


# --- replaying --------------------------------------------------------------------------------------


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


# --- writing ----------------------------------------------------------------------------------------


def notes(records: Iterable[Mapping[str, Any]], settings: Mapping[str, Any]) -> tuple[str, ...]:
    """Returns what must be known of conversations, each note once, after the languages that it is about."""
    about: dict[str, dict[str, None]] = {}
    for r in records:
        if note := settings.get(f"{_NOTE}{key_of(r)}"):
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
        "aidl_recording": VERSION,
        **{name: kept[name] for name in ("prompt", "text", "variant", "run")},
        "guide": settings.get(f"{GUIDE}{key}", settings.get(f"{GUIDE}{kept['variant']}")) or None,
        "note": settings.get(f"{_NOTE}{key}") or None,
        "replies": replies,
    }
    return json.dumps(said, ensure_ascii=False) + "\n"

"""Sheets of pictures to be ranked; the answers, each one line of `study.jsonl`; the figures from them."""

from __future__ import annotations

import json
import os
import re
import unicodedata
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from io import FileIO
from pathlib import Path

from aidl_eval import strict
from aidl_eval.plan import VARIANTS, digest
from aidl_eval.statistics import alpha
from aidl_eval.store import Record, Store, StoreError

STUDY = "study.jsonl"
FEWEST = 2
"""Fewest pictures that can be ranked."""
_FORMAT = 1
_RATER = re.compile(r"[^\W_](?:[\w .-]{0,38}[^\W_])?")
_LONGEST = 1 << 16
"""More bytes than a line has."""


@dataclass(frozen=True)
class Sheet:
    """The pictures of one prompt and run. `id` changes with the programs that are drawn."""

    prompt: str
    run: int
    text: str
    drawn: tuple[str, ...]
    undrawn: tuple[str, ...]
    """Languages whose conversation came to no picture: they are last, and nothing is shown of them."""
    id: str


@dataclass(frozen=True)
class Answer:
    """What one rater says of a sheet: languages from best to worst, those of one group alike; None where the
    rater could not tell. `shown` has them in the order on the screen.
    """

    rater: str
    prompt: str
    run: int
    sheet: str
    shown: tuple[str, ...]
    undrawn: tuple[str, ...]
    ranking: tuple[tuple[str, ...], ...] | None
    date: str

    def __post_init__(self) -> None:
        languages = [*self.shown, *self.undrawn]
        groups = (self.shown,) if self.ranking is None else self.ranking
        if (
            not VARIANTS.keys() >= set(languages)
            or len(set(languages)) < len(languages)
            or sorted(name for group in groups for name in group) != sorted(self.shown)
        ):
            raise ValueError("each language shown has one place")

    def ranks(self) -> Mapping[str, float]:
        """Returns the rank of each language, 1 for the best; those alike share the mean of theirs, and those
        that drew nothing are alike, and last. Empty where the rater could not tell.
        """
        return {} if self.ranking is None else _ranks([*self.ranking, self.undrawn])

    def ranks_of_shown(self) -> Mapping[str, float]:
        """Returns the ranks among the pictures alone."""
        return _ranks(self.ranking or ())


def _ranks(groups: Iterable[Sequence[str]]) -> dict[str, float]:
    found, above = dict[str, float](), 0
    for group in groups:
        found |= dict.fromkeys(group, above + (len(group) + 1) / 2)
        above += len(group)
    return found


def sheets(records: Sequence[Record]) -> list[Sheet]:
    """Returns the sheets of all prompts and runs for which two languages drew something. A conversation that
    broke off says nothing of its language and is left out.
    """
    held = defaultdict[tuple[str, int], list[Record]](list)
    for record in records:
        if "failure" not in record:
            held[record["prompt"], record["run"]].append(record)
    found = []
    for (prompt, run), own in held.items():
        programs = {r["variant"]: digest(str(r["program"])) if _is_drawn(r) else None for r in own}
        drawn = tuple(name for name, program in programs.items() if program is not None)
        undrawn = tuple(name for name, program in programs.items() if program is None)
        if len(drawn) >= FEWEST:
            of = digest(json.dumps([prompt, run, sorted(programs.items())]))
            found.append(Sheet(prompt, run, own[0]["text"], drawn, undrawn, of))
    return found


def _is_drawn(record: Record) -> bool:
    return bool(record["ok"]) and "drawing" not in record.get("unmeasured", {})


def rater_named(text: object) -> str | None:
    """Returns the rater of a name or number as typed, None if it is none: up to 40 letters and digits, and
    blanks, dots, hyphens and low lines between them. Capitals do not matter.
    """
    if not isinstance(text, str) or len(text) > 200:
        return None
    name = " ".join(unicodedata.normalize("NFKC", text).casefold().split())
    return name if _RATER.fullmatch(name) else None


class Answers:
    """The answers in a folder. Others may write to it at the same time."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / STUDY

    def all(self) -> Sequence[Answer]:
        """Returns all answers in the order in which they were given. Raises StoreError."""
        try:
            return list(_read(self.path))
        except FileNotFoundError:
            return []
        except OSError as error:
            raise StoreError("E0988", f"`{self.path}` cannot be read: {error.strerror or error}") from None

    def add(self, answer: Answer) -> None:
        """Appends an answer in one write, and waits until it is on disk. Raises StoreError."""
        data = (json.dumps({"aidl_study": _FORMAT, **asdict(answer)}, ensure_ascii=False) + "\n").encode()
        try:
            with open(self.path, "ab+", buffering=0) as file:
                _cut_torn_line(file)
                if file.write(data) != len(data):
                    raise OSError("the disk is full")
                os.fsync(file.fileno())
        except OSError as error:
            raise StoreError("E0988", f"`{self.path}` cannot be written: {error.strerror or error}") from None


def _cut_torn_line(file: FileIO) -> None:
    """Takes away what a crash left of an answer that nobody was told was kept."""
    size = file.seek(0, os.SEEK_END)
    file.seek(max(0, size - _LONGEST))
    tail = file.read()
    if tail and not tail.endswith(b"\n"):
        file.truncate(size - len(tail) + tail.rfind(b"\n") + 1)


def _read(path: Path) -> Iterator[Answer]:
    lines = path.read_bytes().split(b"\n")
    for number, line in enumerate(lines[:-1], 1):  # what follows the last newline is half an answer
        try:
            said = json.loads(line)
            if said.pop("aidl_study") != _FORMAT:
                raise ValueError
            yield strict.read(said, Answer)
        except (AttributeError, KeyError, RecursionError, TypeError, ValueError):
            hint = "remove that line: the rater is asked once more"
            raise StoreError("E0988", f"`{path}:{number}` is no answer of a study", hint) from None


@dataclass
class Study:
    """The answers that count: of each rater the last on each sheet. `outdated` ones were given on sheets that
    are no longer there as they were.
    """

    answers: tuple[Answer, ...]
    outdated: int

    @cached_property
    def ranked(self) -> list[tuple[str, Mapping[str, float]]]:
        """Returns the prompt and the ranks of each answer in which the rater could tell."""
        return [(answer.prompt, answer.ranks()) for answer in self.answers if answer.ranking is not None]

    @property
    def raters(self) -> int:
        return len({answer.rater for answer in self.answers})

    @property
    def judgements(self) -> int:
        return len(self.ranked)

    @property
    def skipped(self) -> int:
        return len(self.answers) - len(self.ranked)

    @cached_property
    def alpha(self) -> float | None:
        """Returns how far raters agree on the ranks of what they saw."""
        groups = defaultdict[int, dict[tuple[str, str], list[float]]](lambda: defaultdict(list))
        for answer in self.answers:
            for language, rank in answer.ranks_of_shown().items():
                groups[len(answer.shown)][answer.sheet, language].append(rank)
        return alpha(units.values() for units in groups.values())

    def ranks(self, variant: str, prompt: str | None = None) -> list[tuple[str, float]]:
        """Returns the ranks of a language, each with its prompt."""
        return [
            (asked, ranks[variant])
            for asked, ranks in self.ranked
            if variant in ranks and prompt in (None, asked)
        ]


def study_of(store: Store, records: Sequence[Record]) -> Study | None:
    """Returns the study in a folder; None if nobody was asked. Raises StoreError."""
    given = Answers(store.folder).all()
    if not given:
        return None
    last = {(answer.rater, answer.sheet): answer for answer in given}
    there = {sheet.id for sheet in sheets(records)}
    current = tuple(answer for answer in last.values() if answer.sheet in there)
    return Study(current, len(last) - len(current))

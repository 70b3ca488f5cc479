"""Figures of a study: ranks, shares preferred, and how far raters agree."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from aidl_eval.judgements import Answer, Answers, Sheet, sheets
from aidl_eval.statistics import Case, alpha, by_prompt
from aidl_eval.store import Record, Store
from aidl_lang.common.world import csv_text

Numbers = list[tuple[str, float | None]]


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
    def raters(self) -> list[str]:
        return sorted({answer.rater for answer in self.answers if answer.was_asked})

    @property
    def judgements(self) -> int:
        """Returns how many rankings raters gave."""
        return sum(answer.was_asked and answer.ranking is not None for answer in self.answers)

    @property
    def skipped(self) -> int:
        return sum(answer.ranking is None for answer in self.answers)

    @property
    def unasked(self) -> int:
        """Returns how many answers were plain without a rater."""
        return sum(not answer.was_asked for answer in self.answers)

    @cached_property
    def alpha(self) -> float | None:
        """Returns how far raters agree on the ranks of what they saw."""
        groups = defaultdict[int, dict[tuple[str, str], list[float]]](lambda: defaultdict(list))
        for answer in self.answers:
            if answer.was_asked and answer.ranking is not None:
                for language, rank in answer.ranks_of_shown().items():
                    groups[len(answer.shown)][answer.sheet, language].append(rank)
        return alpha(units.values() for units in groups.values())

    def ranks(self, variant: str, prompt: str | None = None) -> Numbers:
        """Returns the ranks of a language, each with its prompt."""
        return [
            (asked, ranks[variant])
            for asked, ranks in self.ranked
            if variant in ranks and prompt in (None, asked)
        ]

    def preferred(self, variant: str, prompt: str | None = None) -> Numbers:
        """Returns the shares of other languages that a language was placed above, each with its prompt."""
        return [
            (asked, sum(_above(ranks, variant, other) for other in ranks if other != variant) / others)
            for asked, ranks in self.ranked
            if variant in ranks and prompt in (None, asked) and (others := len(ranks) - 1)
        ]

    def over(self, first: str, second: str) -> dict[str, float]:
        """Returns by prompt how often the first language was placed above the second."""
        return by_prompt(
            [
                Case(asked, _above(ranks, first, second))
                for asked, ranks in self.ranked
                if first in ranks and second in ranks
            ]
        )


def _above(ranks: Mapping[str, float], first: str, second: str) -> float:
    """Returns 1 where the first is better, 0 where it is worse, a half where both are alike."""
    return (1 + (ranks[first] < ranks[second]) - (ranks[first] > ranks[second])) / 2


def study_of(store: Store, records: Sequence[Record]) -> Study | None:
    """Returns the study in a folder; None if nobody was asked. Raises StoreError."""
    given = Answers(store.folder).all()
    if not given:
        return None
    last, there = last_answers(given), {sheet.id for sheet in sheets(records)}
    current = tuple(answer for answer in last.values() if answer.sheet in there)
    return Study(current, len(last) - len(current))


def last_answers(given: Iterable[Answer]) -> dict[tuple[str, str], Answer]:
    """Returns the last answer of each rater to each sheet."""
    return {(answer.rater, answer.sheet): answer for answer in given}


# --- all answers as a table -----------------------------------------------------------------------

COLUMNS = (
    *("rater", "number", "of", "date", "prompt", "run", "pictures"),
    *("language", "position", "rank", "answer", "counts"),
)


def exported(given: Sequence[Answer], there: Sequence[Sheet]) -> str:
    """Returns all answers as CSV, one line for each language of each."""
    return csv_text([COLUMNS, *_lines(given, there)])


def _lines(given: Sequence[Answer], there: Sequence[Sheet]) -> Iterator[list[object]]:
    last, current = last_answers(given), {sheet.id for sheet in there}
    for answer in given:
        place = answer.number, answer.count, answer.date, answer.prompt, answer.run, answer.pictures
        kind = "cannot tell" if answer.ranking is None else "ranked" if answer.was_asked else "not asked"
        is_last = last[answer.rater, answer.sheet] is answer
        counts = "outdated" if answer.sheet not in current else "yes" if is_last else "replaced"
        ranks = answer.ranks()
        for language in (*answer.shown, *answer.undrawn):
            at = answer.shown.index(language) + 1 if language in answer.shown else ""
            yield [answer.rater, *place, language, at, ranks.get(language, ""), kind, counts]

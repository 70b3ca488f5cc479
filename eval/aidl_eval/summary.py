"""Figures from records: shares and means with their intervals, each with the number of its cases, and what
languages differ by.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations
from statistics import fmean, variance
from typing import Any

from aidl_eval.clip import Scores
from aidl_eval.judgements import Study
from aidl_eval.plan import VARIANTS, key_of
from aidl_eval.rendering import RenderedLanguage
from aidl_eval.statistics import Case, Comparison, Interval, by_prompt, compared, holm, interval, wilson

Record = Mapping[str, Any]


@dataclass(frozen=True)
class Share:
    """A proportion: `part` of `count`. `cases` are the conversations; where each may have `several` of the
    things counted, these are not independent.
    """

    part: int
    count: int
    cases: tuple[Case, ...] = field(default=(), compare=False, repr=False)
    several: bool = field(default=False, compare=False, repr=False)

    @classmethod
    def of(cls, counts: Iterable[tuple[str, int, int]], *, several: bool) -> Share:
        """Returns the share of prompts, parts and counts, one for each conversation."""
        found = tuple(Case(*count) for count in counts)
        return cls(int(sum(c.value for c in found)), int(sum(c.weight for c in found)), found, several)

    @property
    def value(self) -> float | None:
        return self.part / self.count if self.count else None

    @cached_property
    def interval(self) -> Interval | None:
        """Returns Wilson's interval where each conversation counts once, else that by drawing prompts."""
        if self.several:
            return interval(self.cases)
        return wilson(self.part, self.count) if self.count else None


@dataclass(frozen=True)
class Mean:
    """A mean of numbers with their sample variance (by n - 1)."""

    count: int
    value: float | None = None
    variance: float | None = None
    cases: tuple[Case, ...] = field(default=(), compare=False, repr=False)

    @classmethod
    def of(cls, numbers: Iterable[tuple[str, float | None]]) -> Mean:
        """Returns the mean of numbers, each with its prompt."""
        cases = tuple(Case(prompt, n) for prompt, n in numbers if n is not None)
        if not cases:
            return cls(0)
        known = [case.value for case in cases]
        spread = variance(known) if len(known) > 1 else None
        return cls(len(known), fmean(known), spread, cases=cases)

    @cached_property
    def interval(self) -> Interval | None:
        """Returns the interval by drawing prompts."""
        return interval(self.cases)


Figure = Share | Mean


@dataclass(frozen=True)
class Row:
    """The figures of some records; `prompt` is None for all of a variant."""

    variant: str
    prompt: str | None
    jobs: int
    broken_off: int
    figures: Mapping[str, Figure]


COMPARED = (
    *("valid at first", "valid", "attempts", "requirements", "editability", "detached"),
    *("tokens in", "tokens out", "seconds", "CLIP", "rank"),
)
"""Figures that languages are compared by."""


def rows(
    records: Sequence[Record], scores: Scores, per_prompt: bool = False, study: Study | None = None
) -> list[Row]:
    """Returns one row for each variant, or for each prompt in each variant, in the order of the records and
    variants.
    """
    found = []
    for prompt in dict.fromkeys(r["prompt"] for r in records) if per_prompt else (None,):
        for variant in VARIANTS:
            own = [r for r in records if r["variant"] == variant and prompt in (None, r["prompt"])]
            if own:
                held = [r for r in own if "failure" not in r]
                figures = _figures(held, scores)
                if study is not None:
                    figures["rank"] = Mean.of(study.ranks(variant, prompt))
                found.append(Row(variant, prompt, len(held), len(own) - len(held), figures))
    return found


@dataclass(frozen=True)
class Pair:
    """What two languages differ by in a figure."""

    figure: str
    first: str
    second: str
    comparison: Comparison


def pairs(
    variants: Sequence[Row], figures: Iterable[str] = COMPARED, against: str | None = None
) -> list[Pair]:
    """Returns the comparisons of all pairs of languages, or of all with the one `against`, by figures; the
    probabilities of a figure are corrected for how many there are.
    """
    names = [row.variant for row in variants]
    both = list(combinations(names, 2)) if against is None else [(v, against) for v in names if v != against]
    found = []
    for name in figures:
        of = {row.variant: by_prompt(row.figures[name].cases) for row in variants if name in row.figures}
        own = [(a, b, comparison) for a, b in both if of and (comparison := compared(of[a], of[b]))]
        adjusted = iter(holm([comparison.p for *_, comparison in own if comparison.p is not None]))
        found += [
            Pair(name, a, b, c if c.p is None else replace(c, adjusted=next(adjusted))) for a, b, c in own
        ]
    return found


def _figures(held: Sequence[Record], scores: Scores) -> dict[str, Figure]:
    valid = [r for r in held if r["ok"]]
    remembers = [r for r in held if not isinstance(VARIANTS[r["variant"]], RenderedLanguage)]
    edited = [r for r in valid if "edits" in r]
    return {
        "valid at first": _share(held, lambda r: _was_valid(r["attempts"][:1])),
        "valid": _share(held, lambda r: r["ok"]),
        "attempts": _mean(valid, _attempts),
        "fixes": _mean(remembers, lambda r: len(r["fixes"])),
        "intents lost": _mean(remembers, lambda r: len(r["missing"])),
        "structures": _number(valid, "structures"),
        "constraints": _number(valid, "constraints"),
        "degrees": _number(valid, "degrees"),
        "requirements": _shares(valid, "is_met", lambda r: r.get("requirements", ())),
        "editability": _shares(edited, "holds", lambda r: r["edits"]["edits"]),
        "knobs": _mean(edited, lambda r: r["edits"]["knobs"]),
        "detached": _number(valid, "detached"),
        "tokens in": _mean(held, lambda r: r["usage"]["input"]),
        "tokens out": _mean(held, lambda r: r["usage"]["output"]),
        "seconds": _mean(held, _seconds),
        "cost": _mean(held, lambda r: r["usage"]["cost"]),
        "CLIP": _mean(valid, lambda r: scores.of.get(key_of(r))),
    }


def _share(records: Sequence[Record], holds: Callable[[Record], bool]) -> Share:
    return Share.of(((r["prompt"], int(holds(r)), 1) for r in records), several=False)


def _shares(records: Sequence[Record], name: str, results: Callable[[Record], Sequence[Record]]) -> Share:
    """Returns the share of results with what is named, of which a record may have several."""
    found = [(r["prompt"], results(r)) for r in records]
    return Share.of(
        ((prompt, sum(one[name] for one in own), len(own)) for prompt, own in found), several=True
    )


def _mean(records: Sequence[Record], value: Callable[[Record], float | None]) -> Mean:
    return Mean.of((r["prompt"], value(r)) for r in records)


def _number(valid: Sequence[Record], name: str) -> Mean:
    return _mean(valid, lambda r: r.get("numbers", {}).get(name))


def _seconds(record: Record) -> float | None:
    """Returns the seconds of all replies, None if those of one are not known."""
    known = [attempt.get("seconds") for attempt in record["attempts"]]
    return None if None in known else sum(known)


def _was_valid(attempts: Sequence[Record]) -> bool:
    return any(a["verdict"] is not None and a["verdict"]["ok"] for a in attempts)


def _attempts(record: Record) -> int:
    """Returns the number of the first valid attempt; the last word may have made an earlier one valid."""
    attempts = record["attempts"]
    return next((n for n in range(1, len(attempts) + 1) if _was_valid(attempts[:n])), len(attempts))

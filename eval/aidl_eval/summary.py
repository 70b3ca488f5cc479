"""Figures from records: shares and means with their intervals, each with the number of its cases, and what
languages differ by.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations
from statistics import fmean, variance
from typing import Any

from aidl_eval.clip import Scores
from aidl_eval.editability import EditOutcome
from aidl_eval.plan import VARIANTS, key_of
from aidl_eval.preference import Study
from aidl_eval.rendering import RenderedLanguage
from aidl_eval.requirements import Status
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

    @property
    def interval(self) -> Interval | None:
        """Returns Wilson's interval where each conversation counts once, else that by drawing prompts."""
        if self.several:
            return interval(self.cases)
        return wilson(self.part, self.count) if self.count else None


@dataclass(frozen=True)
class Mean:
    """A mean of numbers with their sample variance (by n - 1); without any, the reason, if known, why nothing
    was measured.
    """

    count: int
    value: float | None = None
    variance: float | None = None
    reason: str = ""
    cases: tuple[Case, ...] = field(default=(), compare=False, repr=False)

    @classmethod
    def of(cls, numbers: Iterable[tuple[str, float | None]], reason: str = "") -> Mean:
        """Returns the mean of numbers, each with its prompt."""
        cases = tuple(Case(prompt, n) for prompt, n in numbers if n is not None)
        if not cases:
            return cls(0, reason=reason)
        known = [case.value for case in cases]
        spread = variance(known) if len(known) > 1 else None
        return cls(len(known), fmean(known), spread, cases=cases)

    @property
    def interval(self) -> Interval | None:
        """Returns the interval by drawing prompts."""
        return interval(self.cases)


@dataclass(frozen=True)
class Total:
    """A sum; `count` is the number of cases with a known value."""

    count: int
    value: float | None


Figure = Share | Mean | Total


@dataclass(frozen=True)
class Row:
    """The figures of some records; `prompt` is None for all of a variant."""

    variant: str
    prompt: str | None
    jobs: int
    broken_off: int
    figures: Mapping[str, Figure]


WITHIN = range(2, 6)
COMPARED = (
    *("valid at first", "valid", "attempts", "requirements", "editability", "detached"),
    *("tokens in", "tokens out", "seconds", "CLIP", "rank"),
)
"""Figures that languages are compared by."""

MEANINGS: Mapping[str, str] = {
    "valid at first": "conversations whose first reply held a valid program",
    **{
        f"valid within {n}": f"conversations with a valid program among their first {n} replies"
        for n in WITHIN
    },
    "valid": "conversations that came to a valid program within their attempts",
    "attempts": "attempts up to the first valid program, over conversations that came to one",
    "fixes": "fixes made by the machine, per conversation",
    "intents lost": "what earlier programs of a conversation meant and the last one lacks, per conversation",
    "structures": "per valid program; modules in OpenSCAD",
    "constraints": "per valid program",
    "degrees": "degrees of freedom left, per valid program",
    "requirements": "requirements on named parts that hold, of those examined in valid programs of AIDL",
    "geometry": "requirements on geometry alone that hold, the same in all languages",
    "edits hold": "edits of knobs after which requirements on geometry that were met before still are",
    "editability": "edits of knobs that solve with everything kept, of those tried in valid programs",
    "knobs": "named numbers to edit, per valid program",
    "detached": "pieces beyond the first that stand apart from all others, per valid program",
    "tokens in": "per conversation",
    "tokens out": "per conversation",
    "seconds": "until the model's replies were there, per conversation",
    "cost": "of all conversations, in dollars",
    "CLIP": "CLIP score, per valid program",
    "CLIP neutral": "CLIP score of the picture in the one style of all languages, per valid program",
    "rank": "place among the languages in the study, 1 for the best; without a picture the last",
    "preferred": "share of the other languages that raters placed it above in the study, ties a half",
}


def names(rows: Sequence[Row]) -> list[str]:
    """Returns the names of the figures that rows have: those of a study only where there is one."""
    return [name for name in MEANINGS if any(name in row.figures for row in rows)]


def rows(
    records: Sequence[Record],
    scores: Scores,
    per_prompt: bool = False,
    limit: int = WITHIN[-1],
    study: Study | None = None,
) -> list[Row]:
    """Returns one row for each variant, or for each prompt in each variant, in the order of the records and
    variants. `limit` is the number of attempts that conversations had.
    """
    found = []
    for prompt in dict.fromkeys(r["prompt"] for r in records) if per_prompt else (None,):
        for variant in VARIANTS:
            own = [r for r in records if r["variant"] == variant and prompt in (None, r["prompt"])]
            if own:
                held = [r for r in own if "failure" not in r]
                figures = _figures(held, scores, limit) | _judged(study, variant, prompt)
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
    variants: Sequence[Row],
    figures: Iterable[str] = COMPARED,
    against: str | None = None,
    study: Study | None = None,
) -> list[Pair]:
    """Returns the comparisons of all pairs of languages, or of all with the one `against`, by figures."""
    names = [row.variant for row in variants]
    both = list(combinations(names, 2)) if against is None else [(v, against) for v in names if v != against]
    found = []
    for name in figures:
        of = {row.variant: by_prompt(_cases(row.figures.get(name))) for row in variants}
        found += _corrected(name, {(a, b): compared(of[a], of[b]) for a, b in both})
    if study is not None:
        over = {(a, b): compared(study.over(a, b), study.over(b, a)) for a, b in both}
        found += _corrected("preferred", over)
    return found


def _corrected(name: str, found: Mapping[tuple[str, str], Comparison | None]) -> list[Pair]:
    """Returns the comparisons in one figure, with their probabilities corrected for how many there are."""
    own = [Pair(name, *languages, of) for languages, of in found.items() if of is not None]
    tested = [pair for pair in own if pair.comparison.p is not None]
    adjusted = dict(zip(map(id, tested), holm([p.comparison.p or 0.0 for p in tested]), strict=True))
    return [
        replace(pair, comparison=replace(pair.comparison, adjusted=adjusted.get(id(pair)))) for pair in own
    ]


def _judged(study: Study | None, variant: str, prompt: str | None) -> dict[str, Figure]:
    if study is None:
        return {}
    return {
        "rank": Mean.of(study.ranks(variant, prompt)),
        "preferred": Mean.of(study.preferred(variant, prompt)),
    }


def _cases(figure: Figure | None) -> tuple[Case, ...]:
    return () if figure is None or isinstance(figure, Total) else figure.cases


def _figures(held: Sequence[Record], scores: Scores, limit: int) -> dict[str, Figure]:
    valid = [r for r in held if r["ok"]]
    remembers = [r for r in held if not isinstance(VARIANTS[r["variant"]], RenderedLanguage)]
    edited = [r for r in valid if "edits" in r]
    costs = [r["usage"]["cost"] for r in held]
    return {
        "valid at first": _share(held, lambda r: _was_valid(r["attempts"][:1])),
        **{f"valid within {n}": _share(held if n <= limit else (), _within(n)) for n in WITHIN},
        "valid": _share(held, lambda r: r["ok"]),
        "attempts": _mean(valid, _attempts),
        "fixes": _mean(remembers, lambda r: len(r["fixes"])),
        "intents lost": _mean(remembers, lambda r: len(r["missing"])),
        "structures": _number(valid, "structures"),
        "constraints": _number(valid, "constraints"),
        "degrees": _number(valid, "degrees"),
        "requirements": Share.of((_met(r, is_geometric=False) for r in valid), several=True),
        "geometry": Share.of((_met(r, is_geometric=True) for r in valid), several=True),
        "edits hold": Share.of((_edits(r, "holds", True) for r in edited), several=True),
        "editability": Share.of((_edits(r, "outcome", EditOutcome.KEPT) for r in edited), several=True),
        "knobs": _mean(edited, lambda r: r["edits"]["knobs"]),
        "detached": _number(valid, "detached"),
        "tokens in": _mean(held, lambda r: r["usage"]["input"]),
        "tokens out": _mean(held, lambda r: r["usage"]["output"]),
        "seconds": _mean(held, _seconds),
        "cost": Total(sum(c is not None for c in costs), None if None in costs else sum(costs)),
        "CLIP": _mean(valid, lambda r: scores.of.get(key_of(r)), scores.reason or ""),
        "CLIP neutral": _mean(valid, lambda r: scores.neutral.get(key_of(r)), scores.reason or ""),
    }


def _share(records: Sequence[Record], holds: Callable[[Record], bool]) -> Share:
    return Share.of(((r["prompt"], int(holds(r)), 1) for r in records), several=False)


def _counted(of: Record, results: Sequence[Record], name: str, wanted: object) -> tuple[str, int, int]:
    """Returns the prompt of a record, how many results are as wanted, and how many there are."""
    return of["prompt"], sum(result.get(name) == wanted for result in results), len(results)


def _met(of: Record, *, is_geometric: bool) -> tuple[str, int, int]:
    asked = [x for x in of.get("requirements", ()) if bool(x.get("is_geometric")) == is_geometric]
    return _counted(of, asked, "status", Status.MET)


def _edits(of: Record, name: str, wanted: object) -> tuple[str, int, int]:
    return _counted(of, of["edits"]["edits"], name, wanted)


def _mean(records: Sequence[Record], value: Callable[[Record], float | None], reason: str = "") -> Mean:
    return Mean.of(((r["prompt"], value(r)) for r in records), reason)


def _number(valid: Sequence[Record], name: str) -> Mean:
    return _mean(valid, lambda r: r.get("numbers", {}).get(name))


def _seconds(record: Record) -> float | None:
    """Returns the seconds of all replies, None if those of one are not known."""
    known = [attempt.get("seconds") for attempt in record["attempts"]]
    return None if None in known else sum(known)


def _within(number: int) -> Callable[[Record], bool]:
    return lambda r: _was_valid(r["attempts"][:number]) or (r["ok"] and len(r["attempts"]) <= number)


def _was_valid(attempts: Sequence[Record]) -> bool:
    return any(a["verdict"] is not None and a["verdict"]["ok"] for a in attempts)


def _attempts(record: Record) -> int:
    """Returns the number of the first valid attempt; the last word may have made an earlier one valid."""
    attempts = record["attempts"]
    return next((n for n in range(1, len(attempts) + 1) if _was_valid(attempts[:n])), len(attempts))

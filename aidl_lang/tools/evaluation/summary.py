"""Figures from records: shares with their intervals and means, each with the number of its cases."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from statistics import fmean, pvariance
from typing import Any

from aidl_lang.common.records import record
from aidl_lang.tools.evaluation.clip import Scores
from aidl_lang.tools.evaluation.editability import EditOutcome
from aidl_lang.tools.evaluation.plan import VARIANTS
from aidl_lang.tools.evaluation.rendering import RenderedLanguage
from aidl_lang.tools.evaluation.requirements import Status

Record = Mapping[str, Any]
_Z = 1.959963984540054
"""Quantile of the normal distribution: 95 % lie within."""


@record()
class Share:
    """A proportion: `part` of `count`."""

    part: int
    count: int

    @property
    def value(self) -> float | None:
        return self.part / self.count if self.count else None

    @property
    def interval(self) -> tuple[float, float] | None:
        """Returns Wilson's score interval at 95 % (Journal of the American Statistical Association 22, 1927,
        209).
        """
        if not self.count:
            return None
        n, p, z2 = self.count, self.part / self.count, _Z * _Z
        middle = (p + z2 / (2 * n)) / (1 + z2 / n)
        half = _Z / (1 + z2 / n) * math.sqrt(p * (1 - p) / n + z2 / (4 * n * n))
        return max(0.0, middle - half), min(1.0, middle + half)


@record()
class Mean:
    """A mean of numbers; without any, the reason, if known, why nothing was measured."""

    count: int
    value: float | None = None
    variance: float | None = None
    reason: str = ""

    @classmethod
    def of(cls, numbers: Iterable[float | None], reason: str = "") -> Mean:
        known = [n for n in numbers if n is not None]
        return cls(len(known), fmean(known), pvariance(known)) if known else cls(0, reason=reason)


@record()
class Total:
    """A sum; `count` is the number of cases with a known value."""

    count: int
    value: float | None


Figure = Share | Mean | Total


@record()
class Row:
    """The figures of some records; `prompt` is None for all of a variant."""

    variant: str
    prompt: str | None
    jobs: int
    broken_off: int
    figures: Mapping[str, Figure]


MEANINGS: Mapping[str, str] = {
    "valid at first": "conversations whose first reply held a valid program",
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
    "cost": "of all conversations, in dollars",
    "CLIP": "CLIP score, per valid program",
    "CLIP neutral": "CLIP score of the picture in the one style of all languages, per valid program",
}


def rows(records: Sequence[Record], scores: Scores, per_prompt: bool = False) -> list[Row]:
    """Returns one row for each variant, or for each prompt in each variant, in the order of the records and
    variants.
    """
    found = []
    for prompt in dict.fromkeys(r["prompt"] for r in records) if per_prompt else (None,):
        for variant in VARIANTS:
            own = [r for r in records if r["variant"] == variant and prompt in (None, r["prompt"])]
            if own:
                held = [r for r in own if "failure" not in r]
                found.append(Row(variant, prompt, len(held), len(own) - len(held), _figures(held, scores)))
    return found


def _figures(held: Sequence[Record], scores: Scores) -> dict[str, Figure]:
    valid = [r for r in held if r["ok"]]
    results = [result for r in valid for result in r.get("requirements", ())]
    asked, geometric = ([x for x in results if bool(x.get("is_geometric")) == kind] for kind in (False, True))
    edits = [edit for r in valid if "edits" in r for edit in r["edits"]["edits"]]
    remembers = [r for r in held if not isinstance(VARIANTS[r["variant"]], RenderedLanguage)]
    costs = [r["usage"]["cost"] for r in held]
    return {
        "valid at first": Share(sum(_was_valid(r["attempts"][:1]) for r in held), len(held)),
        "valid": Share(len(valid), len(held)),
        "attempts": Mean.of(_attempts(r) for r in valid),
        "fixes": Mean.of(len(r["fixes"]) for r in remembers),
        "intents lost": Mean.of(len(r["missing"]) for r in remembers),
        "structures": _mean(valid, "structures"),
        "constraints": _mean(valid, "constraints"),
        "degrees": _mean(valid, "degrees"),
        "requirements": Share(sum(result["status"] == Status.MET for result in asked), len(asked)),
        "geometry": Share(sum(result["status"] == Status.MET for result in geometric), len(geometric)),
        "edits hold": Share(sum(bool(edit.get("holds")) for edit in edits), len(edits)),
        "editability": Share(sum(edit["outcome"] == EditOutcome.KEPT for edit in edits), len(edits)),
        "knobs": Mean.of(r["edits"]["knobs"] for r in valid if "edits" in r),
        "detached": _mean(valid, "detached"),
        "tokens in": Mean.of(r["usage"]["input"] for r in held),
        "tokens out": Mean.of(r["usage"]["output"] for r in held),
        "cost": Total(sum(c is not None for c in costs), None if None in costs else sum(costs)),
        "CLIP": Mean.of((scores.of.get(_key(r)) for r in valid), scores.reason or ""),
        "CLIP neutral": Mean.of((scores.neutral.get(_key(r)) for r in valid), scores.reason or ""),
    }


def _mean(valid: Sequence[Record], name: str) -> Mean:
    return Mean.of(r.get("numbers", {}).get(name) for r in valid)


def _key(record: Record) -> str:
    return f"{record['prompt']}/{record['variant']}/{record['run']}"


def _was_valid(attempts: Sequence[Record]) -> bool:
    return any(a["verdict"] is not None and a["verdict"]["ok"] for a in attempts)


def _attempts(record: Record) -> int:
    """Returns the number of the first valid attempt; the last word may have made an earlier one valid."""
    attempts = record["attempts"]
    return next((n for n in range(1, len(attempts) + 1) if _was_valid(attempts[:n])), len(attempts))

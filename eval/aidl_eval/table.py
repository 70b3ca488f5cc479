"""The figures as Markdown for readers, CSV for spreadsheets and JSON for programs."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from math import sqrt
from typing import TypeAlias

from aidl_eval.preference import Study
from aidl_eval.statistics import RESAMPLES, SEED, Interval
from aidl_eval.summary import MEANINGS, Figure, Mean, Pair, Row, Share, Total, names
from aidl_lang.common.prose import counted
from aidl_lang.common.world import csv_text

_NONE = "–"
_BY_PROMPT = ("valid", "requirements", "editability")


def markdown(
    rows: Sequence[Row],
    prompts: Sequence[Row],
    pairs: Sequence[Pair] = (),
    notes: Sequence[str] = (),
    study: Study | None = None,
) -> str:
    """Returns one column for each variant, what pairs of them differ by, what raters say, then the prompts
    one by one, then a key to the lines. `notes` tell what must be known of the conversations.
    """
    head = ["", *(row.variant for row in rows)]
    lines = [["conversations", *(_conversations(row) for row in rows)]]
    lines += [[name, *(shown(row.figures[name]) for row in rows)] for name in names(rows)]
    parts = [
        "# Evaluation",
        *(f"Note on {note}." for note in notes),
        "In square brackets 95 % intervals: Wilson's for conversations, for the rest by drawing prompts with "
        f"replacement ({RESAMPLES:,} resamples). After ± the standard deviation; in round brackets what "
        "figures are taken over.",
        tabulated([head, *lines]),
        *_reasons(rows),
        *_differences(pairs),
        *_study(rows, pairs, study),
        "## By prompt",
        f"In each cell: {', '.join(_BY_PROMPT)}.",
        _by_prompt(rows, prompts),
        "## What the lines mean",
        "\n".join(f"- {name}: {MEANINGS[name]}" for name in names(rows)),
    ]
    return "\n\n".join(parts) + "\n"


def shown(figure: Figure) -> str:
    """Returns the text of a figure in a cell."""
    match figure:
        case Share(part, count) if count:
            return f"{100 * part / count:.0f} %{_between(figure.interval, 100, 0)} ({part}/{count})"
        case Mean(count, float(value), variance):
            digits = 2 if value < 1000 else 0
            spread = "" if variance is None else f" ± {sqrt(variance):,.{digits}f}"
            return f"{value:,.{digits}f}{spread}{_between(figure.interval, 1, digits)} ({count})"
        case Mean(reason=reason) if reason:
            return "not measured"
        case Total(count, value) if count:
            return "unknown" if value is None else f"{value:.4f} ({count})"
    return _NONE


def _between(interval: Interval | None, times: float, digits: int) -> str:
    if interval is None:
        return ""
    low, high = (f"{times * end:,.{digits}f}" for end in interval)
    return f" [{low}–{high}]" if not low.startswith("-") else f" [{low} to {high}]"


def _differences(pairs: Sequence[Pair]) -> list[str]:
    if not pairs:
        return []
    return [
        "## Pairs of languages",
        "The first less the second, by prompt: each prompt that has the figure in both counts once (1.00 is "
        "100 %). Two-sided p of the paired permutation test; Holm's correction is for the pairs of one "
        "figure. Figures of valid programs compare only prompts where both languages came to one.",
        compared(pairs, "languages", "prompts"),
    ]


def compared(pairs: Sequence[Pair], of: str, over: str) -> str:
    """Returns the table of differences between pairs `of` something, `over` that by which they are drawn."""
    head = ["", of, "difference", over, "p", "p, Holm"]
    lines = []
    for pair in pairs:
        found = pair.comparison
        digits = 2 if abs(found.difference) < 1000 else 0
        shown = f"{found.difference:+,.{digits}f}{_between(found.interval, 1, digits)}"
        chances = (_NONE if p is None else f"{p:.3f}" for p in (found.p, found.adjusted))
        lines.append([pair.figure, f"{pair.first} − {pair.second}", shown, str(found.prompts), *chances])
    return tabulated([head, *lines])


def _study(rows: Sequence[Row], pairs: Sequence[Pair], study: Study | None) -> list[str]:
    if study is None:
        return []
    agreed = "not to be had" if study.alpha is None else f"{study.alpha:.3f}"
    said = [
        f"{counted(len(study.raters), 'rater')} and {counted(study.judgements, 'judgement')}; "
        f"{counted(study.skipped, 'time')} a rater could not tell.",
        f"Their agreement, Krippendorff's alpha of ranks: {agreed}.",
    ]
    if study.unasked:
        said.append(f"{counted(study.unasked, 'answer')} followed without a rater: fewer than two had drawn.")
    if study.outdated:
        said.append(f"Left out: {counted(study.outdated, 'answer')} to what is no longer there as it was.")
    return ["## Study", " ".join(said), *_preferred(rows, pairs)]


def _preferred(rows: Sequence[Row], pairs: Sequence[Pair]) -> list[str]:
    cells = {}
    for pair in pairs:
        if pair.figure == "preferred":
            of = pair.comparison
            low, high = of.interval or (None, None)
            cells[pair.first, pair.second] = _half(of.difference, low, high)
            turned = (None, None) if high is None or low is None else (-high, -low)
            cells[pair.second, pair.first] = _half(-of.difference, *turned)
    if not cells:
        return []
    variants = [row.variant for row in rows]
    lines = [[first, *(cells.get((first, second), _NONE) for second in variants)] for first in variants]
    how = "How often the language of the line was placed above that of the column, by prompt, ties a half."
    return [how, tabulated([["", *variants], *lines])]


def _half(difference: float, low: float | None, high: float | None) -> str:
    """Returns a share from how much it exceeds that of the opposite."""
    between = None if low is None or high is None else ((1 + low) / 2, (1 + high) / 2)
    return f"{50 * (1 + difference):.0f} %{_between(between, 100, 0)}"


def _conversations(row: Row) -> str:
    return f"{row.jobs}, and {row.broken_off} that broke off" if row.broken_off else str(row.jobs)


def _reasons(rows: Sequence[Row]) -> list[str]:
    found = {
        f"{name} was not measured: {figure.reason}.": None
        for row in rows
        for name, figure in row.figures.items()
        if isinstance(figure, Mean) and figure.value is None and figure.reason
    }
    return list(found)


def _by_prompt(rows: Sequence[Row], prompts: Sequence[Row]) -> str:
    variants = [row.variant for row in rows]
    cells = {(row.prompt, row.variant): ", ".join(_parts(row)) for row in prompts}
    names = dict.fromkeys(row.prompt or "" for row in prompts)
    return tabulated([["", *variants], *([n, *(cells.get((n, v), _NONE) for v in variants)] for n in names)])


def _parts(row: Row) -> list[str]:
    shares = [row.figures[name] for name in _BY_PROMPT]
    return [f"{s.part}/{s.count}" if isinstance(s, Share) and s.count else _NONE for s in shares]


def tabulated(lines: Sequence[Sequence[str]]) -> str:
    """Returns lines of cells as a table in Markdown, under the first of them."""
    cells = [[cell.replace("|", "\\|") for cell in line] for line in lines]
    head, *body = (f"| {' | '.join(line)} |" for line in cells)
    return "\n".join([head, "|---" * len(lines[0]) + "|", *body])


_FIELDS = ("value", "count", "part", "low", "high", "variance", "reason", "p", "p_holm")
Entry: TypeAlias = dict[str, object]


def _entry(
    figure: str,
    prompt: str | None = None,
    variant: str | None = None,
    against: str | None = None,
    interval: Interval | None = None,
    **known: object,
) -> Entry:
    """Returns a figure as data: where it is from, and all fields, those that are not known empty."""
    known["low"], known["high"] = interval or (None, None)
    place = {"prompt": prompt, "variant": variant, "against": against, "figure": figure}
    return {**place, **{name: known.get(name) for name in _FIELDS}}


def _of_row(row: Row) -> Iterator[Entry]:
    for name, figure in row.figures.items():
        known: Entry = {"value": figure.value, "count": figure.count}
        if isinstance(figure, Share):
            known |= {"part": figure.part, "interval": figure.interval}
        elif isinstance(figure, Mean):
            known |= {"variance": figure.variance, "reason": figure.reason or None}
            known["interval"] = figure.interval
        yield _entry(name, row.prompt, row.variant, **known)  # type: ignore[arg-type]


def _of_pair(pair: Pair) -> Entry:
    """Returns a comparison: `value` is the difference, `count` the prompts."""
    of = pair.comparison
    known = {"value": of.difference, "count": of.prompts, "p": of.p, "p_holm": of.adjusted}
    return _entry(pair.figure, None, pair.first, pair.second, of.interval, **known)


def _of_study(study: Study | None) -> list[Entry]:
    names = ("judgements", "skipped", "unasked", "outdated", "alpha")
    if study is None:
        return []
    known = {"raters": len(study.raters), **{name: getattr(study, name) for name in names}}
    return [_entry(name, value=value) for name, value in known.items()]


def to_csv(rows: Sequence[Row], pairs: Sequence[Pair] = (), study: Study | None = None) -> str:
    """Returns one line for each figure of each row, then one for each comparison, then those of a study."""
    columns = ("prompt", "variant", "against", "figure", *_FIELDS)
    lines = [*(line for row in rows for line in _of_row(row)), *map(_of_pair, pairs), *_of_study(study)]
    return csv_text([columns, *([line.get(column) for column in columns] for line in lines)])


def to_json(
    rows: Sequence[Row], prompts: Sequence[Row], pairs: Sequence[Pair] = (), study: Study | None = None
) -> str:
    """Returns the same as data, with how intervals and probabilities were had."""
    lines: dict[str, object] = {
        "variants": [line for row in rows for line in _of_row(row)],
        "prompts": [line for row in prompts for line in _of_row(row)],
        "pairs": list(map(_of_pair, pairs)),
        **({} if study is None else {"study": _of_study(study)}),
        "method": {"resamples": RESAMPLES, "seed": SEED, "test": "paired permutation, two-sided"},
    }
    return json.dumps(lines, indent=1, ensure_ascii=False) + "\n"

"""The figures as Markdown for readers, CSV for spreadsheets and JSON for programs."""

from __future__ import annotations

import json
from collections.abc import Sequence
from math import sqrt

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
    """Returns an interval to stand behind a figure."""
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
    """Returns the table of how often each language was placed above each other."""
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
    """Returns the reasons for missing measures, each once."""
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


def data(row: Row) -> list[dict[str, object]]:
    """Returns the figures of a row, one by one, with all their data."""
    return [
        {"prompt": row.prompt, "variant": row.variant, "against": None, "figure": name, **_fields(figure)}
        for name, figure in row.figures.items()
    ]


_FIELDS = ("value", "count", "part", "low", "high", "variance", "reason", "p", "p_holm")


def _fields(figure: Figure) -> dict[str, object]:
    found: dict[str, object]
    match figure:
        case Share(part, count):
            low, high = figure.interval or (None, None)
            found = {"value": figure.value, "count": count, "part": part, "low": low, "high": high}
        case Mean(count, value, variance, reason):
            low, high = figure.interval or (None, None)
            found = {"value": value, "count": count, "low": low, "high": high}
            found |= {"variance": variance, "reason": reason or None}
        case Total(count, value):
            found = {"value": value, "count": count}
    return {name: found.get(name) for name in _FIELDS}


def differences(pairs: Sequence[Pair]) -> list[dict[str, object]]:
    """Returns the comparisons in the same form: `value` is the difference, `count` the prompts."""
    found = []
    for pair in pairs:
        of = pair.comparison
        low, high = of.interval or (None, None)
        known: dict[str, object] = {"value": of.difference, "count": of.prompts, "low": low, "high": high}
        known |= {"p": of.p, "p_holm": of.adjusted}
        place = {"prompt": None, "variant": pair.first, "against": pair.second, "figure": pair.figure}
        found.append({**place, **{name: known.get(name) for name in _FIELDS}})
    return found


def judgements(study: Study | None) -> list[dict[str, object]]:
    """Returns the figures of a study as a whole in the same form."""
    if study is None:
        return []
    known = {
        "raters": len(study.raters),
        "judgements": study.judgements,
        "skipped": study.skipped,
        "unasked": study.unasked,
        "outdated": study.outdated,
        "alpha": study.alpha,
    }
    place = {"prompt": None, "variant": None, "against": None}
    empty = dict.fromkeys(_FIELDS)
    return [{**place, "figure": name, **empty, "value": value} for name, value in known.items()]


def to_csv(rows: Sequence[Row], pairs: Sequence[Pair] = (), study: Study | None = None) -> str:
    """Returns one line for each figure of each row, then one for each comparison, then those of a study."""
    columns = ("prompt", "variant", "against", "figure", *_FIELDS)
    lines = [*(line for row in rows for line in data(row)), *differences(pairs), *judgements(study)]
    return csv_text([columns, *([line.get(column) for column in columns] for line in lines)])


def to_json(
    rows: Sequence[Row], prompts: Sequence[Row], pairs: Sequence[Pair] = (), study: Study | None = None
) -> str:
    """Returns the same as data, with how intervals and probabilities were had."""
    lines: dict[str, object]
    lines = {"variants": [line for row in rows for line in data(row)]}
    lines["prompts"] = [line for row in prompts for line in data(row)]
    lines["pairs"] = differences(pairs)
    if study is not None:
        lines["study"] = judgements(study)
    lines["method"] = {"resamples": RESAMPLES, "seed": SEED, "test": "paired permutation, two-sided"}
    return json.dumps(lines, indent=1, ensure_ascii=False) + "\n"

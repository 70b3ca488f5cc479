"""The figures as Markdown for readers, and as CSV for spreadsheets and programs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import sqrt

from aidl_eval.judgements import Study
from aidl_eval.statistics import RESAMPLES, Interval
from aidl_eval.summary import Figure, Mean, Pair, Row, Share
from aidl_lang.common.prose import counted
from aidl_lang.common.world import csv_text

_NONE = "–"


def markdown(
    rows: Sequence[Row], pairs: Sequence[Pair] = (), notes: Sequence[str] = (), study: Study | None = None
) -> str:
    """Returns one column for each variant, what pairs of them differ by, and what raters say. `notes` tell
    what must be known of the conversations.
    """
    head = ["", *(row.variant for row in rows)]
    lines = [["conversations", *(_conversations(row) for row in rows)]]
    lines += [
        [name, *(shown(row.figures[name]) for row in rows)] for name in (rows[0].figures if rows else ())
    ]
    parts = [
        "# Evaluation",
        *notes,
        "In square brackets 95 % intervals: Wilson's for conversations, for the rest by drawing prompts with "
        f"replacement ({RESAMPLES:,} resamples). After ± the standard deviation; in round brackets what "
        "figures are taken over.",
        tabulated([head, *lines]),
        *_differences(pairs),
        *_study(study),
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


def _study(study: Study | None) -> list[str]:
    if study is None:
        return []
    agreed = "not to be had" if study.alpha is None else f"{study.alpha:.3f}"
    said = [
        f"{counted(study.raters, 'rater')} and {counted(study.judgements, 'judgement')}; "
        f"{counted(study.skipped, 'time')} a rater could not tell.",
        f"Their agreement, Krippendorff's alpha of ranks: {agreed}.",
    ]
    if study.outdated:
        said.append(f"Left out: {counted(study.outdated, 'answer')} to what is no longer there as it was.")
    return ["## Study", " ".join(said)]


def _conversations(row: Row) -> str:
    return f"{row.jobs}, and {row.broken_off} that broke off" if row.broken_off else str(row.jobs)


def tabulated(lines: Sequence[Sequence[str]]) -> str:
    """Returns lines of cells as a table in Markdown, under the first of them."""
    cells = [[cell.replace("|", "\\|") for cell in line] for line in lines]
    head, *body = (f"| {' | '.join(line)} |" for line in cells)
    return "\n".join([head, "|---" * len(lines[0]) + "|", *body])


_COLUMNS = "prompt variant against figure value count part low high variance p p_holm".split()


def to_csv(rows: Sequence[Row], pairs: Sequence[Pair] = (), study: Study | None = None) -> str:
    """Returns one line for each figure of each row, then one for each comparison, in which `value` is the
    difference and `count` the prompts, then those of a study.
    """
    lines = [*(line for row in rows for line in _of_row(row)), *map(_of_pair, pairs), *_of_study(study)]
    return csv_text([_COLUMNS, *([line.get(column) for column in _COLUMNS] for line in lines)])


def _of_row(row: Row) -> Iterator[Mapping[str, object]]:
    for name, figure in row.figures.items():
        known: dict[str, object] = {"value": figure.value, "count": figure.count, **_ends(figure.interval)}
        if isinstance(figure, Share):
            known["part"] = figure.part
        else:
            known["variance"] = figure.variance
        yield {"prompt": row.prompt, "variant": row.variant, "figure": name, **known}


def _of_pair(pair: Pair) -> Mapping[str, object]:
    of = pair.comparison
    known = {"value": of.difference, "count": of.prompts, "p": of.p, "p_holm": of.adjusted}
    return {
        "variant": pair.first,
        "against": pair.second,
        "figure": pair.figure,
        **known,
        **_ends(of.interval),
    }


def _ends(interval: Interval | None) -> Mapping[str, object]:
    return dict(zip(("low", "high"), interval or (), strict=False))


def _of_study(study: Study | None) -> Iterator[Mapping[str, object]]:
    if study is not None:
        for name in ("raters", "judgements", "skipped", "outdated", "alpha"):
            yield {"figure": name, "value": getattr(study, name)}

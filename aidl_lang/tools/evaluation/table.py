"""The figures as Markdown for readers, CSV for spreadsheets and JSON for programs."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Sequence

from aidl_lang.tools.evaluation.summary import MEANINGS, Figure, Mean, Row, Share, Total

_NONE = "–"
_BY_PROMPT = ("valid", "requirements", "editability")


def markdown(rows: Sequence[Row], prompts: Sequence[Row]) -> str:
    """Returns one column for each variant, then the prompts one by one, then a key to the lines."""
    head = ["", *(row.variant for row in rows)]
    lines = [["conversations", *(_conversations(row) for row in rows)]]
    lines += [[name, *(shown(row.figures[name]) for row in rows)] for name in MEANINGS]
    parts = [
        "# Evaluation",
        "Shares stand with their 95 % interval (Wilson); in brackets what they and the means are taken over.",
        _table([head, *lines]),
        *_reasons(rows),
        "## By prompt",
        f"In each cell: {', '.join(_BY_PROMPT)}.",
        _by_prompt(rows, prompts),
        "## What the lines mean",
        "\n".join(f"- {name}: {meaning}" for name, meaning in MEANINGS.items()),
    ]
    return "\n\n".join(parts) + "\n"


def shown(figure: Figure) -> str:
    """Returns the text of a figure in a cell."""
    match figure:
        case Share(part, count) if figure.interval is not None:
            low, high = figure.interval
            return f"{100 * part / count:.0f} % [{100 * low:.0f}–{100 * high:.0f}] ({part}/{count})"
        case Mean(count, float(value)):
            return f"{value:,.2f} ({count})" if value < 1000 else f"{value:,.0f} ({count})"
        case Mean(reason=reason) if reason:
            return "not measured"
        case Total(count, value) if count:
            return "unknown" if value is None else f"{value:.4f} ({count})"
    return _NONE


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
    return _table([["", *variants], *([n, *(cells.get((n, v), _NONE) for v in variants)] for n in names)])


def _parts(row: Row) -> list[str]:
    shares = [row.figures[name] for name in _BY_PROMPT]
    return [f"{s.part}/{s.count}" if isinstance(s, Share) and s.count else _NONE for s in shares]


def _table(lines: Sequence[Sequence[str]]) -> str:
    cells = [[cell.replace("|", "\\|") for cell in line] for line in lines]
    head, *body = (f"| {' | '.join(line)} |" for line in cells)
    return "\n".join([head, "|---" * len(lines[0]) + "|", *body])


def data(row: Row) -> list[dict[str, object]]:
    """Returns the figures of a row, one by one, with all their data."""
    return [
        {"prompt": row.prompt, "variant": row.variant, "figure": name, **_fields(figure)}
        for name, figure in row.figures.items()
    ]


_FIELDS = ("value", "count", "part", "low", "high", "variance", "reason")


def _fields(figure: Figure) -> dict[str, object]:
    found: dict[str, object]
    match figure:
        case Share(part, count):
            low, high = figure.interval or (None, None)
            found = {"value": figure.value, "count": count, "part": part, "low": low, "high": high}
        case Mean(count, value, variance, reason):
            found = {"value": value, "count": count, "variance": variance, "reason": reason or None}
        case Total(count, value):
            found = {"value": value, "count": count}
    return {name: found.get(name) for name in _FIELDS}


def to_csv(rows: Sequence[Row]) -> str:
    """Returns one line for each figure of each row."""
    out = io.StringIO()
    writer = csv.DictWriter(out, ("prompt", "variant", "figure", *_FIELDS), lineterminator="\n")
    writer.writeheader()
    writer.writerows(line for row in rows for line in data(row))
    return out.getvalue()


def to_json(rows: Sequence[Row], prompts: Sequence[Row]) -> str:
    lines = {"variants": [line for row in rows for line in data(row)]}
    lines["prompts"] = [line for row in prompts for line in data(row)]
    return json.dumps(lines, indent=1, ensure_ascii=False) + "\n"

"""Writes tables as CSV of which no cell is taken for a formula by the program that opens it."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable

_FORMULA = ("=", "+", "-", "@", "\t", "\r")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


def csv_text(rows: Iterable[Iterable[object]], end: str = "\n") -> str:
    """Returns rows of cells as CSV. A text that begins as formulas do, and is no number, gets a mark: `'`."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator=end)
    writer.writerows([_harmless(cell) for cell in row] for row in rows)
    return out.getvalue()


def _harmless(cell: object) -> object:
    is_formula = isinstance(cell, str) and cell.startswith(_FORMULA) and not _NUMBER.fullmatch(cell)
    return f"'{cell}" if is_formula else cell

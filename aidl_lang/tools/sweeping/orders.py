"""Reads a table whose rows are variants: its columns are params, and whatever else an order has."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

from aidl_lang.building.model import Knob
from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.files import Reads
from aidl_lang.common.names import fold, nearest
from aidl_lang.common.prose import did_you_mean, first_few, named, ticked
from aidl_lang.tools.sweeping.axes import MOST, Value, value
from aidl_lang.tools.sweeping.plan import Rows

_MOST_BYTES = 500_000_000
_LONGEST_CELL = 1_000_000
_SEPARATORS = {";": "semicolons", "\t": "tabs", "|": "bars"}


def read_table(path: Path, knobs: Sequence[Knob], reads: Reads) -> Rows:
    """Returns the rows of a CSV file. An empty cell leaves its param as written. Raises AidlError."""
    rows = _cells(path, reads)
    try:
        _, head = next(rows)
    except StopIteration:
        raise _wrong(f"`{path}` is empty", "its first line names the params") from None
    if len(head) == 1 and (others := [name for mark, name in _SEPARATORS.items() if mark in head[0]]):
        raise _wrong(
            f"the cells of `{path}` are separated by {others[0]}, not by commas",
            "save it with commas as separators, and numbers with points: `12.5`",
        )
    columns = _columns(path, head, knobs)
    params = [(k, knob) for k, knob in enumerate(columns) if knob is not None]
    labels = [(k, name.strip()) for k, name in enumerate(head) if columns[k] is None]
    values: list[dict[str, Value]] = []
    labelled: list[dict[str, str]] = []
    for line, row in rows:
        if not any(row):
            continue
        if len(row) != len(head):
            raise _wrong(f"line {line} of `{path}` has {len(row)} cells, its first line {len(head)}")
        if len(values) == MOST:
            raise _wrong(f"`{path}` has more than {MOST} rows", "sweep a part of them at a time")
        values.append({knob.path: value(knob, row[k]) for k, knob in params if row[k]})
        labelled.append({name: row[k] for k, name in labels})
    if not values:
        raise _wrong(f"`{path}` has no rows below its first line")
    return Rows(
        tuple(knob.path for _, knob in params),
        tuple(name for _, name in labels),
        tuple(values),
        tuple(labelled),
    )


def _cells(path: Path, reads: Reads):  # type: ignore[no-untyped-def]
    """Yields the rows of a CSV file, each with the number of its line."""
    try:
        text = reads.contents(path, _MOST_BYTES).decode("utf-8-sig")
    except FileNotFoundError:
        raise _wrong(f"there is no file `{path}`") from None
    except OSError as error:
        raise _wrong(f"`{path}` cannot be read: {(error.strerror or str(error)).lower()}") from None
    except UnicodeDecodeError as error:
        raise _wrong(f"`{path}` is not UTF-8 text (byte {error.start})", "save it as CSV in UTF-8") from None
    csv.field_size_limit(_LONGEST_CELL)
    reader = csv.reader(text.splitlines(keepends=True), strict=True)
    while True:
        try:
            row = next(reader)
        except StopIteration:
            return
        except csv.Error as error:
            raise _wrong(f"line {reader.line_num} of `{path}` is no CSV: {error}") from None
        yield reader.line_num, row


def _columns(path: Path, head: Sequence[str], knobs: Sequence[Knob]) -> list[Knob | None]:
    """Returns the params of the columns; None for a column that is none and resembles none."""
    by_name = {fold(knob.path): knob for knob in knobs}
    paths = [knob.path for knob in knobs]
    found: list[Knob | None] = []
    seen: set[str] = set()
    for name in map(str.strip, head):
        if not name:
            raise _wrong(f"a column of `{path}` has no name", "its first line names the params")
        if fold(name) in seen:
            raise _wrong(f"`{path}` has two columns `{name}`")
        seen.add(fold(name))
        knob = by_name.get(fold(name))
        if knob is None and (near := nearest(name, paths)):
            raise _wrong(
                f"`{path}` has a column `{name}`, and there is no such param", *did_you_mean(near[:1])
            )
        found.append(knob)
    if not any(found):
        known = first_few(ticked(paths), 12) or "none"
        raise _wrong(
            f"no column of `{path}` is a param: it has {named(head)}", f"params of this program: {known}"
        )
    return found


def _wrong(message: str, *hints: str) -> AidlError:
    return AidlError(Diagnostic("E0972", message, hints=hints))

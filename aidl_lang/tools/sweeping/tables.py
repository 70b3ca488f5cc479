"""Tables of a sweep: CSV, JSON lines, Parquet, and what Arrow and pandas have."""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from aidl_lang.common.files import csv_text
from aidl_lang.export import require
from aidl_lang.tools.sweeping.axes import shown
from aidl_lang.tools.sweeping.rows import Cell, Columns, Row, as_mapping

if TYPE_CHECKING:
    import pyarrow

ARROW_EXTRA = "parquet"


def to_csv(columns: Columns, rows: Sequence[Row]) -> bytes:
    """Returns a table as CSV, with a byte order mark: lists are joined by semicolons, nothing stands where
    nothing is known.
    """
    cells = ([_csv(cell) for cell in columns.cells(row)] for row in rows)
    return csv_text([columns.names, *cells]).encode("utf-8-sig", "backslashreplace")


def _csv(cell: Cell) -> str:
    if cell is None:
        return ""
    if isinstance(cell, list):
        return "; ".join(cell)
    return str(cell) if isinstance(cell, int) and not isinstance(cell, bool) else shown(cell)


def to_json_lines(columns: Columns, rows: Sequence[Row]) -> bytes:
    """Returns a table as JSON lines, one object a row."""
    lines = (
        json.dumps(as_mapping(columns.names, columns.cells(row)), ensure_ascii=False, allow_nan=False)
        for row in rows
    )
    return "".join(f"{line}\n" for line in lines).encode("utf-8", "backslashreplace")


def to_parquet(columns: Columns, rows: Sequence[Row]) -> bytes:
    """Returns a table as Parquet."""
    table = to_arrow(columns, rows)
    import pyarrow.parquet

    out = io.BytesIO()
    pyarrow.parquet.write_table(table, out)
    return out.getvalue()


def to_arrow(columns: Columns, rows: Sequence[Row]) -> pyarrow.Table:
    """Returns a table as Arrow has it. A column that has numbers and texts is of texts. Raises AidlError
    without pyarrow.
    """
    require("pyarrow", "a table of Arrow", ARROW_EXTRA)
    import pyarrow

    found = [columns.cells(row) for row in rows]
    data = {}
    for k, name in enumerate(columns.names):
        cells = [cells[k] for cells in found]
        data[name] = pyarrow.array([_typed(cell, _kind(cells)) for cell in cells], _arrow(_kind(cells)))
    return pyarrow.table(data)


def _kind(cells: Sequence[Cell]) -> type:
    kinds = {type(cell) for cell in cells if cell is not None}
    if kinds <= {int, float} and float in kinds:
        return float
    return kinds.pop() if len(kinds) == 1 else str


def _typed(cell: Cell, kind: type) -> object:
    if cell is None or kind is not str:
        return cell
    return shown(cell) if not isinstance(cell, list) else "; ".join(cell)


def _arrow(kind: type) -> pyarrow.DataType:
    import pyarrow

    kinds: Mapping[type, Callable[[], pyarrow.DataType]] = {
        float: pyarrow.float64,
        int: pyarrow.int64,
        bool: pyarrow.bool_,
        list: lambda: pyarrow.list_(pyarrow.string()),
    }
    return kinds.get(kind, pyarrow.string)()


TABLES: Mapping[str, Callable[[Columns, Sequence[Row]], bytes]] = {
    ".csv": to_csv,
    ".jsonl": to_json_lines,
    ".parquet": to_parquet,
}
"""The formats of tables by suffix."""

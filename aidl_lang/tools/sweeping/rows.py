"""The outcomes of a sweep as rows of a table: CSV, JSON lines, Parquet, and what Arrow and pandas have."""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang.common.files import csv_text
from aidl_lang.common.records import record
from aidl_lang.export import require
from aidl_lang.tools.sweeping.bundle import MEASURES, Fault, Measures, Outcome
from aidl_lang.tools.sweeping.plan import Plan, Value, Variant, shown

if TYPE_CHECKING:
    import pyarrow


Cell: TypeAlias = float | int | str | bool | list[str] | None

_DRAWN = {"width": "drawn_width", "height": "drawn_height"}
"""Measures that are called otherwise in a table, where params are often called so."""


@record()
class Row:
    """A variant with what came of it. Its files are on disk, under the names told here.

    command  reproduces it
    """

    variant: Variant
    outcome: Outcome
    files: tuple[str, ...]
    command: str
    was_kept: bool

    @property
    def ok(self) -> bool:
        """Whether it solved, all asserts hold, and all its files could be made."""
        return self.outcome.ok

    @property
    def number(self) -> int:
        """From 1, in the order of the sweep."""
        return self.variant.number

    @property
    def params(self) -> Mapping[str, Value]:
        """What was set, by path."""
        return self.variant.values

    @property
    def status(self) -> str:
        """`solved`, `partial`, `failed`, `wrong`; `broken` if it met a limit."""
        return self.outcome.status

    @property
    def measures(self) -> Measures:
        """The measures of the whole, in mm, mm², mm³ and g."""
        return self.outcome.measures

    @property
    def message(self) -> str:
        """Returns the first error with its place, or ""."""
        errors = self.outcome.errors
        return said(errors[0]) if errors else ("" if self.ok else f"the program is {self.outcome.status}")


def said(fault: Fault) -> str:
    """Returns a diagnostic in a line: `E0604 line 12: assertion failed: … (12 is not > 15)`."""
    place = f" line {fault.line}" if fault.line is not None else ""
    label = f" ({fault.label})" if fault.label and fault.label not in fault.message else ""
    return " ".join(f"{fault.code}{place}: {fault.message}{label}".split())


class Columns:
    """Columns: number, other fields, params, results; `result_NAME` for one whose name a param has."""

    def __init__(self, plan: Plan, timings: bool = True) -> None:
        self._plan = plan
        self.given = ["n", *plan.labels, *plan.paths]
        results = ["status", "ok", *(_DRAWN.get(name, name) for name in MEASURES), "dof", "asserts"]
        results += ["failed_asserts", "changed", "errors", "warnings", "messages", "files", "command"]
        if timings:
            results.append("seconds")
        taken = set(self.given)
        self._results = [f"result_{name}" if name in taken else name for name in results]
        self._timings = timings

    @property
    def names(self) -> list[str]:
        return [*self.given, *self._results]

    def cells(self, row: Row) -> list[Cell]:
        """Returns the cells of a row, in the order of the names."""
        variant, outcome = row.variant, row.outcome
        given: list[Cell] = [variant.number]
        given += [variant.labels.get(name) for name in self._plan.labels]
        given += [self._value(path, variant, outcome) for path in self._plan.paths]
        warnings = [each for each in outcome.faults if not each.is_error]
        results: list[Cell] = [
            outcome.status,
            outcome.ok,
            *(outcome.measures.get(name) for name in MEASURES),
            outcome.dof,
            outcome.asserts,
            [said(each) for each in outcome.failed_asserts],
            [f"{c.path}: {c.written:.6g} → {c.solved:.6g}" for c in outcome.changed],
            len(outcome.errors),
            len(warnings),
            [said(each) for each in outcome.faults],
            list(row.files),
            row.command,
        ]
        if self._timings:
            results.append(outcome.seconds)
        return [*given, *results]

    def _value(self, path: str, variant: Variant, outcome: Outcome) -> Value | None:
        """Returns the value of a param: as it was set, or as written where the table leaves it out."""
        found = variant.values.get(path)
        return outcome.params.get(path, self._plan.knobs[path].value) if found is None else found


def in_order(rows: Sequence[Row]) -> list[Row]:
    return sorted(rows, key=lambda row: row.variant.number)


def as_mapping(names: Sequence[str], cells: Sequence[Cell]) -> Mapping[str, Cell]:
    return dict(zip(names, cells, strict=True))


ARROW_EXTRA = "parquet"


def to_csv(columns: Columns, rows: Sequence[Row]) -> bytes:
    """Returns a table as CSV with a byte order mark; lists are joined by semicolons."""
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
    """Returns a table as Arrow's; mixed columns are of texts. Raises AidlError without pyarrow."""
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

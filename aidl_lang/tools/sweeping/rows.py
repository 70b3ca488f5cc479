"""The outcomes of a sweep as rows of a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from aidl_lang.common.records import record
from aidl_lang.tools.sweeping.axes import Value
from aidl_lang.tools.sweeping.faults import Fault
from aidl_lang.tools.sweeping.outcome import MEASURES, Measures, Outcome
from aidl_lang.tools.sweeping.plan import Plan, Variant

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
    """The columns of a table: the number, other fields of the orders, params, then what came of it. A result
    whose name a param has taken is called `result_NAME`.
    """

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

"""The outputs of a sweep: drawings under names of a pattern, and rows of a table for all."""

from __future__ import annotations

import io
import json
import os
import re
import unicodedata
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang.common.diagnostics import AidlError
from aidl_lang.common.names import fold, nearest
from aidl_lang.common.prose import did_you_mean, first_few, ticked
from aidl_lang.common.records import record
from aidl_lang.common.world import Reads, csv_text, replace
from aidl_lang.export import FORMATS, suffix_of
from aidl_lang.export.job import file_names, require
from aidl_lang.tools.sweeping.bundle import MEASURES, OF_KIND, Fault, Measures, Outcome
from aidl_lang.tools.sweeping.plan import Plan, Value, Variant, labels, refused, shown

if TYPE_CHECKING:
    import pyarrow


# --- The outcomes of a sweep as rows of a table: CSV, JSON lines, Parquet, and what Arrow and pandas have.

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


def _measure(name: str) -> Callable[[Row], Cell]:
    return lambda row: row.measures.get(name)


_RESULTS: Mapping[str, Callable[[Row], Cell]] = {
    "status": lambda row: row.status,
    "ok": lambda row: row.ok,
    **{_DRAWN.get(name, name): _measure(name) for name in MEASURES},
    "dof": lambda row: row.outcome.dof,
    "asserts": lambda row: row.outcome.asserts,
    "failed_asserts": lambda row: [said(each) for each in row.outcome.failed_asserts],
    "changed": lambda row: [f"{c.path}: {c.written:.6g} → {c.solved:.6g}" for c in row.outcome.changed],
    "errors": lambda row: len(row.outcome.errors),
    "warnings": lambda row: len(row.outcome.faults) - len(row.outcome.errors),
    "messages": lambda row: [said(each) for each in row.outcome.faults],
    "files": lambda row: list(row.files),
    "command": lambda row: row.command,
    "seconds": lambda row: row.outcome.seconds,
}


class Columns:
    """Columns: number, other fields, params, results; `result_NAME` for one whose name a param has."""

    def __init__(self, plan: Plan, timings: bool = True) -> None:
        self._plan = plan
        self.given = ["n", *plan.labels, *plan.paths]
        self._results = {
            f"result_{name}" if name in self.given else name: cell
            for name, cell in _RESULTS.items()
            if timings or name != "seconds"
        }

    @property
    def names(self) -> list[str]:
        return [*self.given, *self._results]

    def cells(self, row: Row) -> list[Cell]:
        variant, outcome = row.variant, row.outcome
        given: list[Cell] = [variant.number]
        given += [variant.labels.get(name) for name in self._plan.labels]
        given += [self._value(path, variant, outcome) for path in self._plan.paths]
        return [*given, *(cell(row) for cell in self._results.values())]

    def by_name(self, row: Row) -> dict[str, Cell]:
        return dict(zip(self.names, self.cells(row), strict=True))

    def _value(self, path: str, variant: Variant, outcome: Outcome) -> Value | None:
        """Returns the value of a param: as it was set, or as written where the table leaves it out."""
        found = variant.values.get(path)
        return outcome.params.get(path, self._plan.knobs[path].value) if found is None else found


def in_order(rows: Sequence[Row]) -> list[Row]:
    return sorted(rows, key=lambda row: row.variant.number)


def turns(rows: Sequence[Row]) -> Iterator[str]:
    """Yields a sentence for each two variants that are neighbours in one param, and of different kind."""
    ways: dict[tuple[str, str], list[tuple[float, Row]]] = defaultdict(list)
    for row in in_order(rows):
        for path, value in row.params.items():
            if not isinstance(value, str | bool):
                others = labels({other: given for other, given in row.params.items() if other != path})
                ways[path, others].append((value, row))
    for (path, beside), way in ways.items():
        for (a, one), (b, other) in pairwise(sorted(way, key=lambda step: step[0])):
            if one.ok and other.ok and (what := _differing(one.outcome, other.outcome)):
                place = f"`{path}` from {shown(a)} to {shown(b)}{' with ' if beside else ''}{beside}"
                yield f"{place}: {'; '.join(what)}"


def _differing(a: Outcome, b: Outcome) -> list[str]:
    """Returns what is of another kind in an outcome: counts, unless the parts are others, and warnings."""
    counts = ("bodies", "pieces", "holes") if a.parts == b.parts else ()
    was, now = ({f.place: f for f in each.faults if f.code in OF_KIND} for each in (a, b))
    pairs = [(name, a.measures.get(name), b.measures.get(name)) for name in counts]
    told = [f"{name} go from {one} to {other}" for name, one, other in pairs if one != other]
    told += [said(f) for place, f in now.items() if place not in was]
    return told + [f"no more: {said(f)}" for place, f in was.items() if place not in now]


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
    lines = (json.dumps(columns.by_name(row), ensure_ascii=False, allow_nan=False) for row in rows)
    return "".join(f"{line}\n" for line in lines).encode("utf-8", "backslashreplace")


def to_parquet(columns: Columns, rows: Sequence[Row]) -> bytes:
    table = to_arrow(columns, rows)
    import pyarrow.parquet

    out = io.BytesIO()
    pyarrow.parquet.write_table(table, out)
    return out.getvalue()


def to_arrow(columns: Columns, rows: Sequence[Row]) -> pyarrow.Table:
    """Returns a table as Arrow's; mixed columns are of texts. Raises AidlError without pyarrow."""
    require("pyarrow", "a table of Arrow", ARROW_EXTRA)
    import pyarrow

    kinds = {
        float: pyarrow.float64(),
        int: pyarrow.int64(),
        bool: pyarrow.bool_(),
        list: pyarrow.list_(pyarrow.string()),
    }
    found = [columns.cells(row) for row in rows]
    data = {}
    for k, name in enumerate(columns.names):
        cells = [cells[k] for cells in found]
        if (kind := _kind(cells)) is str:
            cells = [None if cell is None else _csv(cell) for cell in cells]
        data[name] = pyarrow.array(cells, kinds.get(kind, pyarrow.string()))
    return pyarrow.table(data)


def _kind(cells: Sequence[Cell]) -> type:
    kinds = {type(cell) for cell in cells if cell is not None}
    if kinds <= {int, float} and float in kinds:
        return float
    return kinds.pop() if len(kinds) == 1 else str


TABLES: Mapping[str, Callable[[Columns, Sequence[Row]], bytes]] = {
    ".csv": to_csv,
    ".jsonl": to_json_lines,
    ".parquet": to_parquet,
}
"""The formats of tables by suffix."""


# --- The names of the files that a sweep writes: a pattern such as `out/{width}-{style}.dxf`, with the
# values of a variant in it. Whatever a value says, its file lies where the pattern says.

NUMBER = "n"
"""The field for the number of a variant."""
_FIELD = re.compile(r"\{([^{}]*)\}")
_LONGEST = 60
"""Bytes of one value in a name; file systems take 255 for the whole."""
_RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\..*)?")


@record()
class Pattern:
    """The pattern of a name.

    parts    its texts and, at odd places, its fields
    written  the values that params have where a variant does not set them
    """

    text: str
    suffix: str
    parts: tuple[str, ...]
    written: Mapping[str, Value]

    @property
    def folder(self) -> PurePath:
        """Returns the folder that the names of all variants have in common."""
        return PurePath(f"{self.parts[0]}x").parent

    def named(self, variant: Variant) -> str:
        return "".join(self._value(part, variant) if k % 2 else part for k, part in enumerate(self.parts))

    def _value(self, field: str, variant: Variant) -> str:
        if field == NUMBER:
            return str(variant.number)
        if field in variant.labels:
            return safe(variant.labels[field])
        return safe(shown(variant.values.get(field, self.written.get(field, ""))))


def pattern(text: str, suffix: str, plan: Plan) -> Pattern:
    """Reads a pattern, which names params and columns of a plan. Raises AidlError."""
    fields = [*plan.labels, *plan.paths]
    parts = _FIELD.split(text)
    by_name = {fold(name): name for name in [*fields, NUMBER]}
    for k in range(1, len(parts), 2):
        known = by_name.get(fold(parts[k].strip()))
        if known is None:
            near = did_you_mean(nearest(parts[k], fields)[:1])
            there = first_few(ticked([f"{{{name}}}" for name in [*fields, NUMBER]]), 12)
            message = f"`{text}` names `{{{parts[k]}}}`, which is not varied"
            raise refused("E0973", message, *near, f"there is {there}")
        parts[k] = known
    return Pattern(text, suffix, tuple(parts), {path: knob.value for path, knob in plan.knobs.items()})


def safe(text: str) -> str:
    """Returns a value as part of a file's name: short, and none that a system reads otherwise (`CON`)."""
    kept = "".join(c if _is_plain(c) else "_" for c in unicodedata.normalize("NFC", text))
    kept = re.sub(r"__+", "_", kept).strip("_. ") if kept != text else kept
    kept = re.sub(r"\.\.+", ".", kept).lstrip(".").rstrip(". ")
    while len(kept.encode()) > _LONGEST:
        kept = kept[:-1]
    return f"_{kept}" if not kept or _RESERVED.fullmatch(kept) else kept


def _is_plain(character: str) -> bool:
    return character.isalnum() or character in "-+._" or unicodedata.category(character) == "Mn"


def distinct(names: Iterable[str]) -> Iterator[str]:
    """Yields names made different: of several alike for some file system, each but the first is numbered."""
    taken: set[str] = set()
    for number, name in enumerate(names, 1):
        made, path, mark = name, PurePath(name), f"~{number}"
        while (key := unicodedata.normalize("NFC", made).casefold()) in taken:
            made = str(path.with_name(f"{path.stem}{mark}{path.suffix}"))
            mark += "~"
        taken.add(key)
        yield made


# --- The outputs of a sweep: drawings, one for each variant, and one table or contact sheet for all of them.

SHEETS = (".html", ".pdf", ".png")
"""The formats of contact sheets."""
MOST_PICTURES = 5000
"""Most variants on a contact sheet."""


@record()
class Outputs:
    """Where a sweep writes."""

    patterns: tuple[Pattern, ...] = ()
    tables: tuple[str, ...] = ()
    sheets: tuple[str, ...] = ()

    @property
    def names(self) -> list[str]:
        """Returns the names of all outputs, as they were given."""
        return [*(each.text for each in self.patterns), *self.tables, *self.sheets]

    @property
    def suffixes(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(each.suffix for each in self.patterns))

    def keep(self, program: str) -> Path | None:
        """Returns the folder beside the outputs for what a run has done; None without outputs."""
        for name in (*self.tables, *self.sheets):
            return Path(f"{name}.sweep")
        stem = PurePath(program).stem or "sweep"
        return next((Path(each.folder, f"{stem}.sweep") for each in self.patterns), None)


def outputs(names: Sequence[str], plan: Plan, reads: Reads, fallback: str | None = None) -> Outputs:
    """Sorts the names of outputs. Raises AidlError for one that no sweep can write."""
    patterns: list[Pattern] = []
    tables: list[str] = []
    sheets: list[str] = []
    for name in dict.fromkeys(names):
        suffix = PurePath(name).suffix.lower()
        if _FIELD.search(name) is not None:
            patterns.append(pattern(name, suffix_of(name, fallback), plan))
            continue
        if not Path(name).parent.is_dir():
            message = f"`{name}` cannot be written: there is no directory `{Path(name).parent}`"
            raise refused("E0904", message)
        if suffix in TABLES:
            if suffix == ".parquet":
                require("pyarrow", name, ARROW_EXTRA)
            tables.append(name)
        elif suffix in SHEETS:
            sheets.append(name)
        else:
            raise _shared(name, suffix, plan)
    reads.require_unread((*tables, *sheets))
    if sheets and len(plan) > MOST_PICTURES:
        few = f"a contact sheet has up to {MOST_PICTURES}"
        raise refused("E0973", f"{len(plan)} variants are too many for `{sheets[0]}`: {few}")
    return Outputs(tuple(patterns), tuple(tables), tuple(sheets))


def _shared(name: str, suffix: str, plan: Plan) -> AidlError:
    path = PurePath(name)
    if suffix in FORMATS:
        field = plan.paths[0] if len(plan.paths) == 1 else "n"
        one = path.with_name(f"{path.stem}-{{{field}}}{path.suffix}")
        message = f"every variant would be written to `{name}`"
        return refused("E0973", message, f"say what differs in the name: `{one}`")
    known = f"tables are {', '.join(TABLES)}, contact sheets {', '.join(SHEETS)}"
    drawings = "a drawing has a field in its name, as in `out/{n}.dxf`"
    return refused("E0905", f"`{name}` is neither a table nor a contact sheet", known, drawings)


class Drawings:
    """Writes the drawings of variants, each under a name of its own below the folder of its pattern."""

    def __init__(self, outputs: Outputs, plan: Plan, reads: Reads) -> None:
        """Names the drawings of all variants, numbering equal names. Raises AidlError if one was read."""
        self.renamed = 0
        self._patterns = outputs.patterns
        self._names: list[list[str]] = []
        self._written: dict[str, int] = {}
        self._reads = reads
        for each in outputs.patterns:
            plain = [each.named(variant) for variant in plan]
            names = list(distinct(plain))
            self.renamed += sum(name != before for name, before in zip(names, plain, strict=True))
            reads.require_unread(names)
            self._names.append(names)

    def names(self, variant: Variant) -> list[str]:
        """Returns the names of a variant's drawings, one for each pattern."""
        return [names[variant.number - 1] for names in self._names]

    def write(self, variant: Variant, outcome: Outcome) -> list[str]:
        """Writes the drawings of a variant; returns the names of the files. Raises AidlError."""
        written: list[str] = []
        for each, name in zip(self._patterns, self.names(variant), strict=True):
            contents = outcome.files.get(each.suffix, ())
            for path, data in zip(file_names(name, len(contents)) if contents else [], contents, strict=True):
                if self._written.setdefault(path.casefold(), variant.number) != variant.number:
                    other = self._written[path.casefold()]
                    message = f"`{path}` would hold variant {other} and variant {variant.number}"
                    raise refused("E0973", message, "begin the name with `{n}`")
                self._reads.require_unread([path])  # also those that were read since
                write(path, data)
                written.append(path)
        return written

    def stale(self, variant: Variant) -> list[str]:
        """Returns the files of an earlier run that stand where a variant would have written its own."""
        return [name for name in self.names(variant) if os.path.lexists(name)]


def write(name: str, data: bytes) -> None:
    """Replaces a file, or a link, in one step if its content differs. Raises AidlError."""
    path = Path(name)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.is_symlink() or not path.is_file() or path.read_bytes() != data:
            replace(path, data)
    except OSError as error:
        why = (error.strerror or str(error)).lower()
        raise refused("E0904", f"`{name}` cannot be written: {why}") from None

"""The outputs of a sweep: drawings, one for each variant, under names of a pattern, and one table for all."""

from __future__ import annotations

import os
import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path, PurePath

from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.files import Reads, replace
from aidl_lang.common.names import fold, nearest
from aidl_lang.common.prose import did_you_mean, first_few, ticked
from aidl_lang.common.records import record
from aidl_lang.export import FORMATS, file_names, require, suffix_of
from aidl_lang.tools.sweeping.bundle import Outcome
from aidl_lang.tools.sweeping.plan import Plan, Value, Variant, shown
from aidl_lang.tools.sweeping.rows import ARROW_EXTRA, TABLES

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
        """Returns the name for a variant."""
        return "".join(self._value(part, variant) if k % 2 else part for k, part in enumerate(self.parts))

    def _value(self, field: str, variant: Variant) -> str:
        if field == NUMBER:
            return str(variant.number)
        if field in variant.labels:
            return safe(variant.labels[field])
        return safe(shown(variant.values.get(field, self.written.get(field, ""))))


def has_fields(text: str) -> bool:
    """Tells whether a name is a pattern: one file for each variant."""
    return _FIELD.search(text) is not None


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
            raise AidlError(
                Diagnostic(
                    "E0973",
                    f"`{text}` names `{{{parts[k]}}}`, which is not varied",
                    hints=(*near, f"there is {there}"),
                )
            )
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
        """Returns the formats of the drawings."""
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
        if has_fields(name):
            patterns.append(pattern(name, suffix_of(name, fallback), plan))
            continue
        if not Path(name).parent.is_dir():
            raise AidlError(
                Diagnostic(
                    "E0904", f"`{name}` cannot be written: there is no directory `{Path(name).parent}`"
                )
            )
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
        raise AidlError(Diagnostic("E0973", f"{len(plan)} variants are too many for `{sheets[0]}`: {few}"))
    return Outputs(tuple(patterns), tuple(tables), tuple(sheets))


def _shared(name: str, suffix: str, plan: Plan) -> AidlError:
    path = PurePath(name)
    if suffix in FORMATS:
        field = plan.paths[0] if len(plan.paths) == 1 else "n"
        one = path.with_name(f"{path.stem}-{{{field}}}{path.suffix}")
        message = f"every variant would be written to `{name}`"
        return AidlError(Diagnostic("E0973", message, hints=(f"say what differs in the name: `{one}`",)))
    known = f"tables are {', '.join(TABLES)}, contact sheets {', '.join(SHEETS)}"
    drawings = "a drawing has a field in its name, as in `out/{n}.dxf`"
    return AidlError(
        Diagnostic("E0905", f"`{name}` is neither a table nor a contact sheet", hints=(known, drawings))
    )


class Drawings:
    """Writes the drawings of variants, each under a name of its own below the folder of its pattern."""

    def __init__(self, outputs: Outputs, plan: Plan, reads: Reads) -> None:
        """Names the drawings of all variants, numbering equal names. Raises AidlError if one was read."""
        self.renamed = 0
        self._patterns = outputs.patterns
        self._names = [list(self._named(each, plan)) for each in outputs.patterns]
        self._written: dict[str, int] = {}
        self._reads = reads
        for names in self._names:
            reads.require_unread(names)

    def _named(self, each: Pattern, plan: Plan) -> Iterator[str]:
        plain = [each.named(variant) for variant in plan]
        for before, name in zip(plain, distinct(plain), strict=True):
            self.renamed += name != before
            yield name

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
                    raise AidlError(Diagnostic("E0973", message, hints=("begin the name with `{n}`",)))
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
        raise AidlError(
            Diagnostic("E0904", f"`{name}` cannot be written: {(error.strerror or str(error)).lower()}")
        ) from None

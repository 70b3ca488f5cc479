"""What goes between the processes of a sweep: a program with its files, diagnostics, outcomes."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import field, replace
from functools import cache
from typing import TYPE_CHECKING, Any

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.processes import Limit
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import FileError, ReadFailure, World, normalize, reads_of
from aidl_lang.pipeline import Settings

if TYPE_CHECKING:
    from cattrs import Converter

# --- A program with all that it reads, as it travels to whoever compiles it.

_SPARE = 10.0
"""Seconds that a process gets beyond the limits: for starting, checking, reasons."""

Content = bytes | ReadFailure
"""The content of a file, or why it could not be read."""


def patience(settings: Settings, uses: int = 0) -> float:
    """Returns the seconds that one compile may take, with so many uses of its drawing."""
    return settings.building.seconds + settings.solving.seconds + (1 + uses) * settings.drawing + _SPARE


@record()
class Bundle:
    """A program with the files that it reads: whoever has it needs no file of its own."""

    name: str
    text: str
    files: Mapping[str, Content] = field(hash=False)
    settings: Settings = Settings()

    @property
    def source(self) -> SourceFile:
        return SourceFile(self.name, self.text)


def digest_of(content: Content) -> str:
    """Returns a digest of a file, or the reason why there is none."""
    return content.value if isinstance(content, ReadFailure) else hashlib.sha256(content).hexdigest()


class Carried:
    """The files of a bundle; `missing` gathers what was asked for and is not among them."""

    def __init__(self, files: Mapping[str, Content]) -> None:
        self.files = dict(files)
        self.missing: set[str] = set()

    def read_bytes(self, path: str) -> bytes:
        content = self._content(normalize(path))
        if isinstance(content, ReadFailure):
            raise FileError(path, content)
        return content

    def read(self, path: str) -> str:
        try:
            return self.read_bytes(path).decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")
        except UnicodeDecodeError:
            raise FileError(path, ReadFailure.NOT_TEXT) from None

    def _content(self, path: str) -> Content:
        if path not in self.files:
            self.missing.add(path)
        return self.files.get(path, ReadFailure.MISSING)


class Gathering(Carried):
    """The files of another world, each read once; `files` has those that were asked for."""

    def __init__(self, world: World) -> None:
        super().__init__({})
        self._world = world
        self.reads = reads_of(world)

    def _content(self, path: str) -> Content:
        if path not in self.files:
            try:
                self.files[path] = self._world.read_bytes(path)
            except FileError as reason:
                self.files[path] = reason.reason
        return self.files[path]

    def gather(self, paths: Iterable[str]) -> None:
        """Reads more files, those that are there."""
        for path in paths:
            try:
                self.read_bytes(path)
            except FileError:
                continue  # that it is missing is known now


# --- Diagnostics as they are passed between processes: without their sources.


@record()
class Fault:
    """A diagnostic of a compile without its sources.

    text   the source text at its place, in one line
    file   the file of its place, with its line; None without a place
    """

    code: str
    message: str
    label: str = ""
    text: str = ""
    file: str | None = None
    line: int | None = None

    @property
    def is_error(self) -> bool:
        return self.code.startswith("E")

    @property
    def place(self) -> tuple[str, str | None, int | None]:
        """Returns the key by which it is recognised at another value."""
        return self.code, self.file, self.line


BROKEN = {
    Limit.TIME: "the program takes longer than a compile may",
    Limit.DEATH: "the program ends the process that compiles it",
    Limit.MEMORY: "the program needs more memory than there is for it",
}


def fault(diagnostic: Diagnostic) -> Fault:
    span = diagnostic.span
    if span is None:
        return Fault(diagnostic.code, diagnostic.message, diagnostic.label)
    return Fault(
        diagnostic.code, diagnostic.message, diagnostic.label, span.one_line, span.source.name, span.line
    )


# --- What came of a variant: data that goes between processes, into the cache and into tables.

MEASURES = tuple("width height area perimeter bodies pieces holes wall gap volume mass".split())
"""The measures of the whole, in mm, mm², mm³ and g; None where there is none, or it is not known."""
ASSERT = "E0604"
OF_KIND = frozenset(
    f"W07{n}" for n in ("02", "03", "04", "05", "06", "08", "10", "11", "12", "14", "28", "36", "62", "63")
)
"""The warnings that tell of a change of kind: of outlines, openings and pieces."""

Measures = Mapping[str, float | int | None]


@record()
class Change:
    """A kept size that had to change."""

    path: str
    written: float
    solved: float


@record()
class Outcome:
    """What came of a variant.

    status    `solved`, `partial`, `failed`, `wrong`; `broken` if it met a limit or ended its process
    ok        whether it solved, all asserts hold, and all files could be made
    faults    its errors, then its warnings
    params    all params with the values that they had
    asserts   the number of asserts that were looked at
    dof       degrees of freedom
    files     by suffix: the file, and further ones beside it
    picture   a small PNG, if it was asked for
    missing   files that it asked for and that did not travel with it
    parts     the number of geometries and their parts
    """

    status: str
    ok: bool
    faults: tuple[Fault, ...] = ()
    params: Mapping[str, float | str | bool] = field(default_factory=dict)
    measures: Measures = field(default_factory=dict)
    changed: tuple[Change, ...] = ()
    asserts: int = 0
    dof: int | None = None
    seconds: float = 0.0
    files: Mapping[str, tuple[bytes, ...]] = field(default_factory=dict)
    picture: bytes = b""
    missing: tuple[str, ...] = ()
    parts: int = 0

    @property
    def errors(self) -> tuple[Fault, ...]:
        return tuple(each for each in self.faults if each.is_error)

    @property
    def failed_asserts(self) -> tuple[Fault, ...]:
        return tuple(each for each in self.faults if each.code == ASSERT)


@cache
def _converter() -> Converter:
    from cattrs.preconf.json import make_converter

    return make_converter(detailed_validation=False)


def to_data(outcome: Outcome) -> Any:
    return _converter().unstructure(replace(outcome, missing=()), Outcome)


def from_data(data: Any) -> Outcome:
    """Reads an outcome from JSON of any source. Raises ValueError, TypeError or KeyError for what is none."""
    found = _converter().structure(data, Outcome)
    if set(found.measures) - set(MEASURES) or type(data["ok"]) is not bool or to_data(found) != data:
        raise ValueError("no outcome")
    return found

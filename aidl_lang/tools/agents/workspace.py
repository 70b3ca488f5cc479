"""The files that a program given as text may import, and limits on its size and time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from functools import cached_property
from pathlib import Path

from aidl_lang.building.state import BuildingLimits
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld, FileError, MemoryWorld, ReadFailure, World
from aidl_lang.parser import TextLimits
from aidl_lang.pipeline import Settings
from aidl_lang.solver.problem import Settings as SolverSettings
from aidl_lang.tools.discretion import Programs, Reader

PROGRAM = "program.aidl"
"""The name of the program in diagnostics."""


class RefusalError(Exception):
    """Raised for a call that cannot be answered; the diagnostics give the reason and a remedy."""

    def __init__(self, *diagnostics: Diagnostic) -> None:
        super().__init__("; ".join(d.message for d in diagnostics))
        self.diagnostics = diagnostics


def refusal(code: str, message: str, *hints: str) -> RefusalError:
    return RefusalError(Diagnostic(code, message, hints=hints))


@record()
class Limits:
    """Limits for programs that nobody has read.

    characters  of the program and of all files given with it
    files       given with it
    text        characters of the model, and of all exports
    pixels      larger side of the picture
    """

    characters: int = 400_000
    files: int = 100
    text: int = 60_000
    pixels: int = 1_000
    entities: int = 12_000
    constraints: int = 20_000
    turns: int = 100_000
    seconds_to_build: float = 8.0
    seconds_to_solve: float = 12.0

    @cached_property
    def settings(self) -> Settings:
        return Settings(
            TextLimits(max_characters=self.characters),
            BuildingLimits(
                entities=self.entities,
                constraints=self.constraints,
                turns=self.turns,
                seconds=self.seconds_to_build,
            ),
            SolverSettings(tolerance=1e-10, seconds=self.seconds_to_solve),
        )


@record()
class Surroundings:
    """The files visible to a program: those given with it, then the programs below a folder."""

    given: MemoryWorld
    disk: World | None = None

    def read(self, path: str) -> str:
        try:
            return self.given.read(path)
        except FileError as error:
            if error.reason is not ReadFailure.MISSING or self.disk is None:
                raise
        return self.disk.read(path)

    def read_bytes(self, path: str) -> bytes:
        try:
            return self.given.read_bytes(path)
        except FileError as error:
            if error.reason is not ReadFailure.MISSING or self.disk is None:
                raise
        return self.disk.read_bytes(path)

    def reader(self, source: SourceFile) -> Reader:
        """Returns the author of the program and of the files given with it."""
        return Reader({**self.given.files, source.name: source.text})


@record()
class Workspace:
    """`root` is the folder whose files may be imported; without one, only given files can be."""

    root: Path | None = None
    limits: Limits = field(default_factory=Limits)

    def open(self, program: str, files: Mapping[str, str] | None) -> tuple[SourceFile, Surroundings]:
        """Returns the program as a source, with its surroundings. Raises RefusalError."""
        files = files or {}
        self._measure(program, files)
        try:
            given = MemoryWorld(files)
        except FileError as error:
            raise refusal(
                "E0944",
                f"the file name `{error.path[:200]}` cannot be used: {error.reason}",
                "name files as the program imports them, as `parts/bolt.aidl`",
            ) from None
        disk = None if self.root is None else Programs(DiskWorld(self.root))
        return SourceFile(PROGRAM, program.removeprefix("\ufeff")), Surroundings(given, disk)

    def _measure(self, program: str, files: Mapping[str, str]) -> None:
        characters, most = len(program) + sum(map(len, files.values())), self.limits.characters
        if characters > most:
            raise refusal(
                "E0944",
                f"the program and its files have {characters:,} characters, more than the {most:,} allowed",
                "say what repeats with `for` and with templates",
            )
        if len(files) > self.limits.files:
            raise refusal(
                "E0944",
                f"{len(files):,} files were given, more than the {self.limits.files:,} allowed",
                "give only those that the program imports",
            )

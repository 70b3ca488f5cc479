"""A program with all that it reads, as it travels to whoever compiles it."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import field
from functools import cached_property

from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import FileError, ReadFailure, World, normalize, reads_of
from aidl_lang.pipeline import Settings

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
        """Returns the program as it is compiled."""
        return SourceFile(self.name, self.text)

    @cached_property
    def digest(self) -> str:
        """Returns a digest of all of it."""
        told = [f"{len(self.name)} {self.name} {len(self.text)} {self.text}", repr(self.settings)]
        told += [f"{path} {digest_of(content)}" for path, content in sorted(self.files.items())]
        return hashlib.sha256("\n".join(told).encode("utf-8", "surrogatepass")).hexdigest()


def digest_of(content: Content) -> str:
    """Returns a digest of a file, or the reason why there is none."""
    return content.value if isinstance(content, ReadFailure) else hashlib.sha256(content).hexdigest()


class Gathering:
    """The files of another world, each read once; `files` has those that were asked for."""

    def __init__(self, world: World) -> None:
        self._world = world
        self.reads = reads_of(world)
        self.files: dict[str, Content] = {}

    def read_bytes(self, path: str) -> bytes:
        wanted = normalize(path)
        if wanted not in self.files:
            try:
                self.files[wanted] = self._world.read_bytes(wanted)
            except FileError as reason:
                self.files[wanted] = reason.reason
        return _given(wanted, self.files[wanted])

    def read(self, path: str) -> str:
        return _text(path, self.read_bytes(path))

    def gather(self, paths: Iterable[str]) -> None:
        """Reads more files, those that are there."""
        for path in paths:
            try:
                self.read_bytes(path)
            except FileError:
                continue  # that it is missing is known now


class Carried:
    """The files of a bundle; `missing` gathers what was asked for and is not among them."""

    def __init__(self, files: Mapping[str, Content]) -> None:
        self._files = files
        self.missing: set[str] = set()

    def read_bytes(self, path: str) -> bytes:
        wanted = normalize(path)
        if wanted not in self._files:
            self.missing.add(wanted)
            raise FileError(path, ReadFailure.MISSING)
        return _given(path, self._files[wanted])

    def read(self, path: str) -> str:
        return _text(path, self.read_bytes(path))


def _given(path: str, content: Content) -> bytes:
    if isinstance(content, ReadFailure):
        raise FileError(path, content)
    return content


def _text(path: str, data: bytes) -> str:
    try:
        return data.decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError:
        raise FileError(path, ReadFailure.NOT_TEXT) from None

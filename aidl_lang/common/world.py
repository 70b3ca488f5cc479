"""The world that all files are read through, so that the core is one for disk, memory, editor and browser.

Paths are relative to the root of a project and written with `/`. Nothing outside the root can be read,
whatever `..`, absolute paths or symbolic links say.
"""

from __future__ import annotations

import errno
from collections.abc import Mapping
from enum import StrEnum
from pathlib import Path, PurePosixPath
from typing import Protocol

from aidl_lang.common.files import Reads

_REASONS = {
    errno.ENOENT: "MISSING",
    errno.ENOTDIR: "MISSING",
    errno.EFBIG: "TOO_LARGE",
}


class ReadFailure(StrEnum):
    """The reason why a file cannot be read."""

    MISSING = "there is no such file"
    OUTSIDE = "it lies outside the project"
    NOT_TEXT = "it is not UTF-8 text"
    TOO_LARGE = "it is too large"
    UNREADABLE = "it cannot be read"
    ANOTHER_KIND = "it leads to another kind of file"
    NOT_A_PROGRAM = "it is no program without mistakes"


class FileError(OSError):
    """Raised for a file that cannot be read: `path` as asked for, and the reason in words."""

    def __init__(self, path: str, reason: ReadFailure) -> None:
        super().__init__(f"{path}: {reason}")
        self.path = path
        self.reason = reason


class World(Protocol):
    """The files that a program can read."""

    def read(self, path: str) -> str:
        """Returns the text of a file; the path is relative to the root. Raises FileError."""
        ...

    def read_bytes(self, path: str) -> bytes:
        """Returns what is in a file, such as a font. Raises FileError."""
        ...


def normalize(path: str) -> str:
    """Returns a path without `.` and `..`, relative to the root. Raises FileError if it leaves the root."""
    pure = PurePosixPath(path.replace("\\", "/"))
    parts: list[str] = []
    for part in pure.parts:
        if part == ".." and parts:
            parts.pop()
        elif part == ".." or pure.is_absolute() or part.endswith(":"):
            raise FileError(path, ReadFailure.OUTSIDE)
        else:
            parts.append(part)
    return "/".join(parts)


def relative_to(path: str, importer: str) -> str:
    """Returns the path from the root of one written in `importer`. Raises FileError as `normalize` does."""
    if PurePosixPath(path).is_absolute():
        raise FileError(path, ReadFailure.OUTSIDE)
    return normalize(str(PurePosixPath(importer).parent / path))


class MemoryWorld:
    """Files held in mappings from path to text, and to bytes: for tests, the editor and the browser."""

    def __init__(self, files: Mapping[str, str], data: Mapping[str, bytes] | None = None) -> None:
        self.files = {normalize(path): text for path, text in files.items()}
        self.data = {normalize(path): content for path, content in (data or {}).items()}

    def read(self, path: str) -> str:
        try:
            return self.files[normalize(path)]
        except KeyError:
            raise FileError(path, ReadFailure.MISSING) from None

    def read_bytes(self, path: str) -> bytes:
        if (content := self.data.get(normalize(path))) is not None:
            return content
        return self.read(path).encode()


class DiskWorld:
    """The files below a folder; `reads` remembers those that were read."""

    def __init__(self, root: Path | str, reads: Reads | None = None) -> None:
        self.root = Path(root).resolve()
        self.reads = Reads() if reads is None else reads

    def read(self, path: str) -> str:
        try:
            return self.read_bytes(path).decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")
        except UnicodeDecodeError:
            raise FileError(path, ReadFailure.NOT_TEXT) from None

    def read_bytes(self, path: str) -> bytes:
        try:
            file = (self.root / normalize(path)).resolve()
            if not file.is_relative_to(self.root):
                raise FileError(path, ReadFailure.OUTSIDE)
            # a link to a file of another kind, which is no program
            if file.exists() and file.suffix != PurePosixPath(path).suffix:
                raise FileError(path, ReadFailure.ANOTHER_KIND)
            if file.is_dir():
                raise FileError(path, ReadFailure.MISSING)
            return self.reads.contents(file, below=self.root)
        except FileError:
            raise
        except (OSError, ValueError, RuntimeError) as error:  # a NUL in the name, a loop of links
            reason = _REASONS.get(getattr(error, "errno", 0), "UNREADABLE")
            raise FileError(path, ReadFailure[reason]) from None


class NotedWorld:
    """The files of another world; `asked` has the paths of those that were asked for, there or not."""

    def __init__(self, world: World) -> None:
        self._world = world
        self.asked: set[str] = set()

    def read(self, path: str) -> str:
        self.asked.add(path)
        return self._world.read(path)

    def read_bytes(self, path: str) -> bytes:
        self.asked.add(path)
        return self._world.read_bytes(path)


class KeptWorld:
    """The files of another world, each read once and kept so, also in a pickle, which leaves that behind."""

    def __init__(self, world: World) -> None:
        self._world = world
        self.reads = reads_of(world)
        self._texts: dict[str, str] = {}
        self._bytes: dict[str, bytes] = {}

    def read(self, path: str) -> str:
        wanted = normalize(path)
        if wanted not in self._texts:
            self._texts[wanted] = self._world.read(path)
        return self._texts[wanted]

    def read_bytes(self, path: str) -> bytes:
        wanted = normalize(path)
        if wanted not in self._bytes:
            self._bytes[wanted] = self._world.read_bytes(path)
        return self._bytes[wanted]

    def __getstate__(self) -> dict[str, object]:
        return {"_world": MemoryWorld({}), "reads": Reads(), "_texts": self._texts, "_bytes": self._bytes}


def reads_of(world: World | None) -> Reads:
    """Returns what remembers the files that are read through a world."""
    return world.reads if isinstance(world, DiskWorld | KeptWorld) else Reads()

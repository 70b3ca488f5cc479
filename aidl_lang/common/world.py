"""Files, and the world that they are read through, so that the core is one for disk, memory and browser.

Paths are relative to the root of a project and written with `/`. Nothing outside the root can be read,
whatever `..`, absolute paths or symbolic links say.
"""

from __future__ import annotations

import csv
import errno
import io
import os
import re
import stat
from collections.abc import Iterable, Mapping
from contextlib import suppress
from enum import StrEnum
from pathlib import Path, PurePath, PurePosixPath
from typing import Protocol

from aidl_lang.common.diagnostics import AidlError, Diagnostic

# --- Reads regular files of bounded size, and remembers which: what was read is not to be overwritten.

MAX_BYTES = 10_000_000
"""Most bytes of a file; a program is far smaller."""
_FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
_FOLDER = os.O_RDONLY | getattr(os, "O_DIRECTORY", 0) | getattr(os, "O_NOFOLLOW", 0)


class Reads:
    """The files that were read through it."""

    def __init__(self) -> None:
        self._paths: set[str] = set()

    def contents(self, path: str | Path, most: int = MAX_BYTES, below: Path | None = None) -> bytes:
        """Returns what is in a regular file of at most `most` bytes, without waiting for anybody who writes
        it. With a folder that it is `below`, both without symbolic links, none is followed that comes
        between. Raises OSError, with EFBIG for one that is too large.
        """
        with open(_opened(Path(path), below), "rb") as file:
            status = os.fstat(file.fileno())
            if stat.S_ISDIR(status.st_mode):
                raise IsADirectoryError(errno.EISDIR, "it is a folder", str(path))
            if not stat.S_ISREG(status.st_mode):
                raise OSError(errno.EINVAL, "it is no regular file", str(path))
            data = file.read(most + 1) if status.st_size <= most else b""
        require_fitting(max(len(data), status.st_size), most, str(path))
        self._paths.add(os.path.realpath(path))
        return data

    def require_unread(self, names: Iterable[str | Path]) -> None:
        """Raises AidlError if one of the names is that of a file that was read."""
        known = {_identity(path) for path in self._paths} - {None}
        for name in names:
            if known and _identity(name) in known:
                raise AidlError(Diagnostic("E0908", f"`{name}` was read, and is not overwritten"))


def require_fitting(size: int, most: int, name: str) -> None:
    """Raises OSError if a file of some bytes is larger than it may be."""
    if size > most:
        raise OSError(errno.EFBIG, f"it has more than {most // 1_000_000} MB", name)


def _identity(name: str | Path) -> tuple[int, int] | None:
    """Returns what a file is known by, whatever it is called; None if there is none."""
    try:
        status = os.stat(name)
    except (OSError, ValueError):
        return None
    return status.st_dev, status.st_ino


def _opened(path: Path, below: Path | None) -> int:
    if below is None or os.open not in os.supports_dir_fd:
        return os.open(path, _FLAGS)
    *folders, name = path.relative_to(below).parts
    folder = os.open(below, _FOLDER)
    try:
        for each in folders:
            outer, folder = folder, os.open(each, _FOLDER, dir_fd=folder)
            os.close(outer)
        return os.open(name, _FLAGS | os.O_NOFOLLOW, dir_fd=folder)
    finally:
        os.close(folder)


# --- Writes files whole or not at all.

_WRITABLE = stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH


def replace(path: Path, data: bytes) -> None:
    """Writes beside the file and moves into place once all is on the disk, so that whoever reads it has the
    old or the new one, also after a loss of power. Raises OSError, also for a file that is write-protected.
    """
    mode = path.stat().st_mode if path.exists() else None
    if mode is not None and not (stat.S_IMODE(mode) & _WRITABLE and os.access(path, os.W_OK)):
        raise PermissionError(errno.EACCES, "it is write-protected", str(path))
    temporary = path.with_name(f".{path.name}.{os.urandom(8).hex()}")
    try:
        with open(temporary, "xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        if mode is not None:
            os.chmod(temporary, mode)
        os.replace(temporary, path)
    except BaseException:
        with suppress(OSError):
            os.unlink(temporary)
        raise


# --- Writes tables as CSV of which no cell is taken for a formula by the program that opens it.

_FORMULA = ("=", "+", "-", "@", "\t", "\r")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


def csv_text(rows: Iterable[Iterable[object]], end: str = "\n") -> str:
    """Returns rows of cells as CSV. A text that begins as formulas do, and is no number, gets a mark: `'`."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator=end)
    writer.writerows([_harmless(cell) for cell in row] for row in rows)
    return out.getvalue()


def _harmless(cell: object) -> object:
    is_formula = isinstance(cell, str) and cell.startswith(_FORMULA) and not _NUMBER.fullmatch(cell)
    return f"'{cell}" if is_formula else cell


# --- The kinds of files that a program may read beside itself, by their suffixes.

PROGRAM = ".aidl"
FONTS = (".ttf", ".otf")
DRAWINGS = (".svg", ".dxf")
DATA = (*FONTS, *DRAWINGS)
"""What is read as bytes: no message quotes it."""
WHOLE = "drawing"
"""The name of all that is in a drawing, beside those of its parts."""


def is_data(path: str | PurePath) -> bool:
    """Tells whether a file is a font or a drawing of another program."""
    return PurePath(path).suffix.lower() in DATA


def may_be_read(path: str | PurePath) -> bool:
    """Tells whether a program may read a file of this name."""
    return PurePath(path).suffix == PROGRAM or is_data(path)


def is_drawing(path: str) -> bool:
    """Tells by its name whether a file is read as a drawing."""
    return PurePath(path).suffix.lower() in DRAWINGS


_REASONS = {errno.ENOENT: "MISSING", errno.ENOTDIR: "MISSING", errno.EFBIG: "TOO_LARGE"}


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


class KeptWorld:
    """The files of another world, each read once and kept so, also in a pickle, which leaves that behind;
    `asked` has the paths of those that were asked for, there or not.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self.reads = reads_of(world)
        self.asked: set[str] = set()
        self._texts: dict[str, str] = {}
        self._bytes: dict[str, bytes] = {}

    def read(self, path: str) -> str:
        self.asked.add(path)
        if (wanted := normalize(path)) not in self._texts:
            self._texts[wanted] = self._world.read(path)
        return self._texts[wanted]

    def read_bytes(self, path: str) -> bytes:
        self.asked.add(path)
        if (wanted := normalize(path)) not in self._bytes:
            self._bytes[wanted] = self._world.read_bytes(path)
        return self._bytes[wanted]

    def __getstate__(self) -> dict[str, object]:
        return vars(self) | {"_world": MemoryWorld({}), "reads": Reads()}


def reads_of(world: World | None) -> Reads:
    """Returns what remembers the files that are read through a world."""
    return world.reads if isinstance(world, DiskWorld | KeptWorld) else Reads()

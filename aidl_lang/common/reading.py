"""Reads regular files of bounded size, and remembers which: what was read is not to be overwritten."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterable
from pathlib import Path

from aidl_lang.common.diagnostics import AidlError, Diagnostic

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

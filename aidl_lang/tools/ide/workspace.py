"""The programs of a project in an editor: open ones from memory, all others from disk."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import field
from pathlib import Path

from aidl_lang.checking.resolving.imports import SUFFIX
from aidl_lang.common.records import record
from aidl_lang.common.world import DiskWorld, FileError, ReadFailure, normalize

MOST_FILES = 2_000
"""Most programs of a project that are searched."""
_PASSED_OVER = frozenset({"node_modules", "build", "dist", "__pycache__"})


@record(frozen=False)
class Workspace:
    """`roots` are the folders searched for programs; `open` maps the absolute path of an open program to its
    text.
    """

    roots: Sequence[Path] = ()
    open: dict[Path, str] = field(default_factory=dict)

    def text(self, path: Path) -> str:
        """Returns the text of a file. Raises FileError."""
        if (text := self.open.get(path)) is not None:
            return text
        return DiskWorld(path.parent).read(path.name)

    def world(self, path: Path) -> OpenWorld:
        """Returns the world of a program: its folder and those below, as for the command line."""
        return OpenWorld(self, path.parent)

    def programs(self) -> list[Path]:
        """Returns the programs below the roots, and the open ones; the first of very many."""
        found = dict.fromkeys(self.open)
        for root in self.roots:
            for path in _below(root):
                if len(found) >= MOST_FILES:
                    return list(found)
                found[path] = None
        return list(found)


def _below(folder: Path) -> Iterator[Path]:
    """Yields the programs in a folder and in those below it, except hidden and generated ones."""
    try:
        entries = sorted(folder.iterdir())
    except OSError:
        return  # it may have gone since, or may not be read
    for entry in entries:
        if entry.name.startswith(".") or entry.name in _PASSED_OVER:
            continue
        if entry.is_dir() and not entry.is_symlink():
            yield from _below(entry)
        elif entry.suffix == SUFFIX and entry.is_file():
            yield entry


@record()
class OpenWorld:
    """The files below a folder, open ones with their text in the editor."""

    workspace: Workspace
    folder: Path

    def read(self, path: str) -> str:
        inside = normalize(path)
        if (text := self.workspace.open.get(self.folder / inside)) is not None:
            return text
        return self._disk(path).read(inside)

    def read_bytes(self, path: str) -> bytes:
        return self._disk(path).read_bytes(normalize(path))

    def _disk(self, path: str) -> DiskWorld:
        if not self.folder.is_dir():  # of a program that was never saved
            raise FileError(path, ReadFailure.MISSING)
        return DiskWorld(self.folder)

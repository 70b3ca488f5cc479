"""The cache of outcomes, by content: program, imports, params, options and package lead to what came of them.

It is a folder that is named by whoever sweeps. Processes may share it, one that is killed leaves it whole,
and it is bounded. All in it is JSON that is looked through before it is believed: a folder that somebody else
wrote can give wrong outcomes, as a forged table could, but it runs nothing and touches no other file.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import sqlite3
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import diskcache

from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.resources import surroundings
from aidl_lang.tools.sweeping.bundle import Bundle, Outcome, from_data, to_data
from aidl_lang.tools.sweeping.plan import Value
from aidl_lang.tools.sweeping.working import Making

SIZE = 4 << 30
"""Bytes that a cache may take unless another size is said; what was put in first goes first."""
_LONGEST = 256 << 20
"""Most bytes of one outcome."""
_DATABASE = "cache.db"
_PATIENCE = 60.0
"""Seconds to wait for another process that writes."""

Reader = Callable[[str], str]
"""Returns the digest of a file that a program reads, as it is now."""


class _Json(diskcache.Disk):  # type: ignore[misc]
    """Stores compressed JSON: no pickle is read, no file outside the folder, whatever is in the database."""

    def put(self, key: str) -> tuple[Any, bool]:
        return key, True

    def get(self, key: Any, raw: bool) -> Any:
        if not raw:
            raise ValueError("a key that is no text")
        return key

    def store(self, value: Any, read: bool, key: Any = diskcache.UNKNOWN) -> Any:
        data = zlib.compress(json.dumps(value, separators=(",", ":"), allow_nan=False).encode(), 1)
        return super().store(data, False, key=key)

    def fetch(self, mode: int, filename: str | None, value: Any, read: bool) -> Any:
        if mode not in (diskcache.core.MODE_RAW, diskcache.core.MODE_BINARY):
            raise ValueError("an entry that is no JSON")
        if mode == diskcache.core.MODE_BINARY and not self._is_inside(filename):
            raise ValueError("an entry outside the folder")
        data = super().fetch(mode, filename, value, False)
        if not isinstance(data, bytes):
            raise ValueError("an entry that is no JSON")
        unpacking = zlib.decompressobj()
        text = unpacking.decompress(data, _LONGEST)
        if unpacking.unconsumed_tail:
            raise ValueError("an entry that is too large")
        return json.loads(text)

    def remove(self, file_path: str) -> None:
        if self._is_inside(file_path):
            super().remove(file_path)

    def _is_inside(self, name: str | None) -> bool:
        """Tells whether a name is one that the cache gives: two folders and a file, none of them a link."""
        if not isinstance(name, str):
            return False
        parts = name.split(os.sep)
        plain = len(parts) == 3 and all(part.strip("0123456789abcdef") in ("", ".val") for part in parts)
        folder = os.path.realpath(self._directory)
        return plain and os.path.realpath(os.path.join(folder, name)) == os.path.join(folder, name)


class Store:
    """Outcomes in a folder. Raises AidlError if the folder cannot be one."""

    def __init__(self, folder: Path, size: int | None = SIZE) -> None:
        """Opens or begins a cache; without a `size` nothing in it is dropped."""
        self.folder = folder
        if folder.is_dir() and any(folder.iterdir()) and not (folder / _DATABASE).is_file():
            raise _unusable(folder, "it holds other files", "name a folder that is empty or not there yet")
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._cache = diskcache.Cache(
                str(folder),
                timeout=_PATIENCE,
                disk=_Json,
                size_limit=size or 1 << 60,
                eviction_policy="least-recently-stored" if size else "none",
                disk_min_file_size=1 << 15,
                statistics=0,
                tag_index=0,
            )
        except _UNUSABLE as error:
            raise _unusable(folder, _reason(error)) from None

    def get(self, key: str, digest: Reader) -> Outcome | None:
        """Returns what is kept under a key, if the files that it was made of are as they were."""
        try:
            entry = self._cache.get(key)
            if entry is None or any(digest(path) != known for path, known in entry["reads"].items()):
                return None
            return from_data(entry["outcome"])
        except diskcache.Timeout as error:
            raise _unusable(self.folder, _reason(error)) from None
        except _BROKEN:
            return None  # it is made anew, and replaced

    def put(self, key: str, outcome: Outcome, reads: Mapping[str, str]) -> None:
        """Keeps an outcome. Raises AidlError if the folder takes nothing more."""
        try:
            self._cache.set(key, {"reads": dict(reads), "outcome": to_data(outcome)})
        except _UNUSABLE as error:
            raise _unusable(self.folder, _reason(error)) from None

    def __len__(self) -> int:
        return len(self._cache)

    def close(self) -> None:
        self._cache.close()


_UNUSABLE = (OSError, sqlite3.Error, diskcache.Timeout, ValueError, TypeError, AttributeError, KeyError)
"""Errors of a folder that cannot be written, or that is no cache."""
_BROKEN = (*_UNUSABLE, zlib.error, RecursionError)
"""Errors of an entry that is none."""


def remove(folder: Path) -> None:
    """Removes a cache; nothing if there is none. Raises AidlError for a folder that is no cache."""
    if folder.is_symlink() or (folder.exists() and not (folder / _DATABASE).is_file()):
        raise _unusable(folder, "it is no cache of a sweep", "move it away, or name another output")
    if folder.exists():
        try:
            shutil.rmtree(folder)
        except OSError as error:
            raise _unusable(folder, _reason(error)) from None


def key(bundle: Bundle, params: Mapping[str, Value], making: Making) -> str:
    """Returns the key of a variant. The files that it reads are looked at when it is found."""
    options = {name: sorted(v) if isinstance(v, frozenset) else v for name, v in vars(making.options).items()}
    told = [
        surroundings(),
        bundle.name,
        bundle.text,
        repr(bundle.settings),
        sorted((path, type(value).__name__, value) for path, value in params.items()),
        [list(making.suffixes), sorted(options.items()), making.best_effort, making.picture],
        making.drafted,
    ]
    return hashlib.sha256(json.dumps(told, default=repr).encode()).hexdigest()


def _unusable(folder: Path, why: str, *hints: str) -> AidlError:
    return AidlError(Diagnostic("E0974", f"`{folder}` cannot keep outcomes: {why}", hints=hints))


def _reason(error: BaseException) -> str:
    if isinstance(error, diskcache.Timeout):
        return "another process holds it"
    text = getattr(error, "strerror", None) or str(error) or type(error).__name__
    return text[:1].lower() + text[1:]

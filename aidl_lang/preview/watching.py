"""Looking out for changes of a program, and of what it may import."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from watchfiles import Change, awatch

from aidl_lang.resolving.imports import SUFFIX

_DEBOUNCE = 30
"""Milliseconds in which several changes count as one."""


async def watch(file: Path, changed: Callable[[], None]) -> None:
    """Calls back whenever a file, or a program beside it or below its folder, has changed; until it is
    cancelled.
    """
    try:
        await _watch(file, changed, polling=None)
    except (OSError, RuntimeError):  # the system watches no more files, or not this folder
        await _watch(file, changed, polling=True)


async def _watch(file: Path, changed: Callable[[], None], polling: bool | None) -> None:
    def concerns(change: Change, path: str) -> bool:
        return path.endswith(SUFFIX) or path == str(file)

    async for _ in awatch(
        file.parent, watch_filter=concerns, debounce=_DEBOUNCE, step=10, force_polling=polling
    ):
        changed()

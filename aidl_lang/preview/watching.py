"""Looking at the programs of a folder, on any system."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from watchfiles import Change, awatch

from aidl_lang.resolving.imports import SUFFIX

_DEBOUNCE = 30
"""Milliseconds in which several changes count as one."""


async def watch(folder: Path, changed: Callable[[], None]) -> None:
    """Calls back whenever a program in the folder, or below it, has changed; until it is cancelled."""
    try:
        await _watch(folder, changed, polling=None)
    except (OSError, RuntimeError):  # the system watches no more files, or not this folder
        await _watch(folder, changed, polling=True)


async def _watch(folder: Path, changed: Callable[[], None], polling: bool | None) -> None:
    async for _ in awatch(
        folder, watch_filter=_is_program, debounce=_DEBOUNCE, step=10, force_polling=polling
    ):
        changed()


def _is_program(change: Change, path: str) -> bool:
    return path.endswith(SUFFIX)

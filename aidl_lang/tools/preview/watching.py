"""Watches for changes of a program, and of the files that it may import."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from watchfiles import Change, awatch

from aidl_lang.checking.resolving.imports import SUFFIX

_DEBOUNCE = 30
"""Milliseconds in which several changes count as one."""
_SETTLED = 500
"""Milliseconds after which the system has begun to watch, if nothing has shown that before."""


async def watch(file: Path, changed: Callable[[Iterable[Path]], None], begun: Callable[[], None]) -> None:
    """Calls back with the paths whenever a file, or programs beside it or below its folder, have changed, and
    once when it has begun to see that; until it is cancelled.
    """
    try:
        await _watch(file, changed, begun, polling=None)
    except (OSError, RuntimeError):  # the system watches no more files, or not this folder
        await _watch(file, changed, begun, polling=True)


async def _watch(
    file: Path, changed: Callable[[Iterable[Path]], None], begun: Callable[[], None], polling: bool | None
) -> None:
    def concerns(change: Change, path: str) -> bool:
        return path.endswith(SUFFIX) or path == str(file)

    has_begun = False
    async for changes in awatch(
        file.parent,
        watch_filter=concerns,
        debounce=_DEBOUNCE,
        step=10,
        force_polling=polling,
        rust_timeout=_SETTLED,
        yield_on_timeout=True,
    ):
        if changes:
            changed({Path(path) for _, path in changes})
        elif not has_begun:
            begun()
        has_begun = True

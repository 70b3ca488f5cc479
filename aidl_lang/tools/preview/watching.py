"""Watches for changes of a program, and of the files that it may import."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable
from pathlib import Path

from watchfiles import Change, awatch

from aidl_lang.common.beside import may_be_read

_DEBOUNCE = 30
"""Milliseconds in which several changes count as one."""
_QUIET = 500
"""Milliseconds without a change after which the file is read all the same: the system may have begun to watch
only now, and not all of them tell of every change.
"""


Changed = Callable[[Iterable[Path]], Awaitable[None]]
Begun = Callable[[], Awaitable[None]]


async def watch(file: Path, changed: Changed, begun: Begun) -> None:
    """Calls back whenever a file, or what it may read in its folder or below, has changed, with the paths;
    after a quiet while, without any; once when it has begun to see changes. Goes on until it is cancelled.
    """
    try:
        await _watch(file, changed, begun, polling=None)
    except (OSError, RuntimeError):  # the system watches no more files, or not this folder
        await _watch(file, changed, begun, polling=True)


async def _watch(file: Path, changed: Changed, begun: Begun, polling: bool | None) -> None:
    def concerns(change: Change, path: str) -> bool:
        return may_be_read(path) or path == str(file)

    has_begun = False
    async for changes in awatch(
        file.parent,
        watch_filter=concerns,
        debounce=_DEBOUNCE,
        step=10,
        force_polling=polling,
        rust_timeout=_QUIET,
        yield_on_timeout=True,
    ):
        if changes or has_begun:
            await changed({Path(path) for _, path in changes})
        else:
            await begun()
        has_begun = True

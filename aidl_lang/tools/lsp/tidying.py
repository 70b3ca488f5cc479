"""Collects garbage while nobody waits.

A run leaves tens of thousands of objects that hold each other. Python's collector would look for them in the
middle of the next run, and go through the library and everything else each time; here it does so in the
pauses, and what stays for good is put out of its sight. What a document stands for now is among that and
never stays for good, so this is done seldom, and undone when one is closed.
"""

from __future__ import annotations

import asyncio
import gc
import time
from collections.abc import Callable

_PAUSE = 0.05
"""Seconds without work after which nobody seems to wait."""
_MOST = 100
"""Pieces of work after which it collects without a pause."""
_LONG = 0.03
"""Seconds of a collection that has gone through many permanent objects."""
_RELEASED = 0.5
"""Seconds after which nothing is under way for a document that was closed."""
_FREEZES = 3
"""How often objects are put out of sight: after the library and the first questions have come."""
_ROUNDS = 500
"""Collections after which seemingly permanent objects are looked through again."""


class Tidier:
    """`is_busy` tells whether anybody waits. All methods belong to the loop's thread."""

    def __init__(self, loop: asyncio.AbstractEventLoop, is_busy: Callable[[], bool]) -> None:
        self._loop, self._is_busy = loop, is_busy
        self._left = 0
        self._rounds = self._freezes = 0
        self._planned: asyncio.TimerHandle | None = None
        gc.disable()

    def note(self) -> None:
        """Notes that a piece of work was done."""
        self._left += 1
        if self._planned is not None:
            self._planned.cancel()
        self._planned = self._loop.call_later(0 if self._left >= _MOST else _PAUSE, self._tidy)

    def _tidy(self) -> None:
        if self._left < _MOST and self._is_busy():
            return  # there is a note at the end of that
        self._left = 0
        self._rounds += 1
        if self._rounds % _ROUNDS == 0:
            gc.unfreeze()
            self._freezes = 0
        began = time.perf_counter()
        gc.collect()
        if time.perf_counter() - began > _LONG and self._freezes < _FREEZES:
            self._freezes += 1
            gc.freeze()

    def release(self) -> None:
        """Has all looked through soon: much is of no use any more once what is under way has ended."""
        self._loop.call_later(_RELEASED, self._look_through)

    def _look_through(self) -> None:
        self._rounds = -1
        self.note()

    def close(self) -> None:
        if self._planned is not None:
            self._planned.cancel()
        gc.enable()

"""The surroundings of a run of a program: the time of its stages, room for nesting, no pauses."""

from __future__ import annotations

import gc
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from aidl_lang.common.cancelling import checkpoint

_RECURSION = 20_000
"""Python frames for deeply nested programs; the limits on nesting and calls are reached sooner."""


class Stopwatch:
    """The seconds that each stage took, by its name; a run that is given up ends where a stage begins."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def __call__(self, stage: str) -> Iterator[None]:
        checkpoint()
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[stage] = self.seconds.get(stage, 0.0) + time.perf_counter() - start


class _Working:
    """The settings of the Python interpreter that runs need: room for nested programs, and no pauses to look
    for cycles in a heap that only grows until the run ends. Several threads may run at once; the last to
    leave restores them.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._running = 0
        self._before = (0, False)

    def __enter__(self) -> None:
        with self._lock:
            if not self._running:
                self._before = sys.getrecursionlimit(), gc.isenabled()
                sys.setrecursionlimit(max(self._before[0], _RECURSION))
                gc.disable()
            self._running += 1

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._running -= 1
            if not self._running:
                recursion, collecting = self._before
                sys.setrecursionlimit(recursion)
                if collecting:
                    gc.enable()


working = _Working()

"""The surroundings of a run of a program: the time of its stages, room for nesting, no pauses; and what is
left to work out when it ended.
"""

from __future__ import annotations

import atexit
import gc
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Generic, TypeVar
from weakref import WeakSet

from aidl_lang.common.cancelling import checkpoint

T = TypeVar("T")
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


class Later(Generic[T]):
    """A function that works a value out when it is first called, or copied. `work` is dropped then, and what
    is left of it when the process ends: the kernel of areas complains about those that outlive it.
    """

    def __init__(self, work: Callable[[], T] | None, known: T | None = None) -> None:
        self._work, self.known = work, known
        _waiting.add(self)

    def __call__(self) -> T:
        if (work := self._work) is not None:  # two threads may both do it
            with working:
                self.known = work()
            self._work = None
        return self.known  # type: ignore[return-value]

    def __getstate__(self) -> dict[str, object]:
        return {"known": self(), "_work": None}


_waiting: WeakSet[Later[Any]] = WeakSet()
atexit.register(lambda: [vars(each).update(_work=None) for each in _waiting])

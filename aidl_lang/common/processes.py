"""Processes for work that may hang, crash or devour memory: what breaks one harms nothing else."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future
from enum import Enum
from multiprocessing import connection
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from pebble import ProcessPool

T = TypeVar("T")

MEMORY = 3_000_000_000
"""Bytes that a worker may have, where the system can be told so."""


class Limit(Enum):
    """What a call met that broke it: its limit of time, the end of its process, the limit of memory."""

    TIME = "time"
    DEATH = "death"
    MEMORY = "memory"


class Guarded:
    """Processes that carry out calls side by side, each within limits of time and memory. A call that breaks
    its process takes no other along; the process is replaced.
    """

    def __init__(self, workers: int, preload: str, memory: int = MEMORY) -> None:
        """`preload` is the module that they have loaded from the start."""
        from pebble import ProcessPool

        if sys.platform == "win32":
            context = multiprocessing.get_context("spawn")
        else:  # starts a process from one that has the language loaded and no threads
            context = multiprocessing.get_context("forkserver")
            context.set_forkserver_preload([preload])
        self._pool: ProcessPool = ProcessPool(
            workers, initializer=_prepare, initargs=(memory,), context=context
        )

    def submit(self, seconds: float, task: Callable[..., T], *arguments: object) -> Future[T]:
        """Have a call carried out; see `limit_met` for how it may end. Cancelling ends its process. The task,
        its arguments and what it returns can be pickled.
        """
        return self._pool.schedule(task, arguments, timeout=seconds)

    def close(self) -> None:
        """End all processes, whatever they do."""
        self._pool.stop()  # type: ignore[no-untyped-call]
        self._pool.join()


def limit_met(error: BaseException) -> Limit | None:
    """Returns what broke a call that ended in an error; None where the call raised it by itself."""
    from pebble import ProcessExpired

    if isinstance(error, ProcessExpired):
        return Limit.DEATH
    if isinstance(error, TimeoutError):
        return Limit.TIME
    return Limit.MEMORY if isinstance(error, MemoryError) else None


def count() -> int:
    """The processors that there are for this process."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0)) or 1
    return os.cpu_count() or 1


def _prepare(memory: int) -> None:
    """What a worker does first: it limits its memory, leaves an interrupt to the main process, and sees to it
    that it ends with that.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_server, daemon=True).start()
    if sys.platform != "win32":
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))


def _end_with_server() -> None:
    server = multiprocessing.parent_process()
    if server is not None:
        connection.wait([server.sentinel])
        os._exit(1)

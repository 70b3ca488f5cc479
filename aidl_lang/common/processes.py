"""Processes for work that may hang, crash or devour memory without harming anything else."""

from __future__ import annotations

import gc
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from enum import Enum
from multiprocessing import connection, forkserver
from typing import TYPE_CHECKING, Protocol, TypeVar

if TYPE_CHECKING:
    from pebble import ProcessPool

T = TypeVar("T")

MEMORY = 3_000_000_000
"""Bytes that a worker may use, on systems that can limit it."""


_BETWEEN_SEARCHES = 50_000
"""Objects that a worker makes before it looks for cycles among them."""


class Limit(Enum):
    """The limit that a call met: that of time, the end of its process, or that of memory."""

    TIME = "time"
    DEATH = "death"
    MEMORY = "memory"


class LimitError(Exception):
    """Raised in place of the result of a call that met a limit elsewhere, as on a machine of a cluster."""

    def __init__(self, limit: Limit) -> None:
        super().__init__(limit)
        self.limit = limit


class Engine(Protocol):
    """Whatever carries out calls: the processes of this machine, or the workers of a cluster."""

    @property
    def places(self) -> int:
        """The number of calls that it carries out side by side, as far as it is known now."""
        ...

    def submit(self, seconds: float, task: Callable[..., T], *arguments: object) -> Future[T]:
        """Has a call carried out within some seconds; `limit_met` tells how it broke. The task, its arguments
        and its result must be picklable.
        """
        ...

    def close(self) -> None:
        """Gives up all calls that are not done."""
        ...


class Guarded:
    """A pool of processes that carry out calls side by side, each within limits of time and memory. A call
    that breaks its process takes no other along; the process is replaced.
    """

    def __init__(self, workers: int, preload: str | Sequence[str], memory: int = MEMORY) -> None:
        """Starts the processes; `preload` has the modules that they load at the start."""
        from pebble import ProcessPool

        self.places = workers
        context = prepared(preload)
        self._pool: ProcessPool = ProcessPool(
            workers, initializer=_prepare, initargs=(memory,), context=context
        )

    def submit(self, seconds: float, task: Callable[..., T], *arguments: object) -> Future[T]:
        """Has a call carried out (see `Engine`). Cancelling ends its process."""
        return self._pool.schedule(task, arguments, timeout=seconds)

    def close(self) -> None:
        """Ends all processes, busy or not."""
        self._pool.stop()  # type: ignore[no-untyped-call]
        self._pool.join()


def prepared(preload: str | Sequence[str]) -> multiprocessing.context.BaseContext:
    """Returns how processes are started that have loaded some modules. It begins to load them, which goes on
    while others do other things.
    """
    if sys.platform == "win32":
        return multiprocessing.get_context("spawn")
    # starts a process from one that has the language loaded and no threads
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([preload] if isinstance(preload, str) else list(preload))
    forkserver.ensure_running()
    return context


def limit_met(error: BaseException) -> Limit | None:
    """Returns the limit that broke a call; None if the call raised the error by itself."""
    from pebble import ProcessExpired

    if isinstance(error, LimitError):
        return error.limit
    if isinstance(error, ProcessExpired):
        return Limit.DEATH
    if isinstance(error, TimeoutError):
        return Limit.TIME
    return Limit.MEMORY if isinstance(error, MemoryError) else None


def count() -> int:
    """Returns the number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0)) or 1
    return os.cpu_count() or 1


def _prepare(memory: int) -> None:
    """Prepares a worker: limits its memory, leaves interrupts to the main process, makes it end with that,
    and spares it to look for cycles among what it was started with.
    """
    gc.freeze()
    gc.set_threshold(_BETWEEN_SEARCHES)
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

"""Processes for work that may hang, crash or devour memory: each can be ended, and is then replaced."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
from multiprocessing import connection
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pebble import ProcessPool

MEMORY = 3_000_000_000
"""Bytes that a worker may have, where the system can be told so."""


def pool(workers: int, preload: str) -> ProcessPool:
    """Workers that have a module loaded from the start."""
    from pebble import ProcessPool

    if sys.platform == "win32":
        context = multiprocessing.get_context("spawn")
    else:  # starts a process from one that has the language loaded and no threads
        context = multiprocessing.get_context("forkserver")
        context.set_forkserver_preload([preload])
    return ProcessPool(workers, initializer=_prepare, context=context)


def stop(workers: ProcessPool) -> None:
    """End all processes, whatever they do."""
    workers.stop()  # type: ignore[no-untyped-call]
    workers.join()


def count() -> int:
    """The processors that there are for this process."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0)) or 1
    return os.cpu_count() or 1


def _prepare() -> None:
    """What a worker does first: it limits its memory, leaves an interrupt to the main process, and sees to it
    that it ends with that.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_server, daemon=True).start()
    if sys.platform != "win32":
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def _end_with_server() -> None:
    server = multiprocessing.parent_process()
    if server is not None:
        connection.wait([server.sentinel])
        os._exit(1)

"""Calls in processes of their own, so that a program that hangs, crashes or devours memory harms nothing
else.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import sys
import threading
from collections.abc import Mapping
from concurrent.futures import TimeoutError
from multiprocessing import connection
from typing import TYPE_CHECKING

from aidl_lang.agents.calling import Answer, answer
from aidl_lang.agents.tools import Tools
from aidl_lang.diagnostics import Diagnostic
from aidl_lang.render import compact

if TYPE_CHECKING:
    from pebble import ProcessPool

SECONDS = 45.0
"""A call may take; clients wait for a minute."""
MEMORY = 3_000_000_000
"""Bytes that a worker may have, where the system can be told so."""
_WORKERS = 2


class Workers:
    """A few processes that answer calls one after the other; one that was ended is replaced."""

    def __init__(self, workshop: Tools, seconds: float = SECONDS) -> None:
        self.workshop, self.seconds = workshop, seconds
        self.pool = _pool()

    async def answer(self, name: str, arguments: Mapping[str, object]) -> Answer:
        """The answer of a tool. Cancelling this ends the process that works on it."""
        from pebble import ProcessExpired

        future = self.pool.schedule(answer, (self.workshop, name, arguments), timeout=self.seconds)
        try:
            return await asyncio.wrap_future(future)
        except TimeoutError:
            return _given_up(f"took longer than {self.seconds:g} s")
        except ProcessExpired:
            return _given_up("ended the process that worked on it")
        except MemoryError:
            return _given_up("needs more memory than there is for it")

    def close(self) -> None:
        self.pool.stop()  # type: ignore[no-untyped-call]
        self.pool.join()


def _given_up(why: str) -> Answer:
    diagnostic = Diagnostic(
        "E0943",
        f"the call {why} and was given up",
        hints=("ask for less: fewer parts, smaller arrays, no outlines worked out of many others",),
    )
    return Answer(compact([diagnostic]), {}, is_error=True)


def _pool() -> ProcessPool:
    from pebble import ProcessPool

    if sys.platform == "win32":
        context = multiprocessing.get_context("spawn")
    else:  # starts a process from one that has the language loaded and no threads
        context = multiprocessing.get_context("forkserver")
        context.set_forkserver_preload(["aidl_lang.agents.calling"])
    return ProcessPool(_WORKERS, initializer=_prepare, context=context)


def _prepare() -> None:
    """What a worker does first: it limits its memory, and sees to it that it ends with the server."""
    threading.Thread(target=_end_with_server, daemon=True).start()
    if sys.platform != "win32":
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def _end_with_server() -> None:
    server = multiprocessing.parent_process()
    if server is not None:
        connection.wait([server.sentinel])
        os._exit(1)

"""What the standard library lacks in a browser and `aidl_lang` counts on. `complete` is called before that is
loaded.

There is one thread. Its time is the wall clock's, and what others would do in threads is done in turns of the
loop, each to its end: what is asked meanwhile waits, and whoever cannot wait ends the worker.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from types import ModuleType
from typing import Any


class Turns:
    """An executor that does each piece of work in a turn of the loop, in order. `busy` is told before and
    after: nothing is heard meanwhile.
    """

    busy: Callable[[bool], object]

    def __init__(self, *_: object, **__: object) -> None:
        self._is_closed = False
        self._waiting: set[Future[Any]] = set()

    def submit(self, work: Callable[..., Any], /, *given: Any, **named: Any) -> Future[Any]:
        if self._is_closed:
            raise RuntimeError("cannot schedule new futures after shutdown")
        future: Future[Any] = Future()
        self._waiting.add(future)
        asyncio.get_running_loop().call_soon(self._do, future, lambda: work(*given, **named))
        return future

    def _do(self, future: Future[Any], work: Callable[[], Any]) -> None:
        self._waiting.discard(future)
        if not future.set_running_or_notify_cancel():
            return
        Turns.busy(True)
        try:
            result = work()
        except Exception as reason:  # noqa: BLE001 (handed over, whatever it is)
            future.set_exception(reason)
        else:
            future.set_result(result)
        finally:
            Turns.busy(False)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        self._is_closed = True
        for future in list(self._waiting) if cancel_futures else ():
            future.cancel()


def complete(kernel: object, busy: Callable[[bool], object]) -> None:
    """Puts in place what is lacking. `kernel` is the one of `manifold`, `busy` is told of work."""
    from aidl_web.inside import manifold

    Turns.busy = busy
    time.thread_time = time.perf_counter
    concurrent.futures.ThreadPoolExecutor = Turns  # type: ignore[misc, assignment]
    threading.stack_size = lambda size=0: 0
    # There are no processes either. `multiprocessing` can be loaded, as long as none is started.
    processes, memory = ModuleType("_multiprocessing"), ModuleType("_posixshmem")
    vars(processes).update(sem_unlink=_impossible)
    vars(memory).update(shm_unlink=_impossible)
    manifold.kernel = kernel
    sys.modules |= {"_multiprocessing": processes, "_posixshmem": memory, "manifold3d": manifold}


def _impossible(*_: object) -> None:
    raise OSError("a browser has no processes")

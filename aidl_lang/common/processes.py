"""Processes for work that may hang, crash or devour memory without harming anything else."""

from __future__ import annotations

import gc
import multiprocessing
import os
import signal
import threading
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import contextmanager, suppress
from enum import Enum
from multiprocessing import connection
from multiprocessing.reduction import ForkingPickler
from queue import SimpleQueue
from typing import Any, Protocol, TypeVar

T = TypeVar("T")

MEMORY = 3_000_000_000
"""Bytes that a worker may use, on systems that can limit it."""

_STARTING = 60.0
"""Seconds that a process may take to start."""
_TRIALS = 20
"""How often a process is started for a call before it is told that none lives."""
_BETWEEN_SEARCHES = 50_000
"""Objects that a worker makes before it looks for cycles among them."""


class Limit(Enum):
    """The limit that a call met: that of time, the end of its process, or that of memory."""

    TIME = "time"
    DEATH = "death"
    MEMORY = "memory"


class LimitError(Exception):
    """Raised in place of the result of a call that met a limit, here or on a machine of a cluster."""

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
        """Has a picklable call carried out within some seconds; `limit_met` tells how it broke."""
        ...

    def close(self) -> None:
        """Gives up all calls that are not done."""
        ...


class Guarded:
    """A pool of processes that carry out calls side by side, each within limits of time and memory. A process
    may die at any instant, and takes none but its own call along: it shares a pipe with one thread of this
    process and nothing with the others. It is replaced.
    """

    def __init__(self, workers: int, preload: str | Sequence[str], memory: int = MEMORY) -> None:
        """Starts the processes; `preload` has the modules that they load at the start."""
        # `multiprocessing` lets a daemon have no children, lest they outlive it: these end with their parent.
        multiprocessing.current_process()._config["daemon"] = False  # type: ignore[attr-defined]
        self.places = workers
        self._calls: SimpleQueue[_Call | None] = SimpleQueue()
        context = prepared(preload)
        self._places = [_Place(self._calls, context, memory) for _ in range(workers)]
        for place in self._places:
            place.start()

    def submit(self, seconds: float, task: Callable[..., T], *arguments: object) -> Future[T]:
        """Has a call carried out (see `Engine`). Cancelling ends its process."""
        call = _Call(seconds, ForkingPickler.dumps((task, arguments)))
        self._calls.put(call)
        return call.future

    def close(self) -> None:
        """Ends all processes, busy or not."""
        for place in self._places:
            place.close()
        for _ in self._places:
            self._calls.put(None)
        for place in self._places:
            place.join(_STARTING)


class _Call:
    """A call to be carried out: the seconds that it has, and the pickled task with its arguments."""

    def __init__(self, seconds: float, data: memoryview) -> None:
        self.seconds, self.data = seconds, data
        self.future: Future[Any] = Future()


class _Place(threading.Thread):
    """A thread that has one process at a time carry out calls, one after the other."""

    def __init__(
        self, calls: SimpleQueue[_Call | None], context: multiprocessing.context.BaseContext, memory: int
    ) -> None:
        super().__init__(daemon=True)
        self._calls, self._context, self._memory = calls, context, memory
        self._process: Any = None
        self._call: _Call | None = None
        self._lock = threading.Lock()
        self._is_closed = False

    def run(self) -> None:
        with suppress(LimitError, RuntimeError):  # which a call would meet again
            self._begin()
        while (call := self._calls.get()) is not None:
            self._carry_out(call)
        self._end()

    def close(self) -> None:
        """Ends the process, and begins no other."""
        self._is_closed = True
        with self._lock:
            self._kill()

    def _given_up(self, call: _Call) -> None:
        """Ends the process if it is at a call."""
        with self._lock:
            if self._call is call:
                self._kill()

    def _carry_out(self, call: _Call) -> None:
        future = call.future
        self._call = call
        # a call that is carried out may be cancelled until it is done
        future.add_done_callback(lambda _: self._given_up(call))
        is_well, result = False, None
        try:
            is_well, result = self._answer(call)
        except Exception as error:  # noqa: BLE001 (handed over, whatever it is)
            result = error
        with self._lock:
            self._call = None
        if not future.set_running_or_notify_cancel():
            self._end()
        elif is_well:
            future.set_result(result)
        else:
            future.set_exception(result)

    def _answer(self, call: _Call) -> tuple[bool, Any]:
        """Returns whether a call ended well, and its result or its error. Raises LimitError."""
        for left in reversed(range(_TRIALS)):
            try:
                self._begin()
                with self._within(call.seconds):
                    if call.future.cancelled():
                        raise EOFError
                    self._channel.send_bytes(call.data)
                break
            except LimitError as error:  # the process was gone before it had the call
                if error.limit is Limit.TIME or not left or call.future.cancelled():
                    raise
        with self._within(call.seconds):
            data = self._channel.recv_bytes()
        return ForkingPickler.loads(data)  # type: ignore[no-any-return]

    def _begin(self) -> None:
        """Starts the process unless there is one, and waits until it is ready. Raises LimitError."""
        if self._is_closed:
            raise LimitError(Limit.DEATH)
        if self._process is not None:
            return
        self._channel, theirs = self._context.Pipe()
        process = self._context.Process(target=_serve, args=(theirs, self._memory), daemon=True)  # type: ignore[attr-defined]
        try:
            with _starting:
                process.start()
        except (OSError, EOFError) as error:
            self._channel.close()
            raise LimitError(Limit.DEATH) from error
        finally:
            theirs.close()
        self._process = process
        with self._within(_STARTING):
            self._channel.recv_bytes()

    @contextmanager
    def _within(self, seconds: float) -> Iterator[None]:
        """Ends the process when some seconds are over; raises LimitError if it ends in this time or then."""
        until = time.monotonic() + seconds
        watchdog = threading.Timer(seconds, self._process.kill)
        watchdog.daemon = True
        watchdog.start()
        try:
            yield
        except (OSError, EOFError) as error:
            self._end()
            raise LimitError(Limit.DEATH if time.monotonic() < until else Limit.TIME) from error
        finally:
            watchdog.cancel()

    def _kill(self) -> None:
        if (process := self._process) is not None:
            process.kill()

    def _end(self) -> None:
        if (process := self._process) is not None:
            self._process = None
            self._channel.close()
            process.kill()
            process.join(_STARTING)


_starting = threading.Lock()
"""Held by a thread that starts a process: `multiprocessing` is not made for several at a time."""


def prepared(preload: str | Sequence[str]) -> multiprocessing.context.BaseContext:
    """Returns how processes start that have loaded some modules; these load meanwhile."""
    if not hasattr(os, "fork"):
        return multiprocessing.get_context("spawn")
    from multiprocessing import forkserver

    context = multiprocessing.get_context("forkserver")  # of a process with the language and no threads
    context.set_forkserver_preload([preload] if isinstance(preload, str) else list(preload))
    forkserver.ensure_running()
    return context


def limit_met(error: BaseException) -> Limit | None:
    """Returns the limit that broke a call; None if the call raised the error by itself."""
    if isinstance(error, LimitError):
        return error.limit
    return Limit.MEMORY if isinstance(error, MemoryError) else None


def count() -> int:
    """Returns the number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0)) or 1
    return os.cpu_count() or 1


def _serve(channel: connection.Connection, memory: int) -> None:
    """Carries out the calls that come through a pipe, in a process of its own, until the pipe is closed."""
    _prepare(memory)
    channel.send_bytes(b"")
    while True:
        try:
            data = channel.recv_bytes()
        except EOFError:
            return
        channel.send_bytes(_outcome(data))


def _outcome(data: bytes) -> memoryview:
    """Returns pickled whether a call ended well, and its result or its error."""
    try:
        task, arguments = ForkingPickler.loads(data)
        return ForkingPickler.dumps((True, task(*arguments)))
    except Exception as error:  # noqa: BLE001 (handed over, whatever it is)
        error.add_note(traceback.format_exc())
        try:
            told = ForkingPickler.dumps((False, error))
            ForkingPickler.loads(told)
        except Exception:  # noqa: BLE001 (an error that does not travel is told in words)
            return ForkingPickler.dumps((False, RuntimeError(f"{type(error).__name__}: {error}")))
        return told


def _prepare(memory: int) -> None:
    """Prepares a worker: limits its memory, leaves interrupts to the main process, makes it end with that,
    and spares it to look for cycles among what it was started with.
    """
    gc.freeze()
    gc.set_threshold(_BETWEEN_SEARCHES)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_server, daemon=True).start()
    with suppress(ImportError, OSError, ValueError):  # Windows has no such module, and macOS no such limit
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))


def _end_with_server() -> None:
    server = multiprocessing.parent_process()
    if server is not None:
        connection.wait([server.sentinel])
        os._exit(1)

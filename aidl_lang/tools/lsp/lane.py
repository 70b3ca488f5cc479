"""Work off the message thread: single threads with queues."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Hashable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from typing import Any, Generic, TypeVar

from aidl_lang.common.records import record
from aidl_lang.common.running import Cancelled, cancelled_when

T = TypeVar("T")

_STACK = 64 * 1024 * 1024
"""Stack of a thread, bytes: programs may be nested, and the interpreter follows them."""


def _executor(name: str) -> ThreadPoolExecutor:
    """Returns an executor of one thread, which starts with the first piece of work."""
    return ThreadPoolExecutor(max_workers=1, thread_name_prefix=name)


def give_room() -> None:
    """Gives threads started from now on room for nested programs."""
    threading.stack_size(_STACK)


@record(frozen=False, eq=False)
class Job(Generic[T]):
    """A piece of work: `work` runs in the lane's thread, `done` then on the loop with the result."""

    key: Hashable
    work: Callable[[], T]
    done: Callable[[Future[T]], None]
    dropped: Callable[[], None] = lambda: None
    """Called instead of `done` if newer work of the same key replaces it before it has begun."""


class Lane:
    """Does one piece of work at a time; of those waiting under one key, only the newest. All methods belong
    to the loop's thread; `finished` is called there after each piece.
    """

    def __init__(self, name: str, loop: asyncio.AbstractEventLoop, finished: Callable[[], None]) -> None:
        self._executor = _executor(name)
        self._loop, self._finished = loop, finished
        self._waiting: dict[Hashable, Job[Any]] = {}
        self.running: Job[Any] | None = None
        self._is_closed = False

    @property
    def is_busy(self) -> bool:
        return self.running is not None

    def waits(self, key: Hashable) -> bool:
        return key in self._waiting

    def put(self, job: Job[Any], first: bool = False) -> None:
        """Queues work, last or as the next."""
        self.drop(job.key)
        if self._is_closed:
            job.dropped()
            return
        self._waiting = {job.key: job, **self._waiting} if first else {**self._waiting, job.key: job}
        self._start()

    def drop(self, key: Hashable) -> None:
        """Drops the work waiting under a key; running work goes on."""
        if (older := self._waiting.pop(key, None)) is not None:
            older.dropped()

    def close(self) -> None:
        """Drops waiting work and begins nothing more."""
        self._is_closed = True
        for key in list(self._waiting):
            self.drop(key)
        self._executor.shutdown(wait=False, cancel_futures=True)

    def _start(self) -> None:
        if self.running is None and self._waiting:
            job = self._waiting.pop(next(iter(self._waiting)))
            self.running = job
            self._executor.submit(job.work).add_done_callback(partial(self._hand_over, job))

    def _hand_over(self, job: Job[Any], future: Future[Any]) -> None:
        """Passes a result to the loop, from the lane's thread or whichever cancels."""
        with suppress(RuntimeError):  # the loop has ended: nobody waits for this any more
            self._loop.call_soon_threadsafe(self._finish, job, future)

    def _finish(self, job: Job[Any], future: Future[Any]) -> None:
        self.running = None
        try:
            if not future.cancelled():
                job.done(future)
        finally:
            self._start()
            self._finished()


class Answers:
    """Answers questions one after the other, off the loop. Work on a cancelled question stops."""

    def __init__(self, name: str) -> None:
        self._executor = _executor(name)
        self._is_closing = False

    async def ask(self, answer: Callable[[], T]) -> T:
        """Returns the answer. Raises what `answer` raises."""
        unwanted = threading.Event()

        def work() -> T:
            with cancelled_when(lambda: unwanted.is_set() or self._is_closing):
                return answer()

        if self._is_closing:
            raise asyncio.CancelledError
        try:
            return await asyncio.wrap_future(self._executor.submit(work))
        except asyncio.CancelledError:
            unwanted.set()
            raise

    def close(self) -> None:
        """Cancels the present answer, and begins nothing more."""
        self._is_closing = True
        self._executor.shutdown(wait=False, cancel_futures=True)


def gave_up(future: Future[Any]) -> bool:
    """True for a run that was cancelled, by its future or while running."""
    return future.cancelled() or isinstance(future.exception(), Cancelled)

"""One thread that does what takes time: never more than one thing behind what is wanted.

A change of the text comes before all else and gives up whatever runs. Orders are carried out in turn. Of what
is merely tried, each page has one thing in waiting, the newest. What nobody waits for comes last.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Hashable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from aidl_lang.cancelling import Cancelled, cancelled_when

BUSY_AFTER = 0.15
"""Seconds after which whoever waits is told."""


@dataclass(frozen=True)
class Job:
    """`do` runs in the thread; what it gives, or else `failed`, then runs in the event loop.

    busy    when it takes longer than a moment
    failed  with whatever exception it ended by, Cancelled if it was given up
    """

    do: Callable[[], Callable[[], None]]
    busy: Callable[[], None]
    failed: Callable[[BaseException], None]


class Worker:
    def __init__(self, refresh: Job) -> None:
        self._refresh = refresh
        self._is_text_new = self._is_asked = False
        self._orders: deque[Job] = deque()
        self._attempts: dict[Hashable, Job] = {}
        self._later: Job | None = None
        self._wake = asyncio.Event()
        self._is_closing = False
        self._is_trying = self._is_idling = False
        """what runs: an attempt, what nobody waits for"""

    def refresh(self) -> None:
        """The text may be new, so what runs is given up."""
        self._is_text_new = True
        self._wake.set()

    def ask(self) -> None:
        """Somebody wants to see the text as it is."""
        self._is_asked = True
        self._wake.set()

    def order(self, job: Job) -> None:
        self._orders.append(job)
        self._wake.set()

    def attempt(self, page: Hashable, job: Job) -> None:
        """In place of what waits for the page."""
        self._attempts[page] = job
        self._wake.set()

    def later(self, job: Job) -> None:
        """When there is nothing else to do, from the start if it is interrupted; in place of what waits."""
        self._later = job
        self._wake.set()

    def forget(self, page: Hashable) -> None:
        """What waits to be tried for a page is not wanted any more."""
        self._attempts.pop(page, None)

    async def run(self) -> None:
        """Works until it is cancelled."""
        pool = ThreadPoolExecutor(1, thread_name_prefix="preview")
        try:
            while True:
                await self._wake.wait()
                self._wake.clear()
                while (job := self._next()) is not None:
                    await self._carry_out(job, pool)
        finally:
            self._is_closing = True
            pool.shutdown(wait=False, cancel_futures=True)

    def _next(self) -> Job | None:
        self._is_trying = self._is_idling = False
        if self._is_text_new or (self._is_asked and not self._orders):
            self._is_text_new = self._is_asked = False
            return self._refresh
        if self._orders:
            return self._orders.popleft()
        if self._attempts:
            self._is_trying = True
            return self._attempts.pop(next(iter(self._attempts)))
        job, self._later, self._is_idling = self._later, None, True
        return job

    def _is_unwanted(self) -> bool:
        """Asked by the thread in passing."""
        if self._is_closing or self._is_text_new:
            return True
        is_more_wanted = self._is_asked or bool(self._orders)
        if self._is_idling:
            return is_more_wanted or bool(self._attempts)
        return self._is_trying and is_more_wanted

    async def _carry_out(self, job: Job, pool: ThreadPoolExecutor) -> None:
        loop = asyncio.get_running_loop()
        timer = loop.call_later(BUSY_AFTER, job.busy)
        future = loop.run_in_executor(pool, self._cancellable, job)
        try:
            await asyncio.wait([future])
        finally:
            timer.cancel()
        error = future.exception()
        if error is None:
            future.result()()
        elif isinstance(error, Cancelled) and self._is_idling:
            self._later = self._later or job  # there will be time for it
        else:
            job.failed(error)

    def _cancellable(self, job: Job) -> Callable[[], None]:
        with cancelled_when(self._is_unwanted):
            return job.do()

"""One thread that does what takes time: never more than one thing behind what is wanted.

A change of the text comes before all else and gives up whatever runs. Then the pages have turns, one thing at
a time, so that none waits for all that another wants: its orders, as they came, then the picture it asked
for, then what it merely tries, of which the newest waits. What nobody waits for comes last.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Hashable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import field

from aidl_lang.common.cancelling import Cancelled, cancelled_when
from aidl_lang.common.records import record

BUSY_AFTER = 0.15
"""Seconds after which whoever waits is told."""
MOST_ORDERS = 8
"""Of one page, that wait."""


@record()
class Job:
    """`do` runs in the thread; what it gives, or else `failed`, then runs in the event loop.

    busy    when it takes longer than a moment
    failed  with whatever exception it ended by, Cancelled if it was given up
    lasts   whether it is to be done even if the page that wanted it has gone
    """

    do: Callable[[], Callable[[], None]]
    busy: Callable[[], None]
    failed: Callable[[BaseException], None]
    lasts: bool = False


@record(frozen=False)
class _Lane:
    """What waits for one page."""

    orders: deque[Job] = field(default_factory=deque)
    is_asked: bool = False
    attempt: Job | None = None

    @property
    def is_empty(self) -> bool:
        return not (self.orders or self.is_asked or self.attempt)


_GONE = object()
"""The page in whose name the orders of those that left are carried out."""


class Worker:
    def __init__(self, refresh: Job) -> None:
        self._refresh = refresh
        self._is_text_new = False
        self._lanes: dict[Hashable, _Lane] = {}
        """by page; whose turn is next stands first"""
        self._later: Job | None = None
        self._wake = asyncio.Event()
        self._is_closing = False
        self._trying: Hashable = None
        self._is_idling = False
        """what runs: an attempt of that page, what nobody waits for"""

    def refresh(self) -> None:
        """The text may be new, so what runs is given up."""
        self._is_text_new = True
        self._wake.set()

    def ask(self, page: Hashable) -> None:
        """It wants to see the text as it is; so does None, which is no page."""
        self._lane(page).is_asked = True
        self._wake.set()

    def order(self, page: Hashable, job: Job) -> bool:
        """False if as much as may wait for the page waits already: then this is left out."""
        lane = self._lane(page)
        if len(lane.orders) == MOST_ORDERS:
            return False
        lane.orders.append(job)
        self._wake.set()
        return True

    def attempt(self, page: Hashable, job: Job) -> None:
        """In place of what waits to be tried for the page."""
        self._lane(page).attempt = job
        self._wake.set()

    def later(self, job: Job) -> None:
        """When there is nothing else to do, from the start if it is interrupted; in place of what waits."""
        self._later = job
        self._wake.set()

    def forget(self, page: Hashable) -> None:
        """What waits to be tried for a page is not wanted any more."""
        self._lane(page).attempt = None

    def leave(self, page: Hashable) -> None:
        """The page has gone: of its orders those that last are done, with those of others that went."""
        lane = self._lanes.pop(page, _Lane())
        for job in lane.orders:
            if job.lasts:
                self.order(_GONE, job)

    def _lane(self, page: Hashable) -> _Lane:
        return self._lanes.setdefault(page, _Lane())

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
        self._trying, self._is_idling = None, False
        if self._is_text_new:
            return self._refreshing()
        for page in tuple(self._lanes):
            lane = self._lanes.pop(page)
            if not lane.is_empty:
                self._lanes[page] = lane  # behind the others
                return self._taken(page, lane)
        job, self._later, self._is_idling = self._later, None, True
        return job

    def _taken(self, page: Hashable, lane: _Lane) -> Job:
        if lane.orders:
            return lane.orders.popleft()
        if lane.is_asked:
            return self._refreshing()
        assert lane.attempt is not None
        job, lane.attempt, self._trying = lane.attempt, None, page
        return job

    def _refreshing(self) -> Job:
        """The text as it is, for all that asked for it."""
        self._is_text_new = False
        for lane in self._lanes.values():
            lane.is_asked = False
        return self._refresh

    def _is_unwanted(self) -> bool:
        """Asked by the thread in passing."""
        if self._is_closing or self._is_text_new:
            return True
        if self._is_idling:
            return not all(lane.is_empty for lane in tuple(self._lanes.values()))
        lane = None if self._trying is None else self._lanes.get(self._trying)
        return lane is not None and (lane.is_asked or bool(lane.orders))

    def _is_still_wanted(self) -> bool:
        """Whether the attempt that was given up is what its page wants to see."""
        lane = None if self._trying is None else self._lanes.get(self._trying)
        return lane is not None and lane.is_empty

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
        elif isinstance(error, Cancelled) and self._is_still_wanted():
            self._lanes[self._trying].attempt = job  # once the text, which may be new, was looked at
        else:
            job.failed(error)

    def _cancellable(self, job: Job) -> Callable[[], None]:
        with cancelled_when(self._is_unwanted):
            return job.do()

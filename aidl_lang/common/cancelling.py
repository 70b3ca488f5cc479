"""Ending a run early: because its result is no longer wanted, as when an editor's text has changed again, or
because it takes longer than it may.

Whoever starts a run sets the condition; the stages call `checkpoint` in every loop whose length depends on
the program.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager


class Cancelled(Exception):  # noqa: N818 (nothing went wrong)
    """Raised in a run that is given up. What it has made so far is dropped."""


class OutOfTime(Exception):  # noqa: N818 (not an error of ours: a program asks for too much, which is reported)
    """Raised in work that takes longer than it may."""


class _Asked(threading.local):
    unwanted: Callable[[], bool] | None = None
    deadline: float = math.inf
    next_look: float = 0.0
    """the wall clock before which the deadline cannot be over; reading it costs a tenth of reading the time
    that the thread has used"""


_asked = _Asked()


@contextmanager
def cancelled_when(unwanted: Callable[[], bool]) -> Iterator[None]:
    """Makes runs in this thread raise Cancelled soon after `unwanted` returns True."""
    before, _asked.unwanted = _asked.unwanted, unwanted
    try:
        yield
    finally:
        _asked.unwanted = before


@contextmanager
def limited_to(seconds: float) -> Iterator[None]:
    """Makes work in this thread raise OutOfTime soon after it has taken so many seconds of the processor's
    time, whatever else the machine does.
    """
    before, used = _asked.deadline, time.thread_time()
    _asked.deadline, _asked.next_look = min(before, used + seconds), 0.0
    try:
        yield
    finally:
        _asked.deadline, _asked.next_look = before, 0.0


def give_up(seconds: float = math.inf) -> None:
    """Raises OutOfTime if there is a limit, and work of so many seconds would pass it. For work that plainly
    takes longer, and may fill the memory before a checkpoint notices.
    """
    if _asked.deadline < math.inf and time.thread_time() + seconds > _asked.deadline:
        raise OutOfTime


def checkpoint() -> None:
    """Raises Cancelled if the run in this thread is no longer wanted, OutOfTime if it takes too long."""
    if _asked.unwanted is not None and _asked.unwanted():
        raise Cancelled
    if _asked.deadline < math.inf and (now := time.monotonic()) > _asked.next_look:
        left = _asked.deadline - time.thread_time()
        if left < 0:
            raise OutOfTime
        _asked.next_look = now + left

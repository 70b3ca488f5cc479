"""Ending a run before it is done: nobody waits for it any more, as when an editor's text has changed again,
or it takes longer than a run may.

Whoever starts a run says how to find out; the stages ask in passing, wherever they go through something that
a program makes as long as it likes.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager


class Cancelled(Exception):  # noqa: N818 (nothing went wrong)
    """The run was given up. What it has made so far is dropped."""


class OutOfTime(Exception):  # noqa: N818 (not an error of ours: a program asks for too much, which is reported)
    """The work takes longer than it may."""


class _Asked(threading.local):
    unwanted: Callable[[], bool] | None = None
    deadline: float = math.inf
    next_look: float = 0.0
    """the wall clock before which the deadline cannot be over; to read it costs a tenth of a look at what the
    thread has used"""


_asked = _Asked()


@contextmanager
def cancelled_when(unwanted: Callable[[], bool]) -> Iterator[None]:
    """Runs in this thread raise Cancelled soon after `unwanted` says so."""
    before, _asked.unwanted = _asked.unwanted, unwanted
    try:
        yield
    finally:
        _asked.unwanted = before


@contextmanager
def limited_to(seconds: float) -> Iterator[None]:
    """Work in this thread raises OutOfTime soon after it has taken so much of the processor's time: what else
    the machine does is not held against it.
    """
    before, used = _asked.deadline, time.thread_time()
    _asked.deadline, _asked.next_look = min(before, used + seconds), 0.0
    try:
        yield
    finally:
        _asked.deadline, _asked.next_look = before, 0.0


def give_up() -> None:
    """Raises OutOfTime where there is a limit: what is to be done plainly takes longer, and may fill the
    memory before that is noticed.
    """
    if _asked.deadline < math.inf:
        raise OutOfTime


def checkpoint() -> None:
    """Raises Cancelled if the run in this thread is not wanted any more, OutOfTime if it takes too long."""
    if _asked.unwanted is not None and _asked.unwanted():
        raise Cancelled
    if _asked.deadline < math.inf and (now := time.monotonic()) > _asked.next_look:
        left = _asked.deadline - time.thread_time()
        if left < 0:
            raise OutOfTime
        _asked.next_look = now + left

"""Giving up a run that nobody waits for any more: an editor's text has changed again.

Whoever starts a run says how to find out; the stages ask in passing, wherever they look at the clock.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager


class Cancelled(Exception):  # noqa: N818 (nothing went wrong)
    """The run was given up. What it has made so far is dropped."""


class _Asked(threading.local):
    unwanted: Callable[[], bool] | None = None


_asked = _Asked()


@contextmanager
def cancelled_when(unwanted: Callable[[], bool]) -> Iterator[None]:
    """Runs in this thread raise Cancelled soon after `unwanted` says so."""
    before, _asked.unwanted = _asked.unwanted, unwanted
    try:
        yield
    finally:
        _asked.unwanted = before


def checkpoint() -> None:
    """Raises Cancelled if the run in this thread is not wanted any more."""
    if _asked.unwanted is not None and _asked.unwanted():
        raise Cancelled

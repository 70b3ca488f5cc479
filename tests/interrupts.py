"""Interrupts reach what tests start: a shell lets what runs beside others ignore them, and processes inherit
that. What takes too long is interrupted.
"""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

signal.signal(signal.SIGINT, signal.default_int_handler)


class TooLong(BaseException):
    """The processor's time for a step ran out."""


@contextmanager
def within(seconds: float) -> Iterator[None]:
    """Raises TooLong in the main thread when so much of the processor's time has gone by."""

    def stop(number: int, frame: FrameType | None) -> None:
        raise TooLong

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
